//! Reads a file of data on another thread, to ask what it is to be.

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use super::{DataContents, DataFile, Preview, RasterFacts};
use crate::kit::background::{Aim, Background, Outcome};
use crate::kit::command::{Command, ShellCommand};
use meshbrush_core::layers::{ShapeList, Threat};
use meshbrush_core::raster::{Raster, RasterValues};
use meshbrush_io::io::layers::{LoadedRaster, RasterFile, RasterFrame, RasterLoader};
use meshbrush_io::io::shapes::ShapeFile;
use meshbrush_io::io::{self, DocumentPlane, Meter, RasterFormat, recipe};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Corners of the circle that shows the range of a threat.
const CIRCLE: u32 = 48;
/// Most circles in the picture of a table of threats.
const MOST_CIRCLES: usize = 2000;

/// Reads a file of data, and then asks what it is to be. `frame` is where the document wants rasters.
pub fn look_at(background: &mut Background, path: &Path, frame: RasterFrame) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match read(&file, &frame, meter) {
        Ok(data) => Outcome::PartRead(vec![Command::from(ShellCommand::AskRole(Arc::new(data)))]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads a file of data.
///
/// # Errors
/// Fails with a sentence when the file is of no use, or the work was cancelled.
fn read(path: &Path, frame: &RasterFrame, meter: &Meter) -> Result<DataFile, String> {
    let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let seen = match RasterFormat::from_path(path) {
        Ok(_) => raster(path, frame, meter)?,
        Err(_) if is_table => table(path, meter)?,
        Err(_) => shapes(path, frame.plane.as_ref(), meter)?,
    };
    Ok(seen.of_file(path, false))
}

/// Returns shapes that were read, to ask how the document is to be that opens with them.
pub fn seen_shapes(path: &Path, file: &ShapeFile) -> DataFile {
    shapes_of(path, file).of_file(path, true)
}

/// What was seen of a file.
struct Seen {
    contents: DataContents,
    extent: Option<Rect>,
    is_on_earth: bool,
    unit: LengthUnit,
    preview: Preview,
    sea: Result<Preview, String>,
}

impl Seen {
    fn of_file(self, path: &Path, is_opened: bool) -> DataFile {
        let Self { contents, extent, is_on_earth, unit, preview, sea } = self;
        let (path, bytes) = (path.to_owned(), io::disk::bytes_of(path));
        DataFile { path, bytes, contents, extent, is_on_earth, unit, preview, sea, is_opened }
    }
}

/// Why nothing but shapes leaves a sea.
fn no_sea() -> Result<Preview, String> {
    Err("The file has neither polygons of land nor lines of coast.".into())
}

/// Draws the water beside shapes that are land or coasts.
fn drawn_sea(path: &Path, file: &ShapeFile) -> Result<Preview, String> {
    let sea = recipe::sea_of_land(path, file, None, None, None).map_err(|error| error.to_string())?;
    let polygons: Vec<_> = sea.source.outline.polygons.into_iter().map(|named| named.polygon).collect();
    let extent = Rect::holding(polygons.iter().flatten().flatten().copied()).unwrap_or(Rect::UNIT);
    Ok(Preview::of_shapes(&ShapeList { polygons, ..ShapeList::default() }, extent))
}

fn raster(path: &Path, frame: &RasterFrame, meter: &Meter) -> Result<Seen, String> {
    let file = RasterFile::named(path).map_err(|rule| format!("{}: {rule}", path.display()))?;
    let read = RasterLoader::new(meter).load(&file, RasterValues::Any, frame);
    let LoadedRaster { raster: pixels, coordinates, .. } = read.map_err(|error| error.to_string())?;
    let raster = pixels.raster();
    let facts = facts(raster);
    let extent = if file.format.has_place() {
        Some(raster.bounds())
    } else {
        io::world_file::bounds_beside(path, raster.size()).map_err(|error| error.to_string())?
    };
    let is_grid = file.format.is_grid();
    let contents = if is_grid { DataContents::Grid(facts) } else { DataContents::Picture(facts) };
    let preview = Preview::of_raster(raster, facts.values);
    let unit = match (&frame.plane, coordinates) {
        (Some(_), _) => LengthUnit::Metre,
        (None, coordinates) => coordinates.map_or(LengthUnit::None, |own| own.stated_unit()),
    };
    Ok(Seen { contents, extent, is_on_earth: false, unit, preview, sea: no_sea() })
}

fn facts(raster: &Raster) -> RasterFacts {
    let finite = raster.values().iter().filter(|value| value.is_finite()).map(|&value| f64::from(value));
    let values = finite.fold(None, |range: Option<[f64; 2]>, value| {
        let [least, greatest] = range.unwrap_or([value; 2]);
        Some([least.min(value), greatest.max(value)])
    });
    let missing = raster.values().iter().filter(|value| value.is_nan()).count();
    RasterFacts { size: raster.size(), values, missing }
}

fn shapes(path: &Path, plane: Option<&DocumentPlane>, meter: &Meter) -> Result<Seen, String> {
    let file = io::shape_format::read_shapes(path, plane, meter).map_err(|error| error.to_string())?;
    Ok(shapes_of(path, &file))
}

fn shapes_of(path: &Path, file: &ShapeFile) -> Seen {
    let ShapeList { points, lines, polygons } = &file.shapes;
    let contents =
        DataContents::Shapes { points: points.len(), lines: lines.len(), polygons: polygons.len() };
    let is_on_earth = file.coordinates.on_earth(None).is_some();
    Seen { is_on_earth, sea: drawn_sea(path, file), ..drawn(contents, &file.shapes, file.coordinates.unit()) }
}

/// A table of threats, or else of points.
fn table(path: &Path, meter: &Meter) -> Result<Seen, String> {
    let no_threats = match io::threats::read(path, None, meter) {
        Ok(threats) => {
            return Ok(drawn(DataContents::Threats(threats.len()), &circles(&threats), LengthUnit::None));
        }
        Err(error) => error.to_string(),
    };
    let points = io::points::read(path).map_err(|_| {
        format!(
            "{no_threats} As a table of points it needs a header with x and y, and numbers in both columns."
        )
    })?;
    let contents = DataContents::Points(points.len());
    Ok(drawn(contents, &ShapeList { points, ..ShapeList::default() }, LengthUnit::None))
}

/// Returns the ranges of threats as circles.
fn circles(threats: &[Threat]) -> ShapeList {
    let angle = |corner: u32| f64::from(corner) * TAU / f64::from(CIRCLE);
    let circle = |threat: &Threat| {
        (0..CIRCLE).map(|corner| threat.at + threat.range * DVec2::from_angle(angle(corner))).collect()
    };
    let polygons = threats.iter().take(MOST_CIRCLES).map(|threat| vec![circle(threat)]).collect();
    ShapeList { points: threats.iter().map(|threat| threat.at).collect(), polygons, ..ShapeList::default() }
}

fn drawn(contents: DataContents, shapes: &ShapeList, unit: LengthUnit) -> Seen {
    let rings = shapes.lines.iter().chain(shapes.polygons.iter().flatten()).flatten();
    let extent = Rect::holding(shapes.points.iter().chain(rings).copied());
    let preview = Preview::of_shapes(shapes, extent.unwrap_or(Rect::UNIT));
    Seen { contents, extent, is_on_earth: false, unit, preview, sea: no_sea() }
}

#[cfg(test)]
mod tests {
    use meshbrush_core::layers::ThreatLaw;

    use super::*;

    #[test]
    fn the_range_of_a_threat_is_a_circle_around_it() {
        let threat = Threat { at: DVec2::new(3.0, -2.0), range: 0.5, peak: 1.0, law: ThreatLaw::Radar };
        let shapes = circles(&[threat]);
        assert_eq!(shapes.points, [threat.at]);
        let circle = &shapes.polygons[0][0];
        assert_eq!(circle.len(), CIRCLE as usize);
        let side = 2.0 * threat.range * (TAU / 2.0 / f64::from(CIRCLE)).sin();
        for (n, corner) in circle.iter().enumerate() {
            assert!((corner.distance(threat.at) - threat.range).abs() < 1e-12, "{corner}");
            let next = circle[(n + 1) % circle.len()];
            assert!((corner.distance(next) - side).abs() < 1e-12, "all sides are as long: {corner} {next}");
        }
    }
}
