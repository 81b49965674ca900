//! A row in which a formula is typed.

use std::fmt::Display;
use std::str::FromStr;

use egui::{Id, Key, Ui};

use super::FrameState;
use meshbrush_core::field::formula::ParseError;
use meshbrush_ui::widgets::{TextError, TextRow};

/// Seconds without a key until a formula is applied: the beginning of `0.0005` is a valid formula, too.
const PAUSE: f64 = 0.4;

/// The name, text and help of a row.
pub struct FormulaRow<'a> {
    /// The name of the row.
    pub label: &'a str,
    /// Shown while it is empty.
    pub hint: &'a str,
    /// The purpose of the formula, in one sentence.
    pub help: &'a str,
}

/// A kind of formula: its text is what was typed.
pub trait AnyFormula:
    FromStr<Err = ParseError> + Display + Clone + PartialEq + Send + Sync + 'static
{
}

impl<F: FromStr<Err = ParseError> + Display + Clone + PartialEq + Send + Sync + 'static> AnyFormula for F {}

/// The text typed so far, in egui's memory. It need not be a valid formula yet.
#[derive(Clone, Debug)]
struct Typed<F> {
    text: String,
    /// The formula of the document when the text was last equal to it.
    of: Option<F>,
    /// When the text last changed, in egui's time.
    changed_at: f64,
    /// The formula that was sent last: it is sent once, also if the document refuses it.
    sent: Option<Option<F>>,
}

impl<F> Default for Typed<F> {
    fn default() -> Self {
        Self { text: String::new(), of: None, changed_at: 0.0, sent: None }
    }
}

impl FormulaRow<'_> {
    /// Shows the row for the formula `current` of the document. Returns a new formula as soon as it is valid
    /// and typing has paused; `Some(None)` once the row was emptied.
    ///
    /// While the text is not in effect, the row says so. A text that cannot be read keeps the focus after
    /// Enter, and so does one that the document refused.
    pub fn show<F: AnyFormula>(
        &self,
        ui: &mut Ui,
        state: &FrameState<'_>,
        current: Option<&F>,
    ) -> Option<Option<F>> {
        let id = ui.make_persistent_id(("typed formula", self.label, state.session.document_id()));
        let mut typed: Typed<F> = ui.data(|data| data.get_temp(id)).unwrap_or_default();
        let parsed = parse(&typed.text);
        let refused = typed.was_refused(parsed.as_ref().ok(), current, state);
        if typed.of.as_ref() != current {
            typed.follow(current, refused);
        }
        let parsed = parse(&typed.text);
        let message = parsed.as_ref().err().map(ToString::to_string);
        let error = parsed.as_ref().err().zip(message.as_deref());
        let error = error.map(|(error, message)| TextError { message, at: Some(error.span().start) });
        let in_effect = parsed.as_ref().is_ok_and(|formula| formula.as_ref() == current);
        let row = TextRow::formula(self.label, &mut typed.text).hint(self.hint).help(self.help).error(error);
        let response = row.mark((!in_effect).then_some("not applied")).show(ui);
        if response.changed() {
            typed.changed_at = ui.input(|input| input.time);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if entered && (parsed.is_err() || (refused && !in_effect)) {
            response.request_focus();
        }
        let new = typed.take_finished(ui, parsed.ok(), current, response.lost_focus(), !response.has_focus());
        store(ui, id, typed);
        new
    }
}

fn parse<F: AnyFormula>(text: &str) -> Result<Option<F>, ParseError> {
    if text.trim().is_empty() { Ok(None) } else { text.parse().map(Some) }
}

fn store<F: AnyFormula>(ui: &Ui, id: Id, typed: Typed<F>) {
    ui.data_mut(|data| data.insert_temp(id, typed));
}

impl<F: AnyFormula> Typed<F> {
    /// Returns whether the document refused the formula that was sent last.
    fn was_refused(&self, parsed: Option<&Option<F>>, current: Option<&F>, state: &FrameState<'_>) -> bool {
        let failed = state.session.notices().shown().is_some_and(|notice| notice.failed);
        let sent = self.sent.as_ref().filter(|sent| Some(*sent) == parsed);
        failed && sent.is_some_and(|sent| sent.as_ref() != current)
    }

    /// Follows the document after undo and in another document. A text that was refused stays.
    fn follow(&mut self, current: Option<&F>, refused: bool) {
        self.of = current.cloned();
        let is_own = self.sent.as_ref().is_some_and(|sent| sent.as_ref() == current);
        if !refused && !is_own {
            self.text = current.map_or(String::new(), F::to_string);
            self.sent = None;
        }
    }

    /// Returns the formula to send, if it is valid and typing has ended or paused.
    fn take_finished(
        &mut self,
        ui: &Ui,
        parsed: Option<Option<F>>,
        current: Option<&F>,
        ended: bool,
        at_rest: bool,
    ) -> Option<Option<F>> {
        let new = parsed.filter(|formula| formula.as_ref() != current)?;
        if self.sent.as_ref() == Some(&new) && !ended {
            return None;
        }
        let waited = ui.input(|input| input.time) - self.changed_at;
        if !ended && !at_rest && waited < PAUSE {
            ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(PAUSE - waited));
            return None;
        }
        self.sent = Some(new.clone());
        Some(new)
    }
}
