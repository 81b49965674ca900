//! Mesh generation by local bisection: paint risk or a target diameter, and the mesh follows.
//!
//! A coarse grid of right-angled triangles is refined by bisecting triangles until each satisfies a local
//! condition. All public types are at the root of the crate. The [`guide`] shows how to build, paint, query
//! and export a mesh, and how to find a path. Points and vectors are those of [`glam`], which is re-exported.
//!
//! # Sources
//!
//! The method is that of \[Report\], which implements the refinement of \[Maubach1995\]. In two dimensions it
//! is newest vertex bisection \[Mitchell1989\] and, since the triangles are right-angled and isosceles,
//! longest-edge bisection \[Rivara1984\]; the recursion over neighbours is that of \[Kossaczky1994\]. The
//! number of triangles added to keep the mesh conforming is bounded by \[BDD2004\], and coarsening follows
//! \[ChenZhang2010\]. The [references](guide::references) have the titles.

#![deny(unsafe_code)]

#[cfg(feature = "gui")]
mod app;

pub use glam;

use meshbrush_cli::cli;

// Build a mesh.
#[doc(inline)]
pub use meshbrush_core::build::{
    BuildError, BuildStage, BuiltMesh, CurveTracing, ErrorCurves, MeshBuilder, MeshSpec, Parts,
    RefinementCriterion,
};
#[doc(inline)]
pub use meshbrush_core::domain::{
    BoundaryKind, BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryTreatment, BoundaryType, Crest,
    CrestOnGrid, CutFrame, CutShape, DepthContour, DepthContourError, Domain, DomainOnLattice, DomainShape,
    FormulaShape, Line, LineKind, LineWeirError, LinesOnLattice, MOST_CORNERS, MeshBoundary, NamedPolygon,
    NoCrest, OutlineOnEarth, PieceChoice, PieceFigures, PieceRun, PixelLengths, Polygon, Region, RegionError,
    RegionOnLattice, Ring, Weir, WeirError, ZeroLineError,
};
#[doc(inline)]
pub use meshbrush_core::field::formula::ParseError;
#[doc(inline)]
pub use meshbrush_core::field::{
    Bounds, CostFormula, Formula, RefinementRule, RiskToDiameter, Transfer, TransferError, VertexRule,
};
#[doc(inline)]
pub use meshbrush_core::raster::{
    NearestPixel, PixelGrid, PixelRect, Raster, RasterPyramid, SquareValues, Tile, TilePlace, TiledRaster,
    ValueRange, ValueRanges,
};
#[doc(inline)]
pub use meshbrush_mesh::geometry::{GridError, Lattice, LatticePoint, LatticeRect, Rect};
#[doc(inline)]
pub use meshbrush_mesh::mesh::{
    Answer, BlockRefiner, ChangedArea, Changes, CoarseError, Element, Falloff, Fingerprint, Forecast,
    InvalidTarget, LevelsWithin, Limits, MOST_TRIANGLES, MemoryLimit, Mesh, Progress, RefineError, Refiner,
    RuleAnswers, SharedRule, TargetChange, Updater, Violation, bisection_edge_length,
};

// Paint.
#[doc(inline)]
pub use meshbrush_core::document::{
    Background, Document, Edit, EditError, Edits, Example, ExampleData, ExampleMaking, Follower, History,
    KeepOut, MeshChange, NoPaintLayer, OutlineError, PathCost, PathPlan, Picture, RecordedEdit,
    RecordedStroke, Recording, Repainted, SeaChart, Setting, SettingKind, Settings, SettingsError, Stage,
};
#[doc(inline)]
pub use meshbrush_core::layers::{
    BandLayer, Combine, Coverage, CurveError, Decision, DepthError, DepthFit, DepthRule, DepthSizes, Depths,
    DiameterLimit, DistanceLayer, DistanceTo, FeatureSize, FineAt, FormulaLayer, InvalidLayer, Layer,
    LayerId, LayerKind, LeastTarget, LevelCache, LineGaps, LineSizes, Mask, MedialAxis, MedialBall,
    MedialBalls, NoDepth, NodeDepths, PaintChange, PaintLayer, PaintLayers, PositiveDepth, Quantity,
    RasterLayer, RasterReading, RasterSource, RiskField, ShapeList, Shapes, ShapesError, SizeField,
    SizeFieldSpec, StraitCount, Straits, Surface, SurfaceGoal, SurfaceGoalError, SurfaceNorm, SurfaceSource,
    Threat, ThreatError, ThreatLaw, Threats, ValueCurve,
};
#[doc(inline)]
pub use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror, Patch, PathPoint, Repaint, Stroke};
#[doc(inline)]
pub use meshbrush_core::surface::{
    CurvePoint, SampleCount, SurfaceDemand, SurfaceFit, SurfaceNodes, SurfaceRule, SurfaceSamples,
    domain_on_samples,
};
#[doc(inline)]
pub use meshbrush_mesh::text::LengthUnit;

