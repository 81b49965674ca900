//! The part of the plane where paths may go.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use super::path_mesh::contains;
use super::{Passage, PathError, Waypoint};
use crate::domain::{BoundaryTreatment, Domain, RegionOutline};
use crate::geometry::{Rect, Side, nearest_on_segment, side_of_points};
use crate::layers::{Coverage, Mask};

/// Where paths may go: on the polygons that a domain is given by, out of keep-out regions, and no nearer than
/// the clearance to what is not covered by the polygons and to the regions.
///
/// Beyond the rectangle of the domain there is no land: a path may follow its sides. Clones share their data.
#[derive(Clone, Debug)]
pub struct PathArea {
    keep_out: Arc<[Mask]>,
    outline: Option<Arc<RegionOutline>>,
    /// In the plane, in world units.
    clearance: f64,
    /// How many world units a unit of the asked clearance has in the plane, at most.
    scale: f64,
}

impl Default for PathArea {
    fn default() -> Self {
        Self::outside_of(&[])
    }
}

/// Distances are reduced by this share, and by this share of the largest coordinate, so that rounding never
/// makes one too long.
const ROUNDING: [f64; 2] = [1e-12, 1e-14];

impl PathArea {
    /// Returns the area of paths through a domain that stay out of regions, with a clearance in world units:
    /// in the plane of a projection, in metres on the Earth. The outline that meshes of the domain meet
    /// limits it, if there is one; where there is none, only the triangles of a mesh do.
    ///
    /// # Errors
    /// Fails when the clearance is negative, NaN or infinite.
    pub fn new(
        domain: &Domain,
        boundary: BoundaryTreatment,
        keep_out: Vec<Mask>,
        clearance: f64,
    ) -> Result<Self, PathError> {
        check_clearance(clearance)?;
        let outline = domain.outline(boundary).and_then(|region| RegionOutline::new(&region)).map(Arc::new);
        let scale = domain.greatest_scale();
        Ok(Self { keep_out: keep_out.into(), outline, clearance: scale * clearance, scale })
    }

    /// Returns the area of all points that are in none of the regions.
    pub fn outside_of(keep_out: &[Mask]) -> Self {
        Self { keep_out: keep_out.into(), outline: None, clearance: 0.0, scale: 1.0 }
    }

    /// Returns whether paths may go everywhere.
    pub fn is_everything(&self) -> bool {
        self.keep_out.is_empty() && self.outline.is_none()
    }

    /// Returns whether a mesh is divided along the rim of the area before a cost is known.
    pub(super) fn divides_meshes(&self) -> bool {
        self.outline.is_some() || (self.clearance > 0.0 && !self.keep_out.is_empty())
    }

    /// Returns whether paths may go through a triangle, anticlockwise: `Closed` where no point of it belongs
    /// to the area, `Open` where all of them do.
    pub(super) fn passage(&self, corners: &[DVec2; 3]) -> Passage {
        let of_region = |mask: &Mask| match self.clearance > 0.0 {
            true => self.beside(mask, corners),
            false => outside_of(mask, corners),
        };
        let of_regions = self.keep_out.iter().map(of_region).min().unwrap_or(Passage::Open);
        match &self.outline {
            Some(outline) if of_regions > Passage::Closed => of_regions.min(self.beside(&**outline, corners)),
            _ => of_regions,
        }
    }

