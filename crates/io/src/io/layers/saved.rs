use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{
    SavedCombine, SavedDepthSize, SavedDistanceTo, SavedKind, SavedLaw, SavedNorm, SavedPositive,
    SavedQuantity,
};
use crate::io::RasterFormat;
use crate::io::settings::SavedBoundaryType;
use meshbrush_core::layers::{
    BandLayer, DistanceLayer, DistanceTo, FeatureSize, FormulaLayer, Layer, LayerKind, PaintLayer,
    RasterLayer, RasterReading, Straits,
};
use meshbrush_core::raster::RasterValues;

/// A layer as a text has it. Which keys it may have depends on its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SavedLayer {
    /// The kind of the layer, which decides which keys follow.
    pub kind: SavedKind,
    /// The name of the layer; without one, it is named after its kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A hidden layer asks for nothing.
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub visible: bool,
    /// A locked layer cannot be edited.
    #[serde(default, skip_serializing_if = "is_no")]
    pub locked: bool,
    /// How it is combined with the layers below.
    #[serde(default, skip_serializing_if = "SavedCombine::is_default")]
    pub combine: SavedCombine,
    /// Where it counts: polygons, each a list of rings, the outer one first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<Vec<SavedPolygon>>,
    /// Where it counts: a file with polygons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask_file: Option<PathBuf>,
    /// The quantity that paint or a formula states.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<SavedQuantity>,
    /// A formula in x and y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// The file that holds the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The name of a paint layer in `file`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
    /// Where a raster lies, in place of what its file says: x₀, y₀, x₁, y₁.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 4]>,
    /// The quantity that the pixels of a raster state.
    #[serde(default, rename = "as", skip_serializing_if = "Option::is_none")]
    pub read_as: Option<SavedQuantity>,
    /// Pairs of a raster's value and the target diameter there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<[f64; 2]>>,
    /// Threats in place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threats: Option<Vec<SavedThreat>>,
    /// The object that the distance is measured to, if it is neither a file nor a list of shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<SavedDistanceTo>,
    /// The names of the pieces of the boundary that the distance is measured to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pieces: Option<Vec<String>>,
    /// The types of the pieces of the boundary that the distance is measured to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub types: Option<Vec<SavedBoundaryType>>,
    /// The shapes that the distance is measured to, as a list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapes: Option<Vec<SavedShape>>,
    /// The width of a corridor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// The target diameter at distance 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_zero: Option<f64>,
    /// How much the target diameter grows with the distance, by unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// The distance beyond which nothing is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<f64>,
    /// The least and the greatest value of a band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[f64; 2]>,
    /// The target diameter in a band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<f64>,
    /// Whether values are heights or depths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positive: Option<SavedPositive>,
    /// What is added to depths, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// How the depth decides the target diameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<SavedDepthSize>,
    /// The least depth at which something is asked for, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_from: Option<f64>,
    /// The greatest depth at which something is asked for, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_to: Option<f64>,
    /// The period of a wave, in seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// Triangles in the length of a wave, or of a change of the depth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triangles: Option<f64>,
    /// The side of the square over which heights are averaged, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<f64>,
    /// A time step, in seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_step: Option<f64>,
    /// A Courant number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub courant: Option<f64>,
    /// Triangles across a strait.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub across: Option<f64>,
    /// The least width of a strait that counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_from: Option<f64>,
    /// The greatest width of a strait.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_to: Option<f64>,
    /// Which error of a surface is meant; the largest difference where it is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub norm: Option<SavedNorm>,
    /// The largest error, in the unit of a surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The largest number of triangles for a surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<usize>,
}

/// A polygon: its rings, the outer one first, and their points.
pub type SavedPolygon = Vec<Vec<[f64; 2]>>;

/// A threat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { x = 1, y = 2, range = 3 }")]
pub struct SavedThreat {
    /// Its place.
    pub x: f64,
    /// Its place.
    pub y: f64,
    /// The distance beyond which there is no risk.
    pub range: f64,
    /// The risk at its place.
    #[serde(default = "one")]
    pub peak: f64,
    /// How the risk falls with the distance.
    #[serde(default)]
    pub law: SavedLaw,
}

/// A point, line or polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedShape {
    /// x and y.
    Point([f64; 2]),
    /// Points joined by segments.
    Line(Vec<[f64; 2]>),
    /// Rings, the outer one first.
    Polygon(SavedPolygon),
}

