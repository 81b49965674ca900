//! The cost of each triangle per unit of length.

use rayon::prelude::*;

use super::error::{GREATEST_COST, LEAST_COST};
use super::path_mesh::PathMesh;
use super::{CostDensity, Passage, PathError, checked_range};
use crate::geometry::Rect;

/// The cost of each triangle, in their order; infinite in closed ones.
#[derive(Clone, Debug, Default)]
pub struct TriangleCosts {
    /// A lower bound, for bounds of what paths cost.
    pub least: Vec<f64>,
    /// The mean as computed, to choose a path.
    pub mean: Vec<f64>,
}

/// The cost of one triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleCost {
    least: f64,
    /// Of use where the triangle may have to be bisected.
    pub greatest: f64,
    mean: f64,
}

/// Costs that differ by less than this share have the value in the middle as their mean.
const ALIKE: f64 = 0.2;
/// Inner points whose mean is exact for quadratic functions, as shares of the corners.
const GAUSS: [[f64; 3]; 3] = {
    let [near, far] = [2.0 / 3.0, 1.0 / 6.0];
    [[near, far, far], [far, near, far], [far, far, near]]
};

/// A triangle is bisected if its diameter times the variation of its cost (as a share of its least cost, at
/// most 1) exceeds this share of the longer side of all triangles.
const COARSEST: f64 = 1.0 / 250.0;
/// Number of triangles whose costs a thread computes at a time.
const TOGETHER: usize = 1024;

impl TriangleCosts {
    /// Takes other costs of the same triangles, and returns those that changed, in order.
    pub(super) fn exchange(&mut self, new: Self) -> Vec<u32> {
        let before = std::mem::replace(self, new);
        let differs = |&t: &u32| {
            let t = t as usize;
            self.least[t] != before.least[t] || self.mean[t] != before.mean[t]
        };
        (0..before.least.len() as u32).filter(differs).collect()
    }

    /// Takes the costs of all triangles, with room for `more` further ones.
    pub(super) fn from_slice(costs: &[TriangleCost], more: usize) -> Self {
        let [mut least, mut mean] = [(); 2].map(|()| Vec::with_capacity(costs.len() + more));
        least.extend(costs.iter().map(|cost| cost.least));
        mean.extend(costs.iter().map(|cost| cost.mean));
        Self { least, mean }
    }

    pub(super) fn set(&mut self, triangle: u32, cost: TriangleCost) {
        let count = self.least.len().max(triangle as usize + 1);
        self.least.resize(count, f64::INFINITY);
        self.mean.resize(count, f64::INFINITY);
        self.least[triangle as usize] = cost.least;
        self.mean[triangle as usize] = cost.mean;
    }

    /// Returns the costs in another order, in which the numbers are those that triangles have now.
    pub(super) fn in_order(&self, order: &[u32]) -> Self {
        let sorted = |costs: &[f64]| order.iter().map(|&t| costs[t as usize]).collect();
        Self { least: sorted(&self.least), mean: sorted(&self.mean) }
    }

    /// Recomputes the costs of the triangles that meet one of the rectangles, and returns those that changed,
    /// in order.
    ///
    /// # Errors
    /// Fails as [`PathMesh::costs`] does; then the costs are as before.
    pub fn update(
        &mut self,
        mesh: &PathMesh,
        density: &dyn CostDensity,
        areas: &[Rect],
    ) -> Result<Vec<u32>, PathError> {
        let meeting = mesh.meeting(areas);
        let costs = mesh.costs_of(&meeting, density)?;
        let mut changed: Vec<(u32, TriangleCost)> = meeting.into_iter().zip(costs).collect();
        changed.retain(|&(triangle, cost)| {
            cost.least != self.least[triangle as usize] || cost.mean != self.mean[triangle as usize]
        });
        changed.iter().for_each(|&(triangle, cost)| self.set(triangle, cost));
        Ok(changed.into_iter().map(|(triangle, _)| triangle).collect())
    }
}

/// Returns the greatest diameter of a triangle whose cost varies by as much as the least cost.
pub(super) fn coarsest(mesh: &PathMesh) -> f64 {
    COARSEST * mesh.bounds().map_or(0.0, |bounds| bounds.size().max_element())
}

