use std::sync::Arc;

use crate::domain::{BoundaryTreatment, Domain, Line};
use crate::field::RefinementRule;
use crate::geometry::Lattice;
use crate::layers::SizeFieldSpec;
use crate::mesh::{Cleaning, Limits};

/// The description of a mesh: everything that decides the mesh except paint.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSpec {
    /// The domain Ω.
    pub domain: Domain,
    /// The treatment of the boundary of a domain of polygons.
    pub boundary: BoundaryTreatment,
    /// Lines along which the [derived mesh](crate::outline::DerivedMesh) has edges.
    pub lines: Arc<Vec<Line>>,
    /// The coarse grid and its lattice, over the bounds of the domain.
    pub lattice: Lattice,
    /// h̄, the target diameter.
    pub field: SizeFieldSpec,
    /// The points of a triangle whose target diameters count.
    pub rule: RefinementRule,
    /// The triangles of the domain that the [derived mesh](crate::outline::DerivedMesh) keeps.
    pub cleaning: Cleaning,
    /// Limits of the number of triangles and of their levels.
    pub limits: Limits,
}
