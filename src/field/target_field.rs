use std::ops::Range;

use glam::DVec2;

use super::samples::SourceSamples;
use super::{RiskToDiameter, Source, Transfer, TransferTable, smallest_target};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};
use crate::mesh::{Element, InvalidTarget, Progress, bisection_edge_length, level_for_diameter};
use crate::raster::{MaxMipmap, PixelRect, Raster, RasterOnLattice};

/// Which points of a triangle its target diameter is the minimum over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RefinementRule {
    /// The three vertices: Eq. (12) of \[Report\]. A stroke that passes between the nodes is missed.
    Vertex,
    /// The whole closed triangle. Implies Eq. (12), misses nothing, and can be undone locally.
    Area,
}

/// Describes a [`TargetField`], except for the paint.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetFieldSpec {
    /// The sources of target diameters; the smallest diameter counts.
    pub sources: Vec<Source>,
    /// From risk to diameter; its ends bound h̄ everywhere.
    pub transfer: Transfer,
    /// h̄ where neither a source nor paint asks for a diameter, in world units.
    pub unasked: f64,
    /// Columns and rows of the pixels.
    pub size: [u32; 2],
}

/// The paint, each kind a raster over the same rectangle.
#[derive(Clone, Copy)]
pub struct PaintRef<'a> {
    /// Risk, 0 to 1.
    pub risk: &'a Raster,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: &'a Raster,
}

/// h̄ over a domain: the minimum of all sources and of what is painted, within \[h_min, h_max\].
///
/// By pixel, each diameter stands beside the level that it needs, in a max-mipmap: the area rule asks that
/// mipmap and no formula ([`Self::exceeds`]). The pixels are sampled in slices ([`Self::advance`]) and kept
/// up to date by rectangles ([`Self::update`]). The vertex rule evaluates the sources at nodes instead
/// ([`Self::target_at_node`]), and needs no pixels.
#[derive(Clone, Debug)]
pub struct TargetField {
    spec: TargetFieldSpec,
    table: TransferTable,
    lattice: Lattice,
    samples: SourceSamples,
    target: Raster,
    levels: MaxMipmap<u8>,
    on_lattice: RasterOnLattice,
    diameter_of_level: [f64; 64],
    sampled_rows: u32,
}

/// The level written where no level up to 63 is fine enough. The refinement then ends at the lattice, with an
/// error.
const BEYOND: u8 = u8::MAX;
/// Side of the blocks, in pixels, in which changed levels are reported: smaller blocks fit better, larger
/// ones are fewer.
const BLOCK: u32 = 16;

/// What at most [`BLOCK`] pixels of a row ask for; the rest is of no meaning.
struct Pixels {
    /// h̄ in world units.
    diameters: [f64; BLOCK as usize],
    levels: [u8; BLOCK as usize],
}

impl TargetField {
    /// A field over the bounds of `lattice`, not sampled yet. Until then it asks for nothing.
    pub fn new(spec: TargetFieldSpec, lattice: &Lattice) -> Self {
        let samples = SourceSamples::new(&spec, lattice.bounds());
        Self::with_samples(spec, lattice, samples)
    }

    /// As [`Self::new`]; sources that `earlier` has sampled too, over the same bounds and pixels, are not
    /// evaluated again.
    ///
    /// So a change of the coarse spacing evaluates nothing, and a change of the transfer curve only the
    /// sources of risk.
    pub fn reusing(spec: TargetFieldSpec, lattice: &Lattice, earlier: &Self) -> Self {
        if earlier.lattice.bounds() != lattice.bounds() {
            return Self::new(spec, lattice);
        }
        let samples = SourceSamples::reusing(&spec, lattice.bounds(), &earlier.samples, &earlier.spec);
        Self::with_samples(spec, lattice, samples)
    }

    fn with_samples(spec: TargetFieldSpec, lattice: &Lattice, samples: SourceSamples) -> Self {
        let (bounds, size) = (lattice.bounds(), spec.size);
        Self {
            table: TransferTable::new(&spec.transfer),
            lattice: *lattice,
            samples,
            // Zeros cost nothing until they are written over, slice by slice.
            target: Raster::filled(bounds, size, 0.0),
            levels: MaxMipmap::filled(size, 0),
            on_lattice: RasterOnLattice::new(lattice, size),
            diameter_of_level: std::array::from_fn(|l| bisection_edge_length(lattice.spacing(), l as u32)),
            sampled_rows: 0,
            spec,
        }
    }

    /// What the field is made from.
    pub fn spec(&self) -> &TargetFieldSpec {
        &self.spec
    }

    /// h̄ by pixel, in world units, rounded to f32.
    pub fn target(&self) -> &Raster {
        &self.target
    }

