//! Notes for a person about settings from files.

use std::path::Path;

use glam::DVec2;
use rayon::prelude::*;

use super::super::Number;
use super::super::geojson::Outline;
use super::super::settings::{SavedDomain, SavedSettings, marks_of};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryPieces, BoundaryTreatment, PieceChoice};
use meshbrush_core::earth::Projection;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerKind, PaintLayers, RasterSource};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{LengthUnit, short_name};

/// The share of a rectangle that a raster covers which covers all of it, but for rounding.
const WHOLE: f64 = 1.0 - 1e-6;

/// Returns the note on polygons that are cut at the antimeridian.
pub fn cut_at_antimeridian(path: &Path, outline: &Outline) -> Option<String> {
    outline.is_cut_at_antimeridian().then(|| {
        format!(
            "{} is cut at the antimeridian (longitude 180°): the halves on its sides are separate parts of the mesh, and \
             without --parts all only the largest part stays. Add 360 to the negative longitudes to mesh them as one.",
            path.display()
        )
    })
}

/// Returns how lengths in the plane of a projection differ from those on the Earth, rounded outwards.
pub fn in_the_plane(outline: &Outline, projection: &Projection) -> String {
    let rings = outline.polygons.par_iter().flat_map_iter(|named| &named.polygon);
    let corners = rings.flat_map(|ring| ring.par_iter());
    let scales = corners.map(|&corner| [projection.scale_in_plane(corner); 2]);
    let [least, most] =
        scales.reduce(|| [f64::INFINITY, 0.0], |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])]);
    // A hair less and more than what rounding leaves of a scale of one.
    let (least, most) = (1e-4 * (1e4 * least + 1e-6).floor(), 1e-4 * (1e4 * most - 1e-6).ceil());
    format!(
        "The domain is meshed in the plane {projection}: a length there is {least:.4} to {most:.4} times that on the \
         Earth. Target diameters are metres on the Earth."
    )
}

/// Returns layers that ask for nothing, or only in a part of the domain: that is noted where the domain
/// `has_frame` of its own.
pub fn notes(settings: &Settings, paint: &PaintLayers, has_frame: bool) -> Vec<String> {
    notes_on(settings, paint, has_frame, |_| true)
}

/// Returns the notes on some layers.
pub fn notes_on(
    settings: &Settings,
    paint: &PaintLayers,
    has_frame: bool,
    is_one: impl Fn(&Layer) -> bool,
) -> Vec<String> {
    let domain = settings.domain.bounds;
    let visible: Vec<&Layer> =
        settings.layers.iter().filter(|layer| layer.visible && is_one(layer)).collect();
    let missing = missing_pieces(settings, &visible);
    let idle = settings.idle_layers(paint);
    let is_said = |layer: &Layer| {
        let measures_to_pieces =
            matches!(&layer.kind, LayerKind::Distance(DistanceLayer { to: DistanceTo::Pieces(_), .. }));
        measures_to_pieces && !missing.is_empty()
    };
    let changes_nothing = |layer: &Layer| idle.contains(&layer.id) && !is_said(layer);
    let note = |layer: &&Layer| {
        of_layer(layer, domain, has_frame).or_else(|| changes_nothing(layer).then(|| idle_layer(layer)))
    };
    visible.iter().filter_map(note).chain(missing.iter().cloned()).collect()
}

/// Returns the note on a layer whose mask or grid does not cover the domain.
fn of_layer(layer: &Layer, domain: Rect, has_frame: bool) -> Option<String> {
    match (&layer.kind, &layer.mask) {
        (_, Some(mask)) if mask.bounds().intersection(&domain).is_none() => Some(format!(
            "The mask of the layer “{}” does not meet the domain: it asks for nothing.",
            layer.name
        )),
        (kind, _) => {
            let source = kind.raster_source();
            source.and_then(|source| of_raster(layer, source, domain, has_frame))
        }
    }
}

/// Returns the note on a layer that changes nothing.
fn idle_layer(layer: &Layer) -> String {
    format!(
        "The layer “{}” changes nothing: in the whole rectangle of the domain, it asks for no triangles that are smaller \
         than the coarse ones and than h_max. Check its values, its place and its unit.",
        short_name(&layer.name)
    )
}

/// Returns notes on pins, places of paths and keep-out regions that do not meet the domain.
pub fn far_places(settings: &Settings) -> impl Iterator<Item = String> {
    let domain = settings.domain.bounds;
    let is_far = move |at: &DVec2| !domain.contains(*at);
    let place = |at: &DVec2| format!("{}, {}", Number(at.x), Number(at.y));
    let pins = settings.pins.iter().filter(move |at| is_far(at)).map(move |at| {
        format!(
            "The pin at {} lies outside the rectangle of the domain: there is nothing to read.",
            place(at)
        )
    });
    let routes = settings.paths.routes.iter().zip(1..);
    let routes = routes.flat_map(|(route, number)| route.iter().map(move |at| (at, number)));
    let routes = routes.filter(move |(at, _)| is_far(at)).map(move |(at, number)| {
        format!(
            "The place {} of path {number} lies outside the rectangle of the domain: no path leads there.",
            place(at)
        )
    });
    let regions = settings.paths.keep_out.iter();
    let regions = regions.filter(move |region| region.mask.bounds().intersection(&domain).is_none());
    let regions = regions.map(|region| {
        let name = short_name(&region.name);
        format!("The keep-out region “{name}” does not meet the domain: it keeps no path out.")
    });
    pins.chain(routes).chain(regions)
}

