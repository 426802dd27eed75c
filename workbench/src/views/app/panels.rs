//! The panels around the table.

use eframe::egui::{self, CentralPanel, Panel, RichText, ScrollArea, Theme, Ui};

use super::documents::Then;
use super::{Tab, Workbench};
use crate::logic::outputs::Written;
use crate::logic::scene::{Model, Scene};
use crate::logic::table::Action;
use crate::views::guide::{SCENES, Shows};
use crate::views::study::Asks;
use crate::views::{chart, controls, figures, guide};

/// Text sizes that are offered, as factors.
const TEXT_SIZES: [(&str, f32); 4] = [
    ("small", 0.85),
    ("medium", 1.0),
    ("large", 1.25),
    ("very large", 1.6),
];

/// The width below which the panel of the controls is folded at first.
const NARROW: f32 = 640.0;

/// The height below which the sheets have most of it.
const LOW: f32 = 560.0;

/// The width that a chart beside the figures has at least.
const CHART: f32 = 260.0;

impl Workbench {
    pub(super) fn sheet_tab(&mut self, ui: &mut Ui) {
        let wide = ui.available_width() > NARROW;
        if self.shows_controls.unwrap_or(wide) {
            Panel::left("controls").default_size(250.0).show(ui, |ui| {
                ScrollArea::vertical().show(ui, |ui| self.controls(ui));
            });
        }
        let room = ui.available_height();
        let share = if room < LOW { 0.2 } else { 0.38 };
        let height = (share * room).min(260.0);
        Panel::bottom("figures")
            .default_size(height)
            .resizable(true)
            .show(ui, |ui| {
                ScrollArea::both().show(ui, |ui| self.figures(ui));
            });
        CentralPanel::default().show(ui, |ui| self.sheets(ui));
    }

