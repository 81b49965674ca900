//! The selected threat, on the strip above the canvas: its range, its peak and how its risk falls.

use eframe::egui::Ui;

use super::threats_layer;
use crate::app::features::threats::ThreatEditor;
use meshbrush_core::layers::{Layer, Threat, ThreatLaw, Threats};
use meshbrush_kit::kit::command::{Command, EditCommand, ShellCommand};
use meshbrush_kit::kit::{FrameState, StripItem, end_gesture_when_released, set_kind};
use meshbrush_ui::widgets::{SliderRow, segmented};

/// The range, the peak and the law of the selected threat.
pub static THREAT_OPTIONS: [StripItem; 3] = [
    StripItem::new(144.0, 0, range_row).stretching().only(|state| selected(state).is_some()),
    StripItem::new(120.0, 1, peak_row).stretching().only(|state| selected(state).is_some()),
    StripItem::new(216.0, 2, law_row).only(|state| selected(state).is_some()),
];

/// Returns the selected layer, its threats, and the number of the selected one.
fn selected<'a>(state: &FrameState<'a>) -> Option<(&'a Layer, &'a Threats, usize)> {
    let document = state.session.document();
    let (layer, threats) = threats_layer(document).filter(|(layer, _)| !layer.locked)?;
    Some((layer, threats, state.feature::<ThreatEditor>().selected_in(document)?))
}

/// Changes a threat of a layer. Further changes join the gesture.
pub fn set_threat(
    layer: &Layer,
    threats: &Threats,
    number: usize,
    threat: Threat,
    commands: &mut Vec<Command>,
) {
    let mut threats = threats.clone();
    match threats.set(number, threat) {
        Ok(()) => set_kind(layer, threats, commands),
        Err(error) => commands.push(Command::from(ShellCommand::Report(error.to_string()))),
    }
}

fn range_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((layer, threats, number)) = selected(state) else { return };
    let mut threat = threats.list()[number];
    let extent = state.session.document().settings().domain.bounds.size().max_element();
    let row = SliderRow::new("Range", &mut threat.range, 1e-3 * extent..=extent).logarithmic();
    let row = row.typed_range(f64::MIN_POSITIVE..=f64::MAX).unit(state.unit().symbol());
    let response = row.help("The distance from which on the threat has no risk.").show(ui);
    if response.changed() {
        set_threat(layer, threats, number, threat, commands);
    }
    end_gesture_when_released(&response, commands);
}

fn peak_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((layer, threats, number)) = selected(state) else { return };
    let mut threat = threats.list()[number];
    let row = SliderRow::new("Peak", &mut threat.peak, 0.0..=1.0).step(0.01);
    let response = row.help("The risk in the middle of the threat, 0 to 1.").show(ui);
    if response.changed() {
        set_threat(layer, threats, number, threat, commands);
    }
    end_gesture_when_released(&response, commands);
}

fn law_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((layer, threats, number)) = selected(state) else { return };
    let mut threat = threats.list()[number];
    let laws = [(ThreatLaw::Radar, "Radar"), (ThreatLaw::Gaussian, "Gaussian"), (ThreatLaw::Disc, "Disc")];
    if segmented(ui, "How the risk falls", &mut threat.law, &laws).changed() {
        set_threat(layer, threats, number, threat, commands);
        commands.push(Command::from(EditCommand::EndGesture));
    }
}
