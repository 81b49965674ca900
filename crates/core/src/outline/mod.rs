//! A mesh with the nodes of its boundary on the outline of the domain.
//!
//! The mesh of right-angled triangles does not change. The mesh that is shown and exported is derived from
//! it: a pure function of the mesh, the outline and h̄, independent of the order of the mesh's entries.
//!
//! The idea is that of isosurface stuffing \[LabelleShewchuk2007\], with moves as large as half an edge: each
//! node has a sign, inside or outside. Where the outline crosses an edge between two signs, the end nearer to
//! the crossing moves there ([`snap`]); edges that no end can leave are cut ([`stencil`]). With signs alone,
//! the domain never touches itself; moves preserve that, once flat triangles are left out ([`flat`]). Sharp
//! corners of the outline become nodes ([`corners`]). Where an angle is too small, nodes go back towards home
//! ([`guard`]). Where an edge is longer than its target, it is halved ([`division`]). Then edges are
//! flipped ([`patchwork`]) and nodes shifted ([`smooth`]), as far as that makes the smallest angles larger
//! and no edge longer than its target.
//!
//! Nodes end on lattice points, like all nodes of a mesh: at most half a lattice step beside the outline,
//! whose own corners are lattice points, too ([`RegionOnLattice`](crate::domain::RegionOnLattice)).
//!
//! Each of these is a *stage* ([`stages`]), which the teaching mode of the window shows.
//!
//! All threads work on a stage. A node is moved, and an edge flipped, by the state of its surroundings and by
//! places on the lattice, so the result does not depend on the number of threads; and after an edit, only its
//! surroundings are derived again ([`OutlineFollower`], [`DerivedFollower`]).
//!
//! Bounds. The domain never touches itself in a node. In square cells every angle is at least 18.4° and at
//! most 143.2°, except beside sharp corners of the outline: there it is at least 12°, or 0.8 times the angle
//! of the corner. That nodes lie *on* the outline is not guaranteed: those that retreated may be off by half
//! an edge. Features thinner than the triangles vanish or merge. A triangle needs at least 16 lattice steps
//! along its legs.
//!
//! Where that is asked for, triangles with small angles, between nodes of the boundary or crowded around a
//! node are changed at last ([`quality`]).
//!
//! Lengths. No edge is longer than h̄ at any point of the triangles beside it ([`EdgeTargets`]), as no edge
//! of the mesh is: what lies in a triangle of the mesh that meets its target meets it, too. In triangles of
//! the mesh that are larger than their target, edges may have any length.

mod angles;
mod triangulation;
mod numbers;
mod places;
mod band;
mod snap;
mod stencil;
mod flat;
mod corners;
mod guard;
mod lengths;
mod line;
mod local;
mod lines;
mod quality;
mod patchwork;
mod division;
mod smooth;
mod stages;
mod changes;
mod fitting;
mod window;
mod follower;
mod writer;
mod follower_making;
mod islands;
mod derived_follower;
mod derived;
mod deriving;
mod check;

pub use changes::OutlineFit;
pub use check::DerivedViolation;
pub use derived::DerivedMesh;
pub use derived_follower::DerivedFollower;
pub use deriving::MeshDerivation;
pub use follower::OutlineFollower;
pub use lengths::{EdgeTargets, SharedTargets};
pub use lines::{LineEdge, LineEdges, LineFit, LineProblem, UnresolvedPlace, WeirEdges};
pub(crate) use places::{PlaceKey, triangle_place};
pub use stages::{DerivationAction, DerivationStage, derivation_stages};
