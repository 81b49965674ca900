//! Meshes for a study of convergence: `--scale` and `--sequence`, by a look at the nodes in the files.

use std::collections::HashSet;

use crate::folder::Folder;
use crate::runs::seeds;

/// A sea on the Earth with an island, whose nodes are moved onto the outline.
const SEA: &str = r#"{"type": "Polygon", "coordinates": [[[0, 50], [3, 50], [3.2, 51], [2.6, 51.3], [2, 51.9], [1.1, 51.4],
    [0, 51.6], [0, 50]], [[1, 50.5], [1, 50.8], [1.4, 50.9], [1.5, 50.6], [1, 50.5]]]}"#;

/// Reads the nodes of a file of ADCIRC, as the texts of their coordinates, and its triangles.
fn read(folder: &Folder, name: &str) -> (Vec<String>, Vec<[usize; 3]>) {
    let text = folder.read(name);
    let mut lines = text.lines().skip(1);
    let counts = numbers(lines.next().unwrap());
    let node = |line: &str| line.split(' ').skip(1).take(2).collect::<Vec<_>>().join(" ");
    let nodes = lines.by_ref().take(counts[1]).map(node).collect();
    let corners = |line: &str| <[usize; 3]>::try_from(&numbers(line)[2..5]).unwrap().map(|node| node - 1);
    (nodes, lines.take(counts[0]).map(corners).collect())
}

fn numbers(line: &str) -> Vec<usize> {
    line.split_whitespace().map_while(|word| word.parse().ok()).collect()
}

fn place(text: &str) -> [f64; 2] {
    let words: Vec<f64> = text.split(' ').map(|word| word.parse().unwrap()).collect();
    words.try_into().unwrap()
}

/// Returns the doubled area of each triangle.
fn doubled_areas(nodes: &[String], triangles: &[[usize; 3]]) -> Vec<f64> {
    let area = |corners: &[usize; 3]| {
        let [[ax, ay], [bx, by], [cx, cy]] = corners.map(|node| place(&nodes[node]));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    };
    triangles.iter().map(area).collect()
}

/// Returns the options of a random document: a formula, limits, a gradation and a shape.
fn random_document(seed: u64) -> String {
    let mut random = fastrand::Rng::with_seed(seed);
    let [x, y, near, slope] = [(); 4].map(|()| random.f64());
    let target = format!("{:.4}+{:.3}*hypot(x-{x:.3},y-{y:.3})", 0.01 + 0.05 * near, 0.05 + 0.4 * slope);
    let shape =
        ["", " --inside r<0.9 --boundary report", " --inside x+y<1.3 --boundary report"][random.usize(..3)];
    let rule = ["area", "vertex"][random.usize(..2)];
    let gradation = ["", " --gradation 0.2"][if rule == "area" { random.usize(..2) } else { 0 }];
    format!("--spacing 0.25 --target {target} --h-min 0.02 --h-max 0.3 --rule {rule}{shape}{gradation}")
}

#[test]
fn a_scale_is_the_mesh_of_targets_and_limits_multiplied_by_it() {
    let folder = Folder::new("sequence-scale");
    let base = "--spacing 0.25 --rule";
    for (scale, rule) in [(0.5, "area"), (0.3, "area"), (1.7, "area"), (0.5, "vertex")] {
        let target = "0.03+0.3*hypot(x-0.3,y-0.4)";
        let limits = |factor: f64| format!("--h-min {} --h-max {}", 0.04 * factor, 0.25 * factor);
        let plain = format!("{base} {rule} --target {target} {} --scale {scale}", limits(1.0));
        let multiplied = format!("{base} {rule} --target {scale}*({target}) {}", limits(scale));
        let hash = |options: &str| folder.json("mesh", options)["hash"].clone();
        assert_eq!(hash(&plain), hash(&multiplied), "{scale} {rule}");
        if rule == "area" {
            let graded = |options: &str, slope: f64| hash(&format!("{options} --gradation {slope}"));
            assert_eq!(graded(&plain, 0.2), graded(&multiplied, 0.2 * scale), "{scale}");
        }
    }
    // So is the largest diameter at the outline, which is all that decides these sizes.
    folder.file("sea.geojson", SEA);
    let at_outline = |diameter: &str| {
        let sea = "--region sea.geojson --projection auto --spacing 100000";
        folder.json("mesh", format!("{sea} --boundary-diameter {diameter}").as_str())["hash"].clone()
    };
    assert_eq!(at_outline("20000 --scale 0.5"), at_outline("10000"));
    assert_ne!(at_outline("20000"), at_outline("10000"));
    // h̄ in files is that of the mesh.
    folder.run("mesh --spacing 0.25 --target 0.2+x --scale 0.5 -o a.csv");
    folder.run("mesh --spacing 0.25 --target 0.5*(0.2+x) -o b.csv");
    let table = |name: &str| folder.read(name).lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(table("a.csv"), table("b.csv"));
    for (options, sentence) in [
        ("--scale 0", "write a number above 0"),
        ("--scale much", "write a number above 0"),
        ("--scale 0.5 --certificate a.json", "a certificate states the targets of the layers themselves"),
    ] {
        let ran = folder.run(format!("mesh {options}").as_str());
        assert!(ran.status == 2 && ran.err.contains(sentence), "{}", ran.err);
    }
}

