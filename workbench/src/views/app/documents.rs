//! The documents of the views: opened, saved, asked about before they are lost.

use std::path::PathBuf;

use eframe::egui::{Context, ViewportCommand};

use super::{Tab, Workbench};
use crate::logic::kind::Kind;
use crate::logic::material::TestFile;
use crate::logic::outputs::Written;
use crate::logic::table::Action;
use crate::views::files::{Event, Outgoing, absolute_path, plain};
use crate::views::question;

/// Where a document is, and its text as it was saved or opened last.
#[derive(Default)]
pub struct Document {
    path: Option<PathBuf>,
    saved: String,
}

/// What is done once no change can be lost by it.
pub enum Then {
    /// The window is closed.
    Close,
    /// Another study takes the place of the one in the editor.
    PutStudy(String, String),
}

/// What waits for an answer: changes of a view that would be lost by something.
pub struct Leaving {
    tab: Tab,
    then: Then,
    /// Whether they are being saved.
    saving: bool,
}

impl Workbench {
    /// Takes a file as if it were dropped.
    pub fn open(&mut self, name: &str, content: &[u8]) {
        let text = std::str::from_utf8(content).ok().map(str::to_owned);
        self.guided = None;
        match (Kind::of(name, text.as_deref()), text) {
            (Kind::Test, Some(text)) => {
                let name = plain(name);
                self.materials.put(TestFile { name, text });
                self.tab = Tab::Material;
            }
            (Kind::Field, _) => {
                self.fields.take_card(&self.table.scene().card);
                self.fields.put((plain(name), content.to_vec()));
                self.tab = Tab::Field;
            }
            (Kind::Edge, _) => {
                self.fields.put_edge((plain(name), content.to_vec()));
                self.tab = Tab::Field;
            }
            (Kind::Sheet, Some(text)) => self.lay(name, text),
            (Kind::Study, Some(text)) => self.leave(Then::PutStudy(name.to_owned(), text)),
            (Kind::Named, _) => {
                self.studies.put_file(name, content.to_vec());
                self.message = format!("{} can be named by the study now", plain(name));
                self.tab = Tab::Study;
            }
            _ => {
                self.message = Kind::nothing_reads(&plain(name));
                return;
            }
        }
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(path) = absolute_path(name) {
            self.recent.put(&path);
        }
    }

    /// Lays a study of a sheet on the table, or a card; what the table does not take is a study to be run.
    fn lay(&mut self, name: &str, text: String) {
        let is_card = Kind::is_card(&text);
        let file = name.to_owned();
        self.studies.put_file(name, text.clone().into_bytes());
        self.table.act(Action::Open {
            file,
            text: text.clone(),
        });
        self.tab = Tab::Sheet;
        match self.table.message() {
            None => self.message = format!("{name} is open"),
            Some(_) if is_card => return,
            Some(_) => {
                self.leave(Then::PutStudy(name.to_owned(), text));
                self.tab = Tab::Sheet;
                return;
            }
        }
        if !is_card {
            self.documents[Tab::Sheet as usize] = Document {
                path: absolute_path(name),
                saved: self.table.scene().study(),
            };
        }
    }

    /// The text of a view's document; nothing where it has none that could be lost.
    fn text(&self, tab: Tab) -> Option<String> {
        match tab {
            Tab::Sheet => Some(self.table.scene().study()),
            Tab::Study => Some(self.studies.text.clone()),
            // A card of the user is enclosed in the study of the sheet.
            Tab::Material | Tab::Field => None,
        }
    }

    /// Takes what the views hold for saved.
    pub(super) fn forget_changes(&mut self) {
        for (_, tab) in Tab::ALL {
            let text = self.text(tab).unwrap_or_default();
            self.documents[tab as usize].saved = text;
        }
    }

    /// Whether a view has changes that are not saved.
    pub fn is_changed(&self, tab: Tab) -> bool {
        let text = self.text(tab);
        text.is_some_and(|text| text != self.documents[tab as usize].saved)
    }

    /// What is saved of a view: its document, and the files that the document names.
    fn written(&self, tab: Tab) -> Option<Written> {
        let scene = self.table.scene();
        let card = || (scene.card.reference(), scene.card.text.clone().into_bytes());
        let files = match tab {
            Tab::Sheet => {
                let study = ("sheet.toml".to_owned(), scene.study().into_bytes());
                let card_file = (!scene.card.is_shipped()).then(card);
                [Some(study), card_file].into_iter().flatten().collect()
            }
            Tab::Material => {
                let (name, text) = card();
                vec![(format!("{}.toml", name.trim_end_matches(".toml")), text)]
            }
            Tab::Study => vec![self.studies.file()],
            Tab::Field => return None,
        };
        let name = "study".to_owned();
        Some(Written { name, files })
    }

