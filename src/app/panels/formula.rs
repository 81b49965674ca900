//! A row in which a formula is typed.

use eframe::egui::Ui;

use crate::app::widgets::{TextError, TextRow};
use crate::field::Formula;

/// The text typed so far, in egui's memory. It need not be a valid formula yet.
#[derive(Clone, Debug, Default)]
struct TypedFormula {
    text: String,
    /// The formula of the document when the text was last equal to it.
    of: Option<Formula>,
}

/// Shows a row for the formula `current`. Returns the new formula once a valid one is complete; `Some(None)`
/// once the row was emptied.
pub fn row(ui: &mut Ui, label: &str, hint: &str, current: Option<&Formula>) -> Option<Option<Formula>> {
    let id = ui.make_persistent_id(("typed formula", label));
    let mut typed: TypedFormula = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if typed.of.as_ref() != current {
        // After undo, or in another document.
        typed.text = current.map_or(String::new(), |formula| formula.source().to_owned());
        typed.of = current.cloned();
    }
    let parsed = if typed.text.trim().is_empty() { Ok(None) } else { Formula::parse(&typed.text).map(Some) };
    let message = parsed.as_ref().err().map(ToString::to_string);
    let error = parsed.as_ref().err().zip(message.as_deref());
    let error = error.map(|(error, message)| TextError { message, at: Some(error.span().start) });
    let response = TextRow::formula(label, &mut typed.text).hint(hint).error(error).show(ui);
    ui.data_mut(|data| data.insert_temp(id, typed));
    let new = parsed.ok().filter(|formula| formula.as_ref() != current)?;
    response.lost_focus().then_some(new)
}
