//! Objects of JavaScript, whose values have names.

use glam::DVec2;
use js_sys::{Array, Float64Array, Reflect};
use meshbrush_core::domain::{NamedPolygon, Polygon};
use meshbrush_core::layers::ShapeList;
use meshbrush_mesh::text::Grouped;
use wasm_bindgen::prelude::*;

use crate::errors::{error, refused};

/// An object. Values that are `undefined` or `null` are not there.
#[derive(Clone, Copy)]
pub struct Table<'a>(pub &'a JsValue);

impl Table<'_> {
    /// Returns a value.
    pub fn get(self, key: &str) -> Option<JsValue> {
        let value = Reflect::get(self.0, &key.into()).ok()?;
        (!value.is_undefined() && !value.is_null()).then_some(value)
    }

    /// Returns a number, which may be any.
    ///
    /// # Errors
    /// Fails for another type.
    pub fn number(self, key: &str) -> Result<Option<f64>, JsError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value.as_f64().map(Some).ok_or_else(|| error(format_args!("{key}: this must be a number.")))
    }

    /// Returns a number that follows a rule.
    ///
    /// # Errors
    /// Fails for another type, and where it does not.
    pub fn number_where(
        self,
        key: &str,
        holds: impl Fn(f64) -> bool,
        rule: &str,
    ) -> Result<Option<f64>, JsError> {
        match self.number(key)? {
            Some(value) if !(value.is_finite() && holds(value)) => Err(refused(key, value, rule)),
            value => Ok(value),
        }
    }

    /// Returns a length, in world units.
    ///
    /// # Errors
    /// Fails for another type, and where it is not positive.
    pub fn length(self, key: &str) -> Result<Option<f64>, JsError> {
        self.number_where(key, |value| value > 0.0, "a length must be positive and finite")
    }

    /// Returns a whole number from `least` to `most`.
    ///
    /// # Errors
    /// Fails for another type and for other numbers.
    pub fn count(self, key: &str, least: usize, most: usize) -> Result<Option<usize>, JsError> {
        let number = self.number(key)?;
        let holds = |value: f64| value.trunc() == value && (least as f64..=most as f64).contains(&value);
        match number {
            Some(value) if !holds(value) => {
                let rule = format!("choose a whole number from {} to {}", Grouped(least), Grouped(most));
                Err(refused(key, value, &rule))
            }
            number => Ok(number.map(|value| value as usize)),
        }
    }

    /// Returns a text.
    ///
    /// # Errors
    /// Fails for another type.
    pub fn text(self, key: &str) -> Result<Option<String>, JsError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value.as_string().map(Some).ok_or_else(|| error(format_args!("{key}: this must be a text.")))
    }

    /// Returns one of the values that stand for words.
    ///
    /// # Errors
    /// Fails for another word.
    pub fn word<T: Copy>(self, key: &str, words: &[(&str, T)]) -> Result<Option<T>, JsError> {
        let Some(word) = self.text(key)? else { return Ok(None) };
        let known = words.iter().find(|(known, _)| *known == word);
        known.map(|&(_, value)| Some(value)).ok_or_else(|| {
            let known = words.iter().map(|(known, _)| *known).collect::<Vec<_>>().join(", ");
            error(format_args!("{key}: \"{word}\" is not possible here; write one of {known}."))
        })
    }

    /// Returns whether a flag is set.
    pub fn flag(self, key: &str) -> Option<bool> {
        self.get(key).map(|value| value.is_truthy())
    }

    /// Returns numbers of an array of type `Float64Array`, as `index.js` hands them over.
    pub fn numbers(self, key: &str) -> Option<Vec<f64>> {
        self.get(key)?.dyn_ref::<Float64Array>().map(Float64Array::to_vec)
    }

    /// Returns as many numbers as the type says.
    ///
    /// # Errors
    /// Fails for another count.
    pub fn several<const N: usize>(self, key: &str) -> Result<Option<[f64; N]>, JsError> {
        let Some(numbers) = self.numbers(key) else { return Ok(None) };
        let count = numbers.len();
        let several = numbers.try_into().map(Some);
        several.map_err(|_| error(format_args!("{key}: this must be {N} numbers, and these are {count}.")))
    }

    /// Returns texts.
    pub fn texts(self, key: &str) -> Vec<String> {
        entries(self.get(key)).filter_map(|text| text.as_string()).collect()
    }

    /// Returns a value that is needed.
    ///
    /// # Errors
    /// Fails where there is none.
    pub fn needed<T>(self, key: &str, value: Option<T>) -> Result<T, JsError> {
        value.ok_or_else(|| error(format_args!("{key} is missing.")))
    }
}

