//! Pictures of stress and strain, of several models side by side.

use super::{FieldFigure, Figure, LocalState, Panel, nodal_states};
use crate::document::name_of;
use crate::material::HyperelasticLaw;
use crate::mesh::Mesh;

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
    law: &dyn HyperelasticLaw,
    models: &[Deformed],
    at: &str,
    file: &dyn Fn(&str) -> String,
) -> Vec<Figure> {
    let states: Vec<Vec<LocalState>> = models
        .iter()
        .map(|own| nodal_states(law, own.mesh, &own.fields, own.viscous))
        .collect();
    let figure = |field: &SheetField| {
        let panel = |(own, states): (&Deformed, &Vec<LocalState>)| {
            let u = own.fields.last().copied().unwrap_or_default();
            Panel::at_nodes(&own.label, own.mesh, u, &|node| field.value(&states[node]))
        };
        let (title, quantity) = field.title();
        let panels = models.iter().zip(&states).map(panel);
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
