//! The heights of the mesh on the screen, for the view in space. They are found on another thread.

use std::sync::Arc;

use glam::DVec2;

use super::derivation::{Derivation, MeasuredMesh};
use super::jobs::{Jobs, Slot, Wanted};
use meshbrush_core::document::{Document, Follower};
use meshbrush_core::surface::HeightSource;
use meshbrush_mesh::mesh::{Mesh, PatchPieces, TriangleId};
use meshbrush_render::scene::{
    HeightScale, NodeHeights, ShownSurface, SpaceCamera, SurfaceArrays, SurfaceIndex, ViewRay,
};

/// How far before a point of the surface another one hides it, in pixels towards the viewer.
const HIDDEN_PX: f64 = 1.0;

/// The mesh and the version of the document for which heights were found.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HeightsKey {
    mesh: MeasuredMesh,
    version: u64,
}

/// A mesh with its pieces and the heights of their nodes.
struct FoundHeights {
    mesh: Arc<Mesh>,
    pieces: PatchPieces,
    heights: NodeHeights,
    ends: [u32; 2],
    /// Indices of the mesh and of the pieces.
    indices: [SurfaceIndex; 2],
    /// A number that no other heights have.
    revision: u64,
}

/// Finds the heights of the mesh.
#[derive(Default)]
pub struct HeightFinder {
    /// The heights; none where no node has any.
    found: Slot<HeightsKey, Option<FoundHeights>>,
    started: u64,
}

/// What is known of the heights of the mesh on the screen.
pub enum Heights<'a> {
    /// They are there.
    Known(Surface<'a>),
    /// They are being found.
    Sought,
    /// No layer has heights where the mesh is.
    Missing,
}

/// A mesh as a surface: the one on the screen, or while heights are found for it, the former one.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    found: &'a FoundHeights,
    is_current: bool,
}

impl HeightFinder {
    /// Returns the heights of the mesh as it is.
    pub fn heights(&self, document: &Document, follower: &Follower, derivation: &Derivation) -> Heights<'_> {
        if HeightSource::new(follower.surface().map(|rule| &**rule), &document.settings().layers).is_none() {
            return Heights::Missing;
        }
        let mesh = MeasuredMesh::now(follower, derivation);
        match self.found.last() {
            Some((key, Some(found))) => Heights::Known(Surface { found, is_current: key.mesh == mesh }),
            Some((key, None)) if key.mesh == mesh => Heights::Missing,
            _ => Heights::Sought,
        }
    }

    /// Finds the heights of the mesh, and waits for them as long as the frame may. Returns whether they are
    /// being found.
    pub fn advance(
        &mut self,
        document: &Document,
        follower: &Follower,
        derivation: &Derivation,
        jobs: &Jobs,
    ) -> bool {
        self.found.take_ready(jobs);
        let key = HeightsKey { mesh: MeasuredMesh::now(follower, derivation), version: document.version() };
        self.found.want(&key, jobs);
        if !self.found.is_running() && !self.found.has(&key) {
            let layers = &document.settings().layers;
            let Some(source) = HeightSource::new(follower.surface().map(|rule| &**rule), layers) else {
                return false;
            };
            self.started += 1;
            let (mesh, pieces, revision) =
                (follower.shared_mesh(), derivation.pieces().clone(), self.started);
            let find = move |wanted: &Wanted| {
                wanted.goes_on().then(|| FoundHeights::new(&source, mesh, pieces, revision))
            };
            self.found.start_wanted(key, find, jobs);
        }
        self.found.take(jobs)
    }

    /// Forgets the heights: the view is that of the plan.
    pub fn stop(&mut self, jobs: &Jobs) {
        if self.found.last().is_some() || self.found.is_running() {
            self.found.stop(jobs);
        }
    }
}

impl FoundHeights {
    fn new(source: &HeightSource, mesh: Arc<Mesh>, pieces: PatchPieces, revision: u64) -> Option<Self> {
        let lattice = mesh.lattice();
        let mut of_mesh = source.at_nodes(lattice, mesh.raw_nodes());
        // What lies outside the domain counts for nothing.
        let mut is_shown = vec![false; of_mesh.len()];
        let inside = mesh.raw_triangles().iter().filter(|triangle| !triangle.is_outside());
        inside.flat_map(|triangle| triangle.vertices).for_each(|node| is_shown[node.index()] = true);
        of_mesh
            .iter_mut()
            .zip(is_shown)
            .filter(|(_, is_shown)| !is_shown)
            .for_each(|(height, _)| *height = None);
        let heights = NodeHeights::new(&of_mesh, &source.at_nodes(lattice, pieces.nodes()))?;
        let indices = arrays(&heights, &mesh, &pieces).map(SurfaceIndex::new);
        Some(Self { ends: heights.ends(), mesh, pieces, heights, indices, revision })
    }
}

