//! Ω, the domain: a rectangle or a part of it, given by a formula or by polygons; and how the mesh meets its
//! boundary.

mod boundary;
mod comparison;
mod outline_edge;
mod fit;
mod fit_quality;
mod lines;
mod on_lattice;
mod outline;
mod outline_query;
mod region;
mod region_builder;
mod marching;
mod zero_line;
mod formula_shape;
mod missed_corners;
mod cut_frame;
mod cut_search;
mod cut_shape;
mod depth_contour;
mod complexity;
mod file_frame;
mod coast_lines;
mod sea;
mod segments;
mod farthest;
mod holes;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use crate::earth::{Coordinates, GeographicExtent, Ground, Projection, Reprojection};
use crate::field::Formula;
use crate::geometry::{LatticePoint, Rect};
use crate::mesh::Extract;
use crate::text::Grouped;

pub use crate::geometry::signed_area;
pub use boundary::{
    BoundaryKind, BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryType, CoastEdge, Coasts,
    LONGEST_NAME, MeshBoundary, NamedPolygon, PieceChoice, PieceFigures, PieceRun, coasts,
};
pub use comparison::RegionComparison;
use complexity::check_complexity;
pub use complexity::{MOST_CORNERS, MOST_CROSSINGS};
pub use cut_frame::{CutFrame, FrameSide};
pub use cut_search::OutlineOnEarth;
pub use cut_shape::CutShape;
pub use depth_contour::{DepthContour, DepthContourError, PixelLengths};
pub use file_frame::FileFrame;
pub use fit::{BoundaryTreatment, DomainOnLattice, DomainOnLatticeBuilder};
pub use fit_quality::{FitComparison, FitQuality};
pub use formula_shape::FormulaShape;
pub use holes::HoleFigures;
pub use lines::{
    Crest, CrestOnGrid, Line, LineKind, LineWeirError, LinesOnLattice, NoCrest, Weir, WeirError,
};
pub(crate) use lines::{LineMeasure, LineOnLattice, LinePart, cross, crossing, is_near, lies_between, place};
pub(crate) use missed_corners::COS_30;
pub use on_lattice::RegionOnLattice;
pub(crate) use outline::RegionOutline;
pub(crate) use outline_query::OutlineNearby;
pub use region::{Polygon, Region, Ring, corners};
pub use sea::{Land, Sea, SeaError, WaterSide};
pub use zero_line::ZeroLineError;

/// Scales that differ from 1 by less than this are 1.
const TRUE_TO_SCALE: f64 = 1e-9;

/// A domain in world units.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// The rectangle that the coarse grid covers.
    pub bounds: Rect,
    /// The part of the rectangle.
    pub shape: DomainShape,
    /// Where the domain lies on the Earth, if it does: world units are metres in the plane of this
    /// projection.
    pub projection: Option<Projection>,
}

/// Why polygons are not a valid domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionError {
    /// They cover no area.
    #[error("The polygons cover no area: a ring needs three corners that are not on one line.")]
    NoArea,
    /// They are too large or too small.
    #[error(
        "The polygons are too large or too small: their width and their height must lie between {:e} and {:e}, and no \
         coordinate beyond that. Check the unit of the coordinates.",
        Rect::SHORTEST_SIDE,
        Rect::LONGEST_SIDE
    )]
    Extent,
    /// Too many corners.
    #[error(
        "The polygons have {} corners, and the limit is {}. Simplify the outline first, to the detail that the \
         mesh needs.",
        Grouped(*corners), Grouped(MOST_CORNERS)
    )]
    TooManyCorners {
        /// Corners of all rings.
        corners: usize,
    },
    /// Too many crossings of edges.
    #[error(
        "The rings cross themselves or each other more than {} times, which is the limit. Check that the points are in \
         the order of the outline.",
        Grouped(MOST_CROSSINGS)
    )]
    TooManyCrossings,
    /// Too many long edges: the overlay would take too much memory.
    #[error(
        "Too many of the {} edges of the polygons are long compared with the width. Simplify the outline first, or \
         divide it into several domains.",
        Grouped(*edges)
    )]
    TooManyLongEdges {
        /// Edges of all rings.
        edges: usize,
    },
}

