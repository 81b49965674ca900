//! The distance to points, lines and polygons.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use super::Mask;
use super::engine::convex::Convex;
use crate::domain::{BoundaryMarks, CutShape, Domain, Polygon, Region, RegionError, coasts};
use crate::earth::{Reprojection, projected_line, projected_polygons};
use crate::field::Bounds;
use crate::geometry::{BoxTree, Rect, nearest_on_segment};

/// Points, lines and polygons, in world units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeList {
    /// Single points.
    pub points: Vec<DVec2>,
    /// Polylines, each with two points or more.
    pub lines: Vec<Vec<DVec2>>,
    /// Polygons: an outer ring, then the rings of its holes.
    pub polygons: Vec<Polygon>,
}

impl ShapeList {
    /// Returns the shapes in the plane of a projection.
    pub fn projected(&self, reprojection: &Reprojection) -> Self {
        Self {
            points: self.points.iter().map(|&point| reprojection.in_plane(point)).collect(),
            lines: self.lines.iter().map(|line| projected_line(line, reprojection)).collect(),
            polygons: projected_polygons(&self.polygons, reprojection),
        }
    }

    /// Returns whether there is nothing to be near to.
    pub fn is_empty(&self) -> bool {
        self.segments().next().is_none()
    }

    /// Returns the shapes with an area added: one area where it meets polygons.
    ///
    /// # Errors
    /// Fails when the area is none, or the polygons are too complex.
    pub fn with_area(mut self, shape: &CutShape) -> Result<Self, RegionError> {
        match Mask::new(&self.polygons) {
            Ok(mask) => self.polygons = mask.with(shape)?.polygons().to_vec(),
            // Polygons without an area are lines, and stay.
            Err(RegionError::NoArea) => self.polygons.extend_from_slice(Mask::of_shape(shape)?.polygons()),
            Err(error) => return Err(error),
        }
        Ok(self)
    }

    /// Returns the parts of the shapes that are outside of an area.
    ///
    /// # Errors
    /// Fails when the area is none, or the polygons are too complex.
    pub fn without_area(mut self, shape: &CutShape) -> Result<Self, RegionError> {
        let cut = Mask::of_shape(shape)?;
        match Mask::new(&self.polygons) {
            Ok(mask) => {
                let left = mask.without(shape)?;
                self.polygons = left.map_or_else(Vec::new, |left| left.polygons().to_vec());
            }
            Err(RegionError::NoArea) => {}
            Err(error) => return Err(error),
        }
        self.points.retain(|&point| !cut.contains(point));
        self.lines = self.lines.iter().flat_map(|line| parts_outside(line, &cut)).collect();
        Ok(self)
    }

    /// Returns the memory, in bytes.
    fn bytes(&self) -> usize {
        let points = |points: &Vec<DVec2>| size_of_val(points) + size_of_val(&**points);
        let rings = |polygon: &Polygon| size_of_val(polygon) + polygon.iter().map(points).sum::<usize>();
        let lines: usize = self.lines.iter().map(points).sum();
        points(&self.points) + lines + self.polygons.iter().map(rings).sum::<usize>()
    }

    /// Points as segments of length 0, then the edges of lines and rings.
    fn segments(&self) -> impl Iterator<Item = [DVec2; 2]> {
        let points = self.points.iter().map(|&p| [p, p]);
        let lines = self.lines.iter().flat_map(|line| line.windows(2).map(|ends| [ends[0], ends[1]]));
        let rings = self.polygons.iter().flatten();
        let edges = rings.flat_map(|ring| (0..ring.len()).map(|n| [ring[n], ring[(n + 1) % ring.len()]]));
        points.chain(lines).chain(edges)
    }
}

/// Returns the parts of a polyline that are outside of an area, in their order.
fn parts_outside(line: &[DVec2], area: &Mask) -> Vec<Vec<DVec2>> {
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    let mut goes_on = false;
    for ends in line.windows(2) {
        for piece in pieces(ends[0], ends[1], area).windows(2) {
            if area.contains(piece[0].midpoint(piece[1])) {
                goes_on = false;
                continue;
            }
            match parts.last_mut().filter(|_| goes_on) {
                Some(part) => part.push(piece[1]),
                None => parts.push(piece.to_vec()),
            }
            goes_on = true;
        }
    }
    parts
}

