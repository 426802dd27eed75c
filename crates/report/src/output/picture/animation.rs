//! Fields that move, as an animated PNG: every browser plays it, and other programs show its first picture.

use png::{BlendOp, DisposeOp, Writer};
use tiny_skia::Pixmap;

use super::encode::{Part, colours, encoder, full};
use super::look::Look;
use super::marks::DrawResult;
use super::paint::Painter;
use crate::results::{Animation, FieldFigure, Panel, Scale};

impl Animation {
    /// The animation as an APNG that plays again and again; of every picture only the part that moves is stored.
    pub(super) fn png(&self, look: Look) -> DrawResult<Vec<u8>> {
        let first = self.frames.first().ok_or("it has no frames")?;
        let all = self.frames.iter().flat_map(|frame| &frame.panels);
        let together = self.figure(first.time, all.cloned().collect());
        let plan = together.plan(look, first.panels.len())?;
        let pictures = self.frames.iter().map(|frame| {
            let figure = self.figure(frame.time, frame.panels.clone());
            let mut painter = Painter::new(plan.size(), look.paper(), 1.0)?;
            figure.paint(&mut painter, &plan);
            let marks = figure.marks(&plan);
            marks.iter().for_each(|mark| painter.draw(mark));
            Ok(painter.image)
        });
        self.encode(pictures)
    }

    fn figure(&self, time: f64, panels: Vec<Panel>) -> FieldFigure {
        FieldFigure {
            title: format!("{}, t = {time:.3} s", self.title),
            quantity: self.quantity.clone(),
            scale: Scale::Linear,
            range: None,
            panels,
        }
    }

    fn encode(
        &self,
        mut pictures: impl Iterator<Item = DrawResult<Pixmap>>,
    ) -> DrawResult<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut shown = pictures.next().ok_or("it has no frames")??;
        let count = u32::try_from(self.frames.len()).unwrap_or(u32::MAX);
        let mut encoder = encoder(&mut bytes, &shown);
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(self.milliseconds, 1000)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&colours(&shown, full(&shown)))?;
        for picture in pictures {
            let picture = picture?;
            put(&mut writer, &picture, changed(&shown, &picture))?;
            shown = picture;
        }
        writer.finish()?;
        Ok(bytes)
    }
}

fn put(
    writer: &mut Writer<&mut Vec<u8>>,
    picture: &Pixmap,
    part: Part,
) -> Result<(), png::EncodingError> {
    let [left, top, width, height] = part;
    // The position is held against the size that was set last.
    writer.reset_frame_position()?;
    writer.set_frame_dimension(width, height)?;
    writer.set_frame_position(left, top)?;
    writer.write_image_data(&colours(picture, part))
}

/// The smallest part that holds all differences; one pixel where there are none.
fn changed(before: &Pixmap, after: &Pixmap) -> Part {
    let width = after.width();
    let pairs = before
        .data()
        .chunks_exact(4)
        .zip(after.data().chunks_exact(4));
    let different = pairs.enumerate().filter(|(_, (a, b))| a != b);
    let start = [u32::MAX, u32::MAX, 0, 0];
    let [left, top, right, bottom] =
        different.fold(start, |[left, top, right, bottom], (index, _)| {
            let index = index as u32;
            let (x, y) = (index % width, index / width);
            [left.min(x), top.min(y), right.max(x), bottom.max(y)]
        });
    if left == u32::MAX {
        return [0, 0, 1, 1];
    }
    [left, top, right - left + 1, bottom - top + 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Frame, PictureStyle};

    fn animation() -> Animation {
        let frame = |step: u32| {
            let x = f64::from(step);
            let corners = [[x, 0.0], [x + 10.0, 0.0], [x + 10.0, 5.0], [x, 5.0]];
            Frame {
                time: 0.1 * x,
                panels: vec![Panel::quadrilaterals("a square", &[(corners, x)])],
            }
        };
        Animation {
            title: "Test".into(),
            quantity: "x [mm]".into(),
            frames: (0..4).map(frame).collect(),
            milliseconds: 40,
        }
    }

    #[test]
    fn an_animation_holds_its_frames_and_is_the_same_each_time() {
        let bytes = animation().png(Look::of(&PictureStyle::default())).unwrap();
        assert_eq!(
            bytes,
            animation().png(Look::of(&PictureStyle::default())).unwrap()
        );
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .unwrap();
        let info = reader.info();
        assert_eq!(
            info.animation_control().map(|control| control.num_frames),
            Some(4)
        );
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        let mut parts = Vec::new();
        for _ in 0..4 {
            reader.next_frame(&mut buffer).unwrap();
            let control = *reader.info().frame_control().unwrap();
            assert_eq!((control.delay_num, control.delay_den), (40, 1000));
            parts.push(control.width * control.height);
        }
        assert!(
            parts[1..]
                .iter()
                .all(|part| *part > 100 && *part < parts[0]),
            "{parts:?}"
        );
    }

    #[test]
    fn the_changed_part_is_the_smallest_that_holds_all_differences() {
        let before = Pixmap::new(5, 4).unwrap();
        let mut after = before.clone();
        after.data_mut()[4 * (5 + 2)] = 9;
        after.data_mut()[4 * (3 * 5 + 3)] = 9;
        assert_eq!(changed(&before, &after), [2, 1, 2, 3]);
        assert_eq!(changed(&before, &before), [0, 0, 1, 1]);
    }
}