    /// The level that each pixel asks for.
    pub fn levels(&self) -> &MaxMipmap<u8> {
        &self.levels
    }

    /// Whether every pixel is sampled.
    pub fn is_sampled(&self) -> bool {
        self.sampled_rows == self.spec.size[1]
    }

    /// How many pixels are sampled so far.
    pub fn sampled_pixels(&self) -> usize {
        self.sampled_rows as usize * self.spec.size[0] as usize
    }

    /// How often a source was evaluated at a pixel to make this field: not at all where samples were reused.
    pub fn evaluations(&self) -> u64 {
        self.samples.evaluations()
    }

    /// Samples the sources and the paint row by row, about `pixels` of them.
    ///
    /// # Errors
    /// When a source gives NaN, infinity, zero or less at some pixel. The field is then of no use.
    pub fn advance(&mut self, paint: Option<PaintRef>, pixels: usize) -> Result<Progress, InvalidTarget> {
        let [columns, rows] = self.spec.size;
        let first = self.sampled_rows;
        let slice_rows = (pixels / columns as usize).clamp(1, rows as usize) as u32;
        let last = (first + slice_rows).min(rows);
        let slice = PixelRect { min: [0, first], max: [columns, last] };
        if !slice.is_empty() {
            self.samples.sample(&self.spec, &self.table, self.target.pixel_centers(), slice)?;
            self.sampled_rows = last;
            self.refresh_rows(paint, slice);
        }
        if !self.is_sampled() {
            return Ok(Progress::More);
        }
        self.samples.complete();
        Ok(Progress::Done)
    }

    /// Takes over what changed in the paint within `area`. Rows that are not sampled yet are left to
    /// [`Self::advance`].
    ///
    /// Returns small rectangles that hold all pixels that now ask for another level: only triangles that
    /// touch them may get another answer by the area rule. Most of a dab covers the dab before it, and paint
    /// over what is fine already changes no level at all.
    pub fn update(&mut self, paint: PaintRef, area: PixelRect) -> Vec<PixelRect> {
        self.refresh(Some(paint), area)
    }

    fn refresh(&mut self, paint: Option<PaintRef>, area: PixelRect) -> Vec<PixelRect> {
        let area = PixelRect { min: area.min, max: [area.max[0], area.max[1].min(self.sampled_rows)] };
        let columns = (area.min[0]..area.max[0]).step_by(BLOCK as usize);
        let rows = (area.min[1]..area.max[1]).step_by(BLOCK as usize);
        let mut changed = Vec::new();
        for min @ [x, y] in rows.flat_map(|y| columns.clone().map(move |x| [x, y])) {
            let max = [area.max[0].min(x + BLOCK), area.max[1].min(y + BLOCK)];
            changed.push(self.refresh_block(paint, PixelRect { min, max }));
        }
        changed.retain(|block| !block.is_empty());
        changed
    }

    /// Refreshes whole rows. Unlike [`Self::refresh`] it does not look for changed levels.
    fn refresh_rows(&mut self, paint: Option<PaintRef>, rows: PixelRect) {
        let columns = self.spec.size[0];
        let mut levels = Vec::with_capacity((columns * (rows.max[1] - rows.min[1])) as usize);
        for y in rows.min[1]..rows.max[1] {
            for x in (0..columns).step_by(BLOCK as usize) {
                let end = columns.min(x + BLOCK);
                let pixels = self.refresh_row(paint, y, x..end);
                levels.extend_from_slice(&pixels.levels[..(end - x) as usize]);
            }
        }
        let mut levels = levels.chunks_exact(columns as usize);
        self.levels.update_rows(rows, |_, row| row.copy_from_slice(levels.next().expect("a row each")));
    }

    /// Refreshes at most [`BLOCK`] × [`BLOCK`] pixels, and returns the bounds of those that ask for another
    /// level.
    fn refresh_block(&mut self, paint: Option<PaintRef>, block: PixelRect) -> PixelRect {
        let [left, right] = [block.min[0], block.max[0]];
        let mut levels = [[0; BLOCK as usize]; BLOCK as usize];
        let mut changed = PixelRect { min: [0, 0], max: [0, 0] };
        for (levels, y) in levels.iter_mut().zip(block.min[1]..block.max[1]) {
            *levels = self.refresh_row(paint, y, left..right).levels;
            let before = self.levels.row(y, left..right);
            let differs = |x: &u32| levels[(x - left) as usize] != before[(x - left) as usize];
            if let Some(first) = (left..right).find(differs) {
                let last = (left..right).rev().find(differs).unwrap_or(first);
                changed = changed.union(&PixelRect { min: [first, y], max: [last + 1, y + 1] });
            }
        }
        self.levels.update(changed, |x, y| levels[(y - block.min[1]) as usize][(x - left) as usize]);
        changed
    }

