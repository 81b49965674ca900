//! One of several choices, all in sight.

use egui::{Response, Role, Sense, Stroke, Ui, WidgetInfo, pos2};

use super::paint;
use crate::theme::{font, tokens};
use crate::widgets::tips;

/// Shows a name, and below it the choices in two columns, one of them chosen. `choices` are values with their
/// names; the response has `changed` when `value` did.
pub fn choice_rows<T: PartialEq + Copy>(
    ui: &mut Ui,
    name: &str,
    value: &mut T,
    choices: &[(T, &str)],
) -> Response {
    let row = paint::row(ui);
    let mut group = ui.interact(row, ui.make_persistent_id(("choices", name)), Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(Role::RadioGroup, ui.is_enabled(), name));
    paint::at_left(ui, row, paint::line(ui, name, font::caption(), tokens(ui).label));
    let before = *value;
    for pair in choices.chunks(2) {
        ui.columns(2, |columns| {
            for ((choice, label), ui) in pair.iter().zip(columns) {
                if choice_row(ui, name, label, *choice == before).clicked() {
                    *value = *choice;
                }
            }
        });
    }
    if *value != before {
        group.mark_changed();
    }
    group
}

fn choice_row(ui: &mut Ui, group: &str, label: &str, is_chosen: bool) -> Response {
    let t = tokens(ui);
    let row = paint::row(ui);
    let response = ui.interact(row, ui.make_persistent_id(("choice", group, label)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, ui.is_enabled(), is_chosen, label));
    let middle = pos2(row.left() + 8.0, row.center().y);
    let edge = if is_chosen { t.selected } else { t.faint };
    let fill = if response.hovered() { t.hover } else { t.field };
    ui.painter().circle(middle, 7.0, if is_chosen { t.selected } else { fill }, Stroke::new(1.0, edge));
    if is_chosen {
        ui.painter().circle_filled(middle, 3.0, t.on_selected);
    }
    paint::focus_ring(ui, &response, row, 4);
    let ink = if response.hovered() || is_chosen { t.value } else { t.text };
    let text = row.with_min_x(row.left() + 22.0);
    paint::at_left(ui, text, paint::elided(ui, label, font::body(), ink, text.width()));
    tips::explain(ui, response, tips::sentence(&format!("{group}/{label}")))
}
