//! Adding an outline to a document that has paint already.

use std::sync::Arc;

use super::{Setting, Settings};
use crate::domain::{
    BoundaryMarks, DepthContour, DepthContourError, Domain, NamedPolygon, OutlineOnEarth, PixelLengths,
    Polygon, RegionError,
};
use crate::earth::Coordinates;
use crate::geometry::{GridError, Rect};
use crate::layers::Depths;
use crate::raster::Raster;
use crate::text::{LengthUnit, Number};

/// Why polygons cannot be added to a document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// They are not a domain.
    #[error(transparent)]
    Region(#[from] RegionError),
    /// There is no such contour.
    #[error(transparent)]
    Contour(#[from] DepthContourError),
    /// The domain is given by a formula.
    #[error(
        "The domain of this document is given by a formula, and polygons cannot be added to that. Empty the row \"Domain \
         where\" first."
    )]
    Formula,
    /// They lie elsewhere.
    #[error(
        "The outline lies outside this document: it covers {}, and the document {}. Open it as a document of its own, or \
         check that both have the same coordinates.",
        extent(outline),
        extent(document)
    )]
    Outside {
        /// Bounds of the outline.
        outline: Rect,
        /// Bounds of the document.
        document: Rect,
    },
    /// They reach so far beyond the document that the coarse grid is impossible.
    #[error(
        "The outline reaches too far beyond this document. {0} Raise the coarse spacing first, or open the outline as a \
         document of its own."
    )]
    TooLarge(GridError),
}

/// Decimal places of the ends of an extent beyond the first one of its longer side.
const PLACES_OF_EXTENT: f64 = 6.0;

/// Returns ranges of x and y, in words: to a millionth of the longer side.
pub fn extent(bounds: &Rect) -> String {
    let first = libm::log10(bounds.size().max_element()).floor();
    let places = if first.is_finite() { (PLACES_OF_EXTENT - first).clamp(0.0, 300.0) as usize } else { 17 };
    let shown = |value: f64| Number(format!("{value:.places$}").parse().unwrap_or(value));
    let [x0, y0, x1, y1] = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y].map(shown);
    format!("x from {x0} to {x1} and y from {y0} to {y1}")
}

impl Settings {
    /// Returns the setting that makes polygons the domain, or adds them to the polygons that it is given by.
    /// Paint and all other settings stay.
    ///
    /// The bounds grow as far as the polygons need.
    ///
    /// # Errors
    /// Fails when the polygons are not a domain, lie outside the bounds, or need too large a coarse grid.
    pub fn with_outline(&self, polygons: &[NamedPolygon]) -> Result<Setting, OutlineError> {
        let before = &self.domain;
        if before.formula().is_some() {
            return Err(OutlineError::Formula);
        }
        let plain: Vec<Polygon> = polygons.iter().map(|named| named.polygon.clone()).collect();
        let on_earth = self.outline_on_earth();
        let added = Domain::of_polygons_on_earth(&plain, &on_earth)?;
        let outline = added.bounds;
        if before.bounds.intersection(&outline).is_none_or(|common| !common.is_proper()) {
            return Err(OutlineError::Outside { outline, document: before.bounds });
        }
        let bounds = before.bounds.union(&outline);
        let earlier = before.region().map_or(&[][..], |region| region.polygons());
        let domain = Domain::of_stored_polygons([earlier, &plain].concat(), bounds, &on_earth)?;
        // What was open before stays open, and so do the sides of the outline that is added.
        let domain = match before.region() {
            Some(region) => domain.cut_by([region.cuts(), added.cuts()].concat()),
            None => domain,
        };
        let mut marks = (*self.boundary_marks).clone();
        marks.names.extend(BoundaryMarks::of_polygons(polygons, &domain).names);
        let grown = Self { domain: domain.clone(), ..self.clone() };
        grown.lattice().map_err(OutlineError::TooLarge)?;
        Ok(Setting::Outline { domain, boundary_marks: Arc::new(marks) })
    }

