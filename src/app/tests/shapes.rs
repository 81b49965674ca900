//! What a frame paints.

use eframe::egui::{FullOutput, Rect, Shape};

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
