//! `meshbrush path`, run as a person runs it.

use std::fs;
use std::sync::Arc;

use crate::folder::{Folder, Ran};
use glam::{DVec2, dvec2};
use meshbrush::RiskField;
use meshbrush_core::build::MeshBuilder;
use meshbrush_core::document::{Document, KeepOut, PathCost, PathPlan, Settings};
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{PathMesh, PathRequest, Planner, Weights};
use meshbrush_io::io::Meter;
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::recipe::RecipeFiles;
use meshbrush_mesh::mesh::Progress;
use serde_json::Value;

fn path(folder: &Folder, arguments: &str) -> Ran {
    folder.run(format!("path {arguments}"))
}

const COARSE: &str = "--spacing 0.125";

#[test]
fn the_answer_has_the_path_its_figures_and_an_interval() {
    let folder = Folder::new("answer");
    let answer = folder.json("path", format!("--from 0.1,0.2 --to 0.9,0.8 --length-weight 2 {COARSE}"));
    let number = |name: &str| answer[name].as_f64().unwrap_or_else(|| panic!("{name}"));
    assert!((number("cost") - 2.0).abs() < 1e-9 && (number("length") - 1.0).abs() < 1e-9);
    assert!(number("lower") <= 2.0 && number("upper") >= 2.0 && number("lower") > 1.9);
    assert_eq!((number("risk"), number("highest_risk"), number("triangles")), (0.0, 0.0, 128.0));
    assert!(number("seconds") > 0.0);
    let points = answer["points"].as_array().unwrap();
    assert_eq!((&points[0][0], &points[points.len() - 1][1]), (&0.1.into(), &0.8.into()));
}

#[test]
fn a_proof_narrows_the_interval() {
    let folder = Folder::new("proof");
    let options = format!("--from 0.2,0.3 --to 0.8,0.6 --cost '1 + x' {COARSE}");
    let width = |answer: &Value| {
        let [lower, upper] = ["lower", "upper"].map(|name| answer[name].as_f64().unwrap());
        (upper - lower) / upper
    };
    assert!(width(&folder.json("path", &options)) > 0.01);
    assert!(width(&folder.json("path", format!("{options} --within 1%"))) <= 0.01);
    // The proof has a grid of its own, however fine that of the mesh is.
    let fine = "--from 0.2,0.3 --to 0.8,0.6 --cost '1 + x' --spacing 0.012 --within 0.05%";
    assert!(width(&folder.json("path", fine)) <= 0.0005);
    let ran = path(&folder, &format!("{options} --within 2%"));
    assert!(ran.out.starts_with("cost ") && ran.out.contains("of the best"), "{}", ran.out);
}

/// Risks by pixel, the upper row first, and the heights at which a path begins at the left and ends at the right.
struct Risks {
    rows: Vec<Vec<f64>>,
    ends: [f64; 2],
}

impl Risks {
    fn random(seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let side = random.usize(5..7);
        let risk = |random: &mut fastrand::Rng| [0.0, 0.0, 1.0, random.f64()][random.usize(..4)];
        let rows = (0..side).map(|_| (0..side).map(|_| risk(&mut random)).collect()).collect();
        let ends = [(); 2].map(|()| (0.1 + 0.8 * random.f64()) * side as f64);
        Self { rows, ends }
    }

    /// A raster whose cheapest path runs along sides of pixels with the risk 1: its upper bound counts them.
    fn along_sides() -> Self {
        let rows = [
            [0.0, 0.26, 0.76, 0.0, 0.0, 0.89, 0.0],
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.94, 0.69],
            [0.0, 0.76, 1.0, 0.0, 1.0, 0.93, 0.0],
            [1.0, 1.0, 0.9, 0.0, 0.3, 0.85, 0.0],
            [0.48, 0.0, 1.0, 0.0, 0.78, 0.0, 1.0],
            [0.7, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.94],
        ];
        Self { rows: rows.map(Vec::from).to_vec(), ends: [3.4156, 2.698] }
    }

    fn path(&self, folder: &Folder, more: &str) -> Value {
        let side = self.rows.len();
        let row = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        let header = format!("ncols {side}\nnrows {side}\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
        folder.file("risk.asc", header + &rows.join("\n"));
        let ([from, to], right) = (self.ends, side as f64 - 0.3);
        let options = format!(
            "--domain 0,0,{side},{side} --spacing 1 --h-min 1 --risk-raster risk.asc --from 0.3,{from} --to {right},{to} \
             --length-weight 0.2 --risk-weight 1 {more}"
        );
        folder.json("path", options)
    }
}

