//! The keys of distances and of corridors, which are distances from a strip along lines.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::checks::number_where;
use super::super::{LayerData, LayerOrigin, SavedDistanceTo, SavedShape, Stored, checked_shapes};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use crate::io::layers::key_group::group_of_groups;
use crate::io::lengths::SavedLength;
use crate::io::settings::SavedBoundaryType;
use meshbrush_core::domain::PieceChoice;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, LayerKind, ShapeList, Shapes};

/// The rule for keys that say what a distance is measured to.
const ONE_TARGET: &str = "a distance has one of `to`, `file`, `shapes`, and `pieces` with `types`.";

/// The keys of a distance.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DistanceKeys {
    /// What it is measured to.
    #[serde(flatten)]
    pub target: TargetKeys,
    /// What it asks for.
    #[serde(flatten)]
    pub growth: GrowthKeys,
}

/// The keys of a corridor.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CorridorKeys {
    /// The lines along which it goes.
    #[serde(flatten)]
    pub along: ShapeKeys,
    /// Its width.
    #[serde(flatten)]
    pub strip: StripKeys,
    /// What it asks for, by the distance from its edge.
    #[serde(flatten)]
    pub growth: GrowthKeys,
}

/// What a distance is measured to: one of the keys, or both of `pieces` and `types`, say it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TargetKeys {
    /// A part of the boundary of the domain.
    #[serde(flatten)]
    pub boundary: BoundaryKeys,
    /// Shapes.
    #[serde(flatten)]
    pub shapes: ShapeKeys,
}

/// A part of the boundary of the domain.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundaryKeys {
    /// All of it, or what is no open part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<SavedDistanceTo>,
    /// The names of pieces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pieces: Option<Vec<String>>,
    /// The types of pieces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub types: Option<Vec<SavedBoundaryType>>,
}

/// Shapes in a file or in place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeKeys {
    /// The file of the shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The shapes, as a list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapes: Option<Vec<SavedShape>>,
}

/// The width of a corridor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StripKeys {
    /// The width, in world units. Within it the distance is 0.
    pub width: SavedLength,
}

/// How a target diameter grows with a distance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrowthKeys {
    /// The target diameter at distance 0, in world units.
    pub at_zero: SavedLength,
    /// Growth of the target diameter by unit of distance, dimensionless.
    pub slope: f64,
    /// The distance beyond which nothing is asked for, in world units; without it there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<SavedLength>,
}

group_of_groups!(TargetKeys { boundary: BoundaryKeys, shapes: ShapeKeys });
group_of_groups!(DistanceKeys { target: TargetKeys, growth: GrowthKeys });
group_of_groups!(CorridorKeys { along: ShapeKeys, strip: StripKeys, growth: GrowthKeys });

/// What a distance is measured to, checked.
enum CheckedTarget {
    Boundary(DistanceTo),
    Shapes(PlacedShapes),
}

/// Where shapes are.
enum PlacedShapes {
    InFile,
    InPlace(ShapeList),
}

impl PlacedShapes {
    fn load<D: LayerData>(self, origin: &LayerOrigin, data: &mut D) -> Result<Shapes, D::Error> {
        match self {
            Self::InFile => data.shapes(origin),
            Self::InPlace(list) => Ok(origin.indexed_shapes(list)?),
        }
    }
}

impl DistanceKeys {
    /// Returns the keys without the shapes.
    pub(super) fn of(distance: &DistanceLayer) -> Self {
        let target = TargetKeys { boundary: BoundaryKeys::of(&distance.to), ..TargetKeys::default() };
        Self { target, growth: GrowthKeys::of(distance) }
    }
}

impl CorridorKeys {
    /// Returns the keys of a distance from a strip, without the lines along which it goes.
    pub(super) fn of(distance: &DistanceLayer, width: f64) -> Self {
        let strip = StripKeys { width: width.into() };
        Self { along: ShapeKeys::default(), strip, growth: GrowthKeys::of(distance) }
    }
}

impl BoundaryKeys {
    fn of(to: &DistanceTo) -> Self {
        let chosen = if let DistanceTo::Pieces(chosen) = to { Some(chosen) } else { None };
        let pieces = chosen.map(|chosen| chosen.names.clone()).filter(|names| !names.is_empty());
        let types = chosen.map(|chosen| chosen.types.iter().copied().map(Into::into).collect());
        // One of both says that it is pieces, also where none is chosen.
        let types = types.filter(|types: &Vec<_>| !types.is_empty() || pieces.is_none());
        Self { to: SavedDistanceTo::of(to), pieces, types }
    }

