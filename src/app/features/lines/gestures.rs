//! Gestures of drawing lines.

use meshbrush_kit::kit::{GestureHelp, GesturePlace};

/// What can be done with the pointer while the line tool is selected.
pub static GESTURES: [GestureHelp; 7] = [
    GestureHelp::new(GesturePlace::Lines, "Set a corner of a line", "click"),
    GestureHelp::new(GesturePlace::Lines, "End the line", "double-click or right-click"),
    GestureHelp::new(GesturePlace::Lines, "Close the line", "click on its first corner"),
    GestureHelp::new(GesturePlace::Lines, "No snapping, or the opposite", "Alt+click"),
    GestureHelp::new(GesturePlace::Lines, "Follow the deepest way", "click its ends with Deepest way"),
    GestureHelp::new(GesturePlace::Lines, "Move a corner of the selected line", "drag it with Move corners"),
    GestureHelp::new(
        GesturePlace::Lines,
        "Set another corner of the selected line",
        "drag a place on it with Move corners",
    ),
];
