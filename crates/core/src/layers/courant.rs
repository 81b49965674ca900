//! Courant numbers of the edges of a finished mesh.

use glam::DVec2;
use rayon::prelude::*;

use super::depth::wave_speed;
use super::{Combine, DepthRule, Depths, Layer};
use crate::mesh::MeshView;
use crate::text::LengthUnit;

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

/// The largest time step of a wave of 1 m with the Courant number 1 along every edge: the least L / u, with L
/// and u as of [`CourantFit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestTimeStep {
    /// The time step, in seconds. For another Courant number it is that many times as long.
    pub seconds: f64,
    /// The middle of the edge that decides it, in world units.
    pub at: DVec2,
    /// The length of that edge, in the unit of the document.
    pub edge: f64,
}

impl LargestTimeStep {
    /// Returns that of a mesh; `None` where no edge has water at an end, and in degrees. `depths` are those
    /// at the nodes, in metres, and `length` measures an edge in the unit of the document; plain numbers are
    /// metres.
    pub fn of(
        mesh: MeshView,
        depths: &[f64],
        unit: LengthUnit,
        length: impl Fn([DVec2; 2]) -> f64 + Sync,
    ) -> Option<Self> {
        let times = EdgeTimes::new(depths, unit)?;
        let of_edge = |wet: WetEdge| {
            let edge = length(wet.ends);
            Self { seconds: times.metres * edge / wet.speed, at: wet.middle(), edge }
        };
        // Of equal ones the first: the answer does not depend on threads.
        let steps: Vec<Self> = wet_edges(mesh, depths).into_par_iter().map(of_edge).collect();
        steps.into_iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

/// The times in which a wave of 1 m runs along edges of a mesh: their time steps with the Courant number 1.
#[derive(Clone, Copy, Debug)]
pub struct EdgeTimes<'a> {
    depths: &'a [f64],
    /// Metres in the unit of the document.
    metres: f64,
}

impl<'a> EdgeTimes<'a> {
    /// Returns those of a mesh whose nodes have these depths, in metres; plain numbers are metres. `None` in
    /// degrees.
    pub fn new(depths: &'a [f64], unit: LengthUnit) -> Option<Self> {
        let metres = match unit {
            LengthUnit::None | LengthUnit::Metre => 1.0,
            LengthUnit::Kilometre => 1000.0,
            LengthUnit::Degree => return None,
        };
        Some(Self { depths, metres })
    }

    /// Returns the time along an edge between two nodes, in seconds; `None` without water at an end. The
    /// length is in the unit of the document.
    pub fn seconds(&self, ends: [usize; 2], length: f64) -> Option<f64> {
        speed_along(self.depths, ends).map(|speed| self.metres * length / speed)
    }
}

/// Returns the speed of a wave along an edge, in m/s; `None` without water at an end.
fn speed_along(depths: &[f64], ends: [usize; 2]) -> Option<f64> {
    let [a, b] = ends.map(|node| depths[node]);
    (a > 0.0 || b > 0.0).then(|| wave_speed(0.5 * (a + b)))
}

/// An edge with water at an end.
struct WetEdge {
    ends: [DVec2; 2],
    /// The speed of a wave, in m/s.
    speed: f64,
}

impl WetEdge {
    fn middle(&self) -> DVec2 {
        0.5 * (self.ends[0] + self.ends[1])
    }
}

fn wet_edges(mesh: MeshView, depths: &[f64]) -> Vec<WetEdge> {
    let wet = |ends: [u32; 2]| {
        let nodes = ends.map(|node| node as usize);
        let speed = speed_along(depths, nodes)?;
        let ends = nodes.map(|node| mesh.lattice().world_from_lattice(mesh.nodes()[node]));
        Some(WetEdge { ends, speed })
    };
    edges(mesh).into_par_iter().filter_map(wet).collect()
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
        let of_edge = |wet: WetEdge| (wet.speed * time_step / length(wet.ends), wet.middle());
        let numbers: Vec<(f64, DVec2)> = wet_edges(mesh, depths).into_par_iter().map(of_edge).collect();
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
