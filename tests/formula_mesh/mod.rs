//! Meshes as the program makes them, for a formula of the target diameter under the vertex rule.

use meshbrush::internals::build::{BuiltMesh, FieldSampling, MeshBuilder, MeshSpec};
use meshbrush::internals::domain::{BoundaryTreatment, Domain};
use meshbrush::internals::field::{Formula, RefinementRule, Source, TargetFieldSpec, Transfer};
use meshbrush::internals::geometry::Lattice;
use meshbrush::internals::mesh::{Cleaning, Limits, Progress};

/// The mesh of a domain; `target` is a formula.
pub fn formula_mesh(domain: &Domain, spacing: f64, boundary: BoundaryTreatment, target: &str) -> BuiltMesh {
    let limits = Limits::default();
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, spacing, limits.max_triangles).unwrap(),
        domain: domain.clone(),
        boundary,
        field: TargetFieldSpec {
            sources: vec![Source::TargetFormula(Formula::parse(target).unwrap())],
            transfer: Transfer { h_min: f64::MIN_POSITIVE, h_max: f64::MAX, shape: 1.0 },
            unasked: f64::MAX,
            size: [2; 2],
        },
        rule: RefinementRule::Vertex,
        sampling: FieldSampling::AsNeeded,
        cleaning: Cleaning::NONE,
        limits,
    });
    while builder.advance(None, 1000).unwrap() == Progress::More {}
    builder.finish()
}
