//! Checks of tables. What a value becomes is computed here, too, so that nothing is checked in two ways.

use std::path::{Path, PathBuf};

use super::{
    RegionCoordinates, SavedCrest, SavedDomain, SavedLimits, SavedMesh, SavedOpen, SavedOutput, SavedParts,
    SavedPins, SavedSettings, SavedTreatment,
};
use crate::io::layers::{FindFile, SavedKind, Stored, compiled, each, point, rect_of};
use crate::io::lengths::SavedLength;
use crate::io::{KeyFault, RasterFormat};
use glam::DVec2;
use meshbrush_core::document::LEAST_MEMORY;
use meshbrush_core::domain::{DepthContour, DepthContourError};
use meshbrush_core::earth::{
    Coordinates, CoordinatesTextError, Projection, ProjectionChoice, ProjectionTextError,
};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::MOST_TRIANGLES;
use meshbrush_mesh::text::{Bytes, Grouped, Number, excerpt};

impl<L> SavedSettings<L> {
    /// Checks every value on its own, but for those of layers.
    ///
    /// # Errors
    /// Fails for the first one that cannot be used.
    pub fn check_tables(&self) -> Result<(), KeyFault> {
        let in_table = |table: &'static str| move |fault: KeyFault| fault.within(table);
        self.domain.check().map_err(in_table("domain"))?;
        self.mesh.check().map_err(in_table("mesh"))?;
        self.limits.check().map_err(in_table("limits"))?;
        self.paths.routes().map_err(in_table("paths"))?;
        self.paths.checked_cost().map_err(in_table("paths"))?;
        self.paths.checked_clearance().map_err(in_table("paths"))?;
        for (index, region) in self.keep_out.iter().enumerate() {
            region.check().map_err(|fault| fault.within(index).within("keep_out"))?;
        }
        for (index, line) in self.line.iter().enumerate() {
            line.check().map_err(|fault| fault.within(index).within("line"))?;
        }
        self.problem.problem().map_err(in_table("problem"))?;
        self.problem.solution().map_err(in_table("problem"))?;
        self.pins.points().map_err(in_table("pins"))?;
        Ok(())
    }
}

impl SavedSettings {
    /// Checks every value on its own.
    ///
    /// # Errors
    /// Fails for the first one that cannot be used.
    pub fn check(&self) -> Result<(), KeyFault> {
        self.check_tables()?;
        let has_depths = self.layer.iter().any(|layer| layer.kind() == SavedKind::Depth);
        for (index, layer) in self.layer.iter().enumerate() {
            layer.check(Stored::InFiles).map_err(|fault| fault.within(index).within("layer"))?;
            if layer.keys.uses_depth() && !has_depths {
                let problem = "it uses `depth`, and there are no depths. Name a grid of them: on the command line with \
                               --depth, in a recipe in a layer of the kind \"depth\".";
                return Err(KeyFault::value("formula", problem).within(index).within("layer"));
            }
        }
        Ok(())
    }

    /// Checks whether the values of a recipe suit each other.
    ///
    /// # Errors
    /// Fails for the first one that does not.
    pub(in crate::io) fn check_recipe(&self) -> Result<(), KeyFault> {
        self.domain.check_together().map_err(|fault| fault.within("domain"))?;
        for (index, layer) in self.layer.iter().enumerate() {
            let has_scale = self.limits.h_min.is_some() || !layer.keys.uses_scale();
            let problem = if layer.kind() == SavedKind::Paint && layer.keys.file().is_none() {
                "paint has no form as text; name the project that holds it, as in file = \"harbour.meshbrush\"."
            } else if !has_scale {
                "risk and images need `h_min` in the table [limits]: the smallest target diameter, where the risk is 1 \
                 or the image black."
            } else {
                continue;
            };
            return Err(KeyFault::entry("kind", problem).within(index).within("layer"));
        }
        Ok(())
    }

    /// Returns whether some layer needs both ends of the scale from the smallest to the largest target
    /// diameter.
    pub fn uses_scale(&self) -> bool {
        self.layer.iter().any(|layer| layer.keys.uses_scale())
    }