    pub(super) fn bar(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("gelbench").strong());
            for (name, tab) in Tab::ALL {
                let response = ui.selectable_value(&mut self.tab, tab, name);
                self.positions
                    .insert(name.to_owned(), response.rect.center());
            }
            ui.separator();
            if self.tab == Tab::Sheet {
                let open = self.shows_controls.unwrap_or(true);
                if ui.selectable_label(open, "controls").clicked() {
                    self.shows_controls = Some(!open);
                }
            }
            if matches!(self.tab, Tab::Sheet | Tab::Field) {
                if ui.selectable_label(self.shows_guide, "guide").clicked() {
                    self.shows_guide = !self.shows_guide;
                }
                ui.separator();
            }
            let [undo, redo] = self.table.steps().map(|has| has && self.shows_table());
            for (is_possible, name, keys, action) in [
                (undo, "undo", "Ctrl+Z", Action::Undo),
                (redo, "redo", "Ctrl+Y", Action::Redo),
            ] {
                let button = ui.add_enabled(is_possible, egui::Button::new(name));
                if button.on_hover_text(keys).clicked() {
                    self.table.act(action);
                }
            }
            self.file_menu(ui);
            let export = ui.menu_button("export", |ui| self.offered(ui)).response;
            self.positions
                .insert("export".to_owned(), export.rect.center());
            ui.separator();
            appearance(ui);
            if self.is_busy() {
                ui.separator();
                if ui.button("stop").on_hover_text("Escape").clicked() {
                    self.stop();
                }
            }
        });
    }

    /// The recent files are a part of the menu: a menu in a menu closes under slow hands.
    #[cfg(not(target_arch = "wasm32"))]
    fn file_menu(&mut self, ui: &mut Ui) {
        let menu = ui.menu_button("file", |ui| {
            let entry = |name: &str, keys: &str| egui::Button::new(name).shortcut_text(keys);
            if ui.add(entry("open …", "Ctrl+O")).clicked() {
                self.files.open();
            }
            let hint = "the study for `gelbench run`, with its card if it is your own, or the card";
            if ui
                .add(entry("save", "Ctrl+S"))
                .on_hover_text(hint)
                .clicked()
            {
                self.save(self.tab, false);
            }
            if ui.add(entry("save as …", "Ctrl+Shift+S")).clicked() {
                self.save(self.tab, true);
            }
            ui.separator();
            let recent = self
                .recent
                .paths()
                .iter()
                .map(|path| path.display().to_string());
            let recent: Vec<String> = recent.collect();
            let heading = if recent.is_empty() {
                "no recent files"
            } else {
                "recent files"
            };
            ui.label(RichText::new(heading).small().weak());
            let chosen = recent.iter().find(|path| {
                let name = crate::views::files::plain(path);
                ui.button(name).on_hover_text(*path).clicked()
            });
            if let Some(path) = chosen {
                self.open_path(std::path::Path::new(path));
            }
        });
        let at = menu.response.rect.center();
        self.positions.insert("file".to_owned(), at);
    }

    /// What is dropped is opened, and what is saved is downloaded.
    #[cfg(target_arch = "wasm32")]
    fn file_menu(&mut self, ui: &mut Ui) {
        let hint =
            "Ctrl+S: the study for `gelbench run`, with its card if it is your own, or the card";
        if ui.button("save study").on_hover_text(hint).clicked() {
            self.save(self.tab, false);
        }
    }

    pub(super) fn study_tab(&mut self, ui: &mut Ui) {
        let shown = CentralPanel::default().show(ui, |ui| self.studies.show(ui));
        match shown.inner {
            None => (),
            Some(Asks::File(file)) => self.give(Written::file(file)),
            Some(Asks::Example(name, text)) => self.leave(Then::PutStudy(name, text.to_owned())),
        }
    }

    pub(super) fn guide(&mut self, ui: &mut Ui) {
        let positions = &mut self.positions;
        let note = |name: &str, at| {
            positions.insert(name.to_owned(), at);
        };
        let Some(number) = guide::show(ui, self.guided, note) else {
            return;
        };
        self.guided = Some(number);
        self.message.clear();
        match SCENES[number].shows {
            Shows::Sheet(scene) => {
                self.tab = Tab::Sheet;
                self.change(scene(), false);
            }
            Shows::MeasuredField => {
                self.tab = Tab::Field;
                self.change(Scene::default(), false);
                self.fields.take_card(&self.table.scene().card);
                self.fields.open_example();
                self.fields.correct();
            }
        }
    }

    /// Whether the text of the guide belongs to the view that is shown.
    pub(super) fn is_guided(&self) -> bool {
        let shows = self.guided.map(|number| SCENES[number].shows);
        self.shows_guide
            && match self.tab {
                Tab::Sheet => !matches!(shows, Some(Shows::MeasuredField)),
                Tab::Field => matches!(shows, Some(Shows::MeasuredField)),
                Tab::Material | Tab::Study => false,
            }
    }

    /// The message of the program, until it is closed.
    pub(super) fn show_message(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label(&self.message);
            if ui.small_button("close").clicked() {
                self.message.clear();
            }
        });
    }

    fn change(&mut self, scene: Scene, gesture: bool) {
        let scene = Box::new(scene);
        self.table.act(Action::Change { scene, gesture });
    }

    fn controls(&mut self, ui: &mut Ui) {
        let (scene, held) = controls::show(ui, &self.table);
        ui.add_space(6.0);
        ui.heading("Motion");
        self.motion_controls(ui);
        if scene != *self.table.scene() {
            self.change(scene, held);
        } else if !held && !ui.input(|input| input.pointer.any_down()) {
            self.table.let_go();
        }
    }

    fn sheets(&mut self, ui: &mut Ui) {
        if let Err(fault) = self.table.meshes() {
            figures::fault(ui, fault);
            return;
        }
        self.player(ui);
        let Some(held) = self.sheets.show(ui, &self.table) else {
            ui.label("No model is shown: choose one under `Shown`.");
            return;
        };
        self.grip_at = Some(held.at);
        if let Some(grip) = held.to {
            let scene = Scene {
                grip,
                ..self.table.scene().clone()
            };
            self.change(scene, held.holding);
        }
        if held.released {
            self.table.act(Action::EndGesture);
            self.lets_go = self.springs_back;
        }
    }

    fn figures(&mut self, ui: &mut Ui) {
        if let Some(message) = self.table.message() {
            figures::fault(ui, message);
        }
        for warning in self.table.warnings() {
            ui.colored_label(ui.visuals().warn_fg_color, warning.to_string());
        }
        for model in Model::ALL {
            if let Some(fault) = self.table.fault(model) {
                ui.label(RichText::new(model.name()).strong());
                figures::fault(ui, fault);
            }
        }
        let height = ui.available_height().clamp(130.0, 230.0);
        let curve = figures::curve(&self.table);
        let room = ui.available_width() - figures::WIDTH;
        if room < CHART {
            figures::table(ui, &self.table);
            chart::show(ui, "force over stretch", &curve, height);
            return;
        }
        ui.horizontal_top(|ui| {
            let width = room.min(520.0);
            ui.allocate_ui(egui::vec2(width, height), |ui| {
                chart::show(ui, "force over stretch", &curve, height);
            });
            ui.vertical(|ui| figures::table(ui, &self.table));
        });
    }
}

/// The choice of the background and of the size of texts.
fn appearance(ui: &mut Ui) {
    let (other, theme) = if ui.visuals().dark_mode {
        ("light", Theme::Light)
    } else {
        ("dark", Theme::Dark)
    };
    let button = ui
        .button(other)
        .on_hover_text(format!("{other} background"));
    if button.clicked() {
        ui.ctx().set_theme(theme);
    }
    let zoom = ui.ctx().zoom_factor();
    let known = TEXT_SIZES.iter().find(|(_, factor)| *factor == zoom);
    egui::ComboBox::from_label("text")
        .selected_text(known.map_or("other", |(name, _)| name))
        .width(70.0)
        .show_ui(ui, |ui| {
            for (name, factor) in TEXT_SIZES {
                if ui.selectable_label(zoom == factor, name).clicked() {
                    ui.ctx().set_zoom_factor(factor);
                }
            }
        });
}
