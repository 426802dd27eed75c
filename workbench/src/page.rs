//! The page in the browser: its address, and what is on the table.

use std::cell::RefCell;
use std::collections::BTreeMap;

use eframe::egui::{Context, Theme};
use serde_json::json;

use crate::logic::scene::Model;
use crate::views::app::Workbench;

thread_local! {
    static STATE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// What is on the table, as JSON: the study, whether everything is solved, the forces in N, the deviations in %.
pub fn state() -> String {
    STATE.with_borrow(Clone::clone)
}

/// A link that restores a study, which the page's own address becomes too.
pub fn link(study: &str) -> Option<String> {
    let location = web_sys::window()?.location();
    let escaped = String::from(js_sys::encode_uri_component(study));
    location.set_hash(&escaped).ok()?;
    location.href().ok()
}

/// Notes what is on the table, and how it is drawn.
pub fn publish(bench: &Workbench, context: &Context) {
    let room = context.content_rect();
    let table = &bench.table;
    let model = |model: Model| {
        let shown = table.shown(model)?;
        let deviation = table.deviation(model);
        Some(json!({
            "force": shown.solved.force,
            "moment": shown.solved.moment,
            "settled": shown.settled,
            "seconds": shown.seconds,
            "departure_percent": deviation.map(|deviation| deviation.departure),
        }))
    };
    let [springs, corrected, elements] = Model::ALL.map(model);
    let fits = bench
        .materials
        .ranking()
        .and_then(|ranking| ranking.as_ref().ok());
    let answer = bench
        .fields
        .answer()
        .and_then(|answer| answer.as_ref().ok());
    let frames = answer.and_then(|answer| answer.corrected.as_ref());
    let report = bench
        .studies
        .report()
        .and_then(|report| report.as_ref().ok());
    let state = json!({
        "drawn": context.cumulative_pass_nr(),
        "size": [room.width(), room.height()],
        "pixels_per_point": context.pixels_per_point(),
        "dark": context.theme() == Theme::Dark,
        "tab": format!("{:?}", bench.tab),
        "places": bench.positions.iter().map(|(name, at)| (name, [at.x, at.y])).collect::<BTreeMap<_, _>>(),
        "moving": table.moving().map(|moving| [moving.clock(), moving.computed(), moving.duration]),
        "told": bench.message,
        "grip_at": bench.grip_at.map(|at| [at.x, at.y]),
        "fits": fits.map(|ranking| ranking.fits.iter().map(|fit| (&fit.law, &fit.parameters)).collect::<Vec<_>>()),
        "verdicts": frames.map(|(frames, _)| frames.iter().map(|frame| (&frame.verdict, &frame.forces)).collect::<Vec<_>>()),
        "report": report.map(|report| (&report.title, report.passed, report.blocks.len())),
        "study": table.scene().study(),
        "stretch": table.scene().stretch(),
        "settled": table.is_settled(),
        "springs": springs,
        "corrected": corrected,
        "elements": elements,
        "frames": bench.measured(),
    });
    STATE.with_borrow_mut(|text| *text = state.to_string());
}
