//! The files of coastal solvers, read back by readers that know only the formats: counts, orientation,
//! depths, and that the strings of the boundary cover each of its edges exactly once.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use glam::{DVec2, dvec2};
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, Domain, MeshBoundary, Ring,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::{
    CellShape, JoinedCells, MeshData, MeshFormat, MeshSource, Meter, NodeValues, Provenance, fort14, fvcom,
    gr3, mike, selafin, ugrid, ww3,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, Extract, Limits, Mesh};
use meshbrush_mesh::text::LengthUnit;

use crate::formula_mesh::formula_mesh;
use crate::netcdf_reader::{Attribute, NetCdf};
use crate::runs::seeds;

mod attributes;
mod disv;
mod gmsh;
mod open_strings;
mod squares;
mod types;

use attributes::{Selafin, read_selafin};

/// A mesh as a solver sees it. Numbers start at zero.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    nodes: Vec<DVec2>,
    /// Positive downwards.
    depths: Vec<f64>,
    triangles: Vec<[usize; 3]>,
}

/// A string of nodes as a file has it.
#[derive(Clone, Debug, PartialEq)]
struct Strand {
    nodes: Vec<usize>,
    /// The number after that of its nodes.
    code: usize,
    name: String,
    /// Whether it is a whole loop that does not repeat its first node: an island, or one that is open all
    /// around.
    is_ring: bool,
}

impl Strand {
    fn edges(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let back = self.is_ring.then(|| [self.nodes[self.nodes.len() - 1], self.nodes[0]]);
        self.nodes.windows(2).map(|ends| [ends[0], ends[1]]).chain(back)
    }

    /// ADCIRC's numbers of islands are 1, 11 and 21; SCHISM's is 1.
    fn is_island(&self) -> bool {
        self.code % 10 == 1
    }
}

/// What is written: a mesh with a depth at each node.
struct Case {
    extract: Extract<'static>,
    boundary: MeshBoundary,
    quantities: Vec<NodeValues>,
    targets: Vec<f64>,
    parts: Vec<u32>,
    joined: JoinedCells,
    provenance: Provenance,
}

impl Case {
    fn new(domain: &Domain, marks: &BoundaryMarks, spacing: f64, treatment: BoundaryTreatment) -> Self {
        let built = formula_mesh(domain, spacing, treatment, "10");
        let mesh: &'static Mesh = Box::leak(Box::new(built.mesh));
        let extract = DerivedMesh::new(mesh, &built.domain, None, &Cleaning::FOR_SOLVERS).extract(mesh);
        let boundary = MeshBoundary::new(&extract, domain, marks);
        Self::of(extract, boundary, mesh)
    }

    fn of_coast(domain: &Domain, marks: &BoundaryMarks) -> Self {
        Self::new(domain, marks, 0.25, BoundaryTreatment::OnOutline { diameter: 0.08 })
    }

    fn of(extract: Extract<'static>, boundary: MeshBoundary, mesh: &Mesh) -> Self {
        let depths: Vec<f64> = extract.world_nodes().map(|p| 20.0 + p.x / 3.0 - p.y).collect();
        let depth = NodeValues { name: "depth".into(), values: depths };
        let other = NodeValues { name: "other".into(), values: vec![7.0; extract.nodes().len()] };
        let provenance = Provenance::new(MeshSource::Document("A sea"), mesh.fingerprint(), "x, y");
        let targets = vec![0.5; extract.nodes().len()];
        let parts = extract.part_numbers();
        let joined = JoinedCells::default();
        Self { extract, boundary, quantities: vec![other, depth], targets, parts, joined, provenance }
    }

