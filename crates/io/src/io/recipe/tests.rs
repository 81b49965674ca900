use std::path::{Path, PathBuf};

use super::*;
use crate::io::layers::SavedLayer;
use crate::io::lengths::SavedLength;
use crate::io::settings::SavedParts;
use crate::io::{Given, PlaceInFile, TextValue};
use meshbrush_mesh::text::LengthUnit;

/// A recipe with every table and every kind of layer.
const FULL: &str = r#"
[domain]
region = "sea.geojson"
unit = "degrees"
boundary = "outline"
boundary_diameter = 0.02
parts = 0.01
keep_pinches = true
splits = [[1, 2]]
names = [{ at = [3, 4], name = "harbour" }]
types = [{ at = [3, 4], type = "no-slip land" }]

[mesh]
spacing = 0.5
rule = "area"
max_triangles = 1_000_000
max_level = 20
max_memory = "2GB"

[limits]
h_min = 0.01
h_risk = 0.02
h_max = 1
shape = 1.5
gradation = 0.3

[[layer]]
kind = "formula"
name = "Open sea"
quantity = "diameter"
formula = "0.5 + 0.1*x"

[[layer]]
kind = "raster"
file = "depth.asc"
curve = [[-100, 0.5], [0, 0.02]]
mask = [[[[22, 35], [28, 35], [28, 41]]]]

[[layer]]
kind = "threats"
threats = [
  { x = 24, y = 37, range = 0.5, peak = 0.9, law = "gaussian" },
  { x = 25, y = 38, range = 0.7 },
]

[[layer]]
kind = "distance"
to = "outline"
at_zero = 0.02
slope = 0.2

[[layer]]
kind = "band"
file = "depth.asc"
between = [-20, 0]
diameter = 0.03
combine = "floor"

[[layer]]
kind = "paint"
quantity = "risk"
file = "harbour.meshbrush"

[paths]
routes = [[[23, 36], [24.5, 38], [26, 39]], [[22, 35], [28, 41]]]
length_weight = 2
risk_weight = 7.5
clearance = 0.125

[[keep_out]]
name = "Minefield"
polygons = [[[[24, 37], [25, 37], [25, 38]]]]

[[keep_out]]
file = "zones/closed.geojson"

[pins]
at = [[23, 37], [24.25, 36.5]]

[[output]]
file = "sea.vtu"
quantities = ["depth = 20 - x"]

[[output]]
file = "sea.png"
size = "1600x900"
edges = false
colormap = "magma"
light = true
"#;

fn find(name: &str) -> Result<PathBuf, String> {
    if name.starts_with("gone") { Err(format!("{name} cannot be found.")) } else { Ok(name.into()) }
}

fn parsed(text: &str) -> Result<Recipe, ReadError> {
    parse(Path::new("a/recipe.toml"), text.to_owned(), &find)
}

/// Returns the place and sentence of an error, with the two lines that point.
fn error(text: &str) -> ([usize; 2], String) {
    let error = parsed(text).expect_err(text);
    let PlaceInFile::Column { line, column } = error.place else { panic!("{text:?} gave {error}") };
    assert!(error.to_string().starts_with(&format!("a/recipe.toml, line {line}, column {column}: ")));
    ([line, column], error.flaw.to_string())
}

#[test]
fn a_recipe_with_everything_is_read() {
    let settings = parsed(FULL).unwrap().settings;
    assert_eq!(settings.domain.region.as_deref(), Some(Path::new("sea.geojson")));
    assert_eq!(
        (settings.mesh.spacing, settings.mesh.max_memory.as_deref()),
        (Some(SavedLength(0.5)), Some("2GB"))
    );
    let limits = &settings.limits;
    assert_eq!([limits.h_min, limits.h_risk, limits.h_max], [0.01, 0.02, 1.0].map(|h| Some(SavedLength(h))));
    assert_eq!((limits.shape, limits.gradation), (Some(1.5), Some(0.3)));
    assert_eq!(settings.domain.parts, Some(SavedParts::Share(0.01)));
    let names: Vec<&str> = settings.layer.iter().map(|layer| layer.shown_name()).collect();
    assert_eq!(names, ["Open sea", "Raster", "Threats", "Distance", "Band", "Paint"]);
    assert_eq!(settings.domain.names[0].name, "harbour");
    let outputs: Vec<_> = settings.output.iter().map(|output| output.file.as_path()).collect();
    let paths = &settings.paths;
    assert_eq!(paths.routes[0][1], [24.5, 38.0]);
    assert_eq!((paths.routes.len(), settings.pins.at.len()), (2, 2));
    assert_eq!((paths.length_weight, paths.risk_weight), (Some(2.0), Some(7.5)));
    assert_eq!(paths.clearance, Some(SavedLength(0.125)));
    let regions: Vec<&str> = settings.keep_out.iter().filter_map(|region| region.name.as_deref()).collect();
    assert_eq!(regions, ["Minefield", "closed.geojson"]);
    assert!(settings.files().any(|file| file == Path::new("zones/closed.geojson")));
    assert_eq!(outputs, [Path::new("a/sea.vtu"), Path::new("a/sea.png")], "beside the recipe");
    assert!(parsed("").unwrap().settings.layer.is_empty());
}

