//! Meshes for the tests of several files.

use crate::build::{BuiltMesh, MeshBuilder, MeshSpec};
use crate::domain::{BoundaryTreatment, Domain};
use crate::field::{Formula, RefinementRule, Transfer};
use crate::geometry::{Lattice, Rect};
use crate::layers::{Layer, LayerKind, SizeFieldSpec};
use crate::mesh::{Cleaning, Limits, Progress};

/// Returns the unit square with a target diameter by a formula.
pub fn built(target: &str, rule: RefinementRule, limits: Limits) -> BuiltMesh {
    built_with(Layer::stack([LayerKind::target(Formula::parse(target).unwrap())]), rule, limits)
}

/// Returns the unit square with layers.
pub fn built_with(layers: Vec<Layer>, rule: RefinementRule, limits: Limits) -> BuiltMesh {
    let domain = Domain::rectangle(Rect::UNIT);
    let field = SizeFieldSpec {
        layers,
        transfer: Transfer::between(0.001, 1.0),
        unasked: 1.0,
        outline: None,
        gradation: None,
        projection: None,
    };
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, 0.1, 100_000).unwrap(),
        domain,
        boundary: BoundaryTreatment::default_for(0.1),
        lines: Default::default(),
        field,
        rule,
        cleaning: Cleaning::NONE,
        limits,
    });
    while builder.advance(None, 10_000).unwrap() == Progress::More {}
    builder.finish()
}
