//! The VTK files of a plate.

use super::results::Results;
use super::study::Study;
use crate::corrector::Multipliers;
use crate::corrector::plate::{EQUILIBRIUM, FREE_EDGES, GRIPS};
use crate::output::vtk::{
    Array, Sheet, arrays_file, collection, field_file, finite_element_file, springs_file,
};

/// All VTK files of a run: name and content, one after the other; those of a model as far as it has solutions.
pub fn files(study: &Study, results: &Results) -> impl Iterator<Item = (String, Vec<u8>)> {
    let model = move |model: Model| {
        let steps = 0..study.problem.stretches.len();
        let steps: Vec<usize> = steps.filter(|step| model.has(results, *step)).collect();
        let stretch = |step: &usize| (study.problem.stretches[*step], model.file_name(*step));
        let named: Vec<_> = steps.iter().map(stretch).collect();
        let collection =
            (!named.is_empty()).then(|| (format!("{}.pvd", model.name()), collection(&named)));
        let grids = steps.into_iter().filter_map(move |step| {
            let file = model.file(study, results, step)?;
            Some((model.file_name(step), file))
        });
        grids.chain(collection)
    };
    Model::ALL.into_iter().flat_map(model)
}

#[derive(Clone, Copy)]
enum Model {
    MassSpring,
    Springs,
    Corrected,
    FiniteElement,
}

impl Model {
    const ALL: [Self; 4] = [
        Self::MassSpring,
        Self::Springs,
        Self::Corrected,
        Self::FiniteElement,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::MassSpring => "mass_spring",
            Self::Springs => "springs",
            Self::Corrected => "corrected",
            Self::FiniteElement => "finite_element",
        }
    }

    fn file_name(self, step: usize) -> String {
        format!("{}_{:03}.vtu", self.name(), step + 1)
    }

    fn has(self, results: &Results, step: usize) -> bool {
        let [springs, corrected, elements] = results.models(step).map(|model| model.is_some());
        match self {
            Self::MassSpring | Self::Springs => springs,
            Self::Corrected => corrected,
            Self::FiniteElement => elements,
        }
    }

    /// The file at a stretch at which the model has a solution.
    fn file(self, study: &Study, results: &Results, step: usize) -> Option<Vec<u8>> {
        let title = &study.title;
        let sheet = &Sheet {
            law: &*study.problem.law,
            thickness: study.problem.thickness,
        };
        let lattice = &results.springs.mesh;
        let reference = results.reference_on_lattice.get(step).map(Vec::as_slice);
        let [springs, _, elements] = results.models(step);
        Some(match self {
            Self::MassSpring => {
                field_file(title, sheet, lattice, &springs?.displacement, reference)
            }
            Self::Corrected => {
                let state = results.corrected[step].as_ref()?;
                let u = &state.solution.displacement;
                let multipliers = state.multipliers.iter();
                let multipliers = multipliers.filter_map(|group| multiplier_array(group, u.len()));
                let difference = reference.map(|reference| Array::difference(u, reference));
                let arrays = difference.into_iter().chain(multipliers).collect();
                arrays_file(title, sheet, lattice, u, arrays, Vec::new())
            }
            Self::FiniteElement => {
                let mesh = &results.finest().model.mesh;
                let u = &elements?.displacement;
                match &results.estimates[step] {
                    Some(estimate) => finite_element_file(title, sheet, mesh, u, &estimate.energy),
                    None => field_file(title, sheet, mesh, u, None),
                }
            }
            Self::Springs => springs_file(title, &results.springs, &springs?.displacement),
        })
    }
}

/// The multipliers of a condition at the nodes; zero where the condition does not hold.
fn multiplier_array(group: &Multipliers, size: usize) -> Option<Array> {
    let name = match group.name.as_str() {
        EQUILIBRIUM => "multiplier_zeta_equilibrium_mm2_per_N",
        GRIPS => "multiplier_eta_grips_mm",
        FREE_EDGES => "multiplier_eta_free_edges_mm2_per_N",
        _ => return None,
    };
    let mut values = vec![0.0; size];
    for (unknown, value) in group.unknowns.iter().flatten().zip(&group.values) {
        values[*unknown] = *value;
    }
    Some(Array {
        name,
        values,
        components: 2,
    })
}
