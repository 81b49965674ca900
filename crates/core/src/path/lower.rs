//! A lower bound of what any path costs, from marches on the mesh.

use glam::DVec2;
use rayon::prelude::*;

use super::Passage;
use super::march::March;
use super::path_mesh::PathMesh;
use super::place::MeshPlace;
use crate::mesh::Progress;

/// A lower bound of the least cost of all paths between two places.
///
/// Let v be a subsolution of the eikonal equation: a continuous function that is linear on each triangle with
/// |∇v| ≤ F, the least cost there. Along any path, v grows by no more than the cost of the path, so v(goal) −
/// v(start) is a bound. If |∇v| ≤ F/λ, the bound is λ (v(goal) − v(start)). The marches only propose
/// functions v; the bound follows from the gradients of v alone.
///
/// 1. Paths that can be the best cost `upper` at most. Bounds of the distances from the start and from the
///    goal show through which triangles they go. Only there the gradient counts.
/// 2. v is the signed distance from the bisector, where both distances are equal: it has no source, where
///    marches are least exact.
/// 3. Where |∇v| > F the cost is lowered around, and v is computed again, until little is left to gain. These
///    marches go through the triangles of 1 and some around them: beyond, v may be anything.
#[derive(Clone, Debug)]
pub(super) struct LowerBound {
    march: March,
    /// Whether the march is under way.
    marches: bool,
    v: Vec<f64>,
    costs: Vec<f64>,
    /// The triangles through which a path that costs at most the upper bound may go.
    counting: Vec<u32>,
    factors: Vec<f64>,
    /// Half the difference of the distances from the start and from the goal.
    w: Vec<f64>,
    /// The nodes of triangles in which `w` is 0 somewhere.
    crossed: Vec<u32>,
    /// The factors by which costs were lowered around nodes.
    at_nodes: Vec<f64>,
    /// The bound so far.
    best: f64,
    upper: f64,
    /// How often v was computed.
    corrections: usize,
}

/// The bound is rounded down by this share.
const ROUNDING: f64 = 1e-10;

/// How often v is computed again with lowered costs, at most.
const MOST_CORRECTIONS: usize = 8;
/// v is computed again only where that can raise the bound by at least this share of the upper bound.
const LEAST_GAIN: f64 = 5e-4;
/// Marches go through triangles that can lie on paths of this many times the upper bound.
const MARGIN: f64 = 1.05;
/// Number of triangles that a thread looks at at a time.
const TOGETHER: usize = 4096;

/// The problem whose minimum is bounded from below.
struct Problem<'a> {
    mesh: &'a PathMesh,
    costs: &'a [f64],
    start: MeshPlace,
    goal: MeshPlace,
}

impl LowerBound {
    /// Begins a bound, where `upper` is the cost of a path, and the marches went from the start and from the
    /// goal through all triangles that are not closed. [`Self::raise`] continues for the same places.
    pub fn new(
        mesh: &PathMesh,
        costs: &[f64],
        [start, goal]: [MeshPlace; 2],
        [us, ug]: [&March; 2],
        upper: f64,
    ) -> Self {
        let problem = Problem { mesh, costs, start, goal };
        let [from_start, from_goal] = [us, ug].map(|march| march.values().map(finite).collect::<Vec<f64>>());
        let clamps = rayon::join(
            || problem.clamped(&from_start, start, goal),
            || problem.clamped(&from_goal, goal, start),
        );
        let clamped_gain = problem.gain(&clamps.0).max(-problem.gain(&clamps.1));
        let (counting, costs) = counting(&problem, &clamps, upper);
        drop(clamps);
        let straight = problem.straight(&counting);
        let w: Vec<f64> = from_start.iter().zip(&from_goal).map(|(s, g)| 0.5 * (s - g)).collect();
        Self {
            march: March::default(),
            marches: false,
            v: Vec::new(),
            factors: Vec::new(),
            best: clamped_gain.max(problem.bound(&w, &counting)).max(straight),
            crossed: problem.crossed(&w),
            at_nodes: vec![1.0; mesh.node_count()],
            counting,
            costs,
            w,
            upper,
            corrections: 0,
        }
    }

