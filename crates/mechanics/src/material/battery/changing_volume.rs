//! Sheets that change their volume: textbook formulas of the usual tests, small strain, and the incompressible limit.

use super::*;
use crate::material::sheet::PlaneState;
use crate::material::volume::{Volume, VolumeEnergy, bulk_modulus};
use crate::statistics::bisect;

mod textbook;

use textbook::{Principal, textbook};

/// All laws of bodies that change their volume, in plane stress and in plane strain.
pub(super) fn sheets() -> NamedLaws {
    let compressible = samples::changing_volume().into_iter().flat_map(|card| {
        let strain = card.law.in_plane_strain().expect("a law of volume change");
        let named = |law: Arc<dyn HyperelasticLaw>| {
            (format!("{} in {:?}", card.name, law.plane_state()), law)
        };
        [named(Arc::clone(&card.law)), named(strain)]
    });
    split_sheets().into_iter().chain(compressible).collect()
}

/// All laws that keep their volume and are isotropic, with all resistances to a change of it.
fn split_sheets() -> NamedLaws {
    let synthetic: (&str, Arc<dyn HyperelasticLaw>) = ("synthetic", Arc::new(Synthetic));
    let laws = samples::all().into_iter().chain([synthetic]);
    let sheets = laws.flat_map(|(name, law)| {
        let sheet = move |(plane, poisson_ratio, energy)| {
            let volume = Volume {
                bulk_modulus: bulk_modulus(law.shear_modulus(), poisson_ratio),
                energy,
                plane,
            };
            let sheet = Arc::clone(&law).with_volume(volume)?;
            let label = format!("{name} in {plane:?}, ν = {poisson_ratio}, {energy:?}");
            Some((label, sheet))
        };
        [
            (PlaneState::Stress, 0.3, VolumeEnergy::Quadratic),
            (PlaneState::Stress, 0.49, VolumeEnergy::Quadratic),
            (PlaneState::Strain, 0.4, VolumeEnergy::Quadratic),
            (PlaneState::Stress, 0.3, VolumeEnergy::Logarithmic),
            (PlaneState::Strain, 0.3, VolumeEnergy::Logarithmic),
            (PlaneState::Stress, 0.4, VolumeEnergy::SimoTaylor),
            (PlaneState::Strain, 0.4, VolumeEnergy::SimoTaylor),
        ]
        .into_iter()
        .filter_map(sheet)
    });
    sheets.collect()
}

/// The root of a rising function between 0.2 and 5, by bisection.
fn root(function: impl Fn(f64) -> f64) -> f64 {
    let [high, low] = bisect([5.0, 0.2], 200, |x| function(x) >= 0.0);
    0.5 * (low + high)
}

/// The stretches of a test whose first one is known.
fn stretches(principal: &Principal, mode: Mode, plane: PlaneState, first: f64) -> [f64; 3] {
    let across = |second: f64| match plane {
        PlaneState::Stress => root(|third| principal([first, second, third])[2]),
        PlaneState::Strain => 1.0,
    };
    let second = match mode {
        Mode::Uniaxial => root(|second| principal([first, second, across(second)])[1]),
        Mode::Planar => 1.0,
        Mode::Equibiaxial => first,
    };
    [first, second, across(second)]
}

#[test]
fn stress_and_thickness_of_the_usual_tests_are_the_textbooks() {
    for (name, law, principal) in textbook() {
        for law in [Arc::clone(&law), law.in_plane_strain().unwrap()] {
            for (_, mode) in Mode::ALL {
                for strain in [-0.2, -1e-3, 0.05, 0.4] {
                    let expected = stretches(&principal, mode, law.plane_state(), 1.0 + strain);
                    let stress = principal(expected)[0];
                    let computed = mode.nominal_stress(&*law, strain);
                    let context = format!("{name} {:?} {mode:?} {strain}", law.plane_state());
                    crate::assert_near(computed, stress, 1e-9, &context);
                    let state = mode.gradient(&*law, strain).unwrap();
                    let thickness = law.thickness_stretch(&Kinematics::new(&state).unwrap());
                    assert!(
                        (thickness - expected[2]).abs() < 1e-12,
                        "{context}: {thickness}"
                    );
                    let pressed = principal(expected)[2] / (expected[0] * expected[1]);
                    let computed = law.thickness_stress(&Kinematics::new(&state).unwrap());
                    let thickness_stress = if law.is_objective() {
                        pressed
                    } else {
                        principal(expected)[2]
                    };
                    assert!(
                        (computed - thickness_stress).abs() < 1e-12,
                        "{context}: {computed} {thickness_stress}"
                    );
                }
            }
        }
    }
}

