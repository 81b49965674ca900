//! A document and its follower, and what must hold wherever the follower stops.

use std::collections::HashSet;
use std::ops::Range;

use glam::dvec2;
use meshbrush_core::build::BuildError;
use meshbrush_core::document::{Document, Follower, MeshChange, Pricer, Readings, Settings, Stage};
use meshbrush_core::layers::{LevelCache, PaintLayers};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Fingerprint, Mesh, NodeId, Progress, Triangle, TriangleId};

use super::Operation;
use super::prices::check_price;

/// A document and its follower, with a copy of the mesh that only hears of changed ranges, as the GPU does.
pub struct Driver {
    pub document: Document,
    pub follower: Follower,
    /// Kept from edit to edit, as under the pointer.
    readings: Readings,
    pricer: Pricer,
    nodes: Vec<LatticePoint>,
    triangles: Vec<Triangle>,
    /// The document's revision when work was last given up: until the next the mesh may lag behind.
    given_up: Option<u64>,
    /// How often ranges of the shown mesh changed.
    pub changes_within: usize,
    /// How often the mesh was compared with one made from scratch.
    pub compared: usize,
    /// How often a price was compared with what the stroke costs.
    pub priced: usize,
    /// The settings and the mesh at each rest.
    pub rests: Vec<(Settings, Fingerprint)>,
}

