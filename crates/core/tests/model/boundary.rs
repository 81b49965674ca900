//! The boundary in named pieces, against brute force over all edges of mesh and domain.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;
use std::path::Path;

use crate::formula_mesh::formula_mesh;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::BuiltMesh;
use meshbrush_core::domain::{
    BoundaryKind, BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, CutShape, Domain,
    MeshBoundary, NamedPolygon, Polygon, Ring,
};
use meshbrush_core::field::Formula;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::geojson;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, Extract, Limits, Mesh, NodeId};

/// The mesh of a domain under a treatment, with the boundary's edges no longer than the treatment's diameter.
struct Built {
    built: BuiltMesh,
    derived: DerivedMesh,
}

impl Built {
    fn new(domain: &Domain, boundary: BoundaryTreatment, spacing: f64, target: &str) -> Self {
        let built = formula_mesh(domain, spacing, boundary, target);
        let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::NONE);
        Self { built, derived }
    }

    fn extract(&self) -> Extract<'_> {
        self.derived.extract(&self.built.mesh)
    }
}

fn boundary_edges(extract: &Extract) -> Vec<[DVec2; 2]> {
    extract
        .boundary_edges()
        .map(|edge| edge.ends.map(|node| extract.world(NodeId::from_index(node))))
        .collect()
}

fn names(pieces: &BoundaryPieces) -> Vec<&str> {
    pieces.list().iter().map(|piece| piece.name.as_str()).collect()
}

fn circle(centre: DVec2, radius: f64, corners: usize) -> Ring {
    (0..corners).map(|k| centre + radius * DVec2::from_angle(TAU * k as f64 / corners as f64)).collect()
}

fn of_polygons(polygons: &[Polygon]) -> Domain {
    Domain::of_polygons(polygons).unwrap()
}

/// Returns a sea in the unit square: a wavy coast in the north, the other sides open, and two islands.
fn bay() -> Domain {
    let coast = (0..=40).map(|k| f64::from(40 - k) / 40.0);
    let coast = coast.map(|x| dvec2(x, 0.8 + 0.1 * libm_sin(9.0 * x)));
    let outer: Ring = [dvec2(0.0, 0.0), dvec2(1.0, 0.0)].into_iter().chain(coast).collect();
    of_polygons(&[vec![outer, circle(dvec2(0.3, 0.3), 0.1, 30), circle(dvec2(0.7, 0.4), 0.15, 30)]])
}

fn libm_sin(x: f64) -> f64 {
    x.sin()
}

fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + share * along)
}

/// Returns the sides of a rectangle on which both ends of an edge lie.
fn side([a, b]: [DVec2; 2], frame: &Rect) -> Option<usize> {
    let Rect { min, max } = *frame;
    let on = [
        a.y == min.y && b.y == min.y,
        a.x == max.x && b.x == max.x,
        a.y == max.y && b.y == max.y,
        a.x == min.x && b.x == min.x,
    ];
    on.into_iter().position(|on| on)
}

#[test]
fn a_rectangle_has_four_open_sides() {
    let bounds = Rect::new(dvec2(-3.0, 1.0), dvec2(4.0, 3.5));
    let domain = Domain::rectangle(bounds);
    let built = Built::new(&domain, BoundaryTreatment::Report, 0.5, "0.1 + 0.3*abs(x)");
    let extract = built.extract();
    let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
    assert_eq!(names(boundary.pieces()), ["open south", "open east", "open north", "open west"]);
    for (edge, &piece) in boundary_edges(&extract).into_iter().zip(boundary.piece_of_edge()) {
        assert_eq!(side(edge, &bounds), Some(piece as usize));
    }
    let lengths: Vec<f64> = boundary.figures().iter().map(|figures| figures.length).collect();
    assert!(lengths.iter().zip([7.0, 2.5, 7.0, 2.5]).all(|(length, side)| (length - side).abs() < 1e-12));
    // The lowest where two meet: the corners belong to the south, or to the east.
    let markers = boundary.node_markers(&extract);
    for (place, marker) in extract.world_nodes().zip(markers) {
        let on = [
            place.y == bounds.min.y,
            place.x == bounds.max.x,
            place.y == bounds.max.y,
            place.x == bounds.min.x,
        ];
        assert_eq!(marker as usize, on.into_iter().position(|on| on).map_or(0, |side| side + 1), "{place}");
    }
    assert_eq!(boundary.runs(&extract).len(), 4);
}

