//! Formulas as text, evaluated with their derivatives.

use winnow::ascii::{float, multispace0};
use winnow::combinator::{
    Infix, Prefix, alt, delimited, expression, fail, opt, peek, preceded, repeat,
};
use winnow::error::{ContextError, ErrMode};
use winnow::prelude::*;
use winnow::token::{one_of, take_while};

use super::jet::Jet;

/// A formula of some variables.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// What a variable, by its number, is more than its value at rest.
    Variable(usize),
    /// a + b.
    Sum(Box<[Self; 2]>),
    /// a b.
    Product(Box<[Self; 2]>),
    /// aᵇ.
    Power(Box<[Self; 2]>),
    /// The larger of two values.
    Larger(Box<[Self; 2]>),
    /// A function of a value.
    Of(Function, Box<Self>),
}

/// A function of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// eˣ.
    Exponential,
    /// eˣ − 1, without cancellation where x is small.
    ExponentialLessOne,
    /// ln x.
    Logarithm,
    /// ln (1 + x), without cancellation where x is small.
    LogarithmOfOnePlus,
    /// √x.
    Root,
    /// sin x.
    Sine,
    /// cos x.
    Cosine,
    /// sinh x.
    HyperbolicSine,
    /// cosh x.
    HyperbolicCosine,
    /// tanh x.
    HyperbolicTangent,
    /// |x|.
    Magnitude,
}

/// Where a text is no formula, in characters from its begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoFormula {
    /// How many characters could be read.
    pub after: usize,
}

/// The name of a variable, and its value at rest.
pub type Variable = (&'static str, f64);

impl Function {
    /// All of them by their names.
    pub const NAMES: [(&'static str, Self); 12] = [
        ("exp", Self::Exponential),
        ("expm1", Self::ExponentialLessOne),
        ("ln", Self::Logarithm),
        ("log", Self::Logarithm),
        ("log1p", Self::LogarithmOfOnePlus),
        ("sqrt", Self::Root),
        ("sin", Self::Sine),
        ("cos", Self::Cosine),
        ("sinh", Self::HyperbolicSine),
        ("cosh", Self::HyperbolicCosine),
        ("tanh", Self::HyperbolicTangent),
        ("abs", Self::Magnitude),
    ];

    /// Value, slope and curvature.
    fn at(self, x: f64) -> [f64; 3] {
        match self {
            Self::Exponential => [x.exp(); 3],
            Self::ExponentialLessOne => [x.exp_m1(), x.exp(), x.exp()],
            // Where there is no logarithm it has no slope either.
            Self::Logarithm if x < 0.0 => [f64::NAN; 3],
            Self::LogarithmOfOnePlus if x < -1.0 => [f64::NAN; 3],
            Self::Logarithm => [x.ln(), 1.0 / x, -1.0 / (x * x)],
            Self::LogarithmOfOnePlus => {
                let inverse = 1.0 / (1.0 + x);
                [x.ln_1p(), inverse, -inverse * inverse]
            }
            Self::Root => {
                let root = x.sqrt();
                [root, 0.5 / root, -0.25 / (x * root)]
            }
            Self::Sine => [x.sin(), x.cos(), -x.sin()],
            Self::Cosine => [x.cos(), -x.sin(), -x.cos()],
            Self::HyperbolicSine => [x.sinh(), x.cosh(), x.sinh()],
            Self::HyperbolicCosine => [x.cosh(), x.sinh(), x.cosh()],
            Self::HyperbolicTangent => {
                let (tangent, slope) = (x.tanh(), x.cosh().powi(-2));
                [tangent, slope, -2.0 * tangent * slope]
            }
            Self::Magnitude => [x.abs(), x.signum(), 0.0],
        }
    }
}

impl Expression {
    /// Reads a formula of some variables: `+ - * / ^` (or `**`), brackets, the functions of [`Function::NAMES`], `max` and `min` of two values.
    ///
    /// # Errors
    /// [`NoFormula`], also where a name is none of a variable.
    pub fn parse(text: &str, variables: &[Variable]) -> Result<Self, NoFormula> {
        let full = |input: &mut &str| formula(input, variables);
        let read = (full, multispace0).map(|(formula, _)| formula).parse(text);
        read.map_err(|fault| NoFormula {
            after: text[..fault.offset()].chars().count(),
        })
    }

    /// Whether it depends on a variable.
    pub fn has(&self, variable: usize) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Variable(index) => *index == variable,
            Self::Of(_, value) => value.has(variable),
            Self::Sum(both) | Self::Product(both) | Self::Power(both) | Self::Larger(both) => {
                both.iter().any(|one| one.has(variable))
            }
        }
    }

    /// Its value and derivatives, from what each variable is more than its value at rest.
    pub fn evaluate<const N: usize>(&self, variables: &[Jet<N>]) -> Jet<N> {
        match self {
            Self::Number(value) => Jet::constant(*value),
            Self::Variable(index) => variables[*index],
            Self::Of(function, value) => {
                let value = value.evaluate(variables);
                value.composed(function.at(value.value))
            }
            Self::Sum(both) => both[0].evaluate(variables) + both[1].evaluate(variables),
            Self::Product(both) => match &**both {
                [Self::Number(factor), value] => *factor * value.evaluate(variables),
                [a, b] => a.evaluate(variables) * b.evaluate(variables),
            },
            Self::Power(both) => match &**both {
                [value, Self::Number(exponent)] => {
                    let value = value.evaluate(variables);
                    value.composed(power(value.value, *exponent))
                }
                [value, exponent] => {
                    let value = value.evaluate(variables);
                    let logarithm = value.composed(Function::Logarithm.at(value.value));
                    let product = exponent.evaluate(variables) * logarithm;
                    product.composed(Function::Exponential.at(product.value))
                }
            },
            Self::Larger(both) => {
                let [a, b] = [0, 1].map(|index| both[index].evaluate(variables));
                if b.value > a.value { b } else { a }
            }
        }
    }

    fn sum(a: Self, b: Self) -> Self {
        match (a, b) {
            (Self::Number(a), Self::Number(b)) => Self::Number(a + b),
            // A variable less its value at rest is exact.
            (Self::Sum(both), Self::Number(b)) if both[0] == Self::Number(-b) => {
                let [_, rest] = *both;
                rest
            }
            (a, b) => Self::Sum(Box::new([a, b])),
        }
    }

    fn product(a: Self, b: Self) -> Self {
        match (a, b) {
            (Self::Number(a), Self::Number(b)) => Self::Number(a * b),
            (a, b @ Self::Number(_)) => Self::Product(Box::new([b, a])),
            (a, b) => Self::Product(Box::new([a, b])),
        }
    }

    fn power(a: Self, b: Self) -> Self {
        match (a, b) {
            (Self::Number(a), Self::Number(b)) => Self::Number(a.powf(b)),
            (a, b) => Self::Power(Box::new([a, b])),
        }
    }

    fn negative(self) -> Self {
        Self::product(Self::Number(-1.0), self)
    }

    fn inverse(self) -> Self {
        Self::power(self, Self::Number(-1.0))
    }
}

