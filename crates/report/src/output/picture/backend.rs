//! What plotters draws, as marks of a picture.
//!
//! plotters gives charts their coordinates and draws the elements in them. Its backends for files know no dashes and turn letters into outlines,
//! so that it draws into marks here, which are then written as any format.

use std::convert::Infallible;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, DrawingArea, DrawingBackend, IntoDrawingArea, RGBAColor};
use plotters::style::{Color, ShapeStyle};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingErrorKind};

use super::canvas::Sheet;
use super::marks::{Colour, Mark, Pen};

/// Units of plotters, which counts in whole numbers, for each point of the design.
const FINE: f64 = 256.0;

/// Coordinates of a chart.
pub(super) type Coordinates = Cartesian2d<RangedCoordf64, RangedCoordf64>;

/// A chart that is drawn on.
pub(super) type Chart<'a> = DrawingArea<Backend<'a>, Coordinates>;

/// Points of the design in units of plotters.
pub(super) fn units(points: f64) -> i32 {
    (FINE * points).round() as i32
}

/// A point of plotters in points of the design.
pub(super) fn point((x, y): BackendCoord) -> [f64; 2] {
    [f64::from(x) / FINE, f64::from(y) / FINE]
}

/// Draws marks of a picture in a style of dashes.
pub(super) struct Backend<'a> {
    sheet: &'a mut Sheet,
    dashes: Option<[f32; 2]>,
    /// Discs and rings of one style, which become one mark: centres, radius, pen, and whether they are filled.
    circles: Vec<[f64; 2]>,
    of_circles: Option<(f64, Pen, bool)>,
}

/// A chart with its coordinates on a sheet.
pub(super) fn chart<'a>(
    sheet: &'a mut Sheet,
    dashes: Option<[f32; 2]>,
    coordinates: Coordinates,
) -> Chart<'a> {
    let backend = Backend {
        sheet,
        dashes,
        circles: Vec::new(),
        of_circles: None,
    };
    backend.into_drawing_area().apply_coord_spec(coordinates)
}

impl Pen {
    /// The style in which plotters draws with it; its dashes are those of the backend.
    pub(super) fn style(self) -> ShapeStyle {
        ShapeStyle {
            color: opaque(self.colour).mix(f64::from(self.opacity) / 255.0),
            filled: false,
            stroke_width: units(f64::from(self.width)).unsigned_abs(),
        }
    }
}

/// A colour of plotters.
pub(super) fn opaque([r, g, b]: Colour) -> RGBAColor {
    RGBAColor(r, g, b, 1.0)
}

impl Backend<'_> {
    fn pen<S: BackendStyle>(&self, style: &S) -> Pen {
        let BackendColor {
            rgb: (r, g, b),
            alpha,
        } = style.color();
        Pen {
            colour: [r, g, b],
            width: (f64::from(style.stroke_width()) / FINE) as f32,
            opacity: (255.0 * alpha).round() as u8,
            dashes: self.dashes,
        }
    }

    fn end_circles(&mut self) {
        let Some((radius, pen, is_filled)) = self.of_circles.take() else {
            return;
        };
        let circles = Mark::circles(&self.circles, radius, pen, is_filled);
        self.sheet.put(circles);
        self.circles.clear();
    }
}

impl Drop for Backend<'_> {
    fn drop(&mut self) {
        self.end_circles();
    }
}

type Done = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Backend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        // Every chart has its place by its coordinates.
        (i32::MAX as u32, i32::MAX as u32)
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        self.end_circles();
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> Done {
        let (x, y) = at;
        self.fill_polygon([at, (x + 1, y), (x + 1, y + 1), (x, y + 1)], &colour)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Done {
        self.end_circles();
        let positions: Vec<[f64; 2]> = path.into_iter().map(point).collect();
        let pen = self.pen(style);
        self.sheet.put(Mark::line(&positions, pen));
        Ok(())
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Done {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done {
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        if fill {
            return self.fill_polygon(corners, style);
        }
        self.draw_path(corners.into_iter().chain([(left, top)]), style)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Done {
        self.end_circles();
        let corners: Vec<[f64; 2]> = corners.into_iter().map(point).collect();
        let colour = self.pen(style).colour;
        self.sheet.put(Mark::area(&corners, colour));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Done {
        let pen = Pen {
            dashes: None,
            ..self.pen(style)
        };
        let of_circles = Some((f64::from(radius) / FINE, pen, fill));
        if self.of_circles != of_circles {
            self.end_circles();
            self.of_circles = of_circles;
        }
        self.circles.push(point(centre));
        Ok(())
    }
}
