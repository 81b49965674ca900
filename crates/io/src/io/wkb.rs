//! Well-known binary: points, lines and polygons as bytes, as databases of shapes hold them.
//!
//! Heights and measures are left out.

use glam::{DVec2, dvec2};

use super::positions::open_ring;
use meshbrush_core::domain::{Polygon, Ring};
use meshbrush_core::layers::ShapeList;

/// How deep collections may be in others.
const DEEPEST: u32 = 8;
/// Flags of the extended form, for heights, measures and a coordinate system.
const FLAGS: [u32; 3] = [1 << 31, 1 << 30, 1 << 29];

/// Bytes that are still to be read, in one order of bytes.
pub(super) struct WkbBytes<'a> {
    rest: &'a [u8],
    is_little: bool,
}

impl<'a> WkbBytes<'a> {
    pub(super) fn new(rest: &'a [u8], is_little: bool) -> Self {
        Self { rest, is_little }
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or("ends too early")?;
        self.rest = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    fn number(&mut self) -> Result<u32, String> {
        let bytes: [u8; 4] = self.take(4)?.try_into().expect("four bytes");
        Ok(if self.is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn coordinate(&mut self) -> Result<f64, String> {
        let bytes: [u8; 8] = self.take(8)?.try_into().expect("eight bytes");
        Ok(if self.is_little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    /// Reads a point with so many numbers.
    fn point(&mut self, numbers: usize) -> Result<DVec2, String> {
        let point = dvec2(self.coordinate()?, self.coordinate()?);
        self.take(8 * (numbers - 2))?;
        Ok(point)
    }

    fn finite_point(&mut self, numbers: usize) -> Result<DVec2, String> {
        let point = self.point(numbers)?;
        if point.is_finite() { Ok(point) } else { Err("has a coordinate that is not finite".into()) }
    }

    fn points(&mut self, numbers: usize) -> Result<Vec<DVec2>, String> {
        let count = self.number()? as usize;
        if count.saturating_mul(8 * numbers) > self.rest.len() {
            return Err(format!("announces {count} points and is too short for them"));
        }
        (0..count).map(|_| self.finite_point(numbers)).collect()
    }

    fn polygon(&mut self, numbers: usize) -> Result<Polygon, String> {
        let mut rings: Vec<Ring> = Vec::new();
        for _ in 0..self.number()? {
            let mut ring = self.points(numbers)?;
            open_ring(&mut ring);
            rings.push(ring);
        }
        Ok(rings)
    }

    /// Reads a geometry with its parts, and adds its shapes.
    ///
    /// # Errors
    /// Fails with the rule that the bytes break, as the end of a sentence.
    pub(super) fn geometry(&mut self, shapes: &mut ShapeList) -> Result<(), String> {
        self.nested(shapes, DEEPEST)
    }

    fn nested(&mut self, shapes: &mut ShapeList, deeper: u32) -> Result<(), String> {
        self.is_little = match self.byte()? {
            0 => false,
            1 => true,
            other => return Err(format!("begins with the byte {other}, which says no order of bytes")),
        };
        let code = self.number()?;
        let [has_height, has_measure, has_system] = FLAGS.map(|flag| code & flag != 0);
        let plain = code & !FLAGS.iter().sum::<u32>();
        if has_system {
            self.number()?;
        }
        // 1000, 2000 and 3000 more: with heights, with measures, with both.
        let more = plain / 1000;
        let flagged = usize::from(has_height) + usize::from(has_measure);
        let numbers = 2 + flagged.max([0, 1, 1, 2].get(more as usize).copied().unwrap_or(0));
        match plain % 1000 {
            1 => {
                // An empty point has no numbers.
                let point = self.point(numbers)?;
                shapes.points.extend(Some(point).filter(|point| point.is_finite()));
            }
            2 => {
                let line = self.points(numbers)?;
                shapes.lines.extend(Some(line).filter(|line| line.len() > 1));
            }
            3 => {
                let polygon = self.polygon(numbers)?;
                shapes.polygons.extend(Some(polygon).filter(|rings| !rings.is_empty()));
            }
            4..=7 => {
                let deeper = deeper.checked_sub(1).ok_or("has collections in collections, too deep")?;
                for _ in 0..self.number()? {
                    self.nested(shapes, deeper)?;
                }
            }
            8..=12 => return Err("is a curve, and only straight lines are read".into()),
            _ => return Err(format!("is of the unknown type {code}")),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<ShapeList, String> {
        let mut shapes = ShapeList::default();
        WkbBytes::new(bytes, true).geometry(&mut shapes)?;
        Ok(shapes)
    }

    /// Bytes of numbers in either order: `t` a type or a count, `f` a coordinate.
    fn bytes(is_little: bool, numbers: &[(char, f64)]) -> Vec<u8> {
        let mut bytes = vec![u8::from(is_little)];
        for &(kind, value) in numbers {
            let (whole, float) = (value as u32, value);
            match (kind, is_little) {
                ('t', true) => bytes.extend(whole.to_le_bytes()),
                ('t', false) => bytes.extend(whole.to_be_bytes()),
                (_, true) => bytes.extend(float.to_le_bytes()),
                (_, false) => bytes.extend(float.to_be_bytes()),
            }
        }
        bytes
    }

    #[test]
    fn points_lines_and_polygons_are_read_in_both_orders() {
        for is_little in [true, false] {
            let t = |value: u32| ('t', f64::from(value));
            let f = |value: f64| ('f', value);
            let point = read(&bytes(is_little, &[t(1), f(1.0), f(2.0)])).unwrap();
            assert_eq!(point.points, [dvec2(1.0, 2.0)]);
            // With heights, as numbers above 1000 and as a flag; with a coordinate system.
            for code in [1002, (1 << 31) | 2, (1 << 31) | (1 << 29) | 2] {
                let system = if code & (1 << 29) == 0 { vec![] } else { vec![t(4326)] };
                let rest = [t(2), f(0.0), f(1.0), f(9.0), f(2.0), f(3.0), f(9.0)];
                let numbers = [vec![t(code)], system, rest.to_vec()].concat();
                let line = read(&bytes(is_little, &numbers)).unwrap();
                assert_eq!(line.lines, [[dvec2(0.0, 1.0), dvec2(2.0, 3.0)]]);
            }
            let ring = [t(4), f(0.0), f(0.0), f(1.0), f(0.0), f(0.0), f(1.0), f(0.0), f(0.0)];
            let polygon = read(&bytes(is_little, &[&[t(3), t(1)], &ring[..]].concat())).unwrap();
            assert_eq!(polygon.polygons, [[vec![DVec2::ZERO, DVec2::X, DVec2::Y]]], "without the last point");
        }
    }

    #[test]
    fn every_cut_and_every_wrong_byte_is_an_error_or_another_shape() {
        let whole = bytes(true, &[('t', 2.0), ('t', 2.0), ('f', 0.0), ('f', 1.0), ('f', 2.0), ('f', 3.0)]);
        for end in 0..whole.len() {
            assert!(read(&whole[..end]).is_err(), "cut at {end}");
        }
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..20_000 {
            let mut wrong = whole.clone();
            let place = random.usize(..wrong.len());
            wrong[place] = random.u8(..);
            let _ = read(&wrong);
        }
        let deep: Vec<u8> =
            std::iter::repeat_n(bytes(true, &[('t', 7.0), ('t', 1.0)]), 40).flatten().collect();
        assert!(read(&deep).unwrap_err().contains("too deep"));
        assert!(read(&bytes(true, &[('t', 10.0)])).unwrap_err().contains("a curve"));
    }
}
