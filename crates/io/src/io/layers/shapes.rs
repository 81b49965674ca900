//! Shapes and threats as a text has them.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::checks::{point, points, rings};
use super::{SavedLaw, each};
use crate::io::KeyFault;
use crate::io::lengths::SavedLength;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{ShapeList, Threat, ThreatLaw};

/// A polygon: its rings, the outer one first, and their points.
pub type SavedPolygon = Vec<Vec<[f64; 2]>>;

/// A threat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { x = 1, y = 2, range = 3 }")]
pub struct SavedThreat {
    /// Its place.
    pub x: f64,
    /// Its place.
    pub y: f64,
    /// The distance beyond which there is no risk.
    pub range: SavedLength,
    /// The risk at its place.
    #[serde(default = "one")]
    pub peak: f64,
    /// How the risk falls with the distance.
    #[serde(default)]
    pub law: SavedLaw,
}

/// A point, line or polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedShape {
    /// x and y.
    Point([f64; 2]),
    /// Points joined by segments.
    Line(Vec<[f64; 2]>),
    /// Rings, the outer one first.
    Polygon(SavedPolygon),
}

impl SavedShape {
    pub(super) fn of_list(list: &ShapeList) -> Vec<Self> {
        let points = list.points.iter().map(|point| Self::Point(point.to_array()));
        let line = |line: &Vec<DVec2>| Self::Line(line.iter().map(DVec2::to_array).collect());
        let polygons = list.polygons.iter().map(|polygon| Self::Polygon(saved_polygon(polygon)));
        points.chain(list.lines.iter().map(line)).chain(polygons).collect()
    }

    fn check(&self) -> Result<(), KeyFault> {
        match self {
            Self::Point(at) => point(*at).map(|_| ()),
            Self::Line(along) => points(along, 2, "a line").map(|_| ()),
            Self::Polygon(polygon) => rings(polygon).map(|_| ()),
        }
    }
}

/// Returns the shapes of a list under the key `shapes`.
///
/// # Errors
/// Fails for the first shape that has too few points, or a coordinate that is not finite.
pub(super) fn checked_shapes(shapes: &[SavedShape]) -> Result<ShapeList, KeyFault> {
    let mut list = ShapeList::default();
    each("shapes", shapes, SavedShape::check)?;
    for shape in shapes {
        match shape {
            SavedShape::Point(at) => list.points.push((*at).into()),
            SavedShape::Line(along) => list.lines.push(along.iter().copied().map(Into::into).collect()),
            SavedShape::Polygon(polygon) => list.polygons.push(rings(polygon)?),
        }
    }
    Ok(list)
}

/// Returns a polygon as a text has it.
pub fn saved_polygon(polygon: &Polygon) -> SavedPolygon {
    polygon.iter().map(|ring| ring.iter().map(DVec2::to_array).collect()).collect()
}

impl From<SavedThreat> for Threat {
    fn from(saved: SavedThreat) -> Self {
        let SavedThreat { x, y, range, peak, law } = saved;
        let law = match law {
            SavedLaw::Radar => ThreatLaw::Radar,
            SavedLaw::Gaussian => ThreatLaw::Gaussian,
            SavedLaw::Disc => ThreatLaw::Disc,
        };
        Self { at: DVec2::new(x, y), range: *range, peak, law }
    }
}

impl From<Threat> for SavedThreat {
    fn from(threat: Threat) -> Self {
        let Threat { at, range, peak, law } = threat;
        let law = match law {
            ThreatLaw::Radar => SavedLaw::Radar,
            ThreatLaw::Gaussian => SavedLaw::Gaussian,
            ThreatLaw::Disc => SavedLaw::Disc,
        };
        Self { x: at.x, y: at.y, range: range.into(), peak, law }
    }
}

fn one() -> f64 {
    1.0
}
