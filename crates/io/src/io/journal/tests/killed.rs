//! Heavy documents, killed at any moment.

#[path = "../../../../../../tests/shared/runs.rs"]
#[allow(dead_code, reason = "other tests print tables")]
mod runs;

use std::sync::Arc;

use super::*;

/// A document with many layers, large polygons and much paint.
fn heavy(corners: u32) -> Document {
    let mut document = example();
    let corners = (0..corners).map(|n| f64::from(n) * std::f64::consts::TAU / f64::from(corners));
    let ring = corners.map(|angle| dvec2(0.5 + 0.5 * angle.cos(), 0.5 + 0.5 * angle.sin())).collect();
    let domain = meshbrush_core::domain::Domain::of_polygons(&[vec![ring]]).unwrap();
    document.set(Setting::Domain(domain)).unwrap();
    for n in 0..6 {
        gesture_of_any_kind(&mut document, n);
    }
    document.take_edits();
    document
}

/// A document with one raster, and layers to paint on.
fn light(kind: LayerKind) -> Document {
    let settings = Settings { layers: Layer::default_stack(kind), ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    document.take_edits();
    document
}

fn gesture_of_any_kind(document: &mut Document, n: u32) {
    let medium = if n % 3 == 2 { Medium::Eraser } else { Medium::Diameter(0.01, DiameterChange::Finer) };
    document.begin_stroke(Brush { medium, radius: 0.05, hardness: 0.5, strength: 0.7 });
    document.draw_to(dvec2(f64::from(n) * 0.618 % 1.0, 0.3));
    document.draw_to(dvec2(0.5, f64::from(n) * 0.37 % 1.0));
    document.end_stroke();
}

/// Copies a layer with its paint, as the window does.
fn duplicate(document: &mut Document, at: usize) {
    let mut layers = document.settings().layers.clone();
    let id = document.unused_layer_id();
    let original = layers[at].id;
    layers.insert(at + 1, Layer { id, ..layers[at].clone() });
    document.set(Setting::Layers(layers)).unwrap();
    document.copy_paint(original, id);
}

/// Adds the document to the journal, as the window does.
fn add_edits(journal: &mut Journal, document: &mut Document, time: u64) {
    let edits = document.take_edits();
    assert!(!edits.all_paint);
    journal.add(edits.settings.then(|| document.settings().clone()), document.paint(), time).unwrap();
}

fn parsed(path: &Path) -> KeptJournal {
    KeptJournal::parse(&fs::read(path).unwrap()).unwrap()
}

fn assert_kept(kept: &KeptJournal, expected: &Project) {
    assert_eq!(kept.project.settings, expected.settings, "at {}", kept.time);
    let painted = expected.settings.layers.iter().filter(|layer| layer.paints().is_some());
    let paint = expected.paint.of_layers(painted.map(|layer| layer.id));
    assert!(kept.project.paint == paint, "at {}", kept.time);
}

#[test]
fn a_copied_layer_and_a_changed_setting_write_little_whatever_the_document_weighs() {
    let folder = folder("little");
    let mut document = heavy(20_000);
    let mut journal = begin(&folder, &document, 0);
    let whole = length(&journal);
    assert!(whole > 100_000, "{whole}");
    for time in 1..=80 {
        let before = length(&journal);
        if time % 4 == 0 {
            document.set(Setting::SmallestDiameter(0.001 * (1.0 + time as f64))).unwrap();
        } else {
            duplicate(&mut document, time as usize % 2);
        }
        add_edits(&mut journal, &mut document, time);
        let grown = length(&journal) - before;
        assert!(grown < 1_000, "{grown} bytes at {time}");
        assert_kept(&parsed(&journal.path), &Project::of(&document));
    }
    // So does the whole of it once more: the copies share their pixels.
    let renewed = journal.recorded.begin_again();
    let again = record(WHOLE, 0, |out| renewed.write(out, &Meter::default())).unwrap().len() as u64;
    assert!(again < whole + 10_000, "{again} {whole}");
    fs::remove_dir_all(folder).unwrap();
}

/// A change of one kind or another, or of several.
fn random_edit(document: &mut Document, random: &mut fastrand::Rng, raster: &mut impl FnMut() -> LayerKind) {
    let count = document.settings().layers.len();
    match random.u32(..9) {
        0..=2 => gesture_of_any_kind(document, random.u32(..1000)),
        3 => duplicate(document, random.usize(..count)),
        4 => _ = document.undo(),
        5 => _ = document.redo(),
        6 => document.set(Setting::SmallestDiameter(random.f64() * 0.1 + 1e-3)).unwrap(),
        7 if count > 2 => {
            let mut layers = document.settings().layers.clone();
            layers.remove(random.usize(..count));
            document.set(Setting::Layers(layers)).unwrap();
        }
        _ => {
            let id = document.unused_layer_id();
            let mut layers = document.settings().layers.clone();
            let added = Layer::stack([raster()]).remove(0);
            layers.insert(random.usize(..=count), Layer { id, ..added });
            document.set(Setting::Layers(layers)).unwrap();
        }
    }
}

/// What the other thread does with a shorter journal.
enum Work {
    None,
    Pack(Renewal),
    Sync(Renewed),
}

/// A journal, and the bytes that went into it.
struct Counted {
    journal: Journal,
    work: Work,
    changed: u64,
    written: u64,
    /// Bytes of the whole document with which the journal begins, which are not among those written yet.
    whole: u64,
    renewals: u64,
}

impl Counted {
    /// Lets the other thread go on, or not.
    fn go_on(&mut self, time: u64, random: &mut fastrand::Rng) {
        let journal = &mut self.journal;
        self.work = match std::mem::replace(&mut self.work, Work::None) {
            Work::None => journal.renewal(time).map_or(Work::None, Work::Pack),
            Work::Pack(renewal) if random.bool() => {
                let mut renewed = renewal.pack().unwrap();
                journal.complete(&mut renewed).unwrap();
                Work::Sync(renewed)
            }
            Work::Sync(renewed) if random.bool() => {
                journal.replace_by(renewed).unwrap();
                self.written += length(journal) - journal.whole;
                self.written += std::mem::replace(&mut self.whole, journal.whole);
                self.renewals += 1;
                Work::None
            }
            work => work,
        };
    }

    /// Adds the document, and returns the length of its record.
    fn add(&mut self, document: &mut Document, time: u64) -> u64 {
        let before = length(&self.journal);
        add_edits(&mut self.journal, document, time);
        let grown = length(&self.journal) - before;
        (self.changed, self.written) = (self.changed + grown, self.written + grown);
        grown
    }
}

/// `MESHBRUSH_LONG=200 cargo test --release -p meshbrush-io --lib -- killed_at_any_moment` tries 200 of them.
#[test]
fn killed_at_any_moment_a_journal_has_every_gesture_and_is_bounded_by_what_changed() {
    let renewals: u64 = runs::seeds(1).map(kill_at_random_moments).sum();
    assert!(renewals > 0);
}

/// Returns how often a shorter journal was made.
fn kill_at_random_moments(seed: u64) -> u64 {
    let folder = folder(&format!("killed-{seed}"));
    let mut random = fastrand::Rng::with_seed(seed);
    let mut numbers = fastrand::Rng::with_seed(seed);
    let mut raster = || {
        let side = numbers.u32(2..60);
        let values = (0..side * side).map(|_| numbers.f32()).collect();
        let raster = Raster::from_values(meshbrush_mesh::geometry::Rect::UNIT, [side; 2], values);
        let source = RasterSource { name: "noise".into(), raster: Arc::new(RasterPyramid::new(raster)) };
        RasterLayer { source, reading: RasterReading::Risk }.into()
    };
    let mut document = if seed.is_multiple_of(2) { light(raster()) } else { heavy(300) };
    let journal = begin(&folder, &document, 0);
    let whole = length(&journal);
    let mut counted = Counted { journal, work: Work::None, changed: 0, written: 0, whole, renewals: 0 };
    let mut states = vec![Project::of(&document)];
    for _ in 0..40 {
        counted.go_on(states.len() as u64 - 1, &mut random);
        random_edit(&mut document, &mut random, &mut raster);
        let grown = counted.add(&mut document, states.len() as u64);
        if grown > 0 {
            states.push(Project::of(&document));
        }
        // Killed now, or while the last record was written.
        let bytes = fs::read(&counted.journal.path).unwrap();
        let lost = if random.bool() { 0 } else { random.usize(..=grown as usize) };
        let kept = KeptJournal::parse(&bytes[..bytes.len() - lost]).unwrap();
        assert_eq!(kept.time as usize, states.len() - 1 - usize::from(lost > 0), "seed {seed}");
        assert_kept(&kept, &states[kept.time as usize]);
    }
    let Counted { journal, changed, written, renewals, .. } = counted;
    // But for the last whole document; a file begins with 8 bytes.
    assert!(written <= 3 * changed + 8 * (1 + renewals), "{written} bytes for {changed}, seed {seed}");
    let bytes = fs::read(&journal.path).unwrap();
    for kept in (0..10).filter_map(|_| KeptJournal::parse(&bytes[..random.usize(..bytes.len())]).ok()) {
        assert_kept(&kept, &states[kept.time as usize]);
    }
    fs::remove_dir_all(folder).unwrap();
    renewals
}

#[test]
fn at_rest_nothing_is_to_be_done_after_a_shorter_journal() {
    let folder = folder("rest");
    let mut document = example();
    let mut journal = begin(&folder, &document, 0);
    let mut n = 0;
    let renewal = loop {
        add_gesture(&mut journal, &mut document, n, 1);
        n += 1;
        if let Some(renewal) = journal.renewal(1) {
            break renewal;
        }
    };
    for n in n..n + 3 {
        add_gesture(&mut journal, &mut document, n, 2);
        assert!(journal.renewal(2).is_none(), "one at a time");
    }
    let long = length(&journal);
    let mut renewed = renewal.pack().unwrap();
    journal.complete(&mut renewed).unwrap();
    add_gesture(&mut journal, &mut document, n, 3);
    journal.replace_by(renewed).unwrap();
    assert!(length(&journal) < long && journal.renewal(3).is_none());
    assert_kept(&parsed(&journal.path), &Project::of(&document));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_shorter_journal_that_is_given_up_leaves_the_longer_one() {
    let folder = folder("given-up");
    let mut document = example();
    let mut journal = begin(&folder, &document, 0);
    let mut n = 0;
    let renewal = loop {
        add_gesture(&mut journal, &mut document, n, 1);
        n += 1;
        if let Some(renewal) = journal.renewal(1) {
            break renewal;
        }
    };
    let renewed = renewal.pack().unwrap();
    journal.give_up_renewal();
    assert!(renewed.is_unwanted() && journal.renewal(1).is_none(), "not tried again at once");
    let long = length(&journal);
    journal.replace_by(renewed).unwrap();
    assert_eq!((length(&journal), fs::read_dir(&folder).unwrap().count()), (long, 1));
    assert_kept(&parsed(&journal.path), &Project::of(&document));
    fs::remove_dir_all(folder).unwrap();
}
