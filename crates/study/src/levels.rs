//! Figures of a mesh by level: triangles, bisections with who asked for them, and h.

use crate::build::RefinementCriterion;
use crate::explain::asks_to_bisect;
use crate::mesh::{Extract, Limits, Mesh, TreeTriangle, TriangleId, bisection_edge_length};
use crate::plot::{Axis, Mark, Plot, Scale, Series};
use crate::text::{Grouped, LengthUnit};

/// Bisected triangles of one level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bisections {
    /// Number of triangles that exceed their own target.
    pub required: usize,
    /// The others: only the compatibility with other triangles asked for them.
    pub forced: usize,
}

/// The figures of a mesh for one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelFigures {
    /// The triangles of this level that are in the mesh, as files get it.
    pub triangles: usize,
    /// The triangles of this level that were bisected, also outside a fitted domain.
    pub bisections: Bisections,
    /// The smallest and the largest local triangulation diameter h(x) (Eq. 10) of the nodes whose coarsest
    /// triangle has this level, in world units; `None` without such a node.
    pub diameters: Option<[f64; 2]>,
    /// The longest edge of a triangle of this level: no such h(x) exceeds it, unless nodes were moved onto
    /// an outline.
    pub bound: f64,
}

impl Bisections {
    /// Returns the bisections that made a mesh, by the level of the bisected triangle. `criterion` and
    /// `limits` are those that the mesh is up to date with.
    ///
    /// Takes time in proportion to the mesh.
    pub fn by_level(mesh: &Mesh, criterion: &RefinementCriterion<'_>, limits: &Limits) -> Vec<Self> {
        let mut counts: Vec<Self> = Vec::new();
        for index in 0..mesh.raw_triangle_count() {
            let mut triangle = TreeTriangle::from_mesh(mesh, TriangleId::from_index(index));
            // Each bisected triangle is met once: from that triangle of the mesh which is reached from it
            // through first halves only.
            while let Some(parent) = triangle.parent(mesh.lattice()) {
                let [_, own_end, other_end] = parent.corners();
                if own_end > other_end {
                    break;
                }
                let level = parent.level() as usize;
                if counts.len() <= level {
                    counts.resize(level + 1, Self::default());
                }
                match asks_to_bisect(&parent, criterion, limits) {
                    true => counts[level].required += 1,
                    false => counts[level].forced += 1,
                }
                triangle = parent;
            }
        }
        counts
    }
}

impl LevelFigures {
    /// Returns the figures of each level, from 0 on. `extract` is the mesh as files get it; `criterion` and
    /// `limits` are those that `mesh` is up to date with.
    pub fn new(
        mesh: &Mesh,
        extract: &Extract<'_>,
        criterion: &RefinementCriterion<'_>,
        limits: &Limits,
    ) -> Vec<Self> {
        let triangles = extract.level_counts();
        let bisections = Bisections::by_level(mesh, criterion, limits);
        let diameters = diameters_by_level(extract);
        let count = triangles.len().max(bisections.len()).max(diameters.len());
        (0..count)
            .map(|level| Self {
                triangles: triangles.get(level).copied().unwrap_or(0),
                bisections: bisections.get(level).copied().unwrap_or_default(),
                diameters: diameters.get(level).copied().flatten(),
                bound: bisection_edge_length(mesh.lattice().spacing(), level as u32),
            })
            .collect()
    }
}

/// Returns the minimum and the maximum h(x), by the level of the coarsest triangle around x.
fn diameters_by_level(extract: &Extract<'_>) -> Vec<Option<[f64; 2]>> {
    let mut nodes = vec![(u32::MAX, 0.0_f64); extract.nodes().len()];
    for triangle in extract.triangles() {
        for (from, to) in triangle.edge_nodes() {
            let length = extract.world(from).distance(extract.world(to));
            for node in [from, to] {
                let (level, diameter) = &mut nodes[node.index()];
                (*level, *diameter) = ((*level).min(triangle.level()), diameter.max(length));
            }
        }
    }
    let mut levels: Vec<Option<[f64; 2]>> = Vec::new();
    for (level, diameter) in nodes.into_iter().filter(|(level, _)| *level != u32::MAX) {
        let level = level as usize;
        if levels.len() <= level {
            levels.resize(level + 1, None);
        }
        let [least, greatest] = levels[level].unwrap_or([diameter; 2]);
        levels[level] = Some([least.min(diameter), greatest.max(diameter)]);
    }
    levels
}

