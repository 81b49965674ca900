use std::fmt;
use std::sync::Arc;

use glam::DVec2;

use crate::domain::{BoundaryTreatment, Domain, DomainOnLattice};
use crate::geometry::{GridError, Lattice, Rect};
use crate::layers::Mask;
use crate::mesh::Element;
use crate::path::{CostDensity, Passage, PathArea, PathError, Waypoint};

/// Coarse cells along the longer side of the domain, unless the task says otherwise.
const CELLS: f64 = 8.0;
/// Most coarse cells along that side.
const MOST_CELLS: f64 = 40.0;
/// A certificate of more nodes takes minutes.
const MOST_NODES: usize = 12_000;

/// How a triangle lies to the part of the plane where paths may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Placement {
    /// All of it belongs to that part, or none can tell.
    Inside,
    /// The boundary may pass through it: smaller triangles give a better bound.
    Cut,
    /// No point of the closed triangle belongs to that part.
    Outside,
}

/// Tells how a triangle of the certificate's mesh lies.
pub type PlacementTest = Arc<dyn Fn(&Element) -> Placement + Send + Sync>;

/// The statement to prove: no path costs less than the known one by more than a given share of its cost.
#[derive(Clone)]
pub struct CertificateTask {
    /// The cost density.
    pub cost: Arc<dyn CostDensity>,
    /// The coarse grid of the certificate's mesh. The bound is best where jumps of the cost follow the mesh:
    /// the lattice of the mesh that is shown, or a coarser one that has the lines between pixels.
    pub lattice: Lattice,
    /// The test for the area in which paths may run.
    pub placement: PlacementTest,
    /// The known path, in world units, from the start to the goal.
    pub path: Vec<DVec2>,
    /// The cost of the known path, rounded up.
    pub upper: f64,
    /// The requested width: (upper − lower) / upper.
    pub width: f64,
    /// Number of nodes of the largest program. The work also ends before a program that would take too
    /// long.
    pub most_nodes: usize,
}

/// Why a certificate ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CertificateEnd {
    /// The requested width is reached.
    Reached,
    /// By the estimates, the lower bound is nearly the least cost: only a better path helps.
    UpperBoundLimits,
    /// Finer triangles no longer raise the bound.
    NoMoreGain,
    /// The mesh has as many nodes as the task allows, or the next program would take too much work.
    TooLarge,
    /// The solver failed. The bound is that of the programs before.
    SolverFailed,
}

impl fmt::Display for CertificateEnd {
    /// A sentence about the bounds as they are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reached => "The bounds are as close as asked for.",
            Self::UpperBoundLimits => {
                "The lower bound is as good as it gets: only a better path would help. A finer mesh along \
                 keep-out regions and where the cost jumps can show one."
            }
            Self::NoMoreGain => {
                "Finer triangles no longer raise the lower bound. A finer mesh along keep-out regions and where \
                 the cost jumps can still show a better path."
            }
            Self::TooLarge => {
                "The proof needs more triangles than it may have, most of them where the cost jumps or varies \
                 much, or along an outline. Ask for a wider interval, smooth the cost there, or divide the path \
                 by --via points: each part is proved by itself."
            }
            Self::SolverFailed => "The solver of the proof found no better bound.",
        })
    }
}

impl CertificateTask {
    /// Returns the task for a known path in a rectangle without holes. `upper` is the cost of the path, and
    /// `width` the requested part of it.
    ///
    /// # Errors
    /// Fails when the rectangle is not a proper one.
    pub fn in_rectangle(
        bounds: Rect,
        cost: Arc<dyn CostDensity>,
        path: Vec<DVec2>,
        upper: f64,
        width: f64,
    ) -> Result<Self, GridError> {
        let lattice = Self::lattice_over(bounds)?;
        let placement: PlacementTest = Arc::new(|_| Placement::Inside);
        Ok(Self { cost, lattice, placement, path, upper, width, most_nodes: MOST_NODES })
    }

