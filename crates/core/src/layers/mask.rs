//! Masks: where a layer counts.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use crate::domain::{CutShape, Domain, OutlineOnEarth, Polygon, Region, RegionError, Ring};
use crate::earth::Ground;
use crate::geometry::{BoxTree, Rect, nearest_on_segment};

/// The part of the plane that polygons cover.
///
/// The polygons may overlap: a point counts if one of them covers it. Clones share their data.
#[derive(Clone, Debug)]
pub struct Mask(Arc<IndexedMask>);

#[derive(Debug)]
struct IndexedMask {
    region: Arc<Region>,
    /// The edges of the region, of which no two cross.
    edges: Vec<[DVec2; 2]>,
    tree: BoxTree,
}

/// How a rectangle lies with respect to a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// The mask covers every point.
    Inside,
    /// The mask covers no point.
    Outside,
    /// Neither, or it is not known.
    Mixed,
}

impl PartialEq for Mask {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.region == other.0.region
    }
}

impl Mask {
    /// Returns the mask of polygons, in world units. The mask of its polygons is the same mask.
    ///
    /// # Errors
    /// Fails when they cover no area, or are too large or too complex.
    pub fn new(polygons: &[Polygon]) -> Result<Self, RegionError> {
        let mut mask = Self::in_frame(polygons)?;
        // Corners move to the grid of the frame, and a part thinner than its step vanishes: the frame of what
        // is left can be smaller.
        for _ in 0..MOST_FRAMES {
            if bounds_of(mask.polygons().iter().flatten()) == Some(mask.bounds()) {
                break;
            }
            mask = Self::in_frame(mask.polygons())?;
        }
        Ok(mask)
    }

    /// Returns the mask of polygons, with corners on the grid of the frame of these.
    fn in_frame(polygons: &[Polygon]) -> Result<Self, RegionError> {
        let domain = match bounds_of(polygons.iter().flatten()) {
            // The polygons of another mask stay as they are: a saved mask is read back exactly.
            Some(bounds) if bounds.is_proper() => {
                Domain::of_stored_polygons(polygons.to_vec(), bounds, &OutlineOnEarth::default())?
            }
            _ => Domain::of_polygons(polygons)?,
        };
        let region = domain.region().ok_or(RegionError::NoArea)?;
        let edges: Vec<[DVec2; 2]> = region.edges().collect();
        let boxes: Vec<Rect> = edges.iter().map(|&[a, b]| Rect::spanning(a, b)).collect();
        let tree = BoxTree::new(&boxes);
        Ok(Self(Arc::new(IndexedMask { region: region.clone(), edges, tree })))
    }

    /// Returns the mask of a shape drawn by hand.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does.
    pub fn of_shape(shape: &CutShape) -> Result<Self, RegionError> {
        let rings = shape.rings();
        let frame = bounds_of(rings.iter()).filter(Rect::is_proper).ok_or(RegionError::NoArea)?;
        Self::new(Region::new(&[], frame).with(&rings).polygons())
    }

    /// Returns the mask with a shape added to it.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does.
    pub fn with(&self, shape: &CutShape) -> Result<Self, RegionError> {
        let (region, rings) = (self.region(), shape.rings());
        match bounds_of(rings.iter()).map(|bounds| bounds.union(region.frame())) {
            Some(frame) if frame != *region.frame() => {
                Self::new(region.reframed(frame).with(&rings).polygons())
            }
            _ => Self::new(region.with(&rings).polygons()),
        }
    }

    /// Returns the mask with a shape cut away; `None` where nothing is left.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does.
    pub fn without(&self, shape: &CutShape) -> Result<Option<Self>, RegionError> {
        let region = self.region().without(&shape.rings());
        if region.is_empty() { Ok(None) } else { Self::new(region.polygons()).map(Some) }
    }

    /// Returns the polygons as a region. Clones of a mask share it.
    pub fn region(&self) -> &Arc<Region> {
        &self.0.region
    }

    /// Returns the polygons, which do not overlap.
    pub fn polygons(&self) -> &[Polygon] {
        self.0.region.polygons()
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedMask { region, edges, tree } = &*self.0;
        (Arc::as_ptr(&self.0).addr(), region.bytes() + size_of_val(&**edges) + tree.bytes())
    }

    /// Returns the area covered, in square world units.
    pub fn area(&self) -> f64 {
        self.0.region.area()
    }

    /// Returns the area covered, as measured on the ground.
    pub fn area_on(&self, ground: &Ground) -> f64 {
        self.polygons().iter().flatten().map(|ring| ground.signed_area(ring)).sum()
    }

    /// Returns the smallest rectangle that holds the mask.
    pub fn bounds(&self) -> Rect {
        *self.0.region.frame()
    }

