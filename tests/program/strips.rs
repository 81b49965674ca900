//! Strips in which the frame of a sea runs along a coast: what is cut off, and that the recipe has it.

use crate::folder::Folder;
use serde_json::Value;

/// A bay, and west of it a strip as wide as a triangle between its frame, below, and the coast.
const BAY: &str = "[[0, 0], [40, 0], [40, 20], [24, 20], [24, 1], [0, 1], [0, 0]]";
/// Two bays, which nothing but such a strip joins.
const TWO_BAYS: &str = "[[0, 0], [60, 0], [60, 20], [42, 20], [42, 1], [18, 1], [18, 20], [0, 20], [0, 0]]";

fn sea(ring: &str) -> (Folder, &'static str) {
    let folder = Folder::new(if ring == BAY { "strips-bay" } else { "strips-two-bays" });
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}");
    folder.file("sea.geojson", polygon);
    let recipe = "[domain]\nregion = \"sea.geojson\"\nbounds = [0, 0, 60, 21]\nopen = \"frame\"\nboundary_diameter = 1.2\n\n\
                  [mesh]\nspacing = 4\n\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"1.5\"\n";
    folder.file("sea.toml", recipe);
    (folder, recipe)
}

fn strips(answer: &Value) -> usize {
    let notes = answer["notes"].as_array().unwrap();
    notes.iter().filter(|note| note["rule"] == "strip_along_frame").count()
}

#[test]
fn a_strip_is_cut_off_and_the_recipe_with_its_rings_has_the_same_mesh() {
    let (folder, recipe) = sea(BAY);
    let before = folder.json("check", "sea.toml --for adcirc");
    assert_eq!(strips(&before), 1, "{before}");
    let cut = folder.json("check", "sea.toml --for adcirc --cut-strips");
    assert_eq!((strips(&cut), &cut["cut_strips"]["left"]), (0, &Value::Array(vec![])), "{cut}");
    assert_eq!((&cut["cut_strips"]["for"], &cut["cut_strips"]["strips"]), (&"adcirc".into(), &1.into()));
    // The bay has its triangles, and the strip has none.
    let count = |answer: &Value| answer["triangles"].as_u64().unwrap();
    assert!(count(&cut) < count(&before) - 20 && count(&cut) > count(&before) / 2);
    let text = folder.run("check sea.toml --for adcirc --cut-strips");
    let rings = text.out.split_once("\n\ncut_off = ").unwrap().1;
    let mesh = folder.json("mesh", "sea.toml --cut-strips-for adcirc -o sea.14");
    assert_eq!((&mesh["hash"], &mesh["cut_strips"]), (&cut["hash"], &cut["cut_strips"]));
    let with_rings = recipe.replacen("[domain]\n", &format!("[domain]\ncut_off = {rings}"), 1);
    folder.file("cut.toml", with_rings);
    let by_recipe = folder.json("mesh", "cut.toml -o cut.14");
    assert_eq!(by_recipe["hash"], mesh["hash"]);
    let numbers = |name: &str| folder.read(name).lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(numbers("cut.14"), numbers("sea.14"), "with the same open and closed boundaries");
    // West of the bay nothing is open any more, and nothing is left.
    let summary = folder.json("check", "cut.toml --for adcirc --cut-strips");
    assert_eq!(summary["cut_strips"]["strips"], 0);
}

#[test]
fn a_strip_that_joins_two_seas_stays_and_is_told_with_its_place() {
    let (folder, _) = sea(TWO_BAYS);
    let before = folder.json("check", "sea.toml --for schism");
    assert_eq!(strips(&before), 1, "{before}");
    let cut = folder.json("check", "sea.toml --for schism --cut-strips");
    assert_eq!((strips(&cut), &cut["hash"]), (1, &before["hash"]));
    let left = &cut["cut_strips"]["left"][0];
    assert!(left["sentence"].as_str().unwrap().contains("would be parted from the sea"), "{left}");
    assert!((18.0..42.0).contains(&left["place"][0].as_f64().unwrap()), "{left}");
}

#[test]
fn rings_that_cut_nothing_or_everything_off_are_refused() {
    let (folder, recipe) = sea(BAY);
    for (rings, sentence) in [
        ("[[[0, 5], [1, 5], [1, 6]]]", "this ring does not meet the domain"),
        ("[[[0, 0], [1, 5]]]", "a ring to cut off needs 3 points at least"),
        ("[[[-1, -1], [90, -1], [90, 90], [-1, 90]]]", "nothing would be left"),
        ("[[[0, 0], [nan, 0], [1, 1]]]", "both coordinates of a point must be finite"),
    ] {
        folder.file("cut.toml", recipe.replacen("[domain]\n", &format!("[domain]\ncut_off = {rings}\n"), 1));
        let ran = folder.run("mesh cut.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{rings}: {}", ran.err);
        assert!(ran.err.contains("cut_off"), "{}", ran.err);
    }
    let ran = folder.run("mesh sea.toml --cut-strips-for swan");
    assert!(ran.status == 2 && ran.err.contains("SWAN has no rule on strips"), "{}", ran.err);
}
