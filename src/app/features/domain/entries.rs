//! The domain tool in menus and in the palette.

use eframe::egui::Key;

use super::{DOMAIN, DomainCommand, DomainToolMode};
use crate::app::features::domain::DomainTool;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::from(command));
    let mode = |title: &str, mode| {
        let current = tools.tool == &DOMAIN && tools.settings::<DomainTool>().mode == mode;
        item(title, DomainCommand::Mode(mode)).checked(current)
    };
    let adds = tools.settings::<DomainTool>().adds;
    let mut items = vec![
        mode("Cut domain with the brush", DomainToolMode::Brush).group(),
        mode("Cut domain with a rectangle", DomainToolMode::Rectangle),
        mode("Cut domain with a circle", DomainToolMode::Circle),
        mode("Cut domain with a lasso", DomainToolMode::Lasso),
        mode("Cut domain with a polygon", DomainToolMode::Polygon),
        mode("Fill holes of the domain, or remove parts", DomainToolMode::Fill),
        mode("Draw the frame of the domain", DomainToolMode::Frame),
        item("Add to the domain", DomainCommand::Adds(!adds))
            .key(Key::X)
            .only("with the domain tool", tools.tool == &DOMAIN)
            .checked(adds),
    ];
    if !tools.settings::<DomainTool>().corners.is_empty() {
        items.push(
            item("Close the polygon", DomainCommand::ClosePolygon)
                .key(Key::Enter)
                .only("while a polygon is drawn", true),
        );
    }
    // The menu has what the selected tool does.
    let is_tool = tools.tool == &DOMAIN;
    items.into_iter().map(|item| item.in_menu(is_tool).above()).collect()
}
