use crate::field::Formula;

/// Identifies a layer within a document, as long as the document exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LayerId(pub u32);

/// One layer of the size field.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Which layer it is.
    pub id: LayerId,
    /// What a person calls it.
    pub name: String,
    /// A hidden layer asks for nothing.
    pub visible: bool,
    /// A locked layer cannot be edited.
    pub locked: bool,
    /// How it is combined with the layers below.
    pub combine: Combine,
    /// What it asks for.
    pub kind: LayerKind,
}

/// How a layer is combined with the result of the layers below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// The smaller target diameter counts.
    Finest,
    /// Nothing below the layer gets finer than it asks for.
    Floor,
    /// The layer alone counts, wherever it asks for anything.
    Replace,
}

/// What the values of a layer mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Risk, 0 to 1; the transfer curve turns it into a target diameter.
    Risk,
    /// Target diameter in world units.
    Diameter,
}

/// What a layer asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerKind {
    /// What is painted; the document holds the pixels.
    Paint(Quantity),
    /// A formula in x and y.
    Formula {
        /// What its value means.
        quantity: Quantity,
        /// The formula.
        formula: Formula,
    },
}
