//! Paths whose least cost is known.
//!
//! For a holomorphic f the density |f′| has the distance |f(a) − f(b)|, as long as the segment between the
//! images lies in the image of the domain. Two half-planes obey Snell's law. With density 1 and a hole the
//! shortest path is a string pulled tight.

use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::path::{CostDensity, CostRange, Placement, PlacementTest};
use meshbrush_mesh::geometry::Rect;

/// A density with a known least cost between two points of [`square`].
pub struct ExactPath {
    pub name: &'static str,
    pub density: Arc<dyn CostDensity>,
    /// Where paths may go.
    pub placement: PlacementTest,
    pub exact: f64,
    /// The best path, from the start to the goal.
    pub path: Vec<DVec2>,
}

/// Returns the domain.
pub fn square() -> Rect {
    Rect::around(DVec2::ZERO, 2.0)
}

#[derive(Clone, Copy)]
enum Kind {
    One,
    /// 1/rⁿ.
    Power(i32),
    /// e^x.
    Exponential,
    /// 1 left of a line through the origin, and 3 right of it; the unit normal to the right is given.
    HalfPlanes(DVec2),
}

/// Powers and exponentials of the standard library are no part of what is tested: a margin covers them.
const MARGIN: f64 = 1e-14;

fn range(a: f64, b: f64) -> CostRange {
    let (least, greatest) = (a.min(b), a.max(b));
    CostRange { least: least - MARGIN * least.abs(), greatest: greatest + MARGIN * greatest.abs() }
}

/// Returns the least and greatest distance of a rectangle from the origin.
fn distances(rectangle: &Rect) -> [f64; 2] {
    let nearest = DVec2::ZERO.clamp(rectangle.min, rectangle.max);
    [nearest.length(), rectangle.min.abs().max(rectangle.max.abs()).length()]
}

fn corners(rectangle: &Rect) -> [DVec2; 4] {
    let Rect { min, max } = *rectangle;
    [min, max, dvec2(min.x, max.y), dvec2(max.x, min.y)]
}

impl CostDensity for Kind {
    fn at(&self, point: DVec2) -> f64 {
        match *self {
            Self::One => 1.0,
            Self::Power(n) => point.length().powi(-n),
            Self::Exponential => point.x.exp(),
            Self::HalfPlanes(normal) => {
                if point.dot(normal) <= 0.0 {
                    1.0
                } else {
                    3.0
                }
            }
        }
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        match *self {
            Self::One => CostRange { least: 1.0, greatest: 1.0 },
            Self::Power(n) => {
                let [near, far] = distances(rectangle).map(|r| r.powi(-n));
                range(near, far)
            }
            Self::Exponential => range(rectangle.min.x.exp(), rectangle.max.x.exp()),
            Self::HalfPlanes(_) => {
                let [a, b, c, d] = corners(rectangle).map(|corner| self.at(corner));
                CostRange { least: a.min(b).min(c).min(d), greatest: a.max(b).max(c).max(d) }
            }
        }
    }

    fn derivatives(&self, rectangle: &Rect) -> Option<[CostRange; 2]> {
        let none = CostRange { least: 0.0, greatest: 0.0 };
        match *self {
            Self::One => Some([none; 2]),
            Self::Exponential => Some([self.range(rectangle), none]),
            Self::Power(n) => {
                let [near, far] = distances(rectangle);
                if near == 0.0 {
                    return None;
                }
                // ∂ r⁻ⁿ / ∂x = −n x r⁻ⁿ⁻²
                let factors = [near, far].map(|r| -f64::from(n) * r.powi(-n - 2));
                let along = |from: f64, to: f64| {
                    let products = [from, to].map(|x| factors.map(|factor| range(x * factor, x * factor)));
                    products.into_iter().flatten().reduce(CostRange::union)
                };
                Some([along(rectangle.min.x, rectangle.max.x)?, along(rectangle.min.y, rectangle.max.y)?])
            }
            Self::HalfPlanes(_) => None,
        }
    }
}

fn anywhere() -> PlacementTest {
    Arc::new(|_| Placement::Inside)
}

/// Returns the path whose image is the segment from `from` to `to`.
fn path_of_segment(from: DVec2, to: DVec2, back: impl Fn(DVec2) -> DVec2) -> Vec<DVec2> {
    (0..=400).map(|i| back(from.lerp(to, f64::from(i) / 400.0))).collect()
}

fn polar(radius: f64, angle: f64) -> DVec2 {
    radius * dvec2(angle.cos(), angle.sin())
}

fn logarithm(z: DVec2) -> DVec2 {
    dvec2(z.length().ln(), z.y.atan2(z.x))
}

/// zⁿ, with the angle of z in (−π, π].
fn power(z: DVec2, n: f64) -> DVec2 {
    polar(z.length().powf(n), n * z.y.atan2(z.x))
}

