//! What goes out: offers to choose from, written beside the drawing, then saved.

use gelbench::results::Drawing;
use gelbench_report::results::LineChart;

use crate::logic::background::{Background, Wake};
use crate::logic::engine::Fault;
use crate::logic::outputs::{Format, Wanted, Writer, Written};

/// An offer: its name, and what goes out.
pub type Offer = (String, Wanted);

/// What goes out, and what came of it.
pub struct Exports {
    writer: Background<Writer>,
}

impl Exports {
    /// Nothing yet.
    pub fn new(wake: Wake) -> Self {
        Self {
            writer: Background::new(wake),
        }
    }

    /// Lets something go out.
    pub fn ask(&mut self, wanted: Wanted) {
        self.writer.ask(wanted);
    }

    /// What was written.
    pub fn receive(&mut self) -> Option<Result<Written, Fault>> {
        self.writer.answers().pop()
    }

    /// Whether something is being written.
    pub fn is_busy(&self) -> bool {
        self.writer.is_busy()
    }

    /// Stops it.
    pub fn stop(&mut self) {
        self.writer.stop();
    }
}

/// A picture in every format; `what` is in the names of the offers, `name` in that of the file.
pub fn pictures(what: &str, name: &str, drawing: &Drawing) -> Vec<Offer> {
    let offer = |(format, kind): (&str, Format)| {
        let wanted = Wanted::Picture(name.to_owned(), drawing.clone(), kind);
        (format!("{what} as {format}"), wanted)
    };
    Format::ALL.map(offer).into()
}

/// A chart as a table, and as a picture in every format.
pub fn chart(what: &str, name: &str, chart: &LineChart) -> Vec<Offer> {
    let lines = Wanted::Lines(name.to_owned(), chart.clone());
    let mut offers = vec![(format!("{what} as CSV"), lines)];
    offers.extend(pictures(what, name, &Drawing::from(chart.clone())));
    offers
}
