//! A plot as an SVG: axes with ticks and titles, a legend and a note, in black on white. Series differ by
//! pattern and shape and not by colour.

use std::io::{self, Write};

use super::{Axis, AxisRange, Mark, Plot, Series, Tick};
use crate::text::xml_text;

/// Size of the drawing, in pixels.
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 480.0;
/// Room to the right of the plot.
const RIGHT: f64 = 24.0;
/// Height of a line of text, and the mean width of a letter.
const LINE: f64 = 20.0;
const LETTER: f64 = 7.5;
/// Most ticks of the axes.
const TICKS: [usize; 2] = [9, 7];
/// Length of a tick and of a sample in the legend.
const TICK: f64 = 5.0;
const SAMPLE: f64 = 26.0;
/// Patterns of lines and fills of bars, one after the other.
const DASHES: [&str; 4] = ["none", "8 4", "2 3", "8 3 2 3"];
const FILLS: [&str; 4] = ["#555", "#fff", "url(#rising)", "url(#falling)"];
/// The hatching of the last two fills.
const PATTERNS: &str = "<defs>\
<pattern id=\"rising\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">\
<rect width=\"6\" height=\"6\" fill=\"#fff\"/><path d=\"M-1 1L1 -1M0 6L6 0M5 7L7 5\" stroke=\"#000\"/></pattern>\
<pattern id=\"falling\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">\
<rect width=\"6\" height=\"6\" fill=\"#fff\"/><path d=\"M-1 5L1 7M0 0L6 6M5 -1L7 1\" stroke=\"#000\"/></pattern>\
</defs>";

/// Writes the drawing.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, plot: &Plot) -> io::Result<()> {
    let page = PlotPage::of(plot);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"14\" stroke-linejoin=\"round\">"
    )?;
    let title = xml_text(&plot.title);
    writeln!(out, "<title>{title}</title>\n{PATTERNS}")?;
    writeln!(out, "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>")?;
    let middle = 0.5 * (page.left + page.right);
    writeln!(out, "<text x=\"{middle:.1}\" y=\"24\" text-anchor=\"middle\" font-size=\"17\">{title}</text>")?;
    write_legend(out, plot, &page)?;
    write_axes(out, plot, &page)?;
    for number in 0..plot.series.len() {
        write_series(out, plot, &page, number)?;
    }
    if !plot.note.is_empty() {
        let (y, note) = (HEIGHT - 10.0, xml_text(&plot.note));
        writeln!(out, "<text x=\"{middle:.1}\" y=\"{y}\" text-anchor=\"middle\">{note}</text>")?;
    }
    writeln!(out, "</svg>")
}

/// The layout of the page.
struct PlotPage {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    ranges: [AxisRange; 2],
    ticks: [Vec<Tick>; 2],
}

impl PlotPage {
    fn of(plot: &Plot) -> Self {
        let ranges = plot.ranges();
        let ticks = [0, 1].map(|axis| ranges[axis].ticks(TICKS[axis]));
        let longest = ticks[1].iter().map(|tick| tick.label.chars().count()).max().unwrap_or(0);
        let left = 2.0 * LINE + TICK + LETTER * longest as f64;
        let below = 2.5 * LINE + TICK + if plot.note.is_empty() { 0.0 } else { LINE };
        let top = 40.0 + if plot.series.len() > 1 { 1.5 * LINE } else { 0.0 };
        Self { left, right: WIDTH - RIGHT, top, bottom: HEIGHT - below, ranges, ticks }
    }

    /// Returns the screen coordinate of a position on the x axis.
    fn x(&self, position: f64) -> f64 {
        self.left + (self.right - self.left) * self.ranges[0].share(position)
    }

    fn y(&self, position: f64) -> f64 {
        self.bottom - (self.bottom - self.top) * self.ranges[1].share(position)
    }

    /// Returns the position of a point; `None` where an axis cannot show it.
    fn place(&self, plot: &Plot, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x(plot.x.position(x)?), self.y(plot.y.position(y)?)])
    }
}

