//! Makes a path through triangles smooth, which lowers its cost.

use glam::DVec2;

use super::CostDensity;
use super::integral::mean_cost;
use super::taut::{is_constant_along, taut};
use super::walls::Walls;
use crate::mesh::Progress;

/// How much work goes into a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// About how many pieces the path has in each round.
    pub pieces: &'static [usize],
    /// Steps of Newton's method in each round.
    pub steps: usize,
}

impl Effort {
    /// The effort for a path that is shown, and may be improved later.
    pub const FULL: Self = Self { pieces: &[32, 128, 512], steps: 25 };
    /// The effort for a path that is shown during a drag.
    pub const LIVE: Self = Self { pieces: &[32, 128], steps: 8 };
    /// The effort for a path that is only compared with another one.
    pub(super) const SKETCH: Self = Self { pieces: &[32], steps: 8 };
}

/// Pieces of a path with one cost per metre on the Earth. Such a path hardly bends in the plane, and a person
/// who follows it wants few points: with this many, the error of the cost is at most 10⁻⁶.
const MOST_OF_GEODESIC: usize = 128;

/// Returns a path of lower cost near a polyline. If the walls admit the polyline, they admit the path, too.
///
/// Its vertices move along their normals only: along the path they would slide together. Each round divides
/// the pieces and takes some steps of Newton's method with damping; the matrix is tridiagonal, because a
/// piece depends on its two ends. Before and afterwards it is pulled taut; where the cost is constant all
/// along, that is all.
pub(super) fn refine(
    points: &[DVec2],
    density: &dyn CostDensity,
    walls: &Walls,
    effort: Effort,
) -> Vec<DVec2> {
    let mut refining = Refining::new(points.to_vec(), effort);
    loop {
        if let Some(points) = refining.advance(density, walls) {
            return points;
        }
    }
}

/// The work of [`refine`], a step of Newton's method at a time.
#[derive(Clone, Debug)]
pub(super) struct Refining {
    points: Vec<DVec2>,
    effort: Effort,
    stage: RefiningStage,
}

