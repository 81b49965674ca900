//! The water of a surface of depths as polygons: where it is deeper than a level.
//!
//! A pixel is water where its depth is more than the level; one without a value is none. The outline runs
//! between the centres of pixels: where both depths are known, linear between them, otherwise halfway. It
//! stays a thousandth of the way off each centre, so that rings never touch. Where water meets water at a
//! corner of four centres only, the mean of their depths decides, and where one is unknown the land is
//! joined. Beyond the outermost centres, the depths of the last pixels continue to the sides of the raster,
//! along which the outline closes.

mod opening;
mod trace;

use glam::DVec2;

use super::{Polygon, Ring, signed_area};
use crate::geometry::Rect;
use crate::raster::Raster;
use crate::text::Number;

/// The radius of a sphere with the surface of the Earth, in metres.
const EARTH_RADIUS: f64 = 6_371_007.2;

/// What the polygons are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthContour {
    /// Water is deeper than this, in metres; negative where land up to a height counts.
    pub level: f64,
    /// Islands and waters with a smaller area are left out; 0 for none.
    pub smallest_island: f64,
    /// Inlets narrower than this are closed; 0 for none. Water stays where a disc with this diameter and one
    /// pixel, around the centre of a pixel, holds no centre of a pixel of land; and with it all pixels with
    /// their centres in the disc. Beyond the sides of the raster there is no land.
    pub smallest_inlet: f64,
}

/// How lengths follow from the coordinates of a raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelLengths {
    /// They are lengths in a plane.
    Plane,
    /// They are longitudes and latitudes in degrees; lengths are in metres, on a sphere.
    Degrees,
}

/// Why there are no polygons.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DepthContourError {
    /// A number that cannot be used.
    #[error("The {name} is {}; it must be {rule}.", Number(*value))]
    Number {
        /// The name of the number.
        name: &'static str,
        /// The number as it was given.
        value: f64,
        /// The rule.
        rule: &'static str,
    },
    /// No pixel is deep enough.
    #[error(
        "no pixel is deeper than {} m: the greatest depth is {} m. Choose another level, or say whether the values are \
         heights or depths.",
        Number(*level), Number(*deepest)
    )]
    Dry {
        /// The level.
        level: f64,
        /// The greatest depth of any pixel; −∞ where none has a value.
        deepest: f64,
    },
    /// No pixel has a value.
    #[error("no pixel has a value, so that there is no domain. Leave the choice out, or take another file.")]
    NoValues,
    /// Nothing is left of the water.
    #[error("all water deeper than {} m is in inlets or waters smaller than asked for. Choose smaller ones.", Number(*level))]
    TooSmall {
        /// The level.
        level: f64,
    },
}

impl DepthContour {
    /// The shore, with all islands and inlets.
    pub const SHORE: Self = Self { level: 0.0, smallest_island: 0.0, smallest_inlet: 0.0 };

    /// Checks the numbers.
    ///
    /// # Errors
    /// Fails with the first that cannot be used.
    pub fn check(&self) -> Result<(), DepthContourError> {
        let Self { level, smallest_island, smallest_inlet } = *self;
        let error = |name, value, rule| Err(DepthContourError::Number { name, value, rule });
        if !level.is_finite() {
            return error("level of the contour", level, "a finite depth in metres");
        }
        for (name, value) in [("smallest island", smallest_island), ("smallest inlet", smallest_inlet)] {
            if !(value >= 0.0 && value.is_finite()) {
                return error(name, value, "0 or more, and finite");
            }
        }
        Ok(())
    }

