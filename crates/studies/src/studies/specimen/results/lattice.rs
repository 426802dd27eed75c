//! Springs on the lattice of a specimen and their correction, each up to the end of its path.

use super::end::{End, Run};
use crate::corrector::climb::{Climb, Provenance};
use crate::corrector::nested::{NestedCorrection, NestedMeshes};
use crate::corrector::plate::KnownConditions;
use crate::corrector::specimen::{correct, correct_without_multipliers};
use crate::corrector::{CorrectorSettings, Multipliers, PlateCorrector, Solver};
use crate::error::{Error, SolveFault};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Model, Solution};
use crate::results::models::{CORRECTED, MASS_SPRING};
use crate::solve::vector::difference;
use crate::solve::{Attendance, Loading, NewtonSettings, PathEnd, Stage, State};
use crate::studies::ModelKind;
use crate::studies::specimen::problem::{LARGE, NEWTON, PlateGrids};

const CORRECTOR: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-10,
    movement: 1e-9,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// Where the corrector began at a load factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At springs on a coarser mesh.
    Nested,
    /// On grids of a plate, as its study says.
    Grids,
    /// The same where the springs have no field: ū is the affine stretch.
    GridsAlone,
    /// At the springs' field, with what the correction had changed at the load factor before.
    Springs,
    /// At the equilibrium of the elements, which Newton's method reached from rest in load steps; ū is the
    /// springs' field.
    LoadSteps,
    /// The same, where the springs have no field: ū is that equilibrium itself, which needs no correction.
    Alone,
}

/// How the corrected fields of a path were reached, at each load factor.
#[derive(Default)]
pub struct Correction {
    /// Where the corrector began.
    pub starts: Vec<Start>,
    /// The multipliers, condition after condition; none where they were not computed.
    pub multipliers: Vec<Vec<Multipliers>>,
    /// How a climb came to each field; empty where none climbed.
    pub climbs: Vec<Provenance>,
    /// The discretisation errors in mm of those that began at springs on a coarser mesh.
    pub discretisation_errors: Vec<f64>,
}

/// The corrected fields of a path, and how each was reached.
#[derive(Default)]
struct Fields {
    states: Vec<State>,
    correction: Correction,
}

impl Fields {
    /// Adds the field at the next load factor.
    fn push(&mut self, state: State, start: Start, multipliers: Vec<Multipliers>) {
        self.states.push(state);
        self.correction.starts.push(start);
        self.correction.multipliers.push(multipliers);
    }
}

/// Springs on the lattice, and the corrected field on the mesh of the coarsest finite elements.
pub struct OnLattice {
    pub springs: MassSpring,
    pub uncorrected: Solution,
    pub corrected: Solution,
    /// How the corrected fields were reached.
    pub correction: Correction,
}

/// Solves as many load factors as can be reached, and records where the path ends before the last one. `file` is the beginning of the names of
/// the model's files.
pub fn solve(run: &mut Run, model: &Model, file: &str, settings: NewtonSettings) -> Solution {
    let (specimen, progress) = (run.specimen, run.progress);
    let report = |factor: f64| run.report_solved(&model.name, factor);
    let report_short_step = |factor: f64| {
        let at = specimen.along.describe((1e4 * factor).round() / 1e4);
        progress.tell(&format!("{}, {at}, one of many short steps", model.name));
    };
    let attendance = Attendance {
        on_the_way: &report_short_step,
        ..progress.along(&report)
    };
    let states = model.attended(&specimen.factors, settings, attendance);
    let states = states.unwrap_or_else(|end| {
        run.ends.push(End::of_path(specimen, model, file, &end));
        end.states
    });
    Solution::new(model, &specimen.groups(), states)
}

/// The springs on the lattice, as far as they go; without solutions where the study leaves them out.
pub fn solve_springs(run: &mut Run) -> Result<(MassSpring, Solution), Error> {
    let specimen = run.specimen;
    let springs = specimen.springs();
    if !specimen.computes(ModelKind::MassSpring) {
        let none = Solution::empty(springs.mesh.clone());
        return Ok((springs, none));
    }
    let model = specimen.on(&springs.mesh, springs.potential())?;
    let model = model.named(MASS_SPRING.name);
    let model = model.describing(|element| springs.describe_element(element));
    let settings = specimen.springs_newton;
    let uncorrected = solve(run, &model, MASS_SPRING.key, settings);
    drop(model);
    Ok((springs, uncorrected))
}

