//! Draws the triangles that one camera sees, on all cores.

use std::ops::Range;

use glam::{DVec2, I64Vec2, Vec2Swizzles};
use rayon::prelude::*;

use super::corners::Corners;
use super::damage::{BAND_ROWS, Damage};
use super::groups::TriangleGroups;
use super::rasterizer::{self, LevelShader, Rasterizer, snapped};
use crate::colormap::LEVELS;
use crate::render::Image;
use crate::render::draw_flags::DrawFlags;
use crate::scene::{Camera, Detail, InnerPoint, LevelPaint, Style};
use meshbrush_mesh::geometry::{LatticePoint, LatticeRect};
use meshbrush_mesh::mesh::{Orientation, Triangle};

/// Triangles and their nodes. If the neighbour of a triangle is one of `triangles`, they share an edge.
pub(super) struct TriangleArrays<'a> {
    pub(super) nodes: &'a [LatticePoint],
    /// Positions of the nodes on the screen.
    pub(super) corners: &'a Corners,
    pub(super) triangles: &'a [Triangle],
    /// Positions of the triangles, in groups.
    pub(super) groups: &'a TriangleGroups,
    /// Flags of the triangles that others replace.
    pub(super) flags: &'a DrawFlags,
    /// Whether all triangles are those of a mesh, which merge with others. Pieces do not.
    pub(super) are_of_mesh: bool,
}

impl TriangleArrays<'_> {
    /// Returns, for each vertex, whether the opposite edge is on the boundary, so that no neighbour draws its
    /// half of the line.
    fn boundary_opposite(&self, triangle: &Triangle) -> [bool; 3] {
        Self::boundary_in(self.triangles, self.flags, triangle)
    }

    /// Does the work of [`Self::boundary_opposite`] for any array of triangles with their flags.
    pub(super) fn boundary_in(triangles: &[Triangle], flags: &DrawFlags, triangle: &Triangle) -> [bool; 3] {
        let mut boundary = [false; 3];
        for ((from, to), across) in triangle.edges().into_iter().zip(triangle.raw_neighbours) {
            boundary[3 - from - to] =
                across.triangle().is_none_or(|id| vacant_in(triangles, flags, id.index()));
        }
        boundary
    }

    fn is_vacant(&self, index: usize) -> bool {
        vacant_in(self.triangles, self.flags, index)
    }

    /// Returns, for each band, the groups of triangles that can be seen in its damaged part, in their order.
    fn groups_in_bands(&self, camera: &Camera, damage: &Damage, reach_px: i32) -> Vec<Vec<Range<usize>>> {
        let mut bands = vec![Vec::new(); damage.bands().len()];
        for (group, rect) in self.groups.iter() {
            let [columns, rows] = pixels_around(camera, &rect, reach_px);
            for band in damage.bands_meeting(&columns, &rows) {
                bands[band].push(group.start..group.end.min(self.triangles.len()));
            }
        }
        bands
    }
}

/// Returns whether nothing is drawn in the place of a triangle.
fn vacant_in(triangles: &[Triangle], flags: &DrawFlags, index: usize) -> bool {
    flags.is_vacant(index) || flags.is_drawn(index) && triangles[index].is_outside()
}

/// Returns columns and rows of the pixels that triangles within `rect` can colour, if those that they are
/// merged into reach so far beyond them.
fn pixels_around(camera: &Camera, rect: &LatticeRect, reach_px: i32) -> [Range<i32>; 2] {
    let corners = [rect.min, rect.max].map(|p| snapped(camera.screen_from_lattice(p)));
    rasterizer::pixels_around(&corners, reach_px)
}

/// Draws triangles for one camera in one style.
pub(super) struct Painter {
    camera: Camera,
    ground: [u8; 4],
    shaders: [LevelShader; LEVELS],
    detail: Option<Detail>,
    /// How far merged triangles reach beyond those that they are merged from, in pixels.
    reach_px: i32,
}

impl Painter {
    /// Creates a painter of meshes on the lattice of the camera.
    pub(super) fn new(camera: Camera, style: &Style) -> Self {
        let shaders = LevelPaint::all(&camera, style).map(|paint| LevelShader::new(&paint, style));
        let (detail, reach_px) = (Detail::of(&camera, style), Detail::reach_px(style));
        Self { camera, ground: ground(style), shaders, detail, reach_px }
    }

