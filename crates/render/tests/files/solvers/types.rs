//! What each format writes for the types of pieces, by a look at every edge and node of the boundary.

use std::collections::{BTreeSet, HashMap};

use glam::dvec2;
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, Domain};
use meshbrush_io::io::{fort14, fvcom, gr3, mike, selafin, ugrid, ww3};

use super::{Case, Strand, doubled_area, random_coast, read_grid, read_mike, ring_of, typed_coast, words};
use crate::netcdf_reader::{Attribute, NetCdf};
use crate::runs::seeds;

/// Returns the type of each boundary edge, and whether it is part of a hole that is land of one type.
fn expected(case: &Case) -> HashMap<[usize; 2], (BoundaryType, bool)> {
    let edges: Vec<[usize; 2]> = case.extract.boundary_edges().map(|edge| edge.ends).collect();
    let pieces = case.boundary.pieces().list();
    let type_of = |edge: usize| pieces[case.boundary.piece_of_edge()[edge] as usize].boundary_type();
    let nodes: Vec<_> = case.extract.world_nodes().collect();
    let mut expected = HashMap::new();
    for ring in case.extract.boundary_edge_loops() {
        let points: Vec<_> = ring.iter().map(|&edge| nodes[edges[edge][0]]).collect();
        let types: Vec<&str> = ring.iter().map(|&edge| type_of(edge).word()).collect();
        let is_alike = types.iter().all(|word| *word == types[0] && word.ends_with("land"));
        let is_island = doubled_area(&points) < 0.0 && is_alike;
        expected.extend(ring.iter().map(|&edge| (edges[edge], (type_of(edge), is_island))));
    }
    expected
}

/// Returns whether each edge is in an open string, and the number of its string.
fn edges_of(open: &[Strand], land: &[Strand]) -> HashMap<[usize; 2], (bool, usize)> {
    let mut found = HashMap::new();
    for (is_open, strand) in open.iter().map(|s| (true, s)).chain(land.iter().map(|s| (false, s))) {
        found.extend(strand.edges().map(|edge| (edge, (is_open, strand.code))));
    }
    found
}

fn adcirc(boundary_type: BoundaryType, is_island: bool) -> (bool, usize) {
    match (boundary_type, is_island) {
        (BoundaryType::Open, _) => (true, 0),
        (BoundaryType::Land, false) => (false, 0),
        (BoundaryType::Land, true) => (false, 1),
        (BoundaryType::NoSlipLand, false) => (false, 10),
        (BoundaryType::NoSlipLand, true) => (false, 11),
        (BoundaryType::NaturalLand, false) => (false, 20),
        (BoundaryType::NaturalLand, true) => (false, 21),
        (BoundaryType::Inflow, _) => (false, 2),
        (BoundaryType::NoSlipInflow, _) => (false, 12),
        (BoundaryType::NaturalInflow, _) => (false, 22),
        (other, _) => panic!("{other:?}"),
    }
}

fn schism(boundary_type: BoundaryType, is_island: bool) -> (bool, usize) {
    match adcirc(boundary_type, is_island) {
        (true, _) | (false, 2 | 12 | 22) => (true, 0),
        (false, number) => (false, number % 10),
    }
}

#[test]
fn strings_of_adcirc_and_schism_have_the_types_of_their_pieces() {
    let mut met = BTreeSet::new();
    for case in seeds(24).map(typed_coast) {
        let expected = expected(&case);
        for (text, number) in
            [(case.text(fort14::write), adcirc as fn(_, _) -> _), (case.text(gr3::write), schism)]
        {
            let (_, open, land) = read_grid(&text);
            let found = edges_of(&open, &land);
            assert_eq!(found.len(), expected.len());
            for (edge, &(boundary_type, is_island)) in &expected {
                assert_eq!(found[edge], number(boundary_type, is_island), "{boundary_type:?} {is_island}");
            }
        }
        met.extend(expected.values().map(|&(of_edge, is_island)| adcirc(of_edge, is_island).1));
    }
    assert_eq!(met.into_iter().collect::<Vec<_>>(), [0, 1, 2, 10, 11, 12, 20, 21, 22]);
}

