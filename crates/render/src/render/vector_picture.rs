//! Pictures of a mesh as vectors.

use std::io::{self, Write};

use glam::DVec2;

use super::furniture::{Sheet, shapes_of};
use super::look::{Look, PATH_COLORS};
use super::overlay::OverlayColors;
use meshbrush_io::io::{Provenance, png, svg};
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
        let size = sheet.as_ref().map_or_else(|| self.bare_size(lattice), |sheet| sheet.map_size);
        let pixels = match self.shown_overlay() {
            Some(overlay) if matches!(overlay.colors, OverlayColors::Pixels(_)) => {
                let image = self.fills_in_pixels(overlay, mesh, extract, size);
                let mut file = Vec::new();
                png::write(&mut file, image.size, &image.rgba)?;
                file
            }
            _ => Vec::new(),
        };
        let fills = match self.shown_overlay().map(|overlay| &overlay.colors) {
            None => svg::SvgFills::Levels(self.level_colors.as_table()),
            Some(OverlayColors::Triangles(colors)) => svg::SvgFills::Triangles(colors),
            Some(OverlayColors::Pixels(_)) => svg::SvgFills::Picture(&pixels),
        };
        let style = svg::SvgStyle {
            size: sheet.as_ref().map_or_else(|| self.bare_size(lattice), |sheet| sheet.size),
            unit: on_paper.map(|paper| (paper.width / f64::from(self.size.width), paper.unit.symbol())),
            map: sheet.as_ref().map(|sheet| map_in(sheet, lattice)),
            fills,
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
