//! The uniform data of the shaders.

use bytemuck::{Pod, Zeroable};
use glam::{IVec2, IVec3, Vec2, Vec3, Vec4};

use crate::colormap::LEVELS;
use crate::render::{HUGE_PX, SEAM_SLACK_PX};
use crate::scene::{Camera, Detail, LevelPaint, Light, Overlay, SpacePaint, SpaceView, Style};

/// `Level` of mesh.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Level {
    fill: [f32; 3],
    apex_height_px: f32,
    edge: [f32; 3],
    edge_alpha: f32,
    base_height_px: f32,
    huge: u32,
    unused: [u32; 2],
}

impl From<LevelPaint> for Level {
    fn from(paint: LevelPaint) -> Self {
        Self {
            fill: paint.fill,
            apex_height_px: paint.apex_height_px,
            edge: paint.edge,
            edge_alpha: paint.edge_alpha,
            base_height_px: paint.base_height_px,
            huge: u32::from(paint.leg_px >= HUGE_PX),
            unused: [0; 2],
        }
    }
}

/// `View` of mesh.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct MeshView {
    anchor: IVec2,
    fraction: Vec2,
    px_per_step: Vec2,
    half_size_px: Vec2,
    edge_reach_px: f32,
    seam_slack_px: f32,
    unused: u32,
    rim_px: f32,
    huge_px: f32,
    fill_opacity: f32,
    /// The detail level, if triangles are merged.
    detail_level: u32,
    halvings: u32,
    levels: [Level; LEVELS],
}

impl MeshView {
    pub(super) fn new(camera: &Camera, style: &Style, detail: Option<Detail>) -> Self {
        let (anchor, fraction) = camera.anchor();
        Self {
            anchor,
            fraction: fraction.as_vec2(),
            px_per_step: camera.px_per_step().as_vec2(),
            half_size_px: camera.half_size_px().as_vec2(),
            edge_reach_px: style.edge_reach_px(),
            seam_slack_px: SEAM_SLACK_PX,
            unused: 0,
            rim_px: style.rim_px(),
            huge_px: HUGE_PX,
            fill_opacity: style.fill_opacity,
            detail_level: detail.map_or(0, |detail| detail.level()),
            halvings: camera.lattice().halvings(),
            levels: LevelPaint::all(camera, style).map(Level::from),
        }
    }
}

/// `View` of overlay.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct OverlayView {
    texel: IVec2,
    fraction: Vec2,
    texels_per_px: Vec2,
    half_size_px: Vec2,
    beyond: Vec4,
}

impl OverlayView {
    pub(super) fn new(camera: &Camera, overlay: &Overlay) -> Self {
        let map = overlay.texels(camera);
        let whole = map.at_center.floor();
        Self {
            texel: whole.as_ivec2(),
            fraction: (map.at_center - whole).as_vec2(),
            texels_per_px: map.per_px.as_vec2(),
            half_size_px: camera.half_size_px().as_vec2(),
            beyond: Vec4::from(overlay.beyond.map(f32::from)) / 255.0,
        }
    }
}

/// `Level` of space.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SpaceLevel {
    fill: [f32; 3],
    edge_alpha: f32,
    edge: [f32; 3],
    unused: u32,
}

/// `View` of space.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct SpaceUniform {
    right: Vec3,
    edge_reach_px: f32,
    up: Vec3,
    rim_px: f32,
    towards: Vec3,
    seam_slack_px: f32,
    anchor: IVec3,
    huge_px: f32,
    fraction: Vec3,
    fade_from_px: f32,
    shape: Vec3,
    fade_to_px: f32,
    light: Vec3,
    ambient: f32,
    to_viewer: Vec3,
    strength: f32,
    half_size_px: Vec2,
    nearest_px: f32,
    per_px: f32,
    levels: [SpaceLevel; LEVELS],
}

impl SpaceUniform {
    pub(super) fn new(view: &SpaceView, style: &Style) -> Self {
        let camera = &view.camera;
        let (anchor, fraction) = camera.anchor();
        let [right, up, towards] = camera.rows().map(|row| row.as_vec3());
        let [nearest, farthest] = camera.depth_range();
        let [fade_from_px, fade_to_px] = style.edge_fade_px;
        let level = |SpacePaint { fill, edge, edge_alpha }| SpaceLevel { fill, edge_alpha, edge, unused: 0 };
        Self {
            right,
            edge_reach_px: style.edge_reach_px(),
            up,
            rim_px: style.rim_px(),
            towards,
            seam_slack_px: SEAM_SLACK_PX,
            anchor,
            huge_px: HUGE_PX,
            fraction: fraction.as_vec3(),
            fade_from_px,
            shape: camera.shape().as_vec3(),
            fade_to_px,
            light: view.light.direction().as_vec3(),
            ambient: Light::AMBIENT,
            to_viewer: camera.to_viewer().as_vec3(),
            strength: view.light.strength(),
            half_size_px: camera.plan().half_size_px().as_vec2(),
            nearest_px: nearest as f32,
            per_px: (1.0 / (nearest - farthest).max(1.0)) as f32,
            levels: SpacePaint::all(style).map(level),
        }
    }
}
