//! Nodes on an outline: derived from scratch, and kept in step with the mesh after a dab.
//!
//! *lake*: 1.8 million triangles, an outline of 200,000 corners, most of them closer to each other than the
//! triangles. *coast*: half a million triangles, all of them at a rough outline of 197,000 corners. Both as
//! they are, with a line across the outline at each place of a dab, and with better triangles along the
//! outline. Documents and followers are those of the window. For one thread and for all: the shortest of a few
//! runs from scratch, without and with the removal of parts and pinches, and with what follows edits, and the
//! median and the longest of dabs on the outline, painted and taken back.

use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_benches::documents::lake;
use meshbrush_benches::window::{Slices, wave};
use meshbrush_core::document::{Document, Follower, MeshChange, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, Line, LineKind};
use meshbrush_core::layers::{Layer, LayerKind, Quantity};
use meshbrush_core::outline::{DerivedFollower, DerivedMesh, MeshDerivation};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::mesh::{Changes, Cleaning, Progress};

/// Runs from scratch.
const RUNS: usize = 5;
/// Dabs, each painted and taken back.
const DABS: usize = 20;

/// What is asked for besides nodes on the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Besides {
    Nothing,
    Lines,
    BetterTriangles,
}

struct Scene {
    name: &'static str,
    besides: Besides,
    document: Document,
    /// A circle near the outline.
    radius: f64,
    /// The boundary diameter.
    diameter: f64,
}

impl Scene {
    fn new(
        name: &'static str,
        polygons: &[Vec<Vec<DVec2>>],
        diameter: f64,
        base: LayerKind,
        radius: f64,
    ) -> Self {
        let domain = Domain::of_polygons(polygons).expect("rings");
        let boundary = BoundaryTreatment::OnOutline { diameter };
        let layers = Layer::stack([base, LayerKind::paint(Quantity::Diameter)]);
        let mut settings = Settings { domain, boundary, layers, ..Settings::default() };
        (settings.transfer.h_min, settings.transfer.h_risk) = (0.2 * diameter, 0.2 * diameter);
        let document = Document::new(settings, None).expect("valid settings");
        Self { name, besides: Besides::Nothing, document, radius, diameter }
    }

    /// Asks for more. A line has twelve edges, each as long as eight triangles along the outline.
    fn with(mut self, besides: Besides) -> Self {
        let mut settings = self.document.settings().clone();
        settings.cleaning.improves_boundary = besides == Besides::BetterTriangles;
        if besides == Besides::Lines {
            let line = |n: usize| {
                let (out, edge) = (direction(n), 8.0 * self.diameter);
                let bend = |k: i32| f64::from(k % 2) * 0.4 * edge * out.perp();
                let corner = |k: i32| self.middle(n) + f64::from(k) * 0.6 * edge * out + bend(k);
                let points = (-6..=6).map(corner).collect();
                Line { name: format!("line {n}"), points, closed: false, kind: LineKind::Edges }
            };
            settings.lines = (0..DABS).map(line).collect::<Vec<Line>>().into();
        }
        self.document = Document::new(settings, None).expect("valid settings");
        self.besides = besides;
        self
    }

    /// The lake with an island of the bench *frame*.
    fn lake() -> Self {
        Self::new("lake", &lake(), 0.0011, wave(0.65, 0.0011), 0.48)
    }

