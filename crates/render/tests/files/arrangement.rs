//! On the GPU, a mesh of merged triangles looks the same however its triangles are arranged, and as in
//! software. Fewer of them are looked at.
#![cfg(feature = "gpu")]

use crate::coast;
use crate::detail::{graded, styles};
use crate::render_agreement::{assert_agree, differences, gpu};
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{Changes, Limits, Mesh, Progress, Updater};
use meshbrush_render::render::gpu::{ChunkLimits, Offscreen};
use meshbrush_render::render::{Image, software};
use meshbrush_render::scene::{Camera, ShownMesh, Style};

const SIZE: [u32; 2] = [240, 180];

fn camera(mesh: &Mesh, zoom: f64) -> Camera {
    Camera::fit(mesh.lattice(), mesh.lattice().bounds(), SIZE, 10.0).zoomed(zoom, dvec2(90.0, 60.0))
}

fn merging() -> impl Iterator<Item = (&'static str, Style)> {
    styles().into_iter().map(|(name, style)| (name, Style { merge_below_px: 1.0, ..style }))
}

fn arrange(gpu: &mut Offscreen, mesh: &Mesh, revision: u64) {
    let mirror = gpu.renderer().mirror_mut();
    while mirror.arrange(mesh, revision, 3).unwrap() == Progress::More {}
}

/// Returns pictures at several zooms in all styles, with the vertices for each. No two in a row have the same
/// camera, so that each is drawn.
fn pictures(gpu: &mut Offscreen, mesh: &Mesh) -> Vec<(String, Image, usize)> {
    let mut pictures = Vec::new();
    for ((name, style), zoom) in merging().zip([0.3, 0.6, 1.0, 2.2, 30.0]) {
        let camera = camera(mesh, zoom);
        let vertices = gpu.renderer().mirror().vertices(&camera, &style);
        pictures.push((format!("{name}-{zoom}"), gpu.picture(&camera, &style).unwrap(), vertices));
    }
    pictures
}

#[test]
fn an_arranged_mesh_looks_the_same_and_fewer_triangles_are_looked_at() {
    let Some(gpu) = gpu() else { return };
    let mesh = graded(0.0014);
    assert!(mesh.raw_triangle_count() > 4 << 14, "many blocks");
    let node_bits = (mesh.raw_nodes().len() as u32).div_ceil(4).next_power_of_two().ilog2();
    let small = gpu.with_chunks(ChunkLimits { triangles: 10_001, node_bits }).unwrap();
    for (chunks, mut gpu) in [("large", super::render_agreement::gpu().unwrap()), ("small", small)] {
        gpu.show(&mesh, 1).unwrap();
        let before = pictures(&mut gpu, &mesh);
        arrange(&mut gpu, &mesh, 1);
        for ((name, before, all), (_, after, fewer)) in before.into_iter().zip(pictures(&mut gpu, &mesh)) {
            assert!(before == after, "{chunks} {name}: the picture changed");
            eprintln!("{chunks} {name}: {fewer} of {all} vertices");
            assert_eq!(all, 3 * mesh.raw_triangle_count());
            // At the highest zoom nothing is merged, and blocks are skipped: large ones are seldom out of
            // sight.
            let is_high = name.ends_with("-30");
            let most = if is_high && chunks == "large" { all } else { all / 2 };
            assert!(fewer <= most, "{chunks} {name}: {fewer} of {all}");
        }
    }
}

#[test]
fn merged_triangles_are_those_of_the_software_renderer() {
    let Some(mut gpu) = gpu() else { return };
    let mesh = graded(0.0014);
    gpu.show(&mesh, 1).unwrap();
    for zoom in [0.26, 0.7, 1.5] {
        for (name, style) in merging().filter(|(_, style)| style.is_opaque()) {
            let camera = camera(&mesh, zoom);
            let shown = gpu.picture(&camera, &style).unwrap();
            assert_agree(
                &format!("merged-{name}-{zoom}"),
                &shown,
                &software::draw(&mesh, &camera, &style, None, &[]),
            );
        }
    }
    let built = coast::coast(0.012);
    let pieces = coast::pieces(&built.mesh, &built);
    gpu.show(&built.mesh, 2).unwrap();
    gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
    arrange(&mut gpu, &built.mesh, 2);
    let shown = ShownMesh { mesh: &built.mesh, pieces: Some(&pieces) };
    for (name, style) in merging().filter(|(_, style)| style.is_opaque()) {
        let camera = camera(&built.mesh, 0.4);
        let picture = gpu.picture(&camera, &style).unwrap();
        assert_agree(
            &format!("merged-coast-{name}"),
            &picture,
            &software::draw(shown, &camera, &style, None, &[]),
        );
    }
}

/// Makes a mesh coarse, but fine around a point, and returns the changes.
fn edit(mesh: &mut Mesh, at: DVec2) -> Changes {
    let before = mesh.clone();
    let mut updater = Updater::new(Limits::default());
    updater.add(LatticeRect { min: LatticePoint::new(0, 0), max: mesh.lattice().extent() });
    let square = mesh.lattice().rect_around(&Rect::around(at, 0.1)).unwrap();
    let exceeds =
        |corners: [LatticePoint; 3], level: u32| level < if square.touches(corners) { 11 } else { 7 };
    while updater.advance(mesh, &|| exceeds, usize::MAX).unwrap() == Progress::More {}
    differences(&before, mesh)
}

#[test]
fn an_arranged_mesh_follows_edits() {
    let Some(gpu) = gpu() else { return };
    let mut mesh = graded(0.002);
    let node_bits = (mesh.raw_nodes().len() as u32).next_power_of_two().ilog2();
    let chunks = ChunkLimits { triangles: 5_000, node_bits };
    let mut gpu = gpu.with_chunks(chunks).unwrap();
    gpu.show(&mesh, 0).unwrap();
    arrange(&mut gpu, &mesh, 0);
    for (revision, at) in (1..).zip([dvec2(0.3, 0.2), dvec2(0.7, 0.8)]) {
        let changes = edit(&mut mesh, at);
        gpu.renderer().mirror_mut().apply_changes(&mesh, revision, &changes).unwrap();
        let edited = pictures(&mut gpu, &mesh);
        arrange(&mut gpu, &mesh, revision);
        let arranged = pictures(&mut gpu, &mesh);
        let mut other = super::render_agreement::gpu().unwrap();
        other.show(&mesh, 0).unwrap();
        let anew = pictures(&mut other, &mesh);
        for ((edited, arranged), anew) in edited.iter().zip(&arranged).zip(&anew) {
            assert!(edited.1 == anew.1 && arranged.1 == anew.1, "edit {revision}, {}", anew.0);
        }
    }
}