fn write_axes(out: &mut impl Write, plot: &Plot, page: &PlotPage) -> io::Result<()> {
    let PlotPage { left, right, top, bottom, .. } = *page;
    let [across, up] = &page.ticks;
    writeln!(out, "<g id=\"grid\" stroke=\"#ddd\">")?;
    for y in up.iter().map(|tick| page.y(tick.position)) {
        writeln!(out, "<path d=\"M{left:.1} {y:.1}H{right:.1}\"/>")?;
    }
    writeln!(out, "</g>\n<g id=\"axes\" stroke=\"#000\" fill=\"none\">")?;
    writeln!(out, "<path d=\"M{left:.1} {top:.1}V{bottom:.1}H{right:.1}\"/>")?;
    for x in across.iter().map(|tick| page.x(tick.position)) {
        writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v{TICK}\"/>")?;
    }
    for y in up.iter().map(|tick| page.y(tick.position)) {
        writeln!(out, "<path d=\"M{left:.1} {y:.1}h-{TICK}\"/>")?;
    }
    writeln!(out, "</g>\n<g id=\"ticks\">")?;
    for tick in across {
        let (x, y, label) = (page.x(tick.position), bottom + TICK + 16.0, xml_text(&tick.label));
        writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{label}</text>")?;
    }
    for tick in up {
        let (x, y, label) = (left - TICK - 4.0, page.y(tick.position) + 5.0, xml_text(&tick.label));
        writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{label}</text>")?;
    }
    writeln!(out, "</g>")?;
    let title = |axis: &Axis| xml_text(&axis.title());
    let (middle, y) = (0.5 * (left + right), bottom + TICK + 16.0 + LINE);
    writeln!(out, "<text x=\"{middle:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>", title(&plot.x))?;
    let middle = 0.5 * (top + bottom);
    writeln!(
        out,
        "<text transform=\"translate(20 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        title(&plot.y)
    )
}

/// The name of each series after a sample of it, in one row above the plot.
fn write_legend(out: &mut impl Write, plot: &Plot, page: &PlotPage) -> io::Result<()> {
    if plot.series.len() < 2 {
        return Ok(());
    }
    let widths = plot.series.iter().map(|series| SAMPLE + 24.0 + LETTER * series.name.chars().count() as f64);
    let mut x = 0.5 * (page.left + page.right - widths.clone().sum::<f64>());
    let y = 24.0 + 1.5 * LINE;
    writeln!(out, "<g id=\"legend\">")?;
    for ((number, series), width) in plot.series.iter().enumerate().zip(widths) {
        let style = style(plot, number);
        let middle = y - 5.0;
        match series.mark {
            Mark::Bars => {
                writeln!(
                    out,
                    "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"{SAMPLE}\" height=\"12\" {style}/>",
                    y - 11.0
                )?;
            }
            Mark::Line => writeln!(out, "<path d=\"M{x:.1} {middle:.1}h{SAMPLE}\" {style}/>")?,
            Mark::Points => {
                let dot = dot(number_among(plot, number), [x + 0.5 * SAMPLE, middle]);
                writeln!(out, "<path d=\"{dot}\" {style}/>")?;
            }
        }
        writeln!(out, "<text x=\"{:.1}\" y=\"{y:.1}\">{}</text>", x + SAMPLE + 6.0, xml_text(&series.name))?;
        x += width;
    }
    writeln!(out, "</g>")
}

