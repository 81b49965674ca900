//! The region tool in menus and in the palette.

use eframe::egui::Key;

use super::{REGION, RegionCommand, RegionShape, RegionTarget};
use crate::app::features::regions::RegionTool;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tool = state.tools.settings::<RegionTool>();
    // The menu has what the selected tool does.
    let is_tool = state.tools.tool == &REGION;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::from(command));
    let target = |title: &str, target| {
        item(title, RegionCommand::Target(target)).checked(is_tool && tool.target == target)
    };
    let shape = |title: &str, shape| {
        item(title, RegionCommand::Shape(shape)).checked(is_tool && tool.shape() == shape)
    };
    let mut items = vec![
        target("Draw the mask of the layer", RegionTarget::Mask).group(),
        target("Draw a keep-out region", RegionTarget::KeepOut),
        target("Draw shapes to measure the distance to", RegionTarget::Shapes),
        shape("Draw regions with the brush", RegionShape::Brush).group(),
        shape("Draw regions with a lasso", RegionShape::Lasso),
        shape("Draw regions with a polygon", RegionShape::Polygon),
        shape("Draw rectangles", RegionShape::Rectangle),
        shape("Draw circles", RegionShape::Circle),
        shape("Fill holes of a region, or remove parts", RegionShape::Fill),
        item("Cut from the region", RegionCommand::Cuts(!tool.cuts))
            .key(Key::X)
            .only("with the region tool", is_tool)
            .checked(tool.cuts),
    ];
    if tool.has_lines_and_points() {
        items.push(shape("Draw lines", RegionShape::Line));
        items.push(shape("Draw points", RegionShape::Point));
    }
    if is_tool && tool.target != RegionTarget::Shapes {
        items.push(item("Clear the region", RegionCommand::Clear));
    }
    if !tool.corners.is_empty() {
        items.push(
            item("Close the drawn region", RegionCommand::Close)
                .key(Key::Enter)
                .only("while a region is drawn", true),
        );
    }
    items.into_iter().map(|item| item.in_menu(is_tool).above()).collect()
}
