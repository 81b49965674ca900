//! A legend as data: what its colours mean, in words.

use super::level_legend::LevelLegend;
use crate::colormap::LevelColors;

/// What the colours of a picture mean. Colours are red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// What the colours are about.
    pub title: String,
    /// The colours with their meaning.
    pub body: LegendBody,
}

/// The colours of a legend with their meaning.
#[derive(Clone, Debug, PartialEq)]
pub enum LegendBody {
    /// A row for each colour.
    Rows(Vec<LegendRow>),
    /// Colours side by side.
    Scale(LegendScale),
    /// There is nothing to show, for this reason.
    Missing(String),
}

/// A colour with its meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendRow {
    /// The colour.
    pub color: [u8; 3],
    /// A name, or numbers that stand in columns: as many as in each other row of the legend.
    pub texts: Vec<String>,
}

/// Colours side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendScale {
    /// The colours, from the left.
    pub colors: Vec<[u8; 3]>,
    /// The texts below the left end, the middle and the right end.
    pub ends: [String; 3],
    /// A text below them; empty without one.
    pub note: String,
}

impl Legend {
    /// Returns a legend with colours side by side, from opaque colours.
    pub fn scale(
        title: &str,
        colors: impl IntoIterator<Item = [u8; 4]>,
        ends: [String; 3],
        note: impl Into<String>,
    ) -> Self {
        let colors = colors.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
        let body = LegendBody::Scale(LegendScale { colors, ends, note: note.into() });
        Self { title: title.into(), body }
    }

    /// Returns a legend with a row for each opaque colour.
    pub fn rows(title: &str, rows: impl IntoIterator<Item = ([u8; 4], Vec<String>)>) -> Self {
        let row = |([r, g, b, _], texts): ([u8; 4], Vec<String>)| LegendRow { color: [r, g, b], texts };
        Self { title: title.into(), body: LegendBody::Rows(rows.into_iter().map(row).collect()) }
    }

    /// Returns a legend that says why there is nothing to show.
    pub fn missing(title: &str, reason: &str) -> Self {
        Self { title: title.into(), body: LegendBody::Missing(reason.into()) }
    }

    /// Returns the legend of the levels of a mesh in their colours.
    pub(in crate::render) fn of_levels(levels: LevelLegend, colors: &LevelColors) -> Self {
        let LevelLegend { title, rows } = levels;
        Self::rows(&title, rows.into_iter().map(|row| (colors.of(row.level.min(63) as u8), row.texts.into())))
    }
}
