use std::sync::Arc;

use glam::DVec2;

use super::{
    Depths, FeatureSize, Mask, PaintLayers, Shapes, Straits, Surface, SurfaceSource, Threats, ValueCurve,
};
use crate::domain::PieceChoice;
use crate::field::{Formula, f32_not_below};
use crate::raster::{Raster, RasterPyramid, RasterValues};

/// Identifies a layer within a document, as long as the document exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LayerId(pub u32);

/// One layer of the size field.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Which layer it is.
    pub id: LayerId,
    /// The name that a person gave the layer.
    pub name: String,
    /// A hidden layer asks for nothing.
    pub visible: bool,
    /// A locked layer cannot be edited.
    pub locked: bool,
    /// How it is combined with the layers below.
    pub combine: Combine,
    /// The area in which the layer counts; everywhere without a mask.
    pub mask: Option<Mask>,
    /// The kind of the layer, with its settings.
    pub kind: LayerKind,
}

/// How a layer is combined with the result of the layers below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// The smaller target diameter counts.
    Finest,
    /// The layers below do not make h̄ smaller than the target of this layer.
    Floor,
    /// The layer alone counts, wherever it asks for anything.
    Replace,
}

impl Combine {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Finest, Self::Floor, Self::Replace];
}

/// The meaning of the values of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Risk, 0 to 1; the transfer curve turns it into a target diameter.
    Risk,
    /// Target diameter in world units.
    Diameter,
    /// The largest error of a mesh from surfaces, in their unit. It asks for no diameter: at a sample of a
    /// surface it takes the place of the error that the surface allows.
    Error,
}

impl Quantity {
    /// Returns the noun for such values in a sentence.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Risk => "risk",
            Self::Diameter => "diameters",
            Self::Error => "errors",
        }
    }

    /// Returns the value of paint where nothing is painted: it asks for nothing.
    pub fn blank(self) -> f32 {
        match self {
            Self::Risk => 0.0,
            Self::Diameter => f32::INFINITY,
            Self::Error => f32::MAX,
        }
    }
}

/// The kind of a layer, which decides its target diameters.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerKind {
    /// Paint, whose pixels are in the document.
    Paint(Quantity),
    /// A formula in x and y.
    Formula {
        /// The meaning of the formula's value.
        quantity: Quantity,
        /// The formula.
        formula: Formula,
    },
    /// A raster.
    Raster {
        /// The raster.
        source: RasterSource,
        /// The meaning of the raster's values.
        reading: RasterReading,
    },
    /// Threats, combined as independent probabilities.
    Threats(Threats),
    /// h̄ grows with the distance.
    Distance {
        /// The target of the distance.
        to: DistanceTo,
        /// The target diameter at distance 0, in world units.
        at_zero: f64,
        /// How much the target diameter grows with the distance, by unit of length.
        slope: f64,
        /// The distance beyond which nothing is asked for, in world units; infinite without a limit.
        range: f64,
    },
    /// One diameter where a raster's value lies between two numbers.
    Band {
        /// The raster.
        source: RasterSource,
        /// The least and the greatest of these values.
        between: [f64; 2],
        /// The target diameter there, in world units.
        diameter: f64,
    },
    /// Depths of water.
    Depth(Depths),
    /// At least a number of triangles across each strait.
    Straits(Straits),
    /// A number of triangles across the water, which grow with the way from it.
    FeatureSize(FeatureSize),
    /// A surface that the mesh is to be close to. It asks for no diameter.
    Surface(Surface),
}

