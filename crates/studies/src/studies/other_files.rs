//! Recognises files that are not studies, and names the command that reads them.

use std::path::Path;

use crate::document::{Section, Table};
use crate::error::Error;

/// Refuses the text of a table, a mesh or a field.
///
/// # Errors
/// [`Error::Input`] with what the file is, and the command that reads it.
pub fn refuse(path: &Path, text: &str) -> Result<(), Error> {
    let name = path.display();
    let start = text.trim_start_matches('\u{feff}').trim_start();
    let meshes = [
        "$MeshFormat",
        "# vtk DataFile",
        "<?xml",
        "<VTKFile",
        "1C",
        "*HEADING",
        "*NODE",
    ];
    if meshes.iter().any(|begin| start.starts_with(begin)) {
        let message = format!("{name} is a mesh or a field on a mesh, not a study");
        let hint = format!(
            "`gelbench correct {name} --material CARD --thickness \"2 mm\"` corrects a field; a study names a mesh with shape = \"mesh\" and file = \"{name}\""
        );
        return Err(Error::input(message, hint));
    }
    let is_statement = |line: &str| !line.starts_with('#') && line.contains('=');
    if text.lines().any(is_statement) {
        return Ok(());
    }
    let name = name.to_string();
    let Ok(table) = Table::parse(&name, text) else {
        return Ok(());
    };
    let message = format!("{name} is a table of numbers, not a study");
    Err(Error::input(message, command_for(&table, &name)))
}

/// The command that reads a table with these columns.
fn command_for(table: &Table, name: &str) -> String {
    let has = |words: &[&str]| {
        let mut columns = table.columns.iter();
        columns.any(|column| words.iter().any(|word| column.name.starts_with(word)))
    };
    let correct = format!("gelbench correct {name} --material CARD --thickness \"2 mm\"");
    let fit = format!("gelbench materials fit {name} --all");
    let identify = format!("gelbench identify {name}");
    if has(&["ux", "u_x", "u", "displacement_x", "disp_x"]) {
        format!("measured displacements are corrected by `{correct}`")
    } else if has(&[
        "stretch",
        "strain",
        "nominal_strain",
        "nominal_stress",
        "stress",
        "cauchy",
    ]) {
        format!("a law is fitted to test data by `{fit}`")
    } else if has(&["time"]) && has(&["force"]) {
        format!("springs and dashpots are identified from a recording by `{identify}`")
    } else {
        format!(
            "`{correct}` takes displacements, `{fit}` test data, `{identify}` recordings of force and motion"
        )
    }
}

/// What a TOML file without a `kind` is, if it is no study, and the remedy.
pub fn recognised(root: &Section<'_>, file: &str) -> Option<(&'static str, String)> {
    let any = |keys: &[&'static str]| keys.iter().any(|key| root.has(key));
    if any(&["law", "parameters"]) && !any(&["plate", "load", "specimen"]) {
        let hint = format!(
            "`gelbench materials show {file}` shows it; a study names it with card = \"{file}\" under [material]"
        );
        return Some(("is a material card, not a study", hint));
    }
    if any(&["edges", "unnamed", "edge_gap", "robust", "physics"]) && !any(&["plate", "material"]) {
        let hint = format!(
            "`gelbench correct FIELD --material CARD --thickness \"2 mm\" --study {file}` takes it"
        );
        return Some((
            "states what is known of measured markers, and is not a study by itself",
            hint,
        ));
    }
    if any(&["specimen", "support", "path"]) {
        return Some((
            "is a study of a specimen without its kind",
            "add `kind = \"specimen\"` as its first line".to_owned(),
        ));
    }
    any(&["start", "grip", "time"]).then(|| {
        (
            "is a study of a motion without its kind",
            "add `kind = \"motion\"` as its first line".to_owned(),
        )
    })
}
