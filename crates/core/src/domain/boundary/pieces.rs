//! The pieces of a boundary: stretches, split by marks, with the names and types of marks.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::super::segments::Segments;
use super::super::{Domain, DomainShape, FrameSide, Ring, corners};
use super::stretches::{PlaceOnRing, SidedRing, Stretch, length, stretches};
use super::{BoundaryKind, BoundaryMarks, BoundaryType};
use crate::geometry::{Rect, nearest_on_segment};
use crate::mesh::{Extract, NodeId};

/// A piece of the boundary of a domain.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BoundaryPiece {
    /// The name of the piece. No other piece has it.
    pub name: String,
    /// The kind of the piece.
    pub kind: BoundaryKind,
    /// Whether a person or a file gave the name.
    pub is_named: bool,
    /// The type that a person or a file set.
    pub set_type: Option<BoundaryType>,
    /// A polyline in world units, with the domain on its left. The whole of a ring ends with its first point.
    pub points: Vec<DVec2>,
    pub(super) side: Option<FrameSide>,
    pub(super) place: PlaceOnRing,
    /// The stretch that it is a part of.
    stretch: usize,
}

impl BoundaryPiece {
    /// Returns whether it is the whole of a ring.
    pub fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }

    /// Returns what it is for a solver: the type that was set, or else the default one.
    pub fn boundary_type(&self) -> BoundaryType {
        self.set_type.unwrap_or_else(|| self.default_type())
    }

    /// Returns what it is for a solver if nothing was set: open if it lies along the frame
    /// ([`BoundaryKind::Open`]), and land elsewhere. A name that was given decides against that if it begins
    /// with `open` or with `land`, in upper or lower case.
    pub fn default_type(&self) -> BoundaryType {
        let of_name = if self.is_named { BoundaryType::from_name(&self.name) } else { None };
        let of_kind = if self.kind == BoundaryKind::Open { BoundaryType::Open } else { BoundaryType::Land };
        of_name.unwrap_or(of_kind)
    }

    /// Returns the length in world units.
    pub fn length(&self) -> f64 {
        length(&self.points)
    }

    /// Returns the point halfway along it.
    pub fn middle(&self) -> DVec2 {
        middle(&self.points)
    }
}

/// All pieces of the boundary of a domain. The number of a piece is its index in the list: first open pieces,
/// then mainlands, then islands, each from the largest on; the parts of a split stretch follow one another.
#[derive(Clone, Debug)]
pub struct BoundaryPieces {
    pieces: Vec<BoundaryPiece>,
    index: Option<Index>,
    /// How far a mark may be from the boundary, in world units.
    tolerance: f64,
}

/// How far a mark may be from the boundary of polygons, as a share of the frame's longer side: far more than
/// rounding, and far less than a feature.
const TOLERANCE: f64 = 1e-6;

impl BoundaryPieces {
    /// Returns the pieces of a domain, or `None` for a domain that is given by a formula: its boundary is the
    /// boundary of its mesh.
    pub fn of_domain(domain: &Domain, marks: &BoundaryMarks) -> Option<Self> {
        let tolerance = tolerance(&domain.bounds);
        let corners = corners(&domain.bounds);
        Some(Self::new(&sided_rings(domain, &corners)?, tolerance, marks))
    }

    /// Returns the pieces of the boundary of a mesh alone, for a domain that is given by a formula. A mark
    /// counts up to half a coarse cell from the boundary.
    pub fn of_mesh(extract: &Extract, marks: &BoundaryMarks) -> Self {
        let ring =
            |nodes: &Vec<usize>| nodes.iter().map(|&node| extract.world(NodeId::from_index(node))).collect();
        let rings: Vec<Ring> = extract.boundary_loops().iter().map(ring).collect();
        let lattice = extract.lattice();
        let rings: Vec<SidedRing> = rings.iter().map(|ring| along_frame(ring, &lattice.bounds())).collect();
        Self::new(&rings, tolerance(&lattice.bounds()).max(0.5 * lattice.spacing()), marks)
    }

