//! A material of one's own in specimens and motions takes the place of the file's card in all models.

use std::path::Path;

use gelbench::budget::Budget;
use gelbench::kinds::kind_of;
use gelbench::material::Card;
use gelbench::results::Outcome;
use gelbench::studies::{Progress, motion};
use gelbench_studies::studies::specimen;

/// A study with a card by its name, and with another card put in its place.
fn computed(text: &str, card: Option<Card>) -> Outcome {
    let file = Path::new("study.toml");
    let case = kind_of("study.toml", text).unwrap().unwrap();
    let budget = Budget::default();
    if case.name == specimen::KIND {
        let strip = specimen::load(case, file, text, budget).unwrap().content;
        let strip = match card {
            Some(card) => strip.with_card(card),
            None => strip,
        };
        return specimen::compute(&strip, Progress::silent()).unwrap();
    }
    let plate = motion::load(case, file, text, budget).unwrap().content;
    let plate = match card {
        Some(card) => plate.with_card(card),
        None => plate,
    };
    motion::compute(&plate, Progress::silent()).unwrap()
}

#[test]
fn a_law_of_ones_own_computes_as_the_same_law_of_a_card() {
    let specimen = "kind = \"specimen\"\n[material]\ncard = \"pva-10\"\n[specimen]\nshape = \"strip\"\nlength = \"40 mm\"\n\
                    width = \"20 mm\"\nthickness = \"1 mm\"\ncells = 4\n[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
                    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"8 mm\"\ny = \"0 mm\"\n[path]\n\
                    factors = [1]\nmeasured_group = \"right\"\n";
    let motion = "kind = \"motion\"\n[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m³\"\n[plate]\nlength = \"15 cm\"\n\
                  width = \"5 cm\"\nthickness = \"2 mm\"\ncells = [6, 2]\n[start]\nstretch = \"10 %\"\n[grip]\n\
                  motion = \"release\"\ntime = \"0 s\"\n[time]\nduration = \"20 ms\"\ninterval = \"5 ms\"\n[finite_element]\n\
                  element = \"Q1\"\ncells = [6, 2]\n";
    for text in [specimen, motion] {
        let card = Card::load("neo-hooke", crate::common::root()).unwrap();
        let of_card = computed(&text.replace("pva-10", "neo-hooke"), None);
        let named = Card::of_law("my gel", card.law, [0.5, 2.0]);
        let with_law = computed(text, Some(named));
        assert!(!with_law.checks.is_empty());
        assert_eq!(with_law.checks, of_card.checks);
        assert_ne!(with_law.checks, computed(text, None).checks);
    }
}
