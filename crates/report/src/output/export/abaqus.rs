//! The `.inp` files of Abaqus and of CalculiX, which has taken over most of Abaqus' keywords.
//!
//! Both codes write Ogden's law as Σ 2 μ/α² (…) and a neo-Hookean volume energy as (J − 1)²/D₁, so that the bulk
//! modulus is K = 2/D₁. Abaqus' plane-stress elements are incompressible with D = 0. CalculiX turns them into solids
//! and needs a finite K; its eight-node elements go out with reduced integration (`CPS8R`). On a strip with a hole
//! under traction, Q2 serendipity at load factors 0.5 and 1, they were 0.22 and 0.14 % from the sheet, fully integrated
//! ones 0.48 and 0.30 %; under the other loads tried both were about equally far off.
//!
//! # References
//! Abaqus 2016 Analysis User's Guide, 22.5.1 and 22.5.3; G. Dhondt, CalculiX `CrunchiX` User's Manual 2.20, `*HYPERELASTIC`

use super::model::{Constraint, Model, PartMaterial};
use super::text::{ALL_NODES, FACTORS, SPECIMEN, ascii, number};
use crate::material::{Card, Code, CodeLaw, Softening};
use crate::mesh::CellShape;
use crate::problem::Support;

/// Lines of an input file.
#[derive(Default)]
struct Deck(String);

impl Deck {
    fn line(&mut self, line: &str) {
        self.0 += line;
        self.0.push('\n');
    }

    /// The numbers of nodes or cells, ten a line, counted from one.
    fn numbers(&mut self, numbers: &[usize]) {
        let numbers: Vec<String> = numbers
            .iter()
            .map(|index| (index + 1).to_string())
            .collect();
        for line in numbers.chunks(10) {
            self.line(&line.join(", "));
        }
    }
}

/// The input file of a model.
pub fn write(model: &Model) -> String {
    let given = model.given;
    let mut deck = Deck::default();
    deck.line("*HEADING");
    deck.line(&format!("gelbench: {}", ascii(given.title)));
    for line in model.head() {
        deck.line(&format!("** {line}"));
    }
    mesh(model, &mut deck);
    ties(model, &mut deck);
    for part in &model.materials {
        material(part, &mut deck);
        let orientation = orientation(part, &mut deck);
        deck.line(&format!(
            "*SOLID SECTION, ELSET={}, MATERIAL={}{orientation}",
            part.set, part.name
        ));
        deck.line(&number(given.problem.thickness));
    }
    if is_one_step(model) {
        one_step(model, &mut deck);
        return deck.0;
    }
    let mut before = 0.0;
    for factor in given.factors {
        for factor in model.intermediate_factors(before, *factor) {
            let times = [(factor - before).abs() / 5.0, (factor - before).abs()];
            step(model, times, factor, &mut deck);
            before = factor;
        }
    }
    deck.0
}

/// Whether all load factors can be of one step, because everything grows with the load factor. CalculiX finds no equilibrium in a second
/// step that moves supports and changes loads.
fn is_one_step(model: &Model) -> bool {
    let factors = model.given.factors;
    let grow = factors[0] > 0.0 && factors.windows(2).all(|pair| pair[0] < pair[1]);
    let turns = |held: &Constraint| matches!(held.support, Support::Rotation { .. });
    model.code == Code::CalculiX && factors.len() > 1 && grow && !model.held.iter().any(turns)
}

/// All load factors in one step, each a time at which results are written.
fn one_step(model: &Model, deck: &mut Deck) {
    let factors = model.given.factors;
    deck.line(&format!("*TIME POINTS, NAME={FACTORS}"));
    for factor in factors {
        deck.line(&number(*factor));
    }
    let last = factors[factors.len() - 1];
    step(model, [factors[0] / 5.0, last], last, deck);
}