/// The target of a distance.
#[derive(Clone, Debug, PartialEq)]
pub enum DistanceTo {
    /// The boundary of the domain, on both sides.
    Outline,
    /// The coasts: the boundary of the domain without its open parts, on both sides. A layer of a document
    /// has it; in the description of a size field, shapes take its place, or nothing without a coast.
    Coasts,
    /// Some pieces of the boundary, on both sides. A layer of a document has it; in the description of a size
    /// field, shapes take its place, or nothing where no piece is chosen.
    Pieces(PieceChoice),
    /// Points, lines and polygons.
    Shapes {
        /// The name of their file, for a person; empty where there is none.
        name: String,
        /// The shapes.
        shapes: Shapes,
    },
    /// A strip along lines that were taken from paths. Within it the distance is 0.
    Corridor {
        /// The lines.
        lines: Shapes,
        /// The width of the strip, in world units.
        width: f64,
    },
}

impl DistanceTo {
    /// Returns the shapes, unless it is the outline or a part of it.
    pub fn shapes(&self) -> Option<&Shapes> {
        match self {
            Self::Outline | Self::Coasts | Self::Pieces(_) => None,
            Self::Shapes { shapes, .. } | Self::Corridor { lines: shapes, .. } => Some(shapes),
        }
    }

    /// Returns how far from the shapes the distance begins, in world units.
    pub fn reach(&self) -> f64 {
        if let Self::Corridor { width, .. } = self { 0.5 * width } else { 0.0 }
    }
}

/// A raster, and where it comes from. Clones share the pixels.
#[derive(Clone, Debug)]
pub struct RasterSource {
    /// The name of the file, for a person.
    pub name: String,
    /// The values, at their place.
    pub raster: Arc<RasterPyramid>,
}

impl PartialEq for RasterSource {
    /// Rasters that share their memory are not compared pixel by pixel. Pixels without a value are equal.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (Arc::ptr_eq(&self.raster, &other.raster)
                || have_equal_pixels(self.raster.raster(), other.raster.raster()))
    }
}

fn have_equal_pixels(a: &Raster, b: &Raster) -> bool {
    let is_equal = |(a, b): (&f32, &f32)| a == b || (a.is_nan() && b.is_nan());
    a.bounds() == b.bounds() && a.size() == b.size() && a.values().iter().zip(b.values()).all(is_equal)
}

/// The meaning of the values of a raster.
#[derive(Clone, Debug, PartialEq)]
pub enum RasterReading {
    /// Risk, 0 to 1.
    Risk,
    /// Target diameter in world units.
    Diameter,
    /// The largest error from surfaces, in their unit.
    Error,
    /// The curve gives the target diameter for a value.
    Curve(Arc<ValueCurve>),
}

impl From<&RasterReading> for RasterValues {
    fn from(reading: &RasterReading) -> Self {
        match reading {
            RasterReading::Risk => Self::Risk,
            RasterReading::Diameter => Self::Diameter,
            RasterReading::Error => Self::Error,
            RasterReading::Curve(_) => Self::Any,
        }
    }
}

impl Layer {
    /// Returns the layers of a new document: `base`, and paint of both kinds over it.
    pub fn default_stack(base: LayerKind) -> Vec<Self> {
        let mut layers =
            Self::stack([base, LayerKind::Paint(Quantity::Diameter), LayerKind::Paint(Quantity::Risk)]);
        layers[0].name = "Base".into();
        layers
    }

    /// Creates a visible layer in which the finest counts.
    pub fn new(id: LayerId, name: impl Into<String>, kind: LayerKind) -> Self {
        let combine = Combine::Finest;
        Self { id, name: name.into(), visible: true, locked: false, combine, mask: None, kind }
    }

    /// Returns a stack of layers, from the bottom to the top, named after their kinds and numbered from 0.
    pub fn stack(kinds: impl IntoIterator<Item = LayerKind>) -> Vec<Self> {
        let layer = |(id, kind): (u32, LayerKind)| Self::new(LayerId(id), kind.label(), kind);
        (0..).zip(kinds).map(layer).collect()
    }

