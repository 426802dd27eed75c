//! Camera images beneath meshes.

use std::collections::BTreeMap;

use eframe::egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};

use crate::logic::field::Photo;
use crate::views::surface::View;

/// The images that are on the graphics card: that at rest, and those of frames.
#[derive(Default)]
pub struct Photographs(BTreeMap<Option<usize>, TextureHandle>);

impl Photographs {
    /// Paints an image where it lies in mm, a little faded so that lines on it are seen.
    pub fn paint(
        &mut self,
        ui: &Ui,
        (view, area): (View, Rect),
        frame: Option<usize>,
        photo: &Photo,
    ) {
        let texture = self.0.entry(frame).or_insert_with(|| {
            let image = ColorImage::from_gray(photo.size, &photo.values);
            let name = format!("camera image {frame:?}");
            ui.ctx().load_texture(name, image, TextureOptions::LINEAR)
        });
        let [low, high] = photo.corners;
        let on_screen = Rect::from_two_pos(view.at(low), view.at(high));
        let texture_corners = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let painter = ui.painter().with_clip_rect(area);
        let faded = Color32::from_white_alpha(110);
        painter.image(texture.id(), on_screen, texture_corners, faded);
    }
}
