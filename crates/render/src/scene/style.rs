use super::Camera;
use crate::colormap::{Ground, LEVELS, LevelColors};

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 0xff]
}

/// The appearance of a mesh. Colours are sRGB bytes from 0 to 255.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Fill by level.
    pub level_colors: LevelColors,
    /// The colour of the canvas, seen where there is no mesh, premultiplied by its opacity.
    pub ground: [u8; 4],
    /// Opacity of the fill, 0 to 1; edges are always opaque. If it is less than 1, the ground is transparent,
    /// and colours are premultiplied by their opacity: another picture can be drawn below.
    pub fill_opacity: f32,
    /// Whether edges are drawn.
    pub edges: bool,
    /// Width of an edge in pixels.
    pub edge_width_px: f32,
    /// Lengths of legs in pixels: up to the first, edges are invisible; from the second on, they are drawn in
    /// full.
    pub edge_fade_px: [f32; 2],
    /// Brightness of an edge relative to its fill: 0 is black, 1 the colour of the fill.
    pub edge_shade: f32,
    /// Levels shown in full, as bits from level 0. The others fade towards the ground.
    pub shown_levels: u64,
    /// Length of legs in pixels up to which triangles are merged into larger ones (see
    /// [`Detail`](super::Detail)); 0 where each triangle is drawn.
    pub merge_below_px: f32,
}

/// Meshes with fewer triangles are drawn triangle by triangle: any GPU draws them in time.
const MERGED_FROM: usize = 2_500_000;
/// [`Style::merge_below_px`] of large meshes.
const MERGE_BELOW_PX: f32 = 1.0;

/// The share of its own colour that a faded level keeps.
const FADED_FILL: f32 = 0.12;
/// Mean brightness, 0 to 1, below which the edges of a fill are lighter than it.
const ALMOST_BLACK: f32 = 0.2;
/// Share of white in such edges, 0 to 1.
const LIGHTER_EDGE: f32 = 0.13;
/// The share of the opacity of its edges that a faded level keeps.
pub(super) const FADED_EDGE: f32 = 0.5;

impl Style {
    /// Returns the appearance on a dark ground.
    pub fn dark(level_colors: impl Into<LevelColors>) -> Self {
        Self {
            level_colors: level_colors.into(),
            ground: opaque(Ground::Dark.canvas()),
            fill_opacity: 1.0,
            edges: true,
            edge_width_px: 1.0,
            edge_fade_px: [3.0, 8.0],
            edge_shade: 0.5,
            shown_levels: u64::MAX,
            merge_below_px: 0.0,
        }
    }

    /// Returns the appearance on a light ground.
    pub fn light(level_colors: impl Into<LevelColors>) -> Self {
        Self { ground: opaque(Ground::Light.canvas()), edge_shade: 0.72, ..Self::dark(level_colors) }
    }

    /// Returns this appearance below an overlay: white triangles, which take the colours of the overlay. The
    /// ground keeps its colour where the overlay has the given one.
    pub fn under(self, neutral: [u8; 4]) -> Self {
        let quotient = |i: usize| {
            let share = f32::from(self.ground[i]) / f32::from(neutral[i].max(1));
            (255.0 * share).round().min(255.0) as u8
        };
        let ground = opaque(std::array::from_fn(quotient));
        Self { level_colors: [[0xff; 4]; LEVELS].into(), ground, ..self }
    }

    /// Returns this appearance for a screen with `px_per_point` pixels per point: edges keep their apparent
    /// width.
    pub fn at_density(mut self, px_per_point: f32) -> Self {
        self.edge_width_px *= px_per_point;
        self.edge_fade_px = self.edge_fade_px.map(|px| px * px_per_point);
        self.merge_below_px *= px_per_point;
        self
    }

    /// Returns the appearance of a mesh of `count` triangles on a screen: in a large one, triangles smaller
    /// than a pixel are merged. To be called before [`Self::at_density`].
    pub fn for_triangles(self, count: usize) -> Self {
        Self { merge_below_px: if Self::merges(count) { MERGE_BELOW_PX } else { 0.0 }, ..self }
    }

    /// Returns whether a mesh of `count` triangles is large in the sense of [`Self::for_triangles`].
    pub fn merges(count: usize) -> bool {
        count >= MERGED_FROM
    }

