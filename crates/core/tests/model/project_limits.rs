//! Documents as large as they may be: saved, killed, restored and opened, they are the same.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, KeepOut, PathPlan, Setting, Settings};
use meshbrush_core::domain::{Domain, MOST_CORNERS};
use meshbrush_core::layers::{
    DistanceLayer, DistanceTo, Layer, LayerKind, Mask, Quantity, RasterLayer, RasterReading, RasterSource,
    ShapeList, Shapes, Threat, ThreatLaw, Threats,
};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::journal::{Journal, Left, left};
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::{Meter, write_file};
use meshbrush_mesh::geometry::Rect;

use crate::runs::runs;

/// Returns a share of a limit: all of it in a long run.
fn share_of(limit: usize) -> usize {
    if runs(1) > 1 { limit } else { limit / 100 }
}

/// Returns a coast with bays around the middle of the unit square.
fn coast(corners: usize, radius: f64) -> Vec<DVec2> {
    let corner = |n: usize| {
        let angle = TAU * n as f64 / corners as f64;
        0.5 + radius * (1.0 + 0.1 * (40.0 * angle).sin()) * DVec2::from_angle(angle)
    };
    (0..corners).map(corner).collect()
}

fn line_of(points: usize) -> Shapes {
    let lines = vec![coast(points, 0.3)];
    Shapes::new(ShapeList { lines, ..ShapeList::default() }, true).unwrap()
}

fn threats(count: usize) -> Threats {
    let threat = |n: usize| {
        let at = dvec2((n as f64 * 0.618) % 1.0, n as f64 / count as f64);
        Threat { at, range: 0.01, peak: 0.1, law: ThreatLaw::ALL[n % 3].0 }
    };
    Threats::new((0..count).map(threat).collect()).unwrap()
}

fn raster(side: u32) -> LayerKind {
    let values = (0..side * side).map(|n| (n % 97) as f32 / 100.0).collect();
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(Rect::UNIT, [side, side], values)));
    RasterLayer { source: RasterSource { name: "slope.asc".into(), raster }, reading: RasterReading::Risk }
        .into()
}

/// Returns settings with as many points, threats, pixels and layers as files may have.
fn at_limits() -> Settings {
    let mask = || Mask::new(&[vec![coast(share_of(MOST_CORNERS), 0.4)]]).unwrap();
    let name = String::new();
    let to = DistanceTo::Shapes { name, shapes: line_of(share_of(MOST_CORNERS)) };
    let distance = LayerKind::Distance(DistanceLayer { to, at_zero: 0.05, slope: 0.5, range: f64::INFINITY });
    let few = [LayerKind::constant(0.2), distance, LayerKind::Threats(threats(share_of(100_000)))];
    let few = few.into_iter().chain([raster(10 * share_of(200) as u32), LayerKind::paint(Quantity::Risk)]);
    let many = (0..share_of(2_000)).map(|n| LayerKind::constant(0.2 + n as f64));
    let mut layers = Layer::stack(few.chain(many));
    layers[1].mask = Some(mask());
    let keep_out = [KeepOut { name: "Zone".into(), mask: mask() }];
    let domain = Domain::of_polygons(&[vec![coast(share_of(MOST_CORNERS), 0.45)]]).unwrap();
    Settings {
        layers,
        pins: Arc::new(coast(share_of(MOST_CORNERS), 0.2)),
        paths: Arc::new(PathPlan { keep_out: keep_out.into(), ..PathPlan::default() }),
        ..Settings::for_domain("Limits".into(), domain)
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("meshbrush-limits-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder); // of an earlier run
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn bytes_of(project: &Project) -> Vec<u8> {
    let mut bytes = Vec::new();
    project::write(&mut bytes, project).unwrap();
    bytes
}

fn fingerprint(project: Project) -> String {
    let mut document = project.into_document().unwrap();
    Follower::new(&mut document).unwrap().mesh().fingerprint().to_string()
}

#[test]
fn a_document_at_the_limits_is_saved_killed_restored_and_opened() {
    let folder = folder("whole");
    let mut document = Document::new(at_limits(), None).unwrap();
    let begun = Project::of(&document);
    let mut journal = Journal::begin(&folder, begun, None, 1, &Meter::default()).unwrap();
    let journal_bytes = || -> u64 {
        fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().metadata().unwrap().len()).sum()
    };
    let whole = journal_bytes();
    document.begin_stroke(Brush { medium: Medium::Risk(0.3), radius: 0.1, hardness: 0.5, strength: 1.0 });
    document.draw_to(dvec2(0.5, 0.4));
    document.end_stroke();
    journal.add(None, document.paint(), 2).unwrap();
    // Points are written once: a setting takes few bytes, whatever the document has.
    for gradation in [0.4, 0.3, 0.5] {
        let before = journal_bytes();
        document.set(Setting::Gradation(Some(gradation))).unwrap();
        journal.add(Some(document.settings().clone()), document.paint(), 3).unwrap();
        let added = journal_bytes() - before;
        assert!(20 * added < whole, "{added} bytes for a setting, {whole} in all");
    }
    document.undo();
    journal.add(Some(document.settings().clone()), document.paint(), 4).unwrap();
    drop(journal);
    let restored = left(&folder).map(|left| match left {
        Left::Work(work) => work.project.clone(),
        Left::Unreadable { problem, .. } => panic!("{problem}"),
    });
    let restored: Vec<Project> = restored.collect();
    let saved = Project::of(&document);
    assert!(restored.len() == 1 && restored[0] == saved, "the journal has another document");
    let bytes = bytes_of(&restored[0]);
    let opened = project::from_bytes(&bytes, Path::new("limits.meshbrush")).unwrap();
    assert!(opened == saved, "the project has another document");
    assert!(bytes_of(&opened) == bytes);
    assert_eq!(fingerprint(opened), fingerprint(saved));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_no_project_can_hold_leaves_the_saved_one_as_it_was() {
    let folder = folder("beyond");
    let file = folder.join("a.meshbrush");
    fs::write(&file, bytes_of(&Project::of(&Document::new(Settings::default(), None).unwrap()))).unwrap();
    let before = fs::read(&file).unwrap();
    let mut settings = Settings::default();
    settings.layers[0].name = "x".repeat(65 << 20);
    let project = Project { settings, paint: Default::default() };
    let problem = write_file(&file, |out| project::write(out, &project)).unwrap_err().to_string();
    assert!(problem.starts_with("its settings take 68,1"), "{problem}");
    assert!(problem.contains("the limit is 67,108,864 bytes; shorten"), "{problem}");
    assert!(fs::read(&file).unwrap() == before);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a part of it was left");
    fs::remove_dir_all(folder).unwrap();
}
