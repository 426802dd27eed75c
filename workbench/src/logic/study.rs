//! The scene as a study that `gelbench run` takes, and a study as a scene.
//!
//! A plate that is only stretched is a study of plates; whatever else two grips do is a study of specimens. How the
//! scene is shown stands in a comment, which gelbench does not read, and so does a card of the user's own: the study alone, or a
//! link with it, restores the scene.

use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use gelbench::budget::Budget;
use gelbench::error::Error;
use gelbench::kinds::kind_of;
use gelbench::material::Card;
use gelbench::mesh::Shape;
use gelbench::problem::Support;
use gelbench::studies::plate;
use gelbench::units::Linear;
use gelbench_base::document::quoted;
use gelbench_base::units::could_be_stretch_ratios;
use gelbench_studies::studies::specimen::{self, Along, Specimen};

use super::scene::{CardFile, Grip, Outline, Scene};

/// What a comment with the look begins with.
const LOOK: &str = "# shown: ";

/// What a comment with a card begins with.
const CARD: &str = "# card: ";

impl Scene {
    /// The study, with the name of its card.
    pub fn study(&self) -> String {
        self.study_of(&self.card.reference(), self.grip)
    }

    /// The study of another card or grip.
    pub(super) fn study_of(&self, card: &str, grip: Grip) -> String {
        let look = serde_json::to_string(&self.look).expect("a look is plain data");
        let only_stretched = grip.displacement[1] == 0.0 && grip.angle == 0.0;
        let body = match self.outline {
            Outline::Plate if only_stretched && grip.displacement[0] != 0.0 => {
                self.plate(card, grip.displacement[0] / self.size[0])
            }
            _ => self.specimen(card, grip),
        };
        let card = if self.card.is_shipped() {
            String::new()
        } else {
            let card = serde_json::to_string(&self.card).expect("a card is plain data");
            format!("{CARD}{card}\n")
        };
        format!("# A study of the workbench.\n{LOOK}{look}\n{card}{body}")
    }

    fn plate(&self, card: &str, stretch: f64) -> String {
        let ([length, width], [nx, ny]) = (self.size, self.cells);
        format!(
            "kind = \"plate\"\ntitle = \"Clamped plate\"\n\n\
             [plate]\nlength = \"{length} mm\"\nwidth = \"{width} mm\"\nthickness = \"{} mm\"\ncells = [{nx}, {ny}]\n\n\
             [material]\ncard = {}\n\n[load]\nstretches = [{}]\n",
            self.thickness,
            quoted(card),
            stretch_text(stretch)
        )
    }

    fn specimen(&self, card: &str, grip: Grip) -> String {
        let [length, width] = self.size;
        let (shape, measures) = match self.outline {
            Outline::Plate => ("strip", String::new()),
            Outline::Hole { diameter } => (
                "strip-with-hole",
                format!("hole_diameter = \"{diameter} mm\"\n"),
            ),
            Outline::Notches { depth, length } => (
                "notched-strip",
                format!("notch_depth = \"{depth} mm\"\nnotch_length = \"{length} mm\"\n"),
            ),
            Outline::DogBone {
                narrow_length,
                narrow_width,
                shoulder,
            } => (
                "dog-bone",
                format!(
                    "narrow_length = \"{narrow_length} mm\"\nnarrow_width = \"{narrow_width} mm\"\nshoulder_length = \"{shoulder} mm\"\n"
                ),
            ),
        };
        let [x, y] = grip.lines(0.0).map(|line| written(&line));
        format!(
            "kind = \"specimen\"\ntitle = \"Sheet between two grips\"\n\n[material]\ncard = {}\n\n\
             [specimen]\nshape = \"{shape}\"\nlength = \"{length} mm\"\nwidth = \"{width} mm\"\n{measures}\
             thickness = \"{} mm\"\ncells = {}\n\n\
             [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\n\
             [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"{x}\"\ny = \"{y}\"\n\n\
             [path]\nfactors = [0.25, 0.5, 0.75, 1.0]\nmeasured_group = \"right\"\n",
            quoted(card),
            self.thickness,
            self.cells[1]
        )
    }

