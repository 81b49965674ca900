//! Gestures of drawing regions.

use meshbrush_kit::kit::{GestureHelp, GesturePlace};

/// What can be done with the pointer while the region tool is selected.
pub static GESTURES: [GestureHelp; 7] = [
    GestureHelp::new(GesturePlace::Regions, "Paint a region", "drag with the brush"),
    GestureHelp::new(GesturePlace::Regions, "Draw a square instead of a rectangle", "Shift+drag"),
    GestureHelp::new(GesturePlace::Regions, "Fill a hole of a region", "click with Fill"),
    GestureHelp::new(GesturePlace::Regions, "Cut instead of adding, or the other way round", "Alt+drag"),
    GestureHelp::new(GesturePlace::Regions, "Set a corner of a polygon or a line", "click"),
    GestureHelp::new(GesturePlace::Regions, "Move a corner", "drag it"),
    GestureHelp::new(
        GesturePlace::Regions,
        "Close the polygon, or end the line",
        "double-click or right-click",
    ),
];
