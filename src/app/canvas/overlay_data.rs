//! What the colours of overlays are found from, and finding them.

use std::sync::Arc;

use super::overlay::{OverlaySource, OverlayState};
use super::quality_colors::QualityData;
use super::relief_colors::ReliefColors;
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::domain::DomainOnLattice;
use meshbrush_core::explain::AgesNow;
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::{DepthSurface, Layer, LevelCache, PaintLayers, SizeField};
use meshbrush_core::raster::Raster;
use meshbrush_core::surface::SurfaceRule;
use meshbrush_kit::kit::jobs::Slice;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, Limits, Mesh, TriangleId};
use meshbrush_render::colormap::overlay_palette::{Opaque, OverlayPalette};
use meshbrush_study::pixels::PixelTriangles;
use meshbrush_study::relief::{depth_differences, surface_differences};

/// The document and its mesh as they are, for colours that are found on another thread.
pub(super) struct OverlayData {
    layers: Vec<Layer>,
    paint: PaintLayers,
    field: Arc<SizeField>,
    /// `None` where colours do not depend on it: then it can be changed without a copy meanwhile.
    mesh: Option<Arc<Mesh>>,
    ages: Option<AgesNow>,
    domain: DomainOnLattice,
    rule: RefinementRule,
    limits: Limits,
    surface: Option<Arc<SurfaceRule>>,
    quality: QualityData,
}

impl OverlayData {
    /// Takes what an overlay depends on.
    pub fn of(session: &Session, kind: FieldOverlay) -> Self {
        let (document, follower) = (session.document(), session.follower());
        let reads_mesh =
            matches!(OverlaySource::of(kind), OverlaySource::Triangles | OverlaySource::Comparison);
        let settings = follower.settings();
        Self {
            layers: document.settings().layers.clone(),
            paint: document.paint().clone(),
            field: follower.shared_field(),
            mesh: reads_mesh.then(|| follower.shared_mesh()),
            ages: (kind == FieldOverlay::Age).then(|| session.ages()),
            domain: follower.domain().clone(),
            rule: settings.rule,
            limits: settings.limits(),
            surface: follower.surface().cloned(),
            quality: QualityData::of(session),
        }
    }

    /// Returns what triangles are compared with.
    pub fn quality(&self) -> &QualityData {
        &self.quality
    }

