//! The first minute: three sentences, and scenes that can be played with.

use eframe::egui::{RichText, Ui};

use crate::logic::scene::{Colour, Grip, Layout, Look, Model, Scene};

/// A scene with what is to be seen in it.
pub struct Guided {
    /// Its title.
    pub title: &'static str,
    /// What is to be seen, and what to try.
    pub text: &'static str,
    /// The scene.
    pub scene: fn() -> Scene,
}

/// What the workbench is, in three sentences.
pub const THREE_SENTENCES: &str = "A sheet of gel is held between two grips, and you pull the right one. It is computed three \
    times: by springs, by the same springs corrected to satisfy equilibrium, and by finite elements, which the other two are \
    compared with. Everything is computed here, on your own machine, and no data leave it.";

/// The guided scenes.
pub const SCENES: [Guided; 3] = [
    Guided {
        title: "Why springs are wrong",
        text: "The colours say how far the springs are from the finite elements, and the arrows (multipliers) where they contradict \
               the physics: at the clamps, and over the width, because a lattice of springs has a Poisson's ratio of ⅓ and the gel \
               one of ½. Pull the grip: the departure hardly gets better. Take another card: it stays.",
        scene: why_springs_are_wrong,
    },
    Guided {
        title: "What one correction does",
        text: "The same nodes, before and after the correction, on one colour scale. The corrected field is the nearest one that is \
               in equilibrium: its departure is a hundred times nearer to the finite elements. Turn the knob of the grip and pull \
               across: springs and corrected springs follow in every frame, the finite elements as soon as they are solved.",
        scene: what_one_correction_does,
    },
    Guided {
        title: "Few springs, then climb",
        text: "A lattice of 12 × 4 cells. Move the slider `cells across` to the right: more springs do not come nearer to the finite \
               elements, because what is wrong is not their number; the corrected field does, with about the third power of it. \
               It climbs from a few springs to any number of cells in milliseconds.",
        scene: few_springs_then_climb,
    },
];

fn shown(models: [Model; 2], colour: Colour) -> Look {
    Look {
        models: Model::ALL.map(|model| models.contains(&model)),
        layout: Layout::Beside,
        colour,
        multipliers: false,
        cells: false,
    }
}

fn stretched(stretch: f64) -> Grip {
    Grip {
        displacement: [stretch * Scene::default().size[0], 0.0],
        angle: 0.0,
    }
}

fn why_springs_are_wrong() -> Scene {
    Scene {
        grip: stretched(0.5),
        look: Look {
            multipliers: true,
            ..shown([Model::Springs, Model::Elements], Colour::Distance)
        },
        ..Scene::default()
    }
}

fn what_one_correction_does() -> Scene {
    Scene {
        grip: stretched(0.3),
        look: shown([Model::Springs, Model::Corrected], Colour::Distance),
        ..Scene::default()
    }
}

fn few_springs_then_climb() -> Scene {
    Scene {
        grip: stretched(0.5),
        cells: [12, 4],
        look: Look {
            cells: true,
            ..shown([Model::Springs, Model::Corrected], Colour::Distance)
        },
        ..Scene::default()
    }
}

/// Shows the three sentences and the scenes; the number of the one that was chosen.
pub fn show(ui: &mut Ui, current: Option<usize>) -> Option<usize> {
    let mut chosen = None;
    ui.label(match current {
        None => THREE_SENTENCES,
        Some(number) => SCENES[number].text,
    });
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Scenes:").strong());
        for (number, scene) in SCENES.iter().enumerate() {
            let title = format!("{} {}", number + 1, scene.title);
            if ui
                .selectable_label(current == Some(number), title)
                .clicked()
            {
                chosen = Some(number);
            }
        }
    });
    chosen
}
