//! A mesh that is fine enough for a cost, and the way back to the mesh that it was made of.

use std::sync::Arc;

use super::path_mesh::{NONE, PathMesh, PathTriangle};
use super::triangle_costs::{TriangleCost, TriangleCosts, coarsest};
use super::{CostDensity, PathError};
use crate::geometry::Rect;

/// The most triangles that bisection adds to a mesh.
const MOST_ADDED: usize = 50_000;

/// A mesh that was bisected where the cost varies much within a triangle: the mean of such a triangle would
/// hide a narrow way through it.
pub(super) struct Adapted {
    pub mesh: Arc<PathMesh>,
    pub costs: TriangleCosts,
    pub adaptation: Adaptation,
}

impl Adapted {
    /// Bisects a mesh, the base. `known` has the costs of its triangles.
    ///
    /// # Errors
    /// Fails when the cost is zero, negative, NaN or infinite somewhere.
    pub fn new(
        base: Arc<PathMesh>,
        known: &[TriangleCost],
        density: &dyn CostDensity,
    ) -> Result<Self, PathError> {
        Self::with_most(base, known, density, MOST_ADDED)
    }

    fn with_most(
        base: Arc<PathMesh>,
        known: &[TriangleCost],
        density: &dyn CostDensity,
        most: usize,
    ) -> Result<Self, PathError> {
        let coarsest = coarsest(&base);
        let important = |(triangle, &cost)| (base.importance(triangle, cost, coarsest), triangle);
        let wanted: Vec<(f64, u32)> =
            (0..).zip(known).map(important).filter(|&(importance, _)| importance > 0.0).collect();
        if wanted.is_empty() {
            let costs = TriangleCosts::from_slice(known, 0);
            return Ok(Self { mesh: base, costs, adaptation: Adaptation::default() });
        }
        let varied: Vec<u32> = wanted.iter().map(|&(_, triangle)| triangle).collect();
        let (mut mesh, mut costs) = (base.with_room(most), TriangleCosts::from_slice(known, most));
        mesh.bisect(wanted, most, |mesh, triangle| {
            let cost = mesh.cost(triangle, density)?;
            costs.set(triangle, cost);
            Ok::<_, PathError>(mesh.importance(triangle, cost, coarsest))
        })?;
        let bisected = bisected(&base, &mesh, known);
        let order = mesh.sort_along_curve();
        let is_whole = |t: u32| bisected.binary_search_by_key(&t, |bisected| bisected.number).is_err();
        let is_part = |&(_, &old): &(u32, &u32)| old as usize >= known.len() || !is_whole(old);
        let whole = varied.into_iter().filter(|&t| is_whole(t));
        let adaptation = Adaptation {
            nodes: added_nodes(&base, &mesh),
            parts: (0..).zip(&order).filter(is_part).map(|(number, _)| number).collect(),
            greatest: whole.map(|t| (t, known[t as usize].greatest)).collect(),
            bisected,
            has_obtuse: base.has_obtuse,
            changed: Vec::new(),
        };
        Ok(Self { mesh: Arc::new(mesh), costs: costs.in_order(&order), adaptation })
    }
}

/// The difference between a mesh and its base. The base itself would take as much memory as the mesh, and is
/// needed only after an edit.
///
/// Both are sorted along a curve, so what they share is in the same order in both, and its numbers follow
/// from the numbers of what only one of them has:
///
/// ```text
///   base      0  1  2  3  4  5        2 is bisected
///             │  │   ╲  ╲  ╲  ╲
///   mesh      0  1  2  3  4  5  6     2 and 5 are its parts
/// ```
#[derive(Clone, Debug, Default)]
pub(super) struct Adaptation {
    /// The nodes of the mesh that the base does not have, in the order of their numbers.
    nodes: Vec<u32>,
    /// The triangles of the mesh that the base does not have, in the order of their numbers.
    parts: Vec<u32>,
    /// The triangles of the base that the mesh does not have, in the order of their numbers.
    bisected: Vec<Bisected>,
    /// The greatest costs of base triangles that the cost asks to bisect, but that stay whole because of the
    /// limit on added triangles. Other triangles do not need theirs.
    greatest: Vec<(u32, f64)>,
    /// Whether the base has obtuse angles.
    has_obtuse: bool,
    /// Where the cost changed since the mesh was bisected for it.
    pub changed: Vec<Rect>,
}

