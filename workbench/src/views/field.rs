//! Measured fields: files are dropped and shown, conditions of edges are stated, the field is corrected and judged.

use std::path::Path;

use eframe::egui::{Button, Frame, Grid, ScrollArea, TextEdit, Ui};
use gelbench_images::images::{in_order, is_image_path};

use super::surface::View;
use super::{controls, exports, figures, report, study};
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::field::{Edge, FieldAnswer, FieldCorrector, FieldQuestion, Preview, settings};
use crate::logic::outputs::Wanted;
use crate::logic::scene::CardFile;
use crate::logic::studies::NamedFile;
use crate::logic::table::Table;

mod drawn_edge;
mod edges;
mod frames;
mod photos;

use drawn_edge::DrawnEdge;
use edges::Asked;
use photos::Photographs;

/// The width from which statements and results stand side by side.
const WIDE: f32 = 900.0;

/// How far from an edge or a corner a click may be, in points: as wide as a finger.
const REACH: f32 = 14.0;

/// The example, a field with noise, outliers and conditions of its edges.
const EXAMPLE: &[u8] = include_bytes!("../../../examples/measured_plate.csv");

/// The state of the view.
pub struct Fields {
    /// The files, and what is stated about them.
    pub question: FieldQuestion,
    /// Who corrects it.
    pub corrector: Background<FieldCorrector>,
    answer: Option<Result<FieldAnswer, Fault>>,
    frame: usize,
    field: usize,
    residuals: bool,
    /// The last question.
    done: Option<FieldQuestion>,
    asked: Asked,
    /// Where the mesh was drawn last.
    pub view: Option<View>,
    /// The last preview of the files.
    seen: Option<Preview>,
    photographs: Photographs,
    /// The edge that is being drawn.
    drawn: Option<DrawnEdge>,
}

impl Fields {
    /// Without a field.
    pub fn new(wake: Wake, card: CardFile) -> Self {
        Self {
            question: FieldQuestion::of(Vec::new(), card),
            corrector: Background::new(wake),
            answer: None,
            frame: 0,
            field: 0,
            residuals: true,
            done: None,
            asked: None,
            view: None,
            seen: None,
            photographs: Photographs::default(),
            drawn: None,
        }
    }

    /// Takes a file of markers, or a camera image; another one before it is another frame. An image that is called a mask is the specimen's
    /// region.
    pub fn put(&mut self, file: NamedFile) {
        if is_image_path(Path::new(&file.0)) && file.0.to_lowercase().contains("mask") {
            return self.put_edge(file);
        }
        self.seen = None;
        self.question.files.retain(|(known, _)| *known != file.0);
        self.question.files.push(file);
        self.question
            .files
            .sort_by_cached_key(|(name, _)| in_order(name));
        self.look();
    }

    /// Takes the specimen's edge: a table of lines, or an image of its region.
    pub fn put_edge(&mut self, file: NamedFile) {
        self.question.edge_file = Some(file);
        self.look();
    }

    /// Opens the example, whose grips are rigid and whose long sides are free.
    pub fn open_example(&mut self) {
        self.question.files = vec![("measured_plate.csv".to_owned(), EXAMPLE.to_vec())];
        self.question.edge_file = None;
        let edges = [
            ("left", Edge::Rigid),
            ("right", Edge::Rigid),
            ("top", Edge::Free),
            ("bottom", Edge::Free),
        ];
        self.question.edges = edges.map(|(name, edge)| (name.to_owned(), edge)).into();
        self.question.edge_gap = "0 mm".to_owned();
        self.question.thickness = "2 mm".to_owned();
        self.look();
    }

    /// Takes the material of the sheet.
    pub fn take_card(&mut self, card: &CardFile) {
        self.question.card = card.clone();
    }

    /// Looks at the files; one image alone waits for the next.
    fn look(&mut self) {
        if self.question.waits_for_images() || self.question.files.is_empty() {
            self.corrector.stop();
        } else {
            self.ask(false);
        }
    }

