//! Answers about all points of a rectangle at once.

/// At how many points of a rectangle something is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// At no point.
    None,
    /// At some points, or it is not known.
    Some,
    /// At every point.
    All,
}

impl Share {
    /// `None` or `All`.
    #[inline]
    pub fn of(holds: bool) -> Self {
        if holds { Self::All } else { Self::None }
    }

    /// The same within a mask that covers some of the points.
    #[inline]
    pub fn masked(self) -> Self {
        if self == Self::None { Self::None } else { Self::Some }
    }

    /// Where either is true.
    #[inline]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, _) | (_, Self::All) => Self::All,
            (Self::None, Self::None) => Self::None,
            _ => Self::Some,
        }
    }

    /// Where both are true.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, _) | (_, Self::None) => Self::None,
            (Self::All, Self::All) => Self::All,
            _ => Self::Some,
        }
    }

    /// Where it is not true.
    #[inline]
    pub fn not(self) -> Self {
        match self {
            Self::None => Self::All,
            Self::Some => Self::Some,
            Self::All => Self::None,
        }
    }
}