    /// Returns the risk that the layer has at a point in world units, if it is one of risk with a value
    /// there.
    pub fn risk_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        if self.mask.as_ref().is_some_and(|mask| !mask.contains(point)) {
            return None;
        }
        match &self.kind {
            LayerKind::Paint(Quantity::Risk) => {
                Some(paint.get(self.id).map_or(0.0, |raster| f64::from(raster.sample(point))))
            }
            LayerKind::Formula { quantity: Quantity::Risk, formula } => Some(formula.eval(point.x, point.y)),
            LayerKind::Raster { source, reading: RasterReading::Risk } => {
                source.raster.sample(point).map(f64::from)
            }
            LayerKind::Threats(threats) => Some(threats.risk_at(point)),
            _ => None,
        }
    }

    /// Returns whether the layer says how large errors from surfaces may be.
    pub fn is_of_errors(&self) -> bool {
        self.kind.is_of_errors()
    }

    /// Returns the largest error from surfaces that the layer allows at a point in world units; `None` where
    /// it says nothing: it is of something else, its mask ends, nothing is painted, or its number is not
    /// positive and finite.
    pub fn error_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        if self.mask.as_ref().is_some_and(|mask| !mask.contains(point)) {
            return None;
        }
        let error = match &self.kind {
            LayerKind::Paint(Quantity::Error) => {
                let error = paint.get(self.id)?.sample(point);
                f64::from(if error == Quantity::Error.blank() { f32::INFINITY } else { error })
            }
            LayerKind::Formula { quantity: Quantity::Error, formula } => formula.eval(point.x, point.y),
            LayerKind::Raster { source, reading: RasterReading::Error } => {
                f64::from(source.raster.sample(point)?)
            }
            _ => return None,
        };
        // As paint has it, so that all layers agree.
        (error > 0.0 && error.is_finite()).then(|| f64::from(f32_not_below(error)))
    }

    /// Returns the data that other layers may share, its mask among them: the address of each and its size in
    /// bytes.
    pub(crate) fn shared_data(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        self.mask.as_ref().map(Mask::shared_data).into_iter().chain(self.kind.shared_data())
    }

    /// Returns the quantity that is painted on the layer, if it is a paint layer.
    pub fn paints(&self) -> Option<Quantity> {
        if let LayerKind::Paint(quantity) = self.kind { Some(quantity) } else { None }
    }
}

impl LayerKind {
    /// Returns a formula for the target diameter.
    pub fn target(formula: Formula) -> Self {
        Self::Formula { quantity: Quantity::Diameter, formula }
    }

    /// Returns a layer with one target diameter everywhere, in world units.
    pub fn constant(diameter: f64) -> Self {
        Self::target(Formula::constant_of(diameter))
    }

    /// Returns a formula for the risk.
    pub fn risk(formula: Formula) -> Self {
        Self::Formula { quantity: Quantity::Risk, formula }
    }

    /// Returns whether it is a formula that uses the depth of the water.
    pub fn uses_depth(&self) -> bool {
        matches!(self, Self::Formula { formula, .. } if formula.uses_depth())
    }

    /// Returns whether it says how large errors from surfaces may be. Then it asks for no diameter.
    pub fn is_of_errors(&self) -> bool {
        match self {
            Self::Paint(quantity) | Self::Formula { quantity, .. } => *quantity == Quantity::Error,
            Self::Raster { reading, .. } => *reading == RasterReading::Error,
            _ => false,
        }
    }

    /// Returns whether it changes with the names and types of the pieces of the boundary.
    pub fn follows_pieces(&self) -> bool {
        matches!(self, Self::Distance { to: DistanceTo::Pieces(_) | DistanceTo::Coasts, .. })
    }

    /// Returns the raster that the layer reads, if it reads one.
    pub fn raster_source(&self) -> Option<&RasterSource> {
        match self {
            Self::Raster { source, .. } | Self::Band { source, .. } => Some(source),
            Self::Depth(depths) => Some(depths.source()),
            Self::Surface(surface) => surface.source.raster(),
            _ => None,
        }
    }