/// P = (R ∂W/∂λ Qᵀ) of the polar decomposition of simple shear: stretches λ and 1/λ with λ − 1/λ = γ.
///
/// ```text
/// P₁₂ = dW/dγ,   dλ/dγ = λ²/(1 + λ²)
/// ```
#[test]
fn simple_shear_is_the_textbooks() {
    for (name, law, principal) in textbook() {
        if !law.is_objective() {
            continue;
        }
        for law in [Arc::clone(&law), law.in_plane_strain().unwrap()] {
            for amount in [1e-3, 0.2, 0.6] {
                let first = 0.5 * (amount + f64::hypot(amount, 2.0));
                let third = match law.plane_state() {
                    PlaneState::Stress => root(|third| principal([first, 1.0 / first, third])[2]),
                    PlaneState::Strain => 1.0,
                };
                let w = principal([first, 1.0 / first, third]);
                let slope = first * first / (1.0 + first * first);
                let expected = slope * (w[0] - w[1] / (first * first));
                let computed = curve::simple_shear(&*law, amount);
                crate::assert_near(computed, expected, 1e-10, &name);
            }
        }
    }
}

/// ```text
/// ogden-hill, one ν    λ₂ = λ₃ = λ^(−ν),   P = 2 μ/α (λ^α − λ^(−α ν))/λ
/// Saint Venant         uniaxial ½ E λ (λ² − 1),   planar 1/(1 − ν²),   equibiaxial 1/(1 − ν) of it
/// Blatz-Ko foam        P = μ (λ^(2 ν − 1) − λ⁻³), shear P₁₂ = μ γ
/// ```
#[test]
fn laws_with_closed_forms_have_them() {
    let near = |computed: f64, expected: f64, label: &str| {
        crate::assert_near(computed, expected, 1e-11, &label);
    };
    let of = |law: &str, parameters: &str| samples::card(law, parameters).law;
    let foam = of(
        "ogden-hill-1",
        "mu_1 = \"0.05 MPa\"\nalpha_1 = 3.5\nnu_1 = 0.2",
    );
    let kirchhoff = of(
        "saint-venant-kirchhoff",
        "mu = \"0.05 MPa\"\npoisson_ratio = 0.2",
    );
    let blatz_ko = of(
        "blatz-ko",
        "mu = \"0.05 MPa\"\nshare = 0\npoisson_ratio = 0.25",
    );
    for strain in [-0.2, 0.1, 0.45] {
        let l: f64 = 1.0 + strain;
        let uniaxial = |law: &dyn HyperelasticLaw| Mode::Uniaxial.nominal_stress(law, strain);
        let expected = 0.1 / 3.5 * (l.powf(3.5) - l.powf(-0.7)) / l;
        near(uniaxial(&*foam), expected, "foam");
        let plain = 0.06 * l * (l * l - 1.0);
        near(uniaxial(&*kirchhoff), plain, "Saint Venant");
        for (mode, factor) in [(Mode::Planar, 0.96), (Mode::Equibiaxial, 0.8)] {
            near(
                mode.nominal_stress(&*kirchhoff, strain),
                plain / factor,
                "Saint Venant",
            );
        }
        let expected = 0.05 * (l.powf(-0.5) - l.powi(-3));
        near(uniaxial(&*blatz_ko), expected, "Blatz and Ko");
        near(
            curve::simple_shear(&*blatz_ko, strain),
            0.05 * strain,
            "Blatz and Ko",
        );
    }
}

/// E = 9 κ μ/(3 κ + μ) in plane stress, E/(1 − ν²) in plane strain; ν across the sheet.
#[test]
fn small_strain_moduli_are_those_of_shear_and_bulk_modulus() {
    for (name, law) in sheets() {
        let (mu, kappa) = (law.shear_modulus(), law.bulk_modulus().unwrap());
        let young = 9.0 * kappa * mu / (3.0 * kappa + mu);
        let nu = young / (2.0 * mu) - 1.0;
        let expected = match law.plane_state() {
            PlaneState::Stress => young,
            PlaneState::Strain => young / (1.0 - nu * nu),
        };
        crate::assert_near(law.youngs_modulus(), expected, 1e-10, &name);
        let thinning = law.thickness_gradient(&Kinematics::rest());
        let across = match law.plane_state() {
            PlaneState::Stress => -nu / (1.0 - nu),
            PlaneState::Strain => 0.0,
        };
        assert!(
            (thinning[0] - across).abs() < 1e-12 && (thinning[3] - across).abs() < 1e-12,
            "{name}"
        );
    }
}

