use super::engine::{CompiledLayer, KnownParts, Stack};
use super::{Layer, LayerId, PaintLayers, Shapes, Surface, settled};
use crate::earth::{EdgeLengths, LEVELS, Projection};
use crate::field::Transfer;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::Element;

/// The description of a size field, without the painted pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeFieldSpec {
    /// The layers, from the bottom to the top.
    pub layers: Vec<Layer>,
    /// The limits of h̄, and the curve from risk to diameter.
    pub transfer: Transfer,
    /// h̄ where no layer asks for a diameter, in world units.
    pub unasked: f64,
    /// The boundary of the domain, where a layer asks for the distance to it.
    pub outline: Option<Shapes>,
    /// Largest change of h̄ per unit of length: |h̄(x) − h̄(y)| ≤ g |x − y|. `None` for any change.
    pub gradation: Option<f64>,
    /// The projection in whose plane the field is, if it is on the Earth. Then all diameters are lengths on
    /// the ellipsoid, and world units are metres in the plane. Distances, also those of the gradation, count
    /// as if the scale were the greatest one everywhere: h̄ is never larger than by lengths on the ellipsoid.
    pub projection: Option<Projection>,
}

impl SizeFieldSpec {
    /// Returns whether h̄ of another spec is the same: they differ in surfaces at most, which ask for no
    /// diameter.
    pub(crate) fn asks_as(&self, other: &Self) -> bool {
        let Self { layers, transfer, unasked, outline, gradation, projection } = self;
        let without_surfaces = |layers: &[Layer]| -> Vec<Layer> {
            let others = layers.iter().filter(|layer| !layer.kind.is::<Surface>());
            others.cloned().collect()
        };
        without_surfaces(layers) == without_surfaces(&other.layers)
            && (transfer, unasked, outline, gradation, projection)
                == (&other.transfer, &other.unasked, &other.outline, &other.gradation, &other.projection)
    }
}

/// h̄ over a lattice, as a stack of layers asks for it.
///
/// The rule of refinement asks whether a point of a closed triangle has h̄ < ℓ. *Finest wins* makes that an
/// *or* over the layers; a floor makes it an *and*. So the stack is asked as one, for rectangles of lattice
/// cells: each layer answers for all cells of a rectangle at once, the answers are combined, and only a
/// rectangle that is still undecided is divided. There is no common raster: each layer is asked at its own
/// resolution.
///
/// Painted pixels are passed with each question. They may change between two questions; then the mesh must
/// be updated where they changed.
#[derive(Clone, Debug)]
pub struct SizeField {
    spec: SizeFieldSpec,
    /// The visible layers on the lattice.
    pub(super) stack: Stack,
    /// See [`settled::square_bits`].
    square_bits: Box<[u8; LEVELS]>,
    /// See [`Self::scaled`].
    scale: f64,
}

impl SizeField {
    /// Returns the field of a spec on a lattice.
    pub fn new(spec: SizeFieldSpec, lattice: &Lattice) -> Self {
        let edge_lengths = EdgeLengths::new(spec.projection.as_ref(), lattice);
        Self::with_lengths(spec, lattice, edge_lengths)
    }

    /// Returns the field of another spec on the same lattice.
    pub fn with_spec(&self, spec: SizeFieldSpec) -> Self {
        if spec.projection != self.spec.projection {
            return Self::new(spec, self.lattice());
        }
        Self::with_lengths(spec, self.lattice(), self.edge_lengths().clone())
    }

    /// Returns the field for a mesh whose targets are h̄ times a number, limits and gradation included.
    /// Values of h̄ stay as they are; what they are compared with is divided by the number.
    ///
    /// # Panics
    /// Panics when the number is not positive and finite.
    #[must_use]
    pub fn scaled(&self, scale: f64) -> Self {
        assert!(scale > 0.0 && scale.is_finite(), "a scale of {scale}");
        let lengths = self.edge_lengths().divided_by(scale / self.scale);
        Self { scale, ..Self::with_lengths(self.spec.clone(), self.lattice(), lengths) }
    }

    /// Returns what h̄ is multiplied by in the mesh; see [`Self::scaled`].
    pub fn scale(&self) -> f64 {
        self.scale
    }

    fn with_lengths(spec: SizeFieldSpec, lattice: &Lattice, edge_lengths: EdgeLengths) -> Self {
        let stack = spec.compile(lattice, edge_lengths);
        Self { spec, stack, square_bits: Box::new(settled::square_bits(lattice)), scale: 1.0 }
    }

    /// Returns the field of some layers without the others that ask for smaller diameters.
    ///
    /// Let nothing have changed since a triangle met its target, except that these layers ask for smaller
    /// diameters in places. Then the triangle exceeds its target exactly if it exceeds that of this field: h̄
    /// is the minimum of what they ask for and of the rest, which the triangle meets. Floors and replacements
    /// above them change what they ask for, and stay.
    ///
    /// `None` where that is not so: one of them is not visible, or a floor or a replacement itself.
    pub fn of_layers_alone(&self, ids: &[LayerId]) -> Option<Self> {
        let is_one = |layer: &CompiledLayer| ids.contains(&layer.id);
        let first = self.stack.layers().iter().position(is_one)?;
        let ones = self.stack.layers().iter().filter(|layer| is_one(layer) && layer.is_plain());
        if ones.count() < ids.len() || !self.spec.is_ordered(self.longest()) {
            return None;
        }
        let stack = self.stack.with(|number, layer| number >= first && (is_one(layer) || !layer.is_plain()));
        let is_kept = |layer: &&Layer| stack.layers().iter().any(|kept| kept.id == layer.id);
        let spec = SizeFieldSpec {
            layers: self.spec.layers.iter().filter(is_kept).cloned().collect(),
            outline: self.spec.outline.clone(),
            ..self.spec
        };
        Some(Self { spec, stack, square_bits: self.square_bits.clone(), scale: self.scale })
    }

    /// Returns this field without models of its functions: searches use bounds only.
    #[cfg(test)]
    pub(super) fn without_models(self) -> Self {
        Self { stack: self.stack.without_models(), ..self }
    }

    /// Returns the description of the field.
    pub fn spec(&self) -> &SizeFieldSpec {
        &self.spec
    }

    /// Returns the lattice that it answers for.
    pub fn lattice(&self) -> &Lattice {
        self.stack.lattice()
    }

    /// Returns whether an element's diameter exceeds its target by the area rule: whether h̄ is below it at
    /// some point of the closed triangle (Eqs. 12 and 13 of \[Report\], over all points).
    #[inline]
    pub fn exceeds(&self, paint: &PaintLayers, element: &Element) -> bool {
        self.asks_for_more(paint, element.corners, element.triangle.level())
    }

    /// [`Self::exceeds`] of a triangle by its corners and its level.
    #[inline]
    pub fn asks_for_more(&self, paint: &PaintLayers, corners: [LatticePoint; 3], level: u32) -> bool {
        self.stack.asks_with(&mut KnownParts::default(), paint, corners, level, None)
    }

    /// Returns the diameters of triangles, which h̄ is compared with; divided by [`Self::scale`].
    pub fn edge_lengths(&self) -> &EdgeLengths {
        self.stack.edge_lengths()
    }

    /// Returns the diameter of the largest triangle: nothing coarser matters to a mesh.
    pub fn longest(&self) -> f64 {
        self.edge_lengths().longest()
    }

    /// See [`settled::square_bits`].
    pub(super) fn square_bits(&self) -> &[u8; LEVELS] {
        &self.square_bits
    }
}
