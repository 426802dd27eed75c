//! What laws of sheets with directions must reproduce: closed forms, limits and turned axes.

use super::particular::sample;
use super::*;
use crate::material::registry::CARDS;
use crate::material::{Card, FungDemiray, NeoHooke};

const FUNG: &str = "c = \"0.02 MPa\"\na1 = 9\na2 = 5\na3 = 3\na4 = 4\nangle = ";
const HOLZAPFEL_OGDEN: &str = "a = \"0.02 MPa\"\nb = 0.3\nb_f = 0.2\nb_s = 0.3\nb_fs = 0.4\n";

fn turned(law: &str, parameters: &str, degrees: f64) -> Arc<dyn HyperelasticLaw> {
    let (rest, _) = parameters.rsplit_once("angle = ").unwrap();
    sample(law, &format!("{rest}angle = \"{degrees} deg\""))
}

fn assert_same(a: &dyn HyperelasticLaw, b: &dyn HyperelasticLaw) {
    for h in STATES {
        let [a, b] = [a, b].map(|law| law.response(&Kinematics::new(&gradient(h)).unwrap()));
        let difference = (a.first_piola_kirchhoff_stress - b.first_piola_kirchhoff_stress).norm();
        let scale = a.first_piola_kirchhoff_stress.norm();
        assert!(difference < 1e-12 * scale, "{h:?}: {difference:.1e}");
        assert!((a.tangent - b.tangent).norm() < 1e-12 * a.tangent.norm());
        assert!((a.energy - b.energy).abs() < 1e-12 * a.energy, "{h:?}");
    }
}

#[test]
fn a_strip_along_the_fibres_is_stiffer_than_one_across() {
    let aligned = sample(
        "holzapfel-gasser-ogden",
        "mu = \"0.02 MPa\"\nk1 = \"0.03 MPa\"\nk2 = 0.3\nkappa = 0\nangle = \"0 deg\"\nfamilies = \"one\"",
    );
    let along = aligned.tension([1.0, 0.0], 0.2).nominal_stress;
    let across = aligned.tension([0.0, 1.0], 0.2).nominal_stress;
    let neo_hooke = strip(&NeoHooke { c10: 0.01 }, 0.2);
    // Fibres along: P = P_matrix + 2 λ k₁ E e^(k₂ E²), E = λ² − 1.
    let e: f64 = 1.2 * 1.2 - 1.0;
    let expected = neo_hooke + 2.0 * 1.2 * 0.03 * e * (0.3 * e * e).exp();
    assert!((along / expected - 1.0).abs() < 1e-13, "{along} {expected}");
    // Across, the fibres are pressed and carry nothing.
    crate::assert_near(across, neo_hooke, 1e-13, &"");
}

/// P(F Q) Qᵀ by the turned law is P(F): material axes turned by α and the sheet turned back by α are the same.
#[test]
fn a_turned_angle_is_a_turned_sheet() {
    let of_one_axis = samples::samples()
        .into_iter()
        .filter(|(_, text)| text.contains("angle = ") && !text.contains("families"));
    let mut count = 0;
    for (law, text) in of_one_axis {
        let (base, other) = (turned(law, &text, 20.0), turned(law, &text, 65.0));
        let q = nalgebra::Rotation2::new(45_f64.to_radians()).into_inner();
        for h in STATES {
            let f = Matrix2::new(1.0 + h[0], h[1], h[2], 1.0 + h[3]);
            let of = |law: &dyn HyperelasticLaw, f: Matrix2<f64>| {
                let h = f - Matrix2::identity();
                let p = stress(law, &gradient([h.m11, h.m12, h.m21, h.m22]));
                Matrix2::new(p[0], p[1], p[2], p[3])
            };
            let (p, expected) = (of(&*other, f), of(&*base, f * q) * q.transpose());
            assert!((p - expected).norm() < 1e-12 * p.norm(), "{law} {h:?}");
        }
        count += 1;
    }
    assert_eq!(count, 4);
}

