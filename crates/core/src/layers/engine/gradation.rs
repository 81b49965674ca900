//! The largest field that changes by no more than a given slope and never exceeds what the layers ask for:
//! h̄(x) = min over y of h(y) + g |x − y|.
//!
//! Questions about it are searches through the lattice, best first (`BestFirst`): no cell of a rectangle
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
//! **Of those, only where h + g d can be least.** Where h + g d falls along one direction all over a
//! rectangle, steps in this direction lead out of it without loss, too. So of a smooth hill that is steeper
//! than g, only the surroundings of places are divided at which the slope towards x is g, and no other.

use glam::DVec2;

use crate::geometry::{BestFirst, LatticePoint, Octagon, Rect};
use crate::layers::{PaintLayers, SizeField};

use super::cells::{Cells, Cut};
use super::cone::Cone;
use super::counting::Counting;
use super::place::{Place, Point, TriangleInWorld, gap, rect_of};
use super::squares::{KnownSquares, LEAST_BITS, Square};
use super::steepness::{Slopes, slopes};

/// A comparison that has not ended after so many rectangles says that h̄ is not below.
const MOST_COMPARED: usize = 1 << 16;

/// What is above the least value by less than this share of it is not searched, up to [`FEW`] rectangles.
const TIGHT: f64 = 1e-9;

/// The number of rectangles after which [`TOLERANCE`] is enough.
const FEW: usize = 200;

/// A value that is read is above the least one by at most this share of it.
const TOLERANCE: f64 = 1e-6;

/// The number of rectangles after which [`QUICK_TOLERANCE`] is enough for a value under the pointer.
const QUICK: usize = 400;

/// A value that is read quickly is above the least one by at most this share of it.
const QUICK_TOLERANCE: f64 = 1e-3;

/// A value that is read is the least that was found in so many rectangles.
const MOST_READ: usize = 1 << 13;

/// How near a value that is read is to the least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// For files: above it by at most [`TOLERANCE`].
    Close,
    /// Under the pointer: the same, but [`QUICK_TOLERANCE`] where that would take long.
    Quick,
}

impl Accuracy {
    fn tolerance(self, searched: usize) -> f64 {
        match self {
            _ if searched < FEW => TIGHT,
            Self::Quick if searched >= QUICK => QUICK_TOLERANCE,
            Self::Close | Self::Quick => TOLERANCE,
        }
    }
}

/// A search over a field from a place, with the slope g.
pub struct Search<'a, P> {
    pub field: &'a SizeField,
    pub paint: &'a PaintLayers,
    pub place: P,
    pub slope: f64,
    /// Squares of 2^this steps are divided where the layers say so.
    pub finest: u32,
}

/// A rectangle to search.
#[derive(Clone, Copy)]
pub struct Part {
    pub area: Area,
    /// In world units, with the corner of the lattice as origin.
    pub rect: Rect,
    /// No cell has a lower h before gradation.
    pub least: f64,
    /// No cell has a greater one.
    pub greatest: f64,
    /// From the place.
    pub distance: f64,
    /// The layers that can count in it.
    pub counting: Counting,
}

#[derive(Clone, Copy)]
pub enum Area {
    Square(Square),
    /// Cells, and where to divide them.
    Cells(Cells, Option<Cut>),
}