    /// Returns the files to read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let of_layers =
            self.layer.iter().flat_map(|layer| [layer.keys.file(), layer.shared.mask_file.as_deref()]);
        let of_paths = self.keep_out.iter().map(|region| region.file.as_deref());
        let of_lines = self.line.iter().flat_map(|line| [line.file.as_deref(), line.crest_file()]);
        let of_openings = self.domain.open.0.iter().map(|entry| match entry {
            SavedOpen::Polygons(file) => Some(file.as_path()),
            _ => None,
        });
        let of_domain =
            [self.domain.region.as_deref(), self.domain.land.as_deref()].into_iter().chain(of_openings);
        of_layers.chain(of_domain).chain(of_paths).chain(of_lines).flatten()
    }

    /// Puts the path of each file in place of its name.
    ///
    /// # Errors
    /// Fails for the first one that `find` does not find.
    pub(in crate::io) fn place_files(&mut self, find: &FindFile) -> Result<(), KeyFault> {
        let place = |key: &'static str, file: &mut Option<PathBuf>| -> Result<(), KeyFault> {
            let Some(name) = file else { return Ok(()) };
            *name = find(&name.to_string_lossy()).map_err(|sentence| KeyFault::entry(key, sentence))?;
            Ok(())
        };
        place("region", &mut self.domain.region).map_err(|fault| fault.within("domain"))?;
        place("land", &mut self.domain.land).map_err(|fault| fault.within("domain"))?;
        for entry in &mut self.domain.open.0 {
            if let SavedOpen::Polygons(file) = entry {
                let mut name = Some(file.clone());
                place("open", &mut name).map_err(|fault| fault.within("domain"))?;
                *entry = SavedOpen::Polygons(name.unwrap_or_default());
            }
        }
        for (index, layer) in self.layer.iter_mut().enumerate() {
            let placed = layer.keys.file_key().map_or(Ok(()), |file| place("file", file));
            let placed = placed.and_then(|()| place("mask_file", &mut layer.shared.mask_file));
            placed.map_err(|fault| fault.within(index).within("layer"))?;
        }
        for (index, region) in self.keep_out.iter_mut().enumerate() {
            region.name.get_or_insert_with(|| region_name(region.file.as_deref()));
            place("file", &mut region.file).map_err(|fault| fault.within(index).within("keep_out"))?;
        }
        for (index, line) in self.line.iter_mut().enumerate() {
            line.name_after_file();
            let placed = place("file", &mut line.file).and_then(|()| match &mut line.crest {
                Some(SavedCrest::Grid(file)) => {
                    let mut name = Some(std::mem::take(file));
                    place("crest", &mut name).map(|()| *file = name.unwrap_or_default())
                }
                _ => Ok(()),
            });
            placed.map_err(|fault| fault.within(index).within("line"))?;
        }
        for (index, output) in self.output.iter_mut().enumerate() {
            output.place_grids(find).map_err(|fault| fault.within(index).within("output"))?;
        }
        Ok(())
    }

    /// Puts output files into a folder.
    pub(in crate::io) fn place_outputs(&mut self, folder: &Path) {
        self.output.iter_mut().for_each(|SavedOutput { file, .. }| *file = folder.join(&file));
    }
}

impl SavedOutput {
    /// Puts the path of each grid and table in place of its name.
    fn place_grids(&mut self, find: &FindFile) -> Result<(), KeyFault> {
        for (index, grid) in self.grids.iter_mut().enumerate() {
            let files = [("file", Some(&mut grid.file)), ("table", grid.table.as_mut())];
            for (key, file) in files {
                let Some(file) = file else { continue };
                let found = find(&file.to_string_lossy());
                *file =
                    found.map_err(|sentence| KeyFault::entry(key, sentence).within(index).within("grids"))?;
            }
        }
        Ok(())
    }
}

/// Returns the name of a keep-out region that is given none.
fn region_name(file: Option<&Path>) -> String {
    let name = file.map(|file| file.file_name().unwrap_or_default().to_string_lossy().into_owned());
    name.unwrap_or_else(|| super::paths::DEFAULT_NAME.into())
}

impl SavedDomain {
    fn check(&self) -> Result<(), KeyFault> {
        self.rect()?;
        self.formula()?;
        self.projection()?;
        self.assumed()?;
        self.check_contour()?;
        checked("boundary_diameter", self.boundary_diameter)?;
        if let Some(SavedParts::Share(share)) = self.parts
            && !(0.0..=1.0).contains(&share)
        {
            let sentence = format!("{} is not a share of the area, which lies from 0 to 1.", Number(share));
            return Err(KeyFault::value("parts", sentence));
        }
        self.check_cut_off()?;
        self.sea.map_or(Ok(()), |at| point(at).map(|_| ()).map_err(|fault| fault.within("sea")))?;
        each("splits", &self.splits, |at| point(*at))?;
        each("names", &self.names, |name| point(name.at).map_err(|fault| fault.within("at")))?;
        each("types", &self.types, |of_piece| point(of_piece.at).map_err(|fault| fault.within("at")))?;
        Ok(())
    }

