/// The unit of a document's coordinates and lengths. It gives numbers their meaning; they are never
/// converted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LengthUnit {
    /// Plain numbers.
    #[default]
    None,
    /// Metres.
    Metre,
    /// Kilometres.
    Kilometre,
    /// Degrees of longitude (x) and latitude (y).
    Degree,
}

impl LengthUnit {
    /// All units, in the order of menus.
    pub const ALL: [Self; 4] = [Self::None, Self::Metre, Self::Kilometre, Self::Degree];

    /// Returns the symbol after a number; empty without a unit.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Metre => "m",
            Self::Kilometre => "km",
            Self::Degree => "°",
        }
    }

    /// Returns the name in menus and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Metre => "m",
            Self::Kilometre => "km",
            Self::Degree => "degrees",
        }
    }

    /// Returns whether lengths can be compared with depths in metres: plain numbers are then metres.
    pub fn may_be_metres(self) -> bool {
        matches!(self, Self::None | Self::Metre)
    }

    /// Returns a number with the symbol: `12 m`, `0.5°`.
    ///
    /// ```
    /// use meshbrush_mesh::text::LengthUnit;
    ///
    /// assert_eq!(LengthUnit::Metre.after("12"), "12 m");
    /// assert_eq!(LengthUnit::Degree.after("0.5"), "0.5°");
    /// assert_eq!(LengthUnit::None.after("0.5"), "0.5");
    /// ```
    pub fn after(self, number: &str) -> String {
        match self {
            Self::None => number.to_owned(),
            Self::Degree => format!("{number}°"),
            Self::Metre | Self::Kilometre => format!("{number} {}", self.symbol()),
        }
    }
}