fn arrays<'a>(heights: &'a NodeHeights, mesh: &'a Mesh, pieces: &'a PatchPieces) -> [SurfaceArrays<'a>; 2] {
    let of_mesh = (mesh.raw_nodes(), mesh.raw_triangles(), &heights.mesh);
    [of_mesh, (pieces.nodes(), pieces.triangles(), &heights.pieces)]
        .map(|(nodes, triangles, heights)| SurfaceArrays { nodes, triangles, heights })
}

impl<'a> Surface<'a> {
    /// Returns the mesh with its heights, to be drawn.
    pub fn shown(&self) -> ShownSurface<'a> {
        let FoundHeights { mesh, pieces, heights, .. } = self.found;
        ShownSurface { mesh, pieces: Some(pieces), heights }
    }

    /// Returns whether it is the mesh on the screen.
    pub fn is_current(&self) -> bool {
        self.is_current
    }

    /// Returns a number that no other surface has.
    pub fn revision(&self) -> u64 {
        self.found.revision
    }

    /// Returns the meaning of heights in steps, and the lowest and the highest of them.
    pub fn extent(&self) -> (HeightScale, [u32; 2]) {
        (self.found.heights.scale, self.found.ends)
    }

    /// Returns the height at a place in lattice steps, in steps; `None` beside the surface.
    pub fn height_at(&self, at: DVec2) -> Option<f64> {
        self.nearest(&ViewRay { at, per_step: DVec2::ZERO }).map(|(_, height)| height)
    }

    /// Returns the point nearest the viewer that a ray meets: its place in lattice steps, and its height in
    /// steps.
    fn nearest(&self, ray: &ViewRay) -> Option<(DVec2, f64)> {
        let FoundHeights { mesh, pieces, heights, indices: [mesh_index, piece_index], .. } = self.found;
        let is_drawn = |index| pieces.replacement(TriangleId::from_index(index)).is_none();
        let [of_mesh, of_pieces] = arrays(heights, mesh, pieces);
        let of_mesh = mesh_index.nearest(of_mesh, ray, is_drawn);
        let of_pieces = piece_index.nearest(of_pieces, ray, |_| true);
        [of_mesh, of_pieces].into_iter().flatten().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The surface as a camera sees it: where places of the plan are on the screen, and back.
#[derive(Clone, Copy)]
pub struct SpaceSight<'a> {
    /// The camera.
    pub camera: SpaceCamera,
    /// The surface.
    pub surface: Surface<'a>,
}

impl SpaceSight<'_> {
    /// Returns the place of the plan, in world units, that a pixel shows; beside the surface the one at the
    /// height of the middle.
    pub fn world(&self, px: DVec2) -> DVec2 {
        let lattice = self.camera.plan().lattice();
        match self.surface.nearest(&self.camera.ray(px)) {
            Some((place, _)) => lattice.bounds().min + place * lattice.step(),
            None => self.camera.world_from_screen(px),
        }
    }

    /// Returns the height that a pixel shows, in steps; `None` beside the surface.
    pub fn height_at_px(&self, px: DVec2) -> Option<f64> {
        self.surface.nearest(&self.camera.ray(px)).map(|(_, height)| height)
    }

    /// Returns the pixel of the surface at a place of the plan, in world units; beside the surface that at
    /// the height of the middle.
    pub fn screen(&self, world: DVec2) -> DVec2 {
        self.camera.screen_from_world(world, self.height_at(world).unwrap_or_else(|| self.camera.height()))
    }

    /// Returns whether something before it hides the surface at a place of the plan, in world units.
    pub fn is_hidden(&self, world: DVec2) -> bool {
        let Some(height) = self.height_at(world) else { return false };
        let before = self.height_at_px(self.camera.screen_from_world(world, height));
        // More than the rounding of the pixel.
        let [_, _, towards] = self.camera.rows();
        before.is_some_and(|before| towards.z.abs() * (before - height) > HIDDEN_PX)
    }

    /// Returns the height of the surface at a place of the plan, in steps; `None` beside it.
    fn height_at(&self, world: DVec2) -> Option<f64> {
        self.surface.height_at(self.camera.plan().lattice().lattice_from_world(world))
    }
}
