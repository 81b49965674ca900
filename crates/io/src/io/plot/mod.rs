//! Plots as files: a drawing or a table. The ending says which.

mod csv;
mod svg;

use std::io::{self, Write};
use std::path::Path;

pub use csv::write as write_csv;
pub use svg::write as write_svg;

use meshbrush_core::plot::Plot;

/// The endings of files that a plot can be written to.
pub const ENDINGS: [&str; 2] = ["svg", "csv"];

/// Writes a plot as the ending of `path` says; without one of [`ENDINGS`] as a drawing.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut impl Write, plot: &Plot, path: &Path) -> io::Result<()> {
    let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    if is_table { write_csv(out, plot) } else { write_svg(out, plot) }
}
