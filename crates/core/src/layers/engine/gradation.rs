//! The Lipschitz regularization of h, its inf-convolution with g |·|: the largest field that changes by no
//! more than a given slope g and never exceeds what the layers ask for,
//! h̄(x) = min over y of h(y) + g |x − y|.
//!
//! It is evaluated by branch and bound through the lattice, best first (`BestFirst`): no cell of a rectangle
//! carries less to x than the least h in the rectangle plus g times its distance from x. Two facts keep them
//! short.
//!
//! **Most questions are comparisons.** The rule of refinement asks whether h̄ < ℓ. Then a rectangle whose
//! bound is at least ℓ is skipped, and any value below ℓ ends the search.
//!
//! **Only steep places matter.** Where h changes by at most g per unit of length, a step from y towards x
//! does not increase h(y) + g |x − y|. So from any y one gets without loss to x itself, or to the border of
//! a rectangle in which h is steeper than g, or jumps. Only such rectangles are divided.
//!
//! **Of those, only where h + g d can be least.** Rectangles where h + g d decreases in one direction
//! everywhere are not divided either: steps in this direction lead out of them without loss. So of a smooth
//! hill that is steeper than g, only the surroundings of places where the slope towards x is g are divided.

use glam::DVec2;

use crate::geometry::{BestFirst, LatticePoint, Octagon, Rect};
use crate::layers::PaintLayers;

use super::cells::Cells;
use super::cone::Cone;
use super::parts::{KnownParts, LEAST_BITS, PartId};
use super::place::{ConvexSet, Point, TriangleInWorld, gap, rect_of};
use super::stack::Stack;
use super::steepness::Slopes;

/// A comparison that has not ended after this number of rectangles says that h̄ is not below.
const MOST_COMPARED: usize = 1 << 16;

/// Parts whose bound is below the best known value by less than this share are not searched.
const TIGHT: f64 = 1e-9;

/// The number of rectangles after which [`TOLERANCE`] is enough for files.
const FEW: usize = 200;

/// A value that is read is above the least one by at most this share of it.
const TOLERANCE: f64 = 1e-6;

/// The number of rectangles after which [`QUICK_TOLERANCE`] is enough for a value under the pointer.
const QUICK: usize = 400;

/// A value that is read quickly is above the least one by at most this share of it.
const QUICK_TOLERANCE: f64 = 1e-3;

/// A value that is read is the least that was found in this number of rectangles.
const MOST_READ: usize = 1 << 13;

/// How near a value that is read is to the least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// For files: the result exceeds h̄ by at most [`TIGHT`], or [`TOLERANCE`] if a closer search would take
    /// long.
    Close,
    /// For the pointer: the result exceeds h̄ by at most [`TOLERANCE`], or [`QUICK_TOLERANCE`] if a closer
    /// search would take long.
    Quick,
}

impl Accuracy {
    fn tolerance(self, searched: usize) -> f64 {
        match self {
            Self::Close if searched < FEW => TIGHT,
            Self::Quick if searched >= QUICK => QUICK_TOLERANCE,
            Self::Close | Self::Quick => TOLERANCE,
        }
    }
}

/// A search over a field from a place, with the slope g.
pub struct GradationSearch<'a, P> {
    pub stack: &'a Stack,
    pub paint: &'a PaintLayers,
    pub place: P,
    pub slope: f64,
    /// Squares of 2^this steps are divided where the layers say so.
    pub finest: u32,
}

/// A part of the lattice to search.
#[derive(Clone, Copy)]
pub struct SearchedPart {
    pub id: PartId,
    /// No cell has a lower h before gradation.
    pub least: f64,
    /// No cell has a greater one.
    pub greatest: f64,
    /// The distance from the searched point.
    pub distance: f64,
}

