//! Files for SCHISM, which reads each quantity from a grid of its own: Manning's n from `manning.gr3`.

use std::path::Path;

use meshbrush_io::io::DEPTH;
use meshbrush_render::render::export::ExportFormat;

/// The formats of its grids.
const FORMATS: [&str; 2] = ["gr3", "ll"];
/// Names of files in which it looks for a quantity.
const QUANTITIES: [&str; 8] =
    ["manning", "drag", "rough", "albedo", "watertype", "diffmin", "diffmax", "windrot_geo2proj"];

/// Returns whether SCHISM reads files of a format.
pub fn is_for_schism(format: ExportFormat) -> bool {
    format.mesh().is_some_and(|mesh| FORMATS.contains(&mesh.name()))
}

/// Returns the quantity that a file can have in place of the depth: the name of the file without its ending.
pub fn quantity_of(path: &Path, format: ExportFormat) -> Option<String> {
    let stem = path.file_stem()?.to_str()?;
    (is_for_schism(format) && stem != DEPTH).then(|| stem.to_owned())
}

/// Returns a sentence where SCHISM looks for a `quantity` in a `file` that has none.
pub fn missing(quantity: &str, file: &str) -> Option<String> {
    QUANTITIES.contains(&quantity).then(|| {
        format!(
            "{file}: SCHISM reads the quantity {quantity} there, and there is none. Give it with --quantity \
             {quantity}=EXPR or --quantity-grid {quantity}=FILE, or write to another name."
        )
    })
}
