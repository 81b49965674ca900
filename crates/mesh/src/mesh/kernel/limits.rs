//! Memory as a limit: translated into a count of triangles, so that refinement has one number to look at.

use super::LimitError;

/// The most triangles of any mesh, under any limits: higher ids serve as marks.
pub const MOST_TRIANGLES: usize = (1 << 31) - 1;

/// Limits of the size of a mesh.
///
/// Once the arrays pass 2 MiB, a mesh reserves address space for [`Self::most_triangles`] in one step: about
/// 2 GB with the default limits. Memory is used only as it is touched. On Windows, which charges for
/// reservations, the arrays grow by doubling instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most triangles; refinement that would pass it stops with an error. A triangle and its share of the
    /// nodes take 38 bytes, and up to 16 more while the mesh is refined from scratch.
    pub max_triangles: usize,
    /// Deepest level, or `None` for as deep as the lattice goes. Triangles at this level count as satisfied.
    pub max_level: Option<u32>,
    /// Most memory, or `None` for as much as [`Self::max_triangles`] take.
    pub max_memory: Option<MemoryLimit>,
}

impl Limits {
    /// [`Self::max_triangles`], as far as memory and ids go.
    pub fn most_triangles(&self) -> usize {
        let room = self.max_memory.map_or(usize::MAX, |memory| memory.triangles());
        self.max_triangles.min(MOST_TRIANGLES).min(room)
    }

    /// [`Self::max_level`], or a level that no triangle has.
    pub(in crate::mesh) fn level_cap(&self) -> u32 {
        self.max_level.unwrap_or(u32::MAX)
    }

    /// Returns the error for a mesh that would exceed [`Self::most_triangles`].
    pub(super) fn passed(&self) -> LimitError {
        let limit = self.most_triangles();
        match self.max_memory {
            Some(memory) if memory.triangles() < self.max_triangles.min(MOST_TRIANGLES) => {
                LimitError::TooMuchMemory { limit, memory }
            }
            _ => LimitError::TooManyTriangles { limit },
        }
    }
}

impl Default for Limits {
    /// 50 million triangles (1.9 GB), and any level.
    fn default() -> Self {
        Self { max_triangles: 50_000_000, max_level: None, max_memory: None }
    }
}

/// How much memory meshes may take, and how much of it a triangle takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryLimit {
    /// Most memory, in bytes.
    pub bytes: usize,
    /// Memory of a triangle with its share of all other arrays, in bytes.
    pub per_triangle: usize,
}

/// A triangle and its share of the nodes, in bytes ([`Mesh::bytes`](crate::mesh::Mesh::bytes)).
const IN_THE_MESH: usize = 38;
/// While it is refined from scratch, where every triangle is a block because the target diameter changes
/// everywhere: first the treatments of all triangles of the bisection tree, two for each of the mesh and four
/// bytes each, then those of the mesh besides; later depths, shapes and numbers of the blocks. The vertex
/// rule takes the order of visits and the values at nodes.
const WHILE_MADE: usize = 16;
/// Afterwards, for files and summaries: what lies in the domain, without gaps, and the numbers of its parts.
const WHILE_WRITTEN: usize = 58;
/// While it is updated in place: the marks, with room to double
/// ([`Updater::bytes`](crate::mesh::Updater::bytes)).
const WHILE_UPDATED: usize = 2;

impl MemoryLimit {
    /// The most bytes that a triangle takes while a mesh is made, and nothing else.
    pub const ONE_MESH_MADE: usize = IN_THE_MESH + WHILE_MADE;

    /// The most bytes per triangle of a mesh that is made once and written.
    pub const ONE_MESH: usize = IN_THE_MESH + WHILE_WRITTEN;

    /// The most bytes per triangle of a mesh that is updated in place, or rebuilt beside the one that is
    /// shown.
    pub const TWO_MESHES: usize = 2 * IN_THE_MESH + WHILE_MADE + WHILE_UPDATED;

    /// Returns the limit for a mesh that is made once, with `bytes` of memory.
    pub fn for_one_mesh(bytes: usize) -> Self {
        Self { bytes, per_triangle: Self::ONE_MESH }
    }

    /// Returns the limit for a mesh that is updated in place, or rebuilt beside the shown one, with `bytes`
    /// of memory.
    pub fn for_two_meshes(bytes: usize) -> Self {
        Self { bytes, per_triangle: Self::TWO_MESHES }
    }

    /// Returns how many triangles there is room for.
    pub fn triangles(&self) -> usize {
        self.bytes / self.per_triangle.max(1)
    }
}
