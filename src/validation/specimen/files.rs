//! Pictures and VTK files of a specimen.

use super::{Models, Specimen};
use crate::output::picture::Scale;
use crate::output::{self, Figure, vtk};

fn sizes(u: &[f64]) -> Vec<f64> {
    u.chunks_exact(2).map(|u| u[0].hypot(u[1])).collect()
}

/// Pictures of the last load factor.
pub fn figures(specimen: &Specimen, models: &Models, expected: &[Vec<f64>]) -> Vec<Figure> {
    let Models {
        reference,
        springs,
        uncorrected,
        corrected,
    } = models;
    let lattice = &springs.mesh;
    let last = specimen.factors.len() - 1;
    let fine = &reference.mesh;
    let [before, after] = [uncorrected, corrected].map(|model| &*model.states[last].displacement);
    let exact = &*reference.solved.states[last].displacement;
    let distance = |u: &[f64]| {
        let pairs = u.iter().zip(&expected[last]);
        sizes(&pairs.map(|(u, v)| u - v).collect::<Vec<_>>())
    };
    let name = |what: &str| format!("{}_{what}.png", specimen.name);
    let at = format!("load factor {}", specimen.factors[last]);
    vec![
        Figure {
            name: name("displacement"),
            caption: format!("Displacement in all three models at {at}, on one colour scale."),
            png: output::field_figure(
                &format!("Displacement at {at}"),
                "displacement [mm]",
                Scale::Linear,
                &[
                    ("mass-spring", lattice, before, sizes(before)),
                    ("corrected", lattice, after, sizes(after)),
                    ("finite elements", fine, exact, sizes(exact)),
                ],
            ),
        },
        Figure {
            name: name("error"),
            caption: format!(
                "Distance to the finite elements at {at}, before and after the correction."
            ),
            png: output::field_figure(
                &format!("Distance to the finite elements at {at}"),
                "distance [mm]",
                Scale::Logarithmic,
                &[
                    ("mass-spring", lattice, before, distance(before)),
                    ("corrected", lattice, after, distance(after)),
                ],
            ),
        },
        Figure {
            name: name("mesh"),
            caption: "The cells of the lattice.".into(),
            png: output::mesh_picture("Lattice", lattice),
        },
        Figure {
            name: name("estimated_error"),
            caption: format!(
                "Estimated error of every finite element at {at}, in % of the solution's energy norm."
            ),
            png: output::cell_figure(
                (&format!("Estimated error at {at}"), "error of a cell [%]"),
                Scale::Logarithmic,
                fine,
                exact,
                &reference.estimates[last].energy.cell_percents(),
            ),
        },
    ]
}

/// A series of VTK files for each model; `expected` are the finite elements' displacements at the lattice's nodes.
pub fn files(
    specimen: &Specimen,
    models: &Models,
    expected: &[Vec<f64>],
) -> Vec<(String, Vec<u8>)> {
    let Models {
        reference,
        springs,
        uncorrected,
        corrected,
    } = models;
    let sheet = specimen.sheet();
    let lattice = &springs.mesh;
    let title = &specimen.name;
    let mut files = Vec::new();
    let mut series = |name: &str, file: &dyn Fn(usize) -> Vec<u8>| {
        let steps = specimen.factors.iter().enumerate();
        let named: Vec<(f64, String)> = steps
            .map(|(step, factor)| (*factor, format!("{name}_{:03}.vtu", step + 1)))
            .collect();
        for (step, (_, file_name)) in named.iter().enumerate() {
            files.push((file_name.clone(), file(step)));
        }
        files.push((format!("{name}.pvd"), vtk::collection(&named)));
    };
    for (name, model) in [("mass_spring", uncorrected), ("corrected", corrected)] {
        series(name, &|step| {
            let u = &model.states[step].displacement;
            vtk::field_file(title, &sheet, lattice, u, Some(&expected[step]))
        });
    }
    series("springs", &|step| {
        vtk::springs_file(title, springs, &uncorrected.states[step].displacement)
    });
    series("finite_element", &|step| {
        let u = &reference.solved.states[step].displacement;
        let error = &reference.estimates[step].energy;
        vtk::finite_element_file(title, &sheet, &reference.mesh, u, error)
    });
    files
}
