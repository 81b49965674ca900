//! Sections and controls that are put in sight, as when a person chose them in the command palette.

use egui::{Align, Context, Id, Rect, Stroke, StrokeKind, Ui};

use crate::theme::{metrics, tokens};

/// Passes in which the panel scrolls: a section opens in the first, and a tab of panels can need one more.
const PASSES: u64 = 4;
/// Seconds for which the control is framed.
const FRAMED: f64 = 2.0;

/// What is put in sight, in egui's memory.
#[derive(Clone, Copy)]
struct Revealed {
    section: &'static str,
    control: &'static str,
    /// The number of the first pass that shows it.
    pass: u64,
    /// When it was asked for, in seconds.
    time: f64,
    /// The number of the first pass that has the control: what a panel computes can come later.
    found: Option<u64>,
}

fn id() -> Id {
    Id::unique("section or control that is put in sight")
}

/// Opens the section with this title or name, and scrolls to it, or to the control with this name in it.
pub fn reveal(ctx: &Context, section: &'static str, control: &'static str) {
    let (pass, time) = (ctx.cumulative_pass_nr(), ctx.input(|input| input.time));
    ctx.data_mut(|data| data.insert_temp(id(), Revealed { section, control, pass, time, found: None }));
    ctx.request_repaint();
}

/// Returns whether a section is to be open now, and whether to scroll to it.
pub(super) fn of_section(ui: &Ui, title: &str, name: &str) -> (bool, bool) {
    let is_it = |asked: &Revealed| [title, name].iter().any(|own| own.eq_ignore_ascii_case(asked.section));
    let asked = scrolling(ui).filter(is_it);
    let is_first = asked.is_some_and(|asked| asked.control.is_empty() || passes_since(ui, asked) < 2);
    (asked.is_some(), is_first)
}

/// Scrolls to a control and frames it, if it is the one that is put in sight.
pub(super) fn show_control(ui: &Ui, rect: Rect, name: &str) {
    let Some(asked) = ui.data(|data| data.get_temp::<Revealed>(id())) else { return };
    if asked.control != name || ui.input(|input| input.time) - asked.time > FRAMED {
        return;
    }
    let pass = ui.ctx().cumulative_pass_nr();
    let found = asked.found.unwrap_or(pass);
    if asked.found.is_none() {
        ui.data_mut(|data| data.insert_temp(id(), Revealed { found: Some(pass), ..asked }));
    }
    if pass.saturating_sub(found) < PASSES {
        ui.scroll_to_rect(rect, Some(Align::Center));
        ui.ctx().request_repaint();
    }
    let frame = rect.expand2(egui::vec2(6.0, 1.0));
    let stroke = Stroke::new(1.5, tokens(ui).accent);
    ui.painter().rect_stroke(frame, metrics::RADIUS_CONTROL, stroke, StrokeKind::Middle);
}

/// Returns what is put in sight in these passes.
fn scrolling(ui: &Ui) -> Option<Revealed> {
    ui.data(|data| data.get_temp::<Revealed>(id())).filter(|asked| passes_since(ui, *asked) < PASSES)
}

fn passes_since(ui: &Ui, asked: Revealed) -> u64 {
    ui.ctx().cumulative_pass_nr().saturating_sub(asked.pass)
}
