//! Points, lines, polygons and threats as bytes.
//!
//! Shapes have 32-bit numbers first, little-endian: of points; of lines, and of the points of each; of
//! polygons, of the rings of each, and of the points of each ring. Then come x of all points in this order,
//! and y of all points, as [`write_floats`] writes them. Threats have their number, then x, y, range and peak
//! of all as such floats, and one byte for each law.

use std::io::{self, Read, Write};

use glam::DVec2;

use super::super::Flaw;
use super::archive::Unpacking;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{ShapeList, Threat, ThreatLaw};

/// Floats whose bytes are interleaved. Neighbouring points have equal high bytes, and equal bytes in a row
/// pack well.
const BLOCK: usize = 1 << 12;
const COUNT_BYTES: u64 = 4;
const FLOAT_BYTES: u64 = 8;

/// Shapes that belong to somebody else.
#[derive(Clone, Copy, Default)]
pub struct ShapeSlices<'a> {
    pub points: &'a [DVec2],
    pub lines: &'a [Vec<DVec2>],
    pub polygons: &'a [Polygon],
}

impl<'a> From<&'a ShapeList> for ShapeSlices<'a> {
    fn from(list: &'a ShapeList) -> Self {
        Self { points: &list.points, lines: &list.lines, polygons: &list.polygons }
    }
}

/// Writes shapes.
///
/// # Errors
/// Fails with the errors of `out`, and when there are more points than a 32-bit number counts.
pub fn write_shapes(out: &mut dyn Write, shapes: ShapeSlices) -> io::Result<()> {
    let ShapeSlices { points, lines, polygons } = shapes;
    write_count(out, points.len())?;
    write_counts(out, lines.iter().map(Vec::len))?;
    write_counts(out, polygons.iter().map(Vec::len))?;
    polygons.iter().flatten().try_for_each(|ring| write_count(out, ring.len()))?;
    let rings = polygons.iter().flatten().flatten();
    let all = points.iter().chain(lines.iter().flatten()).chain(rings);
    write_floats(out, all.clone().map(|point| point.x))?;
    write_floats(out, all.map(|point| point.y))
}

/// Reads shapes.
///
/// # Errors
/// Fails when the bytes are damaged, a coordinate is not finite, a line has fewer than two points, a polygon
/// no ring, or a ring fewer than three points.
pub fn read_shapes(input: &mut Unpacking) -> Result<ShapeList, Flaw> {
    let single = read_count(input)?;
    let of_lines = read_counts(input, 2)?;
    let of_polygons = read_counts(input, 1)?;
    let ring_count = of_polygons.iter().try_fold(0usize, |sum, &rings| sum.checked_add(rings));
    let of_rings = counts(input, ring_count.ok_or(Flaw::Damaged)?, 3)?;
    let total = of_lines.iter().chain(&of_rings).try_fold(single, |sum, &points| sum.checked_add(points));
    let total = total.filter(|total| FLOAT_BYTES * 2 * *total as u64 == input.left()).ok_or(Flaw::Damaged)?;
    let [xs, ys] = [read_floats(input, total)?, read_floats(input, total)?];
    let mut points = xs.iter().zip(&ys).map(|(&x, &y)| DVec2::new(x, y));
    if let Some(point) = points.clone().find(|point| !point.is_finite()) {
        return Err(impossible(format_args!("a point at {}, {}", point.x, point.y)));
    }
    let mut take = |count: usize| points.by_ref().take(count).collect::<Vec<_>>();
    let single = take(single);
    let lines = of_lines.into_iter().map(&mut take).collect();
    let mut rings = of_rings.into_iter().map(take);
    let polygons = of_polygons.into_iter().map(|count| rings.by_ref().take(count).collect()).collect();
    Ok(ShapeList { points: single, lines, polygons })
}

/// Writes threats.
///
/// # Errors
/// Fails as [`write_shapes`] does.
pub fn write_threats(out: &mut dyn Write, threats: &[Threat]) -> io::Result<()> {
    write_count(out, threats.len())?;
    for number in 0..4 {
        let floats = |&Threat { at, range, peak, law: _ }: &Threat| [at.x, at.y, range, peak][number];
        write_floats(out, threats.iter().map(floats))?;
    }
    let law = |threat: &Threat| ThreatLaw::ALL.iter().position(|(law, _)| *law == threat.law);
    let laws: Vec<u8> = threats.iter().map(|threat| law(threat).unwrap_or(0) as u8).collect();
    out.write_all(&laws)
}