    /// The scene of a study; cards that it names by a path are looked for in `folder`, then among `cards`.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of the study, or where it is not one of a sheet between two grips.
    pub fn open(file: &Path, text: &str, cards: &[CardFile]) -> Result<Self, Error> {
        let enclosed = text.lines().find_map(|line| line.strip_prefix(CARD));
        let enclosed = enclosed.and_then(|card| serde_json::from_str(card).ok());
        // A card that is known is newer than the one that the study was saved with.
        let cards: Vec<CardFile> = cards.iter().cloned().chain(enclosed).collect();
        let known = with_known_card(text, &cards);
        let study = known.as_ref().map_or(text, |(study, _)| study);
        let shown = text.lines().find_map(|line| line.strip_prefix(LOOK));
        let look = shown.and_then(|look| serde_json::from_str(look).ok());
        let scene = match kind_of(&file.display().to_string(), study)? {
            None => of_specimen(plate::load(file, study, Budget::USUAL)?.content)?,
            Some(kind) if kind.name == specimen::KIND => {
                of_specimen(specimen::load(kind, file, study, Budget::USUAL)?.content)?
            }
            Some(kind) => {
                return Err(Error::input(
                    format!(
                        "a study of the kind `{}` is not a sheet between two grips",
                        kind.name
                    ),
                    "run it in the view Study, or with `gelbench run`",
                ));
            }
        };
        Ok(Self {
            card: known.map_or(scene.card, |(_, card)| card),
            look: look.unwrap_or(scene.look),
            ..scene
        })
    }
}

/// `12 mm + 0.1 * Y`, as studies take it.
fn written(line: &Linear) -> String {
    let slope = line.slope[1];
    match slope {
        0.0 => format!("{} mm", line.at_origin),
        _ => {
            let sign = if slope < 0.0 { '-' } else { '+' };
            format!("{} mm {sign} {} * Y", line.at_origin, slope.abs())
        }
    }
}

/// What a study says of its card.
#[derive(Deserialize)]
struct Named {
    material: NamedCard,
}

#[derive(Deserialize)]
struct NamedCard {
    card: Spanned<String>,
}

/// The study with a shipped card in place of one that it names by its file, line by line as it was, and that one.
fn with_known_card(text: &str, cards: &[CardFile]) -> Option<(String, CardFile)> {
    let card = toml::from_str::<Named>(text).ok()?.material.card;
    let is_named = |file: &&CardFile| !file.is_shipped() && file.reference() == *card.get_ref();
    let known = cards.iter().find(is_named)?;
    let mut study = text.to_owned();
    study.replace_range(card.span(), "\"neo-hooke\"");
    Some((study, known.clone()))
}

fn card_file(card: Card) -> CardFile {
    CardFile {
        name: card.name.trim_end_matches(".toml").to_owned(),
        text: card.text,
    }
}

fn of_specimen(read: Specimen) -> Result<Scene, Error> {
    let other = |what: &str| Error::input(what, "run it in the view Study, or with `gelbench run`");
    let (shape, across, cells) = match &read.outline {
        specimen::Outline::Shape { shape, cells, .. } => (*shape, *cells, None),
        specimen::Outline::Grid(grids) => {
            let strip = Shape::Strip { size: grids.size };
            (strip, grids.cells[1], Some(grids.cells))
        }
        specimen::Outline::File { .. } => {
            return Err(other("the specimen is a mesh from a file"));
        }
    };
    let between_grips = outline_of(shape);
    let (outline, size) =
        between_grips.ok_or_else(|| other("the specimen is not held by two grips"))?;
    let unloaded = grip_of(&read.problem.supports).filter(|_| read.problem.loads.is_empty());
    let grip = unloaded.ok_or_else(|| {
        other("the specimen must have a clamp `left` and a rigid grip `right`, and no other supports or loads")
    })?;
    let along = (size[0] / size[1] * across as f64).round() as usize;
    let last = match read.along {
        Along::Stretch => read.factors.last().copied().unwrap_or(0.0),
        Along::LoadFactor => 1.0,
    };
    let grip = Grip {
        displacement: grip.displacement.map(|u| last * u),
        ..grip
    };
    Ok(Scene {
        outline,
        size,
        thickness: read.problem.thickness,
        cells: cells.unwrap_or([along.next_multiple_of(2).max(2), across]),
        card: card_file(read.card),
        grip,
        look: Scene::default().look,
    })
}

/// The outline of a shape between two grips, with its length and width.
fn outline_of(shape: Shape) -> Option<(Outline, [f64; 2])> {
    Some(match shape {
        Shape::Strip { size } => (Outline::Plate, size),
        Shape::StripWithHole { size, radius } => {
            let diameter = 2.0 * radius;
            (Outline::Hole { diameter }, size)
        }
        Shape::NotchedStrip {
            size,
            depth,
            half_length,
        } => {
            let length = 2.0 * half_length;
            (Outline::Notches { depth, length }, size)
        }
        Shape::DogBone {
            size,
            narrow: [narrow_length, narrow_width],
            shoulder,
        } => (
            Outline::DogBone {
                narrow_length,
                narrow_width,
                shoulder,
            },
            size,
        ),
        Shape::RingSector { .. } | Shape::SquareOnRakes(_) | Shape::Cruciform { .. } => {
            return None;
        }
    })
}