    /// Refreshes h̄ of at most [`BLOCK`] pixels of a row, and returns what they ask for. The levels are left
    /// to the caller.
    fn refresh_row(&mut self, paint: Option<PaintRef>, y: u32, columns: Range<u32>) -> Pixels {
        let pixels = self.evaluate(paint, y, columns.clone());
        let target = self.target.row_mut(y, columns);
        // To the nearest: this is for display and output. Levels are found from the diameter in f64.
        target.iter_mut().zip(pixels.diameters).for_each(|(target, diameter)| *target = diameter as f32);
        pixels
    }

    /// What at most [`BLOCK`] pixels of a row ask for. Loops over arrays of a fixed length, without branches
    /// but for the risk, so that the compiler can use vector instructions.
    fn evaluate(&self, paint: Option<PaintRef>, y: u32, columns: Range<u32>) -> Pixels {
        let count = columns.len();
        let asked: [f32; BLOCK as usize] = self.samples.row(columns.start, y, count);
        let mut pixels = Pixels { diameters: [0.0; BLOCK as usize], levels: [0; BLOCK as usize] };
        pixels.diameters.iter_mut().zip(asked).for_each(|(diameter, asked)| *diameter = f64::from(asked));
        if let Some(paint) = paint {
            let (risks, painted) = (paint.risk.row(y, columns.clone()), paint.diameter.row(y, columns));
            for ((asked, &risk), &diameter) in pixels.diameters.iter_mut().zip(risks).zip(painted) {
                *asked = self.with_paint(*asked, [risk, diameter]);
            }
        }
        let Transfer { h_min, h_max, .. } = self.spec.transfer;
        for (diameter, level) in pixels.diameters.iter_mut().zip(&mut pixels.levels) {
            *diameter = diameter.clamp(h_min, h_max);
            *level = self.level_for(*diameter);
        }
        pixels
    }

    /// The smallest diameter that is asked for, with this risk and diameter painted.
    #[inline]
    fn with_paint(&self, asked: f64, [risk, diameter]: [f32; 2]) -> f64 {
        let asked = asked.min(f64::from(diameter));
        if risk > 0.0 { asked.min(self.table.diameter(f64::from(risk))) } else { asked }
    }

    /// The level that a pixel would ask for with this risk and diameter painted on it.
    pub fn level_with(&self, x: u32, y: u32, painted: [f32; 2]) -> u8 {
        let [asked] = self.samples.row(x, y, 1).map(f64::from);
        let Transfer { h_min, h_max, .. } = self.spec.transfer;
        self.level_for(self.with_paint(asked, painted).clamp(h_min, h_max))
    }

    /// The number of levels whose triangles are longer than `diameter`.
    ///
    /// Two levels halve the length. So with 2ᵉ ≤ diameter < 2ᵉ⁺¹, and 2ᶠ ≤ length of level 0 < 2ᶠ⁺¹, all
    /// levels below 2 (f − e) − 1 are longer, and none from 2 (f − e) + 2 on: three are left to compare.
    #[inline]
    fn level_for(&self, diameter: f64) -> u8 {
        let lengths = &self.diameter_of_level;
        let first = (2 * (exponent(lengths[0]) - exponent(diameter)) - 1).clamp(0, 61) as usize;
        let longer = |level: usize| usize::from(lengths[level] > diameter);
        let level = first + longer(first) + longer(first + 1) + longer(first + 2);
        if level < 64 { level as u8 } else { BEYOND }
    }

    /// Whether an element's diameter exceeds its target (Eq. 13) by the area rule.
    #[inline]
    pub fn exceeds(&self, element: &Element) -> bool {
        self.on_lattice.any_above(&self.levels, element.corners, element.triangle.level() as u8)
    }

    /// [`Self::exceeds`] where the pixels asked for other levels, of a triangle by its corners and its level.
    #[inline]
    pub fn would_exceed(&self, levels: &MaxMipmap<u8>, corners: [LatticePoint; 3], level: u32) -> bool {
        self.on_lattice.any_above(levels, corners, level as u8)
    }

