//! The kinds of dropped files, which decide on the view that opens them.

use gelbench::calibration::TestData;
use gelbench::document::{Statements, with_files};
use gelbench::markers::{ReadSettings, read};
use gelbench_base::document::{is_table_path, plain_name};
use gelbench_calibration::calibration::KEYS;
use gelbench_images::images::is_image_path;
use std::path::{Path, PathBuf};

/// What a file may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A study of a sheet between two grips, or a card.
    Sheet,
    /// A study of another kind.
    Study,
    /// Data of a material test.
    Test,
    /// A measured field, or a camera image of one.
    Field,
    /// The edge of a specimen: a table of lines.
    Edge,
    /// A mesh, which a study may name.
    Named,
    /// What nothing reads.
    Unread,
}

/// Kinds of studies that are sheets between two grips.
const SHEETS: [&str; 2] = ["plate", "specimen"];

impl Kind {
    /// By the name of a file and its text, where it is one.
    pub fn of(name: &str, text: Option<&str>) -> Self {
        let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
        match (ending.as_str(), text) {
            ("toml", Some(text)) => Self::of_toml(text),
            ("vtu" | "vtk" | "pvd" | "frd", _) => Self::Field,
            _ if is_image_path(Path::new(name)) => Self::Field,
            _ if is_table_path(Path::new(name)) => match text {
                Some(text) => Self::of_table(name, text),
                // Tables in other encodings are measured fields: those of cameras.
                None => Self::Field,
            },
            ("msh" | "inp", _) => Self::Named,
            _ => Self::Unread,
        }
    }

    /// The message about a file that nothing reads: which files would be read.
    pub fn nothing_reads(name: &str) -> String {
        format!(
            "nothing reads {name}. What is read: studies and cards (.toml, UTF-8), tests (.csv, .txt, .tsv, .dat), measured fields \
             (tables, also .xlsx, .npy, .npz and .mat; .vtu, .vtk, .pvd, .frd; camera images: .png, .tif, .bmp, .jpg), their edges (tables of \
             x, y, line), and meshes that a study names (.msh, .inp)"
        )
    }

    /// Whether a text is a material card.
    pub fn is_card(text: &str) -> bool {
        let table = text.parse::<toml::Table>();
        table.is_ok_and(|table| table.contains_key("law"))
    }

    fn of_toml(text: &str) -> Self {
        let table = text.parse::<toml::Table>().unwrap_or_default();
        let kind = table.get("kind").and_then(toml::Value::as_str);
        match kind {
            Some(kind) if !SHEETS.contains(&kind) => Self::Study,
            _ => Self::Sheet,
        }
    }

    /// A table that says what was tested, or has fewer than four columns, is a test; any other that is read as markers is a field, which may
    /// state its thickness and the like too.
    fn of_table(name: &str, text: &str) -> Self {
        let first = text
            .lines()
            .find(|line| !line.trim_start().starts_with('#'))
            .unwrap_or_default();
        if is_edge(first) {
            return Self::Edge;
        }
        let columns = first.split([',', ';', '\t']).count();
        let text = beginning(text);
        let states = |key: &str| {
            let statement = format!("{key}:");
            let mut lines = text.lines().map(|line| line.trim_start_matches('#'));
            lines.any(|line| line.trim_start().starts_with(&statement))
        };
        let path = PathBuf::from(name);
        let as_field = || {
            let files = [(path.clone(), text.as_bytes().to_vec())];
            with_files(files, || {
                read(std::slice::from_ref(&path), &ReadSettings::default()).is_ok()
            })
        };
        let as_test = || TestData::parse(name, text, &Statements::new()).is_ok();
        let stated_or_read = || KEYS.iter().any(|key| states(key)) || as_test();
        if columns < 4 || states("test") || (!as_field() && stated_or_read()) {
            Self::Test
        } else {
            Self::Field
        }
    }
}

/// Whether the head of a table is that of lines: x, y, and at most the number of the line.
fn is_edge(head: &str) -> bool {
    let without_unit = |name: &str| plain_name(name.split('[').next().unwrap_or_default());
    let plain: Vec<String> = head.split([',', ';', '\t']).map(without_unit).collect();
    let names: Vec<&str> = plain.iter().map(String::as_str).collect();
    matches!(names[..], ["x", "y"] | ["x", "y", "line"])
}

/// Lines by which a table is recognised: no frame waits for a long one.
const LINES: usize = 300;

/// The first lines of a text.
fn beginning(text: &str) -> &str {
    let end = text.match_indices('\n').nth(LINES);
    end.map_or(text, |(end, _)| &text[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_find_their_view() {
        let field = include_str!("../../../examples/measured_plate.csv");
        let stated = format!("# thickness: 2 mm\n{field}");
        let test = include_str!("../../../materials/data/treloar_1944_uniaxial.csv");
        let motion = include_str!("../../../examples/released_plate.toml");
        let card = include_str!("../../../materials/neo-hooke.toml");
        for (name, text, kind) in [
            ("measured.csv", field, Kind::Field),
            ("stated.csv", stated.as_str(), Kind::Field),
            ("pull.csv", "# area: 8 mm^2\na,b,c,d\n1,2,3,4\n", Kind::Test),
            ("test.csv", test, Kind::Test),
            ("bare.csv", "strain,stress\n0.1,0.2\n", Kind::Test),
            ("edge.csv", "x [mm],y [mm],line\n0,0,1\n", Kind::Edge),
            ("px.csv", "a,b,c,d\n1,2,3,4\n", Kind::Field),
            ("motion.toml", motion, Kind::Study),
            ("card.toml", card, Kind::Sheet),
            ("short.toml", "[plate]\nwidth = \"4 cm\"\n", Kind::Sheet),
            ("mesh.msh", "$MeshFormat\n", Kind::Named),
            ("notes.md", "# notes\n", Kind::Unread),
        ] {
            assert_eq!(Kind::of(name, Some(text)), kind, "{name}");
        }
        assert_eq!(Kind::of("camera.csv", None), Kind::Field);
        assert_eq!(Kind::of("camera.XLSX", None), Kind::Field);
        assert_eq!(Kind::of("photo.jpg", None), Kind::Field);
        assert_eq!(Kind::of("film.mp4", None), Kind::Unread);
    }
}
