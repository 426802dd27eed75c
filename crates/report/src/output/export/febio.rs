//! The `.feb` file of FEBio 4.
//!
//! The sheet is one layer of solids over half its thickness, whose lower face is the middle of the sheet and is
//! held along z; the upper face is free. A column of nodes stands on each node of the sheet: two of them at linear
//! cells and on the mid-sides of quadratic ones, three elsewhere.
//!
//! # References
//! S. A. Maas et al., FEBio User's Manual 4.x; `FEBioMech` in <https://github.com/febiosoftware/FEBio>

use std::collections::BTreeSet;

use super::model::{Constraint, Model, PartMaterial};
use super::text::{FORCE, MID_PLANE, TURNED, ascii, number};
use super::xml::Xml;
use crate::material::CodeLaw;
use crate::mesh::CellShape;

mod columns;
mod curves;

use columns::Columns;
use curves::Curves;

/// Steps of time within a load factor to begin with.
const TIME_STEPS: u32 = 10;

/// The input file of a model.
pub fn write(model: &Model) -> String {
    let columns = Columns::new(model);
    let mut file = Xml::new();
    for line in std::iter::once(ascii(model.given.title)).chain(model.head()) {
        file.comment(&line);
    }
    file.within("febio_spec", &[("version", "4.0")], |file| {
        file.empty("Module", &[("type", "solid")]);
        file.within("Material", &[], |file| {
            for (part, id) in model.materials.iter().zip(1..) {
                material(part, id, file);
            }
        });
        mesh(model, &columns, file);
        let mut curves = Curves::default();
        boundary(model, &columns, &mut curves, file);
        loads(model, &columns, file);
        steps(model, file);
        curves.write(model, file);
        file.within("Output", &[], output);
    });
    file.finish()
}

fn output(file: &mut Xml) {
    file.within("plotfile", &[("type", "febio")], |file| {
        for quantity in ["displacement", "stress", "reaction forces"] {
            file.empty("var", &[("type", quantity)]);
        }
    });
    file.within("logfile", &[], |file| {
        file.empty("node_data", &[("data", "x;y;z;ux;uy;uz"), ("delim", ",")]);
    });
}

/// The law with its parameters, and axes of which the first lies along its direction where it has one.
fn material(material: &PartMaterial, id: usize, file: &mut Xml) {
    let CodeLaw::Named {
        keyword,
        parameters,
        directions,
    } = &material.law
    else {
        unreachable!("FEBio has no law of a tension curve");
    };
    let (id, name) = (id.to_string(), material.name.to_lowercase());
    let attributes = [("id", &*id), ("name", &*name), ("type", keyword.as_str())];
    file.within("material", &attributes, |file| {
        for (name, value) in parameters {
            file.text(name, &[], &number(*value));
        }
        if let [[x, y], ..] = directions[..] {
            file.within("mat_axis", &[("type", "vector")], |file| {
                file.text("a", &[], &format!("{},{},0", number(x), number(y)));
                file.text("d", &[], &format!("{},{},0", number(-y), number(x)));
            });
        }
    });
}

fn solid_name(shape: CellShape) -> &'static str {
    match shape {
        CellShape::Triangle3 => "penta6",
        CellShape::Triangle6 => "penta15",
        CellShape::Quad4 => "hex8",
        CellShape::Quad8 => "hex20",
        CellShape::Quad9 => "hex27",
    }
}

fn list(numbers: impl IntoIterator<Item = usize>) -> String {
    let numbers: Vec<_> = numbers
        .into_iter()
        .map(|number| number.to_string())
        .collect();
    numbers.join(",")
}

/// Cells of one kind and one material.
struct Domain {
    name: String,
    shape: CellShape,
    material: String,
    cells: Vec<usize>,
}

