//! Triangles across straits, counted along crossings that know nothing of how the straits were found.

use std::f64::consts::TAU;

use crate::folder::Folder;
use crate::runs::seeds;

type Point = [f64; 2];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(a: Point) -> f64 {
    a[0].hypot(a[1])
}

fn between(a: Point, b: Point, share: f64) -> Point {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

/// A rough ring around a place.
fn ring(random: &mut fastrand::Rng, at: Point, size: f64, corners: u32) -> Vec<Point> {
    let (phase, waves) = (TAU * random.f64(), f64::from(random.u32(2..5)));
    let corner = |n: u32| {
        let angle = TAU * f64::from(n) / f64::from(corners);
        let radius = size * (0.75 + 0.2 * (waves * angle + phase).sin() + 0.05 * (17.0 * angle).cos());
        [at[0] + radius * angle.cos(), at[1] + radius * angle.sin()]
    };
    (0..corners).map(corner).collect()
}

fn is_inside(at: Point, rings: &[Vec<Point>]) -> bool {
    let mut inside = false;
    for ring in rings {
        for n in 0..ring.len() {
            let (a, b) = (ring[n], ring[(n + 1) % ring.len()]);
            if (a[1] > at[1]) != (b[1] > at[1])
                && at[0] < a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            {
                inside = !inside;
            }
        }
    }
    inside
}

fn nearest_on(ring: &[Point], at: Point) -> Point {
    let on = |n: usize| {
        let (a, b) = (ring[n], ring[(n + 1) % ring.len()]);
        let along = sub(b, a);
        let share =
            (sub(at, a)[0] * along[0] + sub(at, a)[1] * along[1]) / (along[0].powi(2) + along[1].powi(2));
        between(a, b, share.clamp(0.0, 1.0))
    };
    let distance = |point: &Point| length(sub(*point, at));
    (0..ring.len()).map(on).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
}

/// Returns how many triangles have a part of a segment in them.
fn crossed(nodes: &[Point], triangles: &[[usize; 3]], from: Point, to: Point) -> usize {
    let along = sub(to, from);
    let is_crossed = |triangle: &&[usize; 3]| {
        let corners = triangle.map(|node| nodes[node]);
        // The segment crosses the interior: an interval of it is on the inner side of all three sides.
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for n in 0..3 {
            let (a, b) = (corners[n], corners[(n + 1) % 3]);
            let (start, change) = (cross(sub(b, a), sub(from, a)), cross(sub(b, a), along));
            if change > 0.0 {
                low = low.max(-start / change);
            } else if change < 0.0 {
                high = high.min(-start / change);
            } else if start <= 0.0 {
                return false;
            }
        }
        high - low > 1e-9
    };
    triangles.iter().filter(is_crossed).count()
}

fn mesh_in(folder: &Folder) -> (Vec<Point>, Vec<[usize; 3]>) {
    let rows = |ending: &str| -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let text = folder.read(&format!("m.{ending}"));
        text.lines().skip(1).filter(|line| !line.starts_with('#')).map(numbers).collect()
    };
    let nodes = rows("node").iter().map(|row| [row[1], row[2]]).collect();
    let corners = |row: &Vec<f64>| [1, 2, 3].map(|n| row[n] as usize - 1);
    (nodes, rows("ele").iter().map(corners).collect())
}

#[test]
fn every_crossing_of_random_coasts_has_enough_triangles() {
    // A mesh can end short of the coast by a triangle: the layer of straits asks for one more itself.
    for (folder, options) in
        [("straits", "--straits 4 --widest-strait 4"), ("features", "--feature-size 5 --widest-feature 4")]
    {
        crossings_have_enough(&Folder::new(folder), options);
    }
}

