//! Meshes in Abaqus' and CalculiX' input files: nodes, plane elements and sets of one part.
//!
//! `*NSET` are groups of nodes, to which the edges between them belong, `*ELSET` groups of cells. Other keywords are passed over.
//!
//! # References
//! Abaqus Keywords Reference Guide: `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`; CalculiX CrunchiX User's Manual, the same.

use std::collections::HashMap;

use super::raw::{Raw, Unreadable};
use crate::mesh::cell_shape::CellShape;

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
    Other,
}

/// Reads the text of a file.
///
/// # Errors
/// A description of what is wrong or cannot be read.
pub fn read(text: &str) -> Result<Raw, Unreadable> {
    let mut input = Input::default();
    let mut block = Block::Other;
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with("**"));
    while let Some((number, line)) = lines.next() {
        let read = if line.trim_start().starts_with('*') {
            keyword(line).map(|next_block| block = next_block)
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
        "NODE" => Block::Nodes {
            set: option("NSET"),
        },
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
}

/// A member of a set.
enum Member {
    Number(u64),
    Set(String),
}

impl Input {
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
            Block::Other => Ok(()),
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
        if let Some(set) = set {
            extend(&mut self.element_sets, set, vec![Member::Number(*number)]);
        }
        Ok(())
    }

    /// The mesh with its sets; sets of nodes that no cell has, such as reference points, are left out.
    fn finish(mut self) -> Result<Raw, Unreadable> {
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
fn resolved(sets: &[(String, Vec<Member>)]) -> Result<Vec<(String, Vec<u64>)>, Unreadable> {
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

/// A number; Fortran's exponents have a D.
fn coordinate(field: &str) -> Result<f64, String> {
    let number = field.replace(['d', 'D'], "e").parse().ok();
    number.ok_or_else(|| format!("\"{field}\" where a number should be"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "*HEADING\nA strip\n** made by hand\n*Part, name=strip\n*Node, nset=ALL\n1, 0., 0.\n 2, 1D1, 0.\n3, 20., 0., 0.\n\
        4, 0., 10.\n5, 10., 10.\n6, 20., 10.\n*Element, type=CPS4R, elset=left half\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPE3H\n2, 2, 3,\n6\n\
        3, 2, 6, 5\n*Nset, nset=bottom, generate\n1, 3, 1\n*Nset, nset=lower\nbottom\n*Elset, elset=\"right\"\n2, 3\n*End Part\n\
        *Boundary\nlower, 1, 2\n";

    #[test]
    fn nodes_elements_and_sets_are_read() {
        let raw = read(TWO).unwrap();
        assert_eq!(raw.positions.len(), 6);
        assert_eq!(raw.positions[&2], [10.0, 0.0, 0.0]);
        assert_eq!(raw.cells[0], (CellShape::Quad4, vec![1, 2, 5, 4]));
        assert_eq!(raw.cells[1], (CellShape::Triangle3, vec![2, 3, 6]));
        assert_eq!(raw.areas["left half"], [0]);
        assert_eq!(raw.areas["right"], [1, 2]);
        assert_eq!(raw.sets["bottom"], [1, 2, 3]);
        assert_eq!(raw.sets["lower"], [1, 2, 3]);
        assert_eq!(raw.sets["ALL"].len(), 6);
        let mesh = raw.mesh(1.0).unwrap();
        assert_eq!(
            (mesh.cell_count(), mesh.groups()["bottom"].edges.len()),
            (3, 2)
        );
    }

    #[test]
    fn what_is_no_sheet_is_refused_with_its_line() {
        for (text, reason) in [
            ("*ELEMENT, TYPE=C3D8\n", "line 1: elements of the type C3D8"),
            ("*ELEMENT\n", "line 1: *ELEMENT without TYPE=NAME"),
            ("*NODE\n1, 0\n", "line 2: 2 fields"),
            ("*NODE\n1, 0, a\n", "line 2: \"a\" where a number should be"),
            ("*NODE\n1, 0, 0\n1, 0, 0\n", "line 3: the node 1 once more"),
            (
                "*ELEMENT, TYPE=CPS3\n1, 1, 2\n",
                "line 2: the element 1 has 2 nodes instead of 3",
            ),
            (
                "*NSET, NSET=a, GENERATE\n1, 99999999999, 1\n",
                "line 2: a range",
            ),
            ("*NSET, NSET=a\nb\n", "neither a number nor a set"),
            ("*INCLUDE, INPUT=mesh.inp\n", "*INCLUDE names another file"),
        ] {
            let error = read(text).err().unwrap().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }
}
