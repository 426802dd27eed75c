//! From files of measured displacements to a field that satisfies the physics.
//!
//! ```text
//! FIELD ─markers─▶ frames ─────┐
//! mesh, outline or markers ───┼─▶ MarkerStudy ─estimate─▶ one FieldEstimate per frame
//! conditions.toml ────────────┘
//! ```

use std::path::Path;

use rayon::prelude::*;

use crate::error::{Diagnostic, Error};
use crate::estimation::{
    Answer, FieldEstimate, Knowledge, Reason, RegressedLaw, UncertainLaw, estimate, name_parts,
    nearest_field, transfer,
};
use crate::markers::{Frame, MarkerSeries, Understood, check_thickness, place_on};
use crate::material::{Card, PlaneState};
use crate::mesh::Mesh;
use crate::results::Finding;
use crate::studies::images::IMAGES;

mod alike;
mod area;
mod conditions;
mod edge_position;
mod figures;
pub(super) mod finding;
mod findings;
mod force_signs;
mod forces;
mod gross_errors;
mod headline;
mod image_misfit;
pub mod joint;
mod json;
mod machine;
mod materials;
mod mistakes;
mod quantities;
mod refined;
mod report;
mod request;
mod sheet;
mod specimen_file;
mod specimen_mesh;
mod stated_conditions;
mod tables;
mod verdict;
pub mod written;

pub use alike::ComparedFrames;
pub use area::Area;
pub use conditions::{Conditions, TEMPLATE, measured_force};
use finding::once;
pub(super) use headline::mistaken;
pub use machine::{ForceColumn, FrameForces};
pub use materials::in_plane;
use materials::{card_warnings, check_regions, one_card_warning};
pub use request::{MeshSource, Request};
pub use specimen_file::SpecimenFile;
use specimen_mesh::mesh;
pub use stated_conditions::keys;
pub use verdict::worst as worst_answer;

/// A field that was read, with all data for its correction.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MarkerStudy {
    /// The material; of several that of the cells that belong to no region.
    pub card: Card,
    /// The cards of regions of the mesh by their names.
    pub regions: Vec<(String, Card)>,
    /// Thickness at rest in mm.
    pub thickness: f64,
    /// The specimen's mesh.
    pub mesh: Mesh,
    /// Size of its cells in mm, where they were made.
    pub cell_size: Option<f64>,
    /// The origin of the mesh, in words.
    pub mesh_origin: String,
    /// The mesh that the field came on, where it is brought onto another one: then it is a computed field without
    /// noise, see [`transfer`].
    pub coarse: Option<Mesh>,
    /// The markers on the mesh.
    pub series: MarkerSeries,
    /// How the files were understood.
    pub understood: Understood,
    /// What is known besides the displacements.
    pub conditions: Conditions,
    /// The law with parameters that are found with the field, if there are any.
    pub regressed: Option<RegressedLaw>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// Doubts about the figures of all frames.
    pub doubts: Vec<Finding>,
    /// The mistake that the files seem to have, from which all other doubts follow.
    pub mistake: Option<Diagnostic>,
    /// Why the images seem to have been followed wrongly.
    pub mistaken_images: Option<Diagnostic>,
    /// How far outside of the outermost markers the specimen's edge may lie, in mm, where only the markers show it. The intervals of forces
    /// include this.
    pub unknown_gap: Option<f64>,
    /// The accuracy of an edge that was traced in images, in mm; 0 for other edges.
    pub edge_accuracy: f64,
}

/// The warning that so many markers lie outside of the mesh.
fn outside_warning(markers: usize) -> Option<Diagnostic> {
    let message = format!("markers outside the mesh: {markers}");
    (markers > 0).then(|| Diagnostic::warning("", message).hint("they are left out"))
}

/// The doubts about an outline and about a thickness.
fn reading_doubts(outline: Vec<Diagnostic>, thickness: Option<Diagnostic>) -> Vec<Finding> {
    let outline = outline
        .into_iter()
        .map(|doubt| ("uncertain-outline", doubt));
    let all = outline.chain(thickness.map(|doubt| ("thickness", doubt)));
    all.map(|(rule, doubt)| Finding::doubt_of(rule, doubt))
        .collect()
}

impl MarkerStudy {
    /// Reads everything; images are reported before they are followed.
    ///
    /// # Errors
    /// [`Error::Input`] with the faults and their remedies.
    pub fn prepare(request: Request, watch: &dyn Fn(&str)) -> Result<Self, Error> {
        let card = Card::load(&request.material, Path::new("."))?;
        Self::prepare_with(card, request, watch)
    }