    /// Draws the damaged part of a picture again: the ground, and then the arrays one above the other.
    ///
    /// A pixel takes its colour from the last triangle that covers it. Each band draws its triangles in the
    /// order of the arrays, so the picture depends neither on the threads nor on the part that is drawn
    /// again.
    pub(super) fn draw(&self, image: &mut Image, damage: &Damage, arrays: &[TriangleArrays]) {
        let groups: Vec<_> =
            arrays.iter().map(|each| each.groups_in_bands(&self.camera, damage, self.reach_px)).collect();
        let width = image.size[0];
        let bands = image.pixels_mut().par_chunks_mut(width as usize * BAND_ROWS).with_max_len(1);
        bands.zip(damage.bands()).enumerate().for_each(|(band, (pixels, columns))| {
            if columns.is_empty() {
                return;
            }
            let mut rasterizer = Rasterizer::new(pixels, width, columns.clone(), band * BAND_ROWS);
            rasterizer.fill(self.ground);
            for (arrays, groups) in arrays.iter().zip(&groups) {
                groups[band].iter().for_each(|group| self.draw_group(&mut rasterizer, arrays, group.clone()));
            }
        });
    }

    fn draw_group(&self, rasterizer: &mut Rasterizer, arrays: &TriangleArrays, group: Range<usize>) {
        let detail = self.detail.filter(|_| arrays.are_of_mesh);
        for index in group {
            let triangle = &arrays.triangles[index];
            if let Some(detail) = detail.filter(|detail| triangle.level() > detail.level()) {
                self.draw_merged(rasterizer, arrays, index, detail);
                continue;
            }
            if triangle.is_outside() || !arrays.flags.is_drawn(index) {
                continue;
            }
            let shader = &self.shaders[triangle.level() as usize];
            let at_boundary = || arrays.boundary_opposite(triangle);
            let corners = triangle.vertices.map(|v| arrays.corners.of_node(v.index()));
            if rasterizer::is_huge(corners) {
                let half_planes = half_planes(triangle, arrays.nodes, &self.camera);
                rasterizer.fill_half_planes(&half_planes, at_boundary, shader);
            } else {
                rasterizer.fill_snapped(corners, at_boundary, shader);
            }
        }
    }
}

impl Painter {
    /// Draws the ancestor that a triangle represents, if any. Where pieces are in its place, they are drawn
    /// over the ancestor.
    #[inline]
    fn draw_merged(
        &self,
        rasterizer: &mut Rasterizer,
        arrays: &TriangleArrays,
        index: usize,
        detail: Detail,
    ) {
        let triangle = &arrays.triangles[index];
        let inner = InnerPoint::of(triangle, arrays.nodes);
        if let Some(corners) = detail.merged(triangle.level(), inner)
            && !arrays.is_vacant(index)
        {
            let corners = corners.map(|p| snapped(self.camera.screen_from_lattice(p)));
            let shader = &self.shaders[triangle.level() as usize];
            rasterizer.fill_snapped(corners, || [false; 3], shader);
        }
    }
}

/// Returns the colour of the ground.
pub(super) fn ground(style: &Style) -> [u8; 4] {
    style.clear_color().map(|c| (255.0 * c).round() as u8)
}

/// One side of a line. The signed distance of the pixel position p from the line is `normal · p + offset` in
/// pixels, with |normal| = 1; it is positive inside.
pub(super) struct HalfPlane {
    pub(super) normal: DVec2,
    pub(super) offset: f64,
}

impl HalfPlane {
    #[inline]
    pub(super) fn distance_px(&self, px: DVec2) -> f64 {
        self.normal.dot(px) + self.offset
    }

    /// Returns the half-plane to the left of the line from one node to another.
    ///
    /// The part of the cross product that consists of lattice coordinates is calculated in integers. They
    /// have 30 bits, so the sum of two products has 61. The remainder comes from the camera's position within
    /// a lattice step and is at most the length of the edge, so its rounding errors are below 2⁻⁵⁰ steps.
    fn left_of(from: LatticePoint, to: LatticePoint, camera: &Camera) -> Self {
        let steps = |p: LatticePoint| I64Vec2::new(i64::from(p.x), i64::from(p.y));
        let (anchor, fraction) = camera.anchor();
        let along = steps(to) - steps(from);
        let to_anchor = anchor.as_i64vec2() - steps(from);
        let whole = along.perp_dot(to_anchor);
        let cross = whole as f64 + along.as_dvec2().perp_dot(fraction);
        let scale = camera.px_per_step();
        let along_px = along.as_dvec2() * scale;
        let length_px = along_px.length();
        // The y axis points up on the lattice and down on the screen.
        let normal = -along_px.yx() / length_px;
        let at_middle = cross * scale.element_product() / length_px;
        Self { normal, offset: at_middle - normal.dot(camera.half_size_px()) }
    }
}

/// Returns the half-planes whose intersection is a triangle, each with the edge opposite the vertex of the
/// same number.
fn half_planes(triangle: &Triangle, nodes: &[LatticePoint], camera: &Camera) -> [HalfPlane; 3] {
    let corners = triangle.vertices.map(|v| nodes[v.index()]);
    std::array::from_fn(|i| {
        let [from, to] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        match triangle.orientation() {
            Orientation::Anticlockwise => HalfPlane::left_of(from, to, camera),
            Orientation::Clockwise => HalfPlane::left_of(to, from, camera),
        }
    })
}
