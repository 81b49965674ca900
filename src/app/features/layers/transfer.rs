//! The smallest diameter, and the curve from risk to diameter.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::field::{RiskToDiameter, Transfer};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::readout::{Quantity, value_at};
use meshbrush_kit::kit::{FrameState, Panel, Tab, end_gesture_when_released, size_price_row};
use meshbrush_ui::widgets::{CurveField, CurveValues, Section, SliderRow, TransferCurve};

/// The smallest diameter, and the curve from risk to diameter.
pub static TRANSFER: Panel = Panel { name: "transfer", tab: Tab::Size, place: 0, show };

/// Exponents that the curve's middle handle reaches.
const SHAPES: RangeInclusive<f64> = 0.2..=5.0;

/// Limits of the diameters that sliders and handles reach, as shares of the longer side of the domain.
const DIAMETERS: RangeInclusive<f64> = 1e-5..=2.0;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Size and risk").show(ui, |ui| {
        smallest_row(ui, state, commands);
        ui.add_space(4.0);
        curve(ui, state, commands);
        let kinds = [
            Setting::SmallestDiameter(0.0),
            Setting::DiameterAtRiskOne(0.0),
            Setting::LargestDiameter(0.0),
            Setting::TransferShape(0.0),
        ];
        size_price_row(ui, state, &kinds.map(|setting| setting.kind()), candidate(ui, state), commands);
    });
}

/// Returns the diameter that is being typed.
fn candidate(ui: &Ui, state: &FrameState<'_>) -> Option<Setting> {
    let unit = state.unit().symbol();
    let smallest = SliderRow::typed_so_far(ui, SMALLEST, unit).map(Setting::SmallestDiameter);
    let of_curve = || {
        let (field, typed) = TransferCurve::typed_so_far(ui, unit)?;
        Some(match field {
            CurveField::Largest => Setting::LargestDiameter(typed),
            CurveField::AtRiskOne => Setting::DiameterAtRiskOne(typed),
        })
    };
    smallest.or_else(of_curve)
}

fn smallest_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let extent = settings.domain.bounds.size().max_element();
    let Transfer { h_min, h_max, .. } = settings.transfer;
    let mut smallest = h_min;
    let least = (DIAMETERS.start() * extent).min(h_min);
    let slider = SliderRow::new(SMALLEST, &mut smallest, least..=h_max).logarithmic();
    let slider = slider.typed_range(f64::MIN_POSITIVE..=h_max).unit(settings.unit.symbol());
    let slider = slider.default(Settings::default().transfer.h_min * extent).help(SMALLEST_HELP);
    let response = slider.show(ui);
    if smallest != h_min {
        commands.push(Command::from(EditCommand::Set(Setting::SmallestDiameter(smallest))));
    }
    end_gesture_when_released(&response, commands);
}

/// The name of the smallest diameter.
const SMALLEST: &str = "h_min";

const SMALLEST_HELP: &str = "The smallest target diameter of the document, in its unit: nothing gets finer, \
                             whatever layers ask for. The risk curve stays.";

fn curve(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let Transfer { h_min: _, h_risk, h_max, shape } = settings.transfer;
    let extent = settings.domain.bounds.size().max_element();
    let mut shown = CurveValues { h_max, h_risk, shape };
    let curve = |t: &CurveValues, risk: f64| {
        Transfer { shape: t.shape, ..Transfer::between(t.h_risk, t.h_max) }.diameter(risk)
    };
    let (document, follower) = (state.session.document(), state.session.follower());
    let risk = state.pointer.map(|point| value_at(point, document, follower, Quantity::Risk));
    let limits = DIAMETERS.start() * extent..=DIAMETERS.end() * extent;
    let editor = TransferCurve::new(&mut shown, &curve, limits, SHAPES);
    let default = Settings::default().transfer;
    let defaults =
        CurveValues { h_max: default.h_max * extent, h_risk: default.h_risk * extent, shape: default.shape };
    let editor = editor.unit(settings.unit).defaults(defaults);
    let response = editor.mark(risk.filter(|risk| risk.is_finite())).show(ui);
    if shown.h_max != h_max {
        commands.push(Command::from(EditCommand::Set(Setting::LargestDiameter(shown.h_max))));
    }
    if shown.h_risk != h_risk {
        commands.push(Command::from(EditCommand::Set(Setting::DiameterAtRiskOne(shown.h_risk))));
    }
    if shown.shape != shape {
        commands.push(Command::from(EditCommand::Set(Setting::TransferShape(shown.shape))));
    }
    end_gesture_when_released(&response, commands);
}
