use serde::{Deserialize, Serialize};

use super::super::checks::number_where;
use super::super::{LayerData, LayerOrigin, SavedNorm, Stored, compiled, in_direction};
use super::GridKeys;
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use crate::io::layers::key_group::group_of_groups;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{LayerKind, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};
use meshbrush_core::raster::RasterValues;

/// The keys of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SurfaceKeys {
    /// Its raster, unless a formula gives it.
    #[serde(flatten)]
    pub grid: GridKeys,
    /// Its formula, and what is asked for.
    #[serde(flatten)]
    pub goal: GoalKeys,
}

/// The formula of a surface, and how near the mesh is to be.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalKeys {
    /// A formula in x and y, in place of a raster.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// The largest error, in the unit of the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The largest number of triangles, in place of `within`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<usize>,
    /// Which error is meant; the largest difference where it is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub norm: Option<SavedNorm>,
}

group_of_groups!(SurfaceKeys { grid: GridKeys, goal: GoalKeys });

impl SurfaceKeys {
    pub(super) fn of(Surface { source, goal, norm }: &Surface) -> Self {
        let formula = match source {
            SurfaceSource::Raster(_) => None,
            SurfaceSource::Formula(formula) => Some(formula.source().to_owned()),
        };
        let (within, at_most) = match *goal {
            SurfaceGoal::Within(error) => (Some(error), None),
            // TOML has no larger numbers, and no mesh as many triangles.
            SurfaceGoal::AtMost(count) => (None, Some(count.min(i64::MAX as usize))),
        };
        let norm = (*norm != SurfaceNorm::default()).then(|| (*norm).into());
        Self { grid: GridKeys::default(), goal: GoalKeys { formula, within, at_most, norm } }
    }
}

impl GoalKeys {
    fn checked(&self) -> Result<SurfaceGoal, KeyFault> {
        match (self.within, self.at_most) {
            (Some(error), None) => {
                number_where(error, error > 0.0, "an error must be positive and finite")
                    .map_err(|fault| fault.within("within"))?;
                Ok(SurfaceGoal::Within(error))
            }
            (None, Some(count)) => {
                number_where(count as f64, count > 0, "a mesh has one triangle at least")
                    .map_err(|fault| fault.within("at_most"))?;
                Ok(SurfaceGoal::AtMost(count))
            }
            (Some(_), Some(_)) => {
                Err(KeyFault::key("at_most", "a surface has `within` or `at_most`, not both."))
            }
            (None, None) => Err(SurfaceKeys::missing(
                "needs `within`, the largest error, or `at_most`, the largest number of triangles",
            )),
        }
    }
}

impl KindKeys for SurfaceKeys {
    fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.goal.checked()?;
        match (&self.goal.formula, &self.grid.file) {
            (Some(_), Some(_)) => {
                Err(KeyFault::key("formula", "the surface is in `file` or in `formula`, not in both."))
            }
            (Some(text), None) => compiled("formula", text, Formula::parse).map(|_| ()),
            (None, Some(_)) => self.grid.check(Self::missing, stored),
            (None, None) => Err(SurfaceKeys::missing("needs `file`, a raster, or `formula`")),
        }
    }

    /// A formula needs no raster.
    fn grid(&self) -> Option<&GridKeys> {
        self.goal.formula.is_none().then_some(&self.grid)
    }

    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        Some(&mut self.grid)
    }
}

impl LoadKind for SurfaceKeys {
    const WORD: &str = "surface";
    const NAME: &str = "Surface";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let (goal, norm) = (self.goal.checked()?, self.goal.norm.map(SurfaceNorm::from).unwrap_or_default());
        if let Some(text) = &self.goal.formula {
            let source = SurfaceSource::Formula(compiled("formula", text, Formula::parse)?);
            return Ok(LayerKind::Surface(Surface { source, goal, norm }));
        }
        let (source, facts) = origin.raster(&self.grid, RasterValues::Any, data)?;
        let surface = Surface { source: SurfaceSource::Raster(source), goal, norm };
        Ok(in_direction(LayerKind::Surface(surface), facts.positive))
    }
}
