//! For each rule a small mesh that breaks it, and one that keeps it.

use glam::DVec2;
use meshbrush_mesh::text::LengthUnit;

use super::{RULES, Severity, Solver, WrittenMesh, WrittenString, broken_rules, rules_of};

/// Returns the places at which a mesh breaks a rule.
fn places(mesh: &WrittenMesh, name: &str) -> Vec<[f64; 2]> {
    let rule = RULES.iter().find(|rule| rule.name == name).unwrap();
    (rule.find)(mesh).into_iter().map(|found| found.place.into()).collect()
}

fn mesh(nodes: &[[f64; 2]], triangles: &[[usize; 3]], strings: Vec<WrittenString>) -> WrittenMesh {
    WrittenMesh::new(nodes.iter().map(|&p| p.into()).collect(), triangles.to_vec(), strings)
}

fn string(is_open: bool, name: &str, nodes: &[usize]) -> WrittenString {
    WrittenString { name: name.into(), is_open, nodes: nodes.to_vec() }
}

/// Returns triangles around an inner node at the origin, the node 0.
fn fan(triangles: usize) -> WrittenMesh {
    let angle = |n: usize| std::f64::consts::TAU * n as f64 / triangles as f64;
    let ring = (0..triangles).map(|n| DVec2::from_angle(angle(n)));
    let corners = (0..triangles).map(|n| [0, n + 1, (n + 1) % triangles + 1]).collect();
    WrittenMesh::new(std::iter::once(DVec2::ZERO).chain(ring).collect(), corners, Vec::new())
}

/// Returns a square of four triangles around its middle, the node 4, with these strings.
fn square(strings: Vec<WrittenString>) -> WrittenMesh {
    let nodes = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
    mesh(&nodes, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], strings)
}

/// Returns a square of two triangles, with these strings.
fn two_triangles(strings: Vec<WrittenString>) -> WrittenMesh {
    let nodes = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    mesh(&nodes, &[[0, 1, 2], [0, 2, 3]], strings)
}

fn near(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    let is_near = |(a, b): (&[f64; 2], &[f64; 2])| DVec2::from(*a).distance(DVec2::from(*b)) < 1e-12;
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(is_near), "{found:?}");
}

#[test]
fn triangles_run_anticlockwise_around_an_area() {
    near(&places(&square(Vec::new()), "clockwise_triangle"), &[]);
    let nodes = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [6.0, 0.0]];
    let broken = mesh(&nodes, &[[0, 2, 1], [0, 1, 3]], Vec::new());
    near(&places(&broken, "clockwise_triangle"), &[[1.0, 1.0], [3.0, 0.0]]);
}

#[test]
fn nodes_are_there_once_and_have_triangles() {
    for name in ["repeated_node", "node_without_triangle"] {
        near(&places(&square(Vec::new()), name), &[]);
    }
    let nodes = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [3.0, 0.0], [7.0, 7.0]];
    let broken = mesh(&nodes, &[[0, 1, 2]], Vec::new());
    near(&places(&broken, "repeated_node"), &[[3.0, 0.0]]);
    near(&places(&broken, "node_without_triangle"), &[[3.0, 0.0], [7.0, 7.0]]);
}

