//! A bound of the energy error that holds without unknown constants.
//!
//! For any flux σ whose divergence is the mean of f − c u over each triangle, and whose flux through the
//! boundary has the mean that the conditions ask for, the energy error is at most the root of the sum over
//! triangles of (‖a^½∇u + a^−½σ‖ + oscillations)² \[PragerSynge1947\], \[ErnVohralik2015\]. The oscillations
//! are what data differ from their means: times h/π inside (the constant of Poincaré in a convex set
//! \[PayneWeinberger1960\]), and on an edge e times √(|e| h² (1/π² + 1/π) / |T|), which follows from it by
//! the theorem of Gauss with the field from the opposite corner.
//!
//! Ranges of formulas come from interval arithmetic. What means are wrong by, from integration and from the
//! solver, is carried to the boundary in [`transport`](super::transport).

use std::f64::consts::PI;

use glam::DVec2;
use rayon::prelude::*;

use super::doubt::{Doubt, Doubts};
use super::element::{ElementData, ElementShape};
use super::fem_mesh::{EdgeNumbers, FemMesh, NONE};
use super::flux::Fluxes;
use super::matrix::sum_of;
use super::problem::{FemProblem, Values};
use super::solution::FemSolution;
use super::source_range::SourceRange;
use super::transport::Transport;
use crate::geometry::Rect;

/// A bound of the energy error of a solution.
#[derive(Clone, Debug)]
pub struct ErrorBound {
    /// The energy error is at most this: the root of the integral of a |∇e|² + c e², and of α e² along the
    /// boundary.
    pub total: f64,
    /// The part of each triangle, in the order of the [`FemMesh`]; the sum of their squares is that of the
    /// total, but for what is carried to the boundary.
    pub of_triangles: Vec<f64>,
    /// The part of data that differ from their means, if it were alone.
    pub oscillation: f64,
    /// Why the bound is an estimate; empty where it is guaranteed.
    pub doubts: Vec<Doubt>,
    /// The flux that proves it, out of each triangle through the edge opposite each of its corners, in the
    /// order of the [`FemMesh`]. It is the same on both sides of an edge.
    pub fluxes: Vec<[f64; 3]>,
}

impl ErrorBound {
    /// Bounds the energy error of a solution of a problem on the same mesh.
    pub fn of(mesh: &FemMesh, problem: &FemProblem, solution: &FemSolution) -> Self {
        let edge_at = mesh.edge_numbers();
        let fluxes = Fluxes::of(mesh, solution, &edge_at);
        let parts = BoundParts {
            mesh,
            solution,
            fluxes: &fluxes,
            diffusion: Values::of(&problem.diffusion),
            source: SourceRange::of(&problem.source),
            edge_at: &edge_at,
        };
        let terms: Vec<Term> =
            (0..mesh.triangle_count()).into_par_iter().map(|triangle| parts.term(triangle)).collect();
        let mut doubts = Doubts::of_problem(mesh, problem, solution, fluxes.has_pinches);
        terms.iter().for_each(|term| doubts.add_all(term.doubts));
        let defects: Vec<f64> = terms.par_iter().map(|term| term.defect).collect();
        let transport = Transport::of(mesh, solution, &defects);
        if !transport.is_complete {
            doubts.add(Doubt::Balance);
        }
        let square = |value: f64| value * value;
        let inside = sum_of(terms.len(), |triangle| square(terms[triangle].total())).sqrt();
        let oscillation = sum_of(terms.len(), |triangle| square(terms[triangle].oscillation)).sqrt();
        Self {
            // The last digits of sums and roots.
            total: (inside + transport.norm) * (1.0 + ROUNDING),
            of_triangles: terms.iter().map(Term::total).collect(),
            oscillation,
            doubts: doubts.list(),
            fluxes: fluxes.out,
        }
    }

    /// Returns whether the bound is guaranteed, up to the rounding of its own sums.
    pub fn is_guaranteed(&self) -> bool {
        self.doubts.is_empty()
    }
}

/// A share of the bound for the rounding of its sums.
pub(crate) const ROUNDING: f64 = 1e-9;

struct BoundParts<'a> {
    mesh: &'a FemMesh,
    solution: &'a FemSolution,
    fluxes: &'a Fluxes,
    diffusion: Values<'a>,
    source: SourceRange<'a>,
    edge_at: &'a EdgeNumbers,
}

/// What a triangle adds.
#[derive(Clone, Copy, Debug)]
struct Term {
    flux: f64,
    oscillation: f64,
    /// How far the divergence is at most from the mean of the data, as an integral.
    defect: f64,
    doubts: Doubts,
}

impl Term {
    fn total(&self) -> f64 {
        self.flux + self.oscillation
    }
}