fn holomorphic(
    name: &'static str,
    kind: Kind,
    [start, goal]: [DVec2; 2],
    image: impl Fn(DVec2) -> DVec2,
    back: impl Fn(DVec2) -> DVec2,
) -> ExactPath {
    let (from, to) = (image(start), image(goal));
    let mut path = path_of_segment(from, to, back);
    let last = path.len() - 1;
    (path[0], path[last]) = (start, goal);
    let exact = from.distance(to);
    ExactPath { name, density: Arc::new(kind), placement: anywhere(), exact, path }
}

/// Snell's law: the crossing of the line between the half-planes that costs least, by ternary search.
fn half_planes(name: &'static str, normal: DVec2, start: DVec2, goal: DVec2) -> ExactPath {
    let crossing = |along: f64| along * normal.perp();
    let cost = |along: f64| start.distance(crossing(along)) + 3.0 * goal.distance(crossing(along));
    let (mut low, mut high) = (-2.0, 2.0);
    for _ in 0..200 {
        let [a, b] = [(2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0];
        if cost(a) < cost(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let path = vec![start, crossing(low), goal];
    let density = Arc::new(Kind::HalfPlanes(normal));
    ExactPath { name, density, placement: anywhere(), exact: cost(low), path }
}

fn length(path: &[DVec2]) -> f64 {
    path.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Around the square [−½, ½]².
fn square_hole() -> ExactPath {
    let (start, goal) = (dvec2(-1.3, 0.2), dvec2(1.4, 0.3));
    let path = vec![start, dvec2(-0.5, 0.5), dvec2(0.5, 0.5), goal];
    let placement: PlacementTest = Arc::new(|element| {
        let inner = element.world_corners().iter().sum::<DVec2>() / 3.0;
        // Cells follow the hole.
        if inner.abs().max_element() < 0.5 { Placement::Outside } else { Placement::Inside }
    });
    ExactPath { name: "square hole", density: Arc::new(Kind::One), placement, exact: length(&path), path }
}

/// Around the disc of radius 0.6.
fn disc_hole() -> ExactPath {
    const RADIUS: f64 = 0.6;
    let (start, goal) = (dvec2(-1.3, 0.2), dvec2(1.4, 0.3));
    let tangent = |p: DVec2| (p.length_squared() - RADIUS * RADIUS).sqrt();
    let turned = |p: DVec2| (RADIUS / p.length()).acos();
    let (first, last) = (start.y.atan2(start.x) - turned(start), goal.y.atan2(goal.x) + turned(goal));
    let arc = (0..=200).map(|i| polar(RADIUS, first + (last - first) * f64::from(i) / 200.0));
    let path = std::iter::once(start).chain(arc).chain([goal]).collect();
    let exact = tangent(start) + tangent(goal) + RADIUS * (first - last);
    let placement: PlacementTest = Arc::new(|element| {
        let corners = element.world_corners();
        let inside = corners.iter().filter(|corner| corner.length() < RADIUS).count();
        match inside {
            3 => Placement::Outside,
            0 => Placement::Inside,
            _ => Placement::Cut,
        }
    });
    ExactPath { name: "disc hole", density: Arc::new(Kind::One), placement, exact, path }
}

/// Returns all problems whose exact path is known.
pub fn exact_paths() -> Vec<ExactPath> {
    let straight = [dvec2(-1.3, -0.7), dvec2(1.4, 0.9)];
    let inverse = |z: DVec2| power(z, -1.0);
    let degrees = |angle: f64| angle.to_radians();
    vec![
        holomorphic("1", Kind::One, straight, |z| z, |w| w),
        half_planes("half-planes along the mesh", dvec2(1.0, 0.0), straight[0], straight[1]),
        half_planes("oblique half-planes", polar(1.0, 0.3), straight[0], straight[1]),
        square_hole(),
        disc_hole(),
        holomorphic("1/r", Kind::Power(1), [dvec2(1.0, -0.6), dvec2(-0.3, 0.9)], logarithm, |w| {
            polar(w.x.exp(), w.y)
        }),
        holomorphic("1/r²", Kind::Power(2), [dvec2(0.6, -0.5), dvec2(0.4, 0.6)], inverse, inverse),
        holomorphic(
            "1/r⁴",
            Kind::Power(4),
            [polar(1.0, degrees(-15.0)), polar(0.9, degrees(15.0))],
            |z| power(z, -3.0) / 3.0,
            |w| power(3.0 * w, -1.0 / 3.0),
        ),
        holomorphic(
            "e^x",
            Kind::Exponential,
            [dvec2(0.3, -1.1), dvec2(0.7, 1.0)],
            |z| polar(z.x.exp(), z.y),
            logarithm,
        ),
    ]
}
