//! Which holes of a region a mesh covers, and which holes of the mesh the region does not have.

use glam::DVec2;

use super::segments::Segments;
use super::{Region, Ring, signed_area};
use crate::earth::Ground;

/// A hole of a region or of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleFigures {
    /// A point in world units: one of the corners of a hole of a region, or a point in a hole of a mesh.
    pub place: DVec2,
    /// The area of the hole without the parts of the domain in it, in square world units; of
    /// [`FitQuality`](super::FitQuality) as its other areas.
    pub area: f64,
}

impl HoleFigures {
    /// Returns the hole with its area on the ground. It is small compared with the Earth.
    pub(super) fn on_ground(self, ground: &Ground) -> Self {
        Self { area: ground.area_around(self.area, self.place), ..self }
    }
}

/// How the holes of a region and of a mesh of it correspond.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct HoleComparison {
    /// The holes of the region that lie wholly under triangles of the mesh, the largest first.
    pub(super) lost: Vec<HoleFigures>,
    /// The holes of the mesh that contain no part of a hole of the region, the largest first.
    pub(super) new: Vec<HoleFigures>,
}

/// Compares the holes of a region with those of a mesh, given by the loops of its boundary.
///
/// The area that neither of them covers consists of connected parts. Each part is in one hole of the region
/// or outside it, and in one hole of the mesh or outside it. A hole of the region without such a part is
/// covered by the mesh. A hole of the mesh is new if none of its parts is in a hole of the region. The time
/// is proportional to n log n for n edges, as long as a horizontal line crosses few of them.
pub(super) fn compare_holes(region: &Region, loops: &[Ring]) -> HoleComparison {
    let [of_region, of_mesh] = [Complement::new(region.rings()), Complement::new(loops.iter())];
    let mut is_lost = vec![true; of_region.rings.len()];
    let mut is_new = vec![true; of_mesh.rings.len()];
    for part in region.parts_beside(loops) {
        let Some(point) = inner_point(&part) else { continue };
        let Some(island) = of_region.hole_of(point) else { continue };
        is_lost[island] = false;
        if let Some(hole) = of_mesh.hole_of(point) {
            is_new[hole] = false;
        }
    }
    let lost = of_region.holes().filter(|(ring, _)| is_lost[*ring]);
    let new = of_mesh.holes().filter(|(ring, _)| is_new[*ring]);
    let lost = lost.map(|(ring, hole)| hole.figures(of_region.rings[ring][0]));
    let new = new.filter_map(|(_, hole)| Some(hole.figures(inner_point(&hole.rings)?)));
    HoleComparison { lost: largest_first(lost), new: largest_first(new) }
}

fn largest_first(holes: impl Iterator<Item = HoleFigures>) -> Vec<HoleFigures> {
    let mut holes: Vec<HoleFigures> = holes.collect();
    holes.sort_by(|a, b| b.area.total_cmp(&a.area));
    holes
}

/// The complement of a domain that is given by rings with the domain on their left.
struct Complement<'a> {
    rings: Vec<&'a Ring>,
    /// The area that each ring encloses, in square world units; negative for the ring of a hole.
    areas: Vec<f64>,
    /// For each ring, the hole of the domain on its right: the hole itself for the ring of a hole; for an
    /// outer ring the hole that contains it, if any.
    holes: Vec<Option<usize>>,
    segments: Option<Segments>,
    /// For each segment, the number of its ring.
    owners: Vec<u32>,
}