    /// Returns the distance in pixels to which the colour of an edge extends from its middle. A pixel whose
    /// centre is at distance `d` has the coverage `edge_reach_px − d`, clamped to 0…1. Each of the two
    /// triangles draws its half of the line.
    pub fn edge_reach_px(&self) -> f32 {
        self.edge_width_px / 2.0 + 0.5
    }

    /// Returns the length in pixels that is subtracted from the distance to a boundary edge. There is no
    /// neighbour to draw the other half of the line, so the triangle draws both.
    pub fn rim_px(&self) -> f32 {
        self.edge_width_px / 2.0
    }

    /// Returns whether a level is shown in full.
    pub fn shows(&self, level: u32) -> bool {
        self.shown_levels >> level & 1 == 1
    }

    /// Returns the colour of pixels without a triangle, channels from 0 to 1: the ground, or transparent
    /// where something may be drawn below the mesh.
    pub fn clear_color(&self) -> [f32; 4] {
        let [r, g, b] = self.ground_color();
        let opacity = f32::from(self.ground[3]) / 255.0;
        if self.is_opaque() { [r, g, b, opacity] } else { [0.0; 4] }
    }

    /// Returns whether the picture hides everything below it.
    pub fn is_opaque(&self) -> bool {
        self.fill_opacity >= 1.0
    }

    /// Returns the colour of the ground, channels from 0 to 1.
    pub fn ground_color(&self) -> [f32; 3] {
        unit_color(self.ground)
    }
}

/// The appearance of the triangles of one level at one zoom. Channels from 0 to 1, lengths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelPaint {
    /// Colour inside.
    pub fill: [f32; 3],
    /// Colour of the edges.
    pub edge: [f32; 3],
    /// Opacity of the edges: 0 where triangles are too small for edges.
    pub edge_alpha: f32,
    /// Length of a leg in pixels.
    pub leg_px: f32,
    /// Distance of the apex from the bisection edge in pixels.
    pub apex_height_px: f32,
    /// Distance of the two other vertices from the legs opposite to them, in pixels.
    pub base_height_px: f32,
}

impl LevelPaint {
    /// Returns the appearance of every level, from 0.
    ///
    /// Where cells are not square, lengths along x and y differ by up to 5 %; these are their means.
    pub fn all(camera: &Camera, style: &Style) -> [Self; LEVELS] {
        std::array::from_fn(|level| Self::at(level as u32, camera, style))
    }

    fn at(level: u32, camera: &Camera, style: &Style) -> Self {
        let px_per_step = camera.px_per_step();
        // At even levels the legs run along the axes; at odd levels the bisection edge does.
        let axis_steps = f64::from(camera.lattice().cell_steps()) / (1u64 << (level / 2)) as f64;
        let axis_px = axis_steps * (px_per_step.x + px_per_step.y) / 2.0;
        let between_diagonals_px = axis_steps * px_per_step.element_product() / px_per_step.length();
        let (leg_px, apex_height_px, base_height_px) = if level.is_multiple_of(2) {
            (axis_px, between_diagonals_px, axis_px)
        } else {
            (axis_px / std::f64::consts::SQRT_2, axis_px / 2.0, between_diagonals_px)
        };
        let fill = fill_color(level, style);
        Self {
            fill,
            edge: edge_color(fill, style),
            edge_alpha: edge_alpha(leg_px as f32, style) * if style.shows(level) { 1.0 } else { FADED_EDGE },
            leg_px: leg_px as f32,
            apex_height_px: apex_height_px as f32,
            base_height_px: base_height_px as f32,
        }
    }
}

pub(super) fn fill_color(level: u32, style: &Style) -> [f32; 3] {
    let own = unit_color(style.level_colors.of(level as u8));
    if style.shows(level) { own } else { mixed(style.ground_color(), own, FADED_FILL) }
}

/// Returns the colour of the edges on a fill: a darker tint, or a lighter one on a fill that is almost black,
/// so that an unrefined mesh is visible.
pub(super) fn edge_color(fill: [f32; 3], style: &Style) -> [f32; 3] {
    let is_almost_black = fill.iter().sum::<f32>() < 3.0 * ALMOST_BLACK;
    if is_almost_black { mixed(fill, [1.0; 3], LIGHTER_EDGE) } else { fill.map(|c| c * style.edge_shade) }
}

