//! Gestures of the pointer. The list of keys shows all of them, the menu Tool those that are hard to find.

use crate::app::features::ROWS;
use meshbrush_kit::kit::{GestureHelp, GesturePlace};

/// Returns all of them, by their places.
pub fn gestures() -> Vec<&'static GestureHelp> {
    let of_features = ROWS.iter().flat_map(|row| row.gestures);
    let mut all: Vec<_> = GESTURES.iter().chain(of_features).collect();
    all.sort_by_key(|gesture| gesture.place);
    all
}

/// Those that belong to no feature.
static GESTURES: [GestureHelp; 29] = [
    GestureHelp::new(GesturePlace::Querying, "Inspect a triangle", "click"),
    GestureHelp::new(GesturePlace::Querying, "Move a pin", "drag it"),
    GestureHelp::new(GesturePlace::Querying, "Go to a neighbour of the triangle", "1, 2, 3"),
    GestureHelp::new(GesturePlace::Querying, "Follow neighbours and keep the trail", "Shift+1, 2, 3"),
    GestureHelp::new(GesturePlace::Querying, "Copy a value of the triangle", "click on it"),
    GestureHelp::new(GesturePlace::Querying, "Copy all its values", "Ctrl+C"),
    GestureHelp::new(GesturePlace::Threats, "Select or place a threat", "click"),
    GestureHelp::new(GesturePlace::Threats, "Place a threat on another one", "Ctrl+click"),
    GestureHelp::new(GesturePlace::Threats, "Place a threat with its range", "drag from a free place"),
    GestureHelp::new(
        GesturePlace::Threats,
        "Move a threat or change its range",
        "drag its middle or its ring",
    ),
    GestureHelp::new(GesturePlace::Canvas, "Menu for a point", "right-click"),
    GestureHelp::new(GesturePlace::Canvas, "Move the view", "Space+drag"),
    GestureHelp::new(GesturePlace::Canvas, "Move the view", "middle-drag"),
    GestureHelp::new(GesturePlace::Canvas, "Turn the view in space", "Space+drag"),
    GestureHelp::new(GesturePlace::Canvas, "Turn the view in space", "middle-drag"),
    GestureHelp::new(GesturePlace::Canvas, "Move the view in space", "Shift+middle-drag"),
    GestureHelp::new(GesturePlace::Canvas, "Zoom at the pointer", "wheel"),
    GestureHelp::new(GesturePlace::Canvas, "Zoom at the pointer", "pinch"),
    GestureHelp::new(GesturePlace::Canvas, "Move the view while the canvas has the focus", "arrow keys"),
    GestureHelp::new(GesturePlace::Panel, "Change a number", "drag"),
    GestureHelp::new(GesturePlace::Panel, "Change a number ten times finer", "Shift+drag"),
    GestureHelp::new(GesturePlace::Panel, "Scroll", "wheel"),
    GestureHelp::new(GesturePlace::Panel, "Change the number under the pointer", "Ctrl+wheel"),
    GestureHelp::new(GesturePlace::Panel, "Type a number", "click"),
    GestureHelp::new(GesturePlace::Panel, "Type a number beside a slider or a curve", "double-click"),
    GestureHelp::new(GesturePlace::Panel, "Set the default, copy or paste a number", "right-click"),
    GestureHelp::new(GesturePlace::Panel, "Hide or show a level", "click on its row"),
    GestureHelp::new(GesturePlace::Panel, "Show one level alone", "Alt+click on its row"),
    GestureHelp::new(GesturePlace::Panel, "Step a number while it is typed", "Up"),
];
