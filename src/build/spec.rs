use crate::domain::{BoundaryTreatment, Domain};
use crate::field::{RefinementRule, TargetFieldSpec};
use crate::geometry::Lattice;
use crate::mesh::{Cleaning, Limits};

/// What to mesh: everything that decides the mesh, but for paint.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSpec {
    /// Ω.
    pub domain: Domain,
    /// How the mesh meets the boundary of a domain of polygons.
    pub boundary: BoundaryTreatment,
    /// The coarse grid and its lattice, over the bounds of the domain.
    pub lattice: Lattice,
    /// h̄, the target diameter.
    pub field: TargetFieldSpec,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// Whether h̄ is sampled by pixel even where the rule does not need it.
    pub sampling: FieldSampling,
    /// Which triangles of the domain the [derived mesh](crate::outline::DerivedMesh) keeps.
    pub cleaning: Cleaning,
    /// What the mesh may cost.
    pub limits: Limits,
}

/// When h̄ is sampled by pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FieldSampling {
    /// Always: the field is shown, and values that no mesh can meet are found between nodes too.
    Always,
    /// Only for the area rule.
    AsNeeded,
}

impl MeshSpec {
    /// Whether the mesh cannot be built before h̄ is sampled by pixel.
    pub fn samples_field(&self) -> bool {
        self.sampling == FieldSampling::Always || self.rule == RefinementRule::Area
    }
}
