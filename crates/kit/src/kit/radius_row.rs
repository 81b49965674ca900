//! The radius of the brush as a row of a panel.

use egui::Ui;

use super::FrameState;
use crate::kit::command::{BrushCommand, Command};
use crate::kit::tools::FIRST_RADIUS;
use meshbrush_ui::widgets::SliderRow;

/// The radius of the brush, which the domain tool shares.
pub fn radius_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let domain = &state.session.document().settings().domain;
    let in_plane = domain.bounds.size().max_element();
    // The brush has its radius in the plane; a person reads and types it on the Earth.
    let on_earth = domain.on_earth(1.0, state.place());
    let extent = in_plane * on_earth;
    let mut radius = state.tools.radius * on_earth;
    let least = state.view.least_brush_radius(in_plane).min(0.5 * in_plane) * on_earth;
    let slider = SliderRow::new("Radius", &mut radius, least..=0.5 * extent)
        .logarithmic()
        .typed_range(least..=extent)
        .default(FIRST_RADIUS * in_plane * on_earth)
        .unit(state.unit().symbol());
    let help = "Radius of the brush, in the unit of the document; with a projection on the Earth, where the pointer or the \
                middle of the view is. Shift+drag changes it[, as do {smaller-brush} and {larger-brush}].";
    if slider.help(help).show(ui).changed() {
        commands.push(Command::from(BrushCommand::Radius(radius / on_earth)));
    }
}
