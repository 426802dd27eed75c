//! The panel beside the sheet: its shape, its card, its grip, and what is shown of it.

use eframe::egui::{ComboBox, DragValue, Margin, RichText, Slider, SliderClamping, Ui};

use gelbench::material::registry::CARDS;

use super::grip::within;
use crate::logic::scene::{CardFile, Colour, Layout, Model, Outline, Scene};
use crate::logic::table::Table;

/// Cells across a sheet that are offered.
const CELLS: [usize; 2] = [4, 120];

/// The margin of a column to the right of another one.
pub const COLUMN_MARGIN: Margin = Margin {
    left: 12,
    right: 0,
    top: 0,
    bottom: 0,
};

/// Shows all controls; the changed scene, and whether a control is held.
pub fn show(ui: &mut Ui, table: &Table) -> (Scene, bool) {
    let mut scene = table.scene().clone();
    let before = (scene.grip, scene.size[0]);
    let mut held = false;
    let mut hold = |response: eframe::egui::Response| held |= response.dragged();
    ui.heading("Sheet");
    outline(ui, &mut scene, &mut hold);
    ui.add_space(6.0);
    ui.heading("Material");
    card(ui, "card", &mut scene.card, table.cards());
    ui.add_space(6.0);
    ui.heading("Right grip");
    grip(ui, &mut scene, &mut hold);
    if (scene.grip, scene.size[0]) != before {
        scene.grip = within(scene.grip, &scene);
    }
    ui.add_space(6.0);
    ui.heading("Shown");
    look(ui, &mut scene);
    (scene, held)
}

type Hold<'a> = dyn FnMut(eframe::egui::Response) + 'a;

fn length(ui: &mut Ui, name: &str, value: &mut f64, hold: &mut Hold) {
    ui.horizontal(|ui| {
        let label = ui.label(name);
        let drag = DragValue::new(value)
            .speed(0.1)
            .range(0.01..=10_000.0)
            .clamp_existing_to_range(false)
            .suffix(" mm");
        hold(ui.add(drag).labelled_by(label.id));
    });
}

fn outline(ui: &mut Ui, scene: &mut Scene, hold: &mut Hold) {
    ComboBox::from_label("shape")
        .selected_text(scene.outline.name())
        .show_ui(ui, |ui| {
            for (name, outline) in Outline::all(scene.size) {
                let chosen = scene.outline.name() == name;
                if ui.selectable_label(chosen, name).clicked() && !chosen {
                    scene.outline = outline;
                }
            }
        });
    let [along, across] = &mut scene.size;
    length(ui, "length", along, hold);
    length(ui, "width", across, hold);
    length(ui, "thickness", &mut scene.thickness, hold);
    match &mut scene.outline {
        Outline::Plate => (),
        Outline::Hole { diameter } => length(ui, "diameter of the hole", diameter, hold),
        Outline::Notches {
            depth,
            length: long,
        } => {
            length(ui, "depth of a notch", depth, hold);
            length(ui, "length of a notch", long, hold);
        }
        Outline::DogBone {
            narrow_length,
            narrow_width,
            shoulder,
        } => {
            length(ui, "narrow length", narrow_length, hold);
            length(ui, "narrow width", narrow_width, hold);
            length(ui, "length of a shoulder", shoulder, hold);
        }
    }
    let mut cells = scene.cells[1];
    let slider = Slider::new(&mut cells, CELLS[0]..=CELLS[1])
        .step_by(2.0)
        .clamping(SliderClamping::Edits)
        .logarithmic(true);
    let response = ui.add(slider.text("cells across"));
    if response.changed() {
        let along = scene.size[0] / scene.size[1] * cells as f64;
        // Pairs of cells, no longer than the springs allow.
        scene.cells = [
            (along / 2.0).round().max(1.0) as usize * 2,
            cells.next_multiple_of(2),
        ];
    }
    hold(response);
}

/// The cards to choose from: those that come along, and the user's own.
pub fn card(ui: &mut Ui, label: &str, chosen: &mut CardFile, user_cards: &[CardFile]) {
    ComboBox::from_label(label)
        .selected_text(&chosen.name)
        .width(150.0)
        .show_ui(ui, |ui| {
            for (name, _) in CARDS {
                if ui.selectable_label(chosen.name == *name, *name).clicked() {
                    *chosen = CardFile::shipped(name).expect("a shipped card");
                }
            }
            for card in user_cards {
                if ui
                    .selectable_label(chosen.name == card.name, &card.name)
                    .clicked()
                {
                    *chosen = card.clone();
                }
            }
        });
}

fn grip(ui: &mut Ui, scene: &mut Scene, hold: &mut Hold) {
    let length = scene.size[0];
    let mut stretch = 100.0 * scene.stretch();
    let slider = Slider::new(&mut stretch, -20.0..=150.0)
        .suffix(" %")
        .clamping(SliderClamping::Never);
    let response = ui.add(slider.text("stretch"));
    if response.changed() {
        scene.grip.displacement[0] = stretch / 100.0 * length;
    }
    hold(response);
    let across = Slider::new(
        &mut scene.grip.displacement[1],
        -0.4 * length..=0.4 * length,
    );
    let across = across.clamping(SliderClamping::Edits);
    hold(ui.add(across.suffix(" mm").text("across")));
    // Without the sign of a zero.
    let mut degrees = scene.grip.angle.to_degrees() + 0.0;
    let response = ui.add(
        Slider::new(&mut degrees, -60.0..=60.0)
            .clamping(SliderClamping::Edits)
            .suffix(" °")
            .text("rotation"),
    );
    if response.changed() {
        scene.grip.angle = degrees.to_radians();
    }
    hold(response);
    if ui
        .button("straight")
        .on_hover_text("resets transverse motion and rotation")
        .clicked()
    {
        scene.grip.displacement[1] = 0.0;
        scene.grip.angle = 0.0;
    }
}

fn look(ui: &mut Ui, scene: &mut Scene) {
    let look = &mut scene.look;
    for model in Model::ALL {
        ui.checkbox(&mut look.models[model as usize], model.name());
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut look.layout, Layout::Beside, "side by side");
        ui.selectable_value(&mut look.layout, Layout::Over, "superimposed");
    });
    // The name stands above the box, which takes the whole width.
    let label = ui.label("colour");
    let chosen = ComboBox::from_id_salt("colour")
        .selected_text(look.colour.name())
        .width(ui.available_width())
        .truncate()
        .show_ui(ui, |ui| {
            for colour in Colour::ALL {
                ui.selectable_value(&mut look.colour, colour, colour.name());
            }
        });
    chosen.response.labelled_by(label.id);
    ui.checkbox(&mut look.multipliers, "multipliers as arrows")
        .on_hover_text("where the springs violate equilibrium: the derivative of the smallest ½‖u − ū‖² with respect to the nodal forces");
    ui.checkbox(&mut look.cells, "cells");
    if scene.outline == Outline::Plate {
        ui.label("The corrector knows");
        ui.checkbox(&mut look.known.grips, "where the grips are");
        ui.checkbox(&mut look.known.free_edges, "that the long edges are free");
    }
    ui.label(
        RichText::new("Pull the bar at the right end, or its knob to turn it. The wheel zooms, the background is dragged, a double click shows the whole.")
            .small()
            .weak(),
    );
}