/// The motion of the right grip, where the left one is a clamp and there are no others.
fn grip_of(supports: &[(String, Support)]) -> Option<Grip> {
    let support = |name: &str| Some(supports.iter().find(|(group, _)| group == name)?.1);
    let lines = match support("right")? {
        Support::Displacement([Some(x), Some(y)]) => [x, y].map(Linear::constant),
        Support::LinearDisplacement([Some(x), Some(y)]) => [x, y],
        _ => return None,
    };
    let clamp = support("left")? == Support::Displacement([Some(0.0); 2]);
    (clamp && supports.len() == 2).then(|| Grip::of_lines(lines))?
}

/// A stretch λ − 1 as a study has it: in percent where a number could be taken for λ.
fn stretch_text(stretch: f64) -> String {
    if could_be_stretch_ratios(&[stretch]) {
        format!("\"{} %\"", 100.0 * stretch)
    } else {
        stretch.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenes() -> Vec<Scene> {
        let grips = [
            ([30.0, 0.0], 0.0),
            ([12.5, 4.0], 0.0),
            ([20.0, -3.0], 0.3),
            ([0.0, 0.0], -1e-7),
        ];
        let plain = Scene::default();
        let outlines = Outline::all(plain.size).map(|(_, outline)| outline);
        let pairs = outlines
            .iter()
            .flat_map(|outline| grips.map(|grip| (*outline, grip)));
        let scene = |(outline, (displacement, angle))| Scene {
            outline,
            grip: Grip {
                displacement,
                angle,
            },
            ..plain.clone()
        };
        pairs.map(scene).collect()
    }

    #[test]
    fn a_saved_scene_opens_as_it_was() {
        for scene in scenes() {
            let text = scene.study();
            let opened = Scene::open(Path::new("saved.toml"), &text, &[]).unwrap();
            let turned = (opened.grip.angle - scene.grip.angle).abs();
            assert!(turned < 1e-9, "{text}");
            assert_eq!(
                Scene {
                    grip: scene.grip,
                    ..opened.clone()
                },
                scene,
                "{text}"
            );
            assert_eq!(opened.grip.displacement, scene.grip.displacement, "{text}");
        }
    }

    #[test]
    fn a_study_with_a_card_of_its_own_opens_where_the_card_is_known() {
        let mut scene = Scene::default();
        scene.card.name = "my gel".into();
        scene.card.text.push_str("\n# changed\n");
        let text = scene.study();
        assert!(text.contains("card = \"my gel.toml\""), "{text}");
        let open = |text: &str, cards: &[CardFile]| Scene::open("saved.toml".as_ref(), text, cards);
        assert_eq!(open(&text, &[]).unwrap(), scene, "the card is enclosed");
        let mut newer = scene.card.clone();
        newer.text.push_str("# once more\n");
        let opened = open(&text, std::slice::from_ref(&newer)).unwrap();
        assert_eq!(opened.card, newer);
        let others = text.lines().filter(|line| !line.starts_with(CARD));
        let bare = others.collect::<Vec<_>>().join("\n");
        assert_eq!(open(&bare, &[scene.card.clone()]).unwrap(), scene);
        let wrong = text.replace("width = ", "wide = ");
        let line = 1 + wrong
            .lines()
            .position(|line| line.starts_with("wide"))
            .unwrap();
        let fault = open(&wrong, &[]).unwrap_err().to_string();
        assert!(fault.contains(&format!("saved.toml:{line}")), "{fault}");
        let fault = open(&bare, &[]).unwrap_err();
        assert!(fault.to_string().contains("my gel.toml"), "{fault}");
    }

    #[test]
    fn faults_and_other_kinds_are_told_with_a_remedy() {
        let open = |text: &str| {
            Scene::open(Path::new("x.toml"), text, &[])
                .unwrap_err()
                .to_string()
        };
        assert!(open("kind = \"plate\"\n[plate]\nlenght = \"3 cm\"").contains("lenght"));
        let example = include_str!("../../../examples/released_plate.toml");
        assert!(open(example).contains("not a sheet between two grips"));
    }
}
