//! Meshes in Abaqus' and CalculiX' input files: nodes, plane elements and sets of one part.
//!
//! `*NSET` are groups of nodes, to which the edges between them belong, `*ELSET` groups of cells. The part is where its `*INSTANCE` puts it. Other
//! keywords are passed over, but for those that move nodes.
//!
//! # References
//! Abaqus Keywords Reference Guide: `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`; CalculiX CrunchiX User's Manual, the same.

use std::collections::HashMap;

use super::raw::{ImportFault, Raw};
use crate::mesh::cell_shape::CellShape;

mod placement;

use placement::Assembly;

/// What the lines below a keyword hold.
enum Block {
    Nodes {
        set: Option<String>,
    },
    Elements {
        shape: CellShape,
        set: Option<String>,
        is_plane_strain: bool,
    },
    Set {
        of_nodes: bool,
        name: String,
        is_range: bool,
    },
    Part(String),
    Instance {
        name: String,
        part: String,
    },
    /// Behind a part or an instance.
    End,
    /// A system of coordinates for the nodes below it.
    System,
    Other,
}

/// Reads the text of a file.
///
/// # Errors
/// A description of what is wrong or cannot be read.
pub fn read(text: &str) -> Result<Raw, ImportFault> {
    let mut input = Input::default();
    let mut block = Block::Other;
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with("**"));
    while let Some((number, line)) = lines.next() {
        let read = if line.trim_start().starts_with('*') {
            keyword(line).map(|next_block| {
                input.begin(&next_block, number + 1);
                block = next_block;
            })
        } else {
            let mut data = line.trim().to_owned();
            // An element continues below a comma at the end of a line.
            while matches!(block, Block::Elements { .. }) && data.ends_with(',') {
                let Some((_, more)) = lines.next() else { break };
                data.push_str(more.trim());
            }
            input.data(&block, &data)
        };
        read.map_err(|reason| format!("line {}: {reason}", number + 1))?;
    }
    input.finish()
}

/// The block that a keyword begins.
fn keyword(line: &str) -> Result<Block, String> {
    let line = line.trim().trim_start_matches('*');
    let (name, options) = line.split_once(',').unwrap_or((line, ""));
    let name = name.trim().to_uppercase();
    let option = |key: &str| {
        options.split(',').find_map(|part| {
            let (known, value) = part.split_once('=').unwrap_or((part, ""));
            let value = value.trim().trim_matches('"').to_owned();
            known.trim().eq_ignore_ascii_case(key).then_some(value)
        })
    };
    let is_range = option("GENERATE").is_some();
    let named = |key: &str| {
        option(key)
            .filter(|name| !name.is_empty())
            .ok_or(format!("*{name} without {key}=NAME"))
    };
    Ok(match &*name {
        "NODE" => {
            if let Some(system) = option("SYSTEM").filter(|name| !name.eq_ignore_ascii_case("R")) {
                return Err(format!(
                    "*NODE with SYSTEM={system}, a cylindrical or spherical system: write the nodes with their x and y"
                ));
            }
            Block::Nodes {
                set: option("NSET"),
            }
        }
        "ELEMENT" => Block::Elements {
            shape: shape(&named("TYPE")?)?,
            set: option("ELSET"),
            is_plane_strain: named("TYPE")?.to_uppercase().starts_with("CPE"),
        },
        "NSET" | "ELSET" => Block::Set {
            of_nodes: name == "NSET",
            name: named(&name)?,
            is_range,
        },
        "PART" => Block::Part(option("NAME").unwrap_or_default()),
        "INSTANCE" => Block::Instance {
            name: option("NAME").unwrap_or_default(),
            part: option("PART").unwrap_or_default(),
        },
        "END PART" | "END INSTANCE" => Block::End,
        "SYSTEM" => Block::System,
        "NMAP" => {
            return Err("*NMAP moves nodes: write them where they are".to_owned());
        }
        "INCLUDE" => {
            return Err("*INCLUDE names another file: put its lines in this one".to_owned());
        }
        _ => Block::Other,
    })
}

