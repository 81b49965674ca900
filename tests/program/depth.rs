//! Sizes from depths, and depths at nodes, against an evaluation of their own of the formulas.

use std::f64::consts::TAU;

use crate::earth::on_the_ellipsoid;
use crate::folder::Folder;

const COLUMNS: usize = 160;
const ROWS: usize = 100;
/// Side of a pixel, in metres.
const PIXEL: f64 = 500.0;
const G: f64 = 9.81;

/// Heights of a bay with a bank and an island, in metres, by row from the south.
struct Bay(Vec<Vec<f64>>);

impl Bay {
    fn new() -> Self {
        let height = |column: usize, row: usize| {
            let (x, y) = (column as f64 / COLUMNS as f64, row as f64 / ROWS as f64);
            let shelf = -5.0 - 900.0 * x * x;
            let bank = 300.0 * (-60.0 * ((x - 0.7).powi(2) + (y - 0.4).powi(2))).exp();
            let island = 90.0 * (-250.0 * ((x - 0.3).powi(2) + (y - 0.6).powi(2))).exp();
            // As a file has it: with three decimals.
            (1000.0 * (shelf + bank + island + 3.0 * (40.0 * y).sin())).round() / 1000.0
        };
        Self((0..ROWS).map(|row| (0..COLUMNS).map(|column| height(column, row)).collect()).collect())
    }

    /// The text of a grid, in which some pixels have no value.
    fn grid(&self, has_value: impl Fn(usize, usize) -> bool) -> String {
        let mut text = format!("ncols {COLUMNS}\nnrows {ROWS}\nxllcorner 0\nyllcorner 0\ncellsize {PIXEL}\n");
        text += "NODATA_value -32768\n";
        for (row, heights) in self.0.iter().enumerate().rev() {
            let shown = |(column, height): (usize, &f64)| match has_value(column, row) {
                true => height.to_string(),
                false => "-32768".to_owned(),
            };
            text += &heights.iter().enumerate().map(shown).collect::<Vec<_>>().join(" ");
            text.push('\n');
        }
        text
    }

    fn depth(&self, column: usize, row: usize) -> f64 {
        -self.0[row][column]
    }

    /// The slope by the neighbours on both sides, or on one at the edges.
    fn steepness(&self, column: usize, row: usize) -> f64 {
        let (west, east) = (column.saturating_sub(1), (column + 1).min(COLUMNS - 1));
        let (south, north) = (row.saturating_sub(1), (row + 1).min(ROWS - 1));
        let along_x = (self.depth(east, row) - self.depth(west, row)) / ((east - west) as f64 * PIXEL);
        let along_y =
            (self.depth(column, north) - self.depth(column, south)) / ((north - south) as f64 * PIXEL);
        along_x.hypot(along_y)
    }
}

/// The length of a wave, by halving an interval of its wave number.
fn wavelength(period: f64, depth: f64) -> f64 {
    let (mut low, mut high) = (1e-12, 1e6);
    let omega = TAU / period;
    for _ in 0..200 {
        let middle = f64::sqrt(low * high);
        if G * middle * (middle * depth).tanh() < omega * omega { low = middle } else { high = middle }
    }
    TAU / low
}

/// Nodes and triangles of an ADCIRC file, with the depths of the nodes.
fn fort14(text: &str) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let mut lines = text.lines().skip(1);
    let numbers =
        |line: &str| -> Vec<f64> { line.split_whitespace().map_while(|word| word.parse().ok()).collect() };
    let counts = numbers(lines.next().unwrap());
    let node = |line: &str| [1, 2, 3].map(|n| numbers(line)[n]);
    let nodes = lines.by_ref().take(counts[1] as usize).map(node).collect();
    let triangle = |line: &str| [2, 3, 4].map(|n| numbers(line)[n] as usize - 1);
    let triangles = lines.take(counts[0] as usize).map(triangle).collect();
    (nodes, triangles)
}

/// Returns the pixels whose centres are in a triangle, with the weights of its corners there.
fn pixels_in(corners: [[f64; 3]; 3]) -> Vec<(usize, usize, [f64; 3])> {
    let range = |axis: usize, most: usize| {
        let least = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
        let greatest = corners.iter().map(|corner| corner[axis]).fold(0.0, f64::max);
        let bound = |at: f64| ((at / PIXEL) as usize).min(most - 1);
        bound(least)..bound(greatest) + 1
    };
    let cross =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let [a, b, c] = corners.map(|corner| [corner[0], corner[1]]);
    let mut found = Vec::new();
    for row in range(1, ROWS) {
        for column in range(0, COLUMNS) {
            let at = [(column as f64 + 0.5) * PIXEL, (row as f64 + 0.5) * PIXEL];
            let whole = cross(a, b, c);
            let weights = [cross(b, c, at), cross(c, a, at), cross(a, b, at)].map(|part| part / whole);
            if weights.iter().all(|&weight| weight >= 0.0) {
                found.push((column, row, weights));
            }
        }
    }
    found
}

const DOMAIN: &str = "--domain 0,0,80000,50000 --spacing 10000 --h-min 300";

