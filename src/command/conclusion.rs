//! The end of a command: its message, the warnings about its results, and the exit code.

use std::path::Path;

use super::progress::report_files;
use super::terminal;
use super::terminal::{complain_of_end, print, print_report, warn_texts};
use gelbench_base::error::Error;
use gelbench_report::output::ResultFolder;
use gelbench_report::results::{Check, End, Outcome, Results};

/// The exit code of a study of which a model has no solution.
const NO_SOLUTION: u8 = 3;

/// Prints the summary of the results, then warnings, and decides on the exit code.
pub fn conclude(results: &[Results], words: &str) -> terminal::Outcome {
    print(words)?;
    let outcomes = || results.iter().map(|results| &results.outcome);
    warn_texts(outcomes().flat_map(Outcome::warnings));
    let ends = outcomes().filter(|outcome| !outcome.checks.iter().any(Check::is_end));
    let ends: Vec<&End> = ends.flat_map(|outcome| &outcome.ends).collect();
    ends.iter().for_each(|end| complain_of_end(end));
    if let Some(end) = ends.first() {
        return Ok(end.exit_code);
    }
    if outcomes().any(|outcome| outcome.checks.iter().any(Check::is_end)) {
        return Ok(NO_SOLUTION);
    }
    Ok(u8::from(!results.iter().all(Results::passed)))
}

/// Moves all files into their folder, prints the report and the summary of the results, and decides on the exit code.
pub fn finish(folder: ResultFolder, results: Results) -> terminal::Outcome {
    let words = moved_into_place(folder, &results)?;
    print_report(|| results.json())?;
    conclude(&[results], &words)
}

/// Moves all files into their folder; the summary of the results.
pub fn moved_into_place(folder: ResultFolder, results: &Results) -> Result<String, Error> {
    let path = folder.path().to_owned();
    let files = folder.finish()?;
    report_files(&files);
    Ok(printed(results, files.len(), &path))
}

/// The results for a terminal: the headline, where the page is, how far all agree, and where the files are.
fn printed(results: &Results, files: usize, folder: &Path) -> String {
    let all = [
        results.headline(),
        open_page(folder),
        results.agreement(),
        format!("{files} files in {}\n", folder.display()),
    ];
    let parts: Vec<String> = all.into_iter().filter(|part| !part.is_empty()).collect();
    parts.join("\n")
}

/// Where the page of a folder's results is; nothing where it has none.
pub fn open_page(folder: &Path) -> String {
    let page = folder.join("report.html");
    if page.exists() {
        format!("open {}\n", page.display())
    } else {
        String::new()
    }
}
