//! Pictures and VTK files of a specimen.

use super::{Models, Specimen};
use crate::output::picture::Scale;
use crate::output::{self, vtk};
use crate::results::Figure;

fn sizes(u: &[f64]) -> Vec<f64> {
    u.chunks_exact(2).map(|u| u[0].hypot(u[1])).collect()
}

/// The largest load factor that most can be shown of: both corrected field and finite elements, or any model.
fn shown(models: &Models) -> Option<usize> {
    let corrected = models.on_lattice.corrected.reached();
    let both = models.reference.reached().min(corrected);
    let shown = if both > 0 { both } else { models.reached() };
    shown.checked_sub(1)
}

/// Pictures of the largest load factor of which most can be shown.
pub fn figures(specimen: &Specimen, models: &Models, expected: &[Vec<f64>]) -> Vec<Figure> {
    let lattice = &models.on_lattice.springs.mesh;
    let name = |what: &str| format!("{}_{what}.png", specimen.name);
    let cells = output::mesh_picture("Lattice", lattice);
    let mesh = Figure::new(&name("mesh"), "The cells of the lattice.", cells);
    let Some(step) = shown(models) else {
        return vec![mesh];
    };
    let at = format!("load factor {}", specimen.factors[step]);
    let fields = models
        .named()
        .into_iter()
        .filter_map(|(name, _, mesh, solved)| {
            let u = &*solved.states.get(step)?.displacement;
            Some((name, mesh, u))
        });
    let fields: Vec<_> = fields.collect();
    let displacements = fields
        .iter()
        .map(|(name, mesh, u)| (*name, *mesh, *u, sizes(u)));
    let mut figures = vec![Figure {
        name: name("displacement"),
        caption: format!("Displacement at {at}, on one colour scale."),
        png: output::field_figure(
            &format!("Displacement at {at}"),
            "displacement [mm]",
            Scale::Linear,
            &displacements.collect::<Vec<_>>(),
        ),
    }];
    if let Some(expected) = expected.get(step) {
        let on_lattice = fields
            .iter()
            .filter(|(_, mesh, _)| std::ptr::eq(*mesh, lattice));
        let distances = on_lattice.map(|(name, mesh, u)| {
            let pairs = u.iter().zip(expected);
            let distance = sizes(&pairs.map(|(u, v)| u - v).collect::<Vec<_>>());
            (*name, *mesh, *u, distance)
        });
        figures.push(Figure {
            name: name("error"),
            caption: format!("Distance to the finite elements at {at}."),
            png: output::field_figure(
                &format!("Distance to the finite elements at {at}"),
                "distance [mm]",
                Scale::Logarithmic,
                &distances.collect::<Vec<_>>(),
            ),
        });
    }
    figures.push(mesh);
    figures.extend(estimated_error(models, step, &at).map(|png| Figure {
        name: name("estimated_error"),
        caption: format!(
            "Estimated error of every finite element at {at}, in % of the solution's energy norm."
        ),
        png,
    }));
    figures
}

fn estimated_error(models: &Models, step: usize, at: &str) -> Option<Vec<u8>> {
    let reference = &models.reference;
    let estimate = reference.estimates.get(step)?.as_ref()?;
    Some(output::cell_figure(
        (&format!("Estimated error at {at}"), "error of a cell [%]"),
        Scale::Logarithmic,
        &reference.mesh,
        &reference.solved.states.get(step)?.displacement,
        &estimate.energy.cell_percents(),
    ))
}

/// A series of VTK files for each model, as far as it goes; `expected` are the finite elements' displacements at the
/// lattice's nodes.
pub fn files(
    specimen: &Specimen,
    models: &Models,
    expected: &[Vec<f64>],
) -> Vec<(String, Vec<u8>)> {
    let (on_lattice, reference) = (&models.on_lattice, &models.reference);
    let sheet = specimen.sheet();
    let lattice = &on_lattice.springs.mesh;
    let title = &specimen.name;
    let mut files = Vec::new();
    let mut series = |name: &str, reached: usize, file: &dyn Fn(usize) -> Vec<u8>| {
        if reached == 0 {
            return;
        }
        let steps = specimen.factors.iter().take(reached).enumerate();
        let named: Vec<(f64, String)> = steps
            .map(|(step, factor)| (*factor, format!("{name}_{:03}.vtu", step + 1)))
            .collect();
        for (step, (_, file_name)) in named.iter().enumerate() {
            files.push((file_name.clone(), file(step)));
        }
        files.push((format!("{name}.pvd"), vtk::collection(&named)));
    };
    let (uncorrected, corrected) = (&on_lattice.uncorrected, &on_lattice.corrected);
    for (name, model) in [("mass_spring", uncorrected), ("corrected", corrected)] {
        series(name, model.reached(), &|step| {
            let u = &model.states[step].displacement;
            let expected = expected.get(step).map(Vec::as_slice);
            vtk::field_file(title, &sheet, lattice, u, expected)
        });
    }
    series("springs", uncorrected.reached(), &|step| {
        let u = &uncorrected.states[step].displacement;
        vtk::springs_file(title, &on_lattice.springs, u)
    });
    series("finite_element", reference.reached(), &|step| {
        let u = &reference.solved.states[step].displacement;
        match &reference.estimates[step] {
            Some(estimate) => {
                vtk::finite_element_file(title, &sheet, &reference.mesh, u, &estimate.energy)
            }
            None => vtk::field_file(title, &sheet, &reference.mesh, u, None),
        }
    });
    files
}