fn write_series(out: &mut impl Write, plot: &Plot, page: &PlotPage, number: usize) -> io::Result<()> {
    let (series, style) = (&plot.series[number], style(plot, number));
    writeln!(out, "<g class=\"series\" {style}>\n<title>{}</title>", xml_text(&series.name))?;
    let points = series.points.iter().copied().filter(|point| plot.shows(*point));
    match series.mark {
        Mark::Bars => {
            let [from, width] = plot.bar_span(number);
            for [x, y] in points {
                let ends = [x + from, x + from + width].map(|x| plot.x.position(x).map(|at| page.x(at)));
                let ([Some(left), Some(right)], Some([_, y])) = (ends, page.place(plot, [x, y])) else {
                    continue;
                };
                let zero = page.y(plot.y.position(0.0).unwrap_or(page.ranges[1].low()));
                let (upper, height) = (y.min(zero), (y - zero).abs());
                let width = right - left;
                writeln!(
                    out,
                    "<rect x=\"{left:.1}\" y=\"{upper:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"
                )?;
            }
        }
        Mark::Points => {
            for place in points.filter_map(|point| page.place(plot, point)) {
                writeln!(out, "<path d=\"{}\"/>", dot(number_among(plot, number), place))?;
            }
            write_error_bars(out, plot, page, series)?;
        }
        Mark::Line => {
            let places = points.filter_map(|point| page.place(plot, point));
            let places: Vec<String> = places.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            writeln!(out, "<polyline points=\"{}\"/>", places.join(" "))?;
        }
    }
    writeln!(out, "</g>")
}

/// A line from the minimum to the maximum of each point, with a short stroke at both ends.
fn write_error_bars(out: &mut impl Write, plot: &Plot, page: &PlotPage, series: &Series) -> io::Result<()> {
    for ends in series.error_bars() {
        let [Some([x, low]), Some([_, high])] = ends.map(|end| page.place(plot, end)) else { continue };
        let (left, width) = (x - TICK, 2.0 * TICK);
        writeln!(
            out,
            "<path class=\"error\" d=\"M{left:.1} {low:.1}h{width}M{x:.1} {low:.1}V{high:.1}M{left:.1} {high:.1}h{width}\"/>"
        )?;
    }
    Ok(())
}

/// Returns the number of a series among those with its mark.
fn number_among(plot: &Plot, number: usize) -> usize {
    plot.series[..number].iter().filter(|series| series.mark == plot.series[number].mark).count()
}

fn style(plot: &Plot, number: usize) -> String {
    let among = number_among(plot, number);
    match plot.series[number].mark {
        Mark::Bars => format!("fill=\"{}\" stroke=\"#000\"", FILLS[among % FILLS.len()]),
        Mark::Line => {
            let dashes = DASHES[among % DASHES.len()];
            format!("fill=\"none\" stroke=\"#000\" stroke-width=\"1.5\" stroke-dasharray=\"{dashes}\"")
        }
        Mark::Points => {
            let fill = if among.is_multiple_of(2) { "#000" } else { "#fff" };
            format!("fill=\"{fill}\" stroke=\"#000\"")
        }
    }
}

