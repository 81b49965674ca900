//! The marks of an arrangement: frame, ticks, texts, swatches, bar and arrow.

use glam::{DVec2, dvec2};

use super::axes::{MapAxes, MapTick};
use super::blocks::{BAR, BETWEEN, GAP, NORTH, NORTH_LENGTH, ROW, SCALE, SWATCH, TITLE_ROW, column_gap};
use super::content::{Inks, SheetContent};
use super::glyphs;
use super::layout::{SheetPlaces, Side};
use super::legend::{Legend, LegendBody, LegendScale};
use super::scale_bar::ScaleBar;
use super::sheet::{Sheet, SheetMark};
use super::space_axes::{SpaceFrame, SpaceLabel};
use crate::render::north_arrow::north_arrow;

/// Lengths of ticks with and without a label, in heights of the text.
const TICKS: [f64; 2] = [0.45, 0.25];
/// Space between a tick and its label.
const TICK_GAP: f64 = 0.35;
/// Width of lines, and of those of bar and arrow, in heights of the text.
const LINE: f64 = 0.07;
const BOLD: f64 = 0.12;

/// Makes marks.
pub(super) struct Drawing<'a> {
    places: &'a SheetPlaces,
    inks: Inks,
    marks: Vec<SheetMark>,
}

/// Which point of a text is at its place.
#[derive(Clone, Copy)]
enum Align {
    Left,
    Middle,
    Right,
}

impl<'a> Drawing<'a> {
    /// From the map to a label, in heights of the text.
    pub(super) const TO_LABEL: f64 = TICKS[0] + TICK_GAP;
    /// Height of the title of an axis, with the space before it.
    pub(super) const TITLE: f64 = 1.45;
    /// From the map up to the baseline of the title above it: over the uppermost label.
    const TO_TITLE: f64 = 0.95;

    /// Returns the drawing of what an arrangement has places for.
    pub(super) fn of(places: &'a SheetPlaces, content: &SheetContent) -> Self {
        let mut drawing = Self { places, inks: content.inks, marks: Vec::new() };
        if let Some(axes) = &content.axes {
            drawing.frame(axes);
        }
        if let Some(frame) = &places.around.space {
            drawing.space_frame(frame);
        }
        let bar = places.around.bar.as_ref();
        match places.side {
            Side::Right => drawing.stack(content, bar),
            Side::Below => drawing.row_below(content, bar),
        }
        drawing
    }

    pub(super) fn into_sheet(self) -> Sheet {
        let SheetPlaces { size, map_at, map_size, .. } = *self.places;
        Sheet { size, map_at, map_size, marks: self.marks }
    }

    fn em(&self) -> f64 {
        self.places.text_px
    }

    /// Returns a share of the height of the text as a width of whole pixels.
    fn width(&self, share: f64) -> f64 {
        (share * self.em()).round().max(1.0)
    }

    fn map(&self) -> [DVec2; 2] {
        let SheetPlaces { map_at, map_size, .. } = *self.places;
        let at = DVec2::from(map_at.map(f64::from));
        [at, at + DVec2::from(map_size.map(f64::from))]
    }

    fn line(&mut self, points: &[DVec2], width: f64, color: [u8; 3]) {
        self.marks.push(SheetMark::Line { points: points.to_vec(), width, color });
    }

    /// Writes a text on a baseline.
    fn text(&mut self, at: DVec2, align: Align, text: &str, color: [u8; 3]) {
        if text.is_empty() {
            return;
        }
        let size = self.em();
        let share = match align {
            Align::Left => 0.0,
            Align::Middle => 0.5,
            Align::Right => 1.0,
        };
        let at = at - dvec2(share * glyphs::width(text, size), 0.0);
        self.marks.push(SheetMark::Text { at, size, text: text.to_owned(), color });
    }

    /// Draws the frame of the map with its ticks. Lines lie on whole pixels, outside the map.
    fn frame(&mut self, axes: &MapAxes) {
        let (width, ink) = (self.width(LINE), self.inks.strong);
        let [low, high] = self.map();
        let half = DVec2::splat(0.5 * width);
        let [low, high] = [low - half, high + half];
        let corners = [low, dvec2(high.x, low.y), high, dvec2(low.x, high.y), low];
        self.line(&corners, width, ink);
        let [across, upwards] = self.places.around.ticks.clone();
        across.iter().for_each(|tick| self.tick_below(tick, high.y));
        upwards.iter().for_each(|tick| self.tick_left(tick, low.x));
        if let Some([x, y]) = axes.titles() {
            let em = self.em();
            let below = Self::TO_LABEL + glyphs::CAPITAL + Self::TITLE;
            let middle = dvec2(0.5 * (low.x + high.x), high.y + below * em);
            self.text(middle, Align::Middle, &x, self.inks.quiet);
            let above = dvec2(low.x - Self::TO_LABEL * em, low.y - Self::TO_TITLE * em);
            // Over the labels where it fits there, else along the map.
            let room = above.x - (f64::from(self.places.map_at[0]) - self.places.around.margins.left);
            let fits = glyphs::width(&y, em) <= room;
            let (at, align) = if fits { (above, Align::Right) } else { (dvec2(low.x, above.y), Align::Left) };
            self.text(at, align, &y, self.inks.quiet);
        }
    }

