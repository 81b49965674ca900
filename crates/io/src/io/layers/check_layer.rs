use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::checks::{number_where, point, points, positive_length, rect_of, rings};
use super::keys::kinds_with;
use super::{RasterFile, SavedKind, SavedLayer, SavedPolygon, SavedQuantity, SavedShape, SavedThreat};
use crate::io::{KeyFault, RasterFormat};
use meshbrush_core::domain::{PieceChoice, Polygon};
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_core::layers::{
    DepthSizes, DistanceTo, FeatureSize, FormulaLayer, LayerKind, MedialAxis, MedialBalls, Quantity,
    RasterReading, ShapeList, Straits, SurfaceGoal, SurfaceNorm, Threat, ThreatError, ValueCurve,
};

/// Finds a file by the name that a text gives it. Errors are sentences.
pub type FindFile<'a> = dyn Fn(&str) -> Result<PathBuf, String> + 'a;

/// The rule for keys that say what a distance is measured to.
const ONE_TARGET: &str = "a distance has one of `to`, `file`, `shapes`, and `pieces` with `types`.";

/// Where the data of a layer are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// In files, or in place.
    InFiles,
    /// In the project that the layer belongs to: pixels and paint in parts, everything else in place. `file`
    /// is only a name for a person.
    InProject,
}

/// The kind of a layer with its checked values; files were not read.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckedKind {
    /// A kind that needs no further data.
    Complete(LayerKind),
    /// Values by pixel, and what they mean.
    Raster(RasterReading),
    /// Points with a range; none where they are in a file.
    Threats(Option<Vec<Threat>>),
    /// A diameter that grows with the distance.
    Distance(CheckedShapes, Growth),
    /// A diameter that grows with the distance from a strip of this width, in world units.
    Corridor(CheckedShapes, Growth, f64),
    /// One diameter, in world units, where a raster's value lies between two numbers.
    Band([f64; 2], f64),
    /// Depths of water.
    Depth(DepthSizes),
    /// The values of a raster as a surface.
    Surface(SurfaceGoal, SurfaceNorm),
}

/// The target of a distance.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckedShapes {
    /// The boundary of the domain, or a part of it.
    Boundary(DistanceTo),
    /// The shapes of the layer's file.
    File,
    /// Shapes in place.
    InPlace(ShapeList),
}

/// How a target diameter grows with a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Target diameter at distance 0, in world units.
    pub at_zero: f64,
    /// Growth of the target diameter by unit of distance, dimensionless.
    pub slope: f64,
    /// The distance beyond which nothing is asked for, in world units; infinite without a limit.
    pub range: f64,
}

impl SavedLayer {
    /// Checks every value.
    ///
    /// # Errors
    /// Fails for the first key that does not suit the kind, is missing, or has a value that cannot be used.
    pub fn checked(&self, stored: Stored) -> Result<CheckedKind, KeyFault> {
        let kind = self.kind;
        if let Some(key) = self.given().find(|key| !kind.keys().contains(key)) {
            let (word, keys, others) = (kind.word(), kind.keys().join(", "), kinds_with(key).join(", "));
            return Err(KeyFault::key(
                key,
                format!(
                    "a layer of the kind \"{word}\" has no `{key}`; its own keys are {keys}. Kinds with `{key}`: {others}."
                ),
            ));
        }
        self.mask_in_place()?;
        Ok(match kind {
            SavedKind::Paint => self.paint()?,
            SavedKind::Formula => self.checked_formula()?,
            SavedKind::Raster => self.raster(stored)?,
            SavedKind::Threats => self.checked_threats()?,
            SavedKind::Distance => CheckedKind::Distance(self.distance_to(stored)?, self.growth()?),
            SavedKind::Corridor => {
                let along = self.along()?;
                let width = self.length("width", self.width)?;
                CheckedKind::Corridor(along, self.growth()?, width)
            }
            SavedKind::Band => self.band(stored)?,
            SavedKind::Depth => {
                self.check_raster_file(stored)?;
                CheckedKind::Depth(self.depth_sizes()?)
            }
            SavedKind::Surface => self.checked_surface(stored)?,
            SavedKind::Straits => {
                let (across, between) = self.across_widths()?;
                let found = MedialBalls::unknown(between);
                CheckedKind::Complete(LayerKind::Straits(Straits { across, found }))
            }
            SavedKind::FeatureSize => {
                let (across, between) = self.across_widths()?;
                let found = MedialAxis::unknown(between);
                CheckedKind::Complete(LayerKind::FeatureSize(FeatureSize { across, found }))
            }
        })
    }

