//! Points with the triangle around each of them, as a table: the output of `meshbrush locate`, and the file
//! that the window writes for pins.
//!
//! Columns: `x` and `y` in world units; `where` the point lies; the `triangle` and its `level`; its nodes
//! `v1,v2,v3` in the order of mesh files; the point's barycentric coordinates `zeta1,zeta2,zeta3`, in the
//! order of the nodes; and the `value` that they interpolate. If no triangle contains the point, the columns
//! from `triangle` on are empty.

use std::io::{self, Write};

use glam::DVec2;

use super::{Meter, Number};
use meshbrush_core::build::{BuildError, BuiltMesh, MeshBuilder};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::PaintLayers;
use meshbrush_core::outline::{DerivedMesh, EdgeTargets};
use meshbrush_mesh::mesh::{
    Cell, CoarseError, Extract, Location, Locator, Mesh, MeshPatch, NodeId, PatchedLocator, Progress,
    TriangleId, barycentric, interpolate,
};

const HEADER: &str = "x,y,where,triangle,level,v1,v2,v3,zeta1,zeta2,zeta3,value";

/// A search tree is built if there is more than one point for this many triangles.
const TRIANGLES_PER_POINT: usize = 16;

/// Pixels or triangles between two checks whether the work was cancelled.
const SLICE: usize = 1 << 16;

/// A mesh in which points are located, with the values to interpolate.
pub struct LocatedIn<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The differences of the exported mesh from this mesh.
    pub patch: &'a MeshPatch,
    /// The exported mesh. The numbers in the table are its numbers.
    pub extract: &'a Extract<'a>,
    /// The value at a node, in world units.
    pub value_at: &'a dyn Fn(DVec2) -> f64,
}

impl LocatedIn<'_> {
    /// Writes the header and one row for each point, in their order.
    ///
    /// # Errors
    /// Fails with the errors of `out`.
    pub fn write(&self, points: &[DVec2], out: &mut dyn Write) -> io::Result<()> {
        let many = points.len() > self.mesh.raw_triangle_count() / TRIANGLES_PER_POINT;
        let locator = many.then(|| Locator::new(self.mesh));
        let patched =
            (!self.patch.is_empty()).then(|| PatchedLocator::new(self.mesh, self.patch, self.extract));
        writeln!(out, "{HEADER}")?;
        for &point in points {
            let location = match &locator {
                Some(locator) => locator.locate(point),
                None => self.mesh.locate(point),
            };
            let (location, number) = match &patched {
                Some(patched) => {
                    let location = patched.locate(self.extract, point, location);
                    (location, location.triangle())
                }
                None => (location, location.triangle().and_then(|id| self.extract.place_of(id))),
            };
            write!(out, "{},{},{}", Number(point.x), Number(point.y), name(&location))?;
            match number {
                Some(triangle) => self.write_triangle(point, triangle, out)?,
                None => writeln!(out, ",,,,,,,,,")?,
            }
        }
        Ok(())
    }

    /// The columns from `triangle` on. Vertices and ζ are in the order of the vertices in files, so that each
    /// ζ belongs to the vertex in the same place.
    fn write_triangle(&self, point: DVec2, place: TriangleId, out: &mut dyn Write) -> io::Result<()> {
        let Cell { corners, level, .. } = self.extract.cell(place);
        let nodes = corners.map(NodeId::from_index);
        let at = self.mesh.lattice().lattice_from_world(point);
        let zeta = barycentric(nodes.map(|node| self.extract.node(node)), at);
        let value = interpolate(zeta, nodes.map(|node| (self.value_at)(self.extract.world(node))));
        let [a, b, c] = corners;
        let [zeta1, zeta2, zeta3] = zeta.map(Number);
        writeln!(out, ",{},{},{a},{b},{c},{zeta1},{zeta2},{zeta3},{}", place.index(), level, Number(value))
    }
}

/// Writes the table of points in the mesh of a document, as `meshbrush locate --project` does for the saved
/// document.
///
/// The mesh is made from scratch, as the command line makes it. Its numbers are those of files.
///
/// # Errors
/// Fails when the mesh cannot be made, when the work was cancelled, and with the errors of `out`.
pub fn write_of_document(
    out: &mut dyn Write,
    settings: &Settings,
    paint: &PaintLayers,
    points: &[DVec2],
    meter: &Meter,
) -> io::Result<()> {
    let spec = settings.mesh_spec().map_err(|error| io::Error::other(CoarseError::from(error)))?;
    let cleaning = spec.cleaning;
    let mut builder = MeshBuilder::new(spec);
    let mut advance =
        || builder.advance(Some(paint), SLICE).map_err(|error: BuildError| io::Error::other(error));
    while advance()? == Progress::More {
        meter.check()?;
    }
    let BuiltMesh { domain, field, rule, mesh, .. } = builder.finish();
    let targets = EdgeTargets::by_rule(rule, &field, paint);
    let derived = DerivedMesh::new(&mesh, &domain, targets, &cleaning);
    let extract = derived.extract(&mesh).along_curve();
    let value_at = |node: DVec2| field.target_by_rule(rule, paint, node);
    LocatedIn { mesh: &mesh, patch: derived.patch(), extract: &extract, value_at: &value_at }
        .write(points, out)
}

fn name(location: &Location) -> &'static str {
    match location {
        Location::Inside { .. } => "inside",
        Location::OnEdge { .. } => "edge",
        Location::OnVertex { .. } => "vertex",
        Location::OutsideBounds | Location::OutsideDomain => "outside",
        Location::Invalid => "invalid",
    }
}
