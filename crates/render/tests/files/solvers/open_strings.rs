//! Each open node is in one open string of ADCIRC's file, which adds the tide up over its list of open nodes.

use std::collections::{BTreeMap, BTreeSet};

use glam::dvec2;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain};
use meshbrush_io::io::{fort14, gr3};

use super::{Case, Strand, cases, check, frame, read_grid, rectangle_with_land, rim, ring_of};

/// Returns how often each node is in the open strings of a file, read as ADCIRC does: line by line, numbers
/// first.
fn times_listed(text: &str) -> BTreeMap<usize, usize> {
    let mut lines = text.lines().skip(1);
    let mut numbers = || -> Vec<usize> {
        let line = lines.next().unwrap();
        line.split_whitespace().map_while(|word| word.parse().ok()).collect()
    };
    let counts = numbers();
    (0..counts[0] + counts[1]).for_each(|_| drop(numbers()));
    let (strings, all) = (numbers()[0], numbers()[0]);
    let mut times = BTreeMap::new();
    for _ in 0..strings {
        let length = numbers()[0];
        (0..length).for_each(|_| *times.entry(numbers()[0]).or_insert(0) += 1);
    }
    assert_eq!(times.values().sum::<usize>(), all);
    times
}

#[test]
fn each_open_node_is_in_one_open_string_of_adcirc() {
    for case in cases().into_iter().chain([frame(), three_sides(), rectangle_with_land(4.0, [1.0, 2.0])]) {
        let text = case.text(fort14::write);
        let times = times_listed(&text);
        assert!(times.values().all(|&times| times == 1), "{times:?}");
        let (seen, open, land) = read_grid(&text);
        check(&seen, &open, &land);
        // The same nodes are open in the file of SCHISM, but for inflows; those of two pieces twice.
        let of_schism: BTreeSet<usize> = times_listed(&case.text(gr3::write)).into_keys().collect();
        assert!(times.keys().all(|node| of_schism.contains(node)));
    }
}

#[test]
fn open_boundary_all_around_is_one_string_that_does_not_repeat_its_first_node() {
    let (seen, open, land) = read_grid(&frame().text(fort14::write));
    assert_eq!((open.len(), land.len()), (1, 0));
    assert_eq!(open[0].nodes.len(), rim(&seen.triangles).len());
    assert_eq!(open[0].name.split(", ").count(), 4, "{}", open[0].name);
    let (_, of_schism, _) = read_grid(&frame().text(gr3::write));
    assert_eq!(of_schism.len(), 4, "SCHISM takes pieces");
}

/// Returns a rectangle of which three sides are open; the names of two of them were given.
fn three_sides() -> Case {
    let rectangle = ring_of(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let domain = Domain::of_polygons(&[vec![rectangle]]).unwrap();
    let names = [([4.0, 1.5], "open ocean"), ([2.0, 3.0], "land coast"), ([2.0, 0.0], "Open shelf")];
    let names = names.map(|(place, name)| (place.into(), name.to_owned())).to_vec();
    let marks = BoundaryMarks { names, ..BoundaryMarks::default() };
    Case::new(&domain, &marks, 0.5, BoundaryTreatment::OnOutline { diameter: 0.5 })
}

#[test]
fn pieces_that_meet_are_one_string_with_their_names_and_land_begins_where_it_ends() {
    let (seen, open, land) = read_grid(&three_sides().text(fort14::write));
    let names = |strands: &[Strand]| strands.iter().map(|strand| strand.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&open), ["open west, Open shelf, open ocean"]);
    assert_eq!(names(&land), ["land coast"]);
    let ends = |strand: &Strand| [strand.nodes[0], strand.nodes[strand.nodes.len() - 1]];
    let [first, last] = ends(&open[0]);
    assert_eq!(ends(&land[0]), [last, first]);
    assert_eq!([first, last].map(|node| seen.nodes[node]), [dvec2(0.0, 3.0), dvec2(4.0, 3.0)]);
    // SCHISM has a string for each of them, in the same order.
    let (_, open, _) = read_grid(&three_sides().text(gr3::write));
    assert_eq!(names(&open), ["open west", "Open shelf", "open ocean"]);
}
