//! The gaps between the parts of lines: how small triangles must be so that a mesh has edges along all of
//! them.
//!
//! Lines consist of nodes and of straight segments between nodes. The gap at a point is the radius of the
//! smallest disc around it that meets two parts without a node in common: Ruppert's local feature size of
//! the lines.
//!
//! ```text
//!   ●───────────●        ╲        ╱
//!         x               ╲  x   ╱        x  a place
//!   ●───────────●          ╲    ╱
//!                           ●──●
//!   to the farther line    to the farther of the two
//! ```
//!
//! Segments that meet in a node have no gap there, whatever their angle: however small triangles are, the
//! ones in the corner have its angle. The gap is Lipschitz continuous with constant 1, since every distance
//! is. So the target diameter grows by at most one unit of length for each unit of the way from the lines.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use crate::domain::{Domain, Line, LinesOnLattice};
use crate::field::Bounds;
use crate::geometry::{BoxTree, Lattice, NumberMap, Rect, nearest_on_segment};

/// Diameters that lines need, so that a mesh can have edges along them.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSizes {
    /// Triangles across the gap between two parts of lines.
    pub across: f64,
    /// The lines. In a document they are its own.
    pub gaps: LineGaps,
}

impl Default for LineSizes {
    /// Sizes for lines that are not known yet.
    fn default() -> Self {
        Self { across: Self::ENOUGH_ACROSS, gaps: LineGaps::unknown() }
    }
}

impl LineSizes {
    /// Triangles across a gap with which nearly all parts of lines get edges.
    pub const ENOUGH_ACROSS: f64 = 1.0;

    /// Returns the target diameter at a point, as a length in the plane; infinite where lines have no gap.
    pub(super) fn diameter_at(&self, point: DVec2) -> f64 {
        self.gaps.at(point) / self.across
    }

    /// Returns bounds of the target diameter over a closed rectangle, as lengths in the plane.
    pub(super) fn bounds(&self, rect: &Rect) -> Bounds {
        let Bounds { least, greatest, valid } = self.gaps.bounds(rect);
        Bounds { least: least / self.across, greatest: greatest / self.across, valid }
    }

    /// Returns how much the target diameter changes by unit of length, at most.
    pub(super) fn steepness(&self) -> f64 {
        1.0 / self.across
    }

    /// Returns how far from the lines the target diameter is below another one, at most: both are lengths in
    /// the plane.
    pub(super) fn farthest(&self, diameter: f64) -> f64 {
        self.across * diameter * (1.0 + 1e-9)
    }
}

/// The parts of lines, with an index. Clones share their data.
#[derive(Clone, Debug)]
pub struct LineGaps(Arc<IndexedParts>);

#[derive(Debug)]
struct IndexedParts {
    lines: Arc<Vec<Line>>,
    bounds: Option<Rect>,
    parts: Vec<LinesPart>,
    tree: BoxTree,
    /// No gap is smaller, in world units.
    least: f64,
}

/// A node, or a segment between two.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LinesPart {
    ends: [DVec2; 2],
    /// The numbers of its nodes; of a single one, twice.
    nodes: [u32; 2],
}

impl LinesPart {
    fn has(&self, node: u32) -> bool {
        self.nodes.contains(&node)
    }

    fn meets(&self, other: &Self) -> bool {
        other.nodes.iter().any(|&node| self.has(node))
    }

    fn squared_distance(&self, point: DVec2) -> f64 {
        point.distance_squared(nearest_on_segment(point, self.ends))
    }

    fn bounds(&self) -> Rect {
        Rect::spanning(self.ends[0], self.ends[1])
    }
}

impl PartialEq for LineGaps {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &IndexedParts, b: &IndexedParts| a.bounds == b.bounds && a.lines == b.lines;
        Arc::ptr_eq(&self.0, &other.0) || same(&self.0, &other.0)
    }
}

impl LineGaps {
    /// Returns no lines: a layer of a document has those of the document.
    pub fn unknown() -> Self {
        Self::of_parts(Arc::default(), None, Vec::new(), 0.0)
    }

    /// Returns the gaps of lines, where they are in the bounds of a domain. Takes time n log n for n corners
    /// and crossings.
    pub fn of(lines: &Arc<Vec<Line>>, domain: &Domain) -> Self {
        let bounds = domain.bounds;
        let lattice = Lattice::covering(bounds, bounds.size().max_element(), usize::MAX);
        let Ok(lattice) = lattice else { return Self::unknown() };
        let segments = LinesOnLattice::of(lines, &lattice).segments;
        let mut numbers = NumberMap::default();
        let mut parts = Vec::with_capacity(2 * segments.len());
        for ends in &segments {
            let nodes = ends.map(|p| {
                let next = numbers.len() as u32;
                *numbers.entry(p).or_insert(next)
            });
            parts.push(LinesPart { ends: ends.map(|p| lattice.world_from_lattice(p)), nodes });
        }
        let mut nodes: Vec<_> = numbers.into_iter().collect();
        nodes.sort_unstable_by_key(|&(_, number)| number);
        parts.extend(nodes.into_iter().map(|(p, number)| {
            let at = lattice.world_from_lattice(p);
            LinesPart { ends: [at; 2], nodes: [number; 2] }
        }));
        // Two parts without a common node are at least a lattice step apart.
        Self::of_parts(lines.clone(), Some(bounds), parts, 0.25 * lattice.step().min_element())
    }

