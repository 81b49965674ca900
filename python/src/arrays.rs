//! Arrays of NumPy in, and memory of a mesh lent to NumPy out.

use glam::DVec2;
use meshbrush_core::raster::{Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Grouped, Number};
use numpy::ndarray::{ArrayView, ArrayView2, Axis, Dimension};
use numpy::{Element, PyArray, PyArray2, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods, ToPyArray};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::errors::mesh_error;

/// Lends memory of `owner`, which must own `view` and never change it, as an array that cannot be written.
pub fn lent<'py, T: Element, D: Dimension>(
    owner: Bound<'py, PyAny>,
    view: &ArrayView<'_, T, D>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    // The class is frozen, and its memory stays where it is until the last array over it is gone.
    let array = unsafe { PyArray::borrow_from_array(view, owner) };
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// Returns points as world coordinates, copied: another thread may change the array.
pub fn points_of(points: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<DVec2>> {
    let view = points.as_array();
    if view.ncols() != 2 {
        let columns = view.ncols();
        return Err(mesh_error(format!("Points are rows of two coordinates, and these have {columns}.")));
    }
    Ok(view.rows().into_iter().map(|row| DVec2::new(row[0], row[1])).collect())
}

/// Returns points as rows of two coordinates.
pub fn array_of<'py>(py: Python<'py>, points: impl Iterator<Item = DVec2>) -> Bound<'py, PyArray2<f64>> {
    let values: Vec<f64> = points.flat_map(|point| point.to_array()).collect();
    let rows = ArrayView2::from_shape((values.len() / 2, 2), &values).expect("rows are complete");
    rows.to_pyarray(py)
}

/// Returns a raster of values in single precision, in one pass over the array.
pub fn raster_of(
    values: &Bound<'_, PyAny>,
    [x0, y0, x1, y1]: [f64; 4],
    lowest_first: bool,
    name: &str,
) -> PyResult<Raster> {
    let bounds = Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    if !bounds.is_proper() {
        return Err(mesh_error(format!(
            "{name}: the bounds {x0}, {y0}, {x1}, {y1} are no rectangle: give (x0, y0, x1, y1) with {}.",
            Rect::PROPER
        )));
    }
    let untyped = values.cast::<PyUntypedArray>()?;
    let &[rows, columns] = untyped.shape() else {
        let dimensions = untyped.ndim();
        return Err(mesh_error(format!(
            "{name}: a raster has two dimensions, rows and columns, and this array has {dimensions}."
        )));
    };
    let size = [u32::try_from(columns).unwrap_or(u32::MAX), u32::try_from(rows).unwrap_or(u32::MAX)];
    if !is_raster_size(size) {
        return Err(mesh_error(format!(
            "{name}: {} × {} pixels are too many or none: a raster has 1 to 65 536 pixels along each side, and at most \
             200 000 000 in all. Scale it first.",
            Grouped(columns),
            Grouped(rows)
        )));
    }
    let pixels = pixels_of(values, lowest_first, name)?;
    Ok(Raster::from_values(bounds, size, pixels))
}

fn pixels_of(values: &Bound<'_, PyAny>, lowest_first: bool, name: &str) -> PyResult<Vec<f32>> {
    macro_rules! of_types {
        ($($number:ty),*) => {
            $(if let Ok(array) = values.extract::<PyReadonlyArray2<'_, $number>>() {
                return single(array.as_array(), lowest_first, name);
            })*
        };
    }
    of_types!(f32, f64, i16, u8, i32, u16, i64, u32, i8, u64);
    let kind = values.getattr("dtype")?.str()?;
    Err(mesh_error(format!(
        "{name}: an array of {kind} is no raster. Convert it first, for example with .astype(float)."
    )))
}

/// Values that a raster can have.
trait Sample: Copy + Send + Sync {
    fn as_f64(self) -> f64;
}

macro_rules! samples {
    ($($number:ty),*) => {
        $(impl Sample for $number {
            fn as_f64(self) -> f64 {
                self as f64
            }
        })*
    };
}
samples!(f32, f64, i16, u8, i32, u16, i64, u32, i8, u64);

/// Returns the values row by row from the lowest, in single precision.
fn single<T: Sample>(array: ArrayView2<'_, T>, lowest_first: bool, name: &str) -> PyResult<Vec<f32>> {
    let mut view = array;
    if !lowest_first {
        view.invert_axis(Axis(0));
    }
    let columns = view.ncols();
    let mut pixels = vec![0.0; view.len()];
    let too_large = pixels.par_chunks_mut(columns).enumerate().find_map_any(|(number, pixels)| {
        let mut first = None;
        for (pixel, &value) in pixels.iter_mut().zip(view.row(number)) {
            let value = value.as_f64();
            *pixel = value as f32;
            first = first.or((pixel.is_infinite() && value.is_finite()).then_some(value));
        }
        first
    });
    match too_large {
        Some(value) => Err(mesh_error(format!(
            "{name}: the value {} is beyond single precision, which rasters have. Mark pixels without a value with NaN.",
            Number(value)
        ))),
        None => Ok(pixels),
    }
}
