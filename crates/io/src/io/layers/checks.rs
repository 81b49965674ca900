//! Checks of single values. The path of a fault begins at the value.

use std::path::PathBuf;

use glam::DVec2;

use crate::io::KeyFault;
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_mesh::geometry::Rect;

/// Finds a file by the name that a text gives it. Errors are sentences.
pub type FindFile<'a> = dyn Fn(&str) -> Result<PathBuf, String> + 'a;

/// Returns a length in world units.
///
/// # Errors
/// Fails when it is not positive or not finite.
pub fn positive_length(value: f64) -> Result<f64, KeyFault> {
    let rule = "a length must be positive and finite";
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(KeyFault::refused(value, rule)) }
}

/// Returns a number in a range, which the sentence describes.
pub(super) fn number_where(value: f64, holds: bool, rule: &str) -> Result<f64, KeyFault> {
    if holds && value.is_finite() { Ok(value) } else { Err(KeyFault::refused(value, rule)) }
}

/// Returns the rectangle of x₀, y₀, x₁, y₁.
///
/// # Errors
/// Fails when it is not proper.
pub fn rect_of([x0, y0, x1, y1]: [f64; 4]) -> Result<Rect, KeyFault> {
    let rect = Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    if rect.is_proper() {
        return Ok(rect);
    }
    Err(KeyFault::here(format!("these are no rectangle: write [x0, y0, x1, y1] with {}.", Rect::PROPER)))
}

/// Returns a point of finite coordinates, in world units.
///
/// # Errors
/// Fails when a coordinate is not finite.
pub fn point([x, y]: [f64; 2]) -> Result<DVec2, KeyFault> {
    let point = DVec2::new(x, y);
    if point.is_finite() {
        Ok(point)
    } else {
        Err(KeyFault::here("both coordinates of a point must be finite."))
    }
}

/// Returns the points of a line, a ring or a path, in world units. `what` begins the sentence of an error.
///
/// # Errors
/// Fails when there are fewer than `least`, or a coordinate is not finite.
pub fn points(coordinates: &[[f64; 2]], least: usize, what: &str) -> Result<Vec<DVec2>, KeyFault> {
    if coordinates.len() < least {
        let count = coordinates.len();
        return Err(KeyFault::here(format!(
            "{what} needs {least} points at least, and this one has {count}."
        )));
    }
    coordinates.iter().copied().map(point).collect()
}

/// Returns a polygon from its rings, the outer one first, with the first point repeated at the end of a ring
/// or not.
///
/// # Errors
/// Fails with a sentence when there is no ring, a ring has too few points, or a coordinate is not finite.
pub fn rings(rings: &[Vec<[f64; 2]>]) -> Result<Vec<Vec<DVec2>>, KeyFault> {
    if rings.is_empty() {
        return Err(KeyFault::here("a polygon needs its outer ring, a list of points."));
    }
    let open = |ring: &Vec<[f64; 2]>| {
        let closed = ring.len() > 1 && ring.first() == ring.last();
        points(&ring[..ring.len() - usize::from(closed)], 3, "a ring")
    };
    rings.iter().map(open).collect()
}

/// Compiles a formula, as `parse` does.
///
/// # Errors
/// Fails with the lines that point at the mistake.
pub fn compiled(
    key: &'static str,
    text: &str,
    parse: fn(&str) -> Result<Formula, ParseError>,
) -> Result<Formula, KeyFault> {
    parse(text).map_err(|mistake| KeyFault::mistake(key, text, 0, &mistake))
}

/// Checks each entry of a list.
///
/// # Errors
/// Fails for the first one that cannot be used, with its place in the list.
pub fn each<T, U>(
    key: &'static str,
    list: &[T],
    check: impl Fn(&T) -> Result<U, KeyFault>,
) -> Result<Vec<U>, KeyFault> {
    let checked = |(index, entry)| check(entry).map_err(|fault| fault.within(index).within(key));
    list.iter().enumerate().map(checked).collect()
}
