//! The main results of a study of a sheet: the force and displacement of its groups along the path, and where stress and stretch are
//! largest.

use super::sheet::NodalSheet;
use super::{Block, Deformed, LocalState, Table, or_dash};
use crate::mesh::Mesh;
use crate::mesh::geometry::least_width;
use crate::problem::{GroupState, SheetLaws};
use crate::units::number;

/// Most rows of the table of forces; of more, steps are left out.
const MOST_ROWS: usize = 12;

/// Forces, moments and displacements below this share of the largest are negligible.
const NEGLIGIBLE: f64 = 1e-4;

/// Displacements below this share of the sheet's side, and forces below this share of those on a group's nodes, are rounding.
const ROUNDING: f64 = 1e-12;

/// The result of one model of a sheet.
pub struct Headline<'a> {
    /// The model.
    pub model: &'a str,
    /// The parameter along the steps, as a head of a table.
    pub along: &'static str,
    /// The names of the groups.
    pub groups: Vec<&'a str>,
    /// Each step in figures, with the states of its groups.
    pub steps: Vec<(String, Vec<GroupState>)>,
    /// The state whose largest values are shown.
    pub state: LoadedSheet<'a>,
}

/// A sheet in one state.
pub struct LoadedSheet<'a> {
    /// Where on the path, such as `50 % stretch`.
    pub at: String,
    /// The materials.
    pub laws: SheetLaws<'a>,
    /// Its mesh and fields.
    pub deformed: Deformed<'a>,
    /// Points at rest in mm at which stress has no bound.
    pub singular: Vec<[f64; 2]>,
    /// Its gauge section, where it has one.
    pub gauge: Option<Gauge>,
}

/// A part of a sheet along x in which stress and stretch are nearly uniform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Both ends of its middle line at rest in mm.
    pub ends: [[f64; 2]; 2],
    /// Its description.
    pub description: &'static str,
}

impl Gauge {
    /// The middle half of a part of some length along x in the middle of a sheet.
    pub fn middle_half(mesh: &Mesh, length: f64, description: &'static str) -> Self {
        let [x, y] = mesh.middle();
        let quarter = 0.25 * length;
        Self {
            ends: [[x - quarter, y], [x + quarter, y]],
            description,
        }
    }

    /// The length of its middle line over that at rest.
    fn stretch(&self, mesh: &Mesh, displacement: &[f64]) -> f64 {
        let [from, to] = self.ends;
        let [u, v] = self.ends.map(|end| mesh.displacement_at(displacement, end));
        let along = |axis: usize| to[axis] + v[axis] - from[axis] - u[axis];
        along(0).hypot(along(1)) / (to[0] - from[0])
    }

    /// The mean of a value at the nodes over the cells of the section.
    fn mean(&self, mesh: &Mesh, value: &dyn Fn(usize) -> f64) -> f64 {
        let [[from, _], [to, _]] = self.ends;
        let cells =
            (0..mesh.cell_count()).filter(|cell| (from..=to).contains(&mesh.centre(*cell)[0]));
        let (mut sum, mut areas) = (0.0, 0.0);
        for cell in cells {
            let (area, nodes) = (mesh.cell_area(cell), mesh.cell(cell));
            sum += area * nodes.iter().map(|node| value(*node)).sum::<f64>() / nodes.len() as f64;
            areas += area;
        }
        sum / areas
    }
}

