//! Projects: what is saved is what is opened, and no damage goes unnoticed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use glam::dvec2;
use meshbrush_core::document::{Document, Example, Follower, KeepOut, PathCost, PathPlan, Settings, Stage};
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryTreatment, BoundaryType, Domain, OutlineOnEarth,
};
use meshbrush_core::field::{CostFormula, Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    Combine, Layer, LayerId, LayerKind, Mask, PaintLayers, Quantity, RasterLayer, RasterReading, RasterSource,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::path::Weights;
use meshbrush_core::raster::{Raster, RasterPyramid, Tile, TilePlace};
use meshbrush_io::io::project::{self, Project};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

const NAME: &str = "test.meshbrush";

fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap()
}

fn bytes_of(project: &Project) -> Vec<u8> {
    let mut bytes = Vec::new();
    project::write(&mut bytes, project).unwrap();
    bytes
}

fn opened(bytes: &[u8]) -> Result<Project, String> {
    project::from_bytes(bytes, Path::new(NAME)).map_err(|error| error.to_string())
}

fn scribble(document: &mut Document, random: &mut fastrand::Rng) {
    let Rect { min, max } = document.settings().domain.bounds;
    let extent = (max - min).max_element();
    let h_min = document.settings().transfer.h_min;
    for medium in
        [Medium::Risk(1.0), Medium::Diameter(h_min, DiameterChange::Finer), Medium::Eraser, Medium::Risk(1.0)]
    {
        let radius = extent * (0.01 + 0.1 * random.f64());
        document.begin_stroke(Brush { medium, radius, hardness: random.f64(), strength: random.f64() });
        for _ in 0..3 {
            document.draw_to(min + (max - min) * dvec2(random.f64(), random.f64()));
        }
        document.end_stroke();
    }
}

/// Returns some paths with any places, and a cost by weights or by a formula.
fn paths(random: &mut fastrand::Rng) -> PathPlan {
    let mut place = || dvec2(random.f64(), -random.f64());
    let routes = (2..5).map(|count| (0..count).map(|_| place()).collect()).take(2).collect();
    let cost = match random.bool() {
        true => PathCost::Weighted(Weights { length: random.f64(), risk: 0.1 + random.f64() }),
        false => PathCost::Formula(CostFormula::parse("1 + x^2 + 5*risk").unwrap()),
    };
    // Random numbers of their own: the other settings, and the sizes of the meshes, stay what they were.
    let mut of_regions = fastrand::Rng::with_seed(16);
    let mut region = |n: usize| {
        let name = ["coast.geojson", ""][n].to_owned();
        KeepOut { name, mask: Mask::new(polygons(&mut of_regions).region().unwrap().polygons()).unwrap() }
    };
    let keep_out = (0..2).map(&mut region).collect();
    let names = (0..random.usize(..4)).map(|n| ["", "Ferry", "Шлях", "道"][n].to_owned());
    let clearance = [0.0, 0.25 * random.f64()][random.usize(..2)];
    PathPlan { routes, names: Vec::new(), cost, keep_out, clearance }.with_names(names)
}

/// Outlines with holes, crossing themselves and each other, at places where coordinates have many digits.
fn polygons(random: &mut fastrand::Rng) -> Domain {
    let corner = dvec2(1e6 * random.f64(), -1e3 * random.f64());
    let extent = 10f64.powf(4.0 * random.f64() - 1.0);
    let mut ring =
        |count| (0..count).map(|_| corner + extent * dvec2(random.f64(), random.f64())).collect::<Vec<_>>();
    let polygons = vec![vec![ring(7), ring(4)], vec![ring(3)], vec![ring(12)]];
    Domain::of_polygons(&polygons).unwrap()
}

