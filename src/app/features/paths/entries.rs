//! Paths in menus and in the palette.

use eframe::egui::Key;

use super::{AlternativesCommand, CostKind, FrontCommand, KeepOutCommand, OPEN_KEEP_OUT, PATH, PathCommand};
use crate::app::features::paths::Paths;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// Returns the entries. The key deletes a place of a path only while the tool is selected.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::from(command));
    let plan = &state.session.document().settings().paths;
    let has_paths = !plan.routes.is_empty();
    let is_selected = state.feature::<Paths>().tool.selected_in(plan).is_some();
    let paths = &state.feature::<Paths>().finder;
    let alternatives = AlternativesCommand::Show(!paths.alternatives.is_on);
    let front = |title: &str, command| item(title, PathCommand::Front(command));
    let cost =
        |title: &str, kind| item(title, PathCommand::CostBy(kind)).checked(CostKind::of(&plan.cost) == kind);
    let delete =
        item("Delete the selected place of a path", PathCommand::Delete).enabled(is_selected).group();
    let items = vec![
        delete.key(Key::Delete).only("with the path tool", state.tools.tool == &PATH),
        item("Swap start and goal", PathCommand::Swap).enabled(has_paths),
        item("Delete all paths", PathCommand::DeleteAll).enabled(has_paths),
        cost("Weigh length and risk of paths", CostKind::Weights).group(),
        cost("Cost of paths by a formula", CostKind::Formula),
        CatalogItem::new(Menu::Tool, "Add keep-out region…", Command::from(FileCommand::Ask(&OPEN_KEEP_OUT))),
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
        front("Take the next shorter path", FrontCommand::Shorter).enabled(paths.front.is_on).palette_only(),
        front("Take the next safer path", FrontCommand::Safer).enabled(paths.front.is_on).palette_only(),
    ];
    // The menu has what the selected tool does.
    let is_tool = state.tools.tool == &PATH;
    items.into_iter().map(|item| item.above().in_menu(is_tool)).collect()
}
