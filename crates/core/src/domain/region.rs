//! Regions: polygons with holes in a rectangle, and their overlay.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::i_float::int::point::IntPoint;

use super::cut_frame::{CutFrame, FrameSide};
use super::cut_search::OutlineOnEarth;
use crate::geometry::{Rect, signed_area};

/// A closed polyline in world units; an edge joins the last point to the first, which is not repeated.
pub type Ring = Vec<DVec2>;

/// An outer ring, then the rings of its holes.
pub type Polygon = Vec<Ring>;

/// The part of a rectangle, its *frame*, that polygons cover.
///
/// Outer rings run anticlockwise and holes clockwise; no two edges cross. Points lie on a fine grid over the
/// frame: so an edit leaves every edge that it does not touch unchanged, bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    frame: Rect,
    /// The area in square world units. It is declared before the polygons, so that it is compared first:
    /// regions that differ rarely have equal areas.
    area: f64,
    polygons: Vec<Polygon>,
    /// The rectangles that cut it off from its surroundings.
    cuts: Vec<CutFrame>,
}

// `PartialEq` compares all data, and no number is NaN. With `Eq`, `Arc<Region>` compares pointers before the
// data, so that comparing settings that share a region takes no time.
impl Eq for Region {}

impl Region {
    /// Returns the region that the polygons cover within `frame`. They may overlap. A polygon covers what its
    /// first ring encloses, without what its other rings enclose. A ring may have either direction, cross
    /// itself, or run around a point several times.
    ///
    /// `frame` must be proper and all points finite.
    pub fn new(polygons: &[Polygon], frame: Rect) -> Self {
        Self::from_simple_polygons(frame, Self::covered(polygons, frame)).on_earth(&OutlineOnEarth::default())
    }

    /// Returns the polygons of the region that others cover, as [`Self::new`] does.
    pub(super) fn covered(polygons: &[Polygon], frame: Rect) -> Vec<Polygon> {
        let grid = Grid::over(&frame);
        let simple: Vec<IntShape> = polygons
            .iter()
            .filter_map(|rings| {
                grid.contours(rings).split_first().map(|(outer, holes)| {
                    overlay(std::slice::from_ref(outer), holes, OverlayOperation::WITHOUT_HOLES)
                })
            })
            .flatten()
            .collect();
        let contours: Vec<IntContour> = simple.into_iter().flatten().collect();
        Self::cut_to_frame(&grid, &contours).polygons
    }

    /// Returns the region on the left of some rings, within a frame that was not chosen to cut it.
    pub(super) fn enclosed_on_left(rings: &[Ring], frame: Rect) -> Self {
        let grid = Grid::over(&frame);
        Self::cut_to_frame(&grid, &grid.contours(rings))
    }

    /// Returns points on the grid of the regions in a frame, without repetitions.
    pub(super) fn snapped(points: &[DVec2], frame: &Rect) -> Ring {
        let grid = Grid::over(frame);
        let mut snapped: Ring = grid.contour(points).iter().map(|at| grid.world(at)).collect();
        snapped.dedup();
        snapped
    }

    /// Returns the region with exactly these polygons, if they are valid polygons of a region; otherwise the
    /// region that they cover.
    ///
    /// Another overlay would move a corner here and there, where edges nearly touch. So valid polygons are
    /// not overlaid.
    pub(super) fn stored(polygons: Vec<Polygon>, frame: Rect) -> Self {
        let stored = Self::from_simple_polygons(frame, polygons);
        let grid = Grid::over(&frame);
        let on_grid = |ring: &Ring| grid.contour(ring).iter().zip(ring).all(|(p, q)| grid.world(p) == *q);
        let turned = |rings: &Polygon| {
            !rings.is_empty()
                && rings.iter().enumerate().all(|(n, ring)| (signed_area(ring) > 0.0) == (n == 0))
        };
        let within = |ring: &Ring| ring.len() > 2 && ring.iter().all(|&p| frame.contains(p)) && on_grid(ring);
        // Overlaps and crossings would count twice in one of the areas. Their overlay takes the longest.
        let alike = || {
            let covered = Self::cut_to_frame(&grid, &grid.contours_of(&stored)).area();
            (stored.area() - covered).abs() <= 1e-6 * covered
        };
        let valid = stored.polygons.iter().all(turned) && stored.rings().all(within) && alike();
        if valid { stored.on_earth(&OutlineOnEarth::default()) } else { Self::new(&stored.polygons, frame) }
    }