/// What is done next.
#[derive(Clone, Copy, Debug)]
enum RefiningStage {
    Begin,
    /// The first of these rounds begins.
    Divide(&'static [usize]),
    /// Vertices move: the number of steps, then these rounds.
    Relax(Relaxing, usize, &'static [usize]),
}

impl Refining {
    pub fn new(points: Vec<DVec2>, effort: Effort) -> Self {
        Self { points, effort, stage: RefiningStage::Begin }
    }

    /// Takes a step. Returns the path at the end. Every call must get the same cost and walls.
    pub fn advance(&mut self, density: &dyn CostDensity, walls: &Walls) -> Option<Vec<DVec2>> {
        let Self { points, effort, stage } = self;
        *stage = match *stage {
            RefiningStage::Begin => {
                let Some(&first) = effort.pieces.first() else { return Some(std::mem::take(points)) };
                *points = taut(&thin_out(points, walls, first), density, walls);
                if is_constant_along(points, |rectangle| density.range(rectangle)) {
                    return Some(std::mem::take(points));
                }
                let is_geodesic = is_constant_along(points, |rectangle| density.range_on_ground(rectangle));
                let most = if is_geodesic { MOST_OF_GEODESIC } else { usize::MAX };
                let rounds = effort.pieces.iter().take_while(|&&pieces| pieces <= most).count();
                RefiningStage::Divide(&effort.pieces[..rounds])
            }
            RefiningStage::Divide([]) => return Some(taut(points, density, walls)),
            RefiningStage::Divide([pieces, rounds @ ..]) => {
                divide(points, walls, *pieces);
                let relaxation = Relaxation { points, density, walls };
                match relaxation.begin() {
                    Some(relaxing) => RefiningStage::Relax(relaxing, effort.steps, rounds),
                    None => RefiningStage::Divide(rounds),
                }
            }
            RefiningStage::Relax(_, 0, rounds) => RefiningStage::Divide(rounds),
            RefiningStage::Relax(mut relaxing, steps, rounds) => {
                match (Relaxation { points, density, walls }).step(&mut relaxing) {
                    Progress::More => RefiningStage::Relax(relaxing, steps - 1, rounds),
                    Progress::Done => RefiningStage::Divide(rounds),
                }
            }
        };
        None
    }
}

/// Chords of about equal lengths in place of many short pieces, where the walls admit them.
fn thin_out(points: &[DVec2], walls: &Walls, pieces: usize) -> Vec<DVec2> {
    let lengths: Vec<f64> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let longest = lengths.iter().sum::<f64>() / pieces as f64;
    let mut thinned = vec![points[0]];
    let mut at = 0;
    while at + 1 < points.len() {
        let (mut end, mut length) = (at + 1, lengths[at]);
        while end + 1 < points.len() && length + lengths[end] <= longest {
            length += lengths[end];
            end += 1;
        }
        // A piece of the polyline itself is always admitted.
        while end > at + 1 && !walls.admit(points[at], points[end]) {
            end = at + (end - at) / 2;
        }
        thinned.push(points[end]);
        at = end;
    }
    thinned
}

/// Divides the longer pieces until there are about this many.
fn divide(points: &mut Vec<DVec2>, walls: &Walls, pieces: usize) {
    let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let longest = length / pieces as f64;
    let mut divided = vec![points[0]];
    for pair in points.windows(2) {
        let parts = (pair[0].distance(pair[1]) / longest * 0.999).ceil().max(1.0) as usize;
        let mut last = pair[0];
        for left in (2..=parts).rev() {
            // A part that no point divides is divided with the next.
            if let Some(point) = walls.between(last, pair[1], 1.0 / left as f64) {
                divided.push(point);
                last = point;
            }
        }
        divided.push(pair[1]);
    }
    *points = divided;
}

/// Newton's method for the moves of the vertices along their normals.
struct Relaxation<'a> {
    points: &'a mut Vec<DVec2>,
    density: &'a dyn CostDensity,
    walls: &'a Walls,
}

/// The state of a round.
#[derive(Clone, Copy, Debug)]
struct Relaxing {
    cost: f64,
    /// The addition to the diagonal, as a share of it.
    damping: f64,
}

/// The derivatives of the cost by the moves of the inner vertices.
#[derive(Default)]
struct QuadraticCost {
    gradient: Vec<f64>,
    diagonal: Vec<f64>,
    /// The matrix entries between a vertex and the next one.
    beside: Vec<f64>,
}

/// A step that gains less than this share of the cost is the last.
const LEAST_GAIN: f64 = 1e-11;

/// Pieces shorter than this share of the mean length are joined with the next.
const SHORTEST: f64 = 0.45;

impl Relaxation<'_> {
    /// Begins a round; `None` where there is nothing to move.
    fn begin(&self) -> Option<Relaxing> {
        (self.points.len() > 2).then(|| Relaxing { cost: self.cost(self.points), damping: 1e-2 })
    }

    /// Takes a step of Newton's method. Returns whether another one may gain more.
    fn step(&mut self, relaxing: &mut Relaxing) -> Progress {
        let Relaxing { cost, damping } = relaxing;
        if self.even_out() | self.pull_to_corners() {
            *cost = self.cost(self.points);
        }
        let normals = self.normals();
        let quadratic = self.quadratic(&normals);
        let before = *cost;
        // Ends: the damping grows up to a bound.
        while *damping < 1e8 {
            let moves = quadratic.solve(*damping);
            let moved = self.moved(&normals, moves);
            let new = self.cost(&moved);
            if new < *cost {
                (*self.points, *cost) = (moved, new);
                *damping = (0.1 * *damping).max(1e-9);
                break;
            }
            *damping *= 10.0;
        }
        let is_last = self.points.len() < 3 || before - *cost <= LEAST_GAIN * before;
        if is_last { Progress::Done } else { Progress::More }
    }