/// Along sides of pixels the bounds of a path are far apart, so that the path with the least upper bound is
/// not always the cheapest one. Proofs over pixels are long: `path/solution.rs` has the rule for every run.
#[test]
fn a_proof_never_makes_a_path_dearer() {
    if crate::runs::runs(1) == 1 {
        return;
    }
    let folder = Folder::new("proof-rasters");
    let number = |answer: &Value, name: &str| answer[name].as_f64().unwrap();
    let compared = |risks: &Risks| {
        let [without, within] = ["", "--within 10%"].map(|more| risks.path(&folder, more));
        let [first, proved] = [&without, &within].map(|answer| number(answer, "cost"));
        assert!(proved <= first, "{:?}: {proved} within, {first} without", risks.rows);
        let [lower, upper] = ["lower", "upper"].map(|name| number(&within, name));
        assert!(lower <= proved && proved <= upper && upper <= number(&without, "upper"), "{within}");
        [without, within]
    };
    let [without, within] = compared(&Risks::along_sides());
    assert_eq!(without["points"], within["points"]);
    assert!(number(&within, "upper") < 0.6 * number(&without, "upper"), "{within}");
    crate::runs::seeds(2).for_each(|seed| drop(compared(&Risks::random(seed))));
}

#[test]
fn a_path_without_a_proof_is_written_all_the_same() {
    let folder = Folder::new("no-proof");
    let options =
        "--spacing 0.25 --from 0.2,0.3 --to 0.8,0.6 --cost 'if(hypot(x - 0.5, y - 0.5) < 0.2, 9, 1)'";
    let ran = path(&folder, &format!("{options} --within 0.00001%"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert!(ran.out.starts_with("cost 0.746"), "{}", ran.out);
    assert!(
        ran.err.contains("note: The path is proved to be within 1.03 % of the best, not "),
        "{}",
        ran.err
    );
}

/// The unit square without a cape from below that ends in a point, as GeoJSON, and the cape itself.
const CAPE: &str =
    r#"{"type":"Polygon","coordinates":[[[0,0],[0.45,0],[0.5,0.6],[0.55,0],[1,0],[1,1],[0,1],[0,0]]]}"#;

#[test]
fn a_path_keeps_the_clearance_from_a_cape_that_the_mesh_cuts() {
    let folder = Folder::new("clearance");
    fs::write(folder.0.join("cape.geojson"), CAPE).unwrap();
    // Triangles so large that the mesh covers the tip.
    let options = "--region cape.geojson --spacing 0.25 --target 0.5 --boundary-diameter 0.5";
    let ends = "--from 0.1,0.3 --to 0.9,0.3";
    let from_cape = |more: &str| {
        let answer = folder.json("path", format!("{options} {ends} {more}"));
        let point = |point: &Value| dvec2(point[0].as_f64().unwrap(), point[1].as_f64().unwrap());
        let points: Vec<_> = answer["points"].as_array().unwrap().iter().map(point).collect();
        let to_segment = |p: DVec2, a: DVec2, b: DVec2| {
            let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a + share * (b - a))
        };
        let [left, tip, right] = [dvec2(0.45, 0.0), dvec2(0.5, 0.6), dvec2(0.55, 0.0)];
        let sides = [[left, tip], [tip, right]];
        let piece = |pair: &[DVec2]| {
            let ends = sides.iter().flat_map(|side| pair.iter().map(|&p| to_segment(p, side[0], side[1])));
            ends.fold(to_segment(tip, pair[0], pair[1]), f64::min)
        };
        assert!(
            points.iter().all(|p| p.y > 0.29) && points.iter().any(|p| p.y > 0.6),
            "over the tip: {points:?}"
        );
        points.windows(2).map(piece).fold(f64::INFINITY, f64::min)
    };
    for more in ["", "--simplify 0.1", "--within 5%"] {
        let distance = from_cape(more);
        assert!(distance > 0.0 && distance < 0.05, "{more}: {distance}");
        let distance = from_cape(&format!("{more} --clearance 0.2"));
        assert!((0.2..0.25).contains(&distance), "{more}: {distance}");
    }
    let refused = |more: &str, message: &str| {
        let ran = path(&folder, &format!("{options} {more}"));
        assert!(ran.status != 0 && ran.err.contains(message), "{more}: {}", ran.err);
    };
    refused(
        "--from 0.4,0.6 --to 0.9,0.3 --clearance 0.25",
        "The start (0.4, 0.6) is only 0.0996546 from the outline of the domain or a keep-out region, and the clearance of \
         paths is 0.25.",
    );
    refused("--from 0.5,0.59 --to 0.9,0.3", "The start (0.5, 0.59) lies ");
    refused("--from 0.01,0.3 --to 0.99,0.3 --clearance 0.41", "enclose the");
    refused(&format!("{ends} --clearance -1"), "A clearance of -1 is no distance");
}

#[test]
fn the_best_valley_between_threats_is_found_on_a_coarse_mesh() {
    let folder = Folder::new("valley");
    let threats = "x,y,range,peak,law\n27,38,19,1,radar\n45,70,22,0.9,radar\n52,22,17,1,radar\n\
        63,47,15,0.8,radar\n78,74,17,1,radar\n84,27,14,0.9,radar\n17,78,15,0.7,radar\n";
    fs::write(folder.0.join("threats.csv"), threats).unwrap();
    let answer = folder.json(
        "path",
        "--domain 0,0,100,100 --spacing 5 --h-min 0.5 --h-max 20 --threats threats.csv \
         --from 6,12 --to 94,88 --within 1%",
    );
    let [cost, lower, upper] = ["cost", "lower", "upper"].map(|name| answer[name].as_f64().unwrap());
    // Another valley costs 166.5.
    assert!(cost < 146.5 && upper - lower <= 0.01 * upper, "{cost} {lower} {upper}");
}

#[test]
fn via_points_and_keep_out_regions_count() {
    let folder = Folder::new("around");
    let ring = "[[[0.4,-0.1],[0.6,-0.1],[0.6,0.7],[0.4,0.7],[0.4,-0.1]]]";
    fs::write(folder.0.join("wall.geojson"), format!("{{\"type\":\"Polygon\",\"coordinates\":{ring}}}"))
        .unwrap();
    let ends = "--from 0.1,0.1 --to 0.9,0.1 --spacing 0.05";
    let cost = |options: &str| folder.json("path", format!("{ends} {options}"))["cost"].as_f64().unwrap();
    assert!((cost("") - 0.8).abs() < 1e-9);
    let via = 2.0 * f64::hypot(0.4, 0.5);
    assert!((cost("--via 0.5,0.6") - via).abs() < 1e-6);
    let around = 2.0 * f64::hypot(0.3, 0.6) + 0.2;
    let found = cost("--keep-out wall.geojson");
    assert!(found > around - 1e-9 && found < around * 1.1, "{found} {around}");
    let proof = folder.json("path", format!("{ends} --keep-out wall.geojson --within 1%"));
    let lower = proof["lower"].as_f64().unwrap();
    assert!(lower <= around && lower > 0.97 * around, "{lower} {around}");
}

/// The unit square with a square hole in the middle.
const HOLE: &str = "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[1,0],[1,1],[0,1],[0,0]],\
    [[0.4,0.4],[0.6,0.4],[0.6,0.6],[0.4,0.6],[0.4,0.4]]]}";

#[test]
fn paths_between_walls_go_around_holes() {
    let folder = Folder::new("walls");
    fs::write(folder.0.join("hole.geojson"), HOLE).unwrap();
    for boundary in ["fitted", "outline"] {
        let hole = format!("--region hole.geojson --boundary {boundary} --spacing 0.1 --target 0.05");
        for (from, to) in [("0.4,0.5", "0.6,0.5"), ("0.4,0.4", "0.6,0.6"), ("0.6,0.45", "0.4,0.55")] {
            let answer = folder.json("path", format!("{hole} --from {from} --to {to}"));
            let [cost, upper] = ["cost", "upper"].map(|name| answer[name].as_f64().unwrap());
            assert!(
                (cost - 0.4).abs() < 1e-9 && upper >= 0.4 - 1e-9,
                "{boundary} {from} {to}: {cost} {upper}"
            );
        }
    }
    let along = folder.json("path", "--spacing 0.1 --target 0.05 --cost 'exp(4*x)' --from 0,0.2 --to 0,0.8");
    assert!((along["cost"].as_f64().unwrap() - 0.6).abs() < 1e-9);
    let xs = along["points"].as_array().unwrap().iter().map(|point| point[0].as_f64().unwrap());
    assert!(xs.into_iter().all(|x| x >= 0.0));
}

#[test]
fn a_simplified_path_stays_in_the_domain_and_has_figures_of_its_own() {
    let folder = Folder::new("simplified");
    fs::write(folder.0.join("hole.geojson"), HOLE).unwrap();
    let answer = folder.json("path", 
        "--region hole.geojson --spacing 0.1 --target 0.03 --from 0.3,0.47 --to 0.7,0.5 --simplify 0.05 -o p.geojson",
    );
    let points: Vec<[f64; 2]> = serde_json::from_value(answer["points"].clone()).unwrap();
    let length: f64 = points.windows(2).map(|p| f64::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1])).sum();
    for name in ["cost", "length"] {
        assert!((answer[name].as_f64().unwrap() - length).abs() < 1e-12, "{name} {length}");
    }
    assert!(points.len() < 6 && length > 0.46, "{points:?}");
    let feature: Value = serde_json::from_str(&folder.read("p.geojson")).unwrap();
    assert_eq!(feature["properties"]["cost"], answer["cost"]);
}

