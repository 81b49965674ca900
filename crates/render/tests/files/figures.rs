//! Measures times and memory of large and of deep layers. They take long in a debug build:
//!
//! ```sh
//! cargo test --release --test files figures -- --ignored --nocapture --test-threads 1
//! ```

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Settings, Stage};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerKind, Quantity, RasterLayer, RasterReading, RasterSource};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_io::io::png::{self as pictures, Behind};
use meshbrush_io::io::project::{self, Project};
use meshbrush_mesh::geometry::Rect;

/// The window's own value in `app/frame.rs`, and a slice.
const FRAME_BUDGET: Duration = Duration::from_millis(7);
const MESH_SLICE: usize = 256;
/// The window's default brush on the unit square.
const BRUSH: Brush = Brush { medium: Medium::Risk(1.0), radius: 0.06, hardness: 0.35, strength: 0.8 };

/// Reads the number of pixels along a side of the raster from `MESHBRUSH_SIDE`.
#[test]
#[ignore = "takes minutes in a debug build, and is there for its figures"]
fn figures_of_a_large_raster() {
    let side = std::env::var("MESHBRUSH_SIDE").map_or(10_000, |n| n.parse().unwrap());
    let file = written_picture(side);
    let bytes = fs::metadata(&file).unwrap().len();
    eprintln!("{side} × {side} pixels, {:.1} MB as PNG; before: {}", bytes as f64 / 1e6, memory());

    let began = Instant::now();
    let raster = pictures::read(&file, Rect::UNIT, Behind::Black).unwrap();
    eprintln!("read in {:.2?}: {}", began.elapsed(), memory());
    let began = Instant::now();
    let pyramid = Arc::new(RasterPyramid::new(raster));
    eprintln!("prepared in {:.2?}: {}", began.elapsed(), memory());
    fs::remove_file(file).unwrap();

    let source = RasterSource { name: "large.png".into(), raster: pyramid };
    let raster = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk });
    let settings = Settings {
        transfer: Transfer::between(5e-4, 0.05),
        spacing: 0.05,
        layers: Layer::stack([raster, LayerKind::paint(Quantity::Risk)]),
        ..Settings::default()
    };
    let mut document = Document::new(settings, None).unwrap();
    let began = Instant::now();
    let mut follower = Follower::new(&mut document).unwrap();
    let triangles = follower.mesh().raw_triangle_count();
    eprintln!("meshed in {:.2?}, {triangles} triangles: {}", began.elapsed(), memory());

    for n in 1..=3 {
        follower.take_change();
        let (mut first, began) = (None, Instant::now());
        document.begin_stroke(BRUSH);
        document.draw_to(DVec2::splat(0.5 + 0.07 * f64::from(n)));
        document.end_stroke();
        while advance(&mut document, &mut follower) != Stage::InStep {
            first = first.or_else(|| follower.take_change().map(|_| began.elapsed()));
        }
        let (rest, added) = (began.elapsed(), follower.mesh().raw_triangle_count() - triangles);
        let first = first.unwrap_or(rest);
        eprintln!("dab {n}: {first:.2?} to the first change, {rest:.2?} to rest; {added} triangles more");
        assert!(added > 0);
    }
    eprintln!("at the end: {}", memory());
}

/// Measures a stroke on the whole view, and a stroke at 4,096 times the zoom on an equally large mesh.
#[test]
#[ignore = "is there for its figures"]
fn figures_of_a_stroke_at_4096_times_zoom() {
    let mut sizes = Vec::new();
    for (name, zoom) in [("at fit", 1.0), ("at 4,096 times zoom", 4096.0)] {
        let settings = Settings {
            transfer: Transfer::between(0.004 / zoom, 0.5),
            layers: Layer::stack([LayerKind::paint(Quantity::Diameter)]),
            ..Settings::default()
        };
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        let (blank, before) = (project_bytes(&document), follower.mesh().raw_triangle_count());
        let frames = stroke_frames(&mut document, &mut follower, zoom);
        let (bytes, triangles) = (project_bytes(&document) - blank, follower.mesh().raw_triangle_count());
        let at = |share: f64| frames[(share * frames.len() as f64).ceil() as usize - 1];
        let (median, most) = (at(0.5), at(0.99));
        eprintln!("{name}: {bytes} bytes in the project, {} triangles more", triangles - before);
        eprintln!("  frames {median:.2?} median, {most:.2?} 99 %, {:.2?} worst", at(1.0));
        assert!(triangles > before + 1000);
        sizes.push(bytes);
    }
    assert!(sizes[1] < 4 * sizes[0], "a deep stroke takes more room than one at fit: {sizes:?}");
}

/// Draws a wave across the view, then follows until the mesh is up to date. Returns the work of each frame of
/// the stroke, sorted.
fn stroke_frames(document: &mut Document, follower: &mut Follower, zoom: f64) -> Vec<Duration> {
    const FRAMES: u32 = 120;
    let centre = dvec2(0.3127, 0.6183);
    let mut frames = Vec::new();
    // Triangles that are as large on the screen at any zoom.
    let medium = Medium::Diameter(0.005 / zoom, DiameterChange::Finer);
    document.begin_stroke(Brush { medium, radius: 0.06 / zoom, strength: 1.0, ..BRUSH });
    for n in 0..FRAMES {
        let share = f64::from(n) / f64::from(FRAMES - 1);
        let offset = dvec2(0.5 * share - 0.25, 0.2 * (9.0 * share).sin());
        let began = Instant::now();
        document.draw_to(centre + offset / zoom);
        while advance(document, follower) != Stage::InStep && began.elapsed() < FRAME_BUDGET {}
        frames.push(began.elapsed());
    }
    document.end_stroke();
    while advance(document, follower) != Stage::InStep {}
    frames.sort();
    frames
}

fn advance(document: &mut Document, follower: &mut Follower) -> Stage {
    follower.advance(document, MESH_SLICE).unwrap()
}

fn project_bytes(document: &Document) -> usize {
    let mut bytes = Vec::new();
    project::write(&mut bytes, &Project::of(document)).unwrap();
    bytes.len()
}

/// Returns a grey picture of smooth hills with grain, written row by row.
fn written_picture(side: u32) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = folder.join("large.png");
    let out = BufWriter::new(File::create(&file).unwrap());
    let mut encoder = png::Encoder::new(out, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().unwrap();
    let mut stream = writer.stream_writer().unwrap();
    let wave = |n: u32, waves: f64| (waves * f64::from(n) / f64::from(side)).sin();
    let across: Vec<f64> = (0..side).map(|x| wave(x, 21.0)).collect();
    let mut random = fastrand::Rng::with_seed(8);
    for y in 0..side {
        let down = wave(y, 17.0);
        let row: Vec<u8> =
            across.iter().map(|x| (200.0 * (x * down).max(0.0)) as u8 + random.u8(..8)).collect();
        std::io::Write::write_all(&mut stream, &row).unwrap();
    }
    stream.finish().unwrap();
    file
}

/// Returns memory of this process now and at its peak, where the system reports it.
fn memory() -> String {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let megabytes = |key: &str| {
        let line = status.lines().find(|line| line.starts_with(key))?;
        line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kilobytes| kilobytes * 1.024e-3)
    };
    match (megabytes("VmRSS"), megabytes("VmHWM")) {
        (Some(now), Some(peak)) => format!("{now:.0} MB now, {peak:.0} MB at the peak"),
        _ => "memory is not reported".into(),
    }
}
