//! A plot of plain data.

use std::ops::RangeInclusive;

use egui::{Color32, CursorIcon, Rect, RichText, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};
use egui_plot::{
    AxisHints, Bar, BarChart, GridMark, Line, LineStyle, Plot as Chart, PlotBounds, PlotPoint, PlotPoints,
    PlotResponse, PlotUi, Points, VLine,
};

use super::paint;
use crate::theme::{Tokens, font, tokens};
use meshbrush_study::plot::{Axis, AxisRange, Mark, Plot, Series, Tick};

/// Room for a number along each axis, in points.
const TICK_ROOM: Vec2 = vec2(46.0, 28.0);
/// Height of a row of the legend, in points.
const LEGEND_ROW: f32 = 18.0;
/// Width of a sample in the legend, and the space after a name.
const SAMPLE: f32 = 14.0;
const GAP: f32 = 16.0;

/// A point this far from the pointer can still be picked, in points.
const PICK_REACH: f32 = 24.0;

/// Shows a plot in the full width and so many points high, with its legend above and its note below. Returns
/// the x under the pointer.
///
/// Beside the pointer are the values there. `name` names it for tests and screen readers.
pub fn plot_view(ui: &mut Ui, name: &str, plot: &Plot, height: f32) -> Option<f64> {
    let PlotResponse { response, transform, .. } = chart(ui, name, plot, height, Sense::hover());
    let hovered = response.hover_pos().map(|at| plot.x.value(transform.value_from_position(at).x));
    if let Some(x) = hovered {
        response.on_hover_text_at_pointer(plot.readout(x).join("\n"));
    }
    note(ui, plot);
    hovered
}

/// A point of a plot that the pointer is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PickedPoint {
    /// The index of the point in the first series.
    pub point: usize,
    /// Whether it was clicked.
    pub is_clicked: bool,
}

/// Shows a plot as [`plot_view`] does, to choose a point of its first series. Returns the point that is the
/// nearest to the pointer. `tip` says what is shown beside the pointer then.
pub fn plot_picker(
    ui: &mut Ui,
    name: &str,
    plot: &Plot,
    height: f32,
    tip: impl Fn(usize) -> String,
) -> Option<PickedPoint> {
    let PlotResponse { response, transform, .. } = chart(ui, name, plot, height, Sense::click());
    let nearest = response.hover_pos().and_then(|pointer| {
        let on_screen = |&[x, y]: &[f64; 2]| {
            let [x, y] = [plot.x.position(x)?, plot.y.position(y)?];
            Some(transform.position_from_point(&PlotPoint::new(x, y)))
        };
        let points = plot.series.first()?.points.iter().enumerate();
        let near = points.filter_map(|(number, point)| Some((number, on_screen(point)?)));
        near.filter(|(_, at)| at.distance(pointer) < PICK_REACH)
            .min_by(|a, b| a.1.distance(pointer).total_cmp(&b.1.distance(pointer)))
    });
    let picked = nearest.map(|(point, at)| {
        ui.painter().circle_stroke(at, 6.0, (1.5, tokens(ui).value));
        PickedPoint { point, is_clicked: response.clicked() }
    });
    if let Some(picked) = picked {
        response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text_at_pointer(tip(picked.point));
    }
    note(ui, plot);
    picked
}

fn note(ui: &mut Ui, plot: &Plot) {
    ui.label(RichText::new(&plot.note).font(font::caption()).color(tokens(ui).label));
}

/// Shows the legend and the chart.
fn chart(ui: &mut Ui, name: &str, plot: &Plot, height: f32, sense: Sense) -> PlotResponse<()> {
    let t = *tokens(ui);
    if plot.series.len() > 1 {
        legend(ui, plot, &t);
    }
    let [x, y] = plot.ranges();
    let size = vec2(ui.available_width(), height);
    let count = |room: f32, each: f32| (room / each) as usize;
    let ticks = [x.ticks(count(size.x, TICK_ROOM.x)), y.ticks(count(size.y, TICK_ROOM.y))];
    let bounds = PlotBounds::from_min_max([x.low(), y.low()], [x.high(), y.high()]);
    let [x_marks, y_marks] = [grid(&x, &ticks[0]), grid(&y, &ticks[1])];
    let [x_axis, y_axis] = [AxisHints::new_x(), AxisHints::new_y()];
    let chart = Chart::new(name)
        .width(size.x)
        .height(size.y)
        .sense(sense)
        .set_margin_fraction(Vec2::ZERO)
        .show_x(false)
        .show_y(false)
        .show_crosshair(false)
        .grid_color(t.line)
        .grid_spacing(1.0..=2.0)
        .custom_x_axes(vec![hints(x_axis, &plot.x, ticks[0].clone(), &t)])
        .custom_y_axes(vec![hints(y_axis, &plot.y, ticks[1].clone(), &t)])
        .x_grid_spacer(move |_| x_marks.clone())
        .y_grid_spacer(move |_| y_marks.clone());
    let draw = |chart: &mut PlotUi<'_>| {
        chart.set_plot_bounds(bounds);
        for number in 0..plot.series.len() {
            draw_series(chart, plot, number, &y, &t);
        }
        if let Some(at) = chart.pointer_coordinate().filter(|_| chart.response().hovered()) {
            chart.vline(VLine::new("pointer", at.x).color(t.faint).width(1.0).allow_hover(false));
        }
    };
    let shown = ui.scope(|ui| {
        ui.visuals_mut().extreme_bg_color = t.well;
        chart.show(ui, draw)
    });
    let shown = shown.inner;
    shown.response.widget_info(|| WidgetInfo {
        current_text_value: Some(plot.note.clone()),
        ..WidgetInfo::labeled(Role::Image, true, name)
    });
    shown
}

