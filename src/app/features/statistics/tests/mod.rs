//! The figures of the mesh, and the levels that are shown.

mod figures;
mod levels;
mod preflight;
mod quality;
