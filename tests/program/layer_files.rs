//! Documents with every kind of layer in files: projects, journals' records and recipes.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::folder::{Folder, Ran};
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    BandLayer, Combine, DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, FormulaLayer, Layer,
    LayerId, LayerKind, Mask, MedialBalls, PositiveDepth, Quantity, RasterLayer, RasterReading, RasterSource,
    ShapeList, Shapes, Straits, Threat, ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::Meter;
use meshbrush_io::io::project::{Project, from_bytes, read, write};
use meshbrush_io::io::recipe::RecipeFiles;
use meshbrush_mesh::geometry::Rect;

/// Returns the fingerprint of a mesh and the number of its triangles.
fn fingerprint(folder: &Folder, arguments: &[&str]) -> String {
    let summary = folder.json("mesh", arguments);
    format!("{} {}", summary["hash"].as_str().unwrap(), summary["triangles"])
}

/// Random values from 0 to 1, some of them missing, over a rectangle that no decimal fraction meets.
fn raster(random: &mut fastrand::Rng) -> Arc<RasterPyramid> {
    let bounds = Rect::new(dvec2(-0.7, 0.1) / 3.0, dvec2(8.0, 7.7) / 3.0);
    let values = (0..40 * 30).map(|_| if random.u8(..9) == 0 { f32::NAN } else { random.f32() }).collect();
    Arc::new(RasterPyramid::new(Raster::from_values(bounds, [40, 30], values)))
}

fn source(name: &str, raster: &Arc<RasterPyramid>) -> RasterSource {
    RasterSource { name: name.into(), raster: raster.clone() }
}

fn threats(random: &mut fastrand::Rng, count: usize) -> Threats {
    let one = |_| Threat {
        at: 3.0 * dvec2(random.f64(), random.f64()),
        range: 0.05 + 0.3 * random.f64(),
        peak: random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    Threats::new((0..count).map(one).collect()).unwrap()
}

fn circle(center: DVec2, radius: f64, corners: usize) -> Vec<DVec2> {
    let angle = |n: usize| std::f64::consts::TAU * n as f64 / corners as f64;
    (0..corners).map(|n| center + radius * DVec2::from_angle(angle(n))).collect()
}

fn distance(shapes: ShapeList, range: f64) -> LayerKind {
    let to = DistanceTo::Shapes { name: "cable.geojson".into(), shapes: Shapes::new(shapes, true).unwrap() };
    DistanceLayer { to, at_zero: 0.03, slope: 0.3, range }.into()
}

fn corridor(line: Vec<DVec2>, range: f64) -> LayerKind {
    let lines = Shapes::new(ShapeList { lines: vec![line], ..ShapeList::default() }, true).unwrap();
    let to = DistanceTo::Corridor { lines, width: 0.1 };
    DistanceLayer { to, at_zero: 0.04, slope: 0.5, range }.into()
}

/// Returns every kind of layer, with data that a recipe holds itself and data that it needs files for.
fn kinds() -> Vec<LayerKind> {
    let random = &mut fastrand::Rng::with_seed(12);
    let (shared, other) = (raster(random), raster(random));
    let curve = ValueCurve::new(vec![[0.1, 0.5], [0.6, 0.1], [0.9, 0.05]]).unwrap();
    let line = vec![dvec2(0.1, 0.1), dvec2(1.3, 0.7)];
    let few = ShapeList { points: vec![dvec2(0.4, 1.9)], lines: vec![line], polygons: Vec::new() };
    let many = ShapeList { polygons: vec![vec![circle(dvec2(2.0, 1.0), 0.2, 30)]], ..ShapeList::default() };
    let diameters = other.raster().values().iter().map(|v| if v.is_nan() { f32::INFINITY } else { 0.05 + v });
    let diameters = Raster::from_values(other.raster().bounds(), [40, 30], diameters.collect());
    let errors = Raster::filled(diameters.bounds(), [3, 4], 0.25);
    vec![
        LayerKind::constant(0.4),
        LayerKind::target(Formula::parse("0.1 + 0.2*abs(x - y)").unwrap()),
        LayerKind::risk(Formula::parse("0.3*x").unwrap()),
        LayerKind::Raster(RasterLayer { source: source("risk", &shared), reading: RasterReading::Risk }),
        LayerKind::Raster(RasterLayer {
            source: source("length.asc", &Arc::new(RasterPyramid::new(diameters))),
            reading: RasterReading::Diameter,
        }),
        LayerKind::Raster(RasterLayer {
            source: source("depth.asc", &shared),
            reading: RasterReading::Curve(Arc::new(curve)),
        }),
        LayerKind::Band(BandLayer {
            source: source("depth.asc", &shared),
            between: [0.2, 0.21],
            diameter: 0.04,
        }),
        LayerKind::Straits(Straits { across: 3.0, found: MedialBalls::unknown([0.2, 1.0]) }),
        LayerKind::Threats(threats(random, 3)),
        LayerKind::Threats(threats(random, 40)),
        distance(few, 0.5),
        distance(many, f64::INFINITY),
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Outline, at_zero: 0.05, slope: 0.5, range: 0.7 }),
        corridor(vec![dvec2(0.2, 0.3), dvec2(0.7, 0.4), dvec2(1.3, 1.6)], 0.3),
        corridor(circle(dvec2(1.0, 1.0), 0.6, 30), f64::INFINITY),
        LayerKind::paint(Quantity::Risk),
        LayerKind::paint(Quantity::Error),
        LayerKind::Formula(FormulaLayer {
            quantity: Quantity::Error,
            formula: Formula::parse("if(x < 1, 0.1, inf)").unwrap(),
        }),
        LayerKind::Raster(RasterLayer {
            source: source("error.asc", &Arc::new(RasterPyramid::new(errors))),
            reading: RasterReading::Error,
        }),
        LayerKind::paint(Quantity::Diameter),
        LayerKind::paint(Quantity::Diameter),
        LayerKind::Depth(Depths::new(
            source("depth.asc", &shared),
            DepthSizes {
                positive: PositiveDepth::Down,
                offset: -0.25,
                between: [0.3, f64::INFINITY],
                rule: DepthRule::Wavelength { period: 12.0, triangles: 80.0 },
            },
        )),
        LayerKind::Depth(Depths::new(
            source("depth.asc", &shared),
            DepthSizes {
                positive: PositiveDepth::Up,
                offset: 0.0,
                between: DepthSizes::ALL_WATER,
                rule: DepthRule::Nothing,
            },
        )),
    ]
}

