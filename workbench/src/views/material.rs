//! Materials: a card with its curves, parameters that are moved, and laws fitted to dropped tests.

use eframe::egui::{
    Button, ComboBox, DragValue, Frame, Grid, RichText, ScrollArea, TextEdit, Ui, vec2,
};

use gelbench::material::Card;
use gelbench::material::registry::Law;
use gelbench_calibration::calibration::KEYS;
use gelbench_mechanics::material::registry::MARLOW_TABLE;
use gelbench_report::results::{LineChart, material_chart};

use super::{chart, controls, exports, figures};
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::material::{FitQuestion, Fitted, Fitter, Ranking, TestFile, stable_ranges};
use crate::logic::outputs::Wanted;
use crate::logic::scene::CardFile;
use crate::logic::table::Table;

/// The state of the view.
pub struct Materials {
    question: FitQuestion,
    /// Who fits.
    pub fitter: Background<Fitter>,
    ranking: Option<Result<Ranking, Fault>>,
    chosen: usize,
    /// The points of the tests, as they were read last.
    pub seen: Option<LineChart>,
    /// The card of the curves, as it was read last.
    read: Option<(CardFile, Result<Card, Fault>)>,
}

impl Materials {
    /// Without tests.
    pub fn new(wake: Wake) -> Self {
        Self {
            question: FitQuestion::default(),
            fitter: Background::new(wake),
            ranking: None,
            chosen: 0,
            seen: None,
            read: None,
        }
    }

    /// Takes a file of test data.
    pub fn put(&mut self, file: TestFile) {
        self.question.tests.retain(|known| known.name != file.name);
        self.question.tests.push(file);
        self.look();
    }

    /// Has the tests read, so that their points can be seen.
    fn look(&mut self) {
        (self.ranking, self.chosen) = (None, 0);
        if self.question.tests.is_empty() {
            self.seen = None;
        } else {
            self.ask(false);
        }
    }

    fn ask(&mut self, fit: bool) {
        self.fitter.ask(FitQuestion {
            fit,
            ..self.question.clone()
        });
    }

    /// Takes what was fitted.
    pub fn receive(&mut self) {
        let Some(answer) = self.fitter.answers().pop() else {
            return;
        };
        self.seen = answer.as_ref().ok().map(|answer| answer.measured.clone());
        self.ranking = answer.map(|answer| answer.ranking).transpose();
        self.chosen = 0;
    }

    /// Fits the tests that are there.
    pub fn fit(&mut self) {
        if !self.question.tests.is_empty() {
            self.ask(true);
        }
    }

    /// What was fitted last.
    pub fn ranking(&self) -> Option<&Result<Ranking, Fault>> {
        self.ranking.as_ref()
    }

    /// Its exports, by name.
    pub fn offers(&self) -> Vec<(String, Wanted)> {
        let mut offers = Vec::new();
        if let Some((_, Ok(card))) = &self.read {
            let chart = material_chart(card);
            offers.extend(exports::chart("the card's curves", "curves", &chart));
        }
        let ranking = self
            .ranking
            .as_ref()
            .and_then(|ranking| ranking.as_ref().ok());
        if let Some(fit) = ranking.and_then(|ranking| ranking.fits.get(self.chosen)) {
            for (number, chart) in fit.charts.iter().enumerate() {
                let what = ["the fit", "its residuals"][number.min(1)];
                let name = ["fit", "residuals"][number.min(1)];
                offers.extend(exports::chart(what, name, chart));
            }
        }
        offers
    }