/// Returns the triangles of each level.
pub fn triangles_plot(levels: &[LevelFigures]) -> Plot {
    let all: usize = levels.iter().map(|level| level.triangles).sum();
    Plot {
        title: "Triangles per level".into(),
        x: Axis::new("level", Scale::Whole),
        y: Axis::new("triangles", Scale::Linear),
        series: vec![series("Triangles", Mark::Bars, levels, |level| Some(level.triangles as f64))],
        note: format!("{} triangles", Grouped(all)),
    }
}

/// Returns the bisections that the rule asked for beside those that compatibility asked for.
pub fn bisections_plot(levels: &[LevelFigures]) -> Plot {
    let sum = |of: fn(&Bisections) -> usize| levels.iter().map(|level| of(&level.bisections)).sum::<usize>();
    let (required, forced) = (sum(|of| of.required), sum(|of| of.forced));
    let share = 100.0 * forced as f64 / (required + forced).max(1) as f64;
    Plot {
        title: "Bisections per level".into(),
        x: Axis::new("level of the bisected triangle", Scale::Whole),
        y: Axis::new("bisections", Scale::Linear),
        series: vec![
            series("Required", Mark::Bars, levels, |level| Some(level.bisections.required as f64)),
            series("Forced", Mark::Bars, levels, |level| Some(level.bisections.forced as f64)),
        ],
        note: format!("{} required, {} forced ({share:.1} %)", Grouped(required), Grouped(forced)),
    }
}

/// Returns the smallest and the largest h of each level beside the bound.
pub fn diameters_plot(levels: &[LevelFigures], unit: LengthUnit) -> Plot {
    let h = |which: usize| move |level: &LevelFigures| level.diameters.map(|both| both[which]);
    Plot {
        title: "h per level".into(),
        x: Axis::new("coarsest level around the node", Scale::Whole),
        y: Axis::new("h", Scale::Logarithmic).unit(unit.symbol()),
        series: vec![
            series("Bound", Mark::Line, levels, |level| Some(level.bound)),
            series("Smallest h", Mark::Points, levels, h(0)),
            series("Largest h", Mark::Points, levels, h(1)),
        ],
        note: String::new(),
    }
}

