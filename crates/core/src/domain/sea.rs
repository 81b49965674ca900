//! The sea: a frame less the land, which polygons or lines of coast give.
//!
//! Lines have two sides. They are closed along the frame and divide it into parts, of which neighbours across
//! a line are land and water:
//!
//! ```text
//!   ┌────────╮───────────┐
//!   │  land  ╰╮   sea    │      One place decides for all parts. Closed lines are islands; without any,
//!   │         ╰─╮   ◯    │      land is to the left of each line, as in OpenStreetMap.
//!   └───────────╰────────┘
//! ```

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;

use super::coast_lines::CoastLines;
use super::complexity::check_complexity;
use super::file_frame::FileFrame;
use super::region::corners;
use super::{Polygon, Region, RegionError, Ring};
use crate::geometry::{NumberSet, is_around, signed_area};
use crate::text::{Grouped, Number};

/// The share of the length of lines that agrees, at least, on which side is the sea.
const AGREEMENT: f64 = 0.9;
/// How far from an edge the point is that tells its side, as a share of the edge.
const BESIDE: f64 = 1e-6;
/// Ends of lines that a sentence names.
const NAMED_ENDS: usize = 5;

/// The land in a file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Land<'a> {
    /// Polygons of land.
    pub polygons: &'a [Polygon],
    /// Lines of coast.
    pub lines: &'a [Vec<DVec2>],
    /// A place in the sea, which tells the sides of the lines apart.
    pub sea_at: Option<DVec2>,
}

/// The sea in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Sea {
    /// The polygons that it covers, in the coordinates of the frame.
    pub polygons: Vec<Polygon>,
    /// How the sides of the lines were told apart; `None` without lines that need it.
    pub decided: Option<WaterSide>,
}

/// How the sides of lines of coast were told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaterSide {
    /// By a place in the sea.
    OfPlace,
    /// Closed lines are islands.
    AroundIslands,
    /// Land is to the left of the lines.
    RightOfLines,
}

impl WaterSide {
    /// Returns how the side was found, as the start of a sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::OfPlace => "the water is where the place in the sea is",
            Self::AroundIslands => "the water is on the side of the lines where closed lines lie, as islands",
            Self::RightOfLines => "land is taken to be to the left of the lines, as in OpenStreetMap",
        }
    }
}

/// Why land leaves no sea.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeaError {
    /// There is only land in the frame.
    #[error(
        "the land covers the whole frame, so there is no sea. Check the frame, or say where the sea is with `sea`."
    )]
    NoSea,
    /// There is no land in the frame.
    #[error(
        "none of the land lies in the frame {}, {} to {}, {}. Bounds are west, south, east and north, in the coordinates of \
         the file.",
        Number(frame.rect.min.x), Number(frame.rect.min.y), Number(frame.rect.max.x), Number(frame.rect.max.y)
    )]
    NoLand {
        /// The frame.
        frame: FileFrame,
    },
    /// Lines end in the frame.
    #[error("{}", loose_ends(ends))]
    LooseEnds {
        /// Where they end.
        ends: Vec<DVec2>,
    },
    /// The lines do not tell which side is the sea.
    #[error(
        "the lines do not tell land from water: no closed line is an island, and their directions differ. Name a place \
         in the sea (--sea X,Y, or the key `sea`), or give the land as polygons."
    )]
    UnknownSide,
    /// The place that should be in the sea is not in the frame.
    #[error("the place in the sea, {}, {}, is not in the frame.", Number(at.x), Number(at.y))]
    OutsidePlace {
        /// The place.
        at: DVec2,
    },
    /// The place that should be in the sea is on land.
    #[error("the place in the sea, {}, {}, is on land that a polygon gives. Name another one.", Number(at.x), Number(at.y))]
    PlaceOnLand {
        /// The place.
        at: DVec2,
    },
    /// The polygons are too complex.
    #[error("{0}")]
    Region(#[from] RegionError),
}