    fn of_parts(lines: Arc<Vec<Line>>, bounds: Option<Rect>, parts: Vec<LinesPart>, least: f64) -> Self {
        let boxes: Vec<Rect> = parts.iter().map(LinesPart::bounds).collect();
        Self(Arc::new(IndexedParts { lines, bounds, tree: BoxTree::new(&boxes), parts, least }))
    }

    /// Returns whether these are the gaps of lines in the bounds of a domain.
    pub(super) fn is_of(&self, lines: &Arc<Vec<Line>>, domain: &Domain) -> bool {
        self.0.bounds == Some(domain.bounds) && (Arc::ptr_eq(&self.0.lines, lines) || self.0.lines == *lines)
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedParts { parts, tree, .. } = &*self.0;
        (Arc::as_ptr(&self.0).addr(), size_of_val(&**parts) + tree.bytes())
    }

    /// Returns the smallest rectangle that holds the lines; `None` without a line.
    pub fn extent(&self) -> Option<Rect> {
        self.0.tree.bounds()
    }

    /// Returns rectangles that hold all parts that only one of two sets of lines has.
    pub(super) fn areas_that_differ(&self, other: &Self) -> Vec<Rect> {
        let bits = |part: &LinesPart| part.ends.map(|end| end.to_array().map(f64::to_bits));
        let keys = |of: &Self| of.0.parts.iter().map(|part| (bits(part), part.bounds())).collect();
        let [own, others]: [NumberMap<_, Rect>; 2] = [keys(self), keys(other)];
        let only = |of: &NumberMap<_, Rect>, not: &NumberMap<_, Rect>| -> Vec<Rect> {
            of.iter().filter(|(key, _)| !not.contains_key(*key)).map(|(_, rect)| *rect).collect()
        };
        let mut areas = [only(&own, &others), only(&others, &own)].concat();
        areas.sort_unstable_by(|a, b| {
            let key = |rect: &Rect| [rect.min.x, rect.min.y, rect.max.x, rect.max.y];
            key(a).partial_cmp(&key(b)).expect("finite numbers")
        });
        areas
    }

    /// Returns the gap at a point, in the plane; infinite where all parts have a node in common.
    pub fn at(&self, point: DVec2) -> f64 {
        let IndexedParts { parts, tree, least, .. } = &*self.0;
        let of = |number: u32| parts[number as usize];
        let Some((nearest, _)) = tree.nearest(point, |number| of(number).squared_distance(point)) else {
            return f64::INFINITY;
        };
        let nearest = of(nearest);
        let apart = tree.nearest(point, |number| match of(number).meets(&nearest) {
            true => f64::INFINITY,
            false => of(number).squared_distance(point),
        });
        let apart = apart.map_or(f64::INFINITY, |(_, squared)| squared);
        self.between_neighbours(point, &nearest, apart).sqrt().max(*least)
    }

