use eframe::egui::Ui;

use super::super::App;
use super::super::command::Command;
use super::super::readout::{Quantity, value_at};
use super::super::widgets::{Section, Transfer as Shown, TransferCurve};
use crate::document::Setting;
use crate::field::{RiskToDiameter, Transfer};

/// Exponents that the curve's middle handle reaches.
const SHAPES: std::ops::RangeInclusive<f64> = 0.2..=5.0;

impl App {
    pub(super) fn transfer_ui(&mut self, ui: &mut Ui) {
        Section::new("Risk to diameter").show(ui, |ui| {
            let settings = self.session.document().settings();
            let Transfer { h_min, h_max, shape } = settings.transfer;
            let extent = settings.domain.bounds.size().max_element();
            let mut shown = Shown { h_max, h_min, shape };
            let curve = |t: &Shown, risk: f64| {
                Transfer { h_min: t.h_min, h_max: t.h_max, shape: t.shape }.diameter(risk)
            };
            let mark = self.pointer_world.map(|point| {
                value_at(point, self.session.document(), self.session.follower(), Quantity::Risk)
            });
            let editor = TransferCurve::new(&mut shown, &curve, 1e-5 * extent..=2.0 * extent, SHAPES);
            let answer = editor.mark(mark.filter(|risk| risk.is_finite())).show(ui);
            if shown.h_max != h_max {
                self.commands.push(Command::Set(Setting::LargestDiameter(shown.h_max)));
            }
            if shown.h_min != h_min {
                self.commands.push(Command::Set(Setting::SmallestDiameter(shown.h_min)));
            }
            if shown.shape != shape {
                self.commands.push(Command::Set(Setting::TransferShape(shown.shape)));
            }
            self.settle(&answer.response);
        });
    }
}
