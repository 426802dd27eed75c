//! CalculiX' result files, ASCII: nodes (`2C`), elements (`3C`) and the displacements of each step (`DISP`).
//!
//! ```text
//!     2C …                        nodes:      -1, number, x, y, z in columns of 3, 10, 12, 12, 12
//!     3C …                        elements:   -1, number, kind;  -2, nodes
//!   100CL  101 5.00000E-01 …      a step with its time
//!  -4  DISP …                     displacements: -1, node, D1, D2, D3
//! ```
//!
//! CalculiX turns the elements of a sheet into solids. Where the file contains these (`OUTPUT=3D`), their lower faces
//! become the cells, and the displacement of a node is the mean of all nodes above it.
//!
//! # References
//! K. Wittig, CalculiX GraphiX 2.20, "Result Format"

use std::collections::HashMap;

use super::raw::{ImportFault, Raw};
use crate::mesh::cell_shape::CellShape;

/// A file, before a step is chosen.
#[derive(Default)]
pub struct Results {
    /// Positions and cells.
    pub raw: Raw,
    /// The time and the displacements of every step, in the order of the file.
    pub steps: Vec<(f64, HashMap<u64, [f64; 2]>)>,
}

/// Elements by their numbers: kind of the cell, and whether it is the lower face of a solid of so many nodes.
const KINDS: [(usize, CellShape, usize); 8] = [
    (1, CellShape::Quad4, 8),
    (2, CellShape::Triangle3, 6),
    (4, CellShape::Quad8, 20),
    (5, CellShape::Triangle6, 15),
    (7, CellShape::Triangle3, 3),
    (8, CellShape::Triangle6, 6),
    (9, CellShape::Quad4, 4),
    (10, CellShape::Quad8, 8),
];

/// The block to which the lines belong.
enum Block {
    Other,
    Nodes,
    Elements,
    Displacements,
}

/// The part of a file that has been read.
struct Reader {
    results: Results,
    block: Block,
    time: Option<f64>,
    /// Whether an element was a solid.
    solid: bool,
    /// Width of a node's number: the short format has five digits, the long one ten.
    width: usize,
    /// Kind and nodes of the element that is being read.
    element: Option<(usize, Vec<u64>)>,
}

/// Reads the text of a file.
pub fn read(text: &str) -> Result<Results, ImportFault> {
    let mut reader = Reader {
        results: Results::default(),
        block: Block::Other,
        time: None,
        solid: false,
        width: 10,
        element: None,
    };
    for (line, number) in text.lines().zip(1..) {
        reader.line(line, &|what| format!("has no {what} in line {number}"))?;
    }
    let Reader {
        mut results, solid, ..
    } = reader;
    if results.steps.is_empty() {
        return Err("contains no displacements (DISP); ask CalculiX for *NODE FILE with U".into());
    }
    if solid {
        flatten(&mut results)?;
    }
    Ok(results)
}