/// A part of a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub enum DomainShape {
    /// All of it.
    Whole,
    /// The part where the formula is neither zero nor NaN.
    Formula(FormulaShape),
    /// The part that polygons cover.
    Region(Arc<Region>),
}

impl From<Formula> for DomainShape {
    fn from(formula: Formula) -> Self {
        Self::Formula(formula.into())
    }
}

impl Domain {
    /// Returns the whole of a rectangle.
    pub fn rectangle(bounds: Rect) -> Self {
        Self { bounds, shape: DomainShape::Whole, projection: None }
    }

    /// Returns the domain that polygons cover. Its bounds are their bounding rectangle, so that the mesh
    /// follows straight sides along it exactly.
    ///
    /// # Errors
    /// Fails when the polygons cover no area, or are too large or too complex.
    pub fn of_polygons(polygons: &[Polygon]) -> Result<Self, RegionError> {
        Self::of_polygons_on_earth(polygons, &OutlineOnEarth::default())
    }

    /// Returns the domain that polygons cover, as [`Self::of_polygons`] does. Where it was cut off from its
    /// surroundings by a box in the coordinates of its file, the sides of the box are open.
    ///
    /// # Errors
    /// Fails as [`Self::of_polygons`] does.
    pub fn of_polygons_on_earth(
        polygons: &[Polygon],
        on_earth: &OutlineOnEarth,
    ) -> Result<Self, RegionError> {
        let corners = polygons.iter().flatten().flatten().copied();
        let bounds = Rect::holding(corners).ok_or(RegionError::NoArea)?;
        if !bounds.is_proper() {
            let is_flat = bounds.size().min_element() == 0.0;
            return Err(if is_flat { RegionError::NoArea } else { RegionError::Extent });
        }
        check_complexity(polygons, &bounds)?;
        let region = Region::new(polygons, bounds);
        // Every crossing becomes a corner.
        match region.corner_count() {
            corners if corners > MOST_CORNERS => Err(RegionError::TooManyCorners { corners }),
            _ => Self::of_region(region, on_earth),
        }
    }

    /// Checks that [`Self::of_stored_polygons`] takes the polygons of a region.
    ///
    /// # Errors
    /// Fails when they are too complex.
    pub fn check_stored_polygons(polygons: &[Polygon], bounds: &Rect) -> Result<(), RegionError> {
        check_complexity(polygons, bounds)
    }

    /// Returns the domain with exactly these polygons in `bounds`, which must be proper, if they are the
    /// [`Region::polygons`] of a region. Other polygons are overlaid as in [`Self::of_polygons`].
    ///
    /// # Errors
    /// Fails as [`Self::of_polygons`] does.
    pub fn of_stored_polygons(
        polygons: Vec<Polygon>,
        bounds: Rect,
        on_earth: &OutlineOnEarth,
    ) -> Result<Self, RegionError> {
        check_complexity(&polygons, &bounds)?;
        Self::of_region(Region::stored(polygons, bounds), on_earth)
    }

    fn of_region(region: Region, on_earth: &OutlineOnEarth) -> Result<Self, RegionError> {
        if region.is_empty() {
            return Err(RegionError::NoArea);
        }
        let region = if *on_earth == OutlineOnEarth::default() { region } else { region.on_earth(on_earth) };
        let (bounds, shape) = (*region.frame(), DomainShape::Region(Arc::new(region)));
        Ok(Self { bounds, shape, projection: on_earth.projection })
    }

    /// Returns the rectangles that cut it off from its surroundings, where polygons give it.
    pub fn cuts(&self) -> &[CutFrame] {
        self.region().map_or(&[], |region| region.cuts())
    }

