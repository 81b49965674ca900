//! The search of several areas that together are large: through all entries of the array.

use super::BATCH;
use super::area::Area;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::mesh::kernel::Mesh;

/// A search of several areas at once, down the array from its end.
///
/// Most entries of a fine mesh are left out by their level alone: from neighbour to neighbour, each of them
/// would be looked up in memory with its neighbours.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    areas: Vec<Area>,
    grid: AreaGrid,
    /// No area concerns a triangle of this level or a finer one.
    levels: u32,
    /// The entries before this one are still to be looked at: what is appended or moved in the meantime ends
    /// up after it, or was before it already.
    left: usize,
    /// The triangles of this part that are concerned. The mesh changes after each part.
    concerned: usize,
}

/// What the changes of all areas can have done to a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Concern {
    /// It can have begun to exceed its target.
    pub(super) asks: bool,
    /// Its parent can have ceased to.
    pub(super) loosens: bool,
    /// It counts as changed.
    pub(super) is_reported: bool,
}

impl Concern {
    pub(super) fn is_none(self) -> bool {
        self == Self::default()
    }

    fn or(self, other: Self) -> Self {
        Self {
            asks: self.asks || other.asks,
            loosens: self.loosens || other.loosens,
            is_reported: self.is_reported || other.is_reported,
        }
    }
}

impl Scan {
    pub(super) fn new(mesh: &Mesh, areas: Vec<Area>) -> Self {
        let grid = AreaGrid::new(mesh, &areas);
        let levels = areas.iter().map(|area| area.levels(mesh)).max().unwrap_or(0);
        Self { areas, grid, levels, left: mesh.raw_triangle_count(), concerned: 0 }
    }

    /// Ends the search, and returns its areas.
    pub(super) fn into_areas(self) -> Vec<Area> {
        self.areas
    }

    /// Returns whether an entry is still to be looked at.
    #[inline]
    pub(super) fn is_left(&self, entry: usize) -> bool {
        entry < self.left
    }

    /// Returns whether a part has been searched, after which the mesh changes.
    pub(super) fn has_part(&self) -> bool {
        self.concerned >= BATCH
    }

    /// Begins another part.
    pub(super) fn begin_part(&mut self) {
        self.concerned = 0;
    }

    /// Takes the last `most` entries that are left; fewer where the array has become shorter.
    pub(super) fn take(&mut self, mesh: &Mesh, most: usize) -> std::ops::Range<usize> {
        let end = self.left.min(mesh.raw_triangle_count());
        self.left = end.saturating_sub(most);
        self.left..end
    }

    /// Returns whether no entry is left.
    pub(super) fn is_done(&self) -> bool {
        self.left == 0
    }

    /// Returns whether a triangle of this level can be concerned.
    #[inline]
    pub(super) fn has_level(&self, level: u32) -> bool {
        level < self.levels
    }

    /// Returns what the changes can have done to a triangle.
    #[inline]
    pub(super) fn concern(&mut self, mesh: &Mesh, corners: [LatticePoint; 3], level: u32) -> Concern {
        let mut found = Concern::default();
        for near in self.grid.near(corners) {
            let area = &self.areas[near.area as usize];
            if level < near.levels && area.changed.rect.touches(corners) {
                found = found.or(area.concern(mesh, corners, level));
            }
        }
        self.concerned += usize::from(!found.is_none());
        found
    }
}

/// The areas that meet each square of a grid over the lattice.
#[derive(Clone, Debug)]
struct AreaGrid {
    /// The logarithm of the side of the squares, in lattice steps.
    bits: u32,
    /// For each square, row by row, the place of its first entry; and the number of all entries.
    starts: Vec<u32>,
    entries: Vec<Near>,
}

/// An area that meets a square.
#[derive(Clone, Copy, Debug)]
struct Near {
    area: u32,
    /// See [`Area::levels`].
    levels: u32,
}

/// The logarithm of the number of squares along a side.
const SIDE_BITS: u32 = 6;

impl AreaGrid {
    fn new(mesh: &Mesh, areas: &[Area]) -> Self {
        let extent = mesh.lattice().extent();
        let bits = (u32::BITS - extent.x.max(extent.y).leading_zeros()).saturating_sub(SIDE_BITS);
        let mut pairs: Vec<(u32, Near)> = Vec::new();
        for (number, area) in areas.iter().enumerate() {
            let near = Near { area: number as u32, levels: area.levels(mesh) };
            pairs.extend(squares(bits, area.changed.rect).map(|square| (square, near)));
        }
        // An area meets a square once: the order is that of the areas.
        pairs.sort_by_key(|&(square, _)| square);
        let first = |square: u32| pairs.partition_point(|&(other, _)| other < square) as u32;
        let starts = (0..=1 << (2 * SIDE_BITS)).map(first).collect();
        Self { bits, starts, entries: pairs.into_iter().map(|(_, near)| near).collect() }
    }

    /// Returns the areas that meet the squares around a triangle, one of them more than once where it meets
    /// several.
    #[inline]
    fn near(&self, [a, b, c]: [LatticePoint; 3]) -> impl Iterator<Item = Near> {
        let hull = LatticeRect {
            min: LatticePoint::new(a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)),
            max: LatticePoint::new(a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)),
        };
        squares(self.bits, hull).flat_map(|square: u32| {
            let [from, to] = [square, square + 1].map(|n| self.starts[n as usize] as usize);
            self.entries[from..to].iter().copied()
        })
    }
}

/// Returns the numbers of the squares that a rectangle meets.
#[inline]
fn squares(bits: u32, rect: LatticeRect) -> impl Iterator<Item = u32> {
    let [x0, y0, x1, y1] = [rect.min.x, rect.min.y, rect.max.x, rect.max.y].map(|v| v >> bits);
    (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| (y << SIDE_BITS) + x))
}
