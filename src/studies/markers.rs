//! From files of measured displacements to a field that satisfies the physics.
//!
//! ```text
//! FIELD ─measurement─▶ frames ┐
//! mesh, outline or markers ───┼─▶ MeasuredField ─estimate─▶ one FieldEstimate a frame
//! conditions.toml ────────────┘
//! ```

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::corrector::estimation::{FieldEstimate, RegressedLaw, Specimen, estimate, transfer};
use crate::error::{Diagnostic, Error, Severity};
use crate::markers::{
    Frame, Measurement, Read, Reading, check_thickness, place_on, read, read_lines,
};
use crate::material::{Card, HyperelasticLaw};
use crate::mesh::{Allowed, CellShape, Mesh, MeshReading, Outline, import};

mod conditions;
mod doubts;
mod figures;
mod json;
mod report;
mod tables;
pub mod written;

pub use conditions::{Conditions, EdgesByName, measured_force};

/// A mesh that is made has at most about so many cells, if no size is given.
const MOST_CELLS: f64 = 20_000.0;

/// A mesh that is asked for has at most about so many.
const TOO_MANY_CELLS: f64 = 1e6;

/// A mesh that is made has at least about so many cells across the specimen, if no size is given.
const LEAST_ACROSS: f64 = 12.0;

/// Where the mesh comes from.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// The mesh of the field, or one inside the outline of the markers.
    Data,
    /// A file with a mesh, and how it is read.
    File(PathBuf, MeshReading),
    /// A table with closed lines.
    Outline(PathBuf),
}

/// What is to be corrected, and how.
#[derive(Clone, Debug)]
pub struct Request {
    /// The files of the field.
    pub files: Vec<PathBuf>,
    /// How they are to be understood.
    pub reading: Reading,
    /// Name or path of the material's card.
    pub material: String,
    /// Thickness at rest in mm.
    pub thickness: f64,
    /// The mesh.
    pub mesh: MeshSource,
    /// Size of the cells of a mesh that is made, in mm.
    pub cell_size: Option<f64>,
    /// Their kind.
    pub shape: CellShape,
    /// Whether gaps among the markers are holes of the specimen.
    pub holes: bool,
    /// What is known besides.
    pub conditions: Conditions,
}

/// A field that was read, with all that its correction needs.
#[derive(Debug)]
pub struct MeasuredField {
    /// The material.
    pub card: Card,
    /// Thickness at rest in mm.
    pub thickness: f64,
    /// The specimen's mesh.
    pub mesh: Mesh,
    /// Where the mesh comes from, in words.
    pub mesh_origin: String,
    /// The mesh that the field came on, where it is brought onto another one: then it is a computed field without
    /// noise, see [`transfer`].
    pub coarse: Option<Mesh>,
    /// The markers on the mesh.
    pub measurement: Measurement,
    /// The layout of the files.
    pub layout: &'static str,
    /// What is known besides.
    pub conditions: Conditions,
    /// The law with parameters that are found with the field, if there are any.
    pub regressed: Option<RegressedLaw>,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
    /// What makes the figures of all frames doubtful.
    pub doubts: Vec<Diagnostic>,
    /// Where the specimen's edge is nobody's knowledge but the markers': how far outside of them it may lie, in mm. The
    /// intervals of forces hold that.
    pub unknown_gap: Option<f64>,
}

/// A mesh and what it was made from.
struct Made {
    mesh: Mesh,
    origin: String,
    warnings: Vec<Diagnostic>,
    doubts: Vec<Diagnostic>,
    unknown_gap: Option<f64>,
}

impl Made {
    /// A mesh whose edge is known.
    fn known(mesh: Mesh, origin: String) -> Self {
        Self {
            mesh,
            origin,
            warnings: Vec::new(),
            doubts: Vec::new(),
            unknown_gap: None,
        }
    }
}