impl<P: ConvexSet> GradationSearch<'_, P> {
    /// Returns squares that cover all values below `length`, which are at least `least`.
    pub fn start(
        &self,
        known: &mut KnownParts,
        least: f64,
        length: f64,
    ) -> impl Iterator<Item = PartId> + use<P> {
        let lattice = self.stack.lattice();
        let reach = self.place.bounds().expanded(((length - least) / self.slope).max(0.0));
        let step = lattice.step();
        let all = Cells::all(lattice.extent());
        let [min, max] = [reach.min / step, reach.max / step].map(|p| p.to_array());
        let around = Cells {
            min: min.map(|v| (v.floor() as i64).saturating_sub(1).max(0)),
            max: max.map(|v| (v.ceil() as i64).saturating_add(1)),
        };
        let around = around.intersection(&all).map(|around| known.covering(self.stack, self.paint, &around));
        around.into_iter().flatten()
    }

    /// Returns a part, unless its bound is at least `limit`, and its bound.
    #[inline]
    pub fn part(&self, known: &mut KnownParts, id: PartId, limit: f64) -> Option<(f64, SearchedPart)> {
        let [least, greatest] = known.diameters(self.stack, self.paint, id);
        if least >= limit {
            return None;
        }
        let cells = known.cells(id)?;
        let rect = rect_of(&cells, self.stack.lattice());
        // The exact distance takes longer.
        if least + self.slope * gap(&self.place.bounds(), &rect) >= limit {
            return None;
        }
        let distance = self.place.distance(&cells, &rect);
        let bound = least + self.slope * distance;
        (bound < limit).then_some((bound, SearchedPart { id, least, greatest, distance }))
    }

    /// Returns the rectangle of a part, in world units with the corner of the lattice as origin.
    pub fn rect(&self, known: &KnownParts, id: PartId) -> Rect {
        let empty = Rect::new(DVec2::ZERO, DVec2::ZERO);
        known.cells(id).map_or(empty, |cells| rect_of(&cells, self.stack.lattice()))
    }

    /// Returns whether a least value of h + g d can lie inside a part, and not only at the place or on the
    /// border of the part.
    #[inline]
    pub fn is_steep(&self, known: &mut KnownParts, part: PartId) -> bool {
        let rect = self.rect(known, part);
        let (slopes, _) = known.slopes(self.stack, self.paint, part);
        slopes.exceed(self.slope) && !self.falls_throughout(slopes, &rect)
    }

    /// Returns whether h + g d falls along one direction all over a rectangle. The direction does not lead
    /// out of the lattice.
    ///
    /// The gradient of h + g d is that of h, and g times the unit vector u away from the nearest point of the
    /// place. The vector from the nearest point to y changes by at most |y − c| between the centre c of the
    /// rectangle and y, as that from a fixed point does.
    fn falls_throughout(&self, slopes: &Slopes, rect: &Rect) -> bool {
        let away = Cone::from_point(self.place.nearest(rect.center()), rect);
        let (away, spread) = away.map_or((DVec2::ZERO, 1.0), |cone| (cone.toward(), cone.spread()));
        let all = rect_of(&Cells::all(self.stack.lattice().extent()), self.stack.lattice());
        let within_lattice = |mut rise: DVec2| {
            for axis in 0..2 {
                let leaves = match rise[axis] > 0.0 {
                    true => rect.min[axis] <= 0.0,
                    false => rect.max[axis] >= all.max[axis],
                };
                rise[axis] = if leaves { 0.0 } else { rise[axis] };
            }
            rise
        };
        slopes.fall_with(self.slope * away, self.slope * spread, within_lattice)
    }

    /// Returns the parts that a part is divided into.
    pub fn divided(&self, known: &mut KnownParts, part: PartId) -> impl Iterator<Item = PartId> + use<P> {
        known.divided(self.stack, self.paint, part, self.finest)
    }

    /// Returns whether a cell of some parts, at distance d from the place, has h + g d < `length`. Cells at
    /// the place itself must be known to have no h below.
    fn any_below(&self, known: &mut KnownParts, start: impl Iterator<Item = PartId>, length: f64) -> bool {
        let mut parts = BestFirst::default();
        let is_below = |known: &mut KnownParts, id: PartId, parts: &mut BestFirst<PartId>| {
            let Some((bound, part)) = self.part(known, id, length) else { return false };
            parts.push(bound, id);
            part.greatest + self.slope * part.distance < length
        };
        for id in start {
            if is_below(known, id, &mut parts) {
                return true;
            }
        }
        for _ in 0..MOST_COMPARED {
            let Some((_, id)) = parts.pop() else { return false };
            if self.is_steep(known, id)
                && self.divided(known, id).any(|part| is_below(known, part, &mut parts))
            {
                return true;
            }
        }
        false
    }
}

/// Returns the binary logarithm of a quarter of the side of a shape that fits a rectangle of the lattice.
pub fn quarter_bits([min, max]: [[i64; 2]; 2]) -> u32 {
    let side = (max[0] - min[0]).max(max[1] - min[1]).max(1);
    (side as u64).ilog2().saturating_sub(2).max(LEAST_BITS)
}

