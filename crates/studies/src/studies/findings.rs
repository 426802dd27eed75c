//! Warnings about the states of a sheet: one list of rules for equilibria, single models and motions.

use nalgebra::Vector4;

use super::ModelKind;
use super::regions::quoted;
use super::series::{ModelSeries, ModelState};
use super::specimen::forces;
use super::specimen::problem::Specimen;
use super::specimen::results::models::Models;
use crate::mass_spring;
use crate::material::Card;
use crate::material::sheet::Kinematics;
use crate::material::stability::is_stable;
use crate::mesh::Mesh;
use crate::problem::BoundaryProblem;
use crate::results::wrinkling::{self, Wrinkling};
use crate::results::{Finding, Found, Stretches, locking, small_strain};
use crate::solve::State;
use crate::units::number;

/// The models of a sheet that the rules examine.
#[derive(Clone, Copy)]
pub struct Examined<'a> {
    /// The sheet.
    pub specimen: &'a Specimen,
    /// Their states, those nearest to the truth last.
    pub series: &'a [ModelSeries<'a>],
    /// The equilibria of all models; `None` of a motion, and of a single model.
    pub models: Option<&'a Models>,
    /// Whether a lattice is among them whose springs follow the material's curve.
    pub has_springs: bool,
    /// Whether they are the instants of a motion.
    pub is_motion: bool,
}

