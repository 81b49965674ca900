//! Recipes, run by the program itself.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::folder::{Folder, Ran};
use glam::dvec2;
use meshbrush::{
    BoundaryMarks, BoundaryType, Document, Domain, Formula, Layer, LayerKind, LengthUnit, Project, Rect,
    Settings, write_geojson, write_project,
};
use meshbrush_io::io::layers::{SavedKind, SavedLayer};
use meshbrush_io::io::recipe::{parse, read, to_text};
use meshbrush_io::io::settings::SavedSettings;

/// A grid of 4 × 4 values over [0, 4]², the lower left one 0, the others 1, and one pixel without a value.
const GRID: &str = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n\
                    1 1 1 -9\n1 1 1 1\n1 1 1 1\n0 1 1 1\n";

#[test]
fn a_recipe_gives_the_mesh_of_the_options() {
    let folder = Folder::new("alike");
    folder.file("sub/grid.asc", GRID);
    let square = "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,3],[0,4],[0,0]]]}";
    folder.file("sub/square.geojson", square);
    for (recipe, options) in [
        ("", ""),
        (
            "[domain]\nbounds = [-10, -10, 10, 10]\n[mesh]\nspacing = 1\n[[layer]]\nkind = \"formula\"\n\
             quantity = \"diameter\"\nformula = \"if(abs(x)+abs(y)<8, 0.25, 20)\"",
            "--domain -10,-10,10,10 --spacing 1 --target 'if(abs(x)+abs(y)<8, 0.25, 20)'",
        ),
        (
            "[domain]\nbounds = [0, 0, 4, 4]\ninside = \"x < 2\"\n[mesh]\nrule = \"area\"\nmax_level = 5\n[limits]\n\
             h_min = 0.05\nh_max = 1\nshape = 2\n[[layer]]\nkind = \"formula\"\nquantity = \"risk\"\nformula = \"x/4\"",
            "--domain 0,0,4,4 --inside 'x < 2' --rule area --max-level 5 --h-min 0.05 --h-max 1 --transfer-shape 2 \
             --risk x/4",
        ),
        (
            "[limits]\nh_min = 0.05\nh_max = 1\n[[layer]]\nkind = \"raster\"\nfile = \"grid.asc\"\nas = \"risk\"",
            "--h-min 0.05 --h-max 1 --risk-raster sub/grid.asc",
        ),
        (
            "[domain]\nregion = \"square.geojson\"\nboundary = \"fitted\"\nboundary_diameter = 0.1\nparts = \"all\"\n\
             keep_pinches = true\n[mesh]\nspacing = 1",
            "--region sub/square.geojson --boundary fitted --boundary-diameter 0.1 --parts all --keep-pinches --spacing 1",
        ),
    ] {
        folder.file("sub/recipe.toml", recipe);
        let (by_recipe, by_options) = (folder.json("mesh", "sub/recipe.toml"), folder.json("mesh", options));
        for key in ["hash", "triangles", "spacing", "rule", "parts"] {
            assert_eq!(by_recipe[key], by_options[key], "{key} of {recipe}");
        }
    }
}

const REFERENCE: &str = include_str!("../../docs/recipe.md");

