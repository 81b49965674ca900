//! Which parts of the boundary along the frame are open.

use std::f64::consts::TAU;

use crate::formula_mesh::formula_mesh;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{
    BoundaryKind, BoundaryMarks, BoundaryPieces, BoundaryTreatment, Domain, MeshBoundary, Ring, coasts,
};
use meshbrush_core::layers::Shapes;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Cleaning;

fn ring(points: &[(f64, f64)]) -> Ring {
    points.iter().map(|&(x, y)| dvec2(x, y)).collect()
}

fn circle(centre: DVec2, radius: f64, corners: usize) -> Ring {
    (0..corners).map(|k| centre + radius * DVec2::from_angle(TAU * k as f64 / corners as f64)).collect()
}

/// Returns the names of the open pieces of a domain.
fn open(domain: &Domain) -> Vec<String> {
    let pieces = BoundaryPieces::of_domain(domain, &BoundaryMarks::default()).unwrap();
    let open = pieces.list().iter().filter(|piece| piece.kind == BoundaryKind::Open);
    open.map(|piece| piece.name.clone()).collect()
}

/// Returns an island with an edge along its bounding rectangle.
fn island() -> Ring {
    ring(&[(0.0, 0.6), (0.0, 0.4), (0.5, 0.0), (1.0, 0.5), (0.5, 1.0)])
}

/// An island or a lake lies in its own bounding rectangle, and may have an edge along it by chance: that is
/// coast.
#[test]
fn a_coast_along_its_own_bounding_rectangle_is_not_open() {
    let lagoon = circle(dvec2(0.5, 0.5), 0.1, 12);
    for outline in [vec![island()], vec![island(), lagoon]] {
        let domain = Domain::of_polygons(&[outline]).unwrap();
        let built = formula_mesh(&domain, 0.1, BoundaryTreatment::OnOutline { diameter: 0.05 }, "1");
        let derived = DerivedMesh::new(&built.mesh, &built.domain, &Cleaning::NONE);
        let extract = derived.extract(&built.mesh);
        let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
        let names: Vec<&str> = boundary.pieces().list().iter().map(|piece| piece.name.as_str()).collect();
        assert_eq!(names, ["mainland", "island 1"][..names.len()]);
        assert_eq!(boundary.lost().count(), 0);
        let edges: usize = boundary.figures().iter().map(|figures| figures.edges).sum();
        assert_eq!(edges, extract.boundary_edges().count(), "every edge has a piece");
    }
}

#[test]
fn what_a_rectangle_cuts_is_open() {
    // Bounds that are not the bounding rectangle were chosen.
    let whole = Domain::of_polygons(&[vec![island()]]).unwrap();
    let cut = whole.with_bounds(Rect::new(dvec2(0.25, -1.0), dvec2(2.0, 2.0)));
    assert_eq!(open(&cut), ["open west"]);
    // The distance to the coasts leaves that part out.
    let [middle, outline] = [Shapes::coasts(&cut), Shapes::outline(cut.region().unwrap())].map(|shapes| {
        let shapes = shapes.unwrap();
        shapes.distance(dvec2(0.25, 0.5))
    });
    assert!(outline == 0.0 && (middle - 0.3).abs() < 1e-6, "{outline} {middle}");
    assert_eq!(coasts(&whole).len(), 1, "a ring that nothing cuts is all coast");
    assert!(coasts(&Domain::rectangle(Rect::UNIT)).is_empty());
    // The mouth of a fjord is longer than the edges of its coast, though no corner of the frame is wet.
    let south = (0..=20).map(|k| f64::from(k) / 20.0).map(|x| dvec2(x, 0.15 * x - 0.1 * (9.0 * x).sin()));
    let north = (0..=20).rev().map(|k| f64::from(k) / 20.0);
    let north = north.map(|x| dvec2(x, 0.5 - 0.1 * x + 0.1 * (7.0 * x).sin()));
    let head = dvec2(1.02, 0.3);
    let fjord: Ring = south.chain([head]).chain(north).collect();
    assert_eq!(open(&Domain::of_polygons(&[vec![fjord]]).unwrap()), ["open west"]);
    // A corner of the frame that is wet: the short gap between two capes in the east is open, too.
    let sea = ring(&[(0.0, 0.0), (0.8, 0.0), (1.0, 0.5), (1.0, 0.55), (0.7, 1.0), (0.0, 1.0)]);
    let domain = Domain::of_polygons(&[vec![sea]]).unwrap();
    assert_eq!(open(&domain), ["open south", "open east", "open north", "open west"]);
}
