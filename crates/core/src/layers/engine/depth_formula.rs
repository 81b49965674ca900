//! Formulas that use the depth of the water.

use glam::DVec2;

use crate::field::{Bounds, Formula};
use crate::geometry::Lattice;
use crate::layers::{DepthSizes, Quantity};
use crate::raster::ValueRange;

use super::analytic::{Analytic, Function};
use super::asked::Ternary;
use super::cells::{Cells, Cut};
use super::cover::Cover;

/// A formula with the surface of depths of its stack: at each place the value of the highest file that has
/// one. Where none has, the formula has no value.
#[derive(Clone, Debug)]
pub struct DepthFormula {
    formula: Formula,
    /// How values count.
    values: Analytic,
    /// The files, from the top of the stack to its bottom, with the meaning of their values.
    files: Vec<(Cover, DepthSizes)>,
}

/// The depths in some cells.
struct CellDepths {
    /// Bounds in metres.
    depths: Bounds,
    /// In how many of the cells there is one.
    share: Ternary,
    /// Where to divide the cells to know more.
    cut: Option<Cut>,
}

impl DepthFormula {
    /// `files` are from the top of the stack to its bottom.
    pub fn new(formula: &Formula, quantity: Quantity, files: &[(Cover, DepthSizes)]) -> Self {
        Self {
            formula: formula.clone(),
            values: Analytic::new(Function::Formula(formula.clone()), quantity),
            files: files.to_vec(),
        }
    }

    /// Returns the depths in some cells; `None` where there are none.
    fn depths(&self, cells: &Cells, lattice: &Lattice) -> Option<CellDepths> {
        let mut found: Option<CellDepths> = None;
        for (cover, sizes) in &self.files {
            let Some(values) = cover.values(cells, lattice) else { continue };
            let [a, b] = [values.range.least, values.range.greatest].map(|v| sizes.depth_of(v.into()));
            let own = Bounds::new(a.min(b), a.max(b));
            found = Some(match found {
                None => CellDepths { depths: own, share: values.share, cut: values.cut },
                Some(above) => CellDepths {
                    depths: above.depths.union(own),
                    share: above.share.or(values.share),
                    cut: above.cut.or(values.cut),
                },
            });
            if values.share == Ternary::Always {
                break;
            }
        }
        found
    }

    /// Returns the range of the values in some cells, `None` where there are none, and where to divide the
    /// cells to know more.
    pub fn range(&self, cells: &Cells, lattice: &Lattice) -> (Option<ValueRange>, Option<Cut>) {
        let Some(CellDepths { depths, share, cut }) = self.depths(cells, lattice) else {
            return (None, None);
        };
        let Some(middle) = cells.middle() else {
            // The pixel and the masks of a single cell are known.
            let at = cells.center(lattice);
            let value = self.formula.eval_with_depth(at.x, at.y, depths.least);
            return (Some(ValueRange::one(self.values.value(value))), None);
        };
        let mut range = self.values.enclosed(self.formula.bounds_with_depth(&cells.centers(lattice), depths));
        if share != Ternary::Always {
            range = range.union(ValueRange::one(self.nothing()));
        }
        (Some(range), cut.or(Some(middle)).filter(|_| !range.is_one()))
    }

    /// Returns the value that asks for nothing.
    fn nothing(&self) -> f32 {
        match self.values.quantity {
            Quantity::Diameter | Quantity::Error => f32::INFINITY,
            Quantity::Risk => f32::NEG_INFINITY,
        }
    }

    /// Returns the value at a point in world units, unchecked; `None` where there is no depth.
    pub fn raw(&self, point: DVec2) -> Option<f64> {
        let depth = self
            .files
            .iter()
            .find_map(|(cover, sizes)| cover.value_at(point).map(|value| sizes.depth_of(f64::from(value))))?;
        Some(self.formula.eval_with_depth(point.x, point.y, depth))
    }

    /// Returns whether all values in some cells are certainly valid.
    pub fn is_valid_in(&self, cells: &Cells, lattice: &Lattice) -> bool {
        self.depths(cells, lattice).is_none_or(|CellDepths { depths, .. }| {
            let bounds = self.formula.bounds_with_depth(&cells.world_rect(lattice), depths);
            self.values.are_valid(bounds)
        })
    }

    /// Returns how values count.
    pub fn values(&self) -> &Analytic {
        &self.values
    }

