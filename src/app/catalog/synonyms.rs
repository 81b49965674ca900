//! Other words by which commands are found: those of other programs, and those of what a command acts on.

use std::sync::LazyLock;

use meshbrush_render::render::export::ExportFormat;

/// A command that is found by its formats, too.
const EXPORT_MESH: &str = "Export mesh…";

/// The beginning of a title, and other words for it.
static SYNONYMS: &[(&str, &str)] = &[
    ("New…", "create empty blank document start page"),
    ("Open…", "load read file import"),
    ("Add data…", "import load drop grid raster dem terrain depths shapes table csv geojson asc png"),
    ("Open picture as risk…", "image raster png import"),
    ("Open grid as target diameter…", "raster asc size import"),
    ("Open background picture…", "image map trace png"),
    (
        "Open the sea around land…",
        "coast coastline island shoreline water ocean frame line gshhs osm shapefile",
    ),
    ("Open domain…", "coast outline polygon geojson import boundary"),
    (
        "Open the boundary",
        "sea ocean obc offshore elevation water level specified bathymetry depth side mask",
    ),
    ("Add outline to this document…", "coast polygon geojson import boundary"),
    ("Save as recipe…", "toml export script"),
    (EXPORT_MESH, "save write drawing picture coast solver hgrid"),
    ("Export path…", "save write route geojson csv svg png line"),
    ("Export as test…", "record session replay"),
    ("Undo", "back revert"),
    ("Redo", "again repeat"),
    ("Clear paint", "erase delete all remove"),
    ("Query", "inspect identify pick info triangle"),
    ("Brush", "paint draw"),
    ("Eraser", "rubber delete remove paint"),
    ("Path", "route line cost shortest safest"),
    ("Threats", "radar danger"),
    ("Pan", "move hand scroll"),
    ("In space", "3d three dimensions perspective relief terrain surface orbit rotate heights"),
    ("Boundary", "markers pieces names"),
    ("Add layer: picture or grid, through a curve…", "raster depths shallow dem terrain values"),
    ("Add layer: threats", "radar danger table"),
    ("Fit domain", "zoom all whole extent home reset view"),
    ("Go to…", "find jump coordinate point triangle number"),
    ("Edges", "wireframe lines triangles"),
    ("No overlay", "none off hide overlays"),
    ("Overlay smallest angle", "show colour field quality bad elements skewness sliver slivers thin"),
    ("Overlay largest angle", "show colour field quality bad elements skewness obtuse"),
    (
        "Overlay edge ratio",
        "show colour field quality bad elements aspect ratio skewness sliver slivers stretched",
    ),
    ("Overlay longest edge / h̄", "show colour field quality target size ratio too coarse finer honoured"),
    ("Overlay time step", "show colour field cfl courant stability smallest step solver"),
    ("Overlay", "show colour field"),
    ("Graticule", "meridians parallels longitude latitude degrees grid lines map"),
    ("Scale bar", "ruler length"),
    ("Places in", "coordinates longitude latitude degrees minutes metres projection"),
    ("Legend of the levels", "colours colors key diameters counts"),
    ("Larger interface", "ui scale zoom font size text accessibility"),
    ("Smaller interface", "ui scale zoom font size text"),
    ("Interface in its normal size", "ui scale zoom font size text reset"),
    ("Viridis colours", "colormap palette"),
    ("Turbo colours", "colormap palette"),
    ("Larger brush", "radius size width"),
    ("Harder brush", "hardness soft edge falloff"),
    ("Dark theme", "appearance display night"),
    ("Light theme", "appearance display day"),
    ("Contour lines", "isolines levels"),
    ("Show only the level of the triangle", "isolate one level alone"),
    ("Hide or show the level of the triangle", "isolate toggle one level"),
    ("Show the corridor", "nearly best routes band"),
    ("Show the front", "pareto trade length risk"),
    ("Panels", "hide sidebar full screen canvas only tab"),
    ("Find a command…", "palette search menu"),
    ("Keyboard and mouse", "shortcuts keys gestures bindings help"),
    ("Step through", "teach animate algorithm bisection demonstration"),
];

/// Returns other words for a command by its title.
pub fn words_of(title: &str) -> &'static str {
    static OF_EXPORT: LazyLock<String> = LazyLock::new(|| {
        let formats = ExportFormat::all().flat_map(|format| names_in(format.purpose()));
        let formats = ExportFormat::names().chain(ExportFormat::endings()).chain(formats);
        formats.fold(other_words(EXPORT_MESH).to_owned(), |words, name| words + " " + name)
    });
    if title.starts_with(EXPORT_MESH) { &OF_EXPORT } else { other_words(title) }
}

/// Returns the names of programs and formats in a sentence: the words with a capital.
fn names_in(sentence: &str) -> impl Iterator<Item = &str> {
    let words = sentence.split(|letter: char| !letter.is_alphanumeric());
    words.filter(|word| word.len() > 1 && word.contains(char::is_uppercase))
}

fn other_words(title: &str) -> &'static str {
    SYNONYMS.iter().find(|(start, _)| title.starts_with(start)).map_or("", |(_, words)| words)
}

#[cfg(test)]
pub fn starts() -> impl Iterator<Item = &'static str> {
    SYNONYMS.iter().map(|(start, _)| *start)
}