#[test]
fn bounds_are_claimed_only_where_they_hold() {
    let folder = Folder::new("bounds");
    // A line that costs less, on a line of the mesh.
    for cheap in ["abs(x-0.5)<1e-11", "x==0.5"] {
        let line = format!("--from 0.4,0.1 --to 0.4,0.9 --spacing 0.125 --cost 'if({cheap},1,10)'");
        let lower = folder.json("path", &line)["lower"].as_f64().unwrap();
        assert!(lower <= 2.8, "{cheap}: {lower}");
    }
    // A strait that the mesh leaves out.
    let strait = "[[[0,0],[0.45,0],[0.45,0.45],[0.55,0.45],[0.55,0],[1,0],[1,1],[0.55,1],[0.55,0.95],[0.45,0.95],\
        [0.45,1],[0,1],[0,0]],[[0.45,0.47],[0.55,0.47],[0.55,0.9],[0.45,0.9],[0.45,0.47]]]";
    fs::write(folder.0.join("strait.geojson"), format!("{{\"type\":\"Polygon\",\"coordinates\":{strait}}}"))
        .unwrap();
    let through = "--region strait.geojson --boundary outline --boundary-diameter 0.1 --spacing 0.1 --parts all \
        --from 0.2,0.46 --to 0.8,0.46";
    let answer = folder.json("path", through);
    assert!(answer["cost"].as_f64().unwrap() > 0.7 && answer["lower"] == 0.0, "{answer}");
    let ran = path(&folder, through);
    assert!(ran.out.contains("no lower bound is known"), "{}", ran.out);
    let proved = folder.json("path", format!("{through} --within 1%"))["lower"].as_f64().unwrap();
    assert!(proved <= 0.6 && proved > 0.5, "{proved}");
}

