//! What a picture of a large mesh costs a GPU: vertices, bytes and calls, with and without merging triangles
//! smaller than a pixel, and the time of a frame.
//!
//! - *all*: each triangle is looked at.
//! - *merged*: as in the window, once the mesh is arranged.
//!
//! Bytes are those that the vertex shader must fetch if nothing is fetched twice for a triangle and nothing
//! is shared between triangles: 32 of the triangle, three nodes of 8, 4 of its flags, and 2 of its list. The
//! frame is drawn on a canvas of a full HD screen. Lavapipe, which emulates a GPU on the processor, is
//! hundreds of times as slow as one; there the ratio counts.
//!
//! Without a graphics driver nothing is measured.

use std::hint::black_box;
use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_benches::diamond;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Limits, Mesh, Progress};
use meshbrush_render::colormap::{Colormap, Ground, LevelColors};
use meshbrush_render::render::gpu::Offscreen;
use meshbrush_render::scene::{Camera, Style};

const SIZE: [u32; 2] = [1920, 1080];
const ZOOMS: [f64; 3] = [1.0, 8.0, 64.0];
/// Frames of which the median counts; a frame with each triangle of a large mesh is drawn once.
const FRAMES: u32 = 3;
/// Blocks that the window arranges in a frame.
const BLOCKS_PER_FRAME: usize = 8;
/// Bytes of a triangle that is looked at: from the arrays, and from the list of its block.
const BYTES: [usize; 2] = [32 + 3 * 8 + 4, 2];

/// Returns the diamond of the report at a level.
fn uniform(level: u32) -> Mesh {
    let mut mesh = diamond::coarse();
    let rule = diamond::rule_within(&mesh, level);
    mesh.refine_in_blocks(&Limits::default(), &rule).expect("within the default limits");
    mesh
}

/// Returns a mesh whose levels change from place to place, by up to eight.
fn varied(finest: u32) -> Mesh {
    let mut mesh = diamond::coarse();
    let rule = || {
        move |corners: [LatticePoint; 3], level: u32| {
            let mix = |p: LatticePoint| {
                (p.x >> 14).wrapping_mul(0x9e37_79b1) ^ (p.y >> 14).wrapping_mul(0x85eb_ca77)
            };
            let asked = |p: LatticePoint| finest - (mix(p) >> 29);
            corners.into_iter().map(asked).max().is_some_and(|asked| level < asked)
        }
    };
    mesh.refine_in_blocks(&Limits::default(), &rule).expect("within the default limits");
    mesh
}

fn main() {
    let mut gpu = match Offscreen::new() {
        Ok(gpu) => gpu,
        Err(e) => return eprintln!("Nothing was measured. {e}"),
    };
    eprintln!("Adapter: {}", gpu.adapter());
    let levels = |level| uniform(level);
    let meshes: [(&str, &dyn Fn() -> Mesh); 4] = [
        ("uniform", &|| levels(7)),
        ("uniform", &|| levels(13)),
        ("uniform", &|| levels(17)),
        ("varied", &|| varied(16)),
    ];
    for (name, make) in meshes {
        measure(&mut gpu, name, &make());
    }
}

fn measure(gpu: &mut Offscreen, name: &str, mesh: &Mesh) {
    eprintln!("\n{name}, {} triangles", mesh.raw_triangle_count());
    gpu.show(mesh, 1).expect("the mesh fits the graphics memory");
    gpu.queue().submit([]);
    let colors = LevelColors::new(Colormap::Viridis, Ground::Dark, 19);
    let all = Style::dark(colors);
    let merged = all.clone().for_triangles(mesh.raw_triangle_count());
    let before = ZOOMS.map(|zoom| cost(gpu, mesh, zoom, &all));
    if Style::merges(mesh.raw_triangle_count()) {
        arrange(gpu, mesh);
    }
    eprintln!("  zoom                    vertices         bytes       frame");
    for (zoom, all) in ZOOMS.into_iter().zip(before) {
        all.report(zoom, "all", BYTES[0]);
        cost(gpu, mesh, zoom, &merged).report(zoom, "merged", BYTES[0] + BYTES[1]);
    }
}

fn arrange(gpu: &mut Offscreen, mesh: &Mesh) {
    let (began, mut slices) = (Instant::now(), Vec::new());
    loop {
        let start = Instant::now();
        let progress = gpu.renderer().mirror_mut().arrange(mesh, 1, BLOCKS_PER_FRAME);
        slices.push(start.elapsed());
        if black_box(progress.expect("the lists fit the graphics memory")) == Progress::Done {
            break;
        }
    }
    slices.sort();
    let (median, most) = (slices[slices.len() / 2], slices[slices.len() - 1]);
    eprintln!("  arranged in {:.2?}, {median:.2?} a frame, {most:.2?} at most", began.elapsed());
    gpu.queue().submit([]);
}

struct Cost {
    vertices: usize,
    frame: Duration,
}

fn cost(gpu: &mut Offscreen, mesh: &Mesh, zoom: f64, style: &Style) -> Cost {
    let camera = Camera::fit(mesh.lattice(), mesh.lattice().bounds(), SIZE, 20.0);
    let camera = camera.zoomed(zoom, dvec2(900.0, 500.0));
    let frame = |k: u32| {
        // No kept picture can be shown again.
        let camera = camera.panned(DVec2::splat(f64::from(k) / 16.0));
        let start = Instant::now();
        gpu.frame(&camera, style).expect("the canvas is not too large");
        start.elapsed()
    };
    let is_slow = style.merge_below_px == 0.0 && Style::merges(mesh.raw_triangle_count());
    let mut frames: Vec<_> = (1..=if is_slow { 1 } else { FRAMES }).map(frame).collect();
    frames.sort();
    let vertices = gpu.renderer().mirror().vertices(&camera, style);
    Cost { vertices, frame: frames[frames.len() / 2] }
}

impl Cost {
    fn report(&self, zoom: f64, name: &str, bytes: usize) {
        let megabytes = (self.vertices / 3 * bytes) as f64 / 1e6;
        eprintln!("  {zoom:4} {name:>8} {:>19} {megabytes:>10.1} MB {:>11.2?}", self.vertices, self.frame);
    }
}
