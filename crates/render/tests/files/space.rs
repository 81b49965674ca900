//! Pictures in space: from above they are those of the plan, what is in front hides what is behind it, and the
//! GPU draws what the software renderer draws.

use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};
use meshbrush_render::colormap::{LEVELS, LevelColors};
use meshbrush_render::render::{Image, software};
use meshbrush_render::scene::{
    Light, NodeHeights, ShownSurface, SpaceCamera, SpaceView, Style, ViewDirection,
};

const SIZE: [u32; 2] = [400, 300];

fn colors() -> LevelColors {
    std::array::from_fn(|level| [60 + 20 * (level % 10) as u8, 120, 230 - 15 * (level % 10) as u8, 255])
        .into()
}

/// Returns a mesh that is graded towards a point, with a round hole.
fn graded() -> Mesh {
    let contains = |p: DVec2| p.distance(dvec2(0.7, 0.3)) > 0.15;
    let lattice = Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, contains, &Limits::default()).unwrap();
    let near = |x: DVec2| x.distance(dvec2(0.4, 0.6));
    let refines = |element: &meshbrush_mesh::mesh::Element<'_>| {
        let target = element.world_corners().map(near).into_iter().fold(f64::MAX, f64::min);
        element.diameter() > (0.2 * target).max(0.004)
    };
    mesh.refine(&Limits::default(), refines).unwrap();
    mesh
}

fn heights(mesh: &Mesh, height: impl Fn(DVec2) -> Option<f64>) -> NodeHeights {
    let nodes = mesh.raw_nodes().iter().map(|&node| height(mesh.lattice().world_from_lattice(node)));
    NodeHeights::new(&nodes.collect::<Vec<_>>(), &[]).unwrap()
}

fn waves(p: DVec2) -> Option<f64> {
    Some(30.0 + 20.0 * (9.0 * p.x).sin() * (7.0 * p.y).cos())
}

fn view(mesh: &Mesh, heights: &NodeHeights, azimuth: f64, altitude: f64) -> SpaceView {
    higher_view(mesh, heights, azimuth, altitude, 1.0)
}

/// Returns the view of heights that are so many times those of a usual view.
fn higher_view(mesh: &Mesh, heights: &NodeHeights, azimuth: f64, altitude: f64, times: f64) -> SpaceView {
    let default = SpaceCamera::visible_exaggeration(mesh.lattice().bounds(), heights.relief());
    let exaggeration = times * default;
    let direction = ViewDirection { azimuth, altitude };
    let surface = (heights.scale, heights.ends());
    let camera = SpaceCamera::fit(mesh.lattice(), surface, direction, exaggeration, SIZE, 10.0);
    SpaceView { camera, light: Light::default() }
}

fn draw(mesh: &Mesh, heights: &NodeHeights, view: &SpaceView, style: &Style) -> Image {
    software::draw_surface(ShownSurface { mesh, pieces: None, heights }, view, style)
}

#[test]
fn a_plain_from_above_is_the_picture_of_the_plan() {
    let mesh = graded();
    let plain = heights(&mesh, |_| Some(5.0));
    for zoom in [1.0, 3.3, 700.0] {
        let view = view(&mesh, &plain, 0.0, 90.0);
        let camera = view.camera.zoomed(zoom, dvec2(170.0, 130.0));
        let picture = draw(&mesh, &plain, &SpaceView { camera, ..view }, &Style::dark(colors()));
        let plan = software::draw(&mesh, camera.plan(), &Style::dark(colors()), None, &[]);
        let differ = |(a, b): &(&[u8; 4], &[u8; 4])| (0..3).any(|i| a[i].abs_diff(b[i]) > 1);
        let differing = picture.pixels().iter().zip(plan.pixels()).filter(differ).count();
        assert!(differing < 30, "{differing} pixels differ at {zoom}");
    }
}