fn document() -> Document {
    let mut layers = Layer::stack(kinds());
    for (n, layer) in layers.iter_mut().enumerate() {
        layer.id = LayerId(3 * n as u32 + 1);
        layer.combine = [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][n % 4];
        let corners = [5, 60][n / 3 % 2];
        let polygon = vec![circle(dvec2(1.5, 1.0), 0.9, corners), circle(dvec2(1.5, 1.0), 0.3, corners)];
        layer.mask = (n % 3 == 1).then(|| Mask::new(&[polygon]).unwrap());
        layer.visible = n != 1;
        layer.locked = n == 2;
    }
    let settings = Settings {
        spacing: 0.2,
        layers,
        gradation: Some(0.6),
        transfer: Transfer { shape: 1.5, ..Transfer::between(0.12, 0.5) },
        ..Settings::for_domain("All kinds".into(), meshbrush_core::domain::Domain::rectangle(bounds()))
    };
    let mut document = Document::new(settings, None).unwrap();
    for (medium, at) in [
        (Medium::Risk(0.9), dvec2(0.5, 0.5)),
        (Medium::Diameter(0.05, DiameterChange::Finer), dvec2(2.5, 1.5)),
    ] {
        document.begin_stroke(Brush { medium, radius: 0.2, hardness: 0.5, strength: 1.0 });
        document.draw_to(at);
        document.draw_to(at + dvec2(0.3, 0.1));
        document.end_stroke();
    }
    document
}

fn bounds() -> Rect {
    Rect::new(DVec2::ZERO, dvec2(3.0, 2.0))
}

fn project_bytes(project: &Project) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes, project).unwrap();
    bytes
}

