//! The copy of a mesh on the GPU.

use std::ops::Range;

use super::arrangement::Span;
use super::chunks::ChunkLimits;
use super::device::Gpu;
use super::error::GpuError;
use super::mesh_copy::{Counts, MeshCopy};
use super::mesh_pass::MeshSight;
use crate::scene::{Camera, Style};
use meshbrush_mesh::geometry::{Lattice, LatticeRect};
use meshbrush_mesh::mesh::{Changes, Mesh, PatchPieces, Progress, TriangleId};

/// A mesh on the GPU: the arrays of [`Mesh`] as they are, each in one or more buffers.
///
/// There are two copies. The front is drawn. The back receives another mesh in slices while the front stays
/// on the screen; when it is complete, the two change places.
///
/// ```text
///  mesh 2 ── begin_upload, advance_upload … ──► back    mesh 2, in part
///                                                │
///                                                │ with the last byte they change places:
///                                                │ the back is now drawn, and the buffers of
///                                                │ mesh 1 receive the next upload
///                                                ▼
///                                               front   mesh 1, drawn
/// ```
///
/// [`Self::apply_changes`] writes edits into the back during an upload, since they are edits of the mesh that
/// is being uploaded. At other times it writes into the front. Pieces are with the copy of the mesh that they
/// belong to: [`Self::set_pieces`] and [`Self::change_pieces`] choose the copy in the same way.
pub struct MeshMirror {
    gpu: Gpu,
    front: MeshCopy,
    back: MeshCopy,
    upload: Option<Upload>,
    shown: Option<u64>,
    generation: u64,
}

/// An upload into the back: the revision of the mesh, and how many of its first entries were sent.
struct Upload {
    revision: u64,
    sent: Counts,
}

