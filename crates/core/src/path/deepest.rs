//! The deepest way between two places: a path whose cost is low where the water is deep.

use std::sync::Arc;

use glam::DVec2;

use super::leg::LegSearch;
use super::place::MeshPlace;
use super::refine::Refining;
use super::{
    CostDensity, CostRange, Effort, Passage, PathError, PathMesh, PathMeshing, PathRequest, PathSearch,
    Planner, Planning, Walls, Waypoint, in_plane,
};
use crate::domain::Domain;
use crate::geometry::{Rect, corners_that_stay};
use crate::layers::DepthField;
use crate::mesh::Progress;
use crate::text::{Number, rounded};

/// Shallower water counts as if it had this share of the greatest depth.
const SHALLOWEST: f64 = 1e-3;
/// How much more than in the shallowest water a way costs on land, so that it crosses land only where no
/// water is.
const LAND: f64 = 1e4;
/// The way is looked at in steps of this share of a pixel.
const STEP: f64 = 0.25;
/// Points that are left out are nearer to the way than this share of the diameter of triangles along it.
const TOLERANCE: f64 = 0.5;
/// Triangles that are compared with the area of paths in a step.
const AT_ONCE: usize = 16_384;
/// Digits of a coordinate in a sentence.
const DIGITS: usize = 7;

/// A cost that is low where it is deep.
#[derive(Clone, Debug)]
pub struct DepthCost {
    depths: DepthField,
}

impl DepthCost {
    /// Returns the cost over depths.
    pub fn new(depths: DepthField) -> Self {
        Self { depths }
    }

    /// Returns the cost at a depth in metres: less where it is deeper, and most on land and where no depth is
    /// known.
    fn of_depth(&self, depth: Option<f64>) -> f64 {
        // The share to minus the fourth power: in a bend of a trough, paths are nearer to its deepest line
        // the higher the power is.
        let cost = |share: f64| 1.0 / (share * share * share * share);
        match depth.filter(|depth| *depth > 0.0) {
            Some(depth) => cost((depth / self.depths.deepest()).clamp(SHALLOWEST, 1.0)),
            None => LAND * cost(SHALLOWEST),
        }
    }
}

impl CostDensity for DepthCost {
    fn at(&self, point: DVec2) -> f64 {
        self.of_depth(self.depths.depth_at(point))
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let range = self.depths.range_in(rectangle);
        let ends = range.ends.map_or([None; 2], |[least, greatest]| [Some(least), Some(greatest)]);
        let least = if range.has_gaps { None } else { ends[0] };
        CostRange { least: self.of_depth(ends[1]), greatest: self.of_depth(least) }
    }
}

/// Why there is no deepest way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DeepestWayError {
    /// An end is on land, or has no depth.
    #[error(
        "The deepest way has no {which} in water: at x = {}, y = {} is land, or no layer of depths has a value. \
         Choose a place in water.",
        Number(rounded(at.x, DIGITS)), Number(rounded(at.y, DIGITS))
    )]
    EndOnLand {
        /// Which end.
        which: Waypoint,
        /// Its place, in world units.
        at: DVec2,
    },
    /// The best way crosses land.
    #[error(
        "No way in water was found between the two places: at x = {}, y = {} it would cross land, or where no layer of \
         depths has a value. Choose other places, or make the mesh finer where the water is narrow.",
        Number(rounded(at.x, DIGITS)), Number(rounded(at.y, DIGITS))
    )]
    OverLand {
        /// The first place on land, in world units.
        at: DVec2,
    },
    /// No path leads from one end to the other.
    #[error("No deepest way was found. {0}")]
    NoPath(#[from] PathError),
}

/// The search for the deepest way, in steps.
pub struct DeepestWay {
    depths: DepthField,
    cost: Arc<dyn CostDensity>,
    domain: Domain,
    ends: [DVec2; 2],
    step: DeepestStep,
}

/// What is done next.
enum DeepestStep {
    /// The triangles in the domain are found.
    Close(Box<PathMeshing>),
    /// The cost of each triangle is found.
    Plan(Arc<PathMesh>, Planning),
    /// The least cost from the first end to the nodes is found.
    March(Arc<PathMesh>, Box<Planner>, [MeshPlace; 2]),
    /// The path is moved to where it costs least nearby.
    Refine(Arc<PathMesh>, Arc<Walls>, Box<Refining>),
    Done,
}

impl DeepestWay {
    /// Begins the search between two places on the triangles of a mesh.
    ///
    /// # Errors
    /// Fails when one of the places is on land or has no depth.
    pub fn new(
        depths: DepthField,
        mesh: PathMeshing,
        domain: &Domain,
        ends: [DVec2; 2],
    ) -> Result<Self, DeepestWayError> {
        for (at, which) in ends.into_iter().zip([Waypoint::Start, Waypoint::Goal]) {
            if is_land(&depths, at) {
                return Err(DeepestWayError::EndOnLand { which, at });
            }
        }
        let cost = in_plane(DepthCost::new(depths.clone()), &domain.ground());
        Ok(Self { depths, cost, domain: domain.clone(), ends, step: DeepestStep::Close(Box::new(mesh)) })
    }

