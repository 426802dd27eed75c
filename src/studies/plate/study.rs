//! The study file: read, checked, and turned into a problem and the settings of the models.
//!
//! Every default stands in `study/default.toml`, which is also what `gelbench new` writes.

use std::path::{Path, PathBuf};

use crate::corrector::climb::ClimbSettings;
use crate::corrector::{CorrectorSettings, DifferenceScheme};
use crate::document::{Bound, Document, Faults, Section};
use crate::error::{Diagnostic, Error};
use crate::finite_element::Element;
use crate::mass_spring::LatticeSettings;
use crate::material::Card;
use crate::problem::ClampedPlate;
use crate::solve::NewtonSettings;
use crate::units::Dimension;

mod plate;

use plate::{MOST_CELLS, check_cells, read_stretches, reference_cells};
pub use plate::{check_range, read_card, read_plate, read_stretch};

/// The study that `gelbench new` writes: every key with its default.
pub const DEFAULT: &str = include_str!("study/default.toml");

/// A study, checked.
#[derive(Debug)]
pub struct Study {
    /// The file's name without its ending.
    pub name: String,
    /// The heading of the report.
    pub title: String,
    /// What is solved.
    pub problem: ClampedPlate,
    /// Where its material comes from.
    pub card: Card,
    /// Cells of the lattice.
    pub cells: [usize; 2],
    /// What the lattice consists of.
    pub lattice: LatticeSettings,
    /// How the lattice is solved.
    pub mass_spring: NewtonSettings,
    /// The corrector's finite differences.
    pub scheme: DifferenceScheme,
    /// How exactly the corrector climbs; nothing where it is direct.
    pub climb: Option<ClimbSettings>,
    /// When the direct corrector stops.
    pub corrector: CorrectorSettings,
    /// The element of the reference.
    pub element: Element,
    /// Cells of the reference's finest mesh.
    pub reference_cells: [usize; 2],
    /// How much smaller the reference's cells become towards the corners; see [`crate::mesh::Grid`].
    pub grading: f64,
    /// How the reference is solved.
    pub finite_element: NewtonSettings,
    /// What the corrected field has to reach.
    pub tolerances: Tolerances,
    /// What is written, and where.
    pub output: OutputSettings,
    /// The file's text.
    pub text: String,
    /// What deserves attention but does not stop the work.
    pub warnings: Vec<Diagnostic>,
}

/// What the corrected field has to reach at every stretch, in percent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest deviation in displacement.
    pub displacement_percent: f64,
    /// Largest deviation in the departure from affine.
    pub departure_percent: f64,
    /// Largest deviation in force.
    pub force_percent: f64,
    /// Smallest correction of the departure from affine.
    pub correction_percent: f64,
}

/// What is written, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputSettings {
    /// The folder that receives everything.
    pub folder: PathBuf,
    /// Whether `.vtu` and `.pvd` files are written.
    pub vtk: bool,
    /// Whether pictures are written.
    pub plots: bool,
    /// Whether reports are written.
    pub report: bool,
}

/// The text of a study file.
///
/// # Errors
/// [`Error::Input`] when the file cannot be read.
pub fn read(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|cause| {
        let fault = Diagnostic::error("", format!("cannot read {}: {cause}", path.display()));
        Error::Input(vec![
            fault.hint("`gelbench new NAME` writes a study to start from"),
        ])
    })
}

impl Study {
    /// Checks the text of the study file `path`.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of the study and of its card.
    pub fn of_file(path: &Path, text: String) -> Result<Self, Error> {
        let name = path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into());
        let folder = path.parent().unwrap_or(Path::new("."));
        Self::parse(&name, &path.display().to_string(), folder, text)
    }

    /// Reads a study's text; a card given by a path is looked for relative to `folder`.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of the study and of its card.
    pub fn parse(name: &str, file: &str, folder: &Path, text: String) -> Result<Self, Error> {
        let faults = Faults::default();
        let study = {
            let defaults = Document::parse("default.toml", DEFAULT, &faults);
            let document = Document::parse(file, &text, &faults);
            let root = document.root(Some(&defaults), &faults);
            read_sections(name, folder, root)
        };
        let warnings = faults.finish()?;
        let study = study.expect("a study without a card has a fault");
        Ok(Self {
            text,
            warnings,
            ..study
        })
    }

    /// Whether the reference is the corrected field once more: the same equations on the same nodes.
    pub fn is_its_own_reference(&self) -> bool {
        let element = match self.scheme {
            DifferenceScheme::Corners => return false,
            DifferenceScheme::Gauss => Element::Q1,
            DifferenceScheme::Biquadratic => Element::Q2,
        };
        let cells = self.reference_cells.map(|cells| cells * self.scheme.side());
        self.element == element && self.grading == 1.0 && cells == self.cells
    }

    /// Cells of the three meshes of the reference, coarse to fine.
    pub fn reference_meshes(&self) -> [[usize; 2]; 3] {
        [4, 2, 1].map(|coarser| self.reference_cells.map(|cells| cells / coarser))
    }
}

