//! Texts of the help that list formats of files.

use meshbrush_io::io::RasterFormat;
use meshbrush_render::render::export::ExportFormat;

/// Returns the endings of the files of grids, or of images.
fn raster_endings(are_grids: bool) -> String {
    let formats = RasterFormat::all().filter(|format| format.is_grid() == are_grids);
    let endings = formats.flat_map(|format| format.endings());
    endings.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}

/// Returns the help of the file that the window opens.
pub fn file_help() -> String {
    format!(
        "File to open in the window: a project (.meshbrush), a recipe (.toml), a domain (.geojson, .shp, .gpkg), or a \
         greyscale picture ({}) or grid ({}) as risk",
        raster_endings(false),
        raster_endings(true)
    )
}

/// Returns the help of `--target-raster`.
pub fn target_raster_help() -> String {
    format!(
        "Target diameters by pixel: a grid of lengths ({}), or an image ({}; black is --h-min, white --h-max, even \
         between)",
        raster_endings(true),
        raster_endings(false)
    )
}

/// Returns the long help of `--target-raster`.
pub fn target_raster_long_help() -> String {
    format!(
        "{}\n\nAn image, and an array (.npy), covers the domain's bounding box; any other grid lies where its file \
         says. A pixel without a value (NODATA, or transparent) asks for nothing.",
        target_raster_help()
    )
}

/// Returns the help of `--risk-raster`.
pub fn risk_raster_help() -> String {
    format!(
        "Risk by pixel: an image ({}; black 0, white 1; transparent 0) or a grid ({}; values from 0 to 1)",
        raster_endings(false),
        raster_endings(true)
    )
}

/// Returns the help of `--output`, with the ending of every format.
pub fn output_help() -> String {
    let endings: String = ExportFormat::endings().map(|ending| format!(" .{ending}")).collect();
    format!("File to write, may be repeated:{endings}")
}

/// Returns the long help of `--output`.
pub fn output_long_help() -> String {
    let help = output_help();
    format!(
        "{help}\n\nFiles carry the level of each triangle and the target diameter at each node; pictures do not. Beside \
         .node, the files .ele, .neigh and .edge are written; beside .slf, .cli; and .dat stands for the files _grd.dat, \
         _dep.dat and _obc.dat of FVCOM."
    )
}

/// Returns the help of `--format`, with the name of every format.
pub fn format_help() -> String {
    let names: String = ExportFormat::names().map(|name| format!(" {name}")).collect();
    format!("Format of `-o -`, which writes to standard output, and of a file:{names}")
}

/// Returns the long help of `--format`.
pub fn format_long_help() -> String {
    let help = format_help();
    format!(
        "{help}\n\nThe ending of a file chooses its format, unless the file may also be one of the named format (.msh for \
         msh22 and ww3) or the ending says nothing."
    )
}
