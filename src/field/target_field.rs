use glam::DVec2;

use super::{RiskToDiameter, Source, Transfer, TransferTable, smallest_target};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};
use crate::mesh::{Element, InvalidTarget, Progress, bisection_edge_length, level_for_diameter};
use crate::raster::{MaxMipmap, PixelRect, Raster, RasterOnLattice};

/// Which points of a triangle its target diameter is the minimum over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefinementRule {
    /// The three vertices: the report's Eq. (12). A stroke that passes between the nodes leaves no trace.
    Vertex,
    /// The whole closed triangle. Implies Eq. (12), misses nothing, and can be undone locally.
    Area,
}

/// What a [`TargetField`] is made from, besides paint.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetFieldSpec {
    /// All ask; the smallest diameter wins.
    pub sources: Vec<Source>,
    /// From risk to diameter; its ends bound h̄ everywhere.
    pub transfer: Transfer,
    /// Columns and rows.
    pub size: [u32; 2],
}

/// The painted layers, each a raster over the same rectangle.
#[derive(Clone, Copy)]
pub struct PaintRef<'a> {
    /// Risk, 0 to 1.
    pub risk: &'a Raster,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: &'a Raster,
}

/// h̄ over a domain, by pixel: the minimum of all sources and of what is painted, within \[h_min, h_max\].
///
/// Beside each diameter stands the level that it needs, in a mipmap of maxima: the area rule asks that mipmap and no
/// formula. Filled in slices ([`Self::fill`]) and kept up to date by rectangles ([`Self::update`]).
#[derive(Clone, Debug)]
pub struct TargetField {
    spec: TargetFieldSpec,
    table: TransferTable,
    lattice: Lattice,
    /// The smallest diameter that the sources ask for.
    base: Raster,
    target: Raster,
    levels: MaxMipmap<u8>,
    on_lattice: RasterOnLattice,
    diameter_of_level: [f64; 64],
    filled_rows: u32,
}

/// The level written where no level up to 63 is fine enough. The refinement then ends at the lattice, with an error.
const BEYOND: u8 = u8::MAX;
/// Pixels along a side of the squares in which changed levels are told: smaller ones fit better, larger ones are fewer.
const BLOCK: u32 = 16;

