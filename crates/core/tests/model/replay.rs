//! A recorded session gives the same meshes when it is replayed, and a difference is reported.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::operations::{Operation, Scale};
use glam::dvec2;
use meshbrush_core::document::{Background, Document, Edit, Follower, Picture, Setting, Settings, Stage};
use meshbrush_core::domain::{CutShape, corners};
use meshbrush_core::layers::{
    Layer, LayerId, LayerKind, Quantity, RasterLayer, RasterReading, RasterSource, Threat, ThreatLaw, Threats,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror, PathPoint};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::Meter;
use meshbrush_io::io::recording::{self, Replayed};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::Grouped;

fn recorded(settings: Settings) -> Document {
    let mut document = Document::new(settings, None).unwrap();
    document.record();
    document
}

fn exported(document: &Document) -> String {
    let mut text = Vec::new();
    recording::write(&mut text, document.recording().unwrap(), &Meter::default()).unwrap();
    String::from_utf8(text).unwrap()
}

fn replayed(text: &str) -> Result<Replayed, String> {
    let read = recording::from_bytes(text.as_bytes(), Path::new("session.jsonl"));
    read.and_then(|file| file.replay(&Meter::default())).map_err(|error| error.to_string())
}

/// Returns the fingerprint and the number of triangles that the window shows of a document, if it shows a
/// mesh.
fn shown(document: &mut Document, follower: &mut Follower) -> Option<(String, usize)> {
    loop {
        match follower.advance(document, 997) {
            Ok(Stage::InStep) => {
                let mesh = follower.mesh();
                return Some((mesh.fingerprint().to_string(), mesh.triangle_count()));
            }
            Ok(stage) if stage.is_settled() => return None,
            Ok(_) => {}
            Err(_) => return None,
        }
    }
}

/// Returns the meshes that a recording gives, the start first.
fn meshes(text: &str) -> Vec<Option<(String, usize)>> {
    let mesh = |line: &str| {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        let mesh = value["gives"].get("mesh")?;
        Some((mesh["fingerprint"].as_str()?.to_owned(), mesh["triangles"].as_u64()? as usize))
    };
    text.lines().skip(1).map(mesh).collect()
}

#[test]
fn three_hundred_random_gestures_replay_to_the_meshes_that_the_follower_showed() {
    let mut random = fastrand::Rng::with_seed(3);
    let scale = Scale { diameter: 0.03, smallest: 0.03, triangles: 100_000 };
    let mut document = recorded(Settings { spacing: 0.25, ..Settings::default() });
    let mut follower = Follower::new(&mut document).unwrap();
    let edits = |document: &Document| document.recording().unwrap().edits().len();
    let mut expected = vec![shown(&mut document, &mut follower)];
    let mut was_undone = false;
    while edits(&document) < 300 {
        // What was undone is often done again.
        let operation = match was_undone && random.bool() {
            true => Operation::Redo,
            false => Operation::choose(&mut random, scale),
        };
        was_undone = matches!(operation, Operation::Undo);
        // Opened again, a document has another recording. Strokes under a limited gradation take long.
        if matches!(operation, Operation::Reopen | Operation::Set(Setting::Gradation(_))) {
            continue;
        }
        // The window draws each gesture before the next one begins.
        let before = edits(&document);
        operation.apply(&mut document);
        document.end_stroke();
        document.end_gesture();
        let mesh = shown(&mut document, &mut follower);
        let new = edits(&document) - before;
        assert!(new <= 2, "one gesture, or the end of a stroke and a gesture");
        (1..new).for_each(|_| expected.push(None));
        if new > 0 {
            let is_stuck = mesh.is_none();
            expected.push(mesh);
            // A document over a budget would stay there for many gestures.
            if is_stuck && document.undo() {
                expected.push(shown(&mut document, &mut follower));
            }
        }
    }
    let text = exported(&document);
    let written = meshes(&text);
    assert_eq!(written.len(), expected.len());
    let compared = written.iter().zip(&expected).filter(|(_, expected)| expected.is_some());
    assert!(compared.clone().all(|(written, expected)| written == expected));
    let (count, all) = (compared.count(), expected.len());
    assert!(count > 250, "{count} meshes of {all}");
    let kinds = |kind: fn(&Edit) -> bool| {
        document.recording().unwrap().edits().iter().filter(|edit| kind(&edit.edit)).count()
    };
    let (strokes, settings) =
        (kinds(|edit| matches!(edit, Edit::Stroke(_))), kinds(|edit| matches!(edit, Edit::Settings(_))));
    assert!(strokes > 30 && settings > 30, "{strokes} {settings}");
    assert!(kinds(|edit| matches!(edit, Edit::Undo)) > 5 && kinds(|edit| matches!(edit, Edit::Redo)) > 0);
    let replayed = replayed(&text).unwrap();
    assert_eq!((replayed.edits, replayed.difference), (edits(&document), None));
}