/// A rule by its name.
type Rule = (&'static str, fn(Examined) -> Option<Found>);

/// The rules by their names, in the order of their findings.
const RULES: [Rule; 14] = [
    ("lattice-poisson-ratio", lattice),
    ("locking", locking_cells),
    ("relaxation-left-out", relaxation),
    ("idle-loads", idle_loads),
    ("loads-on-points", loads_on_points),
    ("moved-points", moved_points),
    ("several-equilibria", several),
    ("overlap", overlap),
    ("wrinkling", compression),
    ("large-strains", large_strains),
    ("beyond-card", beyond_card),
    ("unstable-material", unstable),
    ("unbalanced-forces", unbalanced),
    ("unjudged-moment", unjudged_moment),
];

/// All findings.
pub fn findings(examined: Examined) -> Vec<Finding> {
    let rules = RULES.iter();
    rules
        .filter_map(|(name, rule)| Some(Finding::warning(name, rule(examined)?)))
        .collect()
}

/// The findings about one equilibrium of finite elements that was found outside of a study; `at` is its load factor or stretch.
pub fn findings_of_state(
    specimen: &Specimen,
    (mesh, displacement): (&Mesh, &[f64]),
    at: f64,
) -> Vec<Finding> {
    let state = ModelState {
        at,
        displacement,
        ..ModelState::default()
    };
    let series = ModelSeries {
        kind: ModelKind::FiniteElement,
        mesh,
        states: vec![state],
    };
    findings(Examined {
        specimen,
        series: &[series],
        models: None,
        has_springs: true,
        is_motion: false,
    })
}

/// A finding without a remedy.
fn without_remedy(message: String) -> Found {
    (message, String::new())
}

impl<'a> Examined<'a> {
    /// The model that is nearest to the truth.
    fn best(&self) -> Option<&'a ModelSeries<'a>> {
        let mut all = self.series.iter().rev();
        all.find(|model| !model.states.is_empty())
    }

    /// The findings of a rule in the cells of each card in the best model's mesh; of several cards, with the names of their regions.
    fn of_cards(&self, rule: impl Fn(&Card, &[usize]) -> Option<Found>) -> Option<Found> {
        self.specimen.cards().in_turn(self.best()?.mesh, rule)
    }

    /// The study's problem and the best model's mesh; `None` in a motion.
    fn problem(&self) -> Option<(&'a BoundaryProblem, &'a Mesh)> {
        let problem = (&self.specimen.problem, self.best()?.mesh);
        (!self.is_motion).then_some(problem)
    }

    /// A description of a load or an instant.
    fn load(&self, at: f64) -> String {
        if self.is_motion {
            format!("{} s", number(at))
        } else {
            self.specimen.along.describe(at)
        }
    }

    /// The first state of the best model in which something is found, with its load.
    fn first<T>(
        &self,
        find: impl Fn(&ModelSeries, &ModelState) -> Option<T>,
    ) -> Option<(T, String)> {
        let model = self.best()?;
        let mut states = model.states.iter();
        states.find_map(|state| Some((find(model, state)?, self.load(state.at))))
    }
}

/// A lattice of another ν than the sheet's.
fn lattice(examined: Examined) -> Option<Found> {
    examined.of_cards(|card, _| {
        let warning = match examined.specimen.grids() {
            _ if !examined.has_springs => None,
            Some(grids) if grids.lattice.area_term => None,
            Some(_) => mass_spring::warning_of_plate(&*card.law),
            None => mass_spring::warning(&*card.law),
        };
        warning.map(without_remedy)
    })
}

/// Corrected field and finite elements whose cells lock.
fn locking_cells(examined: Examined) -> Option<Found> {
    const SCHEME: &str = "Take the scheme \"biquadratic\" for the corrected field";
    let grids = examined.specimen.grids();
    let scheme = grids.filter(|_| !examined.is_motion);
    let scheme = scheme.map(|grids| (grids.correction.scheme.side() == 1, SCHEME));
    let judged = |model: &ModelSeries| match (model.kind, scheme) {
        (ModelKind::MassSpring, _) => (false, ""),
        (ModelKind::Corrected, Some(scheme)) => scheme,
        _ => (locking::locks(model.mesh), locking::SECOND_DEGREE),
    };
    let models = examined.series.iter();
    let models = models.filter(|model| !model.states.is_empty());
    let locking = models.filter_map(|model| {
        let (locks, remedy) = judged(model);
        locks.then_some((model.kind.style().name, remedy))
    });
    let (names, mut remedies): (Vec<&str>, Vec<&str>) = locking.unzip();
    remedies.dedup();
    let models = match &names[..] {
        [] => return None,
        [one] => format!("{one} is"),
        several => format!("{} are", several.join(" and ")),
    };
    examined.of_cards(|card, _| {
        let reason = locking::reason(&*card.law)?;
        Some((format!("{reason}: {models} too stiff"), remedies.join("; ")))
    })
}

/// A card that relaxes, of which equilibria have the long times alone.
fn relaxation(examined: Examined) -> Option<Found> {
    if examined.is_motion {
        return None;
    }
    examined.of_cards(|card, _| {
        let message = card.viscosity.left_out()?;
        Some(without_remedy(format!("{message}.")))
    })
}

/// Loads that supports take up at once.
fn idle_loads(examined: Examined) -> Option<Found> {
    let (problem, mesh) = examined.problem()?;
    let idle = problem.idle_loads(mesh).unwrap_or_default();
    let message = || {
        format!(
            "the load on {} has no effect on the field: supports fix these nodes in its direction and carry it directly",
            idle.join(", ")
        )
    };
    let remedy = "Support another group, or take a support that leaves the load's direction free, such as a grip with a force.";
    (!idle.is_empty()).then(|| (message(), remedy.to_owned()))
}

/// Forces on single points, under which displacements have no limit.
fn loads_on_points(examined: Examined) -> Option<Found> {
    let (problem, mesh) = examined.problem()?;
    let named = quoted(&problem.forces_on_points(mesh))?;
    let message = format!(
        "the force on {named} acts on single points, where displacement and stress grow without limit as the mesh is refined: their values and own \
         errors there are meaningless"
    );
    Some((
        message,
        "Put it on edges, on a line or on an area.".to_owned(),
    ))
}

/// Single points that supports move, which takes no force in a sheet.
fn moved_points(examined: Examined) -> Option<Found> {
    let (problem, mesh) = examined.problem()?;
    let named = quoted(&problem.moved_points(mesh))?;
    let message = format!(
        "the support on {named} moves single points: as the mesh is refined, their force tends to zero, and the field with it, so that force, field \
         and own errors are meaningless"
    );
    Some((message, "Move edges, a line or an area.".to_owned()))
}

/// States that may be one of several: reached through tangents that are not positive definite, or by a snap to another branch.
fn several(examined: Examined) -> Option<Found> {
    let models = examined.models?;
    let all = models.all();
    let solutions = all.map(|(kind, solution)| (kind.style().name, solution));
    // Finer meshes begin with the states of coarser ones.
    let coarser = models.reference.coarser.iter();
    let solutions = solutions
        .into_iter()
        .chain(coarser.map(|solution| ("coarser finite elements", solution)));
    let is_one_of_several =
        |state: &&State| state.convergence.shifted_steps + state.convergence.snaps > 0;
    let states = solutions.flat_map(|(name, solution)| {
        let states = solution.states.iter().filter(is_one_of_several);
        states.map(move |state| format!("{name} at {}", examined.load(state.factor)))
    });
    let states: Vec<String> = states.collect();
    (!states.is_empty()).then(|| {
        without_remedy(format!(
            "the tangent was not positive definite, or the body snapped through, on the way to {}: there are several equilibria, and which one is \
             found depends on mesh and load steps",
            states.join(", ")
        ))
    })
}

/// The first state in which the sheet passes through itself.
fn overlap(examined: Examined) -> Option<Found> {
    /// How deep in a cell a node of the boundary must lie, in natural coordinates.
    const DEEP: f64 = 0.05;
    examined.models?;
    let ([x, y], load) =
        examined.first(|model, state| model.mesh.overlap(state.displacement, DEEP))?;
    Some(without_remedy(format!(
        "the sheet passes through itself at {load}, near ({}, {}) mm at rest: parts of the boundary have no contact with each other, and the \
         state is impossible where they overlap",
        number(x),
        number(y)
    )))
}

/// Compression by which a sheet wrinkles or buckles.
fn compression(examined: Examined) -> Option<Found> {
    let (model, sheet) = (examined.best()?, examined.specimen.sheet());
    let states = model.states.iter().map(|state| {
        let wrinkling = Wrinkling::new(state.strained(sheet), model.mesh, state.displacement);
        (examined.load(state.at), wrinkling)
    });
    wrinkling::warning(states).map(without_remedy)
}

/// The first state with strains or rotations that are too large for the law.
fn large_strains(examined: Examined) -> Option<Found> {
    examined.of_cards(|card, cells| {
        let reason = |model: &ModelSeries, state: &ModelState| {
            small_strain::reason(&*card.law, (model.mesh, cells), state.displacement)
        };
        let (reason, load) = examined.first(reason)?;
        let remedy = small_strain::LARGE_STRAINS.to_owned();
        Some((format!("{reason} at {load}"), remedy))
    })
}

/// The worst stretches beyond the range of the card.
fn beyond_card(examined: Examined) -> Option<Found> {
    let model = examined.best()?;
    examined.of_cards(|card, cells| {
        let states = model.states.iter();
        let stretches = states.map(|state| {
            let stretches = Stretches::new(card, (model.mesh, cells), state.displacement);
            (state.at, stretches)
        });
        let (at, worst) = stretches.max_by(|(_, a), (_, b)| a.share.total_cmp(&b.share))?;
        let reason = worst.reason(card, &format!(" at {}", examined.load(at)))?;
        Some(without_remedy(format!("{reason}.")))
    })
}

/// The first state whose material is not stable in the middle of some cell.
fn unstable(examined: Examined) -> Option<Found> {
    examined.of_cards(|card, cells| {
        let unstable_cell = |model: &ModelSeries, state: &ModelState| {
            let mesh = model.mesh;
            let is_unstable = |cell: &&usize| {
                let centre = mesh.shape(**cell).centre();
                let gradient = mesh.gradient_at(state.displacement, **cell, centre);
                let kinematics = Kinematics::new(&Vector4::from(gradient));
                !kinematics.is_ok_and(|kinematics| is_stable(&*card.law, &kinematics))
            };
            let cell = cells.iter().find(is_unstable)?;
            Some((mesh.describe_cell(*cell), model.kind.style().name))
        };
        let ((cell, model), load) = examined.first(unstable_cell)?;
        Some(without_remedy(format!(
            "the material of the card `{}` is not stable (Drucker) in {cell} of the {model} at {load}.",
            card.name
        )))
    })
}

/// Forces or moments that do not balance.
fn unbalanced(examined: Examined) -> Option<Found> {
    /// The largest resultant, over the largest force, that is not worth a warning.
    const UNBALANCED: f64 = 1e-5;
    let balances = forces::balances(examined.specimen, examined.models?);
    let worst = forces::worst_balance(&balances)?;
    (worst.is_nan() || worst > UNBALANCED).then(|| {
        let balance = forces::balance_words(&balances);
        without_remedy(format!("forces or moments do not balance. {balance}"))
    })
}

/// Moments that no requirement judges.
fn unjudged_moment(examined: Examined) -> Option<Found> {
    forces::unjudged_moment(examined.specimen, examined.models?).map(without_remedy)
}
