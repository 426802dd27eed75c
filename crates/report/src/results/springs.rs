//! The springs of a lattice as a table: what another program needs to build them again.

use crate::document::write_records;
use crate::mass_spring::{MassSpring, Spring};

/// The heads of the table.
const HEAD: [&str; 12] = [
    "spring",
    "node_1",
    "node_2",
    "X_1_mm",
    "Y_1_mm",
    "X_2_mm",
    "Y_2_mm",
    "rest_length_mm",
    "cross_section_mm2",
    "stiffness_at_rest_N_per_mm",
    "stretch",
    "force_N",
];

/// One line for each spring, in the order of the VTK files, springs and nodes numbered from 0: ends at rest, rest length x₀,
/// cross-section a, stiffness a E/x₀ at rest, and stretch and force at the displacements of the nodes after a history, which is
/// empty where the lattice was never loaded.
pub fn springs_csv(model: &MassSpring, displacement: &[f64], history: &[f64]) -> String {
    let states = model.spring_states(displacement, history);
    let record = |(number, spring): (usize, &Spring)| {
        let numbers = [number].into_iter().chain(spring.nodes);
        let positions = spring.nodes.into_iter();
        let positions = positions.flat_map(|node| model.mesh.nodes[node]);
        let stiffness = model.stiffness_at_rest(number);
        let state = &states[number];
        let values = [
            spring.rest_length,
            spring.area,
            stiffness,
            state.stretch,
            state.force,
        ];
        let numbers = numbers.map(|number| number.to_string());
        let values = positions.chain(values).map(|value| value.to_string());
        numbers.chain(values).collect::<Vec<String>>()
    };
    let head = HEAD.map(str::to_owned).to_vec();
    let springs = model.springs.iter().enumerate().map(record);
    write_records(std::iter::once(head).chain(springs))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::document::Table;
    use crate::mass_spring::LatticeSettings;
    use crate::material::NeoHooke;
    use crate::problem::ClampedPlate;

    /// Square cells of E = 0.3 MPa and t = 2 mm: edges inside ¾ E t, on the border half of it, diagonals ⅜ E t.
    #[test]
    fn stiffnesses_of_square_cells_are_those_of_the_guide() {
        let plate = ClampedPlate {
            size: [30.0, 20.0],
            thickness: 2.0,
            law: Arc::new(NeoHooke { c10: 0.05 }),
            stretches: vec![0.5],
        };
        let model = MassSpring::new(&plate, [6, 4], LatticeSettings::default());
        let stretched = model.mesh.nodes.iter().flat_map(|[x, _]| [0.5 * x, 0.0]);
        let text = springs_csv(&model, &stretched.collect::<Vec<_>>(), &[]);
        let table = Table::parse("springs.csv", &text).unwrap();
        assert_eq!(table.rows.len(), model.springs.len());
        let mut edges_inside = 0;
        for (row, _) in &table.rows {
            let [x1, y1, x2, y2] = [row[3], row[4], row[5], row[6]];
            let on_border =
                y1 == y2 && [0.0, 20.0].contains(&y1) || x1 == x2 && [0.0, 30.0].contains(&x1);
            let is_diagonal = x1 != x2 && y1 != y2;
            let share = if is_diagonal || on_border {
                0.375
            } else {
                0.75
            };
            edges_inside += usize::from(share == 0.75);
            assert!((row[9] - share * 0.3 * 2.0).abs() < 1e-14, "{row:?}");
            assert!((row[7] - (x2 - x1).hypot(y2 - y1)).abs() < 1e-14);
            // P = 2 C₁₀ (λ − 1/λ²) along x, nothing along y.
            if y1 == y2 {
                let stress = 0.1 * (1.5 - 1.0 / 2.25);
                assert!((row[10] - 1.5).abs() < 1e-14);
                assert!((row[11] - row[8] * stress).abs() < 1e-14);
            } else if x1 == x2 {
                assert!(row[11].abs() < 1e-14);
            }
        }
        assert_eq!(edges_inside, 6 * 3 + 5 * 4);
    }
}