/// Returns the ends of a segment and the places between them where it crosses the edges of an area, in order.
fn pieces(a: DVec2, b: DVec2, area: &Mask) -> Vec<DVec2> {
    let mut shares = vec![0.0, 1.0];
    if Rect::spanning(a, b).intersection(&area.bounds()).is_some() {
        shares.extend(area.region().edges().filter_map(|[from, to]| {
            let (along, edge) = (b - a, to - from);
            let turn = along.perp_dot(edge);
            let (share, on_edge) = ((from - a).perp_dot(edge) / turn, (from - a).perp_dot(along) / turn);
            let crosses = share > 0.0 && share < 1.0 && (0.0..=1.0).contains(&on_edge);
            crosses.then_some(share)
        }));
        shares.sort_by(f64::total_cmp);
    }
    let mut places: Vec<DVec2> = shares.into_iter().map(|share| a.lerp(b, share)).collect();
    // The ends are not computed: they stay as they were, bit for bit.
    places[0] = a;
    *places.last_mut().expect("a segment has two ends") = b;
    places
}

/// Shapes with an index, to measure the distance to them. Clones share their data.
#[derive(Clone, Debug)]
pub struct Shapes(Arc<IndexedShapes>);

#[derive(Debug)]
struct IndexedShapes {
    list: ShapeList,
    segments: Vec<[DVec2; 2]>,
    tree: BoxTree,
    /// The area of the polygons, if the distance within them is 0.
    filled: Option<Mask>,
}

/// Why there is no distance to shapes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapesError {
    /// No point, line or ring.
    #[error("There is no point, line or polygon to measure the distance to.")]
    Empty,
    /// A coordinate is not finite.
    #[error("A shape has a point at {x}, {y}; both must be finite numbers.")]
    Place {
        /// The number as it was given.
        x: f64,
        /// The number as it was given.
        y: f64,
    },
    /// The polygons cannot be filled.
    #[error(transparent)]
    Polygons(#[from] RegionError),
}

impl PartialEq for Shapes {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &IndexedShapes, b: &IndexedShapes| {
            a.filled.is_some() == b.filled.is_some() && a.list == b.list
        };
        Arc::ptr_eq(&self.0, &other.0) || same(&self.0, &other.0)
    }
}

impl Shapes {
    /// Indexes shapes. With `filled`, the distance within a polygon is 0; otherwise it is that to its
    /// outline.
    ///
    /// # Errors
    /// Fails when there is no shape, a coordinate is not finite, or polygons that are to be filled are too
    /// complex.
    pub fn new(list: ShapeList, filled: bool) -> Result<Self, ShapesError> {
        let segments: Vec<[DVec2; 2]> = list.segments().collect();
        if let Some(p) = segments.iter().flatten().find(|p| !p.is_finite()) {
            return Err(ShapesError::Place { x: p.x, y: p.y });
        }
        if segments.is_empty() {
            return Err(ShapesError::Empty);
        }
        let boxes: Vec<Rect> = segments.iter().map(|&[a, b]| Rect::spanning(a, b)).collect();
        let tree = BoxTree::new(&boxes);
        let filled = match Mask::new(&list.polygons) {
            _ if !filled => None,
            // Polygons without an area are lines.
            Err(RegionError::NoArea) => None,
            mask => Some(mask?),
        };
        Ok(Self(Arc::new(IndexedShapes { list, segments, tree, filled })))
    }

    /// Returns the outline of a region: the distance is that to its boundary, on both sides.
    ///
    /// # Errors
    /// Fails when the region is empty.
    pub fn outline(region: &Region) -> Result<Self, ShapesError> {
        Self::new(ShapeList { polygons: region.polygons().to_vec(), ..ShapeList::default() }, false)
    }

    /// Returns polylines.
    ///
    /// # Errors
    /// Fails when there is none, or a coordinate is not finite.
    pub fn lines(lines: Vec<Vec<DVec2>>) -> Result<Self, ShapesError> {
        Self::new(ShapeList { lines, ..ShapeList::default() }, false)
    }

    /// Returns the coasts of a domain: its boundary without the parts across which water flows, as marks and
    /// the outline itself have them.
    ///
    /// # Errors
    /// Fails when there is no coast.
    pub fn coasts(domain: &Domain, marks: &BoundaryMarks) -> Result<Self, ShapesError> {
        Self::lines(coasts(domain, marks))
    }

    /// Returns the shapes as they were given.
    pub fn list(&self) -> &ShapeList {
        &self.0.list
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedShapes { list, segments, tree, filled } = &*self.0;
        let filled = filled.as_ref().map_or(0, |mask| mask.shared_data().1);
        (Arc::as_ptr(&self.0).addr(), list.bytes() + size_of_val(&**segments) + tree.bytes() + filled)
    }