/// A quantity of [`GroupState`] and its head.
type Column = (&'static str, fn(&GroupState) -> f64);

const DISPLACEMENTS: [Column; 2] = [
    ("displacement along x [mm]", |state| state.displacement[0]),
    ("displacement along y [mm]", |state| state.displacement[1]),
];
const FORCES: [Column; 2] = [
    ("force along x [N]", |state| state.carried()[0]),
    ("force along y [N]", |state| state.carried()[1]),
];
const MOMENT: Column = ("moment [N·mm]", |state| state.carried()[2]);

impl Headline<'_> {
    /// The tables at the beginning of a report.
    pub fn blocks(&self) -> Vec<Block> {
        let mut blocks = Vec::new();
        if !self.listed().is_empty() {
            blocks.push(self.forces());
        }
        blocks.extend(self.state.largest());
        blocks.push(Block::Paragraph(self.note()));
        blocks
    }

    fn note(&self) -> String {
        let mut note = format!("By the {}.", self.model);
        let shown = self.shown().len();
        if shown < self.steps.len() {
            note += &format!(" {shown} of {} steps are listed.", self.steps.len());
        }
        note.extend(self.state.note().map(|words| format!(" {words}")));
        if !self.listed().into_iter().all(|group| self.is_held(group)) {
            note += " Forces are those of supports; a dash is a group on which none acts.";
        }
        if let Some(gauge) = &self.state.gauge {
            note += &format!(" Gauge section: {}.", gauge.description);
        }
        note
    }

    /// The numbers of the steps that are listed, evenly spread, the last among them.
    fn shown(&self) -> Vec<usize> {
        let most = (MOST_ROWS / self.listed().len().max(1)).max(1);
        let every = self.steps.len().div_ceil(most).max(1);
        let mut shown: Vec<usize> = (0..self.steps.len()).rev().step_by(every).collect();
        shown.reverse();
        shown
    }

    fn states(&self) -> impl Iterator<Item = &GroupState> {
        self.steps.iter().flat_map(|(_, groups)| groups)
    }

    /// Whether one of some quantities of a group is in some step not negligible beside its largest size.
    fn is_significant(&self, columns: &[Column], group: usize, size: f64) -> bool {
        let mut states = self.steps.iter().map(|(_, groups)| &groups[group]);
        states.any(|state| {
            let mut values = columns.iter().map(|(_, value)| value(state));
            values.any(|value| value.abs() > NEGLIGIBLE * size)
        })
    }

    /// The largest displacement in mm, the largest force in N, and the moment of that force over the sheet's larger side in N·mm; at least so
    /// large that rounding of positions, and of the forces on a group's nodes, is negligible beside them.
    fn sizes(&self) -> [f64; 3] {
        let [x, y] = self.state.deformed.mesh.size();
        let side = x.max(y);
        let largest = |[x, y]: [Column; 2], least: f64| {
            let sizes = self.states().map(|state| x.1(state).hypot(y.1(state)));
            sizes.fold(least, f64::max)
        };
        let carrying = self.states().filter(|state| state.carried() != [0.0; 3]);
        let of_nodes = carrying.map(|state| state.size).fold(0.0, f64::max);
        let force = largest(FORCES, ROUNDING / NEGLIGIBLE * of_nodes);
        let displacement = largest(DISPLACEMENTS, ROUNDING / NEGLIGIBLE * side);
        [displacement, force, force * side]
    }

    /// The quantities that are significant in some group, with their largest sizes; at least a force.
    fn columns(&self) -> Vec<(Column, f64)> {
        let [displacement, force, moment] = self.sizes();
        let displacements = DISPLACEMENTS.map(|column| (column, displacement));
        let forces = FORCES.map(|column| (column, force));
        let all = displacements
            .into_iter()
            .chain(forces)
            .chain([(MOMENT, moment)]);
        let mut columns: Vec<_> = all
            .filter(|(column, size)| {
                let mut groups = 0..self.groups.len();
                groups.any(|group| self.is_significant(&[*column], group, *size))
            })
            .collect();
        if force == 0.0 {
            columns.push(forces[0]);
        }
        columns
    }

    /// The groups that move or carry something. Of two that balance each other without moments, the one at rest is left out: its force is that
    /// of the other with the opposite sign.
    fn listed(&self) -> Vec<usize> {
        let [displacement, force, moment] = self.sizes();
        let moves = |group: &usize| self.is_significant(&DISPLACEMENTS, *group, displacement);
        let turns = |group: &usize| self.is_significant(&[MOMENT], *group, moment);
        let carries = |group: &usize| self.is_significant(&FORCES, *group, force) || turns(group);
        let all = 0..self.groups.len();
        let carrying: Vec<usize> = all.clone().filter(carries).collect();
        let is_pair =
            carrying.len() == 2 && carrying.iter().any(moves) && !carrying.iter().any(turns);
        all.filter(|group| moves(group) || carries(group) && !is_pair)
            .collect()
    }

    /// Whether a support of a group carries anything in some step.
    fn is_held(&self, group: usize) -> bool {
        let mut states = self.steps.iter().map(|(_, groups)| &groups[group]);
        states.any(|state| state.size > 0.0 || state.force != [0.0; 2])
    }

    fn forces(&self) -> Block {
        let listed = self.listed();
        let rows = self.shown().into_iter();
        let rows = rows.flat_map(|step| listed.iter().map(move |group| (step, *group)));
        let mut table = Table::of(rows)
            .column(self.along, |(step, _)| self.steps[*step].0.clone())
            .column("group", |(_, group)| self.groups[*group].to_owned());
        for ((head, value), size) in self.columns() {
            let is_displacement = DISPLACEMENTS.iter().any(|(name, _)| *name == head);
            table = table.column(head, |(step, group)| {
                match value(&self.steps[*step].1[*group]) {
                    _ if !is_displacement && !self.is_held(*group) => "–".to_owned(),
                    small if small.abs() <= NEGLIGIBLE * size => number(0.0),
                    value => number(value),
                }
            });
        }
        table.block()
    }
}

/// A quantity of [`LocalState`] with its name, and whether its least value counts.
struct Quantity {
    name: &'static str,
    value: fn(&LocalState) -> f64,
    is_least: bool,
}

const STRETCHES: [&str; 2] = ["principal stretch [–]", "smallest principal stretch [–]"];