    fn ask(&mut self, correct: bool) {
        let question = FieldQuestion {
            correct,
            ..self.question.clone()
        };
        self.done = Some(self.stated_question());
        self.corrector.ask(question);
    }

    /// The question without the edges about which nothing is stated.
    fn stated_question(&self) -> FieldQuestion {
        let mut question = self.question.clone();
        question.edges.retain(|_, edge| *edge != Edge::Unnamed);
        question
    }

    /// Corrects the field.
    pub fn correct(&mut self) {
        if !self.question.files.is_empty() {
            self.ask(true);
        }
    }

    /// Takes what was found.
    pub fn receive(&mut self) {
        if let Some(answer) = self.corrector.answers().pop() {
            if let Ok(FieldAnswer { preview, .. }) = &answer {
                for name in &preview.edges {
                    self.question
                        .edges
                        .entry(name.clone())
                        .or_insert(Edge::Unnamed);
                }
                self.question
                    .edges
                    .retain(|name, _| preview.edges.contains(name));
                self.seen = Some(preview.clone());
            }
            self.answer = Some(answer);
            self.photographs = Photographs::default();
            self.frame = usize::MAX;
        }
    }

    /// What was found.
    pub fn answer(&self) -> Option<&Result<FieldAnswer, Fault>> {
        self.answer.as_ref()
    }

    /// Its exports, by name.
    pub fn offers(&self) -> Vec<(String, Wanted)> {
        let Some(Ok(FieldAnswer { preview, corrected })) = &self.answer else {
            return Vec::new();
        };
        let mut offers = Vec::new();
        if let Some((frames, _)) = corrected {
            let question = FieldQuestion {
                correct: true,
                ..self.question.clone()
            };
            let all = "everything that `gelbench correct` writes".to_owned();
            offers.push((all, Wanted::Correction(Box::new(question))));
            let drawing = frames.get(self.frame).and_then(|frame| self.drawing(frame));
            offers.extend(
                drawing
                    .iter()
                    .flat_map(|drawing| exports::pictures("the corrected field", "field", drawing)),
            );
        }
        offers.extend(exports::pictures("the mesh", "mesh", &preview.drawing));
        offers
    }

