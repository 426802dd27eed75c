//! The colour bar below fields, with the quantity that it shows and the values outside of its range.

use super::canvas::{EDGE, GAP, Sheet};
use super::colours::Range;
use super::look::Look;
use super::marks::{Align, Colour, Rectangle};
use super::numbers::{Numbers, Ticks};
use super::paint::Painter;
use crate::results::{Panel, Scale, Values};

/// The length of the arrow at an end that values exceed.
const ARROW: f64 = 14.0;

const HEIGHT: f64 = 12.0;

/// The least length where there is room.
const LEAST: f64 = 300.0;

/// From the bar to the middle of its numbers.
const NUMBERS: f64 = 15.0;

/// A colour bar where it is drawn.
pub(super) struct Bar {
    look: Look,
    /// Without the arrows.
    area: Rectangle,
    pub range: Range,
    pub ticks: Ticks,
    /// Words below it: their middles, and which of them are aligned to an end.
    words: Vec<(String, [f64; 2], Align)>,
    pub bottom: f64,
}

impl Bar {
    /// The bar of panels from a left and an upper end on, as long as the panels or as there is room for its words.
    pub fn of(
        look: Look,
        panels: &[Panel],
        quantity: &str,
        (scale, range): (Scale, Option<[f64; 2]>),
        [left, top, panels_right, most]: [f64; 4],
    ) -> Self {
        let range = Range::of(panels.iter(), scale, range);
        let right = panels_right.max(most.min(left + LEAST)).min(most - 14.0);
        let arrow = |outside: Option<f64>| outside.map_or(0.0, |_| ARROW);
        let area = Rectangle::new(
            [left + arrow(range.below), top],
            [right - arrow(range.above), top + HEIGHT],
        );
        let length = area.size()[0];
        let ticks = Ticks::fitting([range.low, range.high], scale, length, look.number());
        let quantity = ticks.numbers.labelled(quantity);
        let extreme = |which, value| extreme(which, value, panels, &quantity);
        let extremes = [
            range
                .below
                .map(|least| (extreme("min", least), Align::Left)),
            range.above.map(|most| (extreme("max", most), Align::Right)),
        ];
        let mut bar = Self {
            look,
            area,
            range,
            ticks,
            words: Vec::new(),
            bottom: 0.0,
        };
        bar.arrange(&quantity, extremes, [left, right]);
        bar
    }

    /// Places the quantity in the middle below the numbers, and the extreme values at the ends, in the same line if there is room.
    fn arrange(
        &mut self,
        quantity: &str,
        extremes: [Option<(String, Align)>; 2],
        [left, right]: [f64; 2],
    ) {
        const APART: f64 = 16.0;
        let letters = self.look.name();
        let line = letters.line_height();
        let width = |words: &str| letters.width(words);
        let first = self.area.high[1] + NUMBERS + GAP + 0.5 * line + 2.0;
        let mut y = first;
        for words in letters.lines(quantity, right - left) {
            let at = [0.5 * (left + right), y];
            self.words.push((words, at, Align::Centre));
            y += line;
        }
        let widths = extremes.iter().flatten().map(|(words, _)| width(words));
        let widest = widths.fold(0.0, f64::max);
        let is_one_row = 2.0 * (widest + APART) + width(quantity) <= right - left;
        let mut row = if is_one_row { first } else { y };
        let both: f64 = extremes
            .iter()
            .flatten()
            .map(|(words, _)| width(words) + APART)
            .sum();
        for (words, align) in extremes.into_iter().flatten() {
            let end = if align == Align::Left { left } else { right };
            for words in letters.lines(&words, right - left) {
                self.words.push((words, [end, row], align));
                y = y.max(row + line);
                if !is_one_row && both > right - left {
                    row += line;
                }
            }
        }
        self.bottom = y - 0.5 * line + EDGE;
    }

    /// Where a share of the bar is.
    fn at(&self, share: f64) -> f64 {
        self.area.low[0] + share * self.area.size()[0]
    }

    pub fn paint(&self, painter: &mut Painter, table: &[Colour]) {
        let mut shade = |corners, shares| painter.shade(corners, shares, &|share| share, table);
        let [a, b, c, d] = self.area.corners();
        shade([a, b, c], [0.0, 1.0, 1.0]);
        shade([a, c, d], [0.0, 1.0, 0.0]);
        let [below, above] = self.tips();
        if let Some(tip) = below {
            shade([a, d, tip], [0.0; 3]);
        }
        if let Some(tip) = above {
            shade([b, c, tip], [1.0; 3]);
        }
    }

    /// The tips of its arrows.
    fn tips(&self) -> [Option<[f64; 2]>; 2] {
        let middle = 0.5 * (self.area.low[1] + self.area.high[1]);
        let Rectangle { low, high } = self.area;
        [
            self.range.below.map(|_| [low[0] - ARROW, middle]),
            self.range.above.map(|_| [high[0] + ARROW, middle]),
        ]
    }

    pub fn draw(&self, sheet: &mut Sheet) {
        let [a, b, c, d] = self.area.corners();
        let [below, above] = self.tips();
        let frame = [Some(a), Some(b), above, Some(c), Some(d), below, Some(a)];
        let frame: Vec<_> = frame.into_iter().flatten().collect();
        sheet.axis(&frame);
        let bottom = self.area.high[1];
        for (position, label) in &self.ticks.at {
            let x = self.at(self.range.share(*position));
            sheet.axis(&[[x, bottom], [x, bottom + 4.0]]);
            sheet.write(
                label,
                [x, bottom + NUMBERS],
                Align::Centre,
                self.look.number(),
            );
        }
        for (words, at, align) in &self.words {
            sheet.write(words, *at, *align, self.look.name());
        }
    }
}

/// An extreme value with its unit and its panel, where there are several.
fn extreme(which: &str, value: f64, panels: &[Panel], quantity: &str) -> String {
    let has = |panel: &&Panel| match &panel.values {
        Values::AtPoints(values) | Values::InCells(values) => values.contains(&value),
    };
    let unit = quantity.rsplit_once('[').map_or("", |(_, unit)| unit);
    let unit = unit
        .trim_end_matches(']')
        .trim_start_matches(|letter: char| {
            letter == '1' || letter == '0' || "⁻⁰¹²³⁴⁵⁶⁷⁸⁹ –".contains(letter)
        });
    let number = Numbers::default().between(value);
    let panel = panels.iter().find(has).filter(|_| panels.len() > 1);
    let of = panel.map_or_else(String::new, |panel| format!(" ({})", panel.label));
    format!("{which} {number} {unit}").trim_end().to_owned() + &of
}