#[test]
fn coasts_and_sides_of_a_bay_are_separate() {
    let domain = bay();
    let treatments =
        [BoundaryTreatment::Fitted { diameter: 0.02 }, BoundaryTreatment::OnOutline { diameter: 0.02 }];
    for treatment in treatments {
        let built = Built::new(&domain, treatment, 0.1, "1");
        let extract = built.extract();
        let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
        let expected = ["open south", "open east", "open west", "mainland", "island 1", "island 2"];
        assert_eq!(names(boundary.pieces()), expected);
        let kinds: Vec<BoundaryKind> = boundary.pieces().list().iter().map(|piece| piece.kind).collect();
        use BoundaryKind::{Island, Mainland, Open};
        assert_eq!(kinds, [Open, Open, Open, Mainland, Island, Island]);
        // Every piece in one run, the islands closed, in the order of the pieces.
        let runs = boundary.runs(&extract);
        let pieces: Vec<usize> = runs.iter().map(|run| run.piece).collect();
        assert_eq!(pieces, [0, 1, 2, 3, 4, 5]);
        for run in &runs {
            assert_eq!(run.nodes.first() == run.nodes.last(), run.piece >= 4);
            assert_eq!(run.nodes.len(), boundary.figures()[run.piece].edges + 1);
        }
        assert!((boundary.figures()[0].length - 1.0).abs() < 1e-12);
        assert!(boundary.pieces().list()[4].points.iter().all(|p| p.distance(dvec2(0.7, 0.4)) < 0.16));
    }
}

#[test]
fn a_side_that_coasts_divide_has_several_pieces() {
    // Two capes reach the southern side, and a smooth hill touches the northern side in one point.
    let cape = |x: f64| [dvec2(x, 0.0), dvec2(x + 0.05, 0.3), dvec2(x + 0.1, 0.0)];
    let outer: Ring = [dvec2(0.0, 0.0)]
        .into_iter()
        .chain(cape(0.3))
        .chain(cape(0.6))
        .chain([dvec2(1.0, 0.0), dvec2(1.0, 0.5), dvec2(0.5, 1.0), dvec2(0.0, 0.5)])
        .collect();
    let domain = of_polygons(&[vec![outer]]);
    let built = Built::new(&domain, BoundaryTreatment::Fitted { diameter: 0.02 }, 0.1, "1");
    let extract = built.extract();
    let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
    let expected = [
        "open south",
        "open south 2",
        "open south 3",
        "open east",
        "open west",
        "mainland",
        "mainland 2",
        "mainland 3",
    ];
    assert_eq!(names(boundary.pieces()), expected);
    assert_eq!(boundary.present().count(), expected.len());
    for (piece, figures) in boundary.pieces().list().iter().zip(boundary.figures()).take(5) {
        assert!((piece.length() - figures.length).abs() < 0.04, "{}: {}", piece.name, figures.length);
    }
    // Edges of the mesh on the northern side belong to the coast that touches it.
    for (edge, &piece) in boundary_edges(&extract).iter().zip(boundary.piece_of_edge()) {
        if side(*edge, &domain.bounds) == Some(2) {
            assert_eq!(boundary.pieces().list()[piece as usize].name, "mainland");
        }
    }
}

/// Returns rings that can be close to each other and to the frame.
fn random_sea(random: &mut Rng) -> Domain {
    let mut outer = circle(dvec2(0.5, 0.5), 0.8, 40);
    outer.iter_mut().for_each(|p| *p += 0.1 * dvec2(random.f64(), random.f64()));
    let mut rings = vec![outer];
    for _ in 0..random.usize(1..12) {
        let centre = dvec2(random.f64(), random.f64());
        rings.push(circle(centre, 0.02 + 0.12 * random.f64(), random.usize(3..40)));
    }
    let whole = of_polygons(&[rings]);
    let frame = Rect::new(dvec2(0.0, 0.05), dvec2(0.95, 1.0));
    Domain { bounds: frame, ..whole.with_bounds(frame) }
}