#[test]
fn each_obstacle_has_an_error_of_its_own() {
    let folder = Folder::new("obstacles");
    let ring = "[[[0.4,-0.1],[0.6,-0.1],[0.6,1.1],[0.4,1.1],[0.4,-0.1]]]";
    fs::write(folder.0.join("wall.geojson"), format!("{{\"type\":\"Polygon\",\"coordinates\":{ring}}}"))
        .unwrap();
    let ends = "--from 0.1,0.5 --to 0.9,0.5";
    for (arguments, message) in [
        (
            "--spacing 0.05 --keep-out wall.geojson",
            "keep-out regions, the outline of the domain and the clearance, with the triangles that they touch, enclose",
        ),
        ("--spacing 0.05 --inside 'abs(x-0.5)>0.2' --parts all", "but the domain may: a strait between them"),
        ("--spacing 0.05 --cost '1+1e300*x'", "Only costs from 1e-100 to 1e100 can be added up"),
    ] {
        let ran = path(&folder, &format!("{ends} {arguments}"));
        assert_eq!(ran.status, 1, "{arguments}: {}", ran.out);
        assert!(ran.err.contains(message), "{arguments}: {}", ran.err);
    }
    for cost in ["if(x<0.3,1e18,1)", "if(x<0.3,1e12,1e-12)"] {
        let answer = folder.json("path", format!("{ends} --spacing 0.05 --cost '{cost}'"));
        let [cost, lower] = ["cost", "lower"].map(|name| answer[name].as_f64().unwrap());
        assert!(lower > 0.9 * cost && lower <= cost, "{lower} {cost}");
    }
}

