//! Straits: where the water between two coasts is narrow.
//!
//! A *crossing* is a segment across the water from a coast to another one, or to a part of the same ring that
//! is at least twice as far along the coast. Along a crossing, the nearest point of the coast jumps from one
//! side to the other at some place c: a disc around c touches both coasts. So it is enough to ask for a
//! diameter of its width / k in each such disc: the crossing is at least as long as the disc is wide, and
//! runs through all of its width.
//!
//! ```text
//!   ──────╮    land    ╭───────
//!          ╲  .-"""-. ╱
//!           ●/   c   \          a disc that touches two coasts
//!           (    +    )
//!            \       ●
//!          ╱  `-...-´  ╲
//!   ──────╯    land     ╰──────
//! ```

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use glam::DVec2;

use super::strait_passage::narrowest_passage;
use super::strait_search::StraitSearch;
use crate::domain::{BoundaryMarks, Domain, Region};
use crate::field::Bounds;
use crate::geometry::{BoxTree, Rect};

/// Distance between neighbouring centres, at most, as a share of the radius.
pub(super) const CENTERS: f64 = 0.125;
/// Distance between contact points where there is no strait, as a share of the least width.
pub(super) const POINTS: f64 = 0.125;
/// Discs count this much farther than they reach, so that those between their neighbours are in them.
const REACH: f64 = 1.0 + 3.0 * CENTERS;
/// The width of a disc, less that by which those between its neighbours can be narrower.
const WIDTH: f64 = 1.0 - 0.75 * CENTERS;

/// A place of a strait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MedialBall {
    /// The middle of the strait.
    pub center: DVec2,
    /// The points of both coasts that are nearest to the middle.
    pub shores: [DVec2; 2],
    /// The width of the strait: twice the distance from the middle to a coast, in world units.
    pub width: f64,
}

/// A minimum number of triangles across every strait.
#[derive(Clone, Debug, PartialEq)]
pub struct Straits {
    /// Triangles across a strait.
    pub across: f64,
    /// The straits. In a document they are those of its domain.
    pub found: MedialBalls,
}

impl Straits {
    /// Returns the target diameter where a strait has a width. One triangle more than asked for: a mesh that
    /// is fitted to the coast can end short of it.
    pub(super) fn diameter(&self, width: f64) -> f64 {
        width / (self.across + 1.0)
    }

    /// Returns the same for another domain, or other coasts of it.
    pub fn for_domain(&self, domain: &Domain, marks: &BoundaryMarks) -> Self {
        let found = match self.found.is_of(domain, marks) {
            true => self.found.clone(),
            false => MedialBalls::of(domain, marks, self.found.between()),
        };
        Self { found, ..*self }
    }
}

/// The straits of a domain, with an index. Clones share the data.
#[derive(Clone, Debug)]
pub struct MedialBalls(Arc<IndexedStraits>);

#[derive(Debug)]
struct IndexedStraits {
    /// The outline that they were found for.
    region: Option<Arc<Region>>,
    /// The marks that decide which parts of the outline are coasts.
    marks: BoundaryMarks,
    /// The minimum and the maximum width that are asked for.
    between: [f64; 2],
    /// The same as lengths in the plane.
    in_plane: [f64; 2],
    discs: Vec<MedialBall>,
    /// The smallest rectangle with all middles.
    middles: Option<Rect>,
    tree: BoxTree,
    /// The least width in each group of the tree, by level.
    least: Vec<Vec<f64>>,
    /// The narrowest passage, once somebody has asked for it.
    narrowest: OnceLock<Option<MedialBall>>,
}

impl PartialEq for MedialBalls {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        Arc::ptr_eq(&self.0, &other.0)
            || (a.between == b.between && a.in_plane == b.in_plane && a.discs == b.discs)
    }
}

impl MedialBalls {
    /// Finds the straits of a domain that are at most as wide as the second length, in world units, or in
    /// metres on the Earth. Those narrower than the first one count as that wide. None in a domain without
    /// coasts. Marks decide which parts of its boundary are coasts.
    pub fn of(domain: &Domain, marks: &BoundaryMarks, between: [f64; 2]) -> Self {
        let mut search = StraitSearch::new(domain, marks, between);
        search.advance(usize::MAX);
        search.finish()
    }

