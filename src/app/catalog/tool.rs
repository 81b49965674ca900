//! The menu Tool.

use eframe::egui::{Key, Modifiers};

use super::{GESTURES, GestureHelp};
use crate::app::command::{BrushCommand, Command, FileCommand, ShellCommand};
use crate::app::keep_out::KeepOutCommand;
use crate::app::kit::{CatalogItem, DIGITS, FrameState, Menu};
use crate::app::paths::OPEN_KEEP_OUT;
use crate::app::paths::{AlternativesCommand, CostKind, FrontCommand, PathCommand};
use crate::app::tools::{BrushMode, ERASER, PATH, PaintKind, TOOLS, Tools};

/// Tools and their settings.
pub fn tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Tool as InTool;
    let tools = state.tools;
    let kind = |title: &str, kind| {
        CatalogItem::new(InTool, title, Command::Brush(BrushCommand::Kind(kind))).checked(tools.kind == kind)
    };
    let mode = |mode, title: &str| {
        let item = CatalogItem::new(InTool, title, Command::Brush(BrushCommand::Mode(mode)));
        item.checked(tools.mode == mode)
    };
    let mirror = |title: &str, command: fn(bool) -> BrushCommand, on: bool| {
        CatalogItem::new(InTool, title, Command::Brush(command(!on))).checked(on)
    };
    let harder = |title: &str, step: f64, key| {
        let hardness = (tools.hardness + step).clamp(0.0, 1.0);
        CatalogItem::new(InTool, title, Command::Brush(BrushCommand::Hardness(hardness)))
            .keys(Modifiers::SHIFT, key)
    };
    let mut items: Vec<CatalogItem> = (TOOLS.iter())
        .map(|tool| {
            let item =
                CatalogItem::new(InTool, tool.name, Command::Shell(ShellCommand::Use(tool))).key(tool.key);
            item.checked(tools.tool == *tool)
        })
        .collect();
    items.extend([
        kind("Paint risk", PaintKind::Risk).key(Key::R).group(),
        kind("Paint target diameter", PaintKind::Diameter).key(Key::T),
        mode(BrushMode::BuildUp, "Build up").key(Key::U).group(),
        mode(BrushMode::Set, "Set the value").key(Key::V),
        mode(BrushMode::Lower, "Lower").key(Key::L),
        mirror("Mirror strokes left and right", BrushCommand::MirrorX, tools.mirrored[0]).group(),
        mirror("Mirror strokes above and below", BrushCommand::MirrorY, tools.mirrored[1]),
        CatalogItem::new(InTool, "Larger brush", Command::Brush(BrushCommand::Scale(1.15)))
            .key(Key::CloseBracket)
            .group(),
        CatalogItem::new(InTool, "Smaller brush", Command::Brush(BrushCommand::Scale(1.0 / 1.15)))
            .key(Key::OpenBracket),
        harder("Harder brush", 0.1, Key::CloseCurlyBracket),
        harder("Softer brush", -0.1, Key::OpenCurlyBracket),
    ]);
    items.extend(GESTURES.iter().filter(|gesture| !gesture.advice.is_empty()).map(gesture_item));
    let mut items: Vec<CatalogItem> = items.into_iter().map(CatalogItem::above).collect();
    items.extend(path_tool(state));
    items.extend(amounts(tools));
    items
}

/// Returns an entry that names a gesture. Chosen, it says how the gesture is made.
fn gesture_item(gesture: &GestureHelp) -> CatalogItem {
    let command = Command::Shell(ShellCommand::Tell(gesture.advice.to_owned()));
    CatalogItem::new(Menu::Tool, gesture.title, command).gesture(gesture.keys)
}

/// What the digits set: the strength, or the risk in the mode *Set*. A diameter is no share, so there they do
/// nothing. With the query tool they belong to the neighbours.
fn amounts(tools: &Tools) -> impl Iterator<Item = CatalogItem> + use<> {
    let has_keys = !tools.tool.queries;
    let paints = tools.tool != &ERASER;
    let sets_risk = paints && tools.kind == PaintKind::Risk && tools.mode == BrushMode::Set;
    let is_share = !paints || tools.kind == PaintKind::Risk;
    DIGITS.into_iter().enumerate().map(move |(i, key)| {
        let share = (i + 1) as f64 / 10.0;
        let (title, command) = if sets_risk {
            (format!("Risk {share}"), BrushCommand::Risk(share))
        } else {
            (format!("Strength {} %", 10 * (i + 1)), BrushCommand::Strength(share))
        };
        let item = CatalogItem::new(Menu::Tool, title, Command::Brush(command)).enabled(is_share);
        let item = if has_keys { item.key(key) } else { item };
        if i == 0 { item.group() } else { item }
    })
}

/// Returns the key deletes a place of a path only while the tool is selected.
fn path_tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Path(command));
    let plan = &state.session.document().settings().paths;
    let has_paths = !plan.routes.is_empty();
    let is_selected = state.tools.path.selected_in(plan).is_some();
    let paths = state.paths;
    let alternatives = AlternativesCommand::Show(!paths.alternatives.is_on);
    let front = |title: &str, command| item(title, PathCommand::Front(command));
    let cost =
        |title: &str, kind| item(title, PathCommand::CostBy(kind)).checked(CostKind::of(&plan.cost) == kind);
    let delete =
        item("Delete the selected place of a path", PathCommand::Delete).enabled(is_selected).group();
    vec![
        if state.tools.tool == &PATH { delete.key(Key::Delete) } else { delete },
        item("Swap start and goal", PathCommand::Swap).enabled(has_paths),
        item("Delete all paths", PathCommand::DeleteAll).enabled(has_paths),
        cost("Weigh length and risk of paths", CostKind::Weights).group(),
        cost("Cost of paths by a formula", CostKind::Formula),
        CatalogItem::new(Menu::Tool, "Add keep-out region…", Command::File(FileCommand::Ask(&OPEN_KEEP_OUT))),
        item("Keep paths out of the layer's mask", PathCommand::KeepOut(KeepOutCommand::AddMask))
            .enabled(KeepOutCommand::mask_to_add(state.session).is_some()),
        item("Remove all keep-out regions", PathCommand::KeepOut(KeepOutCommand::RemoveAll))
            .enabled(!plan.keep_out.is_empty()),
        item("Show the corridor of paths", PathCommand::ShowCorridor(!paths.corridor.is_on))
            .checked(paths.corridor.is_on)
            .group(),
        item("Show alternatives of the path", PathCommand::Alternatives(alternatives))
            .checked(paths.alternatives.is_on),
        front("Show the front of length and risk", FrontCommand::Show(!paths.front.is_on))
            .checked(paths.front.is_on),
        front("Take the next shorter path", FrontCommand::Shorter).enabled(paths.front.is_on),
        front("Take the next safer path", FrontCommand::Safer).enabled(paths.front.is_on),
    ]
}
