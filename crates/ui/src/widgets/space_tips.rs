//! Sentences of the controls of the view in space, as [`tips`](super::tips) has them.

/// The sentences, by the name of the control.
pub(super) static SENTENCES: &[(&str, &str)] = &[
    (
        "In space",
        "Shows the mesh as a surface, with the heights of layers of surfaces or of depths[; {in-space} switches].",
    ),
    (
        "Heights ×",
        "The factor for heights in space. In documents in kilometres or degrees, 1 is true for heights in metres.",
    ),
    (
        "Look to",
        "The direction in which one looks in space, clockwise from the y axis: at 0 north is at the top.",
    ),
    ("From above", "How high the viewer stands above the horizon: 90° is the view of the plan."),
    ("Light from", "Where the light comes from, clockwise from the y axis."),
    ("Light above", "How high the light stands above the horizon: a low one shows small slopes."),
];
