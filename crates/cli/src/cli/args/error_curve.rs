//! Arguments on the error of a mesh.

use std::path::PathBuf;

use clap::Args;

/// The plot that is asked for.
#[derive(Debug, Args)]
pub struct ErrorCurveArguments {
    /// Plot to write of the error from the surface against the number of triangles, .svg or .csv: that of the
    /// smallest mesh, of uniform meshes, and of the mesh without the surface
    ///
    /// The error is that of --norm. The curve of the smallest mesh has what other layers ask for as well. The
    /// rates by which the errors fall are printed beside the best one that is possible.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub error_curve: Option<PathBuf>,

    /// File to write with the bisections that the error and other targets force, as numbers that other
    /// programs can check (.json)
    ///
    /// With the triangles that must be bisected, their parents and those across must be: if that gives all
    /// bisections, no conforming mesh of the forest meets all demands with fewer triangles.
    /// tests/check_mesh_certificate.py of the source code is such a program. Not for a --norm that sums over
    /// the whole mesh.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub certificate: Option<PathBuf>,
}