fn loose_ends(ends: &[DVec2]) -> String {
    let named = ends.iter().take(NAMED_ENDS).map(|at| format!("{}, {}", Number(at.x), Number(at.y)));
    let named = named.collect::<Vec<_>>().join("; ");
    let others = match ends.len().saturating_sub(NAMED_ENDS) {
        0 => String::new(),
        count => format!(" and {} more", Grouped(count)),
    };
    format!(
        "lines of coast end inside the frame, at {named}{others}, so they do not part land from water. Choose bounds that \
         cut these lines, join the lines, or give the land as polygons."
    )
}

impl Land<'_> {
    /// Returns a frame around the land: a tenth larger on each side, unless the land was cut off at its own
    /// bounding rectangle. `None` where there is no land.
    pub fn frame_around(&self, in_degrees: bool) -> Option<FileFrame> {
        let lines = self.lines.iter().map(Vec::as_slice);
        let shapes = || self.polygons.iter().flatten().map(Vec::as_slice).chain(lines.clone());
        let around = |has_margin| FileFrame::around(shapes(), in_degrees, has_margin);
        let grown = around(true)?;
        let exact = around(false);
        let ends =
            |frame: &FileFrame| CoastLines::new(&frame.lines_within(self.lines), &frame.rect).loose_ends;
        let is_cut = !ends(&grown).is_empty()
            || exact.is_some_and(|exact| exact.is_corner_of(self.polygons) && exact.sea(self).is_ok());
        exact.filter(|_| is_cut).or(Some(grown))
    }
}

impl FileFrame {
    /// Returns whether a corner of the frame is a corner of polygons.
    fn is_corner_of(&self, polygons: &[Polygon]) -> bool {
        let corners = corners(&self.rect);
        self.polygons_within(polygons).iter().flatten().flatten().any(|at| corners.contains(at))
    }

    /// Returns the sea: the frame less the land in it.
    ///
    /// # Errors
    /// Fails when there is no land or no sea in the frame, when lines end inside it, when they do not tell
    /// which side is water, and when the polygons are too complex.
    pub fn sea(&self, land: &Land) -> Result<Sea, SeaError> {
        let polygons = self.polygons_within(land.polygons);
        check_complexity(&polygons, &self.rect)?;
        let mut covered = Region::covered(&polygons, self.rect);
        let lines = CoastLines::new(&self.lines_within(land.lines), &self.rect);
        if covered.is_empty() && lines.is_empty() {
            return Err(SeaError::NoLand { frame: *self });
        }
        let place = |at| self.moved_into(at).ok_or(SeaError::OutsidePlace { at });
        let sea_at = land.sea_at.map(place).transpose()?;
        let whole = Region::new(&[vec![corners(&self.rect)]], self.rect);
        let mut decided = None;
        if !lines.is_empty() {
            let (beside_lines, side) = self.land_beside(&lines, sea_at, &whole)?;
            (covered, decided) = ([covered, beside_lines].concat(), side);
            covered = Region::covered(&covered, self.rect);
        }
        let rings: Vec<Ring> = covered.into_iter().flatten().collect();
        let sea = whole.overlaid(&rings, OverlayRule::Difference, FillRule::NonZero);
        let is_in_sea = |at: &DVec2| is_odd(sea.rings(), *at);
        match sea_at {
            _ if sea.is_empty() => Err(SeaError::NoSea),
            Some(at) if !is_in_sea(&at) => Err(SeaError::PlaceOnLand { at }),
            _ => Ok(Sea { polygons: sea.polygons().to_vec(), decided }),
        }
    }