#[test]
fn unknown_keys_are_named_with_line_column_and_the_nearest_key() {
    let (place, message) = error("[mesh]\nspacing = 1\nmax_triangle = 7 # few\n");
    assert_eq!(place, [3, 1]);
    let pointer = "\n    max_triangle = 7 # few\n    ^^^^^^^^^^^^";
    assert_eq!(
        message,
        format!("there is no key `max_triangle` here; did you mean `max_triangles`?{pointer}")
    );
    for (text, expected_place, expected) in [
        ("[domian]\n", [1, 2], "there is no key `domian` here; did you mean `domain`?"),
        (
            "[mesh]\ncolour = 1",
            [2, 1],
            "there is no key `colour` here; the keys here are spacing, rule, max_triangles,",
        ),
        ("[limits]\n  hmin = 1", [2, 3], "there is no key `hmin` here; did you mean `h_min`?"),
        (
            "\n[[layer]]\nkind = \"paint\"\nquantty = \"risk\"",
            [4, 1],
            "there is no key `quantty` here; did you mean `quantity`?",
        ),
        (
            "[[layer]]\nkind = \"threats\"\nthreats = [{ x = 1, y = 2, range = 3, peek = 1 }]",
            [3, 39],
            "there is no key `peek` here; did you mean `peak`?",
        ),
        (
            "[[output]]\nfile = \"a.vtu\"\nsizes = 3",
            [3, 1],
            "there is no key `sizes` here; did you mean `size`?",
        ),
        (
            "[[layer]]\nkind = \"paint\"\nquantity = \"risk\"\nslope = 3",
            [4, 1],
            "a layer of the kind \"paint\" has no `slope`; its own keys are quantity, file, layer.",
        ),
        (
            "[[layer]]\nkind = \"distance\"\nshapes = [{ circle = 1 }]",
            [3, 13],
            "\"circle\" is not possible here; write one of point, line, polygon.",
        ),
    ] {
        let (place, message) = error(text);
        assert!(message.starts_with(expected), "{text:?} gave {message}");
        assert_eq!(place, expected_place, "{text:?} gave {message}");
    }
}

#[test]
fn values_of_another_type_are_named_with_line_and_column() {
    for (text, expected_place, expected) in [
        (
            "[mesh]\nspacing = \"wide\"",
            [2, 11],
            "“wide” is not a number. Numbers can be typed as 0.25, 1e-4, 100k or 2M.\n    spacing = \"wide\"\n              ^^^^^^",
        ),
        ("[mesh]\nmax_triangles = 1.5", [2, 17], "this must be a whole number from 0, not 1.5."),
        ("[mesh]\nmax_triangles = -1", [2, 17], "this must be a whole number from 0, not -1."),
        ("[mesh]\nrule = \"aera\"", [2, 8], "\"aera\" is not possible here; did you mean \"area\"?"),
        ("[domain]\nbounds = [0, 0, 1]", [2, 10], "this must be a list of 4 numbers, not 3 values."),
        ("[domain]\nbounds = [0, 0, 1, true]", [2, 20], "this must be a number, not true."),
        ("[domain]\nparts = \"most\"", [2, 9], "\"most\" is not possible here; write one of largest, all."),
        ("[domain]\nparts = []", [2, 9], "this must be \"largest\", \"all\" or a share"),
        ("[domain]\nkeep_pinches = 1", [2, 16], "this must be true or false, not 1."),
        ("domain = 3", [1, 10], "this must be a table, not 3."),
        ("layer = 3", [1, 9], "this must be a list, not 3."),
        ("[[layer]]\nname = \"A\"", [1, 1], "the key `kind` is missing here."),
        ("[[layer]]\nkind = 3", [2, 8], "this must be one of the words of this key, in quotation marks."),
        ("[[layer]]\nkind = \"pain\"", [2, 8], "\"pain\" is not possible here; did you mean \"paint\"?"),
        ("[[layer]]\nkind = \"raster\"\nfile = 3", [3, 8], "this must be a text in quotation marks, not 3."),
        (
            "[[layer]]\nkind = \"raster\"\ncurve = [[1, 2], [3]]",
            [3, 18],
            "this must be a list of 2 numbers, not 1 values.",
        ),
    ] {
        let (place, message) = error(text);
        assert!(message.starts_with(expected), "{text:?} gave {message}");
        assert_eq!(place, expected_place, "{text:?} gave {message}");
    }
}

