//! Gmsh 2.2 and 4.1, as the readers of solvers see them: physical groups by name, and the box of the nodes.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use glam::{DVec2, dvec2};
use meshbrush_io::io::{msh, msh22};
use meshbrush_mesh::geometry::Rect;

use super::{cases, frame, rim, words};

/// What FreeFEM, MFEM and Elmer take from a file of Gmsh 2.2: lines and triangles by the names of their
/// groups.
struct Groups {
    nodes: Vec<[f64; 3]>,
    lines: BTreeMap<String, Vec<[usize; 2]>>,
    triangles: BTreeMap<String, Vec<[usize; 3]>>,
}

/// Returns the lines of a section, without its first line, the number of them.
fn section<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let (start, end) = (format!("${name}\n"), format!("$End{name}\n"));
    let inner = text.split_once(&start).unwrap().1.split_once(&end).unwrap().0;
    let mut lines = inner.lines();
    let count: usize = lines.next().unwrap().parse().unwrap();
    let lines: Vec<&str> = lines.collect();
    assert_eq!(lines.len(), count, "{name}");
    lines
}

fn read_msh22(text: &str) -> Groups {
    assert!(text.starts_with("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"));
    let names: HashMap<[usize; 2], String> = section(text, "PhysicalNames")
        .into_iter()
        .map(|line| {
            let (numbers, name) = line.split_once(" \"").unwrap();
            (words(numbers, 2).try_into().unwrap(), name.strip_suffix('"').unwrap().to_owned())
        })
        .collect();
    let node = |(id, line): (usize, &str)| {
        let row = words::<f64>(line, 4);
        assert_eq!(row[0], id as f64);
        [row[1], row[2], row[3]]
    };
    let nodes = (1..).zip(section(text, "Nodes")).map(node).collect();
    let mut found = Groups { nodes, lines: BTreeMap::new(), triangles: BTreeMap::new() };
    for (id, line) in (1..).zip(section(text, "Elements")) {
        let row = words::<usize>(line, line.split(' ').count());
        assert_eq!((row[0], row[2]), (id, 2));
        match row[..] {
            [_, 1, _, group, _, a, b] => {
                found.lines.entry(names[&[1, group]].clone()).or_default().push([a - 1, b - 1]);
            }
            [_, 2, _, group, _, a, b, c] => {
                found.triangles.entry(names[&[2, group]].clone()).or_default().push([a - 1, b - 1, c - 1]);
            }
            _ => panic!("{line}"),
        }
    }
    assert_eq!(found.lines.len() + found.triangles.len(), names.len(), "a group without elements");
    found
}

#[test]
fn each_piece_is_a_physical_curve_of_gmsh_2() {
    for case in cases().into_iter().chain([frame()]) {
        let found = read_msh22(&case.text(msh22::write));
        let expected = case.expected();
        let places: Vec<DVec2> = found.nodes.iter().map(|p| dvec2(p[0], p[1])).collect();
        assert!(places == expected.nodes && found.nodes.iter().all(|p| p[2] == 0.0), "depths are no z");
        assert_eq!(
            found.triangles.into_iter().collect::<Vec<_>>(),
            [("domain".to_owned(), expected.triangles)]
        );
        let mut by_name: BTreeMap<String, Vec<[usize; 2]>> = BTreeMap::new();
        for (edge, &piece) in case.extract.boundary_edges().zip(case.boundary.piece_of_edge()) {
            let name = case.boundary.pieces().list()[piece as usize].name.clone();
            by_name.entry(name).or_default().push(edge.ends);
        }
        assert_eq!(found.lines, by_name);
        let all: BTreeSet<[usize; 2]> = found.lines.into_values().flatten().collect();
        assert_eq!(all, rim(&case.expected().triangles), "the domain is on the left");
    }
}

#[test]
fn values_of_nodes_follow_the_elements_of_gmsh_2() {
    let case = super::square_with_an_island();
    let text = case.text(msh22::write);
    let views: Vec<&str> = text.split("Data\n1\n\"").skip(1).collect();
    let rows = |view: &str| view.lines().nth(6).unwrap().parse::<usize>().unwrap();
    let heads: Vec<(&str, usize)> = views.iter().map(|v| (v.split('"').next().unwrap(), rows(v))).collect();
    let nodes = case.targets.len();
    let of_nodes = ["target_diameter", "other", "depth"].map(|name| (name, nodes));
    assert_eq!(heads, of_nodes, "meshio fails with element data beside two kinds of elements");
    assert!(text.ends_with("\n$EndComments\n") && text.contains("document: A sea\n"));
}

/// Returns the boxes of the curves and of the surface of Gmsh 4.1, without z.
fn boxes(text: &str) -> Vec<Rect> {
    let inner = text.split_once("$Entities\n").unwrap().1.split_once("$EndEntities").unwrap().0;
    let row = |line: &str| {
        let row = words::<f64>(line, 7);
        Rect::new(dvec2(row[1], row[2]), dvec2(row[4], row[5]))
    };
    inner.lines().skip(1).map(row).collect()
}

#[test]
fn boxes_of_gmsh_4_hold_the_nodes_in_their_coordinates() {
    for case in [super::square_with_an_island(), frame()] {
        // Nodes in degrees are elsewhere than the lattice.
        let places = case.extract.world_nodes().map(|p| dvec2(-6.0, 49.0) + 1e-3 * p).collect();
        let placed = case.extract.with_coordinates(places);
        let found = boxes(&case.text(|out, _, data| msh::write(out, &placed, data)));
        let expected = Rect::holding(placed.world_nodes()).unwrap();
        assert_eq!(found.last(), Some(&expected));
        let curves = found[..found.len() - 1].iter();
        assert!(curves.clone().all(|b| expected.contains(b.min) && expected.contains(b.max)));
        assert_eq!(found.len(), case.boundary.present().count() + 1);
    }
}
