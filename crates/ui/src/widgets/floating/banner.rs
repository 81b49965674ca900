//! A message that stays until it is dismissed.

use egui::{self, Align, Color32, Layout, Margin, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::{Icon, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::vanished::guard;
use crate::widgets::{ActionButton, ToolButton};

/// The kinds of [`Banner`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BannerKind {
    /// Something failed.
    Error,
    /// News.
    Info,
}

/// The answer of [`Banner::show`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BannerAnswer {
    /// Nothing was clicked.
    Open,
    /// The cross was clicked.
    Dismissed,
    /// The button was clicked.
    Acted,
    /// The second button was clicked.
    ActedOtherwise,
}

/// A sentence with an icon, a cross to dismiss it, and possibly a button.
#[must_use = "call `show`"]
pub struct Banner<'a> {
    kind: BannerKind,
    text: &'a str,
    action: Option<&'a str>,
    other: Option<&'a str>,
    stands: bool,
}

impl<'a> Banner<'a> {
    /// Something failed; `text` says what, why, and what helps.
    pub fn error(text: &'a str) -> Self {
        Self { kind: BannerKind::Error, text, action: None, other: None, stands: false }
    }

    /// News.
    pub fn info(text: &'a str) -> Self {
        Self { kind: BannerKind::Info, text, action: None, other: None, stands: false }
    }

    /// Returns a button that helps.
    pub fn action(mut self, action: &'a str) -> Self {
        self.action = Some(action);
        self
    }

    /// Returns a second button, left of the first.
    pub fn other(mut self, other: &'a str) -> Self {
        self.other = Some(other);
        self
    }

    /// Removes the cross: the banner disappears when it is no longer true.
    pub fn standing(mut self) -> Self {
        self.stands = true;
        self
    }

    /// Shows the banner over the full width; its height follows the text.
    pub fn show(self, ui: &mut Ui) -> BannerAnswer {
        let t = tokens(ui);
        let (icon, color) = match self.kind {
            BannerKind::Error => (Icon::ERROR, t.danger),
            BannerKind::Info => (Icon::INFO, t.accent),
        };
        let frame = egui::Frame::new()
            .fill(t.popup)
            .stroke(Stroke::new(1.0, t.line.lerp_to_gamma(color, 0.35)))
            .corner_radius(metrics::RADIUS_PANEL)
            .shadow(t.tag_shadow())
            .inner_margin(Margin { left: 12, right: 6, top: 6, bottom: 6 });
        frame.show(ui, |ui| self.contents(ui, icon, color)).inner
    }

    fn contents(&self, ui: &mut Ui, icon: Icon, color: Color32) -> BannerAnswer {
        let buttons = [self.action, self.other].into_iter().flatten();
        let button: f32 = buttons.map(|label| action_width(ui, label) + 8.0).sum();
        let cross = if self.stands { 0.0 } else { metrics::ROW };
        let room = ui.available_width() - 28.0 - button - cross - 8.0;
        let text = ui.painter().layout(self.text.to_owned(), font::body(), tokens(ui).text, room);
        let height = text.size().y.max(metrics::ROW) + 4.0;
        let (id, rect) = ui.allocate_space(vec2(ui.available_width(), height));
        let response = ui.interact(rect, id, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Alert, true, self.text));
        let first_line = Rect::from_min_size(rect.min, vec2(20.0, height.min(metrics::ROW + 4.0)));
        paint::at_left(ui, first_line, paint::line(ui, icon.glyph(), font::icon(18.0), color));
        let corner = pos2(rect.left() + 28.0, rect.center().y - text.size().y / 2.0);
        ui.painter().galley(corner.round(), text, color);
        self.buttons(ui, rect)
    }

    fn buttons(&self, ui: &mut Ui, rect: Rect) -> BannerAnswer {
        let builder = egui::UiBuilder::new().max_rect(rect).layout(Layout::right_to_left(Align::Center));
        let mut child = ui.new_child(builder);
        if !self.stands {
            let dismiss = ToolButton::small(Icon::CLOSE, "Dismiss").show(&mut child);
            guard(&dismiss);
            if dismiss.clicked() {
                return BannerAnswer::Dismissed;
            }
        }
        let mut clicked = |label: Option<&str>| {
            label.is_some_and(|l| child.add(ActionButton::new(l).vanishing()).clicked())
        };
        match (clicked(self.action), clicked(self.other)) {
            (true, _) => BannerAnswer::Acted,
            (_, true) => BannerAnswer::ActedOtherwise,
            _ => BannerAnswer::Open,
        }
    }
}

fn action_width(ui: &Ui, action: &str) -> f32 {
    paint::line(ui, action, font::body(), Color32::PLACEHOLDER).size().x + 24.0
}
