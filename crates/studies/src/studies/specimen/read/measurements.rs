//! The reader of measurements within a sheet.

use crate::document::Section;
use crate::studies::points::{Region, named_tables, read_point, read_probes};
use crate::studies::specimen::measurements::{Extensometer, LineCut, Measurements};
use crate::studies::specimen::problem::Outline;

/// Reads `[[probe]]`, `[[line]]` and `[[extensometer]]` of a sheet, which has no outline where it could not be read.
pub(crate) fn read_measurements(root: &Section, outline: Option<&Outline>) -> Measurements {
    let wanted = ["probe", "line", "extensometer"];
    let outline = outline.filter(|_| wanted.iter().any(|key| root.has(key)));
    let region = outline.map(|outline| (outline.lattice(), outline.bounding_box()));
    let region = region.as_ref();
    Measurements {
        probes: read_probes(root, region),
        lines: named_tables(root, "line", |section, name| {
            read_line(section, name, region)
        }),
        extensometers: named_tables(root, "extensometer", |section, name| {
            read_extensometer(section, name, region)
        }),
    }
}

fn read_line(section: &Section, name: String, region: Option<&Region>) -> LineCut {
    const USUAL: usize = 101;
    let line = LineCut {
        name,
        from: read_point(section, "from", None),
        to: read_point(section, "to", None),
        count: section
            .stated("points", |_, key| section.count(key, 2, 10_000))
            .unwrap_or(USUAL),
    };
    let is_on_sheet = |point: &[f64; 2]| region.is_none_or(|(mesh, _)| mesh.outside(*point) == 0.0);
    let is_known = line.from.iter().chain(&line.to).all(|x| x.is_finite());
    if is_known && !line.points().iter().any(is_on_sheet) {
        let hint = "the ends are points at rest; the line may begin and end outside of the sheet";
        section.fault("to", "ends a line that does not meet the sheet", hint);
    }
    line
}

fn read_extensometer(section: &Section, name: String, region: Option<&Region>) -> Extensometer {
    let ends = ["from", "to"].map(|key| read_point(section, key, region));
    if ends[0] == ends[1] {
        let hint = "give two different points at rest";
        section.fault("to", "is the point `from`", hint);
    }
    Extensometer { name, ends }
}
