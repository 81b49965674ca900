//! Layers of depths of water.

use eframe::egui::Ui;

use super::raster::source_rows;
use crate::app::features::domain::DomainCommand;
use crate::app::features::layers::{OPEN_DEPTH, way_to_metres};
use meshbrush_core::domain::DepthContour;
use meshbrush_core::layers::{DepthRule, DepthSizes, Depths, Layer, PositiveDepth, wavelength};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, remark, set_kind_once};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::{
    ActionButton, Icon, NumberRow, ValueRow, choice_rows, format, segmented, toggle_row,
};

/// Depths of water.
pub static DEPTH: LayerKindRow = LayerKindRow {
    place: 7,
    is_of: |kind| kind.is::<Depths>(),
    icon: Icon::DEPTH,
    tool: None,
    additions: &[Addition {
        title: "depth of water…",
        command: |_| Command::from(FileCommand::Ask(&OPEN_DEPTH)),
    }],
    parameters,
};

/// What a layer of depths asks for, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Size {
    Nothing,
    Wavelength,
    Slope,
    Courant,
}

impl Size {
    const CHOICES: [(Self, &str); 4] = [
        (Self::Nothing, "Nothing"),
        (Self::Wavelength, "Wavelength"),
        (Self::Slope, "Bottom slope"),
        (Self::Courant, "Time step"),
    ];

    fn of(rule: &DepthRule) -> Self {
        match rule {
            DepthRule::Nothing => Self::Nothing,
            DepthRule::Wavelength { .. } => Self::Wavelength,
            DepthRule::Slope { .. } => Self::Slope,
            DepthRule::Courant { .. } => Self::Courant,
        }
    }

    /// Returns the rule with numbers that people begin with.
    fn default_rule(self) -> DepthRule {
        match self {
            Self::Nothing => DepthRule::Nothing,
            Self::Wavelength => DepthRule::DEFAULT_WAVELENGTH,
            Self::Slope => DepthRule::Slope { triangles: 20.0, smoothing: 0.0 },
            Self::Courant => DepthRule::Courant { time_step: 2.0, number: 0.5 },
        }
    }
}

/// Numbers above 0.
const POSITIVE: std::ops::RangeInclusive<f64> = f64::MIN_POSITIVE..=f64::MAX;

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(depths) = layer.kind.get::<Depths>() else { return };
    let before = *depths.sizes();
    let mut sizes = before;
    let choices = [(PositiveDepth::Up, "Heights"), (PositiveDepth::Down, "Depths")];
    segmented(ui, "Values are", &mut sizes.positive, &choices);
    let row = NumberRow::new("Offset", &mut sizes.offset).range(f64::MIN..=f64::MAX).unit("m");
    let help =
        "Added to the depths: for charts whose zero is not that of the other depths, such as low water.";
    row.help(help).show(ui);
    let mut size = Size::of(&sizes.rule);
    let is_in_metres = state.unit().may_be_metres();
    if choice_rows(ui, "Size by", &mut size, &Size::CHOICES).changed() && is_in_metres {
        sizes.rule = size.default_rule();
    }
    if !is_in_metres {
        remark(ui, &format!("Sizes from depths need a document in metres. {}", way_to_metres(state.unit())));
    }
    rule_rows(ui, &mut sizes.rule);
    if size != Size::Nothing {
        band_rows(ui, &mut sizes);
    }
    source_rows(ui, state, depths.source());
    let here = state.pointer.and_then(|point| depths.source().raster.raster().linear_at(point));
    let depth = here.map_or("–".to_owned(), |value| format::digits(sizes.depth_of(value), 5));
    ValueRow::new("Depth at the pointer", &depth).help("In metres; below 0 on land.").show(ui);
    contour_rows(ui, state, layer, commands);
    if sizes != before && sizes.check().is_ok() {
        set_kind_once(layer, depths.with_sizes(sizes), commands);
    }
}

