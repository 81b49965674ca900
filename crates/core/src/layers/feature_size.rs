//! The local feature size of a coast: how wide the water is.
//!
//! W(x) is the distance from x to the shore plus that from x to the medial axis of the water: along a channel
//! it is half of its width, wherever x is in it. A triangle is at most 2 W / R large, so that R of them are
//! across the channel.
//!
//! ```text
//!   ───────────────────────────      d  distance to the shore
//!      d ┆    ●                      m  distance to the middle
//!        ┆  m ┆                      d + m = half of the width
//!   ── ─ ─ ─ ─┼─ ─ ─ ─ ─ ─ middle
//! ```
//!
//! The medial axis is that of straits ([`MedialBalls`]): the centres of discs that touch two coasts, or two
//! parts of one that are far apart along it. So a corner of a coast or a shallow bay has no branch, unlike
//! the medial axis of a raster of distances, which has one for each bend of the shore. Points of the medial
//! axis are at most an eighth of the radius from the nearest centre; that much is subtracted from the
//! distance to the centres. So W is at most what it is with all points of the medial axis, and less by at
//! most a quarter of the radius.
//!
//! W is Lipschitz continuous with constant 2, since both distances are with constant 1.

use std::sync::Arc;

use glam::DVec2;

use super::{MedialBall, MedialBalls, Shapes};
use crate::domain::{BoundaryMarks, Domain};
use crate::field::Bounds;
use crate::geometry::{BoxTree, Rect};

/// The share of the radius of a disc within which the distance to the middle is 0.
const MIDDLE: f64 = 0.125;

/// A number of triangles across the water.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureSize {
    /// Triangles across a channel.
    pub across: f64,
    /// The shores and the middle of the water. In a document they are those of its domain.
    pub found: MedialAxis,
}

impl FeatureSize {
    /// Returns the target diameter where the water is 2 W wide.
    fn diameter(&self, half_width: f64) -> f64 {
        2.0 * half_width / self.across
    }

    /// Returns the target diameter at a point, as a length in the plane; infinite without a middle.
    pub(super) fn diameter_at(&self, point: DVec2) -> f64 {
        self.diameter(self.found.half_width_at(point))
    }

    /// Returns bounds of the target diameter over a closed rectangle, as lengths in the plane.
    pub(super) fn bounds(&self, rect: &Rect) -> Bounds {
        let Bounds { least, greatest, valid } = self.found.bounds(rect);
        Bounds { least: self.diameter(least), greatest: self.diameter(greatest), valid }
    }

    /// Returns how much the target diameter changes by unit of length, at most.
    pub(super) fn steepness(&self) -> f64 {
        4.0 / self.across
    }

    /// Returns how far from the centres the target diameter is below another one, at most: both are lengths
    /// in the plane.
    pub(super) fn farthest(&self, diameter: f64) -> f64 {
        let widest = self.found.discs().last().map_or(0.0, |disc| disc.width);
        0.5 * self.across * diameter * (1.0 + 1e-9) + 0.5 * MIDDLE * widest
    }

    /// Returns the same for another domain, or other coasts of it.
    pub fn for_domain(&self, domain: &Domain, marks: &BoundaryMarks) -> Self {
        let found = match self.found.0.discs.is_of(domain, marks) {
            true => self.found.clone(),
            false => MedialAxis::of(domain, marks, self.found.between()),
        };
        Self { found, ..*self }
    }
}

/// The shores of a domain and the medial axis of its water, with an index. Clones share the data.
#[derive(Clone, Debug)]
pub struct MedialAxis(Arc<IndexedFeatureSize>);

#[derive(Debug)]
struct IndexedFeatureSize {
    discs: MedialBalls,
    shores: Option<Shapes>,
    /// The discs around the centres in which the distance to the middle is 0.
    tree: BoxTree,
}

impl PartialEq for MedialAxis {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        Arc::ptr_eq(&self.0, &other.0) || (a.discs == b.discs && a.shores == b.shores)
    }
}

impl MedialAxis {
    /// Finds the middle of water that is between the first and the second length wide, in world units, or in
    /// metres on the Earth. That of wider water is left out: where 2 W is greater, it can be too large. None
    /// in a domain without coasts.
    pub fn of(domain: &Domain, marks: &BoundaryMarks, between: [f64; 2]) -> Self {
        Self::new(MedialBalls::of(domain, marks, between), Shapes::coasts(domain, marks).ok())
    }

    fn new(discs: MedialBalls, shores: Option<Shapes>) -> Self {
        let boxes: Vec<Rect> =
            discs.discs().iter().map(|disc| Rect::around(disc.center, rim(disc))).collect();
        Self(Arc::new(IndexedFeatureSize { discs, shores, tree: BoxTree::new(&boxes) }))
    }

