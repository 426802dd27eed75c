//! Groups of a mesh: found by their names, and means over them.

use crate::error::Diagnostic;
use crate::mesh::{GAUSS_3, Group, Mesh};

/// The group of a name.
pub fn named<'a>(what: &str, mesh: &'a Mesh, name: &str) -> Result<&'a Group, Diagnostic> {
    let groups = mesh.groups();
    groups.get(name).ok_or_else(|| {
        let known: Vec<_> = groups.keys().map(String::as_str).collect();
        let fault = Diagnostic::error(what, format!("the mesh has no group `{name}`"));
        fault.hint(format!("its groups are {}", known.join(", ")))
    })
}

/// The diagnostic of a support or a load, `what`, that does not suit a group.
pub fn refused(what: &str, group: &str, reason: &str) -> Diagnostic {
    Diagnostic::error(what, format!("the group `{group}` {reason}"))
}

/// The share of each node in the mean over a group: the mean over the length of its edges; without edges over its
/// cells; without cells over its lines; otherwise over its nodes.
///
/// ```text
/// ⟨u⟩ = Σ sᵢ uᵢ,   sᵢ = ∫ Nᵢ ds / ∫ ds   or   ∫ Nᵢ dA / ∫ dA
/// ```
///
/// An unweighted mean over nodes would depend on where they lie.
pub fn shares(mesh: &Mesh, group: &Group) -> Vec<(usize, f64)> {
    let along = |sides: &[Vec<usize>]| -> Vec<(usize, f64)> {
        let sides = sides.iter();
        sides.flat_map(|side| edge_lengths(mesh, side)).collect()
    };
    let measures: Vec<(usize, f64)> = match [
        group.edges.is_empty(),
        group.cells.is_empty(),
        group.lines.is_empty(),
    ] {
        [false, ..] => along(&group.edges),
        [_, false, _] => {
            let cells = group.cells.iter();
            cells.flat_map(|cell| mesh.area_parts(*cell)).collect()
        }
        [_, _, false] => along(&group.lines),
        _ => group.nodes.iter().map(|node| (*node, 1.0)).collect(),
    };
    let total: f64 = measures.iter().map(|(_, measure)| measure).sum();
    let shares = measures.into_iter();
    shares
        .map(|(node, measure)| (node, measure / total))
        .collect()
}

/// The mean displacement of a group in mm: over the length of its edges at rest, else over its cells, lines or nodes.
///
/// # Panics
/// When the mesh has no such group.
pub fn mean_displacement(mesh: &Mesh, group: &str, displacement: &[f64]) -> [f64; 2] {
    let shares = shares(mesh, &mesh.groups()[group]);
    mean(&shares, &|node, axis| displacement[2 * node + axis])
}

/// The mean of a vector at the nodes, by its components, over a group with these shares.
pub fn mean(shares: &[(usize, f64)], of_node: &dyn Fn(usize, usize) -> f64) -> [f64; 2] {
    [0, 1].map(|axis| {
        let parts = shares.iter();
        let parts = parts.map(|(node, share)| share * of_node(*node, axis));
        parts.fold(0.0, |sum, part| sum + part)
    })
}

/// The share of an edge's length that belongs to each of its nodes, in mm.
pub fn edge_lengths(mesh: &Mesh, edge: &[usize]) -> Vec<(usize, f64)> {
    let mut shares: Vec<(usize, f64)> = edge.iter().map(|node| (*node, 0.0)).collect();
    for (x, weight) in GAUSS_3 {
        let (values, slopes) = edge_functions(edge.len(), x);
        let tangent = [0, 1].map(|axis| {
            let nodes = edge.iter().zip(&slopes);
            nodes
                .map(|(node, slope)| slope * mesh.nodes[*node][axis])
                .sum::<f64>()
        });
        let length = tangent[0].hypot(tangent[1]);
        for (share, value) in shares.iter_mut().zip(values) {
            share.1 += weight * value * length;
        }
    }
    shares
}

/// Values and derivatives of an edge's functions at −1 ≤ x ≤ 1: both ends, then the middle.
fn edge_functions(nodes: usize, x: f64) -> (Vec<f64>, Vec<f64>) {
    if nodes == 2 {
        return (vec![0.5 * (1.0 - x), 0.5 * (1.0 + x)], vec![-0.5, 0.5]);
    }
    (
        vec![0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x],
        vec![x - 0.5, x + 0.5, -2.0 * x],
    )
}
