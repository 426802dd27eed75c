//! The triangles between the nodes of a mesh, where they are on the screen, and their magnification by the wheel, two fingers and a pulled
//! background.

use eframe::egui::{
    Color32, InputState, Mesh as Triangles, Pos2, Rect, Response, Ui, Vec2, epaint::Vertex, pos2,
};

use gelbench::mesh::Mesh;

/// The nodes of the triangles that cover a mesh: between all nodes of quadrilaterals with nine, else between corners.
pub fn triangles(mesh: &Mesh) -> Vec<u32> {
    let mut all = Vec::new();
    for cell in 0..mesh.cell_count() {
        let nodes = mesh.cell(cell);
        let shape = mesh.shape(cell);
        let natural = shape.natural_nodes();
        let at = |x: f64, y: f64| natural.iter().position(|node| *node == [x, y]);
        let mut quadrilateral = |corners: [Option<usize>; 4]| {
            let [a, b, c, d] = corners.map(|local| local.map(|local| nodes[local] as u32));
            if let (Some(a), Some(b), Some(c), Some(d)) = (a, b, c, d) {
                all.extend([a, b, c, a, c, d]);
            }
        };
        if natural.len() == 9 {
            for (x, y) in [(-1.0, -1.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)] {
                let (right, above) = (x + 1.0, y + 1.0);
                quadrilateral([at(x, y), at(right, y), at(right, above), at(x, above)]);
            }
            continue;
        }
        for last in 2..shape.corners() {
            all.extend([0, last - 1, last].map(|local| nodes[local] as u32));
        }
    }
    all
}

/// From mm to the screen: Y up, the same scale along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    origin: Pos2,
    scale: f32,
}

impl View {
    /// Fits a rectangle of the sheet's plane, in mm, into one of the screen.
    pub fn fit([[left, bottom], [right, top]]: [[f64; 2]; 2], screen: Rect) -> Self {
        let [width, height] = [right - left, top - bottom].map(|size| size.max(1e-9) as f32);
        let scale = (screen.width() / width)
            .min(screen.height() / height)
            .max(1e-6);
        let middle = [0.5 * (left + right), 0.5 * (bottom + top)].map(|position| position as f32);
        Self {
            origin: pos2(
                screen.center().x - scale * middle[0],
                screen.center().y + scale * middle[1],
            ),
            scale,
        }
    }

    /// The view magnified by a factor about a position of the screen, then shifted.
    #[must_use]
    pub fn closer(self, about: Pos2, factor: f32, shift: Vec2) -> Self {
        Self {
            origin: about + factor * (self.origin - about) + shift,
            scale: factor * self.scale,
        }
    }

    /// The point of the screen of a position in mm.
    pub fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        pos2(
            self.origin.x + self.scale * x as f32,
            self.origin.y - self.scale * y as f32,
        )
    }

    /// The position in mm of a point of the screen.
    pub fn position(&self, on_screen: Pos2) -> [f64; 2] {
        self.vector(on_screen - self.origin)
    }

    /// A vector on the screen in mm.
    pub fn vector(&self, on_screen: eframe::egui::Vec2) -> [f64; 2] {
        [on_screen.x, -on_screen.y].map(|length| f64::from(length / self.scale))
    }
}

/// The magnification of a sheet, and the shift of its middle in points.
#[derive(Clone, Copy, PartialEq)]
pub struct Closer {
    factor: f32,
    shift: Vec2,
}

impl Default for Closer {
    fn default() -> Self {
        Self {
            factor: 1.0,
            shift: Vec2::ZERO,
        }
    }
}

/// The factors within which a sheet is looked at, and the points of a wheel that make e of one.
const FACTORS: [f32; 2] = [0.5, 50.0];
const WHEEL: f32 = 250.0;

impl Closer {
    /// The magnified part of a view of the complete sheet; `middle` is that of the sheet.
    pub fn of(self, full: View, middle: Pos2) -> View {
        full.closer(middle, self.factor, self.shift)
    }

    /// Follows the wheel, two fingers, and the pointer that pulls the background; a double click shows the complete sheet again.
    pub fn follow(&mut self, ui: &Ui, background: &Response, middle: Pos2) {
        if background.double_clicked() {
            *self = Self::default();
        }
        self.shift += background.drag_delta();
        let pointer = background.hover_pos();
        let Some(pointer) = pointer.filter(|_| background.contains_pointer()) else {
            return;
        };
        let wheel = ui.input(|input| input.smooth_scroll_delta().y);
        let factor = ui.input(InputState::zoom_delta) * (wheel / WHEEL).exp();
        let [least, most] = FACTORS.map(|factor| factor / self.factor);
        let factor = factor.clamp(least, most);
        self.factor *= factor;
        // What lies under the pointer stays there.
        let from_middle = pointer - middle;
        self.shift = from_middle - factor * (from_middle - self.shift);
    }
}

/// A deformed mesh on the screen, its nodes coloured.
pub fn draw(
    mesh: &Mesh,
    triangles: &[u32],
    displacement: &[f64],
    view: View,
    colour: impl Fn(usize) -> Color32,
) -> Triangles {
    let nodes = mesh
        .nodes
        .iter()
        .zip(displacement.chunks_exact(2))
        .enumerate();
    let vertices = nodes.map(|(node, ([x, y], u))| Vertex {
        pos: view.at([x + u[0], y + u[1]]),
        uv: eframe::egui::epaint::WHITE_UV,
        color: colour(node),
    });
    Triangles {
        vertices: vertices.collect(),
        indices: triangles.to_vec(),
        ..Triangles::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gelbench::mesh::{CellShape, Shape};

    #[test]
    fn the_triangles_cover_the_sheet_once() {
        let shape = Shape::Strip { size: [3.0, 1.0] };
        for (name, kind) in CellShape::NAMES {
            let mesh = shape.mesh(2, kind);
            let area = |t: &[u32]| {
                let [a, b, c] = [t[0], t[1], t[2]].map(|node| mesh.nodes[node as usize]);
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            };
            let triangles = triangles(&mesh);
            let all: f64 = triangles.chunks_exact(3).map(area).sum();
            assert!((all - 3.0).abs() < 1e-12, "{name}: {all}");
            let used: std::collections::BTreeSet<_> = triangles.iter().collect();
            assert!(kind != CellShape::Quad9 || used.len() == mesh.nodes.len());
        }
    }

    #[test]
    fn a_way_on_the_screen_is_the_way_of_the_places() {
        let screen = Rect::from_min_max(pos2(10.0, 20.0), pos2(310.0, 120.0));
        let view = View::fit([[0.0, 0.0], [150.0, 40.0]], screen);
        let arrow = view.at([30.0, 20.0]) - view.at([20.0, 15.0]);
        let [x, y] = view.vector(arrow);
        assert!((x - 10.0).abs() < 1e-4 && (y - 5.0).abs() < 1e-4);
        let [x, y] = view.position(view.at([30.0, 20.0]));
        assert!((x - 30.0).abs() < 1e-4 && (y - 20.0).abs() < 1e-4);
        assert!(screen.contains(view.at([0.0, 0.0])) && screen.contains(view.at([150.0, 40.0])));
    }
}
