//! What the brush paints, and how.

use meshbrush_core::layers::Quantity;

/// The kind of paint of the brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintKind {
    /// Risk, which the transfer curve turns into a diameter.
    Risk,
    /// The target diameter itself.
    Diameter,
    /// The largest error from surfaces.
    Error,
}

impl PaintKind {
    /// Returns the kind of paint of a layer with this quantity.
    pub fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Risk => Self::Risk,
            Quantity::Diameter => Self::Diameter,
            Quantity::Error => Self::Error,
        }
    }

    /// Returns the quantity of layers that take this paint.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Risk => Quantity::Risk,
            Self::Diameter => Quantity::Diameter,
            Self::Error => Quantity::Error,
        }
    }
}

/// How a stroke of the brush changes the paint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrushMode {
    /// Raises the risk, with each stroke by the strength; makes the painted diameter smaller, never larger.
    BuildUp,
    /// Gives risk or diameter one value, from below and from above.
    Set,
    /// Lowers the risk, with each stroke by the strength; makes the painted diameter larger, never smaller.
    Lower,
}

impl BrushMode {
    /// All modes with their names, in the order of the panel.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::BuildUp, "Build up"), (Self::Set, "Set"), (Self::Lower, "Lower")];
}
