//! Gestures of the pointer. The list of keys shows all of them, the menu Tool those that are hard to find.

/// The tool or control with which a gesture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// With the brush or the eraser.
    Painting,
    /// With the query tool.
    Querying,
    /// With the threats tool.
    Threats,
    /// On the canvas, with any tool.
    Canvas,
    /// On a number or a slider of a panel.
    Panel,
}

impl Place {
    /// Returns the heading in the list of keys.
    pub fn name(self) -> &'static str {
        match self {
            Self::Painting => "Painting with the pointer",
            Self::Querying => "Inspecting triangles",
            Self::Threats => "Threats",
            Self::Canvas => "On the canvas, with any tool",
            Self::Panel => "In the panels",
        }
    }
}

/// Something done with the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GestureHelp {
    /// The effect of the gesture.
    pub title: &'static str,
    /// The keys and the movement.
    pub keys: &'static str,
    /// Where.
    pub place: Place,
    /// The text that its entry in the menu Tool shows; empty for a gesture without an entry.
    pub advice: &'static str,
}

const fn gesture(place: Place, title: &'static str, keys: &'static str) -> GestureHelp {
    GestureHelp { title, keys, place, advice: "" }
}

impl GestureHelp {
    const fn in_menu(self, advice: &'static str) -> Self {
        Self { advice, ..self }
    }
}

/// All of them.
pub static GESTURES: [GestureHelp; 27] = [
    gesture(Place::Painting, "Paint or erase", "drag"),
    gesture(Place::Painting, "Pick the value under the pointer", "Alt+click")
        .in_menu("Hold Alt and click on the canvas: the brush takes the value under the pointer."),
    gesture(Place::Painting, "Straight line from the last point", "Shift+click").in_menu(
        "Hold Shift and click on the canvas: a straight line is painted from the last painted point.",
    ),
    gesture(Place::Painting, "Size of the brush", "Shift+drag")
        .in_menu("Hold Shift and drag sideways on the canvas: the brush becomes larger or smaller."),
    gesture(Place::Querying, "Inspect a triangle", "click"),
    gesture(Place::Querying, "Move a pin", "drag it"),
    gesture(Place::Querying, "Go to a neighbour of the triangle", "1, 2, 3"),
    gesture(Place::Querying, "Follow neighbours and keep the trail", "Shift+1, 2, 3"),
    gesture(Place::Querying, "Copy a value of the triangle", "click on it"),
    gesture(Place::Querying, "Copy all its values", "Ctrl+C"),
    gesture(Place::Threats, "Select or place a threat", "click"),
    gesture(Place::Threats, "Place a threat on another one", "Ctrl+click"),
    gesture(Place::Threats, "Place a threat with its range", "drag from a free place"),
    gesture(Place::Threats, "Move a threat or change its range", "drag its middle or its ring"),
    gesture(Place::Canvas, "Menu for a point", "right-click"),
    gesture(Place::Canvas, "Move the view", "Space+drag"),
    gesture(Place::Canvas, "Move the view", "middle-drag"),
    gesture(Place::Canvas, "Zoom at the pointer", "wheel"),
    gesture(Place::Canvas, "Zoom at the pointer", "pinch"),
    gesture(Place::Panel, "Change a number", "drag"),
    gesture(Place::Panel, "Change a number ten times finer", "Shift+drag"),
    gesture(Place::Panel, "Change the number under the pointer", "wheel"),
    gesture(Place::Panel, "Set the default", "double-click"),
    gesture(Place::Panel, "Type a number", "click"),
    gesture(Place::Panel, "Hide or show a level", "click on its row"),
    gesture(Place::Panel, "Show one level alone", "Alt+click on its row"),
    gesture(Place::Panel, "Step a number while it is typed", "Up"),
];