#[test]
fn the_reference_has_an_example_that_is_valid_and_every_key() {
    let example = REFERENCE.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let find = |name: &str| Ok(name.into());
    let recipe = parse(Path::new("strait.toml"), example.into(), &find).unwrap();
    let settings = &recipe.settings;
    assert_eq!((settings.layer.len(), settings.output.len()), (4, 2));
    assert_eq!((settings.paths.routes.len(), settings.keep_out.len()), (1, 1));
    // The message about a key that does not exist lists those that do.
    let tables = [
        "[{}]",
        "[domain]",
        "[mesh]",
        "[limits]",
        "[paths]",
        "[problem]",
        "[[keep_out]]",
        "[pins]",
        "[[output]]",
    ];
    let layers = SavedKind::ALL.iter().map(|kind| format!("[[layer]]\nkind = \"{}\"", kind.word()));
    for table in tables.map(str::to_owned).into_iter().chain(layers) {
        let text = table.replace("[{}]", "") + "\nqqqqqqqqqqqqqqqqqqqq = 1";
        let error = parse(Path::new("a.toml"), text, &find).unwrap_err().to_string();
        let (_, keys) = error.split_once("the keys here are ").expect(&table);
        for key in keys.split(".\n").next().unwrap().split(", ") {
            let is_mentioned =
                [format!("`{key}`"), format!("[{key}]")].iter().any(|key| REFERENCE.contains(key));
            assert!(is_mentioned, "{key} of {table}");
        }
    }
}

#[test]
fn the_example_is_valid_and_uses_five_kinds() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/jacksboro.toml");
    let recipe = read(&path).unwrap();
    let kinds: BTreeSet<&str> = recipe.settings.layer.iter().map(|layer| layer.kind().word()).collect();
    assert_eq!(kinds.len(), 5, "{kinds:?}");
}

/// What a curve and a band ask for is also asked for by a formula with the same steps.
#[test]
fn curves_and_bands_ask_for_diameters() {
    let folder = Folder::new("curve");
    folder.file("grid.asc", GRID);
    let formula = "[domain]\nbounds = [0, 0, 4, 4]\n[mesh]\nrule = \"area\"\nspacing = 1\n[[layer]]\nkind = \
                   \"formula\"\nquantity = \"diameter\"\n";
    folder.file("want.toml", format!("{formula}formula = \"if(x < 1 and y < 1, 0.1, 2)\""));
    let want = folder.json("mesh", "want.toml");
    assert!(want["triangles"].as_u64() > Some(300));
    for layer in [
        "kind = \"raster\"\ncurve = [[0, 0.1], [0.5, 2]]",
        "kind = \"band\"\nbetween = [-1, 0.5]\ndiameter = 0.1",
    ] {
        let text = format!("[mesh]\nspacing = 1\n[[layer]]\nfile = \"grid.asc\"\n{layer}\n");
        folder.file("got.toml", text);
        let got = folder.json("mesh", "got.toml");
        // A formula is sampled by its own pixels, whose rim is not the grid's: the counts are near.
        let (got, want) = (got["triangles"].as_f64().unwrap(), want["triangles"].as_f64().unwrap());
        assert!((got / want - 1.0).abs() < 0.1, "{layer}: {got} beside {want}");
    }
}

#[test]
fn the_files_of_a_recipe_lie_beside_it() {
    let folder = Folder::new("outputs");
    let recipe = "[[output]]\nfile = \"m.csv\"\nquantities = [\"twice = 2*x\"]\n[[output]]\nfile = \"m.png\"\n\
                  size = \"80x60\"\nedges = false\ncolormap = \"magma\"\n";
    folder.file("sub/recipe.toml", recipe);
    let Ran { status, err, .. } =
        folder.run("mesh sub/recipe.toml -o own.csv --quantity x --max-triangles 10000");
    assert_eq!(status, 0, "{err}");
    assert!(["sub/m.csv", "sub/m.png", "own.csv"].iter().all(|name| folder.has(name)), "{err}");
    let header = |name| fs::read_to_string(folder.0.join(name)).unwrap().lines().next().unwrap().to_owned();
    assert!(header("sub/m.csv").ends_with("twice1,twice2,twice3"));
    assert!(header("own.csv").ends_with("quantity1,quantity2,quantity3"));
    folder.file("p.csv", "x,y\n0.5,0.5\n");
    let Ran { status, out, err } = folder.run("locate sub/recipe.toml --points p.csv");
    assert!(status == 0 && out.contains("0.5,0.5,"), "{err}");
}

