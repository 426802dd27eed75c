//! A problem in the terms that all codes share.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::text::{FIBRES, MATERIAL, Names, SPECIMEN};
use crate::error::Diagnostic;
use crate::material::{Card, Code, CodeLaw};
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, Drive, LONGEST_TURN, Load, Support};

mod remarks;

/// What is exported.
#[derive(Clone, Copy)]
pub struct Export<'a> {
    /// The heading.
    pub title: &'a str,
    /// Thickness, supports and loads.
    pub problem: &'a BoundaryProblem,
    /// The card of all cells that belong to no region.
    pub card: &'a Card,
    /// The cards of the problem's regions, with their names.
    pub regions: &'a [(String, Card)],
    /// The finite elements.
    pub mesh: &'a Mesh,
    /// Load factors, in the order in which they are reached.
    pub factors: &'a [f64],
    /// Bulk modulus over the initial shear modulus, for codes that know no incompressible sheet.
    pub bulk_ratio: f64,
}

impl Export<'_> {
    /// The bulk modulus in MPa that approximates incompressibility; infinite where the code has incompressible sheets.
    fn bulk_modulus(&self, code: Code, card: &Card) -> f64 {
        match code {
            Code::Abaqus => f64::INFINITY,
            _ => self.bulk_ratio * card.law.shear_modulus(),
        }
    }

    fn law(&self, code: Code, card: &Card) -> Result<CodeLaw, Diagnostic> {
        if card.bulk_modulus().is_some() {
            let message = format!(
                "the card `{}` is compressible; only incompressible sheets can be exported",
                card.name
            );
            let hint = match card.volume {
                Some(_) => "leave out the card's `[volume]`",
                None => "take a card whose law is incompressible",
            };
            return Err(Diagnostic::error("", message).hint(hint));
        }
        if card.law.softening().is_some() && code != Code::Abaqus {
            let message = format!(
                "{} has no softening equivalent to that of the card `{}`",
                code.name(),
                card.name
            );
            let hint = "export to Abaqus, which has it (*MULLINS EFFECT), or leave out the card's `[softening]`";
            return Err(Diagnostic::error("", message).hint(hint));
        }
        let law = card.law.in_code(code, self.bulk_modulus(code, card));
        let known = law.filter(|law| code == Code::Abaqus || *law != CodeLaw::TensionCurve);
        known.ok_or_else(|| {
            let name = code.name();
            let message = format!("{name} has no law equivalent to `{}` of the card `{}`", card.law_name, card.name);
            Diagnostic::error("", message).hint(format!(
                "it has {}; fit such a card to the same data, as with `gelbench materials fit DATA.csv --law ogden-2`",
                code.laws()
            ))
        })
    }
}

/// The problem in the terms that all codes share; nodes and cells are numbered as in the mesh.
pub struct Model<'a> {
    pub given: &'a Export<'a>,
    pub code: Code,
    /// The materials of the cells.
    pub materials: Vec<PartMaterial<'a>>,
    /// Kind and nodes of the cells; those in the middle of quadrilaterals only where the code knows them.
    pub cells: Vec<(CellShape, &'a [usize])>,
    /// The nodes of the cells, ascending.
    pub nodes: Vec<usize>,
    /// Node sets by name.
    pub sets: Vec<(String, Vec<usize>)>,
    /// The groups of the mesh: the first sets are theirs, one each.
    groups: Vec<&'a str>,
    /// Parts of the boundary by name: cell and side within it.
    pub surfaces: Vec<(String, Vec<Side>)>,
    pub held: Vec<Constraint>,
    /// Unknowns that follow others: those of grips with a given force, and of nodes that slide along inclined lines.
    pub ties: Vec<Tie>,
    /// Dead nodal forces in N at load factor 1.
    pub forces: Vec<(usize, [f64; 2])>,
    /// Pressures in MPa at load factor 1, by the number of their surface.
    pub pressures: Vec<(usize, f64)>,
}

/// A material and the cells that it fills.
pub struct PartMaterial<'a> {
    pub card: &'a Card,
    pub law: CodeLaw,
    /// Its name.
    pub name: String,
    /// The name of the axes of its fibres.
    pub axes: String,
    /// The name of the set of its cells.
    pub set: String,
    /// Its cells, ascending.
    pub cells: Vec<usize>,
}

