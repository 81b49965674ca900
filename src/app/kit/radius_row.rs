//! The radius of the brush as a row of a panel.

use eframe::egui::Ui;

use super::FrameState;
use crate::app::command::{BrushCommand, Command};
use crate::app::tools::Tools;
use crate::app::widgets::SliderRow;

/// The radius of the brush, which the domain tool shares.
pub fn radius_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let extent = state.session.document().settings().domain.bounds.size().max_element();
    let mut radius = state.tools.radius;
    let slider = SliderRow::new("Radius", &mut radius, 1e-4 * extent..=0.5 * extent)
        .logarithmic()
        .typed_range(1e-4 * extent..=extent)
        .default(Tools::for_domain(extent, 0.0).radius)
        .unit(state.unit().symbol());
    let help = "Radius of the brush, in the unit of the document. Shift+drag changes it[, as do {smaller-brush} and \
                {larger-brush}].";
    if slider.help(help).show(ui).changed() {
        commands.push(Command::Brush(BrushCommand::Radius(radius)));
    }
}