impl OnLattice {
    /// Solves the springs and corrects them, as the study asks for; each path ends independently of the other.
    pub fn solve(run: &mut Run) -> Result<Self, Error> {
        let (springs, uncorrected) = solve_springs(run)?;
        let mesh = run.specimen.outline.corrected_mesh();
        if !run.specimen.computes(ModelKind::Corrected) {
            return Ok(Self {
                springs,
                uncorrected,
                corrected: Solution::empty(mesh),
                correction: Correction::default(),
            });
        }
        let nested = correct_nested(run, &mesh)?;
        Self::correct(run, &mesh, (springs, uncorrected), nested)
    }

    /// Corrects the springs at the load factors that nested meshes have not reached.
    fn correct(
        run: &mut Run,
        mesh: &Mesh,
        (springs, uncorrected): (MassSpring, Solution),
        nested: Vec<NestedCorrection>,
    ) -> Result<Self, Error> {
        let specimen = run.specimen;
        let energy = specimen.corrected_energy(mesh);
        let model = specimen.on(mesh, &energy)?.named("corrector");
        let fields = match specimen.plate() {
            Some((plate, grids)) => correct_on_grids(run, (&plate, grids), mesh, &uncorrected)?,
            None => {
                let mut fields = Fields::default();
                for field in nested {
                    fields.push(field.state, Start::Nested, Vec::new());
                    let error = field.discretisation_error;
                    fields.correction.discretisation_errors.push(error);
                }
                let corrections = Corrections {
                    run,
                    model: &model,
                    steps: None,
                };
                corrections.all(&uncorrected, fields)
            }
        };
        let corrected = Solution::new(&model, &specimen.groups(), fields.states);
        drop(model);
        Ok(Self {
            springs,
            uncorrected,
            corrected,
            correction: fields.correction,
        })
    }
}

/// Corrects as many stretches as can be, on a mesh to whose nodes the springs' field is interpolated. Where the springs have no field
/// the affine stretch takes its place, on which the multipliers and the start of the direct method depend.
///
/// # Errors
/// Any but [`Error::Solve`], which is an end.
fn correct_on_grids(
    run: &mut Run,
    (plate, grids): (&ClampedPlate, &PlateGrids),
    mesh: &Mesh,
    springs: &Solution,
) -> Result<Fields, Error> {
    let mut fields = Fields::default();
    let settings = &grids.correction;
    let mut corrector = PlateCorrector::new(plate, mesh, settings.scheme, settings.direct);
    let mut climb = settings
        .climb
        .map(|climb| Climb::graded(plate, grids.cells, settings.scheme, settings.grading, climb));
    let onto_mesh = settings
        .is_graded()
        .then(|| springs.mesh.interpolation_on(mesh));
    for (step, stretch) in run.specimen.factors.iter().enumerate() {
        let data = match (springs.displacement(step), &onto_mesh) {
            (Some(field), Some(onto_mesh)) => onto_mesh.apply(field),
            (Some(field), None) => field.to_vec(),
            (None, _) => plate.affine(mesh, *stretch),
        };
        let corrected = match &mut climb {
            Some(climb) => corrector.climb(climb, &data, *stretch),
            None => corrector.correct(&data, *stretch, KnownConditions::ALL),
        };
        let field = match corrected {
            Ok(field) => field,
            Err(Error::Solve { fault, .. }) => {
                run.ends.push(End::at(run.specimen, *stretch, fault));
                break;
            }
            Err(other) => return Err(other),
        };
        run.report_solved("corrector", *stretch);
        corrector = corrector.after(&field.state);
        let start = match springs.displacement(step) {
            Some(_) => Start::Grids,
            None => Start::GridsAlone,
        };
        fields.push(field.state, start, field.multipliers);
        fields.correction.climbs.extend(field.provenance);
    }
    Ok(fields)
}

/// The corrections on nested meshes, up to the last load factor that they reach; none where the study has no such meshes.
fn correct_nested(run: &Run, mesh: &Mesh) -> Result<Vec<NestedCorrection>, Error> {
    let specimen = run.specimen;
    if !specimen.is_nested(2 * mesh.nodes.len()) {
        return Ok(Vec::new());
    }
    let meshes = specimen.outline.nested_meshes();
    let nested = NestedMeshes::new(&specimen.problem, &meshes);
    let mut fields = Vec::new();
    for factor in &specimen.factors {
        match nested.correct(*factor) {
            Ok(field) => fields.push(field),
            // The remaining load factors are reached in load steps, which state where they end.
            Err(Error::Solve { .. }) => break,
            Err(other) => return Err(other),
        }
        run.report_solved("corrector", *factor);
    }
    Ok(fields)
}