    /// Returns the polygons of the mask, if they are in place.
    pub(super) fn mask_in_place(&self) -> Result<Option<Vec<Polygon>>, KeyFault> {
        match (&self.mask, &self.mask_file) {
            (None, _) => Ok(None),
            (Some(_), Some(_)) => {
                Err(KeyFault::key("mask_file", "a layer has `mask` or `mask_file`, not both."))
            }
            (Some(polygons), None) if polygons.is_empty() => {
                Err(KeyFault::value("mask", "a mask needs a polygon at least; leave it out to mask nothing."))
            }
            (Some(polygons), None) => {
                each("mask", polygons, |polygon: &SavedPolygon| rings(polygon)).map(Some)
            }
        }
    }

    fn paint(&self) -> Result<CheckedKind, KeyFault> {
        let quantity = self.needed("quantity", self.quantity)?;
        if self.file.is_none() && self.layer.is_some() {
            return Err(KeyFault::key(
                "layer",
                "`layer` names a layer of the project `file`, which is missing.",
            ));
        }
        Ok(CheckedKind::Complete(LayerKind::paint(quantity.into())))
    }

    fn checked_formula(&self) -> Result<CheckedKind, KeyFault> {
        let quantity = self.needed("quantity", self.quantity)?.into();
        let parse = match quantity {
            Quantity::Diameter => Formula::parse_of_size,
            Quantity::Risk | Quantity::Error => Formula::parse,
        };
        let formula = compiled("formula", self.needed("formula", self.formula.as_deref())?, parse)?;
        Ok(CheckedKind::Complete(LayerKind::Formula(FormulaLayer { quantity, formula })))
    }

    fn raster(&self, stored: Stored) -> Result<CheckedKind, KeyFault> {
        self.check_raster_file(stored)?;
        let reading = match (self.read_as, &self.curve) {
            (Some(SavedQuantity::Risk), None) => RasterReading::Risk,
            (Some(SavedQuantity::Diameter), None) => RasterReading::Diameter,
            (Some(SavedQuantity::Error), None) => RasterReading::Error,
            (None, Some(knots)) => RasterReading::Curve(Arc::new(curve(knots)?)),
            (Some(_), Some(_)) => {
                return Err(KeyFault::key("curve", "a raster has `as` or `curve`, not both."));
            }
            (None, None) => {
                let needs =
                    "says what its values mean: as = \"risk\", as = \"diameter\", as = \"error\", or a curve";
                return Err(self.missing(&format!("{needs}, as in curve = [[0, 0.1], [50, 2]]")));
            }
        };
        Ok(CheckedKind::Raster(reading))
    }

    fn checked_threats(&self) -> Result<CheckedKind, KeyFault> {
        match (&self.file, &self.threats) {
            (Some(_), None) => Ok(CheckedKind::Threats(None)),
            (None, Some(list)) => threats(list).map(|list| CheckedKind::Threats(Some(list))),
            (Some(_), Some(_)) => {
                Err(KeyFault::key("threats", "the threats are in `file` or in `threats`, not in both."))
            }
            (None, None) => {
                let needs = "needs `file`, a .csv, or `threats`, a list of { x, y, range, peak, law }";
                Err(self.missing(needs))
            }
        }
    }