/// Reads threats. Their numbers are not checked.
///
/// # Errors
/// Fails when the bytes are damaged.
pub fn read_threats(input: &mut Unpacking) -> Result<Vec<Threat>, Flaw> {
    let count = read_count(input)?;
    if (4 * FLOAT_BYTES + 1) * count as u64 != input.left() {
        return Err(Flaw::Damaged);
    }
    let mut column = || read_floats(input, count);
    let [x, y, range, peak] = [column()?, column()?, column()?, column()?];
    let mut laws = vec![0; count];
    input.read_exact(&mut laws).map_err(|_| Flaw::Damaged)?;
    let threat = |n: usize| {
        let &(law, _) = ThreatLaw::ALL.get(usize::from(laws[n])).ok_or(Flaw::Damaged)?;
        Ok(Threat { at: DVec2::new(x[n], y[n]), range: range[n], peak: peak[n], law })
    };
    (0..count).map(threat).collect()
}

fn write_count(out: &mut dyn Write, count: usize) -> io::Result<()> {
    let count = u32::try_from(count).map_err(|_| io::Error::other("it has more than 4 billion points"))?;
    out.write_all(&count.to_le_bytes())
}

fn write_counts(out: &mut dyn Write, counts: impl ExactSizeIterator<Item = usize>) -> io::Result<()> {
    write_count(out, counts.len())?;
    counts.into_iter().try_for_each(|count| write_count(out, count))
}

fn read_count(input: &mut Unpacking) -> Result<usize, Flaw> {
    let mut bytes = [0; COUNT_BYTES as usize];
    input.read_exact(&mut bytes).map_err(|_| Flaw::Damaged)?;
    Ok(u32::from_le_bytes(bytes) as usize)
}

/// Reads a list of numbers after its length.
fn read_counts(input: &mut Unpacking, least: usize) -> Result<Vec<usize>, Flaw> {
    let length = read_count(input)?;
    counts(input, length, least)
}

/// Reads numbers, of which none is below `least`. No memory is taken for more than are there.
fn counts(input: &mut Unpacking, length: usize, least: usize) -> Result<Vec<usize>, Flaw> {
    if COUNT_BYTES * length as u64 > input.left() {
        return Err(Flaw::Damaged);
    }
    let counts: Vec<usize> = (0..length).map(|_| read_count(input)).collect::<Result<_, _>>()?;
    match counts.iter().find(|count| **count < least) {
        Some(count) => Err(impossible(format_args!("a shape of {count} parts"))),
        None => Ok(counts),
    }
}

/// Writes numbers in blocks: for each the most significant bytes of all numbers first.
fn write_floats(out: &mut dyn Write, mut floats: impl Iterator<Item = f64>) -> io::Result<()> {
    loop {
        let block: Vec<[u8; 8]> = floats.by_ref().take(BLOCK).map(f64::to_be_bytes).collect();
        if block.is_empty() {
            return Ok(());
        }
        let planes: Vec<u8> = (0..8).flat_map(|n| block.iter().map(move |bytes| bytes[n])).collect();
        out.write_all(&planes)?;
    }
}

/// Reads numbers. The caller has checked that as many are there.
fn read_floats(input: &mut Unpacking, count: usize) -> Result<Vec<f64>, Flaw> {
    let mut floats = Vec::new();
    let mut planes = [0; BLOCK * FLOAT_BYTES as usize];
    while floats.len() < count {
        let length = BLOCK.min(count - floats.len());
        let planes = &mut planes[..8 * length];
        input.read_exact(planes).map_err(|_| Flaw::Damaged)?;
        let float = |i: usize| f64::from_be_bytes(std::array::from_fn(|n| planes[n * length + i]));
        floats.extend((0..length).map(float));
    }
    Ok(floats)
}

