use crate::domain::{BoundaryTreatment, Domain};
use crate::field::RefinementRule;
use crate::geometry::Lattice;
use crate::layers::SizeFieldSpec;
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
    pub field: SizeFieldSpec,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// Which triangles of the domain the [derived mesh](crate::outline::DerivedMesh) keeps.
    pub cleaning: Cleaning,
    /// What the mesh may cost.
    pub limits: Limits,
}