/// Returns a name for every piece of the boundary, a type for the first seven, and a split of the first.
fn marks(domain: &Domain) -> BoundaryMarks {
    let pieces = BoundaryPieces::of_domain(domain, &BoundaryMarks::default()).unwrap();
    let name = |piece: &BoundaryPiece| (piece.middle(), format!("{} 'Ä' /\u{1f30a}", piece.name));
    BoundaryMarks {
        splits: vec![pieces.list()[0].points[0], pieces.list()[0].middle()],
        names: pieces.list().iter().map(name).collect(),
        types: pieces.list().iter().map(BoundaryPiece::middle).zip(BoundaryType::ALL).collect(),
    }
}

/// Returns layers of every kind, hidden and locked, combined in every way, with several to paint on.
fn stack(bottom: LayerKind) -> Vec<Layer> {
    let gap = Raster::from_values(Rect::UNIT, [3, 1], vec![0.1, f32::NAN, 0.3]);
    let holes = Raster::from_values(Rect::UNIT, [1, 3], vec![f32::INFINITY, f32::NAN, 0.02]);
    let holes = RasterSource { name: "holes.asc".into(), raster: Arc::new(RasterPyramid::new(holes)) };
    let mut layers = Layer::stack([
        bottom,
        LayerKind::paint(Quantity::Diameter),
        raster_layer("gap.asc", gap),
        LayerKind::Raster(RasterLayer { source: holes, reading: RasterReading::Diameter }),
        LayerKind::risk(formula("x * y")),
        LayerKind::paint(Quantity::Risk),
        LayerKind::paint(Quantity::Risk),
    ]);
    layers[2].combine = Combine::Floor;
    layers[3].combine = Combine::Replace;
    layers[4].visible = false;
    (layers[5].locked, layers[5].name) = (true, "Küste \"\\ \u{1f30a}".into());
    layers[0].id = LayerId(4_000_000_000);
    layers
}

fn raster_layer(name: &str, raster: Raster) -> LayerKind {
    let source = RasterSource { name: name.into(), raster: Arc::new(RasterPyramid::new(raster)) };
    RasterLayer { source, reading: RasterReading::Risk }.into()
}

/// Documents with everything that can be saved.
fn documents() -> Vec<Document> {
    let mut random = fastrand::Rng::with_seed(7);
    let plain = Settings::default();
    let mut all = vec![
        Example::Threats.without_data(),
        Example::Diamond.without_data(),
        Document::new(plain.clone(), None).unwrap(),
    ];
    for _ in 0..40 {
        let domain = polygons(&mut random);
        let extent = domain.bounds.size().max_element();
        let settings = Settings {
            name: "Küste \"\\ \u{1f30a}".into(),
            unit: LengthUnit::ALL[random.usize(..4)],
            boundary: BoundaryTreatment::Fitted { diameter: extent / (20.0 + random.f64()) },
            boundary_marks: Arc::new(marks(&domain)),
            pins: Arc::new(
                (0..random.usize(..5)).map(|_| dvec2(random.f64(), -extent * random.f64())).collect(),
            ),
            paths: Arc::new(paths(&mut random)),
            spacing: extent / (3.0 + random.f64()),
            transfer: Transfer {
                h_min: extent / 700.3,
                h_risk: extent / (random.f64() * 600.0 + 4.0),
                h_max: extent / 3.7,
                shape: 0.1 + random.f64(),
            },
            layers: Layer::default_stack(LayerKind::constant(extent * random.f64().max(1e-3))),
            max_triangles: 123_457,
            domain,
            ..plain.clone()
        };
        all.push(Document::new(settings, None).unwrap());
    }
    let size = [37, 21];
    let risks = (0..size[0] * size[1]).map(|_| random.f32()).collect();
    let raster = Raster::from_values(Rect::new(dvec2(-0.3, 0.1), dvec2(0.7, 1.0 / 3.0)), size, risks);
    let picture = Settings {
        domain: Domain {
            bounds: Rect::new(dvec2(-1.0, 0.1), dvec2(1.0, 0.7)),
            shape: formula("r < 0.9").into(),
            projection: None,
        },
        boundary: BoundaryTreatment::Report,
        layers: Layer::default_stack(raster_layer("slope.png", raster)),
        gradation: Some(1.0 / 3.0),
        rule: RefinementRule::Area,
        ..plain.clone()
    };
    all.push(Document::new(picture, None).unwrap());
    let target = || LayerKind::target(formula("0.02 + 0.1*hypot(x - 0.5, y - 0.5)"));
    all.push(Document::new(Settings { layers: stack(target()), ..plain.clone() }, None).unwrap());
    let layers = Layer::default_stack(target());
    all.push(Document::new(Settings { layers, rule: RefinementRule::Vertex, ..plain }, None).unwrap());
    for document in all.iter_mut().skip(3) {
        scribble(document, &mut random);
    }
    all
}