#[test]
fn every_kind_of_layer_is_read_as_it_was_saved() {
    let project = Project::of(&document());
    let bytes = project_bytes(&project);
    let opened = from_bytes(&bytes, Path::new("a.meshbrush")).unwrap();
    for (layer, expected) in opened.settings.layers.iter().zip(&project.settings.layers) {
        // NaN differs from NaN: rasters are compared as text.
        assert_eq!(format!("{layer:?}"), format!("{expected:?}"));
    }
    assert_eq!(opened.settings.gradation, Some(0.6));
    assert!(opened.paint == project.paint && !opened.paint.is_blank());
    assert!(project_bytes(&opened) == bytes, "saving again gives the same file");
    let rasters = opened.settings.layers.iter().filter_map(|layer| match &layer.kind {
        LayerKind::Raster(RasterLayer { source, .. }) | LayerKind::Band(BandLayer { source, .. }) => {
            Some(&source.raster)
        }
        LayerKind::Depth(depths) => Some(&depths.source().raster),
        _ => None,
    });
    let rasters: Vec<_> = rasters.collect();
    assert!(Arc::ptr_eq(rasters[0], rasters[3]) && !Arc::ptr_eq(rasters[0], rasters[1]));
}

#[test]
fn a_damaged_project_is_refused_and_never_read_wrongly() {
    let project = Project::of(&document());
    let bytes = project_bytes(&project);
    let name = Path::new("a.meshbrush");
    for length in (0..bytes.len()).step_by(bytes.len() / 60) {
        assert!(from_bytes(&bytes[..length], name).is_err(), "{length} bytes");
    }
    let random = &mut fastrand::Rng::with_seed(5);
    let mut refused = 0;
    for _ in 0..200 {
        let mut damaged = bytes.clone();
        let at = random.usize(..damaged.len());
        damaged[at] ^= 1 << random.u8(..8);
        match from_bytes(&damaged, name) {
            Err(_) => refused += 1,
            // A bit that does not matter, such as one of a date.
            Ok(opened) => assert!(project_bytes(&opened) == bytes, "a bit of byte {at} was flipped"),
        }
    }
    assert!(refused > 150, "{refused}");
}

#[test]
fn errors_name_the_layer() {
    let project = Project::of(&document());
    let bytes = project_bytes(&project);
    let broken = |from: &str, to: &str| {
        assert_eq!(from.len(), to.len());
        let mut bytes = bytes.clone();
        let mut found = 0;
        for at in 0..bytes.len() - from.len() {
            if bytes[at..].starts_with(from.as_bytes()) {
                bytes[at..at + from.len()].copy_from_slice(to.as_bytes());
                found += 1;
            }
        }
        assert!(found > 0);
        from_bytes(&bytes, Path::new("a.meshbrush")).unwrap_err().to_string()
    };
    let missing = broken("raster.1", "raster.9");
    assert!(missing.contains("“Raster”") && missing.contains("no part raster.1"), "{missing}");
}

#[test]
fn the_recipe_of_a_document_gives_its_mesh() {
    let folder = Folder::new("recipe");
    let project = Project::of(&document());
    folder.file("all.meshbrush", project_bytes(&project));
    let Ran { status, err, .. } = folder.run(["recipe", "all.meshbrush", "-o", "all.toml"]);
    assert_eq!(status, 0, "{err}");
    for file in ["all-raster.asc", "all-threats.csv", "all-distance.geojson", "all-paint.meshbrush"] {
        assert!(folder.0.join(file).exists(), "{file}: {err}");
    }
    let expected = fingerprint(&folder, &["--project", "all.meshbrush"]);
    assert_eq!(fingerprint(&folder, &["all.toml"]), expected);

    // Every visible layer counts, and so do gradation and masks: without one of them the mesh is another.
    let text = fs::read_to_string(folder.0.join("all.toml")).unwrap();
    for without in ["gradation = 0.6\n", "as = \"risk\"\n", "between = [0.2, 0.21]\n"] {
        assert!(text.contains(without), "{without} in {text}");
    }
    folder.file("other.toml", text.replace("gradation = 0.6\n", ""));
    assert_ne!(fingerprint(&folder, &["other.toml"]), expected);

    let again = RecipeFiles::new(
        &Project::of(&read(&folder.0.join("all.meshbrush")).unwrap()),
        &folder.0.join("all.toml"),
    );
    again.write(&Meter::default()).unwrap();
    assert_eq!(fs::read_to_string(folder.0.join("all.toml")).unwrap(), text);
}

