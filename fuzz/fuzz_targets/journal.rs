//! Journals that were left behind: raw bytes, and records with valid checksums around changed parts.

#![no_main]

mod packing;

use std::fs;
use std::sync::LazyLock;

use meshbrush_io::io::Meter;
use meshbrush_io::io::journal::{self, Journal, Left};
use packing::{Parts, change, hold, packed, sample, unpacked};

const MAGIC: &[u8] = b"MBJOUR01";
const HEAD: usize = 17;

/// The parts of a whole project and of a gesture, as a journal has them.
static SAMPLES: LazyLock<[Parts; 2]> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("meshbrush-fuzz-sample-{}", std::process::id()));
    let project = sample();
    let mut renamed = project.settings.clone();
    renamed.layers[0].name = "renamed".into();
    let mut journal = Journal::begin(&folder, project, None, 0, &Meter::default()).unwrap();
    journal.add(Some(renamed), &Default::default(), 1).unwrap();
    let file = fs::read_dir(&folder).unwrap().next().unwrap().unwrap().path();
    let bytes = fs::read(file).unwrap();
    journal.remove().unwrap();
    let length = u32::from_le_bytes(bytes[MAGIC.len() + 9..][..4].try_into().unwrap()) as usize;
    let (whole, gesture) = bytes[MAGIC.len() + HEAD..].split_at(length);
    [unpacked(&whole[4..]), unpacked(&gesture[HEAD..])]
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((&way, bytes)) = bytes.split_first() else { return };
    let content = match way % 2 {
        0 => [MAGIC, bytes].concat(),
        _ => records(bytes),
    };
    let folder = std::env::temp_dir().join(format!("meshbrush-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let file = folder.join("1-0.journal");
    fs::write(&file, &content).unwrap();
    let found: Vec<Left> = journal::left(&folder).collect();
    assert!(found.len() <= 1);
    for left in found {
        match left {
            Left::Work(abandoned) => hold(abandoned.project),
            Left::Unreadable { problem, .. } => assert!(problem.len() < 1000 && !problem.ends_with('.')),
        }
    }
    let _ = fs::remove_file(&file); // a journal without unsaved work is deleted already
});

/// A journal with a complete sample and further records: each has a kind, a length, and edits of its parts or
/// its bytes.
fn records(mut bytes: &[u8]) -> Vec<u8> {
    let mut journal = MAGIC.to_vec();
    append(&mut journal, 1, 0, &[&[0; 4][..], &packed(&SAMPLES[0])].concat());
    for time in 1..=8 {
        let Some((&[kind, length], rest)) = bytes.split_first_chunk() else { break };
        let (edits, rest) = rest.split_at(usize::from(length).min(rest.len()));
        bytes = rest;
        if kind % 5 == 3 {
            append(&mut journal, 3, time, edits);
            continue;
        }
        let mut parts = SAMPLES[usize::from(kind) / 5 % 2].clone();
        change(&mut parts, edits);
        append(&mut journal, kind % 5, time, &packed(&parts));
    }
    journal
}

fn append(journal: &mut Vec<u8>, kind: u8, time: u64, content: &[u8]) {
    let head = [&[kind][..], &time.to_le_bytes(), &(content.len() as u32).to_le_bytes()].concat();
    let checksum = crc32fast::hash(&[&head, content].concat());
    journal.extend([&head, &checksum.to_le_bytes()[..], content].concat());
}
