//! Closes inlets: water stays where discs fit.

use rayon::prelude::*;

use super::PixelLengths;
use crate::raster::Raster;

/// Leaves water where a disc with a diameter of `width` and one pixel fits; see
/// [`DepthContour::smallest_inlet`](super::DepthContour::smallest_inlet).
pub(super) fn open(water: &mut [bool], raster: &Raster, lengths: PixelLengths, width: f64) {
    let land: Vec<bool> = water.iter().map(|is_water| !is_water).collect();
    let radius_in = |row: usize| 0.5 * (width + lengths.pixel(raster, row as u32).max_element());
    let to_land = squared_distances(&land, raster, lengths);
    let columns = raster.size()[0] as usize;
    let is_middle = |(n, to_land): (usize, &f32)| {
        let radius = radius_in(n / columns);
        water[n] && f64::from(*to_land) >= radius * radius * (1.0 - 1e-6)
    };
    let middles: Vec<bool> = to_land.iter().enumerate().map(is_middle).collect();
    let to_middle = squared_distances(&middles, raster, lengths);
    for (n, (is_water, to_middle)) in water.iter_mut().zip(to_middle).enumerate() {
        let radius = radius_in(n / columns);
        *is_water &= f64::from(to_middle) < radius * radius * (1.0 - 1e-6);
    }
}

/// Returns the squared distance of the centre of each pixel to the nearest of the pixels that are marked; ∞
/// without one. Lengths along a row are those of the row.
pub(super) fn squared_distances(marked: &[bool], raster: &Raster, lengths: PixelLengths) -> Vec<f32> {
    let [columns, rows] = raster.size().map(|side| side as usize);
    let height = lengths.pixel(raster, 0).y;
    // In each column, the number of rows to the nearest marked pixel.
    let mut steps = vec![f32::INFINITY; marked.len()];
    let mut last: Vec<f32> = vec![f32::INFINITY; columns];
    let mut sweep = |row: usize| {
        for (column, last) in last.iter_mut().enumerate() {
            let n = row * columns + column;
            *last = if marked[n] { 0.0 } else { *last + 1.0 };
            steps[n] = steps[n].min(*last);
        }
    };
    (0..rows).for_each(&mut sweep);
    (0..rows).rev().for_each(&mut sweep);
    let mut distances = vec![f32::INFINITY; marked.len()];
    distances.par_chunks_mut(columns).zip(steps.par_chunks(columns)).enumerate().for_each(
        |(row, (distances, steps))| {
            let width = lengths.pixel(raster, row as u32).x;
            let own = |column: usize| squared(f64::from(steps[column]) * height);
            least_sums(own, width, distances);
        },
    );
    distances
}

fn squared(length: f64) -> f64 {
    length * length
}

/// Sets each place n to the minimum of `own(m) + (width · (m − n))²` over all m: the lower envelope of
/// parabolas (Felzenszwalb, Huttenlocher 2012).
fn least_sums(own: impl Fn(usize) -> f64, width: f64, least: &mut [f32]) {
    // The parabolas of the envelope, and the place from which on each is the lowest.
    let mut lowest: Vec<(usize, f64)> = Vec::new();
    for m in (0..least.len()).filter(|&m| own(m).is_finite()) {
        let from = loop {
            let Some(&(top, start)) = lowest.last() else { break f64::NEG_INFINITY };
            let (a, b) = (top as f64, m as f64);
            // They cross there; without a width, the lower one counts everywhere.
            let meets = 0.5 * ((own(m) - own(top)) / (width * width) / (b - a) + a + b);
            let meets = if meets.is_nan() { f64::INFINITY } else { meets };
            if meets > start {
                break meets;
            }
            lowest.pop();
        };
        lowest.push((m, from));
    }
    let mut place = 0;
    for (n, least) in least.iter_mut().enumerate() {
        while lowest.get(place + 1).is_some_and(|(_, start)| *start <= n as f64) {
            place += 1;
        }
        if let Some(&(m, _)) = lowest.get(place) {
            *least = (own(m) + squared(width * (m as f64 - n as f64))) as f32;
        }
    }
}
