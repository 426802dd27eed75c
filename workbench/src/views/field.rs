//! Measured fields: files are dropped, looked at, edges are said, the field is corrected and judged.

use std::collections::BTreeMap;

use eframe::egui::{
    Button, Color32, ComboBox, Grid, RichText, ScrollArea, Slider, Stroke, TextEdit, Ui,
};

use gelbench::results::{Drawing, PALETTE, Scale};

use super::{figures, report, study};
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::field::{
    CorrectedFrame, Edge, FieldAnswer, FieldCorrector, FieldQuestion, Preview,
};
use crate::logic::scene::CardFile;
use crate::logic::studies::NamedFile;

/// The field that comes along, with noise, outliers and what is known of its edges.
const EXAMPLE: &[u8] = include_bytes!("../../../examples/measured_plate.csv");

/// The state of the view.
pub struct Fields {
    question: FieldQuestion,
    corrector: Background<FieldCorrector>,
    found: Option<Result<FieldAnswer, Fault>>,
    frame: usize,
    field: usize,
    residuals: bool,
    told: String,
}

impl Fields {
    /// Without a field.
    pub fn new(wake: Wake, card: CardFile) -> Self {
        Self {
            question: FieldQuestion {
                files: Vec::new(),
                card,
                thickness: "2 mm".to_owned(),
                unit: String::new(),
                columns: String::new(),
                downwards: None,
                edge_gap: String::new(),
                cell_size: String::new(),
                edges: BTreeMap::new(),
                correct: false,
            },
            corrector: Background::new(wake),
            found: None,
            frame: 0,
            field: 0,
            residuals: true,
            told: String::new(),
        }
    }

    /// Takes a file of markers; another one before it is another frame.
    pub fn put(&mut self, file: NamedFile) {
        self.question.files.retain(|(known, _)| *known != file.0);
        self.question.files.push(file);
        self.question.files.sort();
        self.look();
    }