impl<'a> PartMaterial<'a> {
    /// The materials that have cells: one of all of them, or one of each region.
    fn all(given: &Export<'a>, code: Code, names: &mut Names) -> Result<Vec<Self>, Diagnostic> {
        let regions = given.regions.iter().map(|(name, card)| (&**name, card));
        let laws = given.problem.laws().in_cells(given.mesh);
        let mut all: Vec<Self> = Vec::new();
        for ((region, card), number) in std::iter::once(("rest", given.card))
            .chain(regions)
            .zip(0..)
        {
            let range = 0..given.mesh.cell_count();
            let cells: Vec<usize> = range.filter(|cell| laws.number(*cell) == number).collect();
            if cells.is_empty() {
                continue;
            }
            let (mut name, mut axes) = (MATERIAL.to_owned(), FIBRES.to_owned());
            if !all.is_empty() {
                name = format!("MATERIAL_{}", all.len() + 1);
                axes = format!("{FIBRES}_{}", all.len() + 1);
            }
            let set = if given.regions.is_empty() {
                SPECIMEN.to_owned()
            } else {
                names.give(&format!("{region}_cells"))
            };
            all.push(Self {
                law: given.law(code, card)?,
                card,
                name,
                axes,
                set,
                cells,
            });
        }
        Ok(all)
    }
}

/// A cell and the number of an edge within it.
pub type Side = (usize, usize);

/// A displacement that is a multiple of another one.
pub struct Tie {
    pub node: usize,
    pub axis: usize,
    /// Node and axis of the other one.
    pub follows: (usize, usize),
    /// The multiple.
    pub share: f64,
}

/// A component of displacement that a support prescribes on a node set.
pub struct Constraint {
    /// The number of its set.
    pub set: usize,
    pub axis: usize,
    pub support: Support,
}

impl Constraint {
    /// The displacement in mm at load factor 1 where it is the same for all nodes and grows with the factor; the others
    /// go out node by node.
    pub fn uniform(&self) -> Option<f64> {
        match self.support {
            Support::Displacement(displacement) => displacement[self.axis],
            Support::Roller => Some(0.0),
            Support::Grip(drives) => match drives[self.axis] {
                Drive::Displacement(displacement) => Some(displacement),
                Drive::Force(_) => None,
            },
            Support::LinearDisplacement(_) | Support::Radial { .. } | Support::Rotation { .. } => {
                None
            }
        }
    }

    /// The displacement of a node at a place, in mm.
    pub fn at(&self, position: [f64; 2], factor: f64) -> f64 {
        self.support
            .displacement(position, self.axis, factor)
            .unwrap_or_default()
    }
}

impl<'a> Model<'a> {
    /// Load factors on the way from one to another one, and that one: codes that lead every node of a step along a straight line
    /// would take the chord of a large turn.
    pub fn intermediate_factors(&self, before: f64, factor: f64) -> Vec<f64> {
        let turns = self.held.iter().map(|held| match held.support {
            Support::Rotation { angle, .. } => angle.abs(),
            _ => 0.0,
        });
        let turn = (factor - before).abs() * turns.fold(0.0, f64::max);
        let steps = (turn / LONGEST_TURN * (1.0 - 1e-9)).ceil().max(1.0) as usize;
        let between = (1..steps).map(|step| {
            let share = step as f64 / steps as f64;
            before + share * (factor - before)
        });
        between.chain([factor]).collect()
    }

    pub fn new(given: &'a Export<'a>, code: Code) -> Result<Self, Diagnostic> {
        let mesh = given.mesh;
        let all = || (0..mesh.cell_count()).map(|cell| (mesh.shape(cell), mesh.cell(cell)));
        // A nine-node face fits no six-node triangle's neighbour in space.
        let keeps = code == Code::FeBio && all().all(|(shape, _)| shape == CellShape::Quad9);
        let cells: Vec<_> = all()
            .map(|(shape, nodes)| match shape {
                CellShape::Quad9 if !keeps => (CellShape::Quad8, &nodes[..8]),
                _ => (shape, nodes),
            })
            .collect();
        let nodes: BTreeSet<usize> = cells
            .iter()
            .flat_map(|(_, nodes)| *nodes)
            .copied()
            .collect();
        let mut names = Names::default();
        let (mut sets, mut groups) = (Vec::new(), Vec::new());
        let (mut surfaces, mut group_surfaces) = (Vec::new(), BTreeMap::new());
        let sides = sides(&cells);
        for (group, content) in mesh.groups() {
            let members = content.nodes.iter().filter(|node| nodes.contains(node));
            let name = names.give(group);
            if !content.edges.is_empty() {
                group_surfaces.insert(group.as_str(), surfaces.len());
                let edges = content.edges.iter();
                let edges = edges.map(|edge| sides[&[edge[0], edge[1]]]).collect();
                surfaces.push((names.give(&format!("{name}_EDGES")), edges));
            }
            groups.push(group.as_str());
            sets.push((name, members.copied().collect()));
        }
        let mut model = Self {
            given,
            code,
            materials: PartMaterial::all(given, code, &mut names)?,
            cells,
            nodes: nodes.into_iter().collect(),
            sets,
            groups,
            surfaces,
            held: Vec::new(),
            ties: Vec::new(),
            forces: Vec::new(),
            pressures: Vec::new(),
        };
        model.hold(&mut names)?;
        model.tie()?;
        model.load(&group_surfaces)?;
        Ok(model)
    }

