use eframe::egui::{Align, Layout, Ui};

use super::super::App;
use super::super::readout::{Quantity, value_at};
use super::super::widgets::{StatusCell, format};
use crate::document::Stage;
use crate::field::RefinementRule;

/// Space between cells.
const GAP: f32 = 16.0;
/// Shown where there is nothing to show.
const NONE: &str = "–";

impl App {
    pub(super) fn status_ui(&mut self, ui: &mut Ui) {
        let [left, right] = self.fitting_cells(ui);
        ui.horizontal_centered(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            for cell in left {
                cell.show(ui);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                for cell in right {
                    cell.show(ui);
                }
            });
        });
    }

    /// The cells at the left, from the left, and those at the right, from the right. Where there is no room for all, those
    /// that matter least are left out.
    fn fitting_cells(&self, ui: &Ui) -> [Vec<StatusCell>; 2] {
        let [x, y, target] = self.pointer_cells();
        let [triangles, nodes, deepest] = self.mesh_cells();
        let [rule, update] = self.work_cells();
        let mut left = vec![x, y, target, triangles, nodes, deepest];
        let mut right = vec![rule, update];
        let room = ui.available_width();
        let width = |cells: &[StatusCell]| cells.iter().map(|cell| cell.width(ui) + GAP).sum::<f32>();
        while width(&left) + width(&right) - GAP > room && left.len() > 4 {
            left.remove(4);
        }
        if width(&left) + width(&right) - GAP > room {
            right.truncate(1);
        }
        [left, right]
    }

    /// Position of the pointer, and h̄ there.
    fn pointer_cells(&self) -> [StatusCell; 3] {
        let cells = |[x, y, target]: [String; 3]| {
            [("x", x), ("y", y), ("h̄", target)].map(|(name, value)| StatusCell::new(name, value, 8))
        };
        let Some(point) = self.pointer_world else { return cells([NONE; 3].map(String::from)) };
        let step = self.view.camera.map_or(1e-4, |camera| 1.0 / camera.px_per_world());
        let target =
            value_at(point, self.session.document(), self.session.follower(), Quantity::TargetDiameter);
        let inside = self.session.document().settings().domain.bounds.contains(point);
        let target = if inside { format::length(target) } else { "outside".into() };
        cells([format::coordinate(point.x, step), format::coordinate(point.y, step), target])
    }

    fn mesh_cells(&self) -> [StatusCell; 3] {
        let mesh = self.session.mesh();
        let nodes = match (mesh.outside_count(), self.session.topology()) {
            (0, _) => format::count(mesh.raw_nodes().len() as u64),
            (_, Some(topology)) => format::count(topology.nodes as u64),
            (_, None) => NONE.into(),
        };
        let deepest = self.session.level_counts().len().saturating_sub(1);
        [
            StatusCell::new("triangles", format::count(mesh.triangle_count() as u64), 10),
            StatusCell::new("nodes", nodes, 10),
            StatusCell::new("deepest level", deepest.to_string(), 2),
        ]
    }

    /// The rule, and how long the last update took or how far the present one is.
    fn work_cells(&self) -> [StatusCell; 2] {
        let rule = match self.session.follower().settings().rule {
            RefinementRule::Area => "area",
            RefinementRule::Vertex => "vertex",
        };
        [StatusCell::new("rule", rule, 0), StatusCell::new("update", self.update_text(), 11)]
    }

    fn update_text(&self) -> String {
        match self.session.stage() {
            // Not even while at work: which glyphs were needed by then would depend on the machine's speed.
            _ if self.reproducible => NONE.into(),
            Stage::InStep => {
                self.session.last_update().map_or(NONE.into(), |time| format::time(time.as_secs_f64()))
            }
            Stage::Indexing => "indexing".into(),
            Stage::Sampling => "sampling".into(),
            Stage::Copying { triangles } | Stage::Refining { triangles } => format::count(triangles as u64),
            Stage::GaveUp(None) => "cancelled".into(),
            Stage::GaveUp(Some(_)) => "stopped".into(),
        }
    }
}
