//! `settings.json`: the part of a project in readable text.

use std::io::{self, Write};
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::super::Flaw;
use super::super::error::PlacedFlaw;
use super::super::json::{self, JsonFlaw};
use super::super::settings::{SavedName, SavedPieceType, SavedRule, SavedUnit, marks_of, saved_marks};
use super::part_names::{PartData, PartNames};
use super::part_reader::PartReader;
use super::paths::StoredPaths;
use super::saved_background::SavedBackground;
use super::saved_cut::SavedCut;
use super::stored_layers::{StoredLayer, check_raster_sizes};
use super::stored_lines::StoredLine;
use super::{FORMAT, VERSION};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain, DomainShape, OutlineOnEarth};
use meshbrush_core::earth::Projection;
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::raster::is_raster_size;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts, MOST_TRIANGLES};
use meshbrush_mesh::text::{Grouped, Number, excerpt};

/// The fields that every version of the format has.
#[derive(Deserialize)]
struct Head {
    format: String,
    version: u64,
    #[serde(default)]
    written_by: String,
}

/// The content of the file; lengths are in world units.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Saved {
    format: String,
    version: u64,
    written_by: String,
    name: String,
    /// Missing where there is none.
    #[serde(default, skip_serializing_if = "SavedUnit::is_none")]
    unit: SavedUnit,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    background: Option<SavedBackground>,
    pub(super) domain: StoredDomain,
    boundary: SavedBoundary,
    cleaning: SavedCleaning,
    #[serde(default, skip_serializing_if = "SavedMarks::is_empty")]
    boundary_marks: SavedMarks,
    /// x and y of each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pins: Vec<[f64; 2]>,
    /// The part with the pins, where there are many.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pins_part: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    lines: Vec<StoredLine>,
    #[serde(default, skip_serializing_if = "StoredPaths::is_empty")]
    paths: StoredPaths,
    spacing: f64,
    transfer: SavedTransfer,
    /// From the bottom to the top.
    layers: Vec<StoredLayer>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gradation: Option<f64>,
    rule: SavedRule,
    max_triangles: usize,
    /// The memory budget in bytes.
    max_memory: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    max_level: Option<u32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredDomain {
    /// x and y of the lower left corner, then of the upper right one.
    pub(super) bounds: [f64; 4],
    shape: StoredShape,
    /// The part with its polygons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    polygons: Option<String>,
    /// As PROJ writes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    projection: Option<String>,
    /// What cuts polygons off from their surroundings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    cuts: Vec<SavedCut>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StoredShape {
    Whole,
    Formula(String),
    /// Polygons, which are a part of their own.
    Polygons,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SavedBoundary {
    Report,
    #[serde(rename = "fitted_with_diameter")]
    Fitted(f64),
    #[serde(rename = "on_outline_with_diameter")]
    OnOutline(f64),
}

#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedMarks {
    /// x and y of each place.
    splits: Vec<[f64; 2]>,
    names: Vec<SavedName>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    types: Vec<SavedPieceType>,
}

impl SavedMarks {
    fn of(marks: &BoundaryMarks) -> Self {
        let (splits, names, types) = saved_marks(marks);
        Self { splits, names, types }
    }

    fn load(&self) -> BoundaryMarks {
        marks_of(&self.splits, &self.names, &self.types)
    }