/// C₁₁₁₁ = c a₁, C₂₂₂₂ = c a₂, C₁₁₂₂ = c a₃, C₁₂₁₂ = c a₄, and E₁ = C₁₁₁₁ − C₁₁₂₂²/C₂₂₂₂.
#[test]
fn fung_at_small_strain_is_an_orthotropic_sheet() {
    let law = turned("fung", FUNG, 0.0);
    let tangent = law.response(&Kinematics::rest()).tangent;
    for (entry, expected) in [
        ((0, 0), 0.18),
        ((3, 3), 0.10),
        ((0, 3), 0.06),
        ((1, 1), 0.08),
        ((1, 2), 0.08),
    ] {
        assert!((tangent[entry] - expected).abs() < 1e-15, "{entry:?}");
    }
    assert!((law.youngs_modulus() - (0.18 - 0.036)).abs() < 1e-15);
}

/// S₁₁ = c e^Q (a₁ E₁₁ + a₃ E₂₂) of a sheet along its axes, and S₁₂ = 2 c e^Q a₄ E₁₂ in simple shear, where E₂₂ = γ²/2.
#[test]
fn fung_has_its_closed_form_stresses() {
    let law = turned("fung", FUNG, 0.0);
    let [e1, e2]: [f64; 2] = [0.5 * (1.2_f64.powi(2) - 1.0), 0.5 * (1.1_f64.powi(2) - 1.0)];
    let growth = 0.02 * (9.0 * e1 * e1 + 5.0 * e2 * e2 + 6.0 * e1 * e2).exp();
    let computed = law.biaxial([0.2, 0.1]);
    let expected = [1.2 * (9.0 * e1 + 3.0 * e2), 1.1 * (3.0 * e1 + 5.0 * e2)];
    for (computed, expected) in computed.iter().zip(expected) {
        assert!((computed / (growth * expected) - 1.0).abs() < 1e-14);
    }
    let amount: f64 = 0.3;
    let across = 0.5 * amount * amount;
    let growth = 0.02 * (5.0 * across * across + 4.0 * amount * amount).exp();
    let expected = growth * (4.0 * amount + amount * 5.0 * across);
    let computed = curve::simple_shear(&*law, amount);
    crate::assert_near(computed, expected, 1e-14, &"");
}

#[test]
fn exchanged_axes_are_the_same_law() {
    let fung = turned("fung", FUNG, 20.0);
    let exchanged = FUNG.replace("a1 = 9\na2 = 5", "a1 = 5\na2 = 9");
    assert_same(&*fung, &*turned("fung", &exchanged, 110.0));
}

#[test]
fn an_energy_that_some_strain_lowers_is_refused() {
    let text = CARDS[0].1.replace("marlow-exponential", "fung");
    let (head, rest) = text.split_once("[parameters]").unwrap();
    let (_, rest) = rest.split_once("[data]").unwrap();
    for (a3, allowed) in [("6.7", true), ("6.71", false), ("-7", false)] {
        let parameters = FUNG.replace("a3 = 3", &format!("a3 = {a3}"));
        let text = format!("{head}[parameters]\n{parameters}\"0 deg\"\n[data]{rest}");
        match Card::parse("fung", "fung", &text) {
            Ok(_) => assert!(allowed, "{a3}"),
            Err(error) => assert!(!allowed && error.to_string().contains("a1 a2"), "{error}"),
        }
    }
}

/// c₂ = 0, δ = 1: all directions are alike, and Ψ is that of I₁ alone.
#[test]
fn laws_without_fibres_are_isotropic() {
    let may_newman = "mu = \"0.02 MPa\"\nc0 = \"0.01 MPa\"\nc1 = 0.4\nc2 = 0\nangle = \"30 deg\"";
    let lee_sacks =
        "c10 = \"0.02 MPa\"\nc0 = \"0.02 MPa\"\nc1 = 0.4\nc2 = 7\ndelta = 1\nangle = \"30 deg\"";
    let laws = [
        sample("may-newman", may_newman),
        sample("lee-sacks", lee_sacks),
    ];
    assert!(laws.iter().all(|law| law.is_isotropic()));
    assert_same(&*laws[0], &*laws[1]);
    // P = 2 (Ψ₁) (λ − λ⁻²), Ψ₁ = μ/2 + 2 c₀ c₁ x e^(c₁ x²), x = I₁ − 3.
    let x: f64 = 1.5 * 1.5 + 2.0 / 1.5 - 3.0;
    let d1 = 0.01 + 0.008 * x * (0.4 * x * x).exp();
    let expected = 2.0 * d1 * (1.5 - 1.5_f64.powi(-2));
    assert!((strip(&*laws[0], 0.5) / expected - 1.0).abs() < 1e-13);
}