    /// h̄ at a node, for the vertex rule: the sources are evaluated at the point itself, not by pixel.
    ///
    /// A value that no mesh can meet (NaN, infinity, zero or less) is returned as it is, for the rule to
    /// refuse.
    pub fn target_at_node(&self, paint: Option<PaintRef>, point: DVec2) -> f64 {
        let mut asked = match smallest_target(&self.spec.sources, point, &self.spec.transfer) {
            Ok(asked) => asked,
            Err(invalid) => return invalid.value,
        };
        if let Some(PaintRef { risk, diameter }) = paint {
            let painted = diameter.sample(point).map_or(f64::INFINITY, f64::from);
            let by_risk =
                risk.sample(point).map_or(f64::INFINITY, |risk| self.table.diameter(f64::from(risk)));
            asked = asked.min(painted).min(by_risk);
        }
        if asked == f64::INFINITY {
            return self.spec.unasked;
        }
        asked.clamp(self.spec.transfer.h_min, self.spec.transfer.h_max)
    }

    /// h̄ at a point in world units, as `rule` sees it: what files and the inspector show.
    pub fn target_by_rule(&self, rule: RefinementRule, paint: Option<PaintRef>, point: DVec2) -> f64 {
        match rule {
            RefinementRule::Area => self.at(point).unwrap_or(self.spec.unasked),
            RefinementRule::Vertex => self.target_at_node(paint, point),
        }
    }

    /// The part of the lattice on which [`Self::exceeds`] may answer differently once the pixels of `area`
    /// have changed.
    pub fn lattice_rect(&self, area: PixelRect) -> LatticeRect {
        self.on_lattice.lattice_rect(area)
    }

    /// h̄ of the pixel at a point, both in world units; `None` outside the field.
    pub fn at(&self, point: DVec2) -> Option<f64> {
        let target = f64::from(self.target.sample(point)?);
        Some(if target.is_finite() { target } else { self.spec.unasked })
    }

    /// The level that a triangle of the given diameter in world units has.
    pub fn level_of_diameter(&self, diameter: f64) -> Option<u32> {
        level_for_diameter(self.lattice.spacing(), diameter)
    }
}

/// The exponent of a positive number: 2ᵉ ≤ x < 2ᵉ⁺¹.
#[inline]
fn exponent(x: f64) -> i64 {
    (x.to_bits() >> 52) as i64 - 1023
}

/// The nearest f32 that is not below `value`: rounding must not ask for one level more.
pub fn f32_not_below(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    #[test]
    fn only_pixels_that_ask_for_another_level_are_reported() {
        let (bounds, size) = (Rect::UNIT, [70, 50]);
        let lattice = Lattice::covering(bounds, 0.25, 1000).unwrap();
        let transfer = Transfer { h_min: 0.01, h_max: 0.2, shape: 1.0 };
        let spec = TargetFieldSpec { sources: vec![Source::Constant(0.05)], transfer, unasked: 0.2, size };
        let mut field = TargetField::new(spec.clone(), &lattice);
        let (mut risk, mut diameter) =
            (Raster::filled(bounds, size, 0.0), Raster::filled(bounds, size, f32::INFINITY));
        while field.advance(Some(PaintRef { risk: &risk, diameter: &diameter }), 100).unwrap()
            == Progress::More
        {}
        let mut random = fastrand::Rng::with_seed(14);
        let mut reported = 0;
        for _ in 0..300 {
            let min = [random.u32(..70), random.u32(..50)];
            let max = [random.u32(min[0]..70) + 1, random.u32(min[1]..50) + 1];
            let area = PixelRect { min, max };
            // Most of it changes no level: it is coarser than the base, or as it was.
            for _ in 0..4 {
                let (x, y) = (random.u32(min[0]..max[0]), random.u32(min[1]..max[1]));
                risk.set(x, y, random.f32());
                diameter.set(x, y, 0.3 * random.f32());
            }
            let before = field.levels().clone();
            let changed = field.update(PaintRef { risk: &risk, diameter: &diameter }, area);
            let within = |x, y| {
                changed.iter().any(|r| (r.min[0]..r.max[0]).contains(&x) && (r.min[1]..r.max[1]).contains(&y))
            };
            for (x, y) in risk.all().pixels() {
                assert!(before.get(x, y) == field.levels().get(x, y) || within(x, y), "{x}, {y}");
            }
            let mut from_scratch = TargetField::new(spec.clone(), &lattice);
            from_scratch.advance(Some(PaintRef { risk: &risk, diameter: &diameter }), usize::MAX).unwrap();
            let same = |(x, y)| from_scratch.levels().get(x, y) == field.levels().get(x, y);
            assert!(risk.all().pixels().all(same));
            for rect in &changed {
                assert!(rect.pixels().any(|(x, y)| before.get(x, y) != field.levels().get(x, y)), "{rect:?}");
            }
            assert_eq!(field.update(PaintRef { risk: &risk, diameter: &diameter }, area), []);
            reported += changed.len();
        }
        assert!(reported > 300, "{reported}");
    }
}
