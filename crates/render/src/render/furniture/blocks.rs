//! The sizes of legend, scale bar and arrow to the north.

use super::content::{Legend, SheetContent};
use super::glyphs;
use super::scale_bar::ScaleBar;

/// Space between the map and what stands beside or below it, in heights of the text.
pub(super) const GAP: f64 = 1.6;
/// Sizes in heights of the text: of a row and a swatch of a legend, of the spaces between its columns, and of
/// its title with the space below it.
pub(super) const ROW: f64 = 1.45;
pub(super) const SWATCH: f64 = 1.25;
pub(super) const COLUMN_GAPS: [f64; 3] = [0.6, 1.0, 1.0];
pub(super) const TITLE_ROW: f64 = 1.6;
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
    /// Returns the widths of the three columns of texts, in pixels.
    pub(super) fn columns(&self, text_px: f64) -> [f64; 3] {
        [0, 1, 2].map(|column| {
            let widths = self.levels.rows.iter().map(|row| glyphs::width(&row.texts[column], text_px));
            widths.fold(0.0, f64::max)
        })
    }

    /// Returns the width of rows.
    pub(super) fn row_width(&self, text_px: f64) -> f64 {
        (SWATCH + COLUMN_GAPS.iter().sum::<f64>()) * text_px + self.columns(text_px).iter().sum::<f64>()
    }

    /// Returns from where to where the rows repeat, when they stand in several columns.
    pub(super) fn column_step(&self, text_px: f64) -> f64 {
        self.row_width(text_px) + LEGEND_GAP * text_px
    }

    fn width(&self, text_px: f64) -> f64 {
        self.row_width(text_px).max(glyphs::width(&self.levels.title, text_px))
    }
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
        let legend = self.legend.as_ref().map(|legend| TITLE_ROW + ROW * legend.levels.rows.len() as f64);
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
        let rows = legend.levels.rows.len();
        let gap = LEGEND_GAP * text_px;
        let columns = ((room + gap) / legend.column_step(text_px)).floor();
        let fits = columns >= 1.0 && legend.width(text_px) <= room;
        fits.then(|| rows.div_ceil((columns as usize).min(rows.max(1))))
    }

    /// Returns the height of what stands below the map.
    pub(super) fn block_height(&self, legend_rows: usize, text_px: f64) -> f64 {
        let legend = self.legend.as_ref().map_or(0.0, |_| TITLE_ROW + ROW * legend_rows as f64);
        let north = self.north.map_or(0.0, |_| NORTH);
        text_px * legend.max(north).max(self.bar.map_or(0.0, |_| BAR))
    }
}