    fn from_simple_polygons(frame: Rect, polygons: Vec<Polygon>) -> Self {
        let area = polygons.iter().flatten().map(|ring| signed_area(ring)).sum();
        Self { frame, polygons, area, cuts: Vec::new() }
    }

    /// Returns the region with the rectangles that cut it: its frame, if that was chosen and is not just the
    /// bounding rectangle; and the one by which its outline was cut before.
    pub(super) fn on_earth(self, on_earth: &OutlineOnEarth) -> Self {
        let bounds = Rect::holding(self.rings().flatten().copied());
        let chosen = (bounds != Some(self.frame)).then(|| CutFrame::from_world(self.frame));
        if on_earth.frame.is_some() {
            let known = CutFrame::of_region(&self, on_earth);
            return Self { cuts: known.into_iter().collect(), ..self };
        }
        let is_alone = chosen.is_none() || *on_earth != OutlineOnEarth::default();
        let found = is_alone.then(|| CutFrame::of_region(&self, on_earth)).flatten();
        // Nobody chose the bounding rectangle of what a chosen frame leaves.
        let found = found.filter(|found| chosen.is_none() || found.coordinates.is_some());
        let cuts = chosen.into_iter().chain(found).collect();
        Self { cuts, ..self }
    }

    /// Returns the region with other rectangles that cut it.
    pub(super) fn cut_by(self, cuts: Vec<CutFrame>) -> Self {
        Self { cuts, ..self }
    }

    /// Returns the rectangles that cut it off from its surroundings: edges along their sides are open.
    pub fn cuts(&self) -> &[CutFrame] {
        &self.cuts
    }

    /// Returns the side of a rectangle that cuts it along which each edge runs, ring by ring, in the order of
    /// [`Self::rings`]: number n is the edge from corner n.
    pub(super) fn sides(&self) -> Vec<Vec<Option<FrameSide>>> {
        let rings: Vec<&Ring> = self.rings().collect();
        let size = self.frame.size().max_element();
        let mut sides: Vec<Vec<Option<FrameSide>>> =
            rings.iter().map(|ring| vec![None; ring.len()]).collect();
        for cut in &self.cuts {
            for (all, of_cut) in sides.iter_mut().flatten().zip(cut.sides(&rings, size).into_iter().flatten())
            {
                *all = all.or(of_cut);
            }
        }
        sides
    }

    fn cut_to_frame(grid: &Grid, contours: &[IntContour]) -> Self {
        grid.region(overlay(contours, &[grid.contour(&corners(&grid.frame))], OverlayOperation::BOTH))
    }

    /// Returns the rectangle that contains the region, in world units.
    pub fn frame(&self) -> &Rect {
        &self.frame
    }

    /// Returns the polygons, which do not overlap.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }

