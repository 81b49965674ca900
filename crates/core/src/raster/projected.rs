//! Rasters of longitudes and latitudes, and of other planes, in the plane of a projection.

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use super::linear::linear;
use super::{LONGEST_SIDE, MOST_PIXELS, Raster};
use crate::earth::Reprojection;
use crate::geometry::Rect;
use crate::text::{Grouped, Number};

/// Why a raster cannot be projected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProjectedRasterError {
    /// It covers nothing of the area where it is wanted.
    #[error(
        "it covers nothing of the domain: its own coordinates are from {} to {} in x and from {} to {} in y.",
        Number(.0.min.x), Number(.0.max.x), Number(.0.min.y), Number(.0.max.y)
    )]
    Apart(Rect),
    /// Its pixels would be too many.
    #[error(
        "at its own resolution, about {} m, the domain has {} times {} pixels, and {} pixels are the limit, with {} along \
         a side. Use a smaller domain, or a coarser raster.",
        Number(*.side), Grouped(.size[0] as usize), Grouped(.size[1] as usize), Grouped(MOST_PIXELS as usize),
        Grouped(LONGEST_SIDE as usize)
    )]
    TooLarge {
        /// The side of a pixel, in metres.
        side: f64,
        /// [columns, rows].
        size: [u64; 2],
    },
}

/// Pixels between two places whose longitude and latitude are computed exactly.
const STEP: usize = 16;
/// Farthest that a place between them may be from the interpolated one, in pixels of the source.
const TOLERANCE: f64 = 0.01;
/// Places along each side of an area at which the size of pixels is computed.
const SAMPLES: u32 = 33;
/// Least width of a pixel that counts, as a share of its height: pixels at a pole have no width.
const NARROWEST: f64 = 0.25;

/// What a projected pixel gets from the pixels of its source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Resampling {
    /// The value at its centre, linear between the centres of the source's pixels.
    #[default]
    Linear,
    /// The value of the source's pixel around its centre: between two classes there is no third one.
    Nearest,
}

/// Returns a raster in the plane of a projection, where it covers a part of `area`. Its pixels are squares as
/// small as the smallest of the source there, on the Earth; each has the value at its centre, linear between
/// the centres of the source's pixels. It has no value where the pixel of the source around its centre has
/// none; beyond the sides of the source, the values of the last pixels continue for one pixel.
///
/// # Errors
/// Fails when the raster covers nothing of the area, and when the pixels are too many.
pub fn projected_raster(
    source: &Raster,
    reprojection: &Reprojection,
    area: Rect,
) -> Result<Raster, ProjectedRasterError> {
    resampled_raster(source, reprojection, area, Resampling::Linear)
}

/// Returns a raster in the plane of a projection as [`projected_raster`] does, with pixels that get their
/// values in a given way.
///
/// # Errors
/// Fails as [`projected_raster`] does.
pub fn resampled_raster(
    source: &Raster,
    reprojection: &Reprojection,
    area: Rect,
    resampling: Resampling,
) -> Result<Raster, ProjectedRasterError> {
    let is_geographic = reprojection.from.are_degrees();
    let bounds = if is_geographic { eastward(source.bounds()) } else { source.bounds() };
    let source = Source { raster: source, bounds, is_geographic, reprojection, resampling };
    let (bounds, side) = source.place(area).ok_or(ProjectedRasterError::Apart(source.raster.bounds()))?;
    let size = (bounds.size() / side).ceil().max(DVec2::ONE).to_array().map(|count| count as u64);
    if size.iter().any(|&count| count > u64::from(LONGEST_SIDE)) || size[0] * size[1] > MOST_PIXELS {
        return Err(ProjectedRasterError::TooLarge { side, size });
    }
    let size = size.map(|count| count as u32);
    let bounds = Rect::new(bounds.min, bounds.min + side * dvec2(f64::from(size[0]), f64::from(size[1])));
    let mut projected = Raster::filled(bounds, size, f32::NAN);
    let centers = projected.pixel_centers();
    let columns = size[0] as usize;
    let strips = projected.values.par_chunks_mut(STEP * columns).enumerate();
    strips.for_each(|(strip, values)| {
        for left in (0..columns).step_by(STEP) {
            let count = [STEP.min(columns - left), values.len() / columns];
            let center = |x: usize, y: usize| centers((left + x) as u32, (strip * STEP + y) as u32);
            let positions = source.positions(center, count);
            for (y, row) in values.chunks_exact_mut(columns).enumerate() {
                for (x, value) in row[left..left + count[0]].iter_mut().enumerate() {
                    *value = source.value(positions.at(x, y, center));
                }
            }
        }
    });
    Ok(projected)
}

