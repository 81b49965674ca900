//! A coarse grid whose nodes are at the samples of a raster.

use glam::DVec2;

use crate::geometry::Rect;
use crate::raster::Raster;

/// Coarse cells along the longer side at least, where the raster has as many pixels.
const CELLS: u32 = 16;
/// Pixels along the side of a coarse cell, at least, for which cells are halved to have nodes at samples.
const SMALLEST: u32 = 4;
/// Share by which the sides of pixels may differ.
const SQUARE: f64 = 1e-9;
/// Most last bits of a spacing that are tried.
const MOST_BITS: usize = 8;

/// Returns the domain of a raster and a spacing δ̄, in world units: the rectangle between its outermost
/// centres, beyond which its values are not known.
///
/// Where such cells fill the domain, and pixels are square, coarse cells have sides of 2ᵏ pixels with corners
/// at the centres of pixels: then nodes of the mesh are samples of the surface, and a mesh within a small
/// error needs fewer triangles. Cells are at most as wide as `spacing`, where it is given. `None` where there
/// are fewer than two pixels along a side.
pub fn domain_on_samples(raster: &Raster, spacing: Option<f64>) -> Option<(Rect, f64)> {
    let (pixel, steps) = (raster.pixel_size(), raster.size().map(|count| count.saturating_sub(1)));
    if steps.contains(&0) {
        return None;
    }
    let side = pixel.max_element();
    let domain = Rect::new(raster.pixel_center(0, 0), raster.pixel_center(steps[0], steps[1]));
    let widest = match spacing {
        Some(spacing) if spacing < side => return Some((domain, spacing)),
        Some(spacing) => libm::floor(spacing / side).min(f64::from(u32::MAX)) as u32,
        None => {
            let longest = (DVec2::from(steps.map(f64::from)) * pixel).max_element() / side;
            (libm::floor(longest * (1.0 + SQUARE)) as u32 / CELLS).max(1)
        }
    };
    let cell = 1 << widest.ilog2();
    let is_square = (pixel.x - pixel.y).abs() <= SQUARE * side;
    let fills = |cell: &u32| steps.iter().all(|count| count.is_multiple_of(*cell));
    let filling = [cell, (cell / 2).max(SMALLEST.min(cell))].into_iter().find(fills);
    let on_samples =
        filling.filter(|_| is_square).and_then(|cell| spacing_of(&domain, steps.map(|count| count / cell)));
    Some((domain, on_samples.unwrap_or(f64::from(cell) * side)))
}

/// Returns the spacing for this number of cells: its last bit decides whether the domain has one more.
fn spacing_of(domain: &Rect, cells: [u32; 2]) -> Option<f64> {
    let cells = DVec2::from(cells.map(f64::from));
    let widest = (domain.size() / cells).max_element();
    let mut spacings = std::iter::successors(Some(widest), |spacing| Some(spacing.next_up())).take(MOST_BITS);
    spacings.find(|spacing| (domain.size() / *spacing).ceil() == cells)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Lattice;

    #[test]
    fn every_sample_is_a_node_of_the_lattice() {
        for ([columns, rows], pixel, spacing) in
            [([401, 345], 0.000_833_333_333, None), ([33, 65], 2.5, Some(20.0)), ([2, 9], 1.0, None)]
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
    }

    #[test]
    fn the_domain_ends_at_the_outermost_centres() {
        let mut random = fastrand::Rng::with_seed(8);
        for _ in 0..300 {
            let size = [random.u32(2..500), random.u32(2..500)];
            let pixel = dvec2(0.1 + random.f64(), 0.1 + random.f64());
            let corner = dvec2(random.f64(), random.f64()) * 1000.0;
            let bounds = Rect::new(corner, corner + pixel * DVec2::from(size.map(f64::from)));
            let raster = Raster::filled(bounds, size, 0.0);
            let spacing = random.bool().then(|| 20.0 * random.f64() + 0.01);
            let (domain, side) = domain_on_samples(&raster, spacing).unwrap();
            assert_eq!(domain.min, raster.pixel_center(0, 0));
            assert_eq!(domain.max, raster.pixel_center(size[0] - 1, size[1] - 1));
            assert!(spacing.is_none_or(|spacing| side <= spacing * (1.0 + 1e-12)), "{side} for {spacing:?}");
            let default = (domain.size().max_element() / 16.0).max(pixel.max_element());
            assert!(spacing.is_some() || side <= default * (1.0 + 1e-6), "{side} of {default}");
        }
        let row = Raster::filled(Rect::UNIT, [4, 1], 0.0);
        assert_eq!(domain_on_samples(&row, None), None);
    }
}
