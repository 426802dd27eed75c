//! Pictures of stress and strain, of several models side by side.

use super::nodal_sheet::NodalSheet;
use super::{FieldFigure, Figure, LocalState, Panel};
use crate::document::name_of;
use crate::mesh::{Mesh, NodalField};
use crate::problem::SheetLaws;
use crate::units::Dimension;

/// A quantity of a sheet that follows from its displacement field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetField {
    /// The length of the displacement.
    Displacement,
    /// The displacement along x.
    DisplacementX,
    /// The displacement along y.
    DisplacementY,
    /// Von Mises' equivalent Cauchy stress.
    VonMises,
    /// The larger principal Cauchy stress in the plane.
    LargestPrincipalStress,
    /// The smaller one.
    SmallestPrincipalStress,
    /// The Cauchy stress along x.
    CauchyXx,
    /// The Cauchy stress along y.
    CauchyYy,
    /// The Cauchy shear stress.
    CauchyXy,
    /// The Cauchy stress across the sheet.
    CauchyZz,
    /// The larger principal Green–Lagrange strain in the plane.
    LargestPrincipalStrain,
    /// The Green–Lagrange strain along x.
    GreenLagrangeXx,
    /// The Green–Lagrange strain along y.
    GreenLagrangeYy,
    /// The Green–Lagrange shear strain E₁₂, half of the angle γ at small strains.
    GreenLagrangeXy,
    /// The larger principal stretch in the plane.
    LargerStretch,
    /// The smaller principal stretch in the plane.
    SmallerStretch,
    /// The thickness stretch λ₃.
    ThicknessStretch,
    /// The stored energy per reference volume.
    Energy,
}

/// A title, a quantity with its unit, and the value of a state and a displacement in mm.
type About = (&'static str, &'static str, fn(&LocalState, [f64; 2]) -> f64);

impl SheetField {
    /// All of them by the names that studies and files use.
    pub const NAMES: [(&'static str, Self); 18] = [
        ("displacement", Self::Displacement),
        ("displacement-x", Self::DisplacementX),
        ("displacement-y", Self::DisplacementY),
        ("von-mises", Self::VonMises),
        ("largest-principal-stress", Self::LargestPrincipalStress),
        ("smallest-principal-stress", Self::SmallestPrincipalStress),
        ("cauchy-xx", Self::CauchyXx),
        ("cauchy-yy", Self::CauchyYy),
        ("cauchy-xy", Self::CauchyXy),
        ("cauchy-zz", Self::CauchyZz),
        ("largest-principal-strain", Self::LargestPrincipalStrain),
        ("green-lagrange-xx", Self::GreenLagrangeXx),
        ("green-lagrange-yy", Self::GreenLagrangeYy),
        ("green-lagrange-xy", Self::GreenLagrangeXy),
        ("stretch-1", Self::LargerStretch),
        ("stretch-2", Self::SmallerStretch),
        ("thickness-stretch", Self::ThicknessStretch),
        ("energy", Self::Energy),
    ];

    #[rustfmt::skip]
    fn about(self) -> About {
        match self {
            Self::Displacement => ("Displacement", "displacement [mm]", |_, [ux, uy]| ux.hypot(uy)),
            Self::DisplacementX => ("Displacement along x", "ux [mm]", |_, [ux, _]| ux),
            Self::DisplacementY => ("Displacement along y", "uy [mm]", |_, [_, uy]| uy),
            Self::VonMises => ("Von Mises stress", "von Mises stress [MPa]", |state, _| state.von_mises()),
            Self::LargestPrincipalStress => ("Largest principal Cauchy stress", "in the plane [MPa]", |state, _| state.principal_cauchy()[0]),
            Self::SmallestPrincipalStress => ("Smallest principal Cauchy stress", "in the plane [MPa]", |state, _| state.principal_cauchy()[1]),
            Self::CauchyXx => ("Cauchy stress along x", "σxx [MPa]", |state, _| state.cauchy[0]),
            Self::CauchyYy => ("Cauchy stress along y", "σyy [MPa]", |state, _| state.cauchy[1]),
            Self::CauchyXy => ("Cauchy shear stress", "σxy [MPa]", |state, _| state.cauchy[3]),
            Self::CauchyZz => ("Cauchy stress across the sheet", "σzz [MPa]", |state, _| state.cauchy[2]),
            Self::LargestPrincipalStrain => ("Largest principal Green–Lagrange strain", "in the plane [–]", |state, _| state.largest_principal_strain()),
            Self::GreenLagrangeXx => ("Green–Lagrange strain along x", "Exx [–]", |state, _| state.green_lagrange[0]),
            Self::GreenLagrangeYy => ("Green–Lagrange strain along y", "Eyy [–]", |state, _| state.green_lagrange[1]),
            Self::GreenLagrangeXy => ("Green–Lagrange shear strain", "Exy [–]", |state, _| state.green_lagrange[3]),
            Self::LargerStretch => ("Larger principal stretch", "λ₁ [–]", |state, _| state.stretches[0]),
            Self::SmallerStretch => ("Smaller principal stretch", "λ₂ [–]", |state, _| state.stretches[1]),
            Self::ThicknessStretch => ("Thickness stretch", "λ₃ [–]", |state, _| state.stretches[2]),
            Self::Energy => ("Stored energy per volume at rest", "energy [mJ/mm³]", |state, _| state.energy),
        }
    }

    /// Its title in a picture.
    pub fn title(self) -> &'static str {
        self.about().0
    }