    fn distance_to(&self, stored: Stored) -> Result<CheckedShapes, KeyFault> {
        let chosen = self.chosen_pieces();
        if chosen.is_some() && (self.to.is_some() || self.file.is_some() || self.shapes.is_some()) {
            let key = if self.pieces.is_some() { "pieces" } else { "types" };
            return Err(KeyFault::key(key, ONE_TARGET));
        }
        match (self.to, &self.file, &self.shapes) {
            (None, None, None) if let Some(chosen) = chosen => {
                Ok(CheckedShapes::Boundary(DistanceTo::Pieces(chosen)))
            }
            (Some(to), None, None) => Ok(CheckedShapes::Boundary(to.into())),
            (None, Some(_), None) => Ok(CheckedShapes::File),
            (None, file, Some(shapes)) if file.is_none() || stored == Stored::InProject => shapes_of(shapes),
            (None, None, None) => Err(self.missing(
                "needs to = \"outline\" or to = \"coasts\", `pieces` or `types` of the boundary, `file`, a .geojson, \
                 .shp or .gpkg, or `shapes`",
            )),
            (to, _, shapes) => {
                let key = if to.is_some() {
                    "to"
                } else if shapes.is_some() {
                    "shapes"
                } else {
                    "file"
                };
                Err(KeyFault::key(key, ONE_TARGET))
            }
        }
    }

    /// Returns the pieces of the boundary that `pieces` and `types` choose, if there is one of them.
    fn chosen_pieces(&self) -> Option<PieceChoice> {
        let types = self.types.iter().flatten().copied().map(Into::into).collect();
        let is_given = self.pieces.is_some() || self.types.is_some();
        is_given.then(|| PieceChoice { names: self.pieces.clone().unwrap_or_default(), types })
    }

    fn along(&self) -> Result<CheckedShapes, KeyFault> {
        match (&self.file, &self.shapes) {
            (Some(_), None) => Ok(CheckedShapes::File),
            (None, Some(shapes)) => shapes_of(shapes),
            (None, None) => Err(self.missing("needs `file`, a .geojson, .shp or .gpkg, or `shapes`")),
            (Some(_), Some(_)) => Err(KeyFault::key("shapes", "a corridor has one of `file` and `shapes`.")),
        }
    }

    fn growth(&self) -> Result<Growth, KeyFault> {
        let at_zero = self.length("at_zero", self.at_zero)?;
        let slope = self.needed("slope", self.slope)?;
        let rule = "the growth by unit of distance must be 0 or more, and finite";
        number_where(slope, slope >= 0.0, rule).map_err(|fault| fault.within("slope"))?;
        let range = self.range.map(|range| self.length("range", Some(range))).transpose()?;
        Ok(Growth { at_zero, slope, range: range.unwrap_or(f64::INFINITY) })
    }

    fn band(&self, stored: Stored) -> Result<CheckedKind, KeyFault> {
        self.check_raster_file(stored)?;
        let between @ [least, greatest] = self.needed("between", self.between)?;
        if !(least.is_finite() && greatest.is_finite()) || least > greatest {
            let sentence = "write two finite numbers, the least value first.";
            return Err(KeyFault::value("between", sentence));
        }
        Ok(CheckedKind::Band(between, self.length("diameter", self.diameter)?))
    }

    /// Returns the number of triangles across water, and the least and the greatest width of it.
    fn across_widths(&self) -> Result<(f64, [f64; 2]), KeyFault> {
        let across = self.needed("across", self.across)?;
        number_where(across, across >= 1.0, "a number of triangles must be 1 or more, and finite")
            .map_err(|fault| fault.within("across"))?;
        let from = self.length("width_from", self.width_from)?;
        let to = self.length("width_to", self.width_to)?;
        number_where(to, to > from, "it must be above width_from")
            .map_err(|fault| fault.within("width_to"))?;
        Ok((across, [from, to]))
    }

    pub(super) fn check_raster_file(&self, stored: Stored) -> Result<(), KeyFault> {
        self.needed("file", self.file.as_ref())?;
        if stored == Stored::InFiles { self.raster_file().map(|_| ()) } else { Ok(()) }
    }

    /// Returns the file with its pixels.
    ///
    /// # Errors
    /// Fails when it is missing, or is no raster.
    pub fn raster_file(&self) -> Result<RasterFile, KeyFault> {
        let path = self.needed("file", self.file.clone())?;
        let bounds = self.bounds.map(rect_of).transpose().map_err(|fault| fault.within("bounds"))?;
        match RasterFormat::from_path(&path) {
            Ok(format) => Ok(RasterFile { path, format, bounds }),
            Err(rule) => Err(KeyFault { given: Some(String::new()), ..KeyFault::value("file", rule) }),
        }
    }