    /// Returns the land beside lines in the `whole` frame, and how their sides were told apart.
    fn land_beside(
        &self,
        lines: &CoastLines,
        sea_at: Option<DVec2>,
        whole: &Region,
    ) -> Result<(Vec<Polygon>, Option<WaterSide>), SeaError> {
        if !lines.loose_ends.is_empty() {
            return Err(SeaError::LooseEnds { ends: lines.loose_ends.clone() });
        }
        let snapped = |ring: &Ring| Region::snapped(ring, &self.rect);
        let closed: Vec<Ring> = lines.closed.iter().map(snapped).collect();
        let crossing: Vec<Ring> = lines.closed_along_frame(&self.rect).iter().map(snapped).collect();
        let rings = [closed.clone(), crossing].concat();
        check_complexity(&rings.iter().map(|ring| vec![ring.clone()]).collect::<Vec<_>>(), &self.rect)?;
        let odd = whole.overlaid(&rings, OverlayRule::Intersect, FillRule::EvenOdd);
        let sides = Sides::of(&odd);
        let (odd_is_land, side) = match sea_at {
            Some(at) => (!is_odd(rings.iter(), at), Some(WaterSide::OfPlace)),
            None if lines.crossing.is_empty() => (true, None),
            None => {
                match (sides.islands_are_odd(&closed), sides.left_is_odd(&lines.crossing, &rings, self)) {
                    (Some(odd), _) => (odd, Some(WaterSide::AroundIslands)),
                    (None, Some(odd)) => (odd, Some(WaterSide::RightOfLines)),
                    (None, None) => return Err(SeaError::UnknownSide),
                }
            }
        };
        let land = match odd_is_land {
            true => odd,
            false => whole.overlaid(&rings, OverlayRule::Difference, FillRule::EvenOdd),
        };
        Ok((land.polygons().to_vec(), side))
    }
}

/// Returns whether rings enclose a point an odd number of times.
fn is_odd<'a>(rings: impl Iterator<Item = &'a Ring>, at: DVec2) -> bool {
    rings.filter(|ring| is_around(ring, at)).count() % 2 == 1
}

/// The edges of a region, with the region to their left.
struct Sides(NumberSet<[u64; 4]>);

impl Sides {
    fn of(region: &Region) -> Self {
        Self(region.edges().map(key).collect())
    }

    /// Returns whether the region is inside closed lines; `None` where too few agree.
    fn islands_are_odd(&self, closed: &[Ring]) -> Option<bool> {
        let votes = closed.iter().flat_map(|ring| {
            let is_anticlockwise = signed_area(ring) > 0.0;
            let edges = ring.iter().zip(ring.iter().cycle().skip(1));
            edges.filter_map(move |(&a, &b)| {
                let is_left = self.is_left_of([a, b])?;
                Some((is_left == is_anticlockwise, a.distance(b)))
            })
        });
        agreement(votes)
    }

    /// Returns whether the region, which `rings` enclose an odd number of times, is to the left of lines
    /// through the frame; `None` where too few agree.
    fn left_is_odd(&self, lines: &[Vec<DVec2>], rings: &[Ring], frame: &FileFrame) -> Option<bool> {
        let votes = lines.iter().flat_map(|line| {
            let line = Region::snapped(line, &frame.rect);
            let edges = || line.windows(2).map(|ends| [ends[0], ends[1]]);
            let known = edges().filter_map(|[a, b]| Some((self.is_left_of([a, b])?, a.distance(b))));
            let mut votes: Vec<(bool, f64)> = known.collect();
            if votes.is_empty() {
                // The overlay has joined edges on one line.
                let longest = edges().max_by(|[a, b], [c, d]| a.distance(*b).total_cmp(&c.distance(*d)));
                votes.extend(longest.map(|[a, b]| {
                    let beside = a.midpoint(b) + BESIDE * (b - a).perp();
                    (is_odd(rings.iter(), beside), a.distance(b))
                }));
            }
            votes
        });
        agreement(votes)
    }

    /// Returns whether the region is to the left of an edge; `None` if no edge of it runs there.
    fn is_left_of(&self, [a, b]: [DVec2; 2]) -> Option<bool> {
        match (self.0.contains(&key([a, b])), self.0.contains(&key([b, a]))) {
            (true, false) => Some(true),
            (false, true) => Some(false),
            _ => None,
        }
    }
}

