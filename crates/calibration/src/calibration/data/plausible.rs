//! Test data that are impossible or implausible.

use super::columns::{Scaled, sized};
use super::roles::Role;
use super::rounding::WrittenColumn;
use super::strain_column::{FLIP, StrainColumn};
use super::test_data::{Observation, Test};
use crate::document::{Faulty, Head};
use crate::error::Diagnostic;
use crate::statistics::{farthest, median};
use crate::units::decimals;

/// Positive strains below this share of the largest count as rest in a test of compression.
const SCATTER: f64 = 1e-3;

/// What to do about a machine's displacements, whose sign is turned already.
const OF_MACHINE: &str = "displacements count from where pressing begins: state that place, such as the one of the first row, by \
                          --zero \"… mm\"";

/// Refuses data without information, and tests of compression that count pressing as positive; `column` has the strains, where they are not
/// the displacements of a machine, whose signs are turned.
pub fn check_signs(
    head: &Head,
    observations: &[Observation],
    test: Test,
    column: Option<StrainColumn>,
) -> Faulty<()> {
    let strains = || observations.iter().map(Observation::strain);
    let is_zero = observations.iter().all(|one| one.stress == 0.0)
        || observations
            .iter()
            .all(|one| one.strains.iter().all(|x| *x == 0.0 || x.is_nan()));
    if is_zero {
        let hint = "look at the columns and their units";
        return Err(head.fault(0..0, "all strains or all stresses are zero", hint));
    }
    let work = || observations.iter().map(|one| one.strain() * one.stress);
    let compression = head.setting("test", None)?.as_deref() == Some("compression");
    // A machine's reading at rest scatters about zero.
    let at_rest = strains().fold(0.0, |most: f64, x| most.max(-x)) * SCATTER;
    if compression && strains().any(|x| x > at_rest) {
        let message = "a compression test has positive strains";
        let least = -SCATTER * farthest(strains());
        let is_reversed = strains().all(|x| x >= least) && head.setting(FLIP, None)?.is_none();
        let acts_along = work().sum::<f64>() > 0.0;
        let hint = match column {
            None => OF_MACHINE,
            Some(StrainColumn::Stretch) => "give stretches below 1, and stresses a minus sign",
            Some(_) if is_reversed && acts_along => {
                "--flip both gives strains and stresses of compression a minus sign"
            }
            Some(_) if is_reversed => "--flip strain gives strains of compression a minus sign",
            Some(_) => "give strains and stresses of compression a minus sign",
        };
        return Err(head.fault_of("test", message, hint));
    }
    // A stress acts against the strain of a single driven axis only during recoil; of two axes, the second may be held back.
    let against = !work().any(|work| work > 0.0) && work().any(|work| work < 0.0);
    if against && test != Test::Biaxial {
        let message = "the stresses have the sign that is opposite to the strains";
        let hint =
            "tension is positive in both columns, compression negative: reverse the sign of one";
        return Err(head.fault(0..0, message, hint));
    }
    Ok(())
}

/// Refuses displacements that contradict the sizes along their axis: a size less its displacement is the length at rest, in every row.
pub fn check_sizes(head: &Head, roles: &[Role]) -> Faulty<()> {
    /// Besides the digits of both columns, differences below this share of the largest displacement are rounding.
    const ROUNDING: f64 = 5e-3;
    let table = head.table;
    let all: Vec<usize> = (0..table.rows.len()).collect();
    let value = |row: usize, (column, factor): Scaled| factor * table.rows[row].0[column];
    let step =
        |(column, factor): Scaled| factor * WrittenColumn::of(table, column, &all).largest_step();
    for axis in [0, 1] {
        let Some((size, Some(displacement))) = sized(head, roles, axis) else {
            continue;
        };
        let at_rest = |row: usize| value(row, size) - value(row, displacement);
        let known = all.iter().copied().filter(|row| at_rest(*row).is_finite());
        let known: Vec<usize> = known.collect();
        let Some(first) = known.first().map(|row| at_rest(*row)) else {
            continue;
        };
        let far = farthest(known.iter().map(|row| value(*row, displacement))).abs();
        let off = |row: usize| (at_rest(row) - first).abs();
        // The digits are read from the whole file: only where they decide.
        if known.iter().all(|row| off(*row) <= ROUNDING * far) {
            continue;
        }
        let rounding = step(size) + step(displacement) + ROUNDING * far;
        let contradicts = |row: &&usize| off(**row) > rounding;
        if let Some(row) = known.iter().find(contradicts) {
            let [size, displacement] =
                [size, displacement].map(|(column, _)| table.columns[column].head());
            let message = format!(
                "`{size}` less `{displacement}` is {} mm here and {} mm in the first row: it has to be the length at rest in every row",
                decimals(at_rest(*row), 6),
                decimals(first, 6)
            );
            let hint = "correct the unit in the head of one of them, or exchange heads that stand above the other axis; where --length and \
                        --width are stated, sizes are not read";
            return Err(head.fault(table.rows[*row].1.clone(), message, hint));
        }
    }
    Ok(())
}