#[test]
fn a_saved_project_opens_equal_and_saves_to_the_same_bytes() {
    for document in documents() {
        let project = Project::of(&document);
        let bytes = bytes_of(&project);
        let back = opened(&bytes).unwrap();
        assert!(back == project, "{}", document.settings().name);
        let again = back.into_document().unwrap();
        assert_eq!(again.settings(), document.settings());
        assert!(again.paint() == document.paint());
        assert!(again.history().is_empty());
        assert!(bytes_of(&Project::of(&again)) == bytes);
    }
}

#[test]
fn saved_polygons_open_with_equal_corners() {
    let mut random = fastrand::Rng::with_seed(23);
    for _ in 0..1000 {
        let domain = polygons(&mut random);
        let polygons = domain.region().unwrap().polygons().to_vec();
        let again = Domain::of_stored_polygons(polygons, domain.bounds, &OutlineOnEarth::default());
        assert_eq!(again.as_ref(), Ok(&domain));
    }
    // What is no region's is put right: a square twice, and a square that runs the wrong way.
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| dvec2(x, y)).to_vec();
    let clockwise: Vec<_> = square.iter().rev().copied().collect();
    for polygons in [vec![vec![square.clone()], vec![square]], vec![vec![clockwise]]] {
        let domain = Domain::of_stored_polygons(polygons, Rect::UNIT, &OutlineOnEarth::default()).unwrap();
        assert_eq!(domain.region().unwrap().area(), 1.0);
        assert_eq!(domain.region().unwrap().polygons().len(), 1);
    }
}

#[test]
fn an_opened_project_has_the_mesh_of_the_saved_one() {
    for mut document in documents().into_iter().skip(1).step_by(14) {
        let mut back = opened(&bytes_of(&Project::of(&document))).unwrap().into_document().unwrap();
        let [before, after] =
            [&mut document, &mut back].map(|d| Follower::new(d).unwrap().mesh().fingerprint());
        assert_eq!(before, after);
    }
}

/// `cargo test --release --test program project -- --ignored --nocapture`
#[test]
#[ignore = "takes a minute in a debug build, and is there for its figures"]
fn a_painted_mesh_of_two_million_triangles_is_saved_and_opened() {
    let transfer = Transfer::between(4e-4, 0.05);
    let settings = Settings { transfer, spacing: 0.05, ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    let mut random = fastrand::Rng::with_seed(1);
    let mut follower = Follower::new(&mut document).unwrap();
    while follower.mesh().triangle_count() < 2_000_000 {
        let [radius, hardness, strength] =
            [0.02 + 0.04 * random.f64(), random.f64(), 0.3 + 0.5 * random.f64()];
        document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius, hardness, strength });
        (0..3).for_each(|_| document.draw_to(dvec2(random.f64(), random.f64())));
        document.end_stroke();
        while follower.advance(&mut document, 1 << 20).unwrap() != Stage::InStep {}
    }
    let file = folder("large").join(NAME);
    let began = Instant::now();
    let project = Project::of(&document);
    let copied = began.elapsed();
    fs::write(&file, bytes_of(&project)).unwrap();
    let written = began.elapsed();
    let began = Instant::now();
    let mut back = project::read(&file).unwrap();
    let opened = began.elapsed();
    let again = Follower::new(&mut back).unwrap();
    eprintln!(
        "{} triangles, {} bytes of paint; copied in {copied:.1?}, saved in {written:.1?}: {} bytes; opened in {opened:.1?}, meshed after \
         {:.1?}; fingerprints {} and {}",
        follower.mesh().triangle_count(),
        project.paint.bytes(),
        fs::metadata(&file).unwrap().len(),
        began.elapsed(),
        follower.mesh().fingerprint(),
        again.mesh().fingerprint(),
    );
    assert_eq!(follower.mesh().fingerprint(), again.mesh().fingerprint());
    let summary = meshed(&["--project", file.to_str().unwrap()]).unwrap();
    assert_eq!(summary["hash"], again.mesh().fingerprint().to_string());
}

