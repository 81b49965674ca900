//! Finds the rectangle by which an outline was cut off from its surroundings.
//!
//! Any outline touches its own bounding rectangle, by chance also along an edge. That rectangle cuts it only
//! if a corner of the rectangle is on the outline between two sides, or a straight part along the rectangle
//! is longer than all others. It is looked for in the coordinates of the file first, then in those in which
//! outlines are often cut: longitudes and latitudes, the plane of the domain, and the UTM zone. A rectangle
//! that is turned has a direction of a long straight part.

use glam::DVec2;
use rayon::prelude::*;

use super::cut_frame::{CutFrame, FrameSide};
use super::{Region, Ring};
use crate::earth::{Coordinates, Projection, Reprojection};
use crate::geometry::Rect;

/// Number of parts of a circle by which longitudes are distinguished, to find where the outline is not.
const PARTS_OF_CIRCLE: usize = 720;
/// How far a corner may be from the straight line between its neighbours, as a share of the width of the
/// outline: an edge that was divided is still straight.
const STRAIGHT: f64 = 1e-7;
/// Straight parts whose directions a turned rectangle may have.
const DIRECTIONS: usize = 6;
/// The minimum length of two sides that meet at a corner of a rectangle, as a share of the width, where
/// nothing says that the outline was cut in its coordinates.
const LEAST_SIDE: f64 = 1e-2;

/// A side of a turned rectangle is at least this many times as long as all other straight parts.
const LEAST_RATIO: f64 = 2.0;

/// What the coordinates of an outline mean on the Earth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlineOnEarth {
    /// What those of its file are, if that is known.
    pub file: Option<Coordinates>,
    /// The plane of the world units, if the outline is projected.
    pub projection: Option<Projection>,
    /// The rectangle by which it was cut, in the coordinates of its file, if that is known.
    pub frame: Option<Rect>,
}

impl OutlineOnEarth {
    /// Returns that of an outline that was projected.
    pub fn from_reprojection(reprojection: &Reprojection) -> Self {
        Self { file: Some(reprojection.from), projection: Some(reprojection.to), frame: None }
    }

    /// Returns what world coordinates are, if that is known.
    fn world(&self) -> Option<Coordinates> {
        self.projection.map(Coordinates::Plane).or(self.file)
    }

    /// Returns the systems in which a region may have been cut, as [`CutFrame::coordinates`]; that of the
    /// file is the first.
    fn systems(&self, region: &Region) -> Vec<Option<[Coordinates; 2]>> {
        let Some(world) = self.world() else { return vec![None] };
        let center = world.to_geographic(region.frame().center());
        let all = [self.file, Some(Coordinates::Geographic), Some(world), utm(center)];
        let mut systems: Vec<Option<[Coordinates; 2]>> = Vec::new();
        for own in all.into_iter().flatten() {
            let system = (own != world).then_some([world, own]);
            if !systems.contains(&system) {
                systems.push(system);
            }
        }
        systems
    }
}

/// Returns the UTM zone of a longitude and latitude.
fn utm(at: DVec2) -> Option<Coordinates> {
    let zone = ((at.x + 180.0) / 6.0).floor().clamp(0.0, 59.0) as u32 + 1;
    let hemisphere = if at.y < 0.0 { 32_700 } else { 32_600 };
    (at.is_finite() && at.y.abs() < 84.0).then(|| Coordinates::of_epsg(hemisphere + zone)).flatten()
}

/// How certain it is that the outline was cut in the coordinates of a rectangle.
#[derive(Clone, Copy, PartialEq)]
enum Evidence {
    /// They are those of the file.
    OfFile,
    /// They are others.
    Guessed,
    /// The rectangle is turned in them. Any two edges at a right angle are sides of one.
    Turned,
}

impl CutFrame {
    /// Returns the bounding rectangle of a region in the coordinates of its file.
    pub(super) fn around(region: &Region, on_earth: &OutlineOnEarth) -> Option<Self> {
        let rings: Vec<&Ring> = region.rings().collect();
        Local::new(&rings, on_earth.systems(region)[0])?.frame(DVec2::X)
    }

