//! Studies of any kind: written here or dropped, run beside the drawing, their reports shown and given out.

use eframe::egui::{Button, CollapsingHeader, RichText, ScrollArea, TextEdit, Ui};

use gelbench::kinds::KINDS;
use gelbench_studies::studies::plate;

use super::exports::{self, Offer};
use super::{figures, files, report};
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::outputs::Wanted;
use crate::logic::report::{Part, Report};
use crate::logic::studies::{NamedFile, Runner, StudyQuestion};

/// The state of the view.
pub struct Studies {
    name: String,
    text: String,
    files: Vec<NamedFile>,
    runner: Background<Runner>,
    found: Option<Result<Report, Fault>>,
    told: String,
}

impl Studies {
    /// With the study of the plate.
    pub fn new(wake: Wake) -> Self {
        Self {
            name: "study.toml".to_owned(),
            text: plate::DEFAULT.to_owned(),
            files: Vec::new(),
            runner: Background::new(wake),
            found: None,
            told: String::new(),
        }
    }

    /// Takes a study.
    pub fn put(&mut self, name: &str, text: String) {
        (self.name, self.text, self.found) = (plain(name), text, None);
    }

    /// Takes a file that a study may name.
    pub fn put_file(&mut self, name: &str, content: Vec<u8>) {
        let name = plain(name);
        self.files.retain(|(known, _)| *known != name);
        self.files.push((name, content));
    }

    /// The files that are known.
    pub fn files(&self) -> &[NamedFile] {
        &self.files
    }

    /// Takes what was computed.
    pub fn receive(&mut self) {
        if let Some(answer) = self.runner.answers().pop() {
            self.found = Some(answer);
        }
    }

    /// Whether something is being computed.
    pub fn is_busy(&self) -> bool {
        self.runner.is_busy()
    }

    /// Stops it.
    pub fn stop(&mut self) {
        self.runner.stop();
    }

    /// What was found.
    pub fn found(&self) -> Option<&Result<Report, Fault>> {
        self.found.as_ref()
    }

    /// What of it may go out, by name.
    pub fn offers(&self) -> Vec<Offer> {
        let all = "everything that `gelbench run` writes".to_owned();
        let mut offers = vec![(all, Wanted::Study(self.question()))];
        let found = self.found.as_ref().and_then(|found| found.as_ref().ok());
        let parts = found.map_or(&[][..], |report| &report.parts).iter();
        let drawings = parts.filter_map(|part| match part {
            Part::Picture(drawing, _) => Some(drawing),
            _ => None,
        });
        for (number, drawing) in drawings.enumerate() {
            let number = number + 1;
            let what = format!("picture {number}");
            offers.extend(exports::pictures(
                &what,
                &format!("picture_{number}"),
                drawing,
            ));
        }
        offers
    }

    /// Shows the view.
    pub fn show(&mut self, ui: &mut Ui) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            self.text(ui);
            match &self.found {
                None => (),
                Some(Err(fault)) => figures::fault(ui, fault),
                Some(Ok(found)) => {
                    self.told = outputs(ui, &found.files).unwrap_or(std::mem::take(&mut self.told));
                    report::show(ui, "report", found);
                }
            }
        });
    }

    fn text(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.heading(&self.name);
            ui.menu_button("examples", |ui| {
                if ui.button("plate").clicked() {
                    self.put("plate.toml", plate::DEFAULT.to_owned());
                }
                for case in KINDS {
                    let name = if case.slow {
                        format!("{} (minutes)", case.name)
                    } else {
                        case.name.to_owned()
                    };
                    if ui.button(name).clicked() {
                        self.put(&format!("{}.toml", case.name), case.study.to_owned());
                    }
                }
            });
            if ui
                .add_enabled(!self.runner.is_busy(), Button::new("run"))
                .clicked()
            {
                self.run();
            }
            if ui.button("save").clicked() {
                self.told = self.save();
            }
            if self.runner.is_busy() {
                ui.spinner();
                ui.label("computing; Escape stops it");
            }
        });
        if !self.told.is_empty() {
            ui.label(&self.told);
        }
        if !self.files.is_empty() {
            let names: Vec<_> = self.files.iter().map(|(name, _)| name.as_str()).collect();
            ui.label(format!("files that a study can name: {}", names.join(", ")));
        }
        let text = CollapsingHeader::new("text of the study").default_open(true);
        text.show(ui, |ui| {
            let edit = TextEdit::multiline(&mut self.text)
                .code_editor()
                .desired_width(f32::INFINITY);
            ui.add(edit);
        });
    }

    /// Saves the text under its name; says where it is.
    pub fn save(&self) -> String {
        files::save(&self.name, self.text.as_bytes()).unwrap_or_else(|fault| fault)
    }

    /// Runs the study.
    pub fn run(&mut self) {
        let question = self.question();
        self.found = None;
        self.runner.ask(question);
    }

    fn question(&self) -> StudyQuestion {
        let study = self.name.clone();
        let own = (study.clone(), self.text.clone().into_bytes());
        let others = self
            .files
            .iter()
            .filter(|(name, _)| *name != study)
            .cloned();
        let files = others.chain([own]).collect();
        StudyQuestion { study, files }
    }
}

/// Buttons that give files out; what came of the one that was pressed.
pub fn outputs(ui: &mut Ui, all: &[NamedFile]) -> Option<String> {
    let mut told = None;
    if all.is_empty() {
        return told;
    }
    ui.collapsing(
        RichText::new(format!("{} files: tables and VTK", all.len())),
        |ui| {
            ui.horizontal_wrapped(|ui| {
                for (name, content) in all {
                    let plain = plain(name);
                    if ui.small_button(&plain).clicked() {
                        told = Some(files::save(&plain, content).unwrap_or_else(|fault| fault));
                    }
                }
            });
        },
    );
    told
}

/// The name of a file without its folders.
pub fn plain(name: &str) -> String {
    name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned()
}
