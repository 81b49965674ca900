//! Courant numbers of the edges of a finished mesh.

use glam::DVec2;
use rayon::prelude::*;

use super::depth::wave_speed;
use super::{Combine, DepthRule, Depths, Layer};
use crate::mesh::MeshView;

/// What solvers check: the Courant numbers of edges, u Δt / L, where L is the length of an edge and
/// u = √(g H) + √(g / H) that of a wave of 1 m at the mean depth H of its ends, at least 1 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourantFit {
    /// The number that edges should not exceed.
    pub limit: f64,
    /// The time step, in seconds.
    pub time_step: f64,
    /// The edges with water at an end.
    pub edges: usize,
    /// The number of these edges that exceed the limit.
    pub above: usize,
    /// The largest Courant number.
    pub largest: f64,
    /// The middle of the edge that has it, in world units.
    pub at: DVec2,
}

/// Share by which a Courant number may exceed the limit by rounding.
const ROUNDING: f64 = 1e-9;

impl CourantFit {
    /// Returns the figures of a mesh for the strictest visible layer that is a floor for a Courant number;
    /// `None` without one. `depths` are those at the nodes, in metres, and `length` measures an edge.
    pub fn of(
        layers: &[Layer],
        mesh: MeshView,
        depths: &[f64],
        length: impl Fn([DVec2; 2]) -> f64 + Sync,
    ) -> Option<Self> {
        let (time_step, limit) =
            layers.iter().filter_map(floor).max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
        let of_edge = |[from, to]: [u32; 2]| {
            let ends = [from, to].map(|node| depths[node as usize]);
            let places =
                [from, to].map(|node| mesh.lattice().world_from_lattice(mesh.nodes()[node as usize]));
            let is_wet = ends.iter().any(|depth| *depth > 0.0);
            let number = wave_speed(0.5 * (ends[0] + ends[1])) * time_step / length(places);
            is_wet.then_some((number, 0.5 * (places[0] + places[1])))
        };
        let numbers: Vec<(f64, DVec2)> = edges(mesh).par_iter().filter_map(|&edge| of_edge(edge)).collect();
        let above = numbers.iter().filter(|(number, _)| *number > limit * (1.0 + ROUNDING)).count();
        let (largest, at) = numbers.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
        Some(Self { limit, time_step, edges: numbers.len(), above, largest, at })
    }
}

/// Returns the time step and the Courant number of a layer that is a floor for one.
fn floor(layer: &Layer) -> Option<(f64, f64)> {
    match layer.kind.get::<Depths>()?.sizes().rule {
        DepthRule::Courant { time_step, number } if layer.visible && layer.combine == Combine::Floor => {
            Some((time_step, number))
        }
        _ => None,
    }
}

/// Returns the ends of each edge once.
fn edges(mesh: MeshView) -> Vec<[u32; 2]> {
    let sides = |nodes: [u32; 3]| [[nodes[0], nodes[1]], [nodes[1], nodes[2]], [nodes[2], nodes[0]]];
    let of_triangles = mesh.triangles().iter().flat_map(|triangle| {
        sides(triangle.vertices.map(|node| node.index() as u32)).map(|[a, b]| [a.min(b), a.max(b)])
    });
    let mut edges: Vec<[u32; 2]> = of_triangles.collect();
    edges.par_sort_unstable();
    edges.dedup();
    edges
}
