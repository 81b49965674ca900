use eframe::egui::{Align, Layout, Ui};

use super::super::App;
use super::super::readout::{Quantity, value_at};
use super::super::widgets::{format, status_cell};
use crate::document::Stage;
use crate::field::Rule;

impl App {
    pub(super) fn status_ui(&mut self, ui: &mut Ui) {
        ui.horizontal_centered(|ui| {
            ui.spacing_mut().item_spacing.x = 16.0;
            self.pointer_cells(ui);
            self.mesh_cells(ui);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 16.0;
                let rule = match self.session.follower().settings().rule {
                    Rule::Area => "area",
                    Rule::Vertex => "vertex",
                };
                status_cell(ui, "rule", rule, 6);
                status_cell(ui, "update", &self.update_text(), 11);
            });
        });
    }

    /// Position of the pointer, and h̄ there.
    fn pointer_cells(&self, ui: &mut Ui) {
        let Some(point) = self.pointer_world else {
            status_cell(ui, "x", "", 8);
            status_cell(ui, "y", "", 8);
            status_cell(ui, "h̄", "", 8);
            return;
        };
        let step = self.view.camera.map_or(1e-4, |camera| 1.0 / camera.px_per_world());
        let target =
            value_at(point, self.session.document(), self.session.follower(), Quantity::TargetDiameter);
        let inside = self.session.document().settings().domain.bounds.contains(point);
        status_cell(ui, "x", &format::coordinate(point.x, step), 8);
        status_cell(ui, "y", &format::coordinate(point.y, step), 8);
        status_cell(ui, "h̄", &if inside { format::length(target) } else { "outside".into() }, 8);
    }

    fn mesh_cells(&self, ui: &mut Ui) {
        let mesh = self.session.mesh();
        let deepest = self.session.level_counts().len().saturating_sub(1);
        status_cell(ui, "triangles", &format::count(mesh.triangles().len() as u64), 10);
        status_cell(ui, "nodes", &format::count(mesh.nodes().len() as u64), 10);
        status_cell(ui, "deepest level", &deepest.to_string(), 2);
    }

    fn update_text(&self) -> String {
        match self.session.stage() {
            Stage::InStep => {
                self.session.last_update().map_or(String::new(), |time| format::time(time.as_secs_f64()))
            }
            Stage::Filling => "sampling".into(),
            Stage::Refining { triangles } => format::count(triangles as u64),
        }
    }
}