/// Returns the entries of a list, if it is one.
pub fn entries(list: Option<JsValue>) -> impl Iterator<Item = JsValue> {
    let list = list.and_then(|list| list.dyn_into::<Array>().ok()).unwrap_or_default();
    list.to_vec().into_iter()
}

/// Returns points from x and y in turn, which may be any numbers.
///
/// # Errors
/// Fails for an odd number of coordinates.
pub fn points_of(coordinates: &[f64], what: &str) -> Result<Vec<DVec2>, JsError> {
    let (pairs, rest) = coordinates.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(error(format_args!(
            "{what} are x and y in turn, and these are {} numbers: give two for each point.",
            Grouped(coordinates.len())
        )));
    }
    Ok(pairs.iter().map(|&pair| DVec2::from(pair)).collect())
}

/// Returns the points of a line or ring.
fn line_of(value: &JsValue, least: usize, what: &str) -> Result<Vec<DVec2>, JsError> {
    let coordinates = value.dyn_ref::<Float64Array>().map(Float64Array::to_vec).unwrap_or_default();
    let points = points_of(&coordinates, "Points")?;
    if points.len() < least {
        return Err(error(format_args!(
            "{what} needs {least} points at least, and this one has {}.",
            points.len()
        )));
    }
    match points.iter().find(|point| !point.is_finite()) {
        Some(point) => {
            Err(error(format_args!("The point {}, {} is nowhere: both must be finite.", point.x, point.y)))
        }
        None => Ok(points),
    }
}

fn polygon_of(rings: JsValue) -> Result<Polygon, JsError> {
    entries(Some(rings)).map(|ring| open(line_of(&ring, 3, "A ring")?)).collect()
}

/// Returns a ring whose last point is not its first one again.
fn open(mut ring: Vec<DVec2>) -> Result<Vec<DVec2>, JsError> {
    if ring.len() > 3 && ring.first() == ring.last() {
        ring.pop();
    }
    Ok(ring)
}

/// Returns shapes from lists of points, lines and polygons.
///
/// # Errors
/// Fails for points that are not finite, and lines and rings that are too short.
pub fn shapes_of(shapes: &JsValue) -> Result<ShapeList, JsError> {
    let table = Table(shapes);
    let points = table.get("points").map_or(Ok(Vec::new()), |points| line_of(&points, 0, "A list"))?;
    let lines =
        entries(table.get("lines")).map(|line| line_of(&line, 2, "A line")).collect::<Result<_, _>>()?;
    let polygons = entries(table.get("polygons")).map(polygon_of).collect::<Result<_, _>>()?;
    Ok(ShapeList { points, lines, polygons })
}

/// Returns polygons with their names.
///
/// # Errors
/// Fails as [`shapes_of`] does.
pub fn named_polygons_of(shapes: &JsValue) -> Result<Vec<NamedPolygon>, JsError> {
    let polygons = shapes_of(shapes)?.polygons;
    let names = Table(shapes).texts("names");
    let name = |number: usize| names.get(number).cloned().unwrap_or_default();
    Ok(polygons.into_iter().enumerate().map(|(n, polygon)| NamedPolygon { polygon, name: name(n) }).collect())
}
