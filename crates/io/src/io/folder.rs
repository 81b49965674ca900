//! Folders, as a file dialog lists them.

use std::cmp::Reverse;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::disk;

/// Most entries of a folder that are listed.
pub const MOST_ENTRIES: usize = 20_000;

/// A file or a folder in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FolderEntry {
    /// The name of the entry within the folder.
    pub name: OsString,
    /// Whether it is a folder, or a link to one.
    pub is_folder: bool,
    /// Size of a file in bytes.
    pub bytes: u64,
}

/// The contents of a folder: folders first, then files, sorted by name without regard to capitals.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FolderListing {
    /// The entries that can be read, at most [`MOST_ENTRIES`].
    pub entries: Vec<FolderEntry>,
    /// Whether there are more.
    pub is_cut: bool,
}

/// Lists a folder.
///
/// # Errors
/// Fails when it is not a folder or cannot be read.
pub fn list_folder(path: &Path) -> io::Result<FolderListing> {
    let mut listing = FolderListing::default();
    if let Some(names) = disk::names() {
        let entry =
            |(name, bytes): (PathBuf, u64)| FolderEntry { name: name.into(), is_folder: false, bytes };
        listing.entries = names.into_iter().map(entry).collect();
        return Ok(listing);
    }
    for entry in fs::read_dir(path)? {
        if listing.entries.len() == MOST_ENTRIES {
            listing.is_cut = true;
            break;
        }
        // An entry can vanish in the meantime, and a link can lead nowhere.
        let Ok(entry) = entry else { continue };
        let Ok(metadata) = fs::metadata(entry.path()) else { continue };
        let (is_folder, bytes) = (metadata.is_dir(), metadata.len());
        listing.entries.push(FolderEntry { name: entry.file_name(), is_folder, bytes });
    }
    listing.entries.sort_by_cached_key(|entry| {
        (Reverse(entry.is_folder), entry.name.to_string_lossy().to_lowercase(), entry.name.clone())
    });
    Ok(listing)
}

/// Returns whether there is a folder at a path.
pub fn is_folder(path: &Path) -> bool {
    if disk::is_in_memory() { path.as_os_str().is_empty() } else { path.is_dir() }
}

/// Returns the path that a person means by a text: `~` is the home folder, and a relative path begins at
/// `folder`. Steps `.` and `..` are resolved without regard to links.
pub fn resolve(text: &str, folder: &Path, home: Option<&Path>) -> PathBuf {
    let text = text.trim();
    let in_home = text.strip_prefix('~').filter(|rest| rest.is_empty() || rest.starts_with('/'));
    let path = match (in_home, home) {
        (Some(rest), Some(home)) => home.join(rest.trim_start_matches('/')),
        _ => folder.join(text),
    };
    let mut resolved = PathBuf::new();
    for step in path.components() {
        match step {
            std::path::Component::CurDir => {}
            std::path::Component::ParentDir => {
                resolved.pop();
            }
            other => resolved.push(other),
        }
    }
    resolved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_come_first_and_capitals_do_not_matter() {
        let folder = std::env::temp_dir().join(format!("meshbrush-list-folder-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder); // absent at the first run
        fs::create_dir_all(folder.join("z folder")).unwrap();
        for name in ["b.png", "A.png", "a.png"] {
            fs::write(folder.join(name), "12345").unwrap();
        }
        let listing = list_folder(&folder).unwrap();
        let names: Vec<_> = listing.entries.iter().map(|entry| entry.name.to_str().unwrap()).collect();
        assert_eq!(names, ["z folder", "A.png", "a.png", "b.png"]);
        assert!(listing.entries[0].is_folder && listing.entries[1].bytes == 5 && !listing.is_cut);
        assert!(list_folder(&folder.join("a.png")).is_err());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn typed_paths_are_resolved() {
        let (folder, home) = (Path::new("/data/coast"), Path::new("/home/me"));
        let resolved = |text| resolve(text, folder, Some(home));
        assert_eq!(resolved("a.png"), Path::new("/data/coast/a.png"));
        assert_eq!(resolved(" /x/./y.png "), Path::new("/x/y.png"));
        assert_eq!(resolved("../a.png"), Path::new("/data/a.png"));
        assert_eq!(resolved("~"), home);
        assert_eq!(resolved("~/a b.png"), Path::new("/home/me/a b.png"));
        assert_eq!(resolved("~me/a.png"), Path::new("/data/coast/~me/a.png"));
        assert_eq!(resolve("../../../x", folder, None), Path::new("/x"));
    }
}
