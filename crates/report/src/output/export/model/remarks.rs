//! Where a file differs from the study, and the remarks at its head.

use super::{Model, PartMaterial};
use crate::material::{Code, CodeLaw};
use crate::mesh::CellShape;
use crate::output::export::text::{ascii, number};

/// Thickness over the smaller extent from which on a layer of solids is worth a remark.
const THICK: f64 = 0.01;
/// A smaller extent in mm at which absolute tolerances may matter.
const SMALL: f64 = 0.1;

impl Model<'_> {
    /// Where the file differs from the study, in ASCII.
    pub fn remarks(&self) -> Vec<String> {
        let code = self.code.name();
        let mut remarks = self.of_cells();
        for material in self.materials.iter().filter(|_| self.code != Code::Abaqus) {
            let of = match self.materials.len() {
                1 => String::new(),
                _ => format!(" of the card `{}`", material.card.name),
            };
            remarks.push(format!(
                "{code} has no incompressible sheet: the bulk modulus{of} is {} MPa, {} times the initial shear modulus",
                number(self.given.bulk_modulus(self.code, material.card)),
                self.given.bulk_ratio
            ));
        }
        if !self.pressures.is_empty() {
            remarks.push(match self.code {
                Code::Abaqus => "the pressure of gelbench acts on the thickness at rest; check whether that of your code acts on the deformed thickness".into(),
                Code::CalculiX | Code::FeBio => format!(
                    "{code} applies the pressure to the deformed thickness, gelbench to the thickness at rest: the forces differ by the thickness \
                     stretch at the loaded edge"
                ),
            });
        }
        remarks.extend(self.of_solids());
        remarks.extend(self.of_reactions());
        if self.smaller_extent() < SMALL {
            remarks.push(
                "lengths are in mm: codes with absolute tolerances may refuse so small a body; scale all lengths (stresses stay, forces grow with \
                 the square)"
                    .into(),
            );
        }
        let mut materials = self.materials.iter();
        if materials.any(|material| !material.card.viscosity.is_none()) {
            remarks.push(
                "the card's [viscosity] is left out: the file contains the long-term law only"
                    .into(),
            );
        }
        let mut materials = self.materials.iter();
        if materials.any(|material| material.law == CodeLaw::TensionCurve) {
            remarks.push("the law depends on the first invariant alone and is exported as Marlow's law with points of its tension curve".into());
        }
        remarks
    }

    /// The lines at the head of every file.
    pub fn head(&self) -> Vec<String> {
        let mut lines = vec![
            format!("written by gelbench {}", env!("CARGO_PKG_VERSION")),
            format!("units: mm, N, MPa = N/mm^2, mJ; {}", self.time()),
        ];
        for PartMaterial { card, set, .. } in &self.materials {
            let of = match self.materials.len() {
                1 => String::new(),
                _ => format!(" of {set}"),
            };
            let (name, law) = (&card.name, &card.law_name);
            lines.push(format!("material{of}: card {name}, law {law}"));
        }
        let sets = self.sets.iter().map(|(set, _)| set);
        let groups = self.groups.iter().zip(sets);
        let renamed = groups.filter(|(group, set)| group.to_ascii_uppercase() != **set);
        lines.extend(renamed.map(|(group, set)| format!("set {set}: the group `{group}`")));
        lines.extend(
            self.remarks()
                .into_iter()
                .map(|line| format!("remark: {line}")),
        );
        lines.into_iter().map(|line| ascii(&line)).collect()
    }

    /// What the total time is.
    fn time(&self) -> &'static str {
        let factors = self.given.factors;
        let grow = |pair: &[f64]| pair[1].abs() > pair[0].abs();
        if !factors.windows(2).all(grow) {
            "the total time is the length of the path of load factors, each of which stands before its step"
        } else if factors[0] < 0.0 {
            "the total time is the load factor without its sign"
        } else {
            "the total time is the load factor"
        }
    }

    fn smaller_extent(&self) -> f64 {
        let [x, y] = self.given.mesh.size();
        x.min(y)
    }

    /// Where the cells differ.
    fn of_cells(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let has =
            |is_one: fn(CellShape) -> bool| self.cells.iter().any(|(shape, _)| is_one(*shape));
        let mesh = self.given.mesh;
        let nine = (0..mesh.cell_count()).any(|cell| mesh.shape(cell) == CellShape::Quad9);
        if nine && has(|shape| shape == CellShape::Quad8) {
            remarks.push(
                "nine-node quadrilaterals are exported as eight-node ones, without their middle nodes"
                    .into(),
            );
        }
        if self.code == Code::CalculiX && has(|shape| shape.degree() == 1) {
            remarks.push("CalculiX turns CPS3 and CPS4 into linear solids of its own: compare quadratic elements, or fine meshes".into());
        }
        remarks
    }

    /// The differences between a layer of solids and a sheet.
    fn of_solids(&self) -> Vec<String> {
        let (code, thickness) = (self.code.name(), self.given.problem.thickness);
        let mut remarks = Vec::new();
        if self.code != Code::Abaqus && thickness > THICK * self.smaller_extent() {
            remarks.push(format!(
                "{code} computes a layer of solids: its fields depart from those of a sheet as the thickness grows against the width (in a bent \
                 ring by 0.5 % of the displacement at a fifth of the wall, by 5 % at four fifths); to compare, export a thinner sheet with forces \
                 reduced alike"
            ));
        }
        if self.code == Code::FeBio {
            remarks.push(
                "the layer has half the thickness of the sheet: its reaction forces are half of the sheet's".into(),
            );
        }
        remarks
    }

    /// What printed sums of reactions contain besides.
    fn of_reactions(&self) -> Option<String> {
        let sets = || self.held.iter().map(|held| &self.sets[held.set]);
        let loaded = |node: &usize| {
            self.forces
                .iter()
                .any(|(loaded_node, _)| loaded_node == node)
        };
        let is_loaded = sets().any(|(_, nodes)| nodes.iter().any(loaded));
        let is_shared = sets().any(|(name, nodes)| {
            let mut others = sets().filter(|(other, _)| other != name);
            others.any(|(_, other)| nodes.iter().any(|node| other.binary_search(node).is_ok()))
        });
        (self.code != Code::FeBio && (is_loaded || is_shared)).then(|| {
            "sums of RF over a set include nodal loads on its nodes, and nodes of two sets count in both: gelbench's forces of groups leave out the \
             former and divide the latter"
                .to_owned()
        })
    }
}