/// A triangle of a base that was bisected, with numbers of the base.
#[derive(Clone, Copy, Debug)]
struct Bisected {
    number: u32,
    triangle: PathTriangle,
    across: [u32; 3],
    cost: TriangleCost,
}

impl Adaptation {
    /// Returns the base of a mesh.
    pub fn base(&self, mesh: &Arc<PathMesh>) -> Arc<PathMesh> {
        if self.bisected.is_empty() {
            return Arc::clone(mesh);
        }
        let node_numbers = numbers_without(&self.nodes, mesh.node_count());
        let nodes = without(&self.nodes, mesh.node_count()).map(|node| mesh.nodes[node as usize]).collect();
        let mut numbers = vec![NONE; mesh.triangle_count()];
        let (mut triangles, mut across) = (Vec::new(), Vec::new());
        self.visit_base(mesh.triangle_count(), |number, origin| match origin {
            BaseOrigin::Bisected(Bisected { triangle, .. }) => {
                triangles.push(*triangle);
                across.push([NONE; 3]);
            }
            BaseOrigin::Whole(t) => {
                let triangle = mesh.triangles[t as usize];
                let corners = triangle.corners.map(|node| node_numbers[node as usize]);
                triangles.push(PathTriangle { corners, ..triangle });
                across.push(mesh.across[t as usize]);
                numbers[t as usize] = number;
            }
        });
        let renumbered = |t: u32| if t == NONE { NONE } else { numbers[t as usize] };
        across.iter_mut().for_each(|across| *across = across.map(renumbered));
        self.connect_bisected(&triangles, &mut across);
        let mut base = mesh.with_triangles(nodes, triangles, across);
        base.has_obtuse = self.has_obtuse;
        Arc::new(base)
    }

    /// Fills in who is across the edges of the triangles that were bisected, on both sides.
    fn connect_bisected(&self, triangles: &[PathTriangle], across: &mut [[u32; 3]]) {
        for Bisected { number, triangle, across: others, .. } in &self.bisected {
            across[*number as usize] = *others;
            for (edge, &other) in (0..3).zip(others).filter(|&(_, &other)| other != NONE) {
                let end = triangle.corners[(edge + 1) % 3];
                let beyond = triangles[other as usize].corners.iter().position(|&corner| corner == end);
                across[other as usize][beyond.expect("both have the edge")] = *number;
            }
        }
    }

    /// Returns the costs of the triangles of the base, from those of the mesh. For a triangle that need not
    /// be bisected, the greatest cost is not kept, and the least one stands in for it.
    pub fn known_costs(&self, costs: &TriangleCosts) -> Vec<TriangleCost> {
        let mut known = Vec::with_capacity(costs.least.len());
        self.visit_base(costs.least.len(), |_, origin| {
            known.push(match origin {
                BaseOrigin::Bisected(bisected) => bisected.cost,
                BaseOrigin::Whole(t) => {
                    TriangleCost::constant(costs.least[t as usize], costs.mean[t as usize])
                }
            });
        });
        self.greatest.iter().for_each(|&(t, greatest)| known[t as usize].greatest = greatest);
        known
    }

    /// Calls a function for each triangle of the base in the order of their numbers, where the mesh has
    /// `count` triangles.
    fn visit_base<'a>(&'a self, count: usize, mut visit: impl FnMut(u32, BaseOrigin<'a>)) {
        let mut bisected = self.bisected.iter().peekable();
        let mut whole = without(&self.parts, count);
        for number in 0..(count - self.parts.len() + self.bisected.len()) as u32 {
            match bisected.next_if(|bisected| bisected.number == number) {
                Some(bisected) => visit(number, BaseOrigin::Bisected(bisected)),
                None => visit(number, BaseOrigin::Whole(whole.next().expect("all others are whole"))),
            }
        }
    }
}

