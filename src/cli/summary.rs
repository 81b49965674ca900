//! What the finished mesh is, in numbers: for a person, and for a program.

use serde::Serialize;

use super::build::Built;
use super::terminal::grouped;
use crate::field::Rule;

/// The figures of a mesh; its JSON is the answer of `--json`.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// How many.
    pub triangles: usize,
    /// How many.
    pub nodes: usize,
    /// The deepest level.
    pub max_level: usize,
    /// Triangles at each level, from 0.
    pub levels: Vec<usize>,
    /// The mesh's fingerprint, 32 hexadecimal digits: equal for equal meshes, whatever their order.
    pub hash: String,
    /// Seconds of refinement, without reading and writing.
    pub seconds: f64,
    /// Side δ of a coarse cell as it came out, in world units.
    pub spacing: f64,
    /// "vertex" or "area".
    pub rule: &'static str,
    /// Columns and rows that the area rule saw.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resolution: Option<[u32; 2]>,
    /// Triangles left coarser than their target by `--max-level`.
    pub capped: usize,
    /// Broken invariants, if they were checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violations: Option<usize>,
    #[serde(skip)]
    diameters: Vec<f64>,
}

impl Summary {
    /// The figures of a mesh made by `rule`.
    pub fn of(built: &Built, rule: Rule, violations: Option<usize>) -> Self {
        let mesh = &built.mesh;
        let levels = mesh.level_counts();
        Self {
            triangles: mesh.triangles().len(),
            nodes: mesh.nodes().len(),
            max_level: levels.len() - 1,
            hash: mesh.fingerprint().to_string(),
            seconds: built.refinement.as_secs_f64(),
            spacing: mesh.lattice().spacing(),
            rule: if rule == Rule::Vertex { "vertex" } else { "area" },
            resolution: built.target.resolution(),
            capped: built.capped,
            violations,
            diameters: (0..levels.len()).map(|level| mesh.diameter(level as u32)).collect(),
            levels,
        }
    }

    /// A few lines and a table of levels.
    pub fn for_people(&self) -> String {
        let seen = match self.resolution {
            Some([columns, rows]) => format!("area rule on {columns} × {rows} pixels"),
            None => "vertex rule".to_owned(),
        };
        let mut text = format!(
            "{} triangles, {} nodes, levels 0 to {}, refined in {}\ncoarse spacing {}, {seen}\n\n",
            grouped(self.triangles),
            grouped(self.nodes),
            self.max_level,
            duration(self.seconds),
            self.spacing,
        );
        text += &format!("{:>5}  {:>12}  {:>13}\n", "level", "diameter", "triangles");
        for (level, (&count, diameter)) in self.levels.iter().zip(&self.diameters).enumerate() {
            text += &format!("{level:>5}  {:>12}  {:>13}\n", short(*diameter), grouped(count));
        }
        text
    }
}

/// Milliseconds or seconds.
fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

/// Six significant digits, without zeros at the end.
fn short(length: f64) -> String {
    if !(1e-4..1e6).contains(&length) {
        return format!("{length:.5e}");
    }
    let decimals = (5.0 - length.log10().floor()).max(0.0) as usize;
    let text = format!("{length:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_shown_short() {
        for (length, shown) in [
            (1.0, "1"),
            (std::f64::consts::SQRT_2, "1.41421"),
            (0.015625, "0.015625"),
            (100.0, "100"),
            (353_553.39, "353553"),
            (1.0 / 65536.0, "1.52588e-5"),
        ] {
            assert_eq!(short(length), shown);
        }
    }
}
