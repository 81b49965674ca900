//! Settings that are given as a whole, as by a recipe or a script.

use super::{Document, Setting, Settings, SettingsError};
use crate::field::Transfer;
use crate::mesh::{CoarseError, bisection_edge_length};

impl Settings {
    /// Returns the settings with limits that a person can read where there are none: the diameters of the
    /// smallest and the largest triangles of the lattice. The mesh is the same.
    ///
    /// # Errors
    /// Fails when the coarse grid is impossible or too fine.
    pub fn with_limits_of_the_grid(mut self) -> Result<Self, CoarseError> {
        let lattice = self.lattice()?;
        let [smallest, largest] =
            [lattice.deepest_level(), 0].map(|level| bisection_edge_length(lattice.spacing(), level));
        let largest = self.domain.longest_on_earth(largest);
        let transfer = &mut self.transfer;
        if transfer.h_max == f64::MAX {
            transfer.h_max = largest.max(transfer.h_risk);
        }
        if transfer.h_min == f64::MIN_POSITIVE {
            transfer.h_min = smallest.min(transfer.h_max);
            transfer.h_risk = transfer.h_risk.max(transfer.h_min);
        }
        Ok(self)
    }
}

impl Document {
    /// Changes the numbers of the settings, each as a gesture of its own, to the wanted ones. The domain, the
    /// layers and what is named stay.
    ///
    /// # Errors
    /// Fails when the wanted settings are out of range: then nothing changes. Where a change on the way there
    /// is refused, the changes before it stay.
    pub fn change_numbers(&mut self, wanted: Settings) -> Result<(), SettingsError> {
        // Without `..`: a new setting does not compile until somebody has decided whether it is changed here.
        let Settings {
            name: _,
            unit: _,
            background: _,
            domain: _,
            boundary_marks: _,
            lines: _,
            pins: _,
            paths: _,
            layers: _,
            boundary,
            cleaning,
            spacing,
            transfer: Transfer { h_min, h_risk, h_max, shape },
            gradation,
            rule,
            max_triangles,
            max_memory,
            max_level,
        } = wanted.checked()?;
        let changes = [
            Setting::Spacing(spacing),
            Setting::LargestDiameter(h_max),
            Setting::SmallestDiameter(h_min),
            Setting::DiameterAtRiskOne(h_risk),
            Setting::TransferShape(shape),
            Setting::Gradation(gradation),
            Setting::RefinementRule(rule),
            Setting::Boundary(boundary),
            Setting::Cleaning(cleaning),
            Setting::MaxTriangles(max_triangles),
            Setting::MaxMemory(max_memory),
            Setting::MaxLevel(max_level),
        ];
        changes.into_iter().try_for_each(|change| {
            self.set(change)?;
            self.end_gesture();
            Ok(())
        })
    }
}
