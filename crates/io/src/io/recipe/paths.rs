//! Paths, keep-out regions and pins of a recipe. They do not change the mesh.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::layers::{FindFile, KeyFault, MaskSpec, SavedPolygon, Step, each, point, points, rings};
use super::super::{Meter, geojson};
use super::saved::{SavedKeepOut, SavedPaths, SavedPins};
use super::{DescriptionError, SavedRecipe};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::Weights;
use meshbrush_mesh::text::excerpt;

/// What a keep-out region is called that has neither a name nor a file.
const USUAL_NAME: &str = "Keep-out region";

/// Paths as a recipe describes them: every value is checked, and no file was read.
#[derive(Clone, Debug, Default)]
pub struct PathsSpec {
    /// The places of each path, in world units: the start, the places in between in order, and the goal.
    pub routes: Vec<Vec<DVec2>>,
    /// What paths cost.
    pub cost: PathCost,
    /// Where paths do not go.
    pub keep_out: Vec<KeepOutSpec>,
}

/// A region that paths stay out of.
#[derive(Clone, Debug)]
pub struct KeepOutSpec {
    /// What a person calls it.
    pub name: String,
    /// What it covers.
    pub region: MaskSpec,
}

impl SavedRecipe {
    /// Checks the values of paths and keep-out regions.
    pub(super) fn paths_spec(&self, find: &FindFile) -> Result<PathsSpec, KeyFault> {
        let in_paths = |fault: KeyFault| fault.within(Step::Key("paths"));
        let route = |places: &Vec<[f64; 2]>| points(places, 2, "a path");
        let keep_out = self.keep_out.iter().enumerate().map(|(index, region)| {
            let checked = region.checked(find);
            checked.map_err(|fault| fault.within(Step::Index(index)).within(Step::Key("keep_out")))
        });
        Ok(PathsSpec {
            routes: each("routes", &self.paths.routes, route).map_err(in_paths)?,
            cost: self.paths.checked_cost().map_err(in_paths)?,
            keep_out: keep_out.collect::<Result<_, _>>()?,
        })
    }
}

impl SavedPaths {
    /// The paths of a document, without its keep-out regions.
    pub(super) fn of(plan: &PathPlan) -> Self {
        let route = |route: &Vec<DVec2>| route.iter().map(DVec2::to_array).collect();
        let usual = Self { routes: plan.routes.iter().map(route).collect(), ..Self::default() };
        match &plan.cost {
            cost if *cost == PathCost::default() => usual,
            PathCost::Weighted(Weights { length, risk }) => {
                Self { length_weight: Some(*length), risk_weight: Some(*risk), ..usual }
            }
            PathCost::Formula(formula) => Self { cost: Some(formula.source().to_owned()), ..usual },
        }
    }

    fn checked_cost(&self) -> Result<PathCost, KeyFault> {
        let weight = match (self.length_weight, self.risk_weight) {
            (None, None) => None,
            (Some(_), None) => Some("length_weight"),
            _ => Some("risk_weight"),
        };
        match (&self.cost, weight) {
            (Some(_), Some(key)) => {
                Err(KeyFault::key(key, "what paths cost is given by `cost` or by weights, not by both."))
            }
            (Some(text), None) => {
                let formula = CostFormula::parse(text).map_err(|mistake| KeyFault {
                    pointer: Some(mistake.pointer().to_owned()),
                    ..KeyFault::value("cost", mistake.to_string())
                });
                Ok(PathCost::Formula(formula?))
            }
            (None, None) => Ok(PathCost::default()),
            (None, Some(key)) => {
                let usual = Weights::default();
                let cost = PathCost::Weighted(Weights {
                    length: self.length_weight.unwrap_or(usual.length),
                    risk: self.risk_weight.unwrap_or(usual.risk),
                });
                let plan = PathPlan { cost, ..PathPlan::default() };
                plan.check().map_err(|error| KeyFault::value(key, error.to_string()))?;
                Ok(plan.cost)
            }
        }
    }
}

impl SavedKeepOut {
    fn checked(&self, find: &FindFile) -> Result<KeepOutSpec, KeyFault> {
        let named = |usual: String| self.name.clone().unwrap_or(usual);
        match (&self.polygons, &self.file) {
            (Some(_), Some(_)) => {
                Err(KeyFault::key("file", "a keep-out region has `polygons` or `file`, not both."))
            }
            (None, None) => Err(KeyFault::entry("polygons", "a keep-out region needs `polygons` or `file`.")),
            (None, Some(name)) => {
                let file = find(name).map_err(|sentence| KeyFault::entry("file", sentence))?;
                let usual = Path::new(name).file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok(KeepOutSpec { name: named(usual), region: MaskSpec::File(file) })
            }
            (Some(polygons), None) => {
                if polygons.is_empty() {
                    let sentence = "a keep-out region needs a polygon at least; leave the region out.";
                    return Err(KeyFault::value("polygons", sentence));
                }
                let polygons = each("polygons", polygons, |polygon: &SavedPolygon| rings(polygon))?;
                Ok(KeepOutSpec { name: named(USUAL_NAME.into()), region: MaskSpec::Polygons(polygons) })
            }
        }
    }
}

impl SavedPins {
    /// The points, in world units.
    pub(super) fn checked(&self) -> Result<Vec<DVec2>, KeyFault> {
        each("at", &self.at, |at| point(*at))
    }
}

impl PathsSpec {
    /// The files that it names.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.keep_out.iter().filter_map(|region| match &region.region {
            MaskSpec::File(file) => Some(file),
            MaskSpec::Polygons(_) => None,
        })
    }

    /// The paths of a document. The meter counts the bytes of each file.
    ///
    /// # Errors
    /// When a file cannot be read, or the polygons of a region cannot be used.
    pub fn load(&self, meter: &Meter) -> Result<PathPlan, DescriptionError> {
        let load = |KeepOutSpec { name, region }: &KeepOutSpec| {
            let mask = match region {
                MaskSpec::File(file) => {
                    Mask::new(&geojson::without_names(geojson::read_named_metered(file, meter)?))
                }
                MaskSpec::Polygons(polygons) => Mask::new(polygons),
            };
            let unsuited = |problem| {
                let name = excerpt(40, name);
                DescriptionError::Unsuited(format!("The keep-out region “{name}” cannot be used. {problem}"))
            };
            Ok(KeepOut { name: name.clone(), mask: mask.map_err(unsuited)? })
        };
        let keep_out = self.keep_out.iter().map(load).collect::<Result<_, DescriptionError>>()?;
        Ok(PathPlan { routes: self.routes.clone(), cost: self.cost.clone(), keep_out })
    }
}
