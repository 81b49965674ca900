//! The panels round the canvas. A panel reads the app and sends commands; it changes nothing itself.

mod brush;
mod domain;
mod field;
mod inspector;
mod levels;
mod mesh;
mod menu;
mod status;
mod tools;
mod transfer;
mod view;

use eframe::egui::{self, Frame, Margin, Panel, ScrollArea, Ui};

pub use field::FieldTexts;

use super::App;
use super::theme::{metrics, tokens};
use super::tools::Tool;

impl App {
    /// All panels, from the rim inwards.
    pub(super) fn panels_ui(&mut self, ui: &mut Ui) {
        // Hidden panels have nothing under the pointer either.
        self.hovered_neighbour = None;
        self.view.lone_level = None;
        let t = *tokens(ui);
        let bar = Frame::new().fill(t.window).inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, 2));
        // The row of a menu bar stands at the top of its room.
        let above = ((metrics::MENU_BAR - metrics::ROW) / 2.0) as i8;
        let menu = bar.inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, above));
        Panel::top("menu").frame(menu).exact_size(metrics::MENU_BAR).show(ui, |ui| self.menu_ui(ui));
        Panel::bottom("status").frame(bar).exact_size(metrics::STATUS_BAR).show(ui, |ui| self.status_ui(ui));
        if self.view.panels {
            let strip = Frame::new().fill(t.panel).inner_margin(Margin::symmetric(6, 10));
            let width = metrics::TOOL + 12.0;
            Panel::left("tools")
                .frame(strip)
                .resizable(false)
                .exact_size(width)
                .show(ui, |ui| self.tools_ui(ui));
            // The scroll bar runs in the margin.
            let side = Frame::new().fill(t.panel);
            let width = metrics::PANEL_WIDTH;
            Panel::right("side")
                .frame(side)
                .resizable(false)
                .exact_size(width)
                .show(ui, |ui| self.side_ui(ui));
        }
    }

    fn side_ui(&mut self, ui: &mut Ui) {
        let margin = Margin::symmetric(metrics::PANEL_MARGIN as i8, 0);
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if std::mem::replace(&mut self.panel_of, self.tools.tool) != self.tools.tool {
            // What belongs to the new tool stands first: it is to be seen.
            area = area.vertical_scroll_offset(0.0);
        }
        area.show(ui, |ui| {
            Frame::new().inner_margin(margin).show(ui, |ui| self.sections_ui(ui));
        });
    }

    /// What belongs to the tool in hand stands first.
    fn sections_ui(&mut self, ui: &mut Ui) {
        if self.tools.paints() {
            self.brush_ui(ui);
        }
        if self.tools.tool == Tool::Domain {
            self.domain_ui(ui);
        }
        if self.tools.tool == Tool::Query {
            self.inspector_ui(ui);
        }
        self.transfer_ui(ui);
        self.levels_ui(ui);
        if self.tools.tool != Tool::Query {
            self.inspector_ui(ui);
        }
        self.field_ui(ui);
        self.mesh_ui(ui);
        if self.tools.tool != Tool::Domain {
            self.domain_ui(ui);
        }
        self.view_ui(ui);
        ui.add_space(metrics::PANEL_MARGIN);
    }

    /// Ends the gesture of a setting when the control was let go.
    fn settle(&mut self, response: &egui::Response) {
        if super::widgets::edit_done(response) {
            self.commands.push(super::command::Command::EndGesture);
        }
    }
}
