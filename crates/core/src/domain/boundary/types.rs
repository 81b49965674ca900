//! What a piece of the boundary is for a solver.

/// What a piece of the boundary is for a solver.
///
/// Land and inflows differ in how a solver treats the flow there. The default way has no word of its own: the
/// flow across the boundary is set, and the flow along it is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BoundaryType {
    /// The sea goes on.
    Open,
    /// No water flows across.
    Land,
    /// No water flows across, and none along the boundary.
    NoSlipLand,
    /// No water flows across, as a natural boundary condition.
    NaturalLand,
    /// A given flow comes in, as at the mouth of a river.
    Inflow,
    /// A given flow comes in, at right angles to the boundary.
    NoSlipInflow,
    /// A given flow comes in, as a natural boundary condition.
    NaturalInflow,
}

impl BoundaryType {
    /// All types.
    pub const ALL: [Self; 7] = [
        Self::Open,
        Self::Land,
        Self::NoSlipLand,
        Self::NaturalLand,
        Self::Inflow,
        Self::NoSlipInflow,
        Self::NaturalInflow,
    ];

    /// The words of all types, in their order.
    pub const WORDS: [&'static str; 7] =
        ["open", "land", "no-slip land", "natural land", "inflow", "no-slip inflow", "natural inflow"];

    /// Returns the word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// Returns the type of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|boundary_type| boundary_type.word() == word)
    }

    /// Returns the type that a name asks for: open or land where it begins with that word, in upper or lower
    /// case.
    pub fn from_name(name: &str) -> Option<Self> {
        let begins =
            |word: &str| name.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
        [Self::Open, Self::Land].into_iter().find(|of_name| begins(of_name.word()))
    }

    /// Returns whether the sea goes on.
    pub fn is_open(self) -> bool {
        self == Self::Open
    }

    /// Returns whether water flows across: where the sea goes on, and at an inflow.
    pub fn lets_water_through(self) -> bool {
        !matches!(self, Self::Land | Self::NoSlipLand | Self::NaturalLand)
    }
}
