use super::OutlineFollower;
use super::angles::Angles;
use super::changes::{OutlineChanges, OutlineFit};
use super::islands::DerivedIslands;
use super::lengths::EdgeTargets;
use super::lines::{LineFit, fit_lines};
use super::quality::with_better_boundary;
use super::stages::{DerivationAction, Watch};
use crate::domain::DomainOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Cleaning, Extract, Mesh, MeshPatch, Removed};

/// A mesh as it is exported: with its boundary nodes on the outline if the domain requires that, and without
/// the parts and the nodes where the domain touches itself that [`Cleaning`] removes.
///
/// The mesh that it is derived from does not change. The differences are a [`MeshPatch`], a pure function of
/// the mesh and the domain, independent of the order of the mesh's entries.
#[derive(Clone, Debug)]
pub struct DerivedMesh {
    patch: MeshPatch,
    fit: Option<OutlineFit>,
    line_fits: Vec<LineFit>,
    removed: Removed,
    removed_triangles: Vec<[LatticePoint; 3]>,
    allows_pinches: bool,
    corner_limit: f64,
}

impl DerivedMesh {
    /// Derives the mesh. Time and memory grow with the mesh, and above all with the triangles along the
    /// outline.
    ///
    /// Where the triangles of the mesh meet these targets, no edge is longer than h̄ at any point of the
    /// triangles beside it; without targets, edges may have any length.
    pub fn new(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        targets: Option<EdgeTargets>,
        cleaning: &Cleaning,
    ) -> Self {
        Self::watched(mesh, domain, targets, cleaning, &mut |_, _| {})
    }

    /// [`Self::new`], which tells `watch` of each stage.
    pub(super) fn watched(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        targets: Option<EdgeTargets>,
        cleaning: &Cleaning,
        watch: Watch<'_>,
    ) -> Self {
        let region = domain.region_on_outline();
        let changes = region.map(|region| OutlineChanges::new(mesh, region, targets, watch));
        if changes.is_none() {
            watch(DerivationAction::RemoveByCentroid, &MeshPatch::default);
        }
        let (derived, _) = Self::cleaned(mesh, domain, changes, targets, cleaning);
        watch(DerivationAction::Clean, &|| derived.patch.clone());
        derived
    }

    /// Returns the mesh that [`Self::new`] derives, from nodes on the outline that were kept in step with the
    /// mesh. A better boundary and edges along lines are made anew.
    pub fn of_follower(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        outline: &OutlineFollower,
        targets: Option<EdgeTargets>,
        cleaning: &Cleaning,
    ) -> Self {
        Self::cleaned(mesh, domain, Some(outline.changes(mesh)), targets, cleaning).0
    }

    /// Returns the mesh with these changes for the nodes on its outline, and the islands that were changed
    /// after these.
    pub(super) fn cleaned(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        changes: Option<OutlineChanges>,
        targets: Option<EdgeTargets>,
        cleaning: &Cleaning,
    ) -> (Self, DerivedIslands) {
        let mut islands = DerivedIslands::default();
        let (mut patch, fit, mut corner_limit) = match changes {
            Some(OutlineChanges { patch, fit, corner_limit }) => (patch, Some(fit), corner_limit),
            None => (MeshPatch::default(), None, 0.0),
        };
        if let Some(region) = domain.region_on_outline().filter(|_| cleaning.improves_boundary) {
            let (better, changed) = with_better_boundary(mesh, &patch, region, targets);
            (patch, islands.better) = (better, Some(changed));
        }
        let mut line_fits = Vec::new();
        if let Some(lines) = domain.lines() {
            let fitted = fit_lines(mesh, &patch, lines, domain.region_on_outline(), targets);
            (patch, line_fits, islands.lines) = (fitted.patch, fitted.fits, Some(fitted.islands));
            corner_limit = corner_limit.max(fitted.corner_limit);
        }
        let mut removed_triangles = Vec::new();
        let removed = patch.clean_and_report(mesh, cleaning, &mut |corners| removed_triangles.push(corners));
        let removed_triangles =
            removed_triangles.into_iter().map(|corners| corners.map(|node| patch.node(mesh, node))).collect();
        if removed.triangles > 0 && !line_fits.is_empty() {
            let extract = mesh.extract_with(&patch);
            line_fits.iter_mut().for_each(|fit| fit.keep_edges_of(&extract));
        }
        let allows_pinches = fit.is_none() && cleaning.keeps_pinches;
        let derived =
            Self { patch, fit, line_fits, removed, removed_triangles, allows_pinches, corner_limit };
        (derived, islands)
    }

    /// Returns the mesh with the changes, for files and summaries.
    ///
    /// # Panics
    /// Panics when `mesh` is not the one that the changes were derived from.
    pub fn extract<'a>(&self, mesh: &'a Mesh) -> Extract<'a> {
        mesh.extract_with(&self.patch)
    }

    /// Returns the differences from the mesh.
    pub fn patch(&self) -> &MeshPatch {
        &self.patch
    }

    /// Returns the fit of the boundary to the outline, including the parts that were removed; `None` if the
    /// domain does not require nodes on the outline.
    pub fn fit(&self) -> Option<OutlineFit> {
        self.fit
    }

    /// Returns how well the mesh fits the lines of the domain, in their order.
    pub fn line_fits(&self) -> &[LineFit] {
        &self.line_fits
    }

    /// Returns the numbers of removed parts and nodes.
    pub fn removed(&self) -> &Removed {
        &self.removed
    }

    /// Returns the corners of the triangles that were removed, anticlockwise.
    pub fn removed_triangles(&self) -> &[[LatticePoint; 3]] {
        &self.removed_triangles
    }

    pub(super) fn allows_pinches(&self) -> bool {
        self.allows_pinches
    }

    /// Returns the cotangent of the smallest angle that a triangle may have.
    pub(super) fn largest_cotangent(&self, angles: &Angles) -> f64 {
        angles.limit().max(self.corner_limit)
    }
}