impl MeasuredField {
    /// Reads everything.
    ///
    /// # Errors
    /// [`Error::Input`] with what is wrong and what to do.
    pub fn prepare(request: Request) -> Result<Self, Error> {
        let card = Card::load(&request.material, Path::new("."))?;
        let field = read(&request.files, &request.reading)?;
        let Made {
            mesh,
            origin,
            mut warnings,
            mut doubts,
            unknown_gap,
        } = mesh(&request, &field)?;
        request.conditions.check(&mesh)?;
        request.conditions.check_frames(&field.measurement)?;
        let regressed = request.conditions.regressed_law(&card)?;
        let coarse = match request.mesh {
            MeshSource::File(..) => field.mesh,
            _ => None,
        };
        let mut placed = place_on(&mesh, &field.measurement)?;
        if let Some(coarse) = &coarse {
            whole(coarse, &field.measurement)?;
            // Interpolation needs all nodes.
            placed.measurement = field.measurement;
            placed.outside = 0;
        }
        if placed.outside > 0 {
            let message = format!("markers outside of the mesh: {}", placed.outside);
            warnings.push(Diagnostic::warning("", message).hint("they are left out"));
        }
        let mut all = field.warnings;
        doubts.extend(check_thickness(&mesh, request.thickness));
        all.extend(warnings);
        Ok(Self {
            card,
            thickness: request.thickness,
            mesh,
            mesh_origin: origin,
            coarse,
            measurement: placed.measurement,
            layout: field.layout,
            conditions: request.conditions,
            regressed,
            warnings: all,
            doubts,
            unknown_gap,
        })
    }

    /// The law that an estimate has found, else that of the card.
    pub fn law(&self, estimate: &FieldEstimate) -> Arc<dyn HyperelasticLaw> {
        match &self.regressed {
            Some(regressed) if !estimate.parameters.is_empty() => {
                let values = estimate.parameters.iter().map(|(.., found)| found.value);
                regressed.at(&values.collect::<Vec<_>>())
            }
            _ => Arc::clone(&self.card.law),
        }
    }

    /// Estimates the field of every frame.
    ///
    /// # Errors
    /// As [`estimate`], with the frame in its message.
    pub fn estimate(&self, told: &dyn Fn(&Frame)) -> Result<Vec<FieldEstimate>, Error> {
        let specimen = Specimen {
            mesh: &self.mesh,
            law: Arc::clone(&self.card.law),
            thickness: self.thickness,
        };
        let frames = &self.measurement.frames;
        let of_frame = |frame: &Frame| {
            told(frame);
            let law = self.regressed.as_ref();
            let knowledge = self.conditions.knowledge(frame.number, law);
            let found = match &self.coarse {
                None => estimate(&specimen, &frame.markers, &knowledge),
                Some(coarse) => {
                    let markers = frame.markers.iter();
                    let field: Vec<f64> = markers.flat_map(|marker| marker.displacement).collect();
                    transfer(&specimen, (coarse, &field), &knowledge)
                }
            };
            found
                .map(|found| self.with_unknown_edge(found))
                .map_err(|error| match error {
                    Error::Solve { model, fault, .. } => Error::Solve {
                        model,
                        step: format!("frame {}", frame.number),
                        fault,
                    },
                    Error::Input(faults) if frames.len() > 1 => {
                        let named = |fault: Diagnostic| Diagnostic {
                            message: format!("frame {}: {}", frame.number, fault.message),
                            ..fault
                        };
                        Error::Input(faults.into_iter().map(named).collect())
                    }
                    other => other,
                })
        };
        frames.iter().map(of_frame).collect()
    }
}

/// Whether a field has a displacement at every node of its mesh.
fn whole(mesh: &Mesh, measurement: &Measurement) -> Result<(), Error> {
    let mut frames = measurement.frames.iter();
    match frames.find(|frame| frame.markers.len() != mesh.nodes.len()) {
        None => Ok(()),
        Some(frame) => Err(Error::input(
            format!(
                "a field can be brought onto another mesh only if it is whole; the frame {} lacks {} of {} nodes",
                frame.number,
                mesh.nodes.len() - frame.markers.len(),
                mesh.nodes.len()
            ),
            "leave out --mesh to correct it as measured data on its own mesh",
        )),
    }
}

