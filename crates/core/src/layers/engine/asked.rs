//! Answers about all points of a rectangle at once.

/// The share of the points of a rectangle at which a condition is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// The condition is true at no point.
    None,
    /// The condition is true at some points, or the share is unknown.
    Some,
    /// The condition is true at every point.
    All,
}

impl Share {
    /// `None` or `All`.
    #[inline]
    pub fn of(holds: bool) -> Self {
        if holds { Self::All } else { Self::None }
    }

    /// Returns the answer within a mask that covers some of the points.
    #[inline]
    pub fn masked(self) -> Self {
        if self == Self::None { Self::None } else { Self::Some }
    }

    /// Returns the share of the points at which either condition is true.
    #[inline]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, _) | (_, Self::All) => Self::All,
            (Self::None, Self::None) => Self::None,
            _ => Self::Some,
        }
    }

    /// Returns the share of the points at which both conditions are true.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, _) | (_, Self::None) => Self::None,
            (Self::All, Self::All) => Self::All,
            _ => Self::Some,
        }
    }

    /// Returns the share of the points at which the condition is not true.
    #[inline]
    pub fn not(self) -> Self {
        match self {
            Self::None => Self::All,
            Self::Some => Self::Some,
            Self::All => Self::None,
        }
    }
}