#[test]
fn paths_keep_out_regions_and_pins_that_cannot_be_used_are_named_with_line_and_column() {
    for (text, expected_place, expected) in [
        ("[paths]\nroutes = [[[0, 0], [1, 1]], [[2, 2]]]", [2, 29], "a path needs 2 points at least"),
        ("[paths]\nroutes = [[[0, 0], [inf, 1]]]", [2, 11], "both coordinates"),
        (
            "[paths]\nroute = [[[0, 0], [1, 1]]]",
            [2, 1],
            "there is no key `route` here; did you mean `routes`?",
        ),
        ("[paths]\nrisk_weight = -1", [2, 15], "The weights 1 for length and -1 for risk make no cost"),
        ("[paths]\nclearance = -1", [2, 13], "A clearance of -1 is no distance"),
        ("[paths]\nlength_weight = nan", [2, 17], "The weights NaN for length and 10 for risk"),
        (
            "[paths]\ncost = \"1 + rsk\"",
            [2, 8],
            "There is no `rsk`; a cost is a formula of `x`, `y` and `risk`",
        ),
        (
            "[paths]\ncost = \"1\"\nrisk_weight = 2",
            [3, 1],
            "what paths cost is given by `cost` or by weights",
        ),
        ("[[keep_out]]\nname = \"A\"", [1, 1], "a keep-out region needs `polygons` or `file`."),
        ("[[keep_out]]\npolygons = []", [2, 12], "a keep-out region needs a polygon at least"),
        ("[[keep_out]]\npolygons = [[[[0, 0], [1, 0]]]]", [2, 13], "a ring needs 3 points at least"),
        ("[[keep_out]]\nfile = \"gone\"", [2, 1], "gone cannot be found."),
        (
            "[[keep_out]]\nfile = \"a\"\npolygons = [[[[0, 0], [1, 0], [1, 1]]]]",
            [2, 1],
            "a keep-out region has `polygons` or `file`, not both.",
        ),
        ("[pins]\nat = [[0, 0], [0, nan]]", [2, 15], "both coordinates"),
    ] {
        let (place, message) = error(text);
        assert!(message.starts_with(expected), "{text:?} gave {message}");
        assert_eq!(place, expected_place, "{text:?} gave {message}");
    }
}

#[test]
fn text_that_is_not_toml_is_named_with_line_and_column() {
    for (text, expected_place) in
        [("[mesh\n", [1, 6]), ("a = \n", [1, 5]), ("\n\nx = [1, ", [3, 8]), ("[mesh]\nrule = \"a", [2, 10])]
    {
        let (place, message) = error(text);
        assert!(message.starts_with("this is not valid TOML: "), "{text:?} gave {message}");
        assert_eq!(place, expected_place, "{text:?} gave {message}");
    }
    let (place, message) = error("[mesh]\nspacing = 1\nspacing = 2");
    assert!(message.contains("duplicate key"), "{message}");
    assert_eq!(place[0], 3);
}

