//! Window, project, recipe and command line are one program: the same settings give the same mesh and files.

use std::sync::Arc;

use crate::folder::{Folder, Ran};
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, KeepOut, PathCost, PathPlan, Settings};
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, Crest, Domain, DomainShape, Line,
    LineKind, PieceChoice, Weir,
};
use meshbrush_core::field::{CostFormula, Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    BandLayer, Combine, DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, FeatureSize, FormulaLayer,
    Layer, LayerId, LayerKind, LineSizes, Mask, MedialAxis, MedialBalls, PositiveDepth, Quantity,
    RasterLayer, RasterReading, RasterSource, ShapeList, Shapes, Straits, Surface, SurfaceGoal, SurfaceNorm,
    SurfaceSource, Threat, ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::path::Weights;
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::Meter;
use meshbrush_io::io::project::{Project, from_bytes, write as write_project};
use meshbrush_io::io::recipe::{OpenedRecipe, RecipeFiles, open};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::render::export::ExportFormat;

#[test]
fn every_file_is_the_same_for_any_number_of_threads() {
    let folder = Folder::new("threads");
    let square = r#"{"type":"Polygon","coordinates":[[[0,0],[4,0.5],[4,3],[0,4],[0,0]],
                     [[1,1],[1,2],[2,1.5],[1,1]]]}"#;
    let options = ["--region", "in.geojson", "--risk", "exp(-hypot(x-3,y-2))", "--h-min", "0.02"];
    // A grid of MODFLOW needs lengths, and `.ll` degrees.
    let endings = ExportFormat::endings().filter(|ending| *ending != "disv");
    let outputs: Vec<String> = endings.map(|ending| format!("mesh.{ending}")).collect();
    let outputs = outputs.iter().flat_map(|name| ["-o", name]);
    let in_metres = vec!["mesh", "--domain", "0,0,4,4", "--risk", "x/4", "--h-min", "0.1", "-o", "mesh.disv"];
    let mesh: Vec<&str> =
        ["mesh"].into_iter().chain(options).chain(outputs).chain(["--quantity", "sin(x)"]).collect();
    let binary = [&["mesh"], &options[..], &["-o", "binary.msh", "--binary"]].concat();
    let locate = [&["locate"], &options[..], &["--points", "points.csv", "-o", "found.csv"]].concat();
    let ends = ["--from", "0.5,0.5", "--to", "3.5,2", "-o", "path.csv", "-o", "path.geojson"];
    let path = [&["path"], &options[..], &ends].concat();
    let with_threads = |threads: &str| {
        for (command, first) in
            [(&mesh, true), (&in_metres, true), (&binary, false), (&locate, false), (&path, true)]
        {
            folder.file("in.geojson", square);
            folder.file("points.csv", "x,y\n0.3,0.3\n2,2\n3,9\n");
            let option = format!("--threads={threads}");
            let option = if first { vec!["--threads", threads] } else { vec![&option[..]] };
            let arguments = [&command[..], &option].concat();
            let Ran { status, err, .. } = folder.run(&arguments);
            assert_eq!(status, 0, "{arguments:?}: {err}");
        }
        folder.take_files()
    };
    let expected = with_threads("1");
    assert!(expected.len() > 15, "{:?}", expected.keys());
    for threads in ["2", "3"] {
        for (name, bytes) in with_threads(threads) {
            assert!(bytes == expected[&name], "{name} differs with {threads} threads");
        }
    }
}

/// Returns a random number in a range.
fn between(random: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.f64()
}

/// Returns a random point near the domain.
fn point(random: &mut fastrand::Rng) -> DVec2 {
    4.2 * dvec2(random.f64(), random.f64()) - dvec2(0.1, 0.1)
}

fn circle(center: DVec2, radius: f64, corners: usize) -> Vec<DVec2> {
    let angle = |n: usize| std::f64::consts::TAU * n as f64 / corners as f64;
    (0..corners).map(|n| center + radius * DVec2::from_angle(angle(n))).collect()
}

fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap()
}