    /// Shows the view; whether the card shall be saved.
    pub fn show(&mut self, ui: &mut Ui, table: &mut Table) -> bool {
        let scroll = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let wide = ui.available_width() > 900.0;
            if wide {
                ui.columns(2, |columns| {
                    let saves = self.card(&mut columns[0], table);
                    let column = Frame::new().inner_margin(controls::COLUMN_MARGIN);
                    column.show(&mut columns[1], |ui| self.tests(ui, table));
                    saves
                })
            } else if self.question.tests.is_empty() {
                let saves = self.card(ui, table);
                ui.separator();
                self.tests(ui, table);
                saves
            } else {
                // What was dropped is seen without scrolling.
                self.tests(ui, table);
                ui.separator();
                self.card(ui, table)
            }
        });
        scroll.inner
    }

    fn card(&mut self, ui: &mut Ui, table: &mut Table) -> bool {
        let mut saves = false;
        ui.heading("Card");
        let file = table.scene().card.clone();
        ui.horizontal_wrapped(|ui| {
            let mut chosen = file.clone();
            controls::card(ui, "card", &mut chosen, table.cards());
            if chosen != file {
                table.take_card(chosen, false);
            }
            saves = ui.button("save card").clicked();
        });
        if self.read.as_ref().is_none_or(|(known, _)| *known != file) {
            self.read = Some((file.clone(), file.read().map_err(Fault::from)));
        }
        match &self.read {
            None => (),
            Some((_, Err(fault))) => figures::fault(ui, fault),
            Some((_, Ok(card))) => about(ui, &file, card, table),
        }
        saves
    }

    fn tests(&mut self, ui: &mut Ui, table: &mut Table) {
        ui.heading("Fit to tests");
        if self.question.tests.is_empty() {
            ui.label("Drop the CSV file of a test here: stretch or strain, and stress or force.");
        }
        let mut gone = None;
        for (number, file) in self.question.tests.iter().enumerate() {
            ui.horizontal(|ui| {
                ui.label(&file.name);
                if ui.small_button("remove").clicked() {
                    gone = Some(number);
                }
            });
        }
        if let Some(number) = gone {
            self.question.tests.remove(number);
            self.look();
        }
        if self.question.tests.is_empty() {
            return;
        }
        self.reading(ui);
        self.law(ui);
        match (&self.ranking, &self.seen) {
            (None, None) => (),
            (None, Some(measured)) => {
                ui.label(RichText::new(&measured.title).small());
                chart::show(ui, "measured", measured, 260.0);
            }
            (Some(Err(fault)), _) => {
                figures::fault(ui, fault);
                ui.label("Anything the file does not state is stated above.");
            }
            (Some(Ok(ranking)), _) => {
                ranked(ui, ranking, &mut self.chosen);
                if let Some(fit) = ranking.fits.get(self.chosen) {
                    result(ui, fit, table);
                }
            }
        }
    }

    fn reading(&mut self, ui: &mut Ui) {
        let mut stated = false;
        ui.collapsing("not stated in the files", |ui| {
            Grid::new("reading").num_columns(2).show(ui, |ui| {
                for key in KEYS {
                    let label = ui.label(key);
                    let mut value = self.question.reading.get(key).cloned().unwrap_or_default();
                    let edit = TextEdit::singleline(&mut value)
                        .desired_width(140.0)
                        .hint_text(hint(key));
                    if ui.add(edit).labelled_by(label.id).changed() {
                        stated = true;
                        self.question.reading.remove(key);
                        if !value.trim().is_empty() {
                            self.question.reading.insert(key.to_owned(), value);
                        }
                    }
                    ui.end_row();
                }
            });
        });
        if stated {
            self.look();
        }
    }

    fn law(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            let law = &mut self.question.law;
            let name = law.clone().unwrap_or_else(|| "all laws".to_owned());
            ComboBox::from_label("law")
                .selected_text(name)
                .show_ui(ui, |ui| {
                    ui.selectable_value(law, None, "all laws");
                    for known in Law::fitted().filter(|known| known.name != MARLOW_TABLE) {
                        ui.selectable_value(law, Some(known.name.to_owned()), known.name);
                    }
                });
            if ui
                .add_enabled(!self.fitter.is_busy(), Button::new("fit"))
                .clicked()
            {
                self.fit();
            }
            if self.fitter.is_busy() {
                ui.spinner();
                ui.label("fitting; Escape stops it");
            }
        });
    }
}

/// What a card is, with its parameters to be moved and its curves.
fn about(ui: &mut Ui, file: &CardFile, card: &Card, table: &mut Table) {
    ui.label(RichText::new(&card.title).strong());
    ui.label(card.energy());
    parameters(ui, file, card, table);
    for (name, [low, high]) in stable_ranges(card) {
        ui.label(format!(
            "stable (Drucker) in {name} tests for λ = {low:.3} … {high:.3}"
        ));
    }
    chart::show(ui, "curves of the card", &material_chart(card), 300.0);
    ui.label(
        RichText::new(format!("{} {}", card.citation, card.doi))
            .small()
            .weak(),
    );
}

