//! Studies of any kind: written here or dropped, run in the background, their reports shown and exported.

use eframe::egui::{Align, Button, CollapsingHeader, RichText, ScrollArea, TextEdit, Ui};

use gelbench::kinds::KINDS;
use gelbench_studies::studies::plate;

use super::exports::{self, Offer};
use super::files::plain;
use super::{figures, report};
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::outputs::Wanted;
use crate::logic::studies::{NamedFile, Report, Runner, StudyQuestion};

/// The state of the view.
pub struct Studies {
    name: String,
    /// The text as it is in the editor.
    pub text: String,
    /// The files that the study may name.
    pub files: Vec<NamedFile>,
    /// Who runs it.
    pub runner: Background<Runner>,
    report: Option<Result<Report, Fault>>,
    /// Whether the report has just come, and is scrolled to.
    arrived: bool,
    /// Whether the text is unfolded or folded in the next frame.
    unfolds: Option<bool>,
}

/// What the view asks for.
pub enum Asks {
    /// Another study in the place of this one.
    Example(String, &'static str),
    /// A file of the results is to be saved.
    File(NamedFile),
}

impl Studies {
    /// With the study of the plate.
    pub fn new(wake: Wake) -> Self {
        Self {
            name: "study.toml".to_owned(),
            text: plate::DEFAULT.to_owned(),
            files: Vec::new(),
            runner: Background::new(wake),
            report: None,
            arrived: false,
            unfolds: Some(true),
        }
    }

    /// Takes a study; what is being computed of the one before has no place any more.
    pub fn put(&mut self, name: &str, text: String) {
        self.runner.stop();
        (self.name, self.text, self.report) = (plain(name), text, None);
        self.unfolds = Some(true);
    }

    /// Takes a file that a study may name.
    pub fn put_file(&mut self, name: &str, content: Vec<u8>) {
        let name = plain(name);
        self.files.retain(|(known, _)| *known != name);
        self.files.push((name, content));
    }

    /// Takes what was computed.
    pub fn receive(&mut self) {
        if let Some(answer) = self.runner.answers().pop() {
            (self.arrived, self.unfolds) = (answer.is_ok(), Some(answer.is_err()));
            self.report = Some(answer);
        }
    }

    /// What was found.
    pub fn report(&self) -> Option<&Result<Report, Fault>> {
        self.report.as_ref()
    }

    /// Its exports, by name.
    pub fn offers(&self) -> Vec<Offer> {
        let all = "everything that `gelbench run` writes".to_owned();
        let mut offers = vec![(all, Wanted::Study(self.question()))];
        let report = self.report.as_ref().and_then(|report| report.as_ref().ok());
        let drawings = report.map_or(&[][..], |report| &report.figures);
        for (number, drawing) in drawings.iter().enumerate() {
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

    /// The study as a file.
    pub fn file(&self) -> NamedFile {
        (self.name.clone(), self.text.clone().into_bytes())
    }

    /// Shows the view; what it asks for.
    pub fn show(&mut self, ui: &mut Ui) -> Option<Asks> {
        let scroll = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let example = self.editor(ui);
            let file = match &self.report {
                None => None,
                Some(Err(fault)) => {
                    figures::fault(ui, fault);
                    None
                }
                Some(Ok(report)) => {
                    if std::mem::take(&mut self.arrived) {
                        ui.scroll_to_cursor(Some(Align::TOP));
                    }
                    let file = outputs(ui, &report.files);
                    report::show(ui, "report", report);
                    file
                }
            };
            example.or(file.map(Asks::File))
        });
        scroll.inner
    }

    fn editor(&mut self, ui: &mut Ui) -> Option<Asks> {
        let mut asks = None;
        ui.horizontal_wrapped(|ui| {
            ui.heading(&self.name);
            asks = ui.menu_button("examples", examples).inner.flatten();
            if ui
                .add_enabled(!self.runner.is_busy(), Button::new("run"))
                .clicked()
            {
                self.run();
            }
            if self.runner.is_busy() {
                ui.spinner();
                ui.label("computing; Escape stops it");
            }
        });
        if !self.files.is_empty() {
            let names: Vec<_> = self.files.iter().map(|(name, _)| name.as_str()).collect();
            ui.label(format!("files that a study can name: {}", names.join(", ")));
        }
        let text = CollapsingHeader::new("text of the study").open(self.unfolds.take());
        text.show(ui, |ui| {
            let edit = TextEdit::multiline(&mut self.text)
                .code_editor()
                .desired_width(f32::INFINITY);
            ui.add(edit);
        });
        asks
    }

    /// Runs the study.
    pub fn run(&mut self) {
        let question = self.question();
        self.report = None;
        self.runner.ask(question);
    }

    fn question(&self) -> StudyQuestion {
        let study = self.name.clone();
        let edited = self.file();
        let others = self
            .files
            .iter()
            .filter(|(name, _)| *name != study)
            .cloned();
        let files = others.chain([edited]).collect();
        StudyQuestion { study, files }
    }
}

/// The studies that come along; the one that was chosen.
fn examples(ui: &mut Ui) -> Option<Asks> {
    let mut chosen = None;
    let cases = KINDS.iter().map(|case| (case.name, case.study, case.slow));
    for (name, study, slow) in [("plate", plate::DEFAULT, false)].into_iter().chain(cases) {
        let label = if slow {
            format!("{name} (minutes)")
        } else {
            name.to_owned()
        };
        if ui.button(label).clicked() {
            chosen = Some(Asks::Example(format!("{name}.toml"), study));
        }
    }
    chosen
}

/// Buttons that give files out; the file of the one that was pressed.
pub fn outputs(ui: &mut Ui, all: &[NamedFile]) -> Option<NamedFile> {
    let mut pressed = None;
    if all.is_empty() {
        return pressed;
    }
    ui.collapsing(
        RichText::new(format!("{} files: tables and VTK", all.len())),
        |ui| {
            ui.horizontal_wrapped(|ui| {
                for (name, content) in all {
                    let plain = plain(name);
                    if ui.small_button(&plain).clicked() {
                        pressed = Some((plain, content.clone()));
                    }
                }
            });
        },
    );
    pressed
}
