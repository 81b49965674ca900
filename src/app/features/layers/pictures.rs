//! Small pictures of what each layer asks for. They are computed on other threads.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};

use meshbrush_core::document::{Document, Settings};
use meshbrush_core::domain::BoundaryMarks;
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{
    Combine, DepthRule, DepthSizes, Depths, Layer, LayerId, LayerKind, SizeField, SizeFieldSpec,
};
use meshbrush_kit::kit::document_id::DocumentId;
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::colormap::{LevelColors, category_color};

/// Pixels along the longer side of a picture.
const LONGER_SIDE: f64 = 52.0;

/// Returns the colour of a layer, in the overlay and beside its name. It belongs to the layer as long as the
/// document is open.
pub fn layer_color32(id: LayerId) -> Color32 {
    let [r, g, b] = category_color(id.0);
    Color32::from_rgb(r, g, b)
}

/// Everything that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct PictureKey {
    kind: LayerKind,
    /// The state of the document for painted layers, otherwise 0.
    painted: u64,
    document: DocumentId,
    bounds: Rect,
    /// The names and types of the boundary, and the layers of depths, for layers that follow them.
    marks: Option<Arc<BoundaryMarks>>,
    depths: Vec<Layer>,
    transfer: Transfer,
    colors: LevelColors,
}

#[derive(Default)]
struct LayerPicture {
    latest: Slot<PictureKey, ColorImage>,
    texture: Option<TextureHandle>,
}

/// The pictures of all layers, each computed again only when the layer asks for something else.
#[derive(Default)]
pub struct LayerPictures {
    pictures: BTreeMap<LayerId, LayerPicture>,
    /// The state of document and colours for which all pictures are up to date.
    current: Option<(DocumentId, u64, LevelColors)>,
}

impl LayerPictures {
    /// Returns the last picture of a layer.
    pub fn texture(&self, id: LayerId) -> Option<&TextureHandle> {
        self.pictures.get(&id)?.texture.as_ref()
    }

    /// Takes pictures that are ready, and computes those that are out of date. No frame waits for them,
    /// unless it waits for everything. A stroke is shown once it has ended.
    pub fn advance(&mut self, session: &Session, view: &View, jobs: &Jobs, ctx: &Context) {
        let document = session.document();
        let colors = view.level_colors(document.settings());
        let state = (session.document_id(), document.revision(), colors);
        if self.current.as_ref() == Some(&state) || document.stroke().is_some() {
            return;
        }
        let layers = &document.settings().layers;
        self.pictures.retain(|id, _| layers.iter().any(|layer| layer.id == *id));
        let mut all_current = true;
        for layer in layers {
            let key = key(layer, session.document_id(), document, &state.2);
            all_current &=
                self.pictures.entry(layer.id).or_default().advance(key, layer, document, jobs, ctx);
        }
        self.current = all_current.then_some(state);
    }
}

fn key(layer: &Layer, opened: DocumentId, document: &Document, colors: &LevelColors) -> PictureKey {
    let settings = document.settings();
    PictureKey {
        kind: layer.kind.clone(),
        painted: if layer.paints().is_some() { document.revision() } else { 0 },
        document: opened,
        bounds: settings.domain.bounds,
        marks: layer.kind.follows_pieces().then(|| settings.boundary_marks.clone()),
        depths: depths_for(layer, settings),
        transfer: settings.transfer,
        colors: colors.clone(),
    }
}

/// Returns the layers of depths that give a formula its depths. They ask for nothing themselves.
fn depths_for(layer: &Layer, settings: &Settings) -> Vec<Layer> {
    let without_sizes = |layer: &Layer| {
        let depths = layer.kind.get::<Depths>()?;
        let sizes = DepthSizes { rule: DepthRule::Nothing, ..*depths.sizes() };
        Some(Layer { kind: depths.with_sizes(sizes).into(), ..layer.clone() })
    };
    let layers: &[Layer] = if layer.kind.uses_depth() { &settings.layers } else { &[] };
    layers.iter().filter_map(without_sizes).collect()
}

impl LayerPicture {
    /// Returns whether the picture is up to date.
    fn advance(
        &mut self,
        key: PictureKey,
        layer: &Layer,
        document: &Document,
        jobs: &Jobs,
        ctx: &Context,
    ) -> bool {
        self.take(layer.id, jobs, ctx);
        self.latest.want(&key, jobs);
        if !self.latest.is_running()
            && !self.latest.has(&key)
            && let Some(draw) = picture_of(layer, document, key.colors.clone())
        {
            self.latest.start(key.clone(), draw, jobs);
        }
        self.take(layer.id, jobs, ctx);
        self.latest.last().is_some_and(|(of, _)| *of == key)
    }

    fn take(&mut self, id: LayerId, jobs: &Jobs, ctx: &Context) {
        if !self.latest.is_running() {
            return;
        }
        if self.latest.poll(jobs) {
            return;
        }
        let Some((_, image)) = self.latest.last() else { return };
        match &mut self.texture {
            Some(texture) => texture.set(image.clone(), TextureOptions::LINEAR),
            None => {
                let name = format!("layer {}", id.0);
                self.texture = Some(ctx.load_texture(name, image.clone(), TextureOptions::LINEAR));
            }
        }
    }
}

/// Returns the field of a layer alone: what it asks for, and infinity where that is nothing.
pub fn field_of(layer: &Layer, settings: &Settings) -> SizeFieldSpec {
    let alone = Layer { visible: true, combine: Combine::Finest, ..settings.field_layer(layer) };
    SizeFieldSpec {
        layers: [depths_for(layer, settings), vec![alone]].concat(),
        unasked: f64::INFINITY,
        gradation: None,
        ..settings.field_spec()
    }
}

/// Returns the work that draws what a layer alone asks for, in the colours of the levels; transparent where
/// it asks for nothing. `None` while the settings have no mesh.
fn picture_of(
    layer: &Layer,
    document: &Document,
    colors: LevelColors,
) -> Option<impl FnOnce() -> ColorImage + Send + 'static> {
    let settings = document.settings();
    let lattice = settings.lattice().ok()?;
    let spec = field_of(layer, settings);
    let (bounds, paint) = (settings.domain.bounds, document.paint().clone());
    Some(move || {
        let size = bounds.size() / bounds.size().max_element() * LONGER_SIDE;
        let [columns, rows] = [size.x, size.y].map(|side| (side.round() as u32).max(1));
        let field = SizeField::new(spec, &lattice);
        let target = field.sampled(&paint, bounds, [columns, rows]);
        let center = target.pixel_centers();
        let color = |x: u32, y: u32| match target.get(x, y) {
            target if target.is_finite() => {
                let level = field.level_of_diameter(f64::from(target), center(x, y)).unwrap_or(63).min(63);
                let [r, g, b, _] = colors.of(level as u8);
                Color32::from_rgb(r, g, b)
            }
            _ => Color32::TRANSPARENT,
        };
        // Pictures begin at the top.
        let from_top = (0..rows).rev().flat_map(|y| (0..columns).map(move |x| (x, y)));
        let pixels = from_top.map(|(x, y)| color(x, y)).collect();
        ColorImage::new([columns as usize, rows as usize], pixels)
    })
}