    fn check_together(&self) -> Result<(), KeyFault> {
        let ways = [
            ("region", self.region.is_some()),
            ("land", self.land.is_some()),
            ("inside", self.inside.is_some()),
        ];
        let mut ways = ways.into_iter().filter(|(_, is_given)| *is_given);
        if let (Some((first, _)), Some((second, _))) = (ways.next(), ways.next()) {
            let sentence = format!("the domain is given by `{first}` or by `{second}`, not by both.");
            return Err(KeyFault::key(second, sentence));
        }
        if self.sea.is_some() && self.land.is_none() {
            let sentence = "this is a place in the sea beside land; name the file of the land with `land`, or leave it out.";
            return Err(KeyFault::key("sea", sentence));
        }
        if self.land.as_ref().is_some_and(|file| RasterFormat::from_path(file).is_ok()) {
            let sentence = "this is a grid, and land is given by polygons or lines of coast: take `region` and `contour` for \
                            the water of a grid.";
            return Err(KeyFault::key("land", sentence));
        }
        let of_outline =
            [("boundary_diameter", self.boundary_diameter.is_some()), ("boundary", self.boundary.is_some())];
        let given = of_outline.into_iter().find(|(_, is_given)| *is_given && !self.has_outline());
        if let Some((key, _)) = given {
            let sentence = "this is for the outline of a region or a formula; name a file with `region`, give a formula \
                            with `inside`, or leave it out.";
            return Err(KeyFault::key(key, sentence));
        }
        let of_file = [("projection", self.projection.is_some()), ("crs", self.crs.is_some())];
        let given = of_file.into_iter().find(|(_, is_given)| *is_given && self.outline_file().is_none());
        if let Some((key, _)) = given {
            let sentence =
                "this is for the outline of a region; name its file with `region`, or leave it out.";
            return Err(KeyFault::key(key, sentence));
        }
        if self.boundary_diameter.is_some() && self.boundary == Some(SavedTreatment::Report) {
            let sentence = "with boundary = \"report\" nothing is refined along the outline; leave it out.";
            return Err(KeyFault::key("boundary_diameter", sentence));
        }
        Ok(())
    }

    /// Returns whether the domain has an outline: that of a region, or the zero line of a formula.
    pub fn has_outline(&self) -> bool {
        self.outline_file().is_some() || self.inside.is_some()
    }

    /// Returns the rectangle that the coarse grid covers, in world units.
    pub(super) fn rect(&self) -> Result<Option<Rect>, KeyFault> {
        let turn = if self.east_is_less() { 360.0 } else { 0.0 };
        let bounds = self.bounds.map(|[west, south, east, north]| [west, south, east + turn, north]);
        bounds.map(rect_of).transpose().map_err(|fault| fault.within("bounds"))
    }

    /// Returns whether the bounds beside a file have an east that is less than their west, and can be
    /// longitudes.
    fn east_is_less(&self) -> bool {
        let can_be = |[west, _, east, _]: [f64; 4]| west > east && west <= 180.0 && east >= -180.0;
        self.outline_file().is_some() && self.bounds.is_some_and(can_be)
    }

    /// Returns the file of the polygons or lines that give the outline.
    pub fn outline_file(&self) -> Option<&Path> {
        self.region.as_deref().or(self.land.as_deref())
    }

    /// Returns how the projection of the region is chosen; `None` for the plane of its own coordinates.
    fn projection(&self) -> Result<Option<ProjectionChoice>, KeyFault> {
        let text = self.projection.as_deref().filter(|&text| text != "none");
        let choice = text.map(str::parse).transpose();
        choice.map_err(|error: ProjectionTextError| KeyFault::value("projection", error.to_string()))
    }

    /// Returns what coordinates of files are that do not name a known system. Without `crs`, a projection
    /// that is given by all its numbers says that they are in its plane.
    ///
    /// # Errors
    /// Fails when `crs` is no coordinate system.
    pub fn assumed(&self) -> Result<Option<Coordinates>, KeyFault> {
        let fault = |error: CoordinatesTextError| KeyFault::value("crs", error.to_string());
        if let Some(text) = &self.crs {
            return text.parse().map(Some).map_err(fault);
        }
        let given = self.projection.as_deref().and_then(|text| text.parse::<Projection>().ok());
        Ok(given.map(Coordinates::Plane))
    }

    /// Returns what the coordinates of files are, and the plane of the domain.
    pub(super) fn coordinates(&self) -> Result<RegionCoordinates, KeyFault> {
        Ok(RegionCoordinates {
            contour: self.contour(),
            outside_nodata: self.outside_nodata,
            positive: self.positive.map(Into::into),
            is_land: self.land.is_some(),
            sea_at: self.sea.map(DVec2::from),
            east_is_less: self.east_is_less(),
            assumed: self.assumed()?,
            projection: self.projection()?,
        })
    }

    fn contour(&self) -> DepthContour {
        DepthContour {
            level: self.contour.unwrap_or(0.0),
            smallest_island: self.smallest_island.map_or(0.0, |area| area.0),
            smallest_inlet: self.smallest_inlet.map_or(0.0, |width| width.0),
        }
    }