    /// Removes vertices that came too near to others, and returns whether there were any. Pieces of very
    /// different lengths would keep the vertices from moving.
    fn even_out(&mut self) -> bool {
        let points = &*self.points;
        let count = points.len();
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let mean = length / (count - 1) as f64;
        let mut kept = vec![points[0]];
        for n in 1..count - 1 {
            let last = kept[kept.len() - 1];
            let nearest = last.distance(points[n]).min(points[n].distance(points[n + 1]));
            if nearest > SHORTEST * mean || !self.walls.admit(last, points[n + 1]) {
                kept.push(points[n]);
            }
        }
        kept.push(points[count - 1]);
        let has_removed = kept.len() < count;
        if has_removed {
            *self.points = kept;
        }
        has_removed
    }

    /// Moves vertices that a wall keeps from the chord of their neighbours to the corner of the wall, if that
    /// costs less. Returns whether there were any.
    fn pull_to_corners(&mut self) -> bool {
        let mut has_moved = false;
        for n in 1..self.points.len() - 1 {
            let [p, at, q] = [self.points[n - 1], self.points[n], self.points[n + 1]];
            if self.walls.admit(p, q) {
                continue;
            }
            let Some(corner) = self.walls.corner_within(p, q, at).filter(|&corner| corner != at) else {
                continue;
            };
            let is_better =
                self.piece(p, corner) + self.piece(corner, q) < self.piece(p, at) + self.piece(at, q);
            if is_better && self.walls.admit(p, corner) && self.walls.admit(corner, q) {
                self.points[n] = corner;
                has_moved = true;
            }
        }
        has_moved
    }

    fn cost(&self, points: &[DVec2]) -> f64 {
        points.windows(2).map(|pair| self.piece(pair[0], pair[1])).sum()
    }

    fn piece(&self, p: DVec2, q: DVec2) -> f64 {
        p.distance(q) * mean_cost(p, q, self.density)
    }

    /// Unit vectors across the path; zero at its ends.
    fn normals(&self) -> Vec<DVec2> {
        let inner = self.points.windows(3).map(|three| (three[2] - three[0]).perp().normalize_or_zero());
        std::iter::once(DVec2::ZERO).chain(inner).chain([DVec2::ZERO]).collect()
    }

    /// Derivatives by differences over a tenth of the length of the piece.
    fn quadratic(&self, normals: &[DVec2]) -> QuadraticCost {
        let count = self.points.len();
        let mut result = QuadraticCost {
            gradient: vec![0.0; count],
            diagonal: vec![0.0; count],
            beside: vec![0.0; count],
        };
        for n in 0..count - 1 {
            let [p, q] = [self.points[n], self.points[n + 1]];
            let step = 0.1 * p.distance(q);
            if step == 0.0 {
                continue;
            }
            let [u, v] = [step * normals[n], step * normals[n + 1]];
            let at = |i: f64, j: f64| self.piece(p + i * u, q + j * v);
            let (middle, both, neither) = (at(0.0, 0.0), at(1.0, 1.0), at(-1.0, -1.0));
            let [[p_up, p_down], [q_up, q_down]] =
                [[at(1.0, 0.0), at(-1.0, 0.0)], [at(0.0, 1.0), at(0.0, -1.0)]];
            let squared = step * step;
            result.gradient[n] += (p_up - p_down) / (2.0 * step);
            result.gradient[n + 1] += (q_up - q_down) / (2.0 * step);
            result.diagonal[n] += (p_up - 2.0 * middle + p_down) / squared;
            result.diagonal[n + 1] += (q_up - 2.0 * middle + q_down) / squared;
            result.beside[n] =
                (both + neither + 2.0 * middle - p_up - p_down - q_up - q_down) / (2.0 * squared);
        }
        result
    }

