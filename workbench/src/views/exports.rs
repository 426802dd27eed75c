//! Exports: offers to choose from, written in the background, then saved.

use gelbench::results::Drawing;
use gelbench_report::results::LineChart;

use crate::logic::outputs::{FORMATS, Wanted};

/// An offer: its name, and what is exported.
pub type Offer = (String, Wanted);

/// A picture in every format; `what` is in the names of the offers, `name` in that of the file.
pub fn pictures(what: &str, name: &str, drawing: &Drawing) -> Vec<Offer> {
    let offer = |(format, kind)| {
        let wanted = Wanted::Picture(name.to_owned(), drawing.clone(), kind);
        (format!("{what} as {format}"), wanted)
    };
    FORMATS.map(offer).into()
}

/// A chart as a table, and as a picture in every format.
pub fn chart(what: &str, name: &str, chart: &LineChart) -> Vec<Offer> {
    let lines = Wanted::Lines(name.to_owned(), chart.clone());
    let mut offers = vec![(format!("{what} as CSV"), lines)];
    offers.extend(pictures(what, name, &Drawing::from(chart.clone())));
    offers
}
