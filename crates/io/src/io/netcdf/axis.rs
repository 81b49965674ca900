//! The coordinates along a dimension: which direction they are, their unit, and that they are evenly spaced.

use super::super::Flaw;
use super::contents::{ReadVariable, Source, StoredType};
use super::window::Axis;
use meshbrush_mesh::text::{Grouped, Number, excerpt};

/// How far a coordinate may lie from its place, as a share of a pixel.
const TOLERANCE: f64 = 0.01;
/// As [`TOLERANCE`], for coordinates in single precision, which are rounded.
const ROUNDED_TOLERANCE: f64 = 0.25;
/// Most values along a dimension. The finest global grids have a million.
const MOST_VALUES: u64 = 1 << 24;

/// What coordinates say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// To the east, or to the right.
    X,
    /// To the north, or upwards.
    Y,
}

/// The unit of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisUnit {
    /// Degrees of longitude or latitude.
    Degree,
    Metre,
    Kilometre,
    /// Degrees of a turned pole, other units, and none.
    Other,
}

/// Names of coordinates, without regard to case.
const X_NAMES: [&str; 9] =
    ["x", "lon", "long", "longitude", "longitudes", "nav_lon", "easting", "xc", "east"];
const Y_NAMES: [&str; 8] = ["y", "lat", "latitude", "latitudes", "nav_lat", "northing", "yc", "north"];
/// What each begins with names degrees, in file that have no unit.
const DEGREE_NAMES: [&str; 4] = ["lon", "lat", "nav_lon", "nav_lat"];

/// Returns the direction and the unit of coordinates, by their standard name, unit, axis or name; `None` for
/// others, such as times.
pub(super) fn direction(variable: &ReadVariable) -> Option<(Direction, AxisUnit)> {
    use Direction::{X, Y};
    let standard = variable.text("standard_name").unwrap_or_default().to_ascii_lowercase();
    let unit = variable.text("units").unwrap_or_default();
    let by_degrees = degrees_to(unit);
    let named = match standard.as_str() {
        "longitude" => return Some((X, AxisUnit::Degree)),
        "latitude" => return Some((Y, AxisUnit::Degree)),
        "grid_longitude" => return Some((X, AxisUnit::Other)),
        "grid_latitude" => return Some((Y, AxisUnit::Other)),
        "projection_x_coordinate" => Some(X),
        "projection_y_coordinate" => Some(Y),
        _ => None,
    };
    if let Some(direction) = by_degrees {
        return Some((direction, AxisUnit::Degree));
    }
    let name = variable.name.to_ascii_lowercase();
    let has_name = |names: &[&str]| names.contains(&name.as_str());
    let by_axis = match variable.text("axis") {
        Some("X" | "x") => Some(X),
        Some("Y" | "y") => Some(Y),
        _ => None,
    };
    let by_name = if has_name(&X_NAMES) { Some(X) } else { has_name(&Y_NAMES).then_some(Y) };
    let direction = named.or(by_axis).or(by_name)?;
    let is_degree = DEGREE_NAMES.iter().any(|start| name.starts_with(start))
        && (unit.is_empty() || unit.to_ascii_lowercase().starts_with("deg"));
    let unit = match unit.to_ascii_lowercase().as_str() {
        _ if is_degree => AxisUnit::Degree,
        "m" | "metre" | "metres" | "meter" | "meters" => AxisUnit::Metre,
        "km" | "kilometre" | "kilometres" | "kilometer" | "kilometers" => AxisUnit::Kilometre,
        _ => AxisUnit::Other,
    };
    Some((direction, unit))
}

/// Returns the direction of units such as `degrees_east` and `degreeN`.
fn degrees_to(unit: &str) -> Option<Direction> {
    let unit = unit.to_ascii_lowercase();
    let rest = unit.strip_prefix("degree")?;
    match rest.strip_prefix('s').unwrap_or(rest).trim_start_matches(['_', ' ']) {
        "east" | "e" => Some(Direction::X),
        "north" | "n" => Some(Direction::Y),
        _ => None,
    }
}

/// Reads the coordinates of a dimension, which are the centres of pixels.
///
/// # Errors
/// Fails with a sentence when they are not evenly spaced, and when there is only one.
pub(super) fn read(source: &mut dyn Source, variable: usize) -> Result<Axis, Flaw> {
    let coordinates = &source.variables()[variable];
    let (name, count) = (excerpt(40, &coordinates.name), coordinates.dimensions[0].length);
    let is_single = coordinates.sample == Some(StoredType::F32);
    if count > MOST_VALUES {
        let (count, most) = (Grouped(count as usize), Grouped(MOST_VALUES as usize));
        return Err(Flaw::Syntax(format!("“{name}” has {count} values, and at most {most} are read.")));
    }
    if count < 2 {
        let problem =
            format!("“{name}” has {count} values, and the size of pixels follows from two or more.");
        return Err(Flaw::Syntax(problem));
    }
    let (scale, offset) = packing(coordinates);
    let values = source.block(variable, &[0], &[count])?;
    let at = |n: usize| values[n] * scale + offset;
    let (first, last) = (at(0), at(values.len() - 1));
    let step = (last - first) / (count - 1) as f64;
    let largest = first.abs().max(last.abs());
    if !(step.is_normal() && largest.is_finite()) {
        let [first, last] = [first, last].map(Number);
        let problem = format!("“{name}” runs from {first} to {last}");
        return Err(Flaw::Syntax(format!("{problem}, and pixels between them need a width.")));
    }
    let rounding = if is_single { f64::from(f32::EPSILON) * largest / step.abs() } else { 0.0 };
    let tolerance = (TOLERANCE + rounding).min(ROUNDED_TOLERANCE) * step.abs();
    // NaN is uneven too.
    let is_even = |n: &usize| (at(*n) - (first + *n as f64 * step)).abs() <= tolerance;
    if let Some(odd) = (0..values.len()).find(|n| !is_even(n)) {
        let [step, odd, expected] = [step, at(odd), first + odd as f64 * step].map(Number);
        let problem =
            format!("“{name}” is not evenly spaced: a value is {odd}, where steps of {step} give {expected}");
        let help = "Resample the grid first, for example with gdalwarp or cdo remapbil";
        return Err(Flaw::Syntax(format!("{problem}. {help}.")));
    }
    Ok(Axis { first, step, count })
}

/// Returns the factor and the summand that give values from samples.
pub(super) fn packing(variable: &ReadVariable) -> (f64, f64) {
    let number = |name: &str| variable.numbers(name).first().copied();
    (number("scale_factor").unwrap_or(1.0), number("add_offset").unwrap_or(0.0))
}