/// What `meshbrush mesh --json` answers.
fn meshed(arguments: &[&str]) -> Result<serde_json::Value, String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshbrush"));
    let output = command.args(["mesh", "--json"]).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    if output.status.success() {
        Ok(serde_json::from_str(&text(output.stdout)).unwrap())
    } else {
        Err(format!("{:?} {}", output.status.code().unwrap(), text(output.stderr)))
    }
}

#[test]
fn the_command_line_and_the_window_make_the_same_mesh() {
    let file = folder("cli").join(NAME);
    let path = file.to_str().unwrap();
    let mut rules = Vec::new();
    for mut document in documents().into_iter().skip(1).step_by(14).chain(documents().into_iter().last()) {
        fs::write(&file, bytes_of(&Project::of(&document))).unwrap();
        let summary = meshed(&["--checks", "--project", path]).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        assert_eq!(summary["hash"], follower.mesh().fingerprint().to_string());
        assert_eq!((&summary["violations"], &summary["capped"]), (&0.into(), &0.into()));
        rules.push(summary["rule"].as_str().unwrap().to_owned());
    }
    assert!(rules.iter().any(|rule| rule == "vertex") && rules.iter().any(|rule| rule == "area"));
    // Its budget is the project's unless another is asked for, and its layers are its own.
    let refused = meshed(&["--project", path, "--max-triangles", "100"]).unwrap_err();
    assert!(refused.starts_with("1 ") && refused.contains("100"), "{refused}");
    let refused = meshed(&["--project", path, "--target", "1"]).unwrap_err();
    assert!(refused.starts_with("2 ") && refused.contains("--target"), "{refused}");
    fs::write(&file, &fs::read(&file).unwrap()[..100]).unwrap();
    let refused = meshed(&["--project", path]).unwrap_err();
    assert!(refused.starts_with("1 ") && refused.contains("cut off"), "{refused}");
}

#[test]
fn settings_are_readable_text_and_unzip_unpacks_them() {
    let folder = folder("unzip");
    let file = folder.join(NAME);
    let document = &documents()[3];
    fs::write(&file, bytes_of(&Project::of(document))).unwrap();
    let script = "import sys, zipfile, json\nz = zipfile.ZipFile(sys.argv[1])\nassert z.testzip() is None\n\
                  print(z.namelist(), json.loads(z.read('settings.json'))['max_triangles'], \
                  len(z.read('domain.0')))";
    let python = Command::new("python3").args(["-c", script]).arg(&file).output();
    let Ok(python) = python else { return }; // no Python on this machine
    let said = String::from_utf8_lossy(&python.stdout);
    let region = document.settings().domain.region().unwrap();
    let rings = region.rings().count();
    // Numbers of points, lines, polygons, rings of each polygon, and points of each ring; then the points.
    let length = 12 + 4 * region.polygons().len() + 4 * rings + 16 * region.corner_count();
    let expected = format!(
        "['settings.json', 'domain.0', 'polygons.0', 'polygons.1', 'paint.1', 'paint.2'] 123457 {length}"
    );
    assert_eq!(said.trim(), expected, "{}", String::from_utf8_lossy(&python.stderr));
}