    fn data(&self) -> MeshData<'_> {
        let Self { boundary, quantities, targets, parts, joined, provenance, .. } = self;
        MeshData {
            target_diameter: targets,
            quantities,
            heights: None,
            boundary,
            lines: &[],
            parts,
            cells: CellShape::Triangles,
            joined,
            parts_for: None,
            provenance,
        }
    }

    fn written(
        &self,
        write: impl FnOnce(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>,
    ) -> Vec<u8> {
        let mut file = Vec::new();
        write(&mut file, &self.extract, &self.data()).unwrap();
        file
    }

    fn text(&self, write: impl FnOnce(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>) -> String {
        String::from_utf8(self.written(write)).unwrap()
    }

    fn refused(
        &self,
        write: impl FnOnce(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>,
    ) -> String {
        write(&mut Vec::new(), &self.extract, &self.data()).unwrap_err().to_string()
    }

    /// What every reader has to find.
    fn expected(&self) -> Seen {
        let triangles = self.extract.cells().map(|cell| cell.corners).collect();
        let depths = self.quantities.iter().find(|quantity| quantity.name == "depth");
        let depths = depths.map_or(vec![0.0; self.targets.len()], |depth| depth.values.clone());
        Seen { nodes: self.extract.world_nodes().collect(), depths, triangles }
    }
}

/// Returns a square of 4 with an island. The west side is open, the others are land; the island is named.
fn square_with_an_island() -> Case {
    let square = ring_of(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
    let hole = ring_of(&[[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]]);
    let domain = Domain::of_polygons(&[vec![square, hole]]).unwrap();
    let names = [
        ([2.0, 0.0], "LAND south"),
        ([4.0, 2.0], "land east"),
        ([2.0, 4.0], "Landing"),
        ([1.0, 1.5], "Rock"),
    ];
    let names = names.map(|(place, name)| (place.into(), name.to_owned())).to_vec();
    let marks = BoundaryMarks { names, ..BoundaryMarks::default() };
    Case::new(&domain, &marks, 0.5, BoundaryTreatment::OnOutline { diameter: 0.5 })
}

/// Returns a random coast with islands, cut by a frame; one part of the coast and one of an island are open.
fn random_coast(seed: u64) -> Case {
    let (domain, marks) = coast(seed);
    Case::of_coast(&domain, &marks)
}

/// Returns such a coast, the pieces of which have random types, but for a few.
fn typed_coast(seed: u64) -> Case {
    let (domain, mut marks) = coast(seed);
    let mut random = fastrand::Rng::with_seed(seed);
    let pieces = BoundaryPieces::of_domain(&domain, &marks).unwrap();
    for piece in 0..pieces.list().len() {
        let types = BoundaryType::ALL.into_iter().nth(random.usize(..8));
        marks = pieces.retyped(&marks, piece, types);
    }
    Case::of_coast(&domain, &marks)
}

/// Returns a domain with pieces of the boundary, two of them named.
fn coast(seed: u64) -> (Domain, BoundaryMarks) {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut ring = |center: DVec2, radius: f64, corners: usize| -> Ring {
        let waves: Vec<[f64; 2]> = (2..6).map(|_| [random.f64() * 0.12, random.f64() * TAU]).collect();
        let at = |angle: f64| {
            let wave = |(n, [size, phase]): (f64, &[f64; 2])| size * (n * angle + phase).sin();
            1.0 + [2.0, 3.0, 4.0, 5.0].into_iter().zip(&waves).map(wave).sum::<f64>()
        };
        let angles = (0..corners).map(|n| TAU * n as f64 / corners as f64);
        angles.map(|angle| center + radius * at(angle) * DVec2::from_angle(angle)).collect()
    };
    let sea = ring(DVec2::ZERO, 1.0, 120);
    let islands =
        [dvec2(0.0, 0.4), dvec2(-0.3, -0.2), dvec2(0.3, -0.25)].map(|center| ring(center, 0.15, 40));
    let places = [sea[40], sea[50], islands[1][10], islands[1][25]];
    let names = [(sea[45], "Opening".to_owned()), (islands[1][18], "open lagoon".to_owned())].to_vec();
    let rings = std::iter::once(sea).chain(islands).collect();
    let domain = Domain::of_polygons(&[rings]).unwrap();
    let domain = domain.with_bounds(Rect::new(dvec2(-2.0, -2.0), dvec2(0.7, 2.0)));
    (domain, BoundaryMarks { splits: places.to_vec(), names, ..BoundaryMarks::default() })
}

fn ring_of(points: &[[f64; 2]]) -> Ring {
    points.iter().map(|&point| point.into()).collect()
}

fn cases() -> Vec<Case> {
    let coasts = seeds(6).flat_map(|seed| [random_coast(seed), typed_coast(seed)]);
    std::iter::once(square_with_an_island()).chain(coasts).collect()
}

/// Returns the edges of triangles that no other triangle has in the other direction: domain on the left.
fn rim(triangles: &[[usize; 3]]) -> BTreeSet<[usize; 2]> {
    let edges: BTreeSet<[usize; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    assert_eq!(edges.len(), 3 * triangles.len(), "an edge has two triangles on one side");
    edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])).copied().collect()
}

fn doubled_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Checks the triangles, and that the strings cover each boundary edge once with the domain on the left.
fn check(seen: &Seen, open: &[Strand], land: &[Strand]) {
    for corners in &seen.triangles {
        assert!(doubled_area(&corners.map(|node| seen.nodes[node])) > 0.0, "{corners:?} runs clockwise");
    }
    let mut covered = Vec::new();
    for strand in open.iter().chain(land) {
        covered.extend(strand.edges());
        let points: Vec<DVec2> = strand.nodes.iter().map(|&node| seen.nodes[node]).collect();
        if strand.is_ring {
            assert_ne!(strand.nodes.first(), strand.nodes.last(), "{} repeats its first node", strand.name);
        }
        if strand.is_island() {
            assert!(doubled_area(&points) < 0.0, "{} runs anticlockwise", strand.name);
        }
    }
    let distinct: BTreeSet<[usize; 2]> = covered.iter().copied().collect();
    assert_eq!(distinct.len(), covered.len(), "an edge is in two strings");
    assert_eq!(distinct, rim(&seen.triangles));
    // Where a string ends, one begins.
    let chains = || open.iter().chain(land).filter(|strand| !strand.is_ring);
    let begins: BTreeSet<usize> = chains().map(|strand| strand.nodes[0]).collect();
    let ends: BTreeSet<usize> = chains().map(|strand| strand.nodes[strand.nodes.len() - 1]).collect();
    assert_eq!((begins.len(), &begins), (chains().count(), &ends));
}

fn words<T: std::str::FromStr>(line: &str, count: usize) -> Vec<T> {
    let word = |word: &str| word.parse().ok().unwrap_or_else(|| panic!("{line}"));
    let found: Vec<T> = line.split_whitespace().take(count).map(word).collect();
    assert_eq!(found.len(), count, "{line}");
    found
}

/// Reads the format of ADCIRC and SCHISM.
fn read_grid(text: &str) -> (Seen, Vec<Strand>, Vec<Strand>) {
    let mut lines = text.lines().skip(1);
    let counts = lines.next().unwrap();
    let [triangles, nodes] = words::<usize>(counts, 2)[..] else { unreachable!() };
    assert_eq!(counts.split_whitespace().count(), 2, "readers take exactly two numbers");
    let mut seen = Seen::default();
    for id in 1..=nodes {
        let row = words::<f64>(lines.next().unwrap(), 4);
        assert_eq!(row[0], id as f64);
        seen.nodes.push(dvec2(row[1], row[2]));
        seen.depths.push(row[3]);
    }
    for id in 1..=triangles {
        let row = words::<usize>(lines.next().unwrap(), 5);
        assert_eq!(row[..2], [id, 3]);
        seen.triangles.push([row[2] - 1, row[3] - 1, row[4] - 1]);
    }
    let mut strands = || {
        let count = words::<usize>(lines.next().unwrap(), 1)[0];
        let all = words::<usize>(lines.next().unwrap(), 1)[0];
        let mut found = Vec::new();
        for _ in 0..count {
            let head = lines.next().unwrap();
            let [length, code] = words::<usize>(head, 2)[..] else { unreachable!() };
            let nodes = (0..length).map(|_| words::<usize>(lines.next().unwrap(), 1)[0] - 1).collect();
            let name = head.split_once(": ").unwrap().1.to_owned();
            found.push(Strand { nodes, code, name, is_ring: false });
        }
        assert_eq!(found.iter().map(|strand: &Strand| strand.nodes.len()).sum::<usize>(), all);
        found
    };
    let (mut open, mut land) = (strands(), strands());
    land.iter_mut().for_each(|strand| strand.is_ring = strand.is_island());
    mark_open_rings(&seen, &mut open, &land);
    assert!(lines.next().is_none() && open.iter().all(|strand| strand.code == 0));
    (seen, open, land)
}

/// Marks the open strings that are whole loops: the edge from their end to their beginning is in no string.
fn mark_open_rings(seen: &Seen, open: &mut [Strand], land: &[Strand]) {
    let rim = rim(&seen.triangles);
    let covered: BTreeSet<[usize; 2]> = open.iter().chain(land).flat_map(Strand::edges).collect();
    for strand in open {
        let back = [strand.nodes[strand.nodes.len() - 1], strand.nodes[0]];
        strand.is_ring = rim.contains(&back) && !covered.contains(&back);
    }
}

#[test]
fn adcirc_and_schism_read_back() {
    for case in cases() {
        let text = case.text(fort14::write);
        let (seen, open, land) = read_grid(&text);
        assert_eq!(seen, case.expected());
        check(&seen, &open, &land);
        let title = text.lines().next().unwrap();
        assert!(
            title.starts_with("program: Meshbrush ") && title.contains("; document: A sea; fingerprint: ")
        );
        let (of_schism, open_there, land_there) = read_grid(&case.text(gr3::write));
        assert_eq!(of_schism, seen);
        check(&seen, &open_there, &land_there);
        if case.boundary.pieces().list().iter().all(|piece| piece.set_type.is_none()) {
            assert_eq!(case.text(gr3::write), text);
        }
        assert_eq!(case.text(gr3::write_in_degrees), case.text(gr3::write));
    }
}

#[test]
fn names_and_kinds_of_strings_are_those_of_the_pieces() {
    let (seen, open, land) = read_grid(&square_with_an_island().text(fort14::write));
    let names = |strands: &[Strand]| strands.iter().map(|strand| strand.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&open), ["open west"]);
    assert_eq!(names(&land), ["LAND south", "land east", "Landing", "Rock"]);
    assert_eq!(land.iter().map(|strand| strand.code).collect::<Vec<_>>(), [0, 0, 0, 1]);
    let ends = |strand: &Strand| {
        [strand.nodes[0], strand.nodes[strand.nodes.len() - 1]].map(|node| seen.nodes[node])
    };
    assert_eq!(ends(&open[0]), [dvec2(0.0, 4.0), dvec2(0.0, 0.0)]);
    assert_eq!(ends(&land[0]), [dvec2(0.0, 0.0), dvec2(4.0, 0.0)]);

    let (_, open, land) = read_grid(&random_coast(1).text(fort14::write));
    let open_names = names(&open);
    assert_eq!(open_names.iter().collect::<BTreeSet<_>>().len(), open_names.len());
    for name in ["open east", "Opening", "open lagoon"] {
        assert!(open_names.iter().any(|names| names.split(", ").any(|part| part == name)), "{open_names:?}");
    }
    // The rest of the hole with an open part is land, and not an island.
    assert_eq!(land.iter().filter(|strand| strand.is_island()).count(), 2, "{:?}", names(&land));
}

