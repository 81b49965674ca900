//! The boundary in menus and in the palette.

use eframe::egui::Key;

use super::{BOUNDARY, BoundaryCommand, BoundaryToolMode, OPEN_IN_POLYGONS};
use crate::app::features::boundary::BoundaryTool;
use meshbrush_io::io::settings::SavedOpen;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};
use meshbrush_mesh::text::Number;

pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::from(command));
    let current = |mode| tools.tool == &BOUNDARY && tools.settings::<BoundaryTool>().mode == mode;
    let (select, split) = (BoundaryToolMode::Select, BoundaryToolMode::Split);
    let mut items = vec![
        item("Select pieces of the boundary", BoundaryCommand::Mode(select)).checked(current(select)).group(),
        item("Split the boundary", BoundaryCommand::Mode(split)).checked(current(split)),
    ];
    if tools.tool == &BOUNDARY {
        let other = if tools.settings::<BoundaryTool>().mode == split { select } else { split };
        items.push(
            item("Select or split", BoundaryCommand::Mode(other))
                .key(Key::S)
                .only("with the boundary tool", true),
        );
        items.push(item("Join the piece with the next", BoundaryCommand::Join));
    }
    let open = |title: &str, entry| item(title, BoundaryCommand::Open(entry));
    items.extend([
        open("Open the boundary along the frame", SavedOpen::Frame).group(),
        open(
            &format!("Open the boundary deeper than {} m", Number(tools.settings::<BoundaryTool>().level)),
            SavedOpen::Deeper(tools.settings::<BoundaryTool>().level),
        )
        .id("open-boundary-deeper"),
        CatalogItem::new(
            Menu::Tool,
            "Open the boundary in polygons…",
            Command::from(FileCommand::Ask(&OPEN_IN_POLYGONS)),
        ),
    ]);
    // The menu has what the selected tool does.
    let is_tool = tools.tool == &BOUNDARY;
    items.into_iter().map(|item| item.in_menu(is_tool)).collect()
}
