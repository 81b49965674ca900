//! Nodes on an outline, better triangles along it and edges along lines that are kept in step with a mesh,
//! against those derived from scratch.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, MeshChange, Setting, Settings, Stage};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::layers::{Layer, LayerKind, PaintLayers};
use meshbrush_core::outline::{DerivedFollower, DerivedMesh, MeshDerivation};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::geometry::{LatticePoint, Rect};
use meshbrush_mesh::mesh::{Changes, Cleaning, Mesh, PatchPieces, Progress, Triangle};

use crate::lines::random::lines;
use crate::random_coast::{place, random_coast};
use crate::runs::runs;

/// Returns the triangles of a derived mesh, by their corners, in ascending order.
fn triangles(mesh: &Mesh, derived: &DerivedMesh) -> Vec<[LatticePoint; 3]> {
    let extract = derived.extract(mesh);
    let turned = |cell: meshbrush_mesh::mesh::Cell| {
        let corners = cell.corners.map(|node| extract.nodes()[node]);
        let lowest = (0..3).min_by_key(|&i| corners[i]).unwrap();
        [0, 1, 2].map(|i| corners[(lowest + i) % 3])
    };
    let mut triangles: Vec<_> = extract.cells().map(turned).collect();
    triangles.sort_unstable();
    triangles
}

/// What is drawn in place of the triangles of a mesh.
#[derive(PartialEq)]
struct Drawn {
    /// The corners of each triangle from the lowest one on, with its level, and whether the edges from each
    /// corner to the next are on the boundary.
    pieces: Vec<([LatticePoint; 3], u32, [bool; 3])>,
    /// The corners of the triangles of the mesh that are drawn themselves.
    others: Vec<[LatticePoint; 3]>,
}

impl Drawn {
    fn of(mesh: &Mesh, pieces: &PatchPieces) -> Self {
        let of_piece = |piece: &Triangle| {
            let corners = piece.edge_nodes().map(|(from, _)| pieces.nodes()[from.index()]);
            let on_boundary = piece.raw_neighbours.map(|across| across.triangle().is_none());
            let lowest = (0..3).min_by_key(|&i| corners[i]).unwrap();
            let turned = [0, 1, 2].map(|i| (lowest + i) % 3);
            (turned.map(|i| corners[i]), piece.level(), turned.map(|i| on_boundary[i]))
        };
        let ranges: Vec<_> = pieces.replacements().map(|(_, range)| range).collect();
        let shown = ranges.into_iter().flat_map(|range| &pieces.triangles()[range]);
        let mut all: Vec<_> = shown.map(of_piece).collect();
        all.sort_unstable();
        let is_shown = |piece: &&Triangle| !piece.is_outside();
        assert_eq!(all.len(), pieces.triangles().iter().filter(is_shown).count(), "retired ones are outside");
        let others = mesh.triangles().filter(|(id, _)| pieces.replacement(*id).is_none());
        let mut others: Vec<_> = others.map(|(id, _)| mesh.corners(id)).collect();
        others.sort_unstable();
        Self { pieces: all, others }
    }
}

/// Returns the pieces of a mesh that is derived from scratch.
fn pieces_of(mesh: &Mesh, derived: &DerivedMesh) -> PatchPieces {
    PatchPieces::new(mesh, derived.patch(), &derived.extract(mesh))
}

/// Returns what keeps a derived mesh in step, and its pieces, derived in steps of random sizes.
fn derived_in_steps(
    follower: &Follower,
    paint: &PaintLayers,
    random: &mut Rng,
) -> (DerivedFollower, PatchPieces) {
    let (mesh, domain) = (follower.shared_mesh(), follower.domain().clone());
    let targets = follower.shared_targets(paint);
    let mut derivation = MeshDerivation::new(mesh, domain, targets, cleaning_of(follower), true);
    while derivation.advance_by(random.usize(..100)) == Progress::More {}
    let pieces = pieces_of(follower.mesh(), &derivation.take_derived().unwrap());
    (derivation.take_follower().unwrap(), pieces)
}

/// Returns the cleaning that keeps all parts of a mesh.
fn cleaning_of(follower: &Follower) -> Cleaning {
    let improves_boundary = follower.settings().derived_cleaning().improves_boundary;
    Cleaning { improves_boundary, ..Cleaning::NONE }
}

/// What is derived from the mesh of a document.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Nodes on the outline of a random coast.
    Coast,
    /// And better triangles along it.
    BetterCoast,
    /// Lines on a random coast.
    LinesOnCoast,
    LinesOnBetterCoast,
    /// Lines in a staircase of triangles along a random coast.
    LinesInStairs,
    /// Lines in a rectangle.
    LinesInRectangle,
}

impl Kind {
    fn has_lines(self) -> bool {
        !matches!(self, Self::Coast | Self::BetterCoast)
    }

    fn is_better(self) -> bool {
        matches!(self, Self::BetterCoast | Self::LinesOnBetterCoast)
    }
}