/// Where a triangle of a base is.
enum BaseOrigin<'a> {
    /// It was bisected.
    Bisected(&'a Bisected),
    /// The mesh has it with this number.
    Whole(u32),
}

/// Returns the triangles of a base that differ in a mesh that was bisected, and not yet sorted.
fn bisected(base: &PathMesh, mesh: &PathMesh, known: &[TriangleCost]) -> Vec<Bisected> {
    let pairs = base.triangles.iter().zip(&mesh.triangles);
    let differs = |(_, (old, new)): &(u32, (&PathTriangle, &PathTriangle))| old.corners != new.corners;
    let of_base = |(number, (&triangle, _)): (u32, (&PathTriangle, &PathTriangle))| {
        let (across, cost) = (base.across[number as usize], known[number as usize]);
        Bisected { number, triangle, across, cost }
    };
    (0..).zip(pairs).filter(differs).map(of_base).collect()
}

/// Returns the nodes of a mesh that its base does not have.
fn added_nodes(base: &PathMesh, mesh: &PathMesh) -> Vec<u32> {
    let mut known = base.nodes.iter().peekable();
    (0..).zip(&mesh.nodes).filter(|(_, at)| known.next_if_eq(at).is_none()).map(|(node, _)| node).collect()
}

/// Returns the numbers up to `count` that are not in a sorted list.
fn without(left_out: &[u32], count: usize) -> impl Iterator<Item = u32> + '_ {
    let mut left_out = left_out.iter().peekable();
    (0..count as u32).filter(move |number| left_out.next_if_eq(&number).is_none())
}

