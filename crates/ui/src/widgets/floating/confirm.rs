//! Dialogs and questions.

use egui::{self, Align, Context, Frame, Id, Layout, Margin, RichText, Ui};

use crate::theme::{font, tokens, tokens_of};
use crate::widgets::{ActionButton, ButtonKind};

/// How a [`ConfirmDialog`] was answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConfirmAnswer {
    /// Do it.
    Confirmed,
    /// Do the other thing.
    Alternative,
    /// Change nothing: the Cancel button, Escape, or a click outside.
    Cancelled,
}

/// Shows a dialog over the dimmed window, which must be answered or closed first.
pub fn dialog<R>(ctx: &Context, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> egui::ModalResponse<R> {
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(20));
    let modal = egui::Modal::new(Id::unique(name)).frame(frame).backdrop_color(tokens_of(ctx).scrim);
    modal.show(ctx, contents)
}

/// The title of a [`dialog`].
pub fn dialog_title(ui: &mut Ui, title: &str) {
    let font = egui::FontId { size: 15.0, ..font::strong() };
    ui.label(RichText::new(title).font(font).color(tokens(ui).value));
}

/// A question over the window. Show it in every frame until it is answered.
///
/// Enter takes the button that has the focus: at first the main one, or Cancel where something would be
/// destroyed.
#[must_use = "call `show`"]
pub struct ConfirmDialog<'a> {
    title: &'a str,
    body: &'a str,
    confirm: &'a str,
    alternative: Option<&'a str>,
    cancel: &'a str,
    danger: bool,
}

impl<'a> ConfirmDialog<'a> {
    /// Creates a question, an explanation, and the verb on the button that confirms (`Discard`).
    pub fn new(title: &'a str, body: &'a str, confirm: &'a str) -> Self {
        Self { title, body, confirm, alternative: None, cancel: "Cancel", danger: false }
    }

    /// Returns a third answer, at the left (`Do not save`).
    pub fn alternative(mut self, text: &'a str) -> Self {
        self.alternative = Some(text);
        self
    }

    /// Returns the word on the button that changes nothing; `Cancel` by default.
    pub fn cancel(mut self, text: &'a str) -> Self {
        self.cancel = text;
        self
    }

    /// Confirming destroys something.
    pub fn danger(mut self) -> Self {
        self.danger = true;
        self
    }

    /// Shows the dialog and returns the answer given in this frame.
    pub fn show(self, ctx: &Context) -> Option<ConfirmAnswer> {
        let shown = dialog(ctx, "confirm dialog", |ui| self.contents(ui));
        let closed = shown.should_close().then_some(ConfirmAnswer::Cancelled);
        shown.inner.or(closed)
    }

    fn contents(&self, ui: &mut Ui) -> Option<ConfirmAnswer> {
        let t = tokens(ui);
        ui.set_width(380.0);
        dialog_title(ui, self.title);
        ui.add_space(4.0);
        ui.label(RichText::new(self.body).color(t.label));
        ui.add_space(16.0);
        ui.horizontal(|ui| {
            let left = self.alternative.filter(|text| ui.add(ActionButton::new(text)).clicked());
            let right =
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| self.right_buttons(ui)).inner;
            right.or(left.map(|_| ConfirmAnswer::Alternative))
        })
        .inner
    }

    fn right_buttons(&self, ui: &mut Ui) -> Option<ConfirmAnswer> {
        let kind = if self.danger { ButtonKind::Danger } else { ButtonKind::Main };
        let confirm = ui.add(ActionButton::new(self.confirm).kind(kind));
        let cancel = ui.add(ActionButton::new(self.cancel));
        if ui.memory(|memory| memory.focused().is_none()) {
            if self.danger { cancel.request_focus() } else { confirm.request_focus() }
        }
        match (confirm.clicked(), cancel.clicked()) {
            (true, _) => Some(ConfirmAnswer::Confirmed),
            (_, true) => Some(ConfirmAnswer::Cancelled),
            _ => None,
        }
    }
}