/// A raster, and the plane where it is wanted.
struct Source<'a> {
    raster: &'a Raster,
    /// The rectangle that it covers, in its own coordinates.
    bounds: Rect,
    /// Whether these are longitudes and latitudes.
    is_geographic: bool,
    reprojection: &'a Reprojection,
    resampling: Resampling,
}

/// Returns a rectangle of longitudes and latitudes whose western side is below 180°: rasters from 0° to 360°
/// have the same place as those from −180° to 180°.
fn eastward(bounds: Rect) -> Rect {
    let turn = if bounds.min.x >= 180.0 { 360.0 } else { 0.0 };
    Rect::new(bounds.min - dvec2(turn, 0.0), bounds.max - dvec2(turn, 0.0))
}

/// Where the centres of a block of pixels are in the source.
enum Positions<'a> {
    /// Interpolated between those of its corners: lower left, lower right, upper left, upper right.
    Between([DVec2; 4], DVec2),
    /// Computed for each.
    Exact(&'a Source<'a>),
}

impl Positions<'_> {
    fn at(&self, x: usize, y: usize, center: impl Fn(usize, usize) -> DVec2) -> DVec2 {
        match self {
            Self::Between([a, b, c, d], last) => {
                let share = dvec2(x as f64, y as f64) / *last;
                a.lerp(*b, share.x).lerp(c.lerp(*d, share.x), share.y)
            }
            Self::Exact(source) => source.position(center(x, y)),
        }
    }
}