#[test]
fn edges_belong_to_the_nearest_piece_but_for_twice_their_length() {
    let (mut edges, mut changes, mut changes_of_nearest) = (0, 0, 0);
    for seed in 0..60 {
        let mut random = Rng::with_seed(seed);
        let mut domain = random_sea(&mut random);
        if random.bool() {
            domain =
                domain.reshaped(&CutShape::Ring(circle(dvec2(0.4, 0.4), 0.2, 9)), false).unwrap_or(domain);
        }
        let diameter = [0.01, 0.03, 0.08][random.usize(0..3)];
        let treatment = BoundaryTreatment::Fitted { diameter };
        let treatment = if random.bool() { BoundaryTreatment::OnOutline { diameter } } else { treatment };
        let built = Built::new(&domain, treatment, 0.1, "1");
        let extract = built.extract();
        let mut marks = BoundaryMarks::default();
        let ring = &domain.region().unwrap().polygons()[0][0];
        marks.splits = vec![ring[random.usize(0..ring.len())], ring[0].lerp(ring[1], 0.3)];
        let boundary = MeshBoundary::new(&extract, &domain, &marks);
        let pieces = boundary.pieces().list();
        let mut nearest_pieces = Vec::new();
        for (edge, &piece) in boundary_edges(&extract).into_iter().zip(boundary.piece_of_edge()) {
            let (middle, length) = (0.5 * (edge[0] + edge[1]), edge[0].distance(edge[1]));
            let to_piece = |points: &[DVec2]| {
                points
                    .windows(2)
                    .map(|ends| distance(middle, [ends[0], ends[1]]))
                    .fold(f64::INFINITY, f64::min)
            };
            let distances: Vec<f64> = pieces.iter().map(|piece| to_piece(&piece.points)).collect();
            edges += 1;
            if side(edge, &domain.bounds).is_some() {
                let open = |n: &usize| pieces[*n].kind == BoundaryKind::Open && distances[*n] < 1e-9;
                if let Some(expected) = (0..pieces.len()).find(open) {
                    assert_eq!(piece as usize, expected, "seed {seed}, {middle}");
                    nearest_pieces.push(piece as usize);
                    continue;
                }
            }
            let coasts = (0..pieces.len()).filter(|&n| pieces[n].kind != BoundaryKind::Open);
            let nearest = coasts.min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap();
            nearest_pieces.push(nearest);
            let excess = distances[piece as usize] - distances[nearest];
            assert!(excess <= 2.0 * length + 1e-12, "seed {seed}, {middle}: {}", pieces[piece as usize].name);
        }
        for numbers in extract.boundary_edge_loops() {
            let next = numbers.iter().cycle().skip(1);
            for (&edge, &next) in numbers.iter().zip(next) {
                changes += usize::from(boundary.piece_of_edge()[edge] != boundary.piece_of_edge()[next]);
                changes_of_nearest += usize::from(nearest_pieces[edge] != nearest_pieces[next]);
            }
        }
    }
    assert!(
        edges > 15_000 && changes < changes_of_nearest,
        "{edges}: {changes}, {changes_of_nearest} changes"
    );
}

#[test]
fn each_part_of_a_split_ring_is_one_run_of_edges() {
    let mut pieces_in_all = 0;
    for seed in 0..40 {
        let mut random = Rng::with_seed(seed);
        let domain = of_polygons(&[vec![circle(dvec2(0.5, 0.5), 0.4 + 0.1 * random.f64(), 200)]]);
        let splits =
            (0..random.usize(2..30)).map(|_| dvec2(0.5, 0.5) + DVec2::from_angle(TAU * random.f64()));
        let mut marks = BoundaryMarks::default();
        for split in splits {
            let pieces = BoundaryPieces::of_domain(&domain, &marks).unwrap();
            marks = pieces.split(&marks, split, 1.0).unwrap_or(marks);
        }
        let diameter = 0.02;
        let treatment = BoundaryTreatment::Fitted { diameter };
        let treatment = if random.bool() { BoundaryTreatment::OnOutline { diameter } } else { treatment };
        let built = Built::new(&domain, treatment, 0.1, "1");
        let extract = built.extract();
        let boundary = MeshBoundary::new(&extract, &domain, &marks);
        let mut pieces: Vec<usize> = boundary.runs(&extract).into_iter().map(|run| run.piece).collect();
        pieces_in_all += pieces.len();
        pieces.dedup();
        assert!(pieces.iter().copied().eq(boundary.present()), "seed {seed}: {pieces:?}");
        assert_eq!(boundary.runs(&extract).len(), pieces.len(), "seed {seed}");
    }
    assert!(pieces_in_all > 300, "{pieces_in_all}");
}