/// What a size of every pixel asks for.
type Asked = Box<dyn Fn(&Bay, usize, usize) -> f64>;

#[test]
fn triangles_are_as_small_as_the_formulas_ask_for_and_no_smaller() {
    let folder = Folder::new("depth-sizes");
    let bay = Bay::new();
    folder.file("bay.asc", bay.grid(|_, _| true));
    let wet = |depth: f64, size: f64| if depth > 0.0 { size } else { f64::INFINITY };
    let cases: [(&str, Asked); 4] = [
        (
            "--per-wavelength 12 --period 300",
            Box::new(move |bay, x, y| {
                let depth = bay.depth(x, y);
                wet(depth, wavelength(300.0, depth.max(1.0)) / 12.0)
            }),
        ),
        (
            "--per-slope 8",
            Box::new(move |bay, x, y| {
                let depth = bay.depth(x, y);
                wet(depth, TAU / 8.0 * depth.max(1.0) / bay.steepness(x, y))
            }),
        ),
        (
            "--min-courant 0.4 --time-step 40",
            Box::new(move |bay, x, y| {
                let depth = bay.depth(x, y).max(1.0);
                wet(bay.depth(x, y), ((G * depth).sqrt() + (G / depth).sqrt()) * 40.0 / 0.4)
            }),
        ),
        (
            "--target if(depth>0,400+4*depth+0.01*x,inf)",
            Box::new(move |bay, x, y| {
                let east = (x as f64 + 0.5) * PIXEL;
                wet(bay.depth(x, y), 400.0 + 4.0 * bay.depth(x, y) + 0.01 * east)
            }),
        ),
    ];
    for (options, asked) in cases {
        let ran = folder.run(format!("mesh {DOMAIN} --depth bay.asc {options} -o m.14"));
        assert_eq!(ran.status, 0, "{}", ran.err);
        let (nodes, triangles) = fort14(&folder.read("m.14"));
        let (mut checked, mut slack) = (0, Vec::new());
        for triangle in &triangles {
            let corners = triangle.map(|node| nodes[node]);
            let side =
                |a: usize, b: usize| (corners[a][0] - corners[b][0]).hypot(corners[a][1] - corners[b][1]);
            let diameter = side(0, 1).max(side(1, 2)).max(side(2, 0));
            let asked = pixels_in(corners).into_iter().map(|(x, y, _)| asked(&bay, x, y).max(300.0));
            let Some(least) = asked.reduce(f64::min) else { continue };
            // The pixels hold single precision.
            assert!(diameter <= least * (1.0 + 1e-6), "{options}: {diameter} m of {least} m at {corners:?}");
            checked += 1;
            if least < 10_000.0 {
                slack.push(diameter / least);
            }
        }
        slack.sort_by(f64::total_cmp);
        assert!(checked > 500 && slack.len() > 200, "{options}: {checked}, {}", slack.len());
        // A triangle is larger than half of its target unless it was forced, or a pixel beside it decides.
        let median = slack[slack.len() / 2];
        assert!(median > 0.5, "{options}: {median} of the target in the median");
    }
}

