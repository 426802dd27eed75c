//! The subset and the step of image correlation, where a table or a file in its folder states them.
//!
//! | program | where | subset, step |
//! |---|---|---|
//! | DICe | head of the file | `Subset size: 27`, `Step size: x 35 y 35` |
//! | GOM, nodemap | head of the file | `facet_size`, `facet_distance` |
//! | pyALDIC | `NAME_parameters_TIME.json` beside the folder `NAME_csv_TIME` of the table | `winsize`, `winstepsize` |
//! | MatchID | the only `.m2inp` or `.m3inp` in the folder of the table | `<Subset$size>=<15>`, `<Step$size>=<3>` |
//!
//! # References
//! DICe's regression tests; `_write_header` of github.com/dlr-wf/aramis-data-exporter; `export_params.py` of
//! github.com/zachtong/pyALDIC; input files of MatchID 2024.2 in github.com/thibaultbarret/etudeParametriqueMatchID.

use std::fs;
use std::path::{Path, PathBuf};

use crate::document::Table;
use crate::document::file::read_bytes;

/// Subset and step of image correlation.
#[derive(Clone, Debug, PartialEq)]
pub struct Subset {
    /// Width of a subset in pixels.
    pub size: f64,
    /// Distance of neighbouring subsets in pixels.
    pub step: f64,
    /// Where both are stated, for messages.
    pub source: String,
}

impl Subset {
    /// Subset and step according to the head of a table, or to a file in its folder.
    pub(super) fn of(table: &Table, path: &Path, layout: &str) -> Option<Self> {
        let of_head = |size: &str, step: &str| {
            let head = &table.source.text;
            let source = format!("the header of {}", name_of(path));
            Self::new([remark(head, size), remark(head, step)], source)
        };
        match layout {
            "DICe" | "DICe, stereo" => of_head("subset size", "step size"),
            "GOM, nodemap" => of_head("facet_size", "facet_distance"),
            "pyALDIC" => {
                let (file, text) = read_text(&parameters_of_pyaldic(path)?)?;
                let of = |key: &str| json_number(&text, key);
                Self::new([of("winsize"), of("winstepsize")], file)
            }
            "MatchID" => {
                let (file, text) = read_text(&job_of_matchid(path)?)?;
                let of = |key: &str| number(text.split_once(&format!("<{key}>=<"))?.1);
                Self::new([of("Subset$size"), of("Step$size")], file)
            }
            _ => None,
        }
    }

    fn new(values: [Option<f64>; 2], source: String) -> Option<Self> {
        let [size, step] = values.map(|value| value.filter(|value| *value > 0.0));
        Some(Self {
            size: size?,
            step: step?,
            source,
        })
    }
}

/// The value of a remark such as `# key : 19` above the rows.
fn remark(text: &str, key: &str) -> Option<f64> {
    let lines = text.lines().take_while(|line| line.starts_with('#'));
    let mut pairs =
        lines.filter_map(|line| line.trim_start_matches(['#', '*', ' ']).split_once(':'));
    let (_, value) = pairs.find(|(known, _)| known.trim().eq_ignore_ascii_case(key))?;
    value.split_whitespace().find_map(|word| word.parse().ok())
}

/// The number that a text begins with.
fn number(text: &str) -> Option<f64> {
    let text = text.trim_start();
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.');
    text[..end.unwrap_or(text.len())].parse().ok()
}

/// The number of a key of a JSON object.
fn json_number(text: &str, key: &str) -> Option<f64> {
    let value: serde_json::Value = serde_json::from_str(text).ok()?;
    value[key].as_f64()
}

/// A small file and its text, if it can be read.
fn read_text(path: &Path) -> Option<(String, String)> {
    const MOST: u64 = 1 << 20;
    let text = read_bytes(path, MOST).ok()?;
    Some((name_of(path), String::from_utf8_lossy(&text).into_owned()))
}

/// The name of a file, for messages.
fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

fn parameters_of_pyaldic(table: &Path) -> Option<PathBuf> {
    let folder = table.parent()?;
    let name = folder.file_name()?.to_str()?;
    let (prefix, time) = name.rsplit_once("_csv_")?;
    Some(
        folder
            .parent()?
            .join(format!("{prefix}_parameters_{time}.json")),
    )
}

/// The only file with a job of MatchID in the folder of a table.
fn job_of_matchid(table: &Path) -> Option<PathBuf> {
    let folder = table
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let is_job = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        matches!(ending, Some("m2inp" | "m3inp"))
    };
    let mut jobs = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(is_job);
    let first = jobs.next()?;
    jobs.next().is_none().then_some(first)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// Size and step of the first of some files, which is the table.
    fn subset_in(files: &[(&str, &str)], layout: &str) -> Option<[f64; 2]> {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let path = folder.path().join(files[0].0);
        let table = Table::read(&path, "").unwrap();
        let subset = Subset::of(&table, &path, layout)?;
        Some([subset.size, subset.step])
    }

    #[test]
    fn subset_and_step_are_found_where_programs_write_them() {
        let dice = "***\n*** Subset size: 27\n*** Step size: x 35 y 35 (-1 implies not regular grid)\na,b\n1,2\n";
        let gom = "# stage data:\n# facet_size                    : 19\n# facet_distance                : 16\na,b\n1,2\n";
        let aldic = "{\"n_frames\": 1, \"winsize\": 40, \"winstepsize\": 32}";
        let job = "%%% i_Subset\n<Step$size>=<7>\n<Subset$size>=<21>\n";
        let table = "a,b\n1,2\n";
        assert_eq!(subset_in(&[("a.txt", dice)], "DICe"), Some([27.0, 35.0]));
        assert_eq!(
            subset_in(&[("a.txt", gom)], "GOM, nodemap"),
            Some([19.0, 16.0])
        );
        let files = [
            ("foam_csv_2026/1.csv", table),
            ("foam_parameters_2026.json", aldic),
        ];
        assert_eq!(subset_in(&files, "pyALDIC"), Some([40.0, 32.0]));
        let files = [("a.csv", table), ("Job.m2inp", job)];
        assert_eq!(subset_in(&files, "MatchID"), Some([21.0, 7.0]));
    }

    #[test]
    fn what_is_not_stated_or_may_belong_to_another_table_is_not_guessed() {
        let irregular = "***\n*** Subset size: 27\n*** Step size: x -1 y -1 (-1 implies not regular grid)\na,b\n1,2\n";
        assert_eq!(subset_in(&[("a.txt", irregular)], "DICe"), None);
        let table = ("a.csv", "# subset size: 27\n# step size: 35\na,b\n1,2\n");
        assert_eq!(subset_in(&[table], "columns"), None);
        assert_eq!(subset_in(&[table], "pyALDIC"), None);
        let job = "<Step$size>=<7><Subset$size>=<21>";
        let files = [table, ("1.m2inp", job), ("2.m2inp", job)];
        assert_eq!(subset_in(&files, "MatchID"), None);
    }
}
