use eframe::egui::Ui;

use super::super::App;
use super::super::command::Command;
use super::super::tools::{PaintKind, Tool};
use super::super::widgets::{Section, SliderRow, segmented, value_row};

impl App {
    pub(super) fn brush_ui(&mut self, ui: &mut Ui) {
        let erasing = self.tools.tool == Tool::Eraser;
        let title = if erasing { "Eraser" } else { "Brush" };
        Section::new(title).id("brush").show(ui, |ui| {
            if !erasing {
                self.kind_ui(ui);
            }
            self.size_ui(ui);
            if !erasing && self.tools.kind == PaintKind::Diameter {
                self.diameter_ui(ui);
            } else {
                self.strength_ui(ui);
            }
            self.hardness_ui(ui);
        });
    }

    fn kind_ui(&mut self, ui: &mut Ui) {
        let mut kind = self.tools.kind;
        let choices = [(PaintKind::Risk, "Risk"), (PaintKind::Diameter, "Diameter")];
        if segmented(ui, "What the brush paints", &mut kind, &choices).changed() {
            self.commands.push(Command::Paint(kind));
        }
        ui.add_space(4.0);
    }

    pub(super) fn size_ui(&mut self, ui: &mut Ui) {
        let extent = self.session.document().settings().domain.bounds.size().max_element();
        let mut radius = self.tools.radius;
        let slider = SliderRow::new("Size", &mut radius, 1e-4 * extent..=0.5 * extent).logarithmic();
        if slider.help("Radius in world units. [ and ] change it, Shift and a drag too.").show(ui).changed() {
            self.commands.push(Command::BrushRadius(radius));
        }
    }

    fn strength_ui(&mut self, ui: &mut Ui) {
        let mut strength = self.tools.strength();
        let slider = SliderRow::new("Strength", &mut strength, 0.01..=1.0).step(0.01);
        if slider.help("How much of the way one stroke goes. The digits 1 to 0 set it.").show(ui).changed() {
            self.commands.push(Command::BrushStrength(strength));
        }
    }

    fn hardness_ui(&mut self, ui: &mut Ui) {
        let mut hardness = self.tools.hardness;
        let slider = SliderRow::new("Hardness", &mut hardness, 0.0..=1.0).step(0.01);
        if slider
            .help("Share of the radius with full strength. Shift+[ and Shift+] change it.")
            .show(ui)
            .changed()
        {
            self.commands.push(Command::BrushHardness(hardness));
        }
    }

    /// The painted diameter, with the level that it means.
    fn diameter_ui(&mut self, ui: &mut Ui) {
        let transfer = self.session.document().settings().transfer;
        let field = self.session.follower().field();
        let mut diameter = self.tools.diameter.clamp(transfer.h_min, transfer.h_max);
        let level = field.level_of_diameter(diameter).map_or("–".into(), |level| level.to_string());
        let slider = SliderRow::new("Diameter", &mut diameter, transfer.h_min..=transfer.h_max).logarithmic();
        if slider.help("Target diameter that the brush paints.").show(ui).changed() {
            self.commands.push(Command::BrushDiameter(diameter));
        }
        value_row(ui, "Refines to level", &level);
    }
}
