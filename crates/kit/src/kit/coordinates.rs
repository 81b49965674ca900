//! How places are written: in the plane of the document, or on the Earth.

use glam::DVec2;

use meshbrush_core::document::Settings;
use meshbrush_core::earth::{DegreeStyle, EarthPlane, GeographicAxis};
use meshbrush_ui::widgets::degrees::KM_PER_DEGREE;
use meshbrush_ui::widgets::format;

/// The coordinates that places are written in. Documents that do not lie on the Earth have those of their
/// plane only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateStyle {
    /// Longitude and latitude.
    Geographic(DegreeStyle),
    /// x and y in the plane of the document.
    Plane,
}

impl Default for CoordinateStyle {
    fn default() -> Self {
        Self::Geographic(DegreeStyle::Decimal)
    }
}

impl CoordinateStyle {
    /// All of them.
    pub const ALL: [Self; 3] =
        [Self::Geographic(DegreeStyle::Decimal), Self::Geographic(DegreeStyle::Minutes), Self::Plane];

    /// Returns the name for a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Geographic(DegreeStyle::Decimal) => "Degrees",
            Self::Geographic(DegreeStyle::Minutes) => "Degrees and minutes",
            Self::Plane => "Plane",
        }
    }

    /// Returns the style of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|style| style.name() == name)
    }
}

/// Both coordinates of a place, for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlaceText {
    /// The names of the coordinates.
    pub names: [&'static str; 2],
    /// Their values, with units.
    pub values: [String; 2],
}

/// Returns the plane on the Earth in whose longitudes and latitudes the person wants places, and how angles
/// are written; `None` where places are in the plane of the document.
pub fn geographic_plane(settings: &Settings, style: CoordinateStyle) -> Option<(EarthPlane, DegreeStyle)> {
    let CoordinateStyle::Geographic(style) = style else { return None };
    Some((EarthPlane::new(settings.domain.projection, settings.unit)?, style))
}

/// Returns a place, in world units, with the digits that tell it apart from one that is `step` world units
/// away.
pub fn place_text(settings: &Settings, style: CoordinateStyle, at: DVec2, step: f64) -> PlaceText {
    let geographic = geographic_plane(settings, style);
    let names = names_of(geographic.is_some());
    let Some((plane, style)) = geographic else {
        let values = at.to_array().map(|value| format::coordinate(value, step, settings.unit));
        return PlaceText { names, values };
    };
    let [longitude, latitude] = plane.geographic(at).to_array();
    let step = match plane {
        EarthPlane::Degrees => step,
        EarthPlane::Projected(_) => step / (1000.0 * KM_PER_DEGREE),
    };
    let text = |axis, degrees| style.text(axis, degrees, step);
    let values = [text(GeographicAxis::Longitude, longitude), text(GeographicAxis::Latitude, latitude)];
    PlaceText { names, values }
}

/// Returns the names of the coordinates of places on the Earth, or in a plane.
pub fn names_of(is_geographic: bool) -> [&'static str; 2] {
    if is_geographic { ["lon", "lat"] } else { ["x", "y"] }
}
