//! All points that lie on nearly best paths.

use glam::DVec2;

use super::path_mesh::PathMesh;
use super::{Passage, PathError, Planner};

/// How much more than the best path the best one through each node costs.
///
/// The corridor of ε is where that is at most ε. It is computed from the marched distances from the start
/// and from the goal of each leg, u + v, which are exact to first order; the least of these sums counts as
/// the cost of the best path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corridor {
    excess: Vec<f64>,
}

impl Corridor {
    /// Returns the excess at each node, in the order of the nodes, as a share of the cost of the best path;
    /// infinite where no path goes. It is linear on each triangle.
    pub fn excess(&self) -> &[f64] {
        &self.excess
    }

    /// Returns the points of either corridor, on the same mesh.
    pub fn joined(mut self, other: Self) -> Self {
        self.excess.iter_mut().zip(other.excess).for_each(|(excess, other)| *excess = excess.min(other));
        self
    }

    /// Returns the open triangles with a point in the corridor of `share`, by their numbers.
    pub fn triangles<'a>(&'a self, mesh: &'a PathMesh, share: f64) -> impl Iterator<Item = u32> + 'a {
        let within = move |t: &u32| {
            let corners = mesh.triangles[*t as usize].corners;
            mesh.passage(*t) == Passage::Open
                && corners.iter().any(|&node| self.excess[node as usize] <= share)
        };
        (0..mesh.triangle_count() as u32).filter(within)
    }

    /// Returns the excess at a point of an open triangle; `None` elsewhere.
    pub fn excess_at(&self, mesh: &PathMesh, point: DVec2) -> Option<f64> {
        let triangle = mesh.locate(point, Passage::Open)?;
        let place = super::MeshPlace { point, triangle };
        Some(place.interpolate(mesh, &self.excess))
    }
}

impl Planner {
    /// Returns the corridor around the best path between places, in order. Each node has the excess of the
    /// leg that comes nearest to it, as a share of the cost of all legs.
    ///
    /// # Errors
    /// Fails as [`Self::solve`](Planner::solve) does.
    pub fn corridor(&mut self, places: &[DVec2]) -> Result<Corridor, PathError> {
        let places = self.places(places)?;
        self.march(&places, true);
        let mut excess = vec![f64::INFINITY; self.mesh().node_count()];
        let mut total = 0.0;
        for leg in 0..places.len() - 1 {
            let [from, to] = self.open_marches(leg);
            let sum = || from.values().zip(to.values()).map(|(u, v)| u + v);
            let best = sum().fold(f64::INFINITY, f64::min);
            if best.is_finite() {
                total += best;
                excess.iter_mut().zip(sum()).for_each(|(excess, sum)| *excess = excess.min(sum - best));
            }
        }
        if total > 0.0 {
            excess.iter_mut().for_each(|excess| *excess /= total);
        }
        Ok(Corridor { excess })
    }
}