    /// Reads everything but the material, which is that of a card such as [`Card::of_law`] makes.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn prepare_with(
        card: Card,
        mut request: Request,
        watch: &dyn Fn(&str),
    ) -> Result<Self, Error> {
        let (card, regions) = materials::in_common_plane(card, &mut request.conditions)?;
        let (mut field, images) = request.read_field(watch)?;
        let table = request.forces.as_deref();
        let force_warning = request.conditions.take_forces(table, &field.series)?;
        field.warnings.extend(force_warning);
        let specimen_mesh = mesh(&request, &field)?;
        let (mut mesh, mut warnings) = (specimen_mesh.mesh, specimen_mesh.warnings);
        let edges = request.conditions.edges.iter();
        name_parts(&mut mesh, edges.map(|(name, _)| name.as_str()));
        area::name(&mut mesh, &request.conditions.areas)?;
        request.conditions.suit(&mesh, &field.series)?;
        check_regions(&regions, &mesh)?;
        let regressed = request.conditions.regressed_law(&card)?;
        let is_of_file = matches!(request.mesh, MeshSource::File(..));
        let coarse = field.mesh.filter(|_| is_of_file);
        let mut placed = place_on(&mesh, &field.series)?;
        if let Some(coarse) = &coarse {
            check_complete(coarse, &field.series)?;
            // Interpolation needs all nodes.
            placed.series = field.series;
            placed.outside = 0;
            warnings.extend(request.conditions.ignored_for_computed_fields());
        }
        let conditions = request.conditions;
        force_signs::check(&conditions.forces, &placed.series, &mesh, &*card.law)?;
        warnings.extend(outside_warning(placed.outside));
        warnings.extend(card_warnings(&card, &regions, &mesh));
        warnings.extend(one_card_warning(&regions, &mesh));
        let thickness = (card.law.plane_state() == PlaneState::Stress)
            .then(|| check_thickness(&mesh, request.thickness))
            .flatten();
        let study = Self {
            card,
            regions,
            thickness: request.thickness,
            mesh,
            cell_size: specimen_mesh.cell_size,
            mesh_origin: specimen_mesh.origin,
            coarse,
            series: placed.series,
            understood: field.understood,
            conditions,
            regressed,
            warnings: [field.warnings, warnings].concat(),
            doubts: reading_doubts(specimen_mesh.doubts, thickness),
            mistake: None,
            mistaken_images: None,
            unknown_gap: specimen_mesh.unknown_gap,
            edge_accuracy: 0.0,
        };
        let Some(images) = images else {
            return Ok(study);
        };
        Ok(study.about_equilibrium(&images, request.images.mask.is_some(), watch))
    }

    /// The frames with their estimates.
    pub(super) fn frames_with<'a>(
        &'a self,
        estimates: &'a [FieldEstimate],
    ) -> impl DoubleEndedIterator<Item = (&'a Frame, &'a FieldEstimate)> + ExactSizeIterator {
        self.series.frames.iter().zip(estimates)
    }

    /// Whether the markers were followed in camera images.
    fn is_of_images(&self) -> bool {
        self.understood.layout == IMAGES
    }

    /// The frame whose markers move most.
    fn most_moved(&self) -> Option<&Frame> {
        let frames = self.series.frames.iter();
        frames.max_by(|a, b| a.motion().total_cmp(&b.motion()))
    }

    /// Estimates the field of every frame, and compares the residuals of each with those of the one before. Frames
    /// that cannot be corrected are left out as by [`Self::conclude`]; each is reported before it begins.
    ///
    /// # Errors
    /// As [`estimate`], with the frame in its message, where none can be.
    pub fn estimate(&mut self, watch: &dyn Fn(&Frame)) -> Result<Vec<FieldEstimate>, Error> {
        let (mut compared, mut failed) = (ComparedFrames::default(), Vec::new());
        for frames in self.series.frames.chunks(rayon::current_num_threads()) {
            frames.iter().for_each(watch);
            for (frame, estimate) in frames.iter().zip(self.estimate_frames(frames)) {
                match estimate {
                    Ok(estimate) => drop(compared.push(frame, estimate)),
                    Err(fault) => failed.push((frame.number, fault)),
                }
            }
        }
        let mut estimates = compared.into_estimates();
        self.conclude(&mut estimates, failed)?;
        Ok(estimates)
    }

    /// Leaves out the frames that could not be corrected, with a doubt for each kind of fault, and refutes the others where their files
    /// seem to have a mistake.
    ///
    /// # Errors
    /// The cause where no frame remains, or else the first fault.
    pub fn conclude(
        &mut self,
        estimates: &mut [FieldEstimate],
        failed: Vec<(usize, Error)>,
    ) -> Result<(), Error> {
        self.leave_out(failed)?;
        self.mistake = self.likely_mistake(estimates);
        if self.mistake.is_some() {
            for estimate in estimates {
                estimate.verdict.answer = Answer::NotExplained;
                estimate.verdict.reasons.insert(0, Reason::Mistaken);
            }
        }
        Ok(())
    }

    fn leave_out(&mut self, mut failed: Vec<(usize, Error)>) -> Result<(), Error> {
        if !failed.is_empty() && failed.len() == self.series.frames.len() {
            let most = self.most_moved();
            let cause = most.and_then(|frame| self.cause_without_solution(frame));
            return Err(cause.map_or_else(|| failed.swap_remove(0).1, Error::from));
        }
        let all = self.frame_numbers();
        let faults = failed.into_iter().flat_map(|(number, fault)| {
            self.series.frames.retain(|frame| frame.number != number);
            faults(fault).map(move |(message, remedy)| {
                let named = format!("frame {number}: ");
                let message = message.strip_prefix(&named).unwrap_or(&message);
                (
                    number,
                    (format!("{message}; the frame is left out"), remedy),
                )
            })
        });
        let faults: Vec<_> = faults.collect();
        let doubts = once(&all, "frame-left-out", faults.into_iter());
        self.doubts.extend(doubts);
        Ok(())
    }

    /// Estimates the fields of some frames, each by itself, at the same time.
    pub fn estimate_frames<'a>(
        &self,
        frames: impl IntoParallelIterator<Item = &'a Frame>,
    ) -> Vec<Result<FieldEstimate, Error>> {
        let frames = frames.into_par_iter();
        frames.map(|frame| self.estimate_frame(frame)).collect()
    }

    /// Estimates the field of a frame by itself.
    ///
    /// # Errors
    /// As [`estimate`], with the frame in its message.
    pub fn estimate_frame(&self, frame: &Frame) -> Result<FieldEstimate, Error> {
        let (specimen, knowledge) = (self.specimen(), self.knowledge(frame));
        let estimate = match &self.coarse {
            None => self.weighted(&frame.markers, knowledge, &|knowledge| {
                estimate(&specimen, &frame.markers, knowledge)
            }),
            Some(coarse) => {
                let markers = frame.markers.iter();
                let field: Vec<f64> = markers.flat_map(|marker| marker.displacement).collect();
                transfer(&specimen, coarse, &field, &knowledge)
            }
        };
        let estimate = estimate.map(|estimate| self.with_unknown_edge(estimate));
        estimate.map_err(|error| of_frame(error, frame.number, self.series.frames.len()))
    }

    /// The nodal displacements of the field in equilibrium nearest to a frame: by [`nearest_field`], or by a full estimate where that fails.
    fn nearest_displacement(&self, frame: &Frame, may_free_edges: bool) -> Result<Vec<f64>, Error> {
        let specimen = self.specimen();
        let nearest = self.weighted(&frame.markers, self.knowledge(frame), &|knowledge| {
            nearest_field(&specimen, &frame.markers, knowledge, may_free_edges)
        });
        let estimate = nearest.or_else(|_| self.estimate_frame(frame))?;
        Ok(estimate.displacement)
    }

    fn knowledge(&self, frame: &Frame) -> Knowledge {
        let law = self.regressed.as_ref();
        Knowledge {
            edge_gap: self.unknown_gap,
            edge_accuracy: self.edge_accuracy,
            uncertain_law: UncertainLaw::of_card(&self.card),
            ..self.conditions.knowledge(frame.number, law)
        }
    }
}