    /// Returns the pieces of the boundary that are chosen, if a key chooses some.
    fn chosen(&self) -> Option<PieceChoice> {
        let types = self.types.iter().flatten().copied().map(Into::into).collect();
        let is_given = self.pieces.is_some() || self.types.is_some();
        is_given.then(|| PieceChoice { names: self.pieces.clone().unwrap_or_default(), types })
    }
}

impl TargetKeys {
    /// Returns a part of the boundary, or where shapes are. A project has the name of their file beside them.
    fn checked(&self, stored: Stored) -> Result<CheckedTarget, KeyFault> {
        let Self { boundary, shapes: ShapeKeys { file, shapes } } = self;
        let chosen = boundary.chosen();
        if chosen.is_some() && (boundary.to.is_some() || file.is_some() || shapes.is_some()) {
            let key = if boundary.pieces.is_some() { "pieces" } else { "types" };
            return Err(KeyFault::key(key, ONE_TARGET));
        }
        match (boundary.to, file, shapes) {
            (None, None, None) => chosen.map(DistanceTo::Pieces).map(CheckedTarget::Boundary).ok_or_else(|| {
                DistanceKeys::missing(
                    "needs to = \"outline\" or to = \"coasts\", `pieces` or `types` of the boundary, `file`, a .geojson, \
                     .shp or .gpkg, or `shapes`",
                )
            }),
            (Some(to), None, None) => Ok(CheckedTarget::Boundary(to.into())),
            (None, Some(_), None) => Ok(CheckedTarget::Shapes(PlacedShapes::InFile)),
            (None, file, Some(shapes)) if file.is_none() || stored == Stored::InProject => {
                checked_shapes(shapes).map(PlacedShapes::InPlace).map(CheckedTarget::Shapes)
            }
            (Some(_), ..) => Err(KeyFault::key("to", ONE_TARGET)),
            (None, ..) => Err(KeyFault::key("shapes", ONE_TARGET)),
        }
    }
}

impl ShapeKeys {
    fn along(&self) -> Result<PlacedShapes, KeyFault> {
        match (&self.file, &self.shapes) {
            (Some(_), None) => Ok(PlacedShapes::InFile),
            (None, Some(shapes)) => checked_shapes(shapes).map(PlacedShapes::InPlace),
            (None, None) => {
                Err(CorridorKeys::missing("needs `file`, a .geojson, .shp or .gpkg, or `shapes`"))
            }
            (Some(_), Some(_)) => Err(KeyFault::key("shapes", "a corridor has one of `file` and `shapes`.")),
        }
    }
}

impl GrowthKeys {
    fn of(DistanceLayer { at_zero, slope, range, .. }: &DistanceLayer) -> Self {
        let range = range.is_finite().then_some((*range).into());
        Self { at_zero: (*at_zero).into(), slope: *slope, range }
    }

    fn check(&self) -> Result<(), KeyFault> {
        self.at_zero.checked("at_zero")?;
        let rule = "the growth by unit of distance must be 0 or more, and finite";
        number_where(self.slope, self.slope >= 0.0, rule).map_err(|fault| fault.within("slope"))?;
        self.range.map_or(Ok(()), |range| range.checked("range").map(|_| ()))
    }

    /// Returns a layer that asks for this by the distance to `to`.
    fn layer_of(&self, to: DistanceTo) -> LayerKind {
        let Self { at_zero, slope, range } = *self;
        let range = range.map_or(f64::INFINITY, |range| *range);
        LayerKind::Distance(DistanceLayer { to, at_zero: *at_zero, slope, range })
    }
}

impl KindKeys for DistanceKeys {
    fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.target.checked(stored)?;
        self.growth.check()
    }

    fn file(&self) -> Option<&Path> {
        self.target.shapes.file.as_deref()
    }

    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        Some(&mut self.target.shapes.file)
    }
}

impl LoadKind for DistanceKeys {
    const WORD: &str = "distance";
    const NAME: &str = "Distance";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let to = match self.target.checked(D::STORED)? {
            CheckedTarget::Boundary(to) => to,
            CheckedTarget::Shapes(shapes) => {
                DistanceTo::Shapes { name: origin.file_name(), shapes: shapes.load(origin, data)? }
            }
        };
        Ok(self.growth.layer_of(to))
    }
}

impl KindKeys for CorridorKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        self.along.along()?;
        self.strip.width.checked("width")?;
        self.growth.check()
    }

    fn file(&self) -> Option<&Path> {
        self.along.file.as_deref()
    }

    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        Some(&mut self.along.file)
    }
}

impl LoadKind for CorridorKeys {
    const WORD: &str = "corridor";
    const NAME: &str = "Corridor";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let lines = self.along.along()?.load(origin, data)?;
        Ok(self.growth.layer_of(DistanceTo::Corridor { lines, width: *self.strip.width }))
    }
}
