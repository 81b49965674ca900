//! The GPU and the software renderer draw the same picture.
//!
//! Without a graphics driver these tests say so and pass, unless MESHBRUSH_REQUIRE_GPU is set.
//! With MESHBRUSH_PICTURES set to a folder they leave what they drew there.
#![cfg(feature = "gpu")]

use crate::coast;
use crate::kept_picture::keep;
use glam::{DVec2, dvec2};
use meshbrush_core::build::BuiltMesh;
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{Changes, Limits, Mesh, PatchPieces, Progress, Updater};
use meshbrush_render::colormap::{LEVELS, LevelColors};
use meshbrush_render::render::gpu::{ChunkLimits, GpuError, GpuRenderer, Offscreen, ShownImage, read_back};
use meshbrush_render::render::software::PxRect;
use meshbrush_render::render::{Image, software};
use meshbrush_render::scene::{Camera, Overlay, ShownMesh, ShownRevision, Style};

const SIZE: [u32; 2] = [400, 300];
/// The formats of the canvases of windows.
const CANVAS_FORMATS: [wgpu::TextureFormat; 2] =
    [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Bgra8Unorm];

/// Opens a device; `None` where there is no driver and MESHBRUSH_REQUIRE_GPU is not set.
pub fn gpu() -> Option<Offscreen> {
    match Offscreen::new() {
        Ok(offscreen) => Some(offscreen),
        Err(e) if std::env::var_os("MESHBRUSH_REQUIRE_GPU").is_none() => {
            eprintln!("SKIPPED, nothing was compared: {e}");
            None
        }
        Err(e) => panic!("MESHBRUSH_REQUIRE_GPU is set: {e}"),
    }
}

/// Returns colours similar to those of the program: level 0 dark, then from violet to yellow.
fn colors() -> LevelColors {
    const STOPS: [[f32; 3]; 5] =
        [[70., 40., 120.], [59., 82., 139.], [33., 145., 140.], [94., 201., 98.], [253., 231., 37.]];
    std::array::from_fn(|level| {
        if level == 0 {
            return [0x1d, 0x21, 0x2b, 0xff];
        }
        let t = ((level - 1) as f32 / 3.0).min(3.99);
        let (i, f) = (t as usize, t.fract());
        let [r, g, b] = std::array::from_fn(|c| (STOPS[i][c] * (1.0 - f) + STOPS[i + 1][c] * f) as u8);
        [r, g, b, 255]
    })
    .into()
}

/// Returns a mesh that is graded towards a curve, with a round hole.
fn graded() -> Mesh {
    let contains = |p: DVec2| p.distance(dvec2(0.7, 0.3)) > 0.15;
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(),
        contains,
        &Limits::default(),
    )
    .unwrap();
    mesh.refine(&Limits::default(), |element| {
        let near = |x: DVec2| (x.y - 0.5 - 0.3 * (6.0 * x.x).sin()).abs();
        let target = element.world_corners().map(near).into_iter().fold(f64::MAX, f64::min);
        element.diameter() > (0.08 * target).max(0.0012)
    })
    .unwrap();
    mesh
}

/// Returns a mesh that is refined to the last level of the lattice around one node, and that node.
fn deep() -> (Mesh, LatticePoint) {
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.3, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    let deepest = mesh.lattice().deepest_level();
    let point = LatticePoint::new(0x2491_d3a7, 0x1b4c_8e35);
    mesh.refine(&Limits::default(), |element| {
        let xs = element.corners.map(|c| c.x);
        let ys = element.corners.map(|c| c.y);
        let in_box = (xs.iter().min() <= Some(&point.x) && Some(&point.x) <= xs.iter().max())
            && (ys.iter().min() <= Some(&point.y) && Some(&point.y) <= ys.iter().max());
        in_box && element.triangle.level() < deepest
    })
    .unwrap();
    assert_eq!(mesh.level_counts().len() as u32, deepest + 1);
    (mesh, point)
}

fn whole(mesh: &Mesh) -> Camera {
    Camera::fit(mesh.lattice(), mesh.lattice().bounds(), SIZE, 10.0)
}

/// Returns a camera on a node on the curve of [`graded`], a little off the middle.
fn close_up(mesh: &Mesh, zoom: f64) -> Camera {
    whole(mesh).zoomed(zoom, DVec2::ZERO).centered_on(dvec2(0.5, 0.55)).panned(dvec2(10.3, 5.8))
}

