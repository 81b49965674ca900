//! Ω, the domain: a rectangle, or the part of it that a formula or polygons say; and how the mesh meets its boundary.

mod comparison;
mod edge;
mod fit;
mod on_lattice;
mod region;
mod region_builder;
mod cut_shape;
mod tangle;

use std::sync::Arc;

use crate::field::Formula;
use crate::geometry::Rect;
use crate::text::Grouped;

pub use comparison::RegionComparison;
pub use cut_shape::CutShape;
pub use fit::{BoundaryTreatment, DomainOnLattice, DomainOnLatticeBuilder};
pub use on_lattice::RegionOnLattice;
pub use region::{Polygon, Region, Ring, corners, signed_area};
use tangle::check_tangle;
pub use tangle::{MOST_CORNERS, MOST_CROSSINGS};

/// A domain in world units.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// The rectangle that the coarse grid covers.
    pub bounds: Rect,
    /// Which part of it is meant.
    pub shape: DomainShape,
}

/// Why polygons make no domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegionError {
    /// They cover nothing.
    #[error("The polygons cover no area: a ring needs three corners that are not on one line.")]
    NoArea,
    /// Sides are beyond f64.
    #[error("The polygons reach too far: the width and the height round them must be finite numbers.")]
    TooLarge,
    /// More corners than can be worked with.
    #[error(
        "The polygons have {} corners, and at most {} can be worked with. Simplify the outline first, to the detail that the \
         mesh is to have.",
        Grouped(*corners), Grouped(MOST_CORNERS)
    )]
    TooManyCorners {
        /// Corners of all rings.
        corners: usize,
    },
    /// Edges cross all over.
    #[error(
        "The rings cross themselves or each other more than {} times, so that nobody could say what they enclose. Check that \
         the points come in the order of the outline.",
        Grouped(MOST_CROSSINGS)
    )]
    Tangled,
    /// Too many edges are too long.
    #[error(
        "Of the polygons' {} edges so many reach across so much of the width that they cannot be worked with. Simplify the \
         outline first, or cut it into pieces.",
        Grouped(*edges)
    )]
    Sprawling {
        /// Edges of all rings.
        edges: usize,
    },
}

/// Which part of a rectangle is meant.
#[derive(Clone, Debug, PartialEq)]
pub enum DomainShape {
    /// All of it.
    Whole,
    /// Where the formula is neither zero nor NaN.
    Formula(Formula),
    /// What polygons cover.
    Region(Arc<Region>),
}

impl Domain {
    /// The whole of a rectangle.
    pub fn rectangle(bounds: Rect) -> Self {
        Self { bounds, shape: DomainShape::Whole }
    }

    /// What polygons cover; the bounds are the rectangle round them, so that straight sides along it are met exactly.
    ///
    /// # Errors
    /// When they cover nothing, or too much lies too close together to tell what.
    pub fn of_polygons(polygons: &[Polygon]) -> Result<Self, RegionError> {
        let points = polygons.iter().flatten().flatten().map(|&p| Rect::new(p, p));
        let bounds = points.reduce(|a, b| a.union(&b)).filter(Rect::is_proper).ok_or(RegionError::NoArea)?;
        if !bounds.size().is_finite() {
            return Err(RegionError::TooLarge);
        }
        check_tangle(polygons, &bounds)?;
        Self::of_region(Region::new(polygons, bounds))
    }

    /// The domain whose [`Region::polygons`] these are, in `bounds`, which must be proper. It comes back corner by corner; other
    /// polygons are taken as by [`Self::of_polygons`].
    ///
    /// # Errors
    /// As [`Self::of_polygons`].
    pub fn of_stored_polygons(polygons: Vec<Polygon>, bounds: Rect) -> Result<Self, RegionError> {
        check_tangle(&polygons, &bounds)?;
        Self::of_region(Region::stored(polygons, bounds))
    }

    fn of_region(region: Region) -> Result<Self, RegionError> {
        if region.is_empty() {
            return Err(RegionError::NoArea);
        }
        Ok(Self { bounds: *region.frame(), shape: DomainShape::Region(Arc::new(region)) })
    }

    /// The polygons, if the domain has some.
    pub fn region(&self) -> Option<&Arc<Region>> {
        match &self.shape {
            DomainShape::Region(region) => Some(region),
            DomainShape::Whole | DomainShape::Formula(_) => None,
        }
    }

    /// The polygons, or the whole rectangle as one; `None` for a formula.
    pub fn as_region(&self) -> Option<Arc<Region>> {
        match &self.shape {
            DomainShape::Region(region) => Some(region.clone()),
            DomainShape::Whole => Some(Arc::new(Region::new(&[vec![corners(&self.bounds)]], self.bounds))),
            DomainShape::Formula(_) => None,
        }
    }

    /// The formula, if the domain has one.
    pub fn formula(&self) -> Option<&Formula> {
        match &self.shape {
            DomainShape::Formula(formula) => Some(formula),
            DomainShape::Whole | DomainShape::Region(_) => None,
        }
    }

    /// The domain with other bounds. Polygons are cut off where these are smaller.
    pub fn with_bounds(&self, bounds: Rect) -> Self {
        let shape = match &self.shape {
            DomainShape::Region(region) if bounds.is_proper() => {
                DomainShape::Region(Arc::new(region.reframed(bounds)))
            }
            other => other.clone(),
        };
        Self { bounds, shape }
    }
}
