//! How good the triangles are: histograms, and the worst of each measure.

use eframe::egui::{Ui, vec2};

use super::figures::COURANT;
use super::panel::{PlaceRow, figures_of};
use super::{Measured, Statistics, StatisticsCommand};
use meshbrush_core::quality::{MeasureSummary, MeasuredPlace, QualityBin, QualityMeasure};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_kit::kit::{FrameState, Panel, Tab};
use meshbrush_ui::theme::metrics;
use meshbrush_ui::widgets::{
    Histogram, HistogramBar, Icon, NumberRow, Section, ToolButton, ValueRow, format,
};

/// Rows that all measures take.
const DEFAULT_ROWS: f32 = 18.0;

/// Angles, edges, targets, time steps and triangles at nodes.
pub static QUALITY: Panel = Panel { name: "quality", tab: Tab::Mesh, place: 2, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Quality").closed().show(ui, |ui| {
        figures_of(ui, DEFAULT_ROWS, state, commands, |ui, measured, commands| {
            let courant = state.feature::<Statistics>().courant();
            for measure in QualityMeasure::ALL {
                if measure == QualityMeasure::TimeStep {
                    courant_row(ui, measured, courant, commands);
                }
                if let Some(summary) = measured.quality.get(measure) {
                    MeasureRows { summary, courant }.show(ui, state, commands);
                }
            }
            strait_row(ui, measured, state, commands);
        });
    });
}

/// The Courant number of time steps, or the reason why there are none.
fn courant_row(ui: &mut Ui, measured: &Measured, courant: f64, commands: &mut Vec<Command>) {
    if let Some(missing) = measured.no_time_step {
        let help = "The largest time step of a solver follows from the depths of a layer, and from lengths in metres.";
        ValueRow::new("Time step", missing.reason()).help(help).show(ui);
        return;
    }
    let mut number = courant;
    let row = NumberRow::new("Courant number", &mut number).range(COURANT).default(1.0);
    let help = "The Courant number that your solver allows along an edge. Time steps below follow it.";
    if row.help(help).show(ui).changed() {
        commands.push(Command::from(StatisticsCommand::SetCourant(number)));
    }
}

/// The narrowest strait, where a layer of straits has found it.
fn strait_row(ui: &mut Ui, measured: &Measured, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((width, place)) = measured.narrowest_strait else { return };
    let value = &format::length(width, state.unit());
    let help = "The narrowest passage between two shores, from the layer of straits. A click goes there.";
    PlaceRow { label: "Narrowest strait", value, help, place, inside: place, size: width }.show(ui, commands);
}

/// The rows of a measure.
struct MeasureRows<'a> {
    summary: &'a MeasureSummary,
    courant: f64,
}

impl MeasureRows<'_> {
    fn show(&self, ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
        let measure = self.summary.measure;
        let MeasuredPlace { value, at, inside, size } = *self.summary.worst();
        let value = &self.text(value);
        PlaceRow { label: name_of(measure), value, help: help_of(measure), place: at, inside, size }
            .show(ui, commands);
        let overlay = FieldOverlay::of_measure(measure);
        let room = ui.available_width() - (metrics::ROW + metrics::GRID);
        ui.horizontal_top(|ui| {
            let bars = ui.allocate_ui(vec2(room, Histogram::HEIGHT), |ui| self.histogram(ui));
            if let Some(place) = bars.inner {
                commands.push(Command::from(ViewCommand::GoTo(place.at, place.size)));
            }
            overlay_button(ui, overlay, state, commands);
        });
        ui.add_space(6.0);
    }

    /// Shows the bars. Returns the place of the worst triangle or node of a bar that was clicked.
    fn histogram(&self, ui: &mut Ui) -> Option<MeasuredPlace> {
        let measure = self.summary.measure;
        let bins = self.summary.bins_in_use();
        let bars: Vec<HistogramBar> = bins.iter().map(|bin| self.bar(bin)).collect();
        let nouns = match measure {
            QualityMeasure::Valence => ["node", "nodes"],
            measure if measure.is_of_links() => ["link", "links"],
            _ => ["triangle", "triangles"],
        };
        let ends = [bins.first().map(|bin| bin.from), bins.last().map(|bin| self.end_of(bin))];
        let [first, last] = ends.map(|end| end.map_or_else(String::new, |number| self.text(number)));
        let histogram = Histogram::new(name_of(measure), &bars, nouns).ends([&first, &last]);
        bins.get(histogram.show(ui)?)?.worst
    }

    fn bar(&self, bin: &QualityBin) -> HistogramBar {
        let (from, to) = (self.text(bin.from), self.text(bin.to));
        let class = match self.summary.measure {
            QualityMeasure::Valence if bin.to.is_finite() => from,
            _ if bin.to.is_finite() => format!("{from} to {to}"),
            QualityMeasure::TargetRatio => format!("above {from}"),
            _ => format!("{from} or more"),
        };
        HistogramBar { class, count: bin.count as u64, is_bad: is_bad(self.summary.measure, bin) }
    }

    /// Returns the number at the right end of a class.
    fn end_of(&self, bin: &QualityBin) -> f64 {
        match self.summary.measure {
            QualityMeasure::Valence => bin.from,
            _ if bin.to.is_finite() => bin.to,
            _ => self.summary.greatest.value,
        }
    }

    fn text(&self, number: f64) -> String {
        match self.summary.measure {
            QualityMeasure::SmallestAngle | QualityMeasure::LargestAngle => angle_text(number),
            QualityMeasure::EdgeRatio
            | QualityMeasure::TargetRatio
            | QualityMeasure::LinkLength
            | QualityMeasure::LinkCosine => format::without_zeros(&format::fixed(number, 2)).to_owned(),
            QualityMeasure::TimeStep => format::time(self.courant * number),
            QualityMeasure::Valence => format::fixed(number, 0),
        }
    }
}

