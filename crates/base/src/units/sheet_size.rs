//! Whether the measures of a sheet belong together: a length in another unit shows as a ratio that no sheet has.

use super::{extents, number};

/// A sheet thicker than this share of its smaller extent is none.
const THICK: f64 = 0.5;

/// No specimen's mean extent is more than this multiple of its thickness.
const LARGEST_RATIO: f64 = 1e4;

/// No specimen is larger than this, in mm, and thinner than one 500th of it.
const LARGEST_SPECIMEN: [f64; 2] = [3000.0, 500.0];

/// What speaks against a thin sheet with these extents and this thickness in mm, in a sentence without a full stop; `None` of plausible
/// measures.
///
/// ```text
/// t > ½ min(a, b)     or     √(a b) > 10⁴ t     or     √(a b) > 3 m and √(a b) > 500 t
/// ```
///
/// A film of 10 µm and 10 cm has a ratio of 10⁴, which is the thinnest sheet that can be clamped and pulled; sheets of several metres are
/// parts of buildings. Millimetres that are read as metres exceed one of both limits for every sheet wider than 3 mm.
pub fn implausible_sheet(size: [f64; 2], thickness: f64) -> Option<String> {
    let mean = (size[0] * size[1]).sqrt();
    let ratio = mean / thickness;
    let [metres, thin] = LARGEST_SPECIMEN;
    let reason = if thickness > THICK * size[0].min(size[1]) {
        "plane stress assumes a thin sheet".to_owned()
    } else if ratio > LARGEST_RATIO || (mean > metres && ratio > thin) {
        format!(
            "its extent is {} times its thickness, as of no sheet that is tested",
            number(ratio.round())
        )
    } else {
        return None;
    };
    Some(format!(
        "the sheet measures {} and is {thickness} mm thick: {reason}",
        extents(size)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_of_laboratories_are_plausible_and_none_in_metres_instead_of_millimetres_is() {
        for ([length, width], thickness) in [
            ([150.0, 50.0], 2.0),
            ([150.0, 50.0], 0.01),
            ([250.0, 100.0], 0.1),
            ([20.0, 10.0], 2.0),
            ([7.0, 7.0], 0.5),
            ([1500.0, 1000.0], 1.0),
        ] {
            assert_eq!(implausible_sheet([length, width], thickness), None);
            let in_metres = [1e3 * length, 1e3 * width];
            let message = implausible_sheet(in_metres, thickness).unwrap();
            assert!(message.contains("times its thickness"), "{message}");
        }
        let thick = implausible_sheet([15.0, 5.0], 20.0).unwrap();
        assert!(
            thick.contains("15.0000 × 5.0000 mm and is 20 mm thick: plane stress"),
            "{thick}"
        );
    }
}