/// Shows the contour that can become the domain. Its numbers are no part of the document.
fn contour_rows(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let id = ui.make_persistent_id(("contour", layer.id.0, state.session.document_id()));
    let mut contour: DepthContour = ui.data(|data| data.get_temp(id)).unwrap_or(DepthContour::SHORE);
    let symbol = if state.unit() == LengthUnit::Degree { "m" } else { state.unit().symbol() };
    ui.add_space(4.0);
    let row = NumberRow::new("Contour", &mut contour.level).range(f64::MIN..=f64::MAX).unit("m");
    row.help("The domain from the contour is where the depth is more than this; 0 is the shore.").show(ui);
    let row = NumberRow::new("Smallest island", &mut contour.smallest_island).range(0.0..=f64::MAX);
    let area = if symbol.is_empty() { String::new() } else { format!("{symbol}²") };
    let help = "Islands and waters of the contour with a smaller area are left out; 0 keeps all.";
    row.unit(&area).help(help).show(ui);
    let row = NumberRow::new("Smallest inlet", &mut contour.smallest_inlet).range(0.0..=f64::MAX);
    let help = "Inlets of the contour that are narrower are closed; 0 keeps all.";
    row.unit(symbol).help(help).show(ui);
    if ui.add(ActionButton::new("Use the contour as the domain")).clicked() {
        commands.push(Command::from(DomainCommand::UseContour(layer.id, contour)));
    }
    ui.data_mut(|data| data.insert_temp(id, contour));
}

/// Shows the numbers of a rule.
fn rule_rows(ui: &mut Ui, rule: &mut DepthRule) {
    match rule {
        DepthRule::Nothing => {}
        DepthRule::Wavelength { period, triangles } => {
            let row = NumberRow::new("Period", period).range(POSITIVE).unit("s");
            row.help("Period of the wave; 44,712 s is that of the semidiurnal lunar tide (M2).").show(ui);
            let row = NumberRow::new("Triangles", triangles).range(POSITIVE);
            row.help("Least number of triangles in the length of the wave.").show(ui);
            let lengths = [10.0, 1000.0].map(|depth| format::significant(wavelength(*period, depth), 3));
            let text = format!("{} m and {} m", lengths[0], lengths[1]);
            let help = "Length of the wave in water of 10 m and of 1000 m.";
            ValueRow::new("In 10 m and 1000 m", &text).help(help).show(ui);
        }
        DepthRule::Slope { triangles, smoothing } => {
            let row = NumberRow::new("Triangles", triangles).range(POSITIVE);
            let help = "Least number of triangles in the topographic length, 2π H / slope.";
            row.help(help).show(ui);
            let row = NumberRow::new("Average over", smoothing).range(0.0..=f64::MAX).unit("m");
            row.help("Side of the square over which heights are averaged first; 0 for none.").show(ui);
        }
        DepthRule::Courant { time_step, number } => {
            let row = NumberRow::new("Time step", time_step).range(POSITIVE).unit("s");
            row.help("Time step of the solver.").show(ui);
            let row = NumberRow::new("Courant number", number).range(POSITIVE);
            let help = "The diameter at which a wave of 1 m has this Courant number, u Δt / h. As a floor, the layer bounds the \
                        Courant number from above; where the finest counts, from below.";
            row.help(help).show(ui);
        }
    }
}

/// Shows the depths between which the layer asks for something.
fn band_rows(ui: &mut Ui, sizes: &mut DepthSizes) {
    let [least, greatest] = &mut sizes.between;
    let mut is_banded = [*least, *greatest] != DepthSizes::ALL_WATER;
    if toggle_row(ui, "Only between two depths", &mut is_banded).changed() {
        [*least, *greatest] = if is_banded { [0.0, 100.0] } else { DepthSizes::ALL_WATER };
    }
    if is_banded {
        let row = NumberRow::new("From depth", least).range(0.0..=*greatest).unit("m");
        row.help("Shallower water asks for nothing.").show(ui);
        let row = NumberRow::new("To depth", greatest).range(*least..=f64::MAX).unit("m");
        row.help("Deeper water asks for nothing.").show(ui);
    }
}
