use std::sync::{Arc, LazyLock};

use super::*;
use crate::finite_element::{Element, FiniteElements};
use crate::material::{AnisotropicSheet, HolzapfelGasserOgden, HyperelasticLaw, NeoHooke};
use crate::mesh::CellShape;
use crate::problem::ClampedPlate;
use gelbench_mechanics::solve::NewtonSettings;

static LAW: LazyLock<Arc<dyn HyperelasticLaw>> = LazyLock::new(|| Arc::new(NeoHooke { c10: 0.05 }));

fn sheet(thickness: f64) -> Sheet<'static> {
    Sheet::elastic((&*LAW).into(), thickness)
}

/// The compression of a plate of 4 × 1 mm with a displacement field.
fn of(thickness: f64, field: impl Fn([f64; 2]) -> [f64; 2]) -> Wrinkling {
    let mesh = Mesh::plate([4.0, 1.0], [32, 8], CellShape::Quad9);
    let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
    Wrinkling::new(sheet(thickness), &mesh, &u)
}

#[test]
fn a_strut_exceeds_from_half_of_its_critical_stress_on() {
    let squeezed = |[x, y]: [f64; 2]| [-0.01 * x, (0.99_f64.powf(-0.5) - 1.0) * y];
    let stress = 0.1 * (0.99_f64.powi(2) - 1.0 / 0.99);
    // π² E h²/(12 (1 − ν²) L²) with E = 0.3 MPa, ν = ½, and the deformed h and L.
    let per_square = (std::f64::consts::PI / 3.96).powi(2) * 0.3 / 9.0 / 0.99;
    let half = (-2.0 * stress / per_square).sqrt();
    for (thickness, share) in [(0.98 * half, 100.0), (1.02 * half, 0.0)] {
        let wrinkling = of(thickness, squeezed);
        assert!(
            (wrinkling.area_percent - share).abs() < 1e-9,
            "{wrinkling:?}"
        );
        assert!((wrinkling.smallest[3] - stress).abs() < 1e-14);
        let [compression, critical] = wrinkling.worst;
        assert!((compression + stress).abs() < 1e-12);
        // Cells count as squares, which they are not any more by 1 %.
        assert!((critical / (per_square * thickness.powi(2)) - 1.0).abs() < 1e-4);
    }
}

#[test]
fn tension_and_rigid_motions_have_no_compression_and_bending_has_it_on_one_side() {
    let pulled = of(1e-3, |[x, y]| [0.2 * x, (1.2_f64.powf(-0.5) - 1.0) * y]);
    assert_eq!(pulled.area_percent, 0.0);
    let (sine, cosine) = 0.3_f64.sin_cos();
    let turned = of(1e-3, |[x, y]| {
        [
            3.0 + (cosine - 1.0) * x - sine * y,
            1.0 + sine * x + (cosine - 1.0) * y,
        ]
    });
    assert!(turned.smallest.iter().any(|stress| *stress != 0.0));
    assert_eq!(turned.area_percent, 0.0);
    let bend = |[x, y]: [f64; 2]| [1e-3 * x * (y - 0.5), -0.5e-3 * x * x];
    let thin = of(1e-3, bend).area_percent;
    assert!((37.0..=50.1).contains(&thin), "{thin}");
    assert_eq!(of(0.5, bend).area_percent, 0.0);
}

#[test]
fn a_cell_that_is_folded_in_its_middle_has_no_stress_and_counts_nowhere() {
    let pulled = of(0.1, |[x, _]| [0.2 * x, 0.0]);
    let folded = of(0.1, |[x, y]| {
        let middle = (x - 4.0).abs() < 1e-9 && (y - 0.0625).abs() < 1e-9;
        [0.2 * x - if middle { 1.0 } else { 0.0 }, 0.0]
    });
    let cells = folded.smallest.iter().zip(&pulled.smallest);
    let other: Vec<f64> = cells.filter(|(a, b)| a != b).map(|(a, _)| *a).collect();
    assert!(
        matches!(other[..], [stress] if stress.is_nan()),
        "{other:?}"
    );
    assert_eq!(folded.area_percent, 0.0);
}

/// The fields of a clamped sheet of the given aspect ratio and 1 mm width at nominal strains.
fn clamped(aspect: f64, strains: &[f64]) -> (Mesh, Vec<Vec<f64>>) {
    let plate = ClampedPlate {
        size: [aspect, 1.0],
        thickness: 1.0,
        law: Arc::clone(&LAW),
        stretches: strains.to_vec(),
    };
    let elements = FiniteElements::new(&plate, [(12.0 * aspect) as usize, 12], Element::Q2);
    let settings = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 30,
    };
    let states = elements.solve(&plate, settings, &|_| ()).unwrap();
    let fields = states.into_iter().map(|state| state.displacement);
    (elements.mesh.clone(), fields.collect())
}