fn domain(random: &mut fastrand::Rng) -> Domain {
    let square = Rect::new(DVec2::ZERO, dvec2(4.0, between(random, 2.0, 4.0)));
    let coast = vec![dvec2(0.1, 0.0), dvec2(4.0, 0.3), dvec2(3.7, 3.0), dvec2(2.0, 2.2), dvec2(0.0, 4.0)];
    let hole = vec![dvec2(1.0, 1.0), dvec2(1.0, 1.6), dvec2(1.7, 1.1)];
    let islet = circle(dvec2(3.9, 3.8), 0.3, 9);
    let polygons = Domain::of_polygons(&[vec![coast, hole], vec![islet]]).unwrap();
    match random.u8(..5) {
        0 => Domain::rectangle(square),
        1 => Domain { bounds: square, shape: formula("x*y < 3").into(), projection: None },
        2 => polygons.with_bounds(Rect::new(dvec2(-0.5, -0.25), dvec2(4.5, 4.5))),
        3 => Domain { projection: Some("+proj=lcc +lat_0=50.5 +lon_0=9.1".parse().unwrap()), ..polygons },
        _ => polygons,
    }
}

fn raster(random: &mut fastrand::Rng, low: f32, high: f32) -> Arc<RasterPyramid> {
    let bounds = Rect::new(point(random) / 3.0, dvec2(2.0, 2.0) + point(random) / 2.0);
    let value = |random: &mut fastrand::Rng| match random.u8(..9) {
        0 => f32::NAN,
        _ => low + (high - low) * random.f32(),
    };
    let values = (0..12 * 9).map(|_| value(random)).collect();
    Arc::new(RasterPyramid::new(Raster::from_values(bounds, [12, 9], values)))
}

fn shapes(random: &mut fastrand::Rng) -> Shapes {
    let mut list = ShapeList::default();
    match random.u8(..3) {
        0 => list.points = (0..random.usize(1..40)).map(|_| point(random)).collect(),
        1 => list.lines = vec![vec![point(random), point(random), point(random)]],
        _ => list.polygons = vec![vec![circle(point(random), 0.4, random.usize(3..40))]],
    }
    Shapes::new(list, true).unwrap()
}

/// Returns edges, or a weir with one height or a profile.
fn line_kind(random: &mut fastrand::Rng) -> LineKind {
    let crest = match random.u8(..4) {
        0 => Crest::Height(between(random, -1.0, 9.0)),
        1 => {
            let mut shares: Vec<f64> = (0..random.usize(1..5)).map(|_| random.f64()).collect();
            shares.sort_by(f64::total_cmp);
            Crest::Profile(shares.into_iter().map(|share| [share, between(random, -1.0, 9.0)]).collect())
        }
        _ => return LineKind::Edges,
    };
    let supercritical = if random.bool() { 1.0 } else { between(random, 0.1, 2.0) };
    LineKind::Weir(Weir { supercritical, ..Weir::with_crest(crest) })
}