/// Returns whether a cell of the lattice, at distance d from the closed triangle, has h + g d < `length`.
/// Cells that touch the triangle must be known to have no h below. `sources` hold all such cells, if they are
/// known.
pub fn any_below(
    stack: &Stack,
    paint: &PaintLayers,
    known: &mut KnownParts,
    corners: [LatticePoint; 3],
    (slope, length): (f64, f64),
    sources: Option<&[PartId]>,
) -> bool {
    let place = TriangleInWorld::new(corners, stack.lattice());
    // Many pixels can be equally far from a side of the triangle; cells are then divided at pixels.
    let finest = quarter_bits(Octagon::triangle(corners).bounds()).max(stack.pixel_bits(paint));
    let search = GradationSearch { stack, paint, place, slope, finest };
    match sources {
        Some(sources) => search.any_below(known, sources.iter().copied(), length),
        None => {
            let start = search.start(known, stack.limits().h_min, length);
            search.any_below(known, start, length)
        }
    }
}

/// Returns the least h + g d over the lattice, at distance d from a point in world units, and the place from
/// which it comes; `start` is a value that is known, and its place. What the layers ask for that `known`
/// leaves out must be in `start`.
pub fn least(
    stack: &Stack,
    paint: &PaintLayers,
    known: &mut KnownParts,
    point: DVec2,
    (slope, accuracy): (f64, Accuracy),
    start: (f64, DVec2),
) -> (f64, DVec2) {
    let h_min = stack.limits().h_min;
    if start.0 <= h_min {
        return start;
    }
    let origin = stack.lattice().bounds().min;
    let place = Point(point - origin);
    let finest = stack.pixel_bits(paint).max(LEAST_BITS);
    let search = GradationSearch { stack, paint, place, slope, finest };
    let (mut best, mut parts) = (start, BestFirst::default());
    for id in search.start(known, h_min, start.0) {
        if let Some((bound, part)) = search.part(known, id, best.0 * (1.0 - TIGHT)) {
            parts.push(bound, part);
        }
    }
    for number in 0..MOST_READ {
        let Some((bound, part)) = parts.pop() else { break };
        if bound >= best.0 * (1.0 - accuracy.tolerance(number)) {
            break;
        }
        let is_one = part.least == part.greatest;
        let rect = search.rect(known, part.id);
        let center = rect.center();
        // One value all over counts at the nearest place.
        let at = if is_one { search.place.0.clamp(rect.min, rect.max) } else { center };
        let carried = slope * at.distance(search.place.0);
        if part.least + carried < best.0 {
            let value = stack.ungraded_by(known.counting(), paint, origin + center).target + carried;
            if value < best.0 {
                best = (value, origin + at);
            }
        }
        if is_one || !search.is_steep(known, part.id) {
            continue;
        }
        let limit = best.0 * (1.0 - TIGHT);
        for id in search.divided(known, part.id) {
            if let Some((bound, part)) = search.part(known, id, limit) {
                parts.push(bound, part);
            }
        }
    }
    best
}

/// Share by which bounds of h̄ are widened, since sums of distances are rounded.
const MARGIN: f64 = 2e-7;

/// The number of rectangles in which [`graded_bounds`] looks at most.
const MOST_BOUNDED: usize = 24;

/// Bounds of h̄ over all points of some cells, and the parts from which gradation can carry a least value to
/// a point of the cells.
#[derive(Clone, Debug, Default)]
pub struct GradedBounds {
    /// No h̄ is smaller, in world units.
    pub least: f64,
    /// No h̄ is greater.
    pub greatest: f64,
    /// In no order.
    pub sources: Vec<PartId>,
}