#[test]
fn nodes_of_other_solvers_have_the_types_of_their_pieces() {
    for case in seeds(24).map(typed_coast) {
        let expected = expected(&case);
        let ends: HashMap<usize, BoundaryType> =
            expected.iter().map(|(edge, of_edge)| (edge[1], of_edge.0)).collect();
        let (_, codes, _) = read_mike(&case.text(mike::write));
        let conditions = case.text(selafin::write_conditions);
        let rows = conditions.lines().map(|line| words::<f64>(line, 12));
        let rows: HashMap<usize, Vec<f64>> = rows.map(|row| (row[11] as usize - 1, row)).collect();
        let listed = |text: String, skip: usize, place: usize| -> BTreeSet<usize> {
            let lines = text.lines().skip(skip).map(|line| words::<usize>(line, place + 1)[place] - 1);
            lines.collect()
        };
        let open = listed(case.text(fvcom::write_open_boundary), 1, 1);
        let points = case.text(ww3::write);
        let points = points.lines().filter(|line| line.split(' ').nth(1) == Some("15")).collect::<Vec<_>>();
        let points = listed(points.join("\n"), 0, 5);
        // What lies between two pieces is for `check_codes`.
        for (&[node, _], &(of_node, _)) in expected.iter().filter(|(edge, of)| ends[&edge[0]] == of.0) {
            let row = &rows[&node];
            let conditions = [row[0], row[1], row[2], row[7]];
            let (flows, expected) = match of_node {
                BoundaryType::Open => (true, [5.0, 4.0, 4.0, 4.0]),
                BoundaryType::Inflow | BoundaryType::NoSlipInflow | BoundaryType::NaturalInflow => {
                    (true, [4.0, 5.0, 5.0, 5.0])
                }
                BoundaryType::NoSlipLand => (false, [2.0, 0.0, 0.0, 2.0]),
                _ => (false, [2.0, 2.0, 2.0, 2.0]),
            };
            assert_eq!((conditions, codes[node] > 1), (expected, flows), "{of_node:?}");
            let is_open = of_node == BoundaryType::Open;
            assert_eq!((open.contains(&node), points.contains(&node)), (is_open, is_open), "{of_node:?}");
        }
    }
}

#[test]
fn ugrid_lists_the_types_where_some_are_set() {
    let types = |case: &Case| {
        let file = NetCdf::read(&case.written(ugrid::write));
        match file.attributes_of("mesh2d_boundary").get("flag_types") {
            Some(Attribute::Text(text)) => Some(text.clone()),
            _ => None,
        }
    };
    assert_eq!(types(&random_coast(1)), None);
    let case = typed_coast(1);
    let list = case.boundary.pieces().list();
    let present = case.boundary.present().map(|piece| list[piece].boundary_type().word().replace(' ', "_"));
    let words: Vec<String> = std::iter::once("inside".to_owned()).chain(present).collect();
    assert_eq!(types(&case), Some(words.join(" ")));
}

/// A river through the coast, and a wall across the frame: the two things that geometry does not know.
#[test]
fn coast_can_be_open_and_a_part_of_the_frame_land() {
    let square = ring_of(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 5.0], [0.0, 4.0]]);
    let domain = Domain::of_polygons(&[vec![square]]).unwrap();
    let splits = vec![dvec2(3.0, 4.5), dvec2(1.0, 4.5)];
    let mut marks = BoundaryMarks { splits, ..BoundaryMarks::default() };
    for (place, boundary_type) in
        [(dvec2(2.0, 5.0), BoundaryType::Open), (dvec2(4.0, 2.0), BoundaryType::Land)]
    {
        let pieces = BoundaryPieces::of_domain(&domain, &marks).unwrap();
        let (piece, _) = pieces.nearest(place, 1e-9).unwrap();
        marks = pieces.retyped(&marks, piece, Some(boundary_type));
    }
    let case = Case::new(&domain, &marks, 0.5, BoundaryTreatment::OnOutline { diameter: 0.5 });
    let (seen, open, land) = read_grid(&case.text(fort14::write));
    super::check(&seen, &open, &land);
    let names = |strands: &[Strand]| strands.iter().map(|strand| strand.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&open), ["open west, open south", "mainland part 2"]);
    assert_eq!(names(&land), ["open east", "mainland part 1", "mainland part 3"]);
}
