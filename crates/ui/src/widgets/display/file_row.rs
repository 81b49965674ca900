//! A file or folder in a list.

use egui::{Color32, Rect, Response, Role, Sense, Ui, WidgetInfo, vec2};

use super::{Icon, format, paint};
use crate::theme::{font, metrics, tokens};

/// The name of a folder, or the name and size of a file.
#[must_use = "call `show`"]
pub struct FileRow<'a> {
    /// The name of the file.
    pub name: &'a str,
    /// Size of a file in bytes; `None` for a folder.
    pub bytes: Option<u64>,
    /// Whether it is the selected row.
    pub selected: bool,
}

impl FileRow<'_> {
    /// Shows the row in `rect`. Tests find it by its name, that of a folder with a slash.
    pub fn show(self, ui: &Ui, rect: Rect) -> Response {
        let t = tokens(ui);
        let name = if self.bytes.is_some() { self.name.to_owned() } else { format!("{}/", self.name) };
        let response = ui.interact(rect, ui.scope_id().with(("file row", &name)), Sense::CLICK);
        response
            .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, ui.is_enabled(), self.selected, &name));
        let (fill, ink, faint) = match (self.selected, response.hovered()) {
            (true, _) => (t.selected, t.on_selected, t.on_selected),
            (false, true) => (t.field, t.value, t.label),
            (false, false) => (Color32::TRANSPARENT, t.text, t.faint),
        };
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, fill);
        let inner = rect.shrink2(vec2(8.0, 0.0));
        let (icon, tint) = match self.bytes {
            Some(_) => (Icon::FILE, faint),
            None => (Icon::FOLDER, if self.selected { ink } else { t.accent }),
        };
        paint::at_left(ui, inner, paint::line(ui, icon.glyph(), font::icon(16.0), tint));
        let size = paint::line(
            ui,
            &self.bytes.map(format::file_size).unwrap_or_default(),
            font::small_value(),
            faint,
        );
        let room = inner.with_min_x(inner.left() + 26.0).with_max_x(inner.right() - size.size().x - 12.0);
        paint::at_right(ui, inner, size);
        paint::at_left(ui, room, paint::elided(ui, self.name, font::body(), ink, room.width()));
        response
    }
}