#[test]
fn the_slope_of_the_thickness_is_its_derivative_and_the_surfaces_are_free() {
    for (name, law) in sheets() {
        for h in STATES.map(gradient) {
            let kinematics = Kinematics::new(&h).unwrap();
            let slope = law.thickness_gradient(&kinematics);
            for i in 0..4 {
                let thickness = |step: f64| {
                    let mut moved = h;
                    moved[i] += step;
                    law.thickness_stretch(&Kinematics::new(&moved).unwrap())
                };
                let error = best_difference(slope[i], 1.0 + slope.norm(), thickness);
                assert!(error < 1e-9, "{name} {h:?} {i}: {error:.1e}");
            }
            if law.plane_state() == PlaneState::Stress {
                assert_eq!(law.thickness_stress(&kinematics), 0.0);
            }
        }
    }
}

/// Pairs of a law in plane stress with a Poisson's ratio and the law that keeps its volume.
fn limits(poisson_ratio: f64) -> Vec<(String, [Arc<dyn HyperelasticLaw>; 2])> {
    let of = |law: &str, parameters: &str| samples::card(law, parameters).law;
    let split = samples::all().into_iter().flat_map(|(name, law)| {
        VolumeEnergy::NAMES
            .into_iter()
            .filter_map(move |(energy_name, energy)| {
                let volume = Volume {
                    bulk_modulus: bulk_modulus(law.shear_modulus(), poisson_ratio),
                    energy,
                    plane: PlaneState::Stress,
                };
                let sheet = Arc::clone(&law).with_volume(volume)?;
                Some((format!("{name}, {energy_name}"), [sheet, Arc::clone(&law)]))
            })
    });
    let ratio = format!("poisson_ratio = {poisson_ratio}");
    let neo_hooke = ["neo-hooke-simo-pister", "neo-hooke-ciarlet"].map(|name| {
        let near = of(name, &format!("mu = \"0.05 MPa\"\n{ratio}"));
        (
            name.to_owned(),
            [near, of("neo-hooke", "c10 = \"0.025 MPa\"")],
        )
    });
    let shares = format!("mu = \"0.05 MPa\"\nshare = 0.7\n{ratio}");
    let mooney = of(
        "mooney-rivlin",
        "c10 = \"0.0175 MPa\"\nc01 = \"0.0075 MPa\"",
    );
    let term = "mu_1 = \"0.05 MPa\"\nalpha_1 = 3.1";
    let foam = of("ogden-hill-1", &format!("{term}\nnu_1 = {poisson_ratio}"));
    let ogden = of("ogden-1", &format!("{term}\nconvention = \"2mu/alpha^2\""));
    split
        .chain(neo_hooke)
        .chain([
            ("blatz-ko".to_owned(), [of("blatz-ko", &shares), mooney]),
            ("ogden-hill-1".to_owned(), [foam, ogden]),
        ])
        .collect()
}

/// The difference to the law that keeps its volume falls as 1/κ, and so as 1 − 2ν: at ν = 0.4999 it is what the material does, up to
/// 2.5 (1 − 2ν) of the stress, and stresses at two ratios extrapolate to its own.
#[test]
fn the_incompressible_limit_is_the_law_that_keeps_its_volume() {
    for ((name, [near, exact]), (_, [nearer, _])) in limits(0.4998).into_iter().zip(limits(0.4999))
    {
        for h in [
            [0.05, 0.01, -0.02, -0.03],
            [0.2, 0.1, 0.0, -0.1],
            [-0.1, 0.0, 0.05, 0.08],
        ] {
            let [near, nearer, exact] =
                [&near, &nearer, &exact].map(|law| stress(&**law, &gradient(h)));
            let off = |computed: &PlaneTensor| (computed - exact).norm() / exact.norm();
            let compressibility = 1.0 - 2.0 * 0.4999;
            assert!(
                off(&nearer) < 2.5 * compressibility,
                "{name} {h:?}: {:.1e}",
                off(&nearer)
            );
            let limit = 2.0 * nearer - near;
            assert!(off(&limit) < 1e-6, "{name} {h:?}: {:.1e}", off(&limit));
        }
    }
}

/// A sheet of Saint Venant and Kirchhoff's law whose Green strains add up to more than ½ (1 − ν)/ν has no thickness; there is no
/// stress rather than a wrong one.
#[test]
fn a_sheet_without_a_thickness_has_no_stress() {
    let law = samples::card(
        "saint-venant-kirchhoff",
        "mu = \"0.05 MPa\"\npoisson_ratio = 0.3",
    )
    .law;
    let at = |strain: f64| stress(&*law, &gradient([strain, 0.0, 0.0, strain]));
    // ½ · 0.7/0.3 = 1.1667 = λ² − 1
    assert!(at(0.47).norm().is_finite() && !at(0.475).norm().is_finite());
    let [low, _] = crate::material::stability::stable_range(&*law, Mode::Uniaxial);
    assert!(low > 0.5 && low < 0.8, "{low}");
}