fn domains(model: &Model) -> Vec<Domain> {
    let domain = |part: &PartMaterial, shape: CellShape| {
        let cells = part.cells.iter().copied();
        let cells: Vec<usize> = cells.filter(|cell| model.cells[*cell].0 == shape).collect();
        let kind = solid_name(shape);
        (!cells.is_empty()).then(|| Domain {
            name: match model.materials.len() {
                1 => kind.to_owned(),
                _ => format!("{kind}_{}", part.set),
            },
            shape,
            material: part.name.to_lowercase(),
            cells,
        })
    };
    let of_material = |part| CellShape::NAMES.map(|(_, shape)| domain(part, shape));
    let all = model.materials.iter().flat_map(of_material);
    all.flatten().collect()
}

fn mesh(model: &Model, columns: &Columns, file: &mut Xml) {
    let domains = domains(model);
    file.within("Mesh", &[], |file| {
        nodes(model, columns, file);
        for domain in &domains {
            let attributes = [("type", solid_name(domain.shape)), ("name", &*domain.name)];
            file.within("Elements", &attributes, |file| {
                for cell in &domain.cells {
                    let (id, (shape, nodes)) = ((cell + 1).to_string(), model.cells[*cell]);
                    file.text("elem", &[("id", &id)], &list(columns.solid(shape, nodes)));
                }
            });
        }
        sets(model, columns, file);
    });
    file.within("MeshDomains", &[], |file| {
        for Domain { name, material, .. } in &domains {
            file.empty("SolidDomain", &[("name", name), ("mat", material)]);
        }
    });
}

fn nodes(model: &Model, columns: &Columns, file: &mut Xml) {
    let half = model.given.problem.thickness / 2.0;
    file.within("Nodes", &[("name", "sheet")], |file| {
        for (node, column) in &columns.0 {
            let [x, y] = model.given.mesh.nodes[*node].map(number);
            for (level, id) in column.iter().enumerate() {
                let z = number(half * level as f64 / (column.len() - 1) as f64);
                file.text("node", &[("id", &id.to_string())], &format!("{x},{y},{z}"));
            }
        }
    });
}

/// Node sets and surfaces.
fn sets(model: &Model, columns: &Columns, file: &mut Xml) {
    let middle = list(columns.0.values().map(|column| column[0]));
    file.text("NodeSet", &[("name", MID_PLANE)], &middle);
    for (name, nodes) in &model.sets {
        file.text("NodeSet", &[("name", name)], &list(columns.all(nodes)));
    }
    let nodes = turned(model).flat_map(|held| &model.sets[held.set].1);
    for node in nodes.collect::<BTreeSet<_>>() {
        let name = turned_set(*node);
        file.text("NodeSet", &[("name", &name)], &list(columns.all(&[*node])));
    }
    for (number, (node, share, _)) in node_forces(model, columns).into_iter().enumerate() {
        let column = columns.0[&node][share].to_string();
        file.text("NodeSet", &[("name", &force_set(number))], &column);
    }
    for (name, sides) in &model.surfaces {
        file.within("Surface", &[("name", name)], |file| {
            for (number, (cell, side)) in sides.iter().enumerate() {
                let (shape, nodes) = model.cells[*cell];
                let edges = shape.edges();
                let edge: Vec<_> = edges[*side].iter().map(|at| nodes[*at]).collect();
                let (kind, face) = columns.face(shape, &edge);
                let id = (number + 1).to_string();
                file.text(kind, &[("id", &id)], &list(face));
            }
        });
    }
}

fn turned<'a>(model: &'a Model) -> impl Iterator<Item = &'a Constraint> {
    model.held.iter().filter(|held| held.uniform().is_none())
}

fn turned_set(node: usize) -> String {
    format!("{TURNED}{}", node + 1)
}

fn force_set(number: usize) -> String {
    format!("{FORCE}{}", number + 1)
}

/// Dead forces in N on the half sheet: node of the sheet, place in its column, force.
fn node_forces(model: &Model, columns: &Columns) -> Vec<(usize, usize, [f64; 2])> {
    let mut forces = Vec::new();
    for (node, force) in &model.forces {
        for (position, share) in columns.shares(model, *node).iter().enumerate() {
            forces.push((*node, position, force.map(|force| 0.5 * share * force)));
        }
    }
    forces
}

