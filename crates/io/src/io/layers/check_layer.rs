use std::path::PathBuf;

use super::checks::{number_where, point, points, positive_length, rect_of, rings};
use super::saved::{SavedDistanceTo, SavedKind, SavedPolygon, SavedQuantity};
use super::spec::usual_name;
use super::{
    DistanceTo, FindFile, KeyFault, KindSpec, LayerSpec, MaskSpec, RasterFile, RasterFormat, RasterReading,
    SavedLayer, SavedShape, SavedThreat, ShapeSpec, Step, ThreatsSpec,
};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{Threat, ThreatError};

/// Finds the files of a recipe; `None` for a layer of a project, which holds all data itself: there `file` is
/// only a name for a person.
type Files<'a> = Option<&'a FindFile<'a>>;

impl SavedLayer {
    /// Checks every value of a layer whose data are in files.
    ///
    /// # Errors
    /// For the first key that does not suit the kind, is missing, or has a value that cannot be used.
    pub fn checked(&self, find: &FindFile) -> Result<LayerSpec, KeyFault> {
        self.spec(Some(find))
    }

    /// Checks every value of a layer of a project: paint and pixels are parts of the project, and everything
    /// else is in place.
    ///
    /// # Errors
    /// As [`Self::checked`].
    pub fn checked_in_project(&self) -> Result<LayerSpec, KeyFault> {
        self.spec(None)
    }

    fn spec(&self, files: Files) -> Result<LayerSpec, KeyFault> {
        let kind = self.kind;
        if let Some(key) = self.given().find(|key| !kind.keys().contains(key)) {
            let (word, keys) = (kind.word(), kind.keys().join(", "));
            return Err(KeyFault::key(
                key,
                format!("a layer of the kind \"{word}\" has no `{key}`; its own keys are {keys}."),
            ));
        }
        Ok(LayerSpec {
            name: self.name.clone().unwrap_or_else(|| usual_name(kind).to_owned()),
            visible: self.visible,
            locked: self.locked,
            combine: self.combine.into(),
            mask: self.mask(files)?,
            kind: match kind {
                SavedKind::Paint => self.paint(files)?,
                SavedKind::Formula => self.formula()?,
                SavedKind::Raster => self.raster(files)?,
                SavedKind::Threats => self.threats(files)?,
                SavedKind::Distance => self.distance(files)?,
                SavedKind::Corridor => self.corridor(files)?,
                SavedKind::Band => self.band(files)?,
            },
        })
    }

    fn mask(&self, files: Files) -> Result<Option<MaskSpec>, KeyFault> {
        match (&self.mask, &self.mask_file) {
            (None, None) => Ok(None),
            (Some(_), Some(_)) => {
                Err(KeyFault::key("mask_file", "a layer has `mask` or `mask_file`, not both."))
            }
            (None, Some(file)) => Ok(Some(MaskSpec::File(found("mask_file", file, files)?))),
            (Some(polygons), None) => {
                if polygons.is_empty() {
                    return Err(KeyFault::value(
                        "mask",
                        "a mask needs a polygon at least; leave it out to mask nothing.",
                    ));
                }
                each("mask", polygons, |polygon: &SavedPolygon| rings(polygon))
                    .map(|polygons| Some(MaskSpec::Polygons(polygons)))
            }
        }
    }

    fn paint(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let quantity = self.needed("quantity", self.quantity)?.into();
        if self.file.is_none() && self.layer.is_some() {
            return Err(KeyFault::key(
                "layer",
                "`layer` names a layer of the project `file`, which is missing.",
            ));
        }
        let path = self.file.as_ref().map(|_| self.found(files)).transpose()?;
        let own_name = self.name.as_deref().unwrap_or(usual_name(self.kind));
        let layer = self.layer.as_deref().unwrap_or(own_name);
        Ok(KindSpec::Paint { quantity, from: path.map(|path| (path, layer.to_owned())) })
    }

    fn formula(&self) -> Result<KindSpec, KeyFault> {
        let quantity = self.needed("quantity", self.quantity)?.into();
        let text = self.needed("formula", self.formula.as_deref())?;
        Ok(KindSpec::Formula { quantity, formula: compiled("formula", text)? })
    }

