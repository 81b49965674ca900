//! The argument of a refinement rule, and the result of a slice of work.

use glam::DVec2;

use super::{DEEPEST_LEVEL, Mesh, Triangle, TriangleId, bisection_edge_length};
use crate::geometry::{Lattice, LatticePoint, Rect};

/// A triangle as a refinement rule sees it.
pub struct Element<'a> {
    /// The entry of the triangle array.
    pub triangle: &'a Triangle,
    /// The vertices of the triangle in lattice coordinates, in its order.
    pub corners: [LatticePoint; 3],
    /// The grid and lattice of the mesh.
    pub lattice: &'a Lattice,
    diameter: f64,
}

/// [`Mesh::diameter`] of every level of the lattice.
pub(in crate::mesh) struct Diameters([f64; DEEPEST_LEVEL + 1]);

impl Diameters {
    pub(in crate::mesh) fn of(mesh: &Mesh) -> Self {
        let spacing = mesh.lattice.spacing();
        Self(std::array::from_fn(|level| bisection_edge_length(spacing, level as u32)))
    }
}

impl<'a> Element<'a> {
    #[inline]
    pub(super) fn new(
        triangle: &'a Triangle,
        corners: [LatticePoint; 3],
        lattice: &'a Lattice,
        diameters: &Diameters,
    ) -> Self {
        Self { triangle, corners, lattice, diameter: diameters.0[triangle.level() as usize] }
    }
}

impl Element<'_> {
    /// Returns the length of the bisection edge in world units (Eq. 1): what a rule compares with the target
    /// diameter.
    #[inline]
    pub fn diameter(&self) -> f64 {
        self.diameter
    }

    /// Returns the vertices in world coordinates, in the triangle's order.
    #[inline]
    pub fn world_corners(&self) -> [DVec2; 3] {
        self.corners.map(|c| self.lattice.world_from_lattice(c))
    }

    /// Returns the smallest rectangle around it, in world units.
    pub fn world_rectangle(&self) -> Rect {
        let [a, b, c] = self.world_corners();
        Rect::new(a.min(b).min(c), a.max(b).max(c))
    }
}

impl Mesh {
    /// Returns the triangle with the given id, as a refinement rule sees it.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn element(&self, id: TriangleId) -> Element<'_> {
        let triangle = self.triangle(id);
        let corners = triangle.vertices.map(|v| self.node(v));
        Element { triangle, corners, lattice: &self.lattice, diameter: self.diameter(triangle.level()) }
    }

    /// Returns the same as [`Self::element`], using a table of the diameters of all levels.
    #[inline]
    pub(in crate::mesh) fn element_with(&self, id: TriangleId, diameters: &Diameters) -> Element<'_> {
        self.element_of(self.triangle(id), diameters)
    }

    /// Returns the elements of all entries of the array, those outside a fitted domain included.
    pub fn raw_elements(&self) -> impl Iterator<Item = Element<'_>> {
        let diameters = Diameters::of(self);
        self.triangles.iter().map(move |triangle| self.element_of(triangle, &diameters))
    }

    /// Returns the element of a triangle that need not be in the array.
    #[inline]
    pub(in crate::mesh) fn element_of<'a>(
        &'a self,
        triangle: &'a Triangle,
        diameters: &Diameters,
    ) -> Element<'a> {
        Element::new(triangle, triangle.vertices.map(|v| self.node(v)), &self.lattice, diameters)
    }
}

/// Whether a sliced piece of work is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// All work is done.
    Done,
    /// The allowance was used up; call again.
    More,
}
