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

/// The card under `card` of a section, looked for relative to `folder`; `None` where it is no card to work
/// with, which is recorded as a fault.
pub fn read_card(section: &Section<'_>, folder: &Path) -> Option<Card> {
    let name = section.text(KEY);
    // Before the card is loaded, so that a card in fault leaves no other key unread.
    let plane = plane_state(section);
    if name.is_empty() && !section.has(KEY) {
        return None; // told already
    }
    match Card::load(&name, folder) {
        Ok(card) if card.offset == OffsetTreatment::Keep => {
            section.fault(
                KEY,
                "this card has a stress at rest and cannot be used in a model",
                "set `offset = \"subtract\"` in the card",
            );
            None
        }
        Ok(card) if card.law.shear_modulus() <= 0.0 => {
            section.fault(
                KEY,
                &format!(
                    "this card's law is unstable from rest: its shear modulus is {:.4} MPa",
                    card.law.shear_modulus()
                ),
                "choose another law; see `gelbench materials show`",
            );
            None
        }
        Ok(card) if !rests(&card) => {
            section.fault(
                KEY,
                "this card's law is unstable from rest: its bulk modulus is negative, so that at zero in-plane strain the sheet has another thickness and a stress",
                "choose other parameters; for foams the sum of μᵢ (⅓ + βᵢ) must be positive",
            );
            None
        }
        Ok(card) => {
            warn_of_volume(section, &card);
            for warning in card.warnings() {
                section.warning(KEY, &warning.message, warning.hint.as_deref().unwrap_or(""));
            }
            in_plane(section, plane?, card)
        }
        Err(Error::Input(faults)) => {
            for fault in faults {
                match fault.position {
                    Some(_) => section.add(fault),
                    None => section.fault(KEY, &fault.message, fault.hint.as_deref().unwrap_or("")),
                }
            }
            None
        }
        Err(other) => {
            section.fault(KEY, &other.to_string(), "choose another card");
            None
        }
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

/// What the section chooses with `sheet`; plane stress where it says nothing.
fn plane_state(section: &Section<'_>) -> Option<PlaneState> {
    section
        .stated(SHEET, |_, key| section.choice(key, &PlaneState::NAMES))
        .unwrap_or(Some(PlaneState::Stress))
}

/// The card in the plane state of a section; that it has none is recorded.
fn in_plane(section: &Section<'_>, plane: PlaneState, card: Card) -> Option<Card> {
    card_in_plane(card, plane)
        .map_err(|fault| section.fault(SHEET, &fault.message, fault.hint.as_deref().unwrap_or("")))
        .ok()
}

/// The card in a plane state. In plane strain it must change its volume, and as much as displacements alone can say: beyond,
/// pressures of κ times what rounding and iteration leave of a change of volume hide the stress.
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
