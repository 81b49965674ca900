//! One layer on a lattice.

use std::sync::Arc;

use glam::DVec2;

use crate::earth::EdgeLengths;
use crate::field::Transfer;
use crate::geometry::{Lattice, Octagon};
use crate::layers::{Combine, DepthSizes, LayerId, Mask, PaintLayers, Quantity, Shapes};
use crate::raster::{ValueRange, ValueRanges};

use super::analytic::{Analytic, Function};
use super::asked::Ternary;
use super::cells::{Cells, Cut};
use super::cover::{Cover, share_in_mask};
use super::patch::TouchedCells;
use super::pixels::range_touching;
use super::reading::{Diameters, RangeAnswer, Reading};
use super::search::{RasterSearch, any_cell};
use super::steepness::Slopes;
use super::values::{Values, WithGaps};

/// A visible layer, prepared for questions on one lattice.
#[derive(Clone, Debug)]
pub struct CompiledLayer {
    pub id: LayerId,
    pub combine: Combine,
    mask: Option<Mask>,
    /// The depths above it that hide its own.
    covers: Vec<Cover>,
    reading: Reading,
    pub(super) values: Values,
    /// The values with what gradation carries, where there is a closed form for rectangles, too.
    graded: Option<Analytic>,
    /// How gradation carries the values to points, where there is a closed form for these.
    carried: Option<Carried>,
}

/// How gradation carries the values of a function to points: with a slope, those below h_min as h_min.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    pub slope: f64,
    pub h_min: f64,
}

/// What the layers of a field are compiled for.
#[derive(Clone, Copy)]
pub struct CompiledPlane<'a> {
    /// The files of depths, from the top to the bottom, with the meaning of their values, if a layer asks for
    /// the depth.
    pub depths: &'a [(Cover, DepthSizes)],
    pub transfer: &'a Transfer,
    pub lattice: &'a Lattice,
    /// Without one, no point is near to it.
    pub outline: Option<&'a Shapes>,
    pub edge_lengths: &'a EdgeLengths,
}

impl CompiledPlane<'_> {
    /// Returns how values of a quantity are read. Risks up to `nothing` ask for nothing.
    pub fn reading(&self, quantity: Quantity, nothing: f32) -> Reading {
        match quantity {
            Quantity::Risk => Reading::risk(self.transfer, self.lengths(), nothing),
            Quantity::Diameter | Quantity::Error => self.diameters(),
        }
    }

    /// Returns how target diameters are read.
    pub fn diameters(&self) -> Reading {
        Reading::diameter(self.lengths())
    }

    /// Returns the diameters that targets are compared with.
    pub fn lengths(&self) -> &Arc<[f64]> {
        self.edge_lengths.table()
    }
}

impl CompiledLayer {
    /// Returns a layer that counts everywhere, combined with those below in some way.
    pub fn new((id, combine): (LayerId, Combine), (reading, values): (Reading, Values)) -> Self {
        Self { id, combine, mask: None, covers: Vec::new(), reading, values, graded: None, carried: None }
    }

    /// Lets the layer count in the area of a mask only, and nowhere below some depths.
    pub fn within(self, mask: Option<Mask>, covers: Vec<Cover>) -> Self {
        Self { mask, covers, ..self }
    }

    /// Finds in closed form what gradation carries, where that is possible: at least h_min, up to `most`. The
    /// finest of all layers must count.
    pub fn grade(&mut self, gradation: f64, h_min: f64, most: f64, lattice: &Lattice) {
        let (Values::Analytic(analytic), false) = (&self.values, self.is_masked()) else { return };
        let carried = Carried { slope: gradation, h_min };
        self.carried = analytic.function.carries_from_within(&lattice.bounds()).then_some(carried);
        let function = analytic.function.graded(gradation, h_min, most, &lattice.bounds());
        self.graded = function.map(|function| Analytic::new(function, analytic.quantity));
    }

    /// Returns this layer without models of its functions: searches use bounds only.
    #[cfg(test)]
    pub fn without_models(mut self) -> Self {
        if let Values::Analytic(analytic) = self.values {
            self.values = Values::Analytic(analytic.without_models());
        }
        self
    }

    /// Returns whether the layer can be asked alone: where it asks, h̄ is no greater.
    pub fn is_plain(&self) -> bool {
        self.combine == Combine::Finest
    }

