//! What a layer asks for, written as a grid.

use std::path::Path;

use glam::dvec2;

use super::pictures::field_of;
use meshbrush_core::layers::SizeField;
use meshbrush_core::raster::Raster;
use meshbrush_io::io::{self, asc};
use meshbrush_kit::kit::background::{Aim, Background, Outcome, cancelled, exported};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// Cells along the longer side of the domain.
const LONGER_SIDE: f64 = 1024.0;

/// Returns square cells that cover a domain: their bounds, and how many there are: [columns, rows].
fn cells_over(domain: Rect) -> (Rect, [u32; 2], f64) {
    let side = domain.size().max_element() / LONGER_SIDE;
    let count = (domain.size() / side).ceil().max(dvec2(1.0, 1.0));
    (Rect::new(domain.min, domain.min + side * count), [count.x as u32, count.y as u32], side)
}

/// Begins to write what the selected layer asks for: target diameters in the unit of the document at the
/// centres of square cells, and no value where it asks for nothing.
pub fn export(session: &Session, background: &mut Background, path: &Path) {
    let document = session.document();
    let settings = document.settings();
    let (Some(layer), Ok(lattice)) = (document.active_layer(), settings.lattice()) else { return };
    let (spec, paint) = (field_of(layer, settings), document.paint().clone());
    let (name, unit) = (layer.name.clone(), settings.unit);
    let (bounds, size, side) = cells_over(settings.domain.bounds);
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| {
        let field = SizeField::new(spec, &lattice);
        let sampled = field.sampled_while(&paint, bounds, size, &|| !meter.is_cancelled());
        let Some((targets, _)) = sampled else {
            return Outcome::Exported(cancelled(Aim::Export, &file));
        };
        let value = |&target: &f32| if target.is_finite() { target } else { f32::NAN };
        let grid = Raster::from_values(bounds, size, targets.values().iter().map(value).collect());
        let written = io::write_file_metered(&file, meter, |out| asc::write(out, &grid));
        let in_unit = match unit {
            LengthUnit::None => String::new(),
            unit => format!(", in {}", unit.name()),
        };
        let is_empty = grid.values().iter().all(|value| value.is_nan());
        let nothing = if is_empty { " It asks for nothing here: no cell has a value." } else { "" };
        exported(written, meter, &file, || {
            format!(
                "Exported {}: what the layer “{name}” asks for{in_unit}. {} × {} cells of {}.{nothing}",
                file.display(),
                format::count(size[0].into()),
                format::count(size[1].into()),
                format::with_unit(&format::digits(side, 4), unit.symbol()),
            )
        })
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_square_and_cover_the_domain() {
        let domain = Rect::new(dvec2(-3.0, 1.0), dvec2(7.0, 4.1));
        let (bounds, [columns, rows], side) = cells_over(domain);
        assert_eq!([columns, rows], [1024, 318]);
        assert!(bounds.min == domain.min && bounds.max.x >= domain.max.x && bounds.max.y >= domain.max.y);
        let cell = bounds.size() / dvec2(columns.into(), rows.into());
        assert!((cell - dvec2(side, side)).abs().max_element() < 1e-12, "{cell}");
    }

    /// Most programs read no grid with two sides.
    #[test]
    fn files_have_one_side_of_cells() {
        for max in
            [dvec2(7.0, 4.1), dvec2(0.1, 0.3), dvec2(462_000.3, 1e5), dvec2(1.0 / 3.0, 0.7), dvec2(5e-4, 9.9)]
        {
            let (bounds, size, _) = cells_over(Rect::new(dvec2(-3.0, 1e-5), max + dvec2(0.0, 1.0)));
            let mut out = Vec::new();
            asc::write(&mut out, &Raster::filled(bounds, size, 1.0)).unwrap();
            let text = String::from_utf8(out).unwrap();
            assert!(text.lines().any(|line| line.starts_with("cellsize ")), "{:?}", text.lines().nth(4));
        }
    }
}
