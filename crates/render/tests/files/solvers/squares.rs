//! Files with quadrilaterals: their cells cover the triangles once, and the links between them, measured here
//! from the file alone, are none that Delft3D-FM removes.

use std::collections::HashMap;

use glam::DVec2;
use meshbrush_core::domain::{BoundaryTreatment, Domain, MeshBoundary};
use meshbrush_io::io::{CellShape, JoinedCells, MeshData, gr3, mike, msh, sms, ugrid};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, Mesh};
use meshbrush_mesh::text::LengthUnit;

use super::{Case, cases, frame, rim};
use crate::formula_mesh::formula_mesh;
use crate::netcdf_reader::NetCdf;

/// Returns a file with squares.
fn with_squares(
    case: &Case,
    write: impl FnOnce(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>,
) -> Vec<u8> {
    let mut file = Vec::new();
    // Each file joins on its own.
    let joined = &JoinedCells::default();
    write(&mut file, &case.extract, &MeshData { cells: CellShape::Squares, joined, ..case.data() }).unwrap();
    file
}

/// Returns the whole numbers of a line.
fn numbers(line: &str) -> Vec<usize> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Returns the cells of `hgrid.gr3`, numbered from 0.
fn cells_of_gr3(text: &str) -> Vec<Vec<usize>> {
    let mut lines = text.lines().skip(1);
    let counts = numbers(lines.next().unwrap());
    let rows = lines.skip(counts[1]).take(counts[0]).map(numbers);
    rows.map(|row| {
        assert_eq!(row[1], row.len() - 2);
        row[2..].iter().map(|node| node - 1).collect()
    })
    .collect()
}

/// Returns the elements of `.2dm`.
fn cells_of_2dm(text: &str) -> Vec<Vec<usize>> {
    let corners = |line: &str| match line.get(..3)? {
        "E3T" => Some(3),
        "E4Q" => Some(4),
        _ => None,
    };
    let element = |line: &str| {
        let count = corners(line)?;
        let row = numbers(line);
        assert_eq!(row.len(), count + 2, "number, corners and material: {line}");
        Some(row[1..=count].iter().map(|node| node - 1).collect())
    };
    text.lines().filter_map(element).collect()
}

/// Returns the elements of MIKE's `.mesh`: a triangle has 0 for its fourth node.
fn cells_of_mike(text: &str) -> Vec<Vec<usize>> {
    let mut lines = text.lines();
    let nodes = numbers(lines.next().unwrap())[2];
    let mut lines = lines.skip(nodes);
    let head = numbers(lines.next().unwrap());
    assert_eq!(head[1..], if head[1] == 4 { [4, 25] } else { [3, 21] });
    let cells: Vec<Vec<usize>> = lines
        .map(|line| {
            let row = numbers(line);
            assert_eq!(row.len(), head[1] + 1, "{line}");
            row[1..].iter().filter(|&&node| node > 0).map(|node| node - 1).collect()
        })
        .collect();
    assert_eq!(cells.len(), head[0]);
    cells
}

/// Returns the elements of Gmsh 4.1 with three or four nodes.
fn cells_of_msh(text: &str) -> Vec<Vec<usize>> {
    let mut lines = text.lines().skip_while(|line| *line != "$Elements").skip(1).map(numbers);
    let [blocks, count] = [0, 1].map({
        let head = lines.next().unwrap();
        move |n| head[n]
    });
    let (mut cells, mut tags) = (Vec::new(), 0);
    for _ in 0..blocks {
        let head = lines.next().unwrap();
        let nodes = match head[2] {
            1 => 2,
            2 => 3,
            3 => 4,
            kind => panic!("an element of the kind {kind}"),
        };
        for row in lines.by_ref().take(head[3]) {
            tags += 1;
            assert_eq!((row[0], row.len()), (tags, nodes + 1));
            if nodes > 2 {
                cells.push(row[1..].iter().map(|node| node - 1).collect());
            }
        }
    }
    assert_eq!(tags, count);
    cells
}

/// Returns the faces of UGRID.
fn cells_of_ugrid(file: &NetCdf) -> Vec<Vec<usize>> {
    let faces = file.dimensions["mesh2d_nFaces"];
    let values = file.values("mesh2d_face_nodes");
    let corners = values.len() / faces;
    let face = |row: &[f64]| row.iter().filter(|&&node| node > 0.0).map(|&node| node as usize - 1).collect();
    values.chunks(corners).map(face).collect()
}

/// Returns the edges of a cell, each from a node to the next one.
fn edges_of(cell: &[usize]) -> impl Iterator<Item = [usize; 2]> + Clone + '_ {
    (0..cell.len()).map(|k| [cell[k], cell[(k + 1) % cell.len()]])
}

fn area(nodes: &[DVec2], cell: &[usize]) -> f64 {
    0.5 * edges_of(cell).map(|[a, b]| nodes[a].perp_dot(nodes[b])).sum::<f64>()
}