impl Reader {
    fn line(&mut self, line: &str, fault: &dyn Fn(&str) -> String) -> Result<(), ImportFault> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match (&self.block, words.as_slice()) {
            (_, ["2C" | "3C", .., format]) => {
                self.width = digits(format)?;
                self.block = match words[0] {
                    "2C" => Block::Nodes,
                    _ => Block::Elements,
                };
            }
            (_, [first, ..]) if first.starts_with("100C") => {
                self.time = line.get(12..24).and_then(|field| field.trim().parse().ok());
                self.width = digits(words[words.len() - 1])?;
            }
            (_, ["-4", "DISP", ..]) => {
                let time = self.time.ok_or_else(|| fault("time for displacements"))?;
                self.results.steps.push((time, HashMap::new()));
                self.block = Block::Displacements;
            }
            (_, ["-3", ..]) => {
                self.keep_element()?;
                self.block = Block::Other;
            }
            (Block::Nodes, ["-1", ..]) => {
                let position = numbers(line, self.width).ok_or_else(|| fault("place of a node"))?;
                self.results
                    .raw
                    .positions
                    .insert(self.node(line, fault)?, position);
            }
            (Block::Displacements, ["-1", ..]) => {
                let [x, y, _] = numbers(line, self.width).ok_or_else(|| fault("displacement"))?;
                let node = self.node(line, fault)?;
                let (_, field) = self.results.steps.last_mut().expect("a step was begun");
                field.insert(node, [x, y]);
            }
            (Block::Elements, ["-1", _, kind, ..]) => {
                self.keep_element()?;
                self.element = Some((kind.parse().map_err(|_| fault("kind"))?, Vec::new()));
            }
            (Block::Elements, ["-2", ..]) => {
                let (_, nodes) = self.element.as_mut().ok_or_else(|| fault("element"))?;
                let fields = line.as_bytes().get(3..).unwrap_or_default();
                for field in fields.chunks(self.width) {
                    let field = std::str::from_utf8(field).unwrap_or_default().trim();
                    nodes.push(field.parse().map_err(|_| fault("number of a node"))?);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn keep_element(&mut self) -> Result<(), ImportFault> {
        self.solid |= keep(&mut self.results.raw, self.element.take())?;
        Ok(())
    }

    fn node(&self, line: &str, fault: &dyn Fn(&str) -> String) -> Result<u64, ImportFault> {
        let number = line
            .get(3..3 + self.width)
            .and_then(|field| field.trim().parse().ok());
        number.ok_or_else(|| fault("number of a node").into())
    }
}

fn digits(format: &str) -> Result<usize, ImportFault> {
    match format {
        "0" => Ok(5),
        "1" => Ok(10),
        _ => Err("is binary or no result file; use *NODE FILE, which writes ASCII".into()),
    }
}

/// Three numbers of twelve columns each; numbers left out at the end of a line are zero.
fn numbers(line: &str, width: usize) -> Option<[f64; 3]> {
    let mut values = [0.0; 3];
    for (i, value) in values.iter_mut().enumerate() {
        let start = 3 + width + 12 * i;
        let field = line.get(start..(start + 12).min(line.len()));
        match field.map(str::trim) {
            Some("") | None if i == 2 => {}
            field => *value = field?.parse().ok()?,
        }
    }
    Some(values)
}

/// Adds an element as a cell; returns whether it was a solid.
fn keep(raw: &mut Raw, element: Option<(usize, Vec<u64>)>) -> Result<bool, ImportFault> {
    let Some((number, nodes)) = element else {
        return Ok(false);
    };
    let kind = KINDS.iter().find(|(known, ..)| *known == number);
    let Some((_, shape, count)) = kind else {
        return Err(format!(
            "has elements of the kind {number}; a sheet consists of triangles, quadrilaterals, wedges and hexahedra"
        ).into());
    };
    if nodes.len() != *count {
        return Err(format!(
            "has an element of {} nodes where {count} belong",
            nodes.len()
        )
        .into());
    }
    // The middles of the lower face follow the corners of both faces.
    let (corners, shape_nodes) = (shape.corners(), shape.nodes());
    let solid = *count > shape_nodes;
    let mut cell = nodes[..corners].to_vec();
    let middles = if solid { 2 * corners } else { corners };
    cell.extend(&nodes[middles..middles + shape_nodes - corners]);
    raw.cells.push((*shape, cell));
    Ok(solid)
}

/// Takes the mean displacement of all nodes above each other.
fn flatten(results: &mut Results) -> Result<(), ImportFault> {
    let positions = &results.raw.positions;
    let key = |position: &[f64; 3]| [position[0] + 0.0, position[1] + 0.0].map(f64::to_bits);
    let mut columns: HashMap<[u64; 2], Vec<u64>> = HashMap::new();
    for (node, position) in positions {
        columns.entry(key(position)).or_default().push(*node);
    }
    if columns.len() * 2 > positions.len() {
        return Err("contains solids that are not a single layer over a sheet".into());
    }
    for nodes in columns.values_mut() {
        nodes.sort_unstable(); // sums in one order give the same digits on every run
    }
    for (_, field) in &mut results.steps {
        let mean = |node: &u64| {
            let column = &columns[&key(&positions[node])];
            let known: Vec<_> = column.iter().filter_map(|node| field.get(node)).collect();
            let sum = |axis: usize| known.iter().map(|u| u[axis]).sum::<f64>();
            (*node, [0, 1].map(|axis| sum(axis) / known.len() as f64))
        };
        *field = field
            .keys()
            .filter(|node| positions.contains_key(node))
            .map(mean)
            .collect();
    }
    Ok(())
}
