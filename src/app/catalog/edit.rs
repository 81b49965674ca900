//! The menu Edit.

use eframe::egui::{Key, Modifiers};

use super::{CatalogItem, Menu};
use crate::app::command::Command;
use crate::app::frame::FrameState;

/// History and paint.
pub fn edit(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Edit;
    let history = state.session.document().history();
    let named = |verb: &str, title: Option<&str>| match title {
        Some(title) => format!("{verb} {title}"),
        None => verb.to_owned(),
    };
    let undo = named("Undo", history.undo_title());
    let redo = named("Redo", history.redo_title());
    let can_undo = state.session.can_undo();
    let can_redo = history.redo_title().is_some();
    vec![
        CatalogItem::new(Edit, undo, Command::Undo).ctrl(Key::Z).enabled(can_undo),
        CatalogItem::new(Edit, redo, Command::Redo)
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            .enabled(can_redo),
        CatalogItem::new(Edit, "Clear paint", Command::ClearPaint)
            .keys(Modifiers::COMMAND, Key::Backspace)
            .group(),
        CatalogItem::new(Edit, "Cancel or deselect", Command::Escape).key(Key::Escape),
    ]
}
