//! Frames of one specimen: corrected one after the other, written and told.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::command::interrupt;
use crate::command::progress::{Progress, tell_files};
use crate::command::terminal::{NOT_EXPLAINED, print, warn};
use crate::error::Error;
use crate::estimation::{Answer, FieldEstimate};
use crate::markers::Frame;
use crate::output::{self, ResultFolder};
use crate::results::Results;
use crate::studies::markers::written::{self, FrameFiles, SERIES, played};
use crate::studies::markers::{ComparedFrames, MarkerStudy};
use crate::studies::pictures::Pictures;

/// The exit code of an answer, and of whether all that is required is met.
pub fn exit_code(answer: Answer, passed: bool) -> u8 {
    match answer {
        Answer::NotExplained => NOT_EXPLAINED,
        Answer::Undecided => 1,
        _ => u8::from(!passed),
    }
}

/// What a correction is called, and what tells it from others.
pub struct Told {
    pub name: String,
    pub text: String,
    pub identity: String,
    pub pictures: Pictures,
}

/// Corrects all frames of a field, writes into a folder, and prints.
pub fn correct(
    field: &mut MarkerStudy,
    told: Told,
    inputs: &[PathBuf],
    folder: &Path,
) -> Result<(Vec<FieldEstimate>, Results), Error> {
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    let mut results_folder = ResultFolder::resume(folder, "correct", &inputs, &told.identity)?;
    interrupt::guard(&results_folder);
    warn(results_folder.replaces().as_slice());
    let progress = Progress::of(field.series.frames.len() as u64);
    let start = Instant::now();
    let (estimates, failed) = estimates(field, &mut results_folder, &progress)?;
    field.leave_out(failed)?;
    for series in SERIES {
        let collection = output::vtk::collection(&played(field, series));
        results_folder.add(&format!("vtk/{series}.pvd"), &collection)?;
    }
    results_folder.add("vtk/view.py", output::vtk::VIEW.as_bytes())?;
    let seconds = start.elapsed().as_secs_f64();
    progress.tell("files");
    let results = written::results_with(
        &told.pictures,
        field,
        &estimates,
        told.name,
        told.text,
        seconds,
    );
    let warnings = output::write(&results, true, &mut results_folder)?;
    drop(progress);
    warn(&warnings);
    finish(results_folder, &results)?;
    Ok((estimates, results))
}

/// Moves the files of results into their folder, and prints what was found.
pub fn finish(folder: ResultFolder, results: &Results) -> Result<(), Error> {
    let path = folder.path().to_owned();
    let files = folder.finish()?;
    tell_files(&files);
    print(&format!(
        "{}{} files in {}\n",
        results.outcome.summary,
        files.len(),
        path.display()
    ))
}

/// The estimates of frames, and the numbers of those that could not be corrected with the reasons.
type Estimates = (Vec<FieldEstimate>, Vec<(usize, Error)>);

/// Corrects frame after frame and writes each as soon as the one after it is known; what a run of the same identity has done
/// is not done again.
fn estimates(
    field: &MarkerStudy,
    folder: &mut ResultFolder,
    progress: &Progress,
) -> Result<Estimates, Error> {
    let (mut compared, mut failed) = (ComparedFrames::default(), Vec::new());
    let mut was_kept = false;
    for frame in &field.series.frames {
        progress.tell(&format!("frame {}", frame.number));
        let kept = folder.kept(&part(frame));
        let is_kept = kept.is_some();
        let found = kept.map_or_else(|| field.estimate_frame(frame), Ok);
        progress.advance();
        let estimate = match found {
            Ok(estimate) => estimate,
            Err(fault) => {
                failed.push((frame.number, fault));
                continue;
            }
        };
        let settled = compared.push(frame, estimate);
        if let Some((before, estimate)) = settled.filter(|_| !was_kept) {
            write(field, before, estimate, folder)?;
        }
        was_kept = is_kept;
    }
    if let Some((last, estimate)) = compared.last().filter(|_| !was_kept) {
        write(field, last, estimate, folder)?;
    }
    Ok((compared.into_estimates(), failed))
}

/// The name under which a frame is kept.
fn part(frame: &Frame) -> String {
    frame.number.to_string()
}

fn write(
    field: &MarkerStudy,
    frame: &Frame,
    estimate: &FieldEstimate,
    folder: &mut ResultFolder,
) -> Result<(), Error> {
    let files = FrameFiles::new(field, frame, estimate);
    output::write_frame(folder, &files.grids, &files.tables)?;
    folder.keep(&part(frame), estimate)
}