    /// Returns the pieces of a domain, or of its mesh for a domain that is given by a formula.
    pub fn of(domain: &Domain, extract: &Extract, marks: &BoundaryMarks) -> Self {
        Self::of_domain(domain, marks).unwrap_or_else(|| Self::of_mesh(extract, marks))
    }

    fn new(rings: &[SidedRing], tolerance: f64, marks: &BoundaryMarks) -> Self {
        let mut pieces = split(&stretches(rings), &marks.splits, tolerance);
        let index = Index::new(pieces.iter().map(|piece| &*piece.points));
        if let Some(index) = &index {
            give_marks(&mut pieces, index, marks, tolerance);
        }
        make_unique(&mut pieces);
        Self { pieces, index, tolerance }
    }

    /// Returns the pieces, by number.
    pub fn list(&self) -> &[BoundaryPiece] {
        &self.pieces
    }

    /// Returns how far a mark may be from the boundary, in world units.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the number of the piece nearest to a point within `reach`, and its nearest point.
    pub fn nearest(&self, point: DVec2, reach: f64) -> Option<(usize, DVec2)> {
        let index = self.index.as_ref()?;
        let (segment, _) =
            index.segments.nearest(point, |_| true).filter(|&(_, distance)| distance <= reach)?;
        Some((index.owner(segment), nearest_on_segment(point, index.segments.segment(segment))))
    }

    /// Returns the distances to the pieces whose numbers `counts` accepts: that to the nearest, and those up
    /// to `margin` more. Sorted by number.
    pub(super) fn distances(
        &self,
        point: DVec2,
        margin: f64,
        counts: impl Fn(usize) -> bool,
    ) -> Vec<(u32, f64)> {
        let Some(index) = &self.index else { return Vec::new() };
        let accepted = |segment: u32| counts(index.owner(segment));
        let Some((_, least)) = index.segments.nearest(point, accepted) else { return Vec::new() };
        let mut found: Vec<(u32, f64)> = Vec::new();
        index.segments.visit_within(point, least + margin, |segment, distance| {
            if accepted(segment) {
                let piece = index.owner(segment) as u32;
                match found.iter_mut().find(|(other, _)| *other == piece) {
                    Some((_, nearest)) => *nearest = nearest.min(distance),
                    None => found.push((piece, distance)),
                }
            }
        });
        found.sort_unstable_by_key(|(piece, _)| *piece);
        found
    }

    /// Returns the piece that follows on the same stretch: the one that [`Self::joined`] would join.
    pub fn next_of(&self, piece: usize) -> Option<usize> {
        let stretch = self.pieces[piece].stretch;
        let first = self.pieces.iter().position(|other| other.stretch == stretch)?;
        let count = self.pieces[first..].iter().take_while(|other| other.stretch == stretch).count();
        let next = first + (piece - first + 1) % count;
        let meet = self.pieces[piece].points.last() == self.pieces[next].points.first();
        (next != piece && meet).then_some(next)
    }

    /// Returns the marks with another name for a piece. An empty name restores the default one.
    pub fn renamed(&self, marks: &BoundaryMarks, piece: usize, name: &str) -> BoundaryMarks {
        let mut marks = marks.clone();
        marks.names.retain(|(place, _)| !self.is_on(*place, piece));
        let name = BoundaryMarks::valid_name(name);
        if !name.is_empty() {
            marks.names.push((self.pieces[piece].middle(), name));
        }
        marks
    }

    /// Returns the marks with another type for a piece; without one, the piece has its default type again.
    pub fn retyped(
        &self,
        marks: &BoundaryMarks,
        piece: usize,
        boundary_type: Option<BoundaryType>,
    ) -> BoundaryMarks {
        let mut marks = marks.clone();
        marks.types.retain(|(place, _)| !self.is_on(*place, piece));
        let middle = self.pieces[piece].middle();
        marks.types.extend(boundary_type.map(|boundary_type| (middle, boundary_type)));
        marks
    }