impl SavedLayer {
    /// Returns a visible layer of a kind, with no other key.
    pub fn of_kind(kind: SavedKind) -> Self {
        Self {
            kind,
            name: None,
            visible: true,
            locked: false,
            combine: SavedCombine::Finest,
            mask: None,
            mask_file: None,
            quantity: None,
            formula: None,
            file: None,
            layer: None,
            bounds: None,
            read_as: None,
            curve: None,
            threats: None,
            to: None,
            pieces: None,
            types: None,
            shapes: None,
            width: None,
            at_zero: None,
            slope: None,
            range: None,
            between: None,
            diameter: None,
            positive: None,
            offset: None,
            size: None,
            depth_from: None,
            depth_to: None,
            period: None,
            triangles: None,
            smoothing: None,
            time_step: None,
            courant: None,
            across: None,
            width_from: None,
            width_to: None,
            norm: None,
            within: None,
            at_most: None,
        }
    }

    /// Returns a layer of a stack, but for data that has no form as text: `file` names where that is.
    pub fn of(layer: &Layer, file: Option<PathBuf>) -> Self {
        Self {
            shapes: Self::shapes_of(layer),
            threats: Self::threats_of(layer),
            mask: Self::mask_of(layer),
            ..Self::without_lists(layer, file)
        }
    }

    /// Returns a layer as [`Self::of`] does, without its shapes, its threats and its mask.
    pub fn without_lists(layer: &Layer, file: Option<PathBuf>) -> Self {
        let kind = match &layer.kind {
            LayerKind::Paint(PaintLayer { quantity }) => {
                Self { quantity: Some((*quantity).into()), ..Self::of_kind(SavedKind::Paint) }
            }
            LayerKind::Formula(FormulaLayer { quantity, formula }) => Self {
                quantity: Some((*quantity).into()),
                formula: Some(formula.source().to_owned()),
                ..Self::of_kind(SavedKind::Formula)
            },
            LayerKind::Raster(RasterLayer { reading, .. }) => Self {
                read_as: match reading {
                    RasterReading::Risk => Some(SavedQuantity::Risk),
                    RasterReading::Diameter => Some(SavedQuantity::Diameter),
                    RasterReading::Error => Some(SavedQuantity::Error),
                    RasterReading::Curve(_) => None,
                },
                curve: match reading {
                    RasterReading::Curve(curve) => Some(curve.knots().to_vec()),
                    _ => None,
                },
                ..Self::of_kind(SavedKind::Raster)
            },
            LayerKind::Threats(_) => Self::of_kind(SavedKind::Threats),
            LayerKind::Distance(DistanceLayer { to, at_zero, slope, range }) => {
                Self::of_distance(to, [*at_zero, *slope, *range])
            }
            LayerKind::Band(BandLayer { between, diameter, .. }) => {
                Self { between: Some(*between), diameter: Some(*diameter), ..Self::of_kind(SavedKind::Band) }
            }
            LayerKind::Depth(depths) => Self::of_depths(depths.sizes()),
            LayerKind::Surface(surface) => Self::of_surface(surface),
            LayerKind::Straits(Straits { across, found }) => {
                Self::of_widths(SavedKind::Straits, *across, found.between())
            }
            LayerKind::FeatureSize(FeatureSize { across, found }) => {
                Self::of_widths(SavedKind::FeatureSize, *across, found.between())
            }
        };
        Self {
            name: Some(layer.name.clone()),
            visible: layer.visible,
            locked: layer.locked,
            combine: layer.combine.into(),
            file,
            ..kind
        }
    }

    fn of_distance(to: &DistanceTo, [at_zero, slope, range]: [f64; 3]) -> Self {
        let chosen = if let DistanceTo::Pieces(chosen) = to { Some(chosen) } else { None };
        let names = chosen.map(|chosen| chosen.names.clone()).filter(|names| !names.is_empty());
        let types = chosen.map(|chosen| chosen.types.iter().copied().map(Into::into).collect());
        // One of both says that it is pieces, also where none is chosen.
        let types = types.filter(|types: &Vec<_>| !types.is_empty() || names.is_none());
        let kind = match to {
            DistanceTo::Corridor { .. } => SavedKind::Corridor,
            DistanceTo::Outline | DistanceTo::Coasts | DistanceTo::Pieces(_) | DistanceTo::Shapes { .. } => {
                SavedKind::Distance
            }
        };
        Self {
            to: SavedDistanceTo::of(to),
            pieces: names,
            types,
            width: if let DistanceTo::Corridor { width, .. } = to { Some(*width) } else { None },
            at_zero: Some(at_zero),
            slope: Some(slope),
            range: range.is_finite().then_some(range),
            ..Self::of_kind(kind)
        }
    }

