//! Depths of water and surfaces as a shaded relief, some rows at a time: a page has no other thread, and a
//! whole picture takes longer than one of its frames.

use std::sync::Arc;

use super::overlay::{OverlayState, Pixels};
use super::overlay_data::neutral;
use meshbrush_core::layers::{DepthSurface, Layer};
use meshbrush_core::surface::SurfaceRule;
use meshbrush_kit::kit::jobs::Slice;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::mesh::Progress;
use meshbrush_render::colormap::overlay_palette::{Opaque, lit};
use meshbrush_study::relief::{Relief, ReliefPixel, ReliefSampling};

/// The light on an isobath, and the most on any ground.
const ISOBATH: f32 = 0.72;
const MOST_LIGHT: f32 = 1.25;
/// Pixels in a step: a few milliseconds.
const AT_ONCE: u32 = 32_768;

/// The colours of a relief on their way.
pub(super) struct ReliefColors {
    state: OverlayState,
    layers: Vec<Layer>,
    rule: Option<Arc<SurfaceRule>>,
    step: ReliefStep,
}

/// What is done next.
enum ReliefStep {
    Begin,
    /// The surface is sampled.
    Sample(ReliefSampling),
    /// The rows after those with colours get theirs.
    Color(Relief, Vec<Opaque>),
    Done,
}

impl ReliefColors {
    /// Begins: with isobaths of the depths of layers, or with contour lines of surfaces, by the kind of
    /// overlay.
    pub(super) fn new(state: OverlayState, layers: Vec<Layer>, rule: Option<Arc<SurfaceRule>>) -> Self {
        Self { state, layers, rule, step: ReliefStep::Begin }
    }

    /// Takes a step. Returns the colours at the end: neutral ones where there is no surface.
    pub(super) fn advance(&mut self) -> Slice<Pixels> {
        self.advance_by(AT_ONCE / self.state.size[0].max(1))
    }

    fn advance_by(&mut self, rows: u32) -> Slice<Pixels> {
        let OverlayState { size, palette, .. } = &self.state;
        self.step = match std::mem::replace(&mut self.step, ReliefStep::Done) {
            ReliefStep::Begin => match self.begin() {
                Some(sampling) => ReliefStep::Sample(sampling),
                None => return Slice::Found(Pixels { rgba: neutral(*size, palette) }),
            },
            ReliefStep::Sample(mut sampling) => match self.sample(&mut sampling, rows) {
                Progress::More => ReliefStep::Sample(sampling),
                Progress::Done => ReliefStep::Color(sampling.finish(), Vec::new()),
            },
            ReliefStep::Color(relief, mut rgba) => {
                let first = rgba.len() as u32 / size[0].max(1);
                let end = first.saturating_add(rows.max(1));
                let color = self.color();
                rgba.extend(relief.rows(first..end).map(|pixel| pixel.map_or(palette.neutral(), &color)));
                if end >= size[1] {
                    return Slice::Found(Pixels { rgba });
                }
                ReliefStep::Color(relief, rgba)
            }
            ReliefStep::Done => return Slice::Found(Pixels { rgba: neutral(*size, palette) }),
        };
        Slice::More
    }

    /// `None` without a surface.
    fn begin(&self) -> Option<ReliefSampling> {
        let OverlayState { domain, bounds, size, .. } = self.state;
        Some(match self.state.kind {
            FieldOverlay::Depth => {
                Relief::from_depths(&DepthSurface::of(&self.layers)?, domain, (bounds, size))
            }
            _ => {
                let [lowest, highest] = self.heights()?;
                Relief::from_heights(highest - lowest, domain, (bounds, size))
            }
        })
    }

    /// Returns the least and the greatest height of surfaces.
    fn heights(&self) -> Option<[f64; 2]> {
        self.rule.as_ref()?.samples().height_range()
    }

    /// Samples so many more rows.
    fn sample(&self, sampling: &mut ReliefSampling, rows: u32) -> Progress {
        match (self.state.kind, DepthSurface::of(&self.layers), &self.rule) {
            (FieldOverlay::Depth, Some(surface), _) => {
                sampling.advance(rows, |point| surface.depth_at(point))
            }
            (_, _, Some(rule)) => {
                sampling.advance(rows, |point| rule.allowed_at(point).map(|(height, _)| height))
            }
            _ => Progress::Done,
        }
    }

    /// Returns the colour of a pixel.
    fn color(&self) -> impl Fn(ReliefPixel) -> Opaque + '_ {
        let palette = &self.state.palette;
        let deepest = DepthSurface::of(&self.layers).map_or(0.0, |surface| surface.deepest()) as f32;
        let [lowest, highest] = self.heights().unwrap_or_default();
        let rise = (highest - lowest).max(f64::MIN_POSITIVE);
        let is_depth = self.state.kind == FieldOverlay::Depth;
        move |pixel| {
            let ground = match is_depth {
                true if pixel.depth > 0.0 => palette.water(pixel.depth / deepest),
                true => palette.land(),
                false => palette.height(((-f64::from(pixel.depth) - lowest) / rise) as f32),
            };
            lit(ground, if pixel.is_isobath { ISOBATH } else { 1.0 } * pixel.light.min(MOST_LIGHT))
        }
    }
}

#[cfg(test)]
mod tests {
    use meshbrush_core::document::Example;
    use meshbrush_core::layers::{DepthRule, DepthSizes, Depths, PositiveDepth, RasterSource};
    use meshbrush_core::raster::{Raster, RasterPyramid};
    use meshbrush_mesh::geometry::Rect;

    use super::*;
    use crate::app::files::example;
    use meshbrush_kit::kit::session::Session;
    use meshbrush_kit::kit::view::View;
    use meshbrush_render::colormap::overlay_palette::OverlayPalette;

    #[test]
    fn a_level_sea_has_the_colours_of_its_depths() {
        let mut raster = Raster::filled(Rect::UNIT, [20, 20], 0.0_f32);
        for (x, y) in raster.all().pixels() {
            raster.set(x, y, if x < 10 { 50.0 } else { 100.0 });
        }
        let source = RasterSource { name: "depth".into(), raster: Arc::new(RasterPyramid::new(raster)) };
        let sizes = DepthSizes {
            positive: PositiveDepth::Down,
            offset: 0.0,
            rule: DepthRule::Nothing,
            between: DepthSizes::ALL_WATER,
        };
        let layers = Layer::stack([Depths::new(source, sizes)]);
        let view = View::default();
        let session = Session::new(example(Example::ALL[0])).expect("the example has a mesh");
        let palette = OverlayPalette::new(view.ground, view.level_colors(session.document().settings()));
        let state = OverlayState {
            kind: FieldOverlay::Depth,
            document: 0,
            mesh: 0,
            is_derived: false,
            domain: Rect::UNIT,
            bounds: Rect::UNIT,
            size: [40, 40],
            palette,
        };
        let palette = state.palette.clone();
        let mut relief = ReliefColors::new(state, layers, None);
        let colors = loop {
            if let Slice::Found(pixels) = relief.advance_by(7) {
                break pixels.rgba;
            }
        };
        for (x, share) in [(5, 0.5), (35, 1.0)] {
            assert_eq!(colors[40 * 20 + x], palette.water(share), "column {x}");
        }
        // The slope between them is no brighter than a limit.
        let most = |channel: usize| {
            let brightest = [0.5, 1.0].map(|share| palette.water(share)[channel]);
            (MOST_LIGHT * f32::from(brightest[0].max(brightest[1]))).ceil()
        };
        for color in &colors {
            assert!((0..3).all(|channel| f32::from(color[channel]) <= most(channel)), "{color:?}");
        }
    }
}
