//! Equilibrated fluxes: in the space of lowest order of Raviart and Thomas, with the divergence of the data.
//!
//! Around each node, the flux that crosses an edge is found by going around it: what a triangle brings to the
//! node's equation is the difference between its two edges. What is left open is one circulation around the
//! node, and that is taken which brings the flux nearest to that of u \[BraessSchoberl2008\],
//! \[ErnVohralik2015\]. There is nothing to solve but one equation with one unknown for each node.

use glam::DVec2;
use rayon::prelude::*;

use super::boundary_data::EdgeData;
use super::element::{ElementData, ElementShape};
use super::fem_mesh::{EdgeNumbers, FemEdge, FemMesh, NONE};
use super::solution::FemSolution;

/// The flux through the edges of each triangle.
#[derive(Clone, Debug)]
pub(crate) struct Fluxes {
    /// What flows out of each triangle, through the edge opposite each of its corners.
    pub out: Vec<[f64; 3]>,
    /// Whether triangles meet in a node without sharing an edge: then fluxes around it do not balance.
    pub has_pinches: bool,
}

/// What the triangles at a node let out through both edges there: the edge to the next corner, anticlockwise,
/// and that to the one before.
type Spokes = [f64; 2];

struct Equilibration<'a> {
    mesh: &'a FemMesh,
    solution: &'a FemSolution,
    edge_at: &'a EdgeNumbers,
}

impl Fluxes {
    /// Equilibrates the flux −a∇u of a solution.
    pub fn of(mesh: &FemMesh, solution: &FemSolution, edge_at: &EdgeNumbers) -> Self {
        let equilibration = Equilibration { mesh, solution, edge_at };
        let of_nodes: Vec<(Vec<Spokes>, bool)> =
            (0..mesh.node_count()).into_par_iter().map(|node| equilibration.at(node)).collect();
        let has_pinches = of_nodes.iter().any(|(_, is_pinch)| *is_pinch);
        let out = |triangle: usize| {
            let corners = mesh.corners[triangle];
            let spokes = corners.map(|node| {
                let fan = mesh.fan(node as usize);
                let place = fan.iter().position(|&other| other as usize == triangle).unwrap_or(0);
                of_nodes[node as usize].0[place]
            });
            // The edge opposite corner k joins the next corner to the one after it.
            [0, 1, 2].map(|k| spokes[(k + 1) % 3][0] + spokes[(k + 2) % 3][1])
        };
        let out = (0..mesh.triangle_count()).into_par_iter().map(out).collect();
        Self { out, has_pinches }
    }
}

/// A triangle at a node, in the order around it.
struct Sector {
    /// Its place in the fan.
    place: usize,
    triangle: usize,
    /// The corner at the node.
    own: usize,
}