fn key([a, b]: [DVec2; 2]) -> [u64; 4] {
    [a.x, a.y, b.x, b.y].map(f64::to_bits)
}

/// Returns the answer of most of the length.
fn agreement(votes: impl Iterator<Item = (bool, f64)>) -> Option<bool> {
    let (mut yes, mut all) = (0.0, 0.0);
    for (vote, length) in votes {
        all += length;
        yes += if vote { length } else { 0.0 };
    }
    match all > 0.0 {
        true if yes >= AGREEMENT * all => Some(true),
        true if yes <= (1.0 - AGREEMENT) * all => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Rect;

    const UNIT: FileFrame = FileFrame { rect: Rect::UNIT, in_degrees: false };

    fn area(sea: &Sea) -> f64 {
        sea.polygons.iter().flatten().map(|ring| signed_area(ring)).sum()
    }

    fn line(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|&at| at.into()).collect()
    }

    fn beside(lines: &[Vec<DVec2>], sea_at: Option<DVec2>) -> Result<(f64, Option<WaterSide>), SeaError> {
        let sea = UNIT.sea(&Land { polygons: &[], lines, sea_at })?;
        Ok((area(&sea), sea.decided))
    }

    #[test]
    fn land_is_to_the_left_of_lines_without_islands() {
        let coast = line(&[[0.25, 2.0], [0.25, 0.5], [0.25, -1.0]]);
        assert_eq!(beside(std::slice::from_ref(&coast), None), Ok((0.25, Some(WaterSide::RightOfLines))));
        let back: Vec<DVec2> = coast.iter().rev().copied().collect();
        assert_eq!(beside(std::slice::from_ref(&back), None), Ok((0.75, Some(WaterSide::RightOfLines))));
        let place = Some(dvec2(0.9, 0.5));
        assert_eq!(beside(&[coast], place), Ok((0.75, Some(WaterSide::OfPlace))));
        assert_eq!(beside(&[back], place), Ok((0.75, Some(WaterSide::OfPlace))));
    }

    #[test]
    fn closed_lines_are_islands_on_the_side_of_the_water() {
        let coast = line(&[[0.25, -1.0], [0.25, 2.0]]);
        let island = line(&[[0.5, 0.25], [0.75, 0.25], [0.75, 0.5], [0.5, 0.5], [0.5, 0.25]]);
        let sea = Ok((0.75 - 0.0625, Some(WaterSide::AroundIslands)));
        assert_eq!(beside(&[coast.clone(), island.clone()], None), sea);
        let turned: Vec<DVec2> = island.iter().rev().copied().collect();
        assert_eq!(beside(&[coast, turned], None), sea);
        assert_eq!(beside(&[island], None), Ok((0.9375, None)));
    }

    #[test]
    fn pieces_are_joined_in_any_order_and_direction() {
        let pieces = [
            line(&[[0.5, 0.5], [0.5, 0.75]]),
            line(&[[0.25, 1.5], [0.25, 0.75], [0.5 + 1e-9, 0.75]]),
            line(&[[0.25, -0.5], [0.25, 0.5], [0.5, 0.5]]),
        ];
        let place = Some(dvec2(0.9, 0.5));
        let (area, _) = beside(&pieces, place).unwrap();
        assert!((area - 0.6875).abs() < 1e-6, "{area}");
        // Two lines that cross the frame, with land between them, and one that only touches it.
        let strait = [line(&[[0.0, 0.25], [1.0, 0.25]]), line(&[[-1.0, 0.75], [2.0, 0.75]])];
        assert_eq!(beside(&strait, None), Err(SeaError::UnknownSide));
        assert_eq!(beside(&strait, Some(dvec2(0.5, 0.5))).unwrap().0, 0.5);
        let touches = line(&[[-1.0, 0.0], [2.0, 0.0]]);
        let none = SeaError::NoLand { frame: UNIT };
        assert_eq!(beside(&[touches], None), Err(none));
    }

    #[test]
    fn ends_inside_the_frame_are_named() {
        let error = beside(&[line(&[[-1.0, 0.5], [0.25, 0.5]])], None).unwrap_err();
        assert_eq!(error, SeaError::LooseEnds { ends: vec![dvec2(0.25, 0.5)] });
        assert!(error.to_string().contains("at 0.25, 0.5,"), "{error}");
    }

    #[test]
    fn land_on_both_sides_of_the_antimeridian_counts() {
        let frame = FileFrame { rect: Rect::new(dvec2(178.0, 0.0), dvec2(182.0, 4.0)), in_degrees: true };
        let square = |west: f64, east: f64| vec![line(&[[west, 1.0], [east, 1.0], [east, 2.0], [west, 2.0]])];
        let halves = [square(179.0, 180.0), square(-180.0, -179.0)];
        let whole = [vec![line(&[[179.0, 1.0], [-179.0, 1.0], [-179.0, 2.0], [179.0, 2.0]])]];
        for polygons in [&halves[..], &whole[..]] {
            let sea = frame.sea(&Land { polygons, ..Land::default() }).unwrap();
            assert_eq!((area(&sea), sea.polygons.len(), sea.polygons[0].len()), (14.0, 1, 2));
        }
        let around = Land { polygons: &halves, ..Land::default() }.frame_around(true).unwrap();
        assert!(
            (around.rect.min.x - 178.8).abs() < 1e-9 && (around.rect.max.x - 181.2).abs() < 1e-9,
            "{around:?}"
        );
    }

    #[test]
    fn a_place_in_the_sea_counts_after_whole_turns_and_is_not_on_land() {
        let frame = FileFrame { rect: Rect::new(dvec2(178.0, 0.0), dvec2(182.0, 4.0)), in_degrees: true };
        let coast = [line(&[[180.0, -1.0], [180.0, 5.0]])];
        let sea = |at| frame.sea(&Land { lines: &coast, sea_at: Some(at), ..Land::default() });
        let is_east = |sea: &Sea| sea.polygons[0][0].iter().all(|at| at.x >= 180.0);
        for (at, east) in [(dvec2(-179.0, 2.0), true), (dvec2(181.0, 2.0), true), (dvec2(179.0, 2.0), false)]
        {
            assert_eq!(is_east(&sea(at).unwrap()), east, "{at}");
        }
        let outside = dvec2(10.0, 2.0);
        assert_eq!(sea(outside), Err(SeaError::OutsidePlace { at: outside }));
        let polygons = [vec![line(&[[0.25, 0.25], [0.5, 0.25], [0.5, 0.5]])]];
        let beside = |at| UNIT.sea(&Land { polygons: &polygons, sea_at: Some(at), ..Land::default() });
        let on_land = dvec2(0.45, 0.3);
        assert_eq!(beside(on_land), Err(SeaError::PlaceOnLand { at: on_land }));
        assert!(beside(dvec2(0.9, 0.3)).is_ok());
    }

    #[test]
    fn a_frame_around_land_that_was_cut_is_that_of_the_cut() {
        let corner = vec![line(&[[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]])];
        let island = vec![line(&[[3.0, 2.0], [4.0, 2.0], [4.0, 3.0]])];
        let land = Land { polygons: &[corner, island], ..Land::default() };
        assert_eq!(land.frame_around(false).unwrap().rect, Rect::new(DVec2::ZERO, dvec2(4.0, 3.0)));
        let lines =
            [line(&[[0.0, 1.0], [1.0, 2.0], [3.0, 1.0]]), line(&[[1.0, 0.0], [2.0, 1.0], [1.0, 3.0]])];
        let cut = Land { lines: &lines, ..Land::default() };
        assert_eq!(cut.frame_around(false).unwrap().rect, Rect::new(DVec2::ZERO, dvec2(3.0, 3.0)));
    }
}
