//! Which parts of the boundary along the frame are open.

use std::f64::consts::TAU;

use crate::formula_mesh::formula_mesh;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{
    BoundaryKind, BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, CutShape, Domain,
    MeshBoundary, OutlineOnEarth, Ring, coasts,
};
use meshbrush_core::earth::{
    Coordinates, GeographicExtent, ProjectionChoice, Reprojection, projected_polygons,
};
use meshbrush_core::layers::Shapes;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, NodeId};

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
        let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::NONE);
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
    let [middle, outline] =
        [Shapes::coasts(&cut, &BoundaryMarks::default()), Shapes::outline(cut.region().unwrap())].map(
            |shapes| {
                let shapes = shapes.unwrap();
                shapes.distance(dvec2(0.25, 0.5))
            },
        );
    assert!(outline == 0.0 && (middle - 0.3).abs() < 1e-6, "{outline} {middle}");
    assert_eq!(coasts(&whole, &BoundaryMarks::default()).len(), 1, "a ring that nothing cuts is all coast");
    assert!(coasts(&Domain::rectangle(Rect::UNIT), &BoundaryMarks::default()).is_empty());
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

/// A sea in a box of degrees: the coast is in the east, and an island in the middle.
fn sea(west: f64, south: f64, size: [f64; 2]) -> Vec<Ring> {
    let at = |x: f64, y: f64| dvec2(west + size[0] * x, south + size[1] * y);
    let coast = (0..=20).map(|n| f64::from(n) / 20.0);
    let coast = coast.map(|y| at(0.8 + 0.1 * libm::sin(7.0 * y), y));
    let outer = [at(0.0, 0.0)].into_iter().chain(coast).chain([at(0.0, 1.0)]).collect();
    let island = circle(DVec2::ZERO, 0.1, 12).into_iter().map(|p| at(0.4 + p.x, 0.5 + p.y)).collect();
    vec![outer, island]
}

fn projected(rings: &[Ring], choice: &str) -> (Domain, Reprojection) {
    let extent = GeographicExtent::from_rings(rings.iter().map(Vec::as_slice)).unwrap();
    let projection = choice.parse::<ProjectionChoice>().unwrap().projection(&extent).unwrap();
    let reprojection = Reprojection { from: Coordinates::Geographic, to: projection };
    let polygons = projected_polygons(&[rings.to_vec()], &reprojection);
    (
        Domain::of_polygons_on_earth(&polygons, &OutlineOnEarth::from_reprojection(&reprojection)).unwrap(),
        reprojection,
    )
}

const SIDES: [&str; 3] = ["open south", "open north", "open west"];

/// Parallels and meridians are curves in most planes.
#[test]
fn sides_of_a_box_of_degrees_are_open_in_every_plane() {
    for choice in ["auto", "merc", "tmerc", "lcc", "stere"] {
        for (west, south, size) in [
            (-6.0, 48.0, [3.0, 2.0]),
            (176.0, -19.0, [7.0, 4.0]),
            (10.0, 76.0, [20.0, 4.0]),
            (30.0, 1.0, [0.01; 2]),
        ] {
            let (domain, reprojection) = projected(&sea(west, south, size), choice);
            assert_eq!(open(&domain), SIDES, "{choice} {west} {south}");
            let pieces = BoundaryPieces::of_domain(&domain, &BoundaryMarks::default()).unwrap();
            let south_side = &pieces.list()[0].points;
            assert!(
                south_side.iter().all(|&p| (reprojection.from_plane(p).y - south).abs() < 1e-5 * size[1])
            );
            // The mesh finds each edge of such a side.
            let spacing = domain.bounds.size().max_element() / 8.0;
            let treatment = BoundaryTreatment::OnOutline { diameter: 0.5 * spacing };
            let built = formula_mesh(&domain, spacing, treatment, "1e9");
            let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::NONE);
            let extract = derived.extract(&built.mesh);
            let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
            let on_sides = |node: usize| {
                let at = reprojection.from_plane(extract.world(NodeId::from_index(node)));
                let (x, y) = ((at.x - west + 180.0).rem_euclid(360.0) - 180.0, at.y - south);
                [y / size[1], y / size[1] - 1.0, x / size[0]].map(|share| share.abs() < 1e-5)
            };
            let mut count = 0;
            for (edge, &piece) in extract.boundary_edges().zip(boundary.piece_of_edge()) {
                let [a, b] = edge.ends.map(on_sides);
                let along = (0..3).find(|&side| a[side] && b[side]);
                // An edge across the corner between two sides is on none of them; a few nodes are not on the
                // outline.
                let joins_sides = along.is_none() && a.contains(&true) && b.contains(&true);
                let places = edge.ends.map(|node| extract.world(NodeId::from_index(node)));
                let is_off = places.iter().any(|&at| pieces.nearest(at, pieces.tolerance()).is_none());
                let found = Some(piece as usize).filter(|piece| *piece < 3);
                assert!(found == along || joins_sides || is_off, "{choice} {west}: {places:?} {piece}");
                count += usize::from(along.is_some());
            }
            assert!(count > 20, "{choice} {west}: {count}");
        }
    }
}