#[test]
fn a_project_or_its_recipe_decides_places_cost_and_regions_unless_options_do() {
    let folder = Folder::new("project");
    let ring = [(0.4, -0.1), (0.6, -0.1), (0.6, 0.7), (0.4, 0.7)].map(|(x, y)| dvec2(x, y));
    let region = |name: &str, low: f64| KeepOut {
        name: name.into(),
        mask: Mask::new(&[vec![ring.map(|p| dvec2(p.x, p.y + low)).to_vec()]]).unwrap(),
    };
    let routes =
        vec![vec![dvec2(0.1, 0.1), dvec2(0.9, 0.1)], vec![dvec2(0.1, 0.9), dvec2(0.2, 0.8), dvec2(0.2, 0.9)]];
    let cost = PathCost::Weighted(Weights { length: 3.0, risk: 1.0 });
    let plan = PathPlan {
        routes: routes.clone(),
        cost: cost.clone(),
        keep_out: [region("a", 0.0)].into(),
        ..PathPlan::default()
    };
    let settings = Settings { paths: Arc::new(plan), ..Settings::default() };
    let document = Document::new(settings, None).unwrap();
    let project = Project { settings: document.settings().clone(), paint: document.paint().clone() };
    let mut bytes = Vec::new();
    project::write(&mut bytes, &project).unwrap();
    fs::write(folder.0.join("p.meshbrush"), bytes).unwrap();
    RecipeFiles::new(&project, &folder.0.join("p.toml")).write(&Meter::default()).unwrap();
    let number = |options: &str| {
        let [stored, text] = ["--project p.meshbrush", "p.toml"].map(|file| {
            let mut answer = folder.json("path", format!("{file} {options}"));
            answer.as_object_mut().unwrap().remove("seconds");
            answer
        });
        assert_eq!(stored, text, "the project and its recipe with {options}");
        stored["cost"].as_f64().unwrap()
    };
    // What the window does: the derived mesh, and a planner for the plan.
    let spec = document.settings().mesh_spec().unwrap();
    let mut builder = MeshBuilder::new(spec);
    while builder.advance(Some(document.paint()), 100_000).unwrap() != Progress::Done {}
    let mesh = builder.finish().mesh;
    let risk = RiskField::new(&document.settings().layers, document.paint());
    let density = cost.density(risk, &document.settings().domain).unwrap();
    let masks = document.settings().paths.keep_out_masks();
    let mut planner =
        Planner::new(PathMesh::with_keep_out(mesh.extract().view(), &masks), &*density).unwrap();
    for (route, places) in routes.iter().enumerate() {
        let expected = planner.solve(&*density, places, PathRequest::FULL).unwrap();
        assert_eq!(number(&format!("--route {}", route + 1)), expected.cost);
    }
    let around = 3.0 * (2.0 * f64::hypot(0.3, 0.6) + 0.2);
    assert!((number("") - around).abs() < 0.03 * around && number("") >= around);
    assert!((number("--length-weight 2") / number("") - 2.0 / 3.0).abs() < 1e-9);
    assert!((number("--cost 1") / number("") - 1.0 / 3.0).abs() < 1e-9);
    assert!((number("--from 0.1,0.1 --to 0.3,0.1") - 0.6).abs() < 1e-9);
    let ring = "[[[0.1,0.3],[0.2,0.3],[0.2,0.4],[0.1,0.4],[0.1,0.3]]]";
    fs::write(folder.0.join("other.geojson"), format!("{{\"type\":\"Polygon\",\"coordinates\":{ring}}}"))
        .unwrap();
    assert!((number("--keep-out other.geojson") - 2.4).abs() < 1e-9);
    let refused = |arguments: &str, message: &str| {
        let ran = path(&folder, arguments);
        assert!(ran.status == 2 && ran.err.contains(message), "{arguments}: {}", ran.err);
    };
    refused("--project p.meshbrush --route 3", "the paths of p.meshbrush are numbered from 1 to 2");
    refused("p.toml --route 3", "the paths of p.toml are numbered from 1 to 2");
    fs::write(folder.0.join("bare.toml"), "[mesh]\nspacing = 0.1\n").unwrap();
    refused("bare.toml", "bare.toml has no path: give --from X,Y and --to X,Y, or add `routes` to [paths].");
    refused("--spacing 0.1 --route 1", "give --from X,Y and --to X,Y");
    refused("--spacing 0.1", "give --from X,Y and --to X,Y");
}

