//! The coordinates of a mesh in exported files, of a document in the plane of a projection.

use meshbrush_io::io::ThirdCoordinate;
use meshbrush_render::render::export::ExportFormat;

/// What a person wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FileCoordinates {
    /// Longitudes and latitudes, or the plane where the format needs lengths.
    #[default]
    ByFormat,
    /// Longitudes and latitudes.
    Geographic,
    /// The plane of the projection, in metres.
    Plane,
}

impl FileCoordinates {
    /// All of them, with the words for a list.
    pub const ALL: [(Self, &str); 3] = [
        (Self::ByFormat, "As the format has them"),
        (Self::Geographic, "Longitude and latitude"),
        (Self::Plane, "Plane of the document, in m"),
    ];

    /// Returns whether the files of a format are in the plane. Models in space, with lengths along all axes,
    /// always are.
    pub fn is_plane(self, format: ExportFormat, has_heights: bool) -> bool {
        let is_model = format.third_coordinate() == ThirdCoordinate::Model && has_heights;
        is_model || self == Self::Plane || (self == Self::ByFormat && format.needs_lengths())
    }

    /// Returns the word that the next run finds it by.
    pub fn word(self) -> &'static str {
        match self {
            Self::ByFormat => "by format",
            Self::Geographic => "lonlat",
            Self::Plane => "plane",
        }
    }

    /// Returns the one of a word.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().map(|(coordinates, _)| coordinates).find(|it| it.word() == word)
    }
}