    /// Returns the rectangle by which a region was cut off: its own bounding rectangle in some coordinates.
    pub(super) fn of_region(region: &Region, on_earth: &OutlineOnEarth) -> Option<Self> {
        if let Some(rect) = on_earth.frame {
            return Some(Self { coordinates: on_earth.systems(region)[0], eastward: DVec2::X, rect });
        }
        let rings: Vec<&Ring> = region.rings().filter(|ring| ring.len() > 2).collect();
        let size = region.frame().size().max_element();
        let systems = on_earth.systems(region);
        let evidence = |n: usize| if n == 0 { Evidence::OfFile } else { Evidence::Guessed };
        let upright = systems.iter().enumerate().find_map(|(n, &system)| {
            let local = Local::new(&rings, system)?;
            let frame = local.frame(DVec2::X)?;
            cuts(&frame, &rings, size, &local, evidence(n)).then_some(frame)
        });
        let is_plane =
            |system: &Option<[Coordinates; 2]>| !matches!(system, Some([_, Coordinates::Geographic]));
        let turned = || {
            systems.iter().filter(|system| is_plane(system)).find_map(|&system| {
                let local = Local::new(&rings, system)?;
                let frames = local.directions().into_iter().filter_map(|eastward| local.frame(eastward));
                frames.into_iter().find(|frame| cuts(frame, &rings, size, &local, Evidence::Turned))
            })
        };
        upright.or_else(turned)
    }
}

/// Rings in the coordinates of a system.
struct Local {
    system: Option<[Coordinates; 2]>,
    rings: Vec<Ring>,
}

impl Local {
    /// Returns `None` where a corner has no coordinates in the system.
    fn new(rings: &[&Ring], system: Option<[Coordinates; 2]>) -> Option<Self> {
        let Some([of_world, own]) = system else {
            return Some(Self { system, rings: rings.iter().map(|&ring| ring.clone()).collect() });
        };
        let place = |&at: &DVec2| own.from_geographic(of_world.to_geographic(at));
        let mut rings: Vec<Ring> =
            rings.iter().map(|ring| ring.par_iter().map(place).collect::<Ring>()).collect();
        if own == Coordinates::Geographic {
            join_longitudes(&mut rings);
        }
        let is_finite = rings.iter().flatten().all(|at| at.is_finite());
        is_finite.then_some(Self { system, rings })
    }

    /// Returns the bounding rectangle in a direction.
    fn frame(&self, eastward: DVec2) -> Option<CutFrame> {
        let turn = DVec2::new(eastward.x, -eastward.y);
        let places = self.rings.iter().flatten().map(|&at| turn.rotate(at));
        let rect = Rect::holding(places)?;
        rect.is_proper().then_some(CutFrame { coordinates: self.system, eastward, rect })
    }

    /// Returns the directions of the longest straight parts, as those of southern sides.
    fn directions(&self) -> Vec<DVec2> {
        let mut parts: Vec<DVec2> = Vec::new();
        for ring in &self.rings {
            parts
                .extend(straight_parts(ring).into_iter().map(|(start, end)| at(ring, end) - at(ring, start)));
        }
        parts.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
        parts.truncate(DIRECTIONS);
        let southern = |part: DVec2| {
            let quarters = [part, part.perp(), -part, -part.perp()];
            let least = quarters.into_iter().find(|turned| turned.x > 0.0 && turned.y.abs() <= turned.x);
            least.unwrap_or(DVec2::X).normalize_or(DVec2::X)
        };
        parts.into_iter().map(southern).filter(|eastward| eastward.y != 0.0).collect()
    }
}

fn at(ring: &Ring, number: usize) -> DVec2 {
    ring[number % ring.len()]
}