/// Returns mean difference of a colour component, and the share of pixels that differ by more than 8 in one.
fn difference(a: &Image, b: &Image) -> (f64, f64) {
    assert_eq!(a.size, b.size);
    let largest = |(p, q): (&[u8; 4], &[u8; 4])| (0..3).map(|c| p[c].abs_diff(q[c])).max().unwrap();
    let differing = a.pixels().iter().zip(b.pixels()).filter(|&pair| largest(pair) > 8).count();
    let total: u64 = a.rgba.iter().zip(&b.rgba).map(|(p, q)| u64::from(p.abs_diff(*q))).sum();
    let pixels = a.pixels().len() as f64;
    (total as f64 / (3.0 * pixels), differing as f64 / pixels)
}

pub fn assert_agree(name: &str, gpu: &Image, software: &Image) {
    keep(gpu, &format!("{name}-gpu"));
    keep(software, &format!("{name}-software"));
    let (mean, differing) = difference(gpu, software);
    eprintln!("{name}: mean difference {mean:.4} of 255, {:.3} % of pixels differ", 100.0 * differing);
    assert!(mean < 0.5, "{name}: mean difference {mean}");
    assert!(differing < 0.02, "{name}: {differing} of the pixels differ");
    let first = software.pixels()[0];
    assert!(software.pixels().iter().any(|&p| p != first), "{name}: the picture is empty");
}

#[test]
fn pictures_agree_at_every_zoom() {
    let Some(mut gpu) = gpu() else { return };
    let mesh = graded();
    gpu.show(&mesh, 1).unwrap();
    for (style_name, style) in [("dark", Style::dark(colors())), ("light", Style::light(colors()))] {
        for zoom in [0.3, 1.0, 2.7, 9.0, 40.0, 3000.0] {
            let camera = close_up(&mesh, zoom);
            let picture = gpu.picture(&camera, &style).unwrap();
            assert_agree(
                &format!("graded-{style_name}-{zoom}"),
                &picture,
                &software::draw(&mesh, &camera, &style, None, &[]),
            );
        }
    }
}

#[test]
fn pictures_agree_down_to_the_last_level() {
    let Some(mut gpu) = gpu() else { return };
    let (mesh, point) = deep();
    gpu.show(&mesh, 1).unwrap();
    let style = Style::dark(colors());
    let world = mesh.lattice().world_from_lattice(point);
    for zoom in [1.0, 1e2, 1e4, 1e6, 1e7, 1e300] {
        let camera = whole(&mesh).zoomed(zoom, dvec2(0.0, 0.0)).centered_on(world).panned(dvec2(13.3, 5.7));
        let picture = gpu.picture(&camera, &style).unwrap();
        assert_agree(&format!("deep-{zoom:e}"), &picture, &software::draw(&mesh, &camera, &style, None, &[]));
    }
}

#[test]
fn pictures_agree_where_cells_are_not_square() {
    let Some(mut gpu) = gpu() else { return };
    let bounds = Rect::new(dvec2(-7.0, 3.0), dvec2(-5.96, 4.0));
    let mut mesh =
        Mesh::coarse_grid(&Lattice::covering(bounds, 0.6, 1_000_000).unwrap(), |_| true, &Limits::default())
            .unwrap();
    let step = mesh.lattice().step();
    assert!((step.x / step.y - 1.04).abs() < 1e-9, "{step}");
    mesh.refine(&Limits::default(), |element| {
        let near = element.world_corners().iter().any(|x| x.distance(dvec2(-6.5, 3.4)) < 0.3);
        element.diameter() > if near { 0.02 } else { 0.2 }
    })
    .unwrap();
    gpu.show(&mesh, 1).unwrap();
    let style = Style::dark(colors()).at_density(2.0);
    for zoom in [1.0, 5.5, 1e4] {
        let camera = whole(&mesh).zoomed(zoom, dvec2(200.25, 150.0));
        let picture = gpu.picture(&camera, &style).unwrap();
        assert_agree(&format!("oblong-{zoom}"), &picture, &software::draw(&mesh, &camera, &style, None, &[]));
    }
}

