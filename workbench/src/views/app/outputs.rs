//! Exports of the views: studies, fields, tables, pictures.

use eframe::egui::Ui;

use super::{Tab, Workbench};
use crate::logic::outputs::{FORMATS, ShownField, Wanted};
use crate::logic::scene::Model;
use crate::views::exports::{self, Offer};
use crate::views::figures;

impl Workbench {
    /// The exports of the view that is shown, to choose from.
    pub(super) fn offered(&mut self, ui: &mut Ui) {
        #[cfg(target_arch = "wasm32")]
        if self.tab == Tab::Sheet && ui.button("copy a link to this sheet").clicked() {
            let link = crate::page::link(&self.table.scene().study());
            self.message = match link {
                Some(link) => {
                    ui.ctx().copy_text(link);
                    "the link is in the clipboard and is now the address of this page".to_owned()
                }
                None => "the browser gives this page no address".to_owned(),
            };
            ui.close();
        }
        let offers = self.offers();
        if offers.is_empty() {
            ui.label("There is nothing to export yet.");
        }
        for (name, wanted) in offers {
            // In the browser nothing is asked: downloads begin at once.
            let asks = if cfg!(target_arch = "wasm32") {
                ""
            } else {
                " …"
            };
            let response = ui.button(format!("{name}{asks}"));
            self.positions.insert(name, response.rect.center());
            if response.clicked() {
                self.message = "writing …".to_owned();
                self.exports.ask(wanted);
                ui.close();
            }
        }
    }

    fn offers(&self) -> Vec<Offer> {
        match self.tab {
            Tab::Sheet => self.sheet_offers(),
            Tab::Material => self.materials.offers(),
            Tab::Field => self.fields.offers(),
            Tab::Study => self.studies.offers(),
        }
    }

    fn sheet_offers(&self) -> Vec<Offer> {
        let mut scene = self.table.scene().clone();
        scene.look.colour = self.table.shown_colour();
        let field = |model: Model| -> Option<ShownField> {
            let drawn = self.table.drawn(model).filter(|drawn| drawn.follows)?;
            let values = self.table.drawn_values(model).unwrap_or_default();
            Some((model, drawn.displacement.into_owned(), values))
        };
        let shown = |model: &Model| scene.look.models[*model as usize];
        let fields: Vec<_> = Model::ALL
            .into_iter()
            .filter(shown)
            .filter_map(field)
            .collect();
        let mut offers = Vec::new();
        if !fields.is_empty() {
            let wanted = Wanted::Vtk(scene.clone(), fields.clone());
            offers.push(("the fields as VTK".to_owned(), wanted));
            let wanted = Wanted::Nodes(scene.clone(), fields.clone());
            offers.push(("the nodes as CSV".to_owned(), wanted));
            for (name, format) in FORMATS {
                let wanted = Wanted::SheetPicture(scene.clone(), fields.clone(), format);
                offers.push((format!("the sheets as {name}"), wanted));
            }
        }
        let curve = figures::curve(&self.table);
        offers.extend(exports::chart("force over stretch", "force", &curve));
        offers
    }
}
