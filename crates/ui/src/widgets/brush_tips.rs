//! Sentences of the controls of the brush, as [`tips`](super::tips) has them.

/// The sentences, by the name of the control.
pub(super) static SENTENCES: &[(&str, &str)] = &[
    (
        "What the brush paints/Risk",
        "The brush paints risk, from 0 to 1, which the transfer curve turns into a diameter.",
    ),
    ("What the brush paints/Diameter", "The brush paints the target diameter itself."),
    ("What the brush paints/Error", "The brush paints the largest error from surfaces, in their unit."),
    (
        "How a stroke changes the paint/Build up",
        "Each stroke raises the risk, or only refines where a diameter is painted[; {build-up}].",
    ),
    (
        "How a stroke changes the paint/Set",
        "A stroke paints one value, whatever was painted there[; {set-the-value}].",
    ),
    (
        "How a stroke changes the paint/Lower",
        "A stroke takes a share of the risk away, or makes painted diameters larger[; {lower}].",
    ),
    ("Mirrored x, y", "Strokes are repeated left and right, above and below; a click stops that."),
    ("Mirrored x", "Strokes are repeated left and right of the middle of the domain; a click stops that."),
    ("Mirrored y", "Strokes are repeated above and below the middle of the domain; a click stops that."),
    (
        "Preset",
        "A brush under a name: radius, hardness, strength, what it paints, and how a pen changes it. More options keeps one.",
    ),
    (
        "Keep the brush as a preset",
        "Keeps radius, hardness, strength and what is painted under a name, from run to run.",
    ),
    ("Remove the preset", "Removes the preset from the list; the brush stays as it is."),
    ("Mirror x", "Repeats strokes left and right of the middle of the domain."),
    ("Mirror y", "Repeats strokes above and below the middle of the domain."),
    ("Pen: radius", "The pressure of the pen changes the radius of the brush."),
    ("Pen: strength", "The pressure of the pen changes the strength of the brush."),
];
