//! Where a GeoTIFF lies, and in which coordinate reference system (OGC GeoTIFF 1.1).

use std::io::{Read, Seek};

use glam::{DVec2, dvec2};
use tiff::decoder::Decoder;
use tiff::tags::Tag;

use super::super::Flaw;
use super::super::coordinate_system::{CoordinateKind, CoordinateSystem};
use super::super::samples::no_rectangle;
use super::super::vertical::{ValueUnit, VerticalSystem};
use meshbrush_mesh::geometry::Rect;

/// Turns and shears are refused above this share of a pixel per pixel.
const MOST_TURN: f64 = 1e-9;

/// The place of a picture in world units, and the order of its rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) bounds: Rect,
    /// Whether the first row in the file is the lowest.
    pub(super) is_south_up: bool,
}

/// Keys that describe the coordinates: the short ones by number, and the texts.
#[derive(Debug, Default)]
pub(super) struct GeoKeys {
    shorts: Vec<(u16, u16)>,
    texts: Vec<(u16, String)>,
}

const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const CITATION: u16 = 1026;
const GEOGRAPHIC_CODE: u16 = 2048;
const GEOGRAPHIC_CITATION: u16 = 2049;
const PROJECTED_CODE: u16 = 3072;
const PROJECTED_CITATION: u16 = 3073;
/// The value of a code for a system that the file defines itself.
const USER_DEFINED: u16 = 32767;
const VERTICAL_CODE: u16 = 4096;
const VERTICAL_UNIT: u16 = 4099;
/// The value of `GTRasterTypeGeoKey` for samples at points, which lie at the centres of pixels.
const POINTS: u16 = 2;

impl GeoKeys {
    /// Reads the keys of a file; none where it has none.
    pub(super) fn read(decoder: &mut Decoder<impl Read + Seek>) -> Result<Self, Flaw> {
        let Some(directory) = decoder.find_tag(Tag::GeoKeyDirectoryTag)? else { return Ok(Self::default()) };
        let directory = directory.into_u16_vec()?;
        let texts = match decoder.find_tag(Tag::GeoAsciiParamsTag)? {
            Some(texts) => texts.into_string().unwrap_or_default(),
            None => String::new(),
        };
        let mut keys = Self::default();
        for entry in directory.get(4..).unwrap_or_default().chunks_exact(4) {
            let [key, location, count, value] = [entry[0], entry[1], entry[2], entry[3]];
            if location == 0 {
                keys.shorts.push((key, value));
            } else if location == Tag::GeoAsciiParamsTag.to_u16() {
                let text = texts.as_bytes().get(usize::from(value)..usize::from(value) + usize::from(count));
                let text = String::from_utf8_lossy(text.unwrap_or_default()).into_owned();
                keys.texts.push((key, text.trim_end_matches(['|', '\0']).to_owned()));
            }
        }
        Ok(keys)
    }

    fn short(&self, key: u16) -> Option<u16> {
        self.shorts.iter().find(|(at, _)| *at == key).map(|&(_, value)| value)
    }

    fn text(&self, key: u16) -> Option<String> {
        self.texts.iter().find(|(at, text)| *at == key && !text.is_empty()).map(|(_, text)| text.clone())
    }

    /// Returns what the keys say about heights and depths.
    pub(super) fn vertical(&self) -> VerticalSystem {
        let known = |key| self.short(key).filter(|&code| code != 0 && code < USER_DEFINED);
        let system = known(VERTICAL_CODE).map_or_else(VerticalSystem::default, VerticalSystem::from_epsg);
        let unit = known(VERTICAL_UNIT).map_or(ValueUnit::Unstated, ValueUnit::from_epsg);
        VerticalSystem { unit: unit.or(system.unit), ..system }
    }

