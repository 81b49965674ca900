//! A short message about what a key did.

use std::time::Duration;

use eframe::egui::{Align2, Rect, Ui};

use meshbrush_ui::theme::tokens;
use meshbrush_ui::widgets::floating_tag;

/// How long it is shown, in seconds.
const SECONDS: f64 = 1.5;

/// What a key did, and until when that is shown, in egui's time.
#[derive(Clone, Debug)]
pub struct Toast {
    text: String,
    until: f64,
}

impl Toast {
    /// Creates a toast that is shown from `now` on, in egui's time.
    pub fn new(text: String, now: f64) -> Self {
        Self { text, until: now + SECONDS }
    }

    /// Shows it at the top of the canvas until its time is over. It takes no click.
    pub fn show(&self, ui: &Ui, inner: Rect) {
        let left = self.until - ui.input(|input| input.time);
        if left > 0.0 {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(left));
            floating_tag(ui, inner.center_top(), Align2::CENTER_TOP, inner, &self.text, tokens(ui).value);
        }
    }
}