/// Returns the marks of an axis. All have the same distance: none is fainter than the others.
fn grid(range: &AxisRange, ticks: &[Tick]) -> Vec<GridMark> {
    let step_size = range.high() - range.low();
    ticks.iter().map(|tick| GridMark { value: tick.position, step_size }).collect()
}

fn hints<'a>(hints: AxisHints<'a>, axis: &Axis, ticks: Vec<Tick>, t: &Tokens) -> AxisHints<'a> {
    let label = move |mark: GridMark, _: &RangeInclusive<f64>| {
        let tick = ticks.iter().find(|tick| tick.position == mark.value);
        tick.map_or_else(String::new, |tick| tick.label.clone())
    };
    let title = RichText::new(axis.title()).font(font::caption()).color(t.label);
    hints
        .label(title)
        .formatter(label)
        .label_spacing(1.0..=2.0)
        .tick_label_color(t.label)
        .tick_label_font(font::axis())
}

fn color(number: usize, t: &Tokens) -> Color32 {
    let [first, second, third] = t.neighbours;
    [t.accent, first, second, third][number % 4]
}

fn draw_series(chart: &mut PlotUi<'_>, plot: &Plot, number: usize, y: &AxisRange, t: &Tokens) {
    let series = &plot.series[number];
    let Series { name, mark, points, .. } = series;
    let color = color(number, t);
    let place = |&[x, y]: &[f64; 2]| Some([plot.x.position(x)?, plot.y.position(y)?]);
    let places: Vec<[f64; 2]> = points.iter().filter_map(place).collect();
    match mark {
        Mark::Bars => {
            let [from, width] = plot.bar_span(number);
            let zero = plot.y.position(0.0).unwrap_or(y.low());
            let bar = |[x, y]: [f64; 2]| {
                Bar::new(x + from + 0.5 * width, y - zero).base_offset(zero).width(0.94 * width).fill(color)
            };
            let bars = places.into_iter().map(bar).collect();
            chart.bar_chart(BarChart::new(name, bars).color(color).allow_hover(false));
        }
        Mark::Points => {
            let points = Points::new(name, PlotPoints::from(places)).radius(3.0);
            chart.points(points.color(color).allow_hover(false));
            for ends in series.error_bars() {
                let [Some(low), Some(high)] = ends.each_ref().map(place) else { continue };
                let bar = Line::new(name, PlotPoints::from(vec![low, high])).color(color).width(1.5);
                chart.line(bar.allow_hover(false));
            }
        }
        Mark::Line => {
            let style = if number == 0 { LineStyle::Solid } else { LineStyle::dashed_loose() };
            let line = Line::new(name, PlotPoints::from(places)).style(style).width(1.5);
            chart.line(line.color(color).allow_hover(false));
        }
    }
}

/// A sample and the name of each series, in as many rows as they need.
fn legend(ui: &mut Ui, plot: &Plot, t: &Tokens) {
    let names: Vec<_> =
        plot.series.iter().map(|series| paint::line(ui, &series.name, font::caption(), t.text)).collect();
    let width = ui.available_width();
    let mut places = Vec::new();
    let (mut x, mut row) = (0.0, 0);
    for name in &names {
        let wide = SAMPLE + 6.0 + name.size().x;
        if x > 0.0 && x + wide > width {
            (x, row) = (0.0, row + 1);
        }
        places.push((x, row));
        x += wide + GAP;
    }
    let (_, rect) = ui.allocate_space(vec2(width, LEGEND_ROW * (row + 1) as f32));
    for (number, (name, (x, row))) in names.into_iter().zip(places).enumerate() {
        let corner = pos2(rect.left() + x, rect.top() + LEGEND_ROW * row as f32);
        let place = Rect::from_min_size(corner, vec2(SAMPLE, LEGEND_ROW));
        let color = color(number, t);
        let painter = ui.painter();
        match plot.series[number].mark {
            Mark::Bars => _ = painter.rect_filled(place.shrink2(vec2(2.0, 4.0)), 2.0, color),
            Mark::Points => _ = painter.circle_filled(place.center(), 3.5, color),
            Mark::Line => _ = painter.hline(place.x_range(), place.center().y, (2.0, color)),
        }
        let after = Rect::from_min_max(pos2(place.right() + 6.0, place.top()), rect.right_bottom());
        paint::at_left(ui, after.with_max_y(place.bottom()), name);
    }
}
