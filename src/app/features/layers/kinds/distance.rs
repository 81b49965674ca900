//! Layers in which h̄ grows with a distance.

use eframe::egui::{ScrollArea, Ui};

use crate::app::features::layers::{OPEN_SHAPES, REPLACE_SHAPES};
use crate::app::features::regions::{RegionCommand, RegionTarget};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryType, PieceChoice};
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerKind};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_kit::kit::{
    Addition, FrameState, LayerKindRow, add_layer, button_rows, range_rows, remark, set_kind_once,
};
use meshbrush_ui::widgets::{Icon, NumberRow, ValueRow, toggle_row, toggle_row_with_help};

/// The distance to shapes or to the outline of the domain.
pub static DISTANCE: LayerKindRow = LayerKindRow {
    place: 4,
    is_of: |kind| kind.get().is_some_and(|distance: &DistanceLayer| !distance.to.is_corridor()),
    icon: Icon::DISTANCE,
    tool: None,
    additions: &[
        Addition { title: "distance to the outline", command: add_distance_to_outline },
        Addition { title: "distance to drawn shapes", command: |_| draw_shapes() },
        Addition {
            title: "distance to shapes…", command: |_| Command::from(FileCommand::Ask(&OPEN_SHAPES))
        },
    ],
    parameters,
};

/// Height of the list of pieces, in points; more pieces scroll.
const LIST_HEIGHT: f32 = 140.0;
/// Most pieces in the list; names of others can be written in a recipe.
const MOST_ROWS: usize = 200;

/// Selects the tool that draws shapes: the first one adds a layer, unless the selected one has shapes.
fn draw_shapes() -> Command {
    Command::from(RegionCommand::Target(RegionTarget::Shapes))
}

fn add_distance_to_outline(state: &FrameState<'_>) -> Command {
    let transfer = &state.session.document().settings().transfer;
    add_layer(LayerKind::distance_to(DistanceTo::Outline, transfer, Settings::DEFAULT_GRADATION))
}

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(DistanceLayer { to, at_zero, slope, range }) = layer.kind.get() else { return };
    let target = match to {
        DistanceTo::Outline => "outline of the domain",
        DistanceTo::Coasts => "coasts of the domain",
        DistanceTo::Pieces(_) => "pieces of the boundary",
        DistanceTo::Shapes { name, .. } if name.is_empty() => "drawn shapes",
        DistanceTo::Shapes { name, .. } => name,
        DistanceTo::Corridor { .. } => return,
    };
    ValueRow::new("Distance to", target).help("What the distance is measured to.").show(ui);
    target_buttons(ui, layer, to, commands);
    match to {
        DistanceTo::Pieces(chosen) => pieces_rows(ui, state, layer, chosen, commands),
        _ => open_boundary_row(ui, state, layer, to, commands),
    }
    let (mut at_zero, mut slope, mut range) = (*at_zero, *slope, *range);
    let positive = f64::MIN_POSITIVE..=f64::MAX;
    let unit = state.unit().symbol();
    let row = NumberRow::new("At distance 0", &mut at_zero).range(positive).unit(unit);
    let mut changed = row.help("Target diameter at distance 0; it grows from there.").show(ui).changed();
    let row = NumberRow::new("Growth", &mut slope).range(0.0..=f64::MAX);
    let help = "How much the target diameter grows with the distance, per unit of length.";
    changed |= row.help(help).show(ui).changed();
    changed |= range_rows(ui, state, &mut range);
    if changed {
        set_kind_once(layer, DistanceLayer { to: to.clone(), at_zero, slope, range }, commands);
    }
}

/// Shows which pieces of the boundary count: types, then names.
fn pieces_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    chosen: &PieceChoice,
    commands: &mut Vec<Command>,
) {
    chosen_row(ui, layer, true, commands);
    let Some(pieces) = state.session.boundary_pieces() else {
        return remark(ui, "The pieces are being found.");
    };
    let mut next = chosen.clone();
    let has = |of_piece| pieces.list().iter().any(|piece| piece.boundary_type() == of_piece);
    for of_piece in BoundaryType::ALL.into_iter().filter(|&t| has(t) || chosen.types.contains(&t)) {
        let mut counts = chosen.types.contains(&of_piece);
        let label = format!("All of the type {}", of_piece.word());
        let help = "Measures to every piece of the boundary with this type, also to those that get it later.";
        if toggle_row_with_help(ui, &label, help, &mut counts).changed() {
            next.types.retain(|other| *other != of_piece);
            next.types.extend(counts.then_some(of_piece));
        }
    }
    let area = ScrollArea::vertical().id_salt("pieces of a distance").max_height(LIST_HEIGHT);
    area.show(ui, |ui| {
        let names = pieces.list().iter().map(|piece| piece.name.as_str());
        let lost: Vec<&str> = chosen.unknown_names(pieces).collect();
        for name in lost.into_iter().chain(names).take(MOST_ROWS) {
            let mut counts = chosen.names.iter().any(|other| other == name);
            let help = "Measures to the piece of the boundary with this name, whatever its type.";
            if toggle_row_with_help(ui, name, help, &mut counts).changed() {
                next.names.retain(|other| other != name);
                next.names.extend(counts.then(|| name.to_owned()));
            }
        }
    });
    if next != *chosen {
        commands.push(Command::from(LayerCommand::MeasureTo(layer.id, DistanceTo::Pieces(next))));
    }
    if !pieces.list().iter().any(|piece| chosen.includes(piece)) {
        remark(ui, "No piece of the boundary is chosen: the layer asks for nothing.");
    }
}

/// Shows whether only some pieces count.
fn chosen_row(ui: &mut Ui, layer: &Layer, mut chooses: bool, commands: &mut Vec<Command>) {
    if toggle_row(ui, "Only some pieces", &mut chooses).changed() {
        let to = if chooses { DistanceTo::Pieces(PieceChoice::of_land()) } else { DistanceTo::Outline };
        commands.push(Command::from(LayerCommand::MeasureTo(layer.id, to)));
    }
}

/// Shows whether open parts of the boundary count, where the distance is that to the boundary.
fn open_boundary_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    to: &DistanceTo,
    commands: &mut Vec<Command>,
) {
    let mut leaves_out = *to == DistanceTo::Coasts;
    if to.shapes().is_some() {
        return;
    }
    if toggle_row(ui, "Leave out open boundaries", &mut leaves_out).changed() {
        let to = if leaves_out { DistanceTo::Coasts } else { DistanceTo::Outline };
        commands.push(Command::from(LayerCommand::MeasureTo(layer.id, to)));
    }
    chosen_row(ui, layer, false, commands);
    let domain = &state.session.document().settings().domain;
    if leaves_out && domain.region().is_none() {
        remark(ui, "All of the boundary is open, as the domain has no polygons: the layer asks for nothing.");
    }
}

/// Shows buttons that choose the target of the distance.
fn target_buttons(ui: &mut Ui, layer: &Layer, to: &DistanceTo, commands: &mut Vec<Command>) {
    let is_shapes = to.shapes().is_some();
    let outline = Command::from(LayerCommand::MeasureTo(layer.id, DistanceTo::Outline));
    let row = [
        ("Draw shapes", is_shapes, draw_shapes()),
        ("Open shapes…", true, Command::from(FileCommand::Ask(&REPLACE_SHAPES))),
        ("Use outline", is_shapes, outline),
    ];
    button_rows(ui, [row], commands);
    ui.add_space(4.0);
}