    /// Draws the axes of a view in space.
    fn space_frame(&mut self, frame: &SpaceFrame) {
        let (width, from) = (self.width(LINE), self.map()[0]);
        let outline: Vec<_> = frame.outline.iter().map(|&at| from + at).collect();
        self.line(&outline, width, self.inks.quiet);
        for line in &frame.lines {
            self.line(&line.map(|at| from + at), width, self.inks.strong);
        }
        for SpaceLabel { text, place: [left_top, right_bottom] } in &frame.labels {
            let at = from + dvec2(left_top.x, right_bottom.y);
            self.text(at, Align::Left, text, self.inks.quiet);
        }
    }

    fn tick_length(&self, tick: &MapTick) -> f64 {
        TICKS[usize::from(tick.label.is_empty())] * self.em()
    }

    fn tick_below(&mut self, tick: &MapTick, edge: f64) {
        let (width, ink, em) = (self.width(LINE), self.inks.strong, self.em());
        let x = on_pixels(self.map()[0].x + tick.at_px, width);
        self.line(&[dvec2(x, edge), dvec2(x, edge + self.tick_length(tick))], width, ink);
        if !tick.label.is_empty() {
            let baseline = edge + (Self::TO_LABEL + glyphs::CAPITAL) * em;
            self.text(dvec2(x, baseline), Align::Middle, &tick.label, self.inks.quiet);
        }
    }

    fn tick_left(&mut self, tick: &MapTick, edge: f64) {
        let (width, ink, em) = (self.width(LINE), self.inks.strong, self.em());
        let y = on_pixels(self.map()[0].y + tick.at_px, width);
        self.line(&[dvec2(edge, y), dvec2(edge - self.tick_length(tick), y)], width, ink);
        if !tick.label.is_empty() {
            let at = dvec2(edge - Self::TO_LABEL * em, y + 0.5 * glyphs::CAPITAL * em);
            self.text(at, Align::Right, &tick.label, self.inks.quiet);
        }
    }

    /// Draws legend, arrow and bar below each other beside the map: the legend at its top, the others at its
    /// bottom.
    fn stack(&mut self, content: &SheetContent, bar: Option<&ScaleBar>) {
        let em = self.em();
        let [low, high] = self.map();
        let x = high.x + self.places.around.margins.gap_to_block(em);
        if let Some(legend) = &content.legend {
            self.legend(legend, dvec2(x, low.y), legend.list().len());
        }
        let bottom = high.y.max(low.y + content.stack_height(em));
        if let Some(bar) = bar {
            self.bar(bar, dvec2(x, bottom - BAR * em));
        }
        if let Some(north) = content.north {
            let above_bar = content.bar.map_or(0.0, |_| BAR + BETWEEN);
            let from_bottom = above_bar + 0.5 * NORTH;
            self.arrow(dvec2(x + 0.5 * NORTH * em, bottom - from_bottom * em), north);
        }
    }

    /// Draws the legend below the map, and at its right bar and arrow.
    fn row_below(&mut self, content: &SheetContent, bar: Option<&ScaleBar>) {
        let em = self.em();
        let [low, high] = self.map();
        let top = high.y + self.places.around.margins.bottom + GAP * em;
        if let Some(legend) = &content.legend {
            self.legend(legend, dvec2(low.x, top), self.places.around.legend_rows);
        }
        let mut right = high.x;
        if let Some(bar) = bar {
            self.bar(bar, dvec2(right - bar.width(em), top));
            right -= bar.width(em) + BETWEEN * em;
        }
        if let Some(north) = content.north {
            self.arrow(dvec2(right - 0.5 * NORTH * em, top + 0.5 * NORTH * em), north);
        }
    }

    /// Draws a legend from its upper left corner, with so many rows below each other.
    fn legend(&mut self, legend: &Legend, at: DVec2, rows: usize) {
        let em = self.em();
        self.text(at + dvec2(0.0, glyphs::CAPITAL * em), Align::Left, &legend.title, self.inks.quiet);
        let first = at + dvec2(0.0, TITLE_ROW * em);
        match &legend.body {
            LegendBody::Rows(_) => self.legend_rows(legend, first, rows.max(1)),
            LegendBody::Scale(scale) => self.legend_scale(scale, first),
            LegendBody::Missing(reason) => {
                self.text(first + dvec2(0.0, self.baseline(ROW)), Align::Left, reason, self.inks.quiet);
            }
        }
    }

