//! Gestures of painting.

use meshbrush_kit::kit::{GestureHelp, GesturePlace};

/// What can be done with the pointer while the brush or the eraser is selected.
pub static GESTURES: [GestureHelp; 4] = [
    GestureHelp::new(GesturePlace::Painting, "Paint or erase", "drag"),
    GestureHelp::new(GesturePlace::Painting, "Pick the value under the pointer", "Alt+click")
        .in_menu("Hold Alt and click on the canvas: the brush takes the value under the pointer."),
    GestureHelp::new(GesturePlace::Painting, "Straight line from the last point", "Shift+click").in_menu(
        "Hold Shift and click on the canvas: a straight line is painted from the last painted point.",
    ),
    GestureHelp::new(GesturePlace::Painting, "Size of the brush", "Shift+drag")
        .in_menu("Hold Shift and drag sideways on the canvas: the brush becomes larger or smaller."),
];