    /// Returns the water of a raster as polygons in its coordinates, the largest first. `depth_of` is the
    /// depth for a value, in metres.
    ///
    /// # Errors
    /// Fails when a number cannot be used, and where there is no water.
    pub fn polygons(
        &self,
        raster: &Raster,
        lengths: PixelLengths,
        depth_of: impl Fn(f64) -> f64,
    ) -> Result<Vec<Polygon>, DepthContourError> {
        self.check()?;
        let depth = |&value: &f32| if value.is_nan() { f32::NAN } else { depth_of(value.into()) as f32 };
        let depths: Vec<f32> = raster.values().iter().map(depth).collect();
        let mut water: Vec<bool> = depths.iter().map(|&depth| f64::from(depth) > self.level).collect();
        if !water.contains(&true) {
            let deepest =
                depths.iter().copied().filter(|depth| !depth.is_nan()).fold(f32::NEG_INFINITY, f32::max);
            return Err(DepthContourError::Dry { level: self.level, deepest: deepest.into() });
        }
        if self.smallest_inlet > 0.0 {
            opening::open(&mut water, raster, lengths, self.smallest_inlet);
        }
        let rings = trace::rings(&trace::WaterPixels {
            bounds: raster.bounds(),
            size: raster.size(),
            depths: &depths,
            level: self.level,
            water: &water,
        });
        let polygons = self.large_enough(rings, lengths);
        if polygons.is_empty() {
            Err(DepthContourError::TooSmall { level: self.level })
        } else {
            Ok(polygons)
        }
    }

    /// Returns the part of a raster that has values as polygons in its coordinates, the largest first. Their
    /// outline runs halfway between the centres of a pixel with a value and one without.
    ///
    /// # Errors
    /// Fails when a number cannot be used, and where no pixel has a value.
    pub fn polygons_of_values(
        &self,
        raster: &Raster,
        lengths: PixelLengths,
    ) -> Result<Vec<Polygon>, DepthContourError> {
        match (Self { level: 0.0, ..*self })
            .polygons(raster, lengths, |value| if value.is_finite() { 1.0 } else { f64::NAN })
        {
            Err(DepthContourError::Dry { .. }) => Err(DepthContourError::NoValues),
            polygons => polygons,
        }
    }

    /// Returns the waters with their islands that are large enough, the largest first.
    fn large_enough(&self, rings: Vec<trace::TracedRing>, lengths: PixelLengths) -> Vec<Polygon> {
        let areas: Vec<f64> = rings.iter().map(|ring| lengths.area(&ring.points).abs()).collect();
        let stays = |number: usize| areas[number] >= self.smallest_island && areas[number] > 0.0;
        // The numbers of the outer ring and of the holes of each water.
        let mut waters: Vec<(usize, Vec<usize>)> = Vec::new();
        let mut place_of: Vec<Option<usize>> = vec![None; rings.len()];
        for (number, _) in rings.iter().enumerate().filter(|(n, ring)| ring.around.is_none() && stays(*n)) {
            place_of[number] = Some(waters.len());
            waters.push((number, Vec::new()));
        }
        for (number, ring) in rings.iter().enumerate().filter(|(n, _)| stays(*n)) {
            if let Some(place) = ring.around.and_then(|outer| place_of[outer]) {
                waters[place].1.push(number);
            }
        }
        let larger_first = |a: &usize, b: &usize| areas[*b].total_cmp(&areas[*a]).then(a.cmp(b));
        waters.sort_by(|a, b| larger_first(&a.0, &b.0));
        let points = |number: usize| rings[number].points.clone();
        let polygon = |(outer, mut holes): (usize, Vec<usize>)| {
            holes.sort_by(larger_first);
            std::iter::once(outer).chain(holes).map(points).collect()
        };
        waters.into_iter().map(polygon).collect()
    }
}

impl PixelLengths {
    /// Returns the area of a ring, above zero where it is counter-clockwise: in square metres on the Earth.
    fn area(self, ring: &Ring) -> f64 {
        match self {
            Self::Plane => signed_area(ring),
            // The cylinder around the sphere has areas like those of the sphere.
            Self::Degrees => {
                let on_cylinder =
                    |at: &DVec2| EARTH_RADIUS * DVec2::new(at.x.to_radians(), libm::sin(at.y.to_radians()));
                signed_area(&ring.iter().map(on_cylinder).collect::<Ring>())
            }
        }
    }

    /// Returns the sides of a pixel in a row, as lengths.
    fn pixel(self, raster: &Raster, row: u32) -> DVec2 {
        let side = raster.pixel_size();
        match self {
            Self::Plane => side,
            Self::Degrees => {
                let Rect { min, .. } = raster.bounds();
                let latitude = (min.y + (f64::from(row) + 0.5) * side.y).to_radians();
                EARTH_RADIUS
                    * DVec2::new(side.x.to_radians() * libm::cos(latitude).max(0.0), side.y.to_radians())
            }
        }
    }
}

#[cfg(test)]
mod tests;