#[test]
fn a_whole_outline_in_one_string_ends_with_its_first_node() {
    let disc: Ring = (0..30).map(|n| DVec2::from_angle(TAU * f64::from(n) / 30.0)).collect();
    let domain = Domain::of_polygons(&[vec![disc]]).unwrap();
    let treatment = BoundaryTreatment::OnOutline { diameter: 0.3 };
    let lake = Case::new(&domain, &BoundaryMarks::default(), 0.5, treatment);
    let (seen, open, land) = read_grid(&lake.text(fort14::write));
    check(&seen, &open, &land);
    assert_eq!((open.len(), land.len(), land[0].code), (0, 1, 0));
    assert_eq!(land[0].nodes.first(), land[0].nodes.last());
}

/// Returns the pattern of a frame whose sides are all open, without a depth.
fn frame() -> Case {
    let limits = Limits::default();
    let lattice = Lattice::covering(Rect::UNIT, 0.25, limits.max_triangles).unwrap();
    let mesh: &'static Mesh = Box::leak(Box::new(Mesh::coarse_grid(&lattice, |_| true, &limits).unwrap()));
    let boundary = MeshBoundary::from_mesh(&mesh.extract());
    let mut case = Case::of(mesh.extract(), boundary, mesh);
    case.quantities.clear();
    case
}

