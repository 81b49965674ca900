//! Mesh generation by local bisection: paint risk or a target diameter, and the mesh follows.
//!
//! A coarse grid of right-angled triangles is refined by bisecting triangles until each satisfies a local
//! condition. All public types are at the root of the crate. The [`guide`] shows how to build, paint, query
//! and export a mesh. Points and vectors are those of [`glam`], which is re-exported.
//!
//! # Sources
//!
//! The method is that of \[Report\], which implements the refinement of \[Maubach1995\]. In two dimensions it
//! is newest vertex bisection \[Mitchell1989\] and, since the triangles are right-angled and isosceles,
//! longest-edge bisection \[Rivara1984\]; the recursion over neighbours is that of \[Kossaczky1994\]. The
//! number of triangles added to keep the mesh conforming is bounded by \[BDD2004\], and coarsening follows
//! \[ChenZhang2010\]. The [references](guide::references) have the titles.

// What only the window, the tests and the benches use is unused in other builds. Builds of tests have
// `internals`.
#![cfg_attr(not(feature = "internals"), allow(dead_code, unused_imports))]
#![deny(unsafe_code)]

mod text;
mod geometry;
mod mesh;
mod plot;
mod raster;
mod field;
mod domain;
mod layers;
mod outline;
mod paint;
mod build;
mod path;
mod explain;
mod document;
mod io;
mod colormap;
mod scene;
mod render;
mod cli;
#[cfg(feature = "gui")]
mod app;

pub use glam;

// Build a mesh.
pub use build::{BuildError, BuildStage, BuiltMesh, MeshBuilder, MeshSpec, RefinementCriterion};
pub use domain::{
    BoundaryKind, BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryTreatment, CutShape, Domain,
    DomainOnLattice, DomainShape, MOST_CORNERS, MeshBoundary, NamedPolygon, PieceFigures, PieceRun, Polygon,
    Region, RegionError, Ring,
};
pub use field::formula::ParseError;
pub use field::{
    Bounds, CostFormula, Formula, RefinementRule, RiskToDiameter, Transfer, TransferError, VertexRule,
};
pub use geometry::{GridError, Lattice, LatticePoint, LatticeRect, Rect};
pub use mesh::{
    Changes, CoarseError, Element, Fingerprint, Forecast, InvalidTarget, Limits, MOST_TRIANGLES, MemoryLimit,
    Mesh, Progress, RefineError, Refiner, TargetChange, Updater, Violation, bisection_edge_length,
};
pub use raster::{PixelRect, Raster, RasterPyramid, TiledRaster};

// Paint.
pub use document::{
    Background, Document, Example, Follower, KeepOut, MeshChange, PathCost, PathPlan, Picture, Setting,
    Settings, SettingsError, Stage,
};
pub use layers::{
    Combine, Decision, InvalidLayer, Layer, LayerId, LayerKind, LeastTarget, Mask, PaintLayers, Quantity,
    RasterReading, RasterSource, RiskField, SizeField, SizeFieldSpec,
};
pub use paint::{Brush, Medium};
pub use text::LengthUnit;

// Find paths.
pub use path::{
    Certificate, CertificateEnd, CertificateTask, CostDensity, CostRange, FormulaCost, PathError, Placement,
    PlacementTest, Waypoint, WeightedCost, Weights,
};

// Query a mesh.
pub use explain::{Bisections, Demand, Explanation, LevelFigures, Words};
pub use mesh::{
    Adjacency, Cause, Cleaning, KeptParts, Location, Locator, Neighbour, NodeId, Orientation, PatchedLocator,
    Removed, RemovedPart, Topology, TreeTriangle, Triangle, TriangleId, barycentric, interpolate,
};

// Read and write files.
pub use colormap::{Colormap, Ground, LevelColors};
pub use io::{Cancelled, MeshData, MeshFormat, MeshSource, Meter, NodeValues, Provenance, ReadError};
pub use mesh::{
    BoundaryEdge, Cell, Extract, MeshEdge, MeshPatch, MeshStatistics, MeshView, PatchPieces, PatchTriangle,
};
pub use outline::{DerivedMesh, DerivedViolation, OutlineFit};
pub use render::Image;
pub use render::export::{ExportFormat, LARGEST_PICTURE, Look, UnknownEnding};

pub use io::asc::read as read_asc;
pub use io::geojson::{read as read_geojson, read_named as read_named_geojson, write as write_geojson};
pub use io::png::{Behind, read as read_png};
pub use io::points::read as read_points;
pub use io::project::{Project, read as read_project, write as write_project};
pub use io::write_file;

pub mod guide;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals;

use std::ffi::OsString;
use std::process::ExitCode;

/// The window, in a build that has one.
#[cfg(feature = "gui")]
const WINDOW: Option<cli::Window> = Some(cli::Window {
    open: app::run,
    write_screenshots: app::write_screenshots,
    write_manual_pictures: app::write_manual_pictures,
    write_tour: app::write_tour,
});
#[cfg(not(feature = "gui"))]
const WINDOW: Option<cli::Window> = None;

pub use mesh::ProgramAllocator;

/// Runs the program: the command line or, with the feature `gui`, the window. The first argument is the
/// program's name.
pub fn run_program(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    cli::run(arguments, WINDOW)
}

/// The examples of the README, compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