#[test]
fn what_is_open_stays_open_in_edits_and_other_bounds() {
    let (domain, reprojection) = projected(&sea(-6.0, 48.0, [3.0, 2.0]), "lcc");
    let at = |lon: f64, lat: f64| reprojection.in_plane(dvec2(lon, lat));
    let hole = CutShape::Stroke { path: vec![at(-5.5, 48.6)], radius: 8e3 };
    let cape = CutShape::Stroke { path: vec![at(-6.0, 49.0)], radius: 8e3 };
    for (shape, adds, expected) in [
        (&hole, false, vec!["open south", "open north", "open west"]),
        (&cape, false, vec!["open south", "open north", "open west", "open west 2"]),
    ] {
        assert_eq!(open(&domain.reshaped(shape, adds).unwrap()), expected);
    }
    // Water beyond the western side: its shore is not open, and the rest of the side is.
    let more = domain.reshaped(&cape, true).unwrap();
    assert_eq!(open(&more), ["open south", "open north", "open west", "open west 2"]);
    let wider = domain.with_bounds(domain.bounds.expanded(5e4));
    assert_eq!(open(&wider), SIDES, "in bounds that are wider");
    let mut narrow = domain.bounds;
    narrow.max.y -= 0.4 * narrow.size().y;
    assert_eq!(open(&domain.with_bounds(narrow)), SIDES, "the new northern side is open, too");
    let again = domain.clone().cut_by(domain.cuts().to_vec());
    assert_eq!(again, domain);
}

#[test]
fn a_box_that_is_turned_in_a_plane_is_open() {
    let turn = DVec2::from_angle(0.35);
    let rings: Vec<Ring> = sea(0.0, 0.0, [40e3, 30e3]);
    let turned: Vec<Ring> =
        rings.iter().map(|ring| ring.iter().map(|&p| turn.rotate(p) + dvec2(4e5, 5.5e6)).collect()).collect();
    assert_eq!(open(&Domain::of_polygons(std::slice::from_ref(&turned)).unwrap()), SIDES);
    // An island with a right angle at its end is none.
    let coast = (0..40).map(|n| f64::from(n) / 40.0 * TAU);
    let island = coast.map(|a| dvec2(3.0 * a.cos(), (1.0 + 0.3 * (5.0 * a).sin()) * a.sin())).collect();
    assert!(open(&Domain::of_polygons(&[vec![island]]).unwrap()).is_empty());
    // A box of a UTM zone that is meshed in another plane.
    let zone = Coordinates::of_epsg(32630).unwrap();
    let to = "+proj=lcc +lat_0=50 +lat_1=50 +lon_0=-4 +ellps=WGS84 +units=m".parse().unwrap();
    let reprojection = Reprojection { from: zone, to };
    let polygons = projected_polygons(&[turned], &reprojection);
    assert_eq!(
        open(
            &Domain::of_polygons_on_earth(&polygons, &OutlineOnEarth::from_reprojection(&reprojection))
                .unwrap()
        ),
        SIDES
    );
}

