//! Gmsh's ASCII files, versions 2.2 and 4.1.

use std::collections::HashMap;
use std::str::{FromStr, SplitWhitespace};

use super::raw::{BINARY, Displacements, ImportFault, Raw, Step};
use crate::mesh::cell_shape::CellShape;

/// Reads the text of a file.
pub fn read(text: &str) -> Result<Raw, ImportFault> {
    let mut format = section(text, "MeshFormat")?;
    let version: f64 = format.next()?;
    if format.next::<i64>()? != 0 {
        return Err(BINARY.into());
    }
    let names = names(text)?;
    match version {
        v if (2.0..3.0).contains(&v) => version_2(text, &names),
        v if (4.1..5.0).contains(&v) => version_4(text, &names),
        other => Err(format!("has the format {other}; 2.2 and 4.1 can be read").into()),
    }
}

/// The views of vectors at the nodes (`$NodeData`) by their names, each with its steps: times and values by node.
pub fn views(text: &str) -> Result<Vec<(String, Vec<Step>)>, ImportFault> {
    let mut views: Vec<(String, Vec<_>)> = Vec::new();
    for section in text.split("$NodeData").skip(1) {
        let section = section.split("$EndNodeData").next().unwrap_or_default();
        let mut lines = section
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty());
        let texts = lines.next().and_then(|line| line.parse().ok());
        let texts: usize = texts.ok_or("has a $NodeData without its number of names")?;
        let names: Vec<&str> = lines.by_ref().take(texts).collect();
        let name = names.first().map_or("", |name| name.trim_matches('"'));
        let rest: Vec<&str> = lines.collect();
        let rest = rest.join("\n");
        let mut words = Words {
            name: "NodeData",
            words: rest.split_whitespace(),
        };
        let Some(step) = view_step(&mut words)? else {
            continue;
        };
        match views.iter_mut().find(|(known, _)| known == name) {
            Some((_, steps)) => steps.push(step),
            None => views.push((name.to_owned(), vec![step])),
        }
    }
    Ok(views)
}

/// One step of a view after its names; `None` where its values are not vectors.
fn view_step(words: &mut Words) -> Result<Option<Step>, ImportFault> {
    let reals: Vec<f64> = (0..words.next::<usize>()?)
        .map(|_| words.next())
        .collect::<Result<_, _>>()?;
    let count: usize = words.next()?;
    let integers = words.list(count)?;
    let [_, components, nodes, ..] = integers[..] else {
        return Err("has a $NodeData without its number of components and nodes".into());
    };
    let mut values = Displacements::new();
    for _ in 0..nodes {
        let node = words.integer()?;
        let vector: Vec<f64> = (0..components)
            .map(|_| words.next())
            .collect::<Result<_, _>>()?;
        if let [x, y, ..] = vector[..] {
            values.insert(node, [x, y]);
        }
    }
    let is_vector = components == 2 || components == 3;
    Ok(is_vector.then(|| (reals.first().copied(), values)))
}

/// Names of physical groups by dimension and number.
type Names = HashMap<(i64, i64), String>;

/// Words of a section, one after the other.
struct Words<'a> {
    name: &'static str,
    words: SplitWhitespace<'a>,
}

impl Words<'_> {
    fn next<T: FromStr>(&mut self) -> Result<T, ImportFault> {
        let name = self.name;
        let word = self.words.next();
        let word = word.ok_or_else(|| format!("ends within ${name}"))?;
        let number = word.parse().ok();
        Ok(number.ok_or_else(|| format!("has \"{word}\" in ${name}, where a number should be"))?)
    }

    fn skip(&mut self, count: usize) -> Result<(), ImportFault> {
        (0..count).try_for_each(|_| self.next::<f64>().map(|_| ()))
    }

    /// A whole number; some programs write it with a decimal point.
    fn integer(&mut self) -> Result<u64, ImportFault> {
        let number: f64 = self.next()?;
        if number < 0.0 || number.fract() != 0.0 {
            return Err(format!(
                "has {number} in ${}, where a whole number should be",
                self.name
            )
            .into());
        }
        Ok(number as u64)
    }

    fn list(&mut self, count: usize) -> Result<Vec<u64>, ImportFault> {
        (0..count).map(|_| self.integer()).collect()
    }
}

fn body<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = text
        .split_once(&format!("${name}\n"))
        .or_else(|| text.split_once(&format!("${name}\r\n")))?;
    Some(
        rest.split_once(&format!("$End{name}"))
            .map_or(rest, |(body, _)| body),
    )
}

fn section<'a>(text: &'a str, name: &'static str) -> Result<Words<'a>, ImportFault> {
    let body = body(text, name).ok_or_else(|| format!("has no ${name}"))?;
    Ok(Words {
        name,
        words: body.split_whitespace(),
    })
}

fn names(text: &str) -> Result<Names, ImportFault> {
    let body = body(text, "PhysicalNames").unwrap_or_default();
    let mut names = Names::new();
    for line in body.lines().skip(1).filter(|line| !line.trim().is_empty()) {
        let mut words = Words {
            name: "PhysicalNames",
            words: line.split_whitespace(),
        };
        let key = (words.next()?, words.next()?);
        let name = line
            .split('"')
            .nth(1)
            .ok_or("has a physical group without a name")?;
        names.insert(key, name.to_owned());
    }
    Ok(names)
}

