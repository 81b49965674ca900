//! How good the triangles of a mesh are, in the JSON summary.

use serde::Serialize;

use super::build::FinishedMesh;
use meshbrush_core::layers::NodeDepths;
use meshbrush_core::quality::{
    MeasureSummary, MeasuredPlace, MeshQuality, QualityBin, QualityMeasure, TriangleMeasures,
};
use meshbrush_mesh::mesh::Extract;

/// The measures of a mesh as files get it; those that it does not have are left out.
#[derive(Clone, Debug, Serialize)]
pub struct QualitySummary {
    /// The smallest angles of triangles, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_angle: Option<MeasureFigures>,
    /// The largest angles of triangles, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_angle: Option<MeasureFigures>,
    /// The ratios of the longest to the shortest edges of triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge_ratio: Option<MeasureFigures>,
    /// The ratios of the longest edges of triangles to h̄ at their middles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_ratio: Option<MeasureFigures>,
    /// The largest time steps of triangles with the Courant number 1, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step: Option<MeasureFigures>,
    /// The triangles at nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangles_at_node: Option<MeasureFigures>,
}

/// The extremes of a measure, and its histogram.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureFigures {
    /// The least number.
    pub least: NumberAt,
    /// The greatest number.
    pub greatest: NumberAt,
    /// The classes in ascending order, from the first to the last one with any triangle or node.
    pub bins: Vec<BinFigures>,
}

/// A number, and where it is found.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NumberAt {
    /// The number.
    pub value: f64,
    /// The middle of the triangle, or the node.
    pub at: [f64; 2],
}

/// A class of a histogram.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BinFigures {
    /// Where it begins.
    pub from: f64,
    /// Where it ends; `None` where it does not.
    pub to: Option<f64>,
    /// Its triangles or nodes.
    pub count: usize,
}

impl QualitySummary {
    /// Measures the mesh that files get. Without depths there are no time steps.
    pub fn of(finished: &FinishedMesh, extract: &Extract, depths: Option<&NodeDepths>) -> Self {
        let measures = TriangleMeasures::new(extract.view(), finished.ground());
        let mut measures = measures.with_target(&finished.built().field, finished.paint());
        if let Some(NodeDepths { depths, .. }) = depths {
            measures = measures.with_depths(depths, finished.unit());
        }
        let quality = MeshQuality::of(&measures);
        let figures = |measure| quality.get(measure).map(MeasureFigures::from);
        Self {
            smallest_angle: figures(QualityMeasure::SmallestAngle),
            largest_angle: figures(QualityMeasure::LargestAngle),
            edge_ratio: figures(QualityMeasure::EdgeRatio),
            target_ratio: figures(QualityMeasure::TargetRatio),
            time_step: figures(QualityMeasure::TimeStep),
            triangles_at_node: figures(QualityMeasure::Valence),
        }
    }
}

impl From<&MeasureSummary> for MeasureFigures {
    fn from(summary: &MeasureSummary) -> Self {
        let place = |MeasuredPlace { value, at, .. }| NumberAt { value, at: at.into() };
        let bin = |&QualityBin { from, to, count, .. }: &QualityBin| BinFigures {
            from,
            to: to.is_finite().then_some(to),
            count,
        };
        Self {
            least: place(summary.least),
            greatest: place(summary.greatest),
            bins: summary.bins_in_use().iter().map(bin).collect(),
        }
    }
}
