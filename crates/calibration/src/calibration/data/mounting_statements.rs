//! What a table states of the mounting of a biaxial test.

use super::columns::{area, length};
use super::mounting::{Mounted, Mounting, RestState};
use super::roles::Role;
use super::test_data::Test;
use crate::document::{Faulty, Head};
use crate::error::Diagnostic;
use crate::mesh::{Rakes, Shape};
use crate::units::Dimension;

/// The statements that need one on the mounting.
const OF_MOUNTING: [&str; 8] = [
    "tines",
    "tine spacing",
    "tine inset",
    "tine diameter",
    "tine bars",
    "arm width",
    "fillet",
    "markers",
];

/// The key of the state without stress.
pub(super) const REST_STATE: &str = "rest state";

/// The key of the zeros of both forces.
pub(super) const FORCE_ZERO: &str = "force zero";

/// Tines of one side at most.
const MOST_TINES: usize = 20;

/// What holds the sheet.
#[derive(Clone, Copy)]
enum Holder {
    Rakes,
    Cruciform,
}

impl Mounted {
    /// The statements of a table on a test.
    pub(super) fn stated(head: &Head, roles: &[Role], test: Test) -> Faulty<Self> {
        let stated = Self {
            mounting: Mounting::stated(head, roles)?,
            rest_state: rest_state(head)?,
            estimates_force_zero: is_estimated(head)?,
        };
        if stated != Self::default() && test != Test::Biaxial {
            let message = "mounting, rest state and zero of force are those of a biaxial test";
            let hint =
                "give strains and stresses along both axes with --test biaxial, or leave them out";
            return Err(head.fault_of("mounting", message, hint));
        }
        Ok(stated)
    }
}

impl Mounting {
    fn stated(head: &Head, roles: &[Role]) -> Faulty<Option<Self>> {
        const NAMES: [(&str, Holder); 2] =
            [("rakes", Holder::Rakes), ("cruciform", Holder::Cruciform)];
        if head.setting("mounting", None)?.is_none() {
            return match OF_MOUNTING
                .iter()
                .find(|key| !matches!(head.text(key), Ok(None)))
            {
                Some(key) => Err(head.fault_of(
                    key,
                    format!("the {key} is stated, and the mounting is not"),
                    "state the mounting too: rakes or cruciform",
                )),
                None => Ok(None),
            };
        }
        let holder = head.choice("mounting", None, &NAMES)?;
        let lengths = [length(head, roles, 0)?, length(head, roles, 1)?];
        let shape = shape(head, holder, lengths)?;
        let slides = matches!(holder, Holder::Rakes)
            && head.setting("tine bars", None)?.is_some()
            && head.choice("tine bars", None, &[("fixed", false), ("sliding", true)])?;
        let markers = head.quantity("markers", Dimension::Length)?;
        let least = lengths[0].min(lengths[1]);
        if markers.is_some_and(|side| side > 0.8 * least) {
            let message = "the square of the markers must lie well within the sheet";
            let hint = format!("its side must be below {} mm", 0.8 * least);
            return Err(head.fault_of("markers", message, &hint));
        }
        // Stresses are those of any thickness.
        let thickness = head
            .quantity("thickness", Dimension::Length)?
            .unwrap_or(1.0);
        let cross_section = |axis: usize| match area(head, roles, Some(axis)) {
            Ok(area) => Ok(area),
            Err(_) if head.text("thickness")?.is_none() => Ok(thickness * lengths[1 - axis]),
            Err(fault) => Err(fault),
        };
        Ok(Some(Self {
            shape,
            slides,
            lengths,
            thickness,
            areas: [cross_section(0)?, cross_section(1)?],
            markers,
        }))
    }
}

/// The sheet between bars or grips at some distances as mounted.
fn shape(head: &Head, holder: Holder, lengths: [f64; 2]) -> Faulty<Shape> {
    let required = |key: &str| head.required_quantity(key, Dimension::Length);
    let shape = match holder {
        Holder::Rakes => {
            let inset = required("tine inset")?;
            Shape::SquareOnRakes(Rakes {
                size: lengths.map(|length| length + 2.0 * inset),
                tines: tines(head)?,
                spacing: required("tine spacing")?,
                inset,
                radius: 0.5 * required("tine diameter")?,
            })
        }
        Holder::Cruciform => Shape::Cruciform {
            size: lengths,
            arm_width: required("arm width")?,
            fillet: required("fillet")?,
        },
    };
    if let Err(misfit) = shape.check() {
        let message = format!("{}: {misfit}", misfit.measure.replace('_', " "));
        return Err(head.fault_of("mounting", message, &misfit.remedy()));
    }
    Ok(shape)
}

/// The number of tines at each side.
fn tines(head: &Head) -> Faulty<usize> {
    let Some(text) = head.setting("tines", None)? else {
        return Err(head.missing("tines", "5"));
    };
    let number = text.parse().ok();
    number
        .filter(|tines| (1..=MOST_TINES).contains(tines))
        .ok_or_else(|| {
            let message = format!("the number of tines `{text}` cannot be taken");
            head.fault_of(
                "tines",
                message,
                &format!("a whole number from 1 to {MOST_TINES}, for each side"),
            )
        })
}

fn rest_state(head: &Head) -> Faulty<RestState> {
    let Some(text) = head.text(REST_STATE)? else {
        return Ok(RestState::AsMounted);
    };
    let numbers: Option<Vec<f64>> = text.split(',').map(|one| one.trim().parse().ok()).collect();
    let in_range = |stretch: &f64| (RestState::RANGE[0]..=RestState::RANGE[1]).contains(stretch);
    match (&*text, numbers.as_deref()) {
        ("as-mounted", _) => Ok(RestState::AsMounted),
        ("estimated", _) => Ok(RestState::Estimated),
        (_, Some([one])) if in_range(one) => Ok(RestState::Stated([*one; 2])),
        (_, Some([first, second])) if in_range(first) && in_range(second) => {
            Ok(RestState::Stated([*first, *second]))
        }
        _ => {
            let message = format!("the rest state `{text}` is not known");
            let hint = "as-mounted, estimated, or the stretches along both axes as mounted, such as 1.05,1.03 (from 0.7 to 2)";
            Err(head.fault_of(REST_STATE, message, hint))
        }
    }
}

fn is_estimated(head: &Head) -> Faulty<bool> {
    const NAMES: [(&str, bool); 2] = [("as-measured", false), ("estimated", true)];
    match head.setting(FORCE_ZERO, None)? {
        None => Ok(false),
        Some(_) => head.choice(FORCE_ZERO, None, &NAMES),
    }
}

/// What a user must know of a test whose stresses are Cauchy stresses: forces follow from them by the stretch of the middle alone.
pub(super) fn refuse_cauchy(head: &Head) -> Box<Diagnostic> {
    let message = "the forces of a mounted sheet do not follow from Cauchy stresses";
    head.fault_of("mounting", message, "give forces, or nominal stresses")
}
