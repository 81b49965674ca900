//! Drawings as pictures.

use super::Image;
use super::skia::{paint, path_of};
use meshbrush_study::drawing::{Drawing, DrawnShape};

/// Returns a drawing with so many pixels for a unit of its lengths, smoothed at its outlines.
pub fn picture_of(drawing: &Drawing, scale: f64) -> Image {
    let size = drawing.size.map(|length| (scale * length).round().max(1.0) as u32);
    let [r, g, b] = drawing.ground;
    let mut image = Image::filled(size, [r, g, b, 0xff]);
    // In an opaque picture, premultiplied and plain colours are the same.
    if let Some(mut pixmap) = tiny_skia::PixmapMut::from_bytes(&mut image.rgba, size[0], size[1]) {
        for shape in drawing.groups.iter().flat_map(|group| &group.shapes) {
            draw(&mut pixmap, shape, scale as f32);
        }
    }
    image
}

fn draw(pixmap: &mut tiny_skia::PixmapMut<'_>, shape: &DrawnShape, scale: f32) {
    let Some(path) = path_of(&shape.parts) else { return };
    let scaled = tiny_skia::Transform::from_scale(scale, scale);
    if let Some(fill) = shape.fill {
        pixmap.fill_path(&path, &paint(fill), tiny_skia::FillRule::Winding, scaled, None);
    }
    if let Some((color, width)) = shape.line {
        let stroke = tiny_skia::Stroke {
            width: width as f32,
            line_join: tiny_skia::LineJoin::Round,
            line_cap: tiny_skia::LineCap::Round,
            ..tiny_skia::Stroke::default()
        };
        pixmap.stroke_path(&path, &paint(color), &stroke, scaled, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_study::drawing::{DrawingGroup, OutlinePart};

    #[test]
    fn shapes_are_drawn_in_their_order_at_their_places() {
        let mut group = DrawingGroup::new("shapes");
        let square = [[10.0, 10.0], [30.0, 10.0], [30.0, 30.0], [10.0, 30.0]];
        group.polygon(&square, Some([200, 0, 0, 255]), Some(([0, 0, 200, 255], 2.0)));
        group.disc([20.0, 20.0], 5.0, [0, 200, 0, 255], ([0, 200, 0, 255], 0.5));
        group.line(&[[40.0, 5.0], [40.0, 35.0]], [255, 255, 255, 128], 4.0);
        let parts = vec![
            OutlinePart::Move([50.0, 35.0]),
            OutlinePart::Quadratic([[60.0, 5.0], [70.0, 35.0]]),
            OutlinePart::Close,
        ];
        group.shapes.push(DrawnShape { parts, fill: Some([9, 9, 200, 255]), line: None });
        let drawing =
            Drawing { size: [80.0, 40.0], title: String::new(), ground: [1, 2, 3], groups: vec![group] };
        let image = picture_of(&drawing, 2.0);
        assert_eq!(image.size, [160, 80]);
        let at = |x: u32, y: u32| image.pixel(2 * x, 2 * y);
        assert_eq!(at(2, 2), [1, 2, 3, 255]);
        assert_eq!(at(13, 13), [200, 0, 0, 255]);
        assert_eq!(at(10, 20), [0, 0, 200, 255]);
        assert_eq!(at(22, 18), [0, 200, 0, 255]);
        let [r, g, b, _] = at(40, 20);
        assert!((120..=136).contains(&r) && g.abs_diff(r) < 3 && b.abs_diff(r) < 3, "{r} {g} {b}");
        assert_eq!(at(60, 28), [9, 9, 200, 255], "below the curve");
        assert_eq!(at(60, 15), [1, 2, 3, 255], "above it, where its control point is");
    }
}
