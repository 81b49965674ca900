//! Projects: raw bytes, an archive of the fuzzer's own parts, and a valid project with changed parts or
//! bytes.

#![no_main]

mod packing;

use std::path::Path;

use meshbrush_io::io::project;
use packing::{SAMPLE, change, hold, packed};

/// Separates the parts in the fuzzer's input.
const BETWEEN: &[u8] = b"\n==\n";

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((&way, bytes)) = bytes.split_first() else { return check(bytes) };
    match way % 4 {
        0 => check(bytes),
        1 => check(&packed(&own(bytes))),
        2 => {
            let mut parts = SAMPLE.clone();
            change(&mut parts, bytes);
            check(&packed(&parts));
        }
        _ => {
            let mut archive = vec![("archive".to_owned(), packed(&SAMPLE))];
            change(&mut archive, bytes);
            check(&archive[0].1);
        }
    }
});

/// A project that opens is a document, and saving and opening it changes nothing; otherwise the error is a
/// sentence.
fn check(bytes: &[u8]) {
    let name = Path::new("fuzz.meshbrush");
    match project::from_bytes(bytes, name) {
        Ok(project) => hold(project),
        Err(error) => {
            let sentence = error.to_string();
            assert!(sentence.starts_with("fuzz.meshbrush") && sentence.ends_with('.'), "{sentence}");
            assert!(sentence.len() < 1000, "{sentence}");
        }
    }
}

/// The sample with its first parts replaced.
fn own(mut bytes: &[u8]) -> packing::Parts {
    let mut parts = SAMPLE.clone();
    for (_, content) in &mut parts {
        let end = bytes.windows(BETWEEN.len()).position(|window| window == BETWEEN);
        let (part, rest) = bytes.split_at(end.unwrap_or(bytes.len()));
        *content = part.to_vec();
        let Some(rest) = rest.strip_prefix(BETWEEN) else { break };
        bytes = rest;
    }
    parts
}