    /// Returns the smallest rectangle that holds all shapes.
    pub fn extent(&self) -> Rect {
        self.0.tree.bounds().unwrap_or(Rect::new(DVec2::ZERO, DVec2::ZERO))
    }

    /// Returns the distance from a point to the nearest shape, in world units.
    pub fn distance(&self, p: DVec2) -> f64 {
        if self.covers(p) {
            return 0.0;
        }
        let squared =
            |number: u32| p.distance_squared(nearest_on_segment(p, self.0.segments[number as usize]));
        self.0.tree.nearest(p, squared).map_or(f64::INFINITY, |(_, squared)| squared.sqrt())
    }

    /// Returns the point of the shapes that is nearest to a point, both in world units.
    pub fn nearest(&self, p: DVec2) -> DVec2 {
        if self.covers(p) {
            return p;
        }
        let on = |number: u32| nearest_on_segment(p, self.0.segments[number as usize]);
        let found = self.0.tree.nearest(p, |number| p.distance_squared(on(number)));
        found.map_or(p, |(number, _)| on(number))
    }

    /// Returns bounds of the distance over a closed rectangle in world units.
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        self.bounds_within(&Convex::rect(rect.min, rect.max), None)
    }

    /// Returns bounds of the distance over a closed polygon in world units. `near` are the segments that can
    /// be nearest to a point of it, if they are known.
    pub(super) fn bounds_within(&self, place: &Convex, near: Option<&Near>) -> Bounds {
        let bounds = place.bounds();
        let (mut least, mut greatest) = (f64::INFINITY, f64::INFINITY);
        let mut look = |segment: [DVec2; 2]| {
            if squared_gap(&Rect::spanning(segment[0], segment[1]), &bounds) < least {
                let squared = place.squared_distances(segment);
                (least, greatest) = (least.min(squared[0]), greatest.min(squared[1]));
            }
        };
        match near {
            Some(near) => near.segments.iter().for_each(|&segment| look(segment)),
            None => self.visit_nearest(&bounds, &mut look),
        }
        let [least, greatest] = [least, greatest].map(f64::sqrt);
        let is_covered = || match near.and_then(|near| near.is_covered) {
            Some(is_covered) => is_covered,
            None => self.covers(place.corners()[0]),
        };
        // Where there is no segment, the polygons cover all points or none.
        if self.0.filled.is_some() && least > 0.0 && is_covered() {
            return Bounds::one(0.0);
        }
        // Rounding shifts the corners and the nearest points by a few ulps of the largest coordinate.
        let coordinate = |rect: &Rect| rect.min.abs().max(rect.max.abs()).max_element();
        let rounding = 1e-14 * coordinate(&self.extent()).max(coordinate(&bounds));
        Bounds::new((least - rounding).max(0.0), greatest + rounding)
    }

    /// Returns whether filled polygons cover a point.
    fn covers(&self, p: DVec2) -> bool {
        self.0.filled.as_ref().is_some_and(|mask| mask.contains(p))
    }

    /// Visits segments of which one is nearest to each point of a rectangle.
    fn visit_nearest(&self, rect: &Rect, visit: &mut impl FnMut([DVec2; 2])) {
        let squared = |p: DVec2, number: u32| {
            p.distance_squared(nearest_on_segment(p, self.0.segments[number as usize]))
        };
        let center = rect.center();
        let Some((_, nearest)) = self.0.tree.nearest(center, |number| squared(center, number)) else {
            return;
        };
        let farthest = (nearest.sqrt() + rect.size().length()) * (1.0 + 1e-9);
        let is_near = |bounds: &Rect| squared_gap(bounds, rect) <= farthest * farthest;
        let _ = self.0.tree.descend(
            |_, bounds| is_near(bounds),
            |number, bounds| {
                if is_near(bounds) {
                    visit(self.0.segments[number as usize]);
                }
                ControlFlow::Continue(())
            },
        );
    }

    /// Returns the segments that can be nearest to a point of a rectangle, if they are few; `around` are
    /// those for a rectangle around it, if they are known.
    pub(super) fn near(&self, rect: &Rect, around: Option<&Near>) -> Option<Near> {
        let place = Convex::rect(rect.min, rect.max);
        let (mut found, mut farthest) = (Vec::new(), f64::INFINITY);
        let mut look = |segment: [DVec2; 2]| {
            if squared_gap(&Rect::spanning(segment[0], segment[1]), rect) <= farthest {
                let [least, greatest] = place.squared_distances(segment);
                farthest = farthest.min(greatest * (1.0 + 1e-9));
                found.push((least, segment));
            }
        };
        match around {
            Some(around) => around.segments.iter().for_each(|&segment| look(segment)),
            None => self.visit_nearest(rect, &mut look),
        }
        let is_apart = found.iter().all(|&(least, _)| least > 0.0);
        let nearest = found.into_iter().filter(|&(least, _)| least <= farthest);
        let segments: Vec<[DVec2; 2]> = nearest.map(|(_, segment)| segment).collect();
        let is_covered = is_apart.then(|| self.covers(rect.center()));
        (segments.len() <= Near::MOST).then_some(Near { segments, is_covered })
    }
}

