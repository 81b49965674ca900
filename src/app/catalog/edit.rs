//! The menu Edit.

use eframe::egui::{Key, Modifiers};

use crate::app::features::domain::DomainCommand;
use crate::app::features::domain::DomainTool;
use crate::app::features::inspection::InspectCommand;
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
    let in_region = !state.tools.settings::<RegionTool>().corners.is_empty();
    let remove = || match in_region {
        true => Command::from(RegionCommand::RemoveCorner),
        false => Command::from(DomainCommand::RemoveCorner),
    };
    let in_polygon = in_region || !state.tools.settings::<DomainTool>().corners.is_empty();
    let undo = if in_polygon {
        CatalogItem::new(Edit, "Undo corner of the polygon", remove())
    } else {
        CatalogItem::new(Edit, undo, Command::from(EditCommand::Undo)).enabled(can_undo)
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
    if in_polygon {
        items.push(
            CatalogItem::new(Edit, "Remove the last corner", remove())
                .key(Key::Backspace)
                .only("while a polygon is drawn", true),
        );
    }
    items
}