    fn length(&self, key: &'static str, value: Option<f64>) -> Result<f64, KeyFault> {
        let value = self.needed(key, value)?;
        positive_length(value).map_err(|fault| fault.within(key))
    }

    pub(super) fn needed<T>(&self, key: &'static str, value: Option<T>) -> Result<T, KeyFault> {
        value.ok_or_else(|| self.missing(&format!("needs `{key}`")))
    }

    pub(super) fn missing(&self, needs: &str) -> KeyFault {
        KeyFault::entry("kind", format!("a layer of the kind \"{}\" {needs}.", self.kind.word()))
    }

    /// Returns the name of its file without folders, for a person; empty where there is none.
    pub fn file_name(&self) -> String {
        let path = self.file.as_deref().unwrap_or(Path::new(""));
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    }
}

/// Compiles a formula, as `parse` does.
///
/// # Errors
/// Fails with the lines that point at the mistake.
pub fn compiled(
    key: &'static str,
    text: &str,
    parse: fn(&str) -> Result<Formula, ParseError>,
) -> Result<Formula, KeyFault> {
    parse(text).map_err(|mistake| KeyFault::mistake(key, text, 0, &mistake))
}

/// Checks each entry of a list.
///
/// # Errors
/// Fails for the first one that cannot be used, with its place in the list.
pub fn each<T, U>(
    key: &'static str,
    list: &[T],
    check: impl Fn(&T) -> Result<U, KeyFault>,
) -> Result<Vec<U>, KeyFault> {
    let checked = |(index, entry)| check(entry).map_err(|fault| fault.within(index).within(key));
    list.iter().enumerate().map(checked).collect()
}

fn curve(knots: &[[f64; 2]]) -> Result<ValueCurve, KeyFault> {
    if knots.is_empty() {
        return Err(KeyFault::value("curve", "a curve needs one pair [value, diameter] at least."));
    }
    each("curve", knots, |&[value, diameter]| {
        number_where(value, true, "a value of the raster must be finite")?;
        positive_length(diameter).map(|_| ())
    })?;
    let unordered = knots.windows(2).position(|pair| pair[0][0] >= pair[1][0]);
    if let Some(first) = unordered {
        let sentence = "the values of a curve must ascend, and none may come twice.";
        return Err(KeyFault::value("curve", sentence).at(first + 1));
    }
    ValueCurve::new(knots.to_vec()).map_err(|error| KeyFault::value("curve", error.to_string()))
}

fn threats(list: &[SavedThreat]) -> Result<Vec<Threat>, KeyFault> {
    each("threats", list, |saved| {
        let threat = Threat::from(*saved);
        let key = |error: &ThreatError| match error {
            ThreatError::Place { x, .. } if !x.is_finite() => "x",
            ThreatError::Place { .. } => "y",
            ThreatError::Range(_) => "range",
            ThreatError::Peak(_) => "peak",
        };
        threat.check().map(|()| threat).map_err(|error| KeyFault::value(key(&error), error.to_string()))
    })
}

fn shapes_of(shapes: &[SavedShape]) -> Result<CheckedShapes, KeyFault> {
    let mut list = ShapeList::default();
    each("shapes", shapes, |shape| shape.check())?;
    for shape in shapes {
        match shape {
            SavedShape::Point(at) => list.points.push((*at).into()),
            SavedShape::Line(along) => list.lines.push(along.iter().copied().map(Into::into).collect()),
            SavedShape::Polygon(polygon) => list.polygons.push(rings(polygon)?),
        }
    }
    Ok(CheckedShapes::InPlace(list))
}

impl SavedShape {
    fn check(&self) -> Result<(), KeyFault> {
        match self {
            Self::Point(at) => point(*at).map(|_| ()),
            Self::Line(along) => points(along, 2, "a line").map(|_| ()),
            Self::Polygon(polygon) => rings(polygon).map(|_| ()),
        }
    }
}