#[test]
fn edges_of_huge_triangles_stay_in_place() {
    let Some(mut gpu) = gpu() else { return };
    let (mesh, _) = deep();
    gpu.show(&mesh, 1).unwrap();
    let style = Style::dark(colors());
    // The middle of a coarse diagonal, and a coarse node, both far from the refined point.
    let cell = mesh.lattice().cell_steps();
    for (name, node) in
        [("diagonal", LatticePoint::new(cell / 2, cell / 2)), ("node", LatticePoint::new(cell, 3 * cell))]
    {
        let at = whole(&mesh).zoomed(1e300, DVec2::ZERO).centered_on(mesh.lattice().world_from_lattice(node));
        for (i, pan) in [dvec2(0.0, 0.0), dvec2(60.25, -31.5)].into_iter().enumerate() {
            let camera = at.panned(pan);
            let picture = gpu.picture(&camera, &style).unwrap();
            assert_agree(
                &format!("huge-{name}-{i}"),
                &picture,
                &software::draw(&mesh, &camera, &style, None, &[]),
            );
        }
    }
}

#[test]
fn an_overlay_and_a_level_filter_agree() {
    let Some(mut gpu) = gpu() else { return };
    let mesh = graded();
    let style = Style { shown_levels: 0b1111_0000, ..Style::dark(colors()) };
    let rgba: Vec<[u8; 4]> = (0..20 * 30u32).map(|i| [(i % 20 * 12) as u8, (i / 3) as u8, 90, 180]).collect();
    let bounds = Rect::new(dvec2(0.1, 0.25), dvec2(0.9, 0.85));
    let overlay =
        Overlay { bounds, columns: 20, rows: 30, rgba: &rgba, beyond: [40, 80, 120, 255], revision: 1 };
    gpu.show(&mesh, 1).unwrap();
    gpu.show_overlay(Some(&overlay)).unwrap();
    for zoom in [1.0, 20.0, 1e5] {
        let camera = close_up(&mesh, zoom);
        let picture = gpu.picture(&camera, &style).unwrap();
        let expected = software::draw(&mesh, &camera, &style, Some(&overlay), &[]);
        assert_agree(&format!("overlay-{zoom}"), &picture, &expected);
    }
}

#[test]
fn a_translucent_fill_agrees_and_its_edges_stay_opaque() {
    let Some(mut gpu) = gpu() else { return };
    let mesh = graded();
    gpu.show(&mesh, 1).unwrap();
    let camera = close_up(&mesh, 3.0);
    let style = Style { fill_opacity: 0.4, ..Style::dark(colors()) };
    let shown = gpu.picture(&camera, &style).unwrap();
    let mut expected = software::draw(&mesh, &camera, &style, None, &[]);
    let alphas: Vec<u8> = expected.pixels().iter().map(|pixel| pixel[3]).collect();
    assert!([0, 102, 255].iter().all(|alpha| alphas.contains(alpha)), "ground, fill and edges");
    // The canvas below the mesh has the colour of the ground.
    for pixel in expected.rgba.chunks_exact_mut(4) {
        let below = 1.0 - f32::from(pixel[3]) / 255.0;
        for (channel, ground) in pixel.iter_mut().zip(style.ground) {
            *channel = (f32::from(*channel) + below * f32::from(ground)).round() as u8;
        }
    }
    assert_agree("translucent fill", &shown, &expected);
}

#[test]
fn a_mesh_in_many_chunks_looks_the_same() {
    let Some(gpu) = gpu() else { return };
    let mesh = graded();
    let (camera, style) = (whole(&mesh), Style::dark(colors()));
    // The fewest bits with which four buffers hold all nodes.
    let node_bits = (mesh.raw_nodes().len() as u32).div_ceil(4).next_power_of_two().ilog2();
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 1000, node_bits }).unwrap();
    gpu.show(&mesh, 1).unwrap();
    let picture = gpu.picture(&camera, &style).unwrap();
    assert_agree("chunks", &picture, &software::draw(&mesh, &camera, &style, None, &[]));

    let mut small = gpu.with_chunks(ChunkLimits { triangles: 1000, node_bits: node_bits - 2 }).unwrap();
    let refused = small.show(&mesh, 2).unwrap_err();
    assert!(matches!(refused, GpuError::TooManyNodes { .. }), "{refused}");
    assert!(small.picture(&camera, &style).is_ok(), "the canvas is still there");

    let coarse = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    small.show(&coarse, 3).unwrap();
    let former = small.picture(&camera, &style).unwrap();
    let mirror = small.renderer().mirror_mut();
    assert!(mirror.apply_changes(&mesh, 4, &differences(&coarse, &mesh)).is_err());
    assert_eq!(mirror.shown(), None);
    assert_eq!(small.picture(&camera, &style).unwrap(), former);
    small.renderer().mirror_mut().apply_changes(&coarse, 5, &Changes::default()).unwrap();
    assert_eq!(small.renderer().mirror().shown(), Some(5));
    assert_eq!(small.picture(&camera, &style).unwrap(), former);
}