/// A document whose derived mesh is kept in step.
struct Scene {
    document: Document,
    follower: Follower,
    derived: DerivedFollower,
    /// The pieces that are drawn, each in the place of a former one.
    pieces: PatchPieces,
    finest: f64,
    name: String,
}

impl Scene {
    /// Returns a random scene, in cells that are not square for every third number.
    fn new(seed: u64, kind: Kind) -> Self {
        let mut random = Rng::with_seed(seed);
        let stretch = if seed.is_multiple_of(3) { dvec2(1.0, 0.73 + 0.2 * random.f64()) } else { DVec2::ONE };
        let mut polygons = random_coast(&mut random);
        polygons.iter_mut().flatten().flatten().for_each(|p| *p *= stretch);
        let domain = match kind {
            Kind::LinesInRectangle => Domain::rectangle(Rect::new(DVec2::ZERO, stretch)),
            _ => Domain::of_polygons(&polygons).unwrap(),
        };
        let size = domain.bounds.size().max_element();
        let diameter = size * 0.012 * 4f64.powf(random.f64());
        let mut settings = Settings::for_domain("coast".into(), domain);
        settings.boundary = match kind {
            Kind::LinesInStairs => BoundaryTreatment::Fitted { diameter },
            _ => BoundaryTreatment::OnOutline { diameter },
        };
        settings.cleaning.improves_boundary = kind.is_better();
        if kind.has_lines() {
            let mut lines = lines(&mut random);
            lines.iter_mut().flat_map(|line| &mut line.points).for_each(|p| *p *= stretch);
            settings.lines = lines.into();
        }
        // Edges that are too long, or none.
        let target = if seed.is_multiple_of(2) { (0.8 + random.f64()) * diameter } else { 0.2 * size };
        settings.layers = Layer::default_stack(LayerKind::constant(target));
        let finest = 0.2 * diameter;
        (settings.transfer.h_min, settings.transfer.h_risk) = (finest, finest);
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        follower.take_change();
        let (derived, pieces) = derived_in_steps(&follower, document.paint(), &mut random);
        Self { document, follower, derived, pieces, finest, name: format!("seed {seed}") }
    }

    /// Paints or erases a dab, mostly at the coast, or changes the layers or takes something back.
    fn edit(&mut self, random: &mut Rng) {
        let bounds = self.document.settings().domain.bounds;
        let at = bounds.min + place(random) * bounds.size();
        match random.u32(..6) {
            0 => _ = self.document.undo(),
            1 => _ = self.document.redo(),
            2 if random.bool() => {
                // Often no triangle of the mesh changes by that, and only edges on the outline do.
                let mut layers = self.document.settings().layers.clone();
                layers[0].kind = LayerKind::constant(self.finest * (4.0 + 5.0 * random.f64()));
                self.document.set(Setting::Layers(layers)).unwrap();
                self.document.end_gesture();
            }
            2 => {
                let mut layers = self.document.settings().layers.clone();
                let last = layers.len() - 1;
                layers[last].visible ^= true;
                self.document.set(Setting::Layers(layers)).unwrap();
                self.document.end_gesture();
            }
            _ => {
                let diameter = self.finest * 8f64.powf(random.f64());
                let change =
                    if random.u32(..3) == 0 { DiameterChange::Coarser } else { DiameterChange::Finer };
                let radius = self.finest * (4.0 + 30.0 * random.f64());
                let (medium, hardness) = (Medium::Diameter(diameter, change), random.f64());
                self.document.begin_stroke(Brush { medium, radius, hardness, strength: 1.0 });
                self.document.draw_to(at);
                if random.bool() {
                    self.document.draw_to(at + 4.0 * radius * (place(random) - 0.5));
                }
                self.document.end_stroke();
            }
        }
    }

    /// Follows the document up to a random slice or to rest, and returns whether the mesh changed.
    fn follow(&mut self, random: &mut Rng) -> bool {
        let slices = if random.bool() { usize::MAX } else { random.usize(1..4) };
        for _ in 0..slices {
            if self.follower.advance(&mut self.document, 2000).unwrap() == Stage::InStep {
                break;
            }
        }
        match self.follower.take_change() {
            None => false,
            Some(MeshChange::Within(changes)) => {
                self.replace(&changes);
                true
            }
            Some(MeshChange::Replaced) => {
                (self.derived, self.pieces) = derived_in_steps(&self.follower, self.document.paint(), random);
                true
            }
        }
    }

    fn replace(&mut self, changes: &Changes) {
        let mesh = self.follower.mesh();
        let targets = self.follower.edge_targets(self.document.paint());
        let ids = self.derived.update(mesh, targets, changes, usize::MAX).unwrap();
        let replacements = ids.iter().map(|&id| self.derived.replacement(mesh, id));
        let touched = self.pieces.replace(mesh, changes, replacements);
        let is_touched = |id| touched.iter().any(|(touched, _)| *touched == id);
        let replaced = ids.iter().filter(|id| self.pieces.replacement(**id).is_some());
        assert!(replaced.copied().all(is_touched), "{}: pieces are drawn only if they are noted", self.name);
    }