/// Reads all sections; nothing when there is no card to work with, which is recorded as a fault.
fn read_sections(name: &str, folder: &Path, root: Section<'_>) -> Option<Study> {
    root.choice("kind", &[("plate", ())]);
    let title = root.heading("title");
    let material = root.section("material");
    let card = read_card(&material, folder);
    material.unknown_keys();
    let plate = root.section("plate");
    let (problem, cells) = read_plate(&plate, card.as_ref());
    plate.unknown_keys();
    let stretches = read_stretches(&root.section("load"), card.as_ref());

    let section = root.section("mass_spring");
    let lattice = LatticeSettings {
        area_term: section.flag("area_term"),
    };
    let mass_spring = read_newton(&section);
    section.unknown_keys();

    let section = root.section("corrector");
    let scheme = section.choice("scheme", &DifferenceScheme::NAMES);
    if let Some(scheme) = scheme {
        check_pairs(&section, scheme, cells);
    }
    let climb = section.choice("method", &[("climb", true), ("direct", false)]);
    let settings = ClimbSettings {
        tolerance: section.quantity(
            "climb_tolerance",
            Dimension::Ratio,
            Bound::Within(1e-6, 1.0),
        ),
        ..ClimbSettings::default()
    };
    let corrector = CorrectorSettings {
        tolerance: section.number("tolerance", Bound::Within(1e-13, 1e-2)),
        max_steps: section.count("max_steps", 1, 1000),
        ..CorrectorSettings::default()
    };
    section.unknown_keys();

    let section = root.section("finite_element");
    let element = section.choice("element", &Element::NAMES);
    let reference_cells = read_reference_cells(&section, problem.size, cells);
    let grading = section.number("grading", Bound::Within(1.0, 4.0));
    let finite_element = read_newton(&section);
    section.unknown_keys();

    let tolerances = read_tolerances(&root.section("tolerances"));
    let output = read_output(&root.section("output"), name);
    root.unknown_keys();
    let study = Study {
        name: name.to_owned(),
        title,
        problem: ClampedPlate {
            stretches,
            ..problem
        },
        card: card?,
        cells,
        lattice,
        mass_spring,
        scheme: scheme?,
        climb: climb?.then_some(settings),
        corrector,
        element: element?,
        reference_cells,
        grading,
        finite_element,
        tolerances,
        output,
        text: String::new(),
        warnings: Vec::new(),
    };
    if study.is_its_own_reference() {
        root.section("finite_element").warning(
            "cells",
            "with these the finite elements are the corrected field's own equations on the same nodes and cannot judge it",
            "leave `cells` and `grading` out, which suits the lattice, or take finer ones",
        );
    }
    Some(study)
}

fn read_newton(section: &Section<'_>) -> NewtonSettings {
    NewtonSettings {
        tolerance: section.number("tolerance", Bound::Within(1e-13, 1e-2)),
        max_iterations: section.count("max_iterations", 1, 1000),
    }
}

/// The cells that a study gives, or those that suit its lattice.
fn read_reference_cells(section: &Section<'_>, size: [f64; 2], lattice: [usize; 2]) -> [usize; 2] {
    const KEY: &str = "cells";
    let given = section.count_pair_or("automatic", KEY, [4, MOST_CELLS]);
    let Some(cells) = given.flatten() else {
        return reference_cells(size, lattice);
    };
    if cells.iter().any(|cells| cells % 4 != 0) {
        let [x, y] = cells.map(|cells| cells.next_multiple_of(4));
        section.fault(
            KEY,
            "must be multiples of 4: the error is estimated on meshes with half and a quarter as many",
            &format!("the next are [{x}, {y}]"),
        );
    }
    check_cells(section, cells);
    cells
}

