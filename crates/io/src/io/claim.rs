//! Which projects are open in a window: two windows on one project know of each other.
//!
//! A window holds a lock on a small file in the user's data folder, one for each project, as long as the
//! project is open. The operating system releases the lock when the program ends in any way. The project's
//! own file is not locked: saving replaces it, and other programs may read it.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

/// The lock of a window on a project. Dropping it releases the lock.
#[derive(Debug)]
pub struct Claim {
    _lock: File,
}

impl Claim {
    /// Claims a project with a lock file in `folder`, which is created if necessary; `None` if another window
    /// has claimed it.
    ///
    /// # Errors
    /// Fails with the errors of the file system, also where it has no locks: then nobody knows who has the
    /// project open.
    pub fn new(folder: &Path, project: &Path) -> io::Result<Option<Self>> {
        fs::create_dir_all(folder)?;
        // The same file by whatever name.
        let project = fs::canonicalize(project)?;
        let name = format!("{:016x}.lock", hash(project.as_os_str().as_encoded_bytes()));
        // The file is never removed: a process that waits for a removed file would hold a lock that no other
        // process sees. Some network disks lock only files that are open for reading and writing.
        let file =
            File::options().read(true).write(true).create(true).truncate(false).open(folder.join(name))?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self { _lock: file })),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }
}

/// FNV-1a with 64 bits: the same for the same bytes in all versions of the program.
fn hash(bytes: &[u8]) -> u64 {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_project_is_claimed_by_one_at_a_time_under_any_name() {
        let folder = std::env::temp_dir().join(format!("meshbrush-claim-{}", std::process::id()));
        fs::create_dir_all(folder.join("inner")).unwrap();
        let [a, b] = ["a", "b"].map(|name| folder.join(name));
        for path in [&a, &b] {
            fs::write(path, "").unwrap();
        }
        let claim = |path: &Path| Claim::new(&folder.join("open"), path).unwrap();
        let first = claim(&a);
        assert!(first.is_some());
        assert!(claim(&folder.join("inner/../a")).is_none());
        assert!(claim(&b).is_some(), "another project");
        drop(first);
        assert!(claim(&a).is_some());
        fs::remove_dir_all(folder).unwrap();
    }
}
