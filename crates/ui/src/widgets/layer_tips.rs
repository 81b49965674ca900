//! Sentences of the controls of layers, as [`tips`](super::tips) has them.

/// The sentences, by the name of the control.
pub(super) static SENTENCES: &[(&str, &str)] = &[
    ("What the formula gives/Diameter", "The formula gives the target diameter itself."),
    (
        "What the formula gives/Risk",
        "The formula gives the risk, from 0 to 1, which the transfer curve turns into a diameter.",
    ),
    (
        "What the formula gives/Error",
        "The formula gives the largest error from surfaces, in place of that of their layers.",
    ),
    (
        "What the values mean/Error",
        "The raster holds the largest error from surfaces, in place of that of their layers.",
    ),
    ("What the values mean/Diameter", "The raster holds target diameters, in the unit of the document."),
    ("What the values mean/Risk", "The raster holds risk, from 0 to 1."),
    ("What the values mean/Curve", "A curve gives the target diameter for each value of the raster."),
    (
        "Curve of the values",
        "The target diameter for each value of the raster; behind it, how often each value occurs. A click adds a knot.",
    ),
    ("Values are/Heights", "The raster holds heights in metres: water is below 0."),
    ("Values are/Depths", "The raster holds depths of water in metres, above 0."),
    ("Size by/Nothing", "The layer asks for no diameter: exported files get its depths at the nodes."),
    ("Size by/Wavelength", "A number of triangles in the length of a wave, which grows with the depth."),
    (
        "Size by/Bottom slope",
        "A number of triangles in the topographic length, 2π times the depth by the slope.",
    ),
    ("Size by/Time step", "The diameter at which a wave has a Courant number in a time step of a solver."),
    ("Only between two depths", "Shallower and deeper water asks for nothing."),
    ("Leave out open boundaries", "Only coasts count, and no open part of the boundary."),
    ("Only some pieces", "The distance is that to pieces of the boundary, by their types and names."),
    ("Use outline", "Measures the distance to the outline of the domain again."),
    (
        "Use the contour as the domain",
        "The water of this layer becomes the domain, as far as it is in the bounds of the document.",
    ),
    (
        "Use the area with values as the domain",
        "Pixels without a value are outside the domain, as far as they are in the bounds of the document.",
    ),
    ("Limit the range", "Beyond a distance of your choice the layer asks for nothing."),
];