    /// Opens the example, whose grips are rigid and whose long sides are free.
    pub fn open_example(&mut self) {
        self.question.files = vec![("measured_plate.csv".to_owned(), EXAMPLE.to_vec())];
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

    fn look(&mut self) {
        self.ask(false);
    }

    fn ask(&mut self, correct: bool) {
        let question = FieldQuestion {
            correct,
            ..self.question.clone()
        };
        self.corrector.ask(question);
    }

    /// Corrects the field that is there.
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
            }
            self.found = Some(answer);
            self.frame = usize::MAX;
        }
    }

    /// Whether something is being computed.
    pub fn is_busy(&self) -> bool {
        self.corrector.is_busy()
    }

    /// Stops it.
    pub fn stop(&mut self) {
        self.corrector.stop();
    }

    /// What was found.
    pub fn found(&self) -> Option<&Result<FieldAnswer, Fault>> {
        self.found.as_ref()
    }

    /// Shows the view.
    pub fn show(&mut self, ui: &mut Ui) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            self.files(ui);
            if self.question.files.is_empty() {
                return;
            }
            self.said(ui);
            let found = self.found.take();
            match &found {
                None => (),
                Some(Err(fault)) => figures::fault(ui, fault),
                Some(Ok(answer)) => self.answer(ui, answer),
            }
            self.found = found.or(self.found.take());
        });
    }

    fn files(&mut self, ui: &mut Ui) {
        ui.heading("Measured field");
        if self.question.files.is_empty() {
            ui.label(
                "Drop the file of your markers here: a table with x, y, ux, uy, or what DICe, VIC, MatchID, GOM, pyALDIC or muDIC \
                 write. Several files are frames. Nothing leaves this machine.",
            );
        }
        let mut gone = None;
        ui.horizontal_wrapped(|ui| {
            if ui.button("open the example").clicked() {
                self.open_example();
            }
            for (number, (name, _)) in self.question.files.iter().enumerate() {
                ui.label(name);
                if ui.small_button("take away").clicked() {
                    gone = Some(number);
                }
            }
        });
        if let Some(number) = gone {
            self.question.files.remove(number);
            self.found = None;
            if !self.question.files.is_empty() {
                self.look();
            }
        }
    }

    fn said(&mut self, ui: &mut Ui) {
        let FieldQuestion {
            card,
            thickness,
            unit,
            columns,
            edge_gap,
            cell_size,
            downwards,
            ..
        } = &mut self.question;
        ui.label(format!("material: {} (that of the sheet)", card.name));
        Grid::new("said of the field")
            .num_columns(4)
            .show(ui, |ui| {
                let texts = [
                    ("thickness at rest", thickness, "2 mm"),
                    ("unit or pixel", unit, "mm, or 0.05 mm"),
                    ("columns", columns, "x=x_px,y=y_px,ux=u,uy=v"),
                    ("gap to the edge", edge_gap, "1 mm"),
                    ("size of cells", cell_size, "as the markers"),
                ];
                for (number, (name, text, hint)) in texts.into_iter().enumerate() {
                    let label = ui.label(name);
                    let edit = TextEdit::singleline(text).hint_text(hint);
                    ui.add_sized([150.0, 20.0], edit).labelled_by(label.id);
                    if number % 2 == 1 {
                        ui.end_row();
                    }
                }
            });
        ui.horizontal_wrapped(|ui| {
            ui.label("y axis of the file:");
            for (name, value) in [
                ("as known", None),
                ("up", Some(false)),
                ("down", Some(true)),
            ] {
                ui.selectable_value(downwards, value, name);
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
        if !self.told.is_empty() {
            ui.label(&self.told);
        }
    }

    fn answer(&mut self, ui: &mut Ui, answer: &FieldAnswer) {
        self.edges(ui, &answer.preview);
        let Some((frames, found)) = &answer.corrected else {
            self.preview(ui, &answer.preview);
            return;
        };
        self.frames(ui, frames);
        if let Some(told) = study::outputs(ui, &found.files) {
            self.told = told;
        }
        ui.collapsing("report", |ui| report::show(ui, "field", found));
    }

    fn edges(&mut self, ui: &mut Ui, preview: &Preview) {
        ui.horizontal_wrapped(|ui| {
            for (number, name) in preview.edges.iter().enumerate() {
                let [r, g, b] = PALETTE[number % PALETTE.len()];
                let edge = self
                    .question
                    .edges
                    .entry(name.clone())
                    .or_insert(Edge::Unnamed);
                let ink = Color32::from_rgb(r, g, b);
                let label = RichText::new(name).color(ink).strong();
                let shown = Edge::ALL.iter().find(|(_, known)| known == edge);
                let chosen = ComboBox::new(("edge", name), label).width(100.0);
                chosen
                    .selected_text(shown.map_or("", |(name, _)| name))
                    .show_ui(ui, |ui| {
                        for (name, value) in Edge::ALL {
                            ui.selectable_value(edge, value, name);
                        }
                    });
            }
        });
    }

    fn preview(&self, ui: &mut Ui, preview: &Preview) {
        for warning in &preview.warnings {
            ui.colored_label(ui.visuals().warn_fg_color, warning);
        }
        ui.label(&preview.mesh);
        if let Drawing::Mesh(figure) = &preview.drawing {
            let view = report::mesh(ui, figure);
            let painter = ui.painter();
            let ink = ui.visuals().strong_text_color();
            for [rest, found] in &preview.markers {
                let (from, to) = (view.at(*rest), view.at(*found));
                painter.circle_filled(from, 1.5, ink);
                painter.line_segment([from, to], Stroke::new(0.7, ink.gamma_multiply(0.5)));
            }
        }
        ui.collapsing("how the file was understood", |ui| {
            for line in &preview.understood {
                ui.label(line);
            }
        });
    }

    fn frames(&mut self, ui: &mut Ui, frames: &[CorrectedFrame]) {
        self.frame = self.frame.min(frames.len().saturating_sub(1));
        if frames.len() > 1 {
            ui.add(Slider::new(&mut self.frame, 0..=frames.len() - 1).text("frame"));
        }
        let Some(frame) = frames.get(self.frame) else {
            return;
        };
        let ink = match frame.explained {
            true => ui.visuals().strong_text_color(),
            false => ui.visuals().error_fg_color,
        };
        ui.label(
            RichText::new(format!(
                "verdict, frame {}: {}",
                frame.number, frame.verdict
            ))
            .color(ink)
            .strong(),
        );
        for (edge, [x, y]) in &frame.forces {
            let axis = |[value, low, high]: &[f64; 3]| match frame.explained {
                true => format!("{value:.4} N ({low:.4} … {high:.4})"),
                false => format!("{value:.4} N (no interval)"),
            };
            ui.label(format!("force on {edge}: x {}, y {}", axis(x), axis(y)));
        }
        ui.horizontal_wrapped(|ui| {
            for (number, (name, _)) in frame.fields.iter().enumerate() {
                ui.selectable_value(&mut self.field, number, name);
            }
            ui.checkbox(&mut self.residuals, "residuals of the markers");
        });
        self.field = self.field.min(frame.fields.len().saturating_sub(1));
        if let Some((name, panel)) = frame.fields.get(self.field) {
            report::panels(ui, name, Scale::Linear, std::slice::from_ref(panel));
        }
        if self.residuals {
            residuals(ui, frame);
        }
    }
}

/// What is left of every marker, enlarged; those that are far off in another colour.
fn residuals(ui: &mut Ui, frame: &CorrectedFrame) {
    let places: Vec<[f64; 2]> = frame.residuals.iter().map(|(place, ..)| *place).collect();
    let sizes = frame.residuals.iter().filter(|(.., trust)| *trust > 0.5);
    let largest = sizes
        .map(|(_, left, _)| left[0].hypot(left[1]))
        .fold(0.0, f64::max);
    let Some([low, high]) = super::colours::range(places.iter().map(|place| place[0])) else {
        return;
    };
    let enlarged = 0.04 * (high - low) / largest.max(1e-12);
    ui.label(format!("residuals of the markers at rest, {enlarged:.1} times as long; far off in the colour of faults"));
    let (view, area) = report::room(ui, places.iter());
    let painter = ui.painter().with_clip_rect(area);
    for (place, left, trust) in &frame.residuals {
        let ink = match *trust > 0.5 {
            true => ui.visuals().text_color(),
            false => ui.visuals().error_fg_color,
        };
        let to = [0, 1].map(|axis| place[axis] + enlarged * left[axis]);
        painter.circle_filled(view.at(*place), 1.5, ink);
        painter.line_segment([view.at(*place), view.at(to)], Stroke::new(1.0, ink));
    }
}
