//! The tool in hand and the brush as the user set it.

use crate::paint::{Brush, Medium};

/// What the primary button does on the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Paints.
    Brush,
    /// Takes paint away.
    Eraser,
    /// Asks about a point.
    Query,
    /// Adds to the domain or takes away from it, or draws its rectangle.
    Domain,
    /// Moves the view.
    Pan,
}

/// What the brush paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintKind {
    /// Risk, turned into a diameter by the transfer curve.
    Risk,
    /// The target diameter itself.
    Diameter,
}

/// What the domain tool cuts with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DomainToolMode {
    /// The brush ring.
    Brush,
    /// A rectangle from corner to corner.
    Rectangle,
    /// A polygon, corner by corner.
    Polygon,
    /// The rectangle that the coarse grid covers: nothing is cut.
    Frame,
}

/// The tool in hand, and the brush that painting and erasing share.
#[derive(Clone, Debug, PartialEq)]
pub struct Tools {
    /// The tool in hand.
    pub tool: Tool,
    /// What the brush paints.
    pub kind: PaintKind,
    /// Radius of brush and eraser in world units.
    pub radius: f64,
    /// Hardness of brush and eraser, 0 to 1.
    pub hardness: f64,
    /// Strength of the brush, 0 to 1.
    pub paint_strength: f64,
    /// Strength of the eraser, 0 to 1.
    pub erase_strength: f64,
    /// The diameter that the brush paints, in world units.
    pub diameter: f64,
    /// What the domain tool cuts with.
    pub domain_shape: DomainToolMode,
    /// Whether it adds to the domain, or takes away.
    pub domain_adds: bool,
}

impl Tools {
    /// A brush that suits a domain whose longer side is `extent` and whose smallest diameter is `h_min`, in world units.
    pub fn for_domain(extent: f64, h_min: f64) -> Self {
        Self {
            tool: Tool::Brush,
            kind: PaintKind::Risk,
            radius: 0.06 * extent,
            hardness: 0.35,
            paint_strength: 0.8,
            erase_strength: 1.0,
            diameter: 2.0 * h_min,
            domain_shape: DomainToolMode::Brush,
            domain_adds: false,
        }
    }

    /// Whether the tool in hand works with the brush ring.
    pub fn has_ring(&self) -> bool {
        self.paints() || (self.tool == Tool::Domain && self.domain_shape == DomainToolMode::Brush)
    }

    /// Whether the tool in hand changes the paint.
    pub fn paints(&self) -> bool {
        matches!(self.tool, Tool::Brush | Tool::Eraser)
    }

    /// Strength of the tool in hand.
    pub fn strength(&self) -> f64 {
        if self.tool == Tool::Eraser { self.erase_strength } else { self.paint_strength }
    }

    /// Strength of the tool in hand, to be changed.
    pub fn strength_mut(&mut self) -> &mut f64 {
        if self.tool == Tool::Eraser { &mut self.erase_strength } else { &mut self.paint_strength }
    }

    /// The brush that a stroke of the tool in hand is made with.
    pub fn brush(&self) -> Brush {
        let medium = match (self.tool, self.kind) {
            (Tool::Eraser, _) => Medium::Eraser,
            (_, PaintKind::Risk) => Medium::Risk,
            (_, PaintKind::Diameter) => Medium::Diameter(self.diameter),
        };
        // A painted diameter is a length and not a share: strength would make it another length.
        let strength = if matches!(medium, Medium::Diameter(_)) { 1.0 } else { self.strength() };
        Brush { medium, radius: self.radius, hardness: self.hardness, strength }
    }
}