    /// Returns the function of the point that the layer is given by, if it is.
    pub fn analytic(&self) -> Option<&Analytic> {
        match &self.values {
            Values::Constant(analytic) | Values::Analytic(analytic) => Some(analytic),
            Values::Nothing | Values::Paint(_) | Values::Raster { .. } | Values::Depth(_) => None,
        }
    }

    /// Returns whether a cell that touches the triangle asks for less than a limit. `around` are the cells
    /// around the triangle.
    #[inline]
    pub fn any_below(
        &self,
        paint: &PaintLayers,
        triangle: &Octagon,
        around: Cells,
        limit: usize,
        lattice: &Lattice,
    ) -> bool {
        if self.is_masked() {
            return self.any_below_in_mask(paint, triangle, around, limit, lattice);
        }
        match &self.values {
            Values::Constant(constant) => {
                let value = ValueRange::one(constant.at(lattice.bounds().min));
                self.reading.answer(value, limit).asks == Ternary::Always
            }
            Values::Nothing => false,
            Values::Paint(grid) => paint.get(self.id).is_some_and(|raster| {
                let grid = grid.on_lattice(raster.grid(), lattice);
                let search = RasterSearch { raster, grid: &grid, question: self.reading.question(limit) };
                search.any(triangle, &around)
            }),
            Values::Raster { raster, gap, grid } => {
                let raster = &WithGaps { raster, gap: *gap };
                RasterSearch { raster, grid, question: self.reading.question(limit) }.any(triangle, &around)
            }
            Values::Analytic(_) | Values::Depth(_) => {
                self.any_below_in_mask(paint, triangle, around, limit, lattice)
            }
        }
    }

    /// Returns whether the layer is given by pixels whose values ask for more or less in their order, and
    /// counts everywhere, or has no values.
    pub fn has_pixels_only(&self) -> bool {
        let has_pixels = matches!(self.values, Values::Paint(_) | Values::Raster { .. });
        let is_monotone = matches!(self.reading, Reading::Risk { .. } | Reading::Diameter { .. });
        matches!(self.values, Values::Nothing) || (has_pixels && is_monotone && !self.is_masked())
    }

    /// Returns the diameters that pixels which touch a triangle ask for, and whether one of them is below a
    /// limit, of a layer that [`Self::has_pixels_only`]. `None` where they are too many, or not quick to
    /// read.
    pub fn asked_by_pixels(
        &self,
        paint: &PaintLayers,
        (triangle, around): (&Octagon, &Cells),
        limit: usize,
        lattice: &Lattice,
    ) -> Option<(Diameters, bool)> {
        let nothing = Some((Diameters::NOTHING, false));
        let range = match &self.values {
            Values::Paint(grid) => {
                let Some(raster) = paint.get(self.id) else { return nothing };
                range_touching(raster, &grid.on_lattice(raster.grid(), lattice), triangle, around)?
            }
            Values::Raster { raster, gap, grid } => {
                range_touching(&WithGaps { raster, gap: *gap }, grid, triangle, around)?
            }
            Values::Nothing | Values::Constant(_) | Values::Analytic(_) | Values::Depth(_) => return nothing,
        };
        Some((self.reading.diameters(range), self.reading.question(limit).asks(range) != Ternary::Never))
    }

    /// [`Self::any_below`] by rectangles of cells.
    fn any_below_in_mask(
        &self,
        paint: &PaintLayers,
        triangle: &Octagon,
        around: Cells,
        limit: usize,
        lattice: &Lattice,
    ) -> bool {
        let mut ask = |cells: &Cells| {
            let (answer, cut) = self.answer(paint, &TouchedCells::touching(*cells, triangle), limit, lattice);
            (answer.asks, cut)
        };
        any_cell(triangle, around, &mut ask)
    }

    /// Returns whether the mask certainly covers none of some cells.
    pub fn is_masked_out(&self, cells: &Cells, lattice: &Lattice) -> bool {
        self.is_masked() && self.coverage(cells, lattice).0 == Ternary::Never
    }

    /// Returns whether the layer may count in a part of the plane only.
    fn is_masked(&self) -> bool {
        self.mask.is_some() || !self.covers.is_empty()
    }

