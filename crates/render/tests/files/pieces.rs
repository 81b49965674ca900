//! Pictures of a mesh with pieces in place of some of its triangles, drawn in software.

use std::collections::HashMap;

use crate::coast;
use crate::kept_picture::keep;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Extract, Mesh, MeshPatch, PatchPieces, TriangleId};
use meshbrush_render::render::software;
use meshbrush_render::scene::{Camera, ShownMesh, Style};

const SIZE: [u32; 2] = [240, 180];
/// Distance in pixels up to which a pixel beside an edge can be coloured by either triangle: corners are
/// rounded to 1/256 px, and huge triangles overlap their neighbours by 1/64 px.
const TOLERANCE_PX: f64 = 0.05;

fn style(edges: bool) -> Style {
    let colors: [[u8; 4]; 64] = std::array::from_fn(|level| [40 + 3 * level as u8, 90, 120, 255]);
    Style { edges, ..Style::dark(colors) }
}

fn whole(mesh: &Mesh, size: [u32; 2]) -> Camera {
    Camera::fit(mesh.lattice(), mesh.lattice().bounds(), size, 5.0)
}

/// Returns the ends of an edge on the boundary that runs along no axis and no diagonal.
fn skewed_boundary_edge(pieces: &PatchPieces) -> [LatticePoint; 2] {
    let is_skewed = |[a, b]: &[LatticePoint; 2]| {
        let (dx, dy) = (a.x.abs_diff(b.x), a.y.abs_diff(b.y));
        dx.min(dy) > dx.max(dy) / 5 && dx.min(dy) < dx.max(dy) / 2
    };
    let edges =
        pieces.triangles().iter().flat_map(|piece| piece.edge_nodes().into_iter().zip(piece.raw_neighbours));
    let on_boundary = edges.filter(|(_, across)| across.triangle().is_none());
    let mut ends = on_boundary.map(|((from, to), _)| [from, to].map(|node| pieces.nodes()[node.index()]));
    ends.find(is_skewed).unwrap()
}

/// Returns cameras on the whole mesh, and ever closer to a corner and to an edge of a piece.
fn cameras(mesh: &Mesh, pieces: &PatchPieces) -> Vec<Camera> {
    let [a, b] = skewed_boundary_edge(pieces).map(|p| mesh.lattice().world_from_lattice(p));
    let base = whole(mesh, SIZE);
    let mut cameras: Vec<Camera> =
        [1.0, 3.3, 40.0].map(|zoom| base.zoomed(zoom, DVec2::ZERO).centered_on(a)).into();
    for zoom in [1e3, 1e4, 1e5, 1e7, 1e300] {
        let close = base.zoomed(zoom, DVec2::ZERO);
        cameras.extend([close.centered_on(a), close.centered_on(a.lerp(b, 0.37)).panned(dvec2(31.3, 17.8))]);
    }
    cameras
}

/// Returns a position in units of 2⁻²⁰ lattice steps.
fn fine(p: DVec2) -> [i128; 2] {
    let scaled = p * f64::from(1 << 20);
    [scaled.x.round() as i128, scaled.y.round() as i128]
}

/// Returns distance of a pixel from the nearest edge of an anticlockwise triangle; negative outside.
fn inside_px(corners: [LatticePoint; 3], p: [i128; 2], camera: &Camera) -> f64 {
    let corners = corners.map(|c| [i128::from(c.x) << 20, i128::from(c.y) << 20]);
    let scale = camera.px_per_step();
    let distance = |i: usize| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 3]);
        let cross = (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax);
        let length = dvec2((bx - ax) as f64 * scale.x, (by - ay) as f64 * scale.y).length();
        cross as f64 * scale.x * scale.y / length / f64::from(1 << 20)
    };
    distance(0).min(distance(1)).min(distance(2))
}

/// A triangle of the extract, with a rectangle in pixels that is a little larger.
struct Cell {
    corners: [LatticePoint; 3],
    level: u8,
    min: DVec2,
    max: DVec2,
}

impl Cell {
    fn new(extract: &Extract, cell: meshbrush_mesh::mesh::Cell, camera: &Camera) -> Self {
        let corners = cell.corners.map(|n| extract.nodes()[n]);
        let [a, b, c] = corners.map(|corner| camera.screen_from_lattice(corner));
        let (min, max) = (a.min(b).min(c) - 1.0, a.max(b).max(c) + 1.0);
        Self { corners, level: cell.level as u8, min, max }
    }
}

#[test]
fn exactly_the_pixels_of_the_domain_are_filled_with_the_colors_of_their_triangles() {
    let built = coast::coast(0.1);
    let (mesh, derived) = (&built.mesh, coast::derived(&built.mesh, &built));
    let extract: Extract = derived.extract(mesh);
    let pieces = PatchPieces::new(mesh, derived.patch(), &extract);
    assert!(pieces.replacements().any(|(_, pieces)| pieces.is_empty()), "no small part was removed");
    let style = style(false);
    for camera in cameras(mesh, &pieces) {
        let (mut inside, mut outside) = (0, 0);
        let shown = ShownMesh { mesh, pieces: Some(&pieces) };
        let image = software::draw(shown, &camera, &style, None, &[]);
        let cells: Vec<Cell> = extract.cells().map(|cell| Cell::new(&extract, cell, &camera)).collect();
        for (i, &pixel) in image.pixels().iter().enumerate() {
            let px = dvec2(f64::from(i as u32 % SIZE[0]) + 0.5, f64::from(i as u32 / SIZE[0]) + 0.5);
            let p = fine(camera.lattice_from_screen(px));
            let (mut color, mut nearest) = (style.ground, f64::MIN);
            for cell in cells.iter().filter(|cell| cell.min.cmplt(px).all() && cell.max.cmpgt(px).all()) {
                let distance = inside_px(cell.corners, p, &camera);
                nearest = nearest.max(distance);
                if distance > 0.0 {
                    color = style.level_colors.of(cell.level);
                }
            }
            if nearest.abs() > TOLERANCE_PX {
                assert_eq!(pixel, color, "{px} at {} px per step", camera.px_per_step());
                *(if nearest > 0.0 { &mut inside } else { &mut outside }) += 1;
            }
        }
        assert!(inside.min(outside) > 5000, "{inside} pixels inside, {outside} outside");
    }
}