    /// Supports: on the set of their group, or on one of their own where another support replaces a part.
    fn hold(&mut self, names: &mut Names) -> Result<(), Diagnostic> {
        let held = self.given.problem.held_by(self.given.mesh)?;
        for (number, (group, support)) in self.given.problem.supports.iter().enumerate() {
            let group_set = self.groups.iter().position(|known| known == group);
            for axis in [0, 1] {
                let nodes = self.nodes.iter().copied();
                let held_nodes: Vec<usize> = nodes
                    .filter(|node| held.get(&(2 * node + axis)) == Some(&number))
                    .collect();
                if held_nodes.is_empty() {
                    continue;
                }
                let known = group_set
                    .filter(|set| self.sets[*set].1 == held_nodes)
                    .or_else(|| {
                        let mut sets = self.sets.iter();
                        sets.rposition(|(_, nodes)| *nodes == held_nodes)
                    });
                let set = known.unwrap_or_else(|| {
                    self.sets.push((names.give("HELD"), held_nodes));
                    self.sets.len() - 1
                });
                self.held.push(Constraint {
                    set,
                    axis,
                    support: *support,
                });
            }
        }
        Ok(())
    }

    /// Grips with a given force, whose nodes follow one of them, which takes the force; and nodes on inclined lines.
    fn tie(&mut self) -> Result<(), Diagnostic> {
        let ties = self.given.problem.ties(self.given.mesh)?;
        if self.code == Code::FeBio && !ties.is_empty() {
            let message = "a grip with a given force, or a roller along an inclined line, cannot be exported to FEBio";
            return Err(Diagnostic::error("support", message).hint(
                "give the grip a displacement, turn the mesh, or export to Abaqus or CalculiX",
            ));
        }
        let ties = ties.into_iter().map(|(unknown, tie)| Tie {
            node: unknown / 2,
            axis: unknown % 2,
            follows: (tie.master / 2, tie.master % 2),
            share: tie.share,
        });
        let known = ties.filter(|tie| self.nodes.binary_search(&tie.node).is_ok());
        self.ties = known.collect();
        Ok(())
    }

    fn load(&mut self, surfaces: &BTreeMap<&str, usize>) -> Result<(), Diagnostic> {
        let problem = self.given.problem;
        let mut forces = problem.dead_forces(self.given.mesh)?;
        for (unknown, tie) in problem.ties(self.given.mesh)? {
            forces[tie.master] += tie.share * std::mem::take(&mut forces[unknown]);
        }
        for (node, force) in forces.chunks_exact(2).enumerate() {
            if force == [0.0; 2] {
                continue;
            }
            if self.nodes.binary_search(&node).is_err() {
                let [x, y] = self.given.mesh.nodes[node];
                let message = format!(
                    "a force acts on the middle of a cell at ({x}, {y}) mm, where {} has no node",
                    self.code.name()
                );
                return Err(Diagnostic::error("load", message)
                    .hint("let it act on a group of the boundary"));
            }
            self.forces.push((node, [force[0], force[1]]));
        }
        for (group, load) in &problem.loads {
            if let Load::Pressure(pressure) = load {
                self.pressures.push((surfaces[group.as_str()], *pressure));
            }
        }
        Ok(())
    }
}

/// The edges of all cells by their ends, in the order that leaves the cell to the left.
fn sides(cells: &[(CellShape, &[usize])]) -> HashMap<[usize; 2], Side> {
    let mut sides = HashMap::new();
    for (cell, (shape, nodes)) in cells.iter().enumerate() {
        for (side, edge) in shape.edges().iter().enumerate() {
            sides.insert([nodes[edge[0]], nodes[edge[1]]], (cell, side));
        }
    }
    sides
}
