//! `.disv`: MODFLOW's blocks, read here by a parser that knows only its documentation; cells cover the mesh
//! clockwise, the centres are what MODFLOW needs, and top and bottom are those of surface and depth.

use std::collections::HashMap;

use glam::{DVec2, dvec2};
use meshbrush_core::domain::{BoundaryTreatment, Domain, MeshBoundary};
use meshbrush_io::io::{CellShape, MeshData, disv, gr3};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Mesh;
use meshbrush_mesh::text::LengthUnit;

use super::{Case, cases, frame};
use crate::formula_mesh::formula_mesh;

/// A grid as MODFLOW reads it. Numbers start at zero.
struct Disv {
    comments: Vec<String>,
    options: Vec<String>,
    vertices: Vec<DVec2>,
    centers: Vec<DVec2>,
    /// The vertices of each cell, as listed.
    cells: Vec<Vec<usize>>,
    top: Vec<f64>,
    bottom: Vec<f64>,
}

/// Returns the lines of each block by its name, without comments and blank lines.
fn blocks(text: &str) -> HashMap<&str, Vec<&str>> {
    let (mut found, mut open) = (HashMap::new(), None);
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        match (line.split_once(' '), open) {
            (Some(("BEGIN", name)), None) => {
                assert!(found.insert(name, Vec::new()).is_none(), "{name} twice");
                open = Some(name);
            }
            (Some(("END", name)), Some(begun)) => {
                assert_eq!(name, begun);
                open = None;
            }
            (_, Some(name)) => found.get_mut(name).unwrap().push(line),
            (_, None) => panic!("{line} is in no block"),
        }
    }
    assert!(open.is_none());
    found
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(' ').map(|word| word.parse().unwrap_or_else(|_| panic!("{line}"))).collect()
}

fn read(text: &str) -> Disv {
    let blocks = blocks(text);
    let dimensions: HashMap<&str, usize> = blocks["DIMENSIONS"]
        .iter()
        .map(|line| line.split_once(' ').unwrap())
        .map(|(k, n)| (k, n.parse().unwrap()))
        .collect();
    assert_eq!((dimensions.len(), dimensions["NLAY"]), (3, 1));
    let (cells, nodes) = (dimensions["NCPL"], dimensions["NVERT"]);
    let data = &blocks["GRIDDATA"];
    assert_eq!(data.len(), 2 * (cells + 2));
    assert_eq!((data[0], data[1]), ("TOP", "INTERNAL FACTOR 1.0"));
    assert_eq!((data[cells + 2], data[cells + 3]), ("BOTM LAYERED", "INTERNAL FACTOR 1.0"));
    let column = |from: usize| data[from..from + cells].iter().map(|line| line.parse().unwrap()).collect();
    let rows = |name: &str, count: usize| {
        let rows: Vec<Vec<f64>> = blocks[name].iter().map(|line| numbers(line)).collect();
        assert_eq!(rows.len(), count, "{name}");
        assert!(rows.iter().zip(1..).all(|(row, number)| row[0] == f64::from(number)), "{name} in order");
        rows
    };
    let listed = rows("CELL2D", cells);
    let corners = |row: &Vec<f64>| {
        assert_eq!(row.len(), 4 + row[3] as usize);
        row[4..].iter().map(|&vertex| vertex as usize - 1).collect()
    };
    Disv {
        comments: text.lines().filter(|line| line.starts_with('#')).map(str::to_owned).collect(),
        options: blocks.get("OPTIONS").into_iter().flatten().map(|&line| line.to_owned()).collect(),
        vertices: rows("VERTICES", nodes).iter().map(|row| dvec2(row[1], row[2])).collect(),
        centers: listed.iter().map(|row| dvec2(row[1], row[2])).collect(),
        cells: listed.iter().map(corners).collect(),
        top: column(2),
        bottom: column(cells + 4),
    }
}

fn written(case: &Case, cells: CellShape, heights: Option<&[f64]>) -> Disv {
    let mut file = Vec::new();
    disv::write(&mut file, &case.extract, &MeshData { cells, heights, ..case.data() }).unwrap();
    read(&String::from_utf8(file).unwrap())
}

/// Returns twice the area to the left of a ring, as MODFLOW adds it up to know that it runs clockwise.
fn doubled_area(grid: &Disv, cell: &[usize]) -> f64 {
    let at = |k: usize| grid.vertices[cell[k % cell.len()]];
    (0..cell.len()).map(|k| (at(k) - at(0)).perp_dot(at(k + 1) - at(0))).sum()
}

#[test]
fn cells_run_clockwise_and_are_those_of_other_formats() {
    for case in cases().into_iter().chain([frame()]) {
        for shape in [CellShape::Triangles, CellShape::Squares] {
            let grid = written(&case, shape, None);
            assert_eq!(grid.vertices, case.expected().nodes);
            assert!(grid.cells.iter().all(|cell| doubled_area(&grid, cell) < 0.0), "clockwise");
            let mut other = Vec::new();
            gr3::write(&mut other, &case.extract, &MeshData { cells: shape, ..case.data() }).unwrap();
            let other = String::from_utf8(other).unwrap();
            let rows = other.lines().skip(2 + grid.vertices.len()).take(grid.cells.len());
            for (row, cell) in rows.zip(&grid.cells) {
                let mut anticlockwise: Vec<usize> =
                    numbers(row)[2..].iter().map(|n| *n as usize - 1).collect();
                anticlockwise.reverse();
                assert_eq!(&anticlockwise, cell);
            }
        }
        assert_eq!(
            written(&case, CellShape::OfFormat, None).cells,
            written(&case, CellShape::Squares, None).cells
        );
    }
}