impl<'a> Complement<'a> {
    fn new(rings: impl Iterator<Item = &'a Ring>) -> Self {
        let rings: Vec<&Ring> = rings.filter(|ring| ring.len() > 2).collect();
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        for (owner, ring) in rings.iter().enumerate() {
            segments.extend(ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]));
            owners.resize(segments.len(), owner as u32);
        }
        let areas = rings.iter().map(|ring| signed_area(ring)).collect();
        let holes = Vec::with_capacity(rings.len());
        let mut complement = Self { rings, areas, holes, segments: Segments::new(segments), owners };
        complement.holes = complement.holes_on_the_right();
        complement
    }

    fn is_hole(&self, ring: usize) -> bool {
        self.areas[ring] < 0.0
    }

    /// Finds the hole on the right of each ring. For an outer ring, it finds the ring to the left of its
    /// leftmost point; both have the same hole on their right. Rings are visited from left to right, so the
    /// hole of that ring is already known.
    fn holes_on_the_right(&self) -> Vec<Option<usize>> {
        let leftmost = |ring: &&Ring| {
            let by_x = |a: &&DVec2, b: &&DVec2| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
            *ring.iter().min_by(by_x).expect("a ring has corners")
        };
        let starts: Vec<DVec2> = self.rings.iter().map(leftmost).collect();
        let mut order: Vec<usize> = (0..self.rings.len()).collect();
        order.sort_by(|&a, &b| starts[a].x.total_cmp(&starts[b].x).then(a.cmp(&b)));
        let mut ranks = vec![0; order.len()];
        order.iter().enumerate().for_each(|(rank, &ring)| ranks[ring] = rank);
        let mut holes = vec![None; self.rings.len()];
        for (rank, &ring) in order.iter().enumerate() {
            let is_before = |segment: u32| ranks[self.owners[segment as usize] as usize] < rank;
            let left = || self.segments.as_ref()?.first_to_the_left(starts[ring], is_before);
            holes[ring] = if self.is_hole(ring) {
                Some(ring)
            } else {
                left().and_then(|segment| holes[self.owners[segment as usize] as usize])
            };
        }
        holes
    }

    /// Returns the holes, each with the number of its ring.
    fn holes(&self) -> impl Iterator<Item = (usize, Hole<'a>)> {
        let none = || Hole { rings: Vec::new(), area: 0.0 };
        let mut holes: Vec<Hole> = self.rings.iter().map(|_| none()).collect();
        // The ring of the hole itself comes first.
        let own_first = (0..holes.len()).filter(|&ring| self.is_hole(ring));
        let rings = own_first.chain((0..holes.len()).filter(|&ring| !self.is_hole(ring)));
        for (ring, hole) in rings.filter_map(|ring| Some((ring, self.holes[ring]?))) {
            holes[hole].rings.push(self.rings[ring]);
            holes[hole].area -= self.areas[ring];
        }
        holes.into_iter().enumerate().filter(|(_, hole)| !hole.rings.is_empty())
    }

    /// Returns the hole that contains a point of the complement, or `None`.
    fn hole_of(&self, point: DVec2) -> Option<usize> {
        let segment = self.segments.as_ref()?.first_to_the_left(point, |_| true)?;
        self.holes[self.owners[segment as usize] as usize]
    }
}

/// A bounded part of the complement.
struct Hole<'a> {
    /// The ring of the hole, then the outer rings within it.
    rings: Vec<&'a Ring>,
    /// The area of the hole, in square world units.
    area: f64,
}

impl Hole<'_> {
    fn figures(&self, place: DVec2) -> HoleFigures {
        HoleFigures { place, area: self.area }
    }
}

/// Returns a point in a polygon: the middle of the longest part of a horizontal line through it, halfway up.
/// `None` for one without a height.
fn inner_point(rings: &[impl AsRef<[DVec2]>]) -> Option<DVec2> {
    let heights = rings.first()?.as_ref().iter().map(|p| p.y);
    let [low, high] =
        [heights.clone().fold(f64::INFINITY, f64::min), heights.fold(f64::NEG_INFINITY, f64::max)];
    let y = 0.5 * (low + high);
    let mut crossings: Vec<f64> = Vec::new();
    for ring in rings.iter().map(AsRef::as_ref) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (a.y <= y) != (b.y <= y) {
                crossings.push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    let inside = crossings.chunks_exact(2).map(|ends| [ends[0], ends[1]]);
    let [left, right] = inside.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    Some(DVec2::new(0.5 * (left + right), y))
}