#[test]
fn the_former_mesh_stays_until_the_next_is_whole() {
    let Some(gpu) = gpu() else { return };
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 700, node_bits: 15 }).unwrap();
    let (before, after) = (deep().0, graded());
    let (camera, style) = (whole(&before), Style::dark(colors()));
    gpu.show(&before, 1).unwrap();
    let first = gpu.picture(&camera, &style).unwrap();
    gpu.renderer().mirror_mut().begin_upload(&after, 2).unwrap();
    let mut slices = 0;
    while gpu.renderer().mirror_mut().advance_upload(&after, 100_000) == Progress::More {
        slices += 1;
        assert_eq!(gpu.renderer().mirror().shown(), Some(1));
        assert_eq!(gpu.renderer().mirror().uploading(), Some(2));
        assert_eq!(gpu.picture(&camera, &style).unwrap(), first);
    }
    assert!(slices > 5, "{slices}");
    assert_eq!(gpu.renderer().mirror().shown(), Some(2));
    let picture = gpu.picture(&camera, &style).unwrap();
    assert_agree("swapped", &picture, &software::draw(&after, &camera, &style, None, &[]));
}

#[test]
fn changed_ranges_bring_the_mesh_up_to_date() {
    let Some(gpu) = gpu() else { return };
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 900, node_bits: 14 }).unwrap();
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    let (camera, style) = (whole(&mesh), Style::dark(colors()));
    for step in 0..12u64 {
        let before = mesh.clone();
        let center = dvec2(0.1 + 0.07 * step as f64, 0.5);
        mesh.refine(&Limits::default(), |element| {
            let near = element.world_corners().iter().any(|x| x.distance(center) < 0.1);
            near && element.diameter() > 0.008
        })
        .unwrap();
        // The last step undoes all changes, as coarsening would.
        if step == 11 {
            mesh = Mesh::coarse_grid(
                &Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(),
                |_| true,
                &Limits::default(),
            )
            .unwrap();
        }
        let mirror = gpu.renderer().mirror_mut();
        mirror.apply_changes(&mesh, step, &differences(&before, &mesh)).unwrap();
        assert_eq!(mirror.shown(), Some(step));
        let picture = gpu.picture(&camera, &style).unwrap();
        assert_agree(&format!("ranges-{step}"), &picture, &software::draw(&mesh, &camera, &style, None, &[]));
    }
}

pub fn differences(before: &Mesh, after: &Mesh) -> Changes {
    Changes {
        nodes: changed(before.raw_nodes(), after.raw_nodes()),
        triangles: changed(before.raw_triangles(), after.raw_triangles()),
        ..Changes::default()
    }
}

fn changed<T: PartialEq>(before: &[T], after: &[T]) -> Vec<std::ops::Range<usize>> {
    (0..after.len()).filter(|&i| before.get(i) != Some(&after[i])).map(|i| i..i + 1).collect()
}

/// Returns whether an element exceeds level 13 where it touches one of the squares, or level 7 elsewhere.
fn exceeds(corners: [LatticePoint; 3], level: u32, squares: &[LatticeRect]) -> bool {
    let fine = squares.iter().any(|square| square.touches(corners));
    level < if fine { 13 } else { 7 }
}