    /// Takes a step. Returns the way at the end: its corners in world units, from the first place to the
    /// other.
    ///
    /// # Errors
    /// Fails when no path leads between the places, or each crosses land.
    pub fn advance(&mut self) -> Result<Option<Vec<DVec2>>, DeepestWayError> {
        self.step = match std::mem::replace(&mut self.step, DeepestStep::Done) {
            DeepestStep::Close(mut meshing) => match meshing.advance(AT_ONCE) {
                None => DeepestStep::Close(meshing),
                Some(mesh) => {
                    let mesh = Arc::new(mesh);
                    DeepestStep::Plan(Arc::clone(&mesh), Planning::new(mesh))
                }
            },
            DeepestStep::Plan(mesh, mut planning) => match planning.advance(&*self.cost)? {
                None => DeepestStep::Plan(mesh, planning),
                Some(planner) => {
                    let found = |number: usize| {
                        let which = Waypoint::of(number, 2);
                        MeshPlace::find(planner.mesh(), self.ends[number], which)
                    };
                    let places = [self.explained(found(0))?, self.explained(found(1))?];
                    DeepestStep::March(mesh, Box::new(planner), places)
                }
            },
            DeepestStep::March(mesh, mut planner, places) => {
                match planner.march_one(&places, false, 0, PathSearch::NODES_AT_ONCE) {
                    Some(Progress::More) => DeepestStep::March(mesh, planner, places),
                    Some(Progress::Done) | None => {
                        // Bounds and other ways that cost about the same, as for a path, are not asked for.
                        let traced = LegSearch::new(0, places, PathRequest::FULL).trace(&planner, 2);
                        let refining = Refining::new(self.explained(traced)?, Effort::FULL);
                        DeepestStep::Refine(mesh, Arc::clone(&planner.walls), Box::new(refining))
                    }
                }
            }
            DeepestStep::Refine(mesh, walls, mut refining) => match refining.advance(&*self.cost, &walls) {
                None => DeepestStep::Refine(mesh, walls, refining),
                Some(points) => {
                    self.check(&points)?;
                    let tolerance = TOLERANCE * diameter_along(&mesh, &points);
                    return Ok(Some(self.simplified(&points, tolerance, &walls)));
                }
            },
            DeepestStep::Done => return Ok(Some(Vec::new())),
        };
        Ok(None)
    }

    /// Returns how many of [`Self::STAGES`] are done.
    pub fn stage(&self) -> u64 {
        match self.step {
            DeepestStep::Close(_) => 0,
            DeepestStep::Plan(..) => 1,
            DeepestStep::March(..) | DeepestStep::Refine(..) => 2,
            DeepestStep::Done => Self::STAGES,
        }
    }

    /// The triangles are found, then their costs, then the path.
    pub const STAGES: u64 = 3;

    /// Returns a result with an error that knows the domain.
    fn explained<T>(&self, result: Result<T, PathError>) -> Result<T, DeepestWayError> {
        result.map_err(|error| error.in_domain(&self.domain, &self.ends).into())
    }

    /// Checks that a way is in water.
    fn check(&self, points: &[DVec2]) -> Result<(), DeepestWayError> {
        match points.windows(2).find_map(|pair| self.land_between(pair[0], pair[1])) {
            Some(at) => Err(DeepestWayError::OverLand { at }),
            None => Ok(()),
        }
    }

    /// Returns the first place on land of a segment, in steps of a part of a pixel.
    fn land_between(&self, from: DVec2, to: DVec2) -> Option<DVec2> {
        let step = STEP * self.depths.pixel_size();
        let count = (from.distance(to) / step).ceil().clamp(1.0, 1e6) as u32;
        let mut places = (0..=count).map(|n| from.lerp(to, f64::from(n) / f64::from(count)));
        places.find(|&at| is_land(&self.depths, at))
    }

    /// Returns a way with fewer points, at most a tolerance from those that are left out, where it stays in
    /// water and crosses no wall.
    fn simplified(&self, points: &[DVec2], tolerance: f64, walls: &Walls) -> Vec<DVec2> {
        let stays = corners_that_stay(points, tolerance, |ends| {
            let [from, to] = ends.map(|n| points[n]);
            walls.admit(from, to) && self.land_between(from, to).is_none()
        });
        points.iter().zip(stays).filter(|(_, stays)| *stays).map(|(&at, _)| at).collect()
    }
}

fn is_land(depths: &DepthField, at: DVec2) -> bool {
    depths.depth_at(at).is_none_or(|depth| depth <= 0.0)
}

