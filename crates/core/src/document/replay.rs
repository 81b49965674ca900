use super::{Document, Edit, EditError, Follower, Settings};
use crate::build::BuildError;
use crate::layers::PaintLayers;
use crate::mesh::Fingerprint;

/// Does recorded edits again, and makes the mesh after each.
#[derive(Debug)]
pub struct Replay {
    document: Document,
    follower: Follower,
}

/// The mesh that an edit leads to, or why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum ReplayedMesh {
    /// The mesh of the document.
    Mesh {
        /// Equal for equal meshes.
        fingerprint: Fingerprint,
        /// Triangles of the domain.
        triangles: usize,
    },
    /// The document has no mesh; the edit stands nevertheless.
    None(BuildError),
}

impl Replay {
    /// Begins with a document and its mesh.
    ///
    /// # Errors
    /// Fails with a sentence for a person when the settings are out of range or there is no mesh.
    pub fn new(settings: Settings, paint: PaintLayers) -> Result<Self, String> {
        let document = Document::new(settings, Some(paint)).map_err(|error| error.to_string())?;
        Self::from_document(document)
    }

    fn from_document(mut document: Document) -> Result<Self, String> {
        let follower = Follower::new(&mut document).map_err(|error| error.to_string())?;
        Ok(Self { document, follower })
    }

    /// Returns the document as it is.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Does an edit. [`Self::advance`] makes the mesh.
    ///
    /// # Errors
    /// Fails when it is not possible.
    pub fn apply(&mut self, edit: &Edit) -> Result<(), EditError> {
        self.document.apply(edit)
    }

    /// Works on the mesh: about `budget` edges, pixels or triangles. Returns the result once it is there.
    pub fn advance(&mut self, budget: usize) -> Option<ReplayedMesh> {
        match self.follower.advance(&mut self.document, budget) {
            Ok(stage) if !stage.is_settled() => None,
            Ok(_) => Some(match self.follower.stopped() {
                None => ReplayedMesh::of(&self.follower),
                Some(error) => ReplayedMesh::None(error.clone()),
            }),
            Err(error) => Some(ReplayedMesh::None(error)),
        }
    }
}

impl ReplayedMesh {
    fn of(follower: &Follower) -> Self {
        let mesh = follower.mesh();
        Self::Mesh { fingerprint: mesh.fingerprint(), triangles: mesh.triangle_count() }
    }
}