    /// Returns the binary logarithm of the side of the largest pixels in lattice steps, rounded down, if
    /// there are any.
    pub fn log_steps(&self) -> Option<i32> {
        self.files.iter().map(|(cover, _)| cover.log_steps()).max()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::dvec2;

    use super::*;
    use crate::domain::corners;
    use crate::geometry::Rect;
    use crate::layers::compile::depths_of;
    use crate::layers::{DepthRule, Depths, Layer, Mask, PositiveDepth, RasterSource};
    use crate::raster::{Raster, RasterPyramid};

    /// Files of depths whose pixels are lattice cells times a power of two, some masked, with gaps.
    fn files(random: &mut fastrand::Rng) -> Vec<Layer> {
        let file = |random: &mut fastrand::Rng| {
            let bounds = Rect::new(DVec2::ZERO, DVec2::ONE);
            let side = 1 << random.u32(1..4);
            let value = |_| if random.u8(..3) == 0 { f32::NAN } else { 40.0 * random.f32() - 10.0 };
            let raster = Raster::from_values(bounds, [side; 2], (0..side * side).map(value).collect());
            let source = RasterSource { name: "a".into(), raster: Arc::new(RasterPyramid::new(raster)) };
            let positive = [PositiveDepth::Up, PositiveDepth::Down][random.usize(..2)];
            let between = DepthSizes::ALL_WATER;
            Depths::new(source, DepthSizes { positive, offset: 3.0, between, rule: DepthRule::Nothing })
        };
        let mut layers = Layer::stack((0..random.usize(1..4)).map(|_| file(random)));
        for layer in &mut layers {
            let at = dvec2(random.f64(), random.f64());
            let mask = || Mask::new(&[vec![corners(&Rect::around(at, 0.4))]]).unwrap();
            layer.mask = (random.u8(..3) == 0).then(mask);
            layer.visible = random.u8(..4) > 0;
        }
        layers
    }

    /// The depth of the highest file with a value, from its pixel.
    fn referee_depth(layers: &[Layer], at: DVec2) -> Option<f64> {
        layers.iter().rev().filter(|layer| layer.visible).find_map(|layer| {
            let Some(depths) = layer.kind.get::<Depths>() else { panic!("{layer:?}") };
            let raster = depths.source().raster.raster();
            let side = f64::from(raster.size()[0]);
            let value = raster.get((at.x * side) as u32, (at.y * side) as u32);
            let is_in_mask = layer.mask.as_ref().is_none_or(|mask| mask.contains(at));
            let sign = if depths.sizes().positive == PositiveDepth::Up { -1.0 } else { 1.0 };
            (is_in_mask && !value.is_nan()).then_some(sign * f64::from(value) + 3.0)
        })
    }

    #[test]
    fn ranges_hold_the_value_of_every_cell_and_are_exact_at_a_single_one() {
        let lattice = Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap();
        let extent = i64::from(lattice.extent().x);
        let mut random = fastrand::Rng::with_seed(17);
        let texts = ["1 + abs(depth)", "if(depth > 4, x + 0.1, 2)", "depth", "1/(depth - 4)"];
        let (mut without, mut decided) = (0, 0);
        for round in 0..2000 {
            let layers = files(&mut random);
            let formula = Formula::parse_of_size(texts[round % texts.len()]).unwrap();
            let values = DepthFormula::new(&formula, Quantity::Diameter, &depths_of(&layers, &lattice));
            let min = [0, 0].map(|_| random.i64(0..extent));
            let reach = 1 << random.u32(0..lattice.extent().x.ilog2());
            let cells = Cells { min, max: min.map(|v| (v + random.i64(1..=reach)).min(extent)) };
            let (range, cut) = values.range(&cells, &lattice);
            decided += usize::from(cut.is_none());
            for _ in 0..30 {
                let cell = [0, 1].map(|axis: usize| random.i64(cells.min[axis]..cells.max[axis]));
                let one = Cells { min: cell, max: cell.map(|v| v + 1) };
                let at = one.center(&lattice);
                let number = referee_depth(&layers, at).map(|d| formula.eval_with_depth(at.x, at.y, d));
                let expected = match number {
                    Some(number) if number > 0.0 => number,
                    _ => f64::INFINITY,
                };
                let (own, none) = values.range(&one, &lattice);
                let own = own.map_or(f32::INFINITY, |range| range.least);
                assert!(
                    none.is_none() && (f64::from(own) / expected - 1.0).abs() < 1e-6 || own == f32::INFINITY
                );
                assert_eq!(own == f32::INFINITY, expected == f64::INFINITY, "{own} {expected}");
                without += usize::from(number.is_none());
                match range {
                    Some(range) => assert!(range.least <= own && own <= range.greatest, "{own} in {range:?}"),
                    None => assert_eq!(own, f32::INFINITY),
                }
                if cut.is_none() {
                    assert_eq!(own, range.map_or(f32::INFINITY, |range| range.least));
                }
            }
        }
        assert!(without > 1000 && decided > 300, "{without} {decided}");
    }
}
