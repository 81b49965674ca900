//! The program itself, run as a person runs it.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::folder::{Folder, Ran};
use serde_json::Value;

const DIAMOND: &str = "--domain -10,-10,10,10 --spacing 1 --target";

fn diamond(target: f64) -> String {
    format!("{DIAMOND} 'if(abs(x)+abs(y)<8, {target:?}, 20)' --rule vertex")
}

#[test]
fn threads_stand_on_either_side_of_a_command_and_files_only_after_it() {
    let folder = Folder::new("cli-threads");
    for arguments in ["--threads 2 mesh --target 0.5", "mesh --target 0.5 --threads 2"] {
        assert_eq!(folder.run(arguments).status, 0, "{arguments}");
    }
    let ran = folder.run("coast.geojson mesh");
    assert_eq!(ran.status, 2);
    assert!(ran.err.contains("'coast.geojson' stands before the command"), "{}", ran.err);
}

#[test]
fn the_series_of_section_5_4_comes_out() {
    let counts =
        [1088, 1600, 2888, 4936, 9560, 17752, 35176, 67944, 135544, 266616, 532872, 1057160, 2113944];
    let folder = Folder::new("cli-series");
    for (level, count) in (1..).zip(counts) {
        let halved = 0.5f64.powi(level / 2);
        // Odd levels are exact; even ones are irrational, so a hair above.
        let target = if level % 2 == 1 { halved } else { halved * 2.0f64.sqrt() * (1.0 + 1e-12) };
        let summary = folder.json("mesh", diamond(target));
        assert_eq!(summary["triangles"], count, "level {level}");
        assert_eq!(summary["max_level"], level);
    }
}

#[test]
fn the_summary_says_all_that_a_program_asks() {
    let folder = Folder::new("cli-summary");
    let summary = folder.json("mesh", diamond(0.25));
    assert_eq!(summary["triangles"], 9560);
    assert_eq!(summary["nodes"], 4821);
    assert_eq!(summary["levels"], serde_json::json!([440, 72, 72, 144, 384, 8448]));
    assert_eq!(summary["spacing"], 1.0);
    assert_eq!(summary["rule"], "vertex");
    assert!(summary["seconds"].as_f64().is_some_and(|s| (0.0..60.0).contains(&s)));
    let hash = summary["hash"].as_str().unwrap();
    assert!(hash.len() == 32 && hash.chars().all(|c| c.is_ascii_hexdigit()));
    // The same mesh by way of an even-level target has the same hash; another mesh has another.
    assert_eq!(folder.json("mesh", diamond(0.26))["hash"], hash);
    assert_ne!(folder.json("mesh", diamond(0.24))["hash"], hash);
}

#[test]
fn without_a_rule_no_thin_feature_is_missed() {
    let folder = Folder::new("cli-thin");
    let options = "--spacing 0.25 --target 'if(abs(x - 0.3) < 0.001, 0.01, 1)'";
    let default = folder.json("mesh", options);
    assert_eq!(default["rule"], "area");
    let missed = folder.json("mesh", format!("{options} --rule vertex"));
    assert_eq!(missed["levels"], serde_json::json!([32]));
    assert!(default["triangles"].as_u64() > Some(1000), "{default}");
}

#[test]
fn people_get_the_summary_on_standard_error() {
    let ran = Folder::new("cli-people").run(format!("mesh --checks {}", diamond(0.25)));
    assert_eq!((ran.status, ran.out.as_str()), (0, ""));
    assert!(ran.err.contains("9,560 triangles, 4,821 nodes, levels 0 to 5"), "{}", ran.err);
    assert!(ran.err.contains("every invariant of the mesh holds"));
    assert!(ran.err.lines().any(|l| l.split_whitespace().eq(["4", "0.353553", "384"])), "{}", ran.err);
}

#[test]
fn every_ending_is_written_and_the_files_agree() {
    let folder = Folder::new("cli-endings");
    let outputs =
        "-o m.vtu -o m.msh -o m.obj -o m.NODE -o m.csv -o m.stl -o m.ply -o m.glb -o m.2dm -o m.svg";
    let ran = folder.run(format!("mesh {} {outputs} --quantity x*y", diamond(0.25)));
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert_eq!(
        folder.names(),
        [
            "m.2dm", "m.NODE", "m.csv", "m.edge", "m.ele", "m.glb", "m.msh", "m.neigh", "m.obj", "m.ply",
            "m.stl", "m.svg", "m.vtu"
        ]
    );
    assert_eq!(folder.read("m.csv").lines().count(), 9561);
    assert!(folder.read("m.csv").lines().next().unwrap().ends_with("quantity1,quantity2,quantity3"));
    let named =
        folder.run("mesh --spacing 0.5 --quantity depth=x --quantity 'two = 2*x' -o named.csv -o named.vtu");
    assert_eq!(named.status, 0, "{}", named.err);
    assert!(
        folder.read("named.csv").lines().next().unwrap().ends_with("depth1,depth2,depth3,two1,two2,two3")
    );
    assert!(folder.read("m.ele").starts_with("9560 3 1\n"));
    let nodes = folder.read("m.NODE");
    assert!(nodes.starts_with("4821 2 2 1\n1 ") && nodes.contains(" -10 -10 20 100 1\n"));
    assert!(folder.read("m.msh").contains("$Nodes\n1 4821 1 4821\n"));
    assert_eq!(folder.read("m.obj").lines().filter(|l| l.starts_with("f ")).count(), 9560);
    assert!(folder.read("m.svg").contains("<title>9560 triangles, 4821 nodes</title>"));
    assert!(folder.read("m.svg").contains("width=\"1600\" height=\"1600\""));
}