/// Returns a note where places of pins and paths are taken for longitudes and latitudes.
pub fn places_in_degrees(saved: &SavedSettings, settings: &Settings) -> Option<String> {
    let is_same = |typed: &[f64; 2], place: &DVec2| DVec2::from(*typed) == *place;
    let are_same =
        |typed: &[[f64; 2]], places: &[DVec2]| typed.iter().zip(places).all(|(a, b)| is_same(a, b));
    let routes = saved.paths.routes.iter().zip(&settings.paths.routes);
    let is_moved = !are_same(&saved.pins.at, &settings.pins) || !{ routes }.all(|(a, b)| are_same(a, b));
    is_moved.then(|| {
        "Places of pins and paths that are not in the rectangle of the domain are taken for longitudes and latitudes, in \
         degrees."
            .to_owned()
    })
}

/// Returns notes on what is asked of the boundary of a mesh that does not have it.
pub fn idle_cleaning(saved: &SavedDomain, settings: &Settings) -> impl Iterator<Item = String> {
    let is_on_outline =
        settings.is_fitted() && matches!(settings.boundary, BoundaryTreatment::OnOutline { .. });
    let improves = saved.improve_boundary == Some(true) && !is_on_outline;
    let keeps = saved.keep_pinches == Some(true) && !settings.is_fitted();
    let improves = improves.then_some(
        "`improve_boundary` changes nothing: the mesh has no nodes on an outline. It has them in a domain of polygons or by a \
         formula, with the boundary \"outline\".",
    );
    let keeps = keeps.then_some(
        "`keep_pinches` changes nothing: the mesh is not fitted to an outline, and all of it stays.",
    );
    improves.into_iter().chain(keeps).map(str::to_owned)
}

/// Returns a note where a region on the Earth has no open boundary.
pub fn no_open_boundary(settings: &Settings) -> Option<String> {
    let is_on_earth = settings.domain.projection.is_some() || settings.unit == LengthUnit::Degree;
    let is_region = is_on_earth && settings.domain.region().is_some();
    let pieces = || BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks);
    is_region.then(pieces).flatten()?.closed_note()
}

/// Notes on names, types and splits of a text.
#[derive(Debug, Default)]
pub struct MarkNotes {
    /// That places are longitudes and latitudes.
    pub assumed: Option<String>,
    /// Those that have no effect.
    pub without_effect: Vec<String>,
}

/// Returns notes on names, types and splits of a text. The boundary of a formula is that of its mesh, which
/// is not there yet.
pub fn mark_notes(domain: &SavedDomain, settings: &Settings) -> MarkNotes {
    let given = marks_of(&domain.splits, &domain.names, &domain.types);
    let pieces = || BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks);
    let Some(pieces) = (!given.is_empty()).then(pieces).flatten() else { return MarkNotes::default() };
    let marks = domain.marks_on(&settings.domain);
    let assumed = (marks != given).then(|| {
        "Places of names, types and splits of the boundary are taken for longitudes and latitudes, in degrees, where \
         these are on the boundary."
            .to_owned()
    });
    MarkNotes { assumed, without_effect: pieces.idle_marks(&marks) }
}

/// Returns the names of pieces of the boundary that visible layers measure to, and that no piece has.
fn missing_pieces(settings: &Settings, visible: &[&Layer]) -> Vec<String> {
    let chosen = visible.iter().copied().filter_map(|layer| match &layer.kind {
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Pieces(chosen), .. })
            if !chosen.names.is_empty() =>
        {
            Some((layer, chosen))
        }
        _ => None,
    });
    let chosen: Vec<(&Layer, &PieceChoice)> = chosen.collect();
    if chosen.is_empty() {
        return Vec::new();
    }
    let pieces = BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks);
    let names = |(layer, chosen): &(&Layer, &PieceChoice)| -> Vec<String> {
        let unknown = pieces.iter().flat_map(|pieces| chosen.unknown_names(pieces));
        unknown.map(|name| missing_piece(layer, name)).collect()
    };
    chosen.iter().flat_map(names).collect()
}

fn missing_piece(layer: &Layer, name: &str) -> String {
    format!(
        "No piece of the boundary is called “{}”: the layer “{}” does not measure to it.",
        short_name(name),
        short_name(&layer.name)
    )
}

fn of_raster(layer: &Layer, source: &RasterSource, domain: Rect, has_frame: bool) -> Option<String> {
    let (bounds, file) = (source.raster.raster().bounds(), &source.name);
    let common = bounds.intersection(&domain).map_or(0.0, |common| common.size().element_product());
    if common == 0.0 {
        let Rect { min, max } = bounds;
        let place = format!("{}, {} to {}, {}", min.x, min.y, max.x, max.y);
        return Some(format!("{file} covers {place} and does not meet the domain."));
    }
    let share = common / domain.size().element_product();
    (share < WHOLE && has_frame).then(|| {
        let percent = (100.0 * share).max(1.0).floor();
        let name = &layer.name;
        format!(
            "{file} covers {percent} % of the domain's rectangle; beyond it the layer “{name}” asks for nothing."
        )
    })
}