#[test]
fn each_pixel_shows_the_point_nearest_the_viewer() {
    let mesh = graded();
    let waves = heights(&mesh, waves);
    let style = Style { edges: false, ..Style::dark(colors()) };
    for (azimuth, altitude) in [(0.0, 25.0), (140.0, 12.0), (260.0, 60.0)] {
        // High hills hide much.
        let view = higher_view(&mesh, &waves, azimuth, altitude, 5.0);
        let picture = draw(&mesh, &waves, &view, &style);
        let screen = view.camera.screen_map();
        let near = |px: DVec2| {
            let triangles = mesh.raw_triangles().iter().filter(|triangle| !triangle.is_outside());
            let depths = triangles.filter_map(|triangle| {
                let corners = triangle.vertices.map(|vertex| {
                    let node = vertex.index();
                    screen(mesh.raw_nodes()[node].as_dvec2(), f64::from(waves.mesh[node]))
                });
                let [a, b, c] = corners;
                let area = (b - a).truncate().perp_dot((c - a).truncate());
                let part =
                    |p: glam::DVec3, q: glam::DVec3| (p.truncate() - px).perp_dot(q.truncate() - px) / area;
                let parts = [part(b, c), part(c, a), part(a, b)];
                let is_inside = parts.iter().all(|&part| part > 0.0);
                is_inside.then(|| (parts[0] * a.z + parts[1] * b.z + parts[2] * c.z, triangle.level()))
            });
            depths.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, level)| level)
        };
        let mut checked = 0;
        for index in (0..picture.pixels().len()).step_by(331) {
            let (column, row) = (index % SIZE[0] as usize, index / SIZE[0] as usize);
            let middle = dvec2(column as f64 + 0.5, row as f64 + 0.5);
            let level = near(middle);
            // Corners are rounded to a 256th of a pixel: what is as near to an edge may be beyond it.
            let around = [dvec2(0.01, 0.0), dvec2(-0.01, 0.0), dvec2(0.0, 0.01), dvec2(0.0, -0.01)];
            if around.iter().any(|offset| near(middle + *offset) != level) {
                continue;
            }
            let [r, g, b, _] = picture.pixels()[index];
            match level {
                None => assert_eq!([r, g, b, 255], style.ground, "{column} {row}"),
                Some(level) => {
                    let own = colors().of(level as u8);
                    let shade = f64::from(g) / f64::from(own[1]);
                    let is_own = (f64::from(r) - shade * f64::from(own[0])).abs() < 2.0;
                    assert!(is_own || r == 255 || b == 255, "{column} {row}: {r} {g} {b}, {own:?}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 30, "{checked}");
    }
}

#[test]
fn triangles_without_a_height_are_left_out() {
    let mesh = graded();
    let half = heights(&mesh, |p| if p.x < 0.5 { waves(p) } else { None });
    let view = view(&mesh, &half, 0.0, 60.0);
    let picture = draw(&mesh, &half, &view, &Style::dark(colors()));
    let ground = Style::dark(colors()).ground;
    let drawn = |columns: std::ops::Range<u32>| {
        columns
            .flat_map(|x| (0..SIZE[1]).map(move |y| (x, y)))
            .filter(|&(x, y)| picture.pixel(x, y) != ground)
            .count()
    };
    assert!(drawn(0..195) > 10_000 && drawn(205..400) == 0, "{} {}", drawn(0..195), drawn(205..400));
}

#[test]
fn level_ground_keeps_its_colours_and_slopes_towards_the_light_are_bright() {
    let mesh = graded();
    let style = Style { edges: false, ..Style::dark([[100, 100, 100, 255]; LEVELS]) };
    let green = |height: &dyn Fn(DVec2) -> f64| {
        let slope = heights(&mesh, |p| Some(height(p)));
        let view = view(&mesh, &slope, 0.0, 80.0);
        draw(&mesh, &slope, &view, &style).pixel(150, 150)[1]
    };
    assert_eq!(green(&|_| 1.0), 100);
    let (lit, dark) = (green(&|p| p.x - p.y), green(&|p| p.y - p.x));
    assert!(lit > 103 && dark < 97, "the light comes from the upper left: {lit} {dark}");
}

#[cfg(feature = "gpu")]
mod on_the_gpu {
    use super::*;
    use crate::coast;
    use crate::render_agreement::{assert_agree, gpu};

    /// Returns the share of pixels that differ by more than 8 in a channel.
    fn differing(a: &Image, b: &Image) -> f64 {
        let differ = |(p, q): &(&[u8; 4], &[u8; 4])| (0..3).any(|i| p[i].abs_diff(q[i]) > 8);
        a.pixels().iter().zip(b.pixels()).filter(differ).count() as f64 / a.pixels().len() as f64
    }

    #[test]
    fn gpu_and_software_draw_the_same_surface() {
        let Some(mut gpu) = gpu() else { return };
        let mesh = graded();
        let waves = heights(&mesh, |p| waves(p).filter(|_| p.y < 0.9));
        gpu.show(&mesh, 1).unwrap();
        for (name, style) in [("dark", Style::dark(colors())), ("light", Style::light(colors()))] {
            for (azimuth, altitude, zoom) in [
                (0.0, 90.0, 1.0),
                (20.0, 40.0, 1.0),
                (200.0, 15.0, 2.5),
                (120.0, 6.0, 1.0),
                (300.0, 6.0, 1.0),
                (75.0, 30.0, 60.0),
                (310.0, 35.0, 900.0),
            ] {
                let view = view(&mesh, &waves, azimuth, altitude);
                let camera = view.camera.centered_on(dvec2(0.4, 0.6), 5e8).zoomed(zoom, dvec2(200.0, 150.0));
                let view = SpaceView { camera, ..view };
                let shown = ShownSurface { mesh: &mesh, pieces: None, heights: &waves };
                let picture = gpu.picture_in_space(shown, 1, &view, &style).unwrap();
                let software = software::draw_surface(shown, &view, &style);
                assert_agree(&format!("space-{name}-{azimuth}-{altitude}-{zoom}"), &picture, &software);
                let share = differing(&picture, &software);
                assert!(share < 0.001, "{name}, {azimuth}°, {altitude}°: {share} of the pixels differ");
            }
        }
    }

    #[test]
    fn gpu_and_software_draw_the_same_pieces_along_a_coast() {
        let Some(mut gpu) = gpu() else { return };
        let built = coast::coast(0.06);
        let mesh = &built.mesh;
        let derived = coast::derived(mesh, &built);
        let (extract, pieces) = (derived.extract(mesh), coast::pieces(mesh, &built));
        let at = |nodes: &[meshbrush_mesh::geometry::LatticePoint]| -> Vec<Option<f64>> {
            let bounds = mesh.lattice().bounds();
            let share = |p: DVec2| (p - bounds.min) / bounds.size();
            nodes.iter().map(|&node| waves(share(mesh.lattice().world_from_lattice(node)))).collect()
        };
        let heights = NodeHeights::new(&at(mesh.raw_nodes()), &at(pieces.nodes())).unwrap();
        let in_extract = at(extract.nodes()).into_iter().map(|height| heights.scale.steps(height));
        let of_extract = NodeHeights { mesh: in_extract.collect(), ..heights.clone() };
        gpu.show(mesh, 1).unwrap();
        gpu.renderer().mirror_mut().set_pieces(Some(&pieces)).unwrap();
        let style = Style::dark(colors());
        for (azimuth, altitude) in [(20.0, 40.0), (160.0, 20.0)] {
            let view = view(mesh, &heights, azimuth, altitude);
            let shown = ShownSurface { mesh, pieces: Some(&pieces), heights: &heights };
            let picture = gpu.picture_in_space(shown, 1, &view, &style).unwrap();
            let software = software::draw_surface(shown, &view, &style);
            assert_agree(&format!("space-coast-{azimuth}"), &picture, &software);
            let file = software::draw_extract_in_space(&extract, &of_extract, &view, &style);
            assert_agree(&format!("space-coast-file-{azimuth}"), &file, &software);
        }
    }
}

/// Prints how long a picture of two million triangles takes.
#[test]
#[ignore = "measures time"]
fn time_of_two_million_triangles() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| element.triangle.level() < 16).unwrap();
    let waves = heights(&mesh, waves);
    let mut view = view(&mesh, &waves, 20.0, 40.0);
    let surface = (waves.scale, waves.ends());
    let direction = view.camera.direction();
    view.camera =
        SpaceCamera::fit(&lattice, surface, direction, view.camera.exaggeration(), [1600, 1000], 20.0);
    let shown = ShownSurface { mesh: &mesh, pieces: None, heights: &waves };
    let time = |name: &str, draw: &mut dyn FnMut(f64)| {
        draw(0.0);
        let began = std::time::Instant::now();
        (1..=3).for_each(|n| draw(f64::from(n)));
        eprintln!(
            "{} triangles {name}: {:.1} ms",
            mesh.triangle_count(),
            began.elapsed().as_secs_f64() * 1e3 / 3.0
        );
    };
    let style = Style::dark(colors());
    let turned = |n: f64| SpaceView { camera: view.camera.turned(n, 0.0), ..view };
    time("in software", &mut |n| _ = software::draw_surface(shown, &turned(n), &style));
    #[cfg(feature = "gpu")]
    if let Some(mut gpu) = crate::render_agreement::gpu() {
        gpu.show(&mesh, 1).unwrap();
        let name = format!("on {}", gpu.adapter());
        time(&name, &mut |n| _ = gpu.picture_in_space(shown, 1, &turned(n), &style).unwrap());
    }
}
