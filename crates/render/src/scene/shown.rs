use meshbrush_mesh::mesh::{Mesh, PatchPieces};

/// The mesh of a picture, with the pieces that are drawn in place of some of its triangles.
#[derive(Clone, Copy, Debug)]
pub struct ShownMesh<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Pieces of a patch of this mesh.
    pub pieces: Option<&'a PatchPieces>,
}

/// The caller's numbers for the contents of a [`ShownMesh`]. A number is never used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownRevision {
    /// Changes with the mesh.
    pub mesh: u64,
    /// Changes with the pieces.
    pub pieces: u64,
}

impl<'a> From<&'a Mesh> for ShownMesh<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self { mesh, pieces: None }
    }
}
