//! Points in the triangles of a mesh.

use js_sys::{Array, Float64Array, Int32Array, Uint8Array};
use meshbrush_mesh::mesh::{Location, Locator};
use wasm_bindgen::prelude::*;

use crate::document::{Core, Derived};
use crate::errors::error;
use crate::values::points_of;

/// A search tree is built if there is more than one point for this many triangles.
const TRIANGLES_PER_POINT: usize = 16;

#[wasm_bindgen]
impl Core {
    /// Finds the triangles around points, x and y in turn. Returns the number of each triangle or −1, the
    /// code of the place, and the weights of the corners one after the other, NaN where there is no triangle.
    ///
    /// # Errors
    /// Fails for an odd number of coordinates.
    pub fn locate(&self, points: &[f64]) -> Result<Array, JsError> {
        let points = points_of(points, "Points")?;
        let mesh = self.mesh().ok_or_else(|| error("There is no mesh yet."))?;
        let Derived { extract, patched, .. } = self.derived();
        let many = points.len() > mesh.raw_triangle_count() / TRIANGLES_PER_POINT;
        let locator = many.then(|| Locator::new(mesh));
        let mut triangles = vec![-1; points.len()];
        let mut places = vec![0; points.len()];
        let mut weights = vec![f64::NAN; 3 * points.len()];
        for (number, &point) in points.iter().enumerate() {
            let in_mesh =
                locator.as_ref().map_or_else(|| mesh.locate(point), |locator| locator.locate(point));
            let (location, triangle) = match patched {
                Some(patched) => {
                    let location = patched.locate(extract, point, in_mesh);
                    (location, location.triangle())
                }
                None => (in_mesh, in_mesh.triangle().and_then(|id| extract.place_of(id))),
            };
            places[number] = code(&location);
            if let Some(id) = triangle {
                triangles[number] = id.index() as i32;
                weights[3 * number..3 * number + 3].copy_from_slice(&extract.weights_at(id, point));
            }
        }
        let [triangles, places, weights] = [
            Int32Array::from(&triangles[..]).into(),
            Uint8Array::from(&places[..]).into(),
            Float64Array::from(&weights[..]).into(),
        ];
        Ok(Array::of3(&triangles, &weights, &places))
    }
}

/// The numbers of the words that `meshbrush locate` prints.
fn code(location: &Location) -> u8 {
    match location {
        Location::OutsideBounds | Location::OutsideDomain => 0,
        Location::Inside { .. } => 1,
        Location::OnEdge { .. } => 2,
        Location::OnVertex { .. } => 3,
        Location::Invalid => 4,
    }
}
