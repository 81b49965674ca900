//! The lines of the file.

use std::io;

use base64::prelude::{BASE64_STANDARD, Engine};
use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::super::error::{Flaw, PlacedFlaw};
use super::super::layers::{SavedPolygon, saved_polygon};
use super::super::project::PartNames;
use super::super::project::Project;
use super::super::project::embedded::{SettingsValues, paint_of, settings_of, values_of, write_pixels};
use super::{FORMAT, VERSION};
use meshbrush_core::document::{Edit, RecordedStroke, ReplayedMesh, Settings};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{LayerId, PaintLayers};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror, PathPoint};

/// The first line.
#[derive(Debug, Serialize, Deserialize)]
pub struct SavedHead {
    pub format: String,
    pub version: u64,
    #[serde(default)]
    pub written_by: String,
}

impl SavedHead {
    pub fn of_this_program() -> Self {
        let written_by = concat!("Meshbrush ", env!("CARGO_PKG_VERSION")).into();
        Self { format: FORMAT.into(), version: VERSION, written_by }
    }
}

/// The second line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedStart {
    pub start: RecordedSettings,
    pub gives: RecordedMesh,
}

/// Any other line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedStep {
    /// Counted from 1.
    pub edit: usize,
    pub title: String,
    pub does: SavedEdit,
    pub gives: RecordedMesh,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SavedEdit {
    Stroke(SavedStroke),
    Set(RecordedSettings),
    /// Identifiers of the layers.
    Clear(Vec<u32>),
    CopyPaint {
        from: u32,
        to: u32,
    },
    Undo,
    Redo,
}

/// The mesh after an edit, or the reason why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecordedMesh {
    Mesh {
        /// 32 hexadecimal digits.
        fingerprint: String,
        triangles: usize,
    },
    /// The reason, for a person.
    NoMesh(String),
}

impl From<&ReplayedMesh> for RecordedMesh {
    fn from(mesh: &ReplayedMesh) -> Self {
        match mesh {
            ReplayedMesh::Mesh { fingerprint, triangles } => {
                Self::Mesh { fingerprint: fingerprint.to_string(), triangles: *triangles }
            }
            ReplayedMesh::None(reason) => Self::NoMesh(reason.to_string()),
        }
    }
}

/// Settings, or changes of them.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedSettings {
    settings: SettingsValues,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    polygons: Option<Vec<SavedPolygon>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pixels: Option<String>,
}

impl RecordedSettings {
    /// Returns a whole document.
    ///
    /// # Errors
    /// Fails when a part of it is beyond its limit.
    pub fn whole(project: &Project, names: &mut PartNames) -> io::Result<Self> {
        let pixels = pixels_of(project, names)?;
        let polygons = polygons_of(&project.settings);
        Ok(Self { settings: values_of(&project.settings, names), polygons, pixels })
    }

    /// Returns the change from one state of the settings to another.
    ///
    /// # Errors
    /// Fails as [`Self::whole`] does.
    pub fn change(before: &Settings, after: &Settings, names: &mut PartNames) -> io::Result<Self> {
        let project = Project { settings: after.clone(), paint: PaintLayers::default() };
        let pixels = pixels_of(&project, names)?;
        let (old, mut settings) = (values_of(before, names), values_of(after, names));
        let removed: Vec<_> = old.keys().filter(|key| !settings.contains_key(*key)).cloned().collect();
        settings.retain(|key, value| old.get(key) != Some(value));
        settings.extend(removed.into_iter().map(|key| (key, serde_json::Value::Null)));
        let is_same_outline = before.domain.region() == after.domain.region();
        let polygons = polygons_of(after).filter(|_| !is_same_outline);
        Ok(Self { settings, polygons, pixels })
    }