    /// Returns the colours of pixels. `derived` is the mesh with its nodes on the outline, where there is
    /// one. `None` where `goes_on` says that nobody wants them any more.
    pub fn colors(
        &self,
        state: &OverlayState,
        derived: Option<&Extract>,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Vec<Opaque>> {
        let OverlayState { kind, bounds, size, palette, .. } = state;
        let sampled = || self.field.sampled_while(&self.paint, *bounds, *size, goes_on);
        let whole = || derived.is_none().then(|| Some(self.mesh.as_ref()?.extract())).flatten();
        match OverlaySource::of(*kind) {
            OverlaySource::Triangles => {
                let triangles = PixelTriangles::new(self.mesh.as_ref()?, *bounds, *size);
                self.with_triangle_colors(*kind, palette, |color| {
                    triangles.colors(goes_on, palette.neutral(), color)
                })?
            }
            OverlaySource::Comparison => {
                let whole = whole();
                self.compared(derived.or(whole.as_ref())?, state, goes_on)
            }
            OverlaySource::Data => self.relief(state, goes_on),
            OverlaySource::Field if *kind == FieldOverlay::Risk => {
                risk_colors(&self.layers, &self.paint, state, goes_on)
            }
            OverlaySource::Field if *kind == FieldOverlay::Layer => {
                sampled().map(|(_, layers)| layers.into_iter().map(|layer| palette.layer(layer)).collect())
            }
            OverlaySource::Field => sampled().map(|(target, _)| target_colors(&self.field, &target, palette)),
        }
    }

    /// Returns the colours of data all at once: the canvas finds them in slices.
    fn relief(&self, state: &OverlayState, goes_on: &dyn Fn() -> bool) -> Option<Vec<Opaque>> {
        let mut colors = ReliefColors::new(state.clone(), self.layers.clone(), self.surface.clone());
        while goes_on() {
            if let Slice::Found(pixels) = colors.advance() {
                return Some(pixels.rgba);
            }
        }
        None
    }

    fn compared(
        &self,
        mesh: &Extract,
        state: &OverlayState,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Vec<Opaque>> {
        match state.kind {
            FieldOverlay::DepthError => depth_error_colors(&self.layers, mesh, state, goes_on),
            FieldOverlay::SurfaceError => surface_error_colors(self.surface.as_deref(), mesh, state, goes_on),
            _ => self.quality.colors(mesh, state, goes_on),
        }
    }

    /// Calls `use_color` with the colour of each triangle of the mesh before the outline; `None` for an
    /// overlay that has none.
    pub fn with_triangle_colors<T>(
        &self,
        kind: FieldOverlay,
        palette: &OverlayPalette,
        use_color: impl FnOnce(&mut dyn FnMut(TriangleId) -> Opaque) -> T,
    ) -> Option<T> {
        let Self { field, paint, .. } = self;
        let triangles = PixelTriangles::new(self.mesh.as_ref()?, Rect::UNIT, [1, 1]);
        match kind {
            FieldOverlay::Age => {
                let ages = self.ages.as_ref()?;
                Some(use_color(&mut |id| palette.age(ages.of(id))))
            }
            FieldOverlay::Forced => {
                let criterion = RefinementCriterion::new(&self.domain, field, self.rule, Some(paint))
                    .with_surface(self.surface.as_deref());
                let is_forced = |id| triangles.is_forced(id, &criterion, &self.limits);
                Some(use_color(&mut |id| palette.forced(is_forced(id))))
            }
            FieldOverlay::Slack => {
                let mut squares = LevelCache::default();
                Some(use_color(&mut |id| palette.slack(triangles.slack(id, field, paint, &mut squares))))
            }
            _ => None,
        }
    }

    /// Returns the colour of each triangle of an extract; `None` for an overlay whose colours change within
    /// triangles, and where `goes_on` says that nobody wants them any more. A triangle at the outline has the
    /// colour of the one of the mesh at its middle.
    pub fn colors_by_triangle(
        &self,
        kind: FieldOverlay,
        palette: &OverlayPalette,
        extract: &Extract,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Vec<Opaque>> {
        let mesh = self.mesh.as_ref()?;
        self.with_triangle_colors(kind, palette, |color| {
            let view = extract.view();
            let of_triangle = |number: usize| {
                if number.is_multiple_of(4096) && !goes_on() {
                    return None;
                }
                let [a, b, c] = view.world_corners(TriangleId::from_index(number));
                let below = mesh.locate((a + b + c) / 3.0).triangle();
                Some(below.map_or(palette.neutral(), &mut *color))
            };
            (0..extract.triangles().len()).map(of_triangle).collect()
        })?
    }
}

/// `None` where `goes_on` says at the beginning of a row that nobody wants the colours any more.
fn risk_colors(
    layers: &[Layer],
    paint: &PaintLayers,
    state: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let table: [[u8; 4]; 256] = std::array::from_fn(|i| state.palette.risk(i as u8));
    let grid = Raster::filled(state.bounds, state.size, 0u8);
    let centers = grid.pixel_centers();
    let risk = |point| {
        let visible = layers.iter().filter(|layer| layer.visible);
        visible.filter_map(|layer| layer.risk_at(paint, point)).fold(0.0, f64::max)
    };
    let color = |(x, y)| table[(risk(centers(x, y)) * 255.0) as u8 as usize];
    grid.all().pixels().map(|(x, y)| (x > 0 || goes_on()).then(|| color((x, y)))).collect()
}

/// Returns how far the mesh is from the depths; neutral beyond it, and without depths.
fn depth_error_colors(
    layers: &[Layer],
    mesh: &Extract,
    OverlayState { bounds, size, palette, .. }: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let surface = DepthSurface::of(layers);
    let depths = surface.as_ref().and_then(|surface| surface.depths_at_nodes(mesh.view()).ok());
    let Some((surface, depths)) = surface.zip(depths) else { return Some(neutral(*size, palette)) };
    let differences = depth_differences(mesh.view(), &depths, &surface, (*bounds, *size), goes_on)?;
    Some(differences.values().iter().map(|&difference| palette.depth_error(difference)).collect())
}

/// Returns how far the mesh is from surfaces; neutral beyond it, and without a surface.
fn surface_error_colors(
    rule: Option<&SurfaceRule>,
    mesh: &Extract,
    OverlayState { bounds, size, palette, .. }: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let Some(rule) = rule else { return Some(neutral(*size, palette)) };
    let fit = rule.samples().fit(mesh.view());
    let differences = surface_differences(mesh.view(), &fit, rule, (*bounds, *size), goes_on)?;
    Some(differences.values().iter().map(|&share| palette.surface_error(share)).collect())
}

pub(super) fn neutral(size: [u32; 2], palette: &OverlayPalette) -> Vec<[u8; 4]> {
    vec![palette.neutral(); size[0] as usize * size[1] as usize]
}

fn target_colors(field: &SizeField, target: &Raster, palette: &OverlayPalette) -> Vec<[u8; 4]> {
    let center = target.pixel_centers();
    let level =
        |x, y| field.level_of_diameter(f64::from(target.get(x, y)), center(x, y)).unwrap_or(63).min(63);
    target.all().pixels().map(|(x, y)| palette.level(level(x, y) as u8)).collect()
}