impl TriangleCost {
    pub(super) const CLOSED: Self =
        Self { least: f64::INFINITY, greatest: f64::INFINITY, mean: f64::INFINITY };

    /// The cost of a triangle that need not be bisected.
    pub(super) fn constant(least: f64, mean: f64) -> Self {
        Self { least, greatest: least, mean }
    }

    /// Returns whether another cost has the same numbers but for the greatest one.
    #[cfg(test)]
    pub(super) fn is_like(&self, other: Self) -> bool {
        self.least == other.least && self.mean == other.mean
    }

    /// Returns how much the cost varies, as a share of the least cost.
    fn variation(&self) -> f64 {
        if self.least < f64::INFINITY { (self.greatest - self.least) / self.least } else { 0.0 }
    }
}

impl PathMesh {
    /// Returns how urgently a triangle should be bisected: the factor by which its diameter is too large for
    /// its cost; 0 where it is not. The cost jumps in triangles through which the rim of the area of paths
    /// passes.
    pub(super) fn importance(&self, triangle: u32, cost: TriangleCost, coarsest: f64) -> f64 {
        let variation = match self.passage(triangle) {
            Passage::Closed => 0.0,
            Passage::Partly => 1.0,
            Passage::Open => cost.variation().min(1.0),
        };
        let excess = variation * self.diameter(triangle) - coarsest;
        if excess > 0.0 { excess } else { 0.0 }
    }

    /// Returns the cost of each triangle.
    ///
    /// # Errors
    /// Fails when the cost is zero, negative, NaN or infinite somewhere.
    pub fn costs(&self, density: &dyn CostDensity) -> Result<TriangleCosts, PathError> {
        self.all_costs(density).map(|costs| TriangleCosts::from_slice(&costs, 0))
    }

    pub(super) fn all_costs(&self, density: &dyn CostDensity) -> Result<Vec<TriangleCost>, PathError> {
        let all: Vec<u32> = (0..self.triangle_count() as u32).collect();
        self.costs_of(&all, density)
    }

    /// Returns the costs of some triangles. All threads compute; of several errors, that of the first
    /// triangle counts.
    pub(super) fn costs_of(
        &self,
        triangles: &[u32],
        density: &dyn CostDensity,
    ) -> Result<Vec<TriangleCost>, PathError> {
        let of_part = |part: &[u32]| part.iter().map(|&t| self.cost(t, density)).collect();
        let parts: Vec<Result<Vec<TriangleCost>, PathError>> =
            triangles.par_chunks(TOGETHER).map(of_part).collect();
        let mut costs = Vec::with_capacity(triangles.len());
        for part in parts {
            costs.extend(part?);
        }
        Ok(costs)
    }

    pub(super) fn cost(&self, triangle: u32, density: &dyn CostDensity) -> Result<TriangleCost, PathError> {
        if self.passage(triangle) == Passage::Closed {
            return Ok(TriangleCost::CLOSED);
        }
        let range = checked_range(density, &self.rectangle(triangle))?;
        let spread = range.greatest - range.least;
        let [a, b, c] = self.corners(triangle);
        if range.least < LEAST_COST || range.greatest > GREATEST_COST {
            // The range may be wider than the values.
            let at = [a, b, c, (a + b + c) / 3.0].map(|at| (at, density.at(at)));
            if let Some(&(at, value)) =
                at.iter().find(|(_, value)| !(LEAST_COST..=GREATEST_COST).contains(value))
            {
                return Err(PathError::CostOutOfRange { at, value });
            }
        }
        let mean = if spread <= 0.0 {
            range.least
        } else if spread <= ALIKE * range.least {
            density.at((a + b + c) / 3.0)
        } else {
            GAUSS.iter().map(|&[i, j, k]| density.at(i * a + j * b + k * c)).sum::<f64>() / 3.0
        };
        let mean = mean.clamp(range.least, range.greatest);
        Ok(TriangleCost { least: range.least, greatest: range.greatest, mean })
    }
}