fn series(
    name: &str,
    mark: Mark,
    levels: &[LevelFigures],
    value: impl Fn(&LevelFigures) -> Option<f64>,
) -> Series {
    let points = levels.iter().enumerate().filter_map(|(level, of)| Some([level as f64, value(of)?]));
    Series::new(name, mark, points.collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::{DVec2, dvec2};

    use super::*;
    use crate::build::BuiltMesh;
    use crate::explain::NodeFacts;
    use crate::field::RefinementRule;
    use crate::fixture;
    use crate::layers::PaintLayers;

    /// h̄ is fine at one place and coarse elsewhere; by the vertex rule, so that a test can say the same.
    fn built(limits: Limits) -> BuiltMesh {
        fixture::built("0.004 + 0.3*hypot(x - 0.3, y - 0.4)", RefinementRule::Vertex, limits)
    }

    fn figures(built: &BuiltMesh, limits: &Limits) -> Vec<LevelFigures> {
        let criterion = built.criterion(Some(PaintLayers::blank()));
        LevelFigures::new(&built.mesh, &built.mesh.extract(), &criterion, limits)
    }

    /// Bisected triangles by level, as [required, forced]: down from the coarse triangles by plain geometry.
    fn bisected(corners: [DVec2; 3], level: u32, centres: &[DVec2], counts: &mut BTreeMap<u32, [usize; 2]>) {
        let [apex, p, q] = corners;
        // Each triangle of the mesh has its centre strictly inside; a bisected one has at least two.
        let cross = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let all = cross(apex, p, q);
        let inside = |x: &&DVec2| {
            [cross(apex, p, **x), cross(p, q, **x), cross(q, apex, **x)].iter().all(|part| part / all > 0.0)
        };
        let centres: Vec<DVec2> = centres.iter().filter(inside).copied().collect();
        if centres.len() < 2 {
            return;
        }
        let target = |x: DVec2| 0.004 + 0.3 * x.distance(dvec2(0.3, 0.4));
        let exceeds = corners.iter().any(|x| p.distance(q) > target(*x));
        counts.entry(level).or_default()[usize::from(!exceeds)] += 1;
        let middle = 0.5 * (p + q);
        bisected([middle, apex, p], level + 1, &centres, counts);
        bisected([middle, apex, q], level + 1, &centres, counts);
    }

    #[test]
    fn bisections_are_required_or_forced_as_plain_geometry_says() {
        let limits = Limits::default();
        let built = built(limits);
        let mesh = &built.mesh;
        let centres: Vec<DVec2> =
            mesh.triangles().map(|(id, _)| mesh.world_corners(id).iter().sum::<DVec2>() / 3.0).collect();
        let mut counts = BTreeMap::new();
        let coarse = Mesh::coarse_grid(mesh.lattice(), |_| true, &limits).unwrap();
        for (_, triangle) in coarse.triangles() {
            let [p, q] = triangle.bisection_edge();
            let corners = [triangle.apex(), p, q].map(|node| coarse.world(node));
            bisected(corners, 0, &centres, &mut counts);
        }
        let counted: BTreeMap<u32, [usize; 2]> = (0..)
            .zip(Bisections::by_level(mesh, &built.criterion(None), &limits))
            .map(|(level, of)| (level, [of.required, of.forced]))
            .collect();
        assert_eq!(counted, counts);
        let forced: usize = counts.values().map(|of| of[1]).sum();
        assert!(forced > 20, "{counts:?}");
        // Each bisection makes one triangle more.
        let all: usize = counts.values().flatten().sum();
        assert_eq!(all, mesh.raw_triangle_count() - coarse.raw_triangle_count());
    }

    #[test]
    fn at_the_level_cap_no_bisection_is_asked_for() {
        let limits = Limits { max_level: Some(4), ..Limits::default() };
        let levels = figures(&built(limits), &limits);
        assert_eq!(levels.len(), 5);
        assert_eq!(levels[4].bisections, Bisections::default());
        assert!(levels[3].bisections.required > 0);
    }

    #[test]
    fn h_is_within_the_bound_and_that_of_the_nodes() {
        let limits = Limits::default();
        let built = built(limits);
        let mesh = &built.mesh;
        let levels = figures(&built, &limits);
        let mut counts = mesh.level_counts();
        counts.resize(levels.len(), 0);
        assert_eq!(levels.iter().map(|level| level.triangles).collect::<Vec<_>>(), counts);
        let mut expected: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for (node, _) in mesh.nodes() {
            let level = mesh.triangles_around(node).map(|id| mesh.triangle(id).level()).min().unwrap();
            let h = NodeFacts::new(mesh, node).diameter;
            let known = expected.entry(level).or_insert([h, h]);
            *known = [known[0].min(h), known[1].max(h)];
        }
        for (level, figures) in (0..).zip(&levels) {
            assert_eq!(figures.diameters, expected.get(&level).copied(), "level {level}");
            if let Some([least, greatest]) = figures.diameters {
                assert!(least > 0.7 * figures.bound && greatest < figures.bound * (1.0 + 1e-9));
            }
        }
    }

    #[test]
    fn the_plots_have_the_figures() {
        let limits = Limits::default();
        let levels = figures(&built(limits), &limits);
        let sum = |plot: &Plot, series: usize| plot.series[series].points.iter().map(|p| p[1]).sum::<f64>();
        let triangles: usize = levels.iter().map(|level| level.triangles).sum();
        assert_eq!(sum(&triangles_plot(&levels), 0), triangles as f64);
        let plot = bisections_plot(&levels);
        let [required, forced] = [sum(&plot, 0), sum(&plot, 1)];
        let counts = [required, forced].map(|count| Grouped(count as usize));
        let share = 100.0 * forced / (required + forced);
        assert_eq!(plot.note, format!("{} required, {} forced ({share:.1} %)", counts[0], counts[1]));
        assert!(forced > 0.0);
        let plot = diameters_plot(&levels, LengthUnit::Kilometre);
        assert_eq!(plot.y.title(), "h (km)");
        assert_eq!(plot.series[0].points.len(), levels.len());
    }
}