fn edge_alpha(leg_px: f32, style: &Style) -> f32 {
    if style.edges { edge_fade(leg_px, style) } else { 0.0 }
}

/// Returns the opacity of edges where legs have this length in pixels.
#[inline]
pub(super) fn edge_fade(leg_px: f32, style: &Style) -> f32 {
    let [gone, full] = style.edge_fade_px;
    if leg_px <= gone {
        return 0.0;
    }
    let t = ((leg_px - gone) / (full - gone)).min(1.0);
    // Smooth at both ends, so that the beginning of the fade is not visible while zooming.
    t * t * (3.0 - 2.0 * t)
}

fn unit_color([r, g, b, _]: [u8; 4]) -> [f32; 3] {
    [r, g, b].map(|c| f32::from(c) / 255.0)
}

fn mixed(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|i| from[i] + share * (to[i] - from[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colormap::{Colormap, Ground, LevelColors};
    use glam::DVec2;
    use meshbrush_mesh::geometry::{Lattice, Rect};

    fn paints(style: &Style, zoom: f64) -> [LevelPaint; LEVELS] {
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 1000).unwrap();
        let camera = Camera::fit(&lattice, Rect::UNIT, [1000, 1000], 0.0).zoomed(zoom, DVec2::ZERO);
        LevelPaint::all(&camera, style)
    }

    #[test]
    fn widths_keep_their_apparent_size_on_a_denser_screen() {
        let style = Style::dark([[200; 4]; LEVELS]).for_triangles(usize::MAX);
        let dense = style.clone().at_density(2.5);
        assert_eq!(dense.edge_width_px, 2.5 * style.edge_width_px);
        assert_eq!(dense.edge_fade_px, style.edge_fade_px.map(|px| 2.5 * px));
        assert!(dense.merge_below_px == 2.5 * style.merge_below_px && style.merge_below_px > 0.0);
    }

    #[test]
    fn heights_and_legs_are_those_of_right_angled_isosceles_triangles() {
        for (level, paint) in paints(&Style::dark([[200; 4]; LEVELS]), 1.0).iter().enumerate() {
            let leg = 100.0 * 0.5f32.powf(level as f32 / 2.0);
            assert!((paint.leg_px / leg - 1.0).abs() < 1e-5, "level {level}");
            assert!((paint.base_height_px / leg - 1.0).abs() < 1e-5, "level {level}");
            assert!((paint.apex_height_px / leg - 0.5f32.sqrt()).abs() < 1e-5, "level {level}");
        }
    }

    #[test]
    fn edges_fade_with_the_size_of_triangles_and_never_reach_black() {
        let style = Style::dark([[200; 4]; LEVELS]);
        let paints = paints(&style, 1.0);
        assert_eq!(paints[0].edge_alpha, 1.0);
        for pair in paints.windows(2) {
            assert!(pair[1].edge_alpha <= pair[0].edge_alpha);
        }
        let below_three_px = paints.iter().find(|p| p.leg_px < 3.0).unwrap();
        assert_eq!(below_three_px.edge_alpha, 0.0);
        assert!(paints.iter().all(|p| p.edge.iter().all(|&c| c > 0.3)));
    }

    #[test]
    fn the_edges_of_an_unrefined_mesh_can_be_seen() {
        for ground in [Ground::Dark, Ground::Light] {
            let colors = LevelColors::new(Colormap::Viridis, ground, 10);
            let style = if ground == Ground::Dark { Style::dark(colors) } else { Style::light(colors) };
            let paint = paints(&style, 1.0)[0];
            let luminance = |color: [f32; 3]| {
                let linear = color.map(|c| c.powf(2.2));
                0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
            };
            let [low, high] = {
                let both = [luminance(paint.fill), luminance(paint.edge)];
                [both[0].min(both[1]), both[0].max(both[1])]
            };
            let contrast = (high + 0.05) / (low + 0.05);
            assert!(contrast > 1.45, "{ground:?}: {contrast}");
        }
    }

    #[test]
    fn levels_that_are_not_shown_fade_towards_the_ground() {
        let style = Style { shown_levels: 1 << 3, ..Style::dark([[200; 4]; LEVELS]) };
        let paints = paints(&style, 1.0);
        assert_eq!(paints[3].fill, unit_color([200; 4]));
        assert!(paints[4].fill[0] < 0.2);
    }
}