#[test]
fn without_a_depth_it_is_zero_and_never_the_target_diameter() {
    let case = frame();
    let (seen, open, land) = read_grid(&case.text(fort14::write));
    check(&seen, &open, &land);
    assert!(seen.depths.iter().all(|depth| depth.to_bits() == 0) && land.is_empty() && open.len() == 1);
    assert!(read_mike(&case.text(mike::write)).0.depths.iter().all(|&depth| depth == 0.0));
    assert!(!case.text(mike::write).contains(" -0 "));
    let bottom = read_selafin(&case.written(selafin::write)).seen.depths;
    assert!(bottom.iter().all(|depth| depth.to_bits() == (-0.0_f64).to_bits()), "the file has 0 and not -0");
}

#[test]
fn a_boundary_that_touches_itself_is_refused_with_the_place() {
    let limits = Limits::default();
    let lattice =
        Lattice::covering(Rect::new(DVec2::ZERO, dvec2(4.0, 4.0)), 1.0, limits.max_triangles).unwrap();
    // Two squares that share the corner (2, 2).
    let inside = |p: DVec2| p.max_element() <= 2.0 || p.min_element() >= 2.0;
    let mesh: &'static Mesh = Box::leak(Box::new(Mesh::coarse_grid(&lattice, inside, &limits).unwrap()));
    let touches = MeshBoundary::from_mesh(&mesh.extract());
    let case = Case::of(mesh.extract(), touches, mesh);
    let place = "at x = 2, y = 2 the boundary touches itself in a node; have such nodes removed";
    for (name, error) in [
        ("fort.14", case.refused(fort14::write)),
        ("hgrid.gr3", case.refused(gr3::write)),
        (".mesh", case.refused(mike::write)),
        ("SELAFIN", case.refused(selafin::write)),
        (".cli", case.refused(selafin::write_conditions)),
        ("WAVEWATCH III", case.refused(ww3::write)),
        ("FVCOM", case.refused(fvcom::write_open_boundary)),
    ] {
        assert!(
            error.starts_with(&format!("{name} needs two boundary edges")) && error.contains(place),
            "{error}"
        );
    }
}

#[test]
fn hgrid_ll_refuses_metres() {
    let mut case = frame();
    case.provenance = case.provenance.with_unit(LengthUnit::Metre);
    let error = case.refused(gr3::write_in_degrees);
    assert!(error.contains("the coordinates of this mesh are in m; write hgrid.gr3"), "{error}");
    assert!(case.text(gr3::write).contains("; unit: m\n"));
}

