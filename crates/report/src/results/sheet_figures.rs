//! Pictures of stress and strain, of several models side by side.

use super::nodal_sheet::NodalSheet;
use super::{FieldFigure, Figure, LocalState, Panel};
use crate::document::name_of;
use crate::mesh::Mesh;
use crate::problem::SheetLaws;

/// A quantity of a sheet that follows from its displacement field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetField {
    /// Von Mises' equivalent Cauchy stress.
    VonMises,
    /// The larger principal Cauchy stress in the plane.
    LargestPrincipalStress,
    /// The larger principal Green–Lagrange strain in the plane.
    LargestPrincipalStrain,
    /// The thickness stretch λ₃.
    ThicknessStretch,
}

impl SheetField {
    /// All of them by the names that studies and files use.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("von-mises", Self::VonMises),
        ("largest-principal-stress", Self::LargestPrincipalStress),
        ("largest-principal-strain", Self::LargestPrincipalStrain),
        ("thickness-stretch", Self::ThicknessStretch),
    ];

    /// Its title in a picture, and its unit.
    fn title(self) -> (&'static str, &'static str) {
        match self {
            Self::VonMises => ("Von Mises stress", "von Mises stress [MPa]"),
            Self::LargestPrincipalStress => {
                ("Largest principal Cauchy stress", "in the plane [MPa]")
            }
            Self::LargestPrincipalStrain => (
                "Largest principal Green–Lagrange strain",
                "in the plane [–]",
            ),
            Self::ThicknessStretch => ("Thickness stretch", "λ₃ [–]"),
        }
    }

    fn value(self, state: &LocalState) -> f64 {
        match self {
            Self::VonMises => state.von_mises(),
            Self::LargestPrincipalStress => state.principal_cauchy()[0],
            Self::LargestPrincipalStrain => state.largest_principal_strain(),
            Self::ThicknessStretch => state.stretches[2],
        }
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

/// One picture for each field: the models side by side. `file` makes the name of a file from that of a field, and
/// `at` describes the position on the path.
pub fn sheet_figures(
    fields: &[SheetField],
    laws: SheetLaws,
    models: &[Deformed],
    at: &str,
    file: &dyn Fn(&str) -> String,
) -> Vec<Figure> {
    let sheets: Vec<NodalSheet> = models
        .iter()
        .map(|own| NodalSheet::new(laws, own.mesh, &own.fields, own.viscous))
        .collect();
    let figure = |field: &SheetField| {
        let panel = |(own, sheet): (&Deformed, &NodalSheet)| {
            let value = |node: usize| field.value(&sheet.states[node]);
            Panel::at_nodes(&own.label, &sheet.mesh, &sheet.displacement, &value)
        };
        let (title, quantity) = field.title();
        let panels = models.iter().zip(&sheets).map(panel);
        let drawing = FieldFigure::new(format!("{title} at {at}"), quantity, panels);
        let caption = format!(
            "{title} at {at}; values at the nodes are means over the adjacent cells. An arrow at the end of the colours: single places, as at \
             corners, exceed the scale."
        );
        let name = name_of(&SheetField::NAMES, *field).replace('-', "_");
        Figure::new(file(&name), caption, drawing)
    };
    let fields = fields.iter().filter(|_| !models.is_empty());
    fields.map(figure).collect()
}