    /// Returns the whole document.
    ///
    /// # Errors
    /// Fails when a value is missing or out of range, or the pixels are damaged.
    pub fn into_project(self, names: &mut PartNames) -> Result<Project, PlacedFlaw> {
        let pixels = decoded(self.pixels.as_deref())?;
        let polygons = self.polygons.map(polygons_from);
        let settings = settings_of(&self.settings, polygons, pixels.as_deref(), names)?;
        let paint = paint_of(pixels.as_deref(), &settings)?;
        Ok(Project { settings, paint })
    }

    /// Returns the settings after the change.
    ///
    /// # Errors
    /// Fails as [`Self::into_project`] does.
    pub fn apply(&self, before: &Settings, names: &mut PartNames) -> Result<Settings, PlacedFlaw> {
        let mut values = values_of(before, names);
        for (key, value) in &self.settings {
            match value {
                serde_json::Value::Null => _ = values.remove(key),
                value => _ = values.insert(key.clone(), value.clone()),
            }
        }
        let kept = || before.domain.region().map(|region| region.polygons().to_vec());
        let polygons = self.polygons.clone().map(polygons_from).or_else(kept);
        let pixels = decoded(self.pixels.as_deref())?;
        settings_of(&values, polygons, pixels.as_deref(), names)
    }
}

fn polygons_of(settings: &Settings) -> Option<Vec<SavedPolygon>> {
    Some(settings.domain.region()?.polygons().iter().map(saved_polygon).collect())
}

fn polygons_from(saved: Vec<SavedPolygon>) -> Vec<Polygon> {
    let ring = |ring: Vec<[f64; 2]>| ring.into_iter().map(DVec2::from_array).collect();
    saved.into_iter().map(|polygon| polygon.into_iter().map(ring).collect()).collect()
}

fn pixels_of(project: &Project, names: &mut PartNames) -> io::Result<Option<String>> {
    let mut bytes = Vec::new();
    let has_any = write_pixels(&mut bytes, project, names)?;
    Ok(has_any.then(|| BASE64_STANDARD.encode(&bytes)))
}