fn boundary(model: &Model, columns: &Columns, curves: &mut Curves, file: &mut Xml) {
    let axes = ["x", "y"];
    file.within("Boundary", &[], |file| {
        fixed(MID_PLANE, "z", file);
        for held in &model.held {
            let (name, nodes) = &model.sets[held.set];
            let axis = axes[held.axis];
            match held.uniform() {
                Some(0.0) => fixed(name, axis, file),
                Some(displacement) => prescribed(name, axis, displacement, 1, file),
                None => {
                    for node in nodes.iter().filter(|node| columns.0.contains_key(node)) {
                        let curve = curves.turn(model, held, *node);
                        prescribed(&turned_set(*node), axis, 1.0, curve, file);
                    }
                }
            }
        }
    });
}

/// A condition along an axis of a set of nodes.
fn condition(set: &str, axis: &str, kind: &str, file: &mut Xml, content: impl FnOnce(&mut Xml)) {
    let name = format!("{set}_{axis}");
    let attributes = [("name", &*name), ("node_set", set), ("type", kind)];
    file.within("bc", &attributes, content);
}

fn fixed(set: &str, axis: &str, file: &mut Xml) {
    condition(set, axis, "zero displacement", file, |file| {
        for each in ["x", "y", "z"] {
            let held = if each == axis { "1" } else { "0" };
            file.text(&format!("{each}_dof"), &[], held);
        }
    });
}

fn prescribed(set: &str, axis: &str, value: f64, curve: usize, file: &mut Xml) {
    condition(set, axis, "prescribed displacement", file, |file| {
        file.text("dof", &[], axis);
        file.text("value", &[("lc", &curve.to_string())], &number(value));
        file.text("relative", &[], "0");
    });
}

fn loads(model: &Model, columns: &Columns, file: &mut Xml) {
    let forces = node_forces(model, columns);
    if forces.is_empty() && model.pressures.is_empty() {
        return;
    }
    file.within("Loads", &[], |file| {
        for (number_of, (_, _, [x, y])) in forces.into_iter().enumerate() {
            let set = force_set(number_of);
            let attributes = [
                ("name", &*set),
                ("node_set", &*set),
                ("type", "nodal_force"),
            ];
            let value = format!("{},{},0", number(x), number(y));
            file.within("nodal_load", &attributes, |file| {
                file.text("value", &[("lc", "1")], &value);
                file.text("relative", &[], "0");
            });
        }
        for (surface, pressure) in &model.pressures {
            let name = &*model.surfaces[*surface].0;
            let attributes = [("name", name), ("surface", name), ("type", "pressure")];
            file.within("surface_load", &attributes, |file| {
                file.text("pressure", &[("lc", "1")], &number(*pressure));
                file.text("linear", &[], "0");
            });
        }
    });
}

/// One step for each load factor; the time is the load factor without its sign.
fn steps(model: &Model, file: &mut Xml) {
    file.within("Step", &[], |file| {
        let mut before = 0.0_f64;
        for (index, factor) in model.given.factors.iter().enumerate() {
            let size = (factor - before).abs() / f64::from(TIME_STEPS);
            let (id, name) = ((index + 1).to_string(), format!("load factor {factor}"));
            file.within("step", &[("id", &id), ("name", &name)], |file| {
                file.within("Control", &[], |file| control(size, file));
            });
            before = *factor;
        }
    });
}

/// How a step is computed, in steps of time of one size to begin with.
fn control(size: f64, file: &mut Xml) {
    file.text("analysis", &[], "STATIC");
    file.text("time_steps", &[], &TIME_STEPS.to_string());
    file.text("step_size", &[], &number(size));
    file.text("plot_level", &[], "PLOT_STEP_FINAL");
    file.within("time_stepper", &[("type", "default")], |file| {
        for (name, value) in [
            ("max_retries", 10.0),
            ("opt_iter", 15.0),
            ("dtmin", size * 1e-4),
            ("dtmax", size),
        ] {
            file.text(name, &[], &number(value));
        }
    });
    file.within("solver", &[("type", "solid")], |file| {
        file.text("symmetric_stiffness", &[], "symmetric");
        file.within("qn_method", &[("type", "BFGS")], |file| {
            file.text("max_ups", &[], "0");
        });
    });
}