#[test]
fn values_that_cannot_be_used_are_named_with_line_and_column() {
    for (text, expected_place, expected) in [
        ("[mesh]\nspacing = 0", [2, 11], "0 cannot be used: a length must be positive"),
        ("[mesh]\nspacing = nan", [2, 11], "NaN cannot be used"),
        ("[mesh]\nmax_triangles = 1", [2, 17], "choose from 2 to"),
        ("[mesh]\nmax_memory = \"2\"", [2, 14], "\"2\" is no such size"),
        ("[mesh]\nmax_memory = \"2kB\"", [2, 14], "\"2kB\" is no such size: choose 1MB at least"),
        ("[limits]\nh_min = -1", [2, 9], "-1 cannot be used"),
        ("[limits]\nh_min = 2\nh_max = 1", [3, 9], "The smallest diameter 2 is above the largest, 1"),
        (
            "[limits]\nh_min = 2\nh_risk = 1",
            [3, 10],
            "The diameter at risk 1, 1, must be from the smallest diameter 2",
        ),
        (
            "[limits]\nh_risk = 2\nh_max = 1",
            [2, 10],
            "The diameter at risk 1, 2, must be from the smallest diameter 1",
        ),
        (
            "[paths]\nroutes = [[[0, 0], [1, 1]]]\nnames = [\"a\", \"b\"]",
            [3, 9],
            "there are more names than paths",
        ),
        ("[limits]\nshape = 100", [2, 9], "The shape 100"),
        ("[limits]\ngradation = 0", [2, 13], "a gradation of 0 cannot be kept"),
        ("[limits]\ngradation = nan", [2, 13], "a gradation of NaN cannot be kept"),
        ("[domain]\nbounds = [1, 0, 0, 1]", [2, 10], "these are no rectangle"),
        ("[domain]\ninside = \"x\"\nregion = \"a.geojson\"", [2, 1], "the domain is given by `region` or by"),
        (
            "[domain]\nregion = \"gone.geojson\"",
            [2, 1],
            "gone.geojson cannot be found.\n    region = \"gone.geojson\"\n    ^^^^^^^^^^^^^^^^^^^^^^^",
        ),
        ("[domain]\nboundary_diameter = 1", [2, 1], "this is for the outline of a region"),
        (
            "[domain]\nregion = \"a\"\nboundary = \"report\"\nboundary_diameter = 1",
            [4, 1],
            "with boundary = \"report\"",
        ),
        ("[domain]\nparts = 2", [2, 9], "2 is not a share"),
        ("[domain]\nsplits = [[0, 0], [inf, 0]]", [2, 19], "both coordinates"),
        ("[domain]\nnames = [{ at = [nan, 0], name = \"a\" }]", [2, 17], "both coordinates"),
        ("[domain]\ntypes = [{ at = [nan, 0], type = \"open\" }]", [2, 17], "both coordinates"),
        (
            "[domain]\ntypes = [{ at = [0, 0], type = \"sea\" }]",
            [2, 32],
            "\"sea\" is not possible here; write one of open, land, no-slip land",
        ),
        ("[domain]\ninside = \"x +\"", [2, 10], "Expected a value"),
        (
            "[[layer]]\nkind = \"raster\"\n file = \"gone.asc\"\nas = \"risk\"",
            [3, 2],
            "gone.asc cannot be found.",
        ),
        (
            "[[layer]]\nkind = \"paint\"\nquantity = \"risk\"\nmask_file = \"gone\"",
            [4, 1],
            "gone cannot be found.",
        ),
        ("[[layer]]\nkind = \"paint\"\nquantity = \"risk\"\n", [2, 1], "paint has no form as text"),
        (
            "[[layer]]\nkind = \"raster\"\nfile = \"a.asc\"\ncurve = [[0, 1], [0, 1]]",
            [4, 18],
            "the values of a curve must ascend",
        ),
        (
            "[[layer]]\nkind = \"threats\"\n[[layer.threats]]\nx = 0\ny = 0\nrange = -1",
            [6, 9],
            "A threat has the range -1",
        ),
        ("[[layer]]\nkind = \"threats\"\nthreats = []", [2, 1], "risk and images need `h_min`"),
        (
            "[[layer]]\nkind = \"band\"\nfile = \"a.jpg\"\nbetween = [0, 1]\ndiameter = 2",
            [3, 8],
            "a raster ends in .png",
        ),
        ("[[layer]]\nkind = \"band\"", [2, 1], "a layer of the kind \"band\" needs `between`."),
        (
            "[[layer]]\nkind = \"band\"\nbetween = [0, 1]\ndiameter = 2",
            [2, 1],
            "a layer of the kind \"band\" needs `file`.",
        ),
        (
            "[[layer]]\nkind = \"formula\"\nquantity = \"risk\"\nformula = \"1 + sqr(ä)\"",
            [4, 11],
            "There is no `sqr`; write `v^2`.\n    1 + sqr(ä)\n        ^^^",
        ),
    ] {
        let (place, message) = error(text);
        assert!(message.starts_with(expected), "{text:?} gave {message}");
        assert_eq!(place, expected_place, "{text:?} gave {message}");
    }
}

#[test]
fn every_prefix_and_every_changed_byte_gives_a_recipe_or_a_sentence() {
    let check = |text: String| {
        if let Err(error) = parse(Path::new("recipe.toml"), text, &find) {
            let message = error.to_string();
            let sentence = message.split('\n').next().unwrap();
            assert!(sentence.ends_with(['.', '?']) && message.len() < 1000, "{message}");
        }
    };
    for end in 0..FULL.len() {
        check(FULL[..end].to_owned());
    }
    let mut random = fastrand::Rng::with_seed(12);
    for _ in 0..3_000 {
        let mut bytes = FULL.as_bytes().to_vec();
        for _ in 0..random.usize(1..4) {
            let at = random.usize(..bytes.len());
            match random.u8(..3) {
                0 => bytes[at] = random.u8(..128),
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, random.u8(..128)),
            }
        }
        check(String::from_utf8(bytes).unwrap());
    }
    check("[".repeat(100_000));
    check(format!("a = {}", "[".repeat(100_000)));
}