    fn is_empty(&self) -> bool {
        self.splits.is_empty() && self.names.is_empty() && self.types.is_empty()
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedCleaning {
    parts: StoredParts,
    keep_pinches: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    improve_boundary: bool,
}

/// A share is a table here and a plain number in recipes.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StoredParts {
    All,
    Largest,
    WithShare(f64),
}

impl From<Cleaning> for SavedCleaning {
    fn from(cleaning: Cleaning) -> Self {
        let parts = match cleaning.parts {
            KeptParts::All => StoredParts::All,
            KeptParts::Largest => StoredParts::Largest,
            KeptParts::Share(share) => StoredParts::WithShare(share),
        };
        let Cleaning { keeps_pinches: keep_pinches, improves_boundary: improve_boundary, .. } = cleaning;
        Self { parts, keep_pinches, improve_boundary }
    }
}

impl From<SavedCleaning> for Cleaning {
    fn from(saved: SavedCleaning) -> Self {
        let parts = match saved.parts {
            StoredParts::All => KeptParts::All,
            StoredParts::Largest => KeptParts::Largest,
            StoredParts::WithShare(share) => KeptParts::Share(share),
        };
        let SavedCleaning { keep_pinches: keeps_pinches, improve_boundary: improves_boundary, .. } = saved;
        Self { parts, keeps_pinches, improves_boundary }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedTransfer {
    h_min: f64,
    /// The smallest diameter where it is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    h_risk: Option<f64>,
    h_max: f64,
    shape: f64,
}

/// Writes the text of the settings, whose rasters and pictures have the given names.
///
/// # Errors
/// Fails with the errors of `out`.
pub(super) fn write(out: &mut dyn Write, settings: &Settings, names: &PartNames) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Saved::of(settings, names))?;
    writeln!(out)
}

pub(super) fn checked_size(size: [u32; 2]) -> Result<[u32; 2], Flaw> {
    let [columns, rows] = size.map(u64::from);
    if is_raster_size(size) { Ok(size) } else { Err(Flaw::Size { columns, rows }) }
}

impl SavedTransfer {
    fn of(Transfer { h_min, h_risk, h_max, shape }: Transfer) -> Self {
        Self { h_min, h_risk: (h_risk != h_min).then_some(h_risk), h_max, shape }
    }
}

impl From<SavedTransfer> for Transfer {
    fn from(SavedTransfer { h_min, h_risk, h_max, shape }: SavedTransfer) -> Self {
        Self { h_min, h_risk: h_risk.unwrap_or(h_min), h_max, shape }
    }
}

impl Saved {
    /// Returns the settings, whose parts have the given names.
    pub(super) fn of(settings: &Settings, names: &PartNames) -> Self {
        let name_of = |data: PartData| names.of(&data).map(str::to_owned);
        let pins_part = PartData::of_pins(&settings.pins).and_then(name_of);
        Self {
            format: FORMAT.into(),
            version: VERSION,
            written_by: concat!("Meshbrush ", env!("CARGO_PKG_VERSION")).into(),
            name: settings.name.clone(),
            unit: settings.unit.into(),
            background: settings.background.as_ref().map(|background| SavedBackground::of(background, names)),
            domain: StoredDomain {
                bounds: corners(settings.domain.bounds),
                shape: match &settings.domain.shape {
                    DomainShape::Whole => StoredShape::Whole,
                    DomainShape::Formula(shape) => StoredShape::Formula(shape.formula().source().into()),
                    DomainShape::Region(_) => StoredShape::Polygons,
                },
                polygons: settings.domain.region().cloned().map(PartData::Region).and_then(name_of),
                projection: settings.domain.projection.map(|projection| projection.to_string()),
                cuts: settings.domain.cuts().iter().map(SavedCut::of).collect(),
            },
            boundary: match settings.boundary {
                BoundaryTreatment::Report => SavedBoundary::Report,
                BoundaryTreatment::Fitted { diameter } => SavedBoundary::Fitted(diameter),
                BoundaryTreatment::OnOutline { diameter } => SavedBoundary::OnOutline(diameter),
            },
            cleaning: settings.cleaning.into(),
            boundary_marks: SavedMarks::of(&settings.boundary_marks),
            pins: match &pins_part {
                Some(_) => Vec::new(),
                None => settings.pins.iter().map(DVec2::to_array).collect(),
            },
            pins_part,
            lines: settings.lines.iter().map(StoredLine::of).collect(),
            paths: StoredPaths::of(&settings.paths, names),
            spacing: settings.spacing,
            transfer: SavedTransfer::of(settings.transfer),
            layers: settings.layers.iter().map(|layer| StoredLayer::of(layer, names)).collect(),
            gradation: settings.gradation,
            rule: settings.rule.into(),
            max_triangles: settings.max_triangles,
            max_memory: settings.max_memory as u64,
            max_level: settings.max_level,
        }
    }

    /// Reads the text.
    ///
    /// # Errors
    /// Fails when it is not valid, or of a newer version: then the error says by which program.
    pub(super) fn parse(text: &[u8]) -> Result<Self, PlacedFlaw> {
        let head: Head = json::parse(text).map_err(placed)?;
        if head.format != FORMAT {
            return Err(Flaw::Syntax(format!(
                "its format is \"{}\" instead of {FORMAT:?}.",
                excerpt(40, &head.format)
            ))
            .into());
        }
        if head.version > VERSION {
            let by = if head.written_by.is_empty() {
                "a newer program".into()
            } else {
                excerpt(40, &head.written_by)
            };
            return Err(Flaw::Syntax(format!(
                "the project was written by {by} in version {} of its format, and this program ({}) reads up to version \
                 {VERSION}. Open it with a newer Meshbrush.",
                head.version,
                env!("CARGO_PKG_VERSION"),
            ))
            .into());
        }
        json::parse(text).map_err(placed)
    }