/// Reads a mesh of MIKE: also the code of each node.
fn read_mike(text: &str) -> (Seen, Vec<u32>, String) {
    let mut lines = text.lines();
    let (head, mut seen, mut codes) = (lines.next().unwrap(), Seen::default(), Vec::new());
    let [item, unit, nodes] = words::<usize>(head, 3)[..] else { unreachable!() };
    assert_eq!((item, unit), (100_079, 1000));
    for id in 1..=nodes {
        let row = words::<f64>(lines.next().unwrap(), 5);
        assert_eq!(row[0], id as f64);
        seen.nodes.push(dvec2(row[1], row[2]));
        seen.depths.push(-row[3]);
        codes.push(row[4] as u32);
    }
    let [triangles, 3, 21] = words::<usize>(lines.next().unwrap(), 3)[..] else { panic!("triangles") };
    for id in 1..=triangles {
        let row = words::<usize>(lines.next().unwrap(), 4);
        assert_eq!(row[0], id);
        seen.triangles.push([row[1] - 1, row[2] - 1, row[3] - 1]);
    }
    assert!(lines.next().is_none());
    (seen, codes, head.split(' ').next_back().unwrap().to_owned())
}

/// Checks codes of nodes by the rule of solvers: an edge is open if neither node is land, with the code of
/// its second node. `open` are the open strings, in the order of their codes.
fn check_codes(seen: &Seen, codes: &[u32], open: &[Strand]) {
    let strands = (2..).zip(open).flat_map(|(code, strand)| strand.edges().map(move |edge| (edge, code)));
    let expected: HashMap<[usize; 2], u32> = strands.collect();
    let rim = rim(&seen.triangles);
    for &[from, to] in &rim {
        let found = if codes[from] == 1 || codes[to] == 1 { 1 } else { codes[to] };
        assert_eq!(found, expected.get(&[from, to]).copied().unwrap_or(1), "{from} {to}");
    }
    let on_rim: BTreeSet<usize> = rim.into_iter().flatten().collect();
    assert!((0..codes.len()).all(|node| (codes[node] > 0) == on_rim.contains(&node)));
}

#[test]
fn mike_reads_back() {
    for mut case in cases().into_iter().chain([frame()]) {
        let (seen, codes, system) = read_mike(&case.text(mike::write));
        assert_eq!((&seen, &*system), (&case.expected(), "NON-UTM"));
        check_codes(&seen, &codes, &read_grid(&case.text(gr3::write)).1);
        case.provenance = case.provenance.with_unit(LengthUnit::Degree);
        assert!(case.text(mike::write).lines().next().unwrap().ends_with(" LONG/LAT"));
    }
}

/// Returns a rectangle with land between two places of its south side. The rest of that side is open, and the
/// sides in the east and west are land.
fn rectangle_with_land(width: f64, places: [f64; 2]) -> Case {
    let rectangle = ring_of(&[[0.0, 0.0], [width, 0.0], [width, 4.0], [0.0, 4.0]]);
    let domain = Domain::of_polygons(&[vec![rectangle]]).unwrap();
    let middle = 0.5 * (places[0] + places[1]);
    let names = [([middle, 0.0], "land mark"), ([width, 2.0], "land east"), ([0.0, 2.0], "land west")];
    let names = names.map(|(place, name)| (place.into(), name.to_owned())).to_vec();
    let splits = places.map(|x| dvec2(x, 0.0)).to_vec();
    let marks = BoundaryMarks { splits, names, ..BoundaryMarks::default() };
    Case::new(&domain, &marks, 1.0, BoundaryTreatment::Report)
}

#[test]
fn land_of_one_edge_takes_an_edge_of_the_longer_open_piece_where_nodes_are_marked() {
    // Open from 0 to 1, and from 2 to 4: the second node, at 2, becomes land.
    let case = rectangle_with_land(4.0, [1.0, 2.0]);
    let (seen, open, land) = read_grid(&case.text(fort14::write));
    check(&seen, &open, &land);
    assert!(land.iter().any(|strand| strand.name == "land mark" && strand.nodes.len() == 2), "{land:?}");
    let (seen, codes, _) = read_mike(&case.text(mike::write));
    let code_at = |x: f64, y: f64| codes[seen.nodes.iter().position(|&p| p == dvec2(x, y)).unwrap()];
    assert_eq!([0.0, 1.0, 3.0, 4.0].map(|x| code_at(x, 0.0) > 1), [true; 4]);
    assert_eq!([code_at(2.0, 0.0), code_at(0.0, 1.0), code_at(2.0, 2.0)], [1, 1, 0]);
    let conditions = case.text(selafin::write_conditions);
    let walls = conditions.lines().filter(|line| line.starts_with("2 2 2 ")).count();
    assert_eq!(walls, codes.iter().filter(|&&code| code == 1).count());
    let listed = case.text(fvcom::write_open_boundary).lines().count() - 1;
    assert_eq!(listed, codes.iter().filter(|&&code| code > 1).count());
}