impl Driver {
    pub fn new(settings: Settings) -> Self {
        let mut document = Document::new(settings, None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        let (nodes, triangles) = (Vec::new(), Vec::new());
        let readings = Readings::default();
        Self {
            document,
            follower,
            readings,
            pricer: Pricer::default(),
            nodes,
            triangles,
            given_up: None,
            changes_within: 0,
            compared: 0,
            priced: 0,
            rests: Vec::new(),
        }
    }

    pub fn apply(&mut self, operation: Operation) {
        if matches!(operation, Operation::CancelUpdate) {
            self.follower.cancel(&self.document);
            self.given_up = Some(self.document.revision());
        }
        match operation {
            Operation::Reopen => self.reopen(),
            operation => operation.apply(&mut self.document),
        }
        self.check_readings();
    }

    /// Checks that earlier readings do not change later ones.
    fn check_readings(&mut self) {
        let Self { document, follower, readings, .. } = self;
        for at in [dvec2(0.31, 0.62), dvec2(0.77, 0.24)] {
            let alone = follower.field().quick_decision_at(&mut LevelCache::default(), document.paint(), at);
            assert_eq!(readings.decision_at(document, follower, at), alone);
        }
    }

    /// Saves and opens as the window does: with another follower, whose mesh must be the one at rest
    /// before.
    fn reopen(&mut self) {
        self.settle();
        let mut opened = self.document.clone();
        Operation::Reopen.apply(&mut opened);
        let follower = Follower::new(&mut opened);
        assert_eq!(follower.is_ok(), Follower::new(&mut self.document.clone()).is_ok());
        // Where paint cannot be met there is no mesh to open with.
        let Ok(follower) = follower else { return };
        if self.given_up != Some(self.document.revision()) {
            assert_eq!(follower.mesh().fingerprint(), self.follower.mesh().fingerprint());
        }
        (self.document, self.follower, self.given_up) = (opened, follower, None);
        self.check_stop();
    }

    /// One slice of work, and what must hold wherever the work stops.
    pub fn advance(&mut self, visits: usize) {
        self.work(visits);
        self.check_stop();
    }

    /// Returns one slice of work, as in the window: of the stroke under way, or of what follows from it. True
    /// at rest.
    fn work(&mut self, visits: usize) -> bool {
        if self.document.advance_stroke(visits) == Progress::More {
            return false;
        }
        let stage = self.follower.advance(&mut self.document, visits).unwrap_or_else(|error| {
            self.refused(&error);
            Stage::Checking
        });
        stage.is_settled()
    }

    /// As the window does: a setting that cannot be met is taken back, paint stays.
    fn refused(&mut self, error: &BuildError) {
        assert!(error.to_string().ends_with('.'), "{error}");
        if self.document.settings() != self.follower.settings() {
            self.document.reject_last();
        }
    }

    fn check_stop(&mut self) {
        let change = self.follower.take_change();
        let mesh = self.follower.mesh();
        if change.is_some() {
            assert_eq!(mesh.violations(), []);
        }
        match change {
            Some(MeshChange::Replaced) => {
                self.nodes = mesh.raw_nodes().to_vec();
                self.triangles = mesh.raw_triangles().to_vec();
            }
            Some(MeshChange::Within(changes)) => {
                self.changes_within += 1;
                patch(&mut self.nodes, mesh.raw_nodes(), &changes.nodes);
                patch(&mut self.triangles, mesh.raw_triangles(), &changes.triangles);
            }
            None => {}
        }
        assert!(self.nodes == mesh.raw_nodes(), "a node changed and was not reported");
        assert!(self.triangles == mesh.raw_triangles(), "a triangle changed and was not reported");
    }

    /// Works on to rest, where the mesh must be the one made from scratch.
    pub fn settle(&mut self) {
        let settled = (0..1_000_000).any(|_| self.work(997));
        assert!(settled, "the follower never gets in step");
        self.check_stop();
        if self.given_up == Some(self.document.revision()) {
            return;
        }
        // Paint that cannot be met stays, and the mesh is then an earlier one.
        if let Ok(rebuilt) = Follower::new(&mut self.document.clone()) {
            assert!(
                self.follower.mesh().fingerprint() == rebuilt.mesh().fingerprint(),
                "another mesh than from scratch: {}",
                difference(self.follower.mesh(), rebuilt.mesh())
            );
            assert!(
                derived(&self.follower, self.document.paint()) == derived(&rebuilt, self.document.paint()),
                "the derived mesh is another"
            );
            let Self { document, follower, pricer, compared, .. } = self;
            self.priced += usize::from(check_price(pricer, *compared, document, follower));
            self.compared += 1;
            self.rests.push((self.document.settings().clone(), rebuilt.mesh().fingerprint()));
        }
    }
}

/// Returns how many triangles are in only one of two meshes, and the first of each.
fn difference(followed: &Mesh, rebuilt: &Mesh) -> String {
    let corners = |mesh: &Mesh| {
        let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        ids.map(|id| mesh.triangle(id).vertices.map(|node| mesh.world(node).to_array().map(f64::to_bits)))
            .collect::<HashSet<_>>()
    };
    let (followed, rebuilt) = (corners(followed), corners(rebuilt));
    let only = |these: &HashSet<[[u64; 2]; 3]>, others| {
        let mut only = these.difference(others).map(|corners| corners.map(|p| p.map(f64::from_bits)));
        format!("{} of {}, such as {:?}", these.difference(others).count(), these.len(), only.next())
    };
    format!("followed {}; from scratch {}", only(&followed, &rebuilt), only(&rebuilt, &followed))
}

/// Returns the triangles that leave the program, as corners in any order.
fn derived(follower: &Follower, paint: &PaintLayers) -> Vec<[LatticePoint; 3]> {
    let cleaning = follower.settings().derived_cleaning();
    let targets = follower.edge_targets(paint);
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
    let extract = derived.extract(follower.mesh());
    assert_eq!(derived.violations(&extract), []);
    let corners = |corners: [usize; 3]| {
        let mut corners = corners.map(|node| extract.node(NodeId::from_index(node)));
        corners.sort_unstable_by_key(|p| [p.x, p.y]);
        corners
    };
    let mut triangles: Vec<_> = extract.cells().map(|cell| corners(cell.corners)).collect();
    triangles.sort_unstable_by_key(|corners| corners.map(|p| [p.x, p.y]));
    triangles
}

fn patch<T: Copy>(copy: &mut Vec<T>, now: &[T], ranges: &[Range<usize>]) {
    copy.truncate(now.len());
    for range in ranges {
        // New entries are in the ranges, which ascend.
        assert!(range.start <= copy.len(), "entries are new and were not reported");
        copy.extend_from_slice(&now[copy.len().min(range.end)..range.end]);
        copy[range.clone()].copy_from_slice(&now[range.clone()]);
    }
}
