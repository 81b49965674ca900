//! A picture that is redrawn only where the mesh changed equals the picture that is drawn whole, pixel by
//! pixel.

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, MeshChange, Setting, Settings, Stage};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::colormap::LevelColors;
use meshbrush_render::render::software::{self, KeptPicture, PxRect};
use meshbrush_render::scene::{Camera, ShownMesh, ShownRevision, Style};

const SIZE: [u32; 2] = [221, 173];
const STEPS: usize = 120;

/// A document with its mesh, seen by a camera.
struct Scene {
    document: Document,
    follower: Follower,
    camera: Camera,
    style: Style,
    kept: KeptPicture,
    random: fastrand::Rng,
}

impl Scene {
    fn new(settings: Settings, seed: u64) -> Self {
        let mut document = Document::new(settings, None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        let camera = Camera::fit(follower.mesh().lattice(), document.settings().domain.bounds, SIZE, 7.3);
        let colors: LevelColors =
            std::array::from_fn(|level| [40 + 3 * level as u8, 90, 20 * (level % 9) as u8, 255]).into();
        let (kept, random) = (KeptPicture::default(), fastrand::Rng::with_seed(seed));
        Self { document, follower, camera, style: Style::dark(colors), kept, random }
    }

    fn point(&mut self) -> DVec2 {
        let bounds = self.document.settings().domain.bounds;
        bounds.min + dvec2(self.random.f64(), self.random.f64()) * bounds.size()
    }

    /// An edit, a change of the view, or time for the mesh.
    fn step(&mut self) {
        match self.random.u8(0..20) {
            0..8 => self.dab(),
            8..10 => drop(self.document.undo()),
            10 => drop(self.document.redo()),
            11 => self.camera = self.camera.zoomed(0.6 + self.random.f64(), dvec2(90.0, 60.0)),
            12 => self.camera = self.camera.panned(dvec2(self.random.f64() * 30.0 - 15.0, 4.5)),
            13 => self.style.edges = !self.style.edges,
            _ => {}
        }
        let slice = self.random.usize(1..400);
        let slices = self.random.usize(1..30);
        for _ in 0..slices {
            if self.follower.advance(&mut self.document, slice).unwrap() == Stage::InStep {
                break;
            }
        }
    }

    fn dab(&mut self) {
        let extent = self.document.settings().domain.bounds.size().max_element();
        let medium = if self.random.bool() { Medium::Eraser } else { Medium::Risk(1.0) };
        let radius = extent * (0.01 + 0.1 * self.random.f64());
        let brush = Brush { medium, radius, hardness: 0.5, strength: 1.0 };
        let (from, to) = (self.point(), self.point());
        self.document.begin_stroke(brush);
        self.document.draw_to(from);
        self.document.draw_to(from.lerp(to, 0.2));
        self.document.end_stroke();
    }

    /// Tells the picture of the last changes and draws it; returns the part that was drawn.
    fn update(&mut self) -> Option<PxRect> {
        match self.follower.take_change() {
            Some(MeshChange::Within(changes)) => self.kept.note_changes(&changes, self.follower.mesh()),
            Some(MeshChange::Replaced) => self.kept.forget_mesh(),
            None => {}
        }
        let revision = ShownRevision { mesh: self.follower.revision(), pieces: 0 };
        let shown = ShownMesh::from(self.follower.mesh());
        self.kept.update(shown, revision, &self.camera, &self.style)
    }

    fn check(&mut self, step: usize) -> Option<PxRect> {
        let part = self.update();
        let whole = software::draw(self.follower.mesh(), &self.camera, &self.style, None, &[]);
        let kept = self.kept.image();
        assert_eq!(kept.size, whole.size);
        let differing = kept.pixels().iter().zip(whole.pixels()).position(|(a, b)| a != b);
        let at = differing.map(|index| [index as u32 % SIZE[0], index as u32 / SIZE[0]]);
        assert_eq!(at, None, "step {step}: a pixel differs; {part:?} was drawn again");
        part
    }
}

/// Runs random steps and checks that partial and whole drawing both happened often.
fn compare(settings: &Settings) {
    compare_in(settings, |_| {});
}

/// [`compare`] in another style.
fn compare_in(settings: &Settings, change: impl Fn(&mut Style)) {
    let (mut partial, mut whole) = (0, 0);
    for seed in 0..2 {
        let mut scene = Scene::new(settings.clone(), seed);
        change(&mut scene.style);
        for step in 0..STEPS {
            scene.step();
            match scene.check(step) {
                Some(part) if part == PxRect::whole(SIZE) => whole += 1,
                Some(_) => partial += 1,
                None => {}
            }
        }
    }
    assert!(partial > 30 && whole > 10, "{partial} drawn in part, {whole} drawn whole");
}

fn settings() -> Settings {
    let mut settings = Settings::default();
    (settings.transfer.h_min, settings.transfer.h_risk) = (0.004, 0.004);
    settings
}

#[test]
fn after_strokes_and_undo() {
    compare(&settings());
}

#[test]
fn where_triangles_are_far_smaller_than_pixels() {
    let mut settings = settings();
    (settings.transfer.h_min, settings.transfer.h_risk) = (0.0008, 0.0008);
    compare(&settings);
}

#[test]
fn where_triangles_far_smaller_than_pixels_are_merged() {
    let mut settings = settings();
    (settings.transfer.h_min, settings.transfer.h_risk) = (0.0008, 0.0008);
    compare_in(&settings, |style| style.merge_below_px = 1.4);
}

#[test]
fn along_an_outline_where_triangles_leave_the_domain() {
    let ring = |radius: f64| -> Vec<DVec2> {
        (0..40).map(|k| DVec2::splat(0.5) + radius * DVec2::from_angle(f64::from(k) * 0.157)).collect()
    };
    let domain = Domain::of_polygons(&[vec![ring(0.48), ring(0.2)]]).unwrap();
    let boundary = BoundaryTreatment::Fitted { diameter: 0.02 };
    compare(&Settings { domain, boundary, ..settings() });
}

#[test]
fn another_mesh_is_drawn_whole() {
    let mut scene = Scene::new(settings(), 1);
    assert_eq!(scene.check(0), Some(PxRect::whole(SIZE)));
    assert_eq!(scene.check(1), None, "nothing changed");
    scene.document.set(Setting::Bounds(Rect::new(DVec2::ZERO, dvec2(2.0, 1.0)))).unwrap();
    while scene.follower.advance(&mut scene.document, 1000).unwrap() != Stage::InStep {}
    assert_eq!(scene.check(2), Some(PxRect::whole(SIZE)));
}