/// Checks that cells are convex and anticlockwise, cover what the triangles cover, and have the same
/// boundary.
fn check_cells(case: &Case, cells: &[Vec<usize>]) {
    let expected = case.expected();
    let nodes = &expected.nodes;
    let whole: f64 = expected.triangles.iter().map(|cell| area(nodes, cell)).sum();
    let covered: f64 = cells.iter().map(|cell| area(nodes, cell)).sum();
    assert!((covered / whole - 1.0).abs() < 1e-12, "{covered} of {whole}");
    for cell in cells {
        assert!((3..=4).contains(&cell.len()));
        let ahead = edges_of(cell).zip(edges_of(cell).cycle().skip(1));
        let turns = ahead.map(|([a, b], [_, c])| (nodes[b] - nodes[a]).perp_dot(nodes[c] - nodes[b]));
        assert!(turns.into_iter().all(|turn| turn > 0.0), "{cell:?} is convex and anticlockwise");
    }
    let mut directed: HashMap<[usize; 2], usize> = HashMap::new();
    cells.iter().flat_map(|cell| edges_of(cell)).for_each(|edge| *directed.entry(edge).or_default() += 1);
    assert!(directed.values().all(|&times| times == 1), "an edge has a cell on each side at most");
    let outer = directed.keys().filter(|[a, b]| !directed.contains_key(&[*b, *a])).copied();
    assert!(
        outer.collect::<std::collections::BTreeSet<_>>() == rim(&expected.triangles),
        "the boundary stays"
    );
    let joined = cells.iter().filter(|cell| cell.len() == 4).count();
    assert_eq!(cells.len() + joined, expected.triangles.len());
}

/// Returns the place at the same distance from the corners of a triangle or of a quadrilateral on one circle:
/// from the first three corners.
fn circumcenter(nodes: &[DVec2], cell: &[usize]) -> DVec2 {
    let [a, b, c] = [nodes[cell[0]], nodes[cell[1]], nodes[cell[2]]];
    // The perpendicular bisectors of two edges, as two linear equations.
    let (u, v) = (b - a, c - a);
    let (p, q) = (u.dot(a + b) / 2.0, v.dot(a + c) / 2.0);
    let d = u.perp_dot(v);
    DVec2::new((p * v.y - q * u.y) / d, (u.x * q - v.x * p) / d)
}

#[test]
fn cells_of_all_formats_are_the_same_and_cover_the_mesh() {
    let mut joined = 0;
    for case in cases().into_iter().chain([frame()]) {
        let text = |write: fn(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>| {
            String::from_utf8(with_squares(&case, write)).unwrap()
        };
        let cells = cells_of_gr3(&text(gr3::write));
        check_cells(&case, &cells);
        assert_eq!(cells_of_2dm(&text(sms::write)), cells);
        assert_eq!(cells_of_mike(&text(mike::write)), cells);
        let [mut by_corners, mut sorted] = [cells_of_msh(&text(msh::write)), cells.clone()];
        by_corners.sort_unstable();
        sorted.sort_unstable();
        assert_eq!(by_corners, sorted);
        let file = NetCdf::read(&with_squares(&case, ugrid::write));
        assert_eq!(cells_of_ugrid(&file), cells);
        // By default, too.
        let mut plain = Vec::new();
        ugrid::write(&mut plain, &case.extract, &MeshData { cells: CellShape::OfFormat, ..case.data() })
            .unwrap();
        assert_eq!(cells_of_ugrid(&NetCdf::read(&plain)), cells);
        joined += cells.iter().filter(|cell| cell.len() == 4).count();
        let edges: usize = file.values("mesh2d_edge_nodes").len() / 2;
        let sides: usize = cells.iter().map(Vec::len).sum();
        assert_eq!(2 * edges, sides + rim(&case.expected().triangles).len(), "each edge once");
        assert_eq!(file.values("mesh2d_boundary").len(), edges);
        assert_eq!(file.values("mesh2d_level").len(), cells.len());
    }
    assert!(joined > 1000, "{joined}");
}

#[test]
fn in_the_plain_all_links_are_orthogonal() {
    let domain = Domain::rectangle(Rect::UNIT);
    let size = "0.02 + 0.3*abs(hypot(x - 0.5, y - 0.5) - 0.3)";
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, size);
    let mesh: &'static Mesh = Box::leak(Box::new(built.mesh));
    let boundary = MeshBoundary::from_mesh(&mesh.extract());
    let mut case = Case::of(mesh.extract(), boundary, mesh);
    case.provenance = case.provenance.clone().with_unit(LengthUnit::Metre);
    let cells = cells_of_ugrid(&NetCdf::read(&with_squares(&case, ugrid::write)));
    let nodes = case.expected().nodes;
    let mut centers: HashMap<[usize; 2], DVec2> = HashMap::new();
    let mut links = 0;
    for cell in &cells {
        let center = circumcenter(&nodes, cell);
        for [a, b] in edges_of(cell) {
            let Some(other) = centers.insert([a, b], center).or(centers.get(&[b, a]).copied()) else {
                continue;
            };
            let (link, edge) = (center - other, nodes[b] - nodes[a]);
            assert!(link.length() > 0.1 * edge.length(), "no link is short: {link}");
            assert!(link.dot(edge).abs() < 1e-12 * link.length() * edge.length());
            links += 1;
        }
    }
    assert!(links > 1000, "{links}");
}