#[test]
fn layers_that_ask_for_nothing_are_noted_and_faults_name_the_layer() {
    let folder = Folder::new("bad");
    let document = document();
    folder.file("all.meshbrush", project_bytes(&Project::of(&document)));
    folder.file("half.asc", "ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n0.2\n0.2\n");
    folder.file("line.geojson", r#"{"type":"Polygon","coordinates":[[[0,0],[1,1],[0.5,0.5],[0,0]]]}"#);
    let head =
        "[domain]\nbounds = [0, 0, 1, 1]\n[limits]\nh_min = 0.05\nh_max = 0.3\n[[layer]]\nname = \"Own\"\n";
    for (layer, status, words) in [
        (
            "kind = \"raster\"\nfile = \"half.asc\"\nas = \"diameter\"",
            0,
            "half.asc covers 50 % of the domain",
        ),
        (
            "kind = \"raster\"\nfile = \"half.asc\"\nas = \"diameter\"\nbounds = [7, 7, 8, 9]",
            0,
            "half.asc covers 7, 7 to 8, 9 and does not meet the domain",
        ),
        (
            "kind = \"formula\"\nquantity = \"diameter\"\nformula = \"0.1\"\nmask = [[[[5, 5], [6, 5], [6, 6]]]]",
            0,
            "The mask of the layer “Own” does not meet the domain",
        ),
        (
            "kind = \"formula\"\nquantity = \"diameter\"\nformula = \"0.1\"\nmask_file = \"line.geojson\"",
            1,
            "The layer “Own”: its mask cannot be used. ",
        ),
        (
            "kind = \"paint\"\nquantity = \"risk\"\nfile = \"all.meshbrush\"",
            1,
            "The layer “Own”: all.meshbrush has no paint layer “Own”; it has “Painted risk”",
        ),
        (
            "kind = \"paint\"\nquantity = \"diameter\"\nfile = \"all.meshbrush\"\nlayer = \"Painted risk\"",
            1,
            "is not of this `quantity`",
        ),
        ("kind = \"distance\"\nfile = \"half.asc\"\nat_zero = 0.1\nslope = 1", 1, "half.asc, line 1: "),
    ] {
        folder.file("own.toml", format!("{head}{layer}"));
        let Ran { status: found, err, .. } = folder.run(["mesh", "own.toml"]);
        assert!(found == status && err.contains(words), "{layer}\n{found}: {err}");
    }
    let finest = "[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"1e-6\"\n";
    folder.file("own.toml", format!("{finest}[mesh]\nmax_triangles = 5000\n"));
    let Ran { status, err, .. } = folder.run(["mesh", "own.toml"]);
    assert!(status == 1 && err.contains("5,000 triangles"), "{err}");
    folder.file("own.toml", "[domain]\ninside = \"x < y\"\n[[layer]]\nkind = \"distance\"\nto = \"outline\"\nat_zero = 1\nslope = 1");
    let Ran { err, .. } = folder.run(["mesh", "own.toml"]);
    assert!(err.contains("The layer “Distance”: there is no distance to the outline of a domain"), "{err}");
}

#[test]
fn options_take_threats_distances_and_a_limit_of_gradation() {
    let folder = Folder::new("options");
    folder.file("threats.csv", "x,y,range,peak\n0.5,0.5,0.3,1\n");
    folder.file("point.geojson", r#"{"type":"Point","coordinates":[0.2,0.2]}"#);
    let default = ["--h-min", "0.02", "--h-max", "0.3", "--checks", "--rule", "area"];
    let count = |options: &[&str]| {
        let Ran { status, out, err } = folder.run([&["mesh", "--json"], &default[..], options].concat());
        assert_eq!(status, 0, "{err}");
        let summary: serde_json::Value = serde_json::from_str(&out).unwrap();
        summary["triangles"].as_u64().unwrap()
    };
    let plain = count(&[]);
    let threats = count(&["--threats", "threats.csv"]);
    let distance = count(&["--distance", "point.geojson", "--distance-range", "0.1"]);
    let graded = count(&["--distance", "point.geojson", "--distance-range", "0.1", "--gradation", "0.3"]);
    assert!(
        plain < threats && plain < distance && distance < graded,
        "{plain} {threats} {distance} {graded}"
    );
}
