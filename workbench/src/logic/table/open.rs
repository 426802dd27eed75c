//! Opening studies and cards on the table.

use std::path::Path;

use gelbench::error::Error;
use gelbench::material::Card;

use super::{Action, Table};
use crate::logic::kind::Kind;
use crate::logic::scene::{CardFile, Scene};

impl Table {
    pub(super) fn open(&mut self, file: &str, text: &str) -> Result<(), Error> {
        if !Kind::is_card(text) {
            let scene = Scene::open(Path::new(file), text, &self.cards)?;
            self.remember(&scene.card);
            self.scene.change(scene, false);
            return Ok(());
        }
        let name = Path::new(file)
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into());
        let card = Card::parse(&name, file, text)?;
        let card = CardFile {
            name: card.name,
            text: card.text,
        };
        self.take_card(card, false);
        Ok(())
    }

    /// Keeps a card of the user's own among those to choose from.
    fn remember(&mut self, card: &CardFile) {
        if !card.is_shipped() {
            self.cards.retain(|known| known.name != card.name);
            self.cards.push(card.clone());
        }
    }

    /// Takes a card as the sheet's material; `gesture` while a control is held, such as the slider of a parameter.
    pub fn take_card(&mut self, card: CardFile, gesture: bool) {
        self.remember(&card);
        let scene = Box::new(Scene {
            card,
            ..self.scene().clone()
        });
        self.act(Action::Change { scene, gesture });
    }
}