    /// Checks what is said about the contour of a grid.
    fn check_contour(&self) -> Result<(), KeyFault> {
        let given = [
            ("contour", self.contour.is_some()),
            ("positive", self.positive.is_some()),
            ("smallest_island", self.smallest_island.is_some()),
            ("smallest_inlet", self.smallest_inlet.is_some()),
            ("outside_nodata", self.outside_nodata),
        ];
        let is_grid = self.region.as_ref().is_some_and(|file| RasterFormat::from_path(file).is_ok());
        if let Some((key, _)) = given.into_iter().find(|(_, is_given)| *is_given && !is_grid) {
            let sentence = "this is for a region that is a grid of heights or depths; name its file with `region`, or \
                            leave it out.";
            return Err(KeyFault::key(key, sentence));
        }
        if self.outside_nodata && (self.contour.is_some() || self.positive.is_some()) {
            let key = if self.contour.is_some() { "contour" } else { "positive" };
            let sentence = "the domain is where the grid has values, whatever they are: leave this out, or \
                            `outside_nodata`.";
            return Err(KeyFault::key(key, sentence));
        }
        let fault = |error: DepthContourError| {
            let key = match &error {
                DepthContourError::Number { name: "smallest island", .. } => "smallest_island",
                DepthContourError::Number { name: "smallest inlet", .. } => "smallest_inlet",
                _ => "contour",
            };
            KeyFault::value(key, error.to_string())
        };
        self.contour().check().map_err(fault)
    }

    /// Returns the formula of the domain.
    pub(super) fn formula(&self) -> Result<Option<Formula>, KeyFault> {
        self.inside.as_deref().map(|text| compiled("inside", text, Formula::parse)).transpose()
    }
}

impl SavedMesh {
    fn check(&self) -> Result<(), KeyFault> {
        checked("spacing", self.spacing)?;
        if let Some(count) = self.max_triangles
            && !(2..=MOST_TRIANGLES).contains(&count)
        {
            let rule = format!("choose from 2 to {} triangles.", Grouped(MOST_TRIANGLES));
            return Err(KeyFault { given: Some(String::new()), ..KeyFault::value("max_triangles", rule) });
        }
        self.memory().map(|_| ())
    }

    /// Most memory, in bytes.
    pub(super) fn memory(&self) -> Result<Option<usize>, KeyFault> {
        let Some(typed) = &self.max_memory else { return Ok(None) };
        let wrong = |rule: &str| KeyFault {
            given: Some(format!("\"{}\" is no such size: ", excerpt(40, typed))),
            ..KeyFault::value("max_memory", format!("{rule}, such as 500MB or 2GB."))
        };
        let bytes = Bytes::parse(typed).ok_or_else(|| wrong("give a size with its unit"))?;
        if bytes < LEAST_MEMORY { Err(wrong("choose 1MB at least")) } else { Ok(Some(bytes)) }
    }
}

impl SavedLimits {
    /// Checks each number, and whether they make a curve.
    ///
    /// # Errors
    /// Fails for the first one that cannot be used.
    pub fn check(&self) -> Result<(), KeyFault> {
        let h_min = checked("h_min", self.h_min)?;
        let h_risk = checked("h_risk", self.h_risk)?;
        let h_max = checked("h_max", self.h_max)?;
        // Where one end is not given, another takes its place: only the rest is checked then.
        let least = [h_risk, h_max].into_iter().flatten().reduce(f64::min);
        let h_min = h_min.or(least).unwrap_or(1.0);
        let h_risk = h_risk.unwrap_or(h_min);
        let h_max = h_max.unwrap_or(h_risk.max(h_min));
        let transfer = Transfer { h_min, h_risk, h_max, shape: self.shape.unwrap_or(1.0) };
        let wrong_key = match () {
            _ if h_min > h_max => "h_max",
            _ if !(h_min..=h_max).contains(&h_risk) => "h_risk",
            _ => "shape",
        };
        transfer.checked().map_err(|error| KeyFault::value(wrong_key, error.to_string()))?;
        match self.gradation {
            Some(gradation) if !(gradation > 0.0 && gradation.is_finite()) => {
                let sentence = format!(
                    "a gradation of {} cannot be kept: it must be positive and finite, and 0.1 to 0.5 are usual.",
                    Number(gradation)
                );
                Err(KeyFault::value("gradation", sentence))
            }
            _ => Ok(()),
        }
    }
}

impl SavedPins {
    /// Returns the points, in world units.
    pub(super) fn points(&self) -> Result<Vec<DVec2>, KeyFault> {
        each("at", &self.at, |at| point(*at))
    }
}

/// Returns a length, if it is given.
fn checked(key: &'static str, length: Option<SavedLength>) -> Result<Option<f64>, KeyFault> {
    length.map(|length| length.checked(key)).transpose()
}
