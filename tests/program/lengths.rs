//! Lengths with units, in recipes and on the command line.

use crate::earth::on_the_ellipsoid;
use crate::folder::Folder;

const SEA: &str = r#"{"type":"Polygon","coordinates":[[[14,58],[16,58],[16,59],[14,59],[14,58]]]}"#;
const CABLE: &str = r#"{"type":"LineString","coordinates":[[14.5,58.3],[15.5,58.7]]}"#;

/// The same document in a recipe with units, in a recipe with numbers and as options is one mesh.
#[test]
fn a_recipe_with_units_is_the_recipe_with_numbers_and_the_command_line() {
    let folder = Folder::new("lengths");
    folder.file("sea.geojson", SEA);
    folder.file("cable.geojson", CABLE);
    let recipe = |projection: &str, lengths: [&str; 6]| {
        let [spacing, h_min, target, at_zero, range, diameter] = lengths;
        format!(
            "[domain]\nregion = \"sea.geojson\"\n{projection}boundary_diameter = {diameter}\n[mesh]\nspacing = {spacing}\n\
             [limits]\nh_min = {h_min}\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = {target}\n\
             [[layer]]\nkind = \"distance\"\nfile = \"cable.geojson\"\nat_zero = {at_zero}\nslope = 0.2\nrange = {range}\n"
        )
    };
    let units = ["'20 nmi'", "'1500 m'", "'8 km'", "'2000m'", "'0.02e3 km'", "\"6000\""];
    folder.file("units.toml", recipe("", units));
    let numbers = ["37_040", "1500", "'8000'", "2000", "20_000", "6000"];
    folder.file("numbers.toml", recipe("projection = \"auto\"\n", numbers));
    let options = "--region sea.geojson --spacing '20 nmi' --h-min '1500 m' --target '8 km' --distance cable.geojson \
                   --distance-at-zero 2000m --distance-range '20 km' --boundary-diameter 6000";
    let [units, numbers, options] = ["units.toml", "numbers.toml", options].map(|what| {
        let answer = folder.json("mesh", what);
        assert!(answer["triangles"].as_u64() > Some(1000), "{what}: {answer}");
        answer["hash"].clone()
    });
    assert_eq!((&units, &options), (&numbers, &numbers));
    // An option in place of a value has its own unit.
    let finer = folder.json("mesh", "units.toml --h-min '1 km' --spacing '18.52 km'");
    assert_eq!(finer["hash"], folder.json("mesh", "numbers.toml --h-min 1000 --spacing 18520")["hash"]);
}

/// Lengths that have no meaning in a document are refused with a sentence, on the command line too.
#[test]
fn units_that_have_no_meaning_are_refused() {
    let folder = Folder::new("no-lengths");
    folder.file("sea.geojson", SEA);
    let region = "[domain]\nregion = \"sea.geojson\"\n";
    for (recipe, sentence) in [
        (
            "[mesh]\nspacing = \"40 km\"\n".to_owned(),
            "mesh, spacing: \"40 km\" cannot be used: lengths of this domain are plain numbers. Name a region",
        ),
        (
            format!("{region}projection = \"none\"\n[limits]\nh_min = \"2 km\"\n"),
            "limits, h_min: \"2 km\" cannot be used: lengths of this domain are in degrees",
        ),
        (format!("{region}projection = \"auto\"\n[mesh]\nspacing = \"0.1°\"\n"), "are in metres. Give the"),
        (
            format!("{region}[mesh]\nspacing = \"-40 km\"\n"),
            "\"-40 km\" cannot be used: a length must be positive",
        ),
        (format!("{region}[mesh]\nspacing = \"\"\n"), "line 4, column 11: this text is empty"),
        (format!("{region}[mesh]\nspacing = \"2 apples\"\n"), "“apples” cannot be converted to m"),
    ] {
        folder.file("sea.toml", &recipe);
        let ran = folder.run("mesh sea.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{recipe}: {}", ran.err);
    }
    let ran = folder
        .run("mesh --region sea.geojson --projection none --feature-size 4 --h-min 0.1 --widest-feature 9km");
    assert!(ran.err.contains("--widest-feature 9km: lengths of this domain are in degrees"), "{}", ran.err);
}

/// A path is simplified by metres on the Earth: far in the north of a chart in Mercator as well.
#[test]
fn the_tolerance_of_a_simplified_path_is_a_length_on_the_earth() {
    let folder = Folder::new("simplified");
    folder.file("sea.geojson", SEA.replace("58]", "68]").replace("59]", "69]"));
    let [start, goal] = [[14.1, 68.5], [15.9, 68.5]];
    let words = "--region sea.geojson --spacing 20km --target 2km --from 14.1°,68.5° --to 15.9°,68.5°";
    let path = |options: &str| -> Vec<[f64; 2]> {
        let chart = [
            "--crs",
            "lonlat",
            "--projection",
            "+proj=merc +lon_0=15",
            "--out-crs",
            "+proj=merc +lon_0=15",
            "--cost",
            "1 + 2*exp(-((x^2 + (y - 10560e3)^2)/30e3^2))",
        ];
        let words = words.split(' ').chain(chart).chain(options.split_whitespace());
        folder.json("path", words.chain(["-o", "path.geojson"]).collect::<Vec<_>>());
        let text: serde_json::Value = serde_json::from_str(&folder.read("path.geojson")).unwrap();
        serde_json::from_value(text["geometry"]["coordinates"].clone()).unwrap()
    };
    let (all, simple) = (path(""), path("--simplify 1km"));
    let scale = (all[all.len() - 1][0] - all[0][0]) / on_the_ellipsoid(start, goal);
    assert!((2.7..2.8).contains(&scale), "{scale}");
    let to_segment = |at: [f64; 2], ends: &[[f64; 2]]| {
        let [a, b, p] = [ends[0], ends[1], at].map(glam::DVec2::from);
        let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, share)) / scale
    };
    let off = |&at: &[f64; 2]| simple.windows(2).map(|ends| to_segment(at, ends)).fold(f64::MAX, f64::min);
    let farthest = all.iter().map(off).fold(0.0, f64::max);
    assert!((500.0..1010.0).contains(&farthest), "{farthest} m with {} points", simple.len());
    let ran = folder.run(format!("path {words} --simplify 0.1°"));
    assert!(ran.err.contains("--simplify 0.1°: lengths of this domain are in metres"), "{}", ran.err);
}
