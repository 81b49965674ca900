//! The menu bar and the tool strip.

use eframe::egui::{self, Align, Context, Id, Layout, MenuBar, Popup, Response, RichText, ScrollArea, Ui};

use meshbrush_kit::kit::command::{Command, EditCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu, menu_items};
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::{Icon, ToolButton};

/// Height that a menu cannot use: that of the bar and its margins.
const HEIGHT_AROUND_MENU: f32 = metrics::MENU_BAR + 16.0;

/// Every menu, and the document's name.
pub fn menu_bar(ui: &mut Ui, state: &FrameState<'_>, entries: &[CatalogItem], commands: &mut Vec<Command>) {
    MenuBar::new().ui(ui, |ui| {
        ui.label(RichText::new("Meshbrush").font(font::strong()).color(tokens(ui).value));
        ui.add_space(8.0);
        for (menu, name) in Menu::ALL {
            let button = ui.menu_button(name, |ui| {
                // In a small window a long menu scrolls.
                let height = ui.ctx().content_rect().height() - HEIGHT_AROUND_MENU;
                ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
                    let items = entries.iter().filter(|item| item.menu == menu && item.is_in_menu);
                    menu_items(ui, &items.collect::<Vec<_>>(), commands);
                });
            });
            open_if_asked(ui, menu, &button.response);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let title = RichText::new(state.project.title(state.session)).color(tokens(ui).label);
            ui.add(egui::Label::new(title).truncate());
        });
    });
}

fn asked_menu_id() -> Id {
    Id::unique("menu of the bar to open")
}

/// Opens a menu of the bar in the next frame, by its key.
pub fn ask_for_menu(ctx: &Context, menu: Menu) {
    ctx.data_mut(|data| data.insert_temp(asked_menu_id(), menu));
    ctx.request_repaint();
}

/// Opens a menu if its key was pressed. Its button has the focus then, from which the arrow keys lead on.
fn open_if_asked(ui: &Ui, menu: Menu, button: &Response) {
    if ui.data(|data| data.get_temp::<Menu>(asked_menu_id())) == Some(menu) {
        ui.data_mut(|data| data.remove::<Menu>(asked_menu_id()));
        button.request_focus();
        Popup::open_id(ui.ctx(), Popup::default_response_id(button));
    }
}

/// A button for each tool, and below them undo, redo and fit.
pub fn tool_strip(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    // In a low window there is no room for what the menus have, too.
    let (tools, height) = (state.tools.all().len() as f32, ui.available_height());
    let is_low = height < (tools + 3.0) * (metrics::TOOL + 6.0);
    let is_lowest = height < tools * (metrics::TOOL + 2.0);
    ui.spacing_mut().item_spacing.y = match (is_lowest, is_low) {
        (true, _) => 0.0,
        (false, true) => 2.0,
        (false, false) => 6.0,
    };
    for &tool in state.tools.all() {
        let button = ToolButton::new(tool.icon, tool.name).entry(tool.name);
        if button.selected(state.tools.tool == tool).show(ui).clicked() {
            commands.push(Command::from(ShellCommand::Use(tool)));
        }
    }
    if is_low {
        return;
    }
    // From the top: a layout from the bottom would be read from the bottom.
    let height = 3.0 * metrics::TOOL + 2.0 * ui.spacing().item_spacing.y;
    ui.add_space(ui.available_height() - height);
    let history = state.session.document().history();
    let redo = ToolButton::new(Icon::REDO, "Redo").entry("redo");
    let undo = ToolButton::new(Icon::UNDO, "Undo").entry("undo");
    if ui.add_enabled_ui(state.session.can_undo(), |ui| undo.show(ui)).inner.clicked() {
        commands.push(Command::from(EditCommand::Undo));
    }
    if ui.add_enabled_ui(history.redo_title().is_some(), |ui| redo.show(ui)).inner.clicked() {
        commands.push(Command::from(EditCommand::Redo));
    }
    if ToolButton::new(Icon::FIT, "Fit domain").entry("Fit domain").show(ui).clicked() {
        commands.push(Command::from(ViewCommand::Fit));
    }
}
