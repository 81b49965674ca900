//! Layers of threats.

use eframe::egui::Ui;

use super::{OPEN_THREATS, SAVE_THREATS, THREATS, ThreatsCommand};
use crate::app::command::{Command, FileCommand, ShellCommand};
use crate::app::kit::{Addition, FrameState, LayerKindRow, add_layer, button_rows, set_kind_once};
use crate::app::widgets::{Icon, NumberRow, ValueRow, format, segmented};
use meshbrush_core::layers::{Layer, LayerKind, Threat, ThreatLaw, Threats};

/// Places with a risk around them.
pub static THREATS_KIND: LayerKindRow = LayerKindRow {
    place: 3,
    is_of: |kind| matches!(kind, LayerKind::Threats(_)),
    icon: Icon::THREATS,
    tool: Some(&THREATS),
    additions: &[Addition {
        title: "threats",
        command: |_| add_layer(LayerKind::Threats(Threats::default())),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let LayerKind::Threats(threats) = &layer.kind else { return };
    let count = threats.list().len();
    let text = format::count(count as u64);
    ValueRow::new("Threats", &text).help("Places with a risk around them, in this layer.").show(ui);
    let selected = state.features.threats.selected_in(state.session.document());
    if count > 0 {
        // 0 while none is selected.
        let mut number = selected.map_or(0.0, |number| number as f64 + 1.0);
        let row = NumberRow::new("Selected threat", &mut number).range(1.0..=count as f64).integer();
        let help = "Number of the selected threat; the canvas selects threats too, with the tool Threats.";
        if row.help(help).show(ui).changed() {
            commands.push(Command::Threats(ThreatsCommand::Select((number as usize).max(1) - 1)));
        }
    }
    if let Some(number) = selected {
        selected_rows(ui, state, layer, threats, number, commands);
    }
    buttons(ui, state, selected.is_some(), count > 0, commands);
}

/// The numbers and the law of the selected threat.
fn selected_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    threats: &Threats,
    number: usize,
    commands: &mut Vec<Command>,
) {
    let before = threats.list()[number];
    let mut threat = before;
    let unit = state.unit().symbol();
    let coordinates = [("x", &mut threat.at.x), ("y", &mut threat.at.y)];
    for (name, value) in coordinates {
        NumberRow::new(name, value).unit(unit).help("Coordinate of the selected threat.").show(ui);
    }
    let row = NumberRow::new("Range", &mut threat.range).range(f64::MIN_POSITIVE..=f64::MAX).unit(unit);
    row.help("The distance from which on the threat has no risk.").show(ui);
    let row = NumberRow::new("Peak", &mut threat.peak).range(0.0..=1.0);
    row.help("The risk in the middle of the threat, 0 to 1.").show(ui);
    let laws = [(ThreatLaw::Radar, "Radar"), (ThreatLaw::Gaussian, "Gaussian"), (ThreatLaw::Disc, "Disc")];
    segmented(ui, "How the risk falls", &mut threat.law, &laws);
    ui.add_space(4.0);
    if threat != before {
        set_threat(layer, threats, number, threat, commands);
    }
}

fn set_threat(layer: &Layer, threats: &Threats, number: usize, threat: Threat, commands: &mut Vec<Command>) {
    let mut threats = threats.clone();
    match threats.set(number, threat) {
        Ok(()) => set_kind_once(layer, LayerKind::Threats(threats), commands),
        Err(error) => commands.push(Command::Shell(ShellCommand::Report(error.to_string()))),
    }
}

fn buttons(
    ui: &mut Ui,
    state: &FrameState<'_>,
    is_selected: bool,
    has_threats: bool,
    commands: &mut Vec<Command>,
) {
    let middle = state.view.camera.map(|camera| camera.visible_world().center());
    let middle = middle.unwrap_or_else(|| state.session.document().settings().domain.bounds.center());
    let rows = [
        [
            ("Add threat", true, Command::Threats(ThreatsCommand::Place(middle))),
            ("Delete threat", is_selected, Command::Threats(ThreatsCommand::Delete)),
        ],
        [
            ("Open table…", true, Command::File(FileCommand::Ask(&OPEN_THREATS))),
            ("Save table…", has_threats, Command::File(FileCommand::Ask(&SAVE_THREATS))),
        ],
    ];
    button_rows(ui, rows, commands);
}