#[test]
fn pieces_of_a_formula_do_not_depend_on_the_order_of_triangles() {
    let bounds = Rect::around(DVec2::ZERO, 1.0);
    let formula =
        Formula::parse("hypot(x, y) < 1.2 and hypot(x - 0.4, y) > 0.3 and hypot(x + 0.5, y) > 0.15");
    let domain = Domain { bounds, shape: formula.unwrap().into(), projection: None };
    let by_place = |targets: &[&str]| {
        let lattice = Lattice::covering(bounds, 0.1, 1_000_000).unwrap();
        let inside = |p: DVec2| domain.formula().unwrap().eval(p.x, p.y) != 0.0;
        let mut mesh = Mesh::coarse_grid(&lattice, inside, &Limits::default()).unwrap();
        for target in targets {
            let target = Formula::parse(target).unwrap();
            let too_large = |element: &meshbrush_mesh::mesh::Element| {
                element.world_corners().iter().any(|p| element.diameter() > target.eval(p.x, p.y))
            };
            mesh.refine(&Limits::default(), too_large).unwrap();
        }
        let extract = mesh.extract();
        let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
        let edges = boundary_edges(&extract).into_iter().zip(boundary.piece_of_edge());
        let named = edges.map(|(edge, &piece)| {
            let name = boundary.pieces().list()[piece as usize].name.clone();
            (edge.map(|p| [p.x.to_bits(), p.y.to_bits()]), name)
        });
        (named.collect::<BTreeMap<_, _>>(), names(boundary.pieces()).join(", "))
    };
    let (one, pieces) = by_place(&["0.02 + 0.2*abs(x - 1)", "0.02 + 0.2*abs(x + 1)"]);
    let (other, _) = by_place(&["0.02 + 0.2*abs(x + 1)", "0.02 + 0.2*abs(x - 1)"]);
    assert_eq!(one, other);
    assert_eq!(
        pieces,
        "open south, open east, open north, open west, mainland, mainland 2, mainland 3, mainland 4, island 1, island 2"
    );
}

#[test]
fn a_piece_is_named_split_and_joined() {
    let domain = bay();
    let none = BoundaryMarks::default();
    let at = |marks: &BoundaryMarks| BoundaryPieces::of_domain(&domain, marks).unwrap();
    let pieces = at(&none);
    let harbour = pieces.renamed(&none, 5, "  Old \"Port\"\t");
    assert_eq!(names(&at(&harbour))[5], "Old 'Port'");
    assert!(at(&harbour).list()[5].is_named);
    assert_eq!(names(&at(&at(&harbour).renamed(&harbour, 5, " ")))[5], "island 2");

    // An open line is split by one point, a ring by two; a point far away splits nothing.
    assert_eq!(pieces.split(&none, dvec2(0.5, 0.5), 0.01), None);
    let coast = pieces.list()[3].middle();
    let marks = pieces.split(&harbour, coast + dvec2(0.0, 0.004), 0.01).unwrap();
    assert_eq!(at(&marks).split(&marks, marks.splits[0], 0.01), None, "it is split there already");
    // The coast is at most so steep that this is 0.7 times as far along it, or more.
    for (tolerances, splits) in [(1.5, false), (3.5, true)] {
        let beside = marks.splits[0] + dvec2(tolerances * pieces.tolerance(), 0.0);
        assert_eq!(at(&marks).split(&marks, beside, 0.01).is_some(), splits, "{tolerances} tolerances away");
    }
    let expected = [
        "open south",
        "open east",
        "open west",
        "mainland part 1",
        "mainland part 2",
        "island 1",
        "Old 'Port'",
    ];
    assert_eq!(names(&at(&marks)), expected);
    let [one, two] = [3, 4].map(|n| at(&marks).list()[n].length());
    assert!((one + two - pieces.list()[3].length()).abs() < 1e-12 && one.min(two) > 0.4);
    assert_eq!((at(&marks).next_of(3), at(&marks).next_of(4), at(&marks).next_of(0)), (Some(4), None, None));
    assert_eq!(at(&marks).joined(&marks, 3), Some(harbour.clone()));
    assert_eq!(at(&marks).joined(&marks, 4), None);

    let [west, east] = [-0.1, 0.1].map(|dx| dvec2(0.3 + dx, 0.3));
    let once = pieces.split(&harbour, west, 0.01).unwrap();
    assert_eq!(at(&once).list().len(), 6, "a ring that is split once stays in one piece");
    let twice = at(&once).split(&once, east, 0.01).unwrap();
    assert_eq!(names(&at(&twice))[5..].iter().filter(|name| **name == "Old 'Port'").count(), 1);
    let halves = at(&twice);
    let (a, b) = (&halves.list()[5], &halves.list()[6]);
    assert!((a.length() / b.length() - 1.0).abs() < 0.1 && a.points.last() == b.points.first());
    assert_eq!(halves.joined(&twice, 5), Some(harbour.clone()), "both splits of the ring go");
    assert_eq!(halves.joined(&twice, 6), Some(harbour));

    // The mesh follows.
    let built = Built::new(&domain, BoundaryTreatment::OnOutline { diameter: 0.01 }, 0.1, "1");
    let boundary = MeshBoundary::new(&built.extract(), &domain, &twice);
    let lengths: Vec<f64> = boundary.figures().iter().map(|figures| figures.length).collect();
    for (length, piece) in lengths.iter().zip(boundary.pieces().list()) {
        assert!((length / piece.length() - 1.0).abs() < 0.03, "{}: {length}", piece.name);
    }
}