    /// Returns a coarse grid for a certificate.
    ///
    /// # Errors
    /// Fails when the rectangle is not a proper one.
    pub fn lattice_over(bounds: Rect) -> Result<Lattice, GridError> {
        Lattice::covering(bounds, bounds.size().max_element() / CELLS, 8 * MOST_NODES)
    }

    /// Returns a lattice like [`Self::lattice_over`] that contains the lines between the pixels of a raster
    /// over the rectangle, if there is one: the edges of the mesh then follow a cost that is constant on
    /// pixels. `size` is [columns, rows].
    ///
    /// # Errors
    /// Fails when the rectangle is not a proper one.
    pub fn lattice_along_pixels(bounds: Rect, size: [u32; 2]) -> Result<Lattice, GridError> {
        let mut cells = size[0].max(size[1]).max(1);
        while cells.is_multiple_of(2) && f64::from(cells) > CELLS {
            cells /= 2;
        }
        if f64::from(cells) > MOST_CELLS {
            return Self::lattice_over(bounds);
        }
        // A little more, so that rounding adds no cell.
        let spacing = bounds.size().max_element() / f64::from(cells) * (1.0 + 1e-12);
        Lattice::covering(bounds, spacing, 8 * MOST_NODES)
    }

    /// Restricts the paths of this task to a domain that covers the rectangle of the task.
    pub fn in_domain(self, domain: &Domain) -> Self {
        let on_lattice = DomainOnLattice::new(domain, BoundaryTreatment::Report, &self.lattice);
        self.within(on_lattice)
    }

    /// Restricts the paths of this task to a domain on a lattice. The mesh begins with the grid of that
    /// lattice, which should have no more cells than [`Self::lattice_over`] makes.
    pub fn within(self, domain: DomainOnLattice) -> Self {
        let lattice = *domain.lattice();
        let placement: PlacementTest = Arc::new(move |element| {
            if domain.has_none_of(element) {
                Placement::Outside
            } else if domain.may_cut(element) {
                Placement::Cut
            } else {
                Placement::Inside
            }
        });
        Self { lattice, placement, ..self }
    }

    /// Restricts the paths of this task to points outside some regions, besides earlier restrictions.
    pub fn outside_of(self, keep_out: Vec<Mask>) -> Self {
        self.in_area(PathArea::outside_of(&keep_out))
    }

    /// Restricts the paths of this task to an area, besides earlier restrictions. Triangles that its rim
    /// crosses count: the bound is one for a little more than the area, and so for the area.
    pub fn in_area(self, area: PathArea) -> Self {
        let before = self.placement;
        let placement: PlacementTest = Arc::new(move |element| {
            let [a, b, c] = element.world_corners();
            let is_anticlockwise = (b - a).perp_dot(c - a) > 0.0;
            let corners = if is_anticlockwise { [a, b, c] } else { [a, c, b] };
            let of_area = match area.passage(&corners) {
                Passage::Closed => Placement::Outside,
                Passage::Partly => Placement::Cut,
                Passage::Open => Placement::Inside,
            };
            before(element).max(of_area)
        });
        Self { placement, ..self }
    }

    pub(super) fn start(&self) -> DVec2 {
        self.path[0]
    }

    pub(super) fn goal(&self) -> DVec2 {
        self.path[self.path.len() - 1]
    }