#[test]
fn edits_during_an_upload_do_not_hold_it_up_and_get_there() {
    let Some(gpu) = gpu() else { return };
    // Nodes in several buffers, triangles in one, which is exchanged for a larger one on the way.
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 1 << 20, node_bits: 14 }).unwrap();
    let mut mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 0.2, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    let coarse = mesh.clone();
    let square = |x, y, half| coarse.lattice().rect_around(&Rect::around(dvec2(x, y), half)).unwrap();
    let [first, second, third] = [(0.3, 0.3), (0.7, 0.6), (0.3, 0.75)].map(|(x, y)| square(x, y, 0.12));
    let mut squares = vec![first, second];
    mesh.refine(&Limits::default(), |e| exceeds(e.corners, e.triangle.level(), &squares)).unwrap();
    let mut updater = Updater::new(Limits::default());
    gpu.show(&coarse, 0).unwrap();
    gpu.renderer().mirror_mut().begin_upload(&mesh, 1).unwrap();
    let whole_bytes = size_of_val(mesh.raw_triangles()) + size_of_val(mesh.raw_nodes());
    let (mut revision, mut lengths) = (1, vec![]);
    while gpu.renderer().mirror_mut().advance_upload(&mesh, whole_bytes / 16) == Progress::More {
        assert!(revision < 60, "edits hold the upload up: {lengths:?}");
        // Small edits; an edit that outgrows the buffers; an edit that removes more than is still to be sent;
        // and another small edit.
        let small =
            square(0.1 + 0.1 * (revision / 2 % 8) as f64, 0.2 + 0.1 * (revision / 2 % 7) as f64, 0.03);
        let edited = match revision {
            8 => third,
            20 => second,
            21 => square(0.7, 0.6, 0.1),
            _ => small,
        };
        match squares.iter().position(|square| *square == edited) {
            Some(place) => _ = squares.remove(place),
            None => squares.push(edited),
        }
        revision += 1;
        updater.add(edited);
        let rule = || |corners: [LatticePoint; 3], level: u32| exceeds(corners, level, &squares);
        while updater.advance(&mut mesh, &rule, usize::MAX) != Ok(Progress::Done) {}
        let Some(changes) = updater.take_changes() else { continue };
        gpu.renderer().mirror_mut().apply_changes(&mesh, revision, &changes).unwrap();
        assert_eq!(gpu.renderer().mirror().uploading(), Some(revision));
        assert_eq!(gpu.renderer().mirror().shown(), Some(0));
        lengths.push(mesh.raw_triangle_count());
    }
    assert_eq!(gpu.renderer().mirror().shown(), Some(revision));
    assert!(lengths.len() > 10 && !lengths.is_sorted(), "{lengths:?}");
    let style = Style::dark(colors());
    let cameras = [1.0, 4.0, 15.0].map(|zoom| whole(&mesh).zoomed(zoom, dvec2(170.0, 120.0)));
    let patched = cameras.map(|camera| gpu.picture(&camera, &style).unwrap());
    gpu.show(&mesh, revision + 1).unwrap();
    let sent_whole = cameras.map(|camera| gpu.picture(&camera, &style).unwrap());
    assert!(patched == sent_whole, "the mesh that was patched is not the one that was sent whole");
}

#[test]
fn the_picture_is_drawn_again_only_for_a_change() {
    let Some(mut gpu) = gpu() else { return };
    let mesh = graded();
    let (camera, style) = (whole(&mesh), Style::dark(colors()));
    gpu.show(&mesh, 1).unwrap();
    let first = gpu.picture(&camera, &style).unwrap();
    assert_eq!(gpu.picture(&camera, &style).unwrap(), first);
    assert_eq!(gpu.renderer().redraws(), 1, "nothing changed");
    gpu.frame(&camera.panned(dvec2(1.0, 0.0)), &style).unwrap();
    assert_eq!(gpu.renderer().redraws(), 2, "the camera moved");
    gpu.frame(&camera, &Style { edges: false, ..style.clone() }).unwrap();
    assert_eq!(gpu.renderer().redraws(), 3, "the style changed");
    gpu.frame(&camera.resized([300, 300]), &style).unwrap();
    assert_eq!(gpu.renderer().redraws(), 4, "the size changed");
    gpu.show(&mesh, 2).unwrap();
    gpu.frame(&camera.resized([300, 300]), &style).unwrap();
    assert_eq!(gpu.renderer().redraws(), 5, "the mesh changed");
}

#[test]
fn windows_with_blue_first_show_the_same_colors() {
    let Some(gpu) = gpu() else { return };
    let mesh = graded();
    let (camera, style) = (whole(&mesh), Style::dark(colors()));
    let mut gpu = gpu.with_format(wgpu::TextureFormat::Bgra8Unorm).unwrap();
    gpu.show(&mesh, 1).unwrap();
    let picture = gpu.picture(&camera, &style).unwrap();
    assert_agree("bgra", &picture, &software::draw(&mesh, &camera, &style, None, &[]));
}

