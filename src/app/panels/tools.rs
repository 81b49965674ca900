use eframe::egui::{Align, Layout, Ui};

use super::super::App;
use super::super::command::Command;
use super::super::tools::Tool;
use super::super::widgets::{Icon, ToolButton};

const TOOLS: [(Tool, Icon, &str, &str); 5] = [
    (Tool::Brush, Icon::BRUSH, "Brush", "B"),
    (Tool::Eraser, Icon::ERASER, "Eraser", "E"),
    (Tool::Query, Icon::QUERY, "Query", "Q"),
    (Tool::Domain, Icon::DOMAIN, "Domain", "D"),
    (Tool::Pan, Icon::PAN, "Pan", "H"),
];

impl App {
    pub(super) fn tools_ui(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.y = 6.0;
        for (tool, icon, name, key) in TOOLS {
            let button = ToolButton::new(icon, name).key(key).selected(self.tools.tool == tool);
            if button.show(ui).clicked() {
                self.commands.push(Command::Use(tool));
            }
        }
        ui.with_layout(Layout::bottom_up(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.y = 6.0;
            if ToolButton::new(Icon::FIT, "Fit domain").key("Home").show(ui).clicked() {
                self.commands.push(Command::Fit);
            }
            let history = self.session.document().history();
            let (undo, redo) = (history.undo_title().is_some(), history.redo_title().is_some());
            self.history_button(ui, redo, Icon::REDO, "Redo", "Ctrl+Shift+Z", Command::Redo);
            self.history_button(ui, undo, Icon::UNDO, "Undo", "Ctrl+Z", Command::Undo);
        });
    }

    fn history_button(&mut self, ui: &mut Ui, on: bool, icon: Icon, name: &str, key: &str, command: Command) {
        ui.add_enabled_ui(on, |ui| {
            if ToolButton::new(icon, name).key(key).show(ui).clicked() {
                self.commands.push(command);
            }
        });
    }
}