    pub(super) fn check(&self) -> Result<(), PathError> {
        if self.path.len() < 2 {
            return Err(PathError::TooFewPlaces);
        }
        for (which, at) in [(Waypoint::Start, self.start()), (Waypoint::Goal, self.goal())] {
            if !at.is_finite() {
                return Err(PathError::NotAPlace { which, at });
            }
        }
        let is_cost = self.upper.is_finite() && (self.upper > 0.0 || self.start() == self.goal());
        if is_cost { Ok(()) } else { Err(PathError::InvalidCost { at: self.start(), value: self.upper }) }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::CostFormula;
    use crate::layers::RiskField;
    use crate::mesh::{Limits, Mesh};
    use crate::path::FormulaCost;

    /// A clearance counts where the shape of a triangle does: both ways round it must say the same, and never
    /// that a point which may be on a path is outside.
    #[test]
    fn triangles_of_either_orientation_are_placed_by_their_points() {
        let ring = vec![dvec2(0.3, 0.3), dvec2(0.7, 0.35), dvec2(0.6, 0.7)];
        let keep_out = Mask::new(&[vec![ring]]).unwrap();
        let clearance = 0.06;
        let domain = Domain::rectangle(Rect::UNIT);
        let area =
            PathArea::new(&domain, BoundaryTreatment::Report, vec![keep_out.clone()], clearance).unwrap();
        let formula = CostFormula::parse("1").unwrap();
        let cost = Arc::new(FormulaCost { formula, risk: RiskField::default() });
        let ends = vec![dvec2(0.1, 0.1), dvec2(0.9, 0.9)];
        let task = CertificateTask::in_rectangle(Rect::UNIT, cost, ends, 1.2, 0.01).unwrap();
        let plain = task.clone();
        let task = task.in_area(area);
        let mut mesh = Mesh::coarse_grid(&task.lattice, |_| true, &Limits::default()).unwrap();
        mesh.refine(&Limits::default(), |element| element.triangle.level() < 7).unwrap();
        let sides = |[a, b, c]: [DVec2; 3]| [[a, b], [b, c], [c, a]];
        let may_pass = |point: DVec2| {
            let ring = &keep_out.polygons()[0][0];
            let distance =
                |[a, b]: [DVec2; 2]| point.distance(crate::geometry::nearest_on_segment(point, [a, b]));
            !keep_out.contains(point)
                && sides([ring[0], ring[1], ring[2]]).into_iter().all(|side| distance(side) > clearance)
        };
        let mut seen = [[0; 3]; 2];
        for element in mesh.raw_elements() {
            let corners = element.world_corners();
            let [a, b, c] = corners;
            let is_anticlockwise = (b - a).perp_dot(c - a) > 0.0;
            let placement = (task.placement)(&element);
            seen[usize::from(is_anticlockwise)][placement as usize] += 1;
            let points =
                (1..8).flat_map(|i| (1..8 - i).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0)));
            let points = points.map(|(s, t)| a + s * (b - a) + t * (c - a));
            let passing = points.clone().filter(|&point| may_pass(point)).count();
            match placement {
                Placement::Outside => assert_eq!(passing, 0, "{corners:?}"),
                Placement::Inside => assert_eq!(passing, points.count(), "{corners:?}"),
                Placement::Cut => {}
            }
        }
        // A region within a triangle, away from its edges.
        let small = dvec2(0.31, 0.27);
        let ring = [dvec2(0.0, 0.0), dvec2(0.002, 0.0), dvec2(0.0, 0.002)].map(|p| small + p);
        for center in [small, dvec2(0.27, 0.31)] {
            let moved = ring.map(|p| p - small + center).to_vec();
            let area = PathArea::new(
                &domain,
                BoundaryTreatment::Report,
                vec![Mask::new(&[vec![moved]]).unwrap()],
                1e-4,
            )
            .unwrap();
            let task = plain.clone().in_area(area);
            let mut mesh = Mesh::coarse_grid(&task.lattice, |_| true, &Limits::default()).unwrap();
            for level in 0..4 {
                let around = mesh.locate(center).triangle().unwrap();
                assert_eq!((task.placement)(&mesh.element(around)), Placement::Cut, "{level}");
                mesh.refine(&Limits::default(), |element| element.triangle.level() <= level).unwrap();
            }
        }
        // Both kinds occur, and few are left undecided.
        for of_one in seen {
            let [inside, cut, outside] = of_one;
            assert!(inside > 100 && outside > 100 && cut < inside, "{seen:?}");
        }
    }
}
