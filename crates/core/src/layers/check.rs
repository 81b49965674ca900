//! Finds places where a formula gives a number that no layer can have.

use glam::DVec2;

use super::engine::CompiledLayer;
use super::engine::cells::Cells;
use super::{Layer, SizeField, surface_changes};
use crate::geometry::Lattice;
use crate::mesh::Progress;
use crate::text::{Number, short_name};

/// A layer with a value that no mesh can meet.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "The layer “{}” gives {} at x = {}, y = {}: {rule}.", short_name(layer), Number(*value), Number(at.x), Number(at.y)
)]
pub struct InvalidLayer {
    /// The name of the layer.
    pub layer: String,
    /// A place, in world units.
    pub at: DVec2,
    /// The value there.
    pub value: f64,
    /// The rule for values of the layer.
    pub rule: &'static str,
}

/// Checks the formulas of a field, in slices.
///
/// Interval arithmetic proves most formulas valid with a few evaluations. Where it does not, the formula is
/// evaluated at the centres of about 1024 × 1024 squares, so that a single bad point can be missed; there the
/// layer asks for nothing.
#[derive(Clone, Debug, Default)]
pub struct LayerCheck {
    /// The cells that are left to check, each with the number of a layer among the visible ones.
    left: Vec<(usize, Cells)>,
}

/// Binary logarithm of the number of squares along the longer side, at most.
const FINEST_LOG: u32 = 10;

impl LayerCheck {
    /// Creates the work that checks all visible layers of a field.
    pub fn new(field: &SizeField) -> Self {
        let all = Cells::all(field.lattice().extent());
        let is_checked = |n: &usize| field.stack.layers()[*n].can_be_invalid();
        Self { left: (0..field.stack.layers().len()).rev().filter(is_checked).map(|n| (n, all)).collect() }
    }

    /// Returns the work that checks the visible layers of a field that differ from all visible ones of
    /// `checked`, which were found valid on the same lattice.
    pub fn of_changed(field: &SizeField, checked: &[Layer]) -> Self {
        let mut check = Self::new(field);
        let layers = &field.spec().layers;
        let visible: Vec<&Layer> = layers.iter().filter(|layer| layer.visible).collect();
        let has_same_depths =
            |n: usize| !visible[n].kind.uses_depth() || surface_changes(layers, checked).is_empty();
        let is_known = |n: usize| {
            checked.iter().any(|old| old.visible && old.kind == visible[n].kind) && has_same_depths(n)
        };
        check.left.retain(|(n, _)| !is_known(*n));
        check
    }

    /// Returns whether nothing is left.
    pub fn is_done(&self) -> bool {
        self.left.is_empty()
    }

    /// About `budget` evaluations.
    ///
    /// # Errors
    /// Fails with the first invalid value.
    pub fn advance(&mut self, field: &SizeField, budget: usize) -> Result<Progress, InvalidLayer> {
        for _ in 0..budget {
            let Some((number, cells)) = self.left.pop() else { return Ok(Progress::Done) };
            let layer = &field.stack.layers()[number];
            match checked(layer, &cells, field.lattice()) {
                Checked::Valid => {}
                Checked::Divided(parts) => self.left.extend(parts.map(|part| (number, part))),
                Checked::Invalid { at, value, rule } => {
                    let named = field.spec().layers.iter().find(|named| named.id == layer.id);
                    let layer = named.map_or_else(String::new, |named| named.name.clone());
                    return Err(InvalidLayer { layer, at, value, rule });
                }
            }
        }
        Ok(if self.is_done() { Progress::Done } else { Progress::More })
    }
}

enum Checked {
    Valid,
    Divided([Cells; 2]),
    Invalid { at: DVec2, value: f64, rule: &'static str },
}

fn checked(layer: &CompiledLayer, cells: &Cells, lattice: &Lattice) -> Checked {
    let extent = lattice.extent();
    let bits = extent.x.max(extent.y).next_power_of_two().ilog2().saturating_sub(FINEST_LOG);
    if layer.is_valid_in(cells, lattice) {
        return Checked::Valid;
    }
    let is_large = (0..2).any(|axis| cells.max[axis] - cells.min[axis] > 1 << bits);
    match cells.middle().filter(|_| is_large) {
        Some(cut) => Checked::Divided(cells.divided(cut)),
        None => {
            let at = cells.center(lattice);
            let invalid = layer.invalid_number_at(at);
            invalid.map_or(Checked::Valid, |(value, rule)| Checked::Invalid { at, value, rule })
        }
    }
}
