//! The options of a document, as `io/settings` has those of a recipe.

use std::sync::Arc;

use meshbrush_core::document::{MAX_COARSE_TRIANGLES, Settings};
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain, DomainShape, OutlineOnEarth};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{CoarseError, KeptParts, MOST_TRIANGLES};
use wasm_bindgen::prelude::*;

use crate::errors::{compiled, error};
use crate::rasters::rect_of;
use crate::values::{Table, named_polygons_of};

/// Coarse cells along the longer side of the domain unless the spacing is given, as in a recipe.
const DEFAULT_CELLS: f64 = 20.0;

/// How the mesh meets the boundary of polygons.
#[derive(Clone, Copy, PartialEq)]
enum Treatment {
    Report,
    Fitted,
    Outline,
}

impl Treatment {
    const WORDS: [(&str, Self); 3] =
        [("outline", Self::Outline), ("fitted", Self::Fitted), ("report", Self::Report)];

    fn of(treatment: BoundaryTreatment) -> Self {
        match treatment {
            BoundaryTreatment::Report => Self::Report,
            BoundaryTreatment::Fitted { .. } => Self::Fitted,
            BoundaryTreatment::OnOutline { .. } => Self::Outline,
        }
    }

    fn with_diameter(self, diameter: f64) -> BoundaryTreatment {
        match self {
            Self::Report => BoundaryTreatment::Report,
            Self::Fitted => BoundaryTreatment::Fitted { diameter },
            Self::Outline => BoundaryTreatment::OnOutline { diameter },
        }
    }
}

/// Returns the settings of a document without layers.
///
/// # Errors
/// Fails for options that cannot be met.
pub fn settings_of(options: Table<'_>) -> Result<Settings, JsError> {
    let (domain, marks) = domain_of(Table(&options.needed("domain", options.get("domain"))?))?;
    let spacing = options.length("spacing")?.unwrap_or(domain.bounds.size().max_element() / DEFAULT_CELLS);
    Lattice::covering(domain.bounds, spacing, MAX_COARSE_TRIANGLES)
        .map_err(CoarseError::from)
        .map_err(error)?;
    let h_min = options.length("hMin")?.unwrap_or(f64::MIN_POSITIVE);
    let h_risk = options.length("hRisk")?.unwrap_or(h_min);
    let h_max = options.length("hMax")?.unwrap_or(f64::MAX);
    let settings = Settings {
        name: options.text("name")?.unwrap_or_else(|| "Untitled".to_owned()),
        boundary: BoundaryTreatment::default_for(domain.longest_on_earth(spacing)),
        domain,
        boundary_marks: Arc::new(marks),
        spacing,
        transfer: Transfer { h_min, h_risk, h_max, shape: 1.0 },
        layers: Vec::new(),
        rule: RefinementRule::Area,
        max_triangles: Settings::MAX_TRIANGLES,
        max_memory: Settings::MAX_MEMORY,
        ..Settings::default()
    };
    changed(options, settings)?.with_limits_of_the_grid().map_err(error)
}