    /// A line whose edges are halved and bent fourteen times.
    fn coast() -> Self {
        let mut random = fastrand::Rng::with_seed(3);
        let corner =
            |k: u32| dvec2(0.5, 0.5) + 0.42 * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 12.0);
        let mut ring: Vec<DVec2> = (0..12).map(corner).collect();
        for _ in 0..14 {
            let bent =
                |(a, b): (DVec2, DVec2)| [a, 0.5 * (a + b) + 0.5 * (random.f64() - 0.5) * (b - a).perp()];
            let next = ring.iter().skip(1).chain(&ring[..1]);
            ring = ring.iter().copied().zip(next.copied()).flat_map(bent).collect();
        }
        Self::new("coast", &[vec![ring]], 0.00012, LayerKind::constant(0.02), 0.42)
    }

    fn measure(&mut self, threads: usize) {
        let mut follower = Follower::new(&mut self.document).expect("it has a mesh");
        follower.take_change();
        let count = follower.mesh().raw_triangle_count();
        eprintln!("{} and {:?}, {count} triangles, {threads} threads", self.name, self.besides);
        let targets = follower.edge_targets(self.document.paint());
        let improves_boundary = self.besides == Besides::BetterTriangles;
        let none = Cleaning { improves_boundary, ..Cleaning::NONE };
        let cleaned = Cleaning { improves_boundary, ..Cleaning::FOR_SOLVERS };
        for (name, cleaning) in [("from scratch", none), ("and cleaned", cleaned)] {
            let runs = (0..RUNS).map(|_| {
                measured(|| _ = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning))
            });
            report(name, runs.min().expect("some runs"));
        }
        let both = || derived(&follower, &self.document, cleaned);
        report("and followed", (0..RUNS).map(|_| measured(|| _ = both())).min().expect("some runs"));
        let mut derived = both();
        let (mut times, mut changed) = (Vec::new(), 0);
        for n in 0..DABS {
            self.dab(n);
            for undone in [false, true] {
                if undone {
                    self.document.undo();
                }
                let Some(changes) = follow(&mut self.document, &mut follower) else { continue };
                changed += changes.triangles.iter().map(ExactSizeIterator::len).sum::<usize>();
                let targets = follower.edge_targets(self.document.paint());
                let update = || _ = derived.update(follower.mesh(), targets, &changes, usize::MAX);
                times.push(measured(update));
            }
        }
        times.sort();
        let each = changed / times.len().max(1);
        eprintln!("  {} changes of {each} triangles on average", times.len());
        report("after a dab", times[times.len() / 2]);
        report("at most", times[times.len() - 1]);
    }

    /// Paints triangles half as large as those along the outline, eight of these wide.
    fn dab(&mut self, number: usize) {
        let medium = Medium::Diameter(0.5 * self.diameter, DiameterChange::Finer);
        let radius = 4.0 * self.diameter;
        self.document.begin_stroke(Brush { medium, radius, hardness: 1.0, strength: 1.0 });
        self.document.draw_to(self.middle(number));
        self.document.end_stroke();
    }

    /// Returns the place of a dab.
    fn middle(&self, number: usize) -> DVec2 {
        dvec2(0.5, 0.5) + self.radius * direction(number)
    }
}

fn direction(number: usize) -> DVec2 {
    DVec2::from_angle(number as f64 / DABS as f64 * std::f64::consts::TAU)
}

/// Derives a mesh from scratch, with what keeps it in step.
fn derived(follower: &Follower, document: &Document, cleaning: Cleaning) -> DerivedFollower {
    let (mesh, domain) = (follower.shared_mesh(), follower.domain().clone());
    let targets = follower.shared_targets(document.paint());
    let mut derivation = MeshDerivation::new(mesh, domain, targets, cleaning, true);
    while derivation.advance() == Progress::More {}
    derivation.take_follower().expect("it has an outline")
}

/// Follows a document to rest, and returns what changed.
fn follow(document: &mut Document, follower: &mut Follower) -> Option<Changes> {
    Slices::default().follow(document, follower);
    match follower.take_change()? {
        MeshChange::Within(changes) => Some(changes),
        MeshChange::Replaced => unreachable!("paint changes the mesh where it is"),
    }
}

/// Returns the wall time of some work.
fn measured(work: impl FnOnce()) -> Duration {
    let began = Instant::now();
    work();
    began.elapsed()
}

fn report(name: &str, time: Duration) {
    eprintln!("  {name:12} {:8.2} ms", 1e3 * time.as_secs_f64());
}

fn main() {
    let all = [Besides::Nothing, Besides::Lines, Besides::BetterTriangles];
    let scenes =
        all.into_iter().flat_map(|besides| [Scene::lake().with(besides), Scene::coast().with(besides)]);
    for mut scene in scenes {
        for threads in [1, rayon::current_num_threads()] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| scene.measure(threads));
        }
    }
}
