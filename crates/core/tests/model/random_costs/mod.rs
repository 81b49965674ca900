//! Random cost densities, and least costs by other means.

use std::collections::BinaryHeap;

use glam::{DVec2, dvec2};
use meshbrush_core::path::{CostDensity, CostRange};
use meshbrush_mesh::geometry::Rect;

/// A smooth positive function of the distance from a centre.
pub struct Radial {
    centre: DVec2,
    constant: f64,
    /// Amplitude, frequency and phase.
    waves: Vec<[f64; 3]>,
}

impl Radial {
    fn value(&self, r: f64) -> f64 {
        self.constant + self.waves.iter().map(|[a, f, p]| a * (f * r + p).sin()).sum::<f64>()
    }

    fn slope(&self, r: f64) -> f64 {
        self.waves.iter().map(|[a, f, p]| a * f * (f * r + p).cos()).sum()
    }

    /// Returns the greatest n-th derivative.
    fn steepest(&self, n: i32) -> f64 {
        self.waves.iter().map(|[a, f, _]| a.abs() * f.powi(n)).sum()
    }

    /// Returns the least and greatest distance of a rectangle from the centre.
    fn distances(&self, rectangle: &Rect) -> [f64; 2] {
        let (min, max) = (rectangle.min - self.centre, rectangle.max - self.centre);
        [DVec2::ZERO.clamp(min, max).length(), min.abs().max(max.abs()).length()]
    }
}

impl CostDensity for Radial {
    fn at(&self, point: DVec2) -> f64 {
        self.value(point.distance(self.centre))
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let [near, far] = self.distances(rectangle);
        let middle = self.value(0.5 * (near + far));
        let change = 0.5 * (far - near) * self.steepest(1) + 1e-13;
        CostRange { least: middle - change, greatest: middle + change }
    }

    fn derivatives(&self, rectangle: &Rect) -> Option<[CostRange; 2]> {
        let [near, far] = self.distances(rectangle);
        let middle = self.slope(0.5 * (near + far));
        let change = 0.5 * (far - near) * self.steepest(2) + 1e-13;
        // x / r over the rectangle.
        let direction = |axis: usize| {
            let ends = [rectangle.min[axis], rectangle.max[axis]].map(|x| x - self.centre[axis]);
            let shares = ends.into_iter().flat_map(|x| [x / near, x / far]);
            shares.fold([1f64, -1f64], |[least, most], share| [least.min(share), most.max(share)])
        };
        let along = |axis: usize| {
            let products =
                direction(axis).map(|share| [share * (middle - change), share * (middle + change)]);
            let least = products.iter().flatten().fold(f64::INFINITY, |least, &one| least.min(one));
            let greatest = products.iter().flatten().fold(f64::NEG_INFINITY, |most, &one| most.max(one));
            CostRange { least: least - 1e-13, greatest: greatest + 1e-13 }
        };
        Some([along(0), along(1)])
    }
}

/// A path of least cost for a radial density in the unit square.
///
/// With ρ = ln r and u = r c(r), the cost of a path in (ρ, θ) is ∫ u ds. T = pθ + ∫ √(u² − p²) dρ has
/// |∇T| = u wherever u > p, so no path from start to goal costs less than the difference of T, and the path
/// that follows ∇T costs just that.
pub struct RadialPath {
    pub density: Radial,
    pub path: Vec<DVec2>,
    pub exact: f64,
}

impl RadialPath {
    /// Tries until the path stays in the square.
    pub fn random(seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        // Ends: about every third try fits.
        loop {
            // The centre lies outside the square, so that θ is unique.
            let centre = dvec2(-0.3 - random.f64(), random.f64());
            let waves: Vec<[f64; 3]> =
                (0..3).map(|_| [random.f64() - 0.5, 2.0 + 12.0 * random.f64(), 6.3 * random.f64()]).collect();
            let constant = waves.iter().map(|wave| wave[0].abs()).sum::<f64>() + 0.1 + random.f64();
            let density = Radial { centre, constant, waves };
            if let Some(path) = Self::follow(density, &mut random) {
                return path;
            }
        }
    }

