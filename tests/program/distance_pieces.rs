//! Distances to pieces of the boundary by name and by type, against distances computed here.

use crate::folder::Folder;

/// The southwestern and the northeastern corner of two islands, the one with the longer coast first.
const ROCKS: [[[f64; 2]; 2]; 2] = [[[2.0, 4.0], [3.0, 6.0]], [[6.0, 3.0], [7.5, 4.0]]];

/// Returns the corners of a rectangle.
fn ring([[west, south], [east, north]]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    vec![[west, south], [east, south], [east, north], [west, north], [west, south]]
}

/// Returns the distance of a point outside a rectangle from it.
fn from_rock([low, high]: [[f64; 2]; 2], at: [f64; 2]) -> f64 {
    let beyond = |axis: usize| (low[axis] - at[axis]).max(at[axis] - high[axis]).max(0.0);
    beyond(0).hypot(beyond(1))
}

/// Returns the distance of a point of the domain from its frame.
fn from_frame(at: [f64; 2]) -> f64 {
    at.into_iter().map(|coordinate| coordinate.min(10.0 - coordinate)).fold(f64::MAX, f64::min)
}

#[test]
fn distances_to_pieces_are_measured_to_the_named_ones_and_those_of_the_types() {
    let folder = Folder::new("distance-pieces");
    let rings = [ring([[0.0, 0.0], [10.0, 10.0]]), ring(ROCKS[0]), ring(ROCKS[1])];
    let sea = serde_json::json!({ "type": "Polygon", "coordinates": rings });
    folder.file("sea.geojson", sea.to_string());
    let growth = "--distance-at-zero 0.1 --distance-slope 0.25 --distance-range 3";
    // The h̄ of each node that the file names.
    let nodes = |options: &str| -> Vec<([f64; 2], f64)> {
        folder.json(
            "mesh",
            format!("--region sea.geojson --spacing 1 --h-max 1.2 {growth} {options} -o m.node"),
        );
        let text = folder.read("m.node");
        let rows = text.lines().skip(1).filter(|line| !line.starts_with('#')).map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            ([numbers[1], numbers[2]], numbers[3])
        });
        rows.collect()
    };
    let first = |at| from_rock(ROCKS[0], at);
    let second = |at| from_rock(ROCKS[1], at);
    type Distance<'a> = Box<dyn Fn([f64; 2]) -> f64 + 'a>;
    let cases: [(&str, Distance); 6] = [
        ("--distance-to-piece 'island 1'", Box::new(first)),
        ("--distance-to-piece 'island 2'", Box::new(second)),
        (
            "--distance-to-piece 'island 1' --distance-to-piece 'island 2'",
            Box::new(|at| first(at).min(second(at))),
        ),
        ("--distance-to-type land", Box::new(|at| first(at).min(second(at)))),
        ("--distance-to-type open", Box::new(from_frame)),
        (
            "--distance-to-piece 'island 2' --distance-to-type open",
            Box::new(|at| second(at).min(from_frame(at))),
        ),
    ];
    for (options, distance) in &cases {
        let nodes = nodes(options);
        assert!(nodes.len() > 500, "{options}: {} nodes", nodes.len());
        for &(at, found) in &nodes {
            let distance = distance(at);
            let expected = if distance < 3.0 { (0.1 + 0.25 * distance).min(1.2) } else { 1.2 };
            // Where the layer ends, a node may count as just within.
            let is_at_end = (distance - 3.0).abs() < 1e-3;
            assert!(
                is_at_end || (found - expected).abs() < 1e-3,
                "{options} at {at:?}: {found}, not {expected}"
            );
        }
    }
    for (options, sentence) in [
        ("--distance-to-type ocean", "--distance-to-type ocean: the types are open, land,"),
        ("--distance-to-piece 'island 9'", "island 9"),
    ] {
        let ran =
            folder.run(format!("mesh --region sea.geojson --spacing 1 --distance-at-zero 0.1 {options}"));
        assert!(ran.err.contains(sentence), "{options}: {}", ran.err);
    }
}
