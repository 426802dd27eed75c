//! The program: panels around the table, keys, files, and the models that are solved in the background.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{self, CentralPanel, Key, KeyboardShortcut, Modifiers, Panel, Ui};
use web_time::Instant;

use super::field::Fields;
use super::files::Files;
#[cfg(not(target_arch = "wasm32"))]
use super::files::Recent;
use super::fonts;
use super::material::Materials;
use super::sheet::Sheets;
use super::study::Studies;
use crate::logic::background::{Background, Wake};
use crate::logic::engine::Engine;
use crate::logic::engine::motion::Mover;
use crate::logic::outputs::{Writer, Written};
use crate::logic::scene::Scene;
use crate::logic::table::{Action, Table};
use crate::measure::Measure;

mod documents;
mod inbox;
mod motion;
mod outputs;
mod panels;

use documents::{Document, Leaving};
use inbox::Inbox;

const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Y);
const LET_GO: Key = Key::L;
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
const SAVE_AS: KeyboardShortcut =
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
#[cfg(not(target_arch = "wasm32"))]
const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);

/// Fits, corrects or runs what is shown.
const RUN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Enter);

/// The views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// Sheets that are pulled.
    Sheet,
    /// Cards, their parameters, and fits.
    Material,
    /// Measured fields.
    Field,
    /// Studies of any kind.
    Study,
}

impl Tab {
    const ALL: [(&'static str, Self); 4] = [
        ("sheet", Self::Sheet),
        ("material", Self::Material),
        ("measured field", Self::Field),
        ("study", Self::Study),
    ];
}

/// The workbench.
pub struct Workbench {
    /// What lies on the table.
    pub table: Table,
    engines: [Background<Engine>; 3],
    movers: [Background<Mover>; 3],
    exports: Background<Writer>,
    files: Files,
    #[cfg(not(target_arch = "wasm32"))]
    recent: Recent,
    documents: [Document; 4],
    leaving: Option<Leaving>,
    /// Whether the window closes now.
    closes: bool,
    damping: f64,
    /// Whether the sheet is released when the mouse releases the grip, and whether it is to be now.
    springs_back: bool,
    lets_go: bool,
    sheets: Sheets,
    /// The view that is shown.
    pub tab: Tab,
    /// Materials and fits.
    pub materials: Materials,
    /// Measured fields.
    pub fields: Fields,
    /// Studies of any kind.
    pub studies: Studies,
    inbox: Inbox,
    guided: Option<usize>,
    shows_guide: bool,
    shows_controls: Option<bool>,
    /// The last message, such as that a file was written.
    pub message: String,
    /// Where the grip is on the screen, in points.
    pub grip_at: Option<egui::Pos2>,
    /// Where the buttons stood in the last frame that a program may press: by their words, in points.
    pub positions: BTreeMap<String, egui::Pos2>,
    measure: Option<Measure>,
}

impl Workbench {
    /// With a scene on the table; `context` is asked for a frame when something was solved.
    pub fn new(context: &egui::Context, scene: Scene) -> Self {
        fonts::install(context);
        // A press stays a click where frames are slow; there is no menu that a long touch would open.
        context.options_mut(|options| options.input_options.max_click_duration = 10.0);
        let context = context.clone();
        let wake: Wake = Arc::new(move || context.request_repaint());
        let background = || Background::new(Arc::clone(&wake));
        let mover = || Background::new(Arc::clone(&wake));
        let mut bench = Self {
            engines: [background(), background(), background()],
            movers: [mover(), mover(), mover()],
            exports: Background::new(Arc::clone(&wake)),
            files: Files::new(Arc::clone(&wake)),
            #[cfg(not(target_arch = "wasm32"))]
            recent: Recent::default(),
            documents: Default::default(),
            leaving: None,
            closes: false,
            damping: motion::FIRST_DAMPING,
            springs_back: false,
            lets_go: false,
            sheets: Sheets::default(),
            tab: Tab::Sheet,
            materials: Materials::new(Arc::clone(&wake)),
            fields: Fields::new(Arc::clone(&wake), scene.card.clone()),
            table: Table::new(scene),
            studies: Studies::new(Arc::clone(&wake)),
            inbox: Inbox::default(),
            guided: None,
            shows_guide: true,
            shows_controls: None,
            message: String::new(),
            grip_at: None,
            positions: BTreeMap::new(),
            measure: None,
        };
        bench.forget_changes();
        bench
    }

    /// This workbench, which moves the grip without a user and times its frames.
    #[must_use]
    pub fn measuring(self, measure: Measure) -> Self {
        Self {
            measure: Some(measure),
            ..self
        }
    }

    /// What the frames took, where they are measured and all were drawn.
    pub fn measured(&self) -> Option<String> {
        self.measure.as_ref()?.report()
    }

