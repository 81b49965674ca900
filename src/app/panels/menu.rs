use eframe::egui::{self, Align, Button, Layout, MenuBar, RichText, ScrollArea, Ui};

use super::super::App;
use super::super::catalog::catalog;
use super::super::command::{Entry, Menu};
use super::super::theme::{font, metrics, tokens};

/// Height that is not a menu's: the bar, and its own margins.
const ROOM_ROUND_MENU: f32 = metrics::MENU_BAR + 16.0;

impl App {
    pub(super) fn menu_ui(&mut self, ui: &mut Ui) {
        let entries = catalog(self);
        MenuBar::new().ui(ui, |ui| {
            ui.label(RichText::new("Meshbrush").font(font::strong()).color(tokens(ui).value));
            ui.add_space(8.0);
            for (menu, name) in Menu::ALL {
                ui.menu_button(name, |ui| {
                    ui.set_min_width(220.0);
                    // In a small window a long menu scrolls.
                    let room = ui.ctx().content_rect().height() - ROOM_ROUND_MENU;
                    ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, |ui| {
                        for entry in entries.iter().filter(|entry| entry.menu == menu) {
                            self.menu_entry(ui, entry);
                        }
                    });
                });
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let title = RichText::new(self.title()).color(tokens(ui).label);
                ui.add(egui::Label::new(title).truncate());
            });
        });
    }

    fn menu_entry(&mut self, ui: &mut Ui, entry: &Entry) {
        if entry.begins_group {
            ui.separator();
        }
        let mut button = Button::selectable(entry.checked, &entry.title);
        if let Some(shortcut) = &entry.shortcut {
            button = button.shortcut_text(super::super::keys::shortcut_text(shortcut));
        }
        if ui.add_enabled(entry.enabled, button).clicked() {
            self.commands.push(entry.command.clone());
            ui.close();
        }
    }
}
