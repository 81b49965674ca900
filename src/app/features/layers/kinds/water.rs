//! The rows that layers on the width of the water share.

use eframe::egui::Ui;

use meshbrush_kit::kit::{FrameState, remark};
use meshbrush_ui::widgets::NumberRow;

/// The numbers of a layer, and a sentence for each.
pub struct WaterRows {
    pub across: f64,
    /// The least and the greatest width that count.
    pub between: [f64; 2],
    pub across_help: &'static str,
    pub from_help: &'static str,
    pub to_help: &'static str,
}

/// Numbers that were changed, where they are valid.
pub struct ChangedWater {
    pub across: f64,
    /// `None` where the widths stay as they are.
    pub between: Option<[f64; 2]>,
}

impl WaterRows {
    /// Shows the rows, and returns the numbers if somebody changed them.
    pub fn show(self, ui: &mut Ui, state: &FrameState<'_>) -> Option<ChangedWater> {
        let Self { mut across, between: [mut from, mut to], across_help, from_help, to_help } = self;
        let unit = state.unit().symbol();
        let row = NumberRow::new("Triangles across", &mut across).range(1.0..=1000.0);
        let is_number_changed = row.help(across_help).show(ui).changed();
        let row = NumberRow::new("Widths from", &mut from).range(f64::MIN_POSITIVE..=to).unit(unit);
        let mut are_widths_changed = row.help(from_help).show(ui).changed();
        let row = NumberRow::new("Widths to", &mut to).range(from..=f64::MAX).unit(unit);
        are_widths_changed |= row.help(to_help).show(ui).changed();
        if state.session.document().settings().domain.region().is_none() {
            remark(ui, "The domain has no coast, as it has no polygons: the layer asks for nothing.");
        }
        let are_valid = from > 0.0 && from < to;
        let is_changed = is_number_changed || are_widths_changed && are_valid;
        is_changed.then(|| ChangedWater { across, between: are_widths_changed.then_some([from, to]) })
    }
}
