//! The card of a study.

use std::path::Path;

use crate::document::Section;
use crate::error::{Diagnostic, Error};
use crate::material::parameters::OffsetTreatment;
use crate::material::sheet::Kinematics;
use crate::material::volume::{LARGEST_POISSON_RATIO, bulk_modulus};
use crate::material::{Card, PlaneState};

/// The key of a card.
const KEY: &str = "card";

/// The key of the plane state.
const SHEET: &str = "sheet";

/// The card under `card` of a section, looked for relative to `folder`; `None` where a model cannot use it, which is recorded as a fault.
pub fn read_card(section: &Section<'_>, folder: &Path) -> Option<Card> {
    let name = section.text(KEY);
    // Before the card is loaded, so that a card in fault leaves no other key unread.
    let plane = plane_state(section);
    if name.is_empty() && !section.has(KEY) {
        return None; // The missing key was reported when it was read.
    }
    let card = match Card::load(&name, folder) {
        Ok(card) => card,
        Err(Error::Input(faults)) => {
            for fault in faults {
                match fault.position {
                    Some(_) => section.add(fault),
                    None => section.fault(KEY, &fault.message, fault.hint.as_deref().unwrap_or("")),
                }
            }
            return None;
        }
        Err(other) => {
            section.fault(KEY, &other.to_string(), "choose another card");
            return None;
        }
    };
    if let Some((message, hint)) = unusable(&card) {
        section.fault(KEY, &message, hint);
        return None;
    }
    warn_of_volume(section, &card);
    for warning in card.warnings() {
        section.warning(KEY, &warning.message, warning.hint.as_deref().unwrap_or(""));
    }
    let card = card_in_plane(card, plane?);
    card.map_err(|fault| section.fault(SHEET, &fault.message, fault.hint.as_deref().unwrap_or("")))
        .ok()
}

/// Why a model cannot use a card, and the remedy; `None` where it can.
fn unusable(card: &Card) -> Option<(String, &'static str)> {
    let modulus = card.law.shear_modulus();
    if card.offset == OffsetTreatment::Keep {
        let message = "this card has a stress at rest and cannot be used in a model";
        let hint = "set `offset = \"subtract\"` in the card";
        Some((message.to_owned(), hint))
    } else if modulus <= 0.0 {
        let message =
            format!("this card's law is unstable from rest: its shear modulus is {modulus:.4} MPa");
        Some((message, "choose another law; see `gelbench materials show`"))
    } else if !rests(card) {
        let message = "this card's law is unstable from rest: its bulk modulus is negative, so that at zero in-plane strain the sheet has another thickness and a stress";
        let hint = "choose other parameters; for foams the sum of μᵢ (⅓ + βᵢ) must be positive";
        Some((message.to_owned(), hint))
    } else {
        None
    }
}

/// Whether a sheet without strain has no stress.
fn rests(card: &Card) -> bool {
    let (_, stress) = card.law.stress(&Kinematics::rest());
    stress.amax() <= 1e-6 * card.law.shear_modulus()
}

/// Warns of a change of volume that makes another tension curve of the card's parameters.
fn warn_of_volume(section: &Section<'_>, card: &Card) {
    const SHARE: f64 = 0.02;
    let Some([stretch, change]) = card
        .tension_by_volume()
        .filter(|[_, change]| change.abs() > SHARE)
    else {
        return;
    };
    let percent = 100.0 * change.abs();
    let less = if change < 0.0 { "below" } else { "above" };
    section.warning(
        KEY,
        &format!(
            "with its `[volume]`, the card `{}` has a uniaxial stress up to {percent:.1} % {less} the stress of the same parameters at constant \
             volume (at λ = {stretch:.2})",
            card.name
        ),
        "curves and parameters that were obtained from tests by assuming constant volume then do not reproduce these tests: scale them, or state a \
         Poisson's ratio closer to ½",
    );
}

/// The plane state under `sheet` of a section; plane stress where it states none.
fn plane_state(section: &Section<'_>) -> Option<PlaneState> {
    section
        .stated(SHEET, |_, key| section.choice(key, &PlaneState::NAMES))
        .unwrap_or(Some(PlaneState::Stress))
}

/// The card in a plane state. In plane strain its volume must be able to change, and its bulk modulus κ is limited: the pressure is κ times the
/// change of volume, whose rounding and iteration errors would hide the stress.
///
/// # Errors
/// What the card lacks, and the remedy.
pub fn card_in_plane(card: Card, plane: PlaneState) -> Result<Card, Diagnostic> {
    const ROUNDED: f64 = 1.001;
    if plane == PlaneState::Stress {
        return Ok(card);
    }
    let name = card.name.clone();
    let card = card.in_plane_strain().ok_or_else(|| {
        let message = format!(
            "the card `{name}` is incompressible: in plane strain its stress does not follow from the strain"
        );
        let hint = "give the card a `[volume]` with `poisson_ratio` or `bulk_modulus`";
        Diagnostic::error("", message).hint(hint)
    })?;
    let largest = bulk_modulus(1.0, LARGEST_POISSON_RATIO);
    let ratio = card.law.bulk_modulus().unwrap_or(0.0) / card.law.shear_modulus();
    if ratio <= ROUNDED * largest {
        return Ok(card);
    }
    let message = format!(
        "the card `{name}` has a bulk modulus of {ratio:.0} times its shear modulus: in plane strain the limit is {largest:.0} times, a Poisson's \
         ratio of {LARGEST_POISSON_RATIO}"
    );
    let hint = format!(
        "write `poisson_ratio = {LARGEST_POISSON_RATIO}` under `[volume]` of the card: stresses then differ by about 0.02 % from those of an \
         incompressible body"
    );
    Err(Diagnostic::error("", message).hint(hint))
}
