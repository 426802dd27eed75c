//! The grip: a bar at the right end that follows the mouse, a finger or the keys, and a knob that turns it.

use eframe::egui::{
    Color32, EventFilter, Id, Key, Painter, Pos2, Rect, Response, Role, Sense, Stroke, Ui, Vec2,
    WidgetInfo, vec2,
};

use super::surface::View;
use crate::logic::scene::{Grip, Scene};

/// What was done to the grip.
pub struct Held {
    /// Where it shall be; `None` where it stays.
    pub to: Option<Grip>,
    /// Whether it is held.
    pub holding: bool,
    /// Whether it was let go.
    pub released: bool,
    /// Where the middle of its bar is on the screen.
    pub at: Pos2,
}

/// Half the thickness of the bar, the distance of the knob from its end, and the least size of what is taken by a finger.
const BAR: f32 = 5.0;
const KNOB: f32 = 16.0;
const FINGER: f32 = 12.0;

/// How far a grip goes: a sheet is pressed to a twentieth at most, and stretched by the tenfold.
const SHORTEST: f64 = -0.95;
const LONGEST: f64 = 10.0;
const MOST_TURN: f64 = std::f64::consts::FRAC_PI_2;

/// A place of the grip within what is possible for a sheet.
pub fn within(grip: Grip, scene: &Scene) -> Grip {
    let length = scene.size[0];
    let [x, y] = grip.displacement;
    Grip {
        displacement: [
            x.clamp(SHORTEST * length, LONGEST * length),
            y.clamp(-LONGEST * length, LONGEST * length),
        ],
        angle: grip.angle.clamp(-MOST_TURN, MOST_TURN),
    }
}

/// Draws the grip of a sheet and returns what is done to it; `name` distinguishes it from those of other models.
pub fn show(ui: &Ui, scene: &Scene, view: View, name: &str) -> Held {
    let grip = scene.grip;
    let middle = [
        scene.size[0] + grip.displacement[0],
        scene.axis() + grip.displacement[1],
    ];
    let (sine, cosine) = grip.angle.sin_cos();
    let half = 0.5 * scene.size[1];
    let end = |side: f64| {
        view.at([
            middle[0] - side * half * sine,
            middle[1] + side * half * cosine,
        ])
    };
    let (top, bottom) = (end(1.0), end(-1.0));
    let along = (top - bottom).normalized();
    let knob = top + KNOB * along;

    let id = ui.scope_id().with(("grip", name));
    let bar = Rect::from_two_pos(top, bottom).expand(FINGER);
    let pulled = ui.interact(bar, id, Sense::click_and_drag());
    let round = Rect::from_center_size(knob, Vec2::splat(2.0 * FINGER));
    let turned = ui.interact(round, id.with("knob"), Sense::drag());
    let stretch = 100.0 * scene.stretch();
    pulled.widget_info(|| {
        let label = format!("grip of the {name}, stretch {stretch:.1} %, arrow keys move it, full stop and comma turn it");
        WidgetInfo::labeled(Role::Slider, true, label)
    });
    draw(ui.painter(), [bottom, top, knob], ui, [&pulled, &turned]);

    let to = moved(ui, &pulled, view, grip)
        .or_else(|| turn(ui, &turned, view.at(middle), grip))
        .or_else(|| by_keys(ui, &pulled, id, scene));
    Held {
        to: to.map(|to| within(to, scene)),
        holding: pulled.dragged() || turned.dragged(),
        released: pulled.drag_stopped() || turned.drag_stopped(),
        at: view.at(middle),
    }
}

fn draw(
    painter: &Painter,
    [bottom, top, knob]: [Pos2; 3],
    ui: &Ui,
    [pulled, turned]: [&Response; 2],
) {
    let colour = |response: &Response| ui.style().interact(response).fg_stroke.color;
    painter.line_segment([bottom, top], Stroke::new(2.0 * BAR, colour(pulled)));
    painter.line_segment([top, knob], Stroke::new(1.5, colour(turned)));
    painter.circle(
        knob,
        BAR,
        Color32::TRANSPARENT,
        Stroke::new(2.5, colour(turned)),
    );
    if pulled.has_focus() {
        let frame = Rect::from_two_pos(bottom, top).expand(2.0 * BAR);
        let stroke = ui.visuals().selection.stroke;
        painter.rect_stroke(frame, 3.0, stroke, eframe::egui::StrokeKind::Outside);
    }
    if pulled.hovered() || turned.hovered() {
        let icon = eframe::egui::CursorIcon::Grab;
        ui.ctx().set_cursor_icon(icon);
    }
}

fn moved(ui: &Ui, pulled: &Response, view: View, grip: Grip) -> Option<Grip> {
    if pulled.clicked() || pulled.drag_started() {
        pulled.request_focus();
    }
    let drag = pulled.drag_delta();
    if !pulled.dragged() || drag == Vec2::ZERO {
        return None;
    }
    let [mut dx, mut dy] = view.vector(drag);
    // With Shift along the axis alone, with Ctrl across it.
    let keys = ui.input(|input| input.modifiers);
    (dx, dy) = (
        if keys.command { 0.0 } else { dx },
        if keys.shift { 0.0 } else { dy },
    );
    let [x, y] = grip.displacement;
    Some(Grip {
        displacement: [x + dx, y + dy],
        ..grip
    })
}

/// The turn that brings the bar under the pointer.
fn turn(ui: &Ui, turned: &Response, middle: Pos2, grip: Grip) -> Option<Grip> {
    let pointer = ui.input(|input| input.pointer.latest_pos())?;
    let arm = pointer - middle;
    let wanted = turned.dragged() && arm.length() > 1.0;
    wanted.then(|| Grip {
        angle: f64::from((-arm.x).atan2(-arm.y)),
        ..grip
    })
}

/// Arrows move a grip that has the focus by 1 % of the length, with Shift by a tenth of that; comma and full stop turn it by 1°.
fn by_keys(ui: &Ui, pulled: &Response, id: Id, scene: &Scene) -> Option<Grip> {
    if !pulled.has_focus() {
        return None;
    }
    let arrows = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
    ui.input(|input| {
        let pressed = |more: Key, less: Key| {
            let [more, less] = [more, less].map(|key| input.num_presses(key) as f64);
            more - less
        };
        let direction = vec2(
            pressed(Key::ArrowRight, Key::ArrowLeft) as f32,
            pressed(Key::ArrowUp, Key::ArrowDown) as f32,
        );
        let turn = pressed(Key::Comma, Key::Period);
        let fine = if input.modifiers.shift { 0.1 } else { 1.0 };
        let step = 0.01 * scene.size[0] * fine;
        let [x, y] = scene.grip.displacement;
        let to = Grip {
            displacement: [
                x + step * f64::from(direction.x),
                y + step * f64::from(direction.y),
            ],
            angle: scene.grip.angle + (fine * turn).to_radians(),
        };
        (to != scene.grip).then_some(to)
    })
}
