//! A picture in which triangles smaller than a pixel are merged looks like the picture of all triangles.
//!
//! Two pictures are compared as a person sees them from where single pixels can just be told apart: blurred
//! by two pixels in linear light, and by the difference of colours in CIELAB, where 2.3 can just be noticed.
//! With MESHBRUSH_PICTURES set to a folder the tests leave what they drew there.

use crate::coast;
use crate::kept_picture::keep;
use glam::{DVec2, Vec3, dvec2, vec3};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};
use meshbrush_render::colormap::{Colormap, Ground, LevelColors};
use meshbrush_render::render::{Image, software};
use meshbrush_render::scene::{Camera, ShownMesh, Style};

const SIZE: [u32; 2] = [240, 180];
/// Standard deviation of the blur in pixels.
const BLUR_PX: f32 = 2.0;
/// A difference of colours that can just be noticed.
const LEAST_NOTICED: f32 = 2.3;
/// The length of legs up to which the window merges triangles.
const MERGE_BELOW_PX: f32 = 1.0;

fn grid(spacing: f64) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, spacing, 1_000_000).unwrap();
    Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap()
}

/// Returns a mesh that is graded towards a curve.
pub fn graded(finest: f64) -> Mesh {
    let mut mesh = grid(0.05);
    mesh.refine(&Limits::default(), |element| {
        let off = |x: DVec2| (x.y - 0.5 - 0.3 * (6.0 * x.x).sin()).abs();
        let nearest = element.world_corners().map(off).into_iter().fold(f64::MAX, f64::min);
        element.diameter() > (0.08 * nearest).max(finest)
    })
    .unwrap();
    mesh
}

/// Returns a mesh in which triangles of very different levels alternate everywhere.
fn noisy() -> Mesh {
    let mut mesh = grid(0.05);
    mesh.refine(&Limits::default(), |element| {
        let [x, y] = element.corners.iter().fold([0_u32; 2], |[x, y], p| [x ^ p.x >> 16, y ^ p.y >> 16]);
        let hash = (x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77)).wrapping_mul(0x2c1b_3c6d);
        element.triangle.level() < 5 + hash % 7
    })
    .unwrap();
    mesh
}