    fn of_widths(kind: SavedKind, across: f64, [from, to]: [f64; 2]) -> Self {
        Self { across: Some(across), width_from: Some(from), width_to: Some(to), ..Self::of_kind(kind) }
    }

    /// Returns the name of the layer, or the default one of its kind.
    pub fn shown_name(&self) -> &str {
        self.name.as_deref().unwrap_or(self.kind.default_name())
    }

    /// Returns whether it is painted.
    pub fn is_paint(&self) -> bool {
        self.kind == SavedKind::Paint
    }

    /// Returns whether it needs both ends of the scale from the smallest to the largest target diameter.
    pub fn uses_scale(&self) -> bool {
        let format = || self.file.as_ref().and_then(|file| RasterFormat::from_path(file).ok());
        let is_image = || format().is_some_and(|format| !format.is_grid());
        self.is_risk() || (self.read_as == Some(SavedQuantity::Diameter) && is_image())
    }

    /// Returns whether it asks for risk.
    pub fn is_risk(&self) -> bool {
        match self.kind {
            SavedKind::Paint | SavedKind::Formula => self.quantity == Some(SavedQuantity::Risk),
            SavedKind::Raster => self.read_as == Some(SavedQuantity::Risk),
            SavedKind::Threats => true,
            SavedKind::Distance
            | SavedKind::Corridor
            | SavedKind::Band
            | SavedKind::Depth
            | SavedKind::Straits
            | SavedKind::FeatureSize
            | SavedKind::Surface => false,
        }
    }

    /// Returns the kind of the values of its raster, if it reads one.
    pub fn raster_values(&self) -> Option<RasterValues> {
        match (self.kind, self.read_as) {
            (SavedKind::Raster, Some(SavedQuantity::Risk)) => Some(RasterValues::Risk),
            (SavedKind::Raster, Some(SavedQuantity::Diameter)) => Some(RasterValues::Diameter),
            (SavedKind::Raster, Some(SavedQuantity::Error)) => Some(RasterValues::Error),
            (SavedKind::Raster | SavedKind::Band | SavedKind::Depth, _) => Some(RasterValues::Any),
            (SavedKind::Surface, _) if self.formula.is_none() => Some(RasterValues::Any),
            _ => None,
        }
    }

    /// Returns the keys that are given and belong to some kinds only.
    pub fn given(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("quantity", self.quantity.is_some()),
            ("formula", self.formula.is_some()),
            ("file", self.file.is_some()),
            ("layer", self.layer.is_some()),
            ("bounds", self.bounds.is_some()),
            ("as", self.read_as.is_some()),
            ("curve", self.curve.is_some()),
            ("threats", self.threats.is_some()),
            ("to", self.to.is_some()),
            ("pieces", self.pieces.is_some()),
            ("types", self.types.is_some()),
            ("shapes", self.shapes.is_some()),
            ("width", self.width.is_some()),
            ("at_zero", self.at_zero.is_some()),
            ("slope", self.slope.is_some()),
            ("range", self.range.is_some()),
            ("between", self.between.is_some()),
            ("diameter", self.diameter.is_some()),
            ("positive", self.positive.is_some()),
            ("offset", self.offset.is_some()),
            ("size", self.size.is_some()),
            ("depth_from", self.depth_from.is_some()),
            ("depth_to", self.depth_to.is_some()),
            ("period", self.period.is_some()),
            ("triangles", self.triangles.is_some()),
            ("smoothing", self.smoothing.is_some()),
            ("time_step", self.time_step.is_some()),
            ("courant", self.courant.is_some()),
            ("across", self.across.is_some()),
            ("width_from", self.width_from.is_some()),
            ("width_to", self.width_to.is_some()),
            ("within", self.within.is_some()),
            ("at_most", self.at_most.is_some()),
            ("norm", self.norm.is_some()),
        ];
        given.into_iter().filter_map(|(key, is_given)| is_given.then_some(key))
    }
}

fn yes() -> bool {
    true
}

fn is_yes(value: &bool) -> bool {
    *value
}

fn is_no(value: &bool) -> bool {
    !value
}

fn one() -> f64 {
    1.0
}
