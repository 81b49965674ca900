//! Unpacks the parts that the settings of a project name.

use std::io::Cursor;
use std::sync::Arc;

use glam::DVec2;

use super::super::error::{Flaw, PlacedFlaw};
use super::super::{Meter, png};
use super::archive::{Archive, ArchivePart, Unpacking};
use super::part_names::{PartData, PartNames};
use super::{BACKGROUND, SETTINGS, lists, pixels};
use meshbrush_core::document::Picture;
use meshbrush_core::domain::{CutFrame, Domain, DomainShape, OutlineOnEarth, Polygon};
use meshbrush_core::layers::{Mask, ShapeList, Shapes, Threats};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;

/// The names of parts in error messages.
const DOMAIN: &str = "domain";
const RASTER: &str = "raster";
const SHAPES: &str = "shapes";
const POLYGONS: &str = "polygons";
const POINTS: &str = "points";
const THREATS: &str = "threats";

/// Unpacks each part once: data that was read before is shared.
pub(super) struct PartReader<'b, 'a> {
    pub archive: &'b Archive<'a>,
    pub names: &'b mut PartNames,
    pub meter: &'b Meter,
    /// The polygons of the domain, where they are no part.
    pub polygons: Option<Vec<Polygon>>,
}

impl PartReader<'_, '_> {
    /// Returns the shape of a domain from the polygons of its part.
    pub fn domain(
        &mut self,
        name: Option<&str>,
        bounds: Rect,
        on_earth: &OutlineOnEarth,
        cuts: Vec<CutFrame>,
    ) -> Result<DomainShape, PlacedFlaw> {
        if let Some(PartData::Region(region)) = name.and_then(|name| self.names.get(name))
            && self.polygons.is_none()
            && *region.frame() == bounds
            && region.cuts() == cuts
        {
            return Ok(DomainShape::Region(region.clone()));
        }
        let polygons = match self.polygons.take() {
            Some(polygons) => polygons,
            None => self.list(name.unwrap_or(DOMAIN), DOMAIN)?.polygons,
        };
        let domain = Domain::of_stored_polygons(polygons, bounds, on_earth);
        let domain = domain.map_err(|error| Flaw::Syntax(error.to_string()))?.cut_by(cuts);
        if let (Some(name), Some(region)) = (name, domain.region()) {
            self.names.insert(name, PartData::Region(region.clone()));
        }
        Ok(domain.shape)
    }

    /// Returns the picture behind the mesh.
    pub fn background(&mut self, name: &str) -> Result<Arc<Picture>, PlacedFlaw> {
        if let Some(PartData::Picture(picture)) = self.names.get(name) {
            return Ok(picture.clone());
        }
        let bytes = part(self.archive, name)?.bytes(self.meter);
        let picture = bytes.and_then(|bytes| png::decode_picture(Cursor::new(bytes)));
        let picture = Arc::new(picture.map_err(|flaw| in_part(flaw, BACKGROUND))?);
        self.names.insert(name, PartData::Picture(picture.clone()));
        Ok(picture)
    }

    /// Returns the pixels of a raster with `size` = [columns, rows], which layers read.
    pub fn raster(
        &mut self,
        name: &str,
        bounds: Rect,
        size: [u32; 2],
    ) -> Result<Arc<RasterPyramid>, PlacedFlaw> {
        if let Some(PartData::Raster(raster)) = self.names.get(name) {
            let is_alike = raster.raster().bounds() == bounds && raster.raster().size() == size;
            let problem = "two layers disagree about its size or place.";
            return match is_alike {
                true => Ok(raster.clone()),
                false => Err(in_part(Flaw::Syntax(problem.into()), RASTER)),
            };
        }
        let raster = self.unpack(name, RASTER, |input| pixels::read_values(input, bounds, size))?;
        let raster = Arc::new(RasterPyramid::new(raster));
        self.names.insert(name, PartData::Raster(raster.clone()));
        Ok(raster)
    }

    /// Returns the shapes of a layer.
    pub fn shapes(&mut self, name: &str) -> Result<Shapes, PlacedFlaw> {
        if let Some(PartData::Shapes(shapes)) = self.names.get(name) {
            return Ok(shapes.clone());
        }
        let shapes = Shapes::new(self.list(name, SHAPES)?, true);
        let shapes = shapes.map_err(|error| in_part(Flaw::Syntax(error.to_string()), SHAPES))?;
        self.names.insert(name, PartData::Shapes(shapes.clone()));
        Ok(shapes)
    }

    /// Returns the mask of a layer or a keep-out region.
    pub fn mask(&mut self, name: &str) -> Result<Mask, PlacedFlaw> {
        if let Some(PartData::Mask(mask)) = self.names.get(name) {
            return Ok(mask.clone());
        }
        let mask = Mask::new(&self.list(name, POLYGONS)?.polygons);
        let mask = mask.map_err(|error| in_part(Flaw::Syntax(error.to_string()), POLYGONS))?;
        self.names.insert(name, PartData::Mask(mask.clone()));
        Ok(mask)
    }

    /// Returns the pins.
    pub fn pins(&mut self, name: &str) -> Result<Arc<Vec<DVec2>>, PlacedFlaw> {
        if let Some(PartData::Pins(pins)) = self.names.get(name) {
            return Ok(pins.clone());
        }
        let pins = Arc::new(self.list(name, POINTS)?.points);
        self.names.insert(name, PartData::Pins(pins.clone()));
        Ok(pins)
    }

    /// Returns the threats of a layer.
    pub fn threats(&mut self, name: &str) -> Result<Threats, PlacedFlaw> {
        if let Some(PartData::Threats(threats)) = self.names.get(name) {
            return Ok(threats.clone());
        }
        let threats = Threats::new(self.unpack(name, THREATS, lists::read_threats)?);
        let threats = threats.map_err(|(number, error)| {
            in_part(Flaw::Syntax(format!("threat {} cannot be used. {error}", number + 1)), THREATS)
        })?;
        self.names.insert(name, PartData::Threats(threats.clone()));
        Ok(threats)
    }

    fn list(&self, name: &str, what: &'static str) -> Result<ShapeList, PlacedFlaw> {
        self.unpack(name, what, lists::read_shapes)
    }

    /// Unpacks a part with `read`. Errors call the part `what`.
    fn unpack<T>(
        &self,
        name: &str,
        what: &'static str,
        read: impl FnOnce(&mut Unpacking) -> Result<T, Flaw>,
    ) -> Result<T, PlacedFlaw> {
        let mut unpacking = part(self.archive, name)?.unpack(self.meter);
        let read = read(&mut unpacking).and_then(|read| unpacking.finish().map(|()| read));
        read.map_err(|flaw| in_part(flaw, what))
    }
}

/// Returns a part that must be there.
pub(super) fn part<'b, 'a>(archive: &'b Archive<'a>, name: &str) -> Result<&'b ArchivePart<'a>, PlacedFlaw> {
    let missing = || {
        let problem = match name {
            SETTINGS => format!("this is not a Meshbrush project: it has no {name}."),
            _ => format!("the project has no part {}. Use another copy.", excerpt(40, name)),
        };
        Flaw::Syntax(problem).into()
    };
    archive.part(name).ok_or_else(missing)
}

/// Returns a flaw as one in a part.
pub(super) fn in_part(flaw: Flaw, part: &'static str) -> PlacedFlaw {
    PlacedFlaw::from(flaw).within(part)
}
