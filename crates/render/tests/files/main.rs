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
mod netcdf_reader;
mod partial_redraw;
mod pieces;
mod render_agreement;
#[path = "../../../../tests/shared/runs.rs"]
#[expect(dead_code, reason = "these tests use seeds only")]
mod runs;
mod shader_validation;
mod solvers;
mod space;