/// The mesh that a request wants.
fn mesh(request: &Request, field: &Read) -> Result<Made, Error> {
    if request.conditions.edge_gap.is_some()
        && (field.mesh.is_some() || !matches!(request.mesh, MeshSource::Data))
    {
        return Err(Error::input(
            "an edge gap is given, but the specimen's edge is not made of markers",
            "leave out --edge-gap (edge_gap), or the mesh and the outline",
        ));
    }
    match (&request.mesh, &field.mesh) {
        (MeshSource::File(path, reading), _) => {
            let (mesh, warnings) = import(path, *reading).map_err(Error::Input)?;
            let origin = format!("from {}", path.display());
            Ok(Made {
                warnings,
                ..Made::known(mesh, origin)
            })
        }
        (MeshSource::Outline(path), _) => {
            let lines = read_lines(path, request.reading.unit)?;
            let outline = Outline::of_lines(lines).map_err(|reason| {
                let hint = "give the corners of each closed line in order, in columns x [mm], y [mm], line";
                Error::input(format!("{}: {reason}", path.display()), hint)
            })?;
            let markers = field.measurement.places().len() as f64;
            let spacing = (outline.area() / markers).sqrt();
            let mesh = made(request, &outline, spacing)?;
            let origin = format!("made inside the outline of {}", path.display());
            Ok(Made::known(mesh, origin))
        }
        (MeshSource::Data, Some(mesh)) => {
            let told = mesh.faults(Allowed::default());
            let warnings = told.into_iter().map(|fault| Diagnostic {
                severity: Severity::Warning,
                message: format!("the field's own mesh: {}", fault.message),
                hint: Some("correct it on a sound mesh: --mesh or --outline".into()),
                ..fault
            });
            Ok(Made {
                warnings: warnings.collect(),
                ..Made::known(mesh.clone(), "that of the field".into())
            })
        }
        (MeshSource::Data, None) => of_markers(request, field),
    }
}

/// A mesh inside the outline of the markers.
fn of_markers(request: &Request, field: &Read) -> Result<Made, Error> {
    let refuse = |reason: String| {
        let hint = "give the specimen's edge with --outline, or its mesh with --mesh";
        Error::input(format!("a mesh cannot be made: {reason}"), hint)
    };
    let measurement = &field.measurement;
    let found = Outline::of_points(&measurement.places()).map_err(refuse)?;
    let mut outline = found.outline;
    let mut warnings = Vec::new();
    let mut warn = |message: String, hint: &str| {
        warnings.push(Diagnostic::warning("", message).hint(hint));
    };
    match (outline.holes.len(), request.holes) {
        (0, _) => {}
        (_, false) => outline.holes.clear(),
        (count, true) => warn(
            format!("gaps among the markers taken for holes: {count}"),
            "--holes closed if markers were only lost there; --outline gives their true edges",
        ),
    }
    let gap = request.conditions.edge_gap;
    if let Some(gap) = gap {
        outline = outline.widened(gap).map_err(refuse)?;
    }
    let mesh = made(request, &outline, found.spacing)?;
    let spacing = found.spacing;
    let mut origin =
        format!("made inside the outline of the markers, which are about {spacing:.4} mm apart");
    match gap {
        Some(gap) if gap > 0.0 => origin += &format!(", {gap} mm farther out"),
        Some(_) => {}
        None => warn(
            "the specimen's edge is not known: the outline is that of the markers, which usually end inside of it".into(),
            "forces grow with the width: their intervals hold an edge up to a spacing farther out; say where it is with \
             --edge-gap LENGTH (\"0 mm\" where markers lie on it), --outline or --mesh",
        ),
    }
    let doubt = |reason: String| {
        let hint = "give the specimen's edge with --outline, or its mesh with --mesh";
        Diagnostic::warning(
            "",
            format!("the outline of the markers is uncertain: {reason}"),
        )
        .hint(hint)
    };
    Ok(Made {
        mesh,
        origin,
        warnings,
        doubts: found.doubts.into_iter().map(doubt).collect(),
        unknown_gap: gap.is_none().then_some(spacing),
    })
}

/// A mesh inside an outline. Without a wish its cells are as long as the markers' spacing, but at least 12 go across
/// the specimen and at most about 20,000 are made.
fn made(request: &Request, outline: &Outline, spacing: f64) -> Result<Mesh, Error> {
    // Of a triangle with edges of length 1.
    let cell_area = 3f64.sqrt() / 4.0;
    let smallest = |cells: f64| (outline.area() / (cells * cell_area)).sqrt();
    let extent = |axis: usize| {
        let values = outline.outer.iter().map(|point| point[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    let across = extent(0).min(extent(1));
    let size = request
        .cell_size
        .unwrap_or(spacing.min(across / LEAST_ACROSS).max(smallest(MOST_CELLS)));
    if size > across / 2.0 {
        let message = format!("cells of {size} mm are too large for a specimen of {across:.4} mm");
        return Err(Error::input(message, "choose a smaller --cell-size"));
    }
    if size < smallest(TOO_MANY_CELLS) {
        let message = format!("cells of {size} mm would be more than a million");
        return Err(Error::input(message, "choose a larger --cell-size"));
    }
    Ok(outline.mesh(size, request.shape))
}
