//! Pictures of a mesh as vectors.

use std::io::{self, Write};

use glam::DVec2;

use super::furniture::{Sheet, shapes_of};
use super::look::{Look, PATH_COLORS};
use meshbrush_io::io::{Provenance, svg};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Extract, Mesh};

impl Look {
    /// Writes the picture of a mesh with a path over it, in world units.
    ///
    /// # Errors
    /// Fails when the picture is too small for its furniture, and with the errors of `out`.
    pub(super) fn write_svg(
        &self,
        out: &mut impl Write,
        (mesh, extract): (&Mesh, &Extract),
        path: &[DVec2],
        provenance: &Provenance,
    ) -> io::Result<()> {
        let lattice = mesh.lattice();
        let (sheet, arrow) = (self.sheet(mesh, extract).map_err(io::Error::other)?, self.arrow(lattice));
        let shapes = sheet.as_ref().map(shapes_of).unwrap_or_default();
        let on_paper = self.size.on_paper;
        let style = svg::SvgStyle {
            size: sheet.as_ref().map_or_else(|| self.bare_size(lattice), |sheet| sheet.size),
            unit: on_paper.map(|paper| (paper.width / f64::from(self.size.width), paper.unit.symbol())),
            map: sheet.as_ref().map(|sheet| map_in(sheet, lattice)),
            level_colors: self.level_colors.as_table(),
            background: (!self.ground.is_transparent()).then(|| self.ground.color()),
            edges: self.edges,
            path,
            path_colors: PATH_COLORS,
            marks: &arrow,
            mark_colors: self.arrow_colors(),
            shapes: &shapes,
        };
        svg::write(out, extract, &style, provenance)
    }
}

/// Returns where the map is on a sheet.
fn map_in(sheet: &Sheet, lattice: &Lattice) -> svg::SvgMap {
    let (camera, bounds) = (Look::camera(lattice, sheet.map_size), lattice.bounds());
    let at = camera.screen_from_world(DVec2::new(bounds.min.x, bounds.max.y));
    svg::SvgMap { at: at + DVec2::from(sheet.map_at.map(f64::from)), px_per_world: camera.px_per_world() }
}