    fn raster(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let raster = self.raster_file(files)?;
        let reading = match (self.read_as, &self.curve) {
            (Some(SavedQuantity::Risk), None) => RasterReading::Risk,
            (Some(SavedQuantity::Diameter), None) => RasterReading::Diameter,
            (None, Some(knots)) => RasterReading::Curve(curve(knots)?),
            (Some(_), Some(_)) => {
                return Err(KeyFault::key("curve", "a raster has `as` or `curve`, not both."));
            }
            (None, None) => {
                let needs = "says what its values mean: as = \"risk\", as = \"diameter\", or a curve";
                return Err(self.missing(&format!("{needs}, as in curve = [[0, 0.1], [50, 2]]")));
            }
        };
        Ok(KindSpec::Raster { raster, reading })
    }

    fn threats(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let spec = match (&self.file, &self.threats) {
            (Some(_), None) => ThreatsSpec::File(self.found(files)?),
            (None, Some(list)) => ThreatsSpec::List(checked_threats(list)?),
            (Some(_), Some(_)) => {
                return Err(KeyFault::key(
                    "threats",
                    "the threats are in `file` or in `threats`, not in both.",
                ));
            }
            (None, None) => {
                return Err(
                    self.missing("needs `file`, a .csv, or `threats`, a list of { x, y, range, peak, law }")
                );
            }
        };
        Ok(KindSpec::Threats(spec))
    }

    fn distance(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let to = match (self.to, &self.file, &self.shapes) {
            (Some(SavedDistanceTo::Outline), None, None) => DistanceTo::Outline,
            (None, Some(_), None) => DistanceTo::File(self.found(files)?),
            (None, file, Some(shapes)) if file.is_none() || files.is_none() => {
                let name = file.clone().unwrap_or_default();
                DistanceTo::Shapes { name, shapes: each("shapes", shapes, SavedShape::checked)? }
            }
            (None, None, None) => {
                return Err(self.missing("needs to = \"outline\", `file`, a .geojson, or `shapes`"));
            }
            (to, _, shapes) => {
                let key = if to.is_some() {
                    "to"
                } else if shapes.is_some() {
                    "shapes"
                } else {
                    "file"
                };
                return Err(KeyFault::key(key, "a distance has one of `to`, `file` and `shapes`."));
            }
        };
        self.growing(to)
    }

    fn corridor(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let along = match (&self.file, &self.shapes) {
            (Some(_), None) => DistanceTo::File(self.found(files)?),
            (None, Some(shapes)) => DistanceTo::Shapes {
                name: String::new(),
                shapes: each("shapes", shapes, SavedShape::checked)?,
            },
            (None, None) => return Err(self.missing("needs `file`, a .geojson, or `shapes`")),
            (Some(_), Some(_)) => {
                return Err(KeyFault::key("shapes", "a corridor has one of `file` and `shapes`."));
            }
        };
        let width = self.length("width", self.width)?;
        self.growing(DistanceTo::Corridor { along: Box::new(along), width })
    }

    /// A target diameter that grows with a distance.
    fn growing(&self, to: DistanceTo) -> Result<KindSpec, KeyFault> {
        let at_zero = self.length("at_zero", self.at_zero)?;
        let slope = self.needed("slope", self.slope)?;
        let rule = "the growth by unit of distance must be 0 or more, and finite";
        number_where(slope, slope >= 0.0, rule).map_err(|sentence| KeyFault::value("slope", sentence))?;
        let range = self.range.map(|range| self.length("range", Some(range))).transpose()?;
        Ok(KindSpec::Distance { to, at_zero, slope, range })
    }

    fn band(&self, files: Files) -> Result<KindSpec, KeyFault> {
        let raster = self.raster_file(files)?;
        let between @ [least, greatest] = self.needed("between", self.between)?;
        if !(least.is_finite() && greatest.is_finite()) || least > greatest {
            let sentence = "write two finite numbers, the least value first.";
            return Err(KeyFault::value("between", sentence));
        }
        Ok(KindSpec::Band { raster, between, diameter: self.length("diameter", self.diameter)? })
    }