    pub(super) fn new(
        (region, marks): (Option<Arc<Region>>, BoundaryMarks),
        discs: Vec<MedialBall>,
        between: [f64; 2],
        in_plane: [f64; 2],
    ) -> Self {
        let boxes: Vec<Rect> =
            discs.iter().map(|disc| Rect::around(disc.center, reach(disc, in_plane))).collect();
        let tree = BoxTree::new(&boxes);
        let least = tree.all_joined(|disc| discs[disc as usize].width, (f64::INFINITY, f64::min));
        let middles = Rect::holding(discs.iter().map(|disc| disc.center));
        let narrowest = OnceLock::new();
        Self(Arc::new(IndexedStraits {
            region,
            marks,
            between,
            in_plane,
            discs,
            middles,
            tree,
            least,
            narrowest,
        }))
    }

    /// Returns straits that were not looked for yet: there are none.
    pub fn unknown(between: [f64; 2]) -> Self {
        Self::new((None, BoundaryMarks::default()), Vec::new(), between, between)
    }

    /// Returns whether they were found for the coasts of this domain.
    pub(super) fn is_of(&self, domain: &Domain, marks: &BoundaryMarks) -> bool {
        match (&self.0.region, domain.region()) {
            (Some(own), Some(region)) => {
                (Arc::ptr_eq(own, region) || own == region) && self.0.marks == marks.of_coasts()
            }
            (None, None) => self.0.discs.is_empty(),
            _ => false,
        }
    }

    /// Returns the places of straits, the narrowest first. Places between them are covered by them.
    pub fn discs(&self) -> &[MedialBall] {
        &self.0.discs
    }

    /// Returns the narrowest passage between two shores of the domain that they were found for, with wider
    /// water on both sides; nothing if there is none. Corners and dead ends are no passages.
    pub fn narrowest(&self, domain: &Domain) -> Option<MedialBall> {
        let IndexedStraits { marks, discs, narrowest, .. } = &*self.0;
        *narrowest.get_or_init(|| narrowest_passage(domain, marks, discs))
    }

    /// Returns the least and the greatest width that are asked for, in world units, or in metres on the
    /// Earth.
    pub fn between(&self) -> [f64; 2] {
        self.0.between
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedStraits { discs, tree, least, .. } = &*self.0;
        let groups: usize = least.iter().map(|level| size_of_val(&**level)).sum();
        (Arc::as_ptr(&self.0).addr(), size_of_val(&**discs) + tree.bytes() + groups)
    }

    /// Returns the smallest rectangle in which there are straits; `None` without any.
    pub fn extent(&self) -> Option<Rect> {
        self.0.tree.bounds()
    }

    /// Returns the width of the narrowest strait at a point, at least the least width that was looked for;
    /// infinite where there is none.
    pub fn width_at(&self, point: DVec2) -> f64 {
        let mut width = f64::INFINITY;
        self.visit(&Rect::new(point, point), |disc, counted| {
            let is_within = disc.center.distance(point) <= reach(disc, self.0.in_plane);
            width = if is_within { width.min(counted) } else { width };
            width
        });
        width
    }

