//! A web worker of the page: it answers what the page asks.

fn main() {}

#[cfg(target_arch = "wasm32")]
mod worker {
    use gelbench_workbench::logic::background::{Worker, answer};
    use gelbench_workbench::logic::engine::Engine;
    use gelbench_workbench::logic::engine::motion::Mover;
    use gelbench_workbench::logic::field::FieldCorrector;
    use gelbench_workbench::logic::material::Fitter;
    use gelbench_workbench::logic::outputs::Writer;
    use gelbench_workbench::logic::studies::Runner;
    use wasm_bindgen::prelude::*;

    /// Answers a message as the worker of a name; `None` where there is no such worker, or the message is no question for it.
    #[wasm_bindgen]
    pub fn work(worker: &str, question: &[u8]) -> Option<Vec<u8>> {
        match worker {
            Engine::NAME => answer::<Engine>(question),
            Fitter::NAME => answer::<Fitter>(question),
            Runner::NAME => answer::<Runner>(question),
            Mover::NAME => answer::<Mover>(question),
            Writer::NAME => answer::<Writer>(question),
            FieldCorrector::NAME => answer::<FieldCorrector>(question),
            _ => None,
        }
    }
}
