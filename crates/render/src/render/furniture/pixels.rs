//! Draws a sheet into a picture of pixels.

use tiny_skia::{FillRule, LineCap, LineJoin, PathBuilder, PixmapMut, Stroke, Transform};

use super::glyphs;
use super::sheet::{Sheet, SheetMark};
use crate::render::Image;
use crate::render::skia::{paint, path_of};

/// Returns the picture of a sheet on a ground, with a map that was drawn in its size. Colours are red, green,
/// blue and opacity, premultiplied.
pub fn draw_sheet(sheet: &Sheet, map: &Image, ground: [u8; 4]) -> Image {
    let mut image = Image::filled(sheet.size, ground);
    let [x, y] = sheet.map_at.map(|side| side as usize);
    let (width, row) = (sheet.size[0] as usize, map.size[0] as usize);
    let pixels = image.pixels_mut();
    for (line, from) in map.pixels().chunks_exact(row).enumerate() {
        let begin = (y + line) * width + x;
        pixels[begin..begin + row].copy_from_slice(from);
    }
    let [width, height] = image.size;
    if let Some(mut pixmap) = PixmapMut::from_bytes(&mut image.rgba, width, height) {
        sheet.marks.iter().for_each(|mark| draw_mark(&mut pixmap, mark));
    }
    image
}

fn draw_mark(pixmap: &mut PixmapMut<'_>, mark: &SheetMark) {
    let identity = Transform::identity();
    match mark {
        SheetMark::Fill { corners: [from, to], color } => {
            let sides = [from.x, from.y, to.x, to.y].map(|side| side as f32);
            let rect = tiny_skia::Rect::from_ltrb(sides[0], sides[1], sides[2], sides[3]);
            if let Some(rect) = rect {
                pixmap.fill_rect(rect, &paint(opaque(*color)), identity, None);
            }
        }
        SheetMark::Line { points, width, color } => {
            let mut line = PathBuilder::new();
            let [Some(first), Some(last)] = [points.first(), points.last()] else { return };
            line.move_to(first.x as f32, first.y as f32);
            points[1..].iter().for_each(|at| line.line_to(at.x as f32, at.y as f32));
            if first == last && points.len() > 2 {
                line.close();
            }
            let stroke = Stroke {
                width: *width as f32,
                line_cap: LineCap::Butt,
                line_join: LineJoin::Miter,
                ..Stroke::default()
            };
            if let Some(path) = line.finish() {
                pixmap.stroke_path(&path, &paint(opaque(*color)), &stroke, identity, None);
            }
        }
        SheetMark::Text { at, size, text, color } => {
            if let Some(path) = path_of(&glyphs::outline(text, *at, *size)) {
                pixmap.fill_path(&path, &paint(opaque(*color)), FillRule::Winding, identity, None);
            }
        }
    }
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 0xff]
}

/// Returns a picture with plain colours, as files have them, from one with colours that are multiplied by
/// their opacity.
pub fn without_premultiplication(mut image: Image) -> Image {
    for [r, g, b, opacity] in image.pixels_mut() {
        if (1..0xff).contains(opacity) {
            let plain = |value: u8| (f32::from(value) * 255.0 / f32::from(*opacity)).round().min(255.0) as u8;
            [*r, *g, *b] = [*r, *g, *b].map(plain);
        }
    }
    image
}
