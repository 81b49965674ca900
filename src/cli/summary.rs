//! The figures of the finished mesh, as text and as JSON.

use serde::Serialize;

use super::build::FinishedMesh;
use crate::domain::Region;
use crate::field::RefinementRule;
use crate::mesh::Topology;
use crate::text::Grouped;

/// The figures of a mesh; its JSON is the answer of `--json`.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// The deepest level.
    pub max_level: usize,
    /// Triangles at each level, from 0.
    pub levels: Vec<usize>,
    /// The mesh's fingerprint, 32 hexadecimal digits: equal for equal meshes, in any order of triangles.
    pub hash: String,
    /// Seconds of refinement, without reading and writing.
    pub seconds: f64,
    /// The area of the mesh, in square world units.
    pub area: f64,
    /// How the mesh renders the outline of a region.
    #[serde(flatten)]
    pub outline: Option<Outline>,
    /// Side δ of a coarse cell, in world units.
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

/// A region compared with its mesh.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outline {
    /// The area that the polygons cover, in square world units.
    pub region_area: f64,
    /// Holes of the polygons.
    pub region_holes: usize,
    /// Holes of the mesh.
    pub holes: usize,
    /// Edge-connected parts of the mesh.
    pub parts: usize,
}

impl Outline {
    fn of(region: &Region, topology: Topology) -> Self {
        let Topology { parts, holes, .. } = topology;
        Self { region_area: region.area(), region_holes: region.hole_count(), holes, parts }
    }

    fn for_people(&self, area: f64) -> String {
        let gained = area - self.region_area;
        let word = if gained < 0.0 { "less" } else { "more" };
        let percent = 100.0 * gained.abs() / self.region_area;
        let Self { region_area, region_holes, holes, parts } = self;
        let parts = if *parts == 1 { "1 part".into() } else { format!("{} parts", Grouped(*parts)) };
        format!(
            "area {}, {percent:.3} % {word} than the polygons' {}; {} of {} holes, {parts}\n",
            short(area),
            short(*region_area),
            Grouped(*holes),
            Grouped(*region_holes),
        )
    }
}

impl Summary {
    /// The figures of a mesh.
    pub fn of(finished: &FinishedMesh, violations: Option<usize>) -> Self {
        let mesh = finished.mesh();
        let levels = mesh.level_counts();
        let topology = finished.region.as_ref().map(|_| mesh.topology());
        Self {
            triangles: mesh.triangle_count(),
            nodes: topology.map_or(mesh.raw_nodes().len(), |topology| topology.nodes),
            area: mesh.area(),
            outline: finished
                .region
                .as_ref()
                .zip(topology)
                .map(|(region, topology)| Outline::of(region, topology)),
            max_level: levels.len() - 1,
            hash: mesh.fingerprint().to_string(),
            seconds: finished.refinement.as_secs_f64(),
            spacing: mesh.lattice().spacing(),
            rule: if finished.rule() == RefinementRule::Vertex { "vertex" } else { "area" },
            resolution: finished.resolution(),
            capped: finished.capped,
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
            Grouped(self.triangles),
            Grouped(self.nodes),
            self.max_level,
            duration(self.seconds),
            self.spacing,
        );
        if let Some(outline) = &self.outline {
            text.insert_str(text.len() - 1, &outline.for_people(self.area));
        }
        text += &format!("{:>5}  {:>12}  {:>13}\n", "level", "diameter", "triangles");
        for (level, (&count, diameter)) in self.levels.iter().zip(&self.diameters).enumerate() {
            text += &format!("{level:>5}  {:>12}  {:>13}\n", short(*diameter), Grouped(count));
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