    /// Draws a frame.
    pub fn show(&mut self, ui: &mut Ui) {
        self.positions.clear();
        self.receive(ui.ctx());
        if !self.ask(ui.ctx()) {
            self.keys(ui);
        }
        Panel::top("bar").show(ui, |ui| self.bar(ui));
        if !self.message.is_empty() {
            Panel::bottom("told").show(ui, |ui| self.show_message(ui));
        }
        if self.is_guided() {
            Panel::top("guide").show(ui, |ui| self.guide(ui));
        }
        match self.tab {
            Tab::Sheet => self.sheet_tab(ui),
            Tab::Material => {
                let central = CentralPanel::default();
                let shown = central.show(ui, |ui| self.materials.show(ui, &mut self.table));
                if shown.inner {
                    self.save(Tab::Material, true);
                }
                if !ui.input(|input| input.pointer.any_down()) {
                    self.table.let_go();
                }
            }
            Tab::Field => {
                self.fields.take_card(&self.table.scene().card);
                let central = CentralPanel::default();
                let shown = central.show(ui, |ui| self.fields.show(ui, &mut self.table));
                if let Some(file) = shown.inner {
                    self.give(Written::file(file));
                }
            }
            Tab::Study => self.study_tab(ui),
        }
        self.send();
    }

    /// Takes what was dropped and what was solved.
    fn receive(&mut self, context: &egui::Context) {
        for file in context.input(|input| input.raw.dropped_files.clone()) {
            inbox::read(&file, &self.inbox, context);
        }
        let arrived = self
            .inbox
            .lock()
            .map(|mut files| std::mem::take(&mut *files));
        for arrived in arrived.unwrap_or_default() {
            match arrived {
                Ok((name, content)) => self.open(&name, &content),
                Err(fault) => self.message = fault,
            }
        }
        for engine in &mut self.engines {
            for answer in engine.answers() {
                self.table.take(answer);
            }
        }
        match self.exports.answers().pop() {
            None => (),
            Some(Ok(written)) => {
                self.message.clear();
                self.give(written);
            }
            Some(Err(fault)) => self.message = format!("{}; {}", fault.message, fault.advice),
        }
        self.receive_files(context);
        self.play(context);
        self.materials.receive();
        self.fields.receive();
        self.studies.receive();
        if let Some(measure) = &mut self.measure {
            measure.frame(&mut self.table);
            context.request_repaint();
        }
    }

    fn send(&mut self) {
        for task in self.table.tasks() {
            self.engines[task.model as usize].ask(task);
        }
        for question in self.table.motion_questions() {
            self.movers[question.model as usize].ask(question);
        }
    }

    fn keys(&mut self, ui: &Ui) {
        let pressed =
            |shortcut: &KeyboardShortcut| ui.input_mut(|input| input.consume_shortcut(shortcut));
        let writes = ui.ctx().text_edit_focused();
        // An editor has its own undo.
        if self.shows_table() && !writes {
            let redo = KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
            if pressed(&redo) || pressed(&REDO) {
                self.table.act(Action::Redo);
            }
            if pressed(&UNDO) {
                self.table.act(Action::Undo);
            }
        }
        #[cfg(not(target_arch = "wasm32"))]
        if pressed(&OPEN) {
            self.files.open();
        }
        if pressed(&SAVE_AS) {
            self.save(self.tab, true);
        }
        if pressed(&SAVE) {
            self.save(self.tab, false);
        }
        if pressed(&RUN) {
            match self.tab {
                Tab::Sheet => (),
                Tab::Material => self.materials.fit(),
                Tab::Field => self.fields.correct(),
                Tab::Study => self.studies.run(),
            }
        }
        if !writes && self.tab == Tab::Sheet && ui.input(|input| input.key_pressed(LET_GO)) {
            self.lets_go = true;
        }
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.stop();
        }
    }

    /// Whether the view shows the table, whose actions can then be undone in it.
    fn shows_table(&self) -> bool {
        matches!(self.tab, Tab::Sheet | Tab::Material)
    }

    /// Stops all computations; the next change starts a new one.
    fn stop(&mut self) {
        let busy = self.is_busy();
        self.engines.iter_mut().for_each(Background::stop);
        self.movers.iter_mut().for_each(Background::stop);
        self.lets_go = false;
        let moved = self.table.moving().is_some();
        if moved {
            self.table.act(Action::Hold);
        }
        self.exports.stop();
        self.materials.fitter.stop();
        self.fields.corrector.stop();
        self.studies.runner.stop();
        self.table.forget_tasks();
        if busy && !moved {
            self.message = "stopped; the next change starts a new computation".to_owned();
        }
    }

    fn is_busy(&self) -> bool {
        let sheets = self.engines.iter().any(Background::is_busy);
        let moving = self.movers.iter().any(Background::is_busy);
        sheets
            || moving
            || self.exports.is_busy()
            || self.materials.fitter.is_busy()
            || self.fields.corrector.is_busy()
            || self.studies.runner.is_busy()
    }
}

impl eframe::App for Workbench {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let begun = Instant::now();
        self.show(ui);
        if let Some(measure) = &mut self.measure {
            measure.worked(begun.elapsed());
        }
        #[cfg(target_arch = "wasm32")]
        crate::page::publish(self, ui.ctx());
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(report) = self.measured() {
            println!("{report}");
            self.forget_changes();
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            self.measure = None;
        }
    }
}