/// Returns the styles of windows: on dark and on light ground, without edges, with hidden levels, and over a
/// background picture.
pub fn styles() -> [(&'static str, Style); 5] {
    let colors = |ground| LevelColors::new(Colormap::Viridis, ground, 14);
    let dark = Style::dark(colors(Ground::Dark));
    [
        ("light", Style::light(colors(Ground::Light))),
        ("plain", Style { edges: false, ..dark.clone() }),
        ("hidden", Style { shown_levels: 0x5555_5555, ..dark.clone() }),
        ("translucent", Style { fill_opacity: 0.6, ..dark.clone() }),
        ("dark", dark),
    ]
}

fn merged(style: &Style) -> Style {
    Style { merge_below_px: MERGE_BELOW_PX, ..style.clone() }
}

/// Returns the picture as an eye sees it, in CIELAB.
fn seen(image: &Image) -> Vec<Vec3> {
    let linear = |c: u8| (f32::from(c) / 255.0).powf(2.2);
    let pixels = image.pixels().iter().map(|&[r, g, b, _]| vec3(linear(r), linear(g), linear(b)));
    let [width, height] = image.size.map(|n| n as usize);
    let reach = (3.0 * BLUR_PX) as isize;
    let weights: Vec<f32> = (-reach..=reach).map(|d| (-0.5 * (d as f32 / BLUR_PX).powi(2)).exp()).collect();
    let sum: f32 = weights.iter().sum();
    let blurred = |pixels: &[Vec3], place: &dyn Fn(usize, isize) -> usize| -> Vec<Vec3> {
        let at = |i: usize| {
            let near = weights.iter().zip(-reach..);
            near.map(|(&weight, d)| weight * pixels[place(i, d)]).sum::<Vec3>() / sum
        };
        (0..pixels.len()).map(at).collect()
    };
    let clamped = |at: usize, d: isize, count: usize| (at as isize + d).clamp(0, count as isize - 1) as usize;
    let along_x = |i: usize, d: isize| i / width * width + clamped(i % width, d, width);
    let along_y = |i: usize, d: isize| clamped(i / width, d, height) * width + i % width;
    let rows = blurred(&pixels.collect::<Vec<_>>(), &along_x);
    blurred(&rows, &along_y).into_iter().map(lab).collect()
}

/// Returns a colour in linear light as L*, a* and b*.
fn lab(rgb: Vec3) -> Vec3 {
    let xyz = [
        vec3(0.4124, 0.3576, 0.1805).dot(rgb) / 0.9505,
        vec3(0.2126, 0.7152, 0.0722).dot(rgb),
        vec3(0.0193, 0.1192, 0.9505).dot(rgb) / 1.089,
    ];
    let [x, y, z] = xyz.map(|t| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
    vec3(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// Returns the mean difference of the colours of two pictures, and that which 99.9 % of the pixels are below.
fn difference(a: &Image, b: &Image) -> [f32; 2] {
    let mut differences: Vec<f32> = seen(a).iter().zip(seen(b)).map(|(a, b)| a.distance(b)).collect();
    differences.sort_by(f32::total_cmp);
    let count = differences.len();
    [differences.iter().sum::<f32>() / count as f32, differences[count * 999 / 1000]]
}

/// Compares the picture of merged triangles with that of all triangles. The difference must not be noticed.
/// Where neighbouring pixels take their colours from triangles that have nothing in common, as along a rough
/// coast or in noise, neither picture is the right one: there they may differ as much as a picture does from
/// itself, moved by half a pixel.
fn compare<'a>(name: &str, shown: impl Into<ShownMesh<'a>>, camera: &Camera, style: &Style) {
    let shown = shown.into();
    let all = software::draw(shown, camera, style, None, &[]);
    let fewer = software::draw(shown, camera, &merged(style), None, &[]);
    keep(&all, &format!("detail-{name}-all"));
    keep(&fewer, &format!("detail-{name}-merged"));
    let moved = software::draw(shown, &camera.panned(dvec2(0.5, 0.0)), style, None, &[]);
    let ([mean, most], [moved_mean, moved_most]) = (difference(&all, &fewer), difference(&all, &moved));
    eprintln!(
        "{name}: mean {mean:.3} ({moved_mean:.3} if moved), 99.9 % {most:.2} ({moved_most:.2} if moved)"
    );
    assert!(mean < moved_mean.max(LEAST_NOTICED / 4.0), "{name}: {mean}, and {moved_mean} if moved");
    assert!(most < moved_most.max(LEAST_NOTICED), "{name}: {most}, and {moved_most} if moved");
}

fn whole(mesh: &Mesh, zoom: f64) -> Camera {
    let camera = Camera::fit(mesh.lattice(), mesh.lattice().bounds(), SIZE, 10.0);
    camera.zoomed(zoom, dvec2(123.0, 88.0))
}

#[test]
fn merged_triangles_cannot_be_told_from_all_triangles() {
    let zooms = [0.3, 0.55, 1.0, 1.3, 2.2];
    let (graded, noisy) = (graded(0.0014), noisy());
    for ((style_name, style), zoom) in styles().into_iter().zip(zooms) {
        for (name, mesh) in [("graded", &graded), ("noisy", &noisy)] {
            compare(&format!("{name}-{style_name}-{zoom}"), mesh, &whole(mesh, zoom), &style);
        }
    }
}

#[test]
fn coasts_of_merged_triangles_stay_in_place() {
    let built = coast::coast(0.012);
    let pieces = coast::pieces(&built.mesh, &built);
    let shown = ShownMesh { mesh: &built.mesh, pieces: Some(&pieces) };
    for ((style_name, style), zoom) in styles().into_iter().zip([0.3, 0.45, 0.6, 0.8, 1.0]) {
        compare(&format!("coast-{style_name}-{zoom}"), shown, &whole(&built.mesh, zoom), &style);
    }
}

#[test]
fn triangles_that_can_be_seen_are_not_merged() {
    let mesh = graded(0.0012);
    let style = Style::dark(LevelColors::new(Colormap::Viridis, Ground::Dark, 14));
    let camera = whole(&mesh, 8.0);
    let all = software::draw(&mesh, &camera, &style, None, &[]);
    assert!(all == software::draw(&mesh, &camera, &merged(&style), None, &[]));
}