/// xⁿ with slope and curvature; of a whole n below 3 also at x = 0.
fn power(x: f64, n: f64) -> [f64; 3] {
    let raised = |factor: f64, n: f64| {
        if factor == 0.0 {
            0.0
        } else if n.fract() == 0.0 && n.abs() < 64.0 {
            factor * x.powi(n as i32)
        } else {
            factor * x.powf(n)
        }
    };
    [
        raised(1.0, n),
        raised(n, n - 1.0),
        raised(n * (n - 1.0), n - 2.0),
    ]
}

type Read<T> = Result<T, ErrMode<ContextError>>;

fn formula(input: &mut &str, variables: &[Variable]) -> Read<Expression> {
    use Expression as E;
    let prefix = |input: &mut &str| {
        let sign = preceded(multispace0, one_of(['-', '+'])).parse_next(input)?;
        Ok(if sign == '-' {
            Prefix(3, |_: &mut &str, a: E| Ok(a.negative()))
        } else {
            Prefix(3, |_: &mut &str, a: E| Ok(a))
        })
    };
    let infix = |input: &mut &str| {
        let mut sign = preceded(multispace0, alt(("**", "+", "-", "*", "/", "^")));
        Ok(match sign.parse_next(input)? {
            "+" => Infix::Left(1, |_: &mut &str, a, b| Ok(E::sum(a, b))),
            "-" => Infix::Left(1, |_: &mut &str, a, b: E| Ok(E::sum(a, b.negative()))),
            "*" => Infix::Left(2, |_: &mut &str, a, b| Ok(E::product(a, b))),
            "/" => Infix::Left(2, |_: &mut &str, a, b: E| Ok(E::product(a, b.inverse()))),
            _ => Infix::Right(4, |_: &mut &str, a, b| Ok(E::power(a, b))),
        })
    };
    let operand = |input: &mut &str| operand(input, variables);
    expression(operand)
        .prefix(prefix)
        .infix(infix)
        .parse_next(input)
}

/// A number, a variable, a function of a formula, or a formula in brackets.
fn operand(input: &mut &str, variables: &[Variable]) -> Read<Expression> {
    let number = preceded(peek(one_of(('0'..='9', '.'))), float).map(Expression::Number);
    let named = |input: &mut &str| named(input, variables);
    let bracketed = |input: &mut &str| arguments(input, variables);
    let alone = bracketed.verify_map(|all: Vec<Expression>| <[_; 1]>::try_from(all).ok());
    preceded(multispace0, alt((number, named, alone.map(|[one]| one)))).parse_next(input)
}

/// Formulas in brackets, with commas between them.
fn arguments(input: &mut &str, variables: &[Variable]) -> Read<Vec<Expression>> {
    let next = |input: &mut &str| formula(input, variables);
    let others = repeat(0.., preceded((multispace0, ','), next));
    let all = (next, others).map(|(first, others): (_, Vec<_>)| [vec![first], others].concat());
    delimited((multispace0, '('), all, (multispace0, ')')).parse_next(input)
}