    /// Returns the domain cut by the bounding rectangle of its outline in the coordinates of its file,
    /// whether or not that looks like it; unless a rectangle is known already.
    pub fn cut_by_own_frame(&self, on_earth: &OutlineOnEarth) -> Self {
        let Some(region) = self.region().filter(|region| region.cuts().is_empty()) else {
            return self.clone();
        };
        self.clone().cut_by(CutFrame::around(region, on_earth).into_iter().collect())
    }

    /// Returns the domain with other rectangles that cut it off from its surroundings, where polygons give
    /// it.
    pub fn cut_by(self, cuts: Vec<CutFrame>) -> Self {
        let shape = match self.shape {
            DomainShape::Region(region) => {
                DomainShape::Region(Arc::new(Arc::unwrap_or_clone(region).cut_by(cuts)))
            }
            other => other,
        };
        Self { shape, ..self }
    }

    /// Returns the region, if the domain is given by polygons all of whose sides are open: a frame around
    /// data, such as a box of degrees in a plane.
    pub(crate) fn open_frame(&self) -> Option<&Arc<Region>> {
        self.region().filter(|region| region.sides().iter().flatten().all(Option::is_some))
    }

    /// Returns the part of a domain that lies in a frame, whose sides are open there; the domain itself
    /// where nothing does, and where no polygons give it.
    pub(crate) fn within(self, frame: &Region) -> Self {
        let within = self.region().map(|region| region.within(frame));
        match within.filter(|region| !region.is_empty()) {
            Some(region) => Self { shape: DomainShape::Region(Arc::new(region)), ..self },
            None => self,
        }
    }

    /// Returns whether it is all of its rectangle.
    pub fn is_whole(&self) -> bool {
        matches!(self.shape, DomainShape::Whole)
    }

    /// Returns the region, if the domain is given by polygons.
    pub fn region(&self) -> Option<&Arc<Region>> {
        match &self.shape {
            DomainShape::Region(region) => Some(region),
            DomainShape::Whole | DomainShape::Formula(_) => None,
        }
    }

    /// Returns the polygons that the mesh meets in a way of treating the boundary: those of the domain, or
    /// the zero line of its formula where nodes or triangles follow that. It is followed now unless it is
    /// known, which takes some 0.15 s for a circle, and can take seconds.
    pub fn outline(&self, boundary: BoundaryTreatment) -> Option<Arc<Region>> {
        match &self.shape {
            DomainShape::Region(region) => Some(region.clone()),
            DomainShape::Formula(shape) if boundary != BoundaryTreatment::Report => {
                shape.outline_in(&self.bounds).ok()
            }
            DomainShape::Whole | DomainShape::Formula(_) => None,
        }
    }

    /// Returns why a mesh cannot follow the zero line of the formula, if it is to do so and cannot. The line
    /// is followed now unless it is known.
    pub fn outline_error(&self, boundary: BoundaryTreatment) -> Option<ZeroLineError> {
        match &self.shape {
            DomainShape::Formula(shape) if boundary != BoundaryTreatment::Report => {
                shape.outline_in(&self.bounds).err()
            }
            DomainShape::Whole | DomainShape::Formula(_) | DomainShape::Region(_) => None,
        }
    }

    /// Returns the region, or the whole rectangle as one; `None` for a formula.
    pub fn as_region(&self) -> Option<Arc<Region>> {
        match &self.shape {
            DomainShape::Region(region) => Some(region.clone()),
            DomainShape::Whole => Some(Arc::new(Region::new(&[vec![corners(&self.bounds)]], self.bounds))),
            DomainShape::Formula(_) => None,
        }
    }

    /// Returns the formula, if the domain is given by one.
    pub fn formula(&self) -> Option<&Formula> {
        match &self.shape {
            DomainShape::Formula(shape) => Some(shape.formula()),
            DomainShape::Whole | DomainShape::Region(_) => None,
        }
    }

