//! Icons by what they mean here.

use egui_material_icons::icons as material;

/// A sign of the icon font.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Icon(&'static str);

impl Icon {
    /// Picking a value.
    pub const PICK: Self = Self(material::ICON_COLORIZE.codepoint);
    /// Paint.
    pub const BRUSH: Self = Self(material::ICON_BRUSH.codepoint);
    /// Remove paint.
    pub const ERASER: Self = Self(material::ICON_INK_ERASER.codepoint);
    /// Query a point.
    pub const QUERY: Self = Self(material::ICON_MY_LOCATION.codepoint);
    /// Edit the domain.
    pub const DOMAIN: Self = Self(material::ICON_HEXAGON.codepoint);
    /// Draw regions.
    pub const REGION: Self = Self(material::ICON_LASSO_SELECT.codepoint);
    /// Name the boundary.
    pub const BOUNDARY: Self = Self(material::ICON_LABEL.codepoint);
    /// Move the view.
    pub const PATH: Self = Self(material::ICON_ROUTE.codepoint);
    /// The pan tool.
    pub const PAN: Self = Self(material::ICON_DRAG_PAN.codepoint);
    /// Show all of the domain.
    pub const FIT: Self = Self(material::ICON_FIT_SCREEN.codepoint);
    /// Undo.
    pub const UNDO: Self = Self(material::ICON_UNDO.codepoint);
    /// Redo.
    pub const REDO: Self = Self(material::ICON_REDO.codepoint);
    /// A section that is open.
    pub const OPENED: Self = Self(material::ICON_KEYBOARD_ARROW_DOWN.codepoint);
    /// A section that is closed.
    pub const CLOSED: Self = Self(material::ICON_KEYBOARD_ARROW_RIGHT.codepoint);
    /// Dismiss.
    pub const CLOSE: Self = Self(material::ICON_CLOSE.codepoint);
    /// Done, or switched on.
    pub const CHECK: Self = Self(material::ICON_CHECK.codepoint);
    /// Something failed.
    pub const ERROR: Self = Self(material::ICON_ERROR.codepoint);
    /// Something to know.
    pub const INFO: Self = Self(material::ICON_INFO.codepoint);
    /// Search.
    pub const SEARCH: Self = Self(material::ICON_SEARCH.codepoint);
    /// A folder.
    pub const FOLDER: Self = Self(material::ICON_FOLDER.codepoint);
    /// A file.
    pub const FILE: Self = Self(material::ICON_DRAFT.codepoint);
    /// The folder above, or move up.
    pub const UP: Self = Self(material::ICON_ARROW_UPWARD.codepoint);
    /// Add.
    pub const ADD: Self = Self(material::ICON_ADD.codepoint);
    /// Make a copy.
    pub const COPY: Self = Self(material::ICON_CONTENT_COPY.codepoint);
    /// Delete.
    pub const DELETE: Self = Self(material::ICON_DELETE.codepoint);
    /// Move down.
    pub const DOWN: Self = Self(material::ICON_ARROW_DOWNWARD.codepoint);
    /// Shown.
    pub const VISIBLE: Self = Self(material::ICON_VISIBILITY.codepoint);
    /// Something shown in place of the colours of levels.
    pub const OVERLAY: Self = Self(material::ICON_LAYERS.codepoint);
    /// Hidden.
    pub const HIDDEN: Self = Self(material::ICON_VISIBILITY_OFF.codepoint);
    /// Cannot be edited.
    pub const LOCKED: Self = Self(material::ICON_LOCK.codepoint);
    /// Can be edited.
    pub const UNLOCKED: Self = Self(material::ICON_LOCK_OPEN_RIGHT.codepoint);
    /// A layer of a formula.
    pub const FORMULA: Self = Self(material::ICON_FUNCTION.codepoint);
    /// A layer of a raster.
    pub const RASTER: Self = Self(material::ICON_GRID_ON.codepoint);
    /// A layer of threats.
    pub const THREATS: Self = Self(material::ICON_RADAR.codepoint);
    /// A layer of a distance.
    pub const DISTANCE: Self = Self(material::ICON_STRAIGHTEN.codepoint);
    /// A layer of depths.
    pub const DEPTH: Self = Self(material::ICON_WAVES.codepoint);
    /// A layer of straits.
    pub const STRAITS: Self = Self(material::ICON_WIDTH.codepoint);
    /// A layer of the width of the water.
    pub const FEATURE_SIZE: Self = Self(material::ICON_ARROW_RANGE.codepoint);
    /// A layer of a surface.
    pub const SURFACE: Self = Self(material::ICON_LANDSCAPE.codepoint);
    /// A layer of a band of values.
    pub const BAND: Self = Self(material::ICON_LINE_WEIGHT.codepoint);
    /// The first of many.
    pub const FIRST: Self = Self(material::ICON_FIRST_PAGE.codepoint);
    /// One back.
    pub const BACK: Self = Self(material::ICON_CHEVRON_LEFT.codepoint);
    /// Goes forwards by itself.
    pub const PLAY: Self = Self(material::ICON_PLAY_ARROW.codepoint);
    /// Stops for a while.
    pub const PAUSE: Self = Self(material::ICON_PAUSE.codepoint);
    /// One forwards.
    pub const FORWARD: Self = Self(material::ICON_CHEVRON_RIGHT.codepoint);
    /// The last of many.
    pub const LAST: Self = Self(material::ICON_LAST_PAGE.codepoint);
    /// More options.
    pub const TUNE: Self = Self(material::ICON_TUNE.codepoint);
    /// The home folder.
    pub const HOME: Self = Self(material::ICON_HOME.codepoint);

    /// Returns the text that draws it, in the family [`crate::app::theme::font::ICONS`].
    pub const fn glyph(self) -> &'static str {
        self.0
    }
}
