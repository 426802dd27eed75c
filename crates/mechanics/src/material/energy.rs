//! Laws whose energy a card writes as a formula.

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::expression::{Expression, Function, Variable};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::sheet::Kinematics;

/// The variables of a formula, with their values at rest.
const VARIABLES: [Variable; 5] = [
    ("I1", 3.0),
    ("I2", 3.0),
    ("C11", 1.0),
    ("C12", 0.0),
    ("C22", 1.0),
];

/// A law Ψ(I₁, I₂) of an incompressible sheet as a formula, whose derivatives are exact.
///
/// ```text
/// Ψ in MPa = N·mm/mm³ of I₁ and I₂, or of C₁₁, C₁₂, C₂₂ in the axes of the sheet, C = FᵀF
/// ```
///
/// | card key | meaning |
/// |---|---|
/// | `energy` | the formula: `+ - * / ^`, brackets, exp, expm1, ln, log1p, sqrt, sin, cos, sinh, cosh, tanh, abs, max, min |
///
/// The energy at rest is zero, and the sheet has no stress there. A formula that is not defined in a state has no stress in it.
/// I1 − 3, I2 − 3, C11 − 1, C22 − 1, expm1 and log1p are exact near rest, where differences of large terms lose their digits.
#[derive(Clone, Debug)]
pub struct EnergyOfInvariants(Expression);

/// The energy by a formula of C₁₁, C₁₂ and C₂₂: the directions of the sheet may differ.
#[derive(Clone, Debug)]
pub struct EnergyOfStrains(Expression);

/// The most operators and brackets of a formula, and the most brackets within one another: each is a call within the one before.
const MOST: [usize; 2] = [500, 40];

/// Why a formula is too long to be read, if it is.
fn too_long(text: &str) -> Option<String> {
    let count = text.matches(['+', '-', '*', '/', '^', '(']).count();
    let (mut depth, mut deepest) = (0_usize, 0_usize);
    for letter in text.chars() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    let [most, most_deep] = MOST;
    (count > most || deepest > most_deep).then(|| {
        format!(
            "has {count} operators and brackets, {deepest} of which are within one another; {most} and {most_deep} are read"
        )
    })
}

/// Reads the formula of a card.
pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
    let text = parameters.text("energy");
    let unread = || Box::new(EnergyOfInvariants(Expression::Number(f64::NAN)));
    if let Some(message) = too_long(&text) {
        parameters.fault("energy", &message, "write it with fewer terms");
        return unread();
    }
    let formula = match Expression::parse(&text, &VARIABLES) {
        Ok(formula) => formula,
        Err(fault) => {
            let read: String = text.chars().take(fault.after).collect();
            let rest: String = text.chars().skip(fault.after).collect();
            let [open, closed] = ['(', ')'].map(|bracket| text.matches(bracket).count());
            let message = if open == closed {
                format!("is no formula behind `{read}`: `{rest}`")
            } else {
                format!("has {open} opening and {closed} closing brackets")
            };
            parameters.fault("energy", &message, &hint());
            return unread();
        }
    };
    let is_directed = (2..VARIABLES.len()).any(|variable| formula.has(variable));
    let law: Box<dyn HyperelasticLaw> = if is_directed {
        AnisotropicSheet::boxed(EnergyOfStrains(formula), 0.0)
    } else {
        Box::new(EnergyOfInvariants(formula))
    };
    check_rest(&*law, parameters);
    law
}

/// What a formula is made of.
fn hint() -> String {
    let variables = VARIABLES.map(|(name, _)| name).join(", ");
    let functions = Function::NAMES.map(|(name, _)| name).join(", ");
    format!("it has {variables}, numbers, + - * / ^, brackets, and {functions}, max, min")
}

/// Records an energy or a stress at rest, and a sheet that nothing holds together there.
fn check_rest(law: &dyn HyperelasticLaw, parameters: &Parameters) {
    const NEGLIGIBLE: f64 = 1e-9;
    let rest = law.response(&Kinematics::rest());
    let (energy, modulus) = (rest.energy, rest.tangent[(1, 1)]);
    let stress = rest.first_piola_kirchhoff_stress.norm();
    let negligible = NEGLIGIBLE * rest.tangent.norm();
    let (message, hint) = if !(energy.is_finite() && negligible.is_finite()) {
        let hint = "it must be defined at I1 = I2 = 3 and C = 1, with its derivatives";
        ("has no value at rest".to_owned(), hint)
    } else if energy.abs() > negligible {
        let hint = "subtract it, so that it is 0 at I1 = I2 = 3 and C = 1";
        (format!("is {energy} MPa at rest"), hint)
    } else if stress > negligible {
        let hint = "the sheet must be free of stress at I1 = I2 = 3 and C = 1";
        (format!("leaves a stress of {stress} MPa at rest"), hint)
    } else if modulus <= 0.0 {
        let message = format!("has the shear modulus {modulus} MPa at rest");
        (message, "it must be positive")
    } else {
        return;
    };
    parameters.fault("energy", &message, hint);
}

impl InvariantLaw for EnergyOfInvariants {
    fn evaluate(&self, at: Invariants) -> EnergyDerivatives {
        let variables = Jet::variables([at.i1_minus_3, at.i2_minus_3]);
        let energy = self.0.evaluate(&variables);
        EnergyDerivatives {
            energy: energy.value,
            d1: energy.gradient[0],
            d2: energy.gradient[1],
            d11: energy.hessian[(0, 0)],
            d12: energy.hessian[(0, 1)],
            d22: energy.hessian[(1, 1)],
        }
    }
}

impl AnisotropicLaw for EnergyOfStrains {
    fn energy(&self, [i1, c11, c12, c22]: [Jet; 4]) -> Jet {
        // I₂ − 3 = d − 1 + (C₁₁ + C₂₂)/d − 2 with d = C₁₁ C₂₂ − C₁₂².
        let more = c11 + c22 + c11 * c22 + -1.0 * c12.squared();
        let d = 1.0 + more.value;
        let inverse_less_one = more.composed([-more.value / d, -1.0 / (d * d), 2.0 / (d * d * d)]);
        let trace = c11 + c22;
        let i2 = more + trace + trace * inverse_less_one + 2.0 * inverse_less_one;
        self.0.evaluate(&[i1, i2, c11, c12, c22])
    }

    fn is_isotropic(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_that_no_stack_holds_are_refused_before_they_are_read() {
        let deep = format!("{}I1{}", "(".repeat(100_000), ")".repeat(100_000));
        let long = format!("I1{}", " + I1".repeat(100_000));
        assert!(too_long(&deep).is_some() && too_long(&long).is_some());
        assert_eq!(too_long("0.02*(I1 - 3) + expm1((C11 - 1)^2)"), None);
    }
}