    /// Returns the marks with a split at the point of the boundary nearest to a point; `None` if there is
    /// none within `reach`, or the boundary is split there already.
    ///
    /// The whole of a ring stays in one piece until it is split at a second point. A name stays with the part
    /// that it is anchored on; both parts have the type.
    pub fn split(&self, marks: &BoundaryMarks, point: DVec2, reach: f64) -> Option<BoundaryMarks> {
        let (number, place) = self.nearest(point, reach)?;
        let near = |other: &DVec2| other.distance(place) <= 2.0 * self.tolerance;
        let ends = self.pieces.iter().filter(|piece| !piece.is_closed());
        let mut ends = ends.flat_map(|piece| [piece.points[0], piece.points[piece.points.len() - 1]]);
        if marks.splits.iter().any(near) || ends.any(|end| near(&end)) {
            return None;
        }
        let piece = &self.pieces[number];
        let mut divided = self.retyped(marks, number, None);
        let is_whole_ring = piece.is_closed() && !marks.splits.iter().any(|split| self.is_on(*split, number));
        let middles = if is_whole_ring { vec![piece.middle()] } else { middles_beside(&piece.points, place) };
        let types =
            piece.set_type.into_iter().flat_map(|of_piece| middles.iter().map(move |&at| (at, of_piece)));
        divided.types.extend(types);
        divided.splits.push(place);
        Some(divided)
    }

    /// Returns the marks without the split between a piece and the next one of its stretch; `None` if there
    /// is no such split. The name of the first piece stays; the name of the next one stays if the first has
    /// none. The same holds for types. Two halves of a ring become the whole ring.
    pub fn joined(&self, marks: &BoundaryMarks, piece: usize) -> Option<BoundaryMarks> {
        let next = self.next_of(piece)?;
        let starts = if self.next_of(next) == Some(piece) { vec![next, piece] } else { vec![next] };
        let starts: Vec<DVec2> = starts.into_iter().map(|n| self.pieces[n].points[0]).collect();
        let mut joined = marks.clone();
        joined.splits.retain(|split| starts.iter().all(|at| split.distance(*at) > 2.0 * self.tolerance));
        if self.pieces[piece].is_named {
            joined.names.retain(|(place, _)| !self.is_on(*place, next));
        }
        if self.pieces[piece].set_type.is_some() {
            joined.types.retain(|(place, _)| !self.is_on(*place, next));
        }
        Some(joined)
    }

    /// Returns whether a mark at a place is one of a piece.
    fn is_on(&self, place: DVec2, piece: usize) -> bool {
        self.nearest(place, self.tolerance).is_some_and(|(at, _)| at == piece)
    }
}

/// Returns the pieces of a domain as [`BoundaryPieces::of_domain`] does, without their index. Without marks
/// that takes time proportional to the corners.
pub(super) fn unindexed_pieces(domain: &Domain, marks: &BoundaryMarks) -> Option<Vec<BoundaryPiece>> {
    if !marks.is_empty() {
        return BoundaryPieces::of_domain(domain, marks).map(|pieces| pieces.pieces);
    }
    let corners = corners(&domain.bounds);
    Some(split(&stretches(&sided_rings(domain, &corners)?), &[], 0.0))
}

/// Returns how far a mark may be from the boundary of polygons in a frame.
fn tolerance(frame: &Rect) -> f64 {
    TOLERANCE * frame.size().max_element()
}

