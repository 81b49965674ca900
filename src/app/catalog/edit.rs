//! The menu Edit.

use eframe::egui::{Key, Modifiers};

use crate::app::features::domain::DomainCommand;
use crate::app::features::domain::DomainTool;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::lines::{LineTool, LinesCommand};
use crate::app::features::regions::RegionCommand;
use crate::app::features::regions::RegionTool;
use meshbrush_kit::kit::command::{Command, EditCommand, ShellCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

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
    let remove = remove_corner(state);
    let in_polygon = remove.is_some();
    let undo = match remove.clone() {
        Some((of, remove)) => CatalogItem::new(Edit, format!("Undo corner of the {of}"), remove),
        None => CatalogItem::new(Edit, undo, Command::from(EditCommand::Undo)).enabled(can_undo),
    };
    let mut items = vec![
        undo.id("undo").ctrl(Key::Z),
        CatalogItem::new(Edit, redo, Command::from(EditCommand::Redo))
            .id("redo")
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            .ctrl(Key::Y)
            .enabled(can_redo && !in_polygon),
        CatalogItem::new(Edit, "Clear paint", Command::from(EditCommand::ClearPaint))
            .keys(Modifiers::COMMAND, Key::Backspace)
            .group(),
        CatalogItem::new(Edit, "Copy the values of the triangle", Command::from(InspectCommand::CopyReadout))
            .ctrl(Key::C)
            .enabled(state.session.queried_triangle().is_some())
            .group(),
        CatalogItem::new(Edit, "Cancel or deselect", Command::from(ShellCommand::Escape)).key(Key::Escape),
    ];
    if let Some((_, remove)) = remove {
        items.push(
            CatalogItem::new(Edit, "Remove the last corner", remove)
                .key(Key::Backspace)
                .only("while a polygon is drawn", true),
        );
    }
    items
}

/// Returns the command that removes the last corner of what is being drawn, and what that is.
fn remove_corner(state: &FrameState<'_>) -> Option<(&'static str, Command)> {
    let tools = state.tools;
    if !tools.settings::<RegionTool>().corners.is_empty() {
        return Some(("polygon", Command::from(RegionCommand::RemoveCorner)));
    }
    if !tools.settings::<LineTool>().corners.is_empty() {
        return Some(("line", Command::from(LinesCommand::RemoveCorner)));
    }
    let in_domain = !tools.settings::<DomainTool>().corners.is_empty();
    in_domain.then(|| ("polygon", Command::from(DomainCommand::RemoveCorner)))
}