impl<P: Place> Search<'_, P> {
    /// The squares in which values below `length` can lie, which are at least `least`.
    pub fn start(&self, least: f64, length: f64) -> impl Iterator<Item = Square> + use<P> {
        let lattice = self.field.lattice();
        let reach = self.place.bounds().expanded(((length - least) / self.slope).max(0.0));
        let step = lattice.step();
        let all = Cells::all(lattice.extent());
        let [min, max] = [reach.min / step, reach.max / step].map(|p| p.to_array());
        let around = Cells {
            min: min.map(|v| (v.floor() as i64).saturating_sub(1).max(0)),
            max: max.map(|v| (v.ceil() as i64).saturating_add(1)),
        };
        around.intersection(&all).into_iter().flat_map(|around| Square::covering(&around))
    }

    /// A part, unless its bound is at least `limit`, and its bound.
    #[inline]
    pub fn square(&self, known: &mut KnownSquares, square: Square, limit: f64) -> Option<(f64, Part)> {
        let [least, greatest] = known.diameters(self.field, self.paint, square);
        if least >= limit {
            return None;
        }
        let cells = square.cells(self.field.lattice().extent())?;
        let counting = known.counting(self.field, self.paint, square);
        self.bounded(Area::Square(square), &cells, [least, greatest], counting, limit)
    }

    fn cells(&self, cells: Cells, counting: Counting, limit: f64) -> Option<(f64, Part)> {
        let (diameters, cut) = self.field.diameters(self.paint, &cells, counting);
        self.bounded(Area::Cells(cells, cut), &cells, diameters, counting, limit)
    }

    #[inline]
    fn bounded(
        &self,
        area: Area,
        cells: &Cells,
        [least, greatest]: [f64; 2],
        counting: Counting,
        limit: f64,
    ) -> Option<(f64, Part)> {
        let rect = rect_of(cells, self.field.lattice());
        // The exact distance takes longer.
        if least + self.slope * gap(&self.place.bounds(), &rect) >= limit {
            return None;
        }
        let distance = self.place.distance(cells, &rect);
        let bound = least + self.slope * distance;
        (bound < limit).then_some((bound, Part { area, rect, least, greatest, distance, counting }))
    }

    /// The layers that can count in a part, if a least value of h + g d can lie inside it, and not only at
    /// the place or on the border of the part.
    #[inline]
    pub fn steep(&self, known: &mut KnownSquares, part: &Part) -> Option<Counting> {
        let (slopes, counting) = match &part.area {
            Area::Square(square) => known.slopes(self.field, self.paint, *square),
            Area::Cells(cells, _) => slopes(self.field, self.paint, cells, part.counting),
        };
        let matters = slopes.exceed(self.slope) && !self.falls_throughout(&slopes, &part.rect);
        matters.then_some(counting)
    }

    /// Whether h + g d falls along one direction all over a rectangle. The direction does not lead out of the
    /// lattice.
    ///
    /// The gradient of h + g d is that of h, and g times the unit vector u away from the nearest point of the
    /// place. The vector from the nearest point to y changes by at most |y − c| between the centre c of the
    /// rectangle and y, as that from a fixed point does.
    fn falls_throughout(&self, slopes: &Slopes, rect: &Rect) -> bool {
        let away = Cone::from_point(self.place.nearest(rect.center()), rect);
        let (away, spread) = away.map_or((DVec2::ZERO, 1.0), |cone| (cone.toward(), cone.spread()));
        let all = rect_of(&Cells::all(self.field.lattice().extent()), self.field.lattice());
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

    /// Visits what a part, in which these layers can count, is divided into and can have a value below
    /// `limit`, until `visit` returns true. Returns whether it did.
    #[inline]
    pub fn divide(
        &self,
        known: &mut KnownSquares,
        (part, counting): (&Part, Counting),
        limit: f64,
        mut visit: impl FnMut(f64, Part) -> bool,
    ) -> bool {
        let mut offer = |found: Option<(f64, Part)>| found.is_some_and(|(bound, part)| visit(bound, part));
        let halves = |cells: Cells, cut: Option<Cut>| cut.map(|cut| cells.divided(cut));
        let halves = match part.area {
            Area::Square(square) if square.bits > self.finest => {
                return square
                    .quarters()
                    .into_iter()
                    .any(|quarter| offer(self.square(known, quarter, limit)));
            }
            Area::Square(square) => square
                .cells(self.field.lattice().extent())
                .and_then(|cells| halves(cells, self.field.diameters(self.paint, &cells, counting).1)),
            Area::Cells(cells, cut) => halves(cells, cut),
        };
        halves.into_iter().flatten().any(|cells| offer(self.cells(cells, counting, limit)))
    }

    /// Whether a cell, at distance d from the place, has h + g d < `length`. Cells at the place itself must
    /// be known to have no h below.
    fn any_below(&self, known: &mut KnownSquares, length: f64) -> bool {
        let mut parts = BestFirst::default();
        let h_min = self.field.spec().transfer.h_min;
        let offer = |bound: f64, part: Part, parts: &mut BestFirst<Part>| {
            if part.greatest + self.slope * part.distance < length {
                return true;
            }
            parts.push(bound, part);
            false
        };
        for square in self.start(h_min, length) {
            if self.square(known, square, length).is_some_and(|(bound, part)| offer(bound, part, &mut parts))
            {
                return true;
            }
        }
        for _ in 0..MOST_COMPARED {
            let Some((_, part)) = parts.pop() else { return false };
            let Some(counting) = self.steep(known, &part) else { continue };
            if self.divide(known, (&part, counting), length, |bound, part| offer(bound, part, &mut parts)) {
                return true;
            }
        }
        false
    }
}

/// Binary logarithm of a quarter of the side of a shape that fits a rectangle of the lattice.
pub fn quarter_bits([min, max]: [[i64; 2]; 2]) -> u32 {
    let side = (max[0] - min[0]).max(max[1] - min[1]).max(1);
    (side as u64).ilog2().saturating_sub(2).max(LEAST_BITS)
}

/// Whether a cell of the lattice, at distance d from the closed triangle, has h + g d < `length`. Cells that
/// touch the triangle must be known to have no h below.
pub fn any_below(
    field: &SizeField,
    paint: &PaintLayers,
    known: &mut KnownSquares,
    corners: [LatticePoint; 3],
    slope: f64,
    length: f64,
) -> bool {
    let place = TriangleInWorld::new(corners, field.lattice());
    // Many pixels can be equally far from a side of the triangle; cells are then divided at pixels.
    let finest = quarter_bits(Octagon::triangle(corners).bounds()).max(field.pixel_bits(paint));
    Search { field, paint, place, slope, finest }.any_below(known, length)
}

