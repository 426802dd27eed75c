//! gelbench for Python: the module `gelbench._core`, below the package `gelbench`.
//!
//! It passes texts and arrays to the library and returns its results, and contains no mechanics. The GIL is free
//! while something is computed: [`running`].

use pyo3::prelude::*;

mod corrector;
mod errors;
mod fields;
mod images;
mod law;
mod markers;
mod material;
mod results;
mod running;
mod solution;
mod study;
mod sweep;
mod tests_to_laws;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<material::MaterialCard>()?;
    module.add_class::<results::Results>()?;
    module.add_class::<solution::Solution>()?;
    module.add_class::<study::GivenMesh>()?;
    module.add_class::<sweep::Sweep>()?;
    module.add_class::<sweep::SweepTable>()?;
    module.add_function(wrap_pyfunction!(corrector::corrected, module)?)?;
    module.add_function(wrap_pyfunction!(images::track, module)?)?;
    module.add_function(wrap_pyfunction!(markers::correct, module)?)?;
    module.add_function(wrap_pyfunction!(material::laws, module)?)?;
    module.add_function(wrap_pyfunction!(material::materials, module)?)?;
    module.add_function(wrap_pyfunction!(study::check, module)?)?;
    module.add_function(wrap_pyfunction!(study::check_sheet, module)?)?;
    module.add_function(wrap_pyfunction!(study::quantity, module)?)?;
    module.add_function(wrap_pyfunction!(study::run, module)?)?;
    module.add_function(wrap_pyfunction!(study::run_sheet, module)?)?;
    module.add_function(wrap_pyfunction!(study::solve_sheet, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::distributions, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::text_of_file, module)?)?;
    module.add_function(wrap_pyfunction!(tests_to_laws::fit, module)?)?;
    module.add_function(wrap_pyfunction!(tests_to_laws::identify, module)?)?;
    Ok(())
}