    /// Returns the setting that makes a contour of depths the domain: their water, as far as it is in the
    /// bounds of the domain. Names and types of the boundary stay where they were.
    ///
    /// # Errors
    /// Fails when there is no water, the depths lie outside the bounds, or need too large a coarse grid.
    pub fn with_contour(&self, depths: &Depths, contour: &DepthContour) -> Result<Setting, OutlineError> {
        let raster = depths.source().raster.raster();
        let depth_of = |value| depths.sizes().depth_of(value);
        self.with_polygons_on(raster, contour.polygons(raster, self.pixel_lengths(), depth_of)?)
    }

    /// Returns the setting that makes the part of a raster that has values the domain, within the rectangle
    /// of the document.
    ///
    /// # Errors
    /// Fails when no pixel has a value, when the raster is outside the document, and when the polygons are
    /// too many.
    pub fn with_values_of(&self, raster: &Raster) -> Result<Setting, OutlineError> {
        let polygons = DepthContour::SHORE.polygons_of_values(raster, self.pixel_lengths())?;
        self.with_polygons_on(raster, polygons)
    }

    /// Returns what the coordinates of files with outlines are for this document, as far as is known:
    /// longitudes and latitudes, where it lies on the Earth.
    pub fn coordinates_of_outlines(&self) -> Option<Coordinates> {
        let is_geographic = self.unit == LengthUnit::Degree || self.domain.projection.is_some();
        is_geographic.then_some(Coordinates::Geographic)
    }

    fn pixel_lengths(&self) -> PixelLengths {
        match self.outline_on_earth().file {
            Some(Coordinates::Geographic) => PixelLengths::Degrees,
            _ => PixelLengths::Plane,
        }
    }

    /// Returns what the coordinates of an outline mean that is in world units.
    fn outline_on_earth(&self) -> OutlineOnEarth {
        let projection = self.domain.projection;
        let is_geographic = projection.is_none() && self.unit == LengthUnit::Degree;
        OutlineOnEarth { file: is_geographic.then_some(Coordinates::Geographic), projection, frame: None }
    }

    fn with_polygons_on(&self, raster: &Raster, polygons: Vec<Polygon>) -> Result<Setting, OutlineError> {
        let before = &self.domain;
        let bounds = before.bounds.intersection(&raster.bounds()).filter(Rect::is_proper);
        let outside = OutlineError::Outside { outline: raster.bounds(), document: before.bounds };
        let bounds = bounds.ok_or(outside)?;
        let domain = Domain::of_stored_polygons(polygons, bounds, &self.outline_on_earth())?;
        // Beyond the sides of a grid that was projected there are no values, and the sea goes on.
        let domain = match before.open_frame() {
            Some(frame) => domain.within(frame),
            None => domain,
        };
        let changed = Self { domain: domain.clone(), ..self.clone() };
        changed.lattice().map_err(OutlineError::TooLarge)?;
        Ok(Setting::Outline { domain, boundary_marks: self.boundary_marks.clone() })
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn an_extent_is_told_to_a_millionth_of_its_longer_side() {
        let told = |low, high| extent(&Rect::new(low, high));
        let grid = told(dvec2(-84.066_666_666_805_49, 36.5), dvec2(-83.730_833_333_472_16, 36.786_666_7));
        assert_eq!(grid, "x from -84.0666667 to -83.7308333 and y from 36.5 to 36.7866667");
        assert_eq!(told(dvec2(0.0, -3.0), dvec2(20_000.0, 1e-9)), "x from 0 to 20000 and y from -3 to 0");
        assert_eq!(told(dvec2(1e-9, 0.0), dvec2(3e-9, 1e-9)), "x from 1e-9 to 3e-9 and y from 0 to 1e-9");
        assert_eq!(told(dvec2(2.5, 2.5), dvec2(2.5, 2.5)), "x from 2.5 to 2.5 and y from 2.5 to 2.5");
    }
}
