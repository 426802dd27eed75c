//! Noisy markers on a stretched plate, and the nearest field in equilibrium: the force on the grip with its 95 % interval,
//! although no force was measured. The markers were made with a force of 12.87 N.
//!
//!     cargo run --release --example marker_field
//!
//! ```text
//! 333 markers, 7 outliers, noise 0.257 mm
//! force on right  12.890 ± 0.026 N
//! force on left  -12.890 ± 0.026 N
//! ```
use std::{error::Error, path::Path};

use gelbench::estimation::{EdgeCondition, Knowledge, Robust, Specimen, estimate};
use gelbench::markers::{ReadSettings, read};
use gelbench::material::Card;
use gelbench::mesh::{CellShape, Mesh};

pub fn report() -> Result<String, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/measured_plate.csv");
    let markers = read(&[file], &ReadSettings::default())?.series;
    let mesh = Mesh::plate([150.0, 50.0], [12, 4], CellShape::Quad9);
    let specimen = Specimen {
        mesh: &mesh,
        laws: Card::load("pva-10", Path::new("."))?.law.into(),
        thickness: 2.0,
    };
    let known = |edge: &str, condition| (edge.to_owned(), condition);
    let knowledge = Knowledge {
        edges: vec![
            known("left", EdgeCondition::Rigid),
            known("right", EdgeCondition::Rigid),
            known("bottom", EdgeCondition::Free),
            known("top", EdgeCondition::Free),
        ],
        robust: Robust::Tukey,
        ..Knowledge::default()
    };
    let frame = &markers.frames[1];
    let result = estimate(&specimen, &frame.markers, &knowledge)?;
    let judged = result.markers.iter().flatten();
    let outliers = judged.filter(|marker| marker.outlier).count();
    let (count, noise) = (frame.markers.len(), result.noise);
    let mut text = format!("{count} markers, {outliers} outliers, noise {noise:.3} mm\n");
    for edge in &result.forces {
        let ([x, _], name) = (edge.force, &edge.edge);
        let reach = result.reach * x.standard_error;
        text += &format!("force on {name:<5} {:>7.3} ± {reach:.3} N\n", x.value);
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
