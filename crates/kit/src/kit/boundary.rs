//! The pieces of the document's boundary, for the tool that shows and names them, and which of them the
//! mesh lacks. Both are found on another thread: an outline of many corners takes longer than a frame.

use std::sync::Arc;

use super::derivation::{self, Derived};
use super::jobs::{Jobs, Slot};
use meshbrush_core::document::{Document, Follower};
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, Domain, MeshBoundary};

/// The domain, marks and mesh for which pieces were found.
#[derive(Clone, Debug, PartialEq)]
struct BoundaryKey {
    domain: Domain,
    marks: Arc<BoundaryMarks>,
    /// The revision of the mesh, for a domain that is given by a formula, since its boundary is the boundary
    /// of the mesh.
    revision: Option<u64>,
}

/// The data for which lost pieces were found: the pieces, and the exported mesh.
type LostKey = (BoundaryKey, derivation::DerivationKey);

/// Finds the pieces of the boundary.
#[derive(Default)]
pub struct BoundaryFinder {
    pieces: Slot<BoundaryKey, BoundaryPieces>,
    lost: Slot<LostKey, Vec<usize>>,
}

impl BoundaryFinder {
    /// Returns the pieces of the document; `None` until they are found.
    pub fn pieces(&self, document: &Document) -> Option<&BoundaryPieces> {
        self.pieces.last().filter(|(key, _)| is_current(key, document)).map(|(_, pieces)| pieces)
    }

    /// Returns the numbers of the pieces of which a derived mesh has no edge, in ascending order; `None`
    /// until they are found.
    pub fn lost(&self, document: &Document, derived: &Derived) -> Option<&[usize]> {
        let ((key, of), lost) = self.lost.last()?;
        (is_current(key, document) && of == derived.key()).then_some(lost)
    }

    /// Finds the pieces of the document, and which of them a derived mesh lacks, and waits for them as long
    /// as the frame may. Returns whether some are being found.
    pub fn advance(
        &mut self,
        document: &Document,
        follower: &Follower,
        derived: Option<&Derived>,
        jobs: &Jobs,
    ) -> bool {
        let is_finding = self.find_pieces(document, follower, derived, jobs);
        if let (false, Some(derived)) = (is_finding, derived) {
            self.find_lost(document, derived, jobs)
        } else {
            is_finding
        }
    }

    fn find_lost(&mut self, document: &Document, derived: &Derived, jobs: &Jobs) -> bool {
        self.lost.take_ready(jobs);
        let Some((key, pieces)) = self.pieces.last().filter(|(key, _)| is_current(key, document)) else {
            return false;
        };
        let key = (key.clone(), derived.key().clone());
        self.lost.want(&key, jobs);
        if !self.lost.is_running() && !self.lost.has(&key) {
            let (pieces, extract) = (pieces.clone(), derived.shared_extract());
            self.lost.start(key, move || MeshBoundary::from_pieces(&extract, pieces).lost().collect(), jobs);
        }
        self.lost.take(jobs)
    }

    fn find_pieces(
        &mut self,
        document: &Document,
        follower: &Follower,
        derived: Option<&Derived>,
        jobs: &Jobs,
    ) -> bool {
        self.pieces.take_ready(jobs);
        let is_of_mesh = document.settings().domain.formula().is_some();
        if is_of_mesh && !follower.is_in_step(document) {
            return false;
        }
        let is_derived = is_of_mesh && follower.settings().outline().is_some();
        if is_derived && derived.is_none() {
            return false;
        }
        let settings = document.settings();
        let (domain, marks) = (settings.domain.clone(), settings.boundary_marks.clone());
        let key = BoundaryKey { domain, marks, revision: is_of_mesh.then(|| follower.revision()) };
        self.pieces.want(&key, jobs);
        if !self.pieces.is_running() && !self.pieces.has(&key) {
            let BoundaryKey { domain, marks, revision } = key.clone();
            let mesh = revision.map(|_| follower.shared_mesh());
            let extract = derived.filter(|_| is_derived).map(Derived::shared_extract);
            let find = move || match (extract, mesh) {
                (Some(extract), _) => BoundaryPieces::of_mesh(&extract, &marks),
                (None, Some(mesh)) => BoundaryPieces::of_mesh(&mesh.extract(), &marks),
                (None, None) => {
                    BoundaryPieces::of_domain(&domain, &marks).expect("it is given by no formula")
                }
            };
            self.pieces.start(key, find, jobs);
        }
        self.pieces.take(jobs)
    }
}

fn is_current(key: &BoundaryKey, document: &Document) -> bool {
    let settings = document.settings();
    key.domain == settings.domain && key.marks == settings.boundary_marks
}