    fn raster_file(&self, files: Files) -> Result<RasterFile, KeyFault> {
        let path = self.found(files)?;
        if files.is_none() {
            return Ok(RasterFile { path, format: RasterFormat::Part, bounds: None });
        }
        let format = RasterFormat::of(&path).map_err(|sentence| KeyFault::value("file", sentence))?;
        let bounds = self.bounds.map(rect_of).transpose();
        let bounds = bounds.map_err(|sentence| KeyFault::value("bounds", sentence))?;
        Ok(RasterFile { path, format, bounds })
    }

    /// The file that holds the data.
    fn found(&self, files: Files) -> Result<PathBuf, KeyFault> {
        found("file", self.needed("file", self.file.as_deref())?, files)
    }

    fn length(&self, key: &'static str, value: Option<f64>) -> Result<f64, KeyFault> {
        let value = self.needed(key, value)?;
        positive_length(value).map_err(|sentence| KeyFault::value(key, sentence))
    }

    fn needed<T>(&self, key: &'static str, value: Option<T>) -> Result<T, KeyFault> {
        value.ok_or_else(|| self.missing(&format!("needs `{key}`")))
    }

    fn missing(&self, needs: &str) -> KeyFault {
        KeyFault::entry("kind", format!("a layer of the kind \"{}\" {needs}.", self.kind.word()))
    }
}

/// The file that a key names.
fn found(key: &'static str, name: &str, files: Files) -> Result<PathBuf, KeyFault> {
    let found = files.map_or_else(|| Ok(name.into()), |find| find(name));
    found.map_err(|sentence| KeyFault::entry(key, sentence))
}

/// Compiles a formula.
///
/// # Errors
/// With the lines that point at the mistake.
pub fn compiled(key: &'static str, text: &str) -> Result<Formula, KeyFault> {
    Formula::parse(text).map_err(|mistake| {
        let pointer = Some(mistake.pointer().to_owned());
        KeyFault { pointer, ..KeyFault::value(key, mistake.to_string()) }
    })
}

/// Checks each entry of a list.
///
/// # Errors
/// For the first one that cannot be used, with its place in the list.
pub fn each<T, U>(
    key: &'static str,
    list: &[T],
    check: impl Fn(&T) -> Result<U, String>,
) -> Result<Vec<U>, KeyFault> {
    let checked = |(index, entry)| {
        check(entry).map_err(|sentence| KeyFault::value(key, sentence).at(Step::Index(index)))
    };
    list.iter().enumerate().map(checked).collect()
}

fn curve(knots: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, KeyFault> {
    if knots.is_empty() {
        return Err(KeyFault::value("curve", "a curve needs one pair [value, diameter] at least."));
    }
    each("curve", knots, |&[value, diameter]| {
        number_where(value, true, "a value of the raster must be finite")?;
        positive_length(diameter).map(|_| [value, diameter])
    })?;
    let unordered = knots.windows(2).position(|pair| pair[0][0] >= pair[1][0]);
    if let Some(first) = unordered {
        let sentence = "the values of a curve must ascend, and none may come twice.";
        return Err(KeyFault::value("curve", sentence).at(Step::Index(first + 1)));
    }
    Ok(knots.to_vec())
}

fn checked_threats(list: &[SavedThreat]) -> Result<Vec<Threat>, KeyFault> {
    let checked = |(index, saved): (usize, &SavedThreat)| {
        let threat = Threat::from(*saved);
        let fault = |error: ThreatError| {
            let key = match error {
                ThreatError::Place { x, .. } if !x.is_finite() => "x",
                ThreatError::Place { .. } => "y",
                ThreatError::Range(_) => "range",
                ThreatError::Peak(_) => "peak",
            };
            KeyFault::value("threats", error.to_string()).at(Step::Index(index)).at(Step::Key(key))
        };
        threat.check().map(|()| threat).map_err(fault)
    };
    list.iter().enumerate().map(checked).collect()
}

impl SavedShape {
    fn checked(&self) -> Result<ShapeSpec, String> {
        match self {
            Self::Point(at) => point(*at).map(ShapeSpec::Point),
            Self::Line(along) => points(along, 2, "a line").map(ShapeSpec::Line),
            Self::Polygon(polygon) => rings(polygon).map(ShapeSpec::Polygon),
        }
    }
}