/// The name of a group; Gmsh negates the tag where a group takes an entity in the opposite direction.
fn group(names: &Names, dimension: i64, tag: i64) -> String {
    let tag = tag.abs();
    names
        .get(&(dimension, tag))
        .cloned()
        .unwrap_or_else(|| format!("physical-{tag}"))
}

/// Number of nodes of an element, and its role in a flat mesh.
enum Kind {
    Point,
    Line,
    Cell(CellShape),
}

fn kind(number: i64) -> Result<(Kind, usize), ImportFault> {
    Ok(match number {
        15 => (Kind::Point, 1),
        1 => (Kind::Line, 2),
        8 => (Kind::Line, 3),
        2 => (Kind::Cell(CellShape::Triangle3), 3),
        9 => (Kind::Cell(CellShape::Triangle6), 6),
        3 => (Kind::Cell(CellShape::Quad4), 4),
        16 => (Kind::Cell(CellShape::Quad8), 8),
        10 => (Kind::Cell(CellShape::Quad9), 9),
        4..=7 | 11..=14 | 17..=19 | 29..=31 => {
            return Err("is a 3-D mesh (tetrahedra, hexahedra, prisms or pyramids): mesh the flat surface alone, `gmsh -2`".into());
        }
        other => {
            return Err(format!(
                "has elements of Gmsh's type {other}; triangles with 3 or 6 nodes and quadrilaterals with 4, 8 or 9 can be read"
            ).into());
        }
    })
}

impl Raw {
    /// Adds an element with the groups that it belongs to.
    fn add(&mut self, kind: &Kind, nodes: Vec<u64>, groups: &[String]) {
        for group in groups.iter().cloned() {
            match kind {
                Kind::Cell(_) => self.areas.entry(group).or_default().push(self.cells.len()),
                Kind::Line => {
                    let lines = self.lines.entry(group).or_default();
                    lines.push([nodes[0], nodes[1]]);
                }
                Kind::Point => self.points.entry(group).or_default().push(nodes[0]),
            }
        }
        if let Kind::Cell(shape) = kind {
            self.cells.push((*shape, nodes));
        }
    }
}

fn version_2(text: &str, names: &Names) -> Result<Raw, ImportFault> {
    let mut raw = Raw::default();
    let mut words = section(text, "Nodes")?;
    for _ in 0..words.next::<usize>()? {
        let tag = words.integer()?;
        raw.positions
            .insert(tag, [words.next()?, words.next()?, words.next()?]);
    }
    let mut words = section(text, "Elements")?;
    for _ in 0..words.next::<usize>()? {
        words.skip(1)?;
        let (kind, count) = kind(words.next()?)?;
        let tags: usize = words.next()?;
        let physical = if tags > 0 { words.integer()? as i64 } else { 0 };
        words.skip(tags.saturating_sub(1))?;
        let nodes = words.list(count)?;
        let dimension = match kind {
            Kind::Point => 0,
            Kind::Line => 1,
            Kind::Cell(_) => 2,
        };
        let groups = if physical == 0 {
            Vec::new()
        } else {
            vec![group(names, dimension, physical)]
        };
        raw.add(&kind, nodes, &groups);
    }
    Ok(raw)
}

fn version_4(text: &str, names: &Names) -> Result<Raw, ImportFault> {
    let mut raw = Raw::default();
    let groups = entities(text, names)?;
    let mut words = section(text, "Nodes")?;
    let blocks: usize = words.next()?;
    words.skip(3)?;
    for _ in 0..blocks {
        words.skip(1)?;
        words.skip(1)?;
        let parametric: i64 = words.next()?;
        let count: usize = words.next()?;
        if parametric != 0 {
            return Err("has parametric nodes; save it without them".into());
        }
        for tag in words.list(count)? {
            raw.positions
                .insert(tag, [words.next()?, words.next()?, words.next()?]);
        }
    }
    let mut words = section(text, "Elements")?;
    let blocks: usize = words.next()?;
    words.skip(3)?;
    for _ in 0..blocks {
        let entity: (i64, i64) = (words.next()?, words.next()?);
        let (kind, nodes) = kind(words.next()?)?;
        let entity_groups = groups.get(&entity).map_or(&[][..], |groups| &groups[..]);
        for _ in 0..words.next::<usize>()? {
            words.skip(1)?;
            let nodes = words.list(nodes)?;
            raw.add(&kind, nodes, entity_groups);
        }
    }
    Ok(raw)
}

/// The names of the physical groups of points, curves and surfaces, by dimension and number of the entity.
fn entities(text: &str, names: &Names) -> Result<HashMap<(i64, i64), Vec<String>>, ImportFault> {
    let mut groups = HashMap::new();
    if body(text, "Entities").is_none() {
        return Ok(groups);
    }
    let mut words = section(text, "Entities")?;
    let counts: [usize; 3] = [words.next()?, words.next()?, words.next()?];
    words.skip(1)?;
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag: i64 = words.next()?;
            // A point's position, or the box of a curve or a surface.
            words.skip(if dimension == 0 { 3 } else { 6 })?;
            let mut entity_groups = Vec::new();
            for _ in 0..words.next::<usize>()? {
                entity_groups.push(group(names, dimension, words.next()?));
            }
            if dimension > 0 {
                let bounding: usize = words.next()?;
                words.skip(bounding)?;
            }
            groups.insert((dimension, tag), entity_groups);
        }
    }
    Ok(groups)
}
