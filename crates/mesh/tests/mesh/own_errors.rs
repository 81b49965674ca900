//! A rule's own error ends refinement and comes back as it is, from one thread and from many.

use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{Element, Limits, Mesh, Progress, RefineError, Refiner, Updater};

/// Neither `Clone` nor `std::error::Error`: nothing is asked of the error of a rule.
#[derive(Debug, PartialEq)]
struct NoMap {
    corners: [LatticePoint; 3],
}

fn coarse() -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 1_000_000).unwrap();
    Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap()
}

/// Refines to level 8, but cannot answer from level 5 on for triangles that touch a square near the middle.
fn answer(mesh: &Mesh) -> impl Fn([LatticePoint; 3], u32) -> Result<bool, NoMap> + Copy + use<> {
    let side = mesh.lattice().extent().x;
    let unknown = LatticeRect {
        min: LatticePoint::new(side / 2, side / 2),
        max: LatticePoint::new(side / 2 + side / 50, side / 2 + side / 50),
    };
    move |corners, level| match level >= 5 && unknown.touches(corners) {
        true => Err(NoMap { corners }),
        false => Ok(level < 8),
    }
}

fn by_element(
    answer: impl Fn([LatticePoint; 3], u32) -> Result<bool, NoMap>,
) -> impl Fn(&Element) -> Result<bool, NoMap> {
    move |element| answer(element.corners, element.triangle.level())
}

#[test]
fn an_error_of_the_rule_passes_through_refinement_and_the_work_can_go_on() {
    let mut mesh = coarse();
    let answer = answer(&mesh);
    let mut refiner = Refiner::new(&mesh, Limits::default());
    let refused = refiner.advance(&mut mesh, by_element(answer), usize::MAX);
    let Err(RefineError::Rule(NoMap { corners })) = refused else { panic!("{refused:?}") };
    assert!(answer(corners, 8).is_err());
    assert_eq!(mesh.violations(), []);
    let known = |element: &Element| element.triangle.level() < 8;
    assert_eq!(refiner.advance(&mut mesh, known, usize::MAX), Ok(Progress::Done));
    let mut whole = coarse();
    whole.refine(&Limits::default(), known).unwrap();
    assert_eq!(mesh.fingerprint(), whole.fingerprint());
}

#[test]
fn an_error_of_the_rule_passes_through_an_update() {
    let mut mesh = coarse();
    let answer = answer(&mesh);
    let mut updater = Updater::new(Limits::default());
    updater.add(LatticeRect { min: LatticePoint::new(0, 0), max: mesh.lattice().extent() });
    let refused = updater.advance(&mut mesh, &|| answer, usize::MAX);
    assert!(matches!(refused, Err(RefineError::Rule(NoMap { .. }))), "{refused:?}");
    assert_eq!(mesh.violations(), []);
}

#[test]
fn the_error_of_a_shared_rule_is_the_same_for_any_number_of_threads() {
    let errors = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut mesh = coarse();
        let answer = answer(&mesh);
        pool.install(|| mesh.refine_in_blocks(&Limits::default(), &|| answer)).unwrap_err()
    });
    assert!(matches!(errors[0], RefineError::Rule(_)), "{errors:?}");
    assert!(errors.iter().all(|error| *error == errors[0]), "{errors:?}");
}

#[test]
fn a_limit_is_an_error_of_no_rule() {
    let mut mesh = coarse();
    let limits = Limits { max_triangles: 300, ..Limits::default() };
    let error = mesh.refine(&limits, |_| true).unwrap_err();
    assert_eq!(error, RefineError::TooManyTriangles { limit: 300 });
    assert_eq!(error.map_rule(|never| match never {}), RefineError::<NoMap>::TooManyTriangles { limit: 300 });
}
