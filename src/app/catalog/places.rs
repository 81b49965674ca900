//! The sections and settings that the palette puts in sight.

use meshbrush_kit::kit::Place;

/// The places, section by section.
pub static PLACES: [Place; 27] = [
    Place::new("layers", "Layers", "").words("stack order visible hide lock"),
    Place::new("gradation", "Gradation", "Limit gradation").words("growth smooth grading slope"),
    Place::new("layers", "Selected layer", "").words("combine finest floor replace mask curve formula"),
    Place::new("transfer", "Size and risk", "").words("transfer curve risk to diameter"),
    Place::new("transfer", "Size and risk", "h_min").words("smallest finest diameter size"),
    Place::new("transfer", "Size and risk", "h_risk").words("diameter at risk one curve size"),
    Place::new("transfer", "Size and risk", "h_max").words("largest coarsest diameter size"),
    Place::new("levels", "Levels", "").words("isolate show one level alone hide legend histogram colours"),
    Place::new("mesh", "Mesh", "").words("grid settings"),
    Place::new("mesh", "Mesh", "Spacing δ").words("coarse grid cell size delta"),
    Place::new("mesh", "Mesh", "Refinement rule").words("area vertex rule"),
    Place::new("budgets", "Budgets", "Triangle budget").words("limit maximum most triangles"),
    Place::new("budgets", "Budgets", "Memory budget").words("limit maximum ram gigabytes"),
    Place::new("mesh", "Mesh", "Threads").words("cores cpu processors parallel"),
    Place::new("statistics", "Statistics", "").words("figures quality angles area fingerprint counts table"),
    Place::new("plots", "Plots", "").words("chart figure time measure experiment"),
    Place::new("domain", "Domain", "").words("extent outline coast region"),
    Place::new("domain", "Domain", "Unit").words("metres kilometres degrees length"),
    Place::new("domain", "Domain", "Left").words("bounds extent x minimum size"),
    Place::new("domain", "Domain", "Right").words("bounds extent x maximum size"),
    Place::new("domain", "Domain", "Bottom").words("bounds extent y minimum size"),
    Place::new("domain", "Domain", "Top").words("bounds extent y maximum size"),
    Place::new("domain", "Domain", "Domain where").words("formula shape region condition"),
    Place::new("background", "Background picture", "").words("trace map image opacity"),
    Place::new("path", "Path", "").words("route cost risk weight keep-out"),
    Place::new("path", "Path", "Prove within").words("certificate proof bound interval"),
    Place::new("boundary", "Boundary", "").words("pieces names markers open sides"),
];
