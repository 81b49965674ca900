//! Values by pixel.

use std::sync::Arc;

use glam::DVec2;
use meshbrush_core::layers::RasterSource;
use meshbrush_core::raster::{Raster, RasterPyramid, RasterValues, check_values, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Grouped, Number};
use wasm_bindgen::JsError;

use crate::errors::error;
use crate::values::Table;

/// Returns the rectangle with some sides.
///
/// # Errors
/// Fails where it is none.
pub fn rect_of([x0, y0, x1, y1]: [f64; 4]) -> Result<Rect, JsError> {
    let bounds = Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    if bounds.is_proper() {
        return Ok(bounds);
    }
    Err(error(format_args!(
        "The bounds {x0}, {y0}, {x1}, {y1} are no rectangle: give [x0, y0, x1, y1] with {}.",
        Rect::PROPER
    )))
}

/// Returns the raster of a layer. Without `bounds` it covers the rectangle of the domain.
///
/// # Errors
/// Fails for values that cannot be used, and their place.
pub fn source_of(table: Table<'_>, domain: Rect, of: RasterValues) -> Result<RasterSource, JsError> {
    let bounds = table.several("bounds")?.map_or(Ok(domain), rect_of)?;
    let [width, height] = ["width", "height"].map(|key| table.number(key).ok().flatten().unwrap_or(f64::NAN));
    let origins = [("upper", false), ("lower", true)];
    let lowest_first = table.word("origin", &origins)?.unwrap_or(false);
    let values = table.needed("values", table.numbers("values"))?;
    let raster = RasterPyramid::new(raster_of(&values, [width, height], bounds, lowest_first)?);
    check_values(&raster, of).map_err(|problem| error(format_args!("values: {problem}")))?;
    Ok(RasterSource { name: String::new(), raster: Arc::new(raster) })
}

/// Returns a raster of values in single precision, which are row by row from the top, or from the lowest.
fn raster_of(values: &[f64], size: [f64; 2], bounds: Rect, lowest_first: bool) -> Result<Raster, JsError> {
    let sides = size.map(|side| if side.trunc() == side && side > 0.0 { side as u32 } else { 0 });
    let [columns, rows] = sides;
    if !is_raster_size(sides) {
        let [width, height] = size.map(Number);
        return Err(error(format_args!(
            "A raster of {width} × {height} pixels is impossible: width and height are whole numbers from 1 to 65 536, with \
             at most 200 000 000 pixels in all."
        )));
    }
    let count = columns as usize * rows as usize;
    if values.len() != count {
        return Err(error(format_args!(
            "A raster of {columns} × {rows} pixels has {} values, and these are {}.",
            Grouped(count),
            Grouped(values.len())
        )));
    }
    if let Some(value) = values.iter().find(|value| value.is_finite() && (**value as f32).is_infinite()) {
        return Err(error(format_args!(
            "The value {} is beyond single precision, which rasters have. Mark pixels without a value with NaN.",
            Number(*value)
        )));
    }
    let rows = values.chunks_exact(columns as usize);
    let single = |row: &[f64]| row.iter().map(|&value| value as f32).collect::<Vec<_>>();
    let pixels: Vec<f32> =
        if lowest_first { rows.flat_map(single).collect() } else { rows.rev().flat_map(single).collect() };
    Ok(Raster::from_values(bounds, sides, pixels))
}
