//! The sizes of legend, scale bar and arrow to the north.

use super::content::SheetContent;
use super::glyphs;
use super::legend::{Legend, LegendBody, LegendRow, LegendScale};
use super::scale_bar::ScaleBar;

/// Space between the map and what stands beside or below it, in heights of the text.
pub(super) const GAP: f64 = 1.6;
/// Sizes in heights of the text: of a row and a swatch of a legend, of the spaces before its first column and
/// the others, and of its title with the space below it.
pub(super) const ROW: f64 = 1.45;
pub(super) const SWATCH: f64 = 1.25;
const COLUMN_GAPS: [f64; 2] = [0.6, 1.0];
pub(super) const TITLE_ROW: f64 = 1.6;
/// Sizes of colours side by side: their height, their least width, and the least space between the texts
/// below.
pub(super) const SCALE: f64 = 1.25;
const SCALE_WIDTH: f64 = 11.0;
const ENDS_GAP: f64 = 0.8;
/// Between columns of a legend below the map.
const LEGEND_GAP: f64 = 2.0;
/// Sizes of the box of the arrow, and of its length.
pub(super) const NORTH: f64 = 3.4;
pub(super) const NORTH_LENGTH: f64 = 2.0;
/// Height of the bar with its text.
pub(super) const BAR: f64 = 1.75;
/// Between legend, arrow and bar.
pub(super) const BETWEEN: f64 = 1.0;

impl Legend {
    /// Returns its rows; none without any.
    pub(super) fn list(&self) -> &[LegendRow] {
        match &self.body {
            LegendBody::Rows(rows) => rows,
            LegendBody::Scale(_) | LegendBody::Missing(_) => &[],
        }
    }

    /// Returns the widths of the columns of texts, in pixels.
    pub(super) fn columns(&self, text_px: f64) -> Vec<f64> {
        let count = self.list().iter().map(|row| row.texts.len()).max().unwrap_or(0);
        let width = |column: usize| {
            let texts = self.list().iter().filter_map(|row| row.texts.get(column));
            texts.map(|text| glyphs::width(text, text_px)).fold(0.0, f64::max)
        };
        (0..count).map(width).collect()
    }

    /// Returns the width of rows.
    pub(super) fn row_width(&self, text_px: f64) -> f64 {
        let columns = self.columns(text_px);
        let gaps = (0..columns.len()).map(column_gap).sum::<f64>();
        (SWATCH + gaps) * text_px + columns.iter().sum::<f64>()
    }

    /// Returns from where to where the rows repeat, when they stand in several columns.
    pub(super) fn column_step(&self, text_px: f64) -> f64 {
        self.row_width(text_px) + LEGEND_GAP * text_px
    }

    /// Returns the width of everything in the legend with its rows below each other.
    fn width(&self, text_px: f64) -> f64 {
        let width = |text: &str| glyphs::width(text, text_px);
        let body = match &self.body {
            LegendBody::Rows(_) => self.row_width(text_px),
            LegendBody::Scale(scale) => scale.bar_width(text_px).max(width(&scale.note)),
            LegendBody::Missing(reason) => width(reason),
        };
        body.max(width(&self.title))
    }

    /// Returns the height with so many rows below each other, in heights of the text.
    fn height(&self, rows: usize) -> f64 {
        TITLE_ROW
            + match &self.body {
                LegendBody::Rows(_) => ROW * rows as f64,
                LegendBody::Scale(scale) if scale.note.is_empty() => SCALE + ROW,
                LegendBody::Scale(_) => SCALE + 2.0 * ROW,
                LegendBody::Missing(_) => ROW,
            }
    }
}

impl LegendScale {
    /// Returns the width of the colours: enough for the texts below them.
    pub(super) fn bar_width(&self, text_px: f64) -> f64 {
        let [left, middle, right] = self.ends.each_ref().map(|text| glyphs::width(text, text_px));
        let half = 0.5 * middle + left.max(right) + ENDS_GAP * text_px;
        (2.0 * half).max(SCALE_WIDTH * text_px)
    }
}

/// Returns the space before a column of texts, in heights of the text.
pub(super) fn column_gap(column: usize) -> f64 {
    if column == 0 { COLUMN_GAPS[0] } else { COLUMN_GAPS[1] }
}

impl ScaleBar {
    /// Returns the width of the bar or of its text, in pixels.
    pub(super) fn width(&self, text_px: f64) -> f64 {
        self.length_px.max(glyphs::width(&self.text, text_px))
    }
}

impl SheetContent {
    /// Returns the width of legend, arrow and bar below each other.
    pub(super) fn stack_width(&self, bar: Option<&ScaleBar>, text_px: f64) -> f64 {
        let legend = self.legend.as_ref().map_or(0.0, |legend| legend.width(text_px));
        let north = self.north.map_or(0.0, |_| NORTH * text_px);
        legend.max(north).max(bar.map_or(0.0, |bar| bar.width(text_px)))
    }

    /// Returns the height of legend, arrow and bar below each other.
    pub(super) fn stack_height(&self, text_px: f64) -> f64 {
        let legend = self.legend.as_ref().map(|legend| legend.height(legend.list().len()));
        let parts = [legend, self.north.map(|_| NORTH), self.bar.map(|_| BAR)];
        let count = parts.iter().flatten().count();
        let between = BETWEEN * count.saturating_sub(1) as f64;
        text_px * (parts.iter().flatten().sum::<f64>() + between)
    }

    /// Returns the width of arrow and bar beside each other, with the space before them.
    pub(super) fn aside_width(&self, bar: Option<&ScaleBar>, text_px: f64) -> f64 {
        let north = self.north.map_or(0.0, |_| (NORTH + BETWEEN) * text_px);
        north + bar.map_or(0.0, |bar| bar.width(text_px) + BETWEEN * text_px)
    }

    /// Returns how many rows of the legend are below each other in a width; `None` where it has no room.
    pub(super) fn rows_in(&self, room: f64, text_px: f64) -> Option<usize> {
        let Some(legend) = &self.legend else { return (room >= 0.0).then_some(0) };
        let rows = legend.list().len();
        if rows == 0 {
            return (legend.width(text_px) <= room).then_some(0);
        }
        let gap = LEGEND_GAP * text_px;
        let columns = ((room + gap) / legend.column_step(text_px)).floor();
        let fits = columns >= 1.0 && legend.width(text_px) <= room;
        fits.then(|| rows.div_ceil((columns as usize).min(rows)))
    }

    /// Returns the height of what stands below the map.
    pub(super) fn block_height(&self, legend_rows: usize, text_px: f64) -> f64 {
        let legend = self.legend.as_ref().map_or(0.0, |legend| legend.height(legend_rows));
        let north = self.north.map_or(0.0, |_| NORTH);
        text_px * legend.max(north).max(self.bar.map_or(0.0, |_| BAR))
    }
}