impl BoundParts<'_> {
    fn term(&self, triangle: usize) -> Term {
        let (shape, data) = (ElementShape::of(self.mesh, triangle), &self.solution.data[triangle]);
        let corners = self.mesh.triangle(triangle);
        let values = self.solution.at_corners(self.mesh, triangle);
        let gradient = shape.gradient(values);
        let mut doubts = Doubts::default();
        let [least, greatest] = self.diffusion_range(data, corners, &mut doubts);
        let away = (greatest - data.diffusion).max(data.diffusion - least).max(0.0);
        let varying = away / least.sqrt() * shape.energy(gradient, gradient).max(0.0).sqrt();
        let flux = (data.diffusion / least).sqrt() * self.flux_error(triangle, &shape, corners, gradient);
        let range = self.source.over(corners, data.loads, shape.measure());
        doubts.add_all(range.doubts);
        let reaction = data.reaction * spread(values, shape.measure());
        // The inequality of Poincaré, or what the reaction says.
        let weight = (shape.diameter(corners) / PI / least.sqrt()).min(data.reaction.sqrt().recip());
        let at_edges = self.edge_oscillation(triangle, &shape, corners, least);
        Term {
            flux: flux + varying,
            oscillation: weight * (range.spread + reaction) + at_edges,
            defect: range.defect + self.imbalance(triangle, &shape, values, gradient),
            doubts,
        }
    }

    /// Returns the least and the greatest diffusion in a triangle.
    fn diffusion_range(&self, data: &ElementData, corners: [DVec2; 3], doubts: &mut Doubts) -> [f64; 2] {
        let middle = data.diffusion;
        if self.diffusion.constant().is_some() {
            return [middle; 2];
        }
        let bounds = self.diffusion.formula().bounds(&inner_rect(corners));
        let is_usable = bounds.valid && bounds.least > 0.0 && bounds.greatest <= MOST_JUMP * bounds.least;
        if is_usable {
            return [bounds.least.min(middle), bounds.greatest.max(middle)];
        }
        // A jump inside the triangle, or near it along a slope; or a formula that intervals overestimate.
        let inside = corners
            .map(|corner| self.diffusion.at(corner.lerp((corners[0] + corners[1] + corners[2]) / 3.0, 1e-6)));
        let all = inside.into_iter().chain([middle]).filter(|value| *value > 0.0);
        let range = all.fold([middle; 2], |[least, greatest], value| [least.min(value), greatest.max(value)]);
        doubts.add(Doubt::Diffusion);
        // Where a triangle is divided by a jump, the finite elements see the value in the middle.
        if range[1] <= MOST_JUMP * range[0] { range } else { [middle; 2] }
    }

    /// Returns the norm of a^½∇u + a^−½σ, with the diffusion in the middle.
    fn flux_error(&self, triangle: usize, shape: &ElementShape, corners: [DVec2; 3], gradient: DVec2) -> f64 {
        let diffusion = self.solution.data[triangle].diffusion;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let out = self.fluxes.out[triangle];
        let from = corners.map(|corner| middle - corner);
        let mean = (out[0] * from[0] + out[1] * from[1] + out[2] * from[2]) / (2.0 * shape.area);
        let mean = mean + diffusion * shape.stretched(gradient);
        let rate = (out[0] + out[1] + out[2]) / (2.0 * shape.area);
        let turning: f64 = from.iter().map(|from| shape.flux_product(*from, *from)).sum();
        let square = shape.area * (shape.flux_product(mean, mean) + rate * rate * turning / 12.0);
        (square / diffusion).sqrt()
    }

    /// Returns how far the flux out of a triangle is from what its data bring.
    fn imbalance(&self, triangle: usize, shape: &ElementShape, values: [f64; 3], gradient: DVec2) -> f64 {
        let data = &self.solution.data[triangle];
        let mean = (values[0] + values[1] + values[2]) / 3.0;
        let taken = data.reaction * shape.measure() * mean + shape.drift(data.convection, gradient);
        let brought = data.loads[0] + data.loads[1] + data.loads[2] - taken;
        let out = self.fluxes.out[triangle];
        (out[0] + out[1] + out[2] - brought).abs()
    }

    /// Returns the part of the boundary edges of a triangle whose flux is not constant.
    fn edge_oscillation(
        &self,
        triangle: usize,
        shape: &ElementShape,
        corners: [DVec2; 3],
        least: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for opposite in (0..3).filter(|&k| self.mesh.across[triangle][k] == NONE) {
            let Some(&number) = self.edge_at.get(&(triangle as u32, opposite as u32)) else { continue };
            let (edge, data) = (&self.mesh.edges[number], &self.solution.boundary.edges[number]);
            if data.is_dirichlet {
                continue;
            }
            let [a, b] = edge.ends.map(|node| self.solution.values[node as usize]);
            // The moments of a linear flux give its difference between both ends.
            let slope = 6.0 * (data.loads[1] - data.loads[0]) / edge.length - data.transfer * (b - a);
            let spread = slope.abs() * (edge.length / 12.0).sqrt();
            let diameter = shape.diameter(corners);
            let trace = edge.length * diameter * diameter / shape.measure() * (1.0 / (PI * PI) + 1.0 / PI);
            sum += (trace / least).sqrt() * spread;
        }
        sum
    }
}

/// By which factor the diffusion may vary in a triangle.
const MOST_JUMP: f64 = 4.0;

/// Returns the norm of a linear function less its mean.
fn spread([a, b, c]: [f64; 3], measure: f64) -> f64 {
    let square = (a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a);
    (measure * square / 36.0).sqrt()
}

/// Returns the rectangle around a triangle, less a rim that has no area to speak of: coefficients may jump
/// along the edges.
pub(crate) fn inner_rect(corners: [DVec2; 3]) -> Rect {
    let min = corners[0].min(corners[1]).min(corners[2]);
    let max = corners[0].max(corners[1]).max(corners[2]);
    let rim = 1e-9 * (max - min);
    Rect::new(min + rim, max - rim)
}