/// Returns the number of each of `count` items once those in a sorted list are left out; [`NONE`] for these.
fn numbers_without(left_out: &[u32], count: usize) -> Vec<u32> {
    let mut numbers = vec![NONE; count];
    (0..).zip(without(left_out, count)).for_each(|(new, old)| numbers[old as usize] = new);
    numbers
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::field::CostFormula;
    use crate::layers::{Mask, RiskField};
    use crate::path::resolve_tests::{random_mesh, refined};
    use crate::path::{FormulaCost, Passage, PathRequest, Planner};

    fn random_base(random: &mut fastrand::Rng) -> PathMesh {
        let ring: Vec<DVec2> = (0..3).map(|_| dvec2(random.f64(), random.f64())).collect();
        match Mask::new(&[vec![ring]]) {
            Ok(mask) if random.bool() => PathMesh::with_keep_out(refined(random, None).view(), &[mask]),
            _ => random_mesh(random),
        }
    }

    #[test]
    fn a_base_is_found_again_with_what_is_needed_of_its_costs() {
        let mut random = fastrand::Rng::with_seed(1407);
        let [mut bisected, mut whole, mut untouched, mut partly] = [0; 4];
        for _ in 0..60 {
            let base = Arc::new(random_base(&mut random));
            let [x, y] = [random.f64(), random.f64()];
            let hill = format!("1 + {}*exp(-30*((x - {x})^2 + (y - {y})^2))", 9.0 * random.f64());
            let density =
                FormulaCost { formula: CostFormula::parse(&hill).unwrap(), risk: RiskField::default() };
            let known = base.all_costs(&density).unwrap();
            let most = [0, 3, 50, 2000][random.usize(..4)];
            let adapted = Adapted::with_most(Arc::clone(&base), &known, &density, most).unwrap();
            let Adapted { mesh, costs, adaptation } = &adapted;
            let found = adaptation.base(mesh);
            assert_eq!(found.nodes, base.nodes);
            assert_eq!(found.triangles, base.triangles);
            assert_eq!(found.across, base.across);
            assert_eq!(found.has_obtuse, base.has_obtuse);
            assert_eq!(found.covers_domain, base.covers_domain);
            let coarsest = coarsest(&base);
            let costs = adaptation.known_costs(costs);
            assert_eq!(costs.len(), known.len());
            for ((triangle, &cost), &expected) in (0..).zip(&costs).zip(&known) {
                let [of_found, of_base] = [(&found, cost), (&base, expected)]
                    .map(|(mesh, cost)| mesh.importance(triangle, cost, coarsest));
                assert_eq!(of_found, of_base);
                assert!(cost.is_like(expected), "{cost:?} {expected:?}");
            }
            bisected += adaptation.bisected.len();
            whole += adaptation.greatest.len();
            untouched += usize::from(adaptation.bisected.is_empty());
            partly += usize::from(base.triangles.iter().any(|triangle| triangle.passage == Passage::Partly));
        }
        assert!(
            bisected > 1000 && whole > 1000 && untouched > 3 && partly > 10,
            "{bisected} {whole} {untouched} {partly}"
        );
    }

    /// Where an area closes a part of the mesh, triangles must be smaller in the rest.
    #[test]
    fn a_planner_that_goes_over_to_another_area_is_as_a_new_one() {
        let mut random = fastrand::Rng::with_seed(1408);
        let (mut others, mut adapted) = (0, 0);
        for _ in 0..30 {
            let mesh = refined(&mut random, None);
            let share = 0.2 + 0.6 * random.f64();
            let ring = [(share, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0), (-1.0, share), (share, share)];
            let rest = Mask::new(&[vec![ring.map(|(x, y)| dvec2(x, y)).to_vec()]]).unwrap();
            let meshes = [PathMesh::new(mesh.view()), PathMesh::with_keep_out(mesh.view(), &[rest])];
            let [whole, part] = meshes.map(Arc::new);
            let [x, y] = [random.f64(), random.f64()];
            let formula = CostFormula::parse(&format!("1 + 5*exp(-20*((x - {x})^2 + (y - {y})^2))")).unwrap();
            let density = FormulaCost { formula, risk: RiskField::default() };
            let (from, to) = if random.bool() { (&whole, &part) } else { (&part, &whole) };
            let mut planner = Planner::new(Arc::clone(from), &density).unwrap();
            planner.move_to(Arc::clone(to), &density, &[]).unwrap();
            let new = Planner::new(Arc::clone(to), &density).unwrap();
            assert!(planner.mesh().is_same_as(new.mesh()));
            assert_eq!(planner.costs().least, new.costs().least);
            assert_eq!(planner.costs().mean, new.costs().mean);
            others += usize::from(coarsest(&whole) != coarsest(&part));
            adapted += usize::from(new.mesh().triangle_count() > to.triangle_count());
        }
        assert!(others > 10 && adapted > 20, "{others} {adapted}");
    }

    /// The nodes around the start are gone on the second mesh, and there again on the third.
    #[test]
    fn a_start_that_is_closed_and_opened_again_has_the_path_of_a_new_planner() {
        let mesh = refined(&mut fastrand::Rng::with_seed(3), None);
        let ring = [(-1.0, -1.0), (0.5, -1.0), (0.5, 0.5), (-1.0, 0.5)];
        let corner = Mask::new(&[vec![ring.map(|(x, y)| dvec2(x, y)).to_vec()]]).unwrap();
        let meshes = [PathMesh::new(mesh.view()), PathMesh::with_keep_out(mesh.view(), &[corner])];
        let [whole, part] = meshes.map(Arc::new);
        let formula = CostFormula::parse("1 + x").unwrap();
        let density = FormulaCost { formula, risk: RiskField::default() };
        let places = [dvec2(0.1, 0.2), dvec2(0.9, 0.8)];
        let mut planner = Planner::new(Arc::clone(&whole), &density).unwrap();
        let first = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        for to in [&part, &part, &whole] {
            planner.move_to(Arc::clone(to), &density, &[]).unwrap();
        }
        assert_eq!(planner.solve(&density, &places, PathRequest::FULL).unwrap().cost, first.cost);
    }
}