#[test]
fn a_picture_drawn_in_software_reaches_the_canvas_unchanged() {
    for format in CANVAS_FORMATS {
        let Some(gpu) = gpu() else { return };
        let mut gpu = gpu.with_format(format).unwrap();
        let mesh = graded();
        let (camera, style) = (whole(&mesh), Style::dark(colors()));
        let expected = software::draw(&mesh, &camera, &style, None, &[]);
        let (shown, revision) = (ShownMesh::from(&mesh), ShownRevision { mesh: 1, pieces: 0 });
        assert_eq!(gpu.picture_in_software(shown, revision, &camera, &style).unwrap(), expected);
        assert_eq!(gpu.picture_in_software(shown, revision, &camera, &style).unwrap(), expected);
        assert_eq!(gpu.renderer().redraws(), 1, "nothing changed");
    }
}

#[test]
fn a_part_of_a_picture_is_written_to_its_place() {
    let size = [70, 50];
    let mut image = Image::filled(size, [0; 4]);
    for (index, byte) in image.rgba.iter_mut().enumerate() {
        *byte = (index * 31 % 251) as u8;
    }
    let part = PxRect { columns: 13..60, rows: 7..41 };
    for format in CANVAS_FORMATS {
        let Some(gpu) = gpu() else { return };
        let (device, queue) = (gpu.device(), gpu.queue());
        let mut shown = ShownImage::new(device, format);
        shown.fit(device, size).unwrap();
        shown.write(queue, &Image::filled(size, [10, 20, 30, 255]), &PxRect::whole(size));
        shown.write(queue, &image, &part);
        let canvas = canvas(device, size, format);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        shown.paint(&mut pass_onto(&mut encoder, &canvas), true);
        let read = read_back(device, queue, encoder, &canvas).unwrap();
        for (column, row) in (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (column, row))) {
            let is_within = part.columns.contains(&column) && part.rows.contains(&row);
            let expected = if is_within { image.pixel(column, row) } else { [10, 20, 30, 255] };
            assert_eq!(read.pixel(column, row), expected, "{format:?}, column {column}, row {row}");
        }
    }
}

/// Returns a canvas that can be read back.
fn canvas(device: &wgpu::Device, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Begins a render pass onto a canvas.
fn pass_onto<'e>(encoder: &'e mut wgpu::CommandEncoder, canvas: &wgpu::Texture) -> wgpu::RenderPass<'e> {
    let view = canvas.create_view(&wgpu::TextureViewDescriptor::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..wgpu::RenderPassDescriptor::default()
    })
}

#[test]
fn a_canvas_without_a_mesh_is_its_ground() {
    let Some(mut gpu) = gpu() else { return };
    let camera = whole(&graded());
    let style = Style { level_colors: [[9; 4]; LEVELS].into(), ..Style::light(colors()) };
    let picture = gpu.picture(&camera, &style).unwrap();
    assert_eq!(picture, Image::filled(SIZE, style.ground));
}

/// Asserts as [`assert_agree`] does, but so strictly that a wrong line along the coast is found.
fn assert_agree_closely(name: &str, gpu: &Image, software: &Image) {
    assert_agree(name, gpu, software);
    let (_, differing) = difference(gpu, software);
    assert!(differing < 0.0005, "{name}: {differing} of the pixels differ");
}

/// Compares pictures of a mesh with pieces: the whole mesh, and a close-up of the coast.
fn assert_coasts_agree(name: &str, gpu: &mut Offscreen, mesh: &Mesh, pieces: Option<&PatchPieces>) {
    let style = Style::dark(colors());
    let at = dvec2(0.86, 0.0);
    for zoom in [1.0, 4.0, 15.0] {
        let camera = whole(mesh).zoomed(zoom, DVec2::ZERO);
        let camera = if zoom > 1.0 { camera.centered_on(at) } else { camera };
        let expected = software::draw(ShownMesh { mesh, pieces }, &camera, &style, None, &[]);
        let picture = gpu.picture(&camera, &style).unwrap();
        assert_agree_closely(&format!("{name}-{zoom}"), &picture, &expected);
    }
}

/// Returns limits with which a mesh needs many buffers.
fn small_chunks(mesh: &Mesh) -> ChunkLimits {
    let node_bits = (mesh.raw_nodes().len() as u32).div_ceil(3).next_power_of_two().ilog2();
    ChunkLimits { triangles: 301, node_bits }
}