    /// Returns the squared gap at a point. `apart` is the squared distance to the nearest part without a node
    /// of the nearest one: parts that do have one can be apart from each other, and nearer.
    fn between_neighbours(&self, point: DVec2, nearest: &LinesPart, apart: f64) -> f64 {
        let mut near: Vec<(f64, LinesPart)> = Vec::new();
        self.visit_within(point, apart, |part, squared| {
            if part.meets(nearest) {
                near.push((squared, part));
            }
        });
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.nodes.cmp(&b.1.nodes)));
        // Parts at one node have no gap. Most are of that sort, also where many lines meet.
        let mut common: Vec<u32> = Vec::new();
        for (n, (squared, part)) in near.iter().enumerate() {
            if n == 0 {
                common = part.nodes.to_vec();
                continue;
            }
            let meets_all = common.iter().any(|&node| part.has(node));
            if !meets_all && near[..n].iter().any(|(_, other)| !part.meets(other)) {
                return *squared;
            }
            common.retain(|&node| part.has(node));
        }
        apart
    }

    fn visit_within(&self, point: DVec2, squared: f64, mut visit: impl FnMut(LinesPart, f64)) {
        let IndexedParts { parts, tree, .. } = &*self.0;
        let is_near = |rect: &Rect| point.distance_squared(point.clamp(rect.min, rect.max)) <= squared;
        let _ = tree.descend(
            |_, rect| is_near(rect),
            |number, _| {
                let part = parts[number as usize];
                let distance = part.squared_distance(point);
                if distance <= squared {
                    visit(part, distance);
                }
                ControlFlow::Continue(())
            },
        );
    }

    /// Returns bounds of [`Self::at`] over a closed rectangle.
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        let center = rect.center();
        let gap = self.at(center);
        if gap == f64::INFINITY {
            return Bounds::one(f64::INFINITY);
        }
        // Rounding shifts the centre and the nearest points by a few ulps of the largest coordinate.
        let largest = center.abs().max_element() + gap;
        let reach = 0.5 * rect.size().length() * (1.0 + 1e-12) + 1e-14 * largest;
        Bounds::new((gap - reach).max(self.0.least), gap + reach)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn domain() -> Domain {
        Domain::rectangle(Rect::new(DVec2::ZERO, dvec2(2.0, 1.0)))
    }

    fn random_lines(random: &mut fastrand::Rng) -> Arc<Vec<Line>> {
        let mut line = |n: usize| {
            let mut at = dvec2(2.0 * random.f64(), random.f64());
            let points = (0..random.usize(2..6)).map(|_| {
                at += 0.3 * dvec2(random.f64() - 0.5, random.f64() - 0.5);
                at
            });
            Line {
                name: n.to_string(),
                points: points.collect(),
                closed: random.bool(),
                kind: Default::default(),
            }
        };
        Arc::new((0..4).map(&mut line).collect())
    }

    /// The definition: all pairs of parts without a common node.
    fn referee(gaps: &LineGaps, point: DVec2) -> f64 {
        let parts = &gaps.0.parts;
        let distance = |part: &LinesPart| {
            let [a, b] = part.ends;
            let along = b - a;
            let share = if a == b { 0.0 } else { (point - a).dot(along) / along.length_squared() };
            point.distance(a + share.clamp(0.0, 1.0) * along)
        };
        let mut least = f64::INFINITY;
        for (n, a) in parts.iter().enumerate() {
            for b in &parts[..n] {
                let have_common = a.ends.iter().any(|end| b.ends.contains(end));
                if !have_common {
                    least = least.min(distance(a).max(distance(b)));
                }
            }
        }
        least
    }

    #[test]
    fn the_gap_is_that_of_its_definition_and_within_its_bounds() {
        let mut random = fastrand::Rng::with_seed(21);
        for _ in 0..60 {
            let gaps = LineGaps::of(&random_lines(&mut random), &domain());
            for _ in 0..20 {
                let min = dvec2(2.0 * random.f64(), random.f64());
                let size = random.f64().powi(3) * dvec2(random.f64(), random.f64());
                let rect = Rect::new(min, min + size);
                let bounds = gaps.bounds(&rect);
                for _ in 0..5 {
                    let at = rect.min + dvec2(random.f64(), random.f64()) * rect.size();
                    let (gap, wanted) = (gaps.at(at), referee(&gaps, at));
                    assert!((gap - wanted).abs() <= 1e-12, "{gap} {wanted} at {at}");
                    assert!(bounds.contains(gap), "{gap} in {bounds:?}");
                }
            }
        }
    }

    #[test]
    fn known_gaps() {
        let line = |points: &[[f64; 2]]| Line {
            name: String::new(),
            points: points.iter().map(|&p| p.into()).collect(),
            closed: false,
            kind: Default::default(),
        };
        let of = |lines: Vec<Line>| LineGaps::of(&Arc::new(lines), &domain());
        let one = of(vec![line(&[[0.5, 0.5], [0.75, 0.5]])]);
        assert!((one.at(dvec2(0.5, 0.5)) - 0.25).abs() < 1e-8);
        assert!((one.at(dvec2(0.625, 0.5)) - 0.125).abs() < 1e-8);
        let two = of(vec![line(&[[0.1, 0.25], [1.9, 0.25]]), line(&[[0.1, 0.5], [1.9, 0.5]])]);
        assert!((two.at(dvec2(1.0, 0.25)) - 0.25).abs() < 1e-8);
        assert!((two.at(dvec2(1.0, 0.375)) - 0.125).abs() < 1e-8);
        let star = (0..300).map(|n| {
            let end = dvec2(1.0, 0.5) + 0.4 * DVec2::from_angle(0.02 * f64::from(n));
            line(&[[1.0, 0.5], end.to_array()])
        });
        let star = of(star.collect());
        assert!((star.at(dvec2(1.0, 0.5)) - 0.4).abs() < 1e-8, "the ends are apart from each other");
        assert_eq!(of(Vec::new()).at(DVec2::ZERO), f64::INFINITY);
        assert_eq!(of(Vec::new()).extent(), None);
    }

    #[test]
    fn areas_hold_what_differs() {
        let mut random = fastrand::Rng::with_seed(22);
        for _ in 0..60 {
            let before = random_lines(&mut random);
            let mut lines = before.to_vec();
            lines[random.usize(..4)].points[0] = dvec2(random.f64(), random.f64());
            let [old, new] = [before, Arc::new(lines)].map(|lines| LineGaps::of(&lines, &domain()));
            let areas = new.areas_that_differ(&old);
            for _ in 0..100 {
                let at = dvec2(2.0 * random.f64(), random.f64());
                let (gap, gap_before) = (new.at(at), old.at(at));
                let reach = gap.min(gap_before) * (1.0 + 1e-9);
                let is_near = areas.iter().any(|rect| at.distance(at.clamp(rect.min, rect.max)) <= reach);
                assert!(gap == gap_before || is_near, "{gap} after {gap_before} at {at}");
            }
            assert!(old.areas_that_differ(&old).is_empty());
        }
    }
}