    /// Returns whether paths that keep the clearance from something go through a triangle.
    fn beside(&self, forbidden: &impl Forbidden, corners: &[DVec2; 3]) -> Passage {
        let [share, margin] = ROUNDING;
        let [a, b, c] = *corners;
        let rectangle = Rect::new(a.min(b).min(c), a.max(b).max(c));
        let largest = rectangle.min.abs().max(rectangle.max.abs()).max_element();
        let margin = margin * forbidden.largest_coordinate().max(largest);
        let reach = self.clearance * (1.0 + share) + margin;
        let centroid = (a + b + c) / 3.0;
        let mut is_inside = None;
        let (mut is_near, mut is_touched) = (false, false);
        let _ = forbidden.visit_edges(&rectangle.expanded(reach), |edge| {
            if !is_within(reach, corners, edge) {
                return ControlFlow::Continue(());
            }
            is_near = true;
            is_touched |= is_within(margin, corners, edge);
            // Only a triangle that is inside as a whole is closed for that.
            let is_inside = *is_inside.get_or_insert_with(|| forbidden.holds(centroid));
            if is_touched || !is_inside { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if !is_touched && is_inside.unwrap_or_else(|| forbidden.holds(centroid)) {
            return Passage::Closed;
        }
        let too_close = self.clearance * (1.0 - share) - margin;
        if is_near && too_close > 0.0 && is_all_near(forbidden, corners, too_close) {
            return Passage::Closed;
        }
        if is_near { Passage::Partly } else { Passage::Open }
    }

    /// Returns how much farther than the clearance a point lies from everything that paths keep it from;
    /// negative where it is nearer, −∞ on land and in regions.
    pub(super) fn slack(&self, point: DVec2) -> f64 {
        let outline = self.outline.as_deref().map(|outline| self.slack_beside(outline, point));
        let regions = self.keep_out.iter().map(|mask| self.slack_beside(mask, point));
        regions.chain(outline).fold(f64::INFINITY, f64::min)
    }

    fn slack_beside(&self, forbidden: &impl Forbidden, point: DVec2) -> f64 {
        if forbidden.holds(point) {
            return f64::NEG_INFINITY;
        }
        let [share, margin] = ROUNDING;
        let margin = margin * forbidden.largest_coordinate().max(point.abs().max_element());
        forbidden.distance(point) * (1.0 - share) - self.clearance - margin
    }

    /// Returns why no path begins or ends at a point, if the area is why.
    pub(super) fn refusal(&self, which: Waypoint, at: DVec2) -> Option<PathError> {
        let slack = self.slack(at);
        if slack >= 0.0 {
            return None;
        }
        let outline = self.outline.as_deref();
        let regions = self.keep_out.iter();
        if outline.is_some_and(|outline| outline.holds(at)) {
            return Some(PathError::BesidePolygons { which, at });
        }
        if self.clearance == 0.0 || regions.clone().any(|mask| mask.contains(at)) {
            let is_region = regions.clone().any(|mask| self.slack_beside(mask, at) < 0.0);
            let refusal = if is_region {
                PathError::KeptOut { which, at }
            } else {
                PathError::BesidePolygons { which, at }
            };
            return Some(refusal);
        }
        let distances =
            regions.map(|mask| mask.distance(at)).chain(outline.map(|outline| outline.distance(at)));
        let distance = distances.fold(f64::INFINITY, f64::min);
        let [distance, clearance] = [distance, self.clearance].map(|length| length / self.scale);
        Some(PathError::TooClose { which, at, distance, clearance })
    }
}

/// Checks a clearance.
///
/// # Errors
/// Fails when it is negative, NaN or infinite.
pub(crate) fn check_clearance(clearance: f64) -> Result<(), PathError> {
    if clearance >= 0.0 && clearance.is_finite() {
        Ok(())
    } else {
        Err(PathError::InvalidClearance { clearance })
    }
}

/// What paths keep a distance from.
trait Forbidden {
    /// Visits the edges whose rectangles meet another, until `visit` breaks.
    fn visit_edges(&self, area: &Rect, visit: impl FnMut([DVec2; 2]) -> ControlFlow<()>) -> ControlFlow<()>;
    /// Returns the edge nearest to a point.
    fn nearest_edge(&self, point: DVec2) -> Option<[DVec2; 2]>;
    /// Returns whether a point is inside. On an edge either answer is possible.
    fn holds(&self, point: DVec2) -> bool;
    fn largest_coordinate(&self) -> f64;

    /// Returns the distance to the nearest edge.
    fn distance(&self, point: DVec2) -> f64 {
        let nearest = self.nearest_edge(point);
        nearest.map_or(f64::INFINITY, |edge| point.distance(nearest_on_segment(point, edge)))
    }
}

impl Forbidden for Mask {
    fn visit_edges(&self, area: &Rect, visit: impl FnMut([DVec2; 2]) -> ControlFlow<()>) -> ControlFlow<()> {
        self.visit_edges_meeting(area, visit)
    }

    fn nearest_edge(&self, point: DVec2) -> Option<[DVec2; 2]> {
        Self::nearest_edge(self, point)
    }

    fn holds(&self, point: DVec2) -> bool {
        self.contains(point)
    }

    fn largest_coordinate(&self) -> f64 {
        Self::largest_coordinate(self)
    }
}

/// The land: what polygons do not cover in their frame.
impl Forbidden for RegionOutline {
    fn visit_edges(&self, area: &Rect, visit: impl FnMut([DVec2; 2]) -> ControlFlow<()>) -> ControlFlow<()> {
        self.visit_meeting(area, visit)
    }

    fn nearest_edge(&self, point: DVec2) -> Option<[DVec2; 2]> {
        Self::nearest_edge(self, point)
    }

    fn holds(&self, point: DVec2) -> bool {
        !self.covers(point)
    }

    fn largest_coordinate(&self) -> f64 {
        Self::largest_coordinate(self)
    }
}

/// Returns whether paths that stay out of a region go through a triangle.
fn outside_of(mask: &Mask, &[a, b, c]: &[DVec2; 3]) -> Passage {
    match mask.classify(&Rect::new(a.min(b).min(c), a.max(b).max(c))) {
        Coverage::Inside => Passage::Closed,
        Coverage::Mixed => Passage::Partly,
        Coverage::Outside => Passage::Open,
    }
}

/// Returns whether one edge, that nearest to the middle, is nearer than `reach` to all points of a triangle.
fn is_all_near(forbidden: &impl Forbidden, corners: &[DVec2; 3], reach: f64) -> bool {
    let centroid = corners.iter().sum::<DVec2>() / 3.0;
    // The distance from a segment is convex, so the corners decide.
    forbidden.nearest_edge(centroid).is_some_and(|edge| {
        corners.iter().all(|&corner| corner.distance(nearest_on_segment(corner, edge)) < reach)
    })
}

/// Returns whether a triangle, anticlockwise, comes nearer than `reach` to a segment, or meets it.
fn is_within(reach: f64, corners: &[DVec2; 3], segment: [DVec2; 2]) -> bool {
    let is_near =
        |point: DVec2, segment| point.distance_squared(nearest_on_segment(point, segment)) < reach * reach;
    let sides = [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
    segment.iter().any(|&end| contains(corners, end))
        || corners.iter().any(|&corner| is_near(corner, segment))
        || sides.iter().any(|&side| segment.iter().any(|&end| is_near(end, side)) || cross(side, segment))
}

/// Returns whether two segments cross, each between the ends of the other.
fn cross([a, b]: [DVec2; 2], [p, q]: [DVec2; 2]) -> bool {
    let are_apart = |one: Side, other: Side| one != other && one != Side::On && other != Side::On;
    are_apart(side_of_points(a, b, p), side_of_points(a, b, q))
        && are_apart(side_of_points(p, q, a), side_of_points(p, q, b))
}
