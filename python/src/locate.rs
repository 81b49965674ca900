//! Many points in the triangles of a mesh.

use glam::DVec2;
use meshbrush_mesh::mesh::{Location, Locator};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::points_of;
use crate::mesh::{Mesh, Shared};
use crate::work::{Watching, run};

/// A search tree is built if there is more than one point for this many triangles.
const TRIANGLES_PER_POINT: usize = 16;
/// Points that one thread takes at a time.
const POINTS: usize = 1 << 12;

/// Where points lie: the number of the triangle or −1, the code of the place, and the weights of the corners
/// one after the other, NaN where there is no triangle.
struct Found {
    triangles: Vec<i64>,
    places: Vec<u8>,
    weights: Vec<f64>,
}

/// The arrays of [`Found`].
type FoundArrays<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<f64>>);

#[pymethods]
impl Mesh {
    /// Finds the triangles around points.
    fn locate<'py>(slf: &Bound<'py, Self>, points: PyReadonlyArray2<'py, f64>) -> PyResult<FoundArrays<'py>> {
        let points = points_of(&points)?;
        let shared = slf.get().0.clone();
        let found =
            run(slf.py(), &Watching::QUIET, move |watch| shared.found(&points, || watch.is_cancelled()))?;
        let py = slf.py();
        Ok((found.triangles.into_pyarray(py), found.places.into_pyarray(py), found.weights.into_pyarray(py)))
    }
}

impl Shared {
    /// Finds the triangles around points; none, once nobody waits for them.
    fn found(&self, points: &[DVec2], is_cancelled: impl Fn() -> bool + Sync) -> Found {
        let mesh = self.finished.mesh();
        let many = points.len() > mesh.raw_triangle_count() / TRIANGLES_PER_POINT;
        let locator = many.then(|| Locator::new(mesh));
        let patched = self.patched_locator();
        self.with_extract(|extract| {
            let find = |point: DVec2| {
                let in_mesh = locator.as_ref().map_or_else(|| mesh.locate(point), |l| l.locate(point));
                match patched {
                    Some(patched) => {
                        let location = patched.locate(extract, point, in_mesh);
                        (location, location.triangle())
                    }
                    None => (in_mesh, in_mesh.triangle().and_then(|id| extract.place_of(id))),
                }
            };
            let mut found = Found::of(points.len());
            let Found { triangles, places, weights } = &mut found;
            let arrays = triangles
                .par_chunks_mut(POINTS)
                .zip(places.par_chunks_mut(POINTS))
                .zip(weights.par_chunks_mut(3 * POINTS));
            points.par_chunks(POINTS).zip(arrays).for_each(|(points, ((triangles, places), weights))| {
                if is_cancelled() {
                    return;
                }
                for (n, &point) in points.iter().enumerate() {
                    let (location, triangle) = find(point);
                    places[n] = code(&location);
                    if let Some(id) = triangle {
                        triangles[n] = id.index() as i64;
                        weights[3 * n..3 * n + 3].copy_from_slice(&extract.weights_at(id, point));
                    }
                }
            });
            found
        })
    }
}

impl Found {
    /// Returns the arrays of so many points, which lie in no triangle.
    fn of(points: usize) -> Self {
        Self { triangles: vec![-1; points], places: vec![0; points], weights: vec![f64::NAN; 3 * points] }
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