    /// What it is on an axis, with its unit.
    pub fn quantity(self) -> &'static str {
        self.about().1
    }

    /// The dimension of its values.
    pub fn dimension(self) -> Dimension {
        match self.quantity() {
            quantity if quantity.ends_with("[mm]") => Dimension::Length,
            quantity if quantity.ends_with("[–]") => Dimension::Ratio,
            _ => Dimension::Stress,
        }
    }

    /// Its value where the sheet has a state and a displacement in mm.
    pub fn value(self, state: &LocalState, displacement: [f64; 2]) -> f64 {
        self.about().2(state, displacement)
    }
}

/// A model with the data that determine its stresses.
pub struct Deformed<'a> {
    /// Its name.
    pub label: String,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Its displacement fields: the present one last, preceded by those that a law with a memory remembers.
    pub fields: Vec<&'a [f64]>,
    /// The viscous part of the first Piola–Kirchhoff stress at the nodes in MPa; empty where there is none.
    pub viscous: &'a [[f64; 4]],
}

impl<'a> Deformed<'a> {
    /// The model of an elastic material.
    pub fn elastic(label: impl Into<String>, mesh: &'a Mesh, fields: Vec<&'a [f64]>) -> Self {
        Self {
            label: label.into(),
            mesh,
            fields,
            viscous: &[],
        }
    }
}

/// What pictures show of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownFields {
    /// One picture for each.
    pub fields: Vec<SheetField>,
    /// Lower and upper end of the colour bar, in the unit of the field; else all values.
    pub range: Option<[f64; 2]>,
    /// The heading of each picture, else what it shows.
    pub title: Option<String>,
}

impl ShownFields {
    /// The same with both components of the displacement before the other fields.
    #[must_use]
    pub fn with_displacements(&self) -> Self {
        let mut fields = vec![SheetField::DisplacementX, SheetField::DisplacementY];
        let others = self.fields.iter().filter(|field| !fields.contains(field));
        let others: Vec<SheetField> = others.copied().collect();
        fields.extend(others);
        Self {
            fields,
            ..self.clone()
        }
    }
}

/// One picture for each field: the models side by side. `file` makes the name of a file from that of a field, and
/// `at` describes the position on the path.
pub fn sheet_figures(
    shown: &ShownFields,
    laws: SheetLaws,
    models: &[Deformed],
    at: &str,
    file: &dyn Fn(&str) -> String,
) -> Vec<Figure> {
    let sheets: Vec<NodalSheet> = models
        .iter()
        .map(|model| NodalSheet::new(laws, model.mesh, &model.fields, model.viscous))
        .collect();
    let figure = |field: &SheetField| {
        let panel = |(model, sheet): (&Deformed, &NodalSheet)| {
            let u = sheet.displacement.vectors();
            let u: Vec<[f64; 2]> = u.collect();
            let value = |node: usize| field.value(&sheet.states[node], u[node]);
            Panel::at_nodes(&model.label, &sheet.mesh, &sheet.displacement, &value)
        };
        let title = field.title();
        let panels = models.iter().zip(&sheets).map(panel);
        let heading = shown.title.clone();
        let heading = heading.unwrap_or_else(|| format!("{title} at {at}"));
        let drawing = FieldFigure {
            range: shown.range,
            ..FieldFigure::new(heading, field.quantity(), panels)
        };
        let caption = format!(
            "{title} at {at}; values at the nodes are means over the adjacent cells. An arrow at the end of the colours: single places, as at \
             corners, exceed the scale."
        );
        let name = name_of(&SheetField::NAMES, *field).replace('-', "_");
        Figure::new(file(&name), caption, drawing)
    };
    let fields = shown.fields.iter().filter(|_| !models.is_empty());
    fields.map(figure).collect()
}