/// A scheme that takes cells two by two needs even numbers of them.
fn check_pairs(section: &Section, scheme: DifferenceScheme, cells: [usize; 2]) {
    if let Some(odd) = cells
        .iter()
        .find(|cells| !cells.is_multiple_of(scheme.side()))
    {
        section.fault(
            "scheme",
            &format!("takes the cells of the plate two by two, and {odd} is odd"),
            "give an even number of cells along both axes, or take scheme = \"gauss\"",
        );
    }
}

fn read_tolerances(section: &Section<'_>) -> Tolerances {
    let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
    let tolerances = Tolerances {
        displacement_percent: percent("displacement"),
        departure_percent: percent("departure"),
        force_percent: percent("force"),
        correction_percent: percent("correction"),
    };
    section.unknown_keys();
    tolerances
}

fn read_output(section: &Section<'_>, name: &str) -> OutputSettings {
    let folder = section.text("folder");
    let settings = OutputSettings {
        folder: if folder.is_empty() {
            Path::new("output").join(name)
        } else {
            PathBuf::from(folder)
        },
        vtk: section.flag("vtk"),
        plots: section.flag("plots"),
        report: section.flag("report"),
    };
    section.unknown_keys();
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Study, Error> {
        Study::parse("plate", "plate.toml", Path::new("."), text.to_owned())
    }

    fn faults(text: &str) -> Vec<String> {
        match parse(text) {
            Err(Error::Input(faults)) => faults.iter().map(ToString::to_string).collect(),
            other => panic!("accepted: {other:?}"),
        }
    }

    #[test]
    fn an_empty_study_is_the_default_one() {
        let (empty, full) = (parse("").unwrap(), parse(DEFAULT).unwrap());
        assert_eq!(empty.problem.size, [150.0, 50.0]);
        assert_eq!(empty.problem.thickness, 2.0);
        assert_eq!(empty.problem.stretches, [0.15, 0.3, 0.5, 0.75, 1.0]);
        assert_eq!(empty.cells, [60, 20]);
        assert_eq!(empty.reference_meshes(), [[18, 10], [36, 20], [72, 40]]);
        assert_eq!(empty.grading, 2.0);
        assert_eq!(empty.output.folder, Path::new("output/plate"));
        assert_eq!(empty.tolerances, full.tolerances);
        assert!(full.warnings.is_empty());
    }

    #[test]
    fn studies_and_the_library_have_the_same_defaults() {
        let study = parse("").unwrap();
        assert_eq!(study.lattice, LatticeSettings::default());
        assert_eq!(study.mass_spring, NewtonSettings::default());
        assert_eq!(study.scheme, DifferenceScheme::default());
        assert_eq!(study.climb, Some(ClimbSettings::default()));
        assert_eq!(study.corrector, CorrectorSettings::default());
        assert_eq!(study.element, Element::default());
        assert_eq!(study.finite_element, NewtonSettings::default());
    }

    #[test]
    fn all_faults_are_told_at_once_with_line_key_and_hint() {
        let text = "[plate]\nlenght = \"15 cm\"\nwidth = 50\nthickness = \"-2 mm\"\ncells = [60, 0]\n\
                    [material]\ncard = \"pva10\"\n[load]\nstretches = [\"15 mm\"]\n";
        let told = faults(text);
        let expected = [
            (
                "plate.toml:2: plate.lenght: unknown key",
                "did you mean `length`?",
            ),
            (
                "plate.toml:3: plate.width: a length needs a unit",
                "\"2 mm\"",
            ),
            (
                "plate.toml:4: plate.thickness: must be greater than zero",
                "-2 mm",
            ),
            (
                "plate.toml:5: plate.cells: must be two whole numbers",
                "[60, 0]",
            ),
            (
                "plate.toml:7: material.card: there is no card `pva10`",
                "did you mean `pva-10`?",
            ),
            ("plate.toml:9: load.stretches: \"15 mm\"", "%"),
        ];
        assert_eq!(told.len(), expected.len(), "{told:#?}");
        for (line, (start, hint)) in told.iter().zip(expected) {
            assert!(line.starts_with(start) && line.contains(hint), "{line}");
        }
    }

    #[test]
    fn of_many_faults_the_first_are_told_and_the_others_counted() {
        let keys: String = (0..3000).map(|key| format!("k{key} = 1\n")).collect();
        let told = faults(&format!("[plate]\n{keys}"));
        assert_eq!(told.len(), 51);
        assert_eq!(told[50], "and 2950 more findings");
    }

    #[test]
    fn settings_that_contradict_each_other_are_refused() {
        assert!(faults("[plate]\ncells = [60, 10]\n")[0].contains("take [60, 20]"));
        assert!(faults("[plate]\ncells = [2, 2]\n")[0].contains("take [6, 2]"));
        assert!(faults("[plate]\ncells = [1500, 500]\n")[0].contains("750000 cells are too many"));
        assert!(faults("[finite_element]\ncells = [121, 40]\n")[0].contains("[124, 40]"));
        assert!(faults("[finite_element]\ngrading = 0.5\n")[0].contains("must be"));
        assert!(faults("[load]\nstretches = []\n")[0].contains("at least one"));
        assert!(faults("[load]\nstretches = [0.5, 0.3]\n")[0].contains("from small to large"));
        assert!(faults("[load]\nstretches = [-0.1, 0.3]\n")[0].contains("one sign"));
        assert!(faults("[load]\nstretches = [-0.1, -0.05]\n")[0].contains("from small to large"));
        assert!(faults("[load]\nstretches = [0, 0.3]\n")[0].contains("zero"));
        assert!(faults("[load]\nstretches = [-1]\n")[0].contains("must be"));
        assert!(faults("[finite_element]\ncells = \"auto\"\n")[0].contains("\"automatic\""));
        assert!(faults("[corrector]\nscheme = \"gaus\"\n")[0].contains("did you mean \"gauss\""));
        assert!(
            faults("[plate\n")
                .iter()
                .any(|line| line.contains("TOML syntax"))
        );
    }

    /// Equal cells of the reference that are the lattice's own pairs of cells.
    #[test]
    fn a_plate_that_is_compared_with_itself_is_told_so() {
        let study = parse("[plate]\ncells = [240, 80]\n").unwrap();
        assert!(study.reference_cells[1] >= 40 && study.grading > 1.0);
        let own = "[plate]\ncells = [48, 16]\n[finite_element]\ncells = [24, 8]\ngrading = 1\n";
        let study = parse(own).unwrap();
        assert!(study.is_its_own_reference());
        assert!(study.warnings[0].to_string().contains("own equations"));
        let gauss = "[corrector]\nscheme = \"gauss\"\n";
        assert!(
            !parse(&format!("{own}{gauss}"))
                .unwrap()
                .is_its_own_reference()
        );
        let q1 = own.replace("[24, 8]", "[48, 16]\nelement = \"Q1\"");
        assert!(
            parse(&format!("{q1}{gauss}"))
                .unwrap()
                .is_its_own_reference()
        );
    }

    #[test]
    fn compressions_are_a_path_of_their_own() {
        let study = parse("[load]\nstretches = [\"-5 %\", \"-10 %\"]\n").unwrap();
        assert_eq!(study.problem.stretches, [-0.05, -0.1]);
    }

    #[test]
    fn a_stretch_outside_the_range_of_the_card_is_a_warning() {
        let study = parse("[load]\nstretches = [0.5, 1.2]\n").unwrap();
        assert_eq!(study.warnings.len(), 1);
        let told = study.warnings[0].to_string();
        assert!(
            told.contains("120 % stretch") && told.contains("0 to 100 %"),
            "{told}"
        );
    }

    #[test]
    fn a_stretch_beyond_the_stability_of_the_law_is_a_warning() {
        let folder = tempfile::tempdir().unwrap();
        let card = crate::material::registry::CARDS[0].1;
        let card = card.replace("marlow-exponential", "veronda-westmann");
        let (head, _) = card.split_once("amplitude").unwrap();
        let (_, rest) = card.split_once("[data]").unwrap();
        let card = format!("{head}c = \"0.1468 MPa\"\nbeta = 0.31\n[data]{rest}");
        std::fs::write(folder.path().join("vw.toml"), card).unwrap();
        let text = "[material]\ncard = \"vw.toml\"\n[load]\nstretches = [0.5, 0.75]\n";
        let study = Study::parse("plate", "plate.toml", folder.path(), text.to_owned()).unwrap();
        assert_eq!(study.warnings.len(), 1, "{:?}", study.warnings);
        let told = study.warnings[0].to_string();
        assert!(
            told.contains("75 % stretch is beyond the stability"),
            "{told}"
        );
    }
}