/// The thickness over the width below which a sheet wrinkles.
fn critical_thickness(mesh: &Mesh, displacement: &[f64]) -> f64 {
    let mut range = [1e-5, 1e-1_f64];
    while range[1] > 1.05 * range[0] {
        let middle = (range[0] * range[1]).sqrt();
        let [compression, critical] = Wrinkling::new(sheet(middle), mesh, displacement).worst;
        range[usize::from(compression <= critical)] = middle;
    }
    range[0]
}

/// Expected are the thicknesses over the width at which the smallest eigenvalue of bending and membrane stiffness vanishes: neo-Hookean sheets
/// in plane stress with Kirchhoff bending about the stretched state (24 bilinear cells across for the plane, Bogner–Fox–Schmit cells for the
/// plate, clamped ends). They agree with what is published: sheets of width/thickness = 1000 and aspect ratio 2.5 wrinkle, most at about 10 %,
/// and no more at large strains (V. Nayyar, K. Ravi-Chandar, R. Huang, Int. J. Solids Struct. 48 (2011) 3471–3483 and 51 (2014) 1847–1858); one
/// of polyethylene, 25 cm × 10 cm × 0.01 cm, at 10 % (E. Cerda, K. Ravi-Chandar, L. Mahadevan, Nature 419 (2002) 579–580).
#[test]
fn clamped_sheets_wrinkle_at_the_thickness_of_an_eigenvalue_analysis_within_a_factor_of_two() {
    for (aspect, strains, expected) in [
        (2.0, &[0.05][..], &[0.00125][..]),
        (
            2.5,
            &[0.02, 0.1, 0.3, 0.5],
            &[0.00081, 0.00131, 0.00097, 0.00044],
        ),
        (3.0, &[0.2], &[0.00100]),
    ] {
        let (mesh, fields) = clamped(aspect, strains);
        for ((strain, u), expected) in strains.iter().zip(&fields).zip(expected) {
            let ratio = critical_thickness(&mesh, u) / expected;
            assert!((0.5..2.0).contains(&ratio), "{aspect}, {strain}: {ratio}");
            let area = |thickness: f64| Wrinkling::new(sheet(thickness), &mesh, u).area_percent;
            assert!(area(0.5 * expected) > 1.0, "{aspect}, {strain}");
            assert_eq!(area(5.0 * expected), 0.0, "{aspect}, {strain}");
        }
    }
}

#[test]
fn a_clamped_sheet_wrinkles_at_a_hundredth_of_a_millimetre_and_not_at_two() {
    // 150 × 50 mm, scaled to a width of 1 mm.
    let (mesh, fields) = clamped(3.0, &[0.3]);
    let warned = |thickness: f64| {
        let wrinkling = Wrinkling::new(sheet(thickness / 50.0), &mesh, &fields[0]);
        warning([("30 % stretch".to_owned(), wrinkling)].into_iter())
    };
    assert_eq!(warned(2.0), None);
    let thin = warned(0.01).unwrap();
    assert!(
        thin.contains("at 30 % stretch") && thin.contains("MPa are critical"),
        "{thin}"
    );
}

/// The same sheet with one family of fibres, compressed along them or across them.
#[test]
fn the_critical_compression_of_fibres_does_not_depend_on_how_the_sheet_lies() {
    for across in [0.0, 90.0] {
        let ratios = [0.0, 35.0, 90.0].map(|angle: f64| compression_of_fibres(angle, across));
        let [first, ..] = ratios;
        assert!(first > 0.0, "{ratios:?}");
        for ratio in ratios {
            assert!((ratio / first - 1.0).abs() < 1e-6, "{across}: {ratios:?}");
        }
    }
}

/// Compression by the critical one of a square that is compressed along an axis which is turned by an angle, with fibres at another angle to it.
fn compression_of_fibres(angle: f64, fibre: f64) -> f64 {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let (of_fibre, to_fibre) = (angle + fibre).to_radians().sin_cos();
    let law = HolzapfelGasserOgden {
        mu: 0.02,
        k1: 0.05,
        k2: 2.0,
        kappa: 0.0,
        fibres: vec![[1.0, 0.0]],
    };
    let fibres: Arc<dyn HyperelasticLaw> = Arc::new(AnisotropicSheet {
        law,
        axis: [to_fibre, of_fibre],
    });
    let turned = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    let squeezed = |[x, y]: [f64; 2]| turned([-0.01 * x, 0.005 * y]);
    let mut mesh = Mesh::plate([1.0, 1.0], [16, 16], CellShape::Quad9);
    let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| squeezed(*node)).collect();
    mesh.nodes.iter_mut().for_each(|node| *node = turned(*node));
    let sheet = Sheet {
        laws: (&fibres).into(),
        thickness: 0.02,
        past: &[],
        viscous: None,
    };
    let [compression, critical] = Wrinkling::new(sheet, &mesh, &u).worst;
    compression / critical
}
