use glam::{DVec2, dvec2};

use super::{CellNodes, MeshCells};
use crate::text::LengthUnit;

/// Nodes and triangles of a grid of squares, each divided along a diagonal.
fn squares(count: usize) -> (Vec<DVec2>, Vec<[usize; 3]>) {
    let row = count + 1;
    let nodes = (0..row * row).map(|n| dvec2((n % row) as f64, (n / row) as f64)).collect();
    let square = |n: usize| {
        let corner = n / count * row + n % count;
        [[corner, corner + 1, corner + row], [corner + 1, corner + row + 1, corner + row]]
    };
    (nodes, (0..count * count).flat_map(square).collect())
}

#[test]
fn squares_are_joined_and_all_links_are_orthogonal() {
    let (nodes, triangles) = squares(5);
    let mesh = CellNodes { nodes: &nodes, triangles: &triangles, unit: LengthUnit::Metre };
    let before = MeshCells::triangles(mesh).link_figures(mesh);
    assert_eq!((before.links, before.short), (65, 25), "each diagonal has a link of no length");
    let cells = MeshCells::joined(mesh);
    assert_eq!((cells.list().len(), cells.joined_count()), (25, 25));
    let after = cells.link_figures(mesh);
    assert_eq!((after.links, after.short, after.skewed, after.largest_cosine), (40, 0, 0, 0.0));
    for cell in cells.list() {
        let corners: Vec<DVec2> = cell.corners().iter().map(|&node| nodes[node]).collect();
        let area: f64 = (0..4).map(|k| corners[k].perp_dot(corners[(k + 1) % 4])).sum();
        assert_eq!(area, 2.0, "anticlockwise, of area 1");
    }
}

#[test]
fn a_pair_that_is_no_convex_quadrilateral_stays() {
    // Two triangles on one circle within rounding, of which one is nearly flat.
    let nodes = [dvec2(0.0, 0.0), dvec2(2.0, 0.0), dvec2(1.0, 1.0), dvec2(1.0, -1e-3)];
    let triangles = [[0, 1, 2], [1, 0, 3]];
    let mesh = CellNodes { nodes: &nodes, triangles: &triangles, unit: LengthUnit::None };
    let cells = MeshCells::joined(mesh);
    assert_eq!(cells.joined_count(), 0);
}

#[test]
fn in_degrees_lengths_are_those_on_the_earth() {
    // A square on the ground at 60° is twice as wide in degrees.
    let (nodes, triangles) = squares(1);
    let on_earth: Vec<DVec2> = nodes.iter().map(|p| dvec2(0.02 * p.x, 60.0 + 0.01 * p.y)).collect();
    let mesh = CellNodes { nodes: &on_earth, triangles: &triangles, unit: LengthUnit::Degree };
    assert!(MeshCells::triangles(mesh).link_figures(mesh).short == 1);
    assert_eq!(MeshCells::joined(mesh).joined_count(), 1);
}

#[test]
fn centers_are_as_far_from_all_corners_and_within_the_cell() {
    let (nodes, triangles) = squares(2);
    // Far from the origin, as in a plane of the Earth.
    let far: Vec<DVec2> = nodes.iter().map(|&p| dvec2(500_000.0, 6_000_000.0) + 100.0 * p).collect();
    let mesh = CellNodes { nodes: &far, triangles: &triangles, unit: LengthUnit::Metre };
    let cells = MeshCells::joined(mesh);
    let middles = [[50.0, 50.0], [150.0, 50.0], [50.0, 150.0], [150.0, 150.0]];
    let expected = middles.map(|[x, y]| dvec2(500_000.0 + x, 6_000_000.0 + y));
    assert_eq!(cells.centers(mesh), expected);
    // The circumcentre of a flat triangle lies outside: the centre is on the edge before it.
    let flat = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(2.0, 1.0)];
    let mesh = CellNodes { nodes: &flat, triangles: &[[0, 1, 2]], unit: LengthUnit::Metre };
    assert!(MeshCells::triangles(mesh).centers(mesh)[0].distance(dvec2(2.0, 0.0)) < 1e-12);
    let sharp = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(2.0, 4.0)];
    let mesh = CellNodes { nodes: &sharp, ..mesh };
    assert!(MeshCells::triangles(mesh).centers(mesh)[0].distance(dvec2(2.0, 1.5)) < 1e-12);
}

#[test]
fn values_at_centers_are_those_of_the_triangle_that_has_the_centre() {
    let (nodes, triangles) = squares(3);
    let mesh = CellNodes { nodes: &nodes, triangles: &triangles, unit: LengthUnit::Metre };
    for cells in [MeshCells::triangles(mesh), MeshCells::joined(mesh)] {
        let centers = cells.centers(mesh);
        let linear = |p: DVec2| 3.0 + 0.5 * p.x - 2.0 * p.y;
        for (value, center) in
            cells.at_centers(mesh, &centers, |node| linear(nodes[node])).iter().zip(&centers)
        {
            assert!((value - linear(*center)).abs() < 1e-12);
        }
        assert!(cells.at_centers(mesh, &centers, |_| 0.1).iter().all(|value| *value == 0.1), "no rounding");
    }
    // A quadrilateral whose centre is in its second triangle.
    let nodes = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(4.0, 1.0), dvec2(0.0, 4.0)];
    let mesh = CellNodes { nodes: &nodes, triangles: &[[1, 2, 0], [0, 2, 3]], unit: LengthUnit::None };
    let cell = super::MeshCell { corners: [1, 2, 3, 0], count: 4, triangles: [0, 1] };
    let cells = MeshCells { cells: vec![cell] };
    let peak = |node: usize| if node == 3 { 1.0 } else { 0.0 };
    // On the second triangle the value is (4 y - x) / 16.
    assert!((cells.at_centers(mesh, &[dvec2(1.0, 1.25)], peak)[0] - 0.25).abs() < 1e-12);
    assert!(cells.at_centers(mesh, &[dvec2(3.0, 0.5)], peak)[0].abs() < 1e-12);
}