/// Makes longitudes continuous: the cut is where the outline is not.
fn join_longitudes(rings: &mut [Ring]) {
    let part = |longitude: f64| {
        let share = (longitude / 360.0).rem_euclid(1.0);
        ((share * PARTS_OF_CIRCLE as f64) as usize).min(PARTS_OF_CIRCLE - 1)
    };
    let mut is_taken = [false; PARTS_OF_CIRCLE];
    for ring in rings.iter() {
        for n in 0..ring.len() {
            let (from, to) = (part(at(ring, n).x), part(at(ring, n + 1).x));
            // The shorter way round.
            let eastward = (to + PARTS_OF_CIRCLE - from) % PARTS_OF_CIRCLE;
            let (start, count) = match eastward <= PARTS_OF_CIRCLE / 2 {
                true => (from, eastward),
                false => (to, PARTS_OF_CIRCLE - eastward),
            };
            (0..=count).for_each(|step| is_taken[(start + step) % PARTS_OF_CIRCLE] = true);
        }
    }
    let free =
        |start: usize| (0..PARTS_OF_CIRCLE).take_while(|n| !is_taken[(start + n) % PARTS_OF_CIRCLE]).count();
    let longest = (0..PARTS_OF_CIRCLE).max_by_key(|&start| (free(start), PARTS_OF_CIRCLE - start));
    let west = longest
        .filter(|&start| free(start) > 0)
        .map_or(-180.0, |start| (start as f64 + 0.5 * free(start) as f64) * 360.0 / PARTS_OF_CIRCLE as f64);
    // As near to the usual longitudes as possible.
    let west = if west >= 180.0 { west - 360.0 } else { west };
    for at in rings.iter_mut().flatten() {
        at.x = west + (at.x - west).rem_euclid(360.0);
    }
}

/// Returns whether a rectangle around rings cuts them, so that edges along it are open.
fn cuts(frame: &CutFrame, rings: &[&Ring], size: f64, local: &Local, evidence: Evidence) -> bool {
    let sides = frame.sides(rings, size);
    let least = if evidence == Evidence::OfFile { 0.0 } else { LEAST_SIDE * size };
    let has_corner = || rings.iter().zip(&sides).any(|(ring, sides)| has_corner(ring, sides, least));
    let is_longest = |ratio: f64| {
        let [along, elsewhere] = longest_parts(local, &sides);
        along > ratio * elsewhere
    };
    match evidence {
        Evidence::OfFile => has_corner() || is_longest(1.0),
        Evidence::Guessed => has_corner(),
        Evidence::Turned => has_corner() && is_longest(LEAST_RATIO),
    }
}

/// Returns whether two different sides meet on a ring, each along an edge that is part of a run at least this
/// long.
fn has_corner(ring: &Ring, sides: &[Option<FrameSide>], least: f64) -> bool {
    let count = ring.len();
    let run = |start: usize, forwards: bool| {
        let edge =
            |step: usize| if forwards { (start + step) % count } else { (start + count - step) % count };
        let along = (0..count).map(edge).take_while(|&n| sides[n] == sides[start]);
        along.map(|n| at(ring, n).distance(at(ring, n + 1))).sum::<f64>()
    };
    (0..count).any(|n| {
        let next = (n + 1) % count;
        let meet = sides[n].is_some() && sides[next].is_some() && sides[n] != sides[next];
        meet && run(n, false) >= least && run(next, true) >= least
    })
}

/// Returns the length of the longest straight part along the rectangle, and elsewhere.
fn longest_parts(local: &Local, sides: &[Vec<Option<FrameSide>>]) -> [f64; 2] {
    let [mut along, mut elsewhere] = [0.0_f64; 2];
    for (ring, sides) in local.rings.iter().zip(sides) {
        for (start, end) in straight_parts(ring) {
            let length = at(ring, start).distance(at(ring, end));
            let longest = if sides[start % ring.len()].is_some() { &mut along } else { &mut elsewhere };
            *longest = longest.max(length);
        }
    }
    [along, elsewhere]
}

/// Returns the straight parts of a ring: the numbers of the first corner and of the last one.
fn straight_parts(ring: &Ring) -> Vec<(usize, usize)> {
    let bounds = Rect::holding(ring.iter().copied());
    let tolerance = STRAIGHT * bounds.map_or(0.0, |bounds| bounds.size().max_element());
    let goes_on = |start: usize, end: usize| {
        let chord = at(ring, end + 1) - at(ring, start);
        let leg = at(ring, end) - at(ring, start);
        chord.dot(at(ring, end + 1) - at(ring, end)) > 0.0
            && chord.perp_dot(leg).abs() <= tolerance * chord.length()
    };
    // A part that goes on across the first corner begins before it.
    let count = ring.len();
    let first = (0..count).find(|&n| !goes_on(n + count - 1, n + count)).unwrap_or(0);
    let mut parts = Vec::new();
    let mut start = first;
    while start < first + count {
        let mut end = start + 1;
        while end < first + count && goes_on(start, end) {
            end += 1;
        }
        parts.push((start, end));
        start = end;
    }
    parts
}