    fn follow(density: Radial, random: &mut fastrand::Rng) -> Option<Self> {
        const STEPS: usize = 20_000;
        let corners = [DVec2::ZERO, dvec2(1.0, 0.0), dvec2(0.0, 1.0), DVec2::ONE];
        let farthest = corners.iter().map(|corner| corner.distance(density.centre)).fold(0.0, f64::max);
        let nearest = -density.centre.x;
        let least = (0..=2000).map(|i| nearest + (farthest - nearest) * f64::from(i) / 2000.0);
        let least = least.map(|r| r * density.value(r)).fold(f64::INFINITY, f64::min);
        // A little less, since the least was found on a grid.
        let p = 0.98 * least * (2.0 * random.f64() - 1.0);
        let (first, last) = (nearest + 0.15, nearest + 0.15 + 0.6 * random.f64() + 0.1);
        let step = (last - first) / STEPS as f64;
        let mut angle = 0.5 * (random.f64() - 0.5);
        let (mut exact, begin) = (0.0, angle);
        let point = |r: f64, angle: f64| density.centre + r * dvec2(angle.cos(), angle.sin());
        let mut path = vec![point(first, angle)];
        for i in 0..STEPS {
            // The midpoint rule: the error is of the order of 1e-9.
            let r = first + step * (i as f64 + 0.5);
            let u = r * density.value(r);
            let root = (u * u - p * p).sqrt();
            angle += step * p / (r * root);
            exact += step * root / r;
            if (i + 1) % 50 == 0 {
                path.push(point(first + step * (i + 1) as f64, angle));
            }
        }
        let exact = exact + p * (angle - begin);
        let fits = path.iter().all(|&point| Rect::UNIT.expanded(-0.01).contains(point));
        fits.then_some(Self { density, path, exact })
    }
}

/// Square cells of the unit square, each with one cost.
pub struct Cells {
    side: usize,
    costs: Vec<f64>,
}

impl Cells {
    pub fn random(side: usize, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        Self { side, costs: (0..side * side).map(|_| 1.0 + 4.0 * random.f64()).collect() }
    }

    /// Returns the cells that have a coordinate, in one direction.
    fn columns(&self, from: f64, to: f64) -> std::ops::RangeInclusive<usize> {
        let last = self.side as f64 - 1.0;
        let [from, to] = [from, to].map(|x| x * self.side as f64);
        // A coordinate on a line belongs to both sides.
        let first = (from.ceil() - 1.0).clamp(0.0, last);
        first as usize..=to.floor().clamp(first, last) as usize
    }

    fn cost(&self, column: usize, row: usize) -> f64 {
        self.costs[row * self.side + column]
    }

    /// Returns the cheapest way from point to point within cells, over `count` points on each side of each
    /// cell.
    pub fn best_path(&self, start: DVec2, goal: DVec2, count: usize) -> (Vec<DVec2>, f64) {
        let mut points = vec![start, goal];
        let side = self.side as f64;
        for line in 0..=self.side {
            for part in 0..=self.side * count {
                let [fixed, along] = [line as f64 / side, part as f64 / (side * count as f64)];
                points.push(dvec2(fixed, along));
                points.push(dvec2(along, fixed));
            }
        }
        let mut within = vec![Vec::new(); self.side * self.side];
        for (index, point) in points.iter().enumerate() {
            for row in self.columns(point.y, point.y) {
                for column in self.columns(point.x, point.x) {
                    within[row * self.side + column].push(index);
                }
            }
        }
        self.dijkstra(&points, &within)
    }

    fn dijkstra(&self, points: &[DVec2], within: &[Vec<usize>]) -> (Vec<DVec2>, f64) {
        let mut costs = vec![f64::INFINITY; points.len()];
        let mut before = vec![0; points.len()];
        let mut open = BinaryHeap::from([(std::cmp::Reverse(0), 0)]);
        costs[0] = 0.0;
        // Positive numbers are in the order of their bits.
        while let Some((std::cmp::Reverse(bits), index)) = open.pop() {
            let cost = f64::from_bits(bits);
            if cost > costs[index] {
                continue;
            }
            let point = points[index];
            for row in self.columns(point.y, point.y) {
                for column in self.columns(point.x, point.x) {
                    for &next in &within[row * self.side + column] {
                        let there = cost + self.cost(column, row) * point.distance(points[next]);
                        if there < costs[next] {
                            (costs[next], before[next]) = (there, index);
                            open.push((std::cmp::Reverse(there.to_bits()), next));
                        }
                    }
                }
            }
        }
        let mut path = vec![points[1]];
        let mut at = 1;
        while at != 0 {
            at = before[at];
            path.push(points[at]);
        }
        path.reverse();
        (path, costs[1] * (1.0 + 1e-12))
    }
}

impl CostDensity for Cells {
    fn at(&self, point: DVec2) -> f64 {
        self.range(&Rect::new(point, point)).least
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let mut range = CostRange { least: f64::INFINITY, greatest: 0.0 };
        for row in self.columns(rectangle.min.y, rectangle.max.y) {
            for column in self.columns(rectangle.min.x, rectangle.max.x) {
                let cost = self.cost(column, row);
                range = range.union(CostRange { least: cost, greatest: cost });
            }
        }
        range
    }
}
