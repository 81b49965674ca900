//! Places along a Z-order curve: points that are near along it are mostly near in the plane.

use glam::DVec2;

use super::Rect;

/// Returns the place of a point within `bounds` along a Z-order curve, of 65,536 × 65,536 places.
pub fn z_order(p: DVec2, bounds: &Rect) -> u32 {
    let size = bounds.size();
    let share = |axis: usize| if size[axis] > 0.0 { (p[axis] - bounds.min[axis]) / size[axis] } else { 0.0 };
    let place = |axis: usize| (share(axis) * 65_535.0) as u32 & 0xffff;
    interleaved(place(0), place(1)) as u32
}

/// Returns the bits of two numbers in turn: bit n of x becomes bit 2n, and bit n of y becomes bit 2n + 1.
pub fn interleaved(x: u32, y: u32) -> u64 {
    spread(x) | spread(y) << 1
}

/// Moves bit n to bit 2n.
fn spread(bits: u32) -> u64 {
    let mut bits = u64::from(bits);
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_interleaved() {
        assert_eq!(interleaved(0b1011, 0b0100), 0b01_10_01_01);
        assert_eq!(interleaved(u32::MAX, 0), 0x5555_5555_5555_5555);
        assert_eq!(interleaved(0, u32::MAX), 0xaaaa_aaaa_aaaa_aaaa);
    }

    #[test]
    fn corners_of_the_rectangle_are_the_ends_of_the_curve() {
        let bounds = Rect::new(DVec2::new(-1.0, 2.0), DVec2::new(3.0, 2.5));
        assert_eq!(z_order(bounds.min, &bounds), 0);
        assert_eq!(z_order(bounds.max, &bounds), u32::MAX);
        assert_eq!(z_order(bounds.min, &Rect::new(bounds.min, bounds.min)), 0, "also without a size");
    }
}
