//! The invariants hold after every kind of edit, for any answers of the rule.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Element, InvalidTarget, Limits, Mesh, RefineError, Refiner, TriangleId};

/// Returns the unit square in 4 × 4 cells, without a corner and a node inside, so that diagonals are on the
/// boundary.
fn with_a_hole() -> Mesh {
    let removed = [DVec2::ZERO, dvec2(0.5, 0.75)];
    Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap(),
        |p| !removed.contains(&p),
        &Limits::default(),
    )
    .unwrap()
}

/// Target diameters that grow with the distance from a few points; an edit moves one, adds one or takes one
/// away.
struct Field(Vec<(DVec2, f64)>);

impl Field {
    fn edit(&mut self, random: &mut Rng) {
        if self.0.len() > 3 || (!self.0.is_empty() && random.bool()) {
            self.0.swap_remove(random.usize(..self.0.len()));
        } else {
            let at = dvec2(random.f64(), random.f64());
            self.0.push((at, 0.3 * 0.01f64.powf(random.f64())));
        }
    }

    fn target(&self, x: DVec2) -> f64 {
        self.0.iter().map(|&(at, finest)| finest + 0.5 * at.distance(x)).fold(1.0, f64::min)
    }
}

/// Eq. (13) with the vertex rule, refusing what no mesh can satisfy.
fn vertex_rule(target: impl Fn(DVec2) -> f64) -> impl Fn(&Element) -> Result<bool, InvalidTarget> {
    move |element| {
        for at in element.world_corners() {
            let value = target(at);
            if value.is_nan() || value <= 0.0 {
                return Err(InvalidTarget { at, value });
            }
            if element.diameter() > value {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

#[test]
fn a_thousand_edits_with_rebuild_break_nothing() {
    let mut random = Rng::with_seed(1);
    let coarse = with_a_hole();
    let mut mesh = coarse.clone();
    let mut refiner = Refiner::new(&mesh, Limits::default());
    let mut field = Field(Vec::new());
    for edit in 0..1000 {
        field.edit(&mut random);
        // In the memory of the mesh before; every tenth time also from nothing.
        mesh.clone_from(&coarse);
        refiner.restart(&mesh);
        refiner.advance(&mut mesh, vertex_rule(|x| field.target(x)), usize::MAX).unwrap();
        assert_eq!(mesh.violations(), [], "edit {edit}");
        assert_eq!(mesh.unsatisfied(vertex_rule(|x| field.target(x))).unwrap(), [], "edit {edit}");
        if edit % 10 == 0 {
            let mut rebuilt = with_a_hole();
            rebuilt.refine(&Limits::default(), vertex_rule(|x| field.target(x))).unwrap();
            assert_eq!(
                (rebuilt.raw_nodes(), rebuilt.raw_triangles()),
                (mesh.raw_nodes(), mesh.raw_triangles()),
                "edit {edit}"
            );
        }
    }
}

#[test]
fn calls_on_any_triangles_break_nothing() {
    for seed in 0..40 {
        let mut random = Rng::with_seed(seed);
        let mut mesh = with_a_hole();
        for call in 0..60 {
            let count = mesh.raw_triangle_count();
            let first = if random.bool() { count.saturating_sub(4) } else { 0 };
            mesh.refine_triangle(TriangleId::from_index(random.usize(first..count)));
            if call % 4 == 0 {
                assert_eq!(mesh.violations(), [], "seed {seed}, call {call}");
            }
        }
    }
}

#[test]
fn a_bad_target_is_refused_and_the_mesh_stays_conforming() {
    for bad in [f64::NAN, 0.0, -0.0, -1.0, f64::NEG_INFINITY, 1e-300, 5e-324] {
        let mut mesh = with_a_hole();
        // Good on the left, so that there is a mesh to spoil.
        let rule = vertex_rule(|x| if x.x > 0.6 { bad } else { 0.05 });
        let error = mesh.refine(&Limits::default(), &rule).unwrap_err();
        assert_eq!(mesh.violations(), [], "{bad}");
        match error {
            RefineError::Rule(InvalidTarget { at, value }) => {
                assert!(bad.is_nan() || bad <= 0.0, "{bad}: {error}");
                assert!(at.x > 0.6 && (value == bad || value.is_nan() && bad.is_nan()));
            }
            RefineError::TooFine { at, smallest, level } => {
                assert!(bad > 0.0, "{bad}: {error}");
                assert!(at.x > 0.5 && smallest > bad && level == mesh.lattice().deepest_level());
            }
            _ => panic!("{bad}: {error}"),
        }
    }
    let mut mesh = with_a_hole();
    mesh.refine(&Limits::default(), vertex_rule(|_| f64::INFINITY)).unwrap();
    assert_eq!(mesh.raw_triangles(), with_a_hole().raw_triangles(), "an infinite target asks for nothing");
}

#[test]
fn the_triangle_budget_is_never_passed_and_never_refused_too_soon() {
    let rule = || vertex_rule(|x| if x.x > 0.5 { 0.02 } else { 0.3 });
    let mut whole = with_a_hole();
    whole.refine(&Limits::default(), rule()).unwrap();
    let needed = whole.raw_triangle_count();
    for limit in [1, 40, 100, needed / 2, needed - 1] {
        let mut mesh = with_a_hole();
        let coarse = mesh.raw_triangle_count();
        let limits = Limits { max_triangles: limit, ..Limits::default() };
        let error = mesh.refine(&limits, rule()).unwrap_err();
        assert_eq!(error, RefineError::TooManyTriangles { limit });
        assert!(mesh.raw_triangle_count() <= limit.max(coarse), "{limit}");
        assert_eq!(mesh.violations(), [], "{limit}");
    }
    let limits = Limits { max_triangles: needed, ..Limits::default() };
    let mut mesh = with_a_hole();
    mesh.refine(&limits, rule()).unwrap();
    assert_eq!(mesh.fingerprint(), whole.fingerprint());
}

#[test]
fn work_stopped_by_the_budget_can_go_on_with_another() {
    let rule = || vertex_rule(|x| 0.01 + 0.5 * x.distance(dvec2(0.7, 0.2)));
    let mut whole = with_a_hole();
    whole.refine(&Limits::default(), rule()).unwrap();
    let mut mesh = with_a_hole();
    let limits = Limits { max_triangles: whole.raw_triangle_count() / 2, ..Limits::default() };
    mesh.refine(&limits, rule()).unwrap_err();
    mesh.refine(&Limits::default(), rule()).unwrap();
    assert_eq!(mesh.fingerprint(), whole.fingerprint());
}

#[test]
fn the_level_cap_is_met_and_what_it_leaves_is_counted() {
    for cap in [0, 1, 2, 7] {
        let mut mesh = with_a_hole();
        let limits = Limits { max_level: Some(cap), ..Limits::default() };
        let rule = || vertex_rule(|x| 0.001 + 0.3 * x.distance(dvec2(0.7, 0.2)));
        let capped = mesh.refine(&limits, rule()).unwrap();
        assert!(mesh.level_counts().len() <= cap as usize + 1);
        assert_eq!(mesh.violations(), []);
        let left = mesh.unsatisfied(rule()).unwrap();
        assert_eq!(capped, left.len(), "cap {cap}");
        assert!(left.iter().all(|&id| mesh.triangle(id).level() == cap));
    }
}

#[test]
fn the_lattice_ends_with_an_error_at_its_deepest_level() {
    for (spacing, bounds) in [
        (1.0, Rect::UNIT),
        (0.01, Rect::UNIT),
        (1.0, Rect::new(dvec2(1e9, 1e9), dvec2(1e9 + 4.0, 1e9 + 3.0))),
    ] {
        let mut mesh = Mesh::coarse_grid(
            &Lattice::covering(bounds, spacing, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap();
        let corner = mesh.lattice().extent();
        let deepest = mesh.lattice().deepest_level();
        let at_corner = |element: &Element| element.corners.contains(&corner);
        // Down to the deepest level is fine; one further is not.
        mesh.refine(&Limits::default(), |e| at_corner(e) && e.triangle.level() < deepest).unwrap();
        assert_eq!(mesh.level_counts().len() as u32, deepest + 1);
        assert_eq!(mesh.violations(), []);
        let error = mesh.refine(&Limits::default(), |e| at_corner(e)).unwrap_err();
        assert!(matches!(error, RefineError::TooFine { level, .. } if level == deepest), "{error}");
        assert_eq!(mesh.violations(), []);
    }
}

#[test]
#[should_panic(expected = "leave the lattice")]
fn a_call_below_the_deepest_level_panics() {
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 1.0, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    for _ in 0..=mesh.lattice().deepest_level() {
        mesh.refine_triangle(TriangleId::from_index(0));
    }
}