#[test]
fn bottom_and_top_are_depth_and_surface_at_the_centres() {
    for mut case in cases() {
        case.provenance = case.provenance.clone().with_unit(LengthUnit::Metre);
        let grid = written(&case, CellShape::OfFormat, None);
        // The depths of the case are linear: those at a centre need no triangle.
        for (center, bottom) in grid.centers.iter().zip(&grid.bottom) {
            assert!((bottom + 20.0 + center.x / 3.0 - center.y).abs() < 1e-12, "{center}: {bottom}");
        }
        assert!(grid.top.iter().all(|top| top.to_bits() == 0) && grid.options == ["LENGTH_UNITS METERS"]);
        let says = |grid: &Disv, text: &str| grid.comments.iter().any(|line| line.contains(text));
        assert!(says(&grid, "# program: Meshbrush ") && says(&grid, "# botm: minus the depth"));
        let heights: Vec<f64> = case.expected().nodes.iter().map(|p| 2.0 * p.x + 7.0).collect();
        let grid = written(&case, CellShape::OfFormat, Some(&heights));
        for (center, top) in grid.centers.iter().zip(&grid.top) {
            assert!((top - 2.0 * center.x - 7.0).abs() < 1e-12);
        }
        case.quantities.clear();
        let grid = written(&case, CellShape::OfFormat, None);
        assert!(
            grid.bottom.iter().all(|bottom| *bottom == -1.0)
                && says(&grid, "1 below the top, to be replaced")
        );
    }
}

#[test]
fn connections_in_the_plain_are_orthogonal_and_have_a_length() {
    let domain = Domain::rectangle(Rect::UNIT);
    let size = "0.02 + 0.3*abs(hypot(x - 0.5, y - 0.5) - 0.3)";
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, size);
    let mesh: &'static Mesh = Box::leak(Box::new(built.mesh));
    let case = Case::of(mesh.extract(), MeshBoundary::from_mesh(&mesh.extract()), mesh);
    let grid = written(&case, CellShape::OfFormat, None);
    let mut sides: HashMap<[usize; 2], usize> = HashMap::new();
    let mut connections = 0;
    for (number, cell) in grid.cells.iter().enumerate() {
        for k in 0..cell.len() {
            let ends = [cell[k], cell[(k + 1) % cell.len()]];
            let Some(&other) = sides.get(&[ends[1], ends[0]]) else {
                sides.insert(ends, number);
                continue;
            };
            let [from, to] = ends.map(|vertex| grid.vertices[vertex]);
            let along = (to - from).normalize();
            // What MODFLOW divides by: the distance of each centre from the edge.
            let distances = [number, other].map(|cell| (grid.centers[cell] - from).perp_dot(along).abs());
            let between = grid.centers[number] - grid.centers[other];
            assert!(distances.iter().sum::<f64>() > 0.1 * (to - from).length(), "{distances:?}");
            assert!(between.dot(along).abs() < 1e-12 * between.length(), "{between}");
            connections += 1;
        }
    }
    assert!(connections > 1000, "{connections}");
}

#[test]
fn coordinates_are_lengths_and_cells_have_a_thickness() {
    let mut case = frame();
    let plain = written(&case, CellShape::OfFormat, None);
    assert!(plain.options.is_empty(), "without a unit none is written");
    case.provenance = case.provenance.clone().with_unit(LengthUnit::Kilometre);
    let far = written(&case, CellShape::OfFormat, None);
    assert_eq!(far.options, ["LENGTH_UNITS METERS"]);
    let pairs = || plain.vertices.iter().zip(&far.vertices).chain(plain.centers.iter().zip(&far.centers));
    assert!(pairs().all(|(p, q)| 1000.0 * *p == *q));
    assert!(far.comments.iter().any(|line| line.contains("1000 times those of the mesh")));
    let mut degrees = frame();
    degrees.provenance = degrees.provenance.with_unit(LengthUnit::Degree);
    let refused = degrees.refused(disv::write);
    assert!(
        refused.contains("the coordinates of this mesh are degrees") && refused.contains("--out-crs plane")
    );
    // The west of this shore is dry.
    let depth = case.expected().nodes.iter().map(|p| p.x - 0.5).collect();
    case.quantities = vec![meshbrush_io::io::NodeValues { name: "depth".into(), values: depth }];
    let refused = case.refused(disv::write);
    assert!(refused.starts_with("MODFLOW refuses cells without thickness: at x = 0.125, y = "), "{refused}");
    assert!(refused.contains("the bottom 0.375 is not below the top 0; write a least depth"), "{refused}");
}
