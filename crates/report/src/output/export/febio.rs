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
    file.open("febio_spec", &[("version", "4.0")]);
    file.empty("Module", &[("type", "solid")]);
    materials(model, &mut file);
    mesh(model, &columns, &mut file);
    let mut curves = Curves::default();
    boundary(model, &columns, &mut curves, &mut file);
    loads(model, &columns, &mut file);
    steps(model, &mut file);
    curves.write(model, &mut file);
    file.open("Output", &[]);
    file.open("plotfile", &[("type", "febio")]);
    file.empty("var", &[("type", "displacement")]);
    file.empty("var", &[("type", "stress")]);
    file.empty("var", &[("type", "reaction forces")]);
    file.close("plotfile");
    file.open("logfile", &[]);
    file.empty("node_data", &[("data", "x;y;z;ux;uy;uz"), ("delim", ",")]);
    file.close("logfile");
    file.close("Output");
    file.close("febio_spec");
    file.finish()
}

/// All materials.
fn materials(model: &Model, file: &mut Xml) {
    file.open("Material", &[]);
    for (part, id) in model.materials.iter().zip(1..) {
        material(part, id, file);
    }
    file.close("Material");
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
    file.open(
        "material",
        &[("id", &id), ("name", &name), ("type", keyword)],
    );
    for (name, value) in parameters {
        file.text(name, &[], &number(*value));
    }
    if let [[x, y], ..] = directions[..] {
        file.open("mat_axis", &[("type", "vector")]);
        file.text("a", &[], &format!("{},{},0", number(x), number(y)));
        file.text("d", &[], &format!("{},{},0", number(-y), number(x)));
        file.close("mat_axis");
    }
    file.close("material");
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
    let half = model.given.problem.thickness / 2.0;
    file.open("Mesh", &[]);
    file.open("Nodes", &[("name", "sheet")]);
    for (node, column) in &columns.0 {
        let [x, y] = model.given.mesh.nodes[*node].map(number);
        for (level, id) in column.iter().enumerate() {
            let z = number(half * level as f64 / (column.len() - 1) as f64);
            file.text("node", &[("id", &id.to_string())], &format!("{x},{y},{z}"));
        }
    }
    file.close("Nodes");
    let domains = domains(model);
    for domain in &domains {
        let kind = solid_name(domain.shape);
        file.open("Elements", &[("type", kind), ("name", &domain.name)]);
        for cell in &domain.cells {
            let (id, (shape, nodes)) = ((cell + 1).to_string(), model.cells[*cell]);
            file.text("elem", &[("id", &id)], &list(columns.solid(shape, nodes)));
        }
        file.close("Elements");
    }
    sets(model, columns, file);
    file.close("Mesh");
    file.open("MeshDomains", &[]);
    for Domain { name, material, .. } in &domains {
        file.empty("SolidDomain", &[("name", name), ("mat", material)]);
    }
    file.close("MeshDomains");
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
        let name = force_set(number);
        file.text(
            "NodeSet",
            &[("name", &name)],
            &columns.0[&node][share].to_string(),
        );
    }
    for (name, sides) in &model.surfaces {
        file.open("Surface", &[("name", name)]);
        for (number, (cell, side)) in sides.iter().enumerate() {
            let (shape, nodes) = model.cells[*cell];
            let edge: Vec<_> = shape.edges()[*side]
                .iter()
                .map(|position| nodes[*position])
                .collect();
            let (kind, face) = columns.face(shape, &edge);
            file.text(kind, &[("id", &(number + 1).to_string())], &list(face));
        }
        file.close("Surface");
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
    file.open("Boundary", &[]);
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
    file.close("Boundary");
}

/// Opens a condition on an axis of a node set.
fn open_condition(set: &str, axis: &str, kind: &str, file: &mut Xml) {
    let name = format!("{set}_{axis}");
    file.open("bc", &[("name", &name), ("node_set", set), ("type", kind)]);
}

fn fixed(set: &str, axis: &str, file: &mut Xml) {
    open_condition(set, axis, "zero displacement", file);
    for each in ["x", "y", "z"] {
        let held = if each == axis { "1" } else { "0" };
        file.text(&format!("{each}_dof"), &[], held);
    }
    file.close("bc");
}

fn prescribed(set: &str, axis: &str, value: f64, curve: usize, file: &mut Xml) {
    open_condition(set, axis, "prescribed displacement", file);
    file.text("dof", &[], axis);
    file.text("value", &[("lc", &curve.to_string())], &number(value));
    file.text("relative", &[], "0");
    file.close("bc");
}

fn loads(model: &Model, columns: &Columns, file: &mut Xml) {
    let forces = node_forces(model, columns);
    if forces.is_empty() && model.pressures.is_empty() {
        return;
    }
    file.open("Loads", &[]);
    for (number_of, (_, _, [x, y])) in forces.into_iter().enumerate() {
        let set = force_set(number_of);
        file.open(
            "nodal_load",
            &[("name", &set), ("node_set", &set), ("type", "nodal_force")],
        );
        file.text(
            "value",
            &[("lc", "1")],
            &format!("{},{},0", number(x), number(y)),
        );
        file.text("relative", &[], "0");
        file.close("nodal_load");
    }
    for (surface, pressure) in &model.pressures {
        let name = &model.surfaces[*surface].0;
        file.open(
            "surface_load",
            &[("name", name), ("surface", name), ("type", "pressure")],
        );
        file.text("pressure", &[("lc", "1")], &number(*pressure));
        file.text("linear", &[], "0");
        file.close("surface_load");
    }
    file.close("Loads");
}

/// One step for each load factor; the time is the load factor without its sign.
fn steps(model: &Model, file: &mut Xml) {
    file.open("Step", &[]);
    let mut before = 0.0;
    for (index, factor) in model.given.factors.iter().enumerate() {
        let id = (index + 1).to_string();
        let size = (factor - before).abs() / f64::from(TIME_STEPS);
        file.open(
            "step",
            &[("id", &id), ("name", &format!("load factor {factor}"))],
        );
        file.open("Control", &[]);
        file.text("analysis", &[], "STATIC");
        file.text("time_steps", &[], &TIME_STEPS.to_string());
        file.text("step_size", &[], &number(size));
        file.text("plot_level", &[], "PLOT_STEP_FINAL");
        file.open("time_stepper", &[("type", "default")]);
        for (name, value) in [
            ("max_retries", 10.0),
            ("opt_iter", 15.0),
            ("dtmin", size * 1e-4),
            ("dtmax", size),
        ] {
            file.text(name, &[], &number(value));
        }
        file.close("time_stepper");
        file.open("solver", &[("type", "solid")]);
        file.text("symmetric_stiffness", &[], "symmetric");
        file.open("qn_method", &[("type", "BFGS")]);
        file.text("max_ups", &[], "0");
        file.close("qn_method");
        file.close("solver");
        file.close("Control");
        file.close("step");
        before = *factor;
    }
    file.close("Step");
}
