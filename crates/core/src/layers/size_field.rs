use super::engine::asked::Share;
use super::engine::cells::{Cells, Cut};
use super::engine::parts::PartId;
use super::engine::patch::TouchedCells;
use super::engine::reading::{RangeAnswer, largest_below};
use super::engine::search::any_cell;
use super::engine::{CompiledLayer, CompiledPlane, KnownParts, gradation};
use super::{Combine, Layer, LayerId, LayerKind, PaintLayers, Shapes, settled};
use crate::earth::{EdgeLengths, LEVELS, Projection};
use crate::field::Transfer;
use crate::geometry::{Lattice, LatticePoint, Octagon};
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
            let others = layers.iter().filter(|layer| !matches!(layer.kind, LayerKind::Surface(_)));
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
    lattice: Lattice,
    /// What targets are compared with.
    edge_lengths: EdgeLengths,
    /// See [`settled::square_bits`].
    square_bits: Box<[u8; LEVELS]>,
    /// Visible layers, from the bottom to the top.
    layers: Vec<CompiledLayer>,
    /// Whether the finest of some pixels counts everywhere, and nothing else.
    has_pixels_only: bool,
}

/// Facts that hold for all triangles in a square.
#[derive(Clone, Copy)]
pub(super) struct Nearby<'a> {
    /// No point of a cell that touches one of them asks for less, in world units.
    pub least_asked: f64,
    /// The parts of the lattice from which gradation can carry to them.
    pub sources: &'a [PartId],
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
            return Self::new(spec, &self.lattice);
        }
        Self::with_lengths(spec, &self.lattice, self.edge_lengths.clone())
    }

    fn with_lengths(spec: SizeFieldSpec, lattice: &Lattice, edge_lengths: EdgeLengths) -> Self {
        let SizeFieldSpec { transfer, outline, .. } = &spec;
        let plane =
            CompiledPlane { transfer, lattice, outline: outline.as_ref(), edge_lengths: &edge_lengths };
        let visible = spec.layers.iter().filter(|layer| layer.visible);
        let layers: Vec<_> = visible.map(|layer| CompiledLayer::new(layer, &spec.layers, &plane)).collect();
        let has_pixels_only = has_pixels_only(&layers, &spec);
        let square_bits = Box::new(settled::square_bits(lattice));
        let mut field = Self { lattice: *lattice, edge_lengths, square_bits, layers, has_pixels_only, spec };
        let is_minimum = field.layers.iter().all(CompiledLayer::is_plain);
        if let (Some(slope), true) = (field.slope(), is_minimum) {
            let Transfer { h_min, h_max, .. } = field.spec.transfer;
            let most = field.spec.unasked.min(h_max);
            field.layers.iter_mut().for_each(|layer| layer.grade(slope, h_min, most, lattice));
        }
        field
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
        let first = self.layers.iter().position(is_one)?;
        let ones = self.layers.iter().filter(|layer| is_one(layer) && layer.is_plain());
        if ones.count() < ids.len() || !self.spec.is_ordered(self.longest()) {
            return None;
        }
        let kept = self.layers[first..].iter().filter(|layer| is_one(layer) || !layer.is_plain());
        let layers: Vec<CompiledLayer> = kept.cloned().collect();
        let is_kept = |layer: &&Layer| layers.iter().any(|kept| kept.id == layer.id);
        let spec = SizeFieldSpec {
            layers: self.spec.layers.iter().filter(is_kept).cloned().collect(),
            outline: self.spec.outline.clone(),
            ..self.spec
        };
        let (edge_lengths, square_bits) = (self.edge_lengths.clone(), self.square_bits.clone());
        let has_pixels_only = has_pixels_only(&layers, &spec);
        Some(Self { lattice: self.lattice, edge_lengths, square_bits, layers, has_pixels_only, spec })
    }

    /// Returns this field without models of its functions: searches use bounds only.
    #[cfg(test)]
    pub(super) fn without_models(self) -> Self {
        let layers = self.layers.into_iter().map(CompiledLayer::without_models).collect();
        Self { layers, ..self }
    }

    /// Returns the description of the field.
    pub fn spec(&self) -> &SizeFieldSpec {
        &self.spec
    }

    /// Returns the lattice that it answers for.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns the visible layers, from the bottom to the top.
    pub(super) fn compiled(&self) -> &[CompiledLayer] {
        &self.layers
    }

    /// Returns the binary logarithm of the side of the squares, in lattice steps, that searches divide at
    /// lines between pixels: those that are about as large as the largest pixels.
    pub(super) fn pixel_bits(&self, paint: &PaintLayers) -> u32 {
        let bits = self.layers.iter().filter_map(|layer| layer.pixel_bits(paint, &self.lattice));
        bits.max().map_or(0, |bits| bits + 1)
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
        self.asks_with(&mut KnownParts::default(), paint, corners, level, None)
    }

    /// [`Self::asks_for_more`], where many triangles nearby are asked about. `known` must have been used for
    /// this field and these pixels only; `nearby` is what is known of a square that holds the triangle.
    #[inline]
    pub(super) fn asks_with(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
        nearby: Option<Nearby>,
    ) -> bool {
        let Some(limit) = self.edge_lengths.limit(corners, level) else { return false };
        if let Some(asks) = self.limits_decide(limit) {
            return asks;
        }
        let length = self.edge_lengths.table()[limit];
        let triangle = Octagon::triangle(corners);
        let around = Cells::around(&triangle, self.lattice.extent());
        match self.slope() {
            None => self.any_below(paint, &triangle, around, limit),
            Some(slope) => {
                let sources = nearby.map(|nearby| nearby.sources);
                let can_ask = nearby.is_none_or(|nearby| nearby.least_asked < length);
                // What is carried is rounded up as diameters are: distances are rounded, and rounding must
                // not decide where exactly ℓ is carried.
                let carried = f64::from(largest_below(length)).next_up();
                (can_ask && self.any_below(paint, &triangle, around, limit))
                    || gradation::any_below(self, paint, known, corners, (slope, carried), sources)
            }
        }
    }

    /// Returns whether the finest of some pixels counts everywhere, and nothing else: then those that touch a
    /// triangle answer for it and for all triangles within it.
    pub(super) fn has_pixels_only(&self) -> bool {
        self.has_pixels_only
    }

    /// Returns the minimum and the maximum target diameter over the pixels that touch a triangle, and whether
    /// the triangle exceeds its target. For a field that [`Self::has_pixels_only`]; `None` where the pixels
    /// are too many, or not quick to read.
    pub(super) fn asked_by_pixels(
        &self,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> Option<([f64; 2], bool)> {
        let limit = self.edge_lengths.limit(corners, level)?;
        let triangle = Octagon::triangle(corners);
        let around = Cells::around(&triangle, self.lattice.extent());
        let (mut asked, mut exceeds) = ([f64::INFINITY; 2], false);
        for layer in &self.layers {
            let (of_layer, asks) =
                layer.asked_by_pixels(paint, (&triangle, &around), limit, &self.lattice)?;
            asked = [asked[0].min(of_layer.least), asked[1].min(of_layer.greatest)];
            exceeds |= asks;
        }
        Some((asked, self.limits_decide(limit).unwrap_or(exceeds)))
    }

    /// Returns the answer for all triangles with a limit that no layer can change: no point asks for less
    /// than h_min or for more than h_max.
    #[inline]
    fn limits_decide(&self, limit: usize) -> Option<bool> {
        let length = self.edge_lengths.table()[limit];
        let Transfer { h_min, h_max, .. } = self.spec.transfer;
        if length <= h_min {
            return Some(false);
        }
        (length > h_max).then_some(true)
    }

    /// Returns the largest change of h̄ per unit of length in the plane; `None` for any change.
    pub(super) fn slope(&self) -> Option<f64> {
        self.spec.gradation.map(|gradation| gradation / self.edge_lengths.greatest_scale())
    }

    /// Returns the diameters of triangles, which h̄ is compared with.
    pub fn edge_lengths(&self) -> &EdgeLengths {
        &self.edge_lengths
    }

    /// Returns the diameter of the largest triangle: nothing coarser matters to a mesh.
    pub fn longest(&self) -> f64 {
        self.edge_lengths.longest()
    }

    /// See [`settled::square_bits`].
    pub(super) fn square_bits(&self) -> &[u8; LEVELS] {
        &self.square_bits
    }

    /// Returns whether a cell that touches the triangle asks for less than a limit, before gradation.
    ///
    /// From the top down, a layer is tested alone as long as no floor and no replacement above it counts in
    /// the cells around the triangle: the search then divides them for this layer only. Those from the first
    /// floor or replacement that counts down to the bottom are tested together.
    fn any_below(&self, paint: &PaintLayers, triangle: &Octagon, around: Cells, limit: usize) -> bool {
        let mut count = self.layers.len();
        while let Some(layer) = count.checked_sub(1).map(|top| &self.layers[top]) {
            if layer.is_plain() {
                if layer.any_below(paint, triangle, around, limit, &self.lattice) {
                    return true;
                }
            } else if !layer.is_masked_out(&around, &self.lattice) {
                let mut ask =
                    |cells: &Cells| self.asks(count, paint, &TouchedCells::touching(*cells, triangle), limit);
                return any_cell(triangle, around, &mut ask);
            }
            count -= 1;
        }
        false
    }

    /// Returns the share of some cells in which the lowest `count` layers together ask for less than a limit,
    /// and the cut that divides them for a closer answer.
    fn asks(
        &self,
        count: usize,
        paint: &PaintLayers,
        patch: &TouchedCells,
        limit: usize,
    ) -> (Share, Option<Cut>) {
        let Some(below) = count.checked_sub(1) else { return (Share::None, None) };
        let layer = &self.layers[below];
        let (RangeAnswer { asks, present }, cut) = layer.answer(paint, patch, limit, &self.lattice);
        let permits = present.not().or(asks);
        match layer.combine {
            Combine::Finest if asks == Share::All => return (Share::All, None),
            Combine::Floor if permits == Share::None => return (Share::None, None),
            Combine::Replace if present == Share::All => return (asks, cut),
            _ => {}
        }
        let (rest, rest_cut) = self.asks(below, paint, patch, limit);
        let share = match layer.combine {
            Combine::Finest => rest.or(asks),
            Combine::Floor => rest.and(permits),
            Combine::Replace if present == Share::None => rest,
            Combine::Replace if permits == Share::All && rest == Share::All => Share::All,
            Combine::Replace if asks == Share::None && rest == Share::None => Share::None,
            Combine::Replace => Share::Some,
        };
        (share, cut.or(rest_cut))
    }
}

/// Returns whether the finest of some pixels counts everywhere, and nothing else.
fn has_pixels_only(layers: &[CompiledLayer], spec: &SizeFieldSpec) -> bool {
    let is_one = |layer: &CompiledLayer| layer.is_plain() && layer.has_pixels_only();
    spec.gradation.is_none() && layers.iter().all(is_one)
}
