//! The next best paths that differ substantially.

use std::sync::Arc;

use glam::DVec2;

use super::{CostDensity, CostRange, PathError, PathMesh, PathRequest, Planner, Solution};
use crate::field::Bounds;
use crate::geometry::Rect;
use crate::layers::{ShapeList, Shapes};

/// The condition for a path to count as another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Half the width of the corridor around a path, as a share of the length of the best path.
    pub width: f64,
    /// The share of a path's length that must lie outside the corridors of all earlier paths.
    pub outside: f64,
    /// A path may cost more than the best by this share of its cost.
    pub most_excess: f64,
}

impl Default for Difference {
    fn default() -> Self {
        Self { width: 0.05, outside: 0.25, most_excess: 1.0 }
    }
}

/// Finds paths, each of which differs substantially from those before it.
///
/// The cost inside the corridors of the earlier paths is raised: at a distance d from one of them, up to the
/// width w, it is multiplied by 1 + 2 (1 − d/w). The path of least raised cost then moves to where it costs
/// least nearby, without the raise. If it still differs from the earlier ones, it counts; otherwise the cost
/// is raised in corridors twice as wide. It is not proved that no path in between is better.
#[derive(Clone, Debug)]
pub struct Alternatives {
    mesh: Arc<PathMesh>,
    places: Vec<DVec2>,
    difference: Difference,
    /// The paths so far, the best first, and then in the order in which they were found.
    paths: Vec<Solution>,
    /// How much wider than the corridors the cost is raised.
    widening: f64,
    is_done: bool,
    /// Whether the mesh is fine enough for the cost.
    is_adapted: bool,
}

/// How much the cost is raised on an earlier path.
const PENALTY: f64 = 2.0;
/// The search ends when wider corridors than this give no other path.
const MOST_WIDENING: f64 = 8.0;
/// Places of a path that are compared with the earlier ones.
const SAMPLES: usize = 200;

impl Alternatives {
    /// Returns the search for other paths than the best one, which `best` is.
    pub fn new(
        mesh: impl Into<Arc<PathMesh>>,
        places: Vec<DVec2>,
        best: Solution,
        difference: Difference,
    ) -> Self {
        let is_done = best.length == 0.0;
        Self {
            mesh: mesh.into(),
            places,
            difference,
            paths: vec![best],
            widening: 1.0,
            is_done,
            is_adapted: false,
        }
    }

    /// Returns the paths so far: the best, then the others in the order in which they were found.
    pub fn paths(&self) -> &[Solution] {
        &self.paths
    }

    /// Returns whether no more are to be found.
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Does one round, and returns the path that it found, if any.
    ///
    /// # Errors
    /// Fails as [`Planner::solve`] does.
    pub fn advance(&mut self, density: &dyn CostDensity) -> Result<Option<&Solution>, PathError> {
        if self.is_done {
            return Ok(None);
        }
        if !self.is_adapted {
            self.mesh = Arc::clone(Planner::new(Arc::clone(&self.mesh), density)?.mesh());
            self.is_adapted = true;
        }
        let width = self.difference.width * self.paths[0].length;
        let lines = self.paths.iter().map(|path| path.points.clone()).collect();
        let Ok(shapes) = Shapes::new(ShapeList { lines, ..ShapeList::default() }, false) else {
            self.is_done = true;
            return Ok(None);
        };
        let raised = Raised { density, shapes: &shapes, width: self.widening * width };
        let request = PathRequest { has_bounds: false, ..PathRequest::FULL };
        let mut planner = Planner::on_mesh(Arc::clone(&self.mesh), &raised)?;
        let found = planner.solve(&raised, &self.places, request)?;
        // By its true cost, a path in the same valley moves back to the earlier one.
        let path = planner.relaxed(&found, density, request.tolerance);
        if self.share_outside(&path, &shapes, width) < self.difference.outside {
            self.widening *= 2.0;
            self.is_done = self.widening > MOST_WIDENING;
            return Ok(None);
        }
        self.widening = 1.0;
        if path.cost > self.paths[0].cost * (1.0 + self.difference.most_excess) {
            self.is_done = true;
            return Ok(None);
        }
        self.paths.push(path);
        Ok(self.paths.last())
    }

    /// Returns the share of a path that is farther than `width` from the earlier ones.
    fn share_outside(&self, path: &Solution, earlier: &Shapes, width: f64) -> f64 {
        let points = path.evenly(SAMPLES);
        let outside = points.iter().filter(|&&point| earlier.distance(point) > width).count();
        outside as f64 / points.len() as f64
    }
}

/// A cost that is raised near lines.
struct Raised<'a> {
    density: &'a dyn CostDensity,
    shapes: &'a Shapes,
    width: f64,
}

impl Raised<'_> {
    fn factor(&self, distance: f64) -> f64 {
        1.0 + PENALTY * (1.0 - distance / self.width).max(0.0)
    }

    fn raised(&self, CostRange { least, greatest }: CostRange, rectangle: &Rect) -> CostRange {
        let Bounds { least: nearest, greatest: farthest, .. } = self.shapes.bounds(rectangle);
        CostRange { least: least * self.factor(farthest), greatest: greatest * self.factor(nearest) }
    }
}

impl CostDensity for Raised<'_> {
    fn at(&self, point: DVec2) -> f64 {
        self.density.at(point) * self.factor(self.shapes.distance(point))
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        self.raised(self.density.range(rectangle), rectangle)
    }

    fn risk_at(&self, point: DVec2) -> f64 {
        self.density.risk_at(point)
    }

    fn risk_range(&self, rectangle: &Rect) -> CostRange {
        self.density.risk_range(rectangle)
    }

    fn inverse_scale_at(&self, point: DVec2) -> f64 {
        self.density.inverse_scale_at(point)
    }

    fn range_on_ground(&self, rectangle: &Rect) -> CostRange {
        self.raised(self.density.range_on_ground(rectangle), rectangle)
    }
}
