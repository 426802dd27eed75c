//! Pictures of stress and strain, of several models side by side.

use super::sheet::{Deformed, NodalSheet};
use super::{FieldFigure, Figure, LocalState, Panel};
use crate::document::name_of;
use crate::mesh::vectors;
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

/// A field, its name in studies and files, its title in a picture, its name on an axis with the unit, and its value at a state and a
/// displacement in mm.
type Description = (
    SheetField,
    &'static str,
    &'static str,
    &'static str,
    fn(&LocalState, [f64; 2]) -> f64,
);

impl SheetField {
    /// All fields in the order of their declaration.
    #[rustfmt::skip]
    const ALL: [Description; 18] = [
        (Self::Displacement, "displacement", "Displacement", "displacement [mm]", |_, [ux, uy]| ux.hypot(uy)),
        (Self::DisplacementX, "displacement-x", "Displacement along x", "ux [mm]", |_, [ux, _]| ux),
        (Self::DisplacementY, "displacement-y", "Displacement along y", "uy [mm]", |_, [_, uy]| uy),
        (Self::VonMises, "von-mises", "Von Mises stress", "von Mises stress [MPa]", |state, _| state.von_mises()),
        (Self::LargestPrincipalStress, "largest-principal-stress", "Largest principal Cauchy stress", "in the plane [MPa]", |state, _| state.principal_cauchy()[0]),
        (Self::SmallestPrincipalStress, "smallest-principal-stress", "Smallest principal Cauchy stress", "in the plane [MPa]", |state, _| state.principal_cauchy()[1]),
        (Self::CauchyXx, "cauchy-xx", "Cauchy stress along x", "σxx [MPa]", |state, _| state.cauchy[0]),
        (Self::CauchyYy, "cauchy-yy", "Cauchy stress along y", "σyy [MPa]", |state, _| state.cauchy[1]),
        (Self::CauchyXy, "cauchy-xy", "Cauchy shear stress", "σxy [MPa]", |state, _| state.cauchy[3]),
        (Self::CauchyZz, "cauchy-zz", "Cauchy stress across the sheet", "σzz [MPa]", |state, _| state.cauchy[2]),
        (Self::LargestPrincipalStrain, "largest-principal-strain", "Largest principal Green–Lagrange strain", "in the plane [–]", |state, _| state.largest_principal_strain()),
        (Self::GreenLagrangeXx, "green-lagrange-xx", "Green–Lagrange strain along x", "Exx [–]", |state, _| state.green_lagrange[0]),
        (Self::GreenLagrangeYy, "green-lagrange-yy", "Green–Lagrange strain along y", "Eyy [–]", |state, _| state.green_lagrange[1]),
        (Self::GreenLagrangeXy, "green-lagrange-xy", "Green–Lagrange shear strain", "Exy [–]", |state, _| state.green_lagrange[3]),
        (Self::LargerStretch, "stretch-1", "Larger principal stretch", "λ₁ [–]", |state, _| state.stretches[0]),
        (Self::SmallerStretch, "stretch-2", "Smaller principal stretch", "λ₂ [–]", |state, _| state.stretches[1]),
        (Self::ThicknessStretch, "thickness-stretch", "Thickness stretch", "λ₃ [–]", |state, _| state.stretches[2]),
        (Self::Energy, "energy", "Stored energy per volume at rest", "energy [mJ/mm³]", |state, _| state.energy),
    ];

    /// All fields by the names that studies and files use.
    pub const NAMES: [(&'static str, Self); 18] = {
        let mut names = [("", Self::Displacement); 18];
        let mut index = 0;
        while index < names.len() {
            let (field, name, ..) = Self::ALL[index];
            assert!(field as usize == index, "the order of the declaration");
            names[index] = (name, field);
            index += 1;
        }
        names
    };

    /// Its title in a picture.
    pub fn title(self) -> &'static str {
        Self::ALL[self as usize].2
    }

    /// Its name on an axis, with its unit.
    pub fn quantity(self) -> &'static str {
        Self::ALL[self as usize].3
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
        let (.., value) = Self::ALL[self as usize];
        value(state, displacement)
    }
}

/// The fields that pictures show of a sheet.
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
        .map(|model| NodalSheet::new(laws, model))
        .collect();
    let figure = |field: &SheetField| {
        let panel = |(model, sheet): (&Deformed, &NodalSheet)| {
            let u: Vec<[f64; 2]> = vectors(&sheet.displacement).collect();
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
