use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::Meter;

/// Creates a folder and its parents, as far as they do not exist.
///
/// # Errors
/// Errors of the file system.
pub fn make_folder(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path)
}

/// Whether a file or folder exists at a path.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// Why no file can be written at a path, as the end of a sentence; `None` if nothing is known against it.
pub fn obstacle(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Some(format!("there is no folder {}", folder.display()));
    }
    path.is_dir().then(|| "a folder has this name".to_owned())
}

/// Writes a file completely or not at all.
///
/// The content goes to a temporary file in the same folder, which then replaces `path`: the old file is
/// untouched until everything is written. If `path` is not a regular file (a pipe, `/dev/stdout`), it is
/// written directly.
///
/// # Errors
/// Errors of the file system and of `write`. The temporary file is then removed.
pub fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    write_file_metered(path, &Meter::default(), write)
}

/// Writes a file as [`write_file`] does, and leaves no trace if the meter is cancelled before the file is in
/// its place. The bytes of `write` are not counted here: `write` counts what it works on.
///
/// # Errors
/// As [`write_file`], and when the work was cancelled.
pub fn write_file_metered(
    path: &Path,
    meter: &Meter,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    put_in_place([Draft::write(path, meter, write)?], meter)
}

/// Moves files that belong together to their places: all of them, or none if the work was cancelled.
///
/// # Errors
/// When the work was cancelled, and errors of the file system. After an error of the file system the files
/// before it are already in their places.
pub(super) fn put_in_place(drafts: impl IntoIterator<Item = Draft>, meter: &Meter) -> io::Result<()> {
    let drafts: Vec<Draft> = drafts.into_iter().collect();
    meter.check()?;
    drafts.into_iter().try_for_each(Draft::put_in_place)
}

/// A file that is written but not yet in its place. Dropping it removes the temporary file.
pub(super) struct Draft {
    target: PathBuf,
    /// `None` if the target is not a regular file and was written directly.
    temporary: Option<PathBuf>,
}

impl Draft {
    /// Writes the content of the file at `path` to a temporary file, and waits until it is on the disk.
    ///
    /// # Errors
    /// Errors of the file system and of `write`, and when the work was cancelled.
    pub fn write(
        path: &Path,
        meter: &Meter,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<Self> {
        if let Some(obstacle) = obstacle(path) {
            return Err(io::Error::other(obstacle));
        }
        // A link stays a link: the file that it points to is replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let before = fs::metadata(&target).ok();
        if before.as_ref().is_some_and(|m| !m.is_file() && !m.is_dir()) {
            filled(File::options().write(true).open(&target)?, write)?;
            return Ok(Self { target, temporary: None });
        }
        let temporary = beside(&target)?;
        let file = File::options().write(true).create_new(true).open(&temporary)?;
        // From here on dropping the draft removes the temporary file.
        let draft = Self { target, temporary: Some(temporary) };
        let file = filled(file, write)?;
        if let Some(before) = before {
            file.set_permissions(before.permissions())?;
        }
        // The next call can take seconds.
        meter.check()?;
        file.sync_all()?;
        Ok(draft)
    }

    fn put_in_place(mut self) -> io::Result<()> {
        if let Some(temporary) = &self.temporary {
            fs::rename(temporary, &self.target)?;
        }
        self.temporary = None;
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // An error of this is not reported: the error before it is the cause.
            let _ = fs::remove_file(temporary);
        }
    }
}

fn filled(file: File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<File> {
    let mut out = BufWriter::with_capacity(1 << 18, file);
    write(&mut out)?;
    out.into_inner().map_err(io::IntoInnerError::into_error)
}

/// A name in the same folder that is unique among all runs of the program and all writes of each run.
fn beside(target: &Path) -> io::Result<PathBuf> {
    static WRITES: AtomicU64 = AtomicU64::new(0);
    let name =
        target.file_name().ok_or_else(|| io::Error::other("the path does not end in the name of a file"))?;
    let (run, write) = (std::process::id(), WRITES.fetch_add(1, Ordering::Relaxed));
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{run}-{write}.part"));
    Ok(target.with_file_name(hidden))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("meshbrush-atomic-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = folder("failed");
        let path = folder.join("mesh.csv");
        fs::write(&path, "old").unwrap();
        let failed = write_file(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "the disk is full");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(&folder), ["mesh.csv"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_cancelled_write_leaves_the_old_file_and_nothing_else() {
        let folder = folder("cancelled");
        let path = folder.join("mesh.csv");
        fs::write(&path, "old").unwrap();
        for at in 0..3 {
            let meter = Meter::default();
            let cancelled = write_file_metered(&path, &meter, |out| {
                let mut out = meter.count(out);
                for step in 0..3 {
                    if step == at {
                        meter.cancel();
                    }
                    out.write_all(&[b'x'; 1 << 16])?;
                }
                Ok(())
            });
            assert_eq!(cancelled.unwrap_err().to_string(), "it was cancelled");
            assert_eq!(fs::read_to_string(&path).unwrap(), "old");
            assert_eq!(names(&folder), ["mesh.csv"]);
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn files_that_belong_together_are_replaced_together() {
        let folder = folder("together");
        let paths = ["a", "b"].map(|name| folder.join(name));
        let meter = Meter::default();
        let drafts = || paths.each_ref().map(|path| Draft::write(path, &meter, |out| out.write_all(b"new")));
        put_in_place(drafts().map(Result::unwrap), &meter).unwrap();
        assert!(paths.iter().all(|path| fs::read(path).unwrap() == b"new"));
        paths.iter().for_each(|path| fs::write(path, "old").unwrap());
        let written = drafts().map(Result::unwrap);
        meter.cancel();
        assert!(put_in_place(written, &meter).is_err());
        assert!(paths.iter().all(|path| fs::read(path).unwrap() == b"old"));
        assert_eq!(names(&folder).len(), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_finished_write_replaces_the_file() {
        let folder = folder("finished");
        let path = folder.join("mesh.csv");
        for content in ["first", "second"] {
            write_file(&path, |out| out.write_all(content.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), content);
        }
        assert_eq!(names(&folder), ["mesh.csv"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link() {
        let folder = folder("link");
        fs::write(folder.join("real"), "old").unwrap();
        std::os::unix::fs::symlink(folder.join("real"), folder.join("link")).unwrap();
        write_file(&folder.join("link"), |out| out.write_all(b"new")).unwrap();
        assert!(folder.join("link").is_symlink());
        assert_eq!(fs::read_to_string(folder.join("real")).unwrap(), "new");
        fs::remove_dir_all(folder).unwrap();
    }
}
