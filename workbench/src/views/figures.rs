//! What is read off the table: forces, deviations, the curve that is pulled.

use eframe::egui::{Grid, RichText, Ui};

use gelbench_report::results::{Finding, Line, LineChart, Stroke, from_rest};

use crate::logic::engine::Fault;
use crate::logic::scene::{Grip, Model};
use crate::logic::table::Table;

/// Force over stretch of all models that are shown: the points that were computed, and nothing between them.
pub fn curve(table: &Table) -> LineChart {
    let shown = |model: &Model| table.scene().look.models[*model as usize];
    let line = |model: Model| {
        let mut points = table.curve(model);
        // What is only stretched has no force at rest.
        let grip = table.scene().grip;
        if grip.displacement[1] == 0.0 && grip.angle == 0.0 && !points.is_empty() {
            points = from_rest(points);
        }
        Line::new(model.name(), points, model.colour(), Stroke::Points)
    };
    let lines = Model::ALL.into_iter().filter(shown).map(line).collect();
    LineChart::new("", "stretch [–]", "force along X [N]", lines)
}

/// The width that the table takes without the moment.
pub const WIDTH: f32 = 520.0;

/// The width below which a table leaves the moment out.
const NARROW: f32 = 560.0;

/// The figures of all models in a table.
pub fn table(ui: &mut Ui, table: &Table) {
    let moment = ui.available_width() > NARROW;
    Grid::new("figures").striped(true).show(ui, |ui| {
        let heads = [
            "",
            "force x, y [N]",
            "moment [N mm]",
            "displacement [%]",
            "departure [%]",
            "force [%]",
        ];
        for (number, head) in heads.into_iter().enumerate() {
            if number != 2 || moment {
                ui.label(RichText::new(head).small());
            }
        }
        ui.end_row();
        for model in Model::ALL {
            row(ui, table, model, moment);
        }
    });
    ui.label(
        RichText::new(
            "Deviations from the finite elements: displacement, its departure from the linear motion between the grips (the \
             strict measure), force.",
        )
        .small()
        .weak(),
    );
}

fn row(ui: &mut Ui, table: &Table, model: Model, moment: bool) {
    ui.label(model.name());
    // A model that is not computed any more, or has no solution, stays where it was: its figures belong to another grip or sheet.
    let scene = table.scene();
    let followed = (scene.look.models[model as usize] || model == Model::Elements)
        && table.fault(model).is_none();
    let is_valid = |grip: Grip| followed || grip == scene.grip;
    let shown = table.shown(model);
    match shown.filter(|shown| shown.grip.is_some_and(is_valid)) {
        Some(shown) => {
            let [x, y] = shown.solved.force;
            ui.monospace(format!("{:9.4} {:9.4}", rounded(x, 4), rounded(y, 4)));
            if moment {
                ui.monospace(format!("{:9.2}", rounded(shown.solved.moment, 2)));
            }
        }
        None => {
            ui.label("…");
            if moment {
                ui.label("");
            }
        }
    }
    match table.deviation(model) {
        Some(deviation) => {
            ui.monospace(format!("{:8.4}", deviation.displacement));
            ui.monospace(format!("{:8.3}", deviation.departure));
            ui.monospace(format!("{:+8.3}", deviation.force));
        }
        None => {
            for _ in 0..3 {
                ui.label("");
            }
        }
    }
    ui.end_row();
}

/// A number with so many decimals, and no minus before zero.
fn rounded(value: f64, decimals: i32) -> f64 {
    let unit = 10_f64.powi(decimals);
    (value * unit).round() / unit + 0.0
}

/// What a warning of the command is called on the sheet.
pub fn headline(warning: &Finding) -> String {
    match warning.rule {
        "beyond-card" => "beyond the card's range".to_owned(),
        "large-strains" => "strains too large for the law".to_owned(),
        "lattice-poisson-ratio" => "springs have another Poisson's ratio".to_owned(),
        "unstable-material" => "the material is not stable".to_owned(),
        "wrinkling" => "may wrinkle or buckle".to_owned(),
        rule => rule.replace('-', " "),
    }
}

/// A fault in the library's words, with its remedy.
pub fn fault(ui: &mut Ui, fault: &Fault) {
    ui.colored_label(ui.visuals().error_fg_color, &fault.message);
    if !fault.advice.is_empty() {
        ui.label(format!("What to try: {}", fault.advice));
    }
}
