//! Exports a path: as GeoJSON, as a table, as a route on the Earth, or as a picture over its mesh.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::export::ExportFormat;
use super::look::Look;
use meshbrush_core::domain::Domain;
use meshbrush_core::earth::{Coordinates, EarthPlane, Speed, metres_along};
use meshbrush_core::path::{CostDensity, PathError, PathSample, Solution};
use meshbrush_io::io::gpx::write_gpx;
use meshbrush_io::io::kml::write_kml;
use meshbrush_io::io::path::{PathLengths, write_csv, write_geojson};
use meshbrush_io::io::{Meter, Provenance, RouteOnEarth, write_file_metered};
use meshbrush_mesh::mesh::{Extract, Mesh};
use meshbrush_mesh::text::LengthUnit;

/// A file format for paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathFormat {
    /// A feature with the figures of the path.
    GeoJson,
    /// A table with the cost up to each point.
    Csv,
    /// A route for navigation programs.
    Gpx,
    /// A line for programs that show the Earth.
    Kml,
    /// A picture of the mesh with the path over it.
    Picture(ExportFormat),
}

/// The error for a file name whose ending belongs to no format for paths.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: the ending decides the format; use .geojson, .csv, .gpx, .kml, .svg or .png", .0.display())]
pub struct UnknownPathEnding(pub PathBuf);

/// The error for a route of a document that does not lie on the Earth.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{}: GPX and KML have longitudes and latitudes, and the coordinates of this path have no place on the Earth. \
     They need a projection, or the unit degrees; .geojson and .csv write them as they are.",
    .0.display()
)]
pub struct NotOnEarth(pub PathBuf);

impl PathFormat {
    /// All endings, without their dots, the default one first.
    pub const ENDINGS: [&'static str; 7] = ["geojson", "csv", "gpx", "kml", "svg", "png", "json"];

    /// The formats by their default endings, without the dots, and what each is for.
    pub const PURPOSES: [(&'static str, &'static str); 6] = [
        ("geojson", "A line with its figures, for QGIS and web maps"),
        ("csv", "A table with the cost up to each point"),
        ("gpx", "A route for navigation programs and chart plotters"),
        ("kml", "A line for Google Earth"),
        ("svg", "A vector picture of the path over the mesh"),
        ("png", "A picture of the path over the mesh"),
    ];

    /// Returns the format that the ending of a file name chooses; upper and lower case are the same.
    ///
    /// # Errors
    /// Fails when the ending is none of [`Self::ENDINGS`].
    pub fn from_path(path: &Path) -> Result<Self, UnknownPathEnding> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match ending.as_str() {
            "geojson" | "json" => Ok(Self::GeoJson),
            "csv" => Ok(Self::Csv),
            "gpx" => Ok(Self::Gpx),
            "kml" => Ok(Self::Kml),
            "svg" => Ok(Self::Picture(ExportFormat::Svg)),
            "png" => Ok(Self::Picture(ExportFormat::Png)),
            _ => Err(UnknownPathEnding(path.to_owned())),
        }
    }

    /// Checks that a file of this format can be written of a path in a plane.
    ///
    /// # Errors
    /// Fails for a route where no plane on the Earth is known.
    pub fn check(self, file: &Path, plane: Option<EarthPlane>) -> Result<(), NotOnEarth> {
        match self {
            Self::Gpx | Self::Kml if plane.is_none() => Err(NotOnEarth(file.to_owned())),
            _ => Ok(()),
        }
    }
}

/// A path prepared for export.
pub struct PathExport<'a> {
    solution: Cow<'a, Solution>,
    samples: Vec<PathSample>,
    name: String,
    plane: Option<EarthPlane>,
    lengths: PathLengths,
    /// The domain, if it lies on the Earth, and the coordinates that were asked for.
    placed: Option<(Domain, Option<Coordinates>)>,
}

/// The mesh of a path, and its appearance in pictures.
pub struct MeshOfPath<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The part of the mesh in the domain.
    pub extract: &'a Extract<'a>,
    /// The appearance of both.
    pub look: &'a Look,
}

impl<'a> PathExport<'a> {
    /// Prepares a path with all its points, or simplified with a tolerance in world units
    /// ([`Solution::simplified`]). `density` is the cost density of the path.
    ///
    /// # Errors
    /// Fails when the tolerance is negative or NaN.
    pub fn new(
        solution: &'a Solution,
        density: &dyn CostDensity,
        tolerance: Option<f64>,
    ) -> Result<Self, PathError> {
        let solution = match tolerance {
            Some(tolerance) => Cow::Owned(solution.simplified(density, tolerance)?),
            None => Cow::Borrowed(solution),
        };
        let samples = solution.samples(density);
        let lengths = PathLengths { length: solution.length, ..PathLengths::default() };
        Ok(Self { solution, samples, name: "Path".into(), plane: None, lengths, placed: None })
    }

    /// Gives the path a name, and says how its plane lies on the Earth, if it does: in the plane of a
    /// projection lengths are then those on the ellipsoid.
    #[must_use]
    pub fn named(mut self, name: String, plane: Option<EarthPlane>) -> Self {
        (self.name, self.plane) = (name, plane);
        if let Some(plane @ EarthPlane::Projected(_)) = plane {
            let distances = plane.distances(&self.line());
            for (sample, &distance) in self.samples.iter_mut().zip(&distances) {
                sample.distance = distance;
            }
            self.lengths.length = distances.last().copied().unwrap_or(0.0);
            self.lengths.in_plane = Some(self.solution.length);
        }
        self
    }