/// Returns a small document that has every part. Tests try each of its bits, so its paint is a dab of either
/// kind.
fn small() -> Project {
    let square = vec![vec![dvec2(0.0, 0.0), dvec2(1.0, 0.1), dvec2(0.3, 1.0)]];
    let raster = Raster::from_values(Rect::UNIT, [2, 2], vec![0.0, 0.25, 0.5, 1.0]);
    let settings = Settings {
        domain: Domain::of_polygons(&[square]).unwrap(),
        layers: Layer::default_stack(raster_layer("a.png", raster)),
        ..Settings::default()
    };
    let mut document = Document::new(settings, None).unwrap();
    let h_min = document.settings().transfer.h_min;
    for medium in [Medium::Risk(1.0), Medium::Diameter(h_min, DiameterChange::Finer)] {
        document.begin_stroke(Brush { medium, radius: 0.03125, hardness: 1.0, strength: 1.0 });
        document.draw_to(dvec2(0.625, 0.375));
        document.end_stroke();
    }
    Project::of(&document)
}

#[test]
fn every_cut_is_refused() {
    let bytes = bytes_of(&small());
    for length in 0..bytes.len() {
        let error = opened(&bytes[..length]).err().unwrap_or_else(|| panic!("cut at {length}"));
        assert!(error.starts_with(NAME) && error.ends_with('.'), "{error}");
    }
}

#[test]
fn a_flipped_bit_is_refused_or_changes_nothing() {
    let project = small();
    let bytes = bytes_of(&project);
    let mut refused = 0;
    for place in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1 << bit;
            match opened(&damaged) {
                Ok(opened) => assert!(opened == project, "bit {bit} of byte {place}"),
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 6 * bytes.len(), "{refused} of {}", 8 * bytes.len());
}

#[test]
fn garbage_is_refused() {
    let bytes = bytes_of(&small());
    let mut random = fastrand::Rng::with_seed(11);
    for _ in 0..20_000 {
        let mut damaged = bytes.clone();
        for _ in 0..random.usize(1..20) {
            let place = random.usize(0..damaged.len());
            match random.u8(0..4) {
                0 => damaged[place] = random.u8(..),
                1 => drop(damaged.remove(place)),
                2 => damaged.insert(place, random.u8(..)),
                _ => damaged[place] = [0, 0xff, 0x7f, 0x80][random.usize(0..4)],
            }
        }
        let _ = opened(&damaged);
    }
}

/// Returns the small project with the text of its settings changed, in an archive with valid checksums.
fn rewritten(change: impl Fn(&str) -> String) -> Vec<u8> {
    let bytes = bytes_of(&small());
    let parts = unpacked(&bytes);
    packed(parts.into_iter().map(|(name, content)| match name.as_str() {
        "settings.json" => (name, change(str::from_utf8(&content).unwrap()).into_bytes()),
        _ => (name, content),
    }))
}

/// Returns the parts of an archive that the program wrote, read by the local headers alone.
fn unpacked(mut bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut parts = Vec::new();
    while bytes.starts_with(b"PK\x03\x04") {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (packed, name) = (word(18), word(26) & 0xffff);
        let content = &bytes[30 + name..][..packed];
        let mut unpacked = Vec::new();
        std::io::Read::read_to_end(&mut flate2::read::DeflateDecoder::new(content), &mut unpacked).unwrap();
        parts.push((String::from_utf8(bytes[30..30 + name].to_vec()).unwrap(), unpacked));
        bytes = &bytes[30 + name + packed..];
    }
    parts
}

