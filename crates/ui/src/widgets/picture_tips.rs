//! Sentences of the choices for exported pictures, as [`tips`](super::tips) has them.

/// The sentences, by the name of the control.
pub(super) static SENTENCES: &[(&str, &str)] = &[
    ("Width in/Pixels", "Pictures have a width in pixels, for screens."),
    ("Width in/Millimetres", "Pictures have a width on paper, and so many pixels of an inch."),
    (
        "Pixels wide",
        "The width of a picture with everything around its map; the height follows from the domain.",
    ),
    ("Width on paper", "The width of a picture on paper with everything around its map."),
    (
        "Dots per inch",
        "How many pixels an inch of paper has: 300 for print. Texts have 8 points where there is room.",
    ),
    ("Ground of pictures/As shown", "The ground of the canvas, dark or light."),
    ("Ground of pictures/White", "A white ground, with lines, texts and levels in the colours of paper."),
    ("Ground of pictures/Transparent", "No ground, with lines, texts and levels in the colours of paper."),
    ("Legend of levels", "Shows colour, diameter and number of triangles of each level beside the map."),
    ("Axes", "Frames the map with coordinates as the canvas has them; a view in space has none."),
    ("Scale", "Shows a bar of a round length, on the Earth as it is on the ground in the middle of the map."),
    ("North arrow", "Shows the direction to the north beside the map, where the document lies on the Earth."),
];