fn set(document: &mut Document, setting: Setting) {
    document.set(setting).unwrap();
    document.end_gesture();
}

fn stroke(document: &mut Document, medium: Medium, mirror: Mirror, path: &[(f64, f64, f64)]) {
    let brush = Brush { medium, radius: 0.1, hardness: 0.3, strength: 0.7 };
    document.begin_mirrored_stroke(brush, mirror);
    for &(x, y, size) in path {
        document.extend_stroke(PathPoint { at: dvec2(x, y), size, strength: 1.0 });
    }
    document.end_stroke();
}

fn raster_layer() -> LayerKind {
    let values = (0..20 * 20).map(|n| (n % 7) as f32 / 7.0).collect();
    let raster = Raster::from_values(Rect::UNIT, [20, 20], values);
    let source = RasterSource { name: "slope.png".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    RasterLayer { source, reading: RasterReading::Risk }.into()
}

fn cut(document: &mut Document, shape: CutShape) {
    let domain = document.settings().domain.reshaped(&shape, false).unwrap();
    set(document, Setting::Domain(domain));
}

/// Returns a document with paint, a raster and a hole, and one edit of every kind.
fn every_kind_of_edit() -> Document {
    let kinds = [LayerKind::constant(0.3), raster_layer(), LayerKind::paint(Quantity::Diameter)];
    let settings = Settings { spacing: 0.25, layers: Layer::stack(kinds), ..Settings::default() };
    let mut document = Document::new(Settings { max_triangles: 20_000, ..settings }, None).unwrap();
    set(&mut document, Setting::SmallestDiameter(0.1));
    cut(&mut document, CutShape::Ring(corners(&Rect::around(dvec2(0.7, 0.7), 0.1))));
    let either = Medium::Diameter(0.12, DiameterChange::Any);
    stroke(&mut document, either, Mirror::default(), &[(0.3, 0.3, 1.0)]);
    let start = Document::new(document.settings().clone(), Some(document.paint().clone())).unwrap();
    document.replace_with(start);
    document.record();

    let mut layers = document.settings().layers.clone();
    layers.push(Layer::new(LayerId(3), "Risk", LayerKind::paint(Quantity::Risk)));
    layers.push(Layer::new(LayerId(4), "Slope", raster_layer()));
    let threat = Threat { at: dvec2(0.1, 0.9), range: 0.2, peak: 0.9, law: ThreatLaw::Radar };
    let threats = LayerKind::Threats(Threats::new(vec![threat]).unwrap());
    layers.push(Layer::new(LayerId(5), "Sites", threats));
    set(&mut document, Setting::Layers(layers.clone()));
    // The pixels of the new layer lie where the domain is now.
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.0, strength: 1.0 });
    document.draw_to(dvec2(0.5, 0.5));
    document.cancel_stroke();
    set(&mut document, Setting::Bounds(Rect::new(dvec2(-0.013, 0.0), dvec2(1.0, 1.1))));
    let mirror = Mirror { x: Some(0.5), y: None };
    stroke(&mut document, Medium::Risk(0.9), mirror, &[(0.1, 0.2, 0.5), (1.0 / 3.0, 0.6, 1.0)]);
    document.copy_paint(LayerId(3), LayerId(6));
    layers.push(Layer::new(LayerId(6), "Risk 2", LayerKind::paint(Quantity::Risk)));
    set(&mut document, Setting::Layers(layers.clone()));
    document.undo();
    stroke(
        &mut document,
        Medium::Diameter(0.1, DiameterChange::Finer),
        Mirror::default(),
        &[(0.9, 0.1, 1.0)],
    );
    stroke(
        &mut document,
        Medium::Diameter(0.2, DiameterChange::Coarser),
        Mirror::default(),
        &[(0.3, 0.3, 1.0)],
    );
    stroke(&mut document, Medium::Eraser, Mirror::default(), &[(0.2, 0.3, 1.0), (0.3, 0.6, 1.0)]);
    document.undo();
    document.undo();
    document.redo();
    cut(&mut document, CutShape::Stroke { path: vec![dvec2(0.0, 0.4), dvec2(0.2, 0.4)], radius: 0.05 });
    let picture = Arc::new(Picture { size: [1, 1], rgba: vec![9; 4] });
    let (name, bounds) = ("map".into(), Rect::UNIT);
    set(&mut document, Setting::Background(Some(Background { name, picture, bounds, opacity: 0.5 })));
    // A drag: the largest diameter rises with the smallest, and stays.
    document.set(Setting::SmallestDiameter(0.5)).unwrap();
    set(&mut document, Setting::SmallestDiameter(0.09));
    set(&mut document, Setting::MaxTriangles(100));
    document.undo();
    document.clear_layer(LayerId(2));
    document.undo();
    set(&mut document, Setting::Gradation(Some(0.5)));
    document
}