    /// Returns the name of the file that the data come from, for a person, if they come from one.
    pub fn file_name(&self) -> Option<&str> {
        match self {
            Self::Raster { source, .. } | Self::Band { source, .. } => Some(&source.name),
            Self::Depth(depths) => Some(&depths.source().name),
            Self::Surface(Surface { source: SurfaceSource::Raster(source), .. }) => Some(&source.name),
            Self::Distance { to: DistanceTo::Shapes { name, .. }, .. } if !name.is_empty() => Some(name),
            Self::Paint(_)
            | Self::Formula { .. }
            | Self::Threats(_)
            | Self::Distance { .. }
            | Self::Straits(_)
            | Self::FeatureSize(_)
            | Self::Surface(_) => None,
        }
    }

    /// Returns the name of a new layer of this kind: that of its file, if it has one.
    pub fn name(&self) -> String {
        self.file_name().unwrap_or(self.label()).to_owned()
    }

    /// Returns the name of this kind of layer for people.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Paint(Quantity::Risk) => "Painted risk",
            Self::Paint(Quantity::Diameter) => "Painted diameter",
            Self::Paint(Quantity::Error) => "Painted error",
            Self::Formula { .. } => "Formula",
            Self::Raster { .. } => "Raster",
            Self::Threats(_) => "Threats",
            Self::Distance { to: DistanceTo::Corridor { .. }, .. } => "Corridor",
            Self::Distance { .. } => "Distance",
            Self::Band { .. } => "Band",
            Self::Depth(_) => "Depth",
            Self::Straits(_) => "Straits",
            Self::FeatureSize(_) => "Feature size",
            Self::Surface(_) => "Surface",
        }
    }

    /// Returns the name of a change of the settings of such a layer, for the history.
    pub(crate) fn change_title(&self) -> &'static str {
        match self {
            Self::Paint(_) => "paint layer",
            Self::Formula { .. } => "formula",
            Self::Raster { .. } => "raster",
            Self::Threats(_) => "threats",
            Self::Distance { to: DistanceTo::Corridor { .. }, .. } => "corridor",
            Self::Distance { .. } => "distance",
            Self::Band { .. } => "band",
            Self::Depth(_) => "depth",
            Self::Straits(_) => "straits",
            Self::FeatureSize(_) => "feature size",
            Self::Surface(_) => "surface",
        }
    }

    /// Returns the data that other layers may share: the address of each and its size in bytes.
    pub(crate) fn shared_data(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let curve = |reading: &RasterReading| match reading {
            RasterReading::Curve(curve) => Some((Arc::as_ptr(curve).addr(), size_of_val(curve.knots()))),
            RasterReading::Risk | RasterReading::Diameter | RasterReading::Error => None,
        };
        let raster =
            |source: &RasterSource| Some((Arc::as_ptr(&source.raster).addr(), source.raster.bytes()));
        let data = match self {
            Self::Paint(_) => [None; 2],
            Self::Formula { formula, .. } => [Some((formula.address(), formula.bytes())), None],
            Self::Raster { source, reading } => [raster(source), curve(reading)],
            Self::Band { source, .. } => [raster(source), None],
            Self::Depth(depths) => {
                let computed = depths.computed();
                let computed = computed.map(|raster| (Arc::as_ptr(raster).addr(), raster.bytes()));
                [raster(depths.source()), computed]
            }
            Self::Straits(straits) => [Some(straits.found.shared_data()), None],
            Self::FeatureSize(size) => [Some(size.found.shared_data()), None],
            Self::Surface(surface) => match &surface.source {
                SurfaceSource::Raster(source) => [raster(source), None],
                SurfaceSource::Formula(formula) => [Some((formula.address(), formula.bytes())), None],
            },
            Self::Threats(threats) => [Some(threats.shared_data()), None],
            Self::Distance { to, .. } => [to.shapes().map(Shapes::shared_data), None],
        };
        data.into_iter().flatten()
    }
}
