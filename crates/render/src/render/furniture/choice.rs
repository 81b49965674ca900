//! Which furniture a picture has, and its names.

use std::fmt;
use std::str::FromStr;

/// What stands around the map of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Furniture {
    /// The levels: colour, diameter and number of triangles.
    pub legend: bool,
    /// A frame around the map with coordinates; in space the outline of a box, with heights as well.
    pub axes: bool,
    /// A bar of a round length.
    pub scale: bool,
    /// An arrow to the north, where the document lies on the Earth.
    pub north: bool,
}

impl Furniture {
    /// Nothing.
    pub const NONE: Self = Self { legend: false, axes: false, scale: false, north: false };
    /// Everything.
    pub const ALL: Self = Self { legend: true, axes: true, scale: true, north: true };

    /// Returns whether there is none.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    fn names(self) -> impl Iterator<Item = &'static str> {
        let Self { legend, axes, scale, north } = self;
        let named = [(legend, "legend"), (axes, "axes"), (scale, "scale"), (north, "north")];
        named.into_iter().filter_map(|(is_there, name)| is_there.then_some(name))
    }
}

/// The names, separated by commas; `none` without any.
impl fmt::Display for Furniture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.names().collect();
        f.write_str(if names.is_empty() { "none" } else { "" })?;
        f.write_str(&names.join(", "))
    }
}

/// The error for a word that names no furniture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "“{0}” is none of legend, axes, scale and north. Name some of them, with commas, or write all or none."
)]
pub struct UnknownFurniture(String);

impl FromStr for Furniture {
    type Err = UnknownFurniture;

    /// Reads names that are separated by commas, or `all`, or `none`.
    fn from_str(text: &str) -> Result<Self, UnknownFurniture> {
        match text.trim() {
            "all" => return Ok(Self::ALL),
            "none" => return Ok(Self::NONE),
            _ => {}
        }
        let mut furniture = Self::NONE;
        for name in text.split(',').map(str::trim) {
            match name {
                "legend" => furniture.legend = true,
                "axes" => furniture.axes = true,
                "scale" => furniture.scale = true,
                "north" => furniture.north = true,
                _ => return Err(UnknownFurniture(name.into())),
            }
        }
        Ok(furniture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn furniture_is_written_as_it_is_read() {
        for n in 0..16 {
            let [legend, axes, scale, north] = [1, 2, 4, 8].map(|bit| n & bit != 0);
            let furniture = Furniture { legend, axes, scale, north };
            assert_eq!(furniture.to_string().parse(), Ok(furniture));
        }
        assert_eq!("all".parse(), Ok(Furniture::ALL));
        assert_eq!(" scale , north ".parse(), Ok(Furniture { scale: true, north: true, ..Furniture::NONE }));
        for text in ["", "legend,", "Legend", "grid", "all,none"] {
            assert!(text.parse::<Furniture>().is_err(), "{text}");
        }
    }
}