/// Returns the rings of a domain with the sides that they run along; `None` for a domain that is given by a
/// formula. `corners` are those of its bounds.
fn sided_rings<'a>(domain: &'a Domain, corners: &'a Ring) -> Option<Vec<SidedRing<'a>>> {
    match &domain.shape {
        DomainShape::Whole => Some(vec![along_frame(corners, &domain.bounds)]),
        DomainShape::Region(region) => {
            let rings = region.rings().zip(region.sides());
            Some(rings.map(|(corners, sides)| SidedRing { corners, sides }).collect())
        }
        DomainShape::Formula(_) => None,
    }
}

/// Returns a ring with the sides of a frame that its edges run along.
fn along_frame<'a>(ring: &'a Ring, frame: &Rect) -> SidedRing<'a> {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    SidedRing { corners: ring, sides: edges.map(|(&a, &b)| FrameSide::of([a, b], frame)).collect() }
}

/// The segments of all pieces.
#[derive(Clone, Debug)]
struct Index {
    segments: Segments,
    /// The number after the last segment of each piece.
    ends: Vec<usize>,
}

impl Index {
    fn new<'a>(polylines: impl Iterator<Item = &'a [DVec2]>) -> Option<Self> {
        let (mut segments, mut ends) = (Vec::new(), Vec::new());
        for points in polylines {
            segments.extend(points.windows(2).map(|pair| [pair[0], pair[1]]));
            ends.push(segments.len());
        }
        Some(Self { segments: Segments::new(segments)?, ends })
    }

    /// Returns the number of the polyline of a segment.
    fn owner(&self, segment: u32) -> usize {
        self.ends.partition_point(|&end| end <= segment as usize)
    }

    /// Returns the number of a segment within its polyline.
    fn place(&self, segment: u32) -> usize {
        let owner = self.owner(segment);
        segment as usize - if owner == 0 { 0 } else { self.ends[owner - 1] }
    }
}

/// A place on a polyline: the number of a segment, and a point on it.
type PointOnPolyline = (usize, DVec2);

/// Returns the pieces of stretches that are split at the points on them.
fn split(stretches: &[Stretch], splits: &[DVec2], tolerance: f64) -> Vec<BoundaryPiece> {
    let mut cuts: Vec<Vec<PointOnPolyline>> = vec![Vec::new(); stretches.len()];
    let index = if splits.is_empty() { None } else { Index::new(stretches.iter().map(|s| &*s.points)) };
    for (&split, index) in splits.iter().flat_map(|split| Some((split, index.as_ref()?))) {
        let Some((segment, _)) = index.segments.nearest(split, |_| true).filter(|(_, d)| *d <= tolerance)
        else {
            continue;
        };
        let ends = index.segments.segment(segment);
        cuts[index.owner(segment)].push((index.place(segment), nearest_on_segment(split, ends)));
    }
    let mut pieces = Vec::new();
    for (number, (stretch, mut cuts)) in stretches.iter().zip(cuts).enumerate() {
        let along = |&(segment, point): &PointOnPolyline| (segment, stretch.points[segment].distance(point));
        let along_stretch = |cut: &PointOnPolyline| length(&stretch.points[..=cut.0]) + along(cut).1;
        cuts.sort_by(|a, b| along(a).partial_cmp(&along(b)).expect("no distance is NaN"));
        cuts.dedup_by(|a, b| a.1.distance(b.1) <= tolerance);
        let start = cuts.first().filter(|_| stretch.is_closed()).map_or(0.0, along_stretch);
        let parts = parts(&stretch.points, stretch.is_closed(), cuts, tolerance);
        let mut along = stretch.place.along + start;
        let parts = parts.into_iter().map(|points| {
            let place = PlaceOnRing { along, ..stretch.place };
            along += length(&points);
            (place, points)
        });
        let count = parts.len();
        for (part, (place, points)) in (1..).zip(parts) {
            let name =
                if count == 1 { stretch.name.clone() } else { format!("{} part {part}", stretch.name) };
            let (kind, side) = (stretch.kind, stretch.side);
            pieces.push(BoundaryPiece {
                name,
                kind,
                is_named: false,
                set_type: None,
                points,
                side,
                place,
                stretch: number,
            });
        }
    }
    pieces
}

