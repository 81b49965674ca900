//! The curve from risk to diameter.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use crate::app::command::{Command, EditCommand};
use crate::app::kit::{FrameState, Panel, PanelGroup, end_gesture_when_released};
use crate::app::readout::{Quantity, value_at};
use crate::app::widgets::{CurveValues, Section, TransferCurve};
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::field::{RiskToDiameter, Transfer};

/// The curve from risk to diameter.
pub static TRANSFER: Panel = Panel { name: "transfer", group: PanelGroup::Size, only_with_tool: false, show };

/// Exponents that the curve's middle handle reaches.
const SHAPES: RangeInclusive<f64> = 0.2..=5.0;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Risk to diameter").show(ui, |ui| {
        let settings = state.session.document().settings();
        let Transfer { h_min, h_max, shape } = settings.transfer;
        let extent = settings.domain.bounds.size().max_element();
        let mut shown = CurveValues { h_max, h_min, shape };
        let curve = |t: &CurveValues, risk: f64| {
            Transfer { h_min: t.h_min, h_max: t.h_max, shape: t.shape }.diameter(risk)
        };
        let (document, follower) = (state.session.document(), state.session.follower());
        let risk = state.pointer.map(|point| value_at(point, document, follower, Quantity::Risk));
        let editor = TransferCurve::new(&mut shown, &curve, 1e-5 * extent..=2.0 * extent, SHAPES);
        let usual = Settings::default().transfer;
        let defaults =
            CurveValues { h_max: usual.h_max * extent, h_min: usual.h_min * extent, shape: usual.shape };
        let editor = editor.unit(settings.unit).defaults(defaults);
        let response = editor.mark(risk.filter(|risk| risk.is_finite())).show(ui);
        if shown.h_max != h_max {
            commands.push(Command::Edit(EditCommand::Set(Setting::LargestDiameter(shown.h_max))));
        }
        if shown.h_min != h_min {
            commands.push(Command::Edit(EditCommand::Set(Setting::SmallestDiameter(shown.h_min))));
        }
        if shown.shape != shape {
            commands.push(Command::Edit(EditCommand::Set(Setting::TransferShape(shown.shape))));
        }
        end_gesture_when_released(&response, commands);
    });
}