#[test]
fn every_kind_of_edit_replays_and_leads_to_the_same_document() {
    let document = every_kind_of_edit();
    let text = exported(&document);
    let result = replayed(&text).unwrap();
    assert_eq!(result.difference, None);
    assert_eq!(result.edits, document.recording().unwrap().edits().len());
    assert!(text.contains(r#""gives":{"no_mesh":"#), "100 triangles are too few");
    let opened = Document::new(document.settings().clone(), Some(document.paint().clone())).unwrap();
    let mesh = Follower::new(&mut opened.clone()).unwrap().mesh().fingerprint().to_string();
    assert_eq!(meshes(&text).last().unwrap().as_ref().unwrap().0, mesh, "it is the mesh of the document");
    assert!(text.lines().all(|line| !line.contains("NaN")) && !text.contains("map"));
}

#[test]
fn a_mesh_that_differs_is_reported_with_the_edit() {
    let document = every_kind_of_edit();
    let text = exported(&document);
    let lines: Vec<&str> = text.lines().collect();
    let place = lines.iter().position(|line| line.contains("[[0.9,0.1]]")).unwrap();
    let (fingerprint, triangles) = meshes(&text)[place - 1].clone().unwrap();
    let changed = lines[place].replace(&fingerprint, &"0".repeat(32));
    let with = |line: &str| {
        let mut lines = lines.clone();
        lines[place] = line;
        lines.join("\n") + "\n"
    };
    let difference = replayed(&with(&changed)).unwrap().difference.unwrap();
    let (edit, triangles) = (place - 1, Grouped(triangles));
    assert_eq!(
        difference.to_string(),
        format!(
            "The mesh after edit {edit} (paint) differs: expected is {} ({triangles} triangles), and found was \
             {fingerprint} ({triangles} triangles).",
            "0".repeat(32)
        )
    );
    // Another stroke: the first mesh that differs is the one after it.
    let moved = lines[place].replace("[[0.9,0.1]]", "[[0.1,0.9]]");
    assert_ne!(moved, lines[place]);
    assert_eq!(replayed(&with(&moved)).unwrap().difference.unwrap().edit, edit);
}

#[test]
fn mistakes_are_reported_with_their_line() {
    let mut document = recorded(Settings { spacing: 0.5, ..Settings::default() });
    set(&mut document, Setting::Spacing(0.4));
    document.undo();
    let text = exported(&document);
    let said = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        replayed(&text.replace(from, to)).unwrap_err()
    };
    let newer = "reads up to version 1. Use a newer Meshbrush.";
    assert!(said(r#""version":1"#, r#""version":7"#).ends_with(newer));
    assert_eq!(
        said(r#"{"format":"Mesh"#, r#"{"format":"Fish"#),
        "session.jsonl, line 1: this is not a Meshbrush recording."
    );
    assert!(said(r#""spacing":0.4"#, r#""spacing":-1"#).starts_with("session.jsonl, line 3: "));
    assert!(
        said(r#""spacing":0.4"#, r#""gap":1"#).starts_with(
            "session.jsonl, line 3: the settings are not valid: gap: there is no key `gap` here"
        )
    );
    assert_eq!(
        said(r#""does":"undo""#, r#""does":"redo""#),
        "session.jsonl, line 4: There is nothing to redo."
    );
    assert!(said(r#""does":"undo""#, r#""does":"fly""#).starts_with("session.jsonl, line 4, column "));
    assert!(said(r#"{"edit":2"#, r#"{"edit":3"#).ends_with("line 4: this is edit 3, and 2 would be next."));
    assert!(replayed(text.trim_end()).unwrap_err().contains("cut off"));
}

#[test]
fn the_sessions_of_this_folder_give_the_meshes_that_they_had() {
    let mut count = 0;
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/sessions")).unwrap() {
        let path = entry.unwrap().path();
        let replayed = recording::read(&path).and_then(|file| file.replay(&Meter::default())).unwrap();
        assert_eq!(replayed.difference.map(|difference| difference.to_string()), None, "{}", path.display());
        count += 1;
    }
    assert!(count >= 2);
}