    /// Returns bounds of [`Self::width_at`] over a closed rectangle.
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        let (mut least, mut greatest) = (f64::INFINITY, f64::INFINITY);
        self.visit(rect, |disc, counted| {
            let nearest = disc.center.clamp(rect.min, rect.max);
            let far = (rect.max - disc.center).abs().max((rect.min - disc.center).abs());
            // A hair on both sides: rounding must not leave a point out.
            let reach = reach(disc, self.0.in_plane);
            if nearest.distance(disc.center) <= reach * (1.0 + 1e-12) {
                least = least.min(counted);
            }
            if far.length() <= reach * (1.0 - 1e-12) {
                greatest = greatest.min(counted);
            }
            greatest
        });
        Bounds::new(least, greatest)
    }

    /// Returns whether the middles of all straits are in a rectangle.
    pub(super) fn are_in(&self, rect: &Rect) -> bool {
        self.0.middles.is_none_or(|middles| rect.contains(middles.min) && rect.contains(middles.max))
    }

    /// Returns the least sum of what the width of a strait asks for and `slope` times the distance from the
    /// point to the strait, and the nearest point of that strait; `None` if no sum is below `limit`.
    ///
    /// A strait asks for the same all over a disc, and on the straight way to its middle lies the nearest
    /// point.
    pub(super) fn carried_to(
        &self,
        point: DVec2,
        slope: f64,
        limit: f64,
        diameter: impl Fn(f64) -> f64,
    ) -> Option<(f64, DVec2)> {
        let IndexedStraits { in_plane, discs, tree, least, .. } = &*self.0;
        let best = std::cell::Cell::new((limit, None));
        let is_less = |width: f64, bounds: &Rect| {
            let distance = point.distance(point.clamp(bounds.min, bounds.max));
            diameter(self.counted(width)) + slope * distance < best.get().0
        };
        let _ = tree.descend(
            |group, bounds| is_less(least[group.level][group.index], bounds),
            |item, bounds| {
                let disc = &discs[item as usize];
                if is_less(disc.width, bounds) {
                    let (distance, reach) = (disc.center.distance(point), reach(disc, *in_plane));
                    let beyond = (distance - reach).max(0.0);
                    let carried = diameter(self.counted(disc.width)) + slope * beyond;
                    if carried < best.get().0 {
                        let from =
                            if beyond > 0.0 { point.lerp(disc.center, beyond / distance) } else { point };
                        best.set((carried, Some(from)));
                    }
                }
                ControlFlow::Continue(())
            },
        );
        let (least, from) = best.get();
        from.map(|from| (least, from))
    }

    /// Returns the width that counts in a disc, less than its own because of the places between discs.
    fn counted(&self, width: f64) -> f64 {
        (WIDTH * width).max(self.0.in_plane[0])
    }

    /// Visits discs near a rectangle, with the widths that count, until all others are wider than `visit`
    /// returns.
    fn visit(&self, rect: &Rect, mut visit: impl FnMut(&MedialBall, f64) -> f64) {
        let IndexedStraits { discs, tree, least, .. } = &*self.0;
        let counted = |width| self.counted(width);
        let limit = std::cell::Cell::new(f64::INFINITY);
        let meets = |bounds: &Rect| bounds.min.cmple(rect.max).all() && rect.min.cmple(bounds.max).all();
        let _ = tree.descend(
            |group, bounds| meets(bounds) && counted(least[group.level][group.index]) < limit.get(),
            |item, bounds| {
                let disc = &discs[item as usize];
                if meets(bounds) && counted(disc.width) < limit.get() {
                    limit.set(visit(disc, counted(disc.width)));
                }
                ControlFlow::Continue(())
            },
        );
    }
}

