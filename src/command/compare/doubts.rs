//! What makes the figures of a comparison doubtful.

use gelbench_base::error::Diagnostic;
use gelbench_report::compare::imported::Difference;

/// Displacements that all models find larger or smaller by one factor, be it the ratio of two
/// units or of two load factors.
pub fn doubts(differences: &[Difference], at: f64) -> Vec<Diagnostic> {
    let ratios: Option<Vec<f64>> = differences.iter().map(Difference::other_unit).collect();
    let ratio = ratios.filter(|ratios| ratios.iter().all(|ratio| *ratio == ratios[0]));
    let doubt = ratio.map(|ratios| {
        let relation = if differences[0].factor.abs() > 1.0 { "small" } else { "large" };
        let message = format!(
            "the imported displacements are about {} times too {relation}, as if in another unit of length",
            ratios[0]
        );
        Diagnostic::warning("", message).hint("state the file's unit with --unit")
    });
    let scaled = differences.iter().all(Difference::is_scaled);
    let doubt = doubt.or_else(|| {
        let share = 1.0 / differences[0].factor;
        scaled.then(|| {
            let message = format!(
                "the imported displacements are about {share:.3} times those of the models at the load factor {at}, as if at another load factor"
            );
            Diagnostic::warning("", message).hint("state the file's load factor with --factor")
        })
    });
    // The finite elements come first.
    let shifted = differences
        .first()
        .filter(|difference| doubt.is_none() && difference.is_shifted());
    doubt.into_iter().chain(shifted.map(shift_doubt)).collect()
}

/// The difference of finite elements that is mostly a rigid-body motion, which does not concern the material.
fn shift_doubt(finite_elements: &Difference) -> Diagnostic {
    let Difference {
        shift,
        percent,
        shifted_percent,
        ..
    } = finite_elements;
    let [x, y] = shift.displacement;
    let message = format!(
        "most of the finite elements' difference is a rigid-body motion by ({x:.4}, {y:.4}) mm and {:.4} degrees: without it the difference is \
         {shifted_percent:.4} instead of {percent:.4} %",
        shift.angle.to_degrees()
    );
    Diagnostic::warning("", message)
        .hint("remove it from the file, or correct the axes or the supports of the study")
}