#[test]
fn pictures_are_coloured_by_a_measure_with_its_legend() {
    let folder = Folder::new("cli-color-by");
    let mesh = diamond(0.25);
    for (by, title, is_graded) in [
        ("levels", "Level, diameter, count", true),
        ("target", "h̄ by level", true),
        ("target-ratio", "Longest edge / h̄", true),
        ("smallest_angle", "Smallest angle", false),
        ("triangles_at_node", "Triangles at a node", false),
    ] {
        let ran = folder.run(format!("mesh {mesh} -o m.svg --furniture legend --color-by {by}"));
        assert_eq!(ran.status, 0, "{}", ran.err);
        let svg = folder.read("m.svg");
        assert!(svg.contains(&format!("<title>{title}</title>")), "{by}");
        let fills = svg.matches("<path fill=\"#").count() + svg.matches("<path transform").count();
        assert!(fills > if is_graded { 4 } else { 0 }, "{by}: {fills}");
        assert_eq!(svg.contains("id=\"level-"), by == "levels", "{by}");
    }
    for (options, sentence) in [
        ("--color-by time_step", "--color-by time_step: no triangle has a time step"),
        (
            "--color-by angle",
            "--color-by: “angle” is nothing that triangles can be coloured by; use levels, target",
        ),
        ("--color-by edge_ratio --view space", "--color-by with --view space: a view in space shows levels"),
    ] {
        let ran = folder.run(format!("mesh {mesh} -o m.png {options}"));
        assert!(ran.status == 2 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
}

#[test]
fn furniture_that_a_picture_cannot_have_is_said() {
    let folder = Folder::new("cli-furniture");
    let note = "There is no arrow to the north: the document does not lie on the Earth.";
    for (furniture, is_said) in [("north,scale", true), ("all", false), ("axes", false)] {
        let options = format!("--furniture {furniture} --size 400");
        let ran = folder.run(format!("mesh {} -o m.png -o m.svg {options}", diamond(0.25)));
        assert_eq!(ran.status, 0, "{}", ran.err);
        assert_eq!(ran.err.matches(note).count(), usize::from(is_said), "{furniture}: {}", ran.err);
    }
}

#[test]
fn a_picture_shows_the_levels() {
    let folder = Folder::new("cli-picture");
    let run = |options: &str| {
        let ran = folder.run(format!("mesh {} -o m.png {options}", diamond(0.25)));
        assert_eq!(ran.status, 0, "{}", ran.err);
        let file = std::io::BufReader::new(fs::File::open(folder.0.join("m.png")).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(frame.color_type, png::ColorType::Rgba);
        let pixel = |x: u32, y: u32| {
            let at = 4 * (y * frame.width + x) as usize;
            <[u8; 4]>::try_from(&bytes[at..at + 4]).unwrap()
        };
        let middle = pixel(frame.width / 2 + 2, frame.height / 2 - 1);
        ([frame.width, frame.height], pixel(frame.width / 10, frame.height / 20 + 1), middle)
    };
    let plain = "--no-edges --size 400";
    // Level 0 is close to the canvas; the deepest level takes the end of the colour map.
    assert_eq!(run(plain), ([400, 400], [0x1d, 0x21, 0x2b, 255], [0xfd, 0xe7, 0x25, 255]));
    assert_eq!(run(&format!("{plain} --light")).1, [0xe9, 0xec, 0xf1, 255]);
    assert_eq!(run(&format!("{plain} --colormap greys")).2, [249, 249, 249, 255]);
    assert_ne!(run("--size 400").2, [0xfd, 0xe7, 0x25, 255], "an edge runs there");
    assert_eq!(run("--size 300x200").0, [300, 200]);
}

/// Returns an image of grey bytes, the top row first.
fn png(size: [u32; 2], grey: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(grey).unwrap();
    file
}

#[test]
fn an_image_of_risk_refines_where_it_is_bright() {
    let folder = Folder::new("cli-risk");
    // A white line one pixel wide, near the top: between the nodes of a coarse grid of four cells.
    let mut grey = vec![0; 64 * 64];
    grey[6 * 64..7 * 64].fill(255);
    folder.file("risk.png", png([64, 64], &grey));
    let options = "--risk-raster risk.png --h-min 0.02 --spacing 0.25 --checks";
    let by_area = folder.json("mesh", format!("{options} -o m.csv"));
    assert_eq!(by_area["violations"], 0);
    let table = folder.read("m.csv");
    assert_eq!(by_area["max_level"], 9);
    let finest = table.lines().skip(1).filter(|row| row.split(',').nth(1) == Some("9"));
    let heights: Vec<f64> = finest.map(|row| row.split(',').nth(9).unwrap().parse().unwrap()).collect();
    assert!(!heights.is_empty());
    // The line covers 57/64 to 58/64; the triangles that meet it, and those bisected with them, reach 1/64
    // beyond.
    assert!(heights.iter().all(|y| (56.0 / 64.0..=59.0 / 64.0).contains(y)), "{heights:?}");
    // The report's rule sees nothing of it.
    let by_vertex = folder.json("mesh", format!("{options} --rule vertex"));
    assert_eq!(by_vertex["triangles"], 32);
}

#[test]
fn grids_lie_where_they_say_and_images_cover_the_domain() {
    let folder = Folder::new("cli-grids");
    let header = "ncols 2\nnrows 2\nxllcorner 4\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
    folder.file("length.asc", format!("{header}-9999 -9999\n-9999 0.1\n"));
    let own = folder.json("mesh", "--target-raster length.asc -o own.csv --spacing 1");
    assert_eq!(own["spacing"], 1.0);
    assert_eq!(own["max_level"], 8); // 2^-3 (level 7) is longer than 0.1, √2 · 2^-4 is not
    // The same pixels ask on a larger domain, and there their outer edges are met from both sides.
    let wide = folder.json("mesh", "--target-raster length.asc --domain 2,-2,8,4 --spacing 1");
    let finest = |summary: &Value| summary["levels"][8].as_u64().unwrap();
    assert_eq!(wide["max_level"], 8);
    assert!(finest(&own) < finest(&wide) && finest(&wide) < 2 * finest(&own), "{own} {wide}");
    // Black asks for --h-min, white for --h-max.
    folder.file("grey.png", png([2, 1], &[0, 255]));
    let image = "--target-raster grey.png --domain 0,0,2,1 --spacing 1 --h-max 1.5";
    assert_eq!(folder.json("mesh", format!("{image} --h-min 1.45"))["triangles"], 4);
    assert_eq!(folder.json("mesh", format!("{image} --h-min 0.5"))["max_level"], 3);
    // A grid that misses the domain asks for nothing, and that is said.
    let ran = folder.run("mesh --target-raster length.asc --domain 0,0,1,1");
    assert!(ran.err.contains("does not meet the domain") && ran.err.contains("800 triangles"), "{}", ran.err);
}

#[test]
fn points_are_found_and_values_interpolated() {
    let folder = Folder::new("cli-points");
    let rows = "0.3,0.15\n0.5,0.5\n0.5,0.1\n0,0\n2,2\nNaN,0\n-0.9,-0.9\n";
    folder.file("points.csv", format!("x,y\n\n{rows}"));
    let options = "--domain -1,-1,1,1 --spacing 0.5 --inside 'r < 1.2' --target 'if(r < 0.4, 0.125, 1)'";
    let ran = folder.run(format!("locate {options} --points points.csv --quantity '2*x + y'"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    let mut lines = ran.out.lines();
    assert_eq!(lines.next(), Some("x,y,where,triangle,level,v1,v2,v3,zeta1,zeta2,zeta3,value"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let wheres: Vec<&str> = rows.iter().map(|row| row[2]).collect();
    assert_eq!(wheres, ["inside", "vertex", "edge", "vertex", "outside", "invalid", "outside"]);
    for row in &rows {
        assert_eq!(row.len(), 12);
        let numbers: Vec<f64> = row[8..].iter().filter_map(|field| field.parse().ok()).collect();
        let [x, y] = [row[0], row[1]].map(|field| field.parse::<f64>().unwrap());
        match numbers[..] {
            [a, b, c, value] => {
                assert!((a + b + c - 1.0).abs() < 1e-15);
                assert!((value - (2.0 * x + y)).abs() < 1e-12, "a linear quantity is met exactly");
            }
            _ => assert!(row[3..].iter().all(|field| field.is_empty())),
        }
    }
    let to_file = folder.run(format!("locate {options} --points points.csv -o found.csv"));
    assert_eq!((to_file.status, to_file.out.as_str()), (0, ""));
    let values: Vec<String> =
        folder.read("found.csv").lines().map(|row| row.rsplit(',').next().unwrap().to_owned()).collect();
    assert_eq!(values[4], "0.125");
}

/// A square of side 4 with a square hole of side 2 that runs the same way round.
const FRAME: &str = r#"{"type": "Feature", "geometry": {"type": "Polygon", "coordinates":
    [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [3, 1], [3, 3], [1, 3], [1, 1]]]}}"#;

#[test]
fn a_region_is_meshed_as_its_boundary_asks() {
    let folder = Folder::new("cli-region");
    folder.file("frame.geojson", FRAME);
    let shape = |summary: &Value| {
        ["region_area", "region_holes", "area", "holes", "parts"].map(|key| summary[key].as_f64().unwrap())
    };
    let fitted = folder.json("mesh", "--region frame.geojson --spacing 1 --checks");
    assert_eq!(shape(&fitted), [12.0, 1.0, 12.0, 1.0, 1.0]);
    // The default diameter is that of level 7, an eighth of the spacing, as the help says.
    assert_eq!((&fitted["max_level"], &fitted["violations"]), (&7.into(), &0.into()));
    let eighth = folder.json("mesh", "--region frame.geojson --spacing 1 --boundary-diameter 0.125");
    assert_eq!(eighth["hash"], fitted["hash"]);
    let help = folder.run("mesh --help").out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("move onto it [default: an eighth of the spacing]"), "{help}");
    assert_eq!(
        folder.json("mesh", "--region frame.geojson --spacing 1 --boundary fitted")["hash"],
        fitted["hash"]
    );
    let coarser = folder.json("mesh", "--region frame.geojson --spacing 1 --boundary-diameter 0.5 --checks");
    assert_eq!((&coarser["max_level"], &coarser["violations"]), (&3.into(), &0.into()));
    // By the report the corners of the hole are cut: half a cell each.
    let report = folder.json("mesh", "--region frame.geojson --spacing 1 --boundary report --checks");
    assert_eq!(shape(&report), [12.0, 1.0, 13.0, 1.0, 1.0]);
    assert_eq!((&report["triangles"], &report["max_level"]), (&26.into(), &0.into()));
    // Sizes from a field and the outline go together; what lies in the hole asks for nothing.
    let target = "--target 'if(max(abs(x - 2), abs(y - 2)) < 0.5, 0.001, 1)'";
    assert_eq!(folder.json("mesh", format!("--region frame.geojson --spacing 1 {target}"))["max_level"], 7);
    let ran = folder.run("mesh --region frame.geojson --spacing 1");
    assert!(
        ran.err.contains(
            "area 12, 0.000 % more than the polygons' 12; 0.000 % misclassified\n\
             1 hole in 1 part, 1 of 1 island kept; angles 45.0° to 90.0°\n\
             boundary 1 times as long as the outline; farthest from the outline 0, from the mesh 0\n"
        ),
        "{}",
        ran.err
    );
    assert!(
        folder.json("mesh", "--spacing 1")["region_area"].is_null(),
        "there is no outline to compare with"
    );
}

/// A named area between a lake with a name and an unnamed one: the second is too small for the mesh.
const NAMED: &str = r#"{"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"id": 7, "NAME": "Forest \"A\""}, "geometry": {"type": "Polygon", "coordinates": [
        [[0, 0], [9, 0], [8, 5], [4, 8], [1, 5]], [[3, 3], [5, 3], [5, 5], [3, 5]], [[2, 2], [2.01, 2], [2, 2.01]]]}},
    {"type": "Feature", "properties": {"id": 5}, "geometry": {"type": "Polygon", "coordinates": [
        [[11, 1], [13, 1], [12, 3]]]}},
    {"type": "Feature", "properties": null, "geometry": {"type": "Polygon", "coordinates": [
        [[15, 1], [17, 1], [16, 3]]]}}]}"#;