    /// Returns from the top of a row to the baseline of a text in its middle.
    fn baseline(&self, row: f64) -> f64 {
        0.5 * (row + glyphs::CAPITAL) * self.em()
    }

    fn legend_rows(&mut self, legend: &Legend, first: DVec2, rows: usize) {
        let (em, widths) = (self.em(), legend.columns(self.em()));
        for (index, row) in legend.list().iter().enumerate() {
            let (column, below) = ((index / rows) as f64, (index % rows) as f64);
            let corner = first + dvec2(column * legend.column_step(em), below * ROW * em);
            let end = corner + dvec2(SWATCH * em, ROW * em);
            // Swatches meet on whole pixels.
            self.marks.push(SheetMark::Fill { corners: [corner.round(), end.round()], color: row.color });
            let baseline = corner.y + self.baseline(ROW);
            if let [name] = &row.texts[..] {
                self.text(dvec2(end.x + column_gap(0) * em, baseline), Align::Left, name, self.inks.strong);
                continue;
            }
            let mut right = end.x;
            for (n, (text, width)) in row.texts.iter().zip(&widths).enumerate() {
                right += column_gap(n) * em + width;
                let ink = if n == 1 { self.inks.strong } else { self.inks.quiet };
                self.text(dvec2(right, baseline), Align::Right, text, ink);
            }
        }
        self.outlines_of_swatches(legend, first, rows);
    }

    /// Draws colours side by side, which meet on whole pixels, with the texts below them.
    fn legend_scale(&mut self, scale: &LegendScale, at: DVec2) {
        let (em, width) = (self.em(), scale.bar_width(self.em()));
        let (corner, end) = (at.round(), (at + dvec2(width, SCALE * em)).round());
        let side = |cell: usize| {
            let share = cell as f64 / scale.colors.len().max(1) as f64;
            (corner.x + share * (end.x - corner.x)).round()
        };
        for (cell, &color) in scale.colors.iter().enumerate() {
            let corners = [dvec2(side(cell), corner.y), dvec2(side(cell + 1), end.y)];
            self.marks.push(SheetMark::Fill { corners, color });
        }
        self.outline([corner, end]);
        let below = end.y + self.baseline(ROW);
        let places =
            [(corner.x, Align::Left), (0.5 * (corner.x + end.x), Align::Middle), (end.x, Align::Right)];
        for ((x, align), text) in places.into_iter().zip(&scale.ends) {
            self.text(dvec2(x, below), align, text, self.inks.strong);
        }
        self.text(dvec2(corner.x, below + ROW * em), Align::Left, &scale.note, self.inks.quiet);
    }

    /// Draws a line around a rectangle of whole pixels.
    fn outline(&mut self, [from, to]: [DVec2; 2]) {
        let width = self.width(LINE);
        let half = DVec2::splat(0.5 * width);
        let (from, to) = (from - half, to + half);
        let corners = [from, dvec2(to.x, from.y), to, dvec2(from.x, to.y), from];
        self.line(&corners, width, self.inks.quiet);
    }

    /// Draws a line around the swatches: the first level has almost the colour of the ground.
    fn outlines_of_swatches(&mut self, legend: &Legend, first: DVec2, rows: usize) {
        let (em, count) = (self.em(), legend.list().len());
        for column in 0..count.div_ceil(rows) {
            let in_column = rows.min(count - column * rows);
            let corner = first + dvec2(column as f64 * legend.column_step(em), 0.0);
            let end = (corner + dvec2(SWATCH, ROW * in_column as f64) * em).round();
            self.outline([corner.round(), end]);
        }
    }

    /// Draws a bar with its length above it, from the upper left corner.
    fn bar(&mut self, bar: &ScaleBar, at: DVec2) {
        let (em, width, ink) = (self.em(), self.width(BOLD), self.inks.strong);
        self.text(at + dvec2(0.0, glyphs::CAPITAL * em), Align::Left, &bar.text, ink);
        let y = on_pixels(at.y + BAR * em - width, width);
        let up = dvec2(0.0, -0.5 * em);
        let [from, to] = [dvec2(at.x, y), dvec2(at.x + bar.length_px, y)];
        self.line(&[from + up, from, to, to + up], width, ink);
    }

    fn arrow(&mut self, center: DVec2, north: DVec2) {
        let (width, ink) = (self.width(BOLD), self.inks.strong);
        for line in north_arrow(center, NORTH_LENGTH * self.em(), north) {
            self.line(&line, width, ink);
        }
    }
}

/// Returns the middle of a line of a width that covers whole pixels, near a place.
fn on_pixels(at: f64, width: f64) -> f64 {
    (at - 0.5 * width).round() + 0.5 * width
}
