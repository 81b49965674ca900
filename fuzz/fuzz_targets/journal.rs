//! Journals that were left behind: raw bytes, and records with valid checksums around changed parts of
//! projects.

#![no_main]

mod packing;

use std::fs;

use meshbrush_io::io::journal::{self, Left};
use packing::{SAMPLE, change, hold, packed};

const MAGIC: &[u8] = b"MBJOUR02";

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
    append(&mut journal, 1, 0, &[&[0; 4][..], &packed(&SAMPLE)].concat());
    for time in 1..=8 {
        let Some((&[kind, length], rest)) = bytes.split_first_chunk() else { break };
        let (edits, rest) = rest.split_at(usize::from(length).min(rest.len()));
        let mut parts = SAMPLE.clone();
        match kind % 6 {
            // Tiles alone, sometimes with parts that do not belong there.
            2 => drop(parts.drain(..parts.len() - 1)),
            3 => {
                append(&mut journal, 3, time, edits);
                bytes = rest;
                continue;
            }
            _ => {}
        }
        change(&mut parts, edits);
        append(&mut journal, kind % 6, time, &packed(&parts));
        bytes = rest;
    }
    journal
}

fn append(journal: &mut Vec<u8>, kind: u8, time: u64, content: &[u8]) {
    let head = [&[kind][..], &time.to_le_bytes(), &(content.len() as u32).to_le_bytes()].concat();
    let checksum = crc32fast::hash(&[&head, content].concat());
    journal.extend([&head, &checksum.to_le_bytes()[..], content].concat());
}