    /// Returns a medial axis that was not searched for yet: it is empty.
    pub fn unknown(between: [f64; 2]) -> Self {
        Self::new(MedialBalls::unknown(between), None)
    }

    /// Returns the minimum and the maximum width that are searched for, in world units, or in metres on the
    /// Earth.
    pub fn between(&self) -> [f64; 2] {
        self.0.discs.between()
    }

    /// Returns discs that touch two coasts, the narrowest first: the middle is that of their centres.
    pub fn discs(&self) -> &[MedialBall] {
        self.0.discs.discs()
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedFeatureSize { discs, shores, tree } = &*self.0;
        let shores = shores.as_ref().map_or(0, |shores| shores.shared_data().1);
        (Arc::as_ptr(&self.0).addr(), discs.shared_data().1 + shores + tree.bytes())
    }

    /// Returns the smallest rectangle that holds the middle; `None` without one.
    pub fn extent(&self) -> Option<Rect> {
        self.0.tree.bounds()
    }

    /// Returns W at a point, in the plane; infinite without a middle.
    pub fn half_width_at(&self, point: DVec2) -> f64 {
        let Some(shores) = &self.0.shores else { return f64::INFINITY };
        shores.distance(point) + self.to_middle(point)
    }

    /// Returns the distance to the middle.
    fn to_middle(&self, point: DVec2) -> f64 {
        let discs = self.discs();
        let distance = |number: u32| {
            let disc = &discs[number as usize];
            (disc.center.distance(point) - rim(disc)).max(0.0)
        };
        let nearest = self.0.tree.nearest(point, |number| distance(number) * distance(number));
        nearest.map_or(f64::INFINITY, |(number, _)| distance(number))
    }

    /// Returns bounds of [`Self::half_width_at`] over a closed rectangle.
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        let Some(shores) = &self.0.shores else { return Bounds::one(f64::INFINITY) };
        let center = rect.center();
        let to_middle = self.to_middle(center);
        if to_middle == f64::INFINITY {
            return Bounds::one(f64::INFINITY);
        }
        // Rounding shifts the centre and the nearest point by a few ulps of the largest coordinate.
        let largest = center.abs().max_element() + to_middle;
        let reach = 0.5 * rect.size().length() * (1.0 + 1e-12) + 1e-14 * largest;
        let Bounds { least, greatest, valid } = shores.bounds(rect);
        Bounds { least: least + (to_middle - reach).max(0.0), greatest: greatest + to_middle + reach, valid }
    }
}