#[test]
fn a_type_is_set_stays_with_both_parts_and_is_joined() {
    let domain = bay();
    let none = BoundaryMarks::default();
    let at = |marks: &BoundaryMarks| BoundaryPieces::of_domain(&domain, marks).unwrap();
    let types =
        |marks: &BoundaryMarks| at(marks).list().iter().map(|piece| piece.set_type).collect::<Vec<_>>();
    let pieces = at(&none);
    let default: Vec<&str> = pieces.list().iter().map(|piece| piece.boundary_type().word()).collect();
    assert_eq!(default, ["open", "open", "open", "land", "land", "land"]);
    let [river, wall] = [BoundaryType::Inflow, BoundaryType::NoSlipLand].map(Some);
    let marks = pieces.retyped(&pieces.retyped(&none, 3, river), 5, wall);
    assert_eq!(types(&marks), [None, None, None, river, None, wall]);
    assert_eq!(at(&marks).retyped(&marks, 3, None).types.len(), 1);
    assert_eq!(at(&marks).retyped(&marks, 3, wall).types.len(), 2, "a piece has one type");

    // Both parts of an open line, and both of a ring that is split twice.
    let coast = pieces.list()[3].middle();
    let split = at(&marks).split(&marks, coast, 0.01).unwrap();
    assert_eq!(types(&split), [None, None, None, river, river, None, wall]);
    assert_eq!(at(&split).joined(&split, 3).unwrap().types.len(), 2);
    let [west, east] = [-0.1, 0.1].map(|dx| dvec2(0.3 + dx, 0.3));
    let once = at(&marks).split(&marks, west, 0.01).unwrap();
    assert_eq!((types(&once), once.types.len()), (types(&marks), 2));
    let twice = at(&once).split(&once, east, 0.01).unwrap();
    assert_eq!(types(&twice)[5..], [wall, wall]);

    // The type of the first part stays, and that of the next where the first has none.
    let parts = at(&split);
    let other = parts.retyped(&split, 4, wall);
    assert_eq!(types(&at(&other).joined(&other, 3).unwrap())[3], river);
    let other = parts.retyped(&other, 3, None);
    assert_eq!(types(&at(&other).joined(&other, 3).unwrap())[3], wall);

    // A name decides only where no type is set.
    let named = pieces.renamed(&marks, 3, "Open river");
    assert_eq!(at(&named).list()[3].boundary_type(), BoundaryType::Inflow);
    let named = pieces.renamed(&none, 3, "Open river");
    assert_eq!(at(&named).list()[3].boundary_type(), BoundaryType::Open);
}

