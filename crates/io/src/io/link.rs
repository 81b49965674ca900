//! A document as the part of a link after `#`: a version, and the bytes of its project in base64 for
//! addresses.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;

use super::project::{self, Project};
use meshbrush_mesh::text::Grouped;

/// The version that is written, and the newest that is read.
const VERSION: u32 = 1;
/// Most characters of a link that is written: browsers and mail programs pass on so many.
pub const MOST_CHARACTERS: usize = 30_000;
/// Most characters of a link that is read.
const MOST_READ: usize = 8 << 20;

/// Returns the document as the part of a link after `#`.
///
/// # Errors
/// Fails with a sentence when it needs more than [`MOST_CHARACTERS`].
pub fn write(project: &Project) -> Result<String, String> {
    let mut bytes = Vec::new();
    project::write(&mut bytes, project)
        .map_err(|error| format!("The document cannot be packed: {error}."))?;
    let link = format!("{VERSION}.{}", URL_SAFE_NO_PAD.encode(&bytes));
    if link.len() > MOST_CHARACTERS {
        return Err(format!(
            "The document takes {} characters in a link, and browsers and mail programs pass on {}. Save the project and \
             send the file.",
            Grouped(link.len()),
            Grouped(MOST_CHARACTERS)
        ));
    }
    Ok(link)
}

/// Returns the document of the part of a link after `#`.
///
/// # Errors
/// Fails with a sentence when the link is damaged or too long, or was made by a newer program.
pub fn read(link: &str) -> Result<Project, String> {
    const DAMAGED: &str = "The link is damaged: a part of it is missing or changed. Ask for it again, or for the project as a file.";
    if link.len() > MOST_READ {
        return Err(format!(
            "The link has {} characters, and at most {} are read. Ask for the project as a file.",
            Grouped(link.len()),
            Grouped(MOST_READ)
        ));
    }
    let (version, packed) = link.split_once('.').ok_or(DAMAGED)?;
    let version: u32 = version.parse().map_err(|_| DAMAGED)?;
    if version > VERSION {
        return Err(format!(
            "The link was made by a newer Meshbrush (version {version} of links, and this one reads up to {VERSION}). Load \
             the page again to get the newest."
        ));
    }
    let bytes = URL_SAFE_NO_PAD.decode(packed).map_err(|_| DAMAGED)?;
    project::from_bytes(&bytes, Path::new("The link")).map_err(|error| format!("{DAMAGED} ({error})"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_core::document::{Document, Settings};

    fn project() -> Project {
        Project::of(&Document::new(Settings::default(), None).unwrap())
    }

    #[test]
    fn a_link_is_read_as_the_document_that_it_was_made_from() {
        let link = write(&project()).unwrap();
        assert!(link.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte)), "{link}");
        assert_eq!(read(&link).unwrap(), project());
    }

    #[test]
    fn a_link_that_is_damaged_newer_or_too_long_is_refused_with_a_sentence() {
        let link = write(&project()).unwrap();
        for cut in [0, 1, 2, 10, link.len() / 2, link.len() - 1] {
            let problem = read(&link[..cut]).unwrap_err();
            assert!(problem.starts_with("The link is damaged"), "{cut}: {problem}");
        }
        let mut changed = link.clone().into_bytes();
        let middle = changed.len() / 2;
        changed[middle] = if changed[middle] == b'A' { b'B' } else { b'A' };
        let changed = String::from_utf8(changed).unwrap();
        assert!(read(&changed).unwrap_err().starts_with("The link is damaged"));
        let newer = link.replacen("1.", "2.", 1);
        assert!(read(&newer).unwrap_err().contains("newer Meshbrush"), "{newer}");
        let long = format!("1.{}", "A".repeat(MOST_READ));
        assert!(
            read(&long).unwrap_err().contains("at most 8,388,608 are read"),
            "{}",
            read(&long).unwrap_err()
        );
    }
}