/// Returns settings with the values of options in place of their own.
///
/// # Errors
/// Fails for values that cannot be used.
pub fn changed(options: Table<'_>, settings: Settings) -> Result<Settings, JsError> {
    let Transfer { h_min, h_risk, h_max, shape } = settings.transfer;
    // As in a recipe: the curve ends at the smallest diameter, unless another end is given.
    let own_risk = (h_risk != h_min).then_some(h_risk);
    let h_min = options.length("hMin")?.unwrap_or(h_min);
    let transfer = Transfer {
        h_min,
        h_risk: options.length("hRisk")?.or(own_risk).unwrap_or(h_min),
        h_max: options.length("hMax")?.unwrap_or(h_max),
        shape: options.number("shape")?.unwrap_or(shape),
    };
    let spacing = options.length("spacing")?.unwrap_or(settings.spacing);
    let treatment = options.word("boundary", &Treatment::WORDS)?;
    let diameter = options.length("boundaryDiameter")?;
    if (treatment.is_some() || diameter.is_some()) && settings.domain.is_whole() {
        return Err(error(
            "boundary and boundaryDiameter are for the outline of polygons or of a formula: leave them out.",
        ));
    }
    let treatment = treatment.unwrap_or(Treatment::of(settings.boundary));
    if diameter.is_some() && treatment == Treatment::Report {
        return Err(error(
            "With boundary: \"report\" nothing is refined along the outline: leave boundaryDiameter out.",
        ));
    }
    let diameter = diameter
        .or(settings.boundary.diameter())
        .unwrap_or_else(|| BoundaryTreatment::default_diameter(settings.domain.longest_on_earth(spacing)));
    let rules = [("area", RefinementRule::Area), ("vertex", RefinementRule::Vertex)];
    let memory = options.number_where("maxMemory", |bytes| bytes >= 0.0, "give a number of bytes")?;
    Ok(Settings {
        spacing,
        transfer,
        boundary: treatment.with_diameter(diameter),
        cleaning: kept(options)?.cleaning(settings.cleaning),
        gradation: options.number("gradation")?.or(settings.gradation),
        rule: options.word("rule", &rules)?.unwrap_or(settings.rule),
        max_triangles: options.count("maxTriangles", 2, MOST_TRIANGLES)?.unwrap_or(settings.max_triangles),
        max_memory: memory.map_or(settings.max_memory, |bytes| bytes as usize),
        max_level: options.count("maxLevel", 0, DEEPEST)?.map(|level| level as u32).or(settings.max_level),
        ..settings
    })
}

/// More levels than any lattice has.
const DEEPEST: usize = 255;

/// What options say about the parts that stay.
#[derive(Clone, Copy, Default)]
pub struct Kept {
    parts: Option<KeptParts>,
    pinches: Option<bool>,
    improves: Option<bool>,
}

impl Kept {
    /// Returns which triangles stay: the default ones, unless the options say otherwise.
    pub fn cleaning(self, default: meshbrush_mesh::mesh::Cleaning) -> meshbrush_mesh::mesh::Cleaning {
        meshbrush_mesh::mesh::Cleaning {
            parts: self.parts.unwrap_or(default.parts),
            keeps_pinches: self.pinches.unwrap_or(default.keeps_pinches),
            improves_boundary: self.improves.unwrap_or(default.improves_boundary),
        }
    }

    /// Returns this with what later options say.
    pub fn and(self, later: Self) -> Self {
        Self {
            parts: later.parts.or(self.parts),
            pinches: later.pinches.or(self.pinches),
            improves: later.improves.or(self.improves),
        }
    }
}

/// Returns what options say about the parts that stay.
///
/// # Errors
/// Fails for values that cannot be used.
pub fn kept(options: Table<'_>) -> Result<Kept, JsError> {
    let pinches = options.flag("keepPinches");
    let improves = options.flag("improveBoundary");
    let parts = match options.get("parts") {
        Some(value) if value.as_f64().is_some() => options
            .number_where(
                "parts",
                |share| (0.0..=1.0).contains(&share),
                "a share of the area lies from 0 to 1",
            )?
            .map(KeptParts::Share),
        _ => options.word("parts", &[("all", KeptParts::All), ("largest", KeptParts::Largest)])?,
    };
    Ok(Kept { parts, pinches, improves })
}

fn domain_of(domain: Table<'_>) -> Result<(Domain, BoundaryMarks), JsError> {
    let bounds = domain.several("bounds")?.map(rect_of).transpose()?;
    if let Some(shapes) = domain.get("shapes") {
        let polygons = named_polygons_of(&shapes)?;
        if polygons.is_empty() {
            return Err(error(
                "The domain has no polygon: give a ring of points, rings, or GeoJSON with polygons.",
            ));
        }
        return BoundaryMarks::domain_of(&polygons, bounds, &OutlineOnEarth::default()).map_err(error);
    }
    let bounds: Rect = domain.needed("bounds", bounds)?;
    let inside = domain.text("inside")?.map(|text| compiled("inside", &text, Formula::parse)).transpose()?;
    let shape = inside.map_or(DomainShape::Whole, DomainShape::from);
    Ok((Domain { bounds, shape, projection: None }, BoundaryMarks::default()))
}
