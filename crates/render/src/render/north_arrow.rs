//! An arrow to the north, with its letter.

use glam::{DVec2, dvec2};

/// The lines of an arrow in a picture, in pixels from its upper left corner.
pub type ArrowLines = Vec<Vec<DVec2>>;

/// Pictures with a shorter side have no arrow, in pixels.
const SMALLEST_PICTURE: u32 = 120;
/// Length of the arrow as a share of the shorter side of the picture, and its limits in pixels.
const SHARE: f64 = 0.06;
const LENGTHS: [f64; 2] = [18.0, 60.0];

/// Returns the arrow for the upper right corner of a picture of a size in pixels. `north` is the direction in
/// the plane, where y points up. Small pictures have none.
pub fn north_arrow_in(size: [u32; 2], north: DVec2) -> ArrowLines {
    let shorter = size[0].min(size[1]);
    if shorter < SMALLEST_PICTURE {
        return Vec::new();
    }
    let length = (SHARE * f64::from(shorter)).clamp(LENGTHS[0], LENGTHS[1]);
    north_arrow(dvec2(f64::from(size[0]) - 1.2 * length, 1.2 * length), length, north)
}

/// Returns an arrow of a length around a place, in points or pixels with y downwards: its shaft, its head and
/// the letter N at its tail, which stays upright. All are within 0.85 of the length from the place.
pub fn north_arrow(center: DVec2, length: f64, north: DVec2) -> ArrowLines {
    let along = dvec2(north.x, -north.y);
    let across = along.perp();
    let (tip, tail) = (center + 0.5 * length * along, center - 0.25 * length * along);
    let barb = |side: f64| tip - length * (0.3 * along + 0.17 * side * across);
    let letter = |x: f64, y: f64| center - 0.6 * length * along + length * dvec2(0.11 * x, 0.15 * y);
    vec![
        vec![tail, tip],
        vec![barb(-1.0), tip, barb(1.0)],
        vec![letter(-1.0, 1.0), letter(-1.0, -1.0), letter(1.0, 1.0), letter(1.0, -1.0)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arrow_points_to_the_north_and_stays_in_its_corner() {
        for angle in [0.0, 0.3, 1.7, 3.1, -2.0] {
            let north = DVec2::from_angle(angle);
            for size in [[1600, 900], [300, 200], [120, 4000]] {
                let lines = north_arrow_in(size, north);
                let [tail, tip] = lines[0][..] else { panic!("{:?}", lines[0]) };
                let along = (tip - tail).normalize();
                assert!(dvec2(along.x, -along.y).distance(north) < 1e-12);
                let within =
                    |at: &DVec2| at.x > 0.5 * f64::from(size[0]) && at.x < f64::from(size[0]) && at.y > 0.0;
                assert!(lines.iter().flatten().all(within), "{size:?}: {lines:?}");
            }
        }
        assert!(north_arrow_in([1600, 119], DVec2::Y).is_empty());
    }
}
