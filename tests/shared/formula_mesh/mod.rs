//! Meshes as the program makes them, for a formula of the target diameter under the vertex rule.

use meshbrush_core::build::{BuildError, BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{Layer, LayerKind, SizeFieldSpec};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};

/// Returns the mesh of a domain; `target` is a formula.
pub fn formula_mesh(domain: &Domain, spacing: f64, boundary: BoundaryTreatment, target: &str) -> BuiltMesh {
    try_formula_mesh(domain, spacing, boundary, target).unwrap()
}

/// [`formula_mesh`] of a domain that may have no mesh.
pub fn try_formula_mesh(
    domain: &Domain,
    spacing: f64,
    boundary: BoundaryTreatment,
    target: &str,
) -> Result<BuiltMesh, BuildError> {
    let limits = Limits::default();
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, spacing, limits.max_triangles).unwrap(),
        domain: domain.clone(),
        boundary,
        lines: Default::default(),
        field: SizeFieldSpec {
            layers: Layer::stack([LayerKind::target(Formula::parse(target).unwrap())]),
            transfer: Transfer::between(f64::MIN_POSITIVE, f64::MAX),
            unasked: f64::MAX,
            outline: None,
            gradation: None,
            projection: None,
        },
        rule: RefinementRule::Vertex,
        cleaning: Cleaning::NONE,
        limits,
    });
    while builder.advance(None, 1000)? == Progress::More {}
    Ok(builder.finish())
}