    /// Returns whether the mask covers a point. On an edge either answer is possible, always the same one.
    ///
    /// Costs about the number of edges at the height of the point.
    pub fn contains(&self, p: DVec2) -> bool {
        // A ray to the right crosses an odd number of edges.
        let ray = Rect::new(p, DVec2::new(f64::MAX, p.y));
        let mut is_odd = false;
        let _ = self.0.tree.visit_meeting(&ray, |number| {
            is_odd ^= is_right_of(self.0.edges[number as usize], p);
            ControlFlow::Continue(())
        });
        is_odd
    }

    /// How a closed rectangle lies. The answers `Inside` and `Outside` hold for [`Self::contains`] at each of
    /// its points.
    pub fn classify(&self, rect: &Rect) -> Coverage {
        // Rounding may shift the side of an edge on which a point lies by about an ulp of the coordinates.
        let margin = 1e-14 * self.largest_coordinate().max(rect.min.abs().max(rect.max.abs()).max_element());
        let around = rect.expanded(margin);
        let meets = self.0.tree.visit_meeting(&around, |number| {
            if may_meet(self.0.edges[number as usize], &around) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        match meets {
            ControlFlow::Break(()) => Coverage::Mixed,
            ControlFlow::Continue(()) if self.contains(rect.center()) => Coverage::Inside,
            ControlFlow::Continue(()) => Coverage::Outside,
        }
    }

    /// Visits the edges whose rectangles meet another, until `visit` breaks.
    pub(crate) fn visit_edges_meeting(
        &self,
        area: &Rect,
        mut visit: impl FnMut([DVec2; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.0.tree.visit_meeting(area, |number| visit(self.0.edges[number as usize]))
    }

    /// Returns the edge that is nearest to a point.
    pub(crate) fn nearest_edge(&self, p: DVec2) -> Option<[DVec2; 2]> {
        let squared = |number: u32| p.distance_squared(nearest_on_segment(p, self.0.edges[number as usize]));
        self.0.tree.nearest(p, squared).map(|(number, _)| self.0.edges[number as usize])
    }

    /// Returns the largest absolute value of a coordinate.
    pub(crate) fn largest_coordinate(&self) -> f64 {
        let Rect { min, max } = self.bounds();
        min.abs().max(max.abs()).max_element()
    }
}

/// Most times that a frame becomes tighter, as thin parts vanish.
const MOST_FRAMES: u32 = 8;

/// Returns the smallest rectangle that holds all corners of rings.
fn bounds_of<'a>(rings: impl Iterator<Item = &'a Ring>) -> Option<Rect> {
    rings.flatten().map(|&corner| Rect::new(corner, corner)).reduce(|a, b| a.union(&b))
}

/// Returns whether an edge crosses the ray from `p` to the right. An end at the height of `p` counts as
/// below.
fn is_right_of([a, b]: [DVec2; 2], p: DVec2) -> bool {
    if (a.y <= p.y) == (b.y <= p.y) {
        return false;
    }
    if a.x.min(b.x) > p.x {
        return true;
    }
    let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
    (high - low).perp_dot(p - low) > 0.0
}

/// Returns whether an edge whose box meets a rectangle may meet the rectangle too: the corners of the
/// rectangle are not strictly on one side of the edge.
fn may_meet([a, b]: [DVec2; 2], rect: &Rect) -> bool {
    let sides = [rect.min, rect.max, DVec2::new(rect.min.x, rect.max.y), DVec2::new(rect.max.x, rect.min.y)]
        .map(|corner| (b - a).perp_dot(corner - a));
    !(sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn ring(random: &mut fastrand::Rng, corners: usize) -> Vec<DVec2> {
        let centre = dvec2(random.f64(), random.f64());
        let radius = 0.05 + 0.4 * random.f64();
        let corner = |n: usize| {
            let angle = std::f64::consts::TAU * n as f64 / corners as f64;
            centre + radius * (0.3 + 0.7 * random.f64()) * dvec2(angle.cos(), angle.sin())
        };
        (0..corners).map(corner).collect()
    }

    /// Returns whether a point is inside a ring: by its winding angle, unlike the code that is tested.
    fn winds_around(ring: &[DVec2], p: DVec2) -> bool {
        let angles = (0..ring.len()).map(|n| (ring[n] - p).angle_to(ring[(n + 1) % ring.len()] - p));
        angles.sum::<f64>().abs() > 3.0
    }

    #[test]
    fn a_mask_is_the_union_of_its_polygons_without_their_holes() {
        let mut random = fastrand::Rng::with_seed(81);
        let (mut inside, mut points) = (0, 0);
        for _ in 0..40 {
            let polygons: Vec<Polygon> = (0..random.usize(1..5))
                .map(|_| {
                    let outer = ring(&mut random, 30);
                    let centre = outer.iter().sum::<DVec2>() / 30.0;
                    let hole = outer.iter().rev().map(|&p| centre + 0.3 * (p - centre)).collect();
                    vec![outer, hole]
                })
                .collect();
            let mask = Mask::new(&polygons).unwrap();
            for _ in 0..500 {
                let p = dvec2(1.6 * random.f64() - 0.3, 1.6 * random.f64() - 0.3);
                let covered =
                    polygons.iter().any(|rings| winds_around(&rings[0], p) && !winds_around(&rings[1], p));
                assert_eq!(mask.contains(p), covered, "{p}");
                inside += usize::from(covered);
                points += 1;
            }
        }
        assert!(inside > points / 20, "{inside}");
    }

    #[test]
    fn rectangles_inside_and_outside_have_points_of_one_kind() {
        let mut random = fastrand::Rng::with_seed(82);
        let mut met = [0; 3];
        for _ in 0..60 {
            let mask = Mask::new(&[vec![ring(&mut random, 60)], vec![ring(&mut random, 5)]]).unwrap();
            for _ in 0..300 {
                let min = dvec2(1.4 * random.f64() - 0.2, 1.4 * random.f64() - 0.2);
                let side = [0.0, 1e-3, 0.05, 0.5][random.usize(..4)];
                let rect = Rect::new(min, min + side * dvec2(random.f64(), random.f64()));
                let coverage = mask.classify(&rect);
                met[coverage as usize] += 1;
                for n in 0..20 {
                    let corner = dvec2(f64::from(n & 1), f64::from(n >> 1 & 1));
                    let share = if n < 4 { corner } else { dvec2(random.f64(), random.f64()) };
                    let covered = mask.contains((rect.min + share * rect.size()).clamp(rect.min, rect.max));
                    assert!(
                        coverage == Coverage::Mixed || covered == (coverage == Coverage::Inside),
                        "{rect:?}"
                    );
                }
                let touched = mask
                    .0
                    .edges
                    .iter()
                    .any(|&[a, b]| (0..=50).any(|n| rect.contains(a.lerp(b, f64::from(n) / 50.0))));
                assert!(!touched || coverage == Coverage::Mixed);
                if side == 0.0 {
                    assert_ne!(coverage, Coverage::Mixed);
                }
            }
        }
        assert!(met.iter().all(|&count| count > 500), "{met:?}");
    }

    #[test]
    fn shapes_are_added_to_a_mask_and_cut_from_it() {
        let mut random = fastrand::Rng::with_seed(83);
        let shape = |random: &mut fastrand::Rng| match random.bool() {
            true => CutShape::Ring(ring(random, 12)),
            false => {
                let path = (0..random.usize(1..4)).map(|_| dvec2(random.f64(), random.f64())).collect();
                CutShape::Stroke { path, radius: 0.05 + 0.1 * random.f64() }
            }
        };
        for _ in 0..40 {
            let (first, next) = (shape(&mut random), shape(&mut random));
            let (mask, other) = (Mask::of_shape(&first).unwrap(), Mask::of_shape(&next).unwrap());
            let (joined, left) = (mask.with(&next).unwrap(), mask.without(&next).unwrap());
            for _ in 0..200 {
                let p = dvec2(1.6 * random.f64() - 0.3, 1.6 * random.f64() - 0.3);
                let (before, covered) = (mask.contains(p), other.contains(p));
                assert_eq!(joined.contains(p), before || covered, "{p}");
                assert_eq!(left.as_ref().is_some_and(|left| left.contains(p)), before && !covered, "{p}");
            }
            for mask in [Some(joined), left].into_iter().flatten() {
                assert_eq!(Mask::new(mask.polygons()).unwrap(), mask, "it is read back as it was saved");
            }
        }
        let disc = CutShape::Stroke { path: vec![DVec2::ONE], radius: 0.5 };
        assert_eq!(Mask::of_shape(&disc).unwrap().without(&disc), Ok(None));
        let line = CutShape::Ring(vec![DVec2::ZERO, DVec2::ONE, dvec2(0.5, 0.5)]);
        assert_eq!(Mask::of_shape(&line), Err(RegionError::NoArea));
    }

    #[test]
    fn a_mask_that_covers_nothing_is_refused() {
        let line = vec![dvec2(0.0, 0.0), dvec2(1.0, 1.0), dvec2(0.5, 0.5)];
        assert_eq!(Mask::new(&[vec![line]]), Err(RegionError::NoArea));
        assert_eq!(Mask::new(&[]), Err(RegionError::NoArea));
        let square = vec![dvec2(0.0, 0.0), dvec2(2.0, 0.0), dvec2(2.0, 1.0), dvec2(0.0, 1.0)];
        assert!((Mask::new(&[vec![square]]).unwrap().area() - 2.0).abs() < 1e-12);
    }
}