    /// Saves what is shown where it was saved before, or where the user chooses.
    pub(super) fn save(&mut self, tab: Tab, elsewhere: bool) {
        let Some(written) = self.written(tab) else {
            self.message = "`export` saves the corrected field".to_owned();
            return;
        };
        let outgoing = Outgoing {
            written,
            document: self.text(tab).map(|_| tab),
        };
        let path = self.documents[tab as usize].path.clone();
        match path.filter(|_| !elsewhere) {
            Some(path) => self.files.save(&path, outgoing),
            None => self.files.give(outgoing),
        }
    }

    /// Gives files to the user that are no document.
    pub(super) fn give(&mut self, written: Written) {
        self.files.give(Outgoing {
            written,
            document: None,
        });
    }

    /// Takes what came of files.
    pub(super) fn receive_files(&mut self, context: &Context) {
        for event in self.files.events() {
            match event {
                #[cfg(target_arch = "wasm32")]
                Event::Chosen(_) => (),
                #[cfg(not(target_arch = "wasm32"))]
                Event::Chosen(path) => self.open_path(&path),
                Event::Failed(message) => {
                    self.message = message;
                    self.leaving = self.leaving.take().filter(|leaving| !leaving.saving);
                }
                Event::Saved {
                    outgoing,
                    path,
                    message,
                } => {
                    self.message = message;
                    if let Some(tab) = outgoing.document {
                        self.saved(tab, path, &outgoing.written);
                    }
                }
            }
        }
        let closes = context.input(|input| input.viewport().close_requested());
        if closes && self.first_changed().is_some() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.leave(Then::Close);
        }
        if self.closes {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    /// Notes what was saved of a view, which may have changed while a dialogue was open.
    fn saved(&mut self, tab: Tab, path: Option<PathBuf>, written: &Written) {
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(path) = &path {
            self.recent.put(path);
        }
        let text = written.files.first().map(|(_, content)| &content[..]);
        let saved = String::from_utf8_lossy(text.unwrap_or_default()).into_owned();
        self.documents[tab as usize] = Document { path, saved };
        if let Some(leaving) = self.leaving.take() {
            self.leave(leaving.then);
        }
    }

    fn first_changed(&self) -> Option<Tab> {
        let mut tabs = Tab::ALL.into_iter().map(|(_, tab)| tab);
        tabs.find(|tab| self.is_changed(*tab))
    }

    /// Does something that replaces documents, once the user has decided about their changes.
    pub(super) fn leave(&mut self, then: Then) {
        let changed = match &then {
            Then::Close => self.first_changed(),
            Then::PutStudy(..) => Some(Tab::Study).filter(|tab| self.is_changed(*tab)),
        };
        let Some(tab) = changed else {
            return self.go_on(then);
        };
        self.leaving = Some(Leaving {
            tab,
            then,
            saving: false,
        });
    }

    fn go_on(&mut self, then: Then) {
        match then {
            Then::Close => self.closes = true,
            Then::PutStudy(name, text) => {
                self.documents[Tab::Study as usize] = Document {
                    path: absolute_path(&name),
                    saved: text.clone(),
                };
                self.studies.put(&name, text);
                self.tab = Tab::Study;
            }
        }
    }

    /// Asks what must be answered before anything goes on; whether anything must.
    pub(super) fn ask(&mut self, context: &Context) -> bool {
        if self.files.ask(context) {
            return true;
        }
        let Some(leaving) = self.leaving.take_if(|leaving| !leaving.saving) else {
            return false;
        };
        let (name, _) = Tab::ALL[leaving.tab as usize];
        let text = format!("The {name} has changes that are not saved.");
        match question::ask(context, &text, &["save", "discard", "cancel"]) {
            None => self.leaving = Some(leaving),
            Some(0) => {
                let tab = leaving.tab;
                self.leaving = Some(Leaving {
                    saving: true,
                    ..leaving
                });
                self.save(tab, false);
            }
            Some(1) => {
                let text = self.text(leaving.tab).unwrap_or_default();
                self.documents[leaving.tab as usize].saved = text;
                self.leave(leaving.then);
            }
            Some(_) => (),
        }
        true
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Workbench {
    /// Opens a file of the disk, or reports why it cannot be read.
    pub fn open_path(&mut self, path: &std::path::Path) {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        match std::fs::read(&absolute) {
            Ok(content) => self.open(&absolute.display().to_string(), &content),
            Err(cause) => {
                self.recent.forget(&absolute);
                self.message = format!("cannot read {}: {cause}", absolute.display());
            }
        }
    }

    /// Takes a list of recent files.
    pub fn remember(&mut self, recent: crate::views::files::Recent) {
        self.recent = recent;
    }

    /// Takes other dialogues than those of the system.
    pub fn choose_by(&mut self, choose: crate::views::files::Choose) {
        self.files.choose_by(choose);
    }
}