#[test]
fn the_largest_courant_number_is_a_floor_for_all_other_sizes() {
    let folder = Folder::new("depth-floor");
    let bay = Bay::new();
    folder.file("bay.asc", bay.grid(|_, _| true));
    let mesh =
        |options: &str| folder.json("mesh", format!("{DOMAIN} --depth bay.asc --target 800 {options}"));
    let (plain, floored) = (mesh(""), mesh("--max-courant 0.5 --time-step 20"));
    let triangles = |summary: &serde_json::Value| summary["triangles"].as_u64().unwrap();
    assert!(triangles(&floored) < triangles(&plain) / 2, "{floored}");
    assert!(plain["courant"].is_null());
    for (options, sentence) in [
        ("--max-courant 0.5", "--time-step <SECONDS>"),
        ("--max-courant 0 --time-step 2", "--max-courant"),
        ("--per-wavelength 5 --period -1", "--per-wavelength"),
        ("--risk depth/100", "only target diameters have depths"),
    ] {
        let ran = folder.run(format!("mesh {DOMAIN} --depth bay.asc {options}"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
}

/// The Courant numbers of all edges of a file, at the mean depth of their ends.
fn courant_numbers(text: &str, time_step: f64) -> Vec<f64> {
    let (nodes, triangles) = fort14(text);
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let edges: std::collections::BTreeSet<[usize; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    let number = |[a, b]: [usize; 2]| {
        let ([ax, ay, a_deep], [bx, by, b_deep]) = (nodes[a], nodes[b]);
        let depth = (0.5 * (a_deep + b_deep)).max(1.0);
        let speed = (G * depth).sqrt() + (G / depth).sqrt();
        (a_deep > 0.0 || b_deep > 0.0).then(|| speed * time_step / (ax - bx).hypot(ay - by))
    };
    edges.into_iter().filter_map(number).collect()
}

/// Along edges, because solvers check edges. On a flat bottom nothing but the floor decides; on a slope the
/// floor changes within a triangle, and on a disc, nodes on the outline make shorter edges: these are counted.
#[test]
fn edges_keep_the_largest_courant_number_or_are_counted() {
    let folder = Folder::new("depth-courant");
    let head = "ncols 101\nnrows 101\nxllcorner -50\nyllcorner -50\ncellsize 100\n";
    folder.file("flat.asc", head.to_owned() + &"-40 ".repeat(101 * 101));
    let rows = (0..101).map(|_| (0..101).map(|x| format!("{:.2}", -5.0 - 0.95 * f64::from(x))));
    let rows: Vec<String> = rows.map(|row| row.collect::<Vec<_>>().join(" ")).collect();
    folder.file("slope.asc", head.to_owned() + &rows.join("\n"));
    folder.file("bay.asc", Bay::new().grid(|_, _| true));
    let corner = |n: i32| {
        let (sine, cosine) = (f64::from(n) * TAU / 90.0).sin_cos();
        format!("[{}, {}]", 5000.0 + 4500.0 * cosine, 5000.0 + 4500.0 * sine)
    };
    let ring: Vec<String> = (0..=90).map(corner).collect();
    folder
        .file("disc.geojson", format!("{{\"type\": \"Polygon\", \"coordinates\": [[{}]]}}", ring.join(", ")));
    let [flat, slope] = ["flat.asc", "slope.asc"]
        .map(|depths| format!("--domain 0,0,10000,10000 --spacing 2000 --depth {depths} --target 10"));
    let disc = "--region disc.geojson --spacing 2000 --boundary-diameter 2000 --depth slope.asc --target 10";
    let bay = format!("{DOMAIN} --depth bay.asc --target 300");
    let cases = [(&*flat, 1.0), (&slope, 1.1), (disc, f64::INFINITY), (&bay, f64::INFINITY)];
    for (domain, most) in cases {
        for (limit, time_step) in [(1.0, 5.0), (0.5, 5.0), (0.7, 10.0)] {
            let ran = folder
                .run(format!("mesh {domain} --max-courant {limit} --time-step {time_step} -o out.14 --json"));
            let summary: serde_json::Value = serde_json::from_str(&ran.out).unwrap();
            let numbers = courant_numbers(&folder.read("out.14"), time_step);
            // Coordinates in files are rounded.
            let above = |share: f64| numbers.iter().filter(|&&number| number > share * limit).count() as u64;
            let counted = summary["courant"]["above"].as_u64().unwrap();
            assert!((above(1.0 + 1e-6)..=above(1.0 - 1e-6)).contains(&counted), "{domain}: {summary}");
            assert_eq!(summary["courant"]["edges"], numbers.len());
            let largest = numbers.iter().fold(0.0, |a: f64, b| a.max(*b));
            let said = summary["courant"]["largest"].as_f64().unwrap();
            assert!((said / largest - 1.0).abs() < 1e-6, "{said} and {largest}");
            // The largest stable time step is the one with which the largest Courant number is 1.
            let stable = summary["largest_time_step"]["seconds"].as_f64().unwrap();
            assert!((stable * largest / time_step - 1.0).abs() < 1e-6, "{stable} and {largest}");
            assert_eq!(summary["quality"]["time_step"]["least"]["value"].as_f64(), Some(stable));
            assert_eq!(counted > 0, ran.err.contains("edges have a Courant number above"), "{}", ran.err);
            assert!(largest <= most * limit * (1.0 + 1e-6), "{domain}: {}", ran.err);
            assert!(most > 1.0 || counted == 0, "{domain}: {}", ran.err);
            // The floor is no higher than needed: the longest edges are within a factor of it.
            let median = {
                let mut sorted = numbers.clone();
                sorted.sort_by(f64::total_cmp);
                sorted[sorted.len() / 2]
            };
            assert!(median > 0.35 * limit, "{domain}: {median}");
        }
    }
}

#[test]
fn the_domain_is_the_water_of_a_grid() {
    let folder = Folder::new("depth-domain");
    let bay = Bay::new();
    folder.file("bay.asc", bay.grid(|column, row| column < 150 || row > 20));
    folder.file("bay.geojson", r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}"#);
    let boundary = "--spacing 10000 --boundary-diameter 400 --target 4000";
    let summary = folder.json("mesh", format!("--region bay.asc --contour 20 {boundary} -o m.14"));
    let (nodes, triangles) = fort14(&folder.read("m.14"));
    let area: f64 = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|node| nodes[node]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        })
        .sum();
    let is_water = |column: usize, row: usize| (column < 150 || row > 20) && bay.depth(column, row) > 20.0;
    let pixels = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
    let deep = pixels.filter(|&(column, row)| is_water(column, row)).count();
    let expected = deep as f64 * PIXEL * PIXEL;
    assert!((area / expected - 1.0).abs() < 0.01, "{area} of {expected}: {summary}");
    // A node on the coast is where the depth between the centres of pixels is that of the contour.
    let names = |options: &str| {
        let ran = folder.run(format!("mesh --region bay.asc {options} {boundary} -o m.msh"));
        assert_eq!(ran.status, 0, "{}", ran.err);
        let text = folder.read("m.msh");
        let islands = text.lines().filter(|line| line.contains("\"island ")).count();
        (text.contains("\"open east\""), islands)
    };
    let (is_open, islands) = names("--contour 20");
    assert!(is_open && islands > 0, "{islands}");
    assert_eq!(names("--contour 20 --smallest-island 1e9").1, 0, "islands are left out");
    for (options, sentence) in [
        ("--region bay.asc --contour 5000", "bay.asc: no pixel is deeper than 5000 m"),
        ("--region bay.asc --contour 20 --depth-positive down", "no pixel is deeper than 20 m"),
        ("--region bay.geojson --contour 20", "--contour: this is for a region that is a grid"),
        ("--region bay.asc --smallest-inlet -1", "--smallest-inlet: The smallest inlet is -1"),
    ] {
        let ran = folder.run(format!("mesh {options}"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
    // A recipe says the same.
    folder.file(
        "a.toml",
        "[domain]\nregion = \"bay.asc\"\ncontour = 20\nsmallest_inlet = 3000\nboundary_diameter = 400\n\
         [mesh]\nspacing = 10000\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"4000\"\n",
    );
    let by_recipe = folder.json("mesh", "a.toml".to_owned());
    let by_options =
        folder.json("mesh", format!("--region bay.asc --contour 20 --smallest-inlet 3000 {boundary}"));
    assert_eq!(by_recipe["hash"], by_options["hash"]);
    assert_ne!(by_recipe["hash"], summary["hash"], "inlets are closed");
}

#[test]
fn a_formula_of_the_depth_needs_depths() {
    let folder = Folder::new("depth-formula");
    let ran = folder.run(format!("mesh {DOMAIN} --target 400+depth"));
    assert_eq!(ran.status, 2);
    assert!(ran.err.contains("--target: it uses `depth`, and there are no depths."), "{}", ran.err);
    let recipe = "[domain]\nbounds = [0, 0, 9, 9]\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\n\
                  formula = \"1 + depth\"\n";
    folder.file("a.toml", recipe);
    let ran = folder.run("mesh a.toml".to_owned());
    assert!(ran.status != 0 && ran.err.contains("a.toml, line 6, column 11: it uses"), "{}", ran.err);
}

#[test]
fn nodes_have_the_depths_of_the_grid_and_the_differences_are_those_that_are_printed() {
    let folder = Folder::new("depth-nodes");
    let bay = Bay::new();
    let is_known = |column: usize, row: usize| column >= 6 || row >= 9;
    folder.file("bay.asc", bay.grid(is_known));
    for target in [1200.0, 7000.0] {
        let command = format!("{DOMAIN} --depth bay.asc --target {target} -o m.14 -o m.msh");
        let summary = folder.json("mesh", command);
        let (nodes, triangles) = fort14(&folder.read("m.14"));
        let found = &summary["depth"];
        let mut sides = vec![(0.0, 0.0); nodes.len()];
        for triangle in &triangles {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let [from, to] = [triangle[a], triangle[b]];
                let length = (nodes[from][0] - nodes[to][0]).hypot(nodes[from][1] - nodes[to][1]);
                [from, to].into_iter().for_each(|n| sides[n] = (sides[n].0 + length, sides[n].1 + 1.0));
            }
        }
        let mut filled = 0;
        for (&[x, y, depth], (sum, count)) in nodes.iter().zip(&sides) {
            let pixel = |at: f64, most: usize| ((at / PIXEL) as usize).min(most - 1);
            let (column, row) = (pixel(x, COLUMNS), pixel(y, ROWS));
            if !is_known(column, row) {
                filled += 1;
                continue;
            }
            let side = sum / count;
            let expected = if side < 4.0 * PIXEL {
                linear(&bay, [x, y], is_known)
            } else {
                mean(&bay, [x, y], 0.5 * side, is_known)
            };
            assert!((depth - expected).abs() < 1e-3, "{depth} m for {expected} m at {x}, {y}");
        }
        assert!(filled > 0 && found["filled_nodes"] == filled, "{filled}: {found}");
        let (mut largest, mut squares, mut sum, mut count) = (0.0_f64, 0.0, 0.0, 0.0);
        let mut seen = std::collections::BTreeSet::new();
        for triangle in &triangles {
            let corners = triangle.map(|node| nodes[node]);
            for (x, y, weights) in pixels_in(corners) {
                if !is_known(x, y) || !seen.insert((x, y)) {
                    continue;
                }
                let mesh: f64 = (0..3).map(|n| weights[n] * corners[n][2]).sum();
                let off = mesh - bay.depth(x, y);
                (largest, squares, sum, count) =
                    (largest.max(off.abs()), squares + off * off, sum + off, count + 1.0);
            }
        }
        assert_eq!(found["pixels"].as_f64(), Some(count));
        let close = |key: &str, expected: f64| {
            let value = found[key].as_f64().unwrap();
            assert!((value - expected).abs() < 1e-3, "{key}: {value} for {expected}");
        };
        close("largest_error", largest);
        close("rms_error", f64::sqrt(squares / count));
        close("mean_error", sum / count);
    }
    assert!(folder.read("m.msh").contains("\"depth\""));
}

/// The value between the centres of pixels.
fn linear(bay: &Bay, [x, y]: [f64; 2], is_known: impl Fn(usize, usize) -> bool) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    let from = [x / PIXEL - 0.5, y / PIXEL - 0.5];
    for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let [column, row] = [from[0].floor() + dx, from[1].floor() + dy];
        let weight = (1.0 - (from[0] - column).abs()) * (1.0 - (from[1] - row).abs());
        let is_within = column >= 0.0 && row >= 0.0 && column < COLUMNS as f64 && row < ROWS as f64;
        if is_within && is_known(column as usize, row as usize) {
            sum += weight * bay.depth(column as usize, row as usize);
            weights += weight;
        }
    }
    sum / weights
}

/// The mean of the pixels whose centres are in a square.
fn mean(bay: &Bay, [x, y]: [f64; 2], half: f64, is_known: impl Fn(usize, usize) -> bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let center = [(column as f64 + 0.5) * PIXEL, (row as f64 + 0.5) * PIXEL];
            let is_within = (center[0] - x).abs() <= half && (center[1] - y).abs() <= half;
            if is_within && is_known(column, row) {
                sum += bay.depth(column, row);
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn the_first_grid_with_a_value_counts_and_nodes_without_any_are_refused() {
    let folder = Folder::new("depth-stack");
    let flat = |depth: f64, west: f64, size: usize| {
        let header = format!("ncols {size}\nnrows {size}\nxllcorner {west}\nyllcorner 0\ncellsize 100\n");
        header + &format!("{depth} ").repeat(size * size) + "\n"
    };
    folder.file("survey.asc", flat(-3.0, 1000.0, 10));
    folder.file("chart.asc", flat(-50.0, 0.0, 40));
    folder.file("down.asc", flat(50.0, 0.0, 40));
    let mesh = "mesh --domain 0,0,4000,4000 --spacing 500 -o m.14";
    assert_eq!(folder.run(format!("{mesh} --depth survey.asc --depth chart.asc")).status, 0);
    let (nodes, _) = fort14(&folder.read("m.14"));
    for [x, y, depth] in nodes {
        let is_surveyed = (1000.0..=2000.0).contains(&x) && y <= 1000.0;
        assert_eq!(depth, if is_surveyed { 3.0 } else { 50.0 }, "{x}, {y}");
    }
    // Each file has its own zero, heights and depths alike.
    let both = format!("{mesh} --depth survey.asc --depth chart.asc --depth-offset 1.5 --depth-offset -2");
    assert_eq!(folder.run(both).status, 0);
    for [x, y, depth] in fort14(&folder.read("m.14")).0 {
        let is_surveyed = (1000.0..=2000.0).contains(&x) && y <= 1000.0;
        assert_eq!(depth, if is_surveyed { 4.5 } else { 48.0 }, "{x}, {y}");
    }
    assert_eq!(folder.run(format!("{mesh} --depth down.asc --depth-positive down")).status, 0);
    assert!(fort14(&folder.read("m.14")).0.iter().all(|node| node[2] == 50.0));
    let far = folder.run(format!("{} --depth survey.asc", mesh.replace("4000,4000", "40000,40000")));
    assert!(far.status != 0 && far.err.contains("nodes have no depth"), "{}", far.err);
}

/// The survey knows that the water is deep where the chart does not.
#[test]
fn sizes_come_from_the_first_grid_with_a_value() {
    let folder = Folder::new("depth-sizes-of-two");
    let grid = |size: usize, corner: f64, text: &str| {
        format!(
            "ncols {size}\nnrows {size}\nxllcorner {corner}\nyllcorner {corner}\ncellsize 100\nNODATA_value -9999\n{text}\n"
        )
    };
    // A hole in the survey, in its fifth row from the south.
    let survey: Vec<&str> =
        (0..20 * 20).map(|n| if n / 20 == 15 && n % 20 == 9 { "-9999" } else { "-50" }).collect();
    folder.file("survey.asc", grid(20, 1000.0, &survey.join(" ")));
    folder.file("chart.asc", grid(40, 0.0, &"-3 ".repeat(1600)));
    let waves = "--per-wavelength 1 --period 60";
    let mesh = |files: &str| {
        let ran = folder.run(format!("mesh --domain 0,0,4000,4000 --spacing 500 {files} {waves} -o m.14"));
        assert_eq!(ran.status, 0, "{}", ran.err);
        fort14(&folder.read("m.14"))
    };
    let (nodes, triangles) = mesh("--depth survey.asc --depth chart.asc");
    let (shallow, deep) = (wavelength(60.0, 3.0), wavelength(60.0, 50.0));
    let mut seen = [0; 3];
    for corners in triangles.iter().map(|triangle| triangle.map(|node| nodes[node])) {
        let least = |axis: usize| corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
        let greatest = |axis: usize| corners.iter().map(|corner| corner[axis]).fold(0.0, f64::max);
        let meets = |from: [f64; 2], to: [f64; 2]| {
            (0..2).all(|axis| least(axis) < to[axis] && greatest(axis) > from[axis])
        };
        let side = |a: usize, b: usize| (corners[a][0] - corners[b][0]).hypot(corners[a][1] - corners[b][1]);
        let diameter = side(0, 1).max(side(1, 2)).max(side(2, 0));
        let is_in_survey = (0..2).all(|axis| least(axis) >= 1000.0 && greatest(axis) <= 3000.0);
        let is_at_hole = is_in_survey && meets([1900.0, 1400.0], [2000.0, 1500.0]);
        let is_far_inside = (0..2).all(|axis| least(axis) >= 1900.0 && greatest(axis) <= 2600.0);
        let target = if is_in_survey && !is_at_hole { deep } else { shallow };
        assert!(diameter <= target, "{diameter} at {corners:?}");
        seen[0] += usize::from(is_at_hole && diameter <= shallow);
        seen[1] += usize::from(is_far_inside && diameter >= 500.0);
        seen[2] += usize::from(!is_in_survey);
    }
    assert!(seen[0] > 0 && seen[1] > 1 && seen[2] > 100, "{seen:?}");
    // The chart first: its value counts everywhere.
    let (_, finer) = mesh("--depth chart.asc --depth survey.asc");
    assert!(finer.len() > triangles.len(), "{} and {}", finer.len(), triangles.len());
}

#[test]
fn sizes_in_degrees_are_refused() {
    let folder = Folder::new("depth-degrees");
    folder.file("sea.geojson", r#"{"type":"Polygon","coordinates":[[[0,50],[2,50],[2,51],[0,51],[0,50]]]}"#);
    let header = "ncols 20\nnrows 10\nxllcorner 0\nyllcorner 50\ncellsize 0.1\n";
    folder.file("depth.asc", header.to_owned() + &"-40 ".repeat(200));
    let mesh = "mesh --region sea.geojson --depth depth.asc --per-wavelength 20";
    let refused = folder.run(mesh);
    assert!(
        refused.status != 0 && refused.err.contains("lengths of the domain are in degrees"),
        "{}",
        refused.err
    );
    let projected = format!("{mesh} --projection auto --spacing 20000 -o m.14");
    assert_eq!(folder.run(projected).status, 0);
    let (nodes, _) = fort14(&folder.read("m.14"));
    assert!(nodes.iter().all(|node| (node[2] - 40.0).abs() < 1e-9 && node[0] < 2.000_001));
}

/// On a chart in Mercator, lengths at 60° N are twice those on the ground, and slopes look half as steep.
#[test]
fn slopes_are_those_on_the_ground_in_every_projection() {
    let folder = Folder::new("depth-slopes");
    folder
        .file("sea.geojson", r#"{"type":"Polygon","coordinates":[[[9,59],[12,59],[12,61],[9,61],[9,59]]]}"#);
    let depth = |latitude: f64| 150.0 + 900.0 * (latitude - 59.0);
    let header = "ncols 160\nnrows 110\nxllcorner 8.9\nyllcorner 58.9\ncellsize 0.02\n".to_owned();
    let rows = (0..110).map(|row| format!("{} ", -depth(61.09 - 0.02 * f64::from(row))).repeat(160) + "\n");
    folder.file("depth.asc", header + &rows.collect::<String>());
    let per_metre = 900.0 / on_the_ellipsoid([9.0, 59.5], [9.0, 60.5]);
    for projection in ["+proj=merc +lon_0=10", "+proj=tmerc +lon_0=10"] {
        let options = [
            "--region",
            "sea.geojson",
            "--crs",
            "lonlat",
            "--projection",
            projection,
            "--depth",
            "depth.asc",
        ];
        let sizes = ["--per-slope", "60", "--spacing", "80000", "-o", "m.14"];
        let ran = folder.run([&["mesh"], &options[..], &sizes].concat());
        assert_eq!(ran.status, 0, "{projection}: {}", ran.err);
        let (nodes, triangles) = fort14(&folder.read("m.14"));
        // At the sides of the domain, pixels lack neighbours.
        let is_inside = |at: &[f64; 3]| (9.05..11.95).contains(&at[0]) && (59.05..60.95).contains(&at[1]);
        let inside = triangles.iter().filter(|triangle| triangle.iter().all(|&node| is_inside(&nodes[node])));
        let ratios = inside.map(|triangle| {
            let corners = triangle.map(|node| [nodes[node][0], nodes[node][1]]);
            let side = |a: usize, b: usize| on_the_ellipsoid(corners[a], corners[b]);
            let southern = corners.iter().map(|at| at[1]).fold(90.0, f64::min);
            // The pixel there has the depth of a place up to one pixel farther north.
            let target = TAU * depth(southern + 0.02) / per_metre / 60.0;
            side(0, 1).max(side(1, 2)).max(side(2, 0)) / target
        });
        let ratios: Vec<f64> = ratios.collect();
        let (greatest, mean) =
            (ratios.iter().copied().fold(0.0, f64::max), ratios.iter().sum::<f64>() / ratios.len() as f64);
        assert!(
            ratios.len() > 1000 && greatest <= 1.0 && mean > 0.4,
            "{projection}: {greatest}, {mean}, {}",
            ratios.len()
        );
    }
}

#[test]
fn depths_in_files_are_no_less_than_the_least_depth() {
    let folder = Folder::new("depth-least");
    let sea = "mesh --domain 0,0,4000,3000 --spacing 1000 --quantity depth=x/100-5 -o sea.14";
    let depths = |text: &str| -> Vec<f64> {
        let nodes = text.lines().nth(1).unwrap().split(' ').nth(1).unwrap().parse().unwrap();
        let rows = text.lines().skip(2).take(nodes);
        rows.map(|row| row.split(' ').nth(3).unwrap().parse().unwrap()).collect()
    };
    folder.run(sea);
    let plain = depths(&folder.read("sea.14"));
    let ran = folder.run(format!("{sea} --least-depth 3 --json").as_str());
    let text = folder.read("sea.14");
    assert!(text.lines().next().unwrap().contains("; least depth: 3 m"), "{text}");
    let expected: Vec<f64> = plain.iter().map(|depth| depth.max(3.0)).collect();
    assert_eq!(depths(&text), expected);
    let raised = plain.iter().filter(|depth| **depth < 3.0).count();
    assert_eq!(ran.json()["least_depth"], serde_json::json!({ "depth": 3.0, "raised": raised }));
    assert!(raised > 0 && ran.err.contains(&format!("{raised} nodes are less than 3 m deep")), "{}", ran.err);
    let unused = folder.run("mesh --spacing 0.5 -o a.14 --least-depth 3");
    assert!(unused.status == 0 && unused.err.contains("--least-depth changes nothing"), "{}", unused.err);
    assert_eq!(folder.run("mesh --least-depth deep").status, 2);
    let checked =
        folder.run("check --domain 0,0,4,3 --spacing 1 --quantity depth=x-2 --for adcirc --json").json();
    let notes = |answer: &serde_json::Value| answer["notes"].as_array().unwrap().len();
    let raised =
        "check --domain 0,0,4,3 --spacing 1 --quantity depth=x-2 --least-depth 1 --for adcirc --json";
    assert_eq!((notes(&checked), notes(&folder.run(raised).json())), (12, 0));
}

/// The rows of the nodes of `.14`: the fourth number of each is the depth.
fn depths_of(text: &str) -> Vec<f64> {
    let nodes = text.lines().nth(1).unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    let rows = text.lines().skip(2).take(nodes);
    rows.map(|row| row.split(' ').nth(3).unwrap().parse().unwrap()).collect()
}

#[test]
fn formulas_of_quantities_may_use_the_depth_of_layers() {
    let folder = Folder::new("depth-quantity");
    folder.file("bay.asc", Bay::new().grid(|_, _| true));
    let sea = "mesh --domain 1000,1000,75000,45000 --spacing 2000 --depth bay.asc";
    let run = |options: &str| {
        let ran = folder.run(format!("{sea} {options}").as_str());
        assert_eq!(ran.status, 0, "{}", ran.err);
        ran
    };
    run("-o plain.14");
    let plain = depths_of(&folder.read("plain.14"));
    assert!(plain.iter().any(|depth| *depth < 3.0) && plain.iter().any(|depth| *depth > 20.0));
    // A least depth changes files, and not what formulas see.
    let options = ["--quantity", "depth=max(depth,3)", "--quantity", "n=if(depth>20, 0.02, 0.03+depth/1e4)"];
    let words: Vec<&str> = sea.split(' ').chain(options).chain(["--least-depth", "4"]).collect();
    let ran = folder.run([&words[..], &["-o", "made.14", "-o", "made.node", "--json"]].concat());
    assert_eq!(ran.status, 0, "{}", ran.err);
    let expected: Vec<f64> = plain.iter().map(|depth| depth.max(4.0)).collect();
    assert_eq!(depths_of(&folder.read("made.14")), expected);
    let raised = plain.iter().filter(|depth| **depth < 4.0).count();
    assert_eq!(ran.json()["least_depth"], serde_json::json!({ "depth": 4.0, "raised": raised }));
    let text = folder.read("made.node");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let manning = rows.map(|row| row.split_whitespace().nth(5).unwrap().parse().unwrap());
    let expected = plain.iter().map(|depth| if *depth > 20.0 { 0.02 } else { 0.03 + depth / 1e4 });
    assert_eq!(manning.collect::<Vec<f64>>(), expected.collect::<Vec<_>>());
    // In a picture there are no values, and the formula is no mistake.
    run("--quantity depth=depth+1 -o sea.png");
    // The other front ends see the same.
    folder.file(
        "sea.toml",
        "[domain]\nbounds = [1000, 1000, 75000, 45000]\n[mesh]\nspacing = 2000\n[[layer]]\nkind = \"depth\"\nfile = \
         \"bay.asc\"\n[[output]]\nfile = \"recipe.14\"\nquantities = [\"depth = max(depth, 3)\"]\n",
    );
    assert_eq!(folder.run("mesh sea.toml").status, 0);
    let expected: Vec<f64> = plain.iter().map(|depth| depth.max(3.0)).collect();
    assert_eq!(depths_of(&folder.read("recipe.14")), expected);
    let dry = |options: &str| {
        let answer =
            folder.run(format!("{} --for adcirc --json {options}", sea.replace("mesh", "check")).as_str());
        let answer = answer.json();
        let rules = answer["rules"].as_array().unwrap();
        let dry = rules.iter().find(|rule| rule["rule"] == "dry_node").unwrap();
        dry["count"].as_u64().unwrap()
    };
    assert!(dry("--quantity depth=depth-20") > 0 && dry("--quantity depth=max(depth,3)") == 0);
}

#[test]
fn a_quantity_of_the_depth_needs_a_layer_of_depths() {
    let folder = Folder::new("depth-quantity-none");
    let recipe = "[mesh]\nspacing = 0.5\n[[output]]\nfile = \"a.14\"\nquantities = [\"n = depth/2\"]\n";
    folder.file("a.toml", recipe);
    for words in [
        "mesh --spacing 0.5 -o a.14 --quantity n=depth/2",
        "check --spacing 0.5 --for adcirc --quantity n=depth/2",
        "mesh a.toml",
    ] {
        let ran = folder.run(words);
        let sentence = "The quantity n is depth/2, and `depth` in it is the depth of layers at a node";
        assert!(ran.status == 2 && ran.err.contains(sentence), "{words}: {}", ran.err);
    }
    assert!(!folder.has("a.14"));
}

#[test]
fn the_largest_time_step_is_known_for_a_depth_that_is_given() {
    let folder = Folder::new("depth-step");
    let options = "--domain 0,0,40000,40000 --spacing 10000 --quantity depth=50 -o sea.14";
    let step = folder.json("mesh", options)["largest_time_step"].clone();
    // All triangles are alike: their heights are as long as half their longest edges.
    let [edge, height] = [&step, &step["by_height"]].map(|step| step["seconds"].as_f64().unwrap());
    assert!((height / edge - 0.5_f64.sqrt()).abs() < 1e-9, "{step}");
    let bound = 10_000.0 / (9.81_f64 * 50.0).sqrt();
    assert!(edge > 0.9 * bound && edge <= bound, "{edge} {bound}");
    let text = folder.run(format!("mesh {options}").as_str()).err;
    assert!(text.contains("largest time step ") && text.contains(" s across triangles, at "), "{text}");
}

#[test]
fn each_output_of_a_recipe_has_its_own_least_depth_and_slope() {
    let folder = Folder::new("depth-of-outputs");
    let depth = "quantities = [\"depth = 10*x - 1\"]";
    let output = |file: &str, keys: &str| format!("[[output]]\nfile = \"{file}\"\n{keys}\n");
    let outputs = [
        output("as_it_is.14", depth),
        output("deeper.14", &format!("{depth}\nleast_depth = 2")),
        output("smooth.14", &format!("{depth}\nleast_depth = 1\ndepth_slope = 0.05")),
        output("idle.vtu", "least_depth = 2"),
    ];
    let mesh = "[mesh]\nspacing = 0.25\n";
    folder.file("sea.toml", format!("{mesh}{}", outputs.concat()));
    let ran = folder.run("mesh sea.toml");
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert!(ran.err.contains("idle.vtu has no depths, so its least_depth"), "{}", ran.err);
    let depths = |file: &str| -> Vec<f64> {
        let text = folder.read(file);
        let count: Vec<usize> =
            text.lines().nth(1).unwrap().split_whitespace().map(|word| word.parse().unwrap()).collect();
        let rows = text.lines().skip(2).take(count[1]);
        rows.map(|row| row.split_whitespace().nth(3).unwrap().parse().unwrap()).collect()
    };
    let plain = depths("as_it_is.14");
    assert!(plain.contains(&-1.0) && !folder.read("as_it_is.14").contains("least depth"));
    let raised: Vec<f64> = plain.iter().map(|depth| depth.max(2.0)).collect();
    assert_eq!(depths("deeper.14"), raised);
    assert!(folder.read("deeper.14").lines().next().unwrap().contains("; least depth: 2 m"));
    let smooth = depths("smooth.14");
    assert!(smooth.iter().all(|&depth| depth >= 1.0) && smooth != raised);
    assert!(folder.read("smooth.14").lines().next().unwrap().contains("; depth slope: r-factor of edges"));
    // Options count before the keys.
    assert_eq!(folder.run("mesh sea.toml --least-depth 4").status, 0);
    assert!(depths("deeper.14").iter().chain(&depths("as_it_is.14")).all(|&depth| depth >= 4.0));
    for (file, key, sentence) in [
        ("a.14", "depth_slope = 1.5", "an r-factor is a number between 0 and 1"),
        ("a.14", "least_depth = inf", "a depth is a number of metres"),
        ("a.png", "least_depth = 1", "holds no values at the nodes"),
    ] {
        folder.file("bad.toml", format!("{mesh}{}", output(file, key)));
        let ran = folder.run("mesh bad.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{file}, {key}: {}", ran.err);
    }
}