    /// Returns in how many of some cells the layer counts, and where to divide them to know more: those that
    /// the mask covers, and no depths above it hide.
    fn coverage(&self, cells: &Cells, lattice: &Lattice) -> (Ternary, Option<Cut>) {
        let mut coverage = share_in_mask(self.mask.as_ref(), cells, lattice);
        for cover in &self.covers {
            if coverage.0 == Ternary::Never {
                break;
            }
            let (hidden, cut) = cover.share_of(cells, lattice);
            coverage = (coverage.0.and(hidden.not()), coverage.1.or(cut));
        }
        coverage
    }

    /// Returns the layer's answer in some cells, and the cut that divides them for a closer answer.
    pub fn answer(
        &self,
        paint: &PaintLayers,
        patch: &TouchedCells,
        limit: usize,
        lattice: &Lattice,
    ) -> (RangeAnswer, Option<Cut>) {
        let (coverage, mask_cut) = self.coverage(&patch.cells, lattice);
        if coverage == Ternary::Never {
            return (RangeAnswer::NOTHING, None);
        }
        let (range, cut) = self.range(paint, &patch.cells, lattice);
        let Some(range) = range else { return (RangeAnswer::NOTHING, None) };
        let mut answer = self.reading.answer(range, limit);
        if answer.is_undecided()
            && let Values::Analytic(analytic) = &self.values
            && let Some(range) = self.graded.as_ref().unwrap_or(analytic).range_in(patch, lattice)
        {
            answer = self.reading.answer(range, limit);
        }
        if coverage == Ternary::Maybe {
            answer = RangeAnswer { asks: answer.asks.masked(), present: answer.present.masked() };
        }
        (answer, mask_cut.or(cut).filter(|_| answer.is_undecided()))
    }

    /// Returns the diameters that the layer asks for in some cells, and where to divide them to know more.
    ///
    /// A line between pixels comes before an edge of the mask: there are few, and on both sides the diameters
    /// of single pixels are known. A curve of the values can be lower between two values than at both.
    pub fn diameters(
        &self,
        paint: &PaintLayers,
        cells: &Cells,
        lattice: &Lattice,
    ) -> (Diameters, Option<Cut>) {
        let (coverage, mask_cut) = self.coverage(cells, lattice);
        if coverage == Ternary::Never {
            return (Diameters::NOTHING, None);
        }
        let (range, cut) = self.range(paint, cells, lattice);
        let mut diameters = range.map_or(Diameters::NOTHING, |range| self.reading.diameters(range));
        if coverage == Ternary::Maybe {
            diameters.present = diameters.present.masked();
            diameters.greatest = f64::INFINITY;
        }
        let cut = if self.has_pixels() { cut.or(mask_cut) } else { mask_cut.or(cut) };
        (diameters, cut)
    }

    /// Returns whether the values are those of pixels.
    pub fn has_pixels(&self) -> bool {
        matches!(self.values, Values::Paint(_) | Values::Raster { .. } | Values::Depth(_))
    }

    /// Returns the diameters that the values of a range ask for.
    pub fn diameters_of(&self, range: ValueRange) -> Diameters {
        self.reading.diameters(range)
    }

    /// Returns the range of the values in some cells, `None` where the layer has none, and where to divide
    /// the cells to know more.
    fn range(
        &self,
        paint: &PaintLayers,
        cells: &Cells,
        lattice: &Lattice,
    ) -> (Option<ValueRange>, Option<Cut>) {
        let (range, cut) = match &self.values {
            Values::Constant(constant) => (ValueRange::one(constant.at(lattice.bounds().min)), None),
            Values::Nothing => return (None, None),
            Values::Paint(grid) => {
                let Some(raster) = paint.get(self.id) else { return (None, None) };
                grid.on_lattice(raster.grid(), lattice).range(raster, cells)
            }
            Values::Raster { raster, gap, grid } => grid.range(&WithGaps { raster, gap: *gap }, cells),
            Values::Analytic(analytic) => self.graded.as_ref().unwrap_or(analytic).range(cells, lattice),
            Values::Depth(formula) => return formula.range(cells, lattice),
        };
        (Some(range), cut)
    }