fn impossible(what: impl std::fmt::Display) -> Flaw {
    Flaw::Syntax(format!("there is {what} in it, which cannot be: Meshbrush did not write this file."))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::archive::{Archive, ArchiveWriter};
    use super::super::limits::Limits;
    use super::*;
    use crate::io::Meter;

    const NAME: &str = "shapes.0";

    fn packed(write: impl Fn(&mut dyn Write) -> io::Result<()>) -> Vec<u8> {
        let mut archive = ArchiveWriter::new(Vec::new(), Limits::PROJECT);
        archive.add(NAME, &Meter::default(), write).unwrap();
        archive.finish().unwrap()
    }

    fn unpacked<T>(bytes: &[u8], read: impl Fn(&mut Unpacking) -> Result<T, Flaw>) -> Result<T, Flaw> {
        let archive = Archive::open(bytes, Limits::PROJECT)?;
        let mut input = archive.part(NAME).unwrap().unpack(&Meter::default());
        let result = read(&mut input)?;
        input.finish()?;
        Ok(result)
    }

    fn places(random: &mut fastrand::Rng, count: usize) -> Vec<DVec2> {
        let scale = 10f64.powi(random.i32(-300..300));
        (0..count).map(|_| scale * dvec2(random.f64() - 0.5, random.f64())).collect()
    }

    #[test]
    fn random_shapes_are_read_bit_for_bit() {
        for seed in 0..200 {
            let random = &mut fastrand::Rng::with_seed(seed);
            let most = [4, 40, 9000][random.usize(..3)];
            let mut list = |least: usize| {
                let count = random.usize(least..most);
                places(random, count)
            };
            let lines = (0..seed % 4).map(|_| list(2)).collect();
            let polygons = (0..seed % 3).map(|n| (0..=n).map(|_| list(3)).collect()).collect();
            let shapes = ShapeList { points: list(0), lines, polygons };
            let bytes = packed(|out| write_shapes(out, (&shapes).into()));
            assert!(unpacked(&bytes, read_shapes).unwrap() == shapes, "seed {seed}");
        }
    }

    #[test]
    fn a_million_points_are_read_bit_for_bit_and_take_17_bytes_each_at_most() {
        let mut random = fastrand::Rng::with_seed(7);
        let shapes = ShapeList { lines: vec![places(&mut random, 1_000_000)], ..ShapeList::default() };
        let bytes = packed(|out| write_shapes(out, (&shapes).into()));
        assert!(bytes.len() < 17_000_000, "{} bytes", bytes.len());
        assert!(unpacked(&bytes, read_shapes).unwrap() == shapes);
    }

    #[test]
    fn random_threats_are_read_bit_for_bit() {
        for seed in 0..50 {
            let random = &mut fastrand::Rng::with_seed(seed);
            let threat = |_| Threat {
                at: dvec2(random.f64(), -random.f64()),
                range: random.f64(),
                peak: random.f64(),
                law: ThreatLaw::ALL[random.usize(..3)].0,
            };
            let threats: Vec<Threat> = (0..seed * seed * 3).map(threat).collect();
            let bytes = packed(|out| write_threats(out, &threats));
            assert_eq!(unpacked(&bytes, read_threats).unwrap(), threats, "seed {seed}");
        }
    }

    #[test]
    fn damaged_lists_are_refused() {
        let triangle = vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)];
        let lines = vec![triangle.clone()];
        let shapes = ShapeList { points: triangle.clone(), lines, polygons: vec![vec![triangle]] };
        let mut bytes = Vec::new();
        write_shapes(&mut bytes, (&shapes).into()).unwrap();
        let read = |bytes: &[u8]| unpacked(&packed(|out| out.write_all(bytes)), read_shapes);
        assert!(read(&bytes).unwrap() == shapes);
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "{length} bytes");
        }
        assert!(read(&[&bytes[..], &[0]].concat()).is_err(), "a byte too many");
        // Numbers of points, of lines, of points of the line, of polygons, of rings, of points of the ring.
        for place in 0..6 {
            for count in [0, 1, 2, 4, u32::MAX] {
                let mut damaged = bytes.clone();
                damaged[4 * place..][..4].copy_from_slice(&u32::to_le_bytes(count));
                assert!(damaged == bytes || read(&damaged).is_err(), "number {place} is {count}");
            }
        }
        for impossible in [f64::NAN, f64::INFINITY] {
            let mut shapes = shapes.clone();
            shapes.lines[0][1].y = impossible;
            let mut bytes = Vec::new();
            write_shapes(&mut bytes, (&shapes).into()).unwrap();
            assert!(read(&bytes).unwrap_err().to_string().contains("a point at 1, "));
        }
    }
}
