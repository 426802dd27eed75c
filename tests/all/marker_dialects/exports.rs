//! One field as programs write it, in every dialect of tables.

/// A marker: x, y, ux, uy in mm, y upwards. Its numbers are short in binary, so that no way of writing them rounds.
pub type Point = [f64; 4];

/// A column: name, unit, and what stands there.
pub type Column = (&'static str, &'static str, fn(usize, Point) -> f64);

/// What a program writes.
pub struct Export {
    pub layout: &'static str,
    pub columns: Vec<Column>,
    /// The length of its unit in mm where the file does not say it.
    pub unit: Option<f64>,
}

pub fn points() -> Vec<Point> {
    let positions = (0..4).flat_map(|i| (0..3).map(move |j| [f64::from(i), f64::from(j)]));
    let point = |[i, j]: [f64; 2]| {
        let [x, y] = [10.0 + 2.5 * i, 1200.0 + 3.25 * j];
        [x, y, 0.125 * i + 0.0625 * j * j, 0.5 - 0.25 * j]
    };
    positions.map(point).collect()
}

pub const ID: fn(usize, Point) -> f64 = |id, _| id as f64;
pub const ZERO: fn(usize, Point) -> f64 = |_, _| 0.0;
pub const STRAIN: fn(usize, Point) -> f64 = |id, _| 0.01 * id as f64;
pub const X: fn(usize, Point) -> f64 = |_, [x, ..]| x;
pub const Y: fn(usize, Point) -> f64 = |_, [_, y, ..]| y;
pub const UX: fn(usize, Point) -> f64 = |_, [.., ux, _]| ux;
pub const UY: fn(usize, Point) -> f64 = |_, [.., uy]| uy;
/// Downwards, as in an image.
pub const Y_DOWN: fn(usize, Point) -> f64 = |_, [_, y, ..]| -y;
pub const UY_DOWN: fn(usize, Point) -> f64 = |_, [.., uy]| -uy;
/// In pixels of half a millimetre.
pub const X_PIXEL: fn(usize, Point) -> f64 = |_, [x, ..]| 2.0 * x;
pub const Y_PIXEL: fn(usize, Point) -> f64 = |_, [_, y, ..]| -2.0 * y;
pub const U_PIXEL: fn(usize, Point) -> f64 = |_, [.., ux, _]| 2.0 * ux;
pub const V_PIXEL: fn(usize, Point) -> f64 = |_, [.., uy]| -2.0 * uy;

/// Tables of programs, with heads as they write them (sources: the documentation of the layouts).
pub fn exports() -> Vec<Export> {
    let export = |layout, unit, columns: &[Column]| Export {
        layout,
        columns: columns.to_vec(),
        unit,
    };
    let (millimetres, pixels) = (None, Some(0.5));
    vec![
        export(
            "columns",
            millimetres,
            &[
                ("x", "mm", X),
                ("y", "mm", Y),
                ("ux", "mm", UX),
                ("uy", "mm", UY),
            ],
        ),
        export(
            "DICe",
            pixels,
            &[
                ("SUBSET_ID", "", ID),
                ("COORDINATE_X", "", X_PIXEL),
                ("COORDINATE_Y", "", Y_PIXEL),
                ("DISPLACEMENT_X", "", U_PIXEL),
                ("DISPLACEMENT_Y", "", V_PIXEL),
                ("VSG_STRAIN_XX", "", STRAIN),
                ("GAMMA", "", STRAIN),
                ("MATCH", "", ZERO),
            ],
        ),
        export(
            "pyALDIC",
            pixels,
            &[
                ("node_id", "", ID),
                ("x_px", "", X_PIXEL),
                ("y_px", "", Y_PIXEL),
                ("disp_u", "", U_PIXEL),
                ("disp_v", "", V_PIXEL),
                ("disp_magnitude", "", ZERO),
                ("strain_exx", "", STRAIN),
            ],
        ),
        export(
            "muDIC",
            pixels,
            &[
                ("id", "", ID),
                ("x", "", |_, [x, _, ux, _]| 2.0 * (x + ux)),
                ("y", "", |_, [_, y, _, uy]| -2.0 * (y + uy)),
                ("ux", "", U_PIXEL),
                ("uy", "", V_PIXEL),
                ("true_strain_xx", "", STRAIN),
            ],
        ),
        export(
            "VIC-3D",
            millimetres,
            &[
                ("Index", "1", ID),
                ("X", "mm", X),
                ("Y", "mm", Y),
                ("Z", "mm", ZERO),
                ("U", "mm", UX),
                ("V", "mm", UY),
                ("W", "mm", ZERO),
                ("Sigma_X", "mm", STRAIN),
                ("sigma", "pixel", STRAIN),
                ("x", "pixel", STRAIN),
                ("exx", "1", STRAIN),
            ],
        ),
        export(
            "VIC-2D",
            pixels,
            &[
                ("x", "", X_PIXEL),
                ("y", "", Y_PIXEL),
                ("u", "", U_PIXEL),
                ("v", "", V_PIXEL),
                ("exx", "", STRAIN),
                ("eyy", "", STRAIN),
                ("exy", "", STRAIN),
                ("sigma", "", STRAIN),
            ],
        ),
        export(
            "MatchID",
            millimetres,
            &[
                ("Coordinates.Image X", "Pixel", ID),
                ("Coordinates.Image Y", "Pixel", ID),
                ("coor.X", "mm", X),
                ("coor.Y", "mm", Y_DOWN),
                ("disp.Horizontal Displacement U", "mm", UX),
                ("disp.Vertical Displacement V", "mm", UY_DOWN),
                ("strain.Strain-global frame: Exx", "-", STRAIN),
            ],
        ),
        export(
            "MatchID",
            pixels,
            &[
                ("Coordinates.Image X", "Pixel", X_PIXEL),
                ("Coordinates.Image Y", "Pixel", Y_PIXEL),
                ("disp.Horizontal Displacement U", "Pixel", U_PIXEL),
                ("disp.Vertical Displacement V", "Pixel", V_PIXEL),
            ],
        ),
        export(
            "MatchID",
            Some(1.0),
            &[
                ("x_pic", "", ID),
                ("y_pic", "", ID),
                ("x", "", X),
                ("y", "", Y_DOWN),
                ("z", "", ZERO),
                ("u", "", UX),
                ("v", "", UY_DOWN),
                ("w", "", ZERO),
                ("exx", "", STRAIN),
            ],
        ),
        export(
            "GOM, nodemap",
            millimetres,
            &[
                ("ID", "", ID),
                ("x_undef", "mm", X),
                ("y_undef", "mm", Y),
                ("z_undef", "mm", ZERO),
                ("u", "mm", UX),
                ("v", "mm", UY),
                ("w", "mm", ZERO),
                ("epsx", "%", STRAIN),
                ("epsxy", "1", STRAIN),
            ],
        ),
        export(
            "GOM Correlate",
            Some(1.0),
            &[
                ("id", "", ID),
                ("x", "", |_, [x, _, ux, _]| x + ux),
                ("y", "", |_, [_, y, _, uy]| y + uy),
                ("z", "", ZERO),
                ("displacement_x", "", UX),
                ("displacement_y", "", UY),
                ("displacement_z", "", ZERO),
                ("epsilon_x", "", STRAIN),
            ],
        ),
    ]
}

