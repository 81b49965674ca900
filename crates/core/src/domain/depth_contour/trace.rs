//! Traces the outline of water through the centres of pixels (marching squares).
//!
//! Nodes are the centres of pixels and, around them, places on the sides of the raster that have the depths
//! of the last pixels. Beyond these there is no water.

use std::collections::HashMap;

use glam::DVec2;

use super::super::Ring;
use super::super::marching::{self, GridEdge, GridNode, MarchingGrid};
use crate::geometry::Rect;

/// How far a crossing is from both nodes, at least, as a share of the way between them.
const OFF_NODE: f64 = 1.0 / 1024.0;

/// The pixels to trace.
pub(super) struct WaterPixels<'a> {
    pub bounds: Rect,
    pub size: [u32; 2],
    pub depths: &'a [f32],
    pub level: f64,
    /// The pixels that count: all of them are deeper than the level.
    pub water: &'a [bool],
}

/// A ring with the water on its left.
pub(super) struct TracedRing {
    pub points: Ring,
    /// The number of the ring around the water, if this one is an island in it.
    pub around: Option<usize>,
}

impl WaterPixels<'_> {
    /// Returns the number of the pixel of a node, unless it is beyond the sides.
    fn pixel(&self, node: GridNode) -> Option<usize> {
        let [columns, rows] = self.size.map(i64::from);
        let is_node = (0..=columns + 1).contains(&node[0]) && (0..=rows + 1).contains(&node[1]);
        let [x, y] = [(node[0] - 1).clamp(0, columns - 1), (node[1] - 1).clamp(0, rows - 1)];
        is_node.then_some((y * columns + x) as usize)
    }

    /// Returns the depth at a node, if it is known.
    fn depth(&self, node: GridNode) -> Option<f64> {
        let depth = f64::from(self.depths[self.pixel(node)?]);
        (!depth.is_nan()).then_some(depth)
    }

    fn place(&self, node: GridNode) -> DVec2 {
        let Rect { min, max } = self.bounds;
        let size = DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]));
        let pixel = (max - min) / size;
        let along = |axis: usize| match node[axis] {
            n if n <= 0 => min[axis],
            n if n > i64::from(self.size[axis]) => max[axis],
            n => min[axis] + (n as f64 - 0.5) * pixel[axis],
        };
        DVec2::new(along(0), along(1))
    }

    /// Returns the place where the outline crosses an edge with water at one end.
    fn crossing(&self, edge: GridEdge) -> DVec2 {
        let [a, b] = edge.ends();
        let (wet, dry) = if self.is_inside(a) { (a, b) } else { (b, a) };
        if self.pixel(dry).is_none() {
            return self.place(wet);
        }
        let share = match (self.depth(wet), self.depth(dry)) {
            // Water that was closed is deeper than the level.
            (Some(deep), Some(shallow)) if shallow <= self.level => {
                ((deep - self.level) / (deep - shallow)).clamp(OFF_NODE, 1.0 - OFF_NODE)
            }
            _ => 0.5,
        };
        // Exact along a side, where both have the same coordinate.
        let [wet, dry] = [wet, dry].map(|node| self.place(node));
        wet + share * (dry - wet)
    }

    /// Returns whether a node is water, or shallower than the level: not water that was closed.
    fn is_traced(&self, node: GridNode) -> bool {
        self.is_inside(node) || self.depth(node).is_some_and(|depth| depth <= self.level)
    }
}

impl MarchingGrid for WaterPixels<'_> {
    fn is_inside(&self, node: GridNode) -> bool {
        self.pixel(node).is_some_and(|pixel| self.water[pixel])
    }

    fn is_joined(&self, corners: [GridNode; 4]) -> bool {
        let known = corners.map(|node| self.depth(node).filter(|_| self.is_traced(node)));
        let sum: Option<f64> = known.into_iter().sum();
        sum.is_some_and(|sum| 0.25 * sum > self.level)
    }
}

/// Returns the rings of the outline of water.
pub(super) fn rings(water: &WaterPixels) -> Vec<TracedRing> {
    let [columns, rows] = water.size.map(i64::from);
    let squares = (-1..=rows + 1).flat_map(|y| (-1..=columns + 1).map(move |x| [x, y]));
    let mut crossed: HashMap<i64, Vec<(i64, usize)>> = HashMap::new();
    let mut found: Vec<(Vec<GridEdge>, f64)> = Vec::new();
    for edges in marching::rings(water, squares) {
        for edge in edges.iter().filter(|edge| edge.axis == 0) {
            crossed.entry(edge.node[1]).or_default().push((edge.node[0], found.len()));
        }
        let turns = turning_area(&edges);
        found.push((edges, turns));
    }
    crossed.values_mut().for_each(|row| row.sort_unstable());
    let around = outer_rings(&found, &crossed);
    let ring = |((edges, _), around): (&(Vec<GridEdge>, f64), Option<usize>)| TracedRing {
        points: without_needless(edges.iter().map(|&edge| water.crossing(edge)).collect(), &water.bounds),
        around,
    };
    found.iter().zip(around).map(ring).collect()
}

/// Returns the area of a ring between the middles of its edges, in squares, above zero where it is
/// counter-clockwise.
fn turning_area(edges: &[GridEdge]) -> f64 {
    let middle = |edge: &GridEdge| {
        let [a, b] = edge.ends();
        [0, 1].map(|axis: usize| (a[axis] + b[axis]) as f64 * 0.5)
    };
    let pairs = edges.iter().zip(edges.iter().cycle().skip(1));
    pairs.map(|(a, b)| (middle(a), middle(b))).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// Returns for each ring the outer ring of the water in which it is an island, if it is one.
///
/// To the left of the leftmost crossing of an island there is water, up to the next crossing: that is one of
/// the ring around this water, or of another island in it, which reaches farther to the left.
fn outer_rings(
    rings: &[(Vec<GridEdge>, f64)],
    crossed: &HashMap<i64, Vec<(i64, usize)>>,
) -> Vec<Option<usize>> {
    let mut outer: Vec<Option<usize>> = vec![None; rings.len()];
    let leftmost = |number: usize| {
        let along_rows = rings[number].0.iter().filter(|edge| edge.axis == 0);
        along_rows.map(|edge| edge.node).min()
    };
    let left_of = |number: usize| {
        let [x, y] = leftmost(number)?;
        let row = crossed.get(&y)?;
        let place = row.partition_point(|&(column, _)| column < x);
        row.get(place.checked_sub(1)?).map(|&(_, ring)| ring)
    };
    for number in (0..rings.len()).filter(|&n| rings[n].1 < 0.0) {
        let mut way = vec![number];
        let mut at = number;
        while let Some(left) = left_of(at) {
            at = left;
            if rings[at].1 > 0.0 || outer[at].is_some() {
                break;
            }
            way.push(at);
        }
        let around = outer[at].or((rings[at].1 > 0.0).then_some(at));
        way.into_iter().for_each(|island| outer[island] = around);
    }
    outer
}

/// Returns a ring without points that repeat the one before, or lie between two others on a side.
fn without_needless(mut ring: Ring, bounds: &Rect) -> Ring {
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let count = ring.len();
    let is_on_one_side = |n: usize| {
        let points = [ring[(n + count - 1) % count], ring[n], ring[(n + 1) % count]];
        (0..2).any(|axis: usize| {
            [bounds.min[axis], bounds.max[axis]].iter().any(|&side| points.iter().all(|p| p[axis] == side))
        })
    };
    (0..count).filter(|&n| !is_on_one_side(n)).map(|n| ring[n]).collect()
}
