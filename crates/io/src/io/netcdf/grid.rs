//! Which variable of a file is the grid, along which coordinates it runs, and in which system.

use std::collections::HashMap;

use glam::dvec2;

use super::super::coordinate_system::{CoordinateKind, CoordinateSystem};
use super::super::{Flaw, GridWindow};
use super::axis::{AxisUnit, Direction, direction};
use super::contents::ReadVariable;
use meshbrush_core::earth::{self, GeographicExtent};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{LengthUnit, excerpt};

/// Names of grids that are chosen among several, the first one first, without regard to case.
const WELL_KNOWN: [&str; 12] = [
    "elevation",
    "z",
    "band1",
    "depth",
    "bathymetry",
    "bathy",
    "topo",
    "topography",
    "height",
    "altitude",
    "bedrock",
    "surface",
];

/// A variable over coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The number of the variable.
    pub(super) variable: usize,
    pub(super) x: GridSide,
    pub(super) y: GridSide,
}

/// A side of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GridSide {
    /// Which dimension of the grid it is.
    pub(super) dimension: usize,
    /// The number of the variable with its coordinates.
    pub(super) coordinates: usize,
    pub(super) unit: AxisUnit,
}

impl Grid {
    /// Chooses the variable with a name, or else the only grid, or one with a well-known name.
    ///
    /// # Errors
    /// Fails with a sentence when there is none, and when there are several.
    pub(super) fn choose(variables: &[ReadVariable], name: Option<&str>) -> Result<Self, Flaw> {
        let known = DimensionCoordinates::of(variables);
        let grids = (0..variables.len()).filter_map(|number| Self::of(&variables[number], number, &known));
        let grids: Vec<Self> = grids.collect();
        let called = |grid: &Self| variables[grid.variable].name.as_str();
        let names = || excerpt(200, &grids.iter().map(called).collect::<Vec<_>>().join(", "));
        if grids.is_empty() {
            return Err(no_grid(variables));
        }
        if let Some(name) = name {
            let found = grids.iter().find(|grid| called(grid) == name);
            let problem = || format!("the file has no grid “{}”. It has: {}.", excerpt(40, name), names());
            return found.copied().ok_or_else(|| Flaw::Syntax(problem()));
        }
        let well_known = |known: &str| grids.iter().find(|grid| called(grid).eq_ignore_ascii_case(known));
        match grids[..] {
            [only] => Ok(only),
            _ => WELL_KNOWN.into_iter().find_map(well_known).copied().ok_or_else(|| {
                let help = "Name one after the file, as in FILE.nc#NAME";
                Flaw::Syntax(format!("the file has several grids: {}. {help}.", names()))
            }),
        }
    }

    /// Returns a variable as a grid, if it is one: along one dimension with coordinates in each direction,
    /// and further dimensions of length one.
    fn of(grid: &ReadVariable, number: usize, known: &DimensionCoordinates) -> Option<Self> {
        grid.sample?;
        let (mut x, mut y) = (None, None);
        for (at, dimension) in grid.dimensions.iter().enumerate() {
            match known.0.get(dimension.name.as_str()) {
                Some(&(coordinates, direction, unit)) => {
                    let side = if direction == Direction::X { &mut x } else { &mut y };
                    if side.replace(GridSide { dimension: at, coordinates, unit }).is_some() {
                        return None;
                    }
                }
                None if dimension.length == 1 => {}
                None => return None,
            }
        }
        Some(Self { variable: number, x: x?, y: y? })
    }

    /// Returns what the file says about the coordinates.
    pub(super) fn system(&self, variables: &[ReadVariable]) -> Option<CoordinateSystem> {
        let described = described(variables, &variables[self.variable]);
        let known = |kind, unit| {
            let on_earth =
                Some(earth::Coordinates::Geographic).filter(|_| kind == CoordinateKind::Geographic);
            Some(CoordinateSystem {
                kind,
                epsg: None,
                name: None,
                on_earth,
                unit,
                vertical: Default::default(),
            })
        };
        let is_geographic =
            described.as_ref().is_some_and(|system| system.kind == CoordinateKind::Geographic);
        match (self.x.unit, self.y.unit) {
            (AxisUnit::Degree, AxisUnit::Degree) if is_geographic => described,
            (AxisUnit::Degree, AxisUnit::Degree) => known(CoordinateKind::Geographic, LengthUnit::Degree),
            (AxisUnit::Kilometre, AxisUnit::Kilometre) => {
                // A code would say that they are metres.
                let epsg = described.as_ref().filter(|system| system.unit == LengthUnit::Kilometre);
                let (epsg, name) =
                    (epsg.and_then(|system| system.epsg), described.and_then(|system| system.name));
                let (kind, unit) = (CoordinateKind::Projected, LengthUnit::Kilometre);
                Some(CoordinateSystem {
                    kind,
                    epsg,
                    name,
                    on_earth: None,
                    unit,
                    vertical: Default::default(),
                })
            }
            (AxisUnit::Metre, AxisUnit::Metre) => {
                let plane = described.or_else(|| known(CoordinateKind::Projected, LengthUnit::Metre))?;
                Some(CoordinateSystem { unit: LengthUnit::Metre, ..plane })
            }
            _ => described,
        }
    }

