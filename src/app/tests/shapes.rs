//! What a frame paints.

use eframe::egui::{Color32, FullOutput, Rect, Shape};

/// Returns the single shapes of a frame, from the back to the front.
pub fn painted_shapes(frame: &FullOutput) -> Vec<&Shape> {
    fn add<'a>(shape: &'a Shape, all: &mut Vec<&'a Shape>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| add(shape, all)),
            single => all.push(single),
        }
    }
    let mut all = Vec::new();
    frame.shapes.iter().for_each(|clipped| add(&clipped.shape, &mut all));
    all
}

/// Returns the texts among them that are seen, with their rectangles.
pub fn painted_texts(frame: &FullOutput) -> Vec<(String, Rect)> {
    let seen = painted_shapes(frame).into_iter().filter_map(|shape| match shape {
        Shape::Text(text) if text.opacity_factor > 0.0 => {
            Some((text.galley.text().to_owned(), shape.visual_bounding_rect()))
        }
        _ => None,
    });
    seen.collect()
}

/// Returns the sum of the radii of the circles among them that are filled with a colour, in points.
pub fn painted_radii(frame: &FullOutput, fill: Color32) -> f32 {
    let radii = painted_shapes(frame).into_iter().filter_map(|shape| match shape {
        Shape::Circle(circle) if circle.fill == fill => Some(circle.radius),
        _ => None,
    });
    radii.sum()
}
