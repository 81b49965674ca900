mod killed;

use super::*;
use glam::dvec2;
use left::KeptJournal;
use meshbrush_core::document::{Document, Edits, Example, Setting, Settings};
use meshbrush_core::layers::{Layer, LayerKind, RasterLayer, RasterReading, RasterSource};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::raster::{Raster, RasterPyramid};
use std::sync::Arc;

/// Returns the unsaved work in a folder.
fn abandoned(folder: &Path) -> Vec<Abandoned> {
    let work = |left| match left {
        Left::Work(work) => *work,
        Left::Unreadable { path, problem } => panic!("{}: {problem}", path.display()),
    };
    left(folder).map(work).collect()
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("meshbrush-journal-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    folder
}

fn example() -> Document {
    let mut document = Example::Threats.without_data();
    document.take_edits();
    document
}

fn begin(folder: &Path, document: &Document, time: u64) -> Journal {
    Journal::begin(folder, Project::of(document), None, time, &Meter::default()).unwrap()
}

/// Paints or erases.
fn gesture(document: &mut Document, n: u32) {
    let medium = if n % 3 == 2 { Medium::Eraser } else { Medium::Diameter(0.01, DiameterChange::Finer) };
    document.begin_stroke(Brush { medium, radius: 0.05, hardness: 0.5, strength: 0.7 });
    let at = f64::from(n) * 0.618 % 1.0;
    document.draw_to(dvec2(at, 0.3));
    document.draw_to(dvec2(0.5, at));
    document.end_stroke();
    let Edits { settings, all_paint, layers } = document.take_edits();
    assert!(!settings && !all_paint && layers.len() == 1, "strokes change paint alone");
}

fn add_gesture(journal: &mut Journal, document: &mut Document, n: u32, time: u64) {
    gesture(document, n);
    journal.add(None, document.paint(), time).unwrap();
}

fn length(journal: &Journal) -> u64 {
    fs::metadata(&journal.path).unwrap().len()
}

#[test]
fn a_journal_cut_anywhere_has_all_complete_records() {
    let folder = folder("cuts");
    let mut document = example();
    let mut journal = begin(&folder, &document, 100);
    let mut versions = vec![(fs::metadata(&journal.path).unwrap().len() as usize, document.paint().clone())];
    for n in 0..12 {
        add_gesture(&mut journal, &mut document, n, 101 + u64::from(n));
        versions.push((fs::metadata(&journal.path).unwrap().len() as usize, document.paint().clone()));
    }
    let bytes = fs::read(&journal.path).unwrap();
    for cut in
        (0..bytes.len()).step_by(bytes.len() / 23).chain(versions.iter().flat_map(|&(end, _)| [end - 1, end]))
    {
        let whole = versions.partition_point(|&(end, _)| end <= cut);
        match KeptJournal::parse(&bytes[..cut]) {
            Err(_) => assert_eq!(whole, 0, "cut at {cut}"),
            Ok(kept) => {
                assert_eq!((kept.time, kept.clean), (99 + whole as u64, false));
                let kept = kept.project.into_document().unwrap();
                assert!(*kept.paint() == versions[whole - 1].1, "cut at {cut}");
            }
        }
    }
    let mut damaged = bytes.clone();
    damaged[versions[4].0 + 40] ^= 4;
    assert_eq!(KeptJournal::parse(&damaged).unwrap().time, 104);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn settings_are_kept_beside_the_paint() {
    let folder = folder("settings");
    let mut document = example();
    let mut journal = begin(&folder, &document, 1);
    add_gesture(&mut journal, &mut document, 0, 2);
    document.set(Setting::SmallestDiameter(0.0123)).unwrap();
    let Edits { settings, all_paint, layers } = document.take_edits();
    assert!(settings && !all_paint && layers.is_empty());
    journal.add(Some(document.settings().clone()), document.paint(), 3).unwrap();
    drop(journal);
    let kept = abandoned(&folder).pop().unwrap().project.into_document().unwrap();
    assert_eq!(kept.settings(), document.settings());
    assert!(kept.paint() == document.paint());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn rasters_and_pictures_are_written_once() {
    let folder = folder("once");
    let mut random = fastrand::Rng::with_seed(3);
    let mut raster = |name: &str| {
        let values = (0..100 * 100).map(|_| random.f32()).collect();
        let raster = Raster::from_values(meshbrush_mesh::geometry::Rect::UNIT, [100, 100], values);
        let source = RasterSource { name: name.into(), raster: Arc::new(RasterPyramid::new(raster)) };
        RasterLayer { source, reading: RasterReading::Risk }.into()
    };
    let rgba = (0..4 * 100 * 100).map(|n: u32| (n * n % 251) as u8 | (n % 4 / 3 * 255) as u8).collect();
    let mut settings = Settings { layers: Layer::stack([raster("first")]), ..Settings::default() };
    settings.background = Some(meshbrush_core::document::Background {
        name: "map".into(),
        picture: Arc::new(meshbrush_core::document::Picture { size: [100, 100], rgba }),
        bounds: meshbrush_mesh::geometry::Rect::UNIT,
        opacity: 0.5,
    });
    let project = Project { settings: settings.clone(), paint: PaintLayers::default() };
    let mut journal = Journal::begin(&folder, project, None, 1, &Meter::default()).unwrap();
    let mut before = length(&journal);
    for n in 0..5 {
        let is_new = n == 2;
        if is_new {
            settings.layers = Layer::stack([settings.layers[0].kind.clone(), raster("second")]);
        }
        settings.layers[0].name = format!("Slope {n}");
        journal.add(Some(settings.clone()), PaintLayers::blank(), 2).unwrap();
        let grown = length(&journal) - std::mem::replace(&mut before, length(&journal));
        assert_eq!(grown > 20_000, is_new, "{grown} bytes in record {n}");
        assert!(is_new || grown < 300, "{grown} bytes in record {n}");
    }
    drop(journal);
    assert_eq!(abandoned(&folder).pop().unwrap().project.settings, settings);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn only_unlocked_journals_with_unsaved_work_are_offered() {
    let folder = folder("offered");
    let mut document = example();
    let home = Path::new("/tmp/threats.meshbrush");
    let mut journal = begin(&folder, &document, 1);
    assert!(abandoned(&folder).is_empty(), "it is held");
    journal.mark_clean(Some(home), 2).unwrap();
    add_gesture(&mut journal, &mut document, 0, 3);
    drop(journal);
    let found = abandoned(&folder);
    assert_eq!((found.len(), found[0].time, found[0].home.as_deref()), (1, 3, Some(home)));
    assert!(abandoned(&folder).is_empty(), "another window was offered it");
    drop(found);
    assert_eq!(abandoned(&folder).len(), 1, "and may be again");
    abandoned(&folder).pop().unwrap().remove().unwrap();

    let mut journal = begin(&folder, &document, 1);
    journal.mark_clean(None, 2).unwrap();
    drop(journal);
    assert!(abandoned(&folder).is_empty());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "nothing unsaved: it is removed");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_journal_that_cannot_be_read_is_named_and_kept() {
    let folder = folder("unreadable");
    let document = example();
    let journal = begin(&folder, &document, 1);
    let path = journal.path.clone();
    drop(journal);
    let bytes = fs::read(&path).unwrap();
    let mut other_version = bytes.clone();
    other_version[7] = b'2';
    for (content, words) in [(&other_version[..], "another version"), (&bytes[..bytes.len() - 1], "damaged")]
    {
        fs::write(&path, content).unwrap();
        let found: Vec<Left> = left(&folder).collect();
        let [Left::Unreadable { path: named, problem }] = &found[..] else { panic!("{found:?}") };
        assert!(*named == path && problem.contains(words), "{problem}");
        assert_eq!(fs::read(&path).unwrap(), content);
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_complete_record_that_cannot_be_read_counts_as_unsaved() {
    let folder = folder("later");
    let mut document = example();
    let mut journal = begin(&folder, &document, 1);
    add_gesture(&mut journal, &mut document, 0, 2);
    journal.mark_clean(None, 3).unwrap();
    let newer = record(GESTURE, 4, |out| out.write_all(b"from a newer program")).unwrap();
    journal.append(&newer).unwrap();
    drop(journal);
    let kept = abandoned(&folder).pop().expect("nothing is thrown away");
    assert!(kept.time == 3 && kept.project.paint == *document.paint());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_a_killed_program_began_to_write_is_removed_unless_another_one_writes_it() {
    let folder = folder("begun");
    fs::create_dir_all(&folder).unwrap();
    let [left_behind, in_use] = ["1-0.part", "2-0.part"].map(|name| folder.join(name));
    fs::write(&left_behind, "half").unwrap();
    let lock = File::create(&in_use).unwrap();
    lock.try_lock().unwrap();
    assert!(abandoned(&folder).is_empty());
    assert!(!left_behind.exists() && in_use.exists());
    fs::remove_dir_all(folder).unwrap();
}