fn crossings_have_enough(folder: &Folder, options: &str) {
    let (across, h_min) = (4, 0.02);
    let (mut crossings, mut fewest) = (0, usize::MAX);
    for seed in seeds(3) {
        let mut random = fastrand::Rng::with_seed(seed);
        let outer = ring(&mut random, [0.0, 0.0], 10.0, 160);
        let mut rings = vec![outer];
        for n in 0..7 {
            let angle = f64::from(n) + random.f64();
            let distance = 1.0 + 6.0 * random.f64();
            let size = 0.3 + 1.2 * random.f64();
            let island = ring(&mut random, [distance * angle.cos(), distance * angle.sin()], size, 40);
            let is_free = island.iter().all(|&at| is_inside(at, &rings))
                && rings[1..].iter().flatten().all(|&at| !is_inside(at, std::slice::from_ref(&island)));
            if is_free {
                rings.push(island.into_iter().rev().collect());
            }
        }
        let closed: Vec<Vec<Point>> =
            rings.iter().map(|ring| ring.iter().chain(&ring[..1]).copied().collect()).collect();
        let text = serde_json::json!({ "type": "Polygon", "coordinates": closed }).to_string();
        folder.file("coast.geojson", text);
        let command = format!(
            "--region coast.geojson --spacing 4 --boundary-diameter 2 --h-min {h_min} --h-max 4 {options} \
             -o m.node"
        );
        let summary = folder.json("mesh", command);
        // Only where an island almost touches another coast, --h-min leaves fewer triangles.
        for place in summary["straits"]["places"].as_array().into_iter().flatten() {
            let width = place["width"].as_f64().unwrap();
            assert!(width < f64::from(across) * h_min, "seed {seed}: {place}");
        }
        assert!(summary["straits"]["crossings"].as_u64().is_none_or(|count| count > 50));
        let (nodes, triangles) = mesh_in(folder);
        for _ in 0..300 {
            let (own, other) = (random.usize(..rings.len()), random.usize(..rings.len()));
            if own == other {
                continue;
            }
            let n = random.usize(..rings[own].len());
            let from = between(rings[own][n], rings[own][(n + 1) % rings[own].len()], random.f64());
            let to = nearest_on(&rings[other], from);
            let width = length(sub(to, from));
            let is_water = (1..100).all(|n| is_inside(between(from, to, f64::from(n) / 100.0), &rings));
            if !is_water || width > 3.5 || width < f64::from(across) * h_min {
                continue;
            }
            let count = crossed(&nodes, &triangles, from, to);
            assert!(
                count >= across as usize,
                "{options}, seed {seed}: {count} triangles from {from:?} to {to:?}"
            );
            (crossings, fewest) = (crossings + 1, fewest.min(count));
        }
    }
    assert!(crossings > 100, "{crossings}");
    eprintln!("{crossings} crossings, at least {fewest} triangles");
}

