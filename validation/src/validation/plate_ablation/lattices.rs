//! The same correction from wrong springs and from lattices of other topologies.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::fields::Fields;
use crate::corrector::plate::KnownConditions;
use crate::error::Error;
use crate::mass_spring::{MassSpring, Spring};
use crate::statistics::larger;
use crate::validation::case::{Block, Claim, Outcome, Progress, check, number, row, table};

/// How wrong springs are: their cross-sections are changed by up to this share.
#[derive(Clone, Copy)]
pub struct Disturbance {
    pub share: f64,
    pub seed: u64,
}

/// A lattice with other cross-sections than the regular one.
#[derive(Clone, Copy)]
enum Variant {
    Random,
    NoDiagonals,
    /// The rising one of each cell.
    OneDiagonal,
    /// Rising and falling ones by turns.
    Triangulated,
}

impl Variant {
    const ALL: [(&'static str, Self); 4] = [
        ("cross-sections changed at random", Self::Random),
        ("no diagonals", Self::NoDiagonals),
        ("one diagonal", Self::OneDiagonal),
        ("triangulated", Self::Triangulated),
    ];

    fn lattice(self, fields: &Fields, disturbance: Disturbance) -> MassSpring {
        let mesh = &fields.lattice.mesh;
        let size = mesh.cell_size(0);
        let range = 1.0 - disturbance.share..=1.0 + disturbance.share;
        let mut random = ChaCha8Rng::seed_from_u64(disturbance.seed);
        let mut factor = |spring: &Spring| {
            let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
            let slope = (to[0] - from[0]) * (to[1] - from[1]);
            let cell = [0, 1].map(|axis| (0.5 * (from[axis] + to[axis]) / size[axis]) as usize);
            let is_even = (cell[0] + cell[1]) % 2 == 0;
            let twice_if = |stays: bool| if stays { 2.0 } else { 0.0 };
            match self {
                Self::Random => random.random_range(range.clone()),
                _ if slope == 0.0 => 1.0,
                Self::NoDiagonals => 0.0,
                Self::OneDiagonal => twice_if(slope > 0.0),
                Self::Triangulated => twice_if((slope > 0.0) == is_even),
            }
        };
        let lattice = fields.plate.lattice();
        lattice.with_areas(|spring| spring.area * factor(spring))
    }
}

/// Departures from affine before, in between and after, and the distance of the fields to each other.
pub fn compare(
    fields: &Fields,
    disturbance: Disturbance,
    progress: Progress,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    let mut rows = Vec::new();
    let mut worst = 0.0;
    for (name, variant) in Variant::ALL {
        progress.tell(name);
        let lattice = variant.lattice(fields, disturbance);
        let field = fields.plate.solve(&lattice)?.displacement;
        let corrected = fields.correct(&field, KnownConditions::ALL)?;
        let departures = fields.departures(&corrected);
        let last = departures.len() - 1;
        let end = &corrected.state.displacement;
        worst = larger(worst, fields.far(end));
        let [before, first, second] = [0, 1, 2.min(last)].map(|step| departures[step]);
        let mut row = row(name, [before, first, second, fields.departure(end)]);
        row.push(last.to_string());
        rows.push(row);
    }
    let text = "The same correction from wrong springs and other lattice topologies, departure from affine:";
    let head = "lattice | before [%] | after one step [%] | after two [%] | at the end [%] | steps";
    outcome
        .blocks
        .extend([Block::paragraph(text), table(head, rows)]);
    let what = "corrected fields of all lattices compared with each other, relative L2";
    let source = "publication: independent of topology and spring constants";
    outcome
        .checks
        .push(check(what, "–", worst).at_most(1e-6, source));
    outcome.claims.push(Claim {
        claim: "Corrections are independent of the system's topology and spring constants",
        reproduced: format!(
            "springs changed by up to {} %, three other topologies: the same field to {}",
            number(100.0 * disturbance.share),
            number(worst)
        ),
    });
    Ok(())
}
