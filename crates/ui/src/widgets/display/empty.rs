//! A placeholder where there is nothing to show yet.

use egui::{RichText, Ui};

use super::{Icon, paint};
use crate::theme::{font, tokens};
use crate::widgets::shown_keys;

/// Shows an icon, a line that says what is missing, and one that says how to get it. A key is written as in
/// tips: as the id of its entry in braces.
pub fn empty_state(ui: &mut Ui, icon: Icon, title: &str, text: &str) {
    let t = tokens(ui);
    ui.vertical_centered(|ui| {
        ui.add_space(8.0);
        let (_, rect) = ui.allocate_space(egui::vec2(40.0, 32.0));
        paint::at_centre(ui, rect, paint::line(ui, icon.glyph(), font::icon(28.0), t.faint));
        ui.label(RichText::new(title).color(t.text));
        let text = shown_keys::with_keys(ui.ctx(), text);
        ui.label(RichText::new(text).font(font::caption()).color(t.faint));
        ui.add_space(8.0);
    });
}