/// Returns bounds of h̄ over all points of some cells, from those before gradation, `[least, greatest]`, and
/// from the sources of a rectangle around the cells.
///
/// It ends when `is_enough` says so of the bounds of the least h̄, or after a few rectangles: the bounds
/// hold at any time.
///
/// At every point of the cells h̄ is at most `greatest`. So a part with a bound of at least this value is no
/// source: a lower value is carried to all triangles in the cells from other ones.
pub fn graded_bounds(
    stack: &Stack,
    paint: &PaintLayers,
    known: &mut KnownParts,
    (cells, sources): (&Cells, &[PartId]),
    slope: f64,
    [least, greatest]: [f64; 2],
    is_enough: impl Fn([f64; 2]) -> bool,
) -> GradedBounds {
    let place = rect_of(cells, stack.lattice());
    let (center, half_diagonal) = (place.center(), 0.5 * place.size().length());
    let finest = quarter_bits([cells.min, cells.max]);
    let search = GradationSearch { stack, paint, place, slope, finest };
    let mut parts = BestFirst::default();
    // The least h̄ is from `low` to `low_most`, and every h̄ is at most `high`.
    let (mut low_most, mut high) = (greatest, greatest);
    let mut offer = |known: &mut KnownParts, id: PartId, parts: &mut BestFirst<PartId>| {
        if let Some((bound, part)) = search.part(known, id, high * (1.0 + MARGIN)) {
            let rect = search.rect(known, id);
            let nearest = center.clamp(rect.min, rect.max);
            low_most = low_most.min(part.greatest + slope * part.distance);
            high = high.min(part.greatest + slope * (nearest.distance(center) + half_diagonal));
            parts.push(bound, id);
        }
        [low_most, high]
    };
    let mut most = [greatest; 2];
    for &id in sources {
        most = offer(known, id, &mut parts);
    }
    let (mut low, mut sources) = (least, Vec::new());
    for _ in 0..MOST_BOUNDED {
        low = least;
        let Some((bound, id)) = parts.pop() else { break };
        low = bound.min(least);
        let is_least = bound >= least || !known.is_square_above(id, finest);
        if is_least || is_enough([low, most[0]]) {
            parts.push(bound, id);
            break;
        }
        if !known.slopes(stack, paint, id).0.exceed(slope) {
            continue;
        }
        if !search.is_steep(known, id) {
            // It can still matter to a part of the cells.
            sources.push(id);
            continue;
        }
        for id in search.divided(known, id) {
            most = offer(known, id, &mut parts);
        }
    }
    let high = most[1] * (1.0 + MARGIN);
    sources.extend(parts.into_parts().filter(|(bound, _)| *bound < high).map(|(_, id)| id));
    let [h_min, h_max] = [stack.limits().h_min, stack.limits().h_max];
    GradedBounds { least: (low * (1.0 - MARGIN)).max(h_min), greatest: high.min(h_max), sources }
}

/// A field in which some cells have changed, for questions about the values that other cells carry.
pub struct Elsewhere<'a> {
    pub stack: &'a Stack,
    pub paint: &'a PaintLayers,
    pub slope: f64,
    pub changed: &'a [Cells],
}

/// Returns the parts from which values are carried to some cells, unless a value of at most `limit` is
/// carried to each of the cells from a part in which nothing has changed. `sources` are those of a rectangle
/// around the
/// cells.
pub fn most_from_elsewhere(
    elsewhere: &Elsewhere,
    known: &mut KnownParts,
    (cells, sources): (&Cells, &[PartId]),
    limit: f64,
) -> Option<Vec<PartId>> {
    let Elsewhere { stack, paint, slope, changed } = *elsewhere;
    let place = rect_of(cells, stack.lattice());
    let (center, half_diagonal) = (place.center(), 0.5 * place.size().length());
    let finest = quarter_bits([cells.min, cells.max]);
    let search = GradationSearch { stack, paint, place, slope, finest };
    // What is too much here may be little enough for a part of the cells that is farther from the change.
    let most = limit + 2.0 * slope * half_diagonal;
    let mut parts = BestFirst::default();
    let offer = |known: &mut KnownParts, id: PartId, parts: &mut BestFirst<PartId>| {
        let Some((bound, part)) = search.part(known, id, most) else { return false };
        let Some(cells) = known.cells(id) else { return false };
        parts.push(bound, id);
        let rect = search.rect(known, id);
        let farthest = center.clamp(rect.min, rect.max).distance(center) + half_diagonal;
        part.greatest + slope * farthest <= limit
            && changed.iter().all(|changed| changed.intersection(&cells).is_none())
    };
    for &id in sources {
        if offer(known, id, &mut parts) {
            return None;
        }
    }
    for _ in 0..MOST_BOUNDED {
        let Some((bound, id)) = parts.pop() else { break };
        if bound >= limit || !known.is_square_above(id, finest) {
            parts.push(bound, id);
            break;
        }
        for id in search.divided(known, id) {
            if offer(known, id, &mut parts) {
                return None;
            }
        }
    }
    Some(parts.into_parts().map(|(_, id)| id).collect())
}