#[test]
fn marks_survive_a_cut_elsewhere_and_return_with_their_place() {
    let domain = bay();
    let none = BoundaryMarks::default();
    let pieces = BoundaryPieces::of_domain(&domain, &none).unwrap();
    let marks = pieces.renamed(&none, 3, "North coast");
    let marks = pieces.renamed(&marks, 4, "Great island");
    let cut = |centre: DVec2, radius: f64| {
        domain.reshaped(&CutShape::Ring(circle(centre, radius, 12)), false).unwrap()
    };
    let elsewhere = BoundaryPieces::of_domain(&cut(dvec2(0.2, 0.9), 0.2), &marks).unwrap();
    assert!(names(&elsewhere).contains(&"North coast") && names(&elsewhere).contains(&"Great island"));
    let there = BoundaryPieces::of_domain(&cut(dvec2(0.7, 0.4), 0.3), &marks).unwrap();
    assert!(!names(&there).contains(&"Great island"));
    assert!(names(&BoundaryPieces::of_domain(&domain, &marks).unwrap()).contains(&"Great island"));
}

#[test]
fn polygons_bring_their_names() {
    let square = |centre: DVec2, half: f64| circle(centre, half, 4);
    let polygons = [
        NamedPolygon {
            polygon: vec![
                square(dvec2(0.0, 0.0), 3.0),
                square(dvec2(1.0, 0.0), 0.2),
                square(dvec2(-1.0, 0.0), 0.4),
            ],
            name: "Lake".into(),
        },
        NamedPolygon {
            polygon: vec![square(dvec2(8.0, 0.0), 2.0), square(dvec2(8.0, 0.0), 1.0)],
            name: String::new(),
        },
        NamedPolygon { polygon: vec![square(dvec2(0.0, 7.0), 2.0)], name: " Lake".into() },
    ];
    let plain: Vec<Polygon> = polygons.iter().map(|named| named.polygon.clone()).collect();
    let domain = of_polygons(&plain);
    let marks = BoundaryMarks::of_polygons(&polygons, &domain);
    let pieces = BoundaryPieces::of_domain(&domain, &marks).unwrap();
    let expected = ["Lake", "mainland 2", "Lake 2", "island 1", "Lake island 1", "Lake island 2"];
    assert_eq!(names(&pieces), expected);
    assert!(pieces.list()[4].points.iter().all(|p| p.x < 0.0), "the larger hole comes first");
}

#[test]
fn every_island_of_the_aegean_is_a_piece() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/aegean_sea.geojson");
    let domain = of_polygons(&geojson::read(&file).unwrap());
    let built = Built::new(&domain, BoundaryTreatment::Fitted { diameter: 0.02 }, 0.5, "1");
    let extract = built.extract();
    let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
    let kinds = boundary.pieces().list().iter().map(|piece| piece.kind);
    let mut counts: HashMap<BoundaryKind, usize> = HashMap::new();
    kinds.for_each(|kind| *counts.entry(kind).or_default() += 1);
    assert_eq!(counts[&BoundaryKind::Island], domain.region().unwrap().hole_count());
    assert!(boundary.present().count() + 2 >= boundary.pieces().list().len(), "hardly an island is lost");
    let runs = boundary.runs(&extract);
    assert_eq!(runs.iter().map(|run| run.nodes.len() - 1).sum::<usize>(), extract.boundary_edges().count());
}

#[test]
fn parts_are_numbered_from_the_largest() {
    let discs =
        [(dvec2(0.5, 0.5), 0.3), (dvec2(0.9, 0.9), 0.08), (dvec2(0.1, 0.1), 0.08), (dvec2(0.1, 0.9), 0.05)];
    let polygons: Vec<Polygon> =
        discs.iter().map(|&(centre, radius)| vec![circle(centre, radius, 24)]).collect();
    let built =
        Built::new(&of_polygons(&polygons), BoundaryTreatment::OnOutline { diameter: 0.01 }, 0.1, "1");
    let extract = built.extract();
    let parts = extract.part_numbers();
    for (cell, part) in extract.cells().zip(parts) {
        let at = extract.world(NodeId::from_index(cell.corners[0]));
        let disc = discs.iter().position(|&(centre, radius)| at.distance(centre) < radius + 0.02).unwrap();
        // Of the two with equal radii, either is larger by a triangle.
        assert!(part as usize == disc || (disc, part) == (1, 2) || (disc, part) == (2, 1), "{at}: {part}");
    }
}