/// The least h + g d over the lattice, at distance d from a point in world units, and the place from which it
/// comes; `start` is a value that is known, and its place.
pub fn least(
    field: &SizeField,
    paint: &PaintLayers,
    known: &mut KnownSquares,
    point: DVec2,
    (slope, accuracy): (f64, Accuracy),
    start: (f64, DVec2),
) -> (f64, DVec2) {
    let h_min = field.spec().transfer.h_min;
    if start.0 <= h_min {
        return start;
    }
    let origin = field.lattice().bounds().min;
    let place = Point(point - origin);
    let finest = field.pixel_bits(paint).max(LEAST_BITS);
    let search = Search { field, paint, place, slope, finest };
    let (mut best, mut parts) = (start, BestFirst::default());
    for square in search.start(h_min, start.0) {
        if let Some((bound, part)) = search.square(known, square, best.0 * (1.0 - TIGHT)) {
            parts.push(bound, part);
        }
    }
    for number in 0..MOST_READ {
        let Some((bound, part)) = parts.pop() else { break };
        if bound >= best.0 * (1.0 - accuracy.tolerance(number)) {
            break;
        }
        let is_one = part.least == part.greatest;
        let center = part.rect.center();
        // One value all over counts at the nearest place.
        let at = if is_one { search.place.0.clamp(part.rect.min, part.rect.max) } else { center };
        let carried = slope * at.distance(search.place.0);
        if part.least + carried < best.0 {
            let value = field.ungraded_at(paint, origin + center).0 + carried;
            if value < best.0 {
                best = (value, origin + at);
            }
        }
        if is_one {
            continue;
        }
        let Some(counting) = search.steep(known, &part) else { continue };
        let limit = best.0 * (1.0 - TIGHT);
        search.divide(known, (&part, counting), limit, |bound, part| {
            parts.push(bound, part);
            false
        });
    }
    best
}

/// What bounds of h̄ are put farther by, as a share: sums of distances are rounded.
const MARGIN: f64 = 2e-7;

/// The number of rectangles in which [`graded_bounds`] looks at most.
const MOST_BOUNDED: usize = 24;

/// Bounds of h̄ over all points of some cells, from those before gradation, `[least, greatest]`.
///
/// It ends when `is_enough` says so of the bounds of the least h̄, or after a few rectangles: the bounds
/// hold at any time.
pub fn graded_bounds(
    field: &SizeField,
    paint: &PaintLayers,
    known: &mut KnownSquares,
    cells: &Cells,
    slope: f64,
    [least, greatest]: [f64; 2],
    is_enough: impl Fn([f64; 2]) -> bool,
) -> [f64; 2] {
    let place = rect_of(cells, field.lattice());
    let (center, half_diagonal) = (place.center(), 0.5 * place.size().length());
    let finest = quarter_bits([cells.min, cells.max]);
    let search = Search { field, paint, place, slope, finest };
    let mut parts = BestFirst::default();
    // The least h̄ is from `low` to `low_most`, and every h̄ is at most `high`.
    let (mut low_most, mut high) = (greatest, greatest);
    let offer = |found: Option<(f64, Part)>, parts: &mut BestFirst<Part>, ends: [&mut f64; 2]| {
        let Some((bound, part)) = found else { return };
        let [low_most, high] = ends;
        let nearest = center.clamp(part.rect.min, part.rect.max);
        *low_most = low_most.min(part.greatest + slope * part.distance);
        *high = high.min(part.greatest + slope * (nearest.distance(center) + half_diagonal));
        parts.push(bound, part);
    };
    for square in search.start(field.spec().transfer.h_min, least) {
        offer(search.square(known, square, least), &mut parts, [&mut low_most, &mut high]);
    }
    let mut low = least;
    for _ in 0..MOST_BOUNDED {
        let Some((bound, part)) = parts.pop() else {
            low = least;
            break;
        };
        low = bound.min(least);
        let Area::Square(square) = part.area else { break };
        if square.bits <= finest || is_enough([low, low_most]) {
            break;
        }
        // Places of the cells themselves are known to have at least `least`.
        if search.steep(known, &part).is_none() {
            continue;
        }
        for quarter in square.quarters() {
            offer(search.square(known, quarter, least), &mut parts, [&mut low_most, &mut high]);
        }
    }
    let [h_min, h_max] = [field.spec().transfer.h_min, field.spec().transfer.h_max];
    [(low * (1.0 - MARGIN)).max(h_min), (high * (1.0 + MARGIN)).min(h_max)]
}
