//! The introduction: three sentences, and scenes to begin with.

use eframe::egui::{Pos2, RichText, Ui};

use crate::logic::scene::{Colour, Grip, Known, Layout, Look, Model, Scene};

/// What a guided scene lays on the table.
#[derive(Clone, Copy)]
pub enum Shows {
    /// A sheet between two grips.
    Sheet(fn() -> Scene),
    /// The measured field that comes along, corrected.
    MeasuredField,
}

/// A scene with what is to be seen in it.
pub struct Guided {
    /// Its title.
    pub title: &'static str,
    /// What is to be seen, and what to try.
    pub text: &'static str,
    /// What lies on the table.
    pub shows: Shows,
}

/// What the workbench is, in three sentences.
pub const THREE_SENTENCES: &str = "A sheet of gel is held between two grips, and you pull the right one. Three models are \
    solved: springs, the same springs corrected to satisfy equilibrium, and finite elements as the reference. Everything is \
    computed on your own machine, and no data leave it.";

/// The guided scenes.
pub const SCENES: [Guided; 5] = [
    Guided {
        title: "Why springs are wrong",
        text: "The colours show how far the springs are from the finite elements, and the arrows (multipliers) show where \
               they violate equilibrium: at the clamps and across the width, because a spring lattice has a Poisson's ratio \
               of ⅓ and the gel ½. Pull the grip: the departure error hardly decreases. Choose another card: it remains.",
        shows: Shows::Sheet(why_springs_are_wrong),
    },
    Guided {
        title: "Effect of one correction",
        text: "The same nodes, before and after the correction, on one colour scale. The corrected field is the nearest one \
               in equilibrium: its departure is a hundred times closer to the finite elements. Turn the knob of the grip and \
               pull it sideways: springs and corrected springs follow in every frame, the finite elements as soon as they \
               are solved.",
        shows: Shows::Sheet(what_one_correction_does),
    },
    Guided {
        title: "Effect of T",
        text: "T is what is known at the boundary: the position of the grips, and that the long edges are traction-free. \
               Here the corrector does not know about the edges, and its field is hardly closer to the finite elements than \
               the springs. Tick `that the long edges are free` at the bottom of the controls: the known conditions matter, \
               not the springs.",
        shows: Shows::Sheet(what_t_decides),
    },
    Guided {
        title: "Noisy field",
        text: "Camera markers with noise, some of them lost, and the nearest field in equilibrium: it gives forces with \
               intervals, although no force was measured. Click the right edge of the mesh, state that it is free, and \
               correct again: it was in fact gripped, so the data are no longer explained, and the verdict says so.",
        shows: Shows::MeasuredField,
    },
    Guided {
        title: "Few springs, then climb",
        text: "A lattice of 12 × 4 cells. Move the slider `cells across` to the right: more springs do not come closer to \
               the finite elements, because their number is not the cause of the error; the error of the corrected field \
               does decrease, with about the third power of the number. It climbs from a few springs to any number of cells \
               in milliseconds.",
        shows: Shows::Sheet(few_springs_then_climb),
    },
];

/// The springs beside another model, coloured by the distance to the finite elements.
fn springs_and(other: Model) -> Look {
    Look {
        models: Model::ALL.map(|model| model == Model::Springs || model == other),
        layout: Layout::Beside,
        colour: Colour::Distance,
        multipliers: false,
        cells: false,
        known: Known::ALL,
    }
}

/// The usual sheet, stretched.
fn stretched(stretch: f64, look: Look) -> Scene {
    let scene = Scene::default();
    let grip = Grip {
        displacement: [stretch * scene.size[0], 0.0],
        angle: 0.0,
    };
    Scene {
        grip,
        look,
        ..scene
    }
}

fn why_springs_are_wrong() -> Scene {
    let look = Look {
        multipliers: true,
        ..springs_and(Model::Elements)
    };
    stretched(0.5, look)
}

fn what_one_correction_does() -> Scene {
    stretched(0.3, springs_and(Model::Corrected))
}

fn what_t_decides() -> Scene {
    let mut look = springs_and(Model::Corrected);
    look.known.free_edges = false;
    stretched(0.5, look)
}

fn few_springs_then_climb() -> Scene {
    let look = Look {
        cells: true,
        ..springs_and(Model::Corrected)
    };
    Scene {
        cells: [12, 4],
        ..stretched(0.5, look)
    }
}

/// Shows the three sentences and the scenes; the number of the one that was chosen. `note` gets the position of each of them.
pub fn show(
    ui: &mut Ui,
    current: Option<usize>,
    mut note: impl FnMut(&str, Pos2),
) -> Option<usize> {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Scenes:").strong());
        for (number, scene) in SCENES.iter().enumerate() {
            let title = format!("{} {}", number + 1, scene.title);
            let response = ui.selectable_label(current == Some(number), &title);
            note(&title, response.rect.center());
            if response.clicked() {
                chosen = Some(number);
            }
        }
    });
    ui.label(match current {
        None => THREE_SENTENCES,
        Some(number) => SCENES[number].text,
    });
    chosen
}
