//! Formats of files, and pictures.

mod arrangement;
mod coast;
mod detail;
mod figures;
#[path = "../../../../tests/shared/formula_mesh/mod.rs"]
mod formula_mesh;
mod hostile;
mod io;
mod kept_picture;
mod meter;
mod partial_redraw;
mod pieces;
mod render_agreement;
mod shader_validation;
