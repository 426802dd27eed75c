//! Factors kept in files: factorise once, correct many fields in many runs.
//!
//! A file holds the bytes `gelbench factor`, a version, the names and rows of the conditions, the factor, and a
//! CRC-32 of all that. A factor fits a corrector with the same conditions by name and number of rows, the same
//! unknowns and the same weights; it may come from another field. `output::save` writes the bytes.

use super::factor::FactorParts;
use super::{Corrector, Factor};

/// The first bytes of the file.
const MAGIC: &[u8] = b"gelbench factor";
/// The version of the format.
const VERSION: u32 = 1;

/// Why a kept factor cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RetainedFault {
    /// The bytes do not begin as a kept factor does.
    #[error("this is not a stored factor: factorise again")]
    NoFactor,
    /// The file was written by another version of gelbench.
    #[error(
        "the factor is stored in format {0}, this gelbench reads format {VERSION}: factorise again"
    )]
    Version(u32),
    /// The checksum is wrong.
    #[error("the stored factor is damaged, its checksum is wrong: factorise again")]
    Damaged,
    /// The factor belongs to other conditions.
    #[error("the stored factor does not fit the problem: {0}")]
    DoesNotFit(String),
}

/// The names and numbers of rows of a corrector's conditions.
type Fingerprint = Vec<(String, usize)>;

fn fingerprint(corrector: &Corrector) -> Fingerprint {
    let conditions = corrector.conditions.iter();
    conditions
        .map(|condition| (condition.name().to_owned(), condition.rows()))
        .collect()
}

/// A factor of `corrector` as bytes for a file.
pub fn to_bytes(factor: &Factor, corrector: &Corrector) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    let content = postcard::to_stdvec(&(fingerprint(corrector), factor.parts()));
    bytes.extend(content.expect("a factor can be written to memory"));
    let checksum = crc32fast::hash(&bytes);
    bytes.extend(checksum.to_le_bytes());
    bytes
}

/// Reads a kept factor for `corrector`.
///
/// # Errors
/// A [`RetainedFault`].
pub fn from_bytes(bytes: &[u8], corrector: &Corrector) -> Result<Factor, RetainedFault> {
    let rest = bytes.strip_prefix(MAGIC).ok_or(RetainedFault::NoFactor)?;
    let (version, _) = rest.split_first_chunk().ok_or(RetainedFault::Damaged)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(RetainedFault::Version(version));
    }
    let (content, checksum) = bytes.split_last_chunk().ok_or(RetainedFault::Damaged)?;
    if crc32fast::hash(content) != u32::from_le_bytes(*checksum) {
        return Err(RetainedFault::Damaged);
    }
    let content = &content[MAGIC.len() + size_of::<u32>()..];
    let (conditions, parts): (Fingerprint, FactorParts) =
        postcard::from_bytes(content).map_err(|_| RetainedFault::Damaged)?;
    if !parts.is_sound() {
        return Err(RetainedFault::Damaged);
    }
    fits(&conditions, &parts, corrector)?;
    Factor::from_parts(parts).map_err(|_| RetainedFault::Damaged)
}

fn fits(
    conditions: &Fingerprint,
    parts: &FactorParts,
    corrector: &Corrector,
) -> Result<(), RetainedFault> {
    let other = |reason: String| Err(RetainedFault::DoesNotFit(reason));
    let rows: usize = corrector
        .conditions
        .iter()
        .map(|condition| condition.rows())
        .sum();
    let unknowns = corrector.weights.len();
    let (its_rows, its_unknowns) = (parts.jacobian.len(), parts.jacobian.columns());
    if (its_rows, its_unknowns) != (rows, unknowns) {
        return other(format!(
            "it has {its_rows} rows and {its_unknowns} unknowns, the problem {rows} and {unknowns}"
        ));
    }
    if *conditions != fingerprint(corrector) {
        let names: Vec<_> = conditions
            .iter()
            .map(|(name, rows)| format!("{name} ({rows})"))
            .collect();
        return other(format!("its conditions differ: {}", names.join(", ")));
    }
    if parts.weights != corrector.weights {
        return other("its weights differ".into());
    }
    if parts.unknowns.is_some() && parts.unknowns != corrector.square_unknowns() {
        return other("its conditions belong to other unknowns".into());
    }
    Ok(())
}
