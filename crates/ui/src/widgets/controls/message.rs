//! Sentences about what was typed.

use egui::{self, Area, Frame, Id, Margin, Order, Rect, RectAlign, Role, Stroke, Ui, WidgetInfo};

use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// Width at which a sentence is broken into lines, in points.
const WIDTH: f32 = 260.0;

/// Shows a sentence about the contents of `field`: beside the panel that the field is in, or else above the
/// field. It covers no control and takes no room, so that nothing moves under the pointer, and takes no
/// click.
pub(super) fn message(ui: &Ui, id: Id, field: Rect, text: &str) {
    if !ui.is_rect_visible(field) {
        return;
    }
    let window = ui.ctx().content_rect();
    let place = tips::place(ui.clip_rect(), window, field);
    let (beside, align) = place.unwrap_or((field, RectAlign::TOP_START));
    let (pivot, corner) = align.pivot_pos(&beside, 8.0);
    // Above panels, and above the dialog that the field is in.
    let order = if ui.layer_id().order == Order::Background { Order::Middle } else { Order::Tooltip };
    let area = Area::new(id.with("message")).order(order).interactable(false).fade_in(false);
    area.constrain_to(window).pivot(pivot).fixed_pos(corner).show(ui.ctx(), |ui| contents(ui, text));
}

fn contents(ui: &mut Ui, text: &str) {
    let t = *tokens(ui);
    let edge = Stroke::new(1.0, t.line.lerp_to_gamma(t.danger, 0.6));
    let frame = Frame::new().fill(t.popup).stroke(edge).corner_radius(metrics::RADIUS_CONTROL);
    frame.shadow(t.tag_shadow()).inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        let galley = ui.painter().layout(text.to_owned(), font::caption(), t.danger, WIDTH);
        let response = ui.add(egui::Label::new(galley).selectable(false));
        response.widget_info(|| WidgetInfo::labeled(Role::Alert, true, text));
    });
}