#[test]
fn an_open_piece_of_which_no_edge_would_remain_is_refused_where_nodes_are_marked() {
    let case = rectangle_with_land(3.0, [1.0, 2.0]);
    let (seen, open, land) = read_grid(&case.text(fort14::write));
    check(&seen, &open, &land);
    for error in [
        case.refused(mike::write),
        case.refused(selafin::write_conditions),
        case.refused(fvcom::write_open_boundary),
    ] {
        assert!(error.contains("no edge would remain of the open boundary \"open south part"), "{error}");
    }
    assert!(!case.text(ww3::write).is_empty());
}

#[test]
fn selafin_reads_back_with_its_boundary_conditions() {
    for case in cases().into_iter().chain([frame()]) {
        let Selafin { seen, places, title, .. } = read_selafin(&case.written(selafin::write));
        assert_eq!(seen, case.expected());
        assert!(title.starts_with("Meshbrush ") && title.contains(", fingerprint "), "{title}");
        // Along IPOBO, each node is followed by the next one of its loop, or by the first of another loop.
        let order: BTreeMap<i32, usize> = (0..places.len()).map(|node| (places[node], node)).collect();
        let rim = rim(&seen.triangles);
        let next: BTreeMap<usize, usize> = rim.iter().map(|&[from, to]| (from, to)).collect();
        let order: Vec<usize> = order.range(1..).map(|(_, &node)| node).collect();
        assert_eq!((order.len(), next.len()), (rim.len(), rim.len()));
        let loops = order.chunk_by(|&a, &b| next[&a] == b).map(<[usize]>::to_vec).collect::<Vec<_>>();
        let areas = loops.iter().map(|ring| {
            assert_eq!(next[&ring[ring.len() - 1]], ring[0], "a loop is closed");
            doubled_area(&ring.iter().map(|&node| seen.nodes[node]).collect::<Vec<_>>())
        });
        let is_outer: Vec<bool> = areas.map(|area| area > 0.0).collect();
        assert!(is_outer[0] && is_outer.is_sorted_by(|a, b| a >= b), "outer loops first: {is_outer:?}");
        check_conditions(&case, &seen, &order);
    }
}

/// Checks the lines of the .cli file: a wall, or an open boundary.
fn check_conditions(case: &Case, seen: &Seen, order: &[usize]) {
    let (_, open, land) = read_grid(&case.text(gr3::write));
    let mut codes = vec![0; seen.nodes.len()];
    let text = case.text(selafin::write_conditions);
    for (line, (place, &node)) in text.lines().zip((1..).zip(order)) {
        let (numbers, name) = line.split_once(" # ").unwrap();
        let row = words::<f64>(numbers, 13);
        assert_eq!(numbers.split(' ').count(), 13);
        assert_eq!(row[11..], [node as f64 + 1.0, f64::from(place)]);
        codes[node] = match [row[0], row[1], row[2], row[7]] {
            [2.0, 2.0, 2.0, 2.0] | [2.0, 0.0, 0.0, 2.0] => 1,
            [5.0, 4.0, 4.0, 4.0] | [4.0, 5.0, 5.0, 5.0] => 2,
            other => panic!("{other:?}"),
        };
        let strands = if codes[node] == 1 { &land } else { &open };
        assert!(strands.iter().any(|strand| strand.name == name && strand.nodes.contains(&node)), "{line}");
        assert!([3, 4, 5, 6, 8, 9, 10].iter().all(|&n| row[n] == 0.0));
    }
    assert_eq!(text.lines().count(), order.len());
    // All strings through which water flows are one kind here.
    let joined: BTreeSet<[usize; 2]> = open.iter().flat_map(Strand::edges).collect();
    for [from, to] in rim(&seen.triangles) {
        assert_eq!(codes[from] == 2 && codes[to] == 2, joined.contains(&[from, to]));
    }
}

#[test]
fn ww3_reads_back() {
    for case in cases().into_iter().chain([frame()]) {
        let text = case.text(ww3::write);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..4], ["$MeshFormat", "2 0 8", "$EndMeshFormat", "$Nodes"]);
        let (mut seen, nodes) = (Seen::default(), words::<usize>(lines[4], 1)[0]);
        for (id, line) in (1..=nodes).zip(&lines[5..]) {
            let row = words::<f64>(line, 4);
            assert_eq!(row[0], id as f64);
            seen.nodes.push(dvec2(row[1], row[2]));
            seen.depths.push(row[3]);
        }
        assert_eq!(lines[5 + nodes..7 + nodes], ["$EndNodes", "$Elements"]);
        let elements = words::<usize>(lines[7 + nodes], 1)[0];
        let mut points = Vec::new();
        for (id, line) in (1..=elements).zip(&lines[8 + nodes..]) {
            match words::<usize>(line, line.split(' ').count())[..] {
                [number, 15, 2, 0, 0, node] if number == id && seen.triangles.is_empty() => {
                    points.push(node - 1)
                }
                [number, 2, 3, 0, element, 0, a, b, c] if number == id => {
                    seen.triangles.push([a - 1, b - 1, c - 1]);
                    assert_eq!(element, seen.triangles.len());
                }
                _ => panic!("{line}"),
            }
        }
        let end = 8 + nodes + elements;
        assert_eq!(lines[end..end + 2], ["$EndElements", "$Comments"]);
        assert!(lines[end + 2].starts_with("program: Meshbrush") && text.ends_with("\n$EndComments\n"));
        assert_eq!(seen, case.expected());
        assert_open_nodes(&case, &points);
    }
}