impl MeshMirror {
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue, limits: ChunkLimits) -> Self {
        Self {
            gpu: Gpu::new(device, queue, limits),
            front: MeshCopy::new(limits),
            back: MeshCopy::new(limits),
            upload: None,
            shown: None,
            generation: 0,
        }
    }

    /// Fails where the device cannot draw a mesh at all.
    pub(super) fn check_device(&self) -> Result<(), GpuError> {
        self.gpu.check_device()
    }

    /// Begins to upload a mesh; an unfinished upload is dropped. `revision` is the caller's name for the
    /// mesh.
    ///
    /// # Errors
    /// Fails when the device cannot hold the mesh. The mesh on the screen stays.
    pub fn begin_upload(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.upload = None;
        self.check_device()?;
        self.gpu.check_nodes(mesh.raw_nodes().len())?;
        self.back.begin(&self.gpu, mesh)?;
        self.upload = Some(Upload { revision, sent: Counts::NONE });
        Ok(())
    }

    /// Uploads about `byte_budget` more bytes of the mesh that [`Self::begin_upload`] was called with. If the
    /// mesh has changed since, the changes must have gone to [`Self::apply_changes`]. With the last byte the
    /// mesh is shown.
    pub fn advance_upload(&mut self, mesh: &Mesh, byte_budget: usize) -> Progress {
        let Some(Upload { revision, sent }) = &mut self.upload else { return Progress::Done };
        self.back.send(&self.gpu, mesh, sent, byte_budget);
        if sent.nodes < mesh.raw_nodes().len() || sent.triangles < mesh.raw_triangle_count() {
            return Progress::More;
        }
        self.shown = Some(*revision);
        self.upload = None;
        std::mem::swap(&mut self.front, &mut self.back);
        if self.back.is_large() {
            // Memory of the GPU is short for two of them, and new buffers take less time than the upload.
            self.back = MeshCopy::new(self.gpu.limits());
        }
        self.generation += 1;
        Progress::Done
    }

    /// Uploads a whole mesh in one call.
    ///
    /// # Errors
    /// Fails when the device cannot hold the mesh. The mesh on the screen stays.
    pub fn upload(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.begin_upload(mesh, revision)?;
        self.advance_upload(mesh, usize::MAX);
        Ok(())
    }

    /// Writes the changed entries of the mesh that is being uploaded or, without an upload, of the mesh on
    /// the screen. If there is neither, the whole mesh is uploaded.
    ///
    /// During an upload, changed entries that were already sent are written again; the others follow in their
    /// turn.
    ///
    /// # Errors
    /// Fails when the device cannot hold the mesh. An unfinished upload is dropped. The picture stays, but if
    /// the mesh on the screen was the one that changed, [`Self::shown`] becomes `None` and the next mesh is
    /// uploaded whole.
    pub fn apply_changes(&mut self, mesh: &Mesh, revision: u64, changes: &Changes) -> Result<(), GpuError> {
        if let Some(upload) = self.upload.take() {
            self.gpu.check_nodes(mesh.raw_nodes().len())?;
            // Entries beyond the end of a mesh that became shorter must be sent again if it grows.
            let sent = upload.sent.at_most(mesh);
            self.back.fit(&self.gpu, mesh, sent)?;
            self.back.write(&self.gpu, mesh, sent, changes);
            self.upload = Some(Upload { revision, sent });
            return Ok(());
        }
        if self.shown.take().is_none() {
            return self.upload(mesh, revision);
        }
        self.gpu.check_nodes(mesh.raw_nodes().len())?;
        self.front.fit(&self.gpu, mesh, Counts::ALL)?;
        self.front.write(&self.gpu, mesh, Counts::ALL.at_most(mesh), changes);
        self.shown = Some(revision);
        self.generation += 1;
        Ok(())
    }

    /// Replaces the pieces that are drawn in place of some triangles, or removes them with `None`. They
    /// belong to the mesh that is being uploaded or, without an upload, to the mesh on the screen. A mesh
    /// begins without pieces when its upload begins, also when [`Self::apply_changes`] uploads it whole.
    /// Without any mesh, nothing is done.
    ///
    /// # Errors
    /// Fails when the device cannot hold the pieces. The mesh is then without pieces.
    pub fn set_pieces(&mut self, pieces: Option<&PatchPieces>) -> Result<(), GpuError> {
        if self.upload.is_some() {
            return self.back.set_pieces(&self.gpu, pieces);
        }
        if self.shown.is_none() {
            return Ok(());
        }
        self.generation += 1;
        self.front.set_pieces(&self.gpu, pieces)
    }

    /// Draws triangles of the mesh again in place of their pieces, or draws pieces that were appended.
    ///
    /// `pieces` are those that [`Self::set_pieces`] got, and `touched` is the result of
    /// [`PatchPieces::retire`] or [`PatchPieces::replace`]. The time is proportional to `touched`. After a
    /// mesh lost its pieces because another one is uploaded, nothing is done.
    ///
    /// # Errors
    /// Fails when the device cannot hold the appended pieces.
    pub fn change_pieces(
        &mut self,
        pieces: &PatchPieces,
        touched: &[(TriangleId, Range<usize>)],
    ) -> Result<(), GpuError> {
        if touched.is_empty() {
            return Ok(());
        }
        if self.upload.is_some() {
            self.back.change_pieces(&self.gpu, pieces, touched)?;
        } else if self.front.change_pieces(&self.gpu, pieces, touched)? {
            self.generation += 1;
        }
        Ok(())
    }

    /// Arranges up to `blocks` more blocks of 16,384 triangles of the mesh on the screen, so that fewer
    /// triangles are looked at for a picture; the picture is the same. A large mesh needs this to be drawn in
    /// time. Call it when there is time, until it returns [`Progress::Done`], and again after changes.
    /// `revision` is that of `mesh`; if another one is on the screen, nothing is done.
    ///
    /// # Errors
    /// Fails when the device cannot hold the order of the triangles. The picture stays.
    pub fn arrange(&mut self, mesh: &Mesh, revision: u64, blocks: usize) -> Result<Progress, GpuError> {
        if self.shown != Some(revision) || self.upload.is_some() {
            return Ok(Progress::Done);
        }
        self.front.arrange(&self.gpu, mesh, blocks)
    }

    /// Returns how many vertices the shader is called for in a picture by `camera` in `style`, without those
    /// of pieces.
    pub fn vertices(&self, camera: &Camera, style: &Style) -> usize {
        let view = MeshSight::new(self, camera, style);
        let chunks = 0..self.mesh_draws().count();
        let spans = chunks.flat_map(|chunk| view.spans(self, chunk));
        spans.map(|span| 3 * span.count as usize).sum()
    }

    /// Returns the revision of the mesh that is drawn, or `None` before the first mesh and after a failure.
    pub fn shown(&self) -> Option<u64> {
        self.shown
    }

    /// Returns the revision of the mesh that is being uploaded, if any.
    pub fn uploading(&self) -> Option<u64> {
        self.upload.as_ref().map(|upload| upload.revision)
    }

    /// Returns sizes of the buffers.
    pub fn limits(&self) -> ChunkLimits {
        self.gpu.limits()
    }

    /// Returns a number that changes whenever the picture must be redrawn.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// Returns the lattice of the mesh that is drawn, if any.
    pub(super) fn lattice(&self) -> Option<&Lattice> {
        self.front.lattice.as_ref()
    }

    pub(super) fn layout(&self) -> &wgpu::BindGroupLayout {
        self.gpu.layout()
    }

    /// Returns the buffers of the mesh, each with its number of triangles.
    pub(super) fn mesh_draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        self.front.mesh_draws()
    }

    /// Returns the triangles of a buffer that must be drawn where `view` is visible, at a detail level.
    pub(super) fn spans(&self, chunk: usize, view: &LatticeRect, level: Option<u32>) -> Vec<Span> {
        self.front.spans(chunk, view, level)
    }

    /// Returns the buffers of the pieces, each with its number of triangles.
    pub(super) fn piece_draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        self.front.piece_draws()
    }
}
