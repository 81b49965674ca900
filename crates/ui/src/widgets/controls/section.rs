//! A section of a panel: title, note, contents that fold away.

use egui::collapsing_header::CollapsingState;
use egui::{self, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::{Icon, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::reveal;

/// A section of a panel with a title in small capitals.
///
/// A click on the title folds the contents away; egui's memory keeps that over restarts. A hair line ends the
/// section.
#[must_use = "call `show`"]
pub struct Section<'a> {
    title: &'a str,
    note: &'a str,
    id: &'a str,
    open: bool,
    reveal: bool,
}

impl<'a> Section<'a> {
    /// Creates a section that is open at first.
    pub fn new(title: &'a str) -> Self {
        Self { title, note: "", id: title, open: true, reveal: false }
    }

    /// Returns a faint note at the right of the title.
    pub fn note(mut self, note: &'a str) -> Self {
        self.note = note;
        self
    }

    /// Names the section where its title changes (`Triangle 18,204`).
    pub fn id(mut self, id: &'a str) -> Self {
        self.id = id;
        self
    }

    /// Folded away until it is opened for the first time.
    pub fn closed(mut self) -> Self {
        self.open = false;
        self
    }

    /// Opens the section now, and scrolls to it, as a click on the title of a closed section does.
    pub fn reveal(mut self, reveal: bool) -> Self {
        self.reveal = reveal;
        self
    }

    /// Shows the section. `contents` runs only while it is open; returns `None` while it is not.
    pub fn show<R>(self, ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> Option<R> {
        let id = ui.make_persistent_id(("section", self.id));
        let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, self.open);
        ui.add_space(12.0);
        let header = self.header(ui, id, state.is_open());
        let (reveals, mut scrolls) = reveal::of_section(ui, self.title, self.id);
        scrolls |= self.reveal;
        if self.reveal || reveals {
            state.set_open(true);
        } else if header.clicked() {
            state.set_open(!state.is_open());
            scrolls |= state.is_open();
        }
        let inner = state.is_open().then(|| {
            ui.add_space(4.0);
            ui.push_id(self.id, contents).inner
        });
        state.store(ui.ctx());
        if scrolls {
            scroll_to(ui, header.rect.with_max_y(ui.cursor().top()));
        }
        ui.add_space(12.0 - metrics::ROW_GAP);
        divider(ui);
        inner
    }

    fn header(&self, ui: &mut Ui, id: egui::Id, open: bool) -> Response {
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), 20.0));
        let response = ui.interact(rect, id.with("header"), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), self.title));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(open));
        self.paint(ui, rect, &response, open);
        response
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response, open: bool) {
        let t = tokens(ui);
        let lit = response.hovered() || response.has_focus();
        let note = paint::line(ui, self.note, font::caption(), t.label);
        let width = rect.width() - note.size().x - 32.0;
        let title = paint::small_caps(ui, self.title, if lit { t.text } else { t.label }, width);
        let arrow = if open { Icon::OPENED } else { Icon::CLOSED };
        let arrow = paint::line(ui, arrow.glyph(), font::icon(16.0), if lit { t.label } else { t.faint });
        let after_title =
            Rect::from_min_size(pos2(rect.left() + title.size().x + 3.0, rect.top()), vec2(16.0, 20.0));
        paint::focus_ring(ui, response, rect.expand2(vec2(4.0, 0.0)), 4);
        paint::at_left(ui, rect, title);
        paint::at_centre(ui, after_title, arrow);
        paint::at_right(ui, rect, note);
    }
}

/// Scrolls no further than needed for a section to be seen: its top, where it is taller than the panel.
fn scroll_to(ui: &Ui, section: Rect) {
    let is_tall = section.height() > ui.clip_rect().height();
    ui.scroll_to_rect(section, is_tall.then_some(egui::Align::TOP));
}

/// A hair line over the panel's full width, margins included.
fn divider(ui: &mut Ui) {
    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), 1.0));
    let line = rect.expand2(vec2(metrics::PANEL_MARGIN, 0.0));
    ui.painter().rect_filled(line, 0.0, tokens(ui).line);
}
