use super::{Lattice, LatticePoint, Rect};

/// An axis-parallel rectangle with corners on the lattice, closed on all sides; it may be a segment or a
/// point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeRect {
    /// Lower left corner.
    pub min: LatticePoint,
    /// Upper right corner.
    pub max: LatticePoint,
}

impl LatticeRect {
    /// Returns the smallest rectangle that contains both.
    pub fn union(&self, other: &Self) -> Self {
        let ([a, b], [c, d]) = ([self.min, self.max], [other.min, other.max]);
        Self {
            min: LatticePoint::new(a.x.min(c.x), a.y.min(c.y)),
            max: LatticePoint::new(b.x.max(d.x), b.y.max(d.y)),
        }
    }

    /// Returns whether the rectangles have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        let ([a, b], [c, d]) = ([self.min, self.max], [other.min, other.max]);
        a.x <= d.x && c.x <= b.x && a.y <= d.y && c.y <= b.y
    }

    /// This rectangle with every side moved outwards by `steps`, as far as the lattice goes.
    pub fn expanded(&self, steps: u32, extent: LatticePoint) -> Self {
        let Self { min, max } = *self;
        Self {
            min: LatticePoint::new(min.x.saturating_sub(steps), min.y.saturating_sub(steps)),
            max: LatticePoint::new((max.x + steps).min(extent.x), (max.y + steps).min(extent.y)),
        }
    }

    /// Returns whether the rectangle and a closed triangle of a mesh have a point in common.
    ///
    /// The edges of such a triangle run along axes and diagonals of the lattice, so that the two meet when
    /// their extents along x, y, x + y and x − y do: one of these is always a separating axis if there is
    /// one.
    #[inline]
    pub fn touches(&self, corners: [LatticePoint; 3]) -> bool {
        let (x, y) = (corners.map(|c| i64::from(c.x)), corners.map(|c| i64::from(c.y)));
        let [x0, y0, x1, y1] = [self.min.x, self.min.y, self.max.x, self.max.y].map(i64::from);
        meets(x, x0, x1)
            && meets(y, y0, y1)
            && meets([x[0] + y[0], x[1] + y[1], x[2] + y[2]], x0 + y0, x1 + y1)
            && meets([x[0] - y[0], x[1] - y[1], x[2] - y[2]], x0 - y1, x1 - y0)
    }
}

#[inline]
fn meets([a, b, c]: [i64; 3], low: i64, high: i64) -> bool {
    a.min(b).min(c) <= high && low <= a.max(b).max(c)
}

impl Lattice {
    /// Returns the smallest rectangle of the lattice around the part of `area` (in world units) that lies in
    /// the bounds; `None` where nothing does.
    pub fn rect_around(&self, area: &Rect) -> Option<LatticeRect> {
        let common = area.intersection(&self.bounds())?;
        let (min, max) =
            (self.lattice_from_world(common.min).floor(), self.lattice_from_world(common.max).ceil());
        let point = |p: glam::DVec2| LatticePoint::new(p.x as u32, p.y as u32);
        Some(LatticeRect { min: point(min), max: point(max) })
    }
}