#[test]
fn coasts_follow_names_and_types() {
    let domain = Domain::of_polygons(&[sea(0.0, 0.0, [1.0, 1.0])]).unwrap();
    let none = BoundaryMarks::default();
    let pieces = BoundaryPieces::of_domain(&domain, &none).unwrap();
    let number = |name: &str| pieces.list().iter().position(|piece| piece.name == name).unwrap();
    let count = |marks: &BoundaryMarks| coasts(&domain, marks).len();
    assert_eq!(count(&none), 2, "the mainland and the island");
    for (marks, expected) in [
        (pieces.retyped(&none, number("mainland"), Some(BoundaryType::Open)), 1),
        (pieces.retyped(&none, number("mainland"), Some(BoundaryType::Inflow)), 1),
        (pieces.retyped(&none, number("open west"), Some(BoundaryType::Land)), 3),
        (pieces.renamed(&none, number("mainland"), "Open ocean"), 1),
        (pieces.renamed(&none, number("open south"), "land bridge"), 3),
        (pieces.renamed(&none, number("mainland"), "Brittany"), 2),
    ] {
        assert_eq!(count(&marks), expected, "{marks:?}");
    }
}

#[test]
fn parts_are_opened_where_they_lie() {
    let domain = Domain::of_polygons(&[sea(0.0, 0.0, [1.0, 1.0])]).unwrap();
    let none = BoundaryMarks::default();
    let pieces = BoundaryPieces::of_domain(&domain, &none).unwrap();
    // All of the mainland in the north, and the island, which stays land.
    let marks = pieces.opened(&none, |p| p.y > 0.4 && p.x > 0.1).unwrap();
    let opened = BoundaryPieces::of_domain(&domain, &marks).unwrap();
    let of_mainland = opened.list().iter().filter(|piece| piece.kind == BoundaryKind::Mainland);
    let types: Vec<(BoundaryType, f64)> =
        of_mainland.map(|piece| (piece.boundary_type(), piece.middle().y)).collect();
    assert_eq!(types.len(), 2, "{types:?}");
    assert!(types.iter().all(|&(of_piece, y)| (of_piece == BoundaryType::Open) == (y > 0.4)));
    let island = opened.list().iter().find(|piece| piece.kind == BoundaryKind::Island).unwrap();
    assert_eq!(island.boundary_type(), BoundaryType::Land);
    let split = opened.list().iter().flat_map(|piece| [piece.points[0], *piece.points.last().unwrap()]);
    assert!(split.into_iter().any(|p| (p.y - 0.4).abs() < 1e-9), "where it begins");
    let sides = |pieces: &BoundaryPieces| {
        pieces.list().iter().filter(|piece| piece.kind == BoundaryKind::Open).count()
    };
    assert_eq!(sides(&opened), sides(&pieces), "open sides stay whole");
    assert!(pieces.opened(&none, |p| p.y > 2.0).is_none());
    assert!(opened.idle_marks(&marks).is_empty(), "{:?}", opened.idle_marks(&marks));
    // A ring that is closed, at two places.
    let lake = Domain::of_polygons(&[vec![circle(DVec2::ZERO, 1.0, 50)]]).unwrap();
    let pieces = BoundaryPieces::of_domain(&lake, &none).unwrap();
    let marks = pieces.opened(&none, |p| p.x.abs() > 0.9).unwrap();
    let opened = BoundaryPieces::of_domain(&lake, &marks).unwrap();
    let open: Vec<f64> = opened
        .list()
        .iter()
        .filter(|piece| piece.boundary_type().is_open())
        .map(|piece| piece.middle().x)
        .collect();
    assert!(opened.list().len() == 4 && open.len() == 2 && open.iter().all(|x| x.abs() > 0.9), "{open:?}");
}
