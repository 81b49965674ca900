//! What files and the JSON summary say about a mesh besides its triangles.

use glam::DVec2;
use serde::Serialize;

use super::build::FinishedMesh;
use super::request::MeshRequest;
use crate::domain::{BoundaryPiece, MeshBoundary, PieceFigures};
use crate::io::{MeshSource, Provenance};
use crate::mesh::Extract;

/// The boundary in named pieces, the parts, and where the mesh comes from.
pub struct MeshDetails {
    /// The pieces, and the piece of each boundary edge.
    pub boundary: MeshBoundary,
    /// For each triangle the number of its part, from the largest.
    pub parts: Vec<u32>,
    /// Where the mesh comes from.
    pub provenance: Provenance,
}

impl MeshDetails {
    /// Those of a mesh as files get it, which the command `line` asked for.
    pub fn of(finished: &FinishedMesh, extract: &Extract, line: &str, request: &MeshRequest) -> Self {
        let coordinates = match request.mesh.region.as_ref().or(request.project.as_ref()) {
            Some(file) => format!("x, y as in {}", file.display()),
            None => "x, y".to_owned(),
        };
        let fingerprint = finished.mesh().fingerprint();
        let provenance = Provenance::new(MeshSource::Command(line), fingerprint, &coordinates);
        let provenance = provenance.with_unit(finished.unit);
        Self { boundary: finished.boundary(extract), parts: extract.part_numbers(), provenance }
    }

    /// The number of triangles of each part.
    pub fn part_triangles(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for &part in &self.parts {
            let part = part as usize;
            counts.resize(counts.len().max(part + 1), 0);
            counts[part] += 1;
        }
        counts
    }
}

/// A piece of the boundary.
#[derive(Clone, Debug, Serialize)]
pub struct PieceSummary {
    /// Its number. Markers in files are one higher.
    pub id: usize,
    /// Its name, which no other piece has.
    pub name: String,
    /// "open", "mainland" or "island".
    pub kind: &'static str,
    /// Edges of the mesh; none where the mesh covers an island.
    pub edges: usize,
    /// Their length in world units.
    pub length: f64,
}

impl PieceSummary {
    /// Those of all pieces, by number.
    pub fn of_all(boundary: &MeshBoundary) -> Vec<Self> {
        let pieces = boundary.pieces().list().iter().zip(boundary.figures());
        let summary = |(id, (piece, figures)): (usize, (&BoundaryPiece, &PieceFigures))| {
            let PieceFigures { edges, length } = *figures;
            Self { id, name: piece.name.clone(), kind: piece.kind.name(), edges, length }
        };
        pieces.enumerate().map(summary).collect()
    }
}

/// A hole of the polygons that the mesh covers.
#[derive(Clone, Debug, Serialize)]
pub struct LostIsland {
    /// One of its corners.
    pub place: [f64; 2],
    /// Its name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl LostIsland {
    /// The one with a corner at a place.
    pub fn at(place: DVec2, boundary: Option<&MeshBoundary>) -> Self {
        let pieces = boundary.map(MeshBoundary::pieces);
        let name = pieces.and_then(|pieces| {
            let (piece, _) = pieces.nearest(place, pieces.tolerance())?;
            Some(pieces.list()[piece].name.clone())
        });
        Self { place: place.into(), name }
    }
}