fn mesh(model: &Model, deck: &mut Deck) {
    // Nearly incompressible solids on eight nodes are too stiff with all integration points.
    let eight = match model.code {
        Code::CalculiX => "CPS8R",
        _ => "CPS8",
    };
    deck.line(&format!("*NODE, NSET={ALL_NODES}"));
    for node in &model.nodes {
        let [x, y] = model.given.mesh.nodes[*node].map(number);
        deck.line(&format!("{}, {x}, {y}", node + 1));
    }
    for (shape, name) in [
        (CellShape::Triangle3, "CPS3"),
        (CellShape::Triangle6, "CPS6"),
        (CellShape::Quad4, "CPS4"),
        (CellShape::Quad8, eight),
    ] {
        let mut cells = model
            .cells
            .iter()
            .enumerate()
            .filter(|(_, (cell_shape, _))| *cell_shape == shape)
            .peekable();
        if cells.peek().is_some() {
            deck.line(&format!("*ELEMENT, TYPE={name}, ELSET={SPECIMEN}"));
        }
        for (cell, (_, nodes)) in cells {
            let nodes: Vec<_> = nodes.iter().map(|node| (node + 1).to_string()).collect();
            deck.line(&format!("{}, {}", cell + 1, nodes.join(", ")));
        }
    }
    for part in model.materials.iter().filter(|part| part.set != SPECIMEN) {
        deck.line(&format!("*ELSET, ELSET={}", part.set));
        deck.numbers(&part.cells);
    }
    for (name, nodes) in model.sets.iter().filter(|(_, nodes)| !nodes.is_empty()) {
        deck.line(&format!("*NSET, NSET={name}"));
        deck.numbers(nodes);
    }
    for (name, sides) in &model.surfaces {
        deck.line(&format!("*SURFACE, NAME={name}, TYPE=ELEMENT"));
        for (cell, side) in sides {
            deck.line(&format!("{}, S{}", cell + 1, side + 1));
        }
    }
}

/// Displacements that follow others: u − s v = 0.
fn ties(model: &Model, deck: &mut Deck) {
    for tie in &model.ties {
        let (node, axis) = tie.follows;
        let share = match tie.share {
            1.0 => "-1.".to_owned(),
            share => (-share).to_string(),
        };
        deck.line("*EQUATION");
        deck.line("2");
        deck.line(&format!(
            "{}, {}, 1., {}, {}, {share}",
            tie.node + 1,
            tie.axis + 1,
            node + 1,
            axis + 1
        ));
    }
}

/// One step up to a load factor, with its first increment and its length in time.
fn step(model: &Model, [first, period]: [f64; 2], factor: f64, deck: &mut Deck) {
    deck.line(&format!("** load factor {factor}"));
    deck.line("*STEP, NLGEOM, INC=1000");
    deck.line("*STATIC");
    let times = [first, period, period * 1e-6, period];
    deck.line(&times.map(number).join(", "));
    if !model.held.is_empty() {
        deck.line("*BOUNDARY");
    }
    for held in &model.held {
        boundary(model, held, factor, deck);
    }
    if !model.forces.is_empty() {
        deck.line("*CLOAD");
    }
    for (node, force) in &model.forces {
        for (axis, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            deck.line(&format!(
                "{}, {}, {}",
                node + 1,
                axis + 1,
                number(factor * force)
            ));
        }
    }
    if !model.pressures.is_empty() {
        deck.line("*DLOAD");
    }
    for (surface, pressure) in &model.pressures {
        for (cell, side) in &model.surfaces[*surface].1 {
            deck.line(&format!(
                "{}, P{}, {}",
                cell + 1,
                side + 1,
                number(factor * pressure)
            ));
        }
    }
    output(model, deck);
    deck.line("*END STEP");
}

fn boundary(model: &Model, held: &Constraint, factor: f64, deck: &mut Deck) {
    let (name, nodes) = &model.sets[held.set];
    let axis = held.axis + 1;
    if let Some(displacement) = held.uniform() {
        deck.line(&format!(
            "{name}, {axis}, {axis}, {}",
            number(factor * displacement)
        ));
        return;
    }
    for node in nodes {
        let displacement = number(held.at(model.given.mesh.nodes[*node], factor));
        deck.line(&format!("{}, {axis}, {axis}, {displacement}", node + 1));
    }
}