#[test]
fn mistakes_are_reported_with_line_and_column() {
    let folder = Folder::new("mistakes");
    folder.file("a.png", "no picture");
    for (recipe, arguments, expected_status, expected) in [
        ("[[output]]\nfile = \"m.xyz\"", "", 1, "r.toml, line 2, column 8: "),
        ("[[output]]\nfile = \"-\"", "", 1, "r.toml, line 2, column 8: "),
        ("[[output]]\nfile = \"m.png\"\nsize = \"big\"", "", 1, "r.toml, line 3, column 8: write a width"),
        ("[[output]]\nfile = \"m.png\"\ncolormap = \"pink\"", "", 1, "r.toml, line 3, column 12: "),
        (
            "[[output]]\nfile = \"m.csv\"\nquantities = [\"x\", \"y = 2\", \"y=3\"]",
            "",
            1,
            "r.toml, line 3, column 29: the name y is taken",
        ),
        (
            "[[output]]\nfile = \"m.csv\"\nquantities = [\"a = sqr(x)\"]",
            "",
            1,
            "r.toml, line 3, column 15: There",
        ),
        (
            "[mesh]\nspacng = 1",
            "",
            1,
            "r.toml, line 2, column 1: there is no key `spacng` here; did you mean",
        ),
        (
            "[[layer]]\nkind = \"band\"\nfile = \"gone.asc\"\nbetween = [0, 1]\ndiameter = 2",
            "",
            1,
            "r.toml, line 3, column 1: the file gone.asc cannot be found",
        ),
        (
            "[limits]\nh_min = 1\n[[layer]]\nkind = \"raster\"\nfile = \"a.png\"\nas = \"risk\"",
            "",
            1,
            "a.png: this is not a PNG",
        ),
        (
            "[[output]]\nfile = \"r.toml.svg\"\n[[output]]\nfile = \"none/a.svg\"",
            "",
            1,
            "none/a.svg cannot be written",
        ),
        ("[[output]]\nfile = \"m.vtu\"\nbinary = true", "", 1, "r.toml, line 3, column 1: only .msh has"),
        (
            "[[output]]\nfile = \"m.vtu\"\nsize = \"80\"",
            "",
            1,
            "r.toml, line 3, column 1: this is for pictures",
        ),
        (
            "[[output]]\nfile = \"m.msh\"\nlight = true",
            "",
            1,
            "r.toml, line 3, column 1: this is for pictures",
        ),
        (
            "[[output]]\nfile = \"m.png\"\nquantities = [\"x\"]",
            "",
            1,
            "r.toml, line 3, column 1: this format holds no values",
        ),
        (
            "[domain]\nboundary = \"fitted\"",
            "",
            1,
            "r.toml, line 2, column 1: this is for the outline of a region",
        ),
        ("", "--target 1", 2, "--target cannot be used with r.toml: domain and layers are those of the file"),
        ("", "--domain 0,0,1,1", 2, "--domain cannot be used with r.toml"),
        ("", "--h-min 2 --h-max 1", 2, "largest"),
        ("[limits]\nh_min = 2", "--h-max 1", 2, "largest"),
        // 10¹² triangles, and more than any lattice has.
        (
            "[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"1e-6\"",
            "--max-triangles 100000",
            1,
            "100,000",
        ),
        ("[mesh]\nspacing = 1e-6", "", 1, "spacing"),
    ] {
        folder.file("r.toml", recipe);
        let Ran { status, err, .. } = folder.run(format!("mesh r.toml {arguments}"));
        assert_eq!(status, expected_status, "{recipe}: {err}");
        assert!(err.contains(expected), "{recipe} gave {err}");
        assert!(!err.contains("panicked"), "{err}");
    }
    folder.file("latin.toml", b"# na\xefve\n");
    for (arguments, status, expected) in [
        ("gone.toml", 1, "gone.toml: cannot be read"),
        ("latin.toml", 1, "latin.toml, line 1: this is not UTF-8 text"),
        (
            "coast.geojson",
            2,
            "its name ends with .toml. Name a project with --project, and a domain with --region.",
        ),
    ] {
        let Ran { status: got, err, .. } = folder.run(format!("mesh {arguments}"));
        assert_eq!(got, status, "{err}");
        assert!(err.contains(expected), "{err}");
    }
}