/// Returns how far from its centre a disc counts.
fn reach(disc: &MedialBall, between: [f64; 2]) -> f64 {
    REACH * 0.5 * disc.width.max(POINTS * between[0])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::dvec2;

    use super::*;
    use crate::domain::Ring;
    use crate::geometry::nearest_on_segment;
    use crate::layers::Mask;
    use crate::mesh::Progress;

    const NONE: BoundaryMarks = BoundaryMarks { splits: Vec::new(), names: Vec::new(), types: Vec::new() };

    fn domain(rings: Vec<Ring>) -> Domain {
        let mut rings = rings.into_iter();
        let outer = rings.next().unwrap();
        Domain::of_polygons(&[std::iter::once(outer).chain(rings).collect()]).unwrap()
    }

    /// A ring around a place, with the radius at each angle.
    fn ring(at: DVec2, corners: u32, radius: impl Fn(f64) -> f64) -> Ring {
        let angle = |n: u32| 2.0 * PI * f64::from(n) / f64::from(corners);
        (0..corners).map(|n| at + radius(angle(n)) * DVec2::from_angle(angle(n))).collect()
    }

    #[test]
    fn straits_are_equal_only_with_the_same_widths_on_the_earth_and_in_the_plane() {
        let bounds = crate::geometry::Rect::new(dvec2(4e5, 7e6), dvec2(5e5, 7.1e6));
        let text = "+proj=merc +lat_ts=0 +ellps=WGS84 +units=m";
        let plain = Domain::rectangle(bounds);
        let on_earth = Domain { projection: Some(text.parse().unwrap()), ..plain.clone() };
        let straits = |domain: &Domain, least: f64| MedialBalls::of(domain, &NONE, [least, 5e3]);
        let all = [straits(&plain, 1e3), straits(&plain, 2e3), straits(&on_earth, 1e3)];
        for (n, one) in all.iter().enumerate() {
            assert!(one.discs().is_empty());
            assert!(all.iter().enumerate().all(|(m, other)| (one == other) == (n == m)), "{n}");
        }
        assert_eq!(all[0], straits(&plain, 1e3));
    }

    #[test]
    fn a_ring_of_water_is_as_wide_everywhere() {
        let water = domain(vec![ring(DVec2::ZERO, 400, |_| 10.0), ring(DVec2::ZERO, 400, |_| 8.0)]);
        let straits = MedialBalls::of(&water, &NONE, [0.5, 5.0]);
        assert!(straits.discs().len() > 100, "{}", straits.discs().len());
        for disc in straits.discs() {
            assert!((disc.width - 2.0).abs() < 2e-2 && (disc.center.length() - 9.0).abs() < 2e-2, "{disc:?}");
        }
        for n in 0..1000 {
            let at = 9.0 * DVec2::from_angle(f64::from(n));
            let width = straits.width_at(at);
            assert!((1.8..=2.0).contains(&width), "{width} at {at}");
        }
        assert_eq!(straits.width_at(DVec2::ZERO), f64::INFINITY);
        let mut search = StraitSearch::new(&water, &NONE, [0.5, 5.0]);
        while search.advance(3) == Progress::More {}
        assert_eq!(search.finish(), straits, "found in slices");
        assert_eq!(
            MedialBalls::of(&water, &NONE, [0.5, 1.5]).discs().len(),
            0,
            "wider than what is looked for"
        );
        assert_eq!(
            MedialBalls::of(&water, &NONE, [1.95, 5.0]).width_at(dvec2(9.0, 0.0)),
            1.95,
            "counts as the least"
        );
    }

    #[test]
    fn a_convex_water_and_a_shallow_cove_have_no_straits() {
        let round = domain(vec![ring(DVec2::ZERO, 60, |_| 10.0)]);
        assert!(MedialBalls::of(&round, &NONE, [0.1, 100.0]).discs().is_empty());
        let square = domain(vec![vec![dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(4.0, 3.0), dvec2(0.0, 3.0)]]);
        assert!(MedialBalls::of(&square, &NONE, [0.1, 100.0]).discs().is_empty());
    }

    /// Crossings of random water: from many points of the coast to the nearest point of another ring.
    #[test]
    fn the_widths_along_every_crossing_add_up_to_its_length() {
        let mut random = fastrand::Rng::with_seed(5);
        let (mut crossings, mut least) = (0, f64::INFINITY);
        for round in 0..12 {
            let phase = random.f64();
            let outer = ring(DVec2::ZERO, 300, |a| 10.0 + (3.0 * a + phase).sin() + 0.6 * (11.0 * a).cos());
            let islands = (0..6).map(|n| {
                let at = (3.0 + 4.0 * random.f64()) * DVec2::from_angle(f64::from(n) + 0.3 * random.f64());
                let (size, phase) = (0.5 + random.f64(), random.f64());
                let mut island = ring(at, 40, |a| size * (0.7 + 0.3 * (5.0 * a + phase).sin()));
                island.reverse();
                island
            });
            let rings: Vec<Ring> = std::iter::once(outer).chain(islands).collect();
            let Ok(water) = Domain::of_polygons(&[rings]) else { continue };
            let [narrowest, widest] = [0.2, 6.0];
            let straits = MedialBalls::of(&water, &NONE, [narrowest, widest]);
            let region = water.region().unwrap();
            let mask = Mask::new(region.polygons()).unwrap();
            let edges: Vec<[DVec2; 2]> = region.edges().collect();
            for _ in 0..400 {
                let [a, b] = edges[random.usize(..edges.len())];
                let from = a.lerp(b, random.f64());
                // The nearest point of another ring.
                let of_other = |edge: &&[DVec2; 2]| !same_ring(region, edge[0], a);
                let to = edges.iter().filter(of_other).map(|&ends| nearest_on_segment(from, ends));
                let to = to.min_by(|a, b| a.distance(from).total_cmp(&b.distance(from))).unwrap();
                let length = from.distance(to);
                let is_open = (1..200).all(|n| mask.contains(from.lerp(to, f64::from(n) / 200.0)));
                if !is_open || length > 0.9 * widest || length < narrowest {
                    continue;
                }
                // How many times the width of the strait the crossing is long.
                let steps = 2000;
                let share = |n: u32| (f64::from(n) + 0.5) / f64::from(steps);
                let widths = (0..steps).map(|n| straits.width_at(from.lerp(to, share(n))));
                let sum: f64 = widths.map(|width| length / f64::from(steps) / width).sum();
                least = least.min(sum);
                crossings += 1;
                assert!(sum >= 1.0, "round {round}: {sum} from {from} to {to}");
            }
        }
        assert!(crossings > 1000, "{crossings}");
        assert!(least < 1.5, "the bound is sharp: {least}");
    }

    fn same_ring(region: &crate::domain::Region, a: DVec2, b: DVec2) -> bool {
        region.rings().any(|ring| ring.contains(&a) && ring.contains(&b))
    }

    fn random_discs(random: &mut fastrand::Rng) -> MedialBalls {
        let discs = (0..60)
            .map(|_| {
                let center = dvec2(random.f64(), random.f64());
                MedialBall { center, shores: [center; 2], width: 0.02 + 0.3 * random.f64() }
            })
            .collect();
        MedialBalls::new((None, NONE), discs, [0.05, 1.0], [0.05, 1.0])
    }

    #[test]
    fn what_gradation_carries_from_straits_is_the_least_of_all_discs() {
        let mut random = fastrand::Rng::with_seed(7);
        let straits = random_discs(&mut random);
        let diameter = |width: f64| (width / 3.0).max(0.02);
        let mut outside = 0;
        for _ in 0..500 {
            let point = 2.0 * dvec2(random.f64(), random.f64()) - 0.5;
            let slope = 0.05 + random.f64();
            let (least, from) = straits.carried_to(point, slope, f64::INFINITY, diameter).unwrap();
            let of_disc = |disc: &MedialBall| {
                let beyond = disc.center.distance(point) - REACH * 0.5 * disc.width;
                diameter((WIDTH * disc.width).max(0.05)) + slope * beyond.max(0.0)
            };
            let by_all = straits.discs().iter().map(of_disc).fold(f64::INFINITY, f64::min);
            assert!((least - by_all).abs() < 1e-12, "{least} {by_all}");
            let rim =
                |disc: &&MedialBall| disc.center.distance(from) <= REACH * 0.5 * disc.width * (1.0 + 1e-12);
            let asked =
                straits.discs().iter().filter(rim).map(|disc| diameter((WIDTH * disc.width).max(0.05)));
            let at_place = asked.fold(f64::INFINITY, f64::min) + slope * from.distance(point);
            assert!((at_place - least).abs() < 1e-9, "{at_place} from {from}");
            assert_eq!(straits.carried_to(point, slope, least, diameter), None, "nothing is below the least");
            outside += usize::from(from != point);
        }
        assert!(straits.are_in(&Rect::UNIT) && !straits.are_in(&Rect::around(DVec2::ZERO, 0.5)));
        assert!(outside > 200, "{outside}");
    }

    #[test]
    fn bounds_hold_the_width_at_every_point_of_a_rectangle() {
        let mut random = fastrand::Rng::with_seed(6);
        let straits = random_discs(&mut random);
        let mut ones = 0;
        for _ in 0..2000 {
            let size = 0.4 * random.f64().powi(3);
            let min = dvec2(random.f64(), random.f64());
            let rect = Rect::new(min, min + size * dvec2(random.f64(), random.f64()));
            let bounds = straits.bounds(&rect);
            for _ in 0..20 {
                let at = rect.min + dvec2(random.f64(), random.f64()) * rect.size();
                let width = straits.width_at(at);
                let by_all = straits
                    .discs()
                    .iter()
                    .filter(|disc| disc.center.distance(at) <= REACH * 0.5 * disc.width);
                let by_all = by_all.map(|disc| (WIDTH * disc.width).max(0.05)).fold(f64::INFINITY, f64::min);
                assert_eq!(width, by_all);
                assert!(bounds.least <= width && width <= bounds.greatest, "{width} in {bounds:?}");
            }
            ones += usize::from(bounds.greatest < f64::INFINITY);
        }
        assert!(ones > 300, "{ones}");
    }
}
