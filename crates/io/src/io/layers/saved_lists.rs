//! Shapes, threats and masks as a text has them.

use glam::DVec2;

use super::{SavedLaw, SavedLayer, SavedPolygon, SavedShape, SavedThreat};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{DistanceLayer, Layer, ShapeList, Threat, ThreatLaw, Threats};

impl SavedLayer {
    /// Returns the shapes of a layer, if it has any.
    pub fn shapes_of(layer: &Layer) -> Option<Vec<SavedShape>> {
        let DistanceLayer { to, .. } = layer.kind.get()?;
        to.shapes().map(|shapes| SavedShape::of_list(shapes.list()))
    }

    /// Returns the threats of a layer, if it is one of threats.
    pub fn threats_of(layer: &Layer) -> Option<Vec<SavedThreat>> {
        let threats = layer.kind.get::<Threats>()?;
        Some(threats.list().iter().copied().map(SavedThreat::from).collect())
    }

    /// Returns the mask of a layer, if it has one.
    pub fn mask_of(layer: &Layer) -> Option<Vec<SavedPolygon>> {
        Some(layer.mask.as_ref()?.polygons().iter().map(saved_polygon).collect())
    }
}

impl SavedShape {
    fn of_list(list: &ShapeList) -> Vec<Self> {
        let points = list.points.iter().map(|point| Self::Point(point.to_array()));
        let line = |line: &Vec<DVec2>| Self::Line(line.iter().map(DVec2::to_array).collect());
        let polygons = list.polygons.iter().map(|polygon| Self::Polygon(saved_polygon(polygon)));
        points.chain(list.lines.iter().map(line)).chain(polygons).collect()
    }
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
        Self { at: DVec2::new(x, y), range, peak, law }
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
        Self { x: at.x, y: at.y, range, peak, law }
    }
}