/// The quantities of a sheet that is pulled, or of one that is pressed more than it is pulled.
fn quantities(is_pressed: bool) -> [Quantity; 3] {
    let of = |name, value: fn(&LocalState) -> f64, is_least| Quantity {
        name,
        value,
        is_least,
    };
    let von_mises = of("von Mises stress [MPa]", LocalState::von_mises, false);
    if is_pressed {
        let stress = "smallest principal Cauchy stress [MPa]";
        return [
            of(stress, |state| state.principal_cauchy()[1], true),
            of(STRETCHES[1], |state| state.stretches[1], true),
            von_mises,
        ];
    }
    let stress = "principal Cauchy stress [MPa]";
    [
        of(stress, |state| state.principal_cauchy()[0], false),
        of(STRETCHES[0], |state| state.stretches[0], false),
        von_mises,
    ]
}

/// Whether the largest compression of some states is larger than the largest tension.
fn is_pressed<'a>(states: impl Iterator<Item = &'a LocalState>) -> bool {
    let (mut tension, mut compression) = (0.0_f64, 0.0_f64);
    for [most, least] in states.map(LocalState::principal_cauchy) {
        (tension, compression) = (tension.max(most), compression.max(-least));
    }
    compression > tension
}

impl LoadedSheet<'_> {
    /// The distance from singular points in mm from which on values count, whatever the mesh, and the decimals of positions: a fifth of the
    /// sheet's least width, and those that resolve a fiftieth of it.
    fn distance_and_decimals(&self) -> (f64, usize) {
        let width = least_width(&self.deformed.mesh.nodes);
        let decimals = (1.6 - width.log10()).ceil().clamp(1.0, 9.0);
        (width / 5.0, decimals as usize)
    }

    /// A note on the regions that are left out when the largest values are searched; `None` where nothing is left out.
    pub fn note(&self) -> Option<String> {
        let (distance, decimals) = self.distance_and_decimals();
        let distance = format!("{distance:.0$}", decimals + 3);
        let distance = distance.trim_end_matches('0').trim_end_matches('.');
        (!self.singular.is_empty()).then(|| {
            format!(
                "Largest values: farther than {distance} mm from ends of supports and re-entrant corners, where stress has no bound.",
            )
        })
    }

    /// A table of the largest values and of those of the gauge section; `None` where no node is far enough from singular points.
    pub fn largest(&self) -> Option<Block> {
        let sheet = NodalSheet::new(self.laws, &self.deformed);
        let (mesh, states) = (&*sheet.mesh, &sheet.states);
        let (distance, decimals) = self.distance_and_decimals();
        let is_regular = |node: &usize| {
            let [x, y] = mesh.nodes[*node];
            self.singular
                .iter()
                .all(|[a, b]| (x - a).hypot(y - b) > distance)
        };
        let regular: Vec<usize> = (0..mesh.nodes.len()).filter(is_regular).collect();
        let row = |quantity: Quantity| {
            let Quantity {
                name,
                value,
                is_least,
            } = quantity;
            let value = |node: usize| value(&states[node]);
            let sign = if is_least { -1.0 } else { 1.0 };
            let node = largest_node(mesh, &regular, &|node| sign * value(node))?;
            let position = mesh.nodes[node].map(|along| position(along, decimals));
            let position = position.join(", ");
            let mut row = vec![
                name.to_owned(),
                number(value(node)),
                format!("({position})"),
            ];
            row.extend(self.gauge.map(|gauge| {
                let mean = if STRETCHES.contains(&name) {
                    gauge.stretch(mesh, &sheet.displacement)
                } else {
                    gauge.mean(mesh, &value)
                };
                or_dash(Some(mean), number)
            }));
            Some(row)
        };
        let is_pressed = is_pressed(regular.iter().map(|node| &states[*node]));
        let quantities = quantities(is_pressed).into_iter();
        let rows: Vec<Vec<String>> = quantities.filter_map(row).collect();
        let at = format!("at {}", self.at);
        let most = if is_pressed { "extreme" } else { "largest" };
        let head = [&*at, most, "at rest at x, y [mm]", "gauge section"];
        let count = head.len() - usize::from(self.gauge.is_none());
        (!rows.is_empty()).then(|| Block::table(&head[..count], rows))
    }
}

/// A coordinate with some decimals; without the sign of a negative one that is rounded to zero.
fn position(along: f64, decimals: usize) -> String {
    let rounding = 0.5 * 10_f64.powi(-(decimals as i32));
    let along = if along.abs() < rounding { 0.0 } else { along };
    format!("{along:.decimals$}")
}

/// The node with the largest value; of nodes that differ by rounding alone, as those of a symmetric sheet, the first along x, then y.
fn largest_node(mesh: &Mesh, nodes: &[usize], value: &dyn Fn(usize) -> f64) -> Option<usize> {
    const ALIKE: f64 = 1e-6;
    let known = nodes
        .iter()
        .copied()
        .filter(|node| value(*node).is_finite());
    let most = known.clone().map(value).reduce(f64::max)?;
    let alike = known.filter(|node| value(*node) >= most - ALIKE * most.abs());
    alike.min_by(|a, b| {
        let ([ax, ay], [bx, by]) = (mesh.nodes[*a], mesh.nodes[*b]);
        ax.total_cmp(&bx).then(ay.total_cmp(&by))
    })
}