/// The segments of [`Shapes`] that can be nearest to a point of a rectangle.
#[derive(Clone, Debug)]
pub(super) struct Near {
    segments: Vec<[DVec2; 2]>,
    /// Whether filled polygons cover the rectangle; `None` where they may cover a part.
    is_covered: Option<bool>,
}

impl Near {
    /// The largest number of segments: with more, a search through all of them is as fast.
    const MOST: usize = 48;
}

/// Returns the square of the distance between two closed rectangles.
fn squared_gap(a: &Rect, b: &Rect) -> f64 {
    (a.min - b.max).max(b.min - a.max).max(DVec2::ZERO).length_squared()
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn near(random: &mut fastrand::Rng) -> DVec2 {
        dvec2(random.f64(), random.f64())
    }

    fn shapes(random: &mut fastrand::Rng) -> ShapeList {
        let points = (0..random.usize(..6)).map(|_| near(random)).collect();
        let lines = (0..random.usize(..4)).map(|_| (0..9).map(|_| near(random)).collect()).collect();
        let polygon = |random: &mut fastrand::Rng| {
            let (at, side) = (near(random), 0.05 + 0.2 * random.f64());
            vec![vec![at, at + dvec2(side, 0.0), at + dvec2(0.3 * side, side)]]
        };
        let polygons = (0..random.usize(1..4)).map(|_| polygon(random)).collect();
        ShapeList { points, lines, polygons }
    }

    /// Returns the distance to a segment from places along it, closer and closer to the nearest.
    fn referee_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..80 {
            let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if p.distance(a + left * (b - a)) < p.distance(a + right * (b - a)) {
                high = right
            } else {
                low = left
            }
        }
        p.distance(a + 0.5 * (low + high) * (b - a))
    }

    fn is_in_triangle(p: DVec2, ring: &[DVec2]) -> bool {
        (0..3).all(|n| (ring[(n + 1) % 3] - ring[n]).perp_dot(p - ring[n]) > 0.0)
    }

    fn referee(list: &ShapeList, filled: bool, p: DVec2) -> f64 {
        if filled && list.polygons.iter().any(|rings| is_in_triangle(p, &rings[0])) {
            return 0.0;
        }
        let points = list.points.iter().map(|&at| p.distance(at));
        let lines = list
            .lines
            .iter()
            .flat_map(|line| line.windows(2).map(|ends| referee_segment(p, ends[0], ends[1])));
        let rings = list.polygons.iter().flatten();
        let edges = rings.flat_map(|ring| (0..3).map(|n| referee_segment(p, ring[n], ring[(n + 1) % 3])));
        points.chain(lines).chain(edges).fold(f64::INFINITY, f64::min)
    }

    /// Clipped lines that are compared with others must not have moved.
    #[test]
    fn the_pieces_of_a_segment_end_where_it_ends() {
        let mut random = fastrand::Rng::with_seed(9);
        let area = Mask::new(&[vec![vec![dvec2(0.2, 0.2), dvec2(0.8, 0.3), dvec2(0.4, 0.9)]]]).unwrap();
        let mut counts = [0, 0];
        for _ in 0..1_000 {
            let [a, b] = [near(&mut random), 3.0 * near(&mut random)];
            let pieces = pieces(a, b, &area);
            assert_eq!((pieces[0], pieces[pieces.len() - 1]), (a, b));
            counts[usize::from(pieces.len() > 2)] += 1;
        }
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    #[test]
    fn the_distance_is_that_to_the_nearest_shape() {
        let mut random = fastrand::Rng::with_seed(91);
        let mut within = 0;
        for round in 0..60 {
            let (list, filled) = (shapes(&mut random), round % 2 == 0);
            let shapes = Shapes::new(list.clone(), filled).unwrap();
            for _ in 0..200 {
                let p = 2.0 * near(&mut random) - 0.5;
                let (found, expected) = (shapes.distance(p), referee(&list, filled, p));
                assert!((found - expected).abs() < 1e-8, "{found} {expected} at {p}");
                within += usize::from(found == 0.0);
            }
        }
        assert!(within > 20, "{within}");
    }

    #[test]
    fn bounds_hold_the_distance_at_every_point() {
        let mut random = fastrand::Rng::with_seed(92);
        for round in 0..200 {
            let far = [0.0, 1e6][round % 2];
            let mut list = shapes(&mut random);
            list.points.iter_mut().for_each(|p| *p += far);
            list.lines.iter_mut().flatten().for_each(|p| *p += far);
            list.polygons.iter_mut().flatten().flatten().for_each(|p| *p += far);
            let shapes = Shapes::new(list, random.bool()).unwrap();
            for _ in 0..30 {
                let min = 2.0 * near(&mut random) - 0.5 + far;
                let side = [0.0, 1e-3, 0.1, 2.0][random.usize(..4)];
                let rect = Rect::new(min, min + side * near(&mut random));
                let bounds = shapes.bounds(&rect);
                for _ in 0..20 {
                    let p = (rect.min + near(&mut random) * rect.size()).clamp(rect.min, rect.max);
                    assert!(bounds.contains(shapes.distance(p)), "{p} in {rect:?}");
                }
                assert!(bounds.greatest - bounds.least <= rect.size().length() * 1.001 + 1e-6);
            }
        }
    }

    #[test]
    fn cutting_shapes_leaves_what_is_outside() {
        let mut random = fastrand::Rng::with_seed(93);
        for _ in 0..40 {
            let list = shapes(&mut random);
            let path = (0..random.usize(1..4)).map(|_| near(&mut random)).collect();
            let cut = CutShape::Stroke { path, radius: 0.02 + 0.2 * random.f64() };
            let (area, left) = (Mask::of_shape(&cut).unwrap(), list.clone().without_area(&cut).unwrap());
            assert_eq!(left.points.len(), list.points.iter().filter(|&&p| !area.contains(p)).count());
            let length = |lines: &[Vec<DVec2>], counts: &dyn Fn(DVec2) -> bool| {
                let steps = 2_000;
                let step = |ends: &[DVec2]| {
                    let middles = (0..steps).map(|n| ends[0].lerp(ends[1], (f64::from(n) + 0.5) / 2_000.0));
                    middles.filter(|&p| counts(p)).count() as f64 / 2_000.0 * ends[0].distance(ends[1])
                };
                lines.iter().flat_map(|line| line.windows(2).map(step)).sum::<f64>()
            };
            let (expected, found) =
                (length(&list.lines, &|p| !area.contains(p)), length(&left.lines, &|_| true));
            assert!((expected - found).abs() < 2e-2, "{expected} {found}");
        }
    }

    #[test]
    fn an_area_joins_the_polygons_that_it_meets() {
        let square = |x: f64| CutShape::Ring(crate::domain::corners(&Rect::around(dvec2(x, 0.0), 0.5)));
        let list = ShapeList::default().with_area(&square(0.0)).unwrap().with_area(&square(0.75)).unwrap();
        assert_eq!((list.polygons.len(), list.polygons[0].len()), (1, 1));
        let apart = list.clone().with_area(&square(3.0)).unwrap();
        assert_eq!(apart.polygons.len(), 2);
        let halves = list.without_area(&CutShape::Ring(crate::domain::corners(&Rect::spanning(
            dvec2(0.3, -1.0),
            dvec2(0.4, 1.0),
        ))));
        assert_eq!(halves.unwrap().polygons.len(), 2);
    }

    #[test]
    fn shapes_without_a_place_are_refused() {
        assert_eq!(Shapes::new(ShapeList::default(), true), Err(ShapesError::Empty));
        let line = ShapeList { lines: vec![vec![DVec2::ZERO, dvec2(f64::NAN, 1.0)]], ..ShapeList::default() };
        let error = Shapes::new(line, false).unwrap_err();
        assert!(error.to_string().contains("NaN, 1"), "{error}");
        let flat = vec![vec![DVec2::ZERO, DVec2::ONE, dvec2(0.5, 0.5)]];
        let flat = Shapes::new(ShapeList { polygons: vec![flat], ..ShapeList::default() }, true).unwrap();
        assert!((flat.distance(dvec2(1.0, 0.0)) - 0.5f64.sqrt()).abs() < 1e-12);
    }
}