    /// Returns the settings, after all checks.
    pub(super) fn into_settings(self, parts: &mut PartReader) -> Result<Settings, PlacedFlaw> {
        if !(2..=MOST_TRIANGLES).contains(&self.max_triangles) {
            return Err(Flaw::Syntax(format!(
                "\"max_triangles\" is {}, and a budget must be between 2 and {}.",
                Grouped(self.max_triangles),
                Grouped(MOST_TRIANGLES)
            ))
            .into());
        }
        let bounds = rect("domain", self.domain.bounds)?;
        let projection = self.domain.projection.as_deref().map(str::parse::<Projection>);
        let projection = projection.transpose().map_err(sentence)?;
        let shape = match self.domain.shape {
            StoredShape::Whole => DomainShape::Whole,
            StoredShape::Formula(text) => formula("domain", &text)?.into(),
            StoredShape::Polygons => {
                let on_earth = OutlineOnEarth { file: None, projection, frame: None };
                let cuts = self.domain.cuts.iter().map(SavedCut::load).collect::<Result<_, _>>()?;
                parts.domain(self.domain.polygons.as_deref(), bounds, &on_earth, cuts)?
            }
        };
        check_raster_sizes(&self.layers)?;
        let layers =
            self.layers.into_iter().map(|layer| layer.into_layer(parts)).collect::<Result<_, _>>()?;
        let background = self.background.map(|saved| saved.load(parts)).transpose()?;
        let settings = Settings {
            name: self.name,
            unit: self.unit.into(),
            background,
            domain: Domain { bounds, shape, projection },
            boundary: match self.boundary {
                SavedBoundary::Report => BoundaryTreatment::Report,
                SavedBoundary::Fitted(diameter) => BoundaryTreatment::Fitted { diameter },
                SavedBoundary::OnOutline(diameter) => BoundaryTreatment::OnOutline { diameter },
            },
            cleaning: self.cleaning.into(),
            boundary_marks: Arc::new(self.boundary_marks.load()),
            pins: match self.pins_part {
                Some(part) => parts.pins(&part)?,
                None => Arc::new(self.pins.into_iter().map(DVec2::from_array).collect()),
            },
            lines: Arc::new(self.lines.into_iter().map(StoredLine::load).collect()),
            paths: self.paths.load(parts)?,
            spacing: self.spacing,
            transfer: self.transfer.into(),
            layers,
            gradation: self.gradation,
            rule: self.rule.into(),
            max_triangles: self.max_triangles,
            max_memory: usize::try_from(self.max_memory).unwrap_or(usize::MAX),
            max_level: self.max_level,
        };
        settings.checked().map_err(sentence)
    }
}

pub(super) fn corners(rect: Rect) -> [f64; 4] {
    [rect.min.x, rect.min.y, rect.max.x, rect.max.y]
}

pub(super) fn rect(of: &str, [x0, y0, x1, y1]: [f64; 4]) -> Result<Rect, PlacedFlaw> {
    let rect = Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    if rect.is_proper() {
        return Ok(rect);
    }
    let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(Number);
    Err(Flaw::Syntax(format!(
        "the bounds {x0}, {y0}, {x1}, {y1} of \"{of}\" are not a rectangle [x0, y0, x1, y1] with {}.",
        Rect::PROPER
    ))
    .into())
}

pub(super) fn formula(of: &str, text: &str) -> Result<Formula, PlacedFlaw> {
    Formula::parse(text)
        .map_err(|mistake| Flaw::Syntax(format!("the formula of \"{of}\" is not valid. {mistake}")).into())
}

pub(super) fn sentence(error: impl std::fmt::Display) -> PlacedFlaw {
    Flaw::Syntax(error.to_string()).into()
}

fn placed(JsonFlaw { sentence, line, .. }: JsonFlaw) -> PlacedFlaw {
    Flaw::Syntax(format!("the settings are not valid: {sentence}")).at(line)
}