/// Checks that nodes are those of the open strings in their order, each once.
fn assert_open_nodes(case: &Case, nodes: &[usize]) {
    let mut expected: Vec<usize> = Vec::new();
    for node in read_grid(&case.text(fort14::write)).1.iter().flat_map(|strand| &strand.nodes) {
        if !expected.contains(node) {
            expected.push(*node);
        }
    }
    assert_eq!(nodes, expected);
}

#[test]
fn fvcom_reads_back() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fvcom");
    for case in cases().into_iter().chain([frame()]) {
        let _ = fs::remove_dir_all(&folder); // absent at the first run
        fs::create_dir_all(&folder).unwrap();
        let format = MeshFormat::named("fvcom").unwrap();
        let files =
            format.write(&folder.join("bay.dat"), &case.extract, &case.data(), &Meter::default()).unwrap();
        let names = ["bay_grd.dat", "bay_dep.dat", "bay_obc.dat"].map(|name| folder.join(name));
        assert_eq!((&files[..], fs::read_dir(&folder).unwrap().count()), (&names[..], 3));
        assert_eq!(format.files(&names[0]), names);
        let [grid, depths, open] = names.map(|name| fs::read_to_string(name).unwrap());

        let count = |line: Option<&str>, key: &str| -> usize {
            line.unwrap().strip_prefix(key).unwrap().parse().unwrap()
        };
        let (mut seen, mut lines) = (Seen::default(), grid.lines());
        let nodes = count(lines.next(), "Node Number = ");
        for id in 1..=count(lines.next(), "Cell Number = ") {
            let row = words::<usize>(lines.next().unwrap(), 5);
            assert_eq!([row[0], row[4]], [id, 1]);
            seen.triangles.push([row[1] - 1, row[2] - 1, row[3] - 1]);
        }
        for (id, line) in (1..).zip(lines) {
            let row = words::<f64>(line, 4);
            assert_eq!(row[0], f64::from(id));
            seen.nodes.push(dvec2(row[1], row[2]));
            seen.depths.push(row[3]);
        }
        assert_eq!((&seen, nodes), (&case.expected(), seen.nodes.len()));
        let mut lines = depths.lines();
        assert_eq!(count(lines.next(), "Node Number = "), nodes);
        let rows: Vec<Vec<f64>> = lines.map(|line| words(line, 3)).collect();
        assert!(
            rows.iter()
                .map(|row| (dvec2(row[0], row[1]), row[2]))
                .eq(seen.nodes.into_iter().zip(seen.depths))
        );
        let mut lines = open.lines();
        let listed = count(lines.next(), "OBC Node Number = ");
        let rows: Vec<Vec<usize>> = lines.map(|line| words(line, 3)).collect();
        assert!(
            rows.len() == listed && rows.iter().zip(1..).all(|(row, number)| [row[0], row[2]] == [number, 1])
        );
        assert_open_nodes(&case, &rows.iter().map(|row| row[1] - 1).collect::<Vec<_>>());
    }
}

#[test]
fn ugrid_reads_back() {
    for mut case in cases().into_iter().chain([frame()]) {
        for unit in [LengthUnit::None, LengthUnit::Metre, LengthUnit::Degree] {
            case.provenance = case.provenance.clone().with_unit(unit);
            let file = NetCdf::read(&case.written(ugrid::write));
            let node = |number: f64| number as usize - 1;
            let (x, y) = (file.values("mesh2d_node_x"), file.values("mesh2d_node_y"));
            let seen = Seen {
                nodes: x.iter().zip(y).map(|(&x, &y)| dvec2(x, y)).collect(),
                depths: file.values("mesh2d_node_z").iter().map(|z| 0.0 - z).collect(),
                triangles: file
                    .values("mesh2d_face_nodes")
                    .chunks(3)
                    .map(|f| [node(f[0]), node(f[1]), node(f[2])])
                    .collect(),
            };
            assert_eq!(seen, case.expected());
            assert_eq!(file.values("mesh2d_target_diameter"), case.targets);
            for quantity in &case.quantities {
                assert_eq!(file.values(&format!("mesh2d_quantity_{}", quantity.name)), quantity.values);
            }
            check_edges(&case, &seen, &file);
            check_attributes(&file, unit);
        }
    }
}

