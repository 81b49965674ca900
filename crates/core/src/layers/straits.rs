//! Straits: where the water between two coasts is narrow.
//!
//! A *crossing* is a segment across the water from a coast to another one, or to a part of the same ring that
//! is at least [`LAMBDA`] times as far along the coast. Along a crossing, the nearest point of the coast
//! jumps from one side to the other at some place c: a disc around c touches both coasts. So it is enough to
//! ask for a diameter of its width / k in each such disc: the crossing is at least as long as the disc is
//! wide, and runs through all of its width.
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
//!
//! The discs are found from their contact points, by a disc that shrinks until no coast is within it: it
//! touches the coast at the point, and keeps its centre on the normal there (Ma, Bae, Choi 2012).

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use crate::domain::{CoastEdge, Coasts, Domain, Region};
use crate::field::Bounds;
use crate::geometry::{BoxTree, NumberMap, Rect, nearest_on_segment};
use crate::mesh::Progress;

/// The way along a ring from one side of a crossing to the other, at least, as a multiple of its length.
/// Corners wider than 53°, and coves wider than deep, have none.
const LAMBDA: f64 = 2.0;
/// Steps of a disc that shrinks, at most.
const MOST_STEPS: u32 = 60;
/// A disc has shrunk enough where the nearest coast is nearer than its radius by less than this share.
const TOLERANCE: f64 = 1e-7;
/// Distance between neighbouring centres, at most, as a share of the radius.
const CENTERS: f64 = 0.125;
/// Distance between contact points where there is no strait, as a share of the least width.
const POINTS: f64 = 0.125;
/// Discs count this much farther than they reach, so that those between their neighbours are in them.
const REACH: f64 = 1.0 + 3.0 * CENTERS;
/// The width of a disc, less that by which those between its neighbours can be narrower.
const WIDTH: f64 = 1.0 - 0.75 * CENTERS;
/// Straits narrower than this share of the least width are none.
const NARROWEST: f64 = 1e-6;
/// Points along an edge, at most.
const MOST_POINTS: usize = 100_000;

/// A place of a strait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraitDisc {
    /// The middle of the strait.
    pub center: DVec2,
    /// The points of both coasts that are nearest to the middle.
    pub shores: [DVec2; 2],
    /// The width of the strait: twice the distance from the middle to a coast, in world units.
    pub width: f64,
}

/// At least so many triangles across every strait.
#[derive(Clone, Debug, PartialEq)]
pub struct Straits {
    /// Triangles across a strait.
    pub across: f64,
    /// The straits. In a document they are those of its domain.
    pub found: StraitDiscs,
}

impl Straits {
    /// Returns the target diameter where a strait has a width. One triangle more than asked for: a mesh that
    /// is fitted to the coast can end short of it.
    pub(super) fn diameter(&self, width: f64) -> f64 {
        width / (self.across + 1.0)
    }

    /// Returns the same for another domain.
    pub fn for_domain(&self, domain: &Domain) -> Self {
        let found = match self.found.is_of(domain) {
            true => self.found.clone(),
            false => StraitDiscs::of(domain, self.found.between()),
        };
        Self { found, ..*self }
    }
}

/// The straits of a domain, with an index. Clones share the data.
#[derive(Clone, Debug)]
pub struct StraitDiscs(Arc<Indexed>);

#[derive(Debug)]
struct Indexed {
    /// The outline that they were found for.
    region: Option<Arc<Region>>,
    /// The least and the greatest width that are asked for.
    between: [f64; 2],
    /// The same as lengths in the plane.
    in_plane: [f64; 2],
    discs: Vec<StraitDisc>,
    tree: BoxTree,
    /// The least width in each group of the tree, by level.
    least: Vec<Vec<f64>>,
}

impl PartialEq for StraitDiscs {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        Arc::ptr_eq(&self.0, &other.0)
            || (a.between == b.between && a.in_plane == b.in_plane && a.discs == b.discs)
    }
}