    /// Returns the rectangle of a window in the coordinates of the grid; `None` where they are not known.
    pub(super) fn area(&self, window: &GridWindow, system: Option<&CoordinateSystem>) -> Option<Rect> {
        let Some(plane) = window.plane else { return Some(window.area) };
        if self.is_geographic() {
            let extent = GeographicExtent::from_plane(&plane.projection, window.area)?;
            let GeographicExtent { west, width, south, north, .. } = extent;
            return Some(Rect::new(dvec2(west, south), dvec2(west + width, north)));
        }
        plane.reprojection(&system?.stated())?.rectangle_from_plane(window.area)
    }

    /// Returns whether coordinates are longitudes and latitudes.
    pub(super) fn is_geographic(&self) -> bool {
        [self.x.unit, self.y.unit] == [AxisUnit::Degree; 2]
    }
}

/// The coordinates of each dimension that has some, by its name: the number of the variable, what it says.
struct DimensionCoordinates<'a>(HashMap<&'a str, (usize, Direction, AxisUnit)>);

impl<'a> DimensionCoordinates<'a> {
    /// Returns the coordinates of a file. Those with the name of the dimension come first.
    fn of(variables: &'a [ReadVariable]) -> Self {
        let mut known = HashMap::new();
        for (number, variable) in variables.iter().enumerate() {
            let [dimension] = &variable.dimensions[..] else { continue };
            let Some((direction, unit)) = direction(variable).filter(|_| variable.sample.is_some()) else {
                continue;
            };
            let name = dimension.name.as_str();
            if variable.name == name || !known.contains_key(name) {
                known.insert(name, (number, direction, unit));
            }
        }
        Self(known)
    }
}

/// Returns the system that the variable describes whose name is the grid's attribute `grid_mapping`.
fn described(variables: &[ReadVariable], grid: &ReadVariable) -> Option<CoordinateSystem> {
    let mapping = grid.text("grid_mapping")?;
    // With several, the name and the coordinates that it is for are separated: `crs: x y`.
    let name = mapping.split([':', ' ']).next().unwrap_or_default();
    let mapping = variables.iter().find(|variable| variable.name == name)?;
    let text = mapping.text("crs_wkt").or_else(|| mapping.text("spatial_ref"));
    let by_text = text.and_then(CoordinateSystem::from_wkt);
    let code = mapping.text("epsg_code").or_else(|| mapping.text("EPSG_code"));
    let code = code.and_then(|code| code.trim_start_matches("EPSG:").trim().parse().ok());
    let code =
        code.or_else(|| mapping.numbers("epsg").first().map(|&code| code as u32)).filter(|&code| code > 0);
    let kind = match mapping.text("grid_mapping_name") {
        Some("latitude_longitude") => Some(CoordinateKind::Geographic),
        Some("rotated_latitude_longitude") => Some(CoordinateKind::Other),
        Some(_) => Some(CoordinateKind::Projected),
        None => None,
    };
    by_text.or_else(|| Some(CoordinateSystem::from_keys(kind?, code, None)))
}

fn no_grid(variables: &[ReadVariable]) -> Flaw {
    let is_curved = |variable: &&ReadVariable| variable.dimensions.len() > 1 && direction(variable).is_some();
    if let Some(curved) = variables.iter().find(is_curved) {
        return Flaw::Syntax(format!(
            "its coordinates “{}” have {} dimensions: the grid is curved, and only straight grids can be read. Resample \
             it first, for example with cdo remapbil.",
            excerpt(40, &curved.name),
            curved.dimensions.len()
        ));
    }
    if variables.iter().any(|variable| variable.name == "x_range") {
        let problem = "it is a grid as GMT 3 wrote them, with ranges in place of coordinates";
        return Flaw::Syntax(format!("{problem}. Convert it with gmt grdconvert OLD.grd NEW.grd=nf."));
    }
    let shape = |variable: &ReadVariable| {
        let names: Vec<&str> = variable.dimensions.iter().map(|dimension| dimension.name.as_str()).collect();
        format!("{}({})", variable.name, names.join(", "))
    };
    let all = excerpt(200, &variables.iter().map(shape).collect::<Vec<_>>().join(", "));
    let all = if all.is_empty() { "no variables".into() } else { all };
    Flaw::Syntax(format!(
        "the file has no grid of numbers over x and y, or over longitude and latitude, with a coordinate variable for \
         each. It has {all}."
    ))
}
