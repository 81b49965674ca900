//! What the certificate of a mesh states of each triangle that must be bisected.

use std::collections::HashSet;

use glam::{DVec2, dvec2};
use meshbrush_core::build::{BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::explain::{Bisections, Witness};
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::{Layer, PaintLayers};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress, TreeTriangle};

use super::{spec, target};

fn built(domain: Domain, boundary: BoundaryTreatment, formula: &str, rule: RefinementRule) -> BuiltMesh {
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, 0.25, 1_000).unwrap(),
        domain,
        boundary,
        lines: Default::default(),
        field: spec(Layer::stack([target(formula)])),
        rule,
        cleaning: Cleaning::NONE,
        limits: Limits::default(),
    });
    while builder.advance(Some(PaintLayers::blank()), 10_000).unwrap() == Progress::More {}
    builder.finish()
}

fn bisections(built: &BuiltMesh) -> Bisections {
    Bisections::of(&built.mesh, &built.criterion(Some(PaintLayers::blank())), &Limits::default())
}

/// The apex and the middle of the bisection edge: the ends of the edge come in either order.
fn key(triangle: &TreeTriangle) -> [LatticePoint; 2] {
    [triangle.corners()[0], triangle.midpoint()]
}

/// Returns what the triangles asked for force: their ancestors, and with each triangle the one across its bisection
/// edge with its own ancestors.
fn closure(asked: &[(TreeTriangle, Witness)], built: &BuiltMesh) -> HashSet<[LatticePoint; 2]> {
    let mut waiting: Vec<TreeTriangle> = asked.iter().map(|(triangle, _)| *triangle).collect();
    let mut found = HashSet::new();
    while let Some(triangle) = waiting.pop() {
        if found.insert(key(&triangle)) {
            waiting.extend(triangle.parent(built.mesh.lattice()));
            waiting.extend(triangle.across(&built.mesh));
        }
    }
    found
}

/// Checks each witness without the search that found it, and returns how many there are of the outline, at corners,
/// at middles of edges, and elsewhere.
fn check(built: &BuiltMesh, boundary: f64) -> [usize; 4] {
    let Bisections { coarse, leaves, asked } = bisections(built);
    let mut counts = [0; 4];
    for (triangle, witness) in &asked {
        let corners = triangle.corners().map(|corner| built.mesh.lattice().world_from_lattice(corner));
        let diameter = corners[1].distance(corners[2]);
        let Witness::Target { at, target } = *witness else {
            assert!(*witness == Witness::Outline && diameter > boundary, "{witness:?}");
            counts[0] += 1;
            continue;
        };
        // h̄ is constant on cells: where several meet, the least counts.
        let half = 0.5 * built.mesh.lattice().step();
        let cells = [-half.x, half.x].into_iter().flat_map(|x| [-half.y, half.y].map(|y| at + dvec2(x, y)));
        let targets = cells.map(|at| built.field.decision_at(PaintLayers::blank(), at).target);
        let expected = targets.fold(f64::INFINITY, f64::min);
        assert!((target / expected - 1.0).abs() < 1e-5, "{target} {expected}");
        assert!(target < diameter, "{witness:?} {corners:?}");
        let side = |n: usize| (corners[(n + 1) % 3] - corners[n]).perp_dot(at - corners[n]);
        let turn = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).signum();
        assert!((0..3).all(|n| turn * side(n) >= -1e-12), "{at} is not in {corners:?}");
        let middle = |n: usize| corners[n].midpoint(corners[(n + 1) % 3]);
        let place = match () {
            () if corners.contains(&at) => 1,
            () if (0..3).any(|n| middle(n) == at) => 2,
            () => 3,
        };
        counts[place] += 1;
    }
    let lattice = built.mesh.lattice();
    let above = |leaf: &TreeTriangle| std::iter::successors(leaf.parent(lattice), |one| one.parent(lattice));
    let bisected: HashSet<_> = leaves.iter().flat_map(above).map(|triangle| key(&triangle)).collect();
    let forced = closure(&asked, built);
    assert!(bisected.is_subset(&forced), "what is asked for forces the rest");
    // Beyond polygons there are triangles across edges, too.
    assert!(boundary > 0.0 || bisected.len() == forced.len() && forced.len() == leaves.len() - coarse.len());
    counts
}

#[test]
fn each_demand_has_a_witness_that_holds_and_together_they_force_the_mesh() {
    let square = || Domain::rectangle(Rect::UNIT);
    for rule in [RefinementRule::Area, RefinementRule::Vertex] {
        let built = built(square(), BoundaryTreatment::Report, "0.02 + 0.3*hypot(x - 0.31, y - 0.42)", rule);
        assert!(check(&built, 0.0)[1] > 50);
    }
    // A dot in the middle of a coarse triangle: at no corner and on no edge of it.
    let coarse = built(square(), BoundaryTreatment::Report, "1", RefinementRule::Area);
    let (first, _) = coarse.mesh.triangles().nth(9).unwrap();
    let at = coarse.mesh.world_corners(first).iter().sum::<DVec2>() / 3.0;
    let dot = format!("if(hypot(x - {}, y - {}) < 0.001, 0.1, 1)", at.x, at.y);
    let built = built(square(), BoundaryTreatment::Report, &dot, RefinementRule::Area);
    assert!(check(&built, 0.0)[3] > 0);
    let asked = bisections(&built).asked;
    let (_, witness) = asked.iter().find(|(triangle, _)| triangle.level() == 0).unwrap();
    assert!(
        matches!(witness, Witness::Target { at: there, .. } if there.distance(at) < 1e-12),
        "{witness:?}"
    );
}

#[test]
fn a_demand_of_the_outline_is_larger_than_the_boundary_diameter() {
    let ring = vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.9, 0.7), dvec2(0.2, 1.0)];
    let domain = Domain::of_polygons(&[vec![ring]]).unwrap();
    let boundary = BoundaryTreatment::OnOutline { diameter: 0.04 };
    let built = built(domain, boundary, "0.05 + 0.5*hypot(x - 0.5, y - 0.4)", RefinementRule::Area);
    let [outline, corners, ..] = check(&built, 0.04);
    assert!(outline > 50 && corners > 5, "{outline} {corners}");
}