    /// Returns the coordinates of each node of a mesh of the domain; `None` where it does not lie on the
    /// Earth.
    pub fn nodes_in(&self, coordinates: &Coordinates, mesh: &Extract) -> Option<Vec<DVec2>> {
        let place = self.place_in(coordinates)?;
        let place = |&node: &LatticePoint| place(mesh.lattice().world_from_lattice(node));
        Some(mesh.nodes().par_iter().map(place).collect())
    }

    /// Returns what gives points of the domain their coordinates; `None` where it does not lie on the Earth.
    ///
    /// Longitudes are within half a turn of that of the centre of the domain: those of a domain across the
    /// antimeridian do not jump, and may be beyond 180 or below −180.
    pub fn place_in(&self, coordinates: &Coordinates) -> Option<impl Fn(DVec2) -> DVec2 + Sync + use<>> {
        let reprojection = Reprojection { from: *coordinates, to: self.projection? };
        let center = reprojection.from_plane(self.bounds.center()).x;
        Some(move |at| reprojection.from.beside(reprojection.from_plane(at), center))
    }

    /// Returns an upper bound, over the bounds, of what a length in the plane is on the Earth; the same
    /// length without a projection.
    pub fn longest_on_earth(&self, length: f64) -> f64 {
        let least = self.least_scale();
        if (least - 1.0).abs() < TRUE_TO_SCALE { length } else { length / least }
    }

    /// Returns a lower bound of the scale in the bounds; 1 without a projection.
    pub fn least_scale(&self) -> f64 {
        self.projection.map_or(1.0, |projection| projection.least_scale_in(&self.bounds))
    }

    /// Returns approximately the largest scale in the bounds; 1 without a projection.
    pub fn greatest_scale(&self) -> f64 {
        let Some(projection) = self.projection else { return 1.0 };
        let extent = GeographicExtent::from_plane(&projection, self.bounds);
        // The scale has no greatest value but on the rim.
        extent.map_or(1.0, |extent| projection.scale_range(&extent)[1])
    }

    /// Returns what a short length in the plane around a point is on the Earth; the same length without a
    /// projection. Many lengths are measured faster by [`Self::ground`].
    pub fn on_earth(&self, length: f64, point: DVec2) -> f64 {
        self.projection.map_or(length, |projection| length / projection.scale_in_plane(point))
    }

    /// Returns what a short length on the Earth is in the plane around a point; the same length without a
    /// projection.
    pub fn in_plane(&self, length: f64, point: DVec2) -> f64 {
        self.projection.map_or(length, |projection| length * projection.scale_in_plane(point))
    }

    /// Returns how lengths and areas in the bounds are measured: on the Earth with a projection. Takes up to
    /// 20 ms, for a table.
    pub fn ground(&self) -> Ground {
        Ground::new(self.projection.as_ref(), &self.bounds)
    }

    /// Returns the point in world units that a person means: in the plane of a projection, a point that is
    /// not in the bounds is a longitude and a latitude if that is in them.
    pub fn place_of(&self, typed: DVec2) -> DVec2 {
        let is_geographic = typed.y.abs() <= 90.0 && typed.x.abs() <= 360.0;
        let projection = self.projection.filter(|_| is_geographic && !self.bounds.contains(typed));
        let place = projection.map(|projection| projection.plane_from_geographic(typed));
        place.filter(|&place| self.bounds.contains(place)).unwrap_or(typed)
    }

    /// Returns the domain with other bounds. Polygons are clipped to them.
    pub fn with_bounds(&self, bounds: Rect) -> Self {
        let shape = match &self.shape {
            DomainShape::Region(region) if bounds.is_proper() => {
                DomainShape::Region(Arc::new(region.reframed(bounds)))
            }
            other => other.clone(),
        };
        Self { bounds, shape, projection: self.projection }
    }
}