impl Equilibration<'_> {
    /// Returns the flux through the spokes of each triangle at a node, and whether several fans meet there.
    fn at(&self, node: usize) -> (Vec<Spokes>, bool) {
        let fan = self.mesh.fan(node);
        let mut spokes = vec![[0.0; 2]; fan.len()];
        let mut is_done = vec![false; fan.len()];
        let mut chains = 0;
        while let Some(chain) = self.chain(node, &is_done) {
            let is_closed = self.before(&chain[0]) != NONE;
            chain.iter().for_each(|sector| is_done[sector.place] = true);
            self.balance(node, &chain, is_closed, &mut spokes);
            chains += 1;
        }
        (spokes, chains > 1)
    }

    /// Returns triangles that follow each other anticlockwise, from the boundary if they meet it.
    fn chain(&self, node: usize, is_done: &[bool]) -> Option<Vec<Sector>> {
        let fan = self.mesh.fan(node);
        let sector = |place: usize| {
            let triangle = fan[place] as usize;
            let own = self.mesh.corners[triangle].iter().position(|&corner| corner as usize == node);
            Sector { place, triangle, own: own.unwrap_or(0) }
        };
        let left = (0..fan.len()).filter(|&place| !is_done[place]).map(sector);
        let first =
            left.clone().find(|sector| self.before(sector) == NONE).or_else(|| left.clone().next())?;
        let start = first.place;
        let mut chain = vec![first];
        loop {
            let last = &chain[chain.len() - 1];
            let next = self.mesh.across[last.triangle][(last.own + 1) % 3];
            let Some(place) = fan.iter().position(|&other| other == next) else { break };
            if place == start || chain.len() > fan.len() {
                break;
            }
            chain.push(sector(place));
        }
        Some(chain)
    }

    /// Returns the triangle clockwise of one.
    fn before(&self, sector: &Sector) -> u32 {
        self.mesh.across[sector.triangle][(sector.own + 2) % 3]
    }

    /// Finds the flux around a node through a chain of triangles.
    fn balance(&self, node: usize, chain: &[Sector], is_closed: bool, spokes: &mut [Spokes]) {
        let brought: Vec<f64> = chain.iter().map(|sector| self.brought(sector)).collect();
        let total: f64 = brought.iter().sum();
        let ends = if is_closed { [None; 2] } else { self.at_ends(node, chain) };
        let start = match ends {
            [Some(out), _] => -out,
            [None, Some(out)] => out - total,
            [None, None] => 0.0,
        };
        let mut across = start;
        let mut crossing = Vec::with_capacity(chain.len() + 1);
        crossing.push(across);
        for brought in &brought {
            across += brought;
            crossing.push(across);
        }
        // What the solver left is missing in the last triangle, and not between it and its neighbour.
        let closing = if is_closed { Some(start) } else { ends[1] };
        if let (Some(last), Some(closing)) = (crossing.last_mut(), closing) {
            *last = closing;
        }
        let circulation = match ends {
            [None, None] => self.circulation(chain, &crossing),
            _ => 0.0,
        };
        for (n, sector) in chain.iter().enumerate() {
            spokes[sector.place] = [-(crossing[n] + circulation), crossing[n + 1] + circulation];
        }
    }

    /// Returns what the node's equation has from a triangle.
    fn brought(&self, sector: &Sector) -> f64 {
        let (shape, data) =
            (ElementShape::of(self.mesh, sector.triangle), &self.solution.data[sector.triangle]);
        let values = self.solution.at_corners(self.mesh, sector.triangle);
        residual(&shape, data, values, sector.own)
    }

    /// Returns what flows out through the first and the last edge, where that is known.
    fn at_ends(&self, node: usize, chain: &[Sector]) -> [Option<f64>; 2] {
        let (first, last) = (&chain[0], &chain[chain.len() - 1]);
        let out = |triangle: usize, opposite: usize| {
            let number = *self.edge_at.get(&(triangle as u32, opposite as u32))?;
            let (edge, data) = (&self.mesh.edges[number], &self.solution.boundary.edges[number]);
            (!data.is_dirichlet).then(|| self.solution.outflow(edge, data, node))
        };
        [out(first.triangle, (first.own + 2) % 3), out(last.triangle, (last.own + 1) % 3)]
    }

    /// Returns the circulation that brings the flux nearest to that of u.
    fn circulation(&self, chain: &[Sector], crossing: &[f64]) -> f64 {
        let (mut product, mut square) = (0.0, 0.0);
        for (n, sector) in chain.iter().enumerate() {
            let triangle = sector.triangle;
            let (shape, data) = (ElementShape::of(self.mesh, triangle), &self.solution.data[triangle]);
            let corners = self.mesh.triangle(triangle);
            let [own, next, last] = [0, 1, 2].map(|k| corners[(sector.own + k) % 3]);
            let gradient = shape.gradient(self.solution.at_corners(self.mesh, triangle));
            let flux = -data.diffusion * shape.stretched(gradient);
            let middle = (own + next + last) / 3.0;
            // Half of the flux of u through both edges at the node, out of the triangle.
            let of_u = [0.5 * flux.dot(outward(own, next)), 0.5 * flux.dot(outward(last, own))];
            let [right, left] = [-crossing[n] - of_u[0], crossing[n + 1] - of_u[1]];
            let integral = 0.5 * (right * (middle - last) + left * (middle - next));
            let unit = (last - next) / (2.0 * shape.area);
            product += shape.flux_product(unit, integral) / data.diffusion;
            square += shape.area * shape.flux_product(unit, unit) / data.diffusion;
        }
        -product / square
    }
}

/// Returns the normal of an edge to the right of its direction, as long as the edge.
fn outward(from: DVec2, to: DVec2) -> DVec2 {
    -(to - from).perp()
}

/// Returns what the equation of a corner has from a triangle: the integral of (f − b·∇u − c u) φ − a∇u·∇φ.
pub(crate) fn residual(shape: &ElementShape, data: &ElementData, values: [f64; 3], own: usize) -> f64 {
    let mass = shape.measure() * data.reaction / 12.0;
    let sum = values[0] + values[1] + values[2];
    let gradient = shape.gradient(values);
    let flux = data.diffusion * shape.energy(gradient, shape.gradients[own]);
    let drift = shape.drift(data.convection, gradient) / 3.0;
    data.loads[own] - drift - mass * (sum + values[own]) - flux
}

impl FemSolution {
    /// Returns what flows out through a boundary edge, weighted by the hat function of one of its ends.
    pub(crate) fn outflow(&self, edge: &FemEdge, data: &EdgeData, node: usize) -> f64 {
        let own = usize::from(edge.ends[1] as usize == node);
        let [own_value, other] = [edge.ends[own], edge.ends[1 - own]].map(|node| self.values[node as usize]);
        data.transfer * edge.length / 6.0 * (2.0 * own_value + other) - data.loads[own]
    }
}