/// Returns a layer of any kind. Straits and the distance to the outline need a domain that has one.
fn kind(random: &mut fastrand::Rng, has_outline: bool) -> LayerKind {
    let at_zero = between(random, 0.05, 0.3);
    let (slope, range) = (between(random, 0.0, 0.6), [f64::INFINITY, 0.7][random.usize(..2)]);
    match random.u8(..if has_outline { 17 } else { 15 }) {
        0 => LayerKind::constant(between(random, 0.1, 1.0)),
        1 => LayerKind::target(formula("0.1 + 0.2*abs(x - y)")),
        2 => LayerKind::risk(formula("0.9*exp(-hypot(x - 1, y - 2))")),
        3 => LayerKind::Threats(threats(random)),
        4 => LayerKind::paint(Quantity::Risk),
        5 => LayerKind::paint([Quantity::Diameter, Quantity::Error][random.usize(..2)]),
        6 => {
            let source = RasterSource { name: "bottom.asc".into(), raster: raster(random, 0.0, 1.0) };
            BandLayer { source, between: [0.3, 0.4], diameter: at_zero }.into()
        }
        n @ 7..=9 => {
            let (low, reading) = match n {
                7 => (0.0, RasterReading::Risk),
                8 => (0.1, [RasterReading::Diameter, RasterReading::Error][random.usize(..2)].clone()),
                _ => {
                    let knots = vec![[0.1, 0.8], [0.6, 0.2], [0.9, 0.1]];
                    (0.0, RasterReading::Curve(Arc::new(ValueCurve::new(knots).unwrap())))
                }
            };
            let source = RasterSource { name: "grid".into(), raster: raster(random, low, 1.0) };
            RasterLayer { source, reading }.into()
        }
        10 => {
            let to = DistanceTo::Shapes { name: "lights.geojson".into(), shapes: shapes(random) };
            DistanceLayer { to, at_zero, slope, range }.into()
        }
        11 => LayerKind::Depth(depths(random)),
        12 => {
            let to = DistanceTo::Corridor { lines: shapes(random), width: 0.2 };
            DistanceLayer { to, at_zero, slope, range }.into()
        }
        13 => LayerKind::Surface(surface(random)),
        14 => LineSizes { across: between(random, 0.3, 1.5), ..LineSizes::default() }.into(),
        15 => {
            let (across, widths) = (between(random, 1.0, 5.0), [0.3, 1.5]);
            match random.bool() {
                true => LayerKind::Straits(Straits { across, found: MedialBalls::unknown(widths) }),
                false => LayerKind::FeatureSize(FeatureSize { across, found: MedialAxis::unknown(widths) }),
            }
        }
        _ => LayerKind::Distance(DistanceLayer { to: boundary_of(random), at_zero, slope, range }),
    }
}

fn surface(random: &mut fastrand::Rng) -> Surface {
    let norm = SurfaceNorm::ALL[random.usize(..3)];
    // No mesh has a small error of slopes where the surface has a step.
    let step = if norm == SurfaceNorm::Gradient { "" } else { " + if(x > y, 0.3, 0)" };
    let source = match random.u8(..3) {
        0 => SurfaceSource::Formula(formula(&format!("sin(2*x) * cos(3*y){step}"))),
        _ => {
            let raster = raster(random, -3.0, 5.0);
            SurfaceSource::Raster(RasterSource { name: "heights.asc".into(), raster })
        }
    };
    let goal = match random.bool() {
        true => SurfaceGoal::Within(between(random, 0.3, 3.0)),
        false => SurfaceGoal::AtMost(random.usize(20_000..40_000)),
    };
    Surface { source, goal, norm }
}

fn depths(random: &mut fastrand::Rng) -> Depths {
    let source = RasterSource { name: "depth.asc".into(), raster: raster(random, -30.0, 5.0) };
    let rule = match random.u8(..4) {
        0 => DepthRule::Nothing,
        1 => DepthRule::Wavelength { period: 12.0, triangles: between(random, 60.0, 200.0) },
        2 => DepthRule::Slope { triangles: 0.1, smoothing: [0.0, 0.8][random.usize(..2)] },
        _ => DepthRule::Courant { time_step: 0.02, number: between(random, 0.4, 2.0) },
    };
    let positive = [PositiveDepth::Up, PositiveDepth::Down][random.usize(..2)];
    let between = [DepthSizes::ALL_WATER, [2.0, 20.0], [3.0, f64::INFINITY]][random.usize(..3)];
    let offset = [0.0, 1.5, -2.0][random.usize(..3)];
    Depths::new(source, DepthSizes { positive, offset, between, rule })
}

fn boundary_of(random: &mut fastrand::Rng) -> DistanceTo {
    match random.u8(..4) {
        0 => DistanceTo::Outline,
        1 => DistanceTo::Coasts,
        _ => {
            let names = ["mainland", "Rock", "open south", "land"].map(str::to_owned);
            let names = names.into_iter().filter(|_| random.u8(..3) == 0).collect();
            let types = BoundaryType::ALL.into_iter().filter(|_| random.u8(..3) == 0).collect();
            DistanceTo::Pieces(PieceChoice { names, types })
        }
    }
}