    /// Returns whether nothing is covered.
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// Returns all rings, including those of holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        self.polygons.iter().flatten()
    }

    /// Returns all edges as [from, to], with the region on the left.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> {
        let mut cursor = EdgeCursor::default();
        std::iter::from_fn(move || cursor.next(self))
    }

    /// Returns the number of corners, which is also the number of edges.
    pub fn corner_count(&self) -> usize {
        self.rings().map(Vec::len).sum()
    }

    /// Returns the memory of the rings, in bytes.
    pub fn bytes(&self) -> usize {
        self.rings().map(|ring| size_of::<Ring>() + size_of_val(&**ring)).sum()
    }

    /// Returns the number of holes.
    pub fn hole_count(&self) -> usize {
        self.polygons.iter().map(|rings| rings.len() - 1).sum()
    }

    /// Returns an overlay of the region with rings in its frame.
    pub(super) fn overlaid(&self, rings: &[Ring], rule: OverlayRule, fill: FillRule) -> Self {
        let grid = Grid::over(&self.frame);
        let operation = OverlayOperation(rule, fill);
        grid.region(overlay(&grid.contours_of(self), &grid.contours(rings), operation))
            .cut_by(self.cuts.clone())
    }

    /// Returns the bounded connected parts of the plane that neither the region nor the domain of some rings
    /// covers, except parts that are no wider than the rounding errors of an overlay. The rings have their
    /// domain on the left and do not cross each other.
    pub(super) fn parts_beside(&self, rings: &[Ring]) -> Vec<Polygon> {
        let grid = Grid::over(&self.frame);
        let mut covered = grid.contours_of(self);
        covered.extend(grid.contours(rings));
        let around = grid.contour_around();
        let mut parts = overlay(std::slice::from_ref(&around), &covered, OverlayOperation::WITHOUT_HOLES);
        parts.retain(|part| !part[0].iter().any(|corner| around.contains(corner)));
        let mut parts = grid.polygons(&parts);
        // Corners move by at most one step, so that only a strip of two steps can come from rounding.
        let strip = 2.0 * grid.step.max_element();
        parts.retain(|part| {
            let length = part.iter().map(|ring| perimeter(ring)).sum::<f64>();
            part.iter().map(|ring| signed_area(ring)).sum::<f64>() > strip * length
        });
        parts
    }

    /// Returns the area covered, in square world units.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the union with the points that at least one of the rings encloses, within the frame.
    pub fn with(&self, rings: &[Ring]) -> Self {
        let with = self.combined(rings, OverlayOperation::EITHER);
        // What nothing had cut can reach the frame now.
        if self.cuts.is_empty() { with.on_earth(&OutlineOnEarth::default()) } else { with }
    }

    /// Returns the difference from the points that at least one of the rings encloses.
    pub fn without(&self, rings: &[Ring]) -> Self {
        self.combined(rings, OverlayOperation::FIRST_ONLY)
    }

    /// Returns the part within another region, whose open sides stay open.
    pub(super) fn within(&self, other: &Self) -> Self {
        let grid = Grid::over(&self.frame);
        let both = overlay(&grid.contours_of(self), &grid.contours_of(other), OverlayOperation::BOTH);
        grid.region(both).cut_by(other.cuts.clone())
    }

    fn combined(&self, rings: &[Ring], rule: OverlayOperation) -> Self {
        let grid = Grid::over(&self.frame);
        let frame = [grid.contour(&corners(&self.frame))];
        let within: Vec<IntContour> =
            overlay(&grid.contours(rings), &frame, OverlayOperation::BOTH).into_iter().flatten().collect();
        grid.region(overlay(&grid.contours_of(self), &within, rule)).cut_by(self.cuts.clone())
    }

    /// Returns the region in another frame, clipped to it. What was open stays open.
    pub fn reframed(&self, frame: Rect) -> Self {
        let reframed = Self::new(&self.polygons, frame);
        let (rings, size) = (reframed.rings().collect::<Vec<_>>(), frame.size().max_element());
        let is_met =
            |cut: &&CutFrame| cut.sides(&rings, size).into_iter().flatten().any(|side| side.is_some());
        let earlier: Vec<CutFrame> = self.cuts.iter().filter(is_met).cloned().collect();
        let chosen = CutFrame::from_world(frame);
        let is_chosen = reframed.cuts.contains(&chosen) && !earlier.contains(&chosen);
        reframed.cut_by(earlier.into_iter().chain(is_chosen.then_some(chosen)).collect())
    }
}

/// A position between two edges of a region, or before the first or after the last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeCursor {
    polygon: usize,
    ring: usize,
    corner: usize,
}

impl EdgeCursor {
    /// Moves past the next edge and returns it, with the region on its left.
    pub(super) fn next(&mut self, region: &Region) -> Option<[DVec2; 2]> {
        loop {
            let rings = region.polygons.get(self.polygon)?;
            let Some(ring) = rings.get(self.ring) else {
                *self = Self { polygon: self.polygon + 1, ring: 0, corner: 0 };
                continue;
            };
            if let Some(&from) = ring.get(self.corner) {
                self.corner += 1;
                return Some([from, ring[self.corner % ring.len()]]);
            }
            (self.ring, self.corner) = (self.ring + 1, 0);
        }
    }

    /// Returns the number of edges after the cursor in its ring.
    pub(super) fn left_in_ring(&self, region: &Region) -> usize {
        self.ring_of(region).map_or(0, |ring| ring.len() - self.corner)
    }

    /// Returns the position after the last edge of the ring.
    pub(super) fn after_ring(&self, region: &Region) -> Self {
        Self { corner: self.corner + self.left_in_ring(region), ..*self }
    }

    /// Returns an edge after the cursor in its ring; number 0 is the next one.
    pub(super) fn edge_in_ring(&self, region: &Region, number: usize) -> [DVec2; 2] {
        let ring = self.ring_of(region).expect("there is an edge, so there is a ring");
        [ring[self.corner + number], ring[(self.corner + number + 1) % ring.len()]]
    }

    fn ring_of<'a>(&self, region: &'a Region) -> Option<&'a Ring> {
        region.polygons.get(self.polygon)?.get(self.ring)
    }
}

/// Returns the corners of a rectangle, anticlockwise.
pub fn corners(rect: &Rect) -> Ring {
    let Rect { min, max } = *rect;
    vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]
}

