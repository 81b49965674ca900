//! Dictionaries of Python as the tables of a recipe, and data in memory.

use std::collections::HashMap;

use meshbrush_core::earth::Coordinates;
use meshbrush_core::raster::RasterPyramid;
use meshbrush_io::io::{CoordinateSystem, FileCoordinates, Given, GivenGrid, TextValue, ValueFacts};
use meshbrush_mesh::text::{Length, LengthUnit};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::arrays::raster_of;
use crate::errors::mesh_error;

/// Returns a value as the text of a recipe would have it. Anything with `__float__` or `__index__` is a
/// number, and a path is a text. `None` is left out of tables.
pub fn text_value(value: &Bound<'_, PyAny>) -> PyResult<TextValue> {
    if value.is_none() {
        return Ok(TextValue::Nothing);
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(TextValue::Bool(flag.is_true()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(TextValue::Text(text.to_str()?.to_owned()));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.extract::<i128>().map_or(TextValue::Number(f64::INFINITY), TextValue::Whole));
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(TextValue::Number(number.value()));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        return table_of(table);
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        return value
            .try_iter()?
            .map(|entry| text_value(&entry?))
            .collect::<PyResult<_>>()
            .map(TextValue::List);
    }
    other_value(value)
}

fn table_of(table: &Bound<'_, PyDict>) -> PyResult<TextValue> {
    let mut entries = Vec::new();
    for (key, value) in table {
        let value = text_value(&value)?;
        if !matches!(value, TextValue::Nothing) {
            entries.push((key.extract()?, value));
        }
    }
    Ok(TextValue::Table(entries))
}

/// Numbers of NumPy, arrays, and paths.
fn other_value(value: &Bound<'_, PyAny>) -> PyResult<TextValue> {
    if value.hasattr("tolist")? {
        return text_value(&value.call_method0("tolist")?);
    }
    if value.hasattr("__fspath__")? {
        return text_value(&value.call_method0("__fspath__")?);
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(TextValue::Number(number));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "A value of the type {kind} is of no use here: give a number, a text or a list."
    )))
}

/// Data in memory, with the names that tables give them: GeoJSON as bytes, or an array with its place.
#[derive(FromPyObject)]
pub enum GivenData<'py> {
    /// GeoJSON.
    Shapes(Vec<u8>),
    /// A grid.
    Grid(GridData<'py>),
}

/// A grid of numbers.
#[derive(FromPyObject)]
pub struct GridData<'py> {
    /// Two dimensions: rows and columns.
    #[pyo3(item)]
    values: Bound<'py, PyAny>,
    /// x₀, y₀, x₁, y₁, or the rectangle of the domain.
    #[pyo3(item)]
    bounds: Option<[f64; 4]>,
    /// Whether the first row is the lowest.
    #[pyo3(item)]
    lowest_first: bool,
    /// What the coordinates of `bounds` are.
    #[pyo3(item)]
    crs: Option<String>,
    /// What is known about its values: `units`, `positive` and `standard_name` of the CF conventions.
    #[pyo3(item)]
    attributes: HashMap<String, String>,
}

/// The place and the plane of a document, for grids that have none of their own.
#[derive(Clone, Copy)]
pub struct Frame {
    /// The rectangle.
    pub bounds: [f64; 4],
    /// The plane.
    pub plane: Option<Coordinates>,
}

/// Returns data in memory. A grid without a place needs `frame`.
pub fn given_of(given: Vec<(String, GivenData<'_>)>, frame: Option<Frame>) -> PyResult<Given> {
    let mut all = Given::default();
    for (name, data) in given {
        match data {
            GivenData::Shapes(text) => all.add_shapes(name.into(), text),
            GivenData::Grid(grid) => {
                let grid = grid.placed(&name, frame)?;
                all.add_grid(name.into(), grid);
            }
        }
    }
    Ok(all)
}

impl GridData<'_> {
    fn placed(self, name: &str, frame: Option<Frame>) -> PyResult<GivenGrid> {
        let Self { values, bounds, lowest_first, crs, attributes } = self;
        let in_frame = frame.filter(|_| bounds.is_none());
        let Some(place) = bounds.or(frame.map(|frame| frame.bounds)) else {
            return Err(mesh_error(format!("{name}: bounds are missing; give bounds=(x0, y0, x1, y1).")));
        };
        let raster = raster_of(&values, place, lowest_first, name)?;
        let stated = match &crs {
            Some(text) if text == "plane" => frame.and_then(|frame| frame.plane),
            // Well-known text.
            Some(text) if text.contains('[') => None,
            Some(text) => {
                Some(text.parse::<Coordinates>().map_err(|error| mesh_error(format!("crs: {error}")))?)
            }
            None => in_frame.and_then(|frame| frame.plane),
        };
        let described = crs.as_deref().and_then(CoordinateSystem::from_wkt).map(|system| system.stated());
        let [x0, y0, x1, y1] = place;
        let can_be_degrees = y0 >= -91.0 && y1 <= 91.0 && x0 >= -181.0 && x1 <= 361.0;
        let unstated = described.unwrap_or(FileCoordinates::Unstated { can_be_degrees });
        let coordinates = stated.map_or(unstated, FileCoordinates::Known);
        let attribute = |name: &str| attributes.get(name).map(String::as_str);
        let facts = ValueFacts::from_attributes(
            attribute("units"),
            attribute("positive"),
            attribute("standard_name"),
        );
        Ok(GivenGrid { raster: RasterPyramid::new(facts.in_metres(raster)).into(), coordinates, facts })
    }
}

/// A length as Python gives it: a number, or a text with a unit.
#[derive(FromPyObject)]
pub enum GivenLength {
    /// In the unit of the document.
    #[pyo3(transparent)]
    Number(f64),
    /// With a unit or without one.
    #[pyo3(transparent)]
    Text(String),
}

impl GivenLength {
    /// Returns the number in the unit of a document; `key` names it in the sentence of an error.
    pub fn in_unit(&self, key: &str, unit: LengthUnit) -> PyResult<f64> {
        let text = match self {
            Self::Number(number) => return Ok(*number),
            Self::Text(text) => text,
        };
        let length: Length =
            text.parse().map_err(|problem: String| mesh_error(format!("{key}: {problem}")))?;
        let length = length.in_document(unit);
        length
            .check(unit)
            .map_err(|problem| mesh_error(format!("{key}: \"{length}\" cannot be used: {problem}")))?;
        Ok(length.value)
    }
}