#[test]
fn a_boundary_touches_itself_where_four_of_its_edges_meet() {
    near(&places(&square(Vec::new()), "boundaries_that_touch"), &[]);
    let nodes = [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let hourglass = mesh(&nodes, &[[0, 1, 2], [2, 3, 4]], Vec::new());
    near(&places(&hourglass, "boundaries_that_touch"), &[[0.5, 1.0]]);
    assert!(!hourglass.has_strings());
}

#[test]
fn open_nodes_are_listed_once() {
    let land = || string(false, "coast", &[2, 3, 0]);
    let apart = square(vec![string(true, "south", &[0, 1]), string(true, "east", &[1, 2]), land()]);
    near(&places(&apart, "open_node_twice"), &[[2.0, 0.0]]);
    let joined = square(vec![string(true, "south, east", &[0, 1, 2]), land()]);
    near(&places(&joined, "open_node_twice"), &[]);
}

#[test]
fn strings_have_edges_enough() {
    let short = square(vec![string(true, "mouth", &[1]), string(false, "coast", &[1, 2, 3, 0, 1])]);
    near(&places(&short, "short_open_string"), &[[2.0, 0.0]]);
    near(&places(&short, "boundary_of_two_nodes"), &[]);
    let one_edge = square(vec![string(true, "mouth", &[0, 1]), string(false, "coast", &[1, 2, 3, 0])]);
    near(&places(&one_edge, "short_open_string"), &[]);
    near(&places(&one_edge, "boundary_of_two_nodes"), &[[0.0, 0.0]]);
    let sentence = &broken_rules(&one_edge, Solver::Adcirc)[0].found[0].sentence;
    assert_eq!(sentence, "The open boundary “mouth” has 2 nodes.");
}

#[test]
fn open_pieces_that_nodes_cannot_mark_are_named() {
    let mut lost = square(vec![string(true, "mouth", &[0, 1]), string(false, "coast", &[1, 2, 3, 0])]);
    near(&places(&lost, "open_piece_without_edge"), &[]);
    lost.lost_open = vec![(0, "mouth".into())];
    near(&places(&lost, "open_piece_without_edge"), &[[0.0, 0.0]]);
}

#[test]
fn fvcom_counts_open_nodes_twice_and_others_of_the_boundary_once() {
    let strings = || vec![string(true, "south", &[0, 1]), string(false, "coast", &[1, 2, 3, 0])];
    near(&places(&two_triangles(strings()), "two_open_nodes_and_shore"), &[[4.0 / 3.0, 2.0 / 3.0]]);
    near(&places(&square(strings()), "two_open_nodes_and_shore"), &[]);
    // An open corner without a third node on the boundary is no harm, and neither is one open node.
    let closed = two_triangles(vec![string(false, "coast", &[0, 1, 2, 3, 0])]);
    near(&places(&closed, "two_open_nodes_and_shore"), &[]);
    let broken = broken_rules(&two_triangles(strings()), Solver::Fvcom);
    assert_eq!((broken.len(), broken[0].rule.source), (1, "FVCOM tge.F"));
    assert!(broken[0].found[0].sentence.ends_with("the sum over its nodes is 5, and may be 4."));
}

#[test]
fn a_triangle_with_three_boundary_nodes_is_overconstrained() {
    near(&places(&square(Vec::new()), "overconstrained_triangle"), &[]);
    let both = [[4.0 / 3.0, 2.0 / 3.0], [2.0 / 3.0, 4.0 / 3.0]];
    near(&places(&two_triangles(Vec::new()), "overconstrained_triangle"), &both);
    let broken = broken_rules(&two_triangles(Vec::new()), Solver::Telemac);
    assert!(
        broken[0].found[0].sentence.ends_with("two of its edges are on the boundary, and TELEMAC names it.")
    );
}

#[test]
fn islands_of_few_edges_are_taken_for_cells() {
    // A ring of triangles around a hole: corners of the hole first, then those outside.
    let ring = |edges: usize| {
        let angle = |n: f64| std::f64::consts::TAU * n / edges as f64;
        let circle = |radius: f64, shift: f64| {
            (0..edges).map(move |n| radius * DVec2::from_angle(angle(n as f64 + shift)))
        };
        let nodes = circle(1.0, 0.0).chain(circle(2.0, 0.5)).collect();
        let next = |n: usize| (n + 1) % edges;
        let pair = |n: usize| [[n, edges + n, next(n)], [next(n), edges + n, edges + next(n)]];
        WrittenMesh::new(nodes, (0..edges).flat_map(pair).collect(), Vec::new())
    };
    for (edges, islands) in [(3, 1), (6, 1), (7, 0)] {
        assert_eq!(places(&ring(edges), "island_like_cell").len(), islands, "{edges}");
    }
    let found = &broken_rules(&ring(5), Solver::Delft3dFm)[0].found[0];
    assert_eq!(found.sentence, "An island has 5 edges, and its solver takes it for a cell.");
    assert_eq!(found.mended_in, [0, 2, 4, 6, 8], "the triangles with an edge of the hole");
}

#[test]
fn land_along_an_open_boundary_is_a_strip_where_two_triangles_are_between_them() {
    // Columns of squares with open nodes below and land above, so many squares high.
    let strip = |height: usize, length: usize| {
        let width = length + 1;
        let node = |x: usize, y: usize| y * width + x;
        let nodes: Vec<[f64; 2]> =
            (0..=height).flat_map(|y| (0..width).map(move |x| [x as f64, y as f64])).collect();
        let squares = (0..height).flat_map(|y| (0..length).map(move |x| (x, y)));
        let triangles = squares.flat_map(|(x, y)| {
            let [a, b, c, d] = [node(x, y), node(x + 1, y), node(x + 1, y + 1), node(x, y + 1)];
            [[a, b, c], [a, c, d]]
        });
        let triangles: Vec<[usize; 3]> = triangles.collect();
        let open: Vec<usize> = (0..width).collect();
        mesh(&nodes, &triangles, vec![string(true, "frame", &open)])
    };
    assert_eq!(places(&strip(1, 12), "strip_along_frame").len(), 1);
    assert_eq!(places(&strip(2, 12), "strip_along_frame").len(), 1);
    assert!(places(&strip(3, 12), "strip_along_frame").is_empty(), "an inner ring of nodes is between");
    assert!(places(&strip(1, 9), "strip_along_frame").is_empty(), "the ends meet land anyway");
    let broken = broken_rules(&strip(2, 12), Solver::Schism);
    let found = broken.iter().find(|broken| broken.rule.name == "strip_along_frame").unwrap();
    let sentence =
        "The open boundary “frame” runs along land over 4 edges, with at most two triangles between them.";
    assert_eq!(found.found[0].sentence, sentence);
}

#[test]
fn swan_takes_angles_up_to_143_degrees_in_the_coordinates_of_the_file() {
    // tan 71.565° = 3: half of 143.13°, which is the most.
    let triangle = |half: f64| mesh(&[[-half, 0.0], [half, 0.0], [0.0, 1.0]], &[[0, 1, 2]], Vec::new());
    near(&places(&triangle(2.999), "obtuse_angle"), &[]);
    near(&places(&triangle(3.001), "obtuse_angle"), &[[0.0, 1.0 / 3.0]]);
    let sentence = &broken_rules(&triangle(4.0), Solver::Swan)[0].found[0].sentence;
    assert_eq!(sentence, "Triangle 1 has an angle of 151.9°, and 143.13° are the most.");
}

#[test]
fn swan_takes_four_to_ten_cells_at_an_inner_node() {
    for (triangles, is_broken) in [(3, true), (4, false), (10, false), (11, true)] {
        let found = places(&fan(triangles), "cells_at_node");
        near(&found, if is_broken { &[[0.0, 0.0]] } else { &[] });
    }
}

#[test]
fn flow_links_vanish_where_four_nodes_lie_on_one_circle() {
    // The pair of a square shares its centre.
    near(&places(&two_triangles(Vec::new()), "short_flow_link"), &[[1.0, 1.0]]);
    let rhombus = |height: f64| {
        let nodes = [[0.0, 0.0], [1.0, -height], [2.0, 0.0], [1.0, height]];
        mesh(&nodes, &[[0, 1, 2], [0, 2, 3]], Vec::new())
    };
    // Half a link is (height² - 1) / (2 height) long, and the root of the area of a triangle √height.
    for (height, is_short) in [(1.04, true), (1.06, false), (3.0_f64.sqrt(), false)] {
        let link = (height * height - 1.0) / height;
        assert_eq!(link < 0.09 * f64::sqrt(height), is_short);
        near(&places(&rhombus(height), "short_flow_link"), if is_short { &[[1.0, 0.0]] } else { &[] });
        near(&places(&rhombus(height), "skewed_flow_link"), &[]);
    }
}

#[test]
fn modflow_divides_by_the_length_of_connections_and_takes_oblique_ones_for_straight() {
    // The pair of a square shares its centre; as a rule MODFLOW gets one square.
    let mut pair = two_triangles(Vec::new());
    near(&places(&pair, "connection_of_no_length"), &[[1.0, 1.0]]);
    pair.join_cells();
    near(&places(&pair, "connection_of_no_length"), &[]);
    let kite = |x: f64, height: f64| {
        let nodes = [[0.0, 0.0], [x, -height], [2.0, 0.0], [x, height]];
        mesh(&nodes, &[[0, 1, 2], [0, 2, 3]], Vec::new())
    };
    // Its connection is (height² - 1) / height long, and the root of the area of a triangle √height.
    for (height, has_none) in [(1.0004, true), (1.0006, false), (2.0, false)] {
        assert_eq!((height * height - 1.0) / height < 1e-3 * f64::sqrt(height), has_none);
        near(
            &places(&kite(1.0, height), "connection_of_no_length"),
            if has_none { &[[1.0, 0.0]] } else { &[] },
        );
        near(&places(&kite(1.0, height), "oblique_connection"), &[]);
    }
    // The centre of a flat triangle is held at its longest edge, away from the perpendicular of the edge.
    let obtuse =
        mesh(&[[0.0, 0.0], [4.0, 0.0], [2.0, 3.0], [-3.0, -0.9]], &[[0, 1, 2], [0, 3, 1]], Vec::new());
    near(&places(&obtuse, "oblique_connection"), &[[2.0, 0.0]]);
    assert!(rules_of(Solver::Modflow).all(|rule| !rule.needs_strings));
}

#[test]
fn cells_of_modflow_have_a_thickness() {
    // Four triangles around the middle, whose centres are the middles of the sides of the square.
    let mut pond = square(Vec::new());
    near(&places(&pond, "cell_without_thickness"), &[]);
    pond.depths = Some(vec![0.0, 0.0, 4.0, 4.0, 9.0]);
    near(&places(&pond, "cell_without_thickness"), &[[1.0, 0.0]]);
    let sentence = &broken_rules(&pond, Solver::Modflow)[0].found[0].sentence;
    assert_eq!(sentence, "Cell 1 is 0 thick.");
    pond.heights = Some(vec![1.0, 1.0, -5.0, -5.0, 1.0]);
    near(&places(&pond, "cell_without_thickness"), &[[2.0, 1.0], [1.0, 2.0], [0.0, 1.0]]);
}

#[test]
fn in_degrees_flow_links_are_those_on_the_ground() {
    // At 60° a degree of longitude is half as long as one of latitude.
    let rhombus = |height: f64, unit| {
        let nodes = [[0.0, 60.0], [0.002, 60.0 - height], [0.004, 60.0], [0.002, 60.0 + height]];
        let mut pair = mesh(&nodes, &[[0, 1, 2], [0, 2, 3]], Vec::new());
        pair.unit = unit;
        places(&pair, "short_flow_link").len()
    };
    let (degree, metre) = (LengthUnit::Degree, LengthUnit::Metre);
    assert_eq!([rhombus(0.001, degree), rhombus(0.002, degree)], [1, 0], "a square, and one twice as high");
    assert_eq!([rhombus(0.002, metre), rhombus(0.004, metre)], [1, 0]);
}

#[test]
fn links_from_far_obtuse_cells_are_skewed() {
    // The centre of an obtuse cell is held at its longest edge, away from the perpendicular of the common
    // one.
    near(&places(&fan(6), "skewed_flow_link"), &[]);
    let obtuse =
        mesh(&[[0.0, 0.0], [4.0, 0.0], [2.0, 3.0], [-3.0, -0.9]], &[[0, 1, 2], [0, 3, 1]], Vec::new());
    near(&places(&obtuse, "skewed_flow_link"), &[[2.0, 0.0]]);
}

#[test]
fn dry_nodes_are_a_note_where_there_are_depths() {
    let mut sea = square(Vec::new());
    near(&places(&sea, "dry_node"), &[]);
    sea.depths = Some(vec![0.0, 3.0, -1.5, 3.0, 20.0]);
    near(&places(&sea, "dry_node"), &[[0.0, 0.0], [2.0, 2.0]]);
    sea.strings = vec![string(false, "coast", &[0, 1, 2, 3, 0])];
    let broken = broken_rules(&sea, Solver::Schism);
    assert!(broken.len() == 1 && broken[0].rule.severity == Severity::Note, "{broken:?}");
    assert_eq!(broken[0].found[1].sentence, "The depth at node 3 is −1.5 m.");
}

#[test]
fn each_solver_has_the_rules_of_all_and_words_for_it() {
    for solver in Solver::ALL {
        assert_eq!(solver.word().parse(), Ok(solver));
        assert!(rules_of(solver).count() >= 4, "{solver:?}");
    }
    let error = "roms".parse::<Solver>().unwrap_err().to_string();
    assert!(error.starts_with("“roms” is no solver") && error.ends_with("delft3dfm mike modflow"), "{error}");
    let mut names: Vec<&str> = RULES.iter().map(|rule| rule.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), RULES.len());
}
