//! A project: bytes as they are, parts of its own behind right checksums, and a sound project with its parts or bytes changed.

#![no_main]

mod packing;

use std::path::Path;

use meshbrush::io::project;
use packing::{SAMPLE, change, hold, packed};

/// Between the parts that a fuzzer writes itself.
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

/// What opens is a document, and saving it is a fixed point; what does not is told in a sentence.
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
