//! No text makes the reading of a study, of a card or of test data panic.

use std::path::Path;

use gelbench::budget::Budget;
use gelbench::calibration::{FitSettings, TestData, fit};
use gelbench::document::Statements;
use gelbench::kinds::{KINDS, kind_of, read_as};
use gelbench::material::Card;
use gelbench::material::registry::{CARDS, Law};
use gelbench::studies::plate::load;
use gelbench_mechanics::material::registry::DATA;
use gelbench_studies::studies::plate::DEFAULT;
use proptest::prelude::*;

/// `text` with a piece replaced.
fn damaged(text: &str, at: usize, length: usize, piece: &str) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    let start = at % characters.len();
    let end = (start + length).min(characters.len());
    characters.splice(start..end, piece.chars());
    characters.into_iter().collect()
}

proptest! {
    #[test]
    fn studies(at in 0_usize..10_000, length in 0_usize..30, piece in "[ -~\\n]{0,12}|\\PC{0,6}") {
        let text = damaged(DEFAULT, at, length, &piece);
        let _ = load(Path::new("/nowhere/name.toml"), &text, Budget::USUAL);
    }

    #[test]
    fn numbers(value in prop_oneof!["-?[0-9]{1,30}", "-?[0-9]\\.[0-9]e-?[0-9]{1,4}", "nan|inf|-inf"]) {
        let text = format!("[plate]\nlength = \"{value} cm\"\ncells = [{value}, 3]\n[load]\nstretches = [{value}]\n");
        let _ = load(Path::new("/nowhere/name.toml"), &text, Budget::USUAL);
    }

    #[test]
    fn cases(case in 0..KINDS.len(), at in 0_usize..10_000, length in 0_usize..30, piece in "[ -~\\n]{0,12}") {
        let text = damaged(KINDS[case].study, at, length, &piece);
        let _ = read_as(&KINDS[case], Path::new("name.toml"), &text, Budget::USUAL);
        let _ = kind_of("name.toml", &text);
    }

    #[test]
    fn cards(card in 0..CARDS.len(), at in 0_usize..10_000, length in 0_usize..30, piece in "[ -~\\n]{0,12}") {
        let _ = Card::parse("name", "name.toml", &damaged(CARDS[card].1, at, length, &piece));
    }

    #[test]
    fn test_data(file in 0..DATA.len(), at in 0_usize..3_000, length in 0_usize..30, piece in "[ -~\\n]{0,12}|\\PC{0,6}") {
        let text = damaged(DATA[file].1, at, length, &piece);
        if let Ok(data) = TestData::parse("name.csv", &text, &Statements::new()) {
            let law = Law::named("neo-hooke").unwrap();
            let _ = fit(law, &[data], &FitSettings::default());
        }
    }
}
