//! The motion of a released sheet: when it begins, how it is played, what can be done meanwhile.

use eframe::egui::{self, Slider, Ui};

use super::Workbench;
use crate::logic::playing::Playing;
use crate::logic::scene::Model;
use crate::logic::table::Action;
use crate::views::figures;

/// Damping at first in kPa·s: a front that runs through the plate at the start is some millimetres wide, three cells.
pub const FIRST_DAMPING: f64 = 0.02;

/// Damping that is offered in kPa·s.
const DAMPING: std::ops::RangeInclusive<f64> = 0.0..=1.0;

/// A frame that takes longer counts as so long in s: a motion does not jump.
const LONGEST_FRAME: f64 = 0.1;

impl Workbench {
    /// Takes pieces of the motion, and plays it.
    pub(super) fn play(&mut self, context: &egui::Context) {
        for mover in &mut self.movers {
            for answer in mover.answers() {
                self.table.take_motion(answer);
            }
        }
        if self.lets_go && self.table.is_settled() {
            self.let_go();
        }
        if self.table.moving().is_some_and(|moving| moving.running) {
            let seconds = context.input(|input| f64::from(input.stable_dt));
            self.table.advance(seconds.min(LONGEST_FRAME));
            context.request_repaint();
        }
    }

    /// Opens the grip now.
    pub(super) fn let_go(&mut self) {
        self.lets_go = false;
        let damping = 1e-3 * self.damping;
        self.table.act(Action::LetGo { damping });
    }

    /// The button that releases the sheet, and the damping of its motion.
    pub(super) fn motion_controls(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            let hint = "releases the grip: the sheet moves freely; Escape grips it again";
            match self.table.moving() {
                None => {
                    let response = ui.button("release").on_hover_text(hint);
                    self.positions
                        .insert("release".to_owned(), response.rect.center());
                    if response.clicked() {
                        self.lets_go = true;
                    }
                }
                Some(_) => {
                    if ui.button("grip again").clicked() {
                        self.table.act(Action::Hold);
                    }
                }
            }
            ui.checkbox(&mut self.springs_back, "when the mouse button is released");
        });
        let slider = Slider::new(&mut self.damping, DAMPING)
            .logarithmic(true)
            .smallest_positive(1e-4)
            .custom_formatter(|value, _| format!("{value:.4}"))
            .suffix(" kPa·s")
            .text("damping");
        let response = ui
            .add(slider)
            .on_hover_text("shear viscosity in addition to the card's");
        let released = response.drag_stopped() || (response.changed() && !response.dragged());
        if released && self.table.moving().is_some() {
            self.let_go();
        }
    }

    /// What is played, above the sheets.
    pub(super) fn player(&mut self, ui: &mut Ui) {
        let is_shown = |moving: &&Playing| moving.has_begun() || moving.is_complete();
        let Some(moving) = self.table.moving().filter(is_shown) else {
            return;
        };
        let (mut running, mut slowness) = (moving.running, moving.slowness);
        let (mut time, computed) = (1e3 * moving.clock(), 1e3 * moving.computed());
        let (duration, complete) = (1e3 * moving.duration, moving.is_complete());
        let faults: Vec<_> = Model::ALL
            .into_iter()
            .filter_map(|model| moving.fault(model).cloned())
            .collect();
        let errors = Model::ALL.map(|model| 100.0 * moving.energy_error(model));
        let largest_error = errors.into_iter().fold(0.0, f64::max);
        let mut time_was_set = false;
        ui.horizontal_wrapped(|ui| {
            let word = if running { "pause" } else { "play" };
            if ui.button(word).clicked() {
                running = !running;
            }
            if ui.button("grip again").on_hover_text("Escape").clicked() {
                self.table.act(Action::Hold);
                return;
            }
            let slider = Slider::new(&mut time, 0.0..=duration)
                .custom_formatter(|time, _| format!("{time:.1}"))
                .suffix(" ms");
            time_was_set = ui.add(slider.text("since the release")).changed();
            let slower = Slider::new(&mut slowness, 1.0..=1000.0)
                .logarithmic(true)
                .custom_formatter(|times, _| format!("{times:.0}"))
                .suffix(" ×");
            ui.add(slower.text("slower than real time"));
            if complete {
                ui.label(format!("energy error {largest_error:.2} %"));
            } else {
                ui.spinner();
                ui.label(format!("{:.0} % computed", 100.0 * computed / duration));
            }
        });
        for fault in &faults {
            figures::fault(ui, fault);
        }
        let Some(moving) = self.table.moving() else {
            return;
        };
        let changed = running != moving.running || slowness != moving.slowness || time_was_set;
        if let Some(moving) = self.table.moving_mut().filter(|_| changed) {
            (moving.running, moving.slowness) = (running && !time_was_set, slowness);
            if time_was_set {
                moving.show(1e-3 * time);
            }
        }
    }
}