fn hint(key: &str) -> &'static str {
    match key {
        "test" => "uniaxial, planar, …",
        "stress measure" => "nominal or cauchy",
        "strain measure" => "stretch, nominal, …",
        "stress unit" => "kPa, MPa, N …",
        "strain unit" => "-, %, mm …",
        "direction" => "1 or 2",
        "strain ratio" => "0.5",
        "area" => "10 mm^2",
        "width" | "thickness" => "2 mm",
        "ramp" => "0.5 s",
        "preconditioned" => "1.5",
        "time unit" => "s, min …",
        "cycle" => "first, last, all",
        "zero" => "automatic, none, 0.4 mm",
        _ => "50 mm",
    }
}

/// Sliders of the parameters: from a tenth to the tenfold of a stress, over the usual values of others.
fn parameters(ui: &mut Ui, file: &CardFile, card: &Card, table: &mut Table) {
    Grid::new("parameters").num_columns(2).show(ui, |ui| {
        for parameter in &card.parameters {
            let label = ui.label(parameter.key);
            let mut value = parameter.value;
            let speed = 0.005 * parameter.value.abs().max(1e-6);
            let unit = parameter.unit().trim_matches('–');
            let drag = DragValue::new(&mut value)
                .speed(speed)
                .max_decimals(8)
                .suffix(format!(" {unit}"));
            let response = ui.add_sized(vec2(130.0, 20.0), drag).labelled_by(label.id);
            if response.changed()
                && let Some(moved) = file.with_parameter(card, parameter.key, value)
            {
                table.take_card(moved, response.dragged());
            }
            ui.end_row();
        }
    });
}

fn ranked(ui: &mut Ui, ranking: &Ranking, chosen: &mut usize) {
    Grid::new("ranking")
        .striped(true)
        .num_columns(5)
        .show(ui, |ui| {
            for head in ["law", "AICc", "RMSE [MPa]", "NMAD [%]", "over the data"] {
                ui.label(RichText::new(head).small());
            }
            ui.end_row();
            for (number, fit) in ranking.fits.iter().enumerate() {
                if ui.selectable_label(*chosen == number, &fit.law).clicked() {
                    *chosen = number;
                }
                ui.monospace(format!("{:.2}", fit.aicc));
                ui.monospace(format!("{:.3e}", fit.rmse));
                ui.monospace(format!("{:.3}", fit.nmad_percent));
                ui.label(if fit.stable { "stable" } else { "unstable" });
                ui.end_row();
            }
        });
    for reason in &ranking.without {
        ui.label(RichText::new(reason).small().weak());
    }
}

fn result(ui: &mut Ui, fit: &Fitted, table: &mut Table) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(&fit.law).strong());
        if ui.button("use it for the sheet").clicked() {
            let card = CardFile {
                name: format!("fitted-{}", fit.law),
                text: fit.card.clone(),
            };
            table.take_card(card, false);
        }
    });
    ui.label(&fit.formula);
    Grid::new("fitted").num_columns(3).show(ui, |ui| {
        for [key, value, uncertainty] in &fit.parameters {
            ui.label(key);
            ui.monospace(value);
            ui.label(uncertainty);
            ui.end_row();
        }
    });
    if !fit.verdict.is_empty() {
        ui.label(format!("residuals: {}", fit.verdict));
    }
    for (name, [low, high]) in &fit.ranges {
        ui.label(format!(
            "stable in {name} tests for λ = {low:.3} … {high:.3}"
        ));
    }
    for warning in &fit.warnings {
        ui.colored_label(ui.visuals().warn_fg_color, warning);
    }
    for (number, drawn) in fit.charts.iter().enumerate() {
        ui.label(RichText::new(&drawn.title).small());
        let height = if number == 0 { 260.0 } else { 150.0 };
        chart::show(ui, &format!("fit {number}"), drawn, height);
    }
}
