use glam::DVec2;

use super::locate::WalkEnd;
use super::{Location, Mesh, TriangleId};
use crate::geometry::Side;

/// A search tree over a mesh, for many queries: the report's virtual buckets (Section 7.1), carried on below the coarse
/// grid.
///
/// In a deeply refined coarse triangle the walk of Algorithm 15 is long, and each step is a miss of the cache. The tree
/// divides each coarse cell into 4 × 4 and so on, as deep as the triangles there are small, and keeps one triangle for
/// each bucket: queries start within a step or two of their answer. It takes about 4 bytes a triangle.
///
/// A bucket is a hint and nothing rests on it: where a walk from it is stopped by a hole, or the point lies on an edge, the
/// plain walk answers.
pub struct Locator<'m> {
    mesh: &'m Mesh,
    slots: Vec<Slot>,
}

/// A bucket's triangle, or the place of the 16 buckets that it is divided into.
#[derive(Clone, Copy)]
struct Slot(u32);

const DIVIDED: u32 = 1 << 31;
/// Buckets along a side of a divided bucket, as a power of two.
const FAN_BITS: u32 = 2;
const FAN: usize = 1 << FAN_BITS;

impl Slot {
    const NOTHING: Self = Self(DIVIDED - 1);

    fn hint(id: TriangleId) -> Self {
        Self(id.0)
    }

    fn divided(first: usize) -> Self {
        Self(first as u32 | DIVIDED)
    }

    #[inline]
    fn children(self) -> Option<usize> {
        (self.0 & DIVIDED != 0).then_some((self.0 & !DIVIDED) as usize)
    }
}

impl<'m> Locator<'m> {
    /// Builds the tree in time proportional to the mesh.
    pub fn new(mesh: &'m Mesh) -> Self {
        let [columns, rows] = mesh.lattice.cells();
        let slots = vec![Slot::NOTHING; columns as usize * rows as usize];
        let mut locator = Self { mesh, slots };
        for index in 0..mesh.triangles.len() {
            locator.insert(TriangleId::from_index(index));
        }
        locator
    }

    fn insert(&mut self, id: TriangleId) {
        let [a, b, c] = self.mesh.corners(id).map(|c| c.as_dvec2());
        let middle = (a + b + c) / 3.0;
        // A triangle at level l is about a cell halved l / 2 times; four levels divide a bucket once.
        let depth = (self.mesh.triangle(id).level() + 2) / 4;
        let (x, y) = (middle.x as u32, middle.y as u32);
        let mut slot = self.root(x, y);
        let mut shift = self.mesh.lattice.halvings();
        for _ in 0..depth {
            let Some(finer) = shift.checked_sub(FAN_BITS) else { break };
            shift = finer;
            let first = match self.slots[slot].children() {
                Some(first) => first,
                None => self.divide(slot),
            };
            slot = first + child(x, y, shift);
        }
        if self.slots[slot].children().is_none() {
            self.slots[slot] = Slot::hint(id);
        }
    }

    fn divide(&mut self, slot: usize) -> usize {
        let first = self.slots.len();
        let hint = self.slots[slot];
        self.slots.resize(first + FAN * FAN, hint);
        self.slots[slot] = Slot::divided(first);
        first
    }

    #[inline]
    fn root(&self, x: u32, y: u32) -> usize {
        let [columns, rows] = self.mesh.lattice.cells();
        let halvings = self.mesh.lattice.halvings();
        let (column, row) = ((x >> halvings).min(columns - 1), (y >> halvings).min(rows - 1));
        row as usize * columns as usize + column as usize
    }

    /// Finds the triangle that contains a point in world coordinates. Same answers as [`Mesh::locate`].
    #[inline]
    pub fn locate(&self, point: DVec2) -> Location {
        let p = self.mesh.lattice.lattice_from_world(point);
        let extent = self.mesh.lattice.extent().as_dvec2();
        if p.cmpge(DVec2::ZERO).all()
            && p.cmple(extent).all()
            && let Some(hint) = self.hint(p)
            && let WalkEnd::Found(triangle, [Side::Left, Side::Left, Side::Left]) = self.mesh.walk(hint, p)
        {
            return Location::Inside { triangle };
        }
        self.mesh.locate(point)
    }

    #[inline]
    fn hint(&self, p: DVec2) -> Option<TriangleId> {
        let (x, y) = (p.x as u32, p.y as u32);
        let mut slot = self.slots[self.root(x, y)];
        let mut shift = self.mesh.lattice.halvings();
        // Ends: each turn goes down the tree, and `insert` stops before the shift would run out.
        while let Some(first) = slot.children() {
            shift -= FAN_BITS;
            slot = self.slots[first + child(x, y, shift)];
        }
        (slot.0 != Slot::NOTHING.0).then_some(TriangleId(slot.0))
    }
}

#[inline]
fn child(x: u32, y: u32, shift: u32) -> usize {
    let mask = FAN as u32 - 1;
    (((y >> shift) & mask) << FAN_BITS | ((x >> shift) & mask)) as usize
}