/// The shape of a plane element by its type; letters behind the number of nodes (reduced integration, hybrid) do not change it.
fn shape(kind: &str) -> Result<CellShape, String> {
    let kind = kind.to_uppercase();
    let plane = ["CPS", "CPE"]
        .iter()
        .find_map(|plane| kind.strip_prefix(plane));
    match plane.and_then(|rest| rest.chars().next()) {
        Some('3') => Ok(CellShape::Triangle3),
        Some('4') => Ok(CellShape::Quad4),
        Some('6') => Ok(CellShape::Triangle6),
        Some('8') => Ok(CellShape::Quad8),
        _ if kind.starts_with("C3D") => Err(format!(
            "elements of the type {kind}, a 3-D mesh: mesh the flat surface alone, with CPS or CPE"
        )),
        _ => Err(format!(
            "elements of the type {kind}; those of a sheet are CPS3, CPS4, CPS6, CPS8, or CPE"
        )),
    }
}

/// A mesh as its lines are read.
#[derive(Default)]
struct Input {
    raw: Raw,
    /// Cells by the file's own number of the element.
    cells: HashMap<u64, usize>,
    /// Numbers of elements, and names of other sets, by the name of their set.
    element_sets: Vec<(String, Vec<Member>)>,
    node_sets: Vec<(String, Vec<Member>)>,
    assembly: Assembly,
}

/// A member of a set.
enum Member {
    Number(u64),
    Set(String),
}

impl Input {
    /// Begins the block of a keyword on a line.
    fn begin(&mut self, block: &Block, line: usize) {
        match block {
            Block::Part(name) => self.assembly.begin_part(name),
            Block::Instance { name, part } => self.assembly.begin_instance(name, part, line),
            Block::End => self.assembly.end(),
            _ => {}
        }
    }

    fn data(&mut self, block: &Block, line: &str) -> Result<(), String> {
        let fields: Vec<&str> = line
            .split(',')
            .map(str::trim)
            .filter(|field| !field.is_empty())
            .collect();
        match block {
            Block::Nodes { set } => self.node(&fields, set.as_deref()),
            Block::Elements {
                shape,
                set,
                is_plane_strain,
            } => {
                self.raw.is_plane_strain |= is_plane_strain;
                self.element(&fields, *shape, set.as_deref())
            }
            Block::Set {
                of_nodes,
                name,
                is_range,
            } => {
                let sets = if *of_nodes {
                    &mut self.node_sets
                } else {
                    &mut self.element_sets
                };
                extend(sets, name, members(&fields, *is_range)?);
                Ok(())
            }
            Block::Instance { .. } => self.assembly.place(&numbers(line)?),
            Block::System => Err(
                "*SYSTEM states a system of coordinates of its own for nodes: write them in that of the assembly"
                    .to_owned(),
            ),
            Block::Part(_) | Block::End | Block::Other => Ok(()),
        }
    }

    fn node(&mut self, fields: &[&str], set: Option<&str>) -> Result<(), String> {
        let [number, x, y, rest @ ..] = fields else {
            return Err(format!(
                "{} fields, but a node has its number, x and y",
                fields.len()
            ));
        };
        let number = integer(number)?;
        let z = rest.first().copied().unwrap_or("0");
        let position = [coordinate(x)?, coordinate(y)?, coordinate(z)?];
        if self.raw.positions.insert(number, position).is_some() {
            return Err(format!(
                "the node {number} once more: keep the mesh of one part"
            ));
        }
        self.assembly.add_node(number);
        if let Some(set) = set {
            extend(&mut self.node_sets, set, vec![Member::Number(number)]);
        }
        Ok(())
    }