/// Returns a circle, a square, a triangle, a diamond.
fn dot(number: usize, [x, y]: [f64; 2]) -> String {
    match number % 4 {
        0 => format!("M{:.1} {y:.1}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0Z", x - 4.0),
        1 => format!("M{:.1} {:.1}h8v8h-8Z", x - 4.0, y - 4.0),
        2 => format!("M{x:.1} {:.1}l5 9h-10Z", y - 5.0),
        _ => format!("M{x:.1} {:.1}l5 5l-5 5l-5 -5Z", y - 5.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Scale;

    fn drawn(y: Scale) -> String {
        let points =
            |factor: f64| (0..5).map(|x| [f64::from(x), factor * f64::from(x * x)]).collect::<Vec<_>>();
        let plot = Plot {
            title: "Cost & closure".into(),
            x: Axis::new("level", Scale::Whole),
            y: Axis::new("length", y).unit("km"),
            series: vec![
                Series::new("required", Mark::Bars, points(10.0)),
                Series::new("forced", Mark::Bars, points(3.0)),
                Series::new("bound <", Mark::Line, points(12.0)),
                Series::new("measured", Mark::Points, points(11.0)).spans(vec![[1.0, 100.0]; 5]),
            ],
            note: "A note".into(),
        };
        let mut out = Vec::new();
        write(&mut out, &plot).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// Returns the values of an attribute, in order.
    fn values(drawing: &str, name: &str) -> Vec<f64> {
        let beginning = format!(" {name}=\"");
        let parts = drawing.split(&beginning).skip(1);
        parts.filter_map(|part| part.split('"').next()?.parse().ok()).collect()
    }

    #[test]
    fn a_drawing_has_titles_units_ticks_legend_and_note() {
        let drawing = drawn(Scale::Linear);
        for text in
            ["Cost &amp; closure", ">level<", ">length (km)<", ">A note<", ">bound &lt;<", ">required<"]
        {
            assert!(drawing.contains(text), "{text}");
        }
        for tick in [">0<", ">4<", ">50<", ">100<"] {
            assert!(drawing.contains(tick), "{tick}");
        }
        assert_eq!(drawing.matches("<g").count(), drawing.matches("</g>").count());
        assert!(values(&drawing, "x").iter().all(|x| (0.0..=WIDTH).contains(x)));
        assert!(values(&drawing, "y").iter().all(|y| (0.0..=HEIGHT).contains(y)));
    }

    #[test]
    fn each_series_of_a_mark_looks_different() {
        let lines = [Mark::Bars, Mark::Line, Mark::Points];
        let series = lines.iter().flat_map(|mark| (0..2).map(|_| Series::new("", *mark, vec![[0.0, 1.0]])));
        let (x, y) = (Axis::new("x", Scale::Linear), Axis::new("y", Scale::Linear));
        let plot = Plot { title: String::new(), x, y, series: series.collect(), note: String::new() };
        for first in [0, 2, 4] {
            assert!(style(&plot, first) != style(&plot, first + 1), "{}", style(&plot, first));
        }
        // One series alone needs no legend.
        let one = Plot { series: plot.series[..1].to_vec(), ..plot.clone() };
        assert_eq!(PlotPage::of(&plot).top - PlotPage::of(&one).top, 1.5 * LINE);
    }

    #[test]
    fn bars_are_as_high_as_their_values() {
        let drawing = drawn(Scale::Linear);
        let required = drawing.split("<title>required</title>").nth(1).unwrap();
        let heights = values(required.split("</g>").next().unwrap(), "height");
        assert_eq!(heights.len(), 5);
        assert!(heights[0] == 0.0 && (heights[4] / heights[2] - 4.0).abs() < 0.01, "{heights:?}");
    }

    #[test]
    fn error_bars_go_from_the_least_to_the_greatest_value() {
        let drawing = drawn(Scale::Linear);
        let measured = drawing.split("<title>measured</title>").nth(1).unwrap();
        assert_eq!(measured.split("</g>").next().unwrap().matches("class=\"error\"").count(), 5);
        let tick = |label: &str| {
            let before = drawing.split(&format!("text-anchor=\"end\">{label}<")).next().unwrap();
            *values(before, "y").last().unwrap()
        };
        let bar = measured.split("class=\"error\" d=\"").nth(1).unwrap().split('M').nth(2).unwrap();
        let (low, high) = bar.split_once(' ').unwrap().1.split_once('V').unwrap();
        let [low, high]: [f64; 2] = [low, high].map(|y| y.parse().unwrap());
        // The strokes at its ends are as far to the left as to the right.
        let stroke = measured.split("class=\"error\" d=\"M").nth(1).unwrap();
        let number = |text: &str| {
            let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap();
            text[..end].parse::<f64>().unwrap()
        };
        let [left, width, x] = [stroke, stroke.split_once('h').unwrap().1, bar].map(number);
        assert!((left + 0.5 * width - x).abs() < 0.11, "{stroke}");
        let share = (low - high) / (tick("0") - tick("100"));
        assert!((share - 0.99).abs() < 0.01, "{low} {high}");
    }

    #[test]
    fn a_logarithmic_axis_leaves_out_what_it_cannot_show() {
        let drawing = drawn(Scale::Logarithmic);
        let required = drawing.split("<title>required</title>").nth(1).unwrap();
        assert_eq!(values(required.split("</g>").next().unwrap(), "height").len(), 4);
        assert!(!drawing.contains("NaN") && !drawing.contains("inf"));
    }
}