/// Returns the length of a ring, in world units.
fn perimeter(ring: &[DVec2]) -> f64 {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
}

type IntContour = Vec<IntPoint<i64>>;
type IntShape = Vec<IntContour>;

/// Which points belong to the result of an overlay.
#[derive(Clone, Copy)]
struct OverlayOperation(OverlayRule, FillRule);

impl OverlayOperation {
    /// Points of either one; of a single set, points that its rings enclose an odd number of times.
    const EITHER: Self = Self(OverlayRule::Union, FillRule::EvenOdd);
    /// Points of both; contours of the first may overlap.
    const BOTH: Self = Self(OverlayRule::Intersect, FillRule::NonZero);
    /// Points of the first set only. A contour encloses all points that it runs around, whatever its
    /// direction.
    const WITHOUT_HOLES: Self = Self(OverlayRule::Difference, FillRule::NonZero);
    /// Points of the first only.
    const FIRST_ONLY: Self = Self(OverlayRule::Difference, FillRule::EvenOdd);
}

fn overlay(
    first: &[IntContour],
    second: &[IntContour],
    OverlayOperation(rule, fill): OverlayOperation,
) -> Vec<IntShape> {
    let corners = first.iter().chain(second).map(Vec::len).sum();
    // As the OGC standard requires: a hole that touches another ring at one point stays a hole.
    let mut overlay = Overlay::new_custom(corners, IntOverlayOptions::ogc(), Solver::default());
    overlay.add_source(first, ShapeType::Subject);
    overlay.add_source(second, ShapeType::Clip);
    overlay.overlay(rule, fill)
}

/// The grid of the corners of a region: 2³⁰ steps along each side of the frame, or fewer if f64 cannot
/// distinguish them.
struct Grid {
    frame: Rect,
    steps: f64,
    step: DVec2,
}

const GRID_BITS: i32 = 30;

impl Grid {
    fn over(frame: &Rect) -> Self {
        let reach = frame.min.abs().max(frame.max.abs()).max_element();
        let ulp = reach.next_up() - reach;
        let mut steps = f64::from(1 << GRID_BITS);
        // A power of two: a step is as exact as the side, and points on the grid keep their coordinates.
        while steps > 2.0 && (frame.size() / steps).min_element() < 4.0 * ulp {
            steps /= 2.0;
        }
        Self { frame: *frame, steps, step: frame.size() / steps }
    }

    fn contour(&self, ring: &[DVec2]) -> IntContour {
        let nearest = |p: &DVec2| {
            // Points far outside the frame are clipped later anyway.
            let steps = ((*p - self.frame.min) / self.step).clamp(DVec2::splat(-1e12), DVec2::splat(1e12));
            IntPoint::new((steps.x + 0.5).floor() as i64, (steps.y + 0.5).floor() as i64)
        };
        ring.iter().map(nearest).collect()
    }

    fn contours(&self, rings: &[Ring]) -> Vec<IntContour> {
        rings.iter().map(|ring| self.contour(ring)).collect()
    }

    fn contours_of(&self, region: &Region) -> Vec<IntContour> {
        region.rings().map(|ring| self.contour(ring)).collect()
    }

    fn world(&self, p: &IntPoint<i64>) -> DVec2 {
        let place = |k: i64, min: f64, max: f64, step: f64| {
            if k as f64 == self.steps { max } else { min + k as f64 * step }
        };
        let Rect { min, max } = self.frame;
        DVec2::new(place(p.x, min.x, max.x, self.step.x), place(p.y, min.y, max.y, self.step.y))
    }

    /// Returns a square around the frame that does not touch it.
    fn contour_around(&self) -> IntContour {
        let (low, high) = (-8, self.steps as i64 + 8);
        [[low, low], [high, low], [high, high], [low, high]].map(|[x, y]| IntPoint::new(x, y)).to_vec()
    }

    fn polygons(&self, shapes: &[IntShape]) -> Vec<Polygon> {
        let ring = |contour: &IntContour| contour.iter().map(|p| self.world(p)).collect();
        shapes.iter().map(|shape| shape.iter().map(ring).collect()).collect()
    }

    fn region(&self, shapes: Vec<IntShape>) -> Region {
        Region::from_simple_polygons(self.frame, self.polygons(&shapes))
    }
}

#[cfg(test)]
mod tests {
    use std::slice;
    use std::sync::Arc;

    use glam::dvec2;

    use super::*;
    use crate::domain::RegionComparison;
    use crate::mesh::Progress;

    fn square(centre: DVec2, half: f64) -> Ring {
        corners(&Rect::around(centre, half))
    }

