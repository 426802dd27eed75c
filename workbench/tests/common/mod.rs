//! The workbench without a display.
#![allow(dead_code, reason = "every test uses a part of it")]

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use gelbench_workbench::logic::scene::Scene;
use gelbench_workbench::views::app::Workbench;

/// The workbench in a window, made in its first frame.
pub type Bench = Harness<'static, Option<Workbench>>;

/// A small sheet, which is solved at once.
pub fn small() -> Scene {
    Scene {
        cells: [24, 8],
        ..Scene::default()
    }
}

/// A window of a size in points with a scene on the table.
pub fn window(size: [f32; 2], scene: Scene) -> Bench {
    let mut bench = Harness::builder().with_size(size).build_ui_state(
        move |ui, bench: &mut Option<Workbench>| {
            let begin = || Workbench::new(ui.ctx(), scene.clone());
            bench.get_or_insert_with(begin).show(ui);
        },
        None,
    );
    bench.step();
    bench
}

/// What the window shows.
pub fn state(bench: &Bench) -> &Workbench {
    bench.state().as_ref().expect("a frame was drawn")
}

/// The same, to be changed.
pub fn state_mut(bench: &mut Bench) -> &mut Workbench {
    bench.state_mut().as_mut().expect("a frame was drawn")
}

/// Draws frames until something holds.
pub fn until(bench: &mut Bench, holds: impl Fn(&Workbench) -> bool) {
    let begun = Instant::now();
    while !holds(state(bench)) {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "it does not come about"
        );
        std::thread::sleep(Duration::from_millis(2));
        bench.step();
    }
}
