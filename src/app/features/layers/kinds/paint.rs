//! Layers to paint on.

use eframe::egui::Ui;

use super::quantity_name;
use meshbrush_core::layers::{Layer, LayerKind, PaintLayer, Quantity};
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, add_layer};
use meshbrush_mesh::text::Bytes;
use meshbrush_ui::widgets::{ActionButton, Icon, ValueRow};

/// Painted risk and painted diameters.
pub static PAINT: LayerKindRow = LayerKindRow {
    place: 0,
    is_of: |kind| kind.is::<PaintLayer>(),
    icon: Icon::BRUSH,
    tool: None,
    additions: &[
        Addition { title: "paint, as risk", command: |_| add_layer(LayerKind::paint(Quantity::Risk)) },
        Addition {
            title: "paint, as target diameter",
            command: |_| add_layer(LayerKind::paint(Quantity::Diameter)),
        },
        Addition {
            title: "paint, as largest error from surfaces",
            command: |_| add_layer(LayerKind::paint(Quantity::Error)),
        },
    ],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(quantity) = layer.paints() else { return };
    let help = "What the pixels mean: a risk from 0 to 1, or a target diameter in the unit of the document, or \
                the largest error of the mesh from surfaces, in their unit.";
    ValueRow::new("Painted as", quantity_name(quantity)).help(help).show(ui);
    let painted = state.session.document().paint().get(layer.id);
    let bytes = painted.map_or(0, |raster| raster.bytes());
    let help = "Memory of the painted pixels. They are as fine as the strokes that painted them.";
    ValueRow::new("Painted pixels", &Bytes(bytes).to_string()).help(help).show(ui);
    ui.add_space(4.0);
    let is_blank = painted.is_none_or(|raster| raster.is_blank());
    let button = ActionButton::new("Clear this layer");
    if ui.add_enabled_ui(!is_blank, |ui| ui.add(button)).inner.clicked() {
        commands.push(Command::from(LayerCommand::Clear(layer.id)));
    }
}
