//! Rules of solvers on random seas: what `meshbrush check` counts, and what a repair leaves, against counts
//! from the files alone.

use std::collections::HashMap;
use std::f64::consts::TAU;

use serde_json::Value;

use crate::check::refused;
use crate::folder::Folder;
use crate::runs::{prints_table, seeds};

/// The strings of a file of ADCIRC.
struct Strings {
    open: Vec<Vec<usize>>,
    /// Those of land and islands, with their types.
    closed: Vec<(usize, Vec<usize>)>,
}

/// Returns a ring around a place, anticlockwise, whose radius is random within a part of `radius`.
fn blob(random: &mut fastrand::Rng, center: [f64; 2], radius: f64, corners: usize) -> String {
    let corner = |n: usize, random: &mut fastrand::Rng| {
        let (angle, length) = (TAU * n as f64 / corners as f64, radius * (0.55 + 0.45 * random.f64()));
        format!("[{:.2}, {:.2}]", center[0] + length * angle.cos(), center[1] + length * angle.sin())
    };
    let ring: Vec<String> = (0..corners).map(|n| corner(n, random)).collect();
    format!("[{}, {}]", ring.join(", "), ring[0])
}

/// Writes a sea with islands, and returns the options that mesh it with an open frame.
fn random_sea(folder: &Folder, seed: u64) -> String {
    let mut random = fastrand::Rng::with_seed(seed);
    let corners = random.usize(8..40);
    let mut rings = vec![blob(&mut random, [0.0, 0.0], 1000.0, corners)];
    for place in 0..random.usize(0..4) {
        let angle = TAU * place as f64 / 4.0;
        let center = [300.0 * angle.cos(), 300.0 * angle.sin()];
        let (radius, corners) = (20.0 + 100.0 * random.f64(), random.usize(3..14));
        rings.push(blob(&mut random, center, radius, corners));
    }
    folder.file("sea.geojson", format!(r#"{{"type": "Polygon", "coordinates": [{}]}}"#, rings.join(", ")));
    let [left, low, right, high] = [(); 4].map(|()| 250 + random.i32(0..800));
    let (spacing, size) = (random.i32(150..700), random.i32(40..400));
    let shore = random.i32(30..200);
    format!(
        "--region sea.geojson --bounds {},{},{right},{high} --open frame --spacing {spacing} --boundary-diameter {shore} \
         --target {size}+0.1*r",
        -left, -low
    )
}

/// Reads `fort.14`.
fn read_14(text: &str) -> Strings {
    let numbers = |line: &str| -> Vec<f64> {
        line.split('=').next().unwrap().split_whitespace().map_while(|word| word.parse().ok()).collect()
    };
    let mut lines = text.lines().skip(1).map(numbers);
    let counts = lines.next().unwrap();
    let (elements, nodes) = (counts[0] as usize, counts[1] as usize);
    lines.by_ref().take(nodes + elements).for_each(drop);
    let mut strings = || {
        let count = lines.next().unwrap()[0] as usize;
        lines.next();
        let mut all = Vec::new();
        for _ in 0..count {
            let head = lines.next().unwrap();
            let nodes = lines.by_ref().take(head[0] as usize).map(|row| row[0] as usize - 1).collect();
            all.push((head.get(1).map_or(0, |&kind| kind as usize), nodes));
        }
        all
    };
    let open = strings().into_iter().map(|(_, nodes)| nodes).collect();
    Strings { open, closed: strings() }
}

impl Strings {
    /// Returns for each rule how many places break it. The files of FVCOM have the triangles that it refuses
    /// and those without an inner node: an open node beside land of one edge is none there.
    fn counts(&self, [refused, shore]: [usize; 2]) -> HashMap<&'static str, usize> {
        let mut times: HashMap<usize, usize> = HashMap::new();
        self.open.iter().flatten().for_each(|&node| *times.entry(node).or_default() += 1);
        let islands = self.closed.iter().filter(|(kind, _)| [1, 11, 21].contains(kind));
        let strings = self.open.iter().chain(self.closed.iter().map(|(_, nodes)| nodes));
        HashMap::from([
            ("open_node_twice", times.values().filter(|&&times| times > 1).count()),
            ("boundary_of_two_nodes", strings.filter(|nodes| nodes.len() == 2).count()),
            ("two_open_nodes_and_shore", refused),
            ("overconstrained_triangle", shore),
            ("island_like_cell", islands.filter(|(_, nodes)| nodes.len() <= 6).count()),
        ])
    }
}

/// Meshes a sea with further options, and returns for each rule how many places break it by the files, beside
/// the answer of the command.
fn meshed(folder: &Folder, options: &str) -> Option<(HashMap<&'static str, usize>, Value)> {
    let ran = folder.run(format!("mesh {options} -o sea.14 -o sea.dat --json").as_str());
    if ran.status != 0 {
        // Nothing is left of the sea in its bounds, its boundary touches itself, or an open piece has one edge.
        let known = ["touches itself", "no edge would remain", "domain"];
        assert!(known.iter().any(|why| ran.err.contains(why)), "{options}: {}", ran.err);
        return None;
    }
    Some((read_14(&folder.read("sea.14")).counts(refused(folder, "sea")), ran.json()))
}

#[test]
fn places_are_counted_and_mended_as_the_files_have_them() {
    let folder = Folder::new("solver-seas");
    let [mut seas, mut broken, mut mended] = [0; 3];
    for seed in seeds(6) {
        let options = random_sea(&folder, seed);
        let Some((counts, _)) = meshed(&folder, &options) else { continue };
        assert_eq!(counts["open_node_twice"], 0, "{options}");
        seas += 1;
        for (solver, rules) in [
            ("adcirc", vec!["open_node_twice", "boundary_of_two_nodes"]),
            ("fvcom", vec!["two_open_nodes_and_shore"]),
            ("telemac", vec!["overconstrained_triangle"]),
            ("delft3dfm", vec!["island_like_cell"]),
        ] {
            let answer = folder.run(format!("check {options} --for {solver} --json").as_str()).json();
            let listed = |rule: &str| {
                let rows = answer["rules"].as_array().unwrap();
                rows.iter().find(|row| row["rule"] == rule).unwrap()["count"].as_u64().unwrap() as usize
            };
            let expected: usize = rules.iter().map(|rule| counts[rule]).sum();
            assert_eq!(rules.iter().map(|rule| listed(rule)).sum::<usize>(), expected, "{solver} {options}");
            let Some((after, summary)) = meshed(&folder, &format!("{options} --repair-for {solver}")) else {
                continue;
            };
            let left: usize = rules.iter().map(|rule| after[rule]).sum();
            let said = summary["repaired"]["left"].as_u64().unwrap() as usize;
            assert!(
                left <= said && left <= expected,
                "{solver} {options}: {left} of {expected}, {said} said"
            );
            broken += expected;
            mended += expected - left;
        }
    }
    if prints_table() {
        eprintln!("{seas} seas: {mended} of {broken} places mended");
    }
    assert!(seas > 2 && broken > 0 && 2 * mended > broken, "{mended} of {broken} in {seas} seas");
}
