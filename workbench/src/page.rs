//! The page in the browser: it starts the program, on the page or as a worker, and tells what is on the table.

use std::cell::RefCell;
use std::collections::BTreeMap;

use eframe::{WebOptions, WebRunner};
use serde_json::json;
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use crate::logic::background::{Worker, answer};
use crate::logic::engine::Engine;
use crate::logic::engine::motion::Mover;
use crate::logic::field::FieldCorrector;
use crate::logic::material::Fitter;
use crate::logic::outputs::Writer;
use crate::logic::scene::{Model, Scene};
use crate::logic::studies::Runner;
use crate::measure::Measure;
use crate::views::app::Workbench;

thread_local! {
    static TOLD: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Starts the workbench on a canvas: with a study, or without one where it is empty; with `frames` above zero it pulls
/// by itself and times so many frames.
#[wasm_bindgen]
pub async fn start(canvas: HtmlCanvasElement, study: String, frames: usize) -> Result<(), JsValue> {
    let create = move |context: &eframe::CreationContext| {
        let mut bench = Workbench::new(&context.egui_ctx, Scene::default());
        if !study.is_empty() {
            bench.open("link.toml", study.as_bytes());
        }
        if frames > 0 {
            bench = bench.measuring(Measure::of(frames));
        }
        Ok(Box::new(bench) as Box<dyn eframe::App>)
    };
    WebRunner::new()
        .start(canvas, WebOptions::default(), Box::new(create))
        .await
}

/// Answers a message as the worker of a name; nothing where there is no such worker, or the message is none of its questions.
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

/// What is on the table, as JSON: the study, whether everything is solved, the forces in N, the deviations in %.
#[wasm_bindgen]
pub fn told() -> String {
    TOLD.with_borrow(Clone::clone)
}

/// A link that restores a study, which the page's own address becomes too.
pub fn link(study: &str) -> Option<String> {
    let location = web_sys::window()?.location();
    let escaped = String::from(js_sys::encode_uri_component(study));
    location.set_hash(&escaped).ok()?;
    location.href().ok()
}

/// Notes what is on the table, and how often it was drawn.
pub fn tell(bench: &Workbench, drawn: u64) {
    let table = &bench.table;
    let model = |model: Model| {
        let shown = table.shown(model)?;
        let deviation = table.deviation(model);
        Some(json!({
            "force": shown.solved.force,
            "moment": shown.solved.moment,
            "settled": shown.settled,
            "seconds": shown.seconds,
            "departure_percent": deviation.map(|found| found.departure),
        }))
    };
    let [springs, corrected, elements] = Model::ALL.map(model);
    let fits = bench
        .materials()
        .found()
        .and_then(|found| found.as_ref().ok());
    let answer = bench.fields().found().and_then(|found| found.as_ref().ok());
    let frames = answer.and_then(|answer| answer.corrected.as_ref());
    let report = bench
        .studies()
        .found()
        .and_then(|found| found.as_ref().ok());
    let told = json!({
        "drawn": drawn,
        "tab": format!("{:?}", bench.tab()),
        "places": bench.places().iter().map(|(name, at)| (name, [at.x, at.y])).collect::<BTreeMap<_, _>>(),
        "moving": table.moving().map(|moving| [moving.clock(), moving.computed(), moving.duration()]),
        "told": bench.said(),
        "grip_at": bench.grip_at().map(|at| [at.x, at.y]),
        "fits": fits.map(|found| found.fits.iter().map(|fit| (&fit.law, &fit.parameters)).collect::<Vec<_>>()),
        "verdicts": frames.map(|(frames, _)| frames.iter().map(|frame| (&frame.verdict, &frame.forces)).collect::<Vec<_>>()),
        "report": report.map(|report| (&report.title, report.passed, report.parts.len())),
        "study": table.scene().study(),
        "stretch": table.scene().stretch(),
        "settled": table.is_settled(),
        "springs": springs,
        "corrected": corrected,
        "elements": elements,
        "frames": bench.measured(),
    });
    TOLD.with_borrow_mut(|text| *text = told.to_string());
}
