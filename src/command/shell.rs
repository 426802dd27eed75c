//! `gelbench completions` and `gelbench man`: the command's completions for shells, and its manual pages.

use std::path::Path;

use clap::Command;
use clap_complete::Shell;

use super::terminal::{Outcome, print, print_data, save};
use gelbench_base::error::Error;

/// Prints the completions of a shell.
pub fn completions(shell: Shell, command: &mut Command) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(shell, command, "gelbench", &mut script);
    print_data(&String::from_utf8_lossy(&script))?;
    Ok(0)
}

/// Writes a page of the manual for the command and for each of its parts.
pub fn manual(folder: &Path, command: &mut Command) -> Outcome {
    command.build();
    let written = pages(command, folder)?;
    print(&format!("{written} pages in {}\n", folder.display()))?;
    Ok(0)
}

fn pages(command: &Command, folder: &Path) -> Result<usize, Error> {
    let mut page = Vec::new();
    let name = command.get_display_name().unwrap_or(command.get_name());
    let target = folder.join(format!("{name}.1"));
    let manual = clap_mangen::Man::new(command.clone());
    manual
        .render(&mut page)
        .map_err(|cause| Error::write(&target, cause))?;
    save(&target, &page)?;
    let parts = command.get_subcommands();
    let mut parts = parts.filter(|part| part.get_name() != "help");
    parts.try_fold(1, |written, part| Ok(written + pages(part, folder)?))
}