#[test]
fn pieces_agree_at_every_zoom() {
    let Some(gpu) = gpu() else { return };
    let built = coast::coast(0.06);
    let mesh = &built.mesh;
    let pieces = coast::pieces(mesh, &built);
    let mut gpu = gpu.with_chunks(small_chunks(mesh)).unwrap();
    gpu.show(mesh, 1).unwrap();
    assert_coasts_agree("coast-mesh", &mut gpu, mesh, None);
    gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
    let shown = ShownMesh { mesh, pieces: Some(&pieces) };
    // Some pieces of different sizes, at the middle of an edge: down to 200 px per lattice step.
    for (i, piece) in pieces.triangles().iter().step_by(pieces.triangles().len() / 5).enumerate() {
        let [a, b, _] =
            piece.vertices.map(|node| mesh.lattice().world_from_lattice(pieces.nodes()[node.index()]));
        for zoom in [1.0, 7.0, 50.0, 400.0, 3e3, 2e4, 1e6, 1e300] {
            let camera =
                whole(mesh).zoomed(zoom, DVec2::ZERO).centered_on(a.lerp(b, 0.31)).panned(dvec2(20.3, -11.6));
            for style in [Style::dark(colors()), Style::light(colors()).at_density(2.0)] {
                let expected = software::draw(shown, &camera, &style, None, &[]);
                let picture = gpu.picture(&camera, &style).unwrap();
                assert_agree_closely(&format!("piece-{i}-{zoom:e}"), &picture, &expected);
            }
        }
    }
    // Another mesh begins without pieces, in the other copy and in the one that had pieces.
    for revision in [2, 3] {
        gpu.show(mesh, revision).unwrap();
        assert_coasts_agree(&format!("coast-again-{revision}"), &mut gpu, mesh, None);
    }
}

/// Makes a mesh fine around a point, or coarse again with `None`, and returns the changes.
fn edit(mesh: &mut Mesh, built: &BuiltMesh, fine: Option<DVec2>) -> Changes {
    let before = mesh.clone();
    let mut updater = Updater::new(Limits::default());
    updater.add(LatticeRect { min: LatticePoint::new(0, 0), max: mesh.lattice().extent() });
    let criterion = built.criterion(None);
    let fine = fine.map(|at| mesh.lattice().rect_around(&Rect::around(at, 0.1)).unwrap());
    let exceeds = |corners: [LatticePoint; 3], level: u32| {
        let is_fine = fine.is_some_and(|square| square.touches(corners));
        (is_fine && level < 11) || criterion.exceeds_at(corners, level)
    };
    while updater.advance(mesh, &|| exceeds, usize::MAX).unwrap() == Progress::More {}
    mesh.classify(0..mesh.raw_triangle_count(), |element| built.domain.excludes(element));
    differences(&before, mesh)
}

#[test]
fn pieces_follow_the_edits_of_their_mesh() {
    let Some(gpu) = gpu() else { return };
    let built = coast::coast(0.06);
    let mut mesh = built.mesh.clone();
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 301, node_bits: 14 }).unwrap();
    gpu.show(&mesh, 0).unwrap();
    let places = [dvec2(0.8, 0.0), dvec2(0.0, 0.75), dvec2(-0.7, 0.1)];
    for (step, fine) in (1..).zip(places.map(Some).into_iter().chain([None])) {
        let mut pieces = coast::pieces(&mesh, &built);
        gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
        assert_coasts_agree(&format!("derived-{step}"), &mut gpu, &mesh, Some(&pieces));
        let changes = edit(&mut mesh, &built, fine);
        gpu.renderer().mirror_mut().apply_changes(&mesh, step, &changes).unwrap();
        let retired = pieces.retire(&mesh, &changes);
        assert!(!retired.is_empty(), "step {step}");
        gpu.renderer().mirror_mut().change_pieces(&pieces, &retired).unwrap();
        assert_coasts_agree(&format!("retired-{step}"), &mut gpu, &mesh, Some(&pieces));
    }
    assert_eq!(mesh.fingerprint(), built.mesh.fingerprint());
    gpu.renderer().mirror_mut().set_pieces(None).unwrap();
    assert_coasts_agree("without-pieces", &mut gpu, &mesh, None);
}