    /// Raises the bound by one function v, or accepts a limited number of nodes in the march for it. Returns
    /// the bound once that is all.
    pub fn raise(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        [start, goal]: [MeshPlace; 2],
        most: usize,
    ) -> Option<f64> {
        let problem = Problem { mesh, costs, start, goal };
        let Self { w, at_nodes, .. } = self;
        if !self.marches {
            let seed = |&node: &u32| (node, w[node as usize].abs() * at_nodes[node as usize]);
            let seeds: Vec<(u32, f64)> = self.crossed.iter().map(seed).collect();
            self.march.begin(mesh, &seeds);
        }
        let progress = self.march.go_on_for(mesh, &self.costs, Passage::Partly, None, most);
        self.marches = progress == Progress::More;
        if self.marches {
            return None;
        }
        self.v.clear();
        self.v.extend(self.march.values().zip(w).map(|(v, &mut w)| finite(v).copysign(w)));
        self.best = self.best.max(problem.bound(&self.v, &self.counting));
        // Lower costs do not give more.
        let is_last = problem.gain(&self.v) - self.best <= LEAST_GAIN * self.upper;
        if is_last || self.corrections == MOST_CORRECTIONS {
            return Some(self.best.max(0.0) * (1.0 - ROUNDING));
        }
        self.corrections += 1;
        self.lower_costs(&problem);
        None
    }

    /// Lowers the costs around triangles where v is too steep.
    fn lower_costs(&mut self, problem: &Problem) {
        self.factors.clear();
        self.factors.resize(self.at_nodes.len(), 1.0);
        let v = &self.v;
        let ratios = self.counting.par_iter().with_min_len(TOGETHER).map(|&t| problem.ratio(t, v).min(1.0));
        let ratios: Vec<f64> = ratios.collect();
        for (&t, ratio) in self.counting.iter().zip(ratios) {
            for node in problem.mesh.triangles[t as usize].corners {
                let factor = &mut self.factors[node as usize];
                *factor = factor.min(ratio);
            }
        }
        let factors = &self.factors;
        let triangles = problem.mesh.triangles.par_iter().with_min_len(TOGETHER);
        self.costs.par_iter_mut().zip(triangles).for_each(|(cost, triangle)| {
            *cost *= triangle.corners.iter().map(|&node| factors[node as usize]).fold(1.0, f64::min);
        });
        self.at_nodes.iter_mut().zip(&self.factors).for_each(|(all, factor)| *all *= factor);
    }
}

/// Returns the triangles through which a path that costs at most `upper` may go, and the costs of all, where
/// those far from them are closed. `clamps` are bounds of the distances from both ends.
fn counting(problem: &Problem, clamps: &(Vec<f64>, Vec<f64>), upper: f64) -> (Vec<u32>, Vec<f64>) {
    let (mut counting, mut costs) = (Vec::new(), Vec::with_capacity(problem.mesh.triangle_count()));
    for (t, triangle) in (0..).zip(&problem.mesh.triangles) {
        let at = |&node: &u32| clamps.0[node as usize] + clamps.1[node as usize];
        let least = triangle.corners.iter().map(at).fold(f64::INFINITY, f64::min);
        if least <= upper * (1.0 + ROUNDING) && triangle.is_passable() {
            counting.push(t);
        }
        let is_near = least <= upper * MARGIN;
        costs.push(if is_near { problem.costs[t as usize] } else { f64::INFINITY });
    }
    (counting, costs)
}

