//! The menu Tool.

use eframe::egui::{Key, Modifiers};

use super::{CatalogItem, GESTURES, GestureHelp, Menu};
use crate::app::command::{BoundaryCommand, Command, DomainCommand};
use crate::app::frame::FrameState;
use crate::app::tools::{BOUNDARY, BoundaryToolMode, DOMAIN, DomainToolMode, PaintKind, TOOLS};

const DIGITS: [Key; 10] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
    Key::Num0,
];

/// Tools and their settings.
pub fn tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Tool as InTool;
    let tools = state.tools;
    let kind =
        |title: &str, kind| CatalogItem::new(InTool, title, Command::Paint(kind)).checked(tools.kind == kind);
    let harder = |title: &str, step: f64, key| {
        let hardness = (tools.hardness + step).clamp(0.0, 1.0);
        CatalogItem::new(InTool, title, Command::BrushHardness(hardness)).keys(Modifiers::SHIFT, key)
    };
    let mut items: Vec<CatalogItem> = (TOOLS.iter())
        .map(|tool| {
            let item = CatalogItem::new(InTool, tool.name, Command::Use(tool)).key(tool.key);
            item.checked(tools.tool == *tool)
        })
        .collect();
    items.extend([
        kind("Paint risk", PaintKind::Risk).key(Key::R).group(),
        kind("Paint target diameter", PaintKind::Diameter).key(Key::T),
        CatalogItem::new(InTool, "Larger brush", Command::ScaleBrush(1.15)).key(Key::CloseBracket).group(),
        CatalogItem::new(InTool, "Smaller brush", Command::ScaleBrush(1.0 / 1.15)).key(Key::OpenBracket),
        harder("Harder brush", 0.1, Key::CloseCurlyBracket),
        harder("Softer brush", -0.1, Key::OpenCurlyBracket),
    ]);
    items.extend(GESTURES.iter().filter(|gesture| !gesture.advice.is_empty()).map(gesture_item));
    items.extend(domain_tool(state));
    for (i, key) in DIGITS.into_iter().enumerate() {
        let percent = 10 * (i + 1);
        let command = Command::BrushStrength(percent as f64 / 100.0);
        let item = CatalogItem::new(InTool, format!("Strength {percent} %"), command).key(key);
        items.push(if i == 0 { item.group() } else { item });
    }
    items
}

/// An entry that names a gesture. Chosen, it says how the gesture is made.
fn gesture_item(gesture: &GestureHelp) -> CatalogItem {
    let command = Command::Tell(gesture.advice.to_owned());
    CatalogItem::new(Menu::Tool, gesture.title, command).gesture(gesture.keys)
}

fn domain_tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Domain(command));
    let mode = |title: &str, mode| {
        let current = tools.tool == &DOMAIN && tools.domain.mode == mode;
        item(title, DomainCommand::Mode(mode)).checked(current)
    };
    let adds = tools.domain.adds;
    let mut items = vec![
        mode("Cut domain with the brush", DomainToolMode::Brush).group(),
        mode("Cut domain with a rectangle", DomainToolMode::Rectangle),
        mode("Cut domain with a polygon", DomainToolMode::Polygon),
        mode("Draw the frame of the domain", DomainToolMode::Frame),
        item("Add to the domain", DomainCommand::Adds(!adds)).key(Key::X).checked(adds),
    ];
    items.extend(boundary_tool(state));
    if !tools.domain.corners.is_empty() {
        items.push(item("Close the polygon", DomainCommand::ClosePolygon).key(Key::Enter));
    }
    items
}

fn boundary_tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Boundary(command));
    let current = |mode| tools.tool == &BOUNDARY && tools.boundary.mode == mode;
    let (select, split) = (BoundaryToolMode::Select, BoundaryToolMode::Split);
    let mut items = vec![
        item("Select pieces of the boundary", BoundaryCommand::Mode(select)).checked(current(select)).group(),
        item("Split the boundary", BoundaryCommand::Mode(split)).checked(current(split)),
    ];
    if tools.tool == &BOUNDARY {
        let other = if tools.boundary.mode == split { select } else { split };
        items.push(item("Select or split", BoundaryCommand::Mode(other)).key(Key::S));
        items.push(item("Join the piece with the next", BoundaryCommand::Join));
    }
    items
}
