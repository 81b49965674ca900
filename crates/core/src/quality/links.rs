//! The links between the cells of a mesh, as solvers with water levels at circumcentres have them.

use glam::DVec2;

use super::QualityMeasure;
use crate::cells::{CellLink, CellNodes, MeshCells};
use crate::mesh::{MeshView, NodeId, TriangleId};
use crate::text::LengthUnit;

/// Links, and the triangles on both sides of each.
pub(super) struct MeasuredLinks {
    pub(super) links: Vec<CellLink>,
    /// The triangles of the two cells of each link; the same one twice in a cell that is one.
    pub(super) triangles: Vec<[usize; 4]>,
}

impl MeasuredLinks {
    /// Joins pairs of triangles, and measures the links between the cells.
    pub(super) fn of(mesh: MeshView<'_>, unit: LengthUnit) -> Self {
        let nodes: Vec<DVec2> =
            (0..mesh.nodes().len()).map(|node| mesh.world(NodeId::from_index(node))).collect();
        let corners =
            |triangle: usize| mesh.file_vertices(TriangleId::from_index(triangle)).map(|node| node.index());
        let triangles: Vec<[usize; 3]> = (0..mesh.triangles().len()).map(corners).collect();
        let of = CellNodes { nodes: &nodes, triangles: &triangles, unit };
        let cells = MeshCells::joined(of);
        let (links, sides) = cells.links_with_cells(of);
        let of_cell = |cell: usize| cells.list()[cell].triangles;
        let both = |[one, other]: [usize; 2]| {
            let ([a, b], [c, d]) = (of_cell(one), of_cell(other));
            [a, b, c, d]
        };
        Self { links, triangles: sides.into_iter().map(both).collect() }
    }

    /// Returns the worst number of the links of the cell of each of so many triangles; NaN without one.
    pub(super) fn worst(&self, measure: QualityMeasure, triangles: usize) -> Vec<f64> {
        let mut worst = vec![f64::NAN; triangles];
        for (link, owners) in self.links.iter().zip(&self.triangles) {
            let Some(number) = number_of(link, measure) else { continue };
            for &triangle in owners {
                let kept = &mut worst[triangle];
                *kept = if measure.is_worse_when_smaller() { kept.min(number) } else { kept.max(number) };
            }
        }
        worst
    }
}

/// Returns the number of a link by a measure of links. One that the solver removes has no cosine.
pub(super) fn number_of(link: &CellLink, measure: QualityMeasure) -> Option<f64> {
    match measure {
        QualityMeasure::LinkLength => Some(link.share()),
        QualityMeasure::LinkCosine => (!link.is_short()).then_some(link.cosine),
        _ => None,
    }
}
