//! Answers about all points of a rectangle at once.

/// Whether a condition is true at the points of a rectangle, in the three-valued logic of Kleene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ternary {
    /// The condition is true at no point.
    Never,
    /// The condition is true at some points, or may be.
    Maybe,
    /// The condition is true at every point.
    Always,
}

impl Ternary {
    /// Returns `Always` where it holds, and else `Never`.
    #[inline]
    pub fn of(holds: bool) -> Self {
        if holds { Self::Always } else { Self::Never }
    }

    /// Returns the answer within a mask that covers some of the points.
    #[inline]
    pub fn masked(self) -> Self {
        if self == Self::Never { Self::Never } else { Self::Maybe }
    }

    /// Returns the share of the points at which either condition is true.
    #[inline]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Always, _) | (_, Self::Always) => Self::Always,
            (Self::Never, Self::Never) => Self::Never,
            _ => Self::Maybe,
        }
    }

    /// Returns the share of the points at which both conditions are true.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, _) | (_, Self::Never) => Self::Never,
            (Self::Always, Self::Always) => Self::Always,
            _ => Self::Maybe,
        }
    }

    /// Returns the share of the points at which the condition is not true.
    #[inline]
    pub fn not(self) -> Self {
        match self {
            Self::Never => Self::Always,
            Self::Maybe => Self::Maybe,
            Self::Always => Self::Never,
        }
    }
}