impl Problem<'_> {
    fn is_open(&self, t: u32) -> bool {
        self.mesh.passage(t) > Passage::Closed
    }

    /// Returns the cost of a triangle by the gradient of a function there; infinite where it is constant.
    fn ratio(&self, t: u32, v: &[f64]) -> f64 {
        let [a, b, c] = self.mesh.corners(t);
        let [at_a, at_b, at_c] = self.mesh.triangles[t as usize].corners.map(|node| v[node as usize]);
        let (p, q) = (b - a, c - a);
        let (rise_p, rise_q) = (at_b - at_a, at_c - at_a);
        // ∇v = (rise_p q⊥ − rise_q p⊥) / area, rotated.
        let gradient: DVec2 = rise_p * q - rise_q * p;
        self.costs[t as usize] * p.perp_dot(q).abs() / gradient.length()
    }

    /// Returns how much a function grows from the start to the goal.
    fn gain(&self, v: &[f64]) -> f64 {
        self.goal.interpolate(self.mesh, v) - self.start.interpolate(self.mesh, v)
    }

    /// Returns the bound by a function whose gradients count in some triangles.
    fn bound(&self, v: &[f64], counting: &[u32]) -> f64 {
        let ratios = counting.par_iter().with_min_len(TOGETHER).map(|&t| self.ratio(t, v));
        let scale = ratios.reduce(|| 1.0, f64::min);
        let bound = scale * self.gain(v);
        if bound.is_nan() { 0.0 } else { bound }
    }

    /// Returns the bound by a function that grows along the straight line from the start to the goal: the
    /// least cost where paths can go, times the distance. Between near places the marches know less.
    fn straight(&self, counting: &[u32]) -> f64 {
        let least = counting.iter().map(|&t| self.costs[t as usize]).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least * self.start.point.distance(self.goal.point) } else { 0.0 }
    }

    /// Returns a function that is at most the distance from a place everywhere: λ · (max(u, r) − its value
    /// there), with the r that gives most at the other place, and λ by the gradients in all triangles.
    fn clamped(&self, u: &[f64], from: MeshPlace, to: MeshPlace) -> Vec<f64> {
        let total = to.interpolate(self.mesh, u);
        let limits: Vec<f64> = std::iter::once(0.0)
            .chain((0..CLAMPS).map(|n| total * f64::from(1 << n) / f64::from(1 << CLAMPS)))
            .collect();
        // The least ratio of the triangles that reach above each limit.
        let mut scales = vec![1.0_f64; limits.len()];
        for t in (0..self.mesh.triangle_count() as u32).filter(|&t| self.is_open(t)) {
            let corners = self.mesh.triangles[t as usize].corners;
            let highest = corners.iter().map(|&node| u[node as usize]).fold(0.0, f64::max);
            let reached = limits.partition_point(|&limit| limit < highest);
            if reached > 0 {
                let scale = &mut scales[reached - 1];
                *scale = scale.min(self.ratio(t, u));
            }
        }
        for n in (1..scales.len()).rev() {
            scales[n - 1] = scales[n - 1].min(scales[n]);
        }
        let gain = |n: &usize| scales[*n] * (total - limits[*n]);
        let best = (0..limits.len()).max_by(|a, b| gain(a).total_cmp(&gain(b))).unwrap_or(0);
        let limit = limits[best];
        let mut function: Vec<f64> = u.iter().map(|&value| value.max(limit)).collect();
        // Interpolated, the clamped function may be steeper than u where triangles are obtuse.
        let open = (0..self.mesh.triangle_count() as u32).filter(|&t| self.is_open(t));
        let scale = open.map(|t| self.ratio(t, &function)).fold(1.0, f64::min) * (1.0 - ROUNDING);
        let base = from.interpolate(self.mesh, &function);
        function.iter_mut().for_each(|value| *value = scale * (*value - base));
        function
    }

    /// Returns the corners of the triangles in which a function has both signs.
    fn crossed(&self, w: &[f64]) -> Vec<u32> {
        let mut is_crossed = vec![false; w.len()];
        for t in (0..self.mesh.triangle_count() as u32).filter(|&t| self.is_open(t)) {
            let corners = self.mesh.triangles[t as usize].corners;
            let signs = corners.map(|node| w[node as usize].is_sign_negative());
            if signs != [signs[0]; 3] {
                corners.iter().for_each(|&node| is_crossed[node as usize] = true);
            }
        }
        (0..w.len() as u32).filter(|&node| is_crossed[node as usize]).collect()
    }
}

/// The number of limits that a clamped function is tried with.
const CLAMPS: u32 = 10;

/// Returns a value for nodes that no path reaches: their triangles do not touch those that count.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}