#[test]
fn straits_that_are_too_narrow_are_listed() {
    let folder = Folder::new("straits-narrow");
    // Two basins with a channel of 0.1 between them.
    let ring = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 1.95],
        [6.0, 1.95],
        [6.0, 0.0],
        [10.0, 0.0],
        [10.0, 4.0],
        [6.0, 4.0],
        [6.0, 2.05],
        [4.0, 2.05],
        [4.0, 4.0],
        [0.0, 4.0],
        [0.0, 0.0],
    ];
    folder
        .file("basins.geojson", serde_json::json!({ "type": "Polygon", "coordinates": [ring] }).to_string());
    let mesh = |h_min: f64| {
        let input = "--region basins.geojson --spacing 1 --boundary-diameter 0.5 --h-max 1 --straits 4";
        folder.json("mesh", format!("{input} --h-min {h_min}"))
    };
    let fine = mesh(0.01);
    assert_eq!(fine["straits"]["below"], 0, "{}", fine["straits"]);
    let coarse = mesh(0.4);
    let places = coarse["straits"]["places"].as_array().unwrap();
    assert!(!places.is_empty(), "{}", coarse["straits"]);
    let width = |place: &serde_json::Value| place["width"].as_f64().unwrap();
    assert!((width(&places[0]) - 0.1).abs() < 1e-3, "the narrowest first: {}", places[0]);
    for place in places {
        // Five triangles of the least diameter fill wider ones. The channel is between 4 and 6.
        let from_channel = (place["at"][0].as_f64().unwrap() - 5.0).abs() - 1.0;
        assert!(width(place) < 5.0 * 0.4 && from_channel < width(place), "{place}");
        assert!(place["triangles"].as_u64().unwrap() < 4);
    }
    let narrowest = &coarse["straits"]["narrowest"];
    assert!(
        (width(narrowest) - 0.1).abs() < 1e-3 && narrowest["triangles"].as_u64().unwrap() < 4,
        "{narrowest}"
    );
    let [x, y] = [0, 1].map(|n| narrowest["at"][n].as_f64().unwrap());
    assert!((4.0..=6.0).contains(&x) && (y - 2.0).abs() < 0.01, "{narrowest}");
    for (h_min, sentence) in [("0.01", None), ("0.4", Some("The narrowest strait is 0.1 wide, at x = "))] {
        let input = "--region basins.geojson --spacing 1 --boundary-diameter 0.5 --h-max 1 --straits 4";
        let ran = folder.run(format!("mesh {input} --h-min {h_min}"));
        let said = ran
            .err
            .contains("have fewer than 4 triangles across: the smallest target diameter, 0.4, is kept");
        assert_eq!((ran.status, said), (0, sentence.is_some()), "{}", ran.err);
        assert!(sentence.is_none_or(|sentence| ran.err.contains(sentence)), "{}", ran.err);
    }
    for (options, sentence) in [
        ("--straits 4 --region basins.geojson", "--h-min <LENGTH>"),
        ("--straits 4 --region basins.geojson --h-min 0.1", "--widest-strait, or --h-max"),
        ("--feature-size 4 --region basins.geojson --h-min 0.1", "--widest-feature, or --h-max"),
        ("--feature-size 4 --widest-feature 0.1 --region basins.geojson --h-min 0.1", "--widest-feature 0.1"),
        ("--straits 0.5 --region basins.geojson --h-min 0.1 --h-max 1", "--straits 0.5"),
    ] {
        let ran = folder.run(format!("mesh {options}"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
}

/// A coast with two narrow places, of which one is open: its piece asks for no triangles, by name or by type.
#[test]
fn straits_are_not_looked_for_along_pieces_that_a_person_opened() {
    let folder = Folder::new("straits-open");
    let ring = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
    let island = |x: f64, y: f64| [[x, y], [x, y + 2.0], [x + 2.0, y + 2.0], [x + 2.0, y], [x, y]];
    let rings = serde_json::json!([ring, island(2.0, 4.0), island(4.2, 4.0), island(6.5, 4.0)]);
    let text = serde_json::json!({ "type": "Polygon", "coordinates": rings }).to_string();
    folder.file("islands.geojson", text);
    let narrowest = |domain: &str| {
        let recipe = format!(
            "[domain]\nregion = \"islands.geojson\"\nboundary_diameter = 0.5\n{domain}\n[mesh]\nspacing = 1\n\
             [limits]\nh_min = 0.05\nh_max = 1\n[[layer]]\nkind = \"straits\"\nacross = 3\nwidth_from = 0.01\n\
             width_to = 1\n"
        );
        folder.file("sea.toml", recipe);
        folder.json("mesh", "sea.toml".to_owned())["straits"]["narrowest"].clone()
    };
    let width = |place: &serde_json::Value| place["width"].as_f64().unwrap();
    assert!((width(&narrowest("")) - 0.2).abs() < 1e-6);
    for opened in
        ["types = [{ at = [2, 5], type = \"open\" }]", "names = [{ at = [2, 5], name = \"open west\" }]"]
    {
        let place = narrowest(opened);
        assert!((width(&place) - 0.3).abs() < 1e-6, "{opened}: {place}");
    }
}