/// Returns an archive of stored parts.
fn packed(parts: impl IntoIterator<Item = (String, Vec<u8>)>) -> Vec<u8> {
    let (mut out, mut directory, mut count) = (Vec::new(), Vec::new(), 0u16);
    for (name, content) in parts {
        let start = out.len() as u32;
        let size = (content.len() as u32).to_le_bytes();
        let crc = crc32fast::hash(&content).to_le_bytes();
        let common =
            [&[20, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &crc, &size, &size, &[name.len() as u8, 0, 0, 0]].concat();
        out.extend([b"PK\x03\x04", &common[..], name.as_bytes(), &content].concat());
        directory.extend(
            [b"PK\x01\x02\x14\0", &common[..], &[0; 10], &start.to_le_bytes(), name.as_bytes()].concat(),
        );
        count += 1;
    }
    let (size, start) = (directory.len() as u32, out.len() as u32);
    out.extend(directory);
    out.extend([&b"PK\x05\x06\0\0\0\0"[..], &count.to_le_bytes(), &count.to_le_bytes()].concat());
    out.extend([&size.to_le_bytes()[..], &start.to_le_bytes(), &[0, 0]].concat());
    out
}

fn refused(bytes: &[u8], words: &[&str]) {
    let Err(error) = opened(bytes) else { panic!("it was read, without an error about {words:?}") };
    for word in words {
        assert!(error.contains(word), "{word} in: {error}");
    }
}

#[test]
fn archives_packed_by_other_tools_are_opened() {
    assert!(opened(&rewritten(str::to_owned)).unwrap() == small());
}

/// The version that the program writes.
const VERSION: &str = "\"version\": 1";

#[test]
fn a_newer_version_is_named() {
    let newer = rewritten(|text| {
        let newer = text.replace(VERSION, "\"version\": 2, \"seasons\": [1, 2]");
        newer.replace(concat!("Meshbrush ", env!("CARGO_PKG_VERSION")), "Meshbrush 9.9")
    });
    refused(&newer, &[NAME, "settings.json", "Meshbrush 9.9", "version 2", "up to version 1."]);
}

#[test]
fn the_diameter_at_risk_1_is_the_smallest_unless_another_is_given() {
    let transfer = opened(&bytes_of(&small())).unwrap().settings.transfer;
    assert_eq!(transfer.h_risk, transfer.h_min);
    let other = rewritten(|text| text.replace("\"h_max\":", "\"h_risk\": 0.01, \"h_max\":"));
    assert_eq!(opened(&other).unwrap().settings.transfer.h_risk, 0.01);
    let wrong = rewritten(|text| text.replace("\"h_max\":", "\"h_risk\": 1e-9, \"h_max\":"));
    refused(&wrong, &[NAME, "The diameter at risk 1, 1e-9, must be from the smallest"]);
}

#[test]
fn errors_in_settings_name_their_place() {
    let cases: &[(&str, &str, &[&str])] = &[
        (VERSION, "\"version\": 1, \"seasons\": 4", &["line 3", "seasons"]),
        ("\"spacing\"", "\"spacing\": 1e999, \"spacings\"", &["settings.json"]),
        ("\"columns\": 2", "\"columns\": 100000", &["100,000 × 2", "65,536"]),
        ("\"columns\": 2", "\"columns\": 8192", &["raster", "checksum"]),
        ("\"columns\": 2", "\"columns\": 1", &["raster", "8 bytes more"]),
        ("\"id\": 1,", "\"id\": 2,", &["two layers", "2"]),
        ("\"id\": 1,", "\"id\": -1,", &["-1"]),
        ("\"max_triangles\": ", "\"max_triangles\": 999", &["max_triangles"]),
        ("\"shape\": 1.0", "\"shape\": -1.0", &["shape -1"]),
        ("Meshbrush project", "Somebody's project", &["Somebody"]),
        ("\"area\"", "\"aera\"", &["aera"]),
        ("\"spacing\": 0.0", "\"spacing\": 0.000000000", &["coarse"]),
    ];
    for (from, to, words) in cases {
        refused(
            &rewritten(|text| {
                assert!(text.contains(from), "{from}: {text}");
                text.replacen(from, to, 1)
            }),
            words,
        );
    }
    refused(&rewritten(|_| "{".repeat(100_000)), &["line 1"]);
    refused(&rewritten(|_| String::new()), &["settings.json"]);
}

#[test]
fn a_project_without_names_of_the_boundary_opens() {
    let project = Project::of(&documents().swap_remove(3));
    assert!(!project.settings.boundary_marks.is_empty());
    let mut plain = project.clone();
    plain.settings.boundary_marks = Arc::default();
    assert!(plain.settings.boundary_marks.is_empty());
    // The text is packed: the sizes show that nothing is written.
    assert!(bytes_of(&plain).len() + 50 < bytes_of(&project).len());
    assert_eq!(opened(&bytes_of(&plain)).unwrap(), plain);
}

#[test]
fn errors_stay_short_for_long_values() {
    let long = "m".repeat(100_000);
    for [from, to] in [
        ["Meshbrush project", &long],
        [VERSION, &format!("\"version\": 1, \"{long}\": 1")],
        ["\"written_by\": \"Mesh", &format!("\"written_by\": \"{long}")],
        ["\"spacing\"", &format!("\"{long}\"")],
        ["\"area\"", &format!("\"{long}\"")],
    ] {
        let bytes = rewritten(|text| {
            assert!(text.contains(from), "{from}: {text}");
            text.replacen(from, to, 1).replacen(
                VERSION,
                "\"version\": 2",
                usize::from(from.contains("written")),
            )
        });
        let error = opened(&bytes).unwrap_err();
        assert!(
            error.starts_with(NAME) && error.ends_with('.') && error.len() < 1000,
            "{} bytes",
            error.len()
        );
    }
    // From the fuzzer: numbers of three hundred digits. A few others of the kind.
    for [from, to] in [
        ["0.0,\n      0.0,", "1e300,\n      1e299,"],
        ["\"spacing\": ", "\"spacing\": -1e300"],
        ["\"h_min\": ", "\"h_min\": 1e300"],
        ["\"on_outline_with_diameter\": ", "\"on_outline_with_diameter\": -1e300"],
    ] {
        let bytes = rewritten(|text| {
            assert!(text.contains(from), "{from}: {text}");
            let (before, after) = text.split_once(from).expect("just seen");
            let rest = if from.ends_with(": ") { &after[after.find([',', '\n']).unwrap()..] } else { after };
            format!("{before}{to}{rest}")
        });
        let project = project::from_bytes(&bytes, Path::new(NAME)).map_err(|error| error.to_string());
        let error = project.and_then(|project| project.into_document()).unwrap_err();
        assert!(error.contains("1e300") && error.ends_with('.') && error.len() < 300, "{error}");
    }
    let parts = [("settings.json", "{}"), (&long[..200], ""), (&long[..200], "")];
    let twice = packed(parts.map(|(name, content)| (name.to_owned(), content.into())));
    assert!(opened(&twice).unwrap_err().len() < 200);
}

#[test]
fn declared_sizes_take_no_memory() {
    let bytes = bytes_of(&small());
    let directory = bytes.windows(4).rposition(|four| four == b"PK\x01\x02").unwrap();
    // The paint announces bytes that it does not have: few enough to try, and too many for so small a file.
    for (declared, word) in [(900_000_000u32, "damaged"), (3_000_000_000, "the limit is 1,000,000,000 bytes")]
    {
        let mut bomb = bytes.clone();
        bomb[directory + 24..directory + 28].copy_from_slice(&declared.to_le_bytes());
        refused(&bomb, &["paint", word]);
    }
    // The settings are 64 MB of blanks, packed in 64 kB.
    let mut blanks = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::Write::write_all(&mut blanks, &vec![b' '; 64 << 20]).unwrap();
    let mut bomb = packed([("settings.json".to_owned(), blanks.finish().unwrap())]);
    let at = bomb.windows(4).position(|four| four == b"PK\x01\x02").unwrap();
    bomb[at + 10] = 8;
    for declared in [64 << 20, 1000u32] {
        bomb[at + 24..at + 28].copy_from_slice(&declared.to_le_bytes());
        refused(&bomb, &["settings.json"]);
    }
}

#[test]
fn paint_of_all_layers_together_is_limited_by_the_size_of_the_file() {
    let mut settings = small().settings;
    settings.layers = Layer::stack([const { LayerKind::paint(Quantity::Risk) }; 3]);
    let mut paint = PaintLayers::default();
    for layer in &settings.layers {
        let mut raster = settings.blank_raster(layer.id);
        raster.exchange(TilePlace { depth: 0, x: 0, y: 0 }, Some(Arc::new(Tile::filled(1.0))));
        paint.insert(layer.id, raster);
    }
    let bytes = bytes_of(&Project { settings, paint });
    opened(&bytes).unwrap();
    let of_paint =
        |at: &usize| bytes[*at..].starts_with(b"PK\x01\x02") && bytes[at + 46..].starts_with(b"paint.");
    let directory: Vec<usize> = (0..bytes.len() - 46).filter(of_paint).collect();
    let [first, second, third] = directory[..] else { panic!("{directory:?}") };
    let declared = |at: usize| u32::from_le_bytes(bytes[at + 24..][..4].try_into().unwrap());
    // The last part declares all that the others leave, or one byte more.
    let left = 1_000_000_000 - declared(first) - declared(second);
    for (declared, word) in [(left, "damaged"), (left + 1, "the limit is 1,000,000,000 bytes")] {
        let mut bomb = bytes.clone();
        bomb[third + 24..][..4].copy_from_slice(&declared.to_le_bytes());
        refused(&bomb, &["paint", word]);
    }
}

#[test]
fn rasters_of_all_layers_together_are_limited_before_they_are_unpacked() {
    let mut settings = small().settings;
    let raster = || Raster::filled(Rect::UNIT, [2, 2], 0.0);
    settings.layers = Layer::stack([0, 1, 2].map(|n| raster_layer(&format!("{n}.asc"), raster())));
    let bytes = bytes_of(&Project { settings, paint: PaintLayers::default() });
    opened(&bytes).unwrap();
    // 200 million pixels each, which take a gigabyte for a few bytes of zeros.
    let with_large = |count: usize| {
        packed(unpacked(&bytes).into_iter().map(|(name, content)| match name.as_str() {
            "settings.json" => {
                let text = String::from_utf8(content).unwrap();
                assert_eq!(text.matches("\"columns\": 2,").count(), 3);
                let text = text.replacen("\"columns\": 2,", "\"columns\": 10000,", count);
                (name, text.replacen("\"rows\": 2", "\"rows\": 20000", count).into_bytes())
            }
            _ => (name, content),
        }))
    };
    refused(&with_large(2), &["damaged"]);
    refused(&with_large(3), &["600,000,000 pixels"]);
}

#[test]
fn files_that_are_not_projects_are_refused() {
    refused(b"", &["empty"]);
    refused(b"PK", &["not a Meshbrush project"]);
    refused(&[0x89, b'P', b'N', b'G'], &["not a Meshbrush project"]);
    refused(&packed([("readme.txt".to_owned(), b"hello".to_vec())]), &["no settings.json"]);
    let error = project::read(&folder("none").join("absent.meshbrush")).unwrap_err().to_string();
    assert!(error.contains("absent.meshbrush"), "{error}");
    assert!(project::read(Path::new("/dev/zero")).is_err());
}

#[test]
fn paint_with_impossible_values_is_refused() {
    let mut parts = unpacked(&bytes_of(&small()));
    let (_, paint) = parts.last_mut().unwrap();
    let valid = paint.clone();
    // After the grid of 32 bytes: depth, whether there are pixels, column, row, pixels.
    for (place, value) in [(32, 200), (33, 2), (37, 0x7f), (41, 0x80), (42, 0x7f), (42, 0xbf)] {
        let (_, paint) = parts.last_mut().unwrap();
        paint.copy_from_slice(&valid);
        paint[place] = value;
        refused(&packed(parts.clone()), &["paint", "Meshbrush did not write this file"]);
    }
    // The corner and the sides of the pixels of depth 0.
    for number in 0..4 {
        for impossible in [f64::NAN, f64::INFINITY, if number < 2 { f64::NAN } else { 0.0 }] {
            let (_, paint) = parts.last_mut().unwrap();
            paint.copy_from_slice(&valid);
            paint[8 * number..][..8].copy_from_slice(&impossible.to_le_bytes());
            refused(&packed(parts.clone()), &["paint", "cannot be painted"]);
        }
    }
    let (_, paint) = parts.last_mut().unwrap();
    paint.copy_from_slice(&valid);
    paint.push(0);
    refused(&packed(parts.clone()), &["paint"]);
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("project").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}