/// Returns the radius around the centre of a disc within which the distance to the middle is 0.
fn rim(disc: &MedialBall) -> f64 {
    0.5 * MIDDLE * disc.width
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::dvec2;

    use super::*;
    use crate::domain::Ring;
    use crate::geometry::nearest_on_segment;
    use crate::layers::Mask;

    fn ring(at: DVec2, corners: u32, radius: impl Fn(f64) -> f64) -> Ring {
        let angle = |n: u32| TAU * f64::from(n) / f64::from(corners);
        (0..corners).map(|n| at + radius(angle(n)) * DVec2::from_angle(angle(n))).collect()
    }

    /// Water around islands, in a rough ring.
    fn water(random: &mut fastrand::Rng) -> Option<Domain> {
        let phase = random.f64();
        let outer = ring(DVec2::ZERO, 200, |a| 10.0 + (3.0 * a + phase).sin() + 0.6 * (11.0 * a).cos());
        let islands = (0..6).map(|n| {
            let at = (3.0 + 4.0 * random.f64()) * DVec2::from_angle(f64::from(n) + 0.3 * random.f64());
            let (size, phase) = (0.5 + random.f64(), random.f64());
            let mut island = ring(at, 40, |a| size * (0.7 + 0.3 * (5.0 * a + phase).sin()));
            island.reverse();
            island
        });
        Domain::of_polygons(&[std::iter::once(outer).chain(islands).collect()]).ok()
    }

    #[test]
    fn a_channel_is_half_as_wide_everywhere_as_its_width() {
        let rings = vec![ring(DVec2::ZERO, 400, |_| 10.0), ring(DVec2::ZERO, 400, |_| 8.0)];
        let channel = Domain::of_polygons(&[rings]).unwrap();
        let found = MedialAxis::of(&channel, &BoundaryMarks::default(), [0.5, 5.0]);
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..2000 {
            let at = (8.0 + 2.0 * random.f64()) * DVec2::from_angle(TAU * random.f64());
            let half = found.half_width_at(at);
            assert!((0.87..=1.01).contains(&half), "{half} at {at}");
        }
        // Away from the shores it grows with the way: twice as fast on land, and as fast from the middle.
        assert!((found.half_width_at(DVec2::ZERO) - 17.0).abs() < 0.2);
        let none = MedialAxis::of(&channel, &BoundaryMarks::default(), [0.5, 1.5]);
        assert_eq!(none.half_width_at(dvec2(9.0, 0.0)), f64::INFINITY, "wider than what is looked for");
        let square = Domain::of_polygons(&[vec![ring(DVec2::ZERO, 4, |_| 3.0)]]).unwrap();
        let square = MedialAxis::of(&square, &BoundaryMarks::default(), [0.1, 100.0]);
        assert_eq!(square.half_width_at(DVec2::ZERO), f64::INFINITY, "right angles have no middle");
    }

    /// Along a crossing there is a place that is as far from both ends as a middle is, and W is at most the
    /// length of each part: so R triangles of 2 W / R fill it.
    #[test]
    fn the_diameters_along_every_crossing_fill_it_with_the_triangles_across() {
        let mut random = fastrand::Rng::with_seed(5);
        let (mut crossings, mut least) = (0, f64::INFINITY);
        for _ in 0..8 {
            let Some(water) = water(&mut random) else { continue };
            let region = water.region().unwrap();
            let mask = Mask::new(region.polygons()).unwrap();
            let size = FeatureSize {
                across: 3.0,
                found: MedialAxis::of(&water, &BoundaryMarks::default(), [0.2, 8.0]),
            };
            let edges: Vec<(usize, [DVec2; 2])> = region
                .rings()
                .enumerate()
                .flat_map(|(number, ring)| {
                    (0..ring.len()).map(move |n| (number, [ring[n], ring[(n + 1) % ring.len()]]))
                })
                .collect();
            for _ in 0..300 {
                let (own, [a, b]) = edges[random.usize(..edges.len())];
                let from = a.lerp(b, random.f64());
                let others = edges.iter().filter(|(number, _)| *number != own);
                let to = others.map(|(_, ends)| nearest_on_segment(from, *ends));
                let to = to.min_by(|a, b| a.distance(from).total_cmp(&b.distance(from))).unwrap();
                let length = from.distance(to);
                let is_water = (1..200).all(|n| mask.contains(from.lerp(to, f64::from(n) / 200.0)));
                if !is_water || !(0.3..6.0).contains(&length) {
                    continue;
                }
                let steps = 500;
                let share = |n: u32| (f64::from(n) + 0.5) / f64::from(steps);
                let diameters = (0..steps).map(|n| size.diameter_at(from.lerp(to, share(n))));
                let count: f64 = diameters.map(|diameter| length / f64::from(steps) / diameter).sum();
                (crossings, least) = (crossings + 1, least.min(count));
                assert!(count >= 3.0 - 1e-9, "{count} from {from} to {to}");
            }
        }
        assert!(crossings > 300 && least < 4.0, "{crossings} crossings, {least}");
    }

    #[test]
    fn bounds_hold_w_at_every_point_and_it_changes_by_at_most_twice_the_way() {
        let mut random = fastrand::Rng::with_seed(6);
        let water = water(&mut random).unwrap();
        let found = MedialAxis::of(&water, &BoundaryMarks::default(), [0.2, 8.0]);
        let size = FeatureSize { across: 3.0, found: found.clone() };
        let mut steepest = 0.0_f64;
        let shore: Vec<[DVec2; 2]> = water.region().unwrap().edges().collect();
        let place = |random: &mut fastrand::Rng| 24.0 * dvec2(random.f64(), random.f64()) - 12.0;
        for _ in 0..600 {
            let min = place(&mut random);
            let rect = Rect::new(min, min + 6.0 * random.f64().powi(4) * dvec2(random.f64(), random.f64()));
            let bounds = found.bounds(&rect);
            let mut last: Option<(DVec2, f64)> = None;
            for _ in 0..6 {
                let at = rect.min + dvec2(random.f64(), random.f64()) * rect.size();
                let half = found.half_width_at(at);
                let to_shore = shore.iter().map(|&ends| nearest_on_segment(at, ends).distance(at));
                let to_middle =
                    found.discs().iter().map(|disc| (disc.center.distance(at) - disc.width / 16.0).max(0.0));
                let [to_shore, to_middle] =
                    [to_shore.fold(f64::INFINITY, f64::min), to_middle.fold(f64::INFINITY, f64::min)];
                assert!((half - to_shore - to_middle).abs() < 1e-12 * half, "{half} at {at}");
                assert!(bounds.contains(half), "{half} in {bounds:?} at {at}");
                if let Some((before, of_before)) = last {
                    assert!((half - of_before).abs() <= 2.0 * at.distance(before) + 1e-9);
                    let change = (size.diameter(half) - size.diameter(of_before)).abs();
                    let most = size.steepness() * at.distance(before) + 1e-9;
                    assert!(change <= most, "{change} {most}");
                    steepest = steepest.max(change / most);
                }
                last = Some((at, half));
            }
        }
        assert!(steepest > 0.999, "{steepest} of the steepness that a bound of the gradation takes");
    }
}