fn threats(random: &mut fastrand::Rng) -> Threats {
    let count = random.usize(0..30);
    let one = |_| Threat {
        at: point(random),
        range: between(random, 0.1, 1.0),
        peak: random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    Threats::new((0..count).map(one).collect()).unwrap()
}

fn layer(random: &mut fastrand::Rng, kind: LayerKind) -> Layer {
    let mask = (random.u8(..3) == 0).then(|| {
        let corners = random.usize(3..50);
        Mask::new(&[vec![circle(point(random), 1.3, corners), circle(point(random), 0.4, corners)]]).unwrap()
    });
    let combine = match random.u8(..6) {
        0 => Combine::Floor,
        1 => Combine::Replace,
        _ => Combine::Finest,
    };
    let [layer] = Layer::stack([kind]).try_into().unwrap();
    Layer { combine, mask, visible: random.u8(..6) > 0, locked: random.u8(..6) == 0, ..layer }
}

/// Random paths, and regions of few and of many corners that they stay out of.
fn paths(random: &mut fastrand::Rng) -> PathPlan {
    let cost = match random.u8(..3) {
        0 => PathCost::default(),
        1 => PathCost::Weighted(Weights { length: random.f64(), risk: 20.0 * random.f64() }),
        _ => PathCost::Formula(CostFormula::parse("1 + 5*risk^2 + x").unwrap()),
    };
    let route = |random: &mut fastrand::Rng| (0..random.usize(2..5)).map(|_| point(random)).collect();
    let keep_out = |number: usize, random: &mut fastrand::Rng| {
        let polygons = [vec![circle(point(random), 0.2, random.usize(3..50))]];
        KeepOut { name: format!("Zone {number}"), mask: Mask::new(&polygons).unwrap() }
    };
    let plan = PathPlan {
        routes: (0..random.usize(..3)).map(|_| route(random)).collect(),
        names: Vec::new(),
        cost,
        keep_out: (0..random.usize(..3)).map(|number| keep_out(number, random)).collect(),
        clearance: [0.0, 0.01][random.usize(..2)],
    };
    plan.with_names((0..random.usize(..3)).map(|n| ["Ferry", "道 “2”"][n].to_owned()))
}

fn settings(random: &mut fastrand::Rng) -> Settings {
    let domain = domain(random);
    let has_outline = domain.as_region().is_some();
    let layers = (0..random.u32(1..6)).map(|id| {
        let kind = kind(random, has_outline);
        Layer { id: LayerId(2 * id + 1), ..layer(random, kind) }
    });
    let mut layers: Vec<Layer> = layers.collect();
    let has_depths = layers.iter().any(|layer| layer.kind.is::<Depths>());
    if has_depths && random.bool() {
        let of_depth = Formula::parse_of_size("0.3 + 0.01*abs(depth) + 0.02*x").unwrap();
        layers.push(Layer::new(LayerId(99), "Of the depth", LayerKind::target(of_depth)));
    }
    let spacing = between(random, 0.25, 0.6);
    let diameter = between(random, 0.1, 0.3);
    let transfer = Transfer {
        h_min: between(random, 0.1, 0.2),
        h_risk: between(random, 0.2, 0.3),
        h_max: between(random, 0.3, 1.5),
        shape: between(random, 0.5, 2.0),
    };
    let boundary = match random.u8(..4) {
        0 => BoundaryTreatment::Report,
        1 => BoundaryTreatment::Fitted { diameter },
        _ => BoundaryTreatment::OnOutline { diameter },
    };
    let parts = match random.u8(..3) {
        0 => KeptParts::All,
        1 => KeptParts::Largest,
        _ => KeptParts::Share(between(random, 0.0, 0.2)),
    };
    let most_pins = [4, 60][random.usize(..2)];
    let pins = random.usize(..most_pins);
    let lines = (0..random.usize(..3)).map(|n| Line {
        name: format!("line {n}"),
        points: (0..random.usize(2..5)).map(|_| point(random)).collect(),
        closed: random.bool(),
        kind: line_kind(random),
    });
    let settings = Settings {
        lines: Arc::new(lines.collect()),
        pins: Arc::new((0..pins).map(|_| point(random)).collect()),
        paths: Arc::new(paths(random)),
        boundary,
        cleaning: Cleaning { parts, keeps_pinches: random.bool(), improves_boundary: random.bool() },
        spacing,
        transfer,
        layers,
        gradation: random.bool().then(|| between(random, 0.5, 1.5)),
        rule: if random.u8(..3) == 0 { RefinementRule::Vertex } else { RefinementRule::Area },
        max_triangles: random.usize(300_000..900_000),
        max_memory: random.usize(100_000_000..900_000_000),
        max_level: (random.u8(..4) == 0).then(|| random.u32(2..14)),
        // Sizes from depths are in metres.
        unit: if has_depths { LengthUnit::Metre } else { LengthUnit::Kilometre },
        ..Settings::for_domain("Random".into(), domain)
    };
    Settings { boundary_marks: Arc::new(marks(random, &settings.domain)), ..settings }.checked().unwrap()
}

/// Random splits, names and types of pieces of the boundary, most of them on it.
fn marks(random: &mut fastrand::Rng, domain: &Domain) -> BoundaryMarks {
    let mut marks = BoundaryMarks::default();
    for _ in 0..random.usize(..6) {
        let pieces = BoundaryPieces::of_domain(domain, &marks);
        let at = |random: &mut fastrand::Rng| match &pieces {
            Some(pieces) => pieces.list()[random.usize(..pieces.list().len())].middle(),
            None => point(random),
        };
        match random.u8(..3) {
            0 => marks.splits.push(at(random)),
            1 => marks.names.push((at(random), ["Open “Sea”", "Rock", "land"][random.usize(..3)].to_owned())),
            _ => marks.types.push((at(random), BoundaryType::ALL[random.usize(..BoundaryType::ALL.len())])),
        }
    }
    marks
}

/// Returns a document with random settings and a stroke on each paint layer.
fn document(random: &mut fastrand::Rng) -> Document {
    let mut document = Document::new(settings(random), None).unwrap();
    let painted = document.settings().layers.iter().filter_map(|layer| Some((layer.id, layer.paints()?)));
    for (layer, quantity) in painted.collect::<Vec<_>>() {
        let medium = match quantity {
            Quantity::Risk => Medium::Risk(0.8),
            Quantity::Diameter => Medium::Diameter(0.12, DiameterChange::Finer),
            Quantity::Error => Medium::Error(0.03),
        };
        document.activate_layer(layer);
        document.begin_stroke(Brush { medium, radius: 0.3, hardness: 0.5, strength: 1.0 });
        document.draw_to(point(random));
        document.draw_to(point(random));
        document.end_stroke();
    }
    document
}

#[test]
fn random_documents_are_equal_when_they_are_saved_and_opened() {
    for seed in seeds(50) {
        let project = Project::of(&document(&mut fastrand::Rng::with_seed(2000 + seed)));
        let written = |project: &Project| {
            let mut bytes = Vec::new();
            write_project(&mut bytes, project).unwrap();
            bytes
        };
        let bytes = written(&project);
        let opened = from_bytes(&bytes, "a.meshbrush".as_ref()).unwrap();
        if opened != project {
            let texts = [&opened, &project].map(|project| format!("{project:?}"));
            let same = texts[0].bytes().zip(texts[1].bytes()).take_while(|(a, b)| a == b).count();
            let around = texts.map(|text| {
                String::from_utf8_lossy(&text.as_bytes()[same.saturating_sub(200)..])
                    .chars()
                    .take(300)
                    .collect::<String>()
            });
            panic!("seed {seed}: {around:#?}");
        }
        assert!(written(&opened) == bytes, "seed {seed}");
    }
}

/// Returns the fingerprint of the mesh in the window and the number of triangles that it exports.
fn in_window(document: &mut Document) -> String {
    let follower = Follower::new(document).unwrap();
    let cleaning = document.settings().derived_cleaning();
    let targets = follower.edge_targets(document.paint());
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
    let triangles = derived.extract(follower.mesh()).triangles().len();
    format!("{} {triangles}", follower.mesh().fingerprint())
}

/// Returns the fingerprint and the number of triangles that the command line prints for the mesh.
fn by_command(folder: &Folder, arguments: &[&str]) -> String {
    let Ran { status, out, err } = folder.run([&["mesh", "--json"], arguments].concat());
    assert_eq!(status, 0, "{arguments:?}: {err}");
    let summary: serde_json::Value = serde_json::from_str(&out).unwrap();
    format!("{} {}", summary["hash"].as_str().unwrap(), summary["triangles"])
}

#[test]
fn window_project_recipe_and_opened_recipe_have_one_mesh() {
    let folder = Folder::new("random");
    for seed in seeds(8) {
        let mut document = document(&mut fastrand::Rng::with_seed(seed));
        let project = Project::of(&document);
        let mut bytes = Vec::new();
        write_project(&mut bytes, &project).unwrap();
        folder.file("a.meshbrush", bytes);
        let expected = in_window(&mut document);
        assert_eq!(by_command(&folder, &["--project", "a.meshbrush"]), expected, "project, seed {seed}");
        let path = folder.0.join("a.toml");
        RecipeFiles::new(&project, &path).write(&Meter::default()).unwrap();
        assert_eq!(by_command(&folder, &["a.toml"]), expected, "recipe, seed {seed}");
        let OpenedRecipe { document: mut opened, .. } = open(&path, &Meter::default()).unwrap();
        assert_eq!(opened.settings().name, "a");
        let (of_recipe, of_project) = (opened.settings(), &project.settings);
        assert_eq!(of_recipe.paths, of_project.paths, "paths, seed {seed}");
        assert_eq!(of_recipe.pins, of_project.pins, "pins, seed {seed}");
        assert_eq!(of_recipe.lines, of_project.lines, "lines, seed {seed}");
        assert_eq!(of_recipe.boundary_marks, of_project.boundary_marks, "pieces, seed {seed}");
        assert_eq!(in_window(&mut opened), expected, "opened recipe, seed {seed}");
    }
}

/// Options that say the settings of a document with layers that options can name.
fn options(settings: &Settings) -> Vec<String> {
    let mut options: Vec<String> = Vec::new();
    let mut add = |option: &str, value: String| options.push(format!("--{option}={value}"));
    let Rect { min, max } = settings.domain.bounds;
    let bounds = format!("{},{},{},{}", min.x, min.y, max.x, max.y);
    match &settings.domain.shape {
        DomainShape::Region(_) => add("region", "a-domain.geojson".into()),
        DomainShape::Formula(shape) => {
            add("domain", bounds);
            add("inside", shape.formula().source().into());
        }
        _ => add("domain", bounds),
    }
    if !settings.domain.is_whole() {
        let (treatment, diameter) = match settings.boundary {
            BoundaryTreatment::Fitted { diameter } => ("fitted", Some(diameter)),
            BoundaryTreatment::OnOutline { diameter } => ("outline", Some(diameter)),
            _ => ("report", None),
        };
        add("boundary", treatment.into());
        if let Some(diameter) = diameter {
            add("boundary-diameter", diameter.to_string());
            let parts = match settings.cleaning.parts {
                KeptParts::All => "all".to_owned(),
                KeptParts::Share(share) => share.to_string(),
                _ => "largest".to_owned(),
            };
            add("parts", parts);
        }
    }
    add("spacing", settings.spacing.to_string());
    add("h-min", settings.transfer.h_min.to_string());
    add("h-risk", settings.transfer.h_risk.to_string());
    add("h-max", settings.transfer.h_max.to_string());
    add("transfer-shape", settings.transfer.shape.to_string());
    add("rule", if settings.rule == RefinementRule::Area { "area" } else { "vertex" }.into());
    settings.gradation.iter().for_each(|gradation| add("gradation", gradation.to_string()));
    settings.max_level.iter().for_each(|level| add("max-level", level.to_string()));
    for layer in &settings.layers {
        match &layer.kind {
            LayerKind::Formula(FormulaLayer { quantity: Quantity::Risk, formula }) => {
                add("risk", formula.source().into())
            }
            LayerKind::Formula(FormulaLayer { formula, .. }) => add("target", formula.source().into()),
            LayerKind::Threats(_) => add("threats", "a-threats.csv".into()),
            other => unreachable!("no option names {other:?}"),
        }
    }
    if settings.cleaning.keeps_pinches && settings.is_fitted() {
        options.push("--keep-pinches".into());
    }
    options
}

#[test]
fn options_have_the_mesh_of_a_document_with_their_settings() {
    let folder = Folder::new("options");
    for seed in seeds(8) {
        let random = &mut fastrand::Rng::with_seed(1000 + seed);
        let default = settings(random);
        // Polygons alone decide the bounds of a region.
        let domain = match default.domain.region() {
            Some(region) => Domain::of_polygons(region.polygons()).unwrap(),
            None => default.domain.clone(),
        };
        let threats = Threats::new((0..30).flat_map(|_| threats(random).list().to_vec()).collect());
        let layers = Layer::stack([
            LayerKind::target(formula("0.2 + 0.2*abs(x - y)")),
            LayerKind::risk(formula("0.8*exp(-hypot(x - 1, y - 2))")),
            LayerKind::Threats(threats.unwrap()),
        ]);
        // Options name lines by files alone.
        let settings = Settings { domain, layers, lines: Arc::default(), ..default };
        let mut document = Document::new(settings, None).unwrap();
        let project = Project::of(&document);
        RecipeFiles::new(&project, &folder.0.join("a.toml")).write(&Meter::default()).unwrap();
        let options = options(document.settings());
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        assert_eq!(by_command(&folder, &options), in_window(&mut document), "seed {seed}: {options:?}");
    }
}

/// Options override the settings of a project and the values of a recipe alike, as the same edit in the
/// window.
#[test]
fn options_override_projects_and_recipes() {
    let folder = Folder::new("override");
    let hole = vec![dvec2(1.0, 1.0), dvec2(1.0, 1.6), dvec2(1.7, 1.1)];
    let coast = vec![dvec2(0.1, 0.0), dvec2(4.0, 0.3), dvec2(3.7, 3.0), dvec2(0.0, 4.0)];
    let layers = Layer::stack([
        LayerKind::target(formula("0.2 + 0.3*abs(x - y)")),
        LayerKind::risk(formula("0.8*exp(-hypot(x - 1, y - 2))")),
    ]);
    let domain = Domain::of_polygons(&[vec![coast, hole]]).unwrap();
    let transfer = Transfer::between(0.1, 0.6);
    let base = Settings {
        layers,
        spacing: 0.5,
        transfer,
        boundary: BoundaryTreatment::OnOutline { diameter: 0.1 },
        ..Settings::for_domain("Coast".into(), domain)
    };
    let document = Document::new(base.clone(), None).unwrap();
    let project = Project::of(&document);
    let mut bytes = Vec::new();
    write_project(&mut bytes, &project).unwrap();
    folder.file("a.meshbrush", bytes);
    RecipeFiles::new(&project, &folder.0.join("a.toml")).write(&Meter::default()).unwrap();
    let (fitted, all) = (BoundaryTreatment::Fitted { diameter: 0.1 }, Cleaning::NONE);
    for (option, edited) in [
        ("--gradation=0.2", Settings { gradation: Some(0.2), ..base.clone() }),
        ("--h-min=0.05", Settings { transfer: Transfer::between(0.05, 0.6), ..base.clone() }),
        ("--h-risk=0.3", Settings { transfer: Transfer { h_risk: 0.3, ..transfer }, ..base.clone() }),
        ("--h-max=0.3", Settings { transfer: Transfer { h_max: 0.3, ..transfer }, ..base.clone() }),
        ("--transfer-shape=2", Settings { transfer: Transfer { shape: 2.0, ..transfer }, ..base.clone() }),
        ("--spacing=0.2", Settings { spacing: 0.2, ..base.clone() }),
        ("--rule=vertex", Settings { rule: RefinementRule::Vertex, ..base.clone() }),
        ("--boundary=fitted", Settings { boundary: fitted, ..base.clone() }),
        ("--boundary=report", Settings { boundary: BoundaryTreatment::Report, ..base.clone() }),
        (
            "--boundary-diameter=0.05",
            Settings { boundary: BoundaryTreatment::OnOutline { diameter: 0.05 }, ..base.clone() },
        ),
        ("--parts=all --keep-pinches", Settings { cleaning: all, ..base.clone() }),
    ] {
        let expected = in_window(&mut Document::new(edited, None).unwrap());
        let options: Vec<&str> = option.split(' ').collect();
        for file in [&["--project", "a.meshbrush"][..], &["a.toml"]] {
            assert_eq!(by_command(&folder, &[file, &options].concat()), expected, "{file:?} {option}");
        }
    }
    for (options, status, words) in [
        ("--project a.meshbrush --h-min 0.001 --h-max 0.01 --max-memory 1MB", 1, "1 MB of memory"),
        ("--project a.meshbrush --max-triangles 1000", 1, "1,000 triangles"),
        (
            "--project a.meshbrush --target 1",
            2,
            "--target cannot be used with --project a.meshbrush: domain and",
        ),
        ("--project a.meshbrush --risk-raster a.png", 2, "--risk-raster cannot be used with --project"),
        ("--project a.meshbrush --inside x", 2, "--inside cannot be used with --project"),
        ("--project a.meshbrush --h-min 2", 2, "The smallest diameter 2 is above the largest, 0.6"),
        ("--project a.meshbrush --boundary report --boundary-diameter 1", 2, "nothing is refined along"),
        ("a.toml --distance a.geojson --distance-at-zero 1", 2, "--distance cannot be used with a.toml"),
        ("a.toml --project a.meshbrush", 2, "cannot be used with"),
    ] {
        let arguments: Vec<&str> = ["mesh"].into_iter().chain(options.split(' ')).collect();
        let Ran { status: found, err, .. } = folder.run(&arguments);
        assert!(found == status && err.contains(words), "{options}\n{found}: {err}");
    }
}

#[test]
fn the_memory_budget_of_a_project_counts_on_the_command_line() {
    let folder = Folder::new("memory");
    let layers = Layer::stack([LayerKind::constant(0.002)]);
    let settings = Settings { layers, max_memory: 2_000_000, ..Settings::default() };
    let settings = Settings { transfer: Transfer::between(0.001, settings.transfer.h_max), ..settings };
    let project = Project::of(&Document::new(settings, None).unwrap());
    let mut bytes = Vec::new();
    write_project(&mut bytes, &project).unwrap();
    folder.file("a.meshbrush", bytes);
    RecipeFiles::new(&project, &folder.0.join("a.toml")).write(&Meter::default()).unwrap();
    for file in [&["--project", "a.meshbrush"][..], &["a.toml"]] {
        let Ran { status, err, .. } = folder.run([&["mesh"], file].concat());
        assert!(status == 1 && err.contains("2 MB of memory"), "{file:?} gave {status}: {err}");
        let Ran { status, err, .. } = folder.run([&["mesh"], file, &["--max-memory", "1GB"]].concat());
        assert_eq!(status, 0, "{file:?}: {err}");
    }
}

/// A recipe without limits opens with limits that a person can read, and with the same mesh.
#[test]
fn an_opened_recipe_has_limits_and_the_files_that_it_asks_for() {
    let folder = Folder::new("opened");
    folder.file("a.asc", "ncols 2\nnrows 2\nxllcorner 1\nyllcorner 1\ncellsize 1\n0.1 0.2\n0.3 0.4\n");
    folder.file(
        "strait.toml",
        "[mesh]\nmax_level = 9\n[[layer]]\nkind = \"raster\"\nfile = \"a.asc\"\nas = \"diameter\"\n\
         [[layer]]\nkind = \"raster\"\nfile = \"a.asc\"\nvisible = false\nas = \"diameter\"\n\
         [[output]]\nfile = \"a.vtu\"\n",
    );
    let OpenedRecipe { mut document, notes, outputs } =
        open(&folder.0.join("strait.toml"), &Meter::default()).unwrap();
    let Settings { name, transfer, layers, domain, .. } = document.settings();
    assert!(name == "strait" && layers.len() == 2 && !layers[1].visible);
    assert_eq!(domain.bounds, Rect::new(DVec2::ONE, DVec2::splat(3.0)), "the rasters decide");
    assert!(transfer.h_min > 1e-9 && transfer.h_max < 0.2, "{transfer:?}");
    assert_eq!(in_window(&mut document), by_command(&folder, &["strait.toml"]));
    assert_eq!(document.settings().max_level, Some(9));
    assert!(notes.is_empty(), "{notes:?}");
    assert!(outputs.len() == 1 && outputs[0].file == folder.0.join("a.vtu"), "{outputs:?}");
}