/// Returns the parts of a polyline between cuts, which are in its order. A closed one is cut open at the
/// first, and stays in one part if there is no other.
fn parts(
    points: &[DVec2],
    is_closed: bool,
    mut cuts: Vec<PointOnPolyline>,
    tolerance: f64,
) -> Vec<Vec<DVec2>> {
    let last = points.len() - 1;
    if is_closed {
        let Some(&first) = cuts.first() else { return vec![points.to_vec()] };
        cuts.push((first.0 + last, first.1));
    } else {
        let is_end = |point: DVec2| point.distance(points[0]).min(point.distance(points[last])) <= tolerance;
        cuts.retain(|&(_, point)| !is_end(point));
        cuts.insert(0, (0, points[0]));
        cuts.push((last - 1, points[last]));
    }
    let between = |ends: &[PointOnPolyline]| {
        let [(from, start), (to, end)] = [ends[0], ends[1]];
        // The last point of a closed polyline is its first.
        let inner =
            (from + 1..=to).map(|n| if n >= last && is_closed { points[n - last] } else { points[n] });
        let mut part: Vec<DVec2> = [start].into_iter().chain(inner).chain([end]).collect();
        part.dedup();
        part
    };
    cuts.windows(2).map(between).collect()
}

/// Gives each piece the first name and the first type that are anchored on it.
fn give_marks(pieces: &mut [BoundaryPiece], index: &Index, marks: &BoundaryMarks, tolerance: f64) {
    let piece_at = |place: DVec2| {
        let nearest = index.segments.nearest(place, |_| true).filter(|&(_, distance)| distance <= tolerance);
        nearest.map(|(segment, _)| index.owner(segment))
    };
    for (place, name) in &marks.names {
        let Some(number) = piece_at(*place) else { continue };
        let piece = &mut pieces[number];
        if !piece.is_named {
            (piece.name, piece.is_named) = (name.clone(), true);
        }
    }
    for (place, boundary_type) in &marks.types {
        if let Some(number) = piece_at(*place) {
            pieces[number].set_type.get_or_insert(*boundary_type);
        }
    }
}

/// Returns the point halfway along a polyline.
pub(super) fn middle(points: &[DVec2]) -> DVec2 {
    let mut left = 0.5 * length(points);
    for ends in points.windows(2) {
        let [a, b] = [ends[0], ends[1]];
        let edge = a.distance(b);
        if left <= edge && edge > 0.0 {
            return a.lerp(b, left / edge);
        }
        left -= edge;
    }
    points[0]
}

/// Returns the points halfway along the two parts of a polyline that a place on it divides.
fn middles_beside(points: &[DVec2], place: DVec2) -> Vec<DVec2> {
    let distance = |n: usize| nearest_on_segment(place, [points[n], points[n + 1]]).distance(place);
    let nearest = (0..points.len() - 1).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    let (before, after) = points.split_at(1 + nearest.expect("a piece has a segment"));
    vec![middle(&[before, &[place]].concat()), middle(&[&[place], after].concat())]
}

/// Adds a number to names that occur again. Given names come first. `domain` is the name of the triangles in
/// files.
fn make_unique(pieces: &mut [BoundaryPiece]) {
    let mut taken: BTreeSet<String> = BTreeSet::from(["domain".to_owned()]);
    // The next number to try for each name, as thousands of pieces can have the same.
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for is_named in [true, false] {
        for piece in pieces.iter_mut().filter(|piece| piece.is_named == is_named) {
            let mut unique = piece.name.clone();
            while !taken.insert(unique.clone()) {
                let number = numbers.entry(piece.name.clone()).or_insert(1);
                *number += 1;
                unique = format!("{} {number}", piece.name);
            }
            piece.name = unique;
        }
    }
}