#[test]
fn pieces_wait_for_the_mesh_that_is_being_uploaded() {
    let Some(gpu) = gpu() else { return };
    let (built, finer) = (coast::coast(0.1), coast::coast(0.06));
    let mut mesh = finer.mesh.clone();
    let mut gpu = gpu.with_chunks(ChunkLimits { triangles: 301, node_bits: 14 }).unwrap();
    gpu.show(&built.mesh, 0).unwrap();
    let former = coast::pieces(&built.mesh, &built);
    gpu.renderer().mirror_mut().set_pieces(Some(&former)).unwrap();
    gpu.renderer().mirror_mut().begin_upload(&mesh, 1).unwrap();
    let slice = size_of_val(mesh.raw_triangles()) / 6;
    assert_eq!(gpu.renderer().mirror_mut().advance_upload(&mesh, slice), Progress::More);
    assert_eq!(gpu.renderer().mirror_mut().advance_upload(&mesh, slice), Progress::More);
    let mut pieces = coast::pieces(&mesh, &finer);
    gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
    // The mesh grows and shrinks during the upload.
    for (revision, fine) in [(2, Some(dvec2(0.8, 0.0))), (3, None), (4, Some(dvec2(0.0, 0.75)))] {
        let changes = edit(&mut mesh, &finer, fine);
        let mirror = gpu.renderer().mirror_mut();
        mirror.apply_changes(&mesh, revision, &changes).unwrap();
        let retired = pieces.retire(&mesh, &changes);
        mirror.change_pieces(&pieces, &retired).unwrap();
        assert_eq!(mirror.advance_upload(&mesh, slice / 2), Progress::More);
        assert_coasts_agree(&format!("waiting-{revision}"), &mut gpu, &built.mesh, Some(&former));
    }
    while gpu.renderer().mirror_mut().advance_upload(&mesh, slice) == Progress::More {}
    assert_eq!(gpu.renderer().mirror().shown(), Some(4));
    assert_coasts_agree("arrived", &mut gpu, &mesh, Some(&pieces));
    // Pieces of a mesh that is no longer shown change nothing.
    let mut former = former;
    let all = Changes {
        triangles: std::iter::once(0..built.mesh.raw_triangle_count()).collect(),
        ..Changes::default()
    };
    let retired = former.retire(&built.mesh, &all);
    gpu.renderer().mirror_mut().change_pieces(&former, &retired).unwrap();
    assert_coasts_agree("unaffected", &mut gpu, &mesh, Some(&pieces));
}

#[test]
fn a_picture_is_drawn_again_when_its_pieces_change() {
    let Some(mut gpu) = gpu() else { return };
    let built = coast::coast(0.1);
    let mesh = &built.mesh;
    let mut pieces = coast::pieces(mesh, &built);
    let (camera, style) = (whole(mesh), Style::dark(colors()));
    gpu.show(mesh, 1).unwrap();
    gpu.frame(&camera, &style).unwrap();
    gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
    gpu.frame(&camera, &style).unwrap();
    assert_eq!(gpu.renderer().redraws(), 2, "other pieces");
    let first = pieces.replaced().next().unwrap().index();
    let retired = pieces.retire(
        mesh,
        &Changes { triangles: std::iter::once(first..first + 1).collect(), ..Changes::default() },
    );
    gpu.renderer().mirror_mut().change_pieces(&pieces, &retired).unwrap();
    gpu.renderer().mirror_mut().change_pieces(&pieces, &[]).unwrap();
    gpu.frame(&camera, &style).unwrap();
    gpu.frame(&camera, &style).unwrap();
    assert_eq!(gpu.renderer().redraws(), 3, "one piece fewer");

    let shown = ShownMesh { mesh, pieces: Some(&pieces) };
    let expected = software::draw(shown, &camera, &style, None, &[]);
    for (revision, redraws) in [(1, 4), (1, 4), (2, 5)] {
        let revision = ShownRevision { mesh: 1, pieces: revision };
        assert_eq!(gpu.picture_in_software(shown, revision, &camera, &style).unwrap(), expected);
        assert_eq!(gpu.renderer().redraws(), redraws);
    }
}

#[test]
fn a_driver_with_too_few_storage_buffers_is_refused() {
    if gpu().is_none() {
        return;
    }
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let request = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
    let adapter = pollster::block_on(request).unwrap();
    let renderer_with = |buffers: u32| {
        let limits =
            wgpu::Limits { max_storage_buffers_per_shader_stage: buffers, ..wgpu::Limits::default() };
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        GpuRenderer::new(&device, &queue, wgpu::TextureFormat::Rgba8Unorm).err()
    };
    let refused = GpuError::TooFewStorageBuffers { available: 6, needed: 7 };
    assert_eq!((renderer_with(6), renderer_with(7)), (Some(refused), None));
}
