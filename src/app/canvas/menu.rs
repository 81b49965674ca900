//! The menu of a point on the canvas, opened by the secondary button or by keyboard.

use eframe::egui::{Context, Id, Popup, PopupKind, Pos2, Ui};
use glam::DVec2;

use super::Canvas;
use super::press::pointer_over;
use crate::app::features::ROWS;
use crate::app::features::inspection::InspectCommand;
use meshbrush_kit::kit::command::{BrushCommand, Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::tools::Tools;
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{CatalogItem, FrameState, MENU_WIDTH, Menu, menu_item};
use meshbrush_ui::widgets::key_menu::{enter_menu, is_key_menu, open_menu_from};

/// Identifies the menu, and where it was opened in egui's memory.
fn id() -> Id {
    Id::unique("menu of the canvas")
}

/// Opens the menu at a place in points, which is `world` in world units.
pub fn open(ctx: &Context, at: Pos2, world: DVec2) {
    ctx.data_mut(|data| data.insert_temp(id(), (at, world)));
    Popup::open_id(ctx, id());
    ctx.request_repaint();
}

impl Canvas {
    /// Opens the menu for the point under the pointer, or else for the middle of the view.
    pub fn open_menu(&self, ctx: &Context, view: &View, tools: &Tools, session: &Session) {
        let Some((canvas, rect)) = self.shown else { return };
        let Some(pointer) = pointer_over(ctx, rect, view, tools, session) else { return };
        let under_pointer = ctx.pointer_latest_pos().filter(|at| rect.contains(*at));
        let at = under_pointer.unwrap_or(rect.center());
        ctx.data_mut(|data| data.insert_temp(id(), (at, pointer.world(at))));
        open_menu_from(ctx, id(), canvas);
    }
}

/// Shows the menu while it is open.
pub fn show(ui: &Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((at, world)) = ui.data(|data| data.get_temp::<(Pos2, DVec2)>(id())) else { return };
    is_key_menu(ui.ctx(), id()); // gives the focus back
    let popup = Popup::new(id(), ui.ctx().clone(), at, ui.layer_id()).kind(PopupKind::Menu).open_memory(None);
    popup.style(eframe::egui::containers::menu::menu_style).show(|ui| {
        ui.set_min_width(MENU_WIDTH);
        let items = items(state, world);
        let buttons: Vec<_> = items.iter().map(|item| menu_item(ui, item, commands)).collect();
        enter_menu(ui.ctx(), id(), &buttons);
    });
}

/// Returns the menu entries for a point in world units: the entries of the tool come first.
fn items(state: &FrameState<'_>, world: DVec2) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::View, title, command);
    let mut of_tool = (state.tools.tool.menu)(state, world);
    of_tool.extend(ROWS.iter().flat_map(|row| (row.entries_at)(state, world)));
    let is_first = of_tool.is_empty();
    let mut items: Vec<_> = of_tool.into_iter().map(|(title, command)| item(title, command)).collect();
    let query = item("Query here", Command::from(InspectCommand::Query(world)));
    items.extend([
        if is_first { query } else { query.group() },
        item("Pick the value for the brush", Command::from(BrushCommand::Pick(world))),
        item("Copy the coordinates", Command::from(ShellCommand::Copy(state.view.typed_point(world))))
            .group(),
        item("Go to… from here", Command::from(ShellCommand::AskPlaceNear(world))),
        item("Centre here", Command::from(ViewCommand::LookAt(world))),
        item("Fit domain", Command::from(ViewCommand::Fit)),
    ]);
    items
}