fn named(input: &mut &str, variables: &[Variable]) -> Read<Expression> {
    let begin = *input;
    let letters = |letter: char| letter.is_alphanumeric() || letter == '_';
    let name = take_while(1.., letters).parse_next(input)?.to_lowercase();
    let of_name = |(known, _): &(&str, _)| known.to_lowercase() == name;
    let bracketed = |input: &mut &str| arguments(input, variables);
    let arguments = opt(bracketed).parse_next(input)?;
    let mut functions = Function::NAMES.iter();
    let known = match (arguments.map(<Box<[_]>>::from), &*name) {
        (None, _) => variables
            .iter()
            .position(|variable| variable.0.to_lowercase() == name)
            .map(|index| {
                let (rest, deviation) = (variables[index].1, Expression::Variable(index));
                match rest {
                    0.0 => deviation,
                    rest => Expression::sum(Expression::Number(rest), deviation),
                }
            }),
        (Some(all), "max" | "min") => <Box<[Expression; 2]>>::try_from(all).ok().map(|both| {
            if name == "max" {
                return Expression::Larger(both);
            }
            let both = both.map(Expression::negative);
            Expression::Larger(Box::new(both)).negative()
        }),
        (Some(all), _) => <Box<[Expression; 1]>>::try_from(all).ok().and_then(|one| {
            let (_, function) = functions.find(|known| of_name(known))?;
            let [value] = *one;
            Some(Expression::Of(*function, Box::new(value)))
        }),
    };
    known.map_or_else(
        || {
            *input = begin;
            fail.parse_next(input)
        },
        Ok,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const XY: [Variable; 2] = [("x", 3.0), ("y", 0.0)];

    fn value(text: &str, [x, y]: [f64; 2]) -> f64 {
        let read = Expression::parse(text, &XY).unwrap_or_else(|fault| panic!("{text} {fault:?}"));
        read.evaluate(&Jet::variables([x - 3.0, y])).value
    }

    #[test]
    fn formulas_have_the_precedence_of_mathematics() {
        let (x, y) = (2.5_f64, 1.25_f64);
        for (text, expected) in [
            ("1 + 2 * x", 1.0 + 2.0 * x),
            ("-x^2", -x * x),
            ("(-x)^2", x * x),
            ("x^-1", 1.0 / x),
            ("2^y^2", 2.0_f64.powf(y * y)),
            ("x - y - 1", x - y - 1.0),
            ("x / y / 2", x / y / 2.0),
            ("2 * -y", -2.0 * y),
            ("1.5e-3*X**2", 1.5e-3 * x * x),
            (" exp( x ) - expm1(x)", 1.0),
            ("max(x, y) + min(x, 2*y)", x + 2.0 * y.min(0.5 * x)),
            (
                "ln(sqrt(x)) + log1p(y) + abs(-y)",
                0.5 * x.ln() + y.ln_1p() + y,
            ),
            (
                "cosh(y)^2 - sinh(y)^2 + tanh(y) + sin(y)^2 + cos(y)^2",
                2.0 + y.tanh(),
            ),
        ] {
            assert!((value(text, [x, y]) - expected).abs() < 1e-13, "{text}");
        }
        let tiny = 1e-20;
        let read = Expression::parse("0.5 * (x - 3)", &XY).unwrap();
        assert_eq!(
            read.evaluate(&Jet::variables([tiny, 0.0])).value,
            0.5 * tiny
        );
    }

    #[test]
    fn what_is_no_formula_is_refused_where_it_ends() {
        for (text, after) in [
            ("x + z", 4),
            ("x +", 3),
            ("", 0),
            ("2 x", 2),
            ("exp(x, y)", 0),
            ("max(x)", 0),
            ("(x", 2),
            ("x)", 1),
            ("sinus(x)", 0),
        ] {
            let fault = Expression::parse(text, &XY).unwrap_err();
            assert!(fault.after <= after.max(2), "{text}: {fault:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_formula() {
        let text = "exp(0.3*x)*y^3 + ln(x*y) / sqrt(x) + x^y + tanh(x - y)*sin(y) + max(x, y)^2.5";
        let read = Expression::parse(text, &XY).unwrap();
        let at = |x: f64, y: f64| read.evaluate(&Jet::variables([x - 3.0, y]));
        let (x, y, step) = (1.7, 0.9, 1e-5);
        let here = at(x, y);
        let along = [[step, 0.0], [0.0, step]];
        for (axis, [dx, dy]) in along.into_iter().enumerate() {
            let (ahead, behind) = (at(x + dx, y + dy), at(x - dx, y - dy));
            let slope = (ahead.value - behind.value) / (2.0 * step);
            assert!((here.gradient[axis] - slope).abs() < 1e-8, "{axis}");
            let curvature = (ahead.gradient - behind.gradient) / (2.0 * step);
            assert!(
                (here.hessian.column(axis) - curvature).norm() < 1e-8,
                "{axis}"
            );
        }
    }
}
