//! Frames of one specimen: corrected one after the other, written and summarised.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::command::conclusion::moved_into_place;
use crate::command::interrupt;
use crate::command::progress::Progress;
use crate::command::terminal::{NOT_EXPLAINED, print, warn};
use gelbench_base::error::Error;
use gelbench_estimation::estimation::{Answer, FieldEstimate};
use gelbench_mechanics::markers::Frame;
use gelbench_report::output::{self, ResultFolder};
use gelbench_report::results::Results;
use gelbench_studies::studies::markers::written::{self, FrameFiles, SERIES, played};
use gelbench_studies::studies::markers::{ComparedFrames, MarkerStudy};
use gelbench_studies::studies::pictures::Pictures;

/// One folder of results: what they follow from, and how they are written.
#[derive(Clone)]
pub struct Job {
    pub name: String,
    /// The text of the study, empty where there is none.
    pub text: String,
    pub inputs: Vec<PathBuf>,
    pub folder: PathBuf,
    /// The command line, by which an interrupted run is recognised together with the files that were read.
    pub arguments: String,
    pub pictures: Pictures,
}

/// The exit code of a verdict, and of whether all requirements are met.
pub fn exit_code(answer: Answer, passed: bool) -> u8 {
    match answer {
        Answer::NotExplained => NOT_EXPLAINED,
        Answer::Undecided => 1,
        _ => u8::from(!passed),
    }
}

/// Corrects all frames of a field, writes into the job's folder, and prints.
pub fn correct(field: &mut MarkerStudy, job: Job) -> Result<(Vec<FieldEstimate>, Results), Error> {
    let inputs: Vec<&Path> = job.inputs.iter().map(PathBuf::as_path).collect();
    let identity = interrupt::identity(&job.arguments);
    let mut folder =
        interrupt::guarded(|| ResultFolder::resume(&job.folder, "correct", &inputs, &identity))?;
    warn(folder.replaces().as_slice());
    let progress = Progress::of(field.series.frames.len() as u64);
    let start = Instant::now();
    let (mut estimates, failed) = estimates(field, &mut folder, &progress)?;
    field.conclude(&mut estimates, failed)?;
    for series in SERIES {
        let collection = output::vtk::collection(&played(field, series));
        folder.add(&format!("vtk/{series}.pvd"), &collection)?;
    }
    folder.add("vtk/view.py", output::vtk::VIEW.as_bytes())?;
    let seconds = start.elapsed().as_secs_f64();
    progress.report("files");
    let results = written::results(
        &job.pictures,
        field,
        &estimates,
        job.name,
        job.text,
        seconds,
    );
    drop(progress);
    finish(folder, &results)?;
    Ok((estimates, results))
}

/// Writes results, moves all files into their folder, and prints the summary.
pub fn finish(mut folder: ResultFolder, results: &Results) -> Result<(), Error> {
    warn(&output::write(results, true, &mut folder)?);
    print(&moved_into_place(folder, results)?)
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
    for frames in field.series.frames.chunks(rayon::current_num_threads()) {
        for (frame, is_kept, estimate) in together(field, frames, folder, progress) {
            progress.advance();
            match estimate {
                Ok(estimate) => {
                    let settled = compared.push(frame, estimate);
                    if let Some((before, estimate)) = settled.filter(|_| !was_kept) {
                        write(field, before, estimate, folder)?;
                    }
                    was_kept = is_kept;
                }
                Err(fault) => failed.push((frame.number, fault)),
            }
        }
    }
    if let Some((last, estimate)) = compared.last().filter(|_| !was_kept) {
        write(field, last, estimate, folder)?;
    }
    Ok((compared.into_estimates(), failed))
}

/// A frame, whether a run before has kept its estimate, and the estimate.
type EstimatedFrame<'a> = (&'a Frame, bool, Result<FieldEstimate, Error>);

/// The estimates of some frames, in their order: those that are kept, and the others at the same time.
fn together<'a>(
    field: &MarkerStudy,
    frames: &'a [Frame],
    folder: &mut ResultFolder,
    progress: &Progress,
) -> Vec<EstimatedFrame<'a>> {
    let records = frames
        .iter()
        .map(|frame| folder.kept(&frame.number.to_string()));
    let kept: Vec<Option<FieldEstimate>> = records.collect();
    let pairs = frames.iter().zip(&kept);
    let others: Vec<&Frame> = pairs
        .filter_map(|(frame, kept)| kept.is_none().then_some(frame))
        .collect();
    let numbers: Vec<String> = others
        .iter()
        .map(|frame| frame.number.to_string())
        .collect();
    if !numbers.is_empty() {
        progress.report(&format!("frame {}", numbers.join(", ")));
    }
    let mut estimated = field.estimate_frames(others).into_iter();
    let each = frames.iter().zip(kept).filter_map(|(frame, kept)| {
        let is_kept = kept.is_some();
        let estimate = kept.map(Ok).or_else(|| estimated.next());
        Some((frame, is_kept, estimate?))
    });
    each.collect()
}

fn write(
    field: &MarkerStudy,
    frame: &Frame,
    estimate: &FieldEstimate,
    folder: &mut ResultFolder,
) -> Result<(), Error> {
    let files = FrameFiles::new(field, frame, estimate);
    output::write_frame(folder, &files.grids, &files.tables)?;
    folder.keep(&frame.number.to_string(), estimate)
}