/// Along the fibres P adds 4 c₀ c₂ (λ − 1)³ e^(c₂ (λ − 1)⁴); without μ the sheet is soft at rest and stable beside it.
#[test]
fn may_newman_without_a_matrix_begins_with_the_third_power_of_the_strain() {
    let text = "mu = \"0 MPa\"\nc0 = \"0.01 MPa\"\nc1 = 2\nc2 = 900\nangle = \"0 deg\"";
    let law = sample("may-newman", text);
    assert_eq!([law.shear_modulus(), law.youngs_modulus()], [0.0; 2]);
    assert!(law.statements()[0].1.contains("no stiffness at rest"));
    let [planar, _] = law.biaxial([0.1, 0.0]);
    let x: f64 = 1.21 + 1.0 / 1.21 - 2.0;
    let growth = 0.01 * (2.0 * x * x + 900.0 * 0.1_f64.powi(4)).exp();
    let of_matrix = 4.0 * x * 2.0 * (1.1 - 1.1_f64.powi(-3));
    let expected = growth * (of_matrix + 4.0 * 900.0 * 0.1_f64.powi(3));
    crate::assert_near(planar, expected, 1e-12, &"");
    let [_, high] = crate::material::stability::stable_range(&*law, Mode::Uniaxial);
    assert!(high > 1.3, "{high}");
    assert!(strip(&*law, 0.2) > 0.0);
}

/// Pressed fibres carry nothing: across them the sheet is its matrix.
#[test]
fn fibres_of_lee_and_sacks_carry_in_tension_only() {
    let text =
        "c10 = \"0.02 MPa\"\nc0 = \"0.03 MPa\"\nc1 = 0.05\nc2 = 2\ndelta = 0\nangle = \"90 deg\"";
    let law = sample("lee-sacks", text);
    let neo_hooke = strip(&NeoHooke { c10: 0.01 }, 0.2);
    assert!((strip(&*law, 0.2) / neo_hooke - 1.0).abs() < 1e-13);
    let strain: f64 = 1.2 * 1.2 - 1.0;
    let fibres = 0.06 * 2.0 * strain * 1.2 * (2.0 * strain * strain).exp();
    let along = law.tension([0.0, 1.0], 0.2).nominal_stress;
    crate::assert_near(along, neo_hooke + fibres, 1e-13, &"");
}

#[test]
fn holzapfel_and_ogdens_law_has_its_limits() {
    let of = |a: [&str; 3], angle: &str| {
        let [f, s, fs] = a;
        let parameters = format!(
            "a_f = \"{f} MPa\"\na_s = \"{s} MPa\"\na_fs = \"{fs} MPa\"\nangle = \"{angle} deg\""
        );
        sample("holzapfel-ogden", &format!("{HOLZAPFEL_OGDEN}{parameters}"))
    };
    let matrix = of(["0", "0", "0"], "35");
    assert!(matrix.is_isotropic());
    assert_same(&*matrix, &FungDemiray { mu: 0.02, b: 0.3 });
    // f and s exchanged: equal b where both have one.
    let text = |text: &str| text.replace("b_s = 0.3", "b_s = 0.2");
    let pair = |f: &str, s: &str, angle: f64| {
        let parameters =
            format!("a_f = \"{f} MPa\"\na_s = \"{s} MPa\"\na_fs = \"0.01 MPa\"\nangle = ");
        turned(
            "holzapfel-ogden",
            &format!("{}{parameters}", text(HOLZAPFEL_OGDEN)),
            angle,
        )
    };
    assert_same(&*pair("0.03", "0.01", 15.0), &*pair("0.01", "0.03", 105.0));
    // Two perpendicular families of Holzapfel, Gasser and Ogden's law in a matrix that is nearly neo-Hooke's.
    let parameters = "a_f = \"0.03 MPa\"\na_s = \"0.03 MPa\"\na_fs = \"0 MPa\"\nangle = ";
    let soft = text(HOLZAPFEL_OGDEN).replace("b = 0.3", "b = 1e-14");
    let two = "mu = \"0.02 MPa\"\nk1 = \"0.03 MPa\"\nk2 = 0.2\nkappa = 0\nangle = \"45 deg\"\nfamilies = \"two\"";
    assert_same(
        &*turned("holzapfel-ogden", &format!("{soft}{parameters}"), 45.0),
        &*sample("holzapfel-gasser-ogden", two),
    );
}