    /// Returns the path with its vertices moved, less far where the walls are in the way.
    fn moved(&self, normals: &[DVec2], mut moves: Vec<f64>) -> Vec<DVec2> {
        for (n, step) in moves.iter_mut().enumerate().skip(1) {
            let reach = self.points.get(n + 1).map_or(0.0, |next| {
                0.5 * self.points[n].distance(*next).min(self.points[n].distance(self.points[n - 1]))
            });
            *step = step.clamp(-reach, reach);
        }
        let place = |n: usize, moves: &[f64]| self.points[n] + moves[n] * normals[n];
        // A piece without moves is one of the path, so this ends with admitted pieces only.
        for halving in 0..6 {
            let mut is_admitted = true;
            for n in 0..self.points.len() - 1 {
                if moves[n] == 0.0 && moves[n + 1] == 0.0 {
                    continue;
                }
                if !self.walls.admit(place(n, &moves), place(n + 1, &moves)) {
                    let factor = if halving < 4 { 0.5 } else { 0.0 };
                    moves[n] *= factor;
                    moves[n + 1] *= factor;
                    is_admitted = false;
                }
            }
            if is_admitted {
                return (0..self.points.len()).map(|n| place(n, &moves)).collect();
            }
        }
        self.without_blocked(normals, moves)
    }

    /// Returns the path with those moves that the walls admit, one vertex after the other.
    fn without_blocked(&self, normals: &[DVec2], moves: Vec<f64>) -> Vec<DVec2> {
        let mut points = self.points.clone();
        for n in 1..points.len() - 1 {
            let to = points[n] + moves[n] * normals[n];
            if self.walls.admit(points[n - 1], to) && self.walls.admit(to, points[n + 1]) {
                points[n] = to;
            }
        }
        points
    }
}

impl QuadraticCost {
    /// Returns the moves that lead to the least value of the quadratic function with a damped diagonal, by
    /// elimination. Where the diagonal is not positive, more is added.
    fn solve(&self, damping: f64) -> Vec<f64> {
        let count = self.gradient.len();
        let scale = self.diagonal.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut moves = vec![0.0; count];
        let mut diagonal = vec![0.0; count];
        for n in 1..count - 1 {
            let own = self.diagonal[n].abs().max(1e-9 * scale) * (1.0 + damping);
            let (mut pivot, mut right) = (own, -self.gradient[n]);
            if n > 1 {
                let factor = self.beside[n - 1] / diagonal[n - 1];
                pivot -= factor * self.beside[n - 1];
                right -= factor * moves[n - 1];
            }
            // Not convex in this direction: a smaller step.
            diagonal[n] = if pivot > 1e-6 * own { pivot } else { own };
            moves[n] = right;
        }
        for n in (1..count - 1).rev() {
            let next = if n + 2 < count { self.beside[n] * moves[n + 1] } else { 0.0 };
            moves[n] = (moves[n] - next) / diagonal[n];
        }
        moves
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::CostFormula;
    use crate::layers::RiskField;
    use crate::path::FormulaCost;
    use crate::path::walls::tests::with_hole;

    #[test]
    fn a_vertex_moves_to_the_corner_of_a_wall_only_where_that_costs_less_and_is_admitted() {
        let walls = Walls::new(&with_hole());
        let corner = DVec2::splat(0.375);
        let pulled = |path: [DVec2; 3], formula: &str| {
            let formula = CostFormula::parse(formula).expect("a formula");
            let density = FormulaCost { formula, risk: RiskField::default() };
            let mut points = path.to_vec();
            let has_moved =
                Relaxation { points: &mut points, density: &density, walls: &walls }.pull_to_corners();
            assert_eq!(has_moved, points != path, "{path:?}");
            points[1]
        };
        let [p, q, apart] = [dvec2(0.3, 0.55), dvec2(0.55, 0.3), DVec2::splat(0.25)];
        assert!(!walls.admit(p, q) && walls.admit(p, corner) && walls.admit(corner, q));
        assert_eq!(pulled([p, apart, q], "1"), corner, "the shorter way");
        let dear_at_corner = "1 + 20 / (1 + 1000 * ((x - 0.375)^2 + (y - 0.375)^2))";
        assert_eq!(pulled([p, apart, q], dear_at_corner), apart, "a way that costs more");
        // Around two corners: the way to the farther one goes through the hole.
        let [p, at, q] = [dvec2(0.45, 0.7), dvec2(0.1, 0.45), dvec2(0.7, 0.2)];
        assert!(walls.admit_all(&[p, at, q]) && !walls.admit(p, corner) && walls.admit(corner, q));
        assert_eq!(pulled([p, at, q], "1"), at, "a way through the hole");
    }
}