/// The corrected field alone, with its multipliers: on nested meshes the lattice's own springs are not needed.
pub fn solve_corrected(run: &mut Run) -> Result<(Solution, Vec<Vec<Multipliers>>), Error> {
    let specimen = run.specimen;
    let mesh = specimen.outline.corrected_mesh();
    let nested = correct_nested(run, &mesh)?;
    if nested.len() == specimen.factors.len() {
        let energy = specimen.corrected_energy(&mesh);
        let model = specimen.on(&mesh, &energy)?;
        let states: Vec<State> = nested.into_iter().map(|field| field.state).collect();
        let multipliers = vec![Vec::new(); states.len()];
        let solution = Solution::new(&model, &specimen.groups(), states);
        return Ok((solution, multipliers));
    }
    let springs = solve_springs(run)?;
    let on_lattice = OnLattice::correct(run, &mesh, springs, nested)?;
    // The correction goes on where the springs end early.
    run.ends.retain(|end| !end.is_of(MASS_SPRING.name));
    Ok((on_lattice.corrected, on_lattice.correction.multipliers))
}

/// The corrections at all load factors.
struct Corrections<'a, 'b> {
    run: &'a mut Run<'b>,
    model: &'a Model<'a>,
    /// The equilibria of the elements by load steps from rest, once they were needed.
    steps: Option<Result<Vec<State>, PathEnd>>,
}

impl Corrections<'_, '_> {
    /// Corrects as many load factors as can be reached after those of nested meshes.
    fn all(mut self, uncorrected: &Solution, mut fields: Fields) -> Fields {
        let mut change = vec![0.0; 2 * self.model.mesh.nodes.len()];
        let onto_mesh = uncorrected.mesh.interpolation_on(self.model.mesh);
        let factors = self.run.specimen.factors.iter().enumerate();
        for (step, factor) in factors.skip(fields.states.len()) {
            let springs = uncorrected.displacement(step);
            let springs = springs.map(|u| onto_mesh.apply(u));
            let springs = springs.as_deref();
            let history = fields.states.last();
            let history = history.map(|before| self.model.remembered(before));
            let history = history.unwrap_or_default();
            let (factor, history) = (*factor, &*history);
            let stage = Stage { factor, history };
            match self.at(step, stage, springs, &change) {
                Ok(((state, multipliers), start)) => {
                    self.run.report_solved("corrector", factor);
                    if let Some(data) = springs {
                        change = difference(&state.displacement, data);
                    }
                    fields.push(state, start, multipliers);
                }
                Err(end) => {
                    self.run.ends.push(*end);
                    break;
                }
            }
        }
        fields
    }

    /// Corrects the springs' field at a load factor. Where there is none, or the corrector does not converge from it, the equilibrium is reached
    /// in load steps first.
    fn at(
        &mut self,
        step: usize,
        stage: Stage<'_>,
        springs: Option<&[f64]>,
        change: &[f64],
    ) -> Result<(Corrected, Start), Box<End>> {
        if let Some(data) = springs {
            // What the correction has changed at the load factor before is nearly right at this one.
            let near: Vec<f64> = data
                .iter()
                .zip(change)
                .map(|(u, change)| u + change)
                .collect();
            if let Ok(field) = self.correct(data, &near, stage) {
                return Ok((field, Start::Springs));
            }
        }
        let (specimen, model) = (self.run.specimen, self.model);
        let attendance = self.run.progress.along(&|_| ());
        let steps = self
            .steps
            .get_or_insert_with(|| model.attended(&specimen.factors, NEWTON, attendance));
        let reached = match steps {
            Ok(states) => &states[step],
            Err(end) => match end.states.get(step) {
                Some(state) => state,
                None => {
                    let end = End::of_path(specimen, model, CORRECTED.key, end);
                    return Err(Box::new(end));
                }
            },
        };
        let (reached, snaps) = (reached.displacement.clone(), reached.convergence.snaps);
        let start = springs.map_or(Start::Alone, |_| Start::LoadSteps);
        let corrected = self.correct(springs.unwrap_or(&reached), &reached, stage);
        let corrected = corrected.map_err(|fault| Box::new(End::at(specimen, stage.factor, fault)));
        corrected.map(|(mut field, multipliers)| {
            field.convergence.snaps = snaps;
            ((field, multipliers), start)
        })
    }

    fn correct(&self, data: &[f64], start: &[f64], stage: Stage) -> Result<Corrected, SolveFault> {
        if data.len() >= LARGE {
            let field = correct_without_multipliers(self.model, start, stage, NEWTON)?;
            return Ok((field, Vec::new()));
        }
        let field = correct(self.model, data, start, stage, CORRECTOR)?;
        Ok((field.state, field.correction.multipliers))
    }
}

/// A corrected field with its multipliers, condition after condition.
type Corrected = (State, Vec<Multipliers>);
