//! What is said of a layer, whatever its kind is.

/// Identifies a layer within a document, as long as the document exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LayerId(pub u32);

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

/// A layer in its stack, whatever its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerSlot {
    /// Which layer it is.
    pub id: LayerId,
    /// How it is combined with the layers below.
    pub combine: Combine,
}