/// Returns the median of the diameters of the triangles at points of a path; 0 where none is known.
fn diameter_along(mesh: &PathMesh, points: &[DVec2]) -> f64 {
    let diameter = |point: &DVec2| {
        let [a, b, c] = mesh.corners(mesh.locate(*point, Passage::Partly)?);
        Some(a.distance(b).max(b.distance(c)).max(c.distance(a)))
    };
    let mut diameters: Vec<f64> = points.iter().filter_map(diameter).collect();
    diameters.sort_by(f64::total_cmp);
    diameters.get(diameters.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::domain::BoundaryTreatment;
    use crate::geometry::Lattice;
    use crate::layers::{DepthRule, DepthSizes, Depths, Layer, LayerKind, PositiveDepth, RasterSource};
    use crate::mesh::{Limits, Mesh};
    use crate::path::PathArea;
    use crate::raster::{Raster, RasterPyramid};

    /// Side of the raster in pixels.
    const SIDE: u32 = 200;

    fn depths(depth: impl Fn(DVec2) -> f64) -> DepthField {
        let at = |n: u32| (dvec2((n % SIDE).into(), (n / SIDE).into()) + 0.5) / f64::from(SIDE);
        let values = (0..SIDE * SIDE).map(|n| depth(at(n)) as f32).collect();
        let raster = Raster::from_values(Rect::UNIT, [SIDE; 2], values);
        let source = RasterSource { name: "depths".into(), raster: Arc::new(RasterPyramid::new(raster)) };
        let sizes = DepthSizes {
            positive: PositiveDepth::Down,
            offset: 0.0,
            between: DepthSizes::ALL_WATER,
            rule: DepthRule::Nothing,
        };
        let stack = Layer::stack([LayerKind::from(Depths::new(source, sizes))]);
        DepthField::of(&stack).expect("a layer of depths")
    }

    fn find(depths: DepthField, ends: [DVec2; 2]) -> Result<Vec<DVec2>, DeepestWayError> {
        let lattice = Lattice::covering(Rect::UNIT, 0.02, 1_000_000).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let domain = Domain::rectangle(Rect::UNIT);
        let area = PathArea::new(&domain, BoundaryTreatment::Report, Vec::new(), 0.0).unwrap();
        let mut search = DeepestWay::new(depths, PathMeshing::new(mesh.view(), &area), &domain, ends)?;
        loop {
            if let Some(way) = search.advance()? {
                return Ok(way);
            }
        }
    }

    fn thalweg(x: f64) -> f64 {
        0.5 + 0.2 * libm::sin(std::f64::consts::TAU * x)
    }

    #[test]
    fn the_way_follows_the_deepest_line_of_a_trough() {
        let trough = |at: DVec2| 30.0 - 28.0 * (((at.y - thalweg(at.x)) / 0.15).powi(2)).min(1.0);
        let ends = [dvec2(0.05, thalweg(0.05)), dvec2(0.95, thalweg(0.95))];
        let way = find(depths(trough), ends).unwrap();
        assert_eq!([way[0], way[way.len() - 1]], ends);
        for pair in way.windows(2) {
            for n in 0..=10 {
                let at = pair[0].lerp(pair[1], f64::from(n) / 10.0);
                let off = (at.y - thalweg(at.x)).abs();
                assert!(off < 0.03, "{off} beside the thalweg at {at}");
            }
        }
        assert!((8..60).contains(&way.len()), "{} corners", way.len());
    }

    #[test]
    fn no_way_crosses_land_where_there_is_another_one() {
        // A dam with a gap at the top.
        let dam = |at: DVec2| if (at.x - 0.5).abs() < 0.03 && at.y < 0.8 { -2.0 } else { 10.0 };
        let way = find(depths(dam), [dvec2(0.2, 0.2), dvec2(0.8, 0.2)]).unwrap();
        assert!(way.iter().any(|at| at.y > 0.78), "{way:?}");
    }

    #[test]
    fn a_closed_dam_and_ends_on_land_are_named() {
        let dam = |at: DVec2| if (at.x - 0.5).abs() < 0.02 { -2.0 } else { 10.0 };
        let error = find(depths(dam), [dvec2(0.2, 0.2), dvec2(0.8, 0.2)]).unwrap_err();
        let DeepestWayError::OverLand { at } = error else { panic!("{error}") };
        assert!((at.x - 0.48).abs() < 0.01, "{at}");
        assert!(error.to_string().starts_with("No way in water was found"), "{error}");
        let error = find(depths(dam), [dvec2(0.2, 0.2), dvec2(0.5, 0.2)]).unwrap_err();
        assert_eq!(error, DeepestWayError::EndOnLand { which: Waypoint::Goal, at: dvec2(0.5, 0.2) });
        let error = find(depths(dam), [dvec2(f64::NAN, 0.2), dvec2(0.2, 0.2)]).unwrap_err();
        assert!(matches!(error, DeepestWayError::EndOnLand { which: Waypoint::Start, .. }), "{error}");
    }

    #[test]
    fn bounds_of_the_cost_hold_its_values() {
        let field = depths(|at| 12.0 * libm::sin(9.0 * at.x) * at.y + 2.0);
        let cost = DepthCost::new(field);
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..300 {
            let mut corner = || 1.2 * dvec2(random.f64(), random.f64()) - 0.1;
            let ends = [corner(), corner()];
            let area = Rect::spanning(ends[0], ends[1]);
            let range = cost.range(&area);
            for n in 0..40 {
                let share = dvec2(f64::from(n % 7) / 6.0, f64::from(n % 5) / 4.0);
                let value = cost.at(area.min + share * area.size());
                assert!(range.least <= value && value <= range.greatest, "{value} in {range:?}");
            }
        }
    }
}
