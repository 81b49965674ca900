//! Icons by what they mean here: code points of Material Symbols Rounded. `assets/fonts/make.py` makes the
//! font from these, so it must be run after a change.

/// A sign of the icon font.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Icon(&'static str);

impl Icon {
    /// Picking a value.
    pub const PICK: Self = Self("\u{e3b8}");
    /// Paint.
    pub const BRUSH: Self = Self("\u{e3ae}");
    /// Remove paint.
    pub const ERASER: Self = Self("\u{e6d0}");
    /// Query a point.
    pub const QUERY: Self = Self("\u{e55c}");
    /// Edit the domain.
    pub const DOMAIN: Self = Self("\u{eb39}");
    /// Draw regions.
    pub const REGION: Self = Self("\u{eb03}");
    /// Draw lines.
    pub const LINE: Self = Self("\u{e922}");
    /// Name the boundary.
    pub const BOUNDARY: Self = Self("\u{e893}");
    /// Move the view.
    pub const PATH: Self = Self("\u{eacd}");
    /// The pan tool.
    pub const PAN: Self = Self("\u{f71e}");
    /// Show all of the domain.
    pub const FIT: Self = Self("\u{ea10}");
    /// Undo.
    pub const UNDO: Self = Self("\u{e166}");
    /// Redo.
    pub const REDO: Self = Self("\u{e15a}");
    /// A section that is open.
    pub const OPENED: Self = Self("\u{e313}");
    /// A section that is closed.
    pub const CLOSED: Self = Self("\u{e315}");
    /// Dismiss.
    pub const CLOSE: Self = Self("\u{e5cd}");
    /// Done, or switched on.
    pub const CHECK: Self = Self("\u{e668}");
    /// Something failed.
    pub const ERROR: Self = Self("\u{f8b6}");
    /// Something to know.
    pub const INFO: Self = Self("\u{e88e}");
    /// Search.
    pub const SEARCH: Self = Self("\u{ef7a}");
    /// A folder.
    pub const FOLDER: Self = Self("\u{e2c7}");
    /// A file.
    pub const FILE: Self = Self("\u{e66d}");
    /// The folder above, or move up.
    pub const UP: Self = Self("\u{e5d8}");
    /// Add.
    pub const ADD: Self = Self("\u{e145}");
    /// Make a copy.
    pub const COPY: Self = Self("\u{e14d}");
    /// Delete.
    pub const DELETE: Self = Self("\u{e92e}");
    /// Move down.
    pub const DOWN: Self = Self("\u{e5db}");
    /// Shown.
    pub const VISIBLE: Self = Self("\u{e8f4}");
    /// Something shown in place of the colours of levels.
    pub const OVERLAY: Self = Self("\u{e53b}");
    /// Hidden.
    pub const HIDDEN: Self = Self("\u{e8f5}");
    /// Cannot be edited.
    pub const LOCKED: Self = Self("\u{e899}");
    /// Can be edited.
    pub const UNLOCKED: Self = Self("\u{f656}");
    /// A layer of a formula.
    pub const FORMULA: Self = Self("\u{f866}");
    /// A layer of a raster.
    pub const RASTER: Self = Self("\u{e3ec}");
    /// A layer of threats.
    pub const THREATS: Self = Self("\u{f04e}");
    /// A layer of a distance.
    pub const DISTANCE: Self = Self("\u{e41c}");
    /// A layer of depths.
    pub const DEPTH: Self = Self("\u{e176}");
    /// A layer of straits.
    pub const STRAITS: Self = Self("\u{f730}");
    /// A layer of the width of the water.
    pub const FEATURE_SIZE: Self = Self("\u{f69b}");
    /// A layer of a surface.
    pub const SURFACE: Self = Self("\u{e564}");
    /// A layer of a band of values.
    pub const BAND: Self = Self("\u{e91a}");
    /// The first of many.
    pub const FIRST: Self = Self("\u{e5dc}");
    /// One back.
    pub const BACK: Self = Self("\u{e5cb}");
    /// Goes forwards by itself.
    pub const PLAY: Self = Self("\u{e037}");
    /// Stops for a while.
    pub const PAUSE: Self = Self("\u{e034}");
    /// One forwards.
    pub const FORWARD: Self = Self("\u{e5cc}");
    /// The last of many.
    pub const LAST: Self = Self("\u{e5dd}");
    /// More options.
    pub const TUNE: Self = Self("\u{e429}");
    /// The home folder.
    pub const HOME: Self = Self("\u{e9b2}");

    /// Returns the text that draws it, in the family [`crate::theme::font::ICONS`].
    pub const fn glyph(self) -> &'static str {
        self.0
    }
}