impl TargetField {
    /// A field over the bounds of `lattice`, yet to be filled. Until then it asks for nothing.
    pub fn new(spec: TargetFieldSpec, lattice: &Lattice) -> Self {
        let (bounds, size) = (lattice.bounds(), spec.size);
        Self {
            table: TransferTable::new(&spec.transfer),
            lattice: *lattice,
            // Zeros cost nothing until they are written over, slice by slice.
            base: Raster::filled(bounds, size, 0.0),
            target: Raster::filled(bounds, size, 0.0),
            levels: MaxMipmap::filled(size, 0),
            on_lattice: RasterOnLattice::new(lattice, size),
            diameter_of_level: std::array::from_fn(|l| bisection_edge_length(lattice.spacing(), l as u32)),
            filled_rows: 0,
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

    /// Evaluates the sources and the paint row by row, about `pixels` of them.
    ///
    /// # Errors
    /// When a source gives NaN, infinity, zero or less at some pixel. The field is then of no use.
    pub fn fill(&mut self, paint: PaintRef, pixels: usize) -> Result<Progress, InvalidTarget> {
        self.fill_rows(Some(paint), pixels)
    }

    /// As [`Self::fill`] where nothing is painted.
    ///
    /// # Errors
    /// As [`Self::fill`].
    pub fn fill_unpainted(&mut self, pixels: usize) -> Result<Progress, InvalidTarget> {
        self.fill_rows(None, pixels)
    }

    fn fill_rows(&mut self, paint: Option<PaintRef>, pixels: usize) -> Result<Progress, InvalidTarget> {
        let [columns, rows] = self.spec.size;
        let first = self.filled_rows;
        let slice_rows = (pixels / columns as usize).clamp(1, rows as usize) as u32;
        let last = (first + slice_rows).min(rows);
        let slice = PixelRect { min: [0, first], max: [columns, last] };
        let pixel_center = self.base.pixel_centers();
        for (x, y) in slice.pixels() {
            let point = pixel_center(x, y);
            let value = smallest_target(&self.spec.sources, point, &self.table)?;
            self.base.set(x, y, f32_not_below(value));
        }
        self.filled_rows = last;
        self.refresh(paint, slice);
        Ok(if last == rows { Progress::Done } else { Progress::More })
    }

    /// Takes over what changed in the painted layers within `area`. Rows not yet filled are left to [`Self::fill`].
    ///
    /// Returns small rectangles that hold all pixels that now ask for another level: only triangles that touch them may get
    /// another answer by the area rule. The next dab of a stroke covers the last one but for a crescent, and paint over what is
    /// fine already changes no level at all.
    pub fn update(&mut self, paint: PaintRef, area: PixelRect) -> Vec<PixelRect> {
        self.refresh(Some(paint), area)
    }

    fn refresh(&mut self, paint: Option<PaintRef>, area: PixelRect) -> Vec<PixelRect> {
        let area = PixelRect { min: area.min, max: [area.max[0], area.max[1].min(self.filled_rows)] };
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

    /// Refreshes at most [`BLOCK`] × [`BLOCK`] pixels, and returns the bounds of those that ask for another level.
    fn refresh_block(&mut self, paint: Option<PaintRef>, block: PixelRect) -> PixelRect {
        let mut levels = [0; (BLOCK * BLOCK) as usize];
        let place = |x: u32, y: u32| ((y - block.min[1]) * BLOCK + x - block.min[0]) as usize;
        let mut changed = PixelRect { min: [0, 0], max: [0, 0] };
        for (x, y) in block.pixels() {
            let painted = paint.map_or([0.0, f32::INFINITY], |p| [p.risk.get(x, y), p.diameter.get(x, y)]);
            let diameter = self.diameter_with(x, y, painted);
            self.target.set(x, y, diameter as f32);
            let level = self.level_for(diameter);
            levels[place(x, y)] = level;
            if level != self.levels.get(x, y) {
                changed = changed.union(&PixelRect { min: [x, y], max: [x + 1, y + 1] });
            }
        }
        self.levels.update(changed, |x, y| levels[place(x, y)]);
        changed
    }

    /// h̄ of a pixel, with so much risk and so small a diameter painted on it.
    fn diameter_with(&self, x: u32, y: u32, [risk, diameter]: [f32; 2]) -> f64 {
        let mut asked = f64::from(self.base.get(x, y)).min(f64::from(diameter));
        if risk > 0.0 {
            asked = asked.min(self.table.diameter(f64::from(risk)));
        }
        asked.clamp(self.spec.transfer.h_min, self.spec.transfer.h_max)
    }

    /// The level that a pixel would ask for with this risk and diameter painted on it.
    pub fn level_with(&self, x: u32, y: u32, painted: [f32; 2]) -> u8 {
        self.level_for(self.diameter_with(x, y, painted))
    }

    fn level_for(&self, diameter: f64) -> u8 {
        let fine_enough = self.diameter_of_level.partition_point(|&length| length > diameter);
        if fine_enough < 64 { fine_enough as u8 } else { BEYOND }
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

    /// h̄ at a node, for the vertex rule: sources are asked at the very point and not by pixel.
    ///
    /// A value that no mesh can meet (NaN, infinity, zero or less) comes out as it is, for the rule to refuse.
    pub fn target_at_node(&self, paint: PaintRef, point: DVec2) -> f64 {
        let asked = match smallest_target(&self.spec.sources, point, &self.spec.transfer) {
            Ok(asked) => asked,
            Err(invalid) => return invalid.value,
        };
        let painted = paint.diameter.sample(point).map_or(f64::INFINITY, f64::from);
        let risk =
            paint.risk.sample(point).map_or(f64::INFINITY, |risk| self.table.diameter(f64::from(risk)));
        asked.min(painted).min(risk).clamp(self.spec.transfer.h_min, self.spec.transfer.h_max)
    }

    /// The part of the lattice on which [`Self::exceeds`] may answer differently once the pixels of `area` have changed.
    pub fn lattice_rect(&self, area: PixelRect) -> LatticeRect {
        self.on_lattice.lattice_rect(area)
    }

    /// h̄ at a point in world units, `None` outside the field.
    pub fn at(&self, point: DVec2) -> Option<f64> {
        self.target.sample(point).map(f64::from)
    }

    /// The level that a triangle of the given diameter in world units has.
    pub fn level_of_diameter(&self, diameter: f64) -> Option<u32> {
        level_for_diameter(self.lattice.spacing(), diameter)
    }
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
    fn only_pixels_that_ask_for_another_level_are_told() {
        let (bounds, size) = (Rect::UNIT, [70, 50]);
        let lattice = Lattice::covering(bounds, 0.25, 1000).unwrap();
        let transfer = Transfer { h_min: 0.01, h_max: 0.2, shape: 1.0 };
        let spec = TargetFieldSpec { sources: vec![Source::Constant(0.05)], transfer, size };
        let mut field = TargetField::new(spec.clone(), &lattice);
        let (mut risk, mut diameter) =
            (Raster::filled(bounds, size, 0.0), Raster::filled(bounds, size, f32::INFINITY));
        while field.fill(PaintRef { risk: &risk, diameter: &diameter }, 100).unwrap() == Progress::More {}
        let mut random = fastrand::Rng::with_seed(14);
        let mut told = 0;
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
            let mut anew = TargetField::new(spec.clone(), &lattice);
            anew.fill(PaintRef { risk: &risk, diameter: &diameter }, usize::MAX).unwrap();
            assert!(risk.all().pixels().all(|(x, y)| anew.levels().get(x, y) == field.levels().get(x, y)));
            for rect in &changed {
                assert!(rect.pixels().any(|(x, y)| before.get(x, y) != field.levels().get(x, y)), "{rect:?}");
            }
            assert_eq!(field.update(PaintRef { risk: &risk, diameter: &diameter }, area), []);
            told += changed.len();
        }
        assert!(told > 300, "{told}");
    }
}