impl StraitDiscs {
    /// Finds the straits of a domain that are at most as wide as the second length, in world units, or in
    /// metres on the Earth. Those narrower than the first one count as that wide. None in a domain without
    /// coasts.
    pub fn of(domain: &Domain, between: [f64; 2]) -> Self {
        let mut search = StraitSearch::new(domain, between);
        search.advance(usize::MAX);
        search.finish()
    }

    fn new(
        region: Option<Arc<Region>>,
        discs: Vec<StraitDisc>,
        between: [f64; 2],
        in_plane: [f64; 2],
    ) -> Self {
        let boxes: Vec<Rect> =
            discs.iter().map(|disc| Rect::around(disc.center, reach(disc, in_plane))).collect();
        let tree = BoxTree::new(&boxes);
        let least = tree.all_joined(|disc| discs[disc as usize].width, (f64::INFINITY, f64::min));
        Self(Arc::new(Indexed { region, between, in_plane, discs, tree, least }))
    }

    /// Returns straits that were not looked for yet: there are none.
    pub fn unknown(between: [f64; 2]) -> Self {
        Self::new(None, Vec::new(), between, between)
    }

    /// Returns whether they were found for this domain.
    pub(super) fn is_of(&self, domain: &Domain) -> bool {
        match (&self.0.region, domain.region()) {
            (Some(own), Some(region)) => Arc::ptr_eq(own, region) || own == region,
            (None, None) => self.0.discs.is_empty(),
            _ => false,
        }
    }

    /// Returns the places of straits, the narrowest first. Places between them are covered by them.
    pub fn discs(&self) -> &[StraitDisc] {
        &self.0.discs
    }