/// Checks that each edge is there once, and that those of the boundary have the markers of their pieces.
fn check_edges(case: &Case, seen: &Seen, file: &NetCdf) {
    let rim = rim(&seen.triangles);
    let all: BTreeSet<[usize; 2]> = seen
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    let nodes: Vec<usize> = file.values("mesh2d_edge_nodes").iter().map(|&node| node as usize - 1).collect();
    let edges: BTreeSet<[usize; 2]> = nodes.chunks(2).map(|e| [e[0].min(e[1]), e[0].max(e[1])]).collect();
    assert_eq!((nodes.len() / 2, &edges), (all.len(), &all));
    let markers = file.values("mesh2d_boundary");
    assert_eq!(markers.len(), all.len());
    let expected: HashMap<[usize; 2], f64> = case
        .extract
        .boundary_edges()
        .zip(case.boundary.piece_of_edge())
        .map(|(e, &piece)| (e.ends, f64::from(piece) + 1.0))
        .collect();
    for (edge, &marker) in nodes.chunks(2).zip(markers) {
        let edge = [edge[0], edge[1]];
        assert_eq!(marker > 0.0, rim.contains(&edge), "a boundary edge has the domain on its left");
        assert_eq!(marker, expected.get(&edge).copied().unwrap_or(0.0));
    }
    let Attribute::Numbers(values) = &file.attributes_of("mesh2d_boundary")["flag_values"] else {
        panic!("numbers")
    };
    let Attribute::Text(names) = &file.attributes_of("mesh2d_boundary")["flag_meanings"] else {
        panic!("text")
    };
    let present = case.boundary.present().map(|piece| piece as f64 + 1.0);
    assert!(values.iter().copied().eq(std::iter::once(0.0).chain(present)));
    assert_eq!(names.split(' ').count(), values.len(), "{names}");
}

fn check_attributes(file: &NetCdf, unit: LengthUnit) {
    let text = |variable: &str, key: &str| match &file.attributes_of(variable)[key] {
        Attribute::Text(text) => text.clone(),
        Attribute::Numbers(numbers) => format!("{numbers:?}"),
    };
    assert!(matches!(&file.attributes["Conventions"], Attribute::Text(text) if text.contains("UGRID-1.0")));
    assert!(matches!(&file.attributes["document"], Attribute::Text(text) if text == "A sea"));
    assert_eq!(
        (text("mesh2d", "cf_role"), text("mesh2d", "topology_dimension")),
        ("mesh_topology".into(), "[2.0]".into())
    );
    // What the topology names exists.
    for key in ["node_coordinates", "edge_node_connectivity", "face_node_connectivity"] {
        assert!(text("mesh2d", key).split(' ').all(|name| !file.values(name).is_empty()), "{key}");
    }
    for key in ["node_dimension", "edge_dimension", "face_dimension", "max_face_nodes_dimension"] {
        assert!(file.dimensions.contains_key(&text("mesh2d", key)), "{key}");
    }
    assert_eq!(text("mesh2d_face_nodes", "start_index"), "[1.0]");
    let [standard, units, system, code] = match unit {
        LengthUnit::Degree => ["longitude", "degrees_east", "wgs84", "[4326.0]"],
        LengthUnit::Metre => ["projection_x_coordinate", "m", "projected_coordinate_system", "[0.0]"],
        _ => ["projection_x_coordinate", "1", "projected_coordinate_system", "[0.0]"],
    };
    assert_eq!(
        (text("mesh2d_node_x", "standard_name"), text("mesh2d_node_x", "units")),
        (standard.into(), units.into())
    );
    assert_eq!((text("mesh2d_node_z", "grid_mapping"), text(system, "epsg")), (system.into(), code.into()));
    assert_eq!(
        (text("mesh2d_node_z", "standard_name"), text("mesh2d_node_z", "positive")),
        ("altitude".into(), "up".into())
    );
}

#[test]
fn solver_formats_are_chosen_by_endings_and_names() {
    let by_ending = |ending: &str| MeshFormat::from_ending(ending).map(MeshFormat::name);
    for (ending, name) in [
        ("14", "fort14"),
        ("grd", "fort14"),
        ("gr3", "gr3"),
        ("ll", "ll"),
        ("nc", "ugrid"),
        ("slf", "slf"),
        ("mesh", "mesh"),
        ("msh2", "msh22"),
        ("ww3", "ww3"),
        ("msh", "msh"),
        ("dat", "fvcom"),
        ("disv", "disv"),
    ] {
        assert_eq!(by_ending(ending), Some(name), "{ending}");
    }
    assert_eq!(by_ending("fvcom"), None, "a name is no ending");
    assert_eq!(MeshFormat::named("grd").map(MeshFormat::name), Some("fort14"));
    let files = MeshFormat::named("slf").unwrap().files(Path::new("sea.slf"));
    assert_eq!(files, [Path::new("sea.slf"), Path::new("sea.cli")]);
    let places: BTreeSet<&str> = MeshFormat::all().flat_map(MeshFormat::endings).collect();
    assert_eq!(
        places.len(),
        MeshFormat::all().flat_map(MeshFormat::endings).count(),
        "an ending is listed twice"
    );
}