/// What is wrong with a frame that could not be corrected, and what to do.
fn faults(error: Error) -> impl Iterator<Item = (String, String)> {
    let faults = match error {
        Error::Input(faults) => faults,
        Error::Solve { fault, .. } => {
            vec![Diagnostic::warning("", fault.to_string()).hint(fault.advice())]
        }
        other => vec![Diagnostic::warning("", other.to_string())],
    };
    faults
        .into_iter()
        .map(|fault| (fault.message, fault.hint.unwrap_or_default()))
}

/// An error with the frame in its message.
fn of_frame(error: Error, number: usize, frames: usize) -> Error {
    match error {
        Error::Solve { model, fault, .. } => Error::Solve {
            model,
            step: format!("frame {number}"),
            fault: fault.of_measured(),
        },
        other if frames > 1 => {
            other.map_faults(|fault| fault.prefixed(format_args!("frame {number}")))
        }
        other => other,
    }
}

/// Whether a field has a displacement at every node of its mesh.
fn check_complete(mesh: &Mesh, series: &MarkerSeries) -> Result<(), Error> {
    let mut frames = series.frames.iter();
    match frames.find(|frame| frame.markers.len() != mesh.nodes.len()) {
        None => Ok(()),
        Some(frame) => Err(Error::input(
            format!(
                "a field can be transferred to another mesh only if it is complete; frame {} lacks {} of {} nodes",
                frame.number,
                mesh.nodes.len() - frame.markers.len(),
                mesh.nodes.len()
            ),
            "leave out --mesh to correct it as measured data on its own mesh",
        )),
    }
}
