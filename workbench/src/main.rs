//! The workbench on the desktop: `gelbench-workbench [FILE …] [--frames NUMBER]`; and in the browser, where the page starts it.

#[cfg(target_arch = "wasm32")]
fn main() {}

#[cfg(target_arch = "wasm32")]
mod browser {
    use eframe::{WebOptions, WebRunner};
    use gelbench_workbench::logic::scene::Scene;
    use gelbench_workbench::measure::Measure;
    use gelbench_workbench::page;
    use gelbench_workbench::views::app::Workbench;
    use wasm_bindgen::prelude::*;
    use web_sys::HtmlCanvasElement;

    /// Starts the workbench on a canvas: with a study, or without one where it is empty; with `frames` above zero it pulls
    /// by itself and times so many frames.
    #[wasm_bindgen]
    pub async fn start(
        canvas: HtmlCanvasElement,
        study: String,
        frames: usize,
    ) -> Result<(), JsValue> {
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

    /// What is on the table, as JSON.
    #[wasm_bindgen]
    pub fn told() -> String {
        page::state()
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    desktop::main()
}

#[cfg(not(target_arch = "wasm32"))]
mod desktop {
    use std::path::Path;
    use std::process::ExitCode;

    use eframe::egui::ViewportBuilder;
    use gelbench_workbench::logic::scene::Scene;
    use gelbench_workbench::measure::Measure;
    use gelbench_workbench::views::app::Workbench;
    use gelbench_workbench::views::files::Recent;

    const USAGE: &str = "gelbench-workbench [FILE …] [--frames NUMBER]\n\n\
        Opens the workbench with studies and cards.\n\
        --frames  pulls automatically, times this many frames, and exits";

    #[derive(Default)]
    struct Options {
        files: Vec<String>,
        frames: usize,
    }

    pub fn main() -> ExitCode {
        let options = match read(std::env::args().skip(1)) {
            Ok(options) => options,
            Err(fault) => {
                eprintln!("{fault}\n\n{USAGE}");
                return ExitCode::from(2);
            }
        };
        let window = eframe::NativeOptions {
            viewport: ViewportBuilder::default()
                .with_inner_size([1200.0, 800.0])
                .with_title("gelbench"),
            ..Default::default()
        };
        let run = eframe::run_native(
            "gelbench",
            window,
            Box::new(|context| {
                let mut bench = Workbench::new(&context.egui_ctx, Scene::default());
                bench.remember(Recent::of_user());
                for file in &options.files {
                    bench.open_path(Path::new(file));
                }
                if options.frames > 0 {
                    bench = bench.measuring(Measure::of(options.frames));
                }
                Ok(Box::new(bench))
            }),
        );
        match run {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("the window cannot be opened: {error}");
                ExitCode::FAILURE
            }
        }
    }

    fn read(arguments: impl Iterator<Item = String>) -> Result<Options, String> {
        let mut options = Options::default();
        let mut arguments = arguments;
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--frames" => {
                    let number = arguments.next().and_then(|number| number.parse().ok());
                    options.frames = number.ok_or("--frames needs a number")?;
                }
                option if option.starts_with("--") => {
                    return Err(format!("there is no option {option}"));
                }
                file => options.files.push(file.to_owned()),
            }
        }
        Ok(options)
    }
}
