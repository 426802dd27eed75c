//! The study file of a specimen.

use std::path::Path;

use super::measured_curve::{check_extensometer, read_measured_curve};
use super::problem::{Method, Outline, Refinement, Specimen};
use crate::document::{Bound, Section};
use crate::material::{Card, PlaneState};
use crate::mesh::{CellShape, Mesh, MeshReading, import};
use crate::problem::BoundaryProblem;
use crate::solve::LinearSolver;
use crate::studies::pictures::Pictures;
use crate::studies::regions::{SheetCards, divided};
use crate::studies::sections::{Tolerances, check_thickness, read_models, refuse_memory};
use crate::units::Dimension;

mod materials;
mod measurements;
mod outline;
mod path;
mod supports;

use materials::Materials;
pub(crate) use measurements::read_measurements;
use outline::{Import, SHAPES, read_outline, usual_mesh};
use path::{check_measured, read_path};
use supports::SupportsAndLoads;

/// The keys that a study must state of the specimen; cells and lattice have defaults.
const MEASURES: &[&str] = &[
    "shape",
    "thickness",
    "length",
    "width",
    "hole_diameter",
    "file",
    "file_unit",
];

/// Reads a study; `None` where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<Specimen> {
    let of_file = |file: &str, reading| import(&folder.join(file), reading);
    read_with(root, folder, &of_file)
}

/// The same where `import` reads the mesh.
pub fn read_with(root: &Section, folder: &Path, import: &Import) -> Option<Specimen> {
    let materials = Materials::read(root, folder);
    let section = root.section("finite_element");
    let element = section.choice("element", &CellShape::NAMES);
    let linear_solver = section.choice("method", &LinearSolver::NAMES);
    let refinement = read_refinement(&section, element);
    section.unknown_keys();
    let corrector = root.section("corrector");
    let correction = corrector.choice("method", &Method::NAMES);
    corrector.unknown_keys();
    let is_plane_strain = materials
        .plane_state()
        .map(|state| state == PlaneState::Strain);
    let import = |file: &str, reading| {
        let reading = MeshReading {
            is_plane_strain,
            ..reading
        };
        import(file, reading)
    };
    let sheet = StatedSheet::read(root, &import, element);

    let remembers = materials.soften();
    let path = root
        .section("path")
        .requiring(&["factors", "measured_group"]);
    let (factors, group) = read_path(&path, remembers);
    let models = read_models(root);
    let tolerances = Tolerances::read(&root.section("tolerances"), false);
    let pictures = Pictures::read(
        &root.section("pictures"),
        "factors",
        Dimension::Ratio,
        &factors,
    );
    let states = (factors.len(), refinement);
    let specimen = sheet.specimen(root, materials, (&path, &group), states);
    let outline = specimen.as_ref().map(|specimen| &specimen.outline);
    let measurements = read_measurements(root, outline);
    let measured_curve = read_measured_curve(root, folder, None);
    let specimen = specimen?;
    let specimen = Specimen {
        factors,
        measurements,
        measured_curve,
        models,
        tolerances,
        refinement,
        correction: correction?,
        linear_solver: linear_solver?,
        pictures,
        ..specimen
    };
    let mesh = specimen.outline.coarse();
    check_refinement(root, &specimen, &mesh);
    check_nested(root, &specimen);
    check_extensometer(root, &specimen);
    Some(specimen)
}

/// Reads the sheet of a motion in time, whose supports and loads follow the load factor of a section `path`; `None` where it has faults, which
/// are recorded.
pub fn read_moving(
    root: &Section,
    folder: &Path,
    card: Option<&Card>,
    path: &Section,
) -> Option<Specimen> {
    let of_file = |file: &str, reading| import(&folder.join(file), reading);
    let section = root.section("finite_element");
    let element = section.choice("element", &CellShape::NAMES);
    section.unknown_keys();
    let sheet = StatedSheet::read(root, &of_file, element);
    let group = path.text("measured_group");
    sheet.given.check_in_time();
    let materials = Materials::of(card?.clone(), root);
    let specimen = sheet.specimen(root, materials, (path, &group), (1, None))?;
    let ties = specimen.problem.ties(&specimen.outline.coarse());
    if ties.is_ok_and(|ties| !ties.is_empty()) {
        let message = "a line that is parallel to no axis holds the sheet, and in a motion rollers slide along x or y";
        let hint = "turn the specimen so that the line is parallel to an axis";
        root.fault("support", message, hint);
    }
    Some(specimen)
}