#[test]
fn every_output_is_written() {
    let folder = Folder::new("outputs");
    let outputs = "-o path.geojson -o path.csv -o path.svg -o path.png --size 200 --simplify 0.01";
    let options =
        "--from 0.1,0.1 --to 0.9,0.8 --risk 'exp(-20*hypot(x-0.5, y-0.5)^2)' --h-min 0.1 --h-max 0.2";
    let answer = folder.json("path", format!("{options} {COARSE} {outputs}"));
    let points = answer["points"].as_array().unwrap();
    let feature: Value = serde_json::from_str(&folder.read("path.geojson")).unwrap();
    assert_eq!(feature["geometry"]["coordinates"].as_array().unwrap(), points);
    assert_eq!(feature["properties"]["cost"], answer["cost"]);
    let table = folder.read("path.csv");
    assert_eq!(table.lines().next().unwrap(), "x,y,distance,cost,risk,density");
    assert_eq!(table.lines().count(), points.len() + 1);
    let last: Vec<f64> = table.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!((last[3] - answer["cost"].as_f64().unwrap()).abs() < 1e-3 * last[3]);
    assert!((last[2] - answer["length"].as_f64().unwrap()).abs() < 1e-9);
    assert!(folder.read("path.svg").contains("<polyline") && points.len() < 60);
    assert_eq!(&fs::read(folder.0.join("path.png")).unwrap()[1..4], b"PNG");
}

#[test]
fn bad_input_has_a_sentence_and_a_status() {
    let folder = Folder::new("bad");
    let ends = format!("--from 0.1,0.1 --to 0.9,0.8 {COARSE}");
    let ends = ends.as_str();
    let outside = format!("--from 0.1,0.1 --to 1.5,0.8 {COARSE}");
    for (arguments, status, message) in [
        (outside.clone(), 1, "The goal (1.5, 0.8) lies outside the domain."),
        (format!("--from 0.1 --to 1,1 {COARSE}"), 2, "“0.1” is no point."),
        (format!("{ends} --cost 'x - 0.5'"), 1, "A cost per unit of length must be positive and finite"),
        (
            format!("{ends} --cost '1 + rsk'"),
            2,
            "There is no `rsk`; a cost is a formula of `x`, `y` and `risk`.",
        ),
        (format!("{ends} --length-weight 0 --risk-weight 0"), 1, "one of them above 0."),
        (format!("{ends} --length-weight 0"), 1, "give the length a weight above 0."),
        (format!("{ends} --within 0"), 2, "--within 0: write a share"),
        (format!("{ends} -o path.vtu"), 2, "use .geojson, .csv, .gpx, .kml, .svg or .png."),
        (format!("{ends} --simplify -1"), 1, "A tolerance of -1 is no distance"),
        (format!("{ends} --cost 1 --risk-weight 2"), 2, "cannot be used with"),
    ] {
        let ran = path(&folder, &arguments);
        assert_eq!(ran.status, status, "{arguments}: {}", ran.err);
        assert!(ran.err.contains(message), "{arguments}: {}", ran.err);
    }
    let same = folder.json("path", format!("--from 0.5,0.5 --to 0.5,0.5 {COARSE} --within 1%"));
    assert_eq!((&same["cost"], &same["lower"]), (&0.0.into(), &0.0.into()));
}
