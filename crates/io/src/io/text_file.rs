//! Small text files.

use std::io::{self, Read as _};
use std::path::Path;

use super::disk::File;

/// Reads a text file of at most `most_bytes` bytes.
///
/// # Errors
/// Fails where the file cannot be read, is longer, or is not UTF-8.
pub fn read_text(path: &Path, most_bytes: u64) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(most_bytes + 1).read_to_string(&mut text)?;
    if text.len() as u64 > most_bytes {
        return Err(io::Error::other(format!("it is longer than {most_bytes} bytes")));
    }
    Ok(text)
}
