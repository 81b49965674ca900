//! The sections and settings that the palette puts in sight.

use meshbrush_kit::kit::DockPlace;

/// The places, section by section.
pub static PLACES: &[DockPlace] = &[
    DockPlace::new("layers", "Layers", "").words("stack order visible hide lock"),
    DockPlace::new("gradation", "Gradation", "Limit gradation").words("growth smooth grading slope"),
    DockPlace::new("layers", "Selected layer", "").words("combine finest floor replace mask curve formula"),
    DockPlace::new("transfer", "Size and risk", "").words("transfer curve risk to diameter"),
    DockPlace::new("transfer", "Size and risk", "h_min").words("smallest finest diameter size"),
    DockPlace::new("transfer", "Size and risk", "h_risk").words("diameter at risk one curve size"),
    DockPlace::new("transfer", "Size and risk", "h_max").words("largest coarsest diameter size"),
    DockPlace::new("levels", "Levels", "")
        .words("isolate show one level alone hide legend histogram colours"),
    DockPlace::new("mesh", "Mesh", "").words("grid settings"),
    DockPlace::new("mesh", "Mesh", "Spacing δ").words("coarse grid cell size delta"),
    DockPlace::new("mesh", "Mesh", "Refinement rule").words("area vertex rule"),
    DockPlace::new("budgets", "Budgets", "Triangle budget").words("limit maximum most triangles"),
    DockPlace::new("budgets", "Budgets", "Deepest level").words("max level limit bisections refinement"),
    DockPlace::new("budgets", "Budgets", "Memory budget").words("limit maximum ram gigabytes"),
    DockPlace::new("mesh", "Mesh", "Threads").words("cores cpu processors parallel"),
    DockPlace::new("statistics", "Statistics", "").words("figures area fingerprint counts table parts"),
    DockPlace::new("statistics", "Statistics", "Shortest edge").words("quality minimum smallest narrowest"),
    DockPlace::new("statistics", "Statistics", "Longest edge").words("quality maximum largest widest"),
    DockPlace::new("statistics", "Statistics", "Gradation").words("quality growth size change neighbours"),
    DockPlace::new("quality", "Quality", "").words(
        "figures angles bad elements histogram worst check skewness aspect ratio slivers narrowest strait widest \
         cfl courant number time step stability solver valence degree triangles at a node connectivity orthogonality flow links circumcentre",
    ),
    DockPlace::new("quality", "Quality", "Smallest angle")
        .words("quality bad elements skewness sliver slivers thin minimum narrowest"),
    DockPlace::new("quality", "Quality", "Largest angle")
        .words("quality bad elements skewness obtuse maximum widest"),
    DockPlace::new("quality", "Quality", "Edge ratio")
        .words("quality bad elements aspect ratio skewness sliver slivers stretched longest shortest"),
    DockPlace::new("quality", "Quality", "Longest edge / h̄")
        .words("quality target size ratio too coarse honoured diameter"),
    DockPlace::new("preflight", "Solver rules", "").words(
        "check preflight ready adcirc schism swan telemac fvcom wavewatch delft3d mike modflow violations repair \
         overconstrained open boundary",
    ),
    DockPlace::new("plots", "Plots", "").words("chart figure time measure experiment"),
    DockPlace::new("domain", "Domain", "").words("extent outline coast region"),
    DockPlace::new("domain", "Domain", "Unit").words("metres kilometres degrees length"),
    DockPlace::new("domain", "Domain", "Left").words("bounds extent x minimum size"),
    DockPlace::new("domain", "Domain", "Right").words("bounds extent x maximum size"),
    DockPlace::new("domain", "Domain", "Bottom").words("bounds extent y minimum size"),
    DockPlace::new("domain", "Domain", "Top").words("bounds extent y maximum size"),
    DockPlace::new("domain", "Domain", "Domain where").words("formula shape region condition"),
    DockPlace::new("background", "Background picture", "").words("trace map image opacity"),
    DockPlace::new("path", "Path", "").words("route cost risk weight keep-out"),
    DockPlace::new("path", "Path", "Prove within").words("certificate proof bound interval"),
    DockPlace::new("boundary", "Boundary", "").words("pieces names markers open sides"),
];