    fn areas_changed(a: &Region, b: &Region) -> Vec<Rect> {
        let mut comparison = RegionComparison::new(Arc::new(a.clone()), Arc::new(b.clone()));
        while comparison.advance(7) == Progress::More {}
        comparison.areas().to_vec()
    }

    fn unit(polygons: &[Polygon]) -> Region {
        Region::new(polygons, Rect::UNIT)
    }

    #[test]
    fn winding_overlaps_and_crossings_are_resolved() {
        let centre = DVec2::splat(0.5);
        let hole = square(centre, 0.125);
        let mut clockwise = square(centre, 0.25);
        clockwise.reverse();
        for outer in [square(centre, 0.25), clockwise] {
            let region = unit(&[vec![outer, hole.clone()]]);
            assert_eq!((region.area(), region.hole_count()), (0.25 - 0.0625, 1));
        }
        // Two polygons that overlap cover their union, and a part beyond the frame is cut off.
        let region = unit(&[vec![square(centre, 0.25)], vec![square(DVec2::ONE, 0.375)]]);
        assert_eq!(region.area(), 0.25 + 0.140625 - 0.015625);
        // A ring that runs around twice covers the same area as once, and a hole outside its ring adds
        // nothing.
        let twice = [square(centre, 0.25), square(centre, 0.25)].concat();
        assert_eq!(unit(&[vec![twice]]).area(), 0.25);
        let outside = vec![square(centre, 0.25), square(dvec2(0.1, 0.1), 0.0625)];
        assert_eq!(unit(&[outside]).area(), 0.25);
        // A figure of eight: both lobes.
        let bow = vec![dvec2(0.0, 0.0), dvec2(1.0, 1.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)];
        assert!((unit(&[vec![bow]]).area() - 0.5).abs() < 1e-8);
    }

    #[test]
    fn an_edit_leaves_distant_edges_unchanged_and_the_comparison_finds_it() {
        let frame = Rect::new(dvec2(4.0e6, -7.0e6), dvec2(4.0e6 + 900.0, -7.0e6 + 700.0));
        let ring = (0..200).map(|k| f64::from(k) * 0.03141).map(|angle| {
            frame.center()
                + dvec2(300.0 * libm::cos(angle), 300.0 * libm::sin(angle) + 20.0 * libm::sin(9.0 * angle))
        });
        let region = Region::new(&[vec![ring.collect()]], frame);
        let again = region.reframed(frame);
        assert_eq!(again, region, "points on the grid keep their coordinates");
        let dab = square(frame.center() + dvec2(300.0, 0.0), 10.0);
        for edited in [region.with(slice::from_ref(&dab)), region.without(slice::from_ref(&dab))] {
            let areas = areas_changed(&region, &edited);
            let near = Rect::around(frame.center() + dvec2(300.0, 0.0), 30.0);
            assert!(
                !areas.is_empty()
                    && areas.iter().all(|area| near.contains(area.min) && near.contains(area.max))
            );
        }
        let restored = region.with(slice::from_ref(&dab)).without(slice::from_ref(&dab));
        assert!((restored.area() - region.without(slice::from_ref(&dab)).area()).abs() < 1e-3);
        assert!(areas_changed(&region, &region).is_empty());
    }

    #[test]
    fn edges_on_both_sides_of_an_edit_are_skipped() {
        let ring = |radius: f64| {
            let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / 1000.0;
            (0..1000).map(|k| DVec2::splat(0.5) + radius * DVec2::from_angle(angle(k))).collect::<Ring>()
        };
        let region = unit(&[vec![ring(0.3)]]);
        let edited = region.without(&[square(dvec2(0.8, 0.5), 0.001)]);
        let mut comparison = RegionComparison::new(Arc::new(region), Arc::new(edited));
        let steps = (0..).find(|_| comparison.advance(1) == Progress::Done).unwrap();
        // Each edge once, and those of the edit in the three passes.
        assert!(steps < 1100, "{steps}");
        assert!(!comparison.areas().is_empty());
    }

    #[test]
    fn removing_the_whole_frame_leaves_an_empty_region() {
        let region = unit(&[vec![square(DVec2::splat(0.5), 0.3)]]);
        assert!(region.without(&[square(DVec2::splat(0.5), 5.0)]).is_empty());
        assert_eq!(region.with(&[square(DVec2::splat(0.5), 5.0)]).area(), 1.0);
        assert!(unit(&[]).is_empty() && unit(&[vec![vec![DVec2::ZERO, DVec2::ONE]]]).is_empty());
    }
}
