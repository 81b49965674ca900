//! Layers of threats.

use eframe::egui::Ui;

use super::options::set_threat;
use super::{OPEN_THREATS, SAVE_THREATS, THREATS, ThreatsCommand};
use crate::app::features::threats::ThreatEditor;
use meshbrush_core::layers::{Layer, Threats};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, add_layer, button_rows};
use meshbrush_ui::widgets::{Icon, NumberRow, ValueRow, format};

/// Places with a risk around them.
pub static THREATS_KIND: LayerKindRow = LayerKindRow {
    place: 3,
    is_of: |kind| kind.is::<Threats>(),
    icon: Icon::THREATS,
    tool: Some(&THREATS),
    additions: &[Addition { title: "threats", command: |_| add_layer(Threats::default()) }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(threats) = layer.kind.get::<Threats>() else { return };
    let count = threats.list().len();
    let text = format::count(count as u64);
    ValueRow::new("Threats", &text).help("Places with a risk around them, in this layer.").show(ui);
    let selected = state.feature::<ThreatEditor>().selected_in(state.session.document());
    if count > 0 {
        // 0 while none is selected.
        let mut number = selected.map_or(0.0, |number| number as f64 + 1.0);
        let row = NumberRow::new("Selected threat", &mut number).range(1.0..=count as f64).integer();
        let help = "Number of the selected threat; the canvas selects threats too, with the tool Threats.";
        if row.help(help).show(ui).changed() {
            commands.push(Command::from(ThreatsCommand::Select((number as usize).max(1) - 1)));
        }
    }
    if let Some(number) = selected {
        selected_rows(ui, state, layer, threats, number, commands);
    }
    buttons(ui, state, selected.is_some(), count > 0, commands);
}

/// Where the selected threat is. Its range, peak and law are options of the tool.
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
    if threat != before {
        set_threat(layer, threats, number, threat, commands);
        commands.push(Command::from(EditCommand::EndGesture));
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
            ("Add threat", true, Command::from(ThreatsCommand::Place(middle))),
            ("Delete threat", is_selected, Command::from(ThreatsCommand::Delete)),
        ],
        [
            ("Open table…", true, Command::from(FileCommand::Ask(&OPEN_THREATS))),
            ("Save table…", has_threats, Command::from(FileCommand::Ask(&SAVE_THREATS))),
        ],
    ];
    button_rows(ui, rows, commands);
}
