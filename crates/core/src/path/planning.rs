//! A planner is made in steps.

use std::sync::Arc;

use super::adaptation::Adapted;
use super::path_mesh::PathMesh;
use super::triangle_costs::TriangleCost;
use super::{CostDensity, PathError, Planner};

/// Number of triangles whose costs one thread computes in a step.
const AT_ONCE: usize = 2048;

/// The work of [`Planner::new`] in steps. Where there are more threads than one, they compute all costs in
/// one step.
#[derive(Clone, Debug)]
pub struct Planning {
    mesh: Arc<PathMesh>,
    /// The costs of the first triangles.
    costs: Vec<TriangleCost>,
}

impl Planning {
    /// Begins to make a planner for a mesh.
    pub fn new(mesh: impl Into<Arc<PathMesh>>) -> Self {
        Self { mesh: mesh.into(), costs: Vec::new() }
    }

    /// Takes a step. Returns the planner at the end. Every call must get the same cost density.
    ///
    /// # Errors
    /// Fails when the cost is zero, negative, NaN or infinite somewhere.
    pub fn advance(&mut self, density: &dyn CostDensity) -> Result<Option<Planner>, PathError> {
        let (known, all) = (self.costs.len(), self.mesh.triangle_count());
        if known < all {
            let most = if rayon::current_num_threads() > 1 { all } else { AT_ONCE };
            let next: Vec<u32> = (known..all.min(known + most)).map(|triangle| triangle as u32).collect();
            self.costs.extend(self.mesh.costs_of(&next, density)?);
            return Ok(None);
        }
        let known = std::mem::take(&mut self.costs);
        let Adapted { mesh, costs, adaptation } = Adapted::new(Arc::clone(&self.mesh), &known, density)?;
        Ok(Some(Planner { adaptation: Some(adaptation), ..Planner::with_costs(mesh, costs) }))
    }
}