#[test]
fn pieces_of_the_boundary_have_names() {
    let folder = Folder::new("cli-names");
    folder.file("named.geojson", NAMED);
    let summary = folder.json("mesh", "--region named.geojson --spacing 1 --parts all -o m.msh");
    let pieces = summary["boundary"].as_array().unwrap();
    let names: Vec<&str> = pieces.iter().map(|piece| piece["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["open south", "Forest 'A'", "5", "mainland 3", "Forest 'A' island 1"]);
    let ids: Vec<u64> = pieces.iter().map(|piece| piece["id"].as_u64().unwrap()).collect();
    assert_eq!(ids, [0, 1, 2, 3, 4]);
    let kinds: Vec<&str> = pieces.iter().map(|piece| piece["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["open", "mainland", "mainland", "mainland", "island"]);
    assert_eq!(pieces[0]["length"].as_f64(), Some(9.0));
    assert!(pieces.iter().all(|piece| piece["edges"].as_u64().unwrap() > 0));
    // A piece without an edge is lost, and so is its island.
    let lost = &summary["lost_pieces"];
    assert_eq!(
        (lost.as_array().unwrap().len(), &lost[0]["id"], &lost[0]["kind"]),
        (1, &5.into(), &"island".into())
    );
    assert_eq!(lost[0]["name"], "Forest 'A' island 2");
    let lost = &summary["lost_islands"];
    assert!((lost[0]["area"].as_f64().unwrap() - 5e-5).abs() < 1e-7, "{lost}");
    assert_eq!((lost.as_array().unwrap().len(), &lost[0]["name"]), (1, &"Forest 'A' island 2".into()));
    assert!((lost[0]["place"][0].as_f64().unwrap() - 2.0).abs() < 0.02);
    let parts: Vec<u64> =
        summary["part_triangles"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).collect();
    assert_eq!(parts.iter().sum::<u64>(), summary["triangles"].as_u64().unwrap());
    assert_eq!(parts.len(), 3);
    let [shortest, longest, ratio] = ["shortest_edge", "longest_edge", "size_ratio"]
        .map(|name| summary["statistics"][name].as_f64().unwrap());
    assert!(0.0 < shortest && shortest < longest && longest < 2.0 && (1.0..4.0).contains(&ratio));
    let quality = &summary["quality"];
    for (measure, count) in
        [("smallest_angle", "triangles"), ("target_ratio", "triangles"), ("triangles_at_node", "nodes")]
    {
        let bins = quality[measure]["bins"].as_array().unwrap().iter();
        let counted: u64 = bins.map(|bin| bin["count"].as_u64().unwrap()).sum();
        assert_eq!(counted, summary[count].as_u64().unwrap(), "{measure}: {quality}");
    }
    assert_eq!(quality["smallest_angle"]["least"]["value"], summary["statistics"]["smallest_angle"]);
    assert_eq!(quality["largest_angle"]["greatest"]["value"], summary["statistics"]["largest_angle"]);
    assert!(quality.get("time_step").is_none(), "lengths are degrees, and there are no depths");
    let file = folder.read("m.msh");
    assert!(file.contains("\n1 5 \"Forest 'A' island 1\"\n2 1 \"domain\"\n$EndPhysicalNames\n"), "{file}");
    assert!(file.contains(
        "\ncommand: meshbrush mesh --json --region named.geojson --spacing 1 --parts all -o m.msh\n"
    ));
    assert!(file.contains("\ncoordinates: x, y as in named.geojson\nunit: degrees\n"));
    assert_eq!(summary["unit"], "degrees");
    let fingerprint = format!("\nfingerprint: {}\n", summary["hash"].as_str().unwrap());
    assert!(file.contains(&fingerprint));
    folder.json("mesh", "--region named.geojson --spacing 1 --parts all --binary -o b.msh");
    assert!(fs::read(folder.0.join("b.msh")).unwrap().starts_with(b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n"));
    let ran = folder.run("mesh --binary -o b.vtu");
    assert!(ran.err.contains("--binary changes nothing: no .msh is written"), "{}", ran.err);
    // A rectangle and a formula have names too.
    let names = |options: &str| {
        let summary = folder.json("mesh", options);
        let pieces = summary["boundary"].as_array().unwrap().iter();
        pieces.map(|piece| piece["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names("--spacing 0.5"), ["open south", "open east", "open north", "open west"]);
    let ring = "--domain -2,-2,2,2 --spacing 0.25 --inside 'r < 1.7 and r > 0.6'";
    assert_eq!(names(ring), ["mainland", "island 1"]);
}

/// Two squares that a strait parts, which is narrower than the triangles, and a third far away.
const STRAIT: &str = r#"{"type": "MultiPolygon", "coordinates": [
    [[[0, 0], [4, 0], [4, 4], [0, 4]]], [[[4.01, 4], [8, 4], [8, 8], [4.01, 8]]], [[[7, 0], [8, 0], [8, 1], [7, 1]]]]}"#;

#[test]
fn polygons_that_are_cut_at_the_antimeridian_are_not_halved_silently() {
    let folder = Folder::new("cli-antimeridian");
    let half = |west: f64, east: f64| format!("[[[{west},-18],[{east},-18],[{east},-16],[{west},-16]]]");
    let of =
        |halves: [String; 2]| format!(r#"{{"type":"MultiPolygon","coordinates":[{}]}}"#, halves.join(","));
    folder.file("cut.geojson", of([half(177.0, 180.0), half(-180.0, -178.0)]));
    let ran = folder.run("mesh --region cut.geojson --spacing 1");
    assert!(ran.err.contains("cut.geojson is cut at the antimeridian (longitude 180°)"), "{}", ran.err);
    folder.file("whole.geojson", of([half(177.0, 180.0), half(180.0, 182.0)]));
    let ran = folder.run("mesh --region whole.geojson --spacing 1");
    assert!(ran.status == 0 && !ran.err.contains("antimeridian"), "{}", ran.err);
}

#[test]
fn a_fitted_mesh_is_one_part_without_pinches_unless_more_is_asked_for() {
    let folder = Folder::new("cli-parts");
    folder.file("strait.geojson", STRAIT);
    let mesh = |boundary: &str, options: &str| {
        let options = format!("--region strait.geojson --boundary {boundary} --spacing 1 --checks {options}");
        let summary = folder.json("mesh", &options);
        assert_eq!(summary["violations"], 0, "{options}");
        let number = |key: &str| summary[key].as_f64().unwrap();
        let removed = &summary["removed"];
        let parts = removed["parts"].as_array().unwrap().len();
        ([number("parts"), number("area").round()], parts, removed["pinches"].as_u64().unwrap())
    };
    // The two large squares touch in one node.
    let fitted = |options: &str| mesh("fitted", options);
    assert_eq!(fitted("--parts all --keep-pinches"), ([3.0, 33.0], 0, 0));
    let (all, _, pinches) = fitted("--parts all");
    assert_eq!((all[0], pinches), (3.0, 1));
    assert_eq!(fitted("").0, [1.0, 16.0]);
    assert_eq!(fitted("").1, 2);
    assert_eq!(fitted("--parts 0.1").0[0], 2.0);
    assert_eq!(fitted("--parts largest").0, [1.0, 16.0]);
    let ran = folder.run("mesh --region strait.geojson --boundary fitted --spacing 1");
    assert!(ran.err.contains("removed "), "{}", ran.err);
    // With nodes on the outline there are no pinches to begin with.
    assert_eq!(mesh("outline", "--parts all").1, 0);
    assert!(mesh("outline", "--parts all").0[0] > 1.0);
    assert_eq!((mesh("outline", "").0[0], mesh("outline", "").2), (1.0, 0));
    for wrong in ["some", "1.5", "-1", "nan"] {
        assert_fails(
            &folder,
            &format!("mesh --parts {wrong}"),
            2,
            &format!("--parts {wrong}: write largest, all,"),
        );
    }
}

#[test]
fn points_in_a_region_are_found_in_the_triangles_of_its_files() {
    let folder = Folder::new("cli-region-points");
    folder.file("frame.geojson", FRAME);
    // On the outer side, on the hole's side and its corner, inside, in the hole, beyond.
    folder.file("points.csv", "x,y\n4,2.3\n3,2.5\n1,1\n0.3,2.9\n3.9,3.8\n2,2\n5,5\n");
    let input = "--region frame.geojson --spacing 1";
    assert_eq!(folder.run(format!("mesh {input} -o m.node")).status, 0);
    let rows = |text: &str| -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        text.lines().skip(1).filter(|line| !line.starts_with('#')).map(numbers).collect()
    };
    let (nodes, elements) = (rows(&folder.read("m.node")), rows(&folder.read("m.ele")));
    let ran = folder.run(format!("locate {input} --points points.csv"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    let found: Vec<Vec<&str>> = ran.out.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let wheres: Vec<&str> = found.iter().map(|row| row[2]).collect();
    assert_eq!(wheres[2..3], ["vertex"]);
    assert_eq!(wheres[5..], ["outside", "outside"]);
    for row in &found[..5] {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let element = &elements[number(3) as usize];
        assert_eq!(element[0], number(3) + 1.0, "numbers of these files start at one");
        let (corners, listed) = ([5, 6, 7].map(number), [1, 2, 3].map(|i| element[i] - 1.0));
        assert_eq!(
            (corners, number(4)),
            (listed, element[4]),
            "its vertices, in the file's order, and level"
        );
        let mut place = [0.0; 2];
        for (corner, zeta) in [(5, 8), (6, 9), (7, 10)] {
            let node = &nodes[number(corner) as usize];
            (0..2).for_each(|i| place[i] += number(zeta) * node[1 + i]);
        }
        assert!((place[0] - number(0)).abs() < 1e-12 && (place[1] - number(1)).abs() < 1e-12, "{row:?}");
    }
}

#[test]
fn bad_regions_are_explained() {
    let folder = Folder::new("cli-bad-regions");
    folder.file("frame.geojson", FRAME);
    let polygon = |rings: &str| format!(r#"{{"type":"Polygon","coordinates":{rings}}}"#);
    folder.file("empty.geojson", "");
    folder.file("cut.geojson", &FRAME[..120]);
    folder.file("text.geojson", "first line\n");
    folder.file("infinite.geojson", polygon("[[[0,0],[1,0],\n[1e999,1]]]"));
    folder.file("nan.geojson", polygon("[[[0,0],[1,0],\n\n[NaN,1]]]"));
    folder.file("deep.geojson", polygon(&"[".repeat(100_000)));
    let points = r#"{"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}}]}"#;
    folder.file("points.geojson", points);
    folder.file("line.geojson", polygon("[[[0,0],[1,1],[2,2]]]"));
    folder.file("narrow.geojson", polygon("[[[0,0],[1e12,0],[0,1e-3]]]"));
    folder.file("vast.geojson", polygon("[[[-1.7e308,-1.7e308],[1.7e308,0],[0,1.7e308]]]"));
    folder.file("huge.geojson", polygon("[[[0,0],[1e300,0],[1e300,1e300],[0,1e300]]]"));
    folder.file("mixed.geojson", polygon("[[[0,0],[1,0],[0,[1,2]]]]"));
    for (arguments, status, sentence) in [
        ("--region none.geojson", 1, "none.geojson: cannot be read"),
        ("--region empty.geojson", 1, "empty.geojson, line 1: the file ends too early"),
        ("--region cut.geojson", 1, "cut.geojson, line 2: the file ends too early"),
        ("--region text.geojson", 1, "text.geojson, line 1: this is not valid GeoJSON"),
        (
            "--region infinite.geojson",
            1,
            "infinite.geojson, line 2: this is not valid GeoJSON: number out of range",
        ),
        ("--region nan.geojson", 1, "nan.geojson, line 3: this is not valid GeoJSON"),
        (
            "--region deep.geojson",
            1,
            "deep.geojson, line 1: this is not valid GeoJSON: recursion limit exceeded",
        ),
        (
            "--region points.geojson",
            1,
            "points.geojson: a domain needs a Polygon or a MultiPolygon, and it has Point",
        ),
        ("--region line.geojson", 1, "line.geojson: The polygons cover no area"),
        ("--region narrow.geojson", 1, "is too narrow"),
        ("--region vast.geojson", 1, "their width and their height must lie between 1e-120 and 1e150"),
        ("--region huge.geojson", 1, "their width and their height must lie between 1e-120 and 1e150"),
        ("--region mixed.geojson", 1, "mixed.geojson, line 1: this is not valid GeoJSON: a list has both"),
        ("--region .", 1, ".: cannot be read"),
        ("--region frame.geojson --domain 0,0,1,1", 2, "cannot be used with '--domain"),
        ("--region frame.geojson --inside x", 2, "cannot be used with '--inside"),
        (
            "--boundary-diameter 0.1",
            2,
            "--boundary-diameter 0.1: it is for the outline of a domain. Name a file with --region",
        ),
        (
            "--region frame.geojson --boundary report --boundary-diameter 0.1",
            2,
            "Take --boundary fitted, or leave it out.",
        ),
        (
            "--region frame.geojson --boundary-diameter 0",
            2,
            "--boundary-diameter 0: a length must be positive",
        ),
        (
            "--region frame.geojson --boundary-diameter NaN",
            2,
            "--boundary-diameter NaN: a length must be positive",
        ),
        (
            "--region frame.geojson --boundary-diameter 1e-300",
            1,
            "--boundary-diameter 1e-300: below 8.429e-9 (level 50) nodes would leave the lattice.",
        ),
        (
            "--region frame.geojson --boundary-diameter 0.001 --max-triangles 1000",
            1,
            "more than 1,000 triangles",
        ),
        ("--region frame.geojson --boundary nearly", 2, "invalid value 'nearly'"),
        ("--region frame.geojson -o frame.geojson", 2, "frame.geojson"),
    ] {
        let before = folder.names();
        assert_fails(&folder, &format!("mesh {arguments}"), status, sentence);
        assert_eq!(folder.names(), before, "{arguments}");
        assert_eq!(folder.read("frame.geojson"), FRAME, "{arguments}");
    }
}

#[test]
fn a_level_cap_is_kept_and_said() {
    let folder = Folder::new("cli-cap");
    let ran = folder.run(format!("mesh --max-level 3 --checks {}", diamond(0.25)));
    assert_eq!(ran.status, 0);
    assert!(ran.err.contains("levels 0 to 3") && ran.err.contains("--max-level left"), "{}", ran.err);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = Folder::new("cli-pipe");
    let rows = "0.3,0.2\n".repeat(20_000);
    folder.file("points.csv", format!("x,y\n{rows}"));
    let mut command = folder.command("locate --points points.csv");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = [0; 10];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    // The pipe is closed here, with most of the answer unread.
    let ran = Ran::new(child.wait_with_output().unwrap());
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
}

/// Runs a command that must fail: one sentence on standard error, no result, no panic.
fn assert_fails(folder: &Folder, arguments: &str, status: i32, sentence: &str) {
    let ran = folder.run(arguments);
    assert_eq!(ran.status, status, "{arguments}: {}", ran.err);
    assert!(ran.err.contains(sentence), "{arguments}: {}", ran.err);
    assert!(!ran.err.contains("panicked"), "{arguments}: {}", ran.err);
    assert_eq!(ran.out, "", "{arguments}");
    if !ran.err.starts_with("error: ") {
        assert!(ran.err.starts_with("meshbrush: "), "{arguments}: {}", ran.err);
        // A formula's mistake is followed by the formula and carets.
        let lines = if ran.err.contains('^') { 3 } else { 1 };
        assert!(ran.err.lines().count() <= lines, "{arguments}: {}", ran.err);
    }
}

#[test]
fn impossible_targets_fail_with_their_place() {
    let folder = Folder::new("cli-targets");
    for (options, sentence) in [
        ("--rule vertex --target 0", "The target diameter is 0 at x = "),
        ("--rule vertex --target -1", "The target diameter is -1 at x = "),
        ("--rule vertex --target 'sqrt(x - 2)'", "The target diameter is NaN at x = "),
        ("--rule vertex --target 'if(x < 0.5, 0.1, 0/0)'", "The target diameter is NaN at x = 0."),
        ("--rule vertex --target 1e-300", "nodes would leave the lattice"),
        ("--rule vertex --target 0.05 --target -x", "The target diameter is 0 at x = 0"),
        ("--rule vertex --target -1 --h-min 0.1", "The target diameter is -1 at x = "),
        ("--rule vertex --risk 0/0 --h-min 0.01", "The target diameter is NaN at x = "),
        ("--target 0", "gives 0 at x = "),
        ("--target -1 --h-min 0.1", "gives -1 at x = "),
        ("--target 0.05 --target -x", "a target diameter must be positive"),
        ("--target 'x - 0.3'", "gives -0.00"),
        ("--target 'sqrt(x - 2)'", "gives NaN at x = "),
        ("--target 'if(x < 0.5, 0.1, 0/0)'", "gives NaN at x = "),
        ("--risk 0/0 --h-min 0.01", "a risk must be a number from 0 to 1"),
        ("--target 1e-300", "nodes would leave the lattice"),
        ("--target 0.001 --max-triangles 1000", "more than 1,000 triangles, which is the limit"),
        (
            "--target 0.001 --max-memory 1MB",
            "more than 10,416 triangles, and 1 MB of memory, which is the limit",
        ),
        (
            "--target 0.001 --max-memory 1MB --max-triangles 900",
            "more than 900 triangles, which is the limit",
        ),
        ("--target 0.05 --quantity 1/x -o new.vtu", "The quantity is inf at x = 0, y = 0"),
        ("--target 0.05 --quantity depth=1/x -o new.vtu", "The quantity depth is inf at x = 0, y = 0"),
    ] {
        folder.file("old.vtu", "old");
        assert_fails(&folder, &format!("mesh {options} -o old.vtu --json"), 1, sentence);
        assert_eq!(folder.read("old.vtu"), "old", "{options}");
        assert_eq!(folder.names(), ["old.vtu"], "{options}");
    }
}

#[test]
fn wrong_arguments_are_explained() {
    let folder = Folder::new("cli-arguments");
    for (arguments, status, sentence) in [
        ("mesh --spacing 0", 2, "--spacing 0: a length must be positive and finite."),
        ("mesh --spacing -1", 2, "--spacing -1: a length"),
        ("mesh --spacing NaN", 2, "--spacing NaN: a length"),
        ("mesh --spacing inf", 2, "--spacing inf: a length"),
        ("mesh --spacing 1e-9", 1, "the limit is 50,000,000"),
        ("mesh --spacing 1e-300", 1, "the limit is 50,000,000"),
        ("mesh --spacing 3x", 2, "invalid value '3x'"),
        ("mesh --spacing 3mm", 2, "--spacing 3mm: lengths of this domain are plain numbers"),
        ("mesh --domain 1,0,0,1", 2, "x0 less than x1"),
        ("mesh --domain 0,0,0,1", 2, "x0 less than x1"),
        ("mesh --domain 0,0,1", 2, "write four numbers with commas between"),
        ("mesh --domain 0,0,1,NaN", 2, "finite numbers"),
        ("mesh --domain 0,0,inf,1", 2, "finite numbers"),
        ("mesh --domain 0,0,1e300,1e300", 2, "sides between 1e-120 and 1e150"),
        ("mesh --domain 1e16,0,1.0000000000000008e16,8 --spacing 1", 1, "Move the domain nearer"),
        ("mesh --target '1 + 2*sqr(x)'", 2, "--target: There is no `sqr`; write `v^2`."),
        ("mesh --target ''", 2, "meshbrush: --target: "),
        ("mesh --risk x", 2, "need --h-min"),
        ("mesh --risk x --h-min 2 --h-max 1", 2, "exchange them"),
        ("mesh --risk x --h-min 0.1 --transfer-shape 0", 2, "The shape 0 of the transfer curve"),
        ("mesh --risk x --h-min -0.1", 2, "--h-min -0.1: a length"),
        ("mesh --inside 0", 1, "No coarse triangle lies in the domain"),
        ("mesh --max-triangles 0", 2, "--max-triangles 0: choose from"),
        ("mesh --max-memory 2", 2, "--max-memory 2: give a size with its unit, such as 500MB or 2GB."),
        ("mesh --max-memory much", 2, "--max-memory much: give a size with its unit"),
        ("mesh --max-memory 2PB", 2, "--max-memory 2PB: give a size with its unit"),
        ("mesh --max-memory NaNGB", 2, "--max-memory NaNGB: give a size"),
        ("mesh --max-memory 0GB", 2, "--max-memory 0GB: choose 1MB at least"),
        ("mesh --max-memory -1GB", 2, "--max-memory -1GB: choose 1MB at least"),
        ("mesh --rule both", 2, "invalid value 'both'"),
        (
            "mesh -o mesh.xyz",
            2,
            "use one of .vtu .msh .msh2 .obj .stl .ply .glb .node .2dm .csv .14 .grd .gr3 .ll .nc .slf .mesh .ww3 .dat .disv .svg .png",
        ),
        ("mesh -o mesh", 2, "-o mesh: the ending chooses the format; use one of .vtu"),
        ("mesh -o m.svg --size 0", 2, "--size 0: write a width"),
        ("mesh -o m.svg --colormap jet", 2, "There is no colormap `jet`"),
        ("mesh -o nowhere/m.vtu", 1, "nowhere/m.vtu cannot be written: there is no folder nowhere."),
        ("mesh --target-raster risk.jpg", 2, "a raster ends in .png"),
        ("mesh --unknown", 2, "unexpected argument"),
        ("locate", 2, "--points"),
        ("locate --points nothing.csv", 1, "nothing.csv: cannot be read"),
    ] {
        assert_fails(&folder, arguments, status, sentence);
        assert_eq!(folder.names(), [""; 0], "{arguments}");
    }
}

#[test]
fn a_formula_is_shown_with_a_pointer() {
    let ran = Folder::new("cli-pointer").run("mesh --target '1 + 2*sqr(x)'");
    let lines: Vec<&str> = ran.err.lines().collect();
    let expected =
        ["meshbrush: --target: There is no `sqr`; write `v^2`.", "    1 + 2*sqr(x)", "          ^^^"];
    assert_eq!(lines, expected);
}

#[test]
fn bad_files_are_named_with_the_rule_they_break() {
    let folder = Folder::new("cli-files");
    let good = png([8, 8], &[128; 64]);
    folder.file("short.png", &good[..good.len() - 30]);
    folder.file("text.png", "not a picture");
    folder.file("empty.png", "");
    folder.file("bomb.png", bomb());
    folder.file("short.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
    folder.file("metres.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n483\n");
    folder.file("points.csv", "x,y\n1,2\n1,east\n");
    fs::create_dir(folder.0.join("folder.vtu")).unwrap();
    fs::create_dir(folder.0.join("taken.neigh")).unwrap();
    folder.file("edited.edge", "a project by another name");
    for (arguments, status, sentence) in [
        ("mesh --h-min 0.1 --risk-raster none.png", 1, "none.png: cannot be read"),
        ("mesh --h-min 0.1 --risk-raster short.png", 1, "short.png: the file ends too early"),
        ("mesh --h-min 0.1 --risk-raster text.png", 1, "text.png: this is not a PNG image"),
        ("mesh --h-min 0.1 --risk-raster empty.png", 1, "empty.png: "),
        ("mesh --h-min 0.1 --risk-raster bomb.png", 1, "100,000 × 100,000 pixels cannot be read"),
        ("mesh --target-raster short.asc", 1, "short.asc, line 7: the file ends too early"),
        ("mesh --h-min 0.1 --risk-raster metres.asc", 1, "metres.asc: the risk is 483 at x = 0.5, y = 0.5"),
        ("mesh --target-raster short.png", 2, "need --h-min"),
        ("mesh -o folder.vtu", 1, "folder.vtu cannot be written: a folder has this name"),
        ("mesh -o taken.node", 1, "taken.neigh cannot be written: a folder has this name"),
        ("mesh --project edited.edge -o edited.node", 2, "edited.edge is an input file"),
        ("locate --points points.csv", 1, "points.csv, line 3: y is `east`, which is not a number."),
        ("locate --points points.csv -o points.csv", 2, "points.csv is an input file"),
    ] {
        let before = folder.names();
        assert_fails(&folder, arguments, status, sentence);
        assert_eq!(folder.names(), before, "{arguments}");
    }
}

/// Returns a small file that announces an image of ten thousand million pixels.
fn bomb() -> Vec<u8> {
    let header = b"IHDR\x00\x01\x86\xa0\x00\x01\x86\xa0\x10\x06\x00\x00\x00";
    let crc = !header.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
    });
    [b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0d", &header[..], &crc.to_be_bytes()].concat()
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_an_error() {
    // Nobody, the superuser included, makes files here.
    let folder = Folder::new("cli-unwritable");
    if Path::new("/proc/self").is_dir() {
        assert_fails(
            &folder,
            "mesh --target 0.05 -o /proc/self/m.vtu --json",
            1,
            "/proc/self/m.vtu cannot be written",
        );
    }
}

#[test]
fn help_and_version_are_results() {
    let folder = Folder::new("cli-help");
    for arguments in ["--help", "mesh --help", "locate -h", "--version"] {
        let ran = folder.run(arguments);
        assert_eq!((ran.status, ran.err.as_str()), (0, ""), "{arguments}");
        assert!(!ran.out.is_empty());
    }
}

#[cfg(not(feature = "gui"))]
#[test]
fn a_build_without_a_window_says_so() {
    assert_fails(&Folder::new("cli-window"), "", 2, "built without its window");
}

#[test]
fn shells_complete_the_options() {
    let folder = Folder::new("cli-completions");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ran = folder.run(format!("completions {shell}"));
        assert_eq!(ran.status, 0, "{}", ran.err);
        for word in ["meshbrush", "max-triangles", "project"] {
            assert!(ran.out.contains(word), "{shell}: no {word}");
        }
    }
    assert_eq!(folder.run("completions dos").status, 2);
}

#[test]
fn every_command_has_a_man_page() {
    let folder = Folder::new("cli-man");
    let ran = folder.run("man pages");
    assert_eq!((ran.status, ran.out.as_str()), (0, ""), "{}", ran.err);
    let page = folder.read("pages/meshbrush-why.1");
    // The examples stay lines, with the signs that a shell needs.
    for line in [
        r"\fB\-\-max\-triangles\fR \fI<N>\fR",
        ".SH EXAMPLES\n.nf\n",
        r"\&meshbrush why 2.5,1 \-\-project coast.meshbrush \-\-json",
        r"\(aq0.01 + 0.2*hypot(x \- 0.5, y \- 0.5)\(aq",
    ] {
        assert!(page.contains(line), "no {line} in {page}");
    }
    let program = folder.read("pages/meshbrush.1");
    assert!(program.contains(r"meshbrush\-mesh(1)") && !program.contains(r"meshbrush\-man"), "{program}");
    let ran = folder.run("man pages/meshbrush.1");
    assert_eq!(ran.status, 1);
    assert!(ran.err.contains("cannot be written"), "{}", ran.err);
}

/// As [`Folder::run`], with bytes on standard input.
fn run_with_input(folder: &Folder, arguments: &str, input: &str) -> Ran {
    let mut child = folder
        .command(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    Ran::new(child.wait_with_output().unwrap())
}

const TRIANGLE: &str = r#"{"type":"Polygon","coordinates":[[[0,0],[4,0],[0,4],[0,0]]]}"#;

#[test]
fn a_dash_is_standard_input_or_output() {
    let folder = Folder::new("cli-dash");
    let region = run_with_input(&folder, "mesh --region - --json", TRIANGLE);
    assert_eq!(region.status, 0, "{}", region.err);
    assert!((region.json()["region_area"].as_f64().unwrap() - 8.0).abs() < 1e-6);
    let located = run_with_input(&folder, "locate --spacing 0.5 --points - -o -", "lon;lat\n0,25;0,5\n");
    assert!(
        located.out.contains("\n0.25,0.5,vertex,") || located.out.contains("\n0.25,0.5,edge,"),
        "{located:?}"
    );
    folder.run("mesh --spacing 0.5 -o file.csv -o file.vtu");
    for ending in ["csv", "vtu"] {
        let piped = folder.command(format!("mesh --spacing 0.5 -o - --format {ending}")).output().unwrap();
        assert!(piped.status.success());
        // The files say by which command they were made.
        let without_command = |bytes: &[u8]| {
            let lines = bytes.split(|&byte| byte == b'\n');
            lines.filter(|line| !line.starts_with(b"command: ")).collect::<Vec<_>>().join(&b'\n')
        };
        let file = fs::read(folder.0.join(format!("file.{ending}"))).unwrap();
        assert_eq!(without_command(&piped.stdout), without_command(&file), "{ending}");
    }
    assert_fails(&folder, "mesh -o -", 2, "name one with --format, as in --format vtu.");
    assert_fails(&folder, "mesh -o - --format node", 2, "--format node: this format has 4 files");
    assert_fails(&folder, "mesh -o - --format doc", 2, "--format doc: use one of vtu msh msh22 obj");
    assert_fails(
        &folder,
        "mesh -o - --format vtu --json",
        2,
        "-o - and --json both print on standard output",
    );
    assert_fails(&folder, "locate --region - --points -", 2, "--region - and --points - both read");
    let wrong = run_with_input(&folder, "mesh --region -", "{}");
    assert!(wrong.err.contains("standard input"), "{}", wrong.err);
}

#[test]
fn a_name_chooses_among_the_formats_of_an_ending() {
    let folder = Folder::new("cli-format");
    let start = |name: &str| folder.read(name).lines().take(2).collect::<Vec<_>>().join(" ");
    folder.run("mesh --spacing 0.5 --format ww3 -o ww3.msh -o sea.2dm -o other.txt --quantity depth=9-x");
    // WAVEWATCH III reads whole numbers there.
    assert_eq!(start("ww3.msh"), "$MeshFormat 2 0 8");
    assert_eq!(start("other.txt"), "$MeshFormat 2 0 8");
    assert!(start("sea.2dm").starts_with("MESH2D"), "its ending says another format");
    assert!(folder.read("ww3.msh").contains(" 0 0 9\n"), "the depth");
    folder.run("mesh --spacing 0.5 -o usual.msh -o older.msh2");
    assert_eq!(start("usual.msh"), "$MeshFormat 4.1 0 8");
    assert_eq!(start("older.msh2"), "$MeshFormat 2.2 0 8");
    folder.run("mesh --spacing 0.5 --format msh22 -o named.msh");
    let without_origin = |name: &str| folder.read(name).split("$Comments").next().unwrap().to_owned();
    assert_eq!(without_origin("named.msh"), without_origin("older.msh2"));
    let ran = folder.run("mesh --spacing 0.5 --format fvcom -o bay_grd.dat");
    // The first open node, its number in the mesh, and its type.
    assert!(ran.status == 0 && start("bay_obc.dat").starts_with("OBC Node Number = 8 1 "), "{}", ran.err);
    assert!(start("bay_obc.dat").ends_with(" 1"));
    assert!(ran.err.contains("wrote bay_grd.dat") && ran.err.contains("wrote bay_dep.dat"), "{}", ran.err);
    assert_fails(&folder, "mesh -o a.vtu --format doc", 2, "--format doc: use one of vtu msh msh22 obj");
    let apart = "mesh --domain 0,0,4,4 --spacing 1 --inside 'max(x,y) <= 2 or min(x,y) >= 2' --boundary report -o a.14";
    let ran = folder.run(apart);
    let refusal = "fort.14 needs two boundary edges at each boundary node, and at x = 2, y = 2";
    assert!(ran.status == 1 && ran.err.contains(refusal) && !folder.0.join("a.14").exists(), "{}", ran.err);
}

#[test]
fn options_that_change_nothing_are_named() {
    let folder = Folder::new("cli-no-effect");
    for (arguments, note) in [
        ("mesh --transfer-shape 2", "--transfer-shape changes nothing without --risk"),
        ("mesh --boundary report", "--boundary changes nothing without --region"),
        (
            "mesh --improve-boundary",
            "`improve_boundary` changes nothing: the mesh has no nodes on an outline",
        ),
        (
            "mesh --inside x+y<1 --boundary report --improve-boundary",
            "`improve_boundary` changes nothing: the mesh",
        ),
        ("mesh --keep-pinches", "`keep_pinches` changes nothing: the mesh is not fitted"),
        ("mesh --quantity x", "--quantity changes nothing: no file with data"),
        ("mesh --quantity x -o m.svg", "--quantity changes nothing: no file with data"),
        ("mesh --light -o m.vtu", "The options on pictures change nothing"),
        ("mesh --format vtu -o m.vtu", "--format changes nothing: the endings of the files"),
    ] {
        let ran = folder.run(arguments);
        assert_eq!(ran.status, 0, "{arguments}: {}", ran.err);
        assert!(ran.err.contains(&format!("meshbrush: note: {note}")), "{arguments}: {}", ran.err);
    }
    let ran = folder.run("mesh --spacing 0.2 --quantity x -o m.vtu --json");
    assert_eq!(ran.err.trim(), "wrote m.vtu", "without a note");
}

#[test]
fn a_value_at_a_vertex_does_not_depend_on_the_others() {
    let folder = Folder::new("cli-vertex-value");
    folder.file("p.csv", "x,y\n0.5,0.5\n");
    let ran = folder.run("locate --spacing 0.5 --points p.csv --quantity 1/x");
    assert!(ran.out.trim().ends_with(",2"), "{}", ran.out);
}

#[test]
#[cfg(target_os = "linux")]
fn a_signal_during_an_export_leaves_the_old_file_and_no_part_of_the_new_one() {
    let folder = Folder::new("cli-signal");
    // A signal that the tests are told to ignore, as by `nohup`, is ignored by the program too.
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    let ignored = u64::from_str_radix(ignored.trim(), 16).unwrap();
    let signals = [("INT", 2), ("TERM", 15), ("HUP", 1)];
    for (signal, number) in signals.into_iter().filter(|(_, number)| ignored >> (number - 1) & 1 == 0) {
        folder.file("m.msh", "old");
        let large = "mesh --spacing 0.05 --target 0.0012 -o m.msh";
        let mut child = folder.command(large).stderr(Stdio::null()).spawn().unwrap();
        let part = || folder.names().iter().any(|name| name.ends_with(".part"));
        while !part() {
            assert!(child.try_wait().unwrap().is_none(), "it ended before it was interrupted");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        // The shell's own `kill`: a minimal system has no other.
        let kill = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status();
        assert!(kill.unwrap().success());
        let status = child.wait().unwrap();
        assert_eq!(std::os::unix::process::ExitStatusExt::signal(&status), Some(number), "{signal}");
        assert_eq!((folder.names(), folder.read("m.msh")), (vec!["m.msh".to_owned()], "old".to_owned()));
    }
}

#[test]
fn a_target_of_infinity_asks_for_nothing() {
    let folder = Folder::new("cli-infinity");
    let hash = |arguments: &str| folder.json("mesh", arguments)["hash"].clone();
    assert_eq!(hash("--target 1/0"), hash("--target 100"));
    assert_eq!(hash("--target 1/0 --target 0.02"), hash("--target 0.02"));
    assert_ne!(hash("--target 0.02"), hash("--target 100"));
}

#[test]
fn a_recorded_session_is_replayed_and_a_difference_gives_status_1() {
    let folder = Folder::new("cli-replay");
    let text = fs::read_to_string("tests/sessions/random_gestures.jsonl").unwrap();
    let lines: Vec<&str> = text.lines().take(6).collect();
    folder.file("a.jsonl", lines.join("\n") + "\n");
    let ran = folder.run("replay a.jsonl");
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
    assert!(
        ran.out.starts_with("4 edits replayed: every mesh is the recorded one, and the last has "),
        "{ran:?}"
    );
    assert_eq!(folder.run("replay a.jsonl --json").json()["agrees"], true);

    let last: Value = serde_json::from_str(lines[5]).unwrap();
    let found = last["gives"]["mesh"]["fingerprint"].as_str().unwrap();
    folder.file("b.jsonl", lines.join("\n").replace(found, "an old one") + "\n");
    let ran = folder.run("replay b.jsonl --json");
    assert_eq!(ran.status, 1);
    let difference = &ran.json()["difference"];
    assert_eq!(difference["edit"], ran.err.split_once("after edit ").unwrap().1[..1].parse::<u64>().unwrap());
    assert!(difference["expected"].as_str().unwrap().starts_with("an old one"));
    assert!(ran.err.contains("expected is an old one") && ran.err.contains(found), "{ran:?}");
    assert_eq!(folder.run("replay missing.jsonl").status, 1);
}

#[test]
fn the_experiment_of_the_report_has_its_triangles() {
    let ran = Folder::new("cli-report").run("report --runs 2 --level 7 --json");
    assert_eq!(ran.status, 0, "{ran:?}");
    let answer = ran.json();
    let rows = answer["meshes"].as_array().unwrap();
    let triangles: Vec<_> = rows.iter().map(|row| row["triangles"].as_u64().unwrap()).collect();
    assert_eq!(triangles[..6], [1088, 1600, 2888, 4936, 9560, 17752]);
    assert_eq!(rows[4]["triangles_in_report"], 9560);
    assert!(answer["exponent"].as_f64().unwrap().is_finite() && answer["gradient_in_report"] == 1.01);
    assert!(answer["exponent_uncertainty"].as_f64().unwrap() >= 0.0 && answer["is_disturbed"].is_boolean());
    for row in rows {
        let runs = row["runs"].as_array().unwrap();
        let seconds =
            |run: &serde_json::Value| run.get("processor").unwrap_or(&run["wall"]).as_f64().unwrap();
        let least = runs.iter().map(seconds).fold(f64::INFINITY, f64::min);
        assert!(runs.len() == 2 && row["seconds"].as_f64() == Some(least), "{row}");
    }
}
