//! Settings and pixels as parts of another file: settings as values of JSON, pixels as an archive.

use std::io::{self, Write};
use std::sync::Arc;

use serde_json::{Map, Value};

use super::archive::Archive;
use super::settings::{Parts, Saved};
use super::{
    DOMAIN, Flaw, Meter, Packed, PartNames, PlacedFlaw, Project, SETTINGS, paint, parts, write_parts,
};
use meshbrush_core::document::{Picture, Settings};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{PaintLayers, RasterReading};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

/// Settings as values of JSON, but for polygons and the pixels of rasters.
pub type SettingsValues = Map<String, Value>;

/// Returns the values of settings, with the keys of `settings.json`. Rasters and the background picture have
/// the given names.
pub fn values_of(settings: &Settings, names: &PartNames) -> SettingsValues {
    match serde_json::to_value(Saved::of(settings, names)) {
        Ok(Value::Object(values)) => values,
        _ => unreachable!("settings are an object with texts as keys"),
    }
}

/// Returns the settings with these values, after all checks.
///
/// `polygons` are those of the domain, if it has any; `pixels` is an archive of [`write_pixels`].
///
/// # Errors
/// Fails as for settings in a project.
pub fn settings_of(
    values: &SettingsValues,
    polygons: Option<Vec<Polygon>>,
    pixels: Option<&[u8]>,
    names: &mut PartNames,
) -> Result<Settings, PlacedFlaw> {
    let text = serde_json::to_vec(values).map_err(io::Error::from)?;
    let meter = &Meter::default();
    let archive = archive_of(pixels)?;
    let packed = Packed { archive: &archive, names, meter };
    Saved::parse(&text)?.into_settings(&mut WithPolygons { polygons, packed })
}

/// Writes an archive of the rasters that have no name yet, and of the paint. Returns whether there is
/// anything in it.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_pixels(out: &mut dyn Write, project: &Project, names: &mut PartNames) -> io::Result<bool> {
    let new = names.add(&project.settings);
    let mut pixels = parts(project, names, &new);
    pixels.retain(|(name, _)| name != SETTINGS && name != DOMAIN);
    write_parts(out, &pixels, &Meter::default())?;
    Ok(!pixels.is_empty())
}

/// Returns the paint of such an archive.
///
/// # Errors
/// Fails when it is damaged.
pub fn paint_of(pixels: Option<&[u8]>, settings: &Settings) -> Result<PaintLayers, PlacedFlaw> {
    paint(&archive_of(pixels)?, settings, &Meter::default())
}

fn archive_of(pixels: Option<&[u8]>) -> Result<Archive<'_>, Flaw> {
    pixels.map_or_else(|| Ok(Archive::default()), Archive::open)
}

/// Parts of an archive, with polygons that are not part of it.
struct WithPolygons<'b, 'a> {
    polygons: Option<Vec<Polygon>>,
    packed: Packed<'b, 'a>,
}

impl Parts for WithPolygons<'_, '_> {
    fn polygons(&mut self) -> Result<Vec<Polygon>, PlacedFlaw> {
        let missing = || Flaw::Syntax("the polygons of the domain are missing.".into()).into();
        self.polygons.take().ok_or_else(missing)
    }

    fn background(&mut self, name: &str) -> Result<Arc<Picture>, PlacedFlaw> {
        self.packed.background(name)
    }

    fn raster(&mut self, part: &str, bounds: Rect, size: [u32; 2]) -> Result<Arc<RasterPyramid>, PlacedFlaw> {
        self.packed.raster(part, bounds, size)
    }

    fn base(&mut self, bounds: Rect, size: [u32; 2], reading: &RasterReading) -> Result<Raster, PlacedFlaw> {
        self.packed.base(bounds, size, reading)
    }
}