/// How a table is written.
#[derive(Clone, Copy, Debug)]
pub struct Dialect {
    pub separator: &'static str,
    pub decimal: char,
    /// Around each field, and behind each separator.
    pub quotes: [&'static str; 2],
    /// Whether units stand in a second line, else in brackets.
    pub second_line: bool,
    /// Whether the line of names is a remark.
    pub remark: bool,
    pub preamble: &'static str,
    pub line_end: &'static str,
}

pub fn dialects() -> Vec<Dialect> {
    let mut all = Vec::new();
    let separators = [(",", '.'), (";", '.'), (";", ','), ("\t", '.'), ("\t", ',')];
    let heads = [(false, false), (true, false), (false, true)];
    let quotes = [["", ""], ["\"", ""], ["\"", " "], ["", " "]];
    for (separator, decimal) in separators {
        for (second_line, remark) in heads {
            for quotes in quotes {
                for preamble in ["", "Project 7, specimen 3\n5 mm/min\n"] {
                    for line_end in ["\n", "\r\n"] {
                        all.push(Dialect {
                            separator,
                            decimal,
                            quotes,
                            second_line,
                            remark,
                            preamble,
                            line_end,
                        });
                    }
                }
            }
        }
    }
    // A remark has no quotes, and nothing stands above it that is none.
    all.retain(|one| !one.remark || one.quotes[0].is_empty() && one.preamble.is_empty());
    let quoted = Dialect {
        separator: ",",
        decimal: ',',
        quotes: ["\"", ""],
        ..all[0]
    };
    all.push(quoted);
    all
}

impl Dialect {
    pub fn line(&self, fields: impl Iterator<Item = String>) -> String {
        let [quote, space] = self.quotes;
        let fields: Vec<String> = fields
            .map(|field| format!("{quote}{field}{quote}"))
            .collect();
        fields.join(&format!("{}{space}", self.separator)) + "\n"
    }

    pub fn text(&self, export: &Export, remark: &str) -> String {
        let columns = || export.columns.iter();
        let bracketed = |(name, unit, _): &Column| match (unit.is_empty(), self.second_line) {
            (false, false) => format!("{name} [{unit}]"),
            _ => (*name).to_owned(),
        };
        let mut text = format!("# {remark}\n{}", self.preamble);
        text += if self.remark { "#  " } else { "" };
        text += &self.line(columns().map(bracketed));
        if self.second_line {
            text += &self.line(columns().map(|(_, unit, _)| (*unit).to_owned()));
        }
        for (id, point) in points().into_iter().enumerate() {
            let value = |(.., value): &Column| value(id, point).to_string();
            let field = |column| value(column).replace('.', &self.decimal.to_string());
            text += &self.line(columns().map(field));
        }
        text.replace('\n', self.line_end)
    }
}