/// The parts of a study that define a sheet of any shape: its outline, its supports and loads.
struct StatedSheet<'a> {
    section: Section<'a>,
    name: Option<&'static str>,
    thickness: f64,
    outline: Option<Outline>,
    given: SupportsAndLoads<'a>,
}

impl<'a> StatedSheet<'a> {
    fn read(root: &Section<'a>, import: &Import, element: Option<CellShape>) -> Self {
        let section = root.section("specimen").requiring(MEASURES);
        let name = section.choice("shape", &SHAPES.map(|name| (name, name)));
        let thickness = section.quantity("thickness", Dimension::Length, Bound::SIZE);
        let element = element.unwrap_or(CellShape::Quad9);
        let outline = name.and_then(|name| read_outline(&section, name, import, element));
        section.unknown_keys();
        Self {
            name,
            thickness,
            outline,
            given: SupportsAndLoads::read(root),
            section,
        }
    }

    /// The specimen of some cards with a measured group of a section, for so many states, or local refinement.
    fn specimen(
        self,
        root: &Section,
        materials: Materials,
        (path, group): (&Section, &str),
        (states, refinement): (usize, Option<Refinement>),
    ) -> Option<Specimen> {
        let Self {
            section,
            thickness,
            given,
            ..
        } = self;
        let name = self.name?;
        let fits = |outline: &mut Outline| {
            fits(&section, outline) && affords(&section, outline, states, refinement)
        };
        let outline = self
            .outline
            .and_then(|mut outline| fits(&mut outline).then_some(outline));
        let Some(outline) = outline else {
            // The groups of a shape do not depend on its measures.
            if let Some(mesh) = usual_mesh(name) {
                given.check_groups(&mesh);
                check_measured(path, group, &mesh);
            }
            return None;
        };
        let mesh = outline.coarse();
        check_elements(root, &outline, &mesh);
        given.check_groups(&mesh);
        check_measured(path, group, &mesh);
        let (card, regions) = materials.on(root, &outline, &mesh)?;
        let cards = SheetCards {
            card: &card,
            regions: &regions,
        };
        let (law, laws_of_regions) = cards.laws();
        let problem = BoundaryProblem {
            thickness,
            law,
            regions: laws_of_regions,
            supports: given.supports(),
            loads: given.loads(),
        };
        let name = name.replace('-', "_");
        let specimen = Specimen {
            regions,
            ..Specimen::of(&name, card, problem, outline, group)
        };
        check_thickness(&section, thickness, mesh.size(), Some(&specimen.card));
        given.check(root, &specimen.problem, &mesh);
        warn_of_parts(&section, &specimen, &mesh);
        Some(specimen)
    }
}

/// Warns where a file's cells make other finite elements than the study says.
fn check_elements(root: &Section, outline: &Outline, mesh: &Mesh) {
    let section = root.section("finite_element");
    let Outline::File { element, .. } = outline else {
        return;
    };
    let built = outline.elements_on(mesh).element_names();
    let stated = CellShape::NAMES.iter().find(|(_, shape)| shape == element);
    let stated_name = stated.map_or("", |(name, _)| *name);
    if section.has("element") && !section.flag("adaptive") && built != stated_name {
        let message = format!("the cells of the file make {built} elements, not {stated_name}");
        section.warning(
            "element",
            &message,
            "mesh with the cells you want, or leave the key out",
        );
    }
}

/// Nested correction needs coarser meshes of the same shape, and has no memory.
fn check_nested(root: &Section, specimen: &Specimen) {
    if specimen.correction != Method::Nested {
        return;
    }
    let section = root.section("corrector");
    if !specimen.outline.is_shape() {
        let message = "the mesh of a file has no coarser meshes of the same shape";
        section.fault("method", message, "leave `method` out, or write \"direct\"");
    }
    if specimen.problem.laws().soften() {
        refuse_memory(&section, "nested correction");
    }
}

