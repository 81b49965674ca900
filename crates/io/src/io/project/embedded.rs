//! Settings and pixels as parts of another file: settings as values of JSON, pixels as an archive.

use std::io::{self, Write};

use serde_json::{Map, Value};

use super::archive::Archive;
use super::limits::Limits;
use super::part_names::PartData;
use super::part_reader::PartReader;
use super::settings::Saved;
use super::{Flaw, Meter, PartNames, PlacedFlaw, Project, SETTINGS, paint, parts, write_parts};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::PaintLayers;

/// Settings as values of JSON, but for polygons of the domain, long lists of points and pixels.
pub type SettingsValues = Map<String, Value>;

/// Returns the values of settings, with the keys of `settings.json`. Parts have the given names.
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
    Saved::parse(&text)?.into_settings(&mut PartReader { archive: &archive, names, meter, polygons })
}

/// Writes an archive of the data that has no name yet, except for the polygons of the domain, and of the
/// paint. Returns whether there is anything in it.
///
/// # Errors
/// Fails with the errors of `out`, and when a part is beyond its limit.
pub fn write_pixels(out: &mut dyn Write, project: &Project, names: &mut PartNames) -> io::Result<bool> {
    let mut new = names.add(&project.settings);
    new.retain(|(_, data)| !matches!(data, PartData::Region(_)));
    let mut pixels = parts(project, names, &new);
    pixels.retain(|(name, _)| name != SETTINGS);
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
    pixels.map_or_else(|| Ok(Archive::default()), |bytes| Archive::open(bytes, Limits::PROJECT))
}