fn saved(text: &str) -> SavedSettings {
    RecipeText::new(Path::new("recipe.toml"), text.to_owned())
        .parse()
        .unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_recipe_is_written_as_it_was_read() {
    let odd = "[[layer]]\nkind = \"formula\"\nname = \"a \\\"b\\\" \\\\ \\n \\u0001 ä 😀\"\nquantity = \"risk\"\nformula = \"x\"\n";
    let numbers = "[domain]\nbounds = [-1e-300, 1e300, 0.1, 12345678901234567890.0]\nparts = \"all\"\n\
                   [mesh]\nspacing = 0.30000000000000004\nmax_triangles = 2147483647";
    let ring: String = (0..40).map(|n| format!("[{n}.25, {}],", n * n)).collect();
    let long = format!(
        "[[layer]]\nkind = \"paint\"\nquantity = \"risk\"\nmask = [[[{ring}]], [[[0,0],[1,0],[1,1]]]]"
    );
    // Empty lists of a layer are more than none.
    let none = "[limits]\nh_min = 0.1\n[[layer]]\nkind = \"threats\"\nthreats = []\n\
                [[layer]]\nkind = \"distance\"\ntypes = []\nat_zero = 0.1\nslope = 0.2";
    for text in ["", FULL, odd, numbers, &long, none] {
        let recipe = saved(text);
        let written = to_text(&recipe);
        assert_eq!(saved(&written), recipe, "{written}");
        assert_eq!(to_text(&saved(&written)), written);
        assert!(written.lines().all(|line| line.chars().count() <= 120), "{written}");
    }
}

#[test]
fn a_written_recipe_is_readable() {
    let written = to_text(&saved(FULL));
    let first_layer = "\n# The size field, from the bottom layer to the top one.\n[[layer]]\nname = \"Open sea\"\n\
                       kind = \"formula\"\nquantity = \"diameter\"\nformula = \"0.5 + 0.1*x\"\n\n[[layer]]\n";
    assert!(written.contains(first_layer), "{written}");
    assert!(
        written
            .contains("\n\n[limits]\nh_min = 0.01\nh_risk = 0.02\nh_max = 1\nshape = 1.5\ngradation = 0.3\n"),
        "{written}"
    );
    let threats = "threats = [\n  { x = 24, y = 37, range = 0.5, peak = 0.9, law = \"gaussian\" },\n";
    assert!(written.contains(threats), "{written}");
    assert!(written.contains("\nparts = 0.01\n") && written.contains("file = \"sea.png\"\n"), "{written}");
}

/// A layer alone is read as the only one of a recipe: its mistakes are not said to be in a list of layers.
#[test]
fn a_mistake_in_a_layer_alone_is_at_its_key() {
    let text = |text: &str| TextValue::Text(text.into());
    let others = BesideLayer { smallest: false, depths: false, unit: LengthUnit::None };
    for (formula, is_good) in [("0.1 + x", true), ("0.1 +", false), ("sin(x, y)", false)] {
        let entries = [("kind", text("formula")), ("quantity", text("diameter")), ("formula", text(formula))];
        let table = TextValue::Table(entries.map(|(key, value)| (key.to_owned(), value)).to_vec());
        match SavedLayer::of_value(&table, &others, &Given::default()) {
            Ok(_) => assert!(is_good, "{formula}"),
            Err(fault) => {
                assert!(!is_good && fault.path.len() == 1, "{fault:?}");
                assert!(fault.to_string().starts_with("formula"), "{fault}");
            }
        }
    }
}

/// A number that TOML does not have must not take its layer with it.
#[test]
fn the_largest_number_of_triangles_is_written() {
    use meshbrush_core::layers::{Layer, LayerKind, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};
    let source = SurfaceSource::Formula("x".parse().unwrap());
    let goal = SurfaceGoal::AtMost(usize::MAX);
    let kind = LayerKind::Surface(Surface { source, goal, norm: SurfaceNorm::default() });
    let layer = Layer::stack([kind]).remove(0);
    let layer = SavedLayer::of(&layer, None, crate::io::layers::ListsInPlace::ALL);
    let text = to_text(&SavedSettings { layer: vec![layer], ..SavedSettings::default() });
    assert!(text.contains("at_most = 9223372036854775807"), "{text}");
}