/// Shows the measure on the canvas, or the levels again.
fn overlay_button(ui: &mut Ui, overlay: FieldOverlay, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let is_shown = state.view.overlay == overlay;
    let name = format!("{} as overlay", overlay.name());
    if ToolButton::small(Icon::OVERLAY, &name).selected(is_shown).show(ui).clicked() {
        let next = if is_shown { FieldOverlay::None } else { overlay };
        commands.push(Command::from(ViewCommand::SetOverlay(next)));
    }
}

fn angle_text(degrees: f64) -> String {
    let text = format::fixed(degrees, 1);
    format!("{}°", format::without_zeros(&text))
}

fn name_of(measure: QualityMeasure) -> &'static str {
    match measure {
        QualityMeasure::SmallestAngle => "Smallest angle",
        QualityMeasure::LargestAngle => "Largest angle",
        QualityMeasure::EdgeRatio => "Edge ratio",
        QualityMeasure::TargetRatio => "Longest edge / h̄",
        QualityMeasure::TimeStep => "Time step",
        QualityMeasure::Valence => "Triangles at a node",
        QualityMeasure::LinkLength => "Link length",
        QualityMeasure::LinkCosine => "Orthogonality",
    }
}

fn help_of(measure: QualityMeasure) -> &'static str {
    match measure {
        QualityMeasure::SmallestAngle => {
            "The smallest angle of all triangles. Below are the triangles by their smallest angle, in red up to 20°. A \
             click goes to the worst."
        }
        QualityMeasure::LargestAngle => {
            "The largest angle of all triangles. Below are the triangles by their largest angle, in red from 130° on. A \
             click goes to the worst."
        }
        QualityMeasure::EdgeRatio => {
            "The largest ratio of the longest to the shortest edge of a triangle: the aspect ratio. Below are the triangles \
             by their ratio, in red from 3 on. A click goes to the worst."
        }
        QualityMeasure::TargetRatio => {
            "The largest ratio of the longest edge of a triangle to h̄ at its middle. Below are the triangles by their ratio, \
             in red above 1. A click goes to the worst."
        }
        QualityMeasure::TimeStep => {
            "The largest time step of a solver for a wave of 1 m with this Courant number along every edge. Below are the \
             triangles by theirs; each class is twice as long. A click goes to the triangle that decides it."
        }
        QualityMeasure::Valence => {
            "The most triangles at a node. Below are the nodes by theirs, in red from 9 on. A click goes to the node."
        }
        QualityMeasure::LinkLength => {
            "The shortest link between the centres of two cells, by their size, with pairs of triangles joined as Delft3D-FM \
             gets them. It removes those below 0.09, in red. A click goes to the worst."
        }
        QualityMeasure::LinkCosine => {
            "The largest cosine of the angle between a link of Delft3D-FM and the edge that it crosses: 0 is orthogonal. In red \
             from 0.5 on, where the solver refuses it. A click goes to the worst."
        }
    }
}

/// Returns whether a class has triangles or nodes that solvers tend to refuse.
fn is_bad(measure: QualityMeasure, bin: &QualityBin) -> bool {
    match measure {
        QualityMeasure::SmallestAngle => bin.to <= 20.0,
        QualityMeasure::LargestAngle => bin.from >= 130.0,
        QualityMeasure::EdgeRatio => bin.from >= 3.0,
        QualityMeasure::TargetRatio => bin.from > 0.95,
        QualityMeasure::TimeStep => false,
        QualityMeasure::Valence => bin.from >= 9.0,
        QualityMeasure::LinkLength => bin.to <= 0.091,
        QualityMeasure::LinkCosine => bin.from >= 0.495,
    }
}