/// The warning about a stress at zero strain where none was subtracted: a preload, or a load cell that was not set to zero.
pub fn stress_at_rest(head: &Head, observations: &[Observation]) -> Option<Diagnostic> {
    /// Rows by whose second differences noise is estimated.
    const ROWS: usize = 12;
    /// Standard deviations, and a share of the largest stress, below which a stress counts as zero.
    const SIGNIFICANT: f64 = 4.0;
    const NEGLIGIBLE: f64 = 0.005;
    /// A strain below this share of the largest counts as zero.
    const AT_REST: f64 = 1e-3;
    let strain = farthest(observations.iter().map(Observation::strain)).abs();
    let stress = Observation::largest_stress(observations);
    let first = observations.first()?;
    let axis = |one: &&Observation| one.axis == first.axis;
    let rows: Vec<f64> = observations
        .iter()
        .filter(axis)
        .map(|one| one.stress)
        .take(ROWS)
        .collect();
    let bends = rows
        .windows(3)
        .map(|triple| (triple[0] - 2.0 * triple[1] + triple[2]).abs());
    // The variance of the second differences of white noise is six times that of the noise.
    let noise = 1.4826 * median(bends) / 6.0_f64.sqrt();
    let is_at_rest = first
        .strains
        .iter()
        .all(|x| x.is_nan() || x.abs() <= AT_REST * strain);
    let acts = first.stress.abs() > (SIGNIFICANT * noise).max(NEGLIGIBLE * stress);
    (rows.len() >= 5 && is_at_rest && acts).then(|| {
        let message = format!(
            "{}: at the first row the strain is zero, but the stress is {:.2} % of the largest, more than its scatter",
            head.table.source.name,
            100.0 * first.stress / stress
        );
        let hint = "if the specimen was preloaded, count strains from its unloaded state; if the load cell was not set to zero, subtract its reading \
                    from the forces; otherwise parameters are biased";
        Diagnostic::warning("", message).hint(hint)
    })
}

/// The warning about strains that are so large that they may be in percent, or that begin at 1 as stretches do.
pub fn implausible(
    head: &Head,
    strain: StrainColumn,
    observations: &[Observation],
) -> Option<Diagnostic> {
    /// λ − 1: stretches of soft gels reach about 20.
    const MOST: f64 = 20.0;
    let about = match strain {
        StrainColumn::Stretch => "stretches",
        StrainColumn::Strain(_) | StrainColumn::GreenLagrange => "strains",
    };
    let name = &head.table.source.name;
    let largest = farthest(observations.iter().flat_map(|one| one.strains)).abs();
    let (message, hint) = if largest > MOST {
        (
            format!("{name}: the {about} reach λ = {:.4}", 1.0 + largest),
            "if the column is in percent, write [%] after its name instead of [-]",
        )
    } else if strain != StrainColumn::Stretch && begin_at_one(observations) {
        (
            format!(
                "{name}: the strains begin at 1, where the stress is nearly zero, as stretches do"
            ),
            "if the column is a stretch, name it `stretch` instead of a strain",
        )
    } else {
        return None;
    };
    Some(Diagnostic::warning("", message).hint(hint))
}

/// Whether the smallest strain is 1 within a tenth, with less than a twentieth of the largest stress.
fn begin_at_one(observations: &[Observation]) -> bool {
    let observed = observations.iter();
    let first = observed.min_by(|a, b| a.strain().total_cmp(&b.strain()));
    let largest = Observation::largest_stress(observations);
    first.is_some_and(|first| {
        (0.9..1.1).contains(&first.strain()) && first.stress.abs() < 0.05 * largest
    })
}

#[cfg(test)]
mod tests {
    use crate::calibration::tests::helpers::parsed;

    #[test]
    fn a_stress_at_rest_is_told_where_it_is_more_than_scatter() {
        let output = |head: &str, rest: f64, noise: f64| {
            let mut text = format!("# test: uniaxial\n{head}\n");
            for row in 0..30 {
                let strain = 0.01 * f64::from(row);
                let scatter = noise * f64::from((7 * row) % 5 - 2);
                text += &format!("{strain:.3},{:.6}\n", rest + 0.3 * strain + scatter);
            }
            let read = parsed(&text);
            let mut warnings = read.warnings.iter();
            warnings.any(|warning| warning.message.contains("the strain is zero"))
        };
        let table = "nominal_strain [-],nominal_stress [MPa]";
        assert!(output(table, 0.01, 0.0) && output(table, 0.01, 1e-4));
        assert!(!output(table, 0.0, 1e-4) && !output(table, 1e-4, 0.0));
        assert!(!output(table, 0.002, 2e-3));
    }
}
