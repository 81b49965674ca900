//! Help inside the window: the manual, and the list of keys and gestures.

mod key_editor;
mod keys;
mod manual;
mod markdown;
mod page;
mod search;

pub use key_editor::{stop as stop_editing_keys, takes_next_key};
#[cfg(test)]
pub use keys::page as keys_page;

use eframe::egui::{self, Context, Frame, Margin, ScrollArea, Ui, vec2};

use meshbrush_kit::kit::command::{Command, HelpTopic, ShellCommand};
use meshbrush_kit::kit::{CatalogItem, Keymap};
use meshbrush_ui::theme::tokens_of;

fn title(topic: HelpTopic) -> &'static str {
    match topic {
        HelpTopic::Keys => "Keyboard and mouse",
        HelpTopic::Page(file) | HelpTopic::Heading(file, _) => {
            manual::page_of(file).map_or("", |page| page.title)
        }
    }
}

/// Returns the pictures of the page of a topic that are not here yet.
pub fn missing_pictures(topic: HelpTopic) -> Vec<&'static str> {
    match topic {
        HelpTopic::Keys => Vec::new(),
        HelpTopic::Page(file) | HelpTopic::Heading(file, _) => {
            manual::page_of(file).map_or(Vec::new(), manual::missing_pictures)
        }
    }
}

/// Width of the list of pages.
const LIST_WIDTH: f32 = 168.0;
/// Size of the window where there is room, in points.
const SIZE: egui::Vec2 = vec2(820.0, 600.0);

/// Shows a topic in a window of its own, beside the list of all topics. The canvas stays usable.
pub fn show(
    ctx: &Context,
    topic: HelpTopic,
    catalog: &[CatalogItem],
    keymap: &Keymap,
    commands: &mut Vec<Command>,
) {
    let mut open = true;
    let room = ctx.content_rect().size() - vec2(48.0, 96.0);
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(12));
    egui::Window::new("Help")
        .open(&mut open)
        .frame(frame.fill(tokens_of(ctx).panel))
        .default_size(SIZE.min(room))
        .min_size(vec2(480.0, 280.0))
        .default_pos(ctx.content_rect().center() - SIZE.min(room) / 2.0)
        .collapsible(false)
        .show(ctx, |ui| contents(ui, topic, catalog, keymap, commands));
    if !open {
        commands.push(Command::from(ShellCommand::CloseHelp));
    }
}

fn contents(
    ui: &mut Ui,
    topic: HelpTopic,
    catalog: &[CatalogItem],
    keymap: &Keymap,
    commands: &mut Vec<Command>,
) {
    let mut query = String::new();
    egui::Panel::left("topics of the help").frame(Frame::NONE).resizable(false).exact_size(LIST_WIDTH).show(
        ui,
        |ui| {
            query = search::field(ui);
            ui.add_space(8.0);
            let pages = manual::PAGES.iter().map(|page| HelpTopic::Page(page.file));
            for other in std::iter::once(HelpTopic::Keys).chain(pages) {
                let is_shown = query.is_empty() && other == topic.in_list();
                if ui.selectable_label(is_shown, title(other)).clicked() {
                    search::clear(ui);
                    commands.push(Command::from(ShellCommand::ShowHelp(other)));
                }
            }
        },
    );
    egui::CentralPanel::default().frame(Frame::new().inner_margin(Margin { left: 16, ..Margin::ZERO })).show(
        ui,
        |ui| {
            if !query.is_empty() {
                let area = ScrollArea::vertical().id_salt("results").auto_shrink(false);
                area.show(ui, |ui| search::results(ui, &query, commands));
                return;
            }
            // Each topic keeps how far it was scrolled.
            ScrollArea::vertical().id_salt(title(topic)).auto_shrink(false).show(ui, |ui| match topic {
                HelpTopic::Keys => keys::show(ui, catalog, keymap, commands),
                HelpTopic::Page(file) => {
                    if let Some(page) = manual::page_of(file) {
                        page::show(ui, page, None, commands);
                    }
                }
                HelpTopic::Heading(file, block) => {
                    if let Some(page) = manual::page_of(file) {
                        page::show(ui, page, Some(block), commands);
                        // From now on the page is scrolled by hand.
                        commands.push(Command::from(ShellCommand::ShowHelp(HelpTopic::Page(file))));
                    }
                }
            });
        },
    );
}