impl Source<'_> {
    /// Returns the place of a point of the plane in the source, in pixels: its floor is (column, row).
    fn position(&self, point: DVec2) -> DVec2 {
        let from = self.reprojection.from_plane(point) - self.bounds.min;
        let east = if self.is_geographic { from.x.rem_euclid(360.0) } else { from.x };
        dvec2(east, from.y) / self.raster.pixel_size()
    }

    /// Returns the places of the centres of a block of `[columns, rows]` pixels.
    fn positions(&self, center: impl Fn(usize, usize) -> DVec2, count: [usize; 2]) -> Positions<'_> {
        let last = count.map(|count| count - 1);
        if last.contains(&0) {
            return Positions::Exact(self);
        }
        let corners = [[0, 0], [last[0], 0], [0, last[1]], last];
        let corners = corners.map(|[x, y]| self.position(center(x, y)));
        let between = Positions::Between(corners, dvec2(last[0] as f64, last[1] as f64));
        let middle = last.map(|last| last / 2);
        let tests = [middle, [middle[0], 0], [middle[0], last[1]], [0, middle[1]], [last[0], middle[1]]];
        let is_close = tests.into_iter().all(|[x, y]| {
            let exact = self.position(center(x, y));
            (between.at(x, y, &center) - exact).abs().max_element() <= TOLERANCE
        });
        if is_close { between } else { Positions::Exact(self) }
    }

    /// Returns the value at a place in pixels, by the pixels around it that have one.
    fn value(&self, at: DVec2) -> f32 {
        let value = match self.is_round() {
            true => {
                let columns = i64::from(self.raster.size()[0]);
                self.value_of(at, |x, y| self.raster.known(x.rem_euclid(columns), y))
            }
            false => self.value_of(self.within_a_pixel(at), |x, y| self.raster.known(x, y)),
        };
        value.unwrap_or(f32::NAN)
    }

    fn value_of(&self, at: DVec2, pixel: impl Fn(i64, i64) -> Option<f32>) -> Option<f32> {
        match self.resampling {
            Resampling::Linear => linear(at, pixel).map(|value| value as f32),
            Resampling::Nearest => pixel(at.x.floor() as i64, at.y.floor() as i64),
        }
    }

    /// Returns a place, moved into the source if it is at most a pixel away: pixels of the plane can cover a
    /// part of the source where their centres are outside.
    fn within_a_pixel(&self, at: DVec2) -> DVec2 {
        let size = DVec2::from(self.raster.size().map(f64::from));
        // Just west of the source, a place is almost once around the Earth to the east.
        let turn = 360.0 / self.raster.pixel_size().x;
        let is_west = self.is_geographic && at.x > turn - 1.0;
        let at = if is_west { at - dvec2(turn, 0.0) } else { at };
        let moved = at.clamp(DVec2::ZERO, size.map(f64::next_down));
        if (moved - at).abs().max_element() <= 1.0 { moved } else { at }
    }

    /// Returns whether the source goes once around the Earth.
    fn is_round(&self) -> bool {
        let width = self.bounds.size().x;
        self.is_geographic && (width - 360.0).abs() < 0.5 * self.raster.pixel_size().x
    }

    /// Returns the part of an area that the source covers, and the side of its smallest pixels there, in
    /// metres; `None` if it covers nothing.
    fn place(&self, area: Rect) -> Option<(Rect, f64)> {
        let share = |n: u32| f64::from(n) / f64::from(SAMPLES - 1);
        let samples = || (0..SAMPLES * SAMPLES).map(|n| dvec2(share(n % SAMPLES), share(n / SAMPLES)));
        let Rect { min, max } = self.bounds;
        let in_plane = samples().map(|share| self.reprojection.in_plane(min + share * (max - min)));
        // The samples of a curved side do not reach its bulge.
        let covered = Rect::holding(in_plane.filter(|at| at.is_finite()))?;
        let margin = DVec2::splat(covered.size().max_element() / f64::from(SAMPLES - 1));
        let covered = Rect::new(covered.min - margin, covered.max + margin);
        let bounds = covered.intersection(&area).filter(Rect::is_proper)?;
        let size = self.raster.size().map(f64::from);
        let sides = samples().filter_map(|share| {
            let at = self.position(bounds.min + share * bounds.size());
            let is_within = at.cmpge(DVec2::ZERO).all() && at.cmple(DVec2::from(size)).all();
            is_within.then(|| self.side_of_pixel(at))
        });
        sides.reduce(f64::min).map(|side| (bounds, side))
    }

    /// Returns the side of a square about as large as the pixel at a place, in metres in the plane.
    fn side_of_pixel(&self, at: DVec2) -> f64 {
        let Rect { min, max } = self.bounds;
        let pixel = self.raster.pixel_size();
        let geographic =
            (min + at * pixel).clamp(min + 0.5 * pixel, (max - 0.5 * pixel).max(min + 0.5 * pixel));
        let plane = |at: DVec2| self.reprojection.in_plane(at);
        // Half a pixel away from the poles, beyond which the projection does not go.
        let [along_x, along_y] = [DVec2::X, DVec2::Y].map(|axis| {
            let half = 0.5 * pixel * axis;
            plane(geographic + half).distance(plane(geographic - half))
        });
        along_y.min(along_x.max(NARROWEST * along_y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::{Coordinates, GeographicExtent, Projection, ProjectionChoice, ProjectionKind};

    fn projected(
        source: &Raster,
        projection: &Projection,
        area: Rect,
    ) -> Result<Raster, ProjectedRasterError> {
        projected_raster(source, &Reprojection { from: Coordinates::Geographic, to: *projection }, area)
    }

    fn plane(kind: ProjectionKind, west: f64, width: f64, [south, north]: [f64; 2]) -> Projection {
        let extent = GeographicExtent { west, width, south, north, pole: None };
        ProjectionChoice::Family(kind).projection(&extent).unwrap()
    }

    /// Returns the smallest rectangle of the plane around a part of the Earth.
    fn area(projection: &Projection, west: f64, width: f64, [south, north]: [f64; 2]) -> Rect {
        let share = |n: u32| f64::from(n) / 20.0;
        let at = |n: u32| dvec2(west + share(n % 21) * width, south + share(n / 21) * (north - south));
        let places = (0..441).map(|n| projection.plane_from_geographic(at(n)));
        Rect::holding(places).unwrap()
    }

    fn linear(at: DVec2) -> f64 {
        3.0 * at.x - 2.0 * at.y
    }

    fn raster(bounds: Rect, size: [u32; 2], value: impl Fn(DVec2) -> f32) -> Raster {
        let mut raster = Raster::filled(bounds, size, 0.0);
        for (x, y) in raster.all().pixels() {
            let center = raster.pixel_center(x, y);
            raster.set(x, y, value(center));
        }
        raster
    }

    #[test]
    fn values_lie_where_they_do_on_the_earth_in_every_projection() {
        use ProjectionKind::{Lambert, Mercator, PolarStereographic, TransverseMercator};
        for (kind, west, [south, north]) in [
            (Mercator, 5.0, [-3.0, 4.0]),
            (TransverseMercator, 170.0, [40.0, 52.0]),
            (Lambert, -75.0, [30.0, 44.0]),
            (PolarStereographic, 100.0, [-80.0, -65.0]),
        ] {
            let width = 16.0;
            let projection = plane(kind, west, width, [south, north]);
            let bounds = Rect::new(dvec2(west - 0.5, south - 0.5), dvec2(west + width + 0.5, north + 0.5));
            let source = raster(bounds, [340, 320], |at| linear(at) as f32);
            let wanted = area(&projection, west, width, [south, north]);
            let projected = projected(&source, &projection, wanted).unwrap();
            let mut compared = 0;
            for (x, y) in projected.all().pixels() {
                let mut at = projection.geographic_from_plane(projected.pixel_center(x, y));
                at.x = west + (at.x - west + 180.0).rem_euclid(360.0) - 180.0;
                let value = projected.get(x, y);
                let inner = source.pixel_size();
                let is_inner = at.cmpge(bounds.min + inner).all() && at.cmple(bounds.max - inner).all();
                let slack = 1.1 * inner;
                let is_outer = at.cmplt(bounds.min - slack).any() || at.cmpgt(bounds.max + slack).any();
                assert!(!is_outer || value.is_nan(), "{kind:?} {at}");
                if is_inner {
                    let off = (f64::from(value) - linear(at)).abs();
                    // A hundredth of a pixel.
                    assert!(off <= 0.01 * 5.0 * inner.max_element() + 1e-4, "{kind:?} at {at}: {off}");
                    compared += 1;
                }
            }
            assert!(compared > 50_000, "{kind:?}: {compared}");
            let side = projected.pixel_size().x;
            let greatest =
                111_700.0 * source.pixel_size().y * projection.scale_at(dvec2(west, north)).max(1.1);
            assert!(side <= greatest, "{kind:?}: {side} m");
        }
    }

    #[test]
    fn pixels_without_a_value_stay_without_one() {
        let projection = plane(ProjectionKind::Lambert, 0.0, 4.0, [50.0, 53.0]);
        let bounds = Rect::new(dvec2(0.0, 50.0), dvec2(4.0, 53.0));
        let is_hole = |at: DVec2| (at - dvec2(2.0, 51.5)).abs().max_element() < 0.5;
        let source = raster(bounds, [40, 30], |at| if is_hole(at) { f32::NAN } else { 7.0 });
        let projected = projected(&source, &projection, area(&projection, 0.0, 4.0, [50.0, 53.0]));
        let projected = projected.unwrap();
        let mut holes = 0;
        for (x, y) in projected.all().pixels() {
            let at = projection.geographic_from_plane(projected.pixel_center(x, y));
            // Beside the source, its last pixels go on.
            let Some(under) = source.sample(at) else { continue };
            let has_none = under.is_nan();
            let value = projected.get(x, y);
            let is_close = (source.pixel_from_world(at) - source.pixel_from_world(at).round()).abs();
            // Within a hundredth of a pixel from a line between pixels, either is right.
            if is_close.min_element() > 2.0 * TOLERANCE {
                assert_eq!(value.is_nan(), has_none, "{at}");
            }
            assert!(value.is_nan() || value == 7.0);
            holes += usize::from(value.is_nan());
        }
        assert!(holes > 100);
    }

    #[test]
    fn a_raster_around_the_earth_has_no_seam() {
        for west in [0.0, -180.0] {
            let bounds = Rect::new(dvec2(west, -90.0), dvec2(west + 360.0, 90.0));
            let turn = |at: DVec2| libm::cos((at.x - 30.0).to_radians());
            let source = raster(bounds, [720, 360], |at| turn(at) as f32);
            for middle in [0.0, 180.0] {
                let projection = plane(ProjectionKind::Lambert, middle - 5.0, 10.0, [50.0, 60.0]);
                let wanted = area(&projection, middle - 5.0, 10.0, [50.0, 60.0]);
                let projected = projected(&source, &projection, wanted).unwrap();
                for (x, y) in projected.all().pixels() {
                    let at = projection.geographic_from_plane(projected.pixel_center(x, y));
                    let off = f64::from(projected.get(x, y)) - turn(at);
                    assert!(off.abs() < 1e-3, "{at}: {off}");
                }
            }
        }
    }

    #[test]
    fn a_raster_in_another_plane_lies_where_it_does_on_the_earth() {
        for code in [32633, 3857] {
            let from = Coordinates::of_epsg(code).unwrap();
            let projection = plane(ProjectionKind::Lambert, 12.0, 6.0, [58.0, 61.0]);
            let low = from.from_geographic(dvec2(14.6, 59.0));
            let bounds = Rect::new(low, low + dvec2(60_000.0, 40_000.0));
            let value = |from: DVec2| from.x * 1e-3 + from.y * 2e-3;
            let source = raster(bounds, [120, 80], |at| value(at - low) as f32);
            let wanted = area(&projection, 12.0, 6.0, [58.0, 61.0]);
            let reprojection = Reprojection { from, to: projection };
            let projected = projected_raster(&source, &reprojection, wanted).unwrap();
            let mut compared = 0;
            for (x, y) in projected.all().pixels() {
                let at = projection.geographic_from_plane(projected.pixel_center(x, y));
                let at = from.from_geographic(at) - low;
                if at.cmpge(DVec2::splat(500.0)).all() && at.cmple(dvec2(59_500.0, 39_500.0)).all() {
                    assert!((f64::from(projected.get(x, y)) - value(at)).abs() < 0.02, "{code}: {at}");
                    compared += 1;
                }
            }
            assert!(compared > 5_000, "{code}: {compared}");
        }
    }

    #[test]
    fn what_is_apart_or_too_fine_is_refused() {
        let projection = plane(ProjectionKind::Lambert, 0.0, 4.0, [50.0, 53.0]);
        let wanted = area(&projection, 0.0, 4.0, [50.0, 53.0]);
        let far = raster(Rect::new(dvec2(100.0, 10.0), dvec2(101.0, 11.0)), [4, 4], |_| 1.0);
        let error = projected(&far, &projection, wanted).unwrap_err();
        assert!(error.to_string().contains("from 100 to 101 in x"), "{error}");
        let fine = raster(Rect::new(dvec2(1.0, 51.0), dvec2(1.001, 51.001)), [100, 100], |_| 1.0);
        let wide = Rect::new(wanted.min - 1e7, wanted.max + 1e7);
        let projected = projected(&fine, &projection, wide).unwrap();
        assert!(projected.values().len() < 1_000_000, "{:?}", projected.size());
    }
}