    fn check(&self, edit: usize) {
        let (mesh, domain) = (self.follower.mesh(), self.follower.domain());
        let targets = self.follower.edge_targets(self.document.paint());
        let cleaning = cleaning_of(&self.follower);
        let scratch = DerivedMesh::new(mesh, domain, targets, &cleaning);
        let name = format!("{}, edit {edit}", self.name);
        if let Some(outline) = self.derived.outline() {
            let kept = DerivedMesh::of_follower(mesh, domain, outline, targets, &cleaning);
            assert!(triangles(mesh, &kept) == triangles(mesh, &scratch), "{name}: other triangles");
            assert_eq!(kept.fit(), scratch.fit(), "{name}");
            assert_eq!(kept.violations(&kept.extract(mesh)), [], "{name}");
        }
        let drawn = Drawn::of(mesh, &self.pieces);
        let from_scratch = Drawn::of(mesh, &pieces_of(mesh, &scratch));
        assert!(drawn.pieces == from_scratch.pieces, "{name}: other pieces are drawn");
        assert!(drawn.others == from_scratch.others, "{name}: others are drawn without pieces");
    }
}

/// Edits scenes, and returns how often their meshes changed.
fn edited(seeds: impl Iterator<Item = u64>, kind: Kind, edits: usize) -> usize {
    let mut changed = 0;
    for seed in seeds {
        let (mut scene, mut random) = (Scene::new(seed, kind), Rng::with_seed(seed));
        for edit in 0..edits {
            scene.edit(&mut random);
            if scene.follow(&mut random) {
                scene.check(edit);
                changed += 1;
            }
        }
    }
    changed
}

#[test]
fn nodes_kept_on_the_outline_are_those_derived_from_scratch() {
    let changed = edited(0..runs(10), Kind::Coast, 25);
    assert!(changed > 60, "{changed} edits changed the mesh");
}

#[test]
fn better_triangles_kept_along_the_outline_are_those_derived_from_scratch() {
    let changed = edited(10..10 + runs(4), Kind::BetterCoast, 20);
    assert!(changed > 25, "{changed} edits changed the mesh");
}

#[test]
fn edges_kept_along_lines_are_those_derived_from_scratch() {
    let changed = edited(20..20 + runs(5), Kind::LinesOnCoast, 20);
    assert!(changed > 25, "{changed} edits changed the mesh");
}

#[test]
fn edges_kept_along_lines_beside_better_triangles_are_those_derived_from_scratch() {
    let changed = edited(30..30 + runs(4), Kind::LinesOnBetterCoast, 20);
    assert!(changed > 20, "{changed} edits changed the mesh");
}

#[test]
fn edges_kept_along_lines_without_an_outline_are_those_derived_from_scratch() {
    let changed =
        [Kind::LinesInStairs, Kind::LinesInRectangle].map(|kind| edited(40..40 + runs(4), kind, 20));
    assert!(changed.iter().all(|&changed| changed > 20), "{changed:?} edits changed the mesh");
}

#[test]
fn a_change_near_the_outline_that_is_too_large_is_reported() {
    let (mut scene, mut random) = (Scene::new(2, Kind::Coast), Rng::with_seed(2));
    let (mut some, mut none) = (0, 0);
    for _ in 0..30 {
        scene.edit(&mut random);
        while scene.follower.advance(&mut scene.document, 2000).unwrap() != Stage::InStep {}
        let Some(MeshChange::Within(changes)) = scene.follower.take_change() else { continue };
        let mut limited = scene.derived.clone();
        let targets = scene.follower.edge_targets(scene.document.paint());
        let most = random.usize(1..200);
        let few = limited.update(scene.follower.mesh(), targets, &changes, most);
        let all = scene.derived.update(scene.follower.mesh(), targets, &changes, usize::MAX).unwrap();
        match few {
            Some(few) => {
                assert_eq!(few, all);
                some += 1;
            }
            None => {
                assert!(all.len() > most, "{} changed, and {most} may", all.len());
                none += 1;
            }
        }
    }
    assert!(some > 0 && none > 0, "{some} small changes, {none} large ones");
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let in_pool = |threads: usize, kind: Kind| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut scene, mut random) = (Scene::new(4, kind), Rng::with_seed(7));
            for _ in 0..8 {
                scene.edit(&mut random);
                scene.follow(&mut random);
            }
            let (mesh, domain) = (scene.follower.mesh(), scene.follower.domain());
            let targets = scene.follower.edge_targets(scene.document.paint());
            let scratch = DerivedMesh::new(mesh, domain, targets, &cleaning_of(&scene.follower));
            (scratch.patch().clone(), Drawn::of(mesh, &scene.pieces))
        })
    };
    for kind in [Kind::Coast, Kind::LinesOnBetterCoast] {
        let one = in_pool(1, kind);
        for threads in [2, 3, 8] {
            assert!(in_pool(threads, kind) == one, "{threads} threads");
        }
    }
}