#[test]
fn halves_of_all_sizes_have_the_nodes_of_the_mesh() {
    let folder = Folder::new("sequence-nested");
    for seed in seeds(10) {
        let document = random_document(seed);
        let nodes = |scale: &str| {
            let ran = folder.run(format!("mesh {document} --scale {scale} -o a.14").as_str());
            assert_eq!(ran.status, 0, "{document}: {}", ran.err);
            read(&folder, "a.14").0.into_iter().collect::<HashSet<String>>()
        };
        let [coarse, middle, fine] = ["1", "0.5", "0.25"].map(nodes);
        assert!(coarse.is_subset(&middle) && middle.is_subset(&fine), "{document}");
        assert!(middle.len() > 2 * coarse.len());
    }
}

/// Checks that each mesh has the nodes of the one before, with the same numbers and coordinates to the last digit,
/// and four triangles for each of its, in its area.
fn check_sequence(folder: &Folder, options: &str, count: usize) {
    let command = format!("{options} --sequence {count} -o sea.14");
    let summary = folder.json("mesh", command.as_str());
    folder.run(format!("mesh {options} -o alone.14").as_str());
    let meshes: Vec<_> = (1..=count).map(|number| read(folder, &format!("sea_{number}.14"))).collect();
    assert_eq!(meshes[0], read(folder, "alone.14"), "{options}");
    for (mesh, listed) in meshes.iter().zip(summary["sequence"].as_array().unwrap()) {
        assert_eq!(
            (listed["nodes"].as_u64(), listed["triangles"].as_u64()),
            (Some(mesh.0.len() as u64), Some(mesh.1.len() as u64))
        );
    }
    for pair in meshes.windows(2) {
        let [(nodes, triangles), (finer, halves)] = pair else { unreachable!() };
        assert_eq!(finer[..nodes.len()], nodes[..], "{options}");
        assert_eq!(finer.iter().collect::<HashSet<_>>().len(), finer.len(), "a node is there twice");
        assert_eq!(halves.len(), 4 * triangles.len());
        let (areas, of_halves) = (doubled_areas(nodes, triangles), doubled_areas(finer, halves));
        for (area, quarters) in areas.iter().zip(of_halves.chunks(4)) {
            // In degrees midpoints are those of the plane.
            let most = if options.contains("lonlat") { 0.1 } else { 1e-6 };
            assert!(quarters.iter().all(|quarter| (4.0 * quarter / area - 1.0).abs() < most), "{options}");
        }
    }
    let head = folder.read("sea_2.14").lines().next().unwrap().to_owned();
    assert!(
        head.contains(&format!("; sequence: 2 of {count}; each has the nodes of the one before")),
        "{head}"
    );
}

#[test]
fn meshes_of_a_sequence_have_all_nodes_of_the_one_before() {
    let folder = Folder::new("sequence-files");
    folder.file("sea.geojson", SEA);
    for seed in seeds(6) {
        check_sequence(&folder, &random_document(seed), 3);
    }
    let sea = "--region sea.geojson --boundary-diameter";
    check_sequence(&folder, &format!("{sea} 0.1 --spacing 0.5 --target 0.3"), 3);
    for crs in ["plane", "lonlat"] {
        let options = format!("{sea} 20000 --projection auto --spacing 50000 --target 30000 --out-crs {crs}");
        check_sequence(&folder, &options, 3);
    }
}

#[test]
fn boundaries_and_targets_of_a_sequence_follow() {
    let folder = Folder::new("sequence-boundary");
    folder.file("sea.geojson", SEA);
    let options = "--region sea.geojson --open frame --boundary-diameter 0.1 --spacing 0.5 --target 0.3";
    folder.run(format!("mesh {options} --sequence 2 -o sea.14 -o sea.csv").as_str());
    let strings = |name: &str| -> Vec<(String, usize)> {
        let text = folder.read(name);
        let heads = text.lines().filter(|line| line.contains(" = Number of nodes for "));
        heads.map(|head| (head.split(" = ").nth(1).unwrap().to_owned(), numbers(head)[0])).collect()
    };
    let [first, second] = ["sea_1.14", "sea_2.14"].map(strings);
    assert!(!first.is_empty());
    for ((name, nodes), (finer, more)) in first.iter().zip(&second) {
        // An island does not repeat its first node.
        let edges =
            |nodes: usize| if name.contains("land") && name.contains("island") { nodes } else { nodes - 1 };
        assert_eq!((name, 2 * edges(*nodes)), (finer, edges(*more)), "{name}");
    }
    let table = |name: &str| folder.read(name);
    for (name, target) in [("sea_1.csv", ",0.3,"), ("sea_2.csv", ",0.15,")] {
        assert!(table(name).lines().skip(1).all(|row| row.contains(target)), "h̄ is that of the mesh: {name}");
    }
    assert_eq!(4 * (table("sea_1.csv").lines().count() - 1), table("sea_2.csv").lines().count() - 1);
}

#[test]
fn sequences_that_cannot_be_written_are_refused() {
    let folder = Folder::new("sequence-refused");
    for (options, status, sentence) in [
        ("--sequence 2 -o -  --format msh", 2, "standard output is one. Name a file with -o"),
        ("--sequence 2 -o a.png", 2, "Leave out .svg and .png"),
        ("--sequence 0 -o a.14", 2, "0 is not in 1..=16"),
        (
            "--sequence 9 --max-triangles 100000 -o a.14",
            1,
            "the last mesh would have 52,428,800 triangles, and 100,000 are allowed",
        ),
    ] {
        let ran = folder.run(format!("mesh {options}").as_str());
        assert!(ran.status == status && ran.err.contains(sentence), "{options}: {}", ran.err);
        assert_eq!(folder.names(), Vec::<String>::new(), "nothing is written");
    }
}
