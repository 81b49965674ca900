//! The document that an empty one becomes with the raster that it begins with: its domain, its unit and its
//! plane.

use std::path::Path;
use std::sync::Arc;

use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryMarks, Domain, NamedPolygon, OutlineOnEarth};
use meshbrush_core::earth::{Coordinates, ProjectionChoice, Reprojection};
use meshbrush_core::raster::{RasterPyramid, projected_raster};
use meshbrush_io::io::FileCoordinates;
use meshbrush_io::io::geojson::Outline;
use meshbrush_kit::kit::EmptyDocument;
use meshbrush_kit::kit::background::name_of;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Widest grid whose parallels go the shorter way between its corners, in degrees.
const WIDEST: f64 = 170.0;

/// The settings of a document that begins with a raster.
pub struct Ground {
    /// The settings, without a layer of the raster.
    pub settings: Settings,
    /// The raster in the plane of the document; `None` where it is as it was read.
    pub raster: Option<Arc<RasterPyramid>>,
    /// A sentence for a person about the coordinates.
    pub note: Option<String>,
}

/// Returns the document that an empty one becomes with a raster: in the unit and the plane of the file, or
/// in metres where these are wanted and the file is in degrees. `None` where the extent has no area, or is
/// the extent that the document has.
pub fn ground_under(
    empty: &EmptyDocument,
    file: &Path,
    raster: &Arc<RasterPyramid>,
    coordinates: Option<FileCoordinates>,
    wants_metres: bool,
) -> Option<Ground> {
    let bounds = raster.raster().bounds();
    let stated = coordinates.filter(|coordinates| wants_metres || is_stated(coordinates));
    let unit = stated.map_or(LengthUnit::None, |coordinates| coordinates.unit());
    let settings = empty.over(file, bounds, unit)?;
    let Some(from) = stated.and_then(|coordinates| coordinates.on_earth(None)) else {
        return Some(Ground { settings, raster: None, note: None });
    };
    if let Some(own) = from.projection() {
        let domain = Domain { projection: Some(own), ..Domain::rectangle(bounds) };
        return Some(Ground { settings: empty.on(file, domain, unit), raster: None, note: None });
    }
    if !wants_metres {
        return Some(Ground { settings, raster: None, note: None });
    }
    Some(in_metres(empty, file, raster, from).unwrap_or_else(|problem| {
        let note = format!("All of {} cannot be in metres. {problem}", name_of(file));
        Ground { settings, raster: None, note: Some(note) }
    }))
}

fn is_stated(coordinates: &FileCoordinates) -> bool {
    !matches!(coordinates, FileCoordinates::Unstated { .. })
}

/// Returns a document in the plane of a projection that suits a raster.
fn in_metres(
    empty: &EmptyDocument,
    file: &Path,
    raster: &Arc<RasterPyramid>,
    from: Coordinates,
) -> Result<Ground, String> {
    let Rect { min, max } = raster.raster().bounds();
    if from.are_degrees() && max.x - min.x > WIDEST {
        return Err("It is too wide for one plane.".into());
    }
    let corners = [min, (max.x, min.y).into(), max, (min.x, max.y).into()];
    let polygon = NamedPolygon { polygon: vec![corners.to_vec()], name: String::new() };
    let outline = Outline { polygons: vec![polygon], coordinates: FileCoordinates::Known(from) };
    let projected = outline.projected(ProjectionChoice::Automatic, None);
    let (outline, to) = projected.map_err(|error| error.to_string())?;
    let on_earth = OutlineOnEarth { file: Some(from), projection: Some(to), frame: None };
    let domain = BoundaryMarks::domain_of(&outline.polygons, None, &on_earth);
    let domain: Domain = domain.map_err(|error| error.to_string())?.0;
    let projected = projected_raster(raster.raster(), &Reprojection { from, to }, domain.bounds);
    let projected = projected.map_err(|error| error.to_string())?;
    let what =
        if from == Coordinates::WebMercator { "is in Web Mercator" } else { "has longitudes and latitudes" };
    let (name, plane) = (name_of(file), to.kind().name());
    let note = format!("{name} {what}: the document is in metres, in a {plane} plane.");
    Ok(Ground {
        settings: empty.on(file, domain, LengthUnit::Metre),
        raster: Some(Arc::new(RasterPyramid::new(projected))),
        note: Some(note),
    })
}