    fn element(
        &mut self,
        fields: &[&str],
        shape: CellShape,
        set: Option<&str>,
    ) -> Result<(), String> {
        let numbers = integers(fields)?;
        let [number, nodes @ ..] = &numbers[..] else {
            return Err("an element without its number".to_owned());
        };
        if nodes.len() != shape.nodes() {
            return Err(format!(
                "the element {number} has {} nodes instead of {}",
                nodes.len(),
                shape.nodes()
            ));
        }
        if self.cells.insert(*number, self.raw.cells.len()).is_some() {
            return Err(format!(
                "the element {number} once more: keep the mesh of one part"
            ));
        }
        self.raw.cells.push((shape, nodes.to_vec()));
        self.assembly.add_element();
        if let Some(set) = set {
            extend(&mut self.element_sets, set, vec![Member::Number(*number)]);
        }
        Ok(())
    }

    /// The mesh with its sets; sets of nodes that no cell has, such as reference points, are left out.
    fn finish(mut self) -> Result<Raw, ImportFault> {
        self.assembly.put(&mut self.raw.positions)?;
        for (name, numbers) in resolved(&self.element_sets)? {
            let cells = numbers
                .iter()
                .filter_map(|number| self.cells.get(number))
                .copied();
            self.raw.areas.insert(name, cells.collect());
        }
        let used = self.raw.used();
        for (name, numbers) in resolved(&self.node_sets)? {
            if numbers.iter().any(|number| used.contains(number)) {
                self.raw.sets.insert(name, numbers);
            }
        }
        Ok(self.raw)
    }
}

fn extend(sets: &mut Vec<(String, Vec<Member>)>, name: &str, members: Vec<Member>) {
    match sets.iter_mut().find(|(known, _)| known == name) {
        Some((_, all)) => all.extend(members),
        None => sets.push((name.to_owned(), members)),
    }
}

/// The members on a line: numbers and names of sets, or the first, the last and the step of a range.
fn members(fields: &[&str], is_range: bool) -> Result<Vec<Member>, String> {
    /// Longest range, so that three numbers take no more memory than a mesh.
    const LONGEST: u64 = 10_000_000;
    if !is_range {
        let member = |field: &&str| {
            integer(field).map_or_else(|_| Member::Set((*field).to_owned()), Member::Number)
        };
        return Ok(fields.iter().map(member).collect());
    }
    let (first, last, step) = match integers(fields)?[..] {
        [first, last] => (first, last, 1),
        [first, last, step] => (first, last, step),
        _ => return Err("a range needs its first and last number, and its step".to_owned()),
    };
    if step == 0 || last.saturating_sub(first) / step > LONGEST {
        return Err(format!("a range from {first} to {last} in steps of {step}"));
    }
    Ok((first..=last)
        .step_by(step as usize)
        .map(Member::Number)
        .collect())
}

/// The numbers of sets, with those of sets that stand above them.
fn resolved(sets: &[(String, Vec<Member>)]) -> Result<Vec<(String, Vec<u64>)>, ImportFault> {
    let mut all: Vec<(String, Vec<u64>)> = Vec::new();
    for (name, members) in sets {
        let mut numbers = Vec::new();
        for member in members {
            match member {
                Member::Number(number) => numbers.push(*number),
                Member::Set(other) => {
                    let other = all.iter().find(|(known, _)| known.eq_ignore_ascii_case(other)).ok_or_else(|| {
                        format!("has the set `{name}` with `{other}`, which is neither a number nor a set above it")
                    })?;
                    numbers.extend(&other.1);
                }
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        all.push((name.clone(), numbers));
    }
    Ok(all)
}

fn integers(fields: &[&str]) -> Result<Vec<u64>, String> {
    fields.iter().map(|field| integer(field)).collect()
}

fn integer(field: &str) -> Result<u64, String> {
    field
        .parse()
        .map_err(|_| format!("\"{field}\" where a whole number should be"))
}

/// The numbers on a line; one that is left out is zero.
fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let line = line.strip_suffix(',').unwrap_or(line);
    let number = |field: &str| match field.trim() {
        "" => Ok(0.0),
        field => coordinate(field),
    };
    line.split(',').map(number).collect()
}

/// A number; Fortran's exponents have a D.
fn coordinate(field: &str) -> Result<f64, String> {
    let number = field.replace(['d', 'D'], "e").parse().ok();
    number.ok_or_else(|| format!("\"{field}\" where a number should be"))
}

#[cfg(test)]
mod tests;