    /// Shows the view; a file of the results that the user wants to save.
    pub fn show(&mut self, ui: &mut Ui, table: &mut Table) -> Option<NamedFile> {
        let scroll = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            self.files(ui);
            if self.question.files.is_empty() {
                return None;
            }
            let answered = self.answer.take();
            let answer = answered
                .as_ref()
                .and_then(|answered| answered.as_ref().ok());
            let corrected = answer.is_some_and(|answer| answer.corrected.is_some());
            let file = if corrected && ui.available_width() > WIDE {
                ui.columns(2, |columns| {
                    self.question(&mut columns[0], table, answered.as_ref());
                    let column = Frame::new().inner_margin(controls::COLUMN_MARGIN);
                    let column = column.show(&mut columns[1], |ui| self.results(ui, answer));
                    column.inner
                })
            } else {
                self.question(ui, table, answered.as_ref());
                self.results(ui, answer)
            };
            self.answer = answered.or(self.answer.take());
            file
        });
        scroll.inner
    }

    /// The statements about the field, and its picture.
    fn question(
        &mut self,
        ui: &mut Ui,
        table: &mut Table,
        answer: Option<&Result<FieldAnswer, Fault>>,
    ) {
        self.inputs(ui, table);
        if let Some(Err(fault)) = answer {
            figures::fault(ui, fault);
        }
        if let Some(preview) = self.seen.take() {
            self.preview(ui, &preview);
            self.seen = Some(preview);
        }
    }

    fn results(&mut self, ui: &mut Ui, answer: Option<&FieldAnswer>) -> Option<NamedFile> {
        let (frames, report) = answer?.corrected.as_ref()?;
        if self.done.as_ref() != Some(&self.stated_question()) {
            let ink = ui.visuals().warn_fg_color;
            ui.colored_label(
                ink,
                "The stated conditions have changed since: press `correct` to apply them.",
            );
        }
        self.frames(ui, frames);
        let file = study::outputs(ui, &report.files);
        ui.collapsing("report", |ui| report::show(ui, "field", report));
        file
    }

    fn files(&mut self, ui: &mut Ui) {
        ui.heading("Measured field");
        if self.question.files.is_empty() {
            ui.label(
                "Drop the file of your markers here: a table with x, y, ux, uy, or an export of DICe, VIC, MatchID, GOM, \
                 pyALDIC or muDIC. Several files are frames. Or drop camera images of a speckled specimen, the first one at rest, \
                 and its edge: a table of x, y, line, or a mask. No data leave this machine.",
            );
        }
        let mut gone = None;
        ui.horizontal_wrapped(|ui| {
            if ui.button("open the example").clicked() {
                self.open_example();
            }
            for (number, (name, _)) in self.question.files.iter().enumerate() {
                ui.label(name);
                if ui.small_button("remove").clicked() {
                    gone = Some(number);
                }
            }
        });
        if let Some(number) = gone {
            self.question.files.remove(number);
            (self.answer, self.seen) = (None, None);
            self.look();
        }
        if self.question.waits_for_images() {
            ui.label("This is the specimen at rest: drop an image under load beside it.");
        }
        let edge_name = self.question.edge_file.as_ref().map(|(name, _)| name);
        if let Some(name) = edge_name.cloned() {
            ui.horizontal(|ui| {
                ui.label(format!("edge of the specimen: {name}"));
                if ui.small_button("remove").clicked() {
                    self.question.edge_file = None;
                    self.look();
                }
            });
        }
    }

    fn inputs(&mut self, ui: &mut Ui, table: &mut Table) {
        let mut chosen = table.scene().card.clone();
        controls::card(ui, settings::MATERIAL.label, &mut chosen, table.cards());
        if chosen != table.scene().card {
            table.take_card(chosen, false);
            self.question.card = table.scene().card.clone();
        }
        Grid::new("stated about the field")
            .num_columns(4)
            .show(ui, |ui| {
                let texts = settings::TEXTS.iter().zip(self.question.texts());
                for (number, (setting, text)) in texts.enumerate() {
                    let label = ui.label(setting.label);
                    let edit = TextEdit::singleline(text).hint_text(setting.example);
                    ui.add_sized([150.0, 20.0], edit).labelled_by(label.id);
                    if number % 2 == 1 {
                        ui.end_row();
                    }
                }
            });
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("{}:", settings::Y_AXIS.label));
            for (name, value) in [
                ("as known", None),
                ("up", Some(false)),
                ("down", Some(true)),
            ] {
                ui.selectable_value(&mut self.question.downwards, value, name);
            }
        });
        ui.horizontal_wrapped(|ui| {
            let idle = !self.corrector.is_busy();
            if ui.add_enabled(idle, Button::new("look")).clicked() {
                self.look();
            }
            if ui.add_enabled(idle, Button::new("correct")).clicked() {
                self.correct();
            }
            if !idle {
                ui.spinner();
                ui.label("computing; Escape stops it");
            }
        });
    }

    fn preview(&mut self, ui: &mut Ui, preview: &Preview) {
        for warning in &preview.warnings {
            ui.colored_label(ui.visuals().warn_fg_color, warning);
        }
        ui.add_space(4.0);
        if let Some(photo) = &preview.photo
            && self.draws_edge(ui, photo)
        {
            return;
        }
        ui.label(format!(
            "The mesh: {}. Click an edge and state what is known about it:",
            preview.mesh
        ));
        self.mesh(ui, preview);
        self.edges(ui, preview);
        ui.collapsing("how the file was read", |ui| {
            for line in &preview.understood {
                ui.label(line);
            }
        });
        ui.collapsing("the same on the command line", |ui| {
            ui.monospace(self.question.command());
        });
    }
}