// Find paths.
#[doc(inline)]
pub use meshbrush_core::path::{
    Certificate, CertificateEnd, CertificateTask, Corridor, CostDensity, CostModel, CostRange, DualFunction,
    Effort, FormulaCost, GroundCost, LegProof, Passage, PathArea, PathCertificate, PathError, PathMesh,
    PathRequest, PathSample, Placement, PlacementTest, Planner, Solution, TriangleCosts, Waypoint,
    WeightedCost, Weights,
};

// Query a mesh.
#[doc(inline)]
pub use meshbrush_core::explain::{Demand, Explanation, Words};
#[doc(inline)]
pub use meshbrush_mesh::mesh::{
    Adjacency, Cause, Cleaning, KeptParts, Location, Locator, Neighbour, NodeId, Orientation, PatchedLocator,
    Removed, RemovedPart, Topology, TreeTriangle, Triangle, TriangleId, barycentric, interpolate,
};
#[doc(inline)]
pub use meshbrush_study::levels::{Bisections, LevelFigures};

// Read and write files.
#[doc(inline)]
pub use meshbrush_core::earth::{
    Coordinates, CoordinatesTextError, DegreeStyle, EdgeLengths, GeographicAxis, GeographicExtent,
    GeographicSystem, InverseScale, Projection, ProjectionChoice, ProjectionError, ProjectionKind,
    ProjectionTextError, Reprojection, projected_polygons,
};
#[doc(inline)]
pub use meshbrush_core::outline::{
    DerivedFollower, DerivedMesh, DerivedViolation, EdgeTargets, LineEdge, LineEdges, LineFit, LineProblem,
    OutlineFit, OutlineFollower, SharedTargets, UnresolvedPlace, WeirEdges,
};
#[doc(inline)]
pub use meshbrush_io::io::{
    Cancelled, CellShape, Counted, Flaw, JoinedCells, MeshData, MeshFormat, MeshSource, Meter, NodeValues,
    PartitionFigures, PlaceInFile, Provenance, QuantityPlaces, ReadError, ThirdCoordinate,
};
#[doc(inline)]
pub use meshbrush_mesh::mesh::{
    BoundaryEdge, Cell, CurveOrder, DrawnPiece, Extract, MeshEdge, MeshPatch, MeshStatistics, MeshView,
    PatchPieces, PatchTriangle, Replacement,
};
#[doc(inline)]
pub use meshbrush_render::colormap::{Colormap, Ground, LevelColors};
#[doc(inline)]
pub use meshbrush_render::render::Image;
#[doc(inline)]
pub use meshbrush_render::render::export::{ExportFormat, UnknownEnding};
pub use meshbrush_render::render::furniture::{
    Furniture, Legend, LegendBody, LegendRow, LegendScale, NoRoom, UnknownFurniture,
};
pub use meshbrush_render::render::look::{Look, MapPlace};
pub use meshbrush_render::render::overlay::{OverlayColors, PictureOverlay, PixelColors};
pub use meshbrush_render::render::picture_size::{
    LARGEST_PICTURE, PaperSize, PaperUnit, PictureGround, PictureSize, SizeError, UnknownGround,
};
pub use meshbrush_render::render::space_look::SpaceLook;
#[doc(inline)]
pub use meshbrush_render::scene::{HeightScale, Light, NodeHeights, ViewDirection};

#[doc(inline)]
pub use meshbrush_io::io::asc::read as read_asc;
#[doc(inline)]
pub use meshbrush_io::io::geojson::{
    read as read_geojson, read_named as read_named_geojson, write as write_geojson,
};
#[doc(inline)]
pub use meshbrush_io::io::png::{Behind, read as read_png};
#[doc(inline)]
pub use meshbrush_io::io::points::read as read_points;
#[doc(inline)]
pub use meshbrush_io::io::project::{Project, read as read_project, write as write_project};
#[doc(inline)]
pub use meshbrush_io::io::write_file;

pub mod guide;

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

#[doc(inline)]
pub use meshbrush_mesh::mesh::ProgramAllocator;

/// Runs the program: the command line or, with the feature `gui`, the window. The first argument is the
/// program's name.
pub fn run_program(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    ProgramAllocator::give_large_arrays_back();
    cli::run(arguments, WINDOW)
}

/// The examples of the README, compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