fn decoded(pixels: Option<&str>) -> Result<Option<Vec<u8>>, Flaw> {
    let flaw = || Flaw::Syntax("\"pixels\" is not in base64.".into());
    pixels.map(|text| BASE64_STANDARD.decode(text).map_err(|_| flaw())).transpose()
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedStroke {
    layer: u32,
    medium: SavedMedium,
    radius: f64,
    hardness: f64,
    strength: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mirror_x: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mirror_y: Option<f64>,
    path: Vec<Vec<f64>>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SavedMedium {
    Risk(f64),
    /// A smaller diameter.
    Finer(f64),
    /// A larger diameter.
    Coarser(f64),
    /// Any diameter.
    Diameter(f64),
    Error(f64),
    Eraser,
}

impl From<&RecordedStroke> for SavedStroke {
    fn from(stroke: &RecordedStroke) -> Self {
        let Brush { medium, radius, hardness, strength } = stroke.brush;
        Self {
            layer: stroke.layer.0,
            medium: medium.into(),
            radius,
            hardness,
            strength,
            mirror_x: stroke.mirror.x,
            mirror_y: stroke.mirror.y,
            path: stroke.path.iter().map(saved_point).collect(),
        }
    }
}

impl SavedStroke {
    /// Returns the stroke, after all checks.
    ///
    /// # Errors
    /// Fails when a number is out of range.
    pub fn checked(&self) -> Result<RecordedStroke, Flaw> {
        let check = |what: &str, value: f64, is_valid: bool| match is_valid {
            true => Ok(value),
            false => Err(Flaw::Syntax(format!("{what} of {value} is out of range."))),
        };
        let share = |what, value| check(what, value, (0.0..=1.0).contains(&value));
        let positive = |what, value: f64| check(what, value, value > 0.0 && value.is_finite());
        let medium = match self.medium {
            SavedMedium::Risk(risk) => Medium::Risk(share("a risk", risk)?),
            SavedMedium::Finer(to) => Medium::Diameter(positive("a diameter", to)?, DiameterChange::Finer),
            SavedMedium::Coarser(to) => {
                Medium::Diameter(positive("a diameter", to)?, DiameterChange::Coarser)
            }
            SavedMedium::Diameter(to) => Medium::Diameter(positive("a diameter", to)?, DiameterChange::Any),
            SavedMedium::Error(to) => Medium::Error(positive("an error", to)?),
            SavedMedium::Eraser => Medium::Eraser,
        };
        let brush = Brush {
            medium,
            radius: positive("a radius", self.radius)?,
            hardness: share("a hardness", self.hardness)?,
            strength: share("a strength", self.strength)?,
        };
        let path = self.path.iter().map(|point| checked_point(point)).collect::<Result<_, _>>()?;
        let mirror = Mirror { x: self.mirror_x, y: self.mirror_y };
        Ok(RecordedStroke { layer: LayerId(self.layer), brush, mirror, path })
    }
}

fn saved_point(point: &PathPoint) -> Vec<f64> {
    let PathPoint { at, size, strength } = *point;
    if (size, strength) == (1.0, 1.0) { at.to_array().to_vec() } else { vec![at.x, at.y, size, strength] }
}

fn checked_point(numbers: &[f64]) -> Result<PathPoint, Flaw> {
    let point = match *numbers {
        [x, y] => Some(PathPoint::from(DVec2::new(x, y))),
        [x, y, size, strength] => Some(PathPoint { at: DVec2::new(x, y), size, strength }),
        _ => None,
    };
    let is_valid =
        |point: &PathPoint| point.is_finite() && point.size >= 0.0 && (0.0..=1.0).contains(&point.strength);
    point.filter(is_valid).ok_or_else(|| {
        let rule = "a point of a path is x and y, or x, y, size and strength; strength is between 0 and 1";
        Flaw::Syntax(format!("{rule}, and this one has {} numbers.", numbers.len()))
    })
}

impl From<Medium> for SavedMedium {
    fn from(medium: Medium) -> Self {
        match medium {
            Medium::Risk(risk) => Self::Risk(risk),
            Medium::Diameter(to, DiameterChange::Finer) => Self::Finer(to),
            Medium::Diameter(to, DiameterChange::Coarser) => Self::Coarser(to),
            Medium::Diameter(to, DiameterChange::Any) => Self::Diameter(to),
            Medium::Error(to) => Self::Error(to),
            Medium::Eraser => Self::Eraser,
        }
    }
}

impl SavedEdit {
    /// Returns the edit as it is written. `before` are the settings before it.
    ///
    /// # Errors
    /// Fails when a part of its settings is beyond its limit.
    pub fn of(edit: &Edit, before: &Settings, names: &mut PartNames) -> io::Result<Self> {
        Ok(match edit {
            Edit::Stroke(stroke) => Self::Stroke((&**stroke).into()),
            Edit::Settings(after) => Self::Set(RecordedSettings::change(before, after, names)?),
            Edit::Clear(layers) => Self::Clear(layers.iter().map(|layer| layer.0).collect()),
            Edit::CopyPaint { from, to } => Self::CopyPaint { from: from.0, to: to.0 },
            Edit::Undo => Self::Undo,
            Edit::Redo => Self::Redo,
        })
    }

    /// Returns the edit of a document with the settings `before`.
    ///
    /// # Errors
    /// Fails when a value is missing or out of range.
    pub fn checked(&self, before: &Settings, names: &mut PartNames) -> Result<Edit, PlacedFlaw> {
        Ok(match self {
            Self::Stroke(stroke) => Edit::Stroke(stroke.checked()?.into()),
            Self::Set(change) => Edit::Settings(change.apply(before, names)?.into()),
            Self::Clear(layers) => Edit::Clear(layers.iter().copied().map(LayerId).collect()),
            Self::CopyPaint { from, to } => Edit::CopyPaint { from: LayerId(*from), to: LayerId(*to) },
            Self::Undo => Edit::Undo,
            Self::Redo => Edit::Redo,
        })
    }
}
