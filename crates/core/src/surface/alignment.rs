//! A coarse grid whose nodes are at the samples of a raster.

use glam::DVec2;

use crate::geometry::Rect;
use crate::raster::Raster;

/// Coarse cells along the longer side at least, where the raster has as many pixels.
const CELLS: u32 = 16;
/// Share by which the sides of pixels may differ.
const SQUARE: f64 = 1e-9;
/// Most last bits of a spacing that are tried.
const MOST_BITS: usize = 8;

/// Returns a domain and a spacing δ̄, in world units, whose coarse cells have sides of 2ᵏ pixels with corners
/// at the centres of pixels: then nodes of the mesh are samples of the surface, and a mesh within an error
/// needs fewer triangles.
///
/// The domain begins at the centre of the lowest pixel at the left, and contains the centres of all others:
/// it can be larger than the raster by less than a cell at the right and at the top. Cells are at most as
/// wide as `spacing`, where it is given. `None` where pixels are not square, or there are fewer than two
/// along a side.
pub fn domain_on_samples(raster: &Raster, spacing: Option<f64>) -> Option<(Rect, f64)> {
    let (pixel, steps) = (raster.pixel_size(), raster.size().map(|count| count.saturating_sub(1)));
    let side = pixel.max_element();
    if (pixel.x - pixel.y).abs() > SQUARE * side || steps.contains(&0) {
        return None;
    }
    let widest = match spacing {
        Some(spacing) => libm::floor(spacing / side).clamp(1.0, f64::from(u32::MAX)) as u32,
        None => (steps[0].max(steps[1]) / CELLS).max(1),
    };
    let cell = 1 << widest.ilog2();
    let cells = steps.map(|count| count.div_ceil(cell));
    let extent = DVec2::from(cells.map(|count| f64::from(count) * f64::from(cell))) * pixel;
    let first = raster.pixel_center(0, 0);
    let domain = Rect::new(first, first + extent);
    // The last bit decides whether the domain has one more cell.
    let fits = |spacing: &f64| {
        let found = (domain.size() / *spacing).ceil();
        found == DVec2::from(cells.map(f64::from))
    };
    let widest = (domain.size() / DVec2::from(cells.map(f64::from))).max_element();
    let mut spacings = std::iter::successors(Some(widest), |spacing| Some(spacing.next_up())).take(MOST_BITS);
    spacings.find(fits).map(|spacing| (domain, spacing))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Lattice;

    #[test]
    fn every_sample_is_a_node_of_the_lattice() {
        for ([columns, rows], pixel, spacing) in
            [([403, 344], 0.000_833_333_333, None), ([33, 65], 2.5, Some(20.0)), ([2, 9], 1.0, None)]
        {
            let corner = dvec2(-84.41375, 36.44625);
            let size = pixel * dvec2(f64::from(columns), f64::from(rows));
            let raster = Raster::filled(Rect::new(corner, corner + size), [columns, rows], 0.0);
            let (domain, side) = domain_on_samples(&raster, spacing).unwrap();
            assert!(spacing.is_none_or(|spacing| side <= spacing + 1e-12));
            let lattice = Lattice::covering(domain, side, 1_000_000).unwrap();
            for (x, y) in raster.all().pixels() {
                let place = raster.pixel_center(x, y);
                let node = lattice.lattice_from_world(place);
                assert!(place.clamp(domain.min, domain.max).distance(place) < 1e-9);
                // Halving cells reaches the pixel after some levels: the rest is zeros.
                let whole = node * f64::from(1 << 9) / f64::from(lattice.cell_steps());
                assert!(whole.distance(whole.round()) < 1e-5, "{whole}");
            }
        }
        let narrow = Raster::filled(Rect::new(DVec2::ZERO, dvec2(1.0, 2.0)), [4, 4], 0.0);
        assert_eq!(domain_on_samples(&narrow, None), None);
    }
}