    /// Returns what the keys say about the coordinate reference system; `None` where they say nothing.
    pub(super) fn coordinate_system(&self) -> Option<CoordinateSystem> {
        let kind = match self.short(MODEL_TYPE)? {
            1 => CoordinateKind::Projected,
            2 => CoordinateKind::Geographic,
            _ => CoordinateKind::Other,
        };
        let [code, citation] = match kind {
            CoordinateKind::Geographic => [GEOGRAPHIC_CODE, GEOGRAPHIC_CITATION],
            _ => [PROJECTED_CODE, PROJECTED_CITATION],
        };
        let epsg = self.short(code).filter(|&code| code != 0 && code < USER_DEFINED).map(u32::from);
        let name = self.text(citation).or_else(|| self.text(CITATION));
        Some(CoordinateSystem::from_keys(kind, epsg, name))
    }
}

/// Returns where a picture of `size` = [columns, rows] lies; `None` where the file does not say it.
///
/// # Errors
/// Fails with a sentence when the picture is turned, sheared, mirrored, or covers no rectangle.
pub(super) fn read(
    decoder: &mut Decoder<impl Read + Seek>,
    keys: &GeoKeys,
    size: [u32; 2],
) -> Result<Option<Placement>, Flaw> {
    let Some(affine) = Affine::read(decoder)? else { return Ok(None) };
    // Samples at points are at whole numbers of pixels, and pixels reach half a pixel around them.
    let first = if keys.short(RASTER_TYPE) == Some(POINTS) { -0.5 } else { 0.0 };
    let last = dvec2(first + f64::from(size[0]), first + f64::from(size[1]));
    let (a, b) = (affine.at(DVec2::splat(first)), affine.at(last));
    if affine.step.x < 0.0 {
        let problem =
            "its columns run from east to west, and only pictures with east at the right can be read.";
        return Err(Flaw::Syntax(format!("{problem} Warp it first, for example with gdalwarp.")));
    }
    let bounds = Rect::new(a.min(b), a.max(b));
    if !bounds.is_proper() {
        return Err(no_rectangle(affine.step.x, affine.step.y.abs()));
    }
    Ok(Some(Placement { bounds, is_south_up: affine.step.y > 0.0 }))
}

/// The map from columns and rows of the picture to the world: `origin + step * [column, row]`.
struct Affine {
    origin: DVec2,
    step: DVec2,
}

impl Affine {
    fn at(&self, pixel: DVec2) -> DVec2 {
        self.origin + self.step * pixel
    }

    fn read(decoder: &mut Decoder<impl Read + Seek>) -> Result<Option<Self>, Flaw> {
        let mut numbers = |tag| -> Result<Option<Vec<f64>>, Flaw> {
            Ok(decoder.find_tag(tag)?.map(|value| value.into_f64_vec()).transpose()?)
        };
        let scale = numbers(Tag::ModelPixelScaleTag)?;
        let ties = numbers(Tag::ModelTiepointTag)?;
        let matrix = numbers(Tag::ModelTransformationTag)?;
        match (scale.as_deref(), ties.as_deref(), matrix.as_deref()) {
            // Programs ignore the sign of the height, and write a matrix for rows from south to north.
            (Some([width, height, ..]), Some([i, j, _, x, y, ..]), _) => {
                let step = dvec2(*width, -height.abs());
                Ok(Some(Self { origin: dvec2(*x, *y) - step * dvec2(*i, *j), step }))
            }
            (_, _, Some(&[a, b, _, x, c, d, _, y, ..])) => {
                if b.abs() > MOST_TURN * a.abs() || c.abs() > MOST_TURN * d.abs() {
                    return Err(Flaw::Syntax(turned()));
                }
                Ok(Some(Self { origin: dvec2(x, y), step: dvec2(a, d) }))
            }
            (None, Some(ties), None) if ties.len() > 6 => Err(Flaw::Syntax(turned())),
            _ => Ok(None),
        }
    }
}

fn turned() -> String {
    "the picture is turned or warped, and only pictures with north at the top can be read. Warp it first, for example \
     with gdalwarp."
        .into()
}