    /// Returns the least and the greatest width that are asked for, in world units, or in metres on the
    /// Earth.
    pub fn between(&self) -> [f64; 2] {
        self.0.between
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let Indexed { discs, tree, least, region: _, between: _, in_plane: _ } = &*self.0;
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

    /// Visits discs near a rectangle, with the widths that count, until all others are wider than `visit`
    /// returns.
    fn visit(&self, rect: &Rect, mut visit: impl FnMut(&StraitDisc, f64) -> f64) {
        let Indexed { in_plane, discs, tree, least, region: _, between: _ } = &*self.0;
        let counted = |width: f64| (WIDTH * width).max(in_plane[0]);
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

/// The work of [`StraitDiscs::of`], in slices.
#[derive(Debug)]
pub(crate) struct StraitSearch {
    region: Option<Arc<Region>>,
    between: [f64; 2],
    finder: Finder,
    /// The first edge of the coasts that was not looked at.
    next: usize,
    found: Vec<StraitDisc>,
}

impl StraitSearch {
    /// Begins to look for the straits of a domain.
    pub(crate) fn new(domain: &Domain, between: [f64; 2]) -> Self {
        let in_plane = [between[0] * domain.least_scale(), between[1] * domain.greatest_scale()];
        let finder = Finder::new(Coasts::of(domain), domain.bounds, in_plane);
        Self { region: domain.region().cloned(), between, finder, next: 0, found: Vec::new() }
    }

    /// Looks along so many edges of the coasts.
    pub(crate) fn advance(&mut self, edges: usize) -> Progress {
        let all = self.finder.coasts.edges.len();
        let end = self.next.saturating_add(edges).min(all);
        let found: Vec<Vec<StraitDisc>> =
            (self.next..end).into_par_iter().map(|edge| self.finder.along(edge)).collect();
        self.found.extend(found.into_iter().flatten());
        self.next = end;
        if end == all { Progress::Done } else { Progress::More }
    }

    /// Returns the straits, once all edges were looked at.
    pub(crate) fn finish(self) -> StraitDiscs {
        StraitDiscs::new(self.region, thinned(self.found), self.between, self.finder.between)
    }
}

/// Returns how far from its centre a disc counts.
fn reach(disc: &StraitDisc, between: [f64; 2]) -> f64 {
    REACH * 0.5 * disc.width.max(POINTS * between[0])
}

/// Finds the discs that touch two coasts.
#[derive(Debug)]
struct Finder {
    coasts: Coasts,
    tree: BoxTree,
    frame: Rect,
    between: [f64; 2],
}

/// A point of a coast.
#[derive(Clone, Copy)]
struct Shore {
    at: DVec2,
    ring: u32,
    /// The length of the ring up to the point.
    along: f64,
}

impl Finder {
    fn new(coasts: Coasts, frame: Rect, between: [f64; 2]) -> Self {
        let boxes: Vec<Rect> =
            coasts.edges.iter().map(|edge| Rect::spanning(edge.ends[0], edge.ends[1])).collect();
        Self { coasts, tree: BoxTree::new(&boxes), frame, between }
    }

    /// Returns the discs that touch an edge, or the corner at its end.
    fn along(&self, edge: usize) -> Vec<StraitDisc> {
        let CoastEdge { ends: [from, to], ring, along, next } = self.coasts.edges[edge];
        let length = from.distance(to);
        let direction = (to - from) / length;
        let normal = direction.perp();
        let mut found = Vec::new();
        let mut place = 0.0;
        for _ in 0..MOST_POINTS {
            let shore = Shore { at: from + place * direction, ring, along: along + place };
            let disc = self.disc(shore, normal);
            found.extend(disc);
            if place >= length {
                break;
            }
            let step = disc.map_or(0.0, |disc| 0.5 * CENTERS * disc.width).max(POINTS * self.between[0]);
            place = (place + step).min(length);
        }
        if let Some(next) = next {
            let [start, end] = self.coasts.edges[next as usize].ends;
            let next_direction = end - start;
            let turn = libm::atan2(direction.perp_dot(next_direction), direction.dot(next_direction));
            // The water is on the left: at a right turn, the land is a corner that points into it.
            let steps = (-turn / CENTERS).ceil().max(0.0) as u32;
            let shore = Shore { at: to, ring, along: along + length };
            let angles = (1..steps).map(|n| turn * f64::from(n) / f64::from(steps));
            let normals = angles.map(|angle| DVec2::new(libm::cos(angle), libm::sin(angle)).rotate(normal));
            found.extend(normals.filter_map(|normal| self.disc(shore, normal)));
        }
        found
    }

    /// Returns the largest disc that touches the coast at a point and has no coast within it, if the two
    /// points that it touches are the ends of a crossing.
    fn disc(&self, shore: Shore, normal: DVec2) -> Option<StraitDisc> {
        let mut radius = 0.5 * self.between[1];
        let mut other = None;
        for _ in 0..MOST_STEPS {
            let center = shore.at + radius * normal;
            let (nearest, distance) = self.nearest(center)?;
            if distance >= radius * (1.0 - TOLERANCE) {
                break;
            }
            let across = nearest.at - shore.at;
            let smaller = across.length_squared() / (2.0 * across.dot(normal));
            if !(smaller > 0.0 && smaller < radius) {
                return None;
            }
            (radius, other) = (smaller, Some(nearest));
        }
        let other = other?;
        let center = shore.at + radius * normal;
        let is_strait = self.is_crossing(shore, other) && self.frame.contains(center);
        is_strait.then_some(StraitDisc { center, shores: [shore.at, other.at], width: 2.0 * radius })
    }

    fn nearest(&self, point: DVec2) -> Option<(Shore, f64)> {
        let on = |edge: u32| nearest_on_segment(point, self.coasts.edges[edge as usize].ends);
        let (edge, _) = self.tree.nearest(point, |edge| point.distance_squared(on(edge)))?;
        let (CoastEdge { ends, ring, along, .. }, at) = (self.coasts.edges[edge as usize], on(edge));
        Some((Shore { at, ring, along: along + at.distance(ends[0]) }, at.distance(point)))
    }

    fn is_crossing(&self, a: Shore, b: Shore) -> bool {
        let length = a.at.distance(b.at);
        // Closer points are one point, but for rounding.
        if length <= NARROWEST * self.between[0] {
            return false;
        }
        let apart = (a.along - b.along).abs();
        a.ring != b.ring || apart.min(self.coasts.lengths[a.ring as usize] - apart) >= LAMBDA * length
    }
}

/// Returns the discs, the narrowest first, without those whose centre is close to that of a narrower one.
fn thinned(mut discs: Vec<StraitDisc>) -> Vec<StraitDisc> {
    discs.sort_by(|a, b| {
        let by_place = || a.center.x.total_cmp(&b.center.x).then(a.center.y.total_cmp(&b.center.y));
        a.width.total_cmp(&b.width).then_with(by_place)
    });
    let mut grids: Vec<CenterGrid> = Vec::new();
    let mut kept: Vec<StraitDisc> = Vec::new();
    for disc in discs {
        let is_length = disc.width > 0.0 && disc.width.is_finite();
        if !is_length || grids.iter().any(|grid| grid.has_near(disc.center)) {
            continue;
        }
        let cell = CENTERS * libm::exp2(libm::log2(disc.width).floor());
        if grids.last().is_none_or(|last| last.cell != cell) {
            grids.push(CenterGrid { cell, centers: NumberMap::default() });
        }
        if let Some(grid) = grids.last_mut() {
            grid.centers.entry(grid.place(disc.center)).or_default().push(disc.center);
        }
        kept.push(disc);
    }
    kept
}

/// The centres of discs that are as wide as others, but for a factor of two, by the cells that they are in.
struct CenterGrid {
    /// The side of a cell: at most `CENTERS` times the width of each disc.
    cell: f64,
    centers: NumberMap<[i64; 2], Vec<DVec2>>,
}

impl CenterGrid {
    fn place(&self, center: DVec2) -> [i64; 2] {
        (center / self.cell).floor().to_array().map(|at| at as i64)
    }

    /// Returns whether a centre is nearer than half of `CENTERS` times the radius of its disc.
    fn has_near(&self, point: DVec2) -> bool {
        let [x, y] = self.place(point);
        let cells = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        let centers = cells.filter_map(|cell| self.centers.get(&cell)).flatten();
        centers.into_iter().any(|center| center.distance(point) < 0.25 * self.cell)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::dvec2;

    use super::*;
    use crate::domain::Ring;
    use crate::layers::Mask;

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
        let straits = |domain: &Domain, least: f64| StraitDiscs::of(domain, [least, 5e3]);
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
        let straits = StraitDiscs::of(&water, [0.5, 5.0]);
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
        let mut search = StraitSearch::new(&water, [0.5, 5.0]);
        while search.advance(3) == Progress::More {}
        assert_eq!(search.finish(), straits, "found in slices");
        assert_eq!(StraitDiscs::of(&water, [0.5, 1.5]).discs().len(), 0, "wider than what is looked for");
        assert_eq!(
            StraitDiscs::of(&water, [1.95, 5.0]).width_at(dvec2(9.0, 0.0)),
            1.95,
            "counts as the least"
        );
    }

    #[test]
    fn a_convex_water_and_a_shallow_cove_have_no_straits() {
        let round = domain(vec![ring(DVec2::ZERO, 60, |_| 10.0)]);
        assert!(StraitDiscs::of(&round, [0.1, 100.0]).discs().is_empty());
        let square = domain(vec![vec![dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(4.0, 3.0), dvec2(0.0, 3.0)]]);
        assert!(StraitDiscs::of(&square, [0.1, 100.0]).discs().is_empty());
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
            let straits = StraitDiscs::of(&water, [narrowest, widest]);
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

    #[test]
    fn bounds_hold_the_width_at_every_point_of_a_rectangle() {
        let mut random = fastrand::Rng::with_seed(6);
        let discs = (0..60)
            .map(|_| {
                let center = dvec2(random.f64(), random.f64());
                StraitDisc { center, shores: [center; 2], width: 0.02 + 0.3 * random.f64() }
            })
            .collect();
        let straits = StraitDiscs::new(None, discs, [0.05, 1.0], [0.05, 1.0]);
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
