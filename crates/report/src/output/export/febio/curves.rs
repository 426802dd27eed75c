//! How loads and rotations grow with time.

use crate::output::export::model::{Constraint, Model};
use crate::output::export::text::number;
use crate::output::export::xml::Xml;

/// Points of the path of a turn between two load factors.
const TURN_POINTS: u32 = 8;

/// Load curves: the first is the load factor itself, the others follow turning nodes.
#[derive(Default)]
pub struct Curves(Vec<Vec<[f64; 2]>>);

impl Curves {
    /// The number of the curve of a node that a support turns, exact at every load factor and at points between.
    pub fn turn(&mut self, model: &Model, held: &Constraint, node: usize) -> usize {
        let position = model.given.mesh.nodes[node];
        let mut points = vec![[0.0, 0.0]];
        let mut before = 0.0_f64;
        for factor in model.given.factors {
            for i in 1..=TURN_POINTS {
                let at = match i {
                    TURN_POINTS => *factor,
                    _ => before + (factor - before) * f64::from(i) / f64::from(TURN_POINTS),
                };
                points.push([f64::abs(at), held.at(position, at)]);
            }
            before = *factor;
        }
        self.0.push(points);
        self.0.len() + 1
    }

    pub fn write(self, model: &Model, file: &mut Xml) {
        // Load factors have one sign, and grow where nothing softens.
        let factor = vec![[0.0, 0.0], [1.0, model.given.factors[0].signum()]];
        file.within("LoadData", &[], |file| {
            for (index, points) in std::iter::once(factor).chain(self.0).enumerate() {
                let id = (index + 1).to_string();
                let name = format!("curve {id}");
                let attributes = [("id", &*id), ("name", &*name), ("type", "loadcurve")];
                file.within("load_controller", &attributes, |file| {
                    file.text("interpolate", &[], "LINEAR");
                    file.text("extend", &[], "EXTRAPOLATE");
                    file.within("points", &[], |file| {
                        for [time, value] in points {
                            file.text("pt", &[], &format!("{},{}", number(time), number(value)));
                        }
                    });
                });
            }
        });
    }
}
