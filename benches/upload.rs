//! A mesh on its way to the screen: upload, drawing, and showing the kept picture again.
//!
//! Without a graphics driver only the software renderer is measured.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};
use meshbrush_render::colormap::LEVELS;
use meshbrush_render::scene::{Camera, Style};

const SIZE: [u32; 2] = [1200, 900];

/// Returns a graded mesh of about 100 thousand, 1 million and 4 million triangles.
fn meshes() -> Vec<(&'static str, Mesh)> {
    [("100k", 0.0024), ("1M", 0.0007), ("4M", 0.00033)].map(|(name, least)| (name, graded(least))).into()
}

fn graded(least: f64) -> Mesh {
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    mesh.refine(&Limits::default(), |element| {
        let off = |x: DVec2| (x.y - 0.5 - 0.3 * (6.0 * x.x).sin()).abs();
        let nearest = element.world_corners().map(off).into_iter().fold(f64::MAX, f64::min);
        element.diameter() > (0.1 * (nearest - 0.04)).max(least)
    })
    .unwrap();
    mesh
}

fn style() -> Style {
    Style::dark(std::array::from_fn(|level| [(level * 255 / LEVELS) as u8, 140, 90, 255]))
}

/// Returns the whole grid, panned a little each time, so that no kept picture can be reused.
fn moved(mesh: &Mesh, frame: &mut u32) -> Camera {
    *frame += 1;
    let camera = Camera::fit(mesh.lattice(), mesh.lattice().bounds(), SIZE, 20.0);
    camera.panned(DVec2::splat(f64::from(*frame % 16) / 16.0))
}

fn software(c: &mut Criterion) {
    let mut group = c.benchmark_group("software");
    for (name, mesh) in meshes() {
        group.throughput(Throughput::Elements(mesh.raw_triangle_count() as u64));
        let (style, mut frame) = (style(), 0);
        group.bench_function(BenchmarkId::new("draw", name), |b| {
            b.iter(|| {
                meshbrush_render::render::software::draw(&mesh, &moved(&mesh, &mut frame), &style, None, &[])
            });
        });
    }
}

fn gpu(c: &mut Criterion) {
    let mut offscreen = match meshbrush_render::render::gpu::Offscreen::new() {
        Ok(offscreen) => offscreen,
        Err(e) => return eprintln!("The GPU was not measured. {e}"),
    };
    eprintln!("Adapter: {}", offscreen.adapter());
    let mut group = c.benchmark_group("gpu");
    for (name, mesh) in meshes() {
        group.throughput(Throughput::Elements(mesh.raw_triangle_count() as u64));
        let (style, mut frame) = (style(), 0);
        let kept = moved(&mesh, &mut frame);
        group.bench_function(BenchmarkId::new("upload", name), |b| {
            b.iter(|| {
                offscreen.show(&mesh, 0).unwrap();
                // The queue executes writes with the next submission.
                offscreen.queue().submit([]);
                offscreen.device().poll(wgpu::PollType::wait_indefinitely()).unwrap();
            });
        });
        group.bench_function(BenchmarkId::new("redraw", name), |b| {
            b.iter(|| offscreen.frame(&moved(&mesh, &mut frame), &style).unwrap());
        });
        group.bench_function(BenchmarkId::new("kept picture", name), |b| {
            b.iter(|| offscreen.frame(&kept, &style).unwrap());
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    targets = software, gpu
}
criterion_main!(benches);