/// Warns of a file whose cells are divided into parts, as for several materials: all have the study's one where it states no other.
fn warn_of_parts(section: &Section, specimen: &Specimen, mesh: &Mesh) {
    let is_file = matches!(specimen.outline, Outline::File { .. });
    let parts = divided(mesh).filter(|_| is_file && specimen.regions.is_empty());
    if let Some(parts) = parts {
        let message = format!(
            "the cells of the file are divided into {parts}: all of them get the card `{}`",
            specimen.card.name
        );
        let hint =
            "write a [[material]] for each, with `on` and its name, if their materials differ";
        section.warning("file", &message, hint);
    }
}

/// Whether the measures could be read, and fit together; what does not is recorded.
fn fits(section: &Section, outline: &Outline) -> bool {
    let Outline::Shape { shape, .. } = outline else {
        return true;
    };
    if !shape.measures().iter().all(|measure| measure.is_finite()) {
        return false; // A missing measure was reported when it was read.
    }
    let fits = shape.check();
    if let Err(misfit) = &fits {
        section.fault(misfit.measure, misfit.reason, &misfit.remedy());
    }
    fits.is_ok()
}

/// Whether the meshes are not too large; that they are is recorded. Finite elements on the mesh of a file are halved less often
/// where that helps, which is a warning.
fn affords(
    section: &Section,
    outline: &mut Outline,
    states: usize,
    refinement: Option<Refinement>,
) -> bool {
    let (key, smaller) = match (refinement, outline.is_shape()) {
        (Some(_), _) => ("shape", "take fewer cells, `most_cells` or load factors"),
        (None, true) => ("cells", "take fewer, or fewer load factors"),
        (None, false) => (
            "file",
            "take a coarser mesh, or elements of the first degree",
        ),
    };
    let full_excess = section.excess(outline.need(states, refinement));
    let too_much = |outline: &Outline| section.excess(outline.need(states, None)).is_some();
    while refinement.is_none() && too_much(outline) && outline.halve_less() {}
    let affords = section.affords(key, outline.need(states, refinement), smaller);
    if let Some(excess) = full_excess.filter(|_| affords) {
        let meshes = match outline.halvings() {
            0 => {
                "computed on this mesh alone, without an error estimate of their displacement and of the curves that its edges approximate"
            }
            _ => "computed on two meshes instead of three",
        };
        let message = format!(
            "halved twice, for the finite elements' own error, it {excess}: the finite elements are {meshes}"
        );
        section.warning(key, &message, &excess.remedy("take a coarser mesh"));
    }
    affords
}

fn read_refinement(section: &Section, element: Option<CellShape>) -> Option<Refinement> {
    let error = section.quantity("error", Dimension::Ratio, Bound::Within(1e-6, 0.5));
    let most_cells = section.count("most_cells", 10, 1_000_000_000);
    if !section.flag("adaptive") {
        return None;
    }
    if element.is_some_and(|element| !element.is_triangle()) {
        let message = "adaptive refinement needs triangles";
        section.fault("element", message, "take \"T2\" or \"T1\"");
    }
    Some(Refinement {
        error_percent: 100.0 * error,
        most_cells,
    })
}

/// A force on nodes without edges is another one on a mesh that is refined locally, and a material that softens has no error estimate to
/// refine by.
fn check_refinement(root: &Section, specimen: &Specimen, mesh: &Mesh) {
    if specimen.refinement.is_none() {
        return;
    }
    if specimen.problem.laws().soften() {
        let message = "this card softens, and the error estimate that refines the mesh has no memory of the largest load";
        let hint = "leave out `adaptive`, or the card's `[softening]`";
        root.section("finite_element")
            .fault("adaptive", message, hint);
    }
    if !specimen.problem.moved_points(mesh).is_empty() {
        let message = "in the limit of fine meshes single nodes move without force, so that local refinement around them never ends";
        let hint = "move a group with edges, lines or an area, or leave out `adaptive`";
        root.fault("support", message, hint);
    }
    if !specimen.problem.forces_on_points(mesh).is_empty() {
        let message = "under a force on single nodes the displacement diverges on finer meshes, so that local refinement around them never ends";
        let hint = "put it on a group with edges, lines or an area, or leave out `adaptive`";
        root.fault("load", message, hint);
    }
}