#[test]
fn options_on_layers_are_checked() {
    let folder = Folder::new("options");
    for (options, expected) in [
        ("--gradation 0", "--gradation: a gradation of 0 cannot be kept: it must be positive and finite"),
        ("--gradation -1", "--gradation: a gradation of -1"),
        ("--gradation NaN", "--gradation: a gradation of NaN"),
        (
            "--distance a.geojson",
            "--distance a.geojson: at distance 0 there is no target diameter. Give it with",
        ),
        ("--distance a.geojson --distance-at-zero 0", "--distance-at-zero 0: a length must be positive"),
        ("--distance a.geojson --h-min 1 --distance-slope -1", "--distance-slope -1: the growth"),
        ("--distance a.geojson --h-min 1 --distance-slope NaN", "--distance-slope NaN: the growth"),
        ("--distance a.geojson --h-min 1 --distance-range 0", "--distance-range 0: a length must be"),
        ("--distance-slope 1", "--distance <FILE.geojson>"),
        ("--threats a.csv", "Risk and images need --h-min"),
        ("--project a.meshbrush --threats a.csv", "cannot be used with"),
    ] {
        let Ran { status, err, .. } = folder.run(format!("mesh {options}"));
        assert_eq!(status, 2, "{options}: {err}");
        assert!(err.contains(expected), "{options} gave {err}");
    }
}

/// A document without paint and its recipe give the same mesh with the same names along the boundary.
#[test]
fn the_recipe_of_a_document_gives_its_mesh() {
    let folder = Folder::new("document");
    let polygons = [vec![
        vec![dvec2(0.1, 0.0), dvec2(4.0, 0.3), dvec2(4.0, 3.0), dvec2(0.0, 4.0)],
        vec![dvec2(1.0, 1.0), dvec2(1.0, 2.0), dvec2(2.0, 1.1)],
    ]];
    let domain = Domain::of_polygons(&polygons).unwrap();
    let names = vec![(dvec2(1.0, 1.5), "rock".to_owned())];
    let types = vec![(dvec2(1.0, 1.5), BoundaryType::NaturalLand), (dvec2(4.0, 0.5), BoundaryType::Inflow)];
    let marks = BoundaryMarks { splits: vec![dvec2(4.0, 1.0)], names, types };
    let formula = Domain { shape: "x*y < 3".parse::<Formula>().unwrap().into(), ..domain.clone() };
    let wider = domain.with_bounds(Rect::new(dvec2(-1.0, -0.5), dvec2(4.5, 4.5)));
    let frame = domain.bounds;
    for domain in [domain, wider, formula, Domain::rectangle(frame)] {
        let settings = Settings {
            boundary_marks: marks.clone().into(),
            unit: LengthUnit::Kilometre,
            layers: Layer::default_stack(LayerKind::constant(0.3)),
            ..Settings::for_domain("Rock".into(), domain)
        };
        let base = "{ \"kind\": \"formula\", \"quantity\": \"diameter\", \"formula\": \"0.3\" }";
        let layers: Vec<SavedLayer> = vec![serde_json::from_str(base).unwrap()];
        let recipe = to_text(&SavedSettings::of(&settings, "rock.geojson", layers, Vec::new()));
        folder.file("rock.toml", &recipe);
        if let Some(region) = settings.domain.region() {
            let mut text = Vec::new();
            write_geojson(&mut text, region.polygons()).unwrap();
            folder.file("rock.geojson", text);
        }
        let mut project = Vec::new();
        write_project(&mut project, &Project::of(&Document::new(settings, None).unwrap())).unwrap();
        folder.file("rock.meshbrush", project);
        let (by_recipe, by_project) =
            (folder.json("mesh", "rock.toml"), folder.json("mesh", "--project rock.meshbrush"));
        for key in ["hash", "triangles", "spacing", "unit", "boundary", "parts"] {
            assert_eq!(by_recipe[key], by_project[key], "{key} of {recipe}");
        }
    }
}

