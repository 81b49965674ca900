use glam::DVec2;

/// A triangle in world coordinates, with the gradients of its barycentric coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatTriangle {
    pub corners: [DVec2; 3],
    /// Gradients of the barycentric coordinates.
    slopes: [DVec2; 3],
}

/// An affine function of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AffineFunction {
    /// The value at `origin`.
    pub value: f64,
    pub slope: DVec2,
    pub origin: DVec2,
}

impl AffineFunction {
    pub(super) fn at(&self, point: DVec2) -> f64 {
        self.value + self.slope.dot(point - self.origin)
    }
}

impl FlatTriangle {
    pub(super) fn new(corners: [DVec2; 3]) -> Self {
        let [a, b, c] = corners;
        let twice_area = (b - a).perp_dot(c - a);
        let slopes = [(b, c), (c, a), (a, b)].map(|(from, to)| (to - from).perp() / twice_area);
        Self { corners, slopes }
    }

    /// Returns the length of the longest side.
    pub(super) fn diameter(&self) -> f64 {
        let [a, b, c] = self.corners;
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// Returns the triangle without the points that are nearer to an edge than `inset`, or half of it if that
    /// is less: all edges move towards the centre of the inscribed circle.
    pub(super) fn shrunk(&self, inset: f64) -> Self {
        let [a, b, c] = self.corners;
        let sides = [b.distance(c), c.distance(a), a.distance(b)];
        let round = sides.iter().sum::<f64>();
        let center = self.point(sides.map(|side| side / round));
        let radius = (b - a).perp_dot(c - a).abs() / round;
        let share = (inset / radius).min(0.5);
        Self::new(self.corners.map(|corner| corner + share * (center - corner)))
    }

    pub(super) fn centroid(&self) -> DVec2 {
        self.corners.iter().sum::<DVec2>() / 3.0
    }

    /// Returns the point with the given barycentric coordinates.
    pub(super) fn point(&self, barycentric: [f64; 3]) -> DVec2 {
        self.corners.iter().zip(barycentric).map(|(&corner, share)| corner * share).sum()
    }

    /// Returns the barycentric coordinates of a point. They sum to 1, but for rounding.
    pub(super) fn barycentric(&self, point: DVec2) -> [f64; 3] {
        let [a, ..] = self.corners;
        let [_, second, third] = self.slopes.map(|slope| slope.dot(point - a));
        [1.0 - second - third, second, third]
    }
}