#[test]
fn a_mesh_with_pieces_looks_like_its_extract() {
    let built = coast::coast(0.06);
    let (mesh, derived) = (&built.mesh, coast::derived(&built.mesh, &built));
    let extract = derived.extract(mesh);
    let pieces = coast::pieces(mesh, &built);
    let style = style(true);
    for (i, camera) in cameras(mesh, &pieces).into_iter().enumerate() {
        let shown = ShownMesh { mesh, pieces: Some(&pieces) };
        let image = software::draw(shown, &camera, &style, None, &[]);
        let expected = software::draw_extract(&extract, &camera, &style);
        keep(&image, &format!("pieces-{i}"));
        keep(&expected, &format!("pieces-extract-{i}"));
        // Triangles come in another order, so that this would also find any that overlap.
        let differing = image.pixels().iter().zip(expected.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "camera {i}");
    }
    let camera = whole(mesh, [1000, 1000]);
    keep(
        &software::draw(ShownMesh { mesh, pieces: Some(&pieces) }, &camera, &style, None, &[]),
        "pieces-coast",
    );
    keep(&software::draw(mesh, &camera, &style, None, &[]), "pieces-mesh");
}

#[test]
fn the_boundary_of_a_fitted_domain_is_drawn_in_full_width() {
    let built = coast::coast(0.1);
    let style = style(true);
    let camera = whole(&built.mesh, [600, 600]);
    let image = software::draw(&built.mesh, &camera, &style, None, &[]);
    let expected = software::draw_extract(&built.mesh.extract(), &camera, &style);
    assert!(image == expected);
}

#[test]
fn the_edges_of_a_removed_triangle_are_boundary_edges() {
    let built = coast::coast(0.1);
    let mesh = &built.mesh;
    let inside = |id: &TriangleId| mesh.neighbours(*id).iter().all(|n| n.triangle().is_some());
    let removed = mesh.triangles().map(|(id, _)| id).filter(inside).nth(5).unwrap();
    let patch = MeshPatch { changed: vec![(removed, 0..0)], ..MeshPatch::default() };
    let extract = mesh.extract_with(&patch);
    let pieces = PatchPieces::new(mesh, &patch, &extract);
    let style = style(true);
    let camera = whole(mesh, [600, 600]);
    let image = software::draw(ShownMesh { mesh, pieces: Some(&pieces) }, &camera, &style, None, &[]);
    assert!(image == software::draw_extract(&extract, &camera, &style));
    assert!(image != software::draw(mesh, &camera, &style, None, &[]));
}

#[test]
fn an_extract_is_the_same_for_any_number_of_threads_and_its_neighbours_share_edges() {
    let built = coast::coast(0.002);
    let (mesh, derived) = (&built.mesh, coast::derived(&built.mesh, &built));
    let extract = on_threads(1, || derived.extract(mesh));
    assert!(extract.triangles().len() > 30_000, "{} triangles: all of one thread", extract.triangles().len());
    assert!(derived.patch().changed.len() > 1000);
    for threads in [2, 3, 8] {
        let other = on_threads(threads, || derived.extract(mesh));
        assert!(extract.triangles() == other.triangles() && extract.nodes() == other.nodes());
    }

    let mut across = HashMap::new();
    let edges = |[a, b, c]: [usize; 3]| [[b, c], [c, a], [a, b]];
    for (index, cell) in extract.cells().enumerate() {
        for edge in edges(cell.corners) {
            assert_eq!(across.insert(edge, index), None, "two triangles left of {edge:?}");
        }
    }
    for cell in extract.cells() {
        let expected = edges(cell.corners).map(|[from, to]| across.get(&[to, from]).copied());
        assert_eq!(cell.opposite, expected);
    }
    let mut used = vec![false; extract.nodes().len()];
    extract.cells().flat_map(|cell| cell.corners).for_each(|node| used[node] = true);
    assert!(used.iter().all(|&used| used), "nodes of no triangle");
    let moved: HashMap<_, _> = derived.patch().moved.iter().copied().collect();
    for index in 0..mesh.raw_triangle_count() {
        let id = TriangleId::from_index(index);
        if let Some(place) = extract.place_of(id) {
            let corners = extract.cell(place).corners.map(|node| extract.nodes()[node]);
            let nodes = mesh.triangle(id).edge_nodes().map(|(from, _)| from);
            assert_eq!(corners, nodes.map(|node| *moved.get(&node).unwrap_or(&mesh.node(node))));
        }
    }
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}
