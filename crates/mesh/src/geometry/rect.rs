use glam::DVec2;

/// An axis-parallel rectangle in world units, closed on all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Lower left corner.
    pub min: DVec2,
    /// Upper right corner.
    pub max: DVec2,
}

impl Rect {
    /// Shortest side of a proper rectangle, so that areas and ratios of lengths are finite and not zero.
    pub const SHORTEST_SIDE: f64 = 1e-120;
    /// Longest side of a proper rectangle, and its farthest coordinate.
    pub const LONGEST_SIDE: f64 = 1e150;
    /// What [`Self::is_proper`] asks for, as a part of a sentence.
    pub const PROPER: &str = "finite numbers, x0 less than x1 and y0 less than y1, sides between 1e-120 and 1e150 and no \
                              coordinate beyond ±1e150";

    /// Returns the rectangle with the given lower left and upper right corners.
    pub const fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }

    /// The unit square, the domain of the body of the report.
    pub const UNIT: Self = Self::new(DVec2::ZERO, DVec2::ONE);

    /// Returns the smallest rectangle that holds both points.
    pub fn spanning(a: DVec2, b: DVec2) -> Self {
        Self::new(a.min(b), a.max(b))
    }

    /// Returns the smallest rectangle that holds all points; `None` without points.
    pub fn holding(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        points.into_iter().map(|point| Self::new(point, point)).reduce(|a, b| a.union(&b))
    }

    /// Returns the square of half side `radius` about `centre`.
    pub fn around(centre: DVec2, radius: f64) -> Self {
        Self::new(centre - DVec2::splat(radius), centre + DVec2::splat(radius))
    }

    /// Returns the width and height.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Returns the point in the middle.
    pub fn center(&self) -> DVec2 {
        self.min + 0.5 * self.size()
    }

    /// Returns whether the point lies in the closed rectangle. False for NaN.
    pub fn contains(&self, p: DVec2) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Returns the smallest rectangle that holds this one and `other`.
    pub fn union(&self, other: &Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// Returns the common part, or `None` where the two do not meet.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let common = Self::new(self.min.max(other.min), self.max.min(other.max));
        common.min.cmple(common.max).all().then_some(common)
    }

    /// This rectangle with every side moved outwards by `margin`.
    pub fn expanded(&self, margin: f64) -> Self {
        Self::new(self.min - DVec2::splat(margin), self.max + DVec2::splat(margin))
    }

    /// Returns whether calculations with the rectangle stay within f64: both sides are from
    /// [`Self::SHORTEST_SIDE`] to [`Self::LONGEST_SIDE`], and no coordinate is farther from 0 than that. All
    /// rectangles that are read are checked with this.
    pub fn is_proper(&self) -> bool {
        let size = self.size();
        let reach = self.min.abs().max(self.max.abs());
        size.min_element() >= Self::SHORTEST_SIDE
            && size.max_element() <= Self::LONGEST_SIDE
            && reach.max_element() <= Self::LONGEST_SIDE
            && !size.is_nan()
    }
}
