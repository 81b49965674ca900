//! The area of a mask or a keep-out region for a person.

use egui::{Id, Ui};

use super::FrameState;
use meshbrush_core::earth::Ground;
use meshbrush_core::layers::Mask;
use meshbrush_ui::widgets::format;

/// Returns the area that a mask covers, with the unit of the document: on the Earth in the plane of a
/// projection.
pub fn area_text(ui: &Ui, state: &FrameState<'_>, mask: &Mask, digits: usize) -> String {
    format::area(area(ui, state, mask), state.unit(), digits)
}

fn area(ui: &Ui, state: &FrameState<'_>, mask: &Mask) -> f64 {
    let Some(projection) = state.session.document().settings().domain.projection else { return mask.area() };
    // The table of scales takes milliseconds: too long for every frame.
    let corners = [mask.bounds().min, mask.bounds().max].map(|corner| corner.to_array().map(f64::to_bits));
    let id = Id::unique(("area", mask.area().to_bits(), corners, projection.to_string()));
    let measured = || mask.area_on(&Ground::new(Some(&projection), &mask.bounds()));
    ui.data_mut(|data| *data.get_temp_mut_or_insert_with(id, measured))
}