    /// Returns the binary logarithm of the side of the pixels in lattice steps, rounded down, if there are
    /// any.
    pub fn pixel_bits(&self, paint: &PaintLayers, lattice: &Lattice) -> Option<u32> {
        let log_steps = match &self.values {
            Values::Paint(grid) => grid.on_lattice(paint.get(self.id)?.grid(), lattice).log_steps(),
            Values::Raster { grid, .. } => grid.log_steps(),
            Values::Depth(formula) => formula.log_steps()?,
            Values::Nothing | Values::Constant(_) | Values::Analytic(_) => return None,
        };
        Some(log_steps.clamp(0, 30) as u32)
    }

    /// Returns whether the diameters of some cells may jump because they are those of pixels. `diameters` are
    /// those of the cells.
    pub fn jumps(&self, diameters: &Diameters) -> bool {
        self.has_pixels() && diameters.least < diameters.greatest
    }

    /// Returns bounds of the gradient of the diameters of some cells, where the layer asks for one; unknown
    /// where they may jump. `diameters` are those of the cells.
    pub fn slopes(&self, cells: &Cells, diameters: &Diameters, lattice: &Lattice) -> Slopes {
        if diameters.least == diameters.greatest {
            return Slopes::FLAT;
        }
        match &self.values {
            Values::Nothing | Values::Constant(_) => Slopes::FLAT,
            Values::Paint(_) | Values::Raster { .. } | Values::Depth(_) => Slopes::UNKNOWN,
            Values::Analytic(analytic) => {
                let analytic = self.graded.as_ref().unwrap_or(analytic);
                let of_values = analytic.function.slopes(&cells.world_rect(lattice));
                let (ValueRange { least, greatest }, _) = analytic.range(cells, lattice);
                let slopes = of_values.times(self.reading.slopes(least.into(), greatest.into()));
                // Risks beyond 0 and 1 count as these.
                let is_cut = analytic.quantity == Quantity::Risk && (least <= 0.0 || greatest >= 1.0);
                if is_cut { slopes.or(Slopes::FLAT) } else { slopes }
            }
        }
    }

    /// Returns whether the diameters rise to `h_max` without a jump where the layer stops asking in some
    /// cells.
    pub fn fades_to(&self, h_max: f64, cells: &Cells, lattice: &Lattice) -> bool {
        if self.coverage(cells, lattice).0 != Ternary::Always {
            return false;
        }
        match (&self.values, &self.graded) {
            (Values::Analytic(Analytic { function: Function::Threats(_), .. }), _) => true,
            (_, Some(Analytic { function: Function::Distance { profile, .. }, .. })) => {
                profile.graded.is_some_and(|graded| graded.most >= h_max)
            }
            _ => false,
        }
    }

    /// Returns whether [`Self::carried_to`] knows what gradation carries to any point.
    pub fn has_closed_form(&self) -> bool {
        self.carried.is_some()
    }

    /// Returns the diameter that gradation carries to a point in world units, and the point that it comes
    /// from, if a closed form is known and the diameter is below a limit.
    pub fn carried_to(&self, point: DVec2, limit: f64) -> Option<(f64, DVec2)> {
        let Values::Analytic(own) = &self.values else { return None };
        let function = &self.graded.as_ref().unwrap_or(own).function;
        function.carried_to(point, self.carried?, limit).filter(|(diameter, _)| *diameter < limit)
    }

    /// Returns the diameter that the layer asks for at a point in world units: infinite where it asks for
    /// nothing, and NaN, zero or less where the value is not valid.
    pub fn diameter_at(&self, paint: &PaintLayers, point: DVec2) -> f64 {
        let is_outside = self.mask.as_ref().is_some_and(|mask| !mask.contains(point));
        if is_outside || self.covers.iter().any(|cover| cover.contains(point)) {
            return f64::INFINITY;
        }
        match &self.values {
            Values::Constant(analytic) | Values::Analytic(analytic) => {
                self.reading.diameter_of(analytic.raw(point))
            }
            Values::Nothing => f64::INFINITY,
            Values::Depth(formula) => {
                formula.raw(point).map_or(f64::INFINITY, |value| self.reading.diameter_of(value))
            }
            Values::Paint(_) => paint
                .get(self.id)
                .map_or(f64::INFINITY, |raster| self.reading.diameter_of(raster.sample(point).into())),
            Values::Raster { raster, gap, .. } => {
                self.reading.diameter_of(raster.sample(point).unwrap_or(*gap).into())
            }
        }
    }
}
