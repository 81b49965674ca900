use std::sync::Arc;

use super::{Projection, ScaleMap};
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::bisection_edge_length;

/// Number of levels with a length. A lattice has fewer.
pub const LEVELS: usize = 64;

/// The diameters of triangles, ℓ_b of Eq. (1), in the unit of target diameters: world units, or metres on the
/// ellipsoid where the lattice lies in the plane of a projection.
///
/// There, the length is that in the plane by the least scale in the dyadic square around the triangle. So it
/// is no shorter than any edge is on the ellipsoid, and no longer for a triangle within the first one.
///
/// All lengths are in one table. A *limit* is a place in it: [`LEVELS`] · band + level, with the bands of a
/// [`ScaleMap`]. Without a projection there is one band.
#[derive(Clone, Debug)]
pub struct EdgeLengths {
    table: Arc<[f64]>,
    scale: Option<Arc<ScaleMap>>,
    halvings: u32,
    /// The length of the largest triangle in the plane.
    longest_in_plane: f64,
}

/// Diameters that are longer than a target by this share meet it: scales are rounded.
const ROUNDING: f64 = 1e-12;

impl EdgeLengths {
    /// Returns the lengths for a lattice, which may lie in the plane of a projection.
    pub fn new(projection: Option<&Projection>, lattice: &Lattice) -> Self {
        let scale = projection.map(|projection| Arc::new(ScaleMap::new(projection, lattice)));
        let of_level = |level: usize| bisection_edge_length(lattice.spacing(), level as u32);
        let of_band = |scale: f64| (0..LEVELS).map(move |level| of_level(level) / scale);
        let table = match &scale {
            None => of_band(1.0).collect(),
            Some(map) => {
                let scales = (0..map.band_count()).map(|band| map.scale_of(band) * (1.0 + ROUNDING));
                scales.flat_map(of_band).collect()
            }
        };
        Self { table, scale, halvings: lattice.halvings(), longest_in_plane: of_level(0) }
    }

    /// Returns the lengths divided by a number, to be compared with targets that are multiplied by it.
    pub fn divided_by(&self, scale: f64) -> Self {
        Self { table: self.table.iter().map(|length| length / scale).collect(), ..self.clone() }
    }

    /// Returns the lengths of all limits.
    pub fn table(&self) -> &Arc<[f64]> {
        &self.table
    }

    /// Returns the limit of a triangle, given by its corners and level; `None` for a level that no lattice
    /// has.
    #[inline]
    pub fn limit(&self, corners: [LatticePoint; 3], level: u32) -> Option<usize> {
        let level_in_band = Some(level as usize).filter(|&level| level < LEVELS)?;
        let band = self.scale.as_ref().map_or(0, |scale| scale.band_around(corners, level, self.halvings));
        Some(LEVELS * band + level_in_band)
    }

    /// Returns the length of a triangle, given by its corners and level; 0 for a level that no lattice has.
    #[inline]
    pub fn of(&self, corners: [LatticePoint; 3], level: u32) -> f64 {
        self.limit(corners, level).map_or(0.0, |limit| self.table[limit])
    }

    /// Returns the length of a line of length 1 in the plane, in a triangle that need not be one of a mesh:
    /// no shorter than on the ellipsoid, and no longer than in a triangle of a mesh around it.
    pub fn of_unit_in(&self, corners: [LatticePoint; 3]) -> f64 {
        let longest = |band: usize| self.table[LEVELS * band] / self.longest_in_plane;
        let Some(scale) = &self.scale else { return longest(0) };
        let [min, max] = [
            corners.iter().fold([u32::MAX; 2], |[x, y], p| [x.min(p.x), y.min(p.y)]),
            corners.iter().fold([0; 2], |[x, y], p| [x.max(p.x), y.max(p.y)]),
        ];
        let side = (max[0] - min[0]).max(max[1] - min[1]).max(1);
        let bits = side.next_power_of_two().ilog2();
        let [first, last] = [min.map(|v| v >> bits), [0, 1].map(|n| (max[n] - 1).max(min[n]) >> bits)];
        let squares =
            (first[1]..=last[1]).flat_map(|row| (first[0]..=last[0]).map(move |column| [column, row]));
        longest(squares.map(|place| scale.band_in(bits, place)).min().unwrap_or(0))
    }

    /// Returns the length of the largest triangle.
    pub fn longest(&self) -> f64 {
        self.table[0]
    }

    /// Returns the least scale; 1 without a projection.
    pub fn least_scale(&self) -> f64 {
        self.scale.as_ref().map_or(1.0, |scale| scale.scale_of(0))
    }

    /// Returns the greatest scale; 1 without a projection.
    pub fn greatest_scale(&self) -> f64 {
        self.scale.as_ref().map_or(1.0, |scale| scale.greatest())
    }

    /// Returns the bands of the minimum and the maximum scale in the square of 2^bits lattice steps that is
    /// number `place` along x and y.
    pub fn bands_in(&self, bits: u32, place: [u32; 2]) -> [usize; 2] {
        self.scale.as_ref().map_or([0; 2], |scale| scale.bands_in(bits, place))
    }

    /// Returns the first level whose triangles around a place within the lattice are no longer than a target
    /// diameter.
    pub fn first_level_at(&self, place: LatticePoint, diameter: f64) -> u32 {
        let [band, _] = self.bands_in(0, [place.x, place.y]);
        self.first_level_within(band, diameter)
    }

    /// Returns the first level in a band whose triangles are no longer than a target diameter.
    pub fn first_level_within(&self, band: usize, diameter: f64) -> u32 {
        // An array of a known length is searched faster than a slice.
        let (bands, _) = self.table.as_chunks::<LEVELS>();
        bands[band].partition_point(|&length| length > diameter) as u32
    }
}
