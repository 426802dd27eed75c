//! What a bench must show: lines that pass or fail, each with what was measured.

/// Lines with pass or fail.
#[derive(Default)]
pub struct Lines(Vec<(bool, String)>);

impl Lines {
    pub fn put(&mut self, pass: bool, text: String) {
        self.0.push((pass, text));
    }

    /// Prints all lines; the number of those that fail.
    pub fn print(&self) -> usize {
        println!();
        for (pass, text) in &self.0 {
            println!("{} {text}", if *pass { "pass" } else { "FAIL" });
        }
        self.0.iter().filter(|(pass, _)| !pass).count()
    }
}

/// What ends a bench: 0 when all aims are met, 1 when one is not, and the error's own code.
pub fn ended(missed: Result<usize, gelbench::error::Error>) -> std::process::ExitCode {
    use std::process::ExitCode;
    match missed {
        Ok(0) => ExitCode::SUCCESS,
        Ok(missed) => {
            eprintln!("{missed} aims are not met: see the lines that say FAIL");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// The least-squares slope of ln y over ln x.
pub fn exponent(points: &[[f64; 2]]) -> f64 {
    let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let mean =
        |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let covariance: f64 = points
        .iter()
        .map(|point| (point[0] - x) * (point[1] - y))
        .sum();
    let variance: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
    covariance / variance
}

/// Of some runs, as time and error, those that no other is both quicker and more accurate than, from the most accurate on.
pub fn best<T>(runs: impl Iterator<Item = T>, time_and_error: impl Fn(&T) -> [f64; 2]) -> Vec<T> {
    let mut selected: Vec<T> = runs.collect();
    selected.sort_by(|a, b| time_and_error(a)[1].total_cmp(&time_and_error(b)[1]));
    let mut quickest = f64::INFINITY;
    selected.retain(|run| {
        let seconds = time_and_error(run)[0];
        let quicker = seconds < quickest;
        quickest = quickest.min(seconds);
        quicker
    });
    selected
}