    /// Says in which coordinates GeoJSON and tables are of a path in the plane of a projection: in these, or
    /// without them in longitudes and latitudes.
    #[must_use]
    pub fn in_coordinates(mut self, domain: &Domain, coordinates: Option<Coordinates>) -> Self {
        self.placed = domain.projection.map(|_| (domain.clone(), coordinates));
        self
    }

    /// Says how long the path takes at a speed, where lengths in metres are known: on the Earth, and from the
    /// unit of coordinates.
    #[must_use]
    pub fn at_speed(mut self, speed: Option<Speed>, unit: LengthUnit) -> Self {
        let seconds =
            |speed: Speed| metres_along(self.plane, unit, &self.line()).map(|metres| speed.seconds(metres));
        self.lengths.seconds = speed.and_then(seconds);
        self
    }

    /// Returns the lengths of the path that is written, and its time. Distances of [`Self::samples`] are in
    /// the same unit.
    pub fn lengths(&self) -> &PathLengths {
        &self.lengths
    }

    fn line(&self) -> Vec<DVec2> {
        self.samples.iter().map(|sample| sample.point).collect()
    }

    /// Returns the path that is written, with its figures.
    pub fn solution(&self) -> &Solution {
        &self.solution
    }

    /// Returns the points that are written, with the cost up to each.
    pub fn samples(&self) -> &[PathSample] {
        &self.samples
    }

    /// Writes the path to a file.
    ///
    /// # Errors
    /// Fails when the file cannot be written, and when the meter was cancelled. An existing file is then
    /// unchanged.
    pub fn write(
        &self,
        file: &Path,
        format: PathFormat,
        over: &MeshOfPath<'_>,
        provenance: &Provenance,
        meter: &Meter,
    ) -> io::Result<()> {
        write_file_metered(file, meter, |out: &mut dyn Write| match format {
            PathFormat::GeoJson => self.write_geojson(out, provenance),
            PathFormat::Csv => write_csv(out, &self.samples, &self.points_in(self.coordinates())),
            PathFormat::Gpx => write_gpx(out, &self.route(file)?, &self.of_route(provenance)),
            PathFormat::Kml => write_kml(out, &self.route(file)?, &self.of_route(provenance)),
            PathFormat::Picture(format) => {
                let points = self.line();
                let MeshOfPath { mesh, extract, look } = *over;
                format.write_path_to(out, (mesh, extract), &points, look, provenance, meter)
            }
        })
    }

    /// Returns the coordinates of GeoJSON and tables, where they are not those of the plane.
    fn coordinates(&self) -> Option<Coordinates> {
        let (_, coordinates) = self.placed.as_ref()?;
        Some(coordinates.unwrap_or(Coordinates::Geographic))
    }

    /// Returns the points that are written in coordinates, or in the plane.
    fn points_in(&self, coordinates: Option<Coordinates>) -> Vec<DVec2> {
        let placed = self.placed.as_ref().zip(coordinates);
        let place = placed.and_then(|((domain, _), coordinates)| domain.place_in(&coordinates));
        let line = self.line();
        place.map_or_else(|| line.clone(), |place| line.iter().map(|&at| place(at)).collect())
    }

    fn write_geojson(&self, out: &mut dyn Write, provenance: &Provenance) -> io::Result<()> {
        let coordinates = self.coordinates();
        let mut points = self.points_in(coordinates);
        if let Some((Coordinates::Geographic, plane)) = coordinates.zip(self.plane) {
            // Between the points of the path, programs draw other lines than those of the plane.
            let middle = points.first().map_or(0.0, |first| first.x);
            let mut before = middle;
            points = plane.route(&self.line()).into_iter().map(|point| point.at).collect();
            for point in &mut points {
                *point = Coordinates::Geographic.beside(*point, before);
                before = point.x;
            }
        }
        let system = coordinates.filter(|coordinates| *coordinates != Coordinates::Geographic);
        let system = system.map(|coordinates| coordinates.to_string());
        let provenance = match coordinates {
            Some(coordinates) => {
                let projection = self.plane.and_then(EarthPlane::projection);
                &provenance.clone().in_coordinates(&coordinates, projection)
            }
            None => provenance,
        };
        write_geojson(out, &self.solution, &points, system.as_deref(), &self.lengths, provenance)
    }

    /// Returns the path as a route.
    fn route(&self, file: &Path) -> io::Result<RouteOnEarth<'_>> {
        let plane = self.plane.ok_or_else(|| io::Error::other(NotOnEarth(file.to_owned())))?;
        Ok(RouteOnEarth::new(&self.name, plane, &self.solution, &self.samples))
    }

    /// Returns what a route says about its origin.
    fn of_route(&self, provenance: &Provenance) -> Provenance {
        let projection = self.plane.and_then(EarthPlane::projection);
        provenance.clone().in_coordinates(&Coordinates::Geographic, projection)
    }
}
