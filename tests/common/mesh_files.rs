//! Meshes as other programs write them.

use std::fmt::Write;

use gelbench::mesh::{CellShape, Mesh};

/// Nodes, cells by their nodes, and lines by the name of their group, with numbers from 0.
#[derive(Clone, Default)]
pub struct MeshFile {
    pub nodes: Vec<[f64; 2]>,
    pub cells: Vec<Vec<usize>>,
    pub lines: Vec<(String, Vec<usize>)>,
}

impl MeshFile {
    /// A strip of `count` unit squares with four nodes each.
    pub fn squares([nx, ny]: [usize; 2]) -> Self {
        let nodes = (0..=nx).flat_map(|i| (0..=ny).map(move |j| [i as f64, j as f64]));
        let cells = (0..nx).flat_map(|i| (0..ny).map(move |j| i * (ny + 1) + j));
        let cells = cells.map(|a| vec![a, a + ny + 1, a + ny + 2, a + 1]);
        Self {
            nodes: nodes.collect(),
            cells: cells.collect(),
            lines: Vec::new(),
        }
    }

    /// A mesh with the edges of its groups.
    pub fn of(mesh: &Mesh) -> Self {
        let groups = mesh.groups().iter();
        let lines = groups.flat_map(|(name, group)| {
            let edges = group.edges.iter();
            edges.map(move |edge| (name.clone(), edge.clone()))
        });
        Self {
            nodes: mesh.nodes.clone(),
            cells: (0..mesh.cell_count())
                .map(|cell| mesh.cell(cell).to_vec())
                .collect(),
            lines: lines.collect(),
        }
    }

    /// Gmsh's format 2.2.
    pub fn msh(&self) -> String {
        let mut names: Vec<&str> = self.lines.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_owned();
        let _ = writeln!(text, "$PhysicalNames\n{}", names.len());
        for (number, name) in names.iter().enumerate() {
            let _ = writeln!(text, "1 {} \"{name}\"", number + 1);
        }
        let _ = writeln!(text, "$EndPhysicalNames\n$Nodes\n{}", self.nodes.len());
        for (number, [x, y]) in self.nodes.iter().enumerate() {
            let _ = writeln!(text, "{} {x:?} {y:?} 0", number + 1);
        }
        let count = self.lines.len() + self.cells.len();
        let _ = writeln!(text, "$EndNodes\n$Elements\n{count}");
        let of_lines = self.lines.iter().map(|(name, nodes)| {
            let tag = names.iter().position(|known| known == name);
            (
                if nodes.len() == 2 { 1 } else { 8 },
                1 + tag.unwrap_or(0),
                nodes,
            )
        });
        let of_cells = self.cells.iter().map(|nodes| {
            let kind = match nodes.len() {
                3 => 2,
                4 => 3,
                6 => 9,
                8 => 16,
                _ => 10,
            };
            (kind, 0, nodes)
        });
        for (number, (kind, tag, nodes)) in of_lines.chain(of_cells).enumerate() {
            let nodes: Vec<String> = nodes.iter().map(|node| (node + 1).to_string()).collect();
            let _ = writeln!(text, "{} {kind} 2 {tag} 1 {}", number + 1, nodes.join(" "));
        }
        text + "$EndElements\n"
    }

    /// VTK's XML format, without groups.
    pub fn vtu(&self) -> String {
        let points: Vec<String> = self
            .nodes
            .iter()
            .map(|[x, y]| format!("{x:?} {y:?} 0"))
            .collect();
        let numbers = |values: &mut dyn Iterator<Item = usize>| {
            values
                .map(|value| value.to_string())
                .collect::<Vec<_>>()
                .join(" ")
        };
        let ends = self.cells.iter().scan(0, |end, cell| {
            *end += cell.len();
            Some(*end)
        });
        let kinds = self.cells.iter().map(|nodes| match nodes.len() {
            3 => 5,
            4 => 9,
            6 => 22,
            8 => 23,
            _ => 28,
        });
        let array = |kind: &str, rest: &str, values: &str| {
            format!("<DataArray type=\"{kind}\" {rest} format=\"ascii\">{values}</DataArray>\n")
        };
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n\
             </Piece></UnstructuredGrid></VTKFile>\n",
            self.nodes.len(),
            self.cells.len(),
            array("Float64", "NumberOfComponents=\"3\"", &points.join(" ")),
            array(
                "Int64",
                "Name=\"connectivity\"",
                &numbers(&mut self.cells.iter().flatten().copied())
            ),
            array("Int64", "Name=\"offsets\"", &numbers(&mut ends.into_iter())),
            array("UInt8", "Name=\"types\"", &numbers(&mut kinds.into_iter())),
        )
    }
}

/// All kinds of cells that files hold.
pub const KINDS: [CellShape; 5] = [
    CellShape::Triangle3,
    CellShape::Triangle6,
    CellShape::Quad4,
    CellShape::Quad8,
    CellShape::Quad9,
];
