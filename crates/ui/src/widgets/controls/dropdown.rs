//! One of several choices, folded away.

use egui::{self, Response, Ui, UiBuilder};

use super::{Icon, paint};
use crate::theme::{font, metrics};
use crate::widgets::tips;

/// Shows a name and a drop-down list. `choices` are values with their names; the response has `changed` when
/// `value` did.
pub fn dropdown_row<T: PartialEq + Copy>(
    ui: &mut Ui,
    label: &str,
    value: &mut T,
    choices: &[(T, &str)],
) -> Response {
    let columns = paint::Columns::of(paint::row(ui));
    paint::label(ui, columns.label, label, "");
    let chosen = choices.iter().find(|(choice, _)| choice == value).map_or("", |(_, name)| name);
    let before = *value;
    let mut child = ui.new_child(UiBuilder::new().max_rect(columns.rest));
    let width = columns.rest.width();
    let list =
        egui::ComboBox::from_id_salt(("dropdown", label)).width(width).truncate().selected_text(chosen).icon(
            |ui, rect, visuals, _| {
                let arrow = paint::line(ui, Icon::OPENED.glyph(), font::icon(16.0), visuals.text_color());
                paint::at_centre(ui, rect, arrow);
            },
        );
    let mut response =
        child.name_inputs(label, |ui| list.show_ui(ui, |ui| entries(ui, value, choices)).response);
    if *value != before {
        response.mark_changed();
    }
    tips::explain(ui, response, tips::sentence(label))
}

fn entries<T: PartialEq + Copy>(ui: &mut Ui, value: &mut T, choices: &[(T, &str)]) {
    ui.spacing_mut().interact_size.y = metrics::ROW;
    for (choice, name) in choices {
        ui.selectable_value(value, *choice, *name);
    }
}