#[test]
fn types_of_pieces_are_in_files_and_summary_and_a_misplaced_one_is_told() {
    let folder = Folder::new("types");
    let types = "types = [{ at = [2, 0], type = \"natural inflow\" }, { at = [4, 2], type = \"land\" }, \
                 { at = [2, 2], type = \"open\" }]";
    let rest =
        "[mesh]\nspacing = 1\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"1\"\n";
    folder.file("sea.toml", format!("[domain]\nbounds = [0, 0, 4, 4]\n{types}\n{rest}"));
    let ran = folder.run("mesh sea.toml --json -o sea.14");
    assert!(
        ran.err.contains("The type “open” at 2, 2 is not on the boundary: no piece has it."),
        "{}",
        ran.err
    );
    let boundary = &ran.json()["boundary"];
    let types: Vec<&str> = (0..4).map(|piece| boundary[piece]["type"].as_str().unwrap()).collect();
    assert_eq!(types, ["natural inflow", "land", "open", "open"]);
    let file = std::fs::read_to_string(folder.0.join("sea.14")).unwrap();
    let heads = file.lines().filter(|line| line.contains(" = Number of nodes for "));
    let heads: Vec<&str> = heads.map(|line| line.split_once(' ').unwrap().1).collect();
    let expected = [
        "0 = Number of nodes for open boundary 1: open north, open west",
        "22 = Number of nodes for land boundary 1: open south",
        "0 = Number of nodes for land boundary 2: open east",
    ];
    assert_eq!(heads, expected);
}

/// A recipe may hold names of layers and files of any length; what the program says of them stays short.
#[test]
fn no_sentence_repeats_a_long_name() {
    let folder = Folder::new("long-names");
    let name = "n".repeat(1_000_000);
    let layer = |rest: &str| {
        format!(
            "[domain]\ninside = \"x < 0.5\"\n[mesh]\nspacing = 0.25\n[[layer]]\nname = \"{name}\"\n{rest}"
        )
    };
    let formula = "kind = \"formula\"\nquantity = \"diameter\"\nformula =";
    for (command, text, status, said) in [
        (
            "mesh",
            layer(&format!("{formula} \"0.1\"\nmask = [[[[2, 2], [3, 2], [3, 3]]]]")),
            0,
            "…” does not meet",
        ),
        (
            "mesh",
            layer("kind = \"distance\"\nto = \"outline\"\nat_zero = 1\nslope = 1"),
            1,
            "…”: there is no",
        ),
        (
            "mesh",
            layer(&format!("{formula} \"0.1\"\nmask = [[[[0, 0], [1, 0], [2, 0]]]]")),
            1,
            "…”: its mask",
        ),
        ("mesh", layer(&format!("rule = 1\n{formula} \"1\"")), 1, "no key `rule`"),
        (
            "mesh",
            format!("[mesh]\nspacing = 0.25\n[[output]]\nfile = \"{name}.msh\""),
            1,
            "cannot be written",
        ),
        ("why 0.1,0.1", layer(&format!("{formula} \"0.1\"")), 0, "…” asks for 0.1"),
    ] {
        folder.file("long.toml", text);
        let Ran { status: found, out, err } = folder.run(format!("{command} long.toml"));
        assert!(out.len() + err.len() < 1500, "{command}: {} bytes", out.len() + err.len());
        assert!(found == status && format!("{out}{err}").contains(said), "{said}: {found}, {out}{err}");
    }
}