/// Displacements and stresses at the end of the step, and the reactions of every held set.
fn output(model: &Model, deck: &mut Deck) {
    let mut sets: Vec<&str> = model
        .held
        .iter()
        .map(|held| &*model.sets[held.set].0)
        .collect();
    sets.dedup();
    if model.code == Code::Abaqus {
        for line in [
            "*OUTPUT, FIELD",
            "*NODE OUTPUT",
            "U, RF",
            "*ELEMENT OUTPUT",
            "S, LE",
        ] {
            deck.line(line);
        }
        for set in sets {
            deck.line("*OUTPUT, HISTORY");
            deck.line(&format!("*NODE OUTPUT, NSET={set}"));
            deck.line("U1, U2, RF1, RF2");
        }
        return;
    }
    let at = if is_one_step(model) {
        format!("TIME POINTS={FACTORS}")
    } else {
        "FREQUENCY=1000".to_owned()
    };
    deck.line(&format!("*NODE FILE, OUTPUT=2D, {at}"));
    deck.line("U");
    deck.line(&format!("*EL FILE, OUTPUT=2D, {at}"));
    deck.line("S");
    for set in sets {
        deck.line(&format!("*NODE PRINT, NSET={set}, TOTALS=ONLY, {at}"));
        deck.line("RF");
    }
}

/// Names the directions of a material's fibres, or the axes of Fung's law, and returns the option of the section that refers to them.
fn orientation(material: &PartMaterial, deck: &mut Deck) -> String {
    let CodeLaw::Named {
        keyword,
        directions,
        ..
    } = &material.law
    else {
        return String::new();
    };
    let Some([x, y]) = directions.first() else {
        return String::new();
    };
    let local = local_directions(keyword, directions);
    deck.line(&format!(
        "*ORIENTATION, NAME={}, SYSTEM=RECTANGULAR{local}",
        material.axes
    ));
    if local.is_empty() {
        let axes = [*x, *y, 0.0, -*y, *x, 0.0].map(number);
        deck.line(&axes.join(", "));
        deck.line("3, 0.");
    } else {
        deck.line("1., 0., 0., 0., 1., 0.");
        deck.line("3, 0.");
        for [x, y] in directions {
            deck.line(&format!("{}, {}, 0.", number(*x), number(*y)));
        }
    }
    format!(", ORIENTATION={}", material.axes)
}

/// The option that counts the directions of fibres; those of Fung's law are its axes.
fn local_directions(keyword: &str, directions: &[[f64; 2]]) -> String {
    match directions.len() {
        0 => String::new(),
        _ if keyword.starts_with("FUNG") => String::new(),
        count => format!(", LOCAL DIRECTIONS={count}"),
    }
}

/// The keyword and data of a material.
fn material(material: &PartMaterial, deck: &mut Deck) {
    deck.line(&format!("*MATERIAL, NAME={}", material.name));
    match &material.law {
        CodeLaw::Named {
            keyword,
            parameters,
            directions,
        } => {
            let kind = if directions.is_empty() {
                ""
            } else {
                "ANISOTROPIC "
            };
            let local = local_directions(keyword, directions);
            deck.line(&format!("*{kind}HYPERELASTIC, {keyword}{local}"));
            let values = parameters.iter().map(|(_, value)| number(*value));
            for line in values.collect::<Vec<_>>().chunks(8) {
                deck.line(&line.join(", "));
            }
        }
        CodeLaw::TensionCurve => {
            deck.line("*HYPERELASTIC, MARLOW");
            deck.line("*UNIAXIAL TEST DATA");
            for [strain, stress] in tension_curve(material.card) {
                deck.line(&format!("{}, {}", number(stress), number(strain)));
            }
        }
    }
    if let Some(Softening { r, m, beta }) = material.card.law.softening() {
        deck.line("*MULLINS EFFECT");
        deck.line(&[r, m, beta].map(number).join(", "));
    }
}

/// Strain λ − 1 and nominal stress from rest to one and a half of the card's range and to a stretch of 3 at least, as far
/// as the law has an energy.
fn tension_curve(card: &Card) -> Vec<[f64; 2]> {
    const POINTS: u32 = 400;
    let most = (1.5 * card.stretch_range[1] - 1.0).max(2.0);
    let strains = (0..=POINTS).map(|i| most * f64::from(i) / f64::from(POINTS));
    strains
        .map(|strain| (strain, card.law.tension([1.0, 0.0], strain)))
        // Beyond a law's limit the stress may be a number, but the energy is none.
        .take_while(|(_, test)| (test.energy + test.nominal_stress).is_finite())
        .map(|(strain, test)| [strain, test.nominal_stress])
        .collect()
}
