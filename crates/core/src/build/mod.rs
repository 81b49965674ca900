//! Makes a mesh from its description: the one pipeline of window, command line, benches and tests.
//!
//! A [`MeshSpec`] describes the mesh; a [`MeshBuilder`] makes it in slices. [`RefinementCriterion`] decides
//! for both, and for updates and checks afterwards, which triangles are too large.
//!
//! ```
//! use meshbrush_core::build::{MeshBuilder, MeshSpec};
//! use meshbrush_core::domain::{BoundaryTreatment, Domain};
//! use meshbrush_core::field::{Formula, RefinementRule, Transfer};
//! use meshbrush_core::layers::{Layer, LayerKind, SizeFieldSpec};
//! use meshbrush_mesh::geometry::{Lattice, Rect};
//! use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};
//!
//! let domain = Domain::rectangle(Rect::UNIT);
//! let formula = Formula::parse("if(abs(x) + abs(y) < 0.4, 0.0125, 1)")?;
//! let spec = MeshSpec {
//!     lattice: Lattice::covering(domain.bounds, 0.05, 100_000)?,
//!     domain,
//!     boundary: BoundaryTreatment::default_for(0.05),
//!     lines: Default::default(),
//!     field: SizeFieldSpec {
//!         layers: Layer::stack([LayerKind::target(formula)]),
//!         transfer: Transfer::between(0.01, 1.0),
//!         unasked: 1.0,
//!         outline: None,
//!         gradation: None,
//!         projection: None,
//!     },
//!     rule: RefinementRule::Vertex,
//!     cleaning: Cleaning::NONE,
//!     limits: Limits::default(),
//! };
//! let mut builder = MeshBuilder::new(spec);
//! while builder.advance(None, 10_000)? == Progress::More {}
//! let built = builder.finish();
//! assert!(built.mesh.violations().is_empty());
//! assert!(built.unsatisfied(None)?.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod approximation;
mod builder;
mod criterion;
mod error_curve;
mod search;
mod spec;

pub use builder::{BuildError, BuildStage, BuiltMesh, MeshBuilder, Parts};
pub use criterion::RefinementCriterion;
pub use error_curve::{CurveTracing, ErrorCurves};
pub use spec::MeshSpec;
