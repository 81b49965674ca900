//! The levels of a mesh in words: on the canvas, and beside exported pictures.

use meshbrush_mesh::text::{Grouped, LengthUnit, digits};

/// The levels that a mesh has, for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelLegend {
    /// What the columns are.
    pub title: String,
    /// A row for each level with triangles, from the coarsest.
    pub rows: Vec<LevelRow>,
}

/// A level in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelRow {
    /// The level.
    pub level: u32,
    /// The level, the diameter of its triangles in the unit of the document, and how many there are.
    pub texts: [String; 3],
}

impl LevelLegend {
    /// Returns the levels with triangles. `counts` has the number of triangles of each level, and `diameter`
    /// is that of a level, in world units.
    pub fn new(counts: &[usize], diameter: impl Fn(u32) -> f64, unit: LengthUnit) -> Self {
        let title = match unit.symbol() {
            "" => "Level, diameter, count".to_owned(),
            unit => format!("Level, diameter in {unit}, count"),
        };
        let present = (0..).zip(counts).filter(|(_, count)| **count > 0);
        let row = |(level, &count): (u32, &usize)| LevelRow {
            level,
            texts: [level.to_string(), digits(diameter(level), 3), short_count(count)],
        };
        Self { title, rows: present.map(row).collect() }
    }
}

/// Returns a count in at most seven letters.
fn short_count(count: usize) -> String {
    match count {
        0..1_000_000 => Grouped(count).to_string(),
        _ => format!("{:.1} M", count as f64 / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_without_triangles_have_no_row() {
        let legend =
            LevelLegend::new(&[0, 12, 0, 1_234_567], |level| 8.0 / f64::from(level), LengthUnit::None);
        assert_eq!(legend.title, "Level, diameter, count");
        let texts: Vec<_> = legend.rows.iter().map(|row| row.texts.join(" | ")).collect();
        assert_eq!(texts, ["1 | 8 | 12", "3 | 2.67 | 1.2 M"]);
        assert_eq!(LevelLegend::new(&[1], |_| 1.0, LengthUnit::Metre).title, "Level, diameter in m, count");
    }
}
