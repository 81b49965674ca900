use std::ffi::{OsStr, OsString};
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Meter, disk, pipe};

/// The end of the names of temporary files.
const PART: &str = ".part";
/// Most bytes of a name that the name of its temporary file repeats.
const LONGEST_IN_PART: usize = 200;
/// Most links from one to the next.
const MOST_LINKS: usize = 40;

/// Creates a folder and its parents, as far as they do not exist.
///
/// # Errors
/// Fails with the errors of the file system.
pub fn make_folder(path: &Path) -> io::Result<()> {
    if disk::is_in_memory() { Ok(()) } else { fs::create_dir_all(path) }
}

/// Removes files that this run has made, when they are of no use without others. What cannot be removed
/// stays.
pub fn remove_new(files: &[PathBuf]) {
    for file in files {
        disk::remove(file);
        let _ = fs::remove_file(file); // the failure that made them useless is the one to report
    }
}

/// Returns whether a file or folder exists at a path.
pub fn exists(path: &Path) -> bool {
    if disk::is_in_memory() { disk::is_file(path) } else { path.exists() }
}

/// Returns why no file should be written at a path, as the end of a sentence; `None` if nothing is known
/// against it.
pub fn obstacle(path: &Path) -> Option<String> {
    place_obstacle(path).or_else(|| {
        let advice = "allow it to be written, or choose another name";
        is_read_only(path).then(|| format!("the file is read-only; {advice}"))
    })
}

/// Returns whether a file exists that its owner keeps from being changed. It can be replaced nevertheless
/// where its folder can be written: callers ask first.
pub fn is_read_only(path: &Path) -> bool {
    let target = if disk::is_in_memory() { None } else { behind_links(path).ok() };
    let Some(target) = target else { return false };
    let refuses = || {
        let opened = File::options().write(true).open(&target);
        let kinds = [io::ErrorKind::PermissionDenied, io::ErrorKind::ReadOnlyFilesystem];
        opened.is_err_and(|error| kinds.contains(&error.kind()))
    };
    fs::metadata(&target).is_ok_and(|found| found.is_file() && (found.permissions().readonly() || refuses()))
}

/// Returns why no file can be written at a path, as the end of a sentence.
fn place_obstacle(path: &Path) -> Option<String> {
    if disk::is_in_memory() {
        return None;
    }
    let target = match behind_links(path) {
        Ok(target) => target,
        Err(problem) => return Some(problem),
    };
    let folder = folder_of(&target);
    if !folder.is_dir() {
        let link = if path.is_symlink() { "it is a link to a missing folder: " } else { "" };
        return Some(format!("{link}there is no folder {}", folder.display()));
    }
    match fs::symlink_metadata(&target) {
        Ok(found) => found.is_dir().then(|| "a folder has this name".to_owned()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        // A name that is too long, for example.
        Err(error) => Some(error.to_string()),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the file behind a path: for a link, the file that it points to, whether it exists or not. Writing
/// that file leaves the link in place.
fn behind_links(path: &Path) -> Result<PathBuf, String> {
    if let Ok(existing) = fs::canonicalize(path) {
        return Ok(existing);
    }
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(link) = fs::read_link(&target) else { return Ok(target) };
        target = folder_of(&target).join(link);
    }
    Err("its links point to each other in a circle".into())
}

/// Writes a file completely or not at all.
///
/// The content goes to a temporary file in the same folder, which then replaces `path`: the old file is
/// untouched until everything is written. If `path` is not a regular file (a pipe, `/dev/stdout`), it is
/// written directly.
///
/// # Errors
/// Fails with the errors of the file system and of `write`. The temporary file is then removed.
pub fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    write_file_metered(path, &Meter::default(), write)
}

/// Writes a file as [`write_file`] does, and leaves no trace if the meter is cancelled before the file is in
/// its place. `write` must count its progress itself.
///
/// # Errors
/// Fails as [`write_file`] does, and when the work was cancelled.
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
/// Fails when the work was cancelled, and with the errors of the file system. After an error of the file
/// system the files before it are already in their places.
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
    /// The content, where files are kept in memory.
    in_memory: Option<Vec<u8>>,
    /// The temporary file. It is locked until it is in its place, so that other runs can tell that somebody
    /// works on it.
    _lock: Option<File>,
}

impl Draft {
    /// Writes the content of the file at `path` to a temporary file, and waits until it is on the disk.
    ///
    /// # Errors
    /// Fails with the errors of the file system and of `write`, and when the work was cancelled.
    pub fn write(
        path: &Path,
        meter: &Meter,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<Self> {
        if disk::is_in_memory() {
            let mut content = Vec::new();
            write(&mut content)?;
            let target = path.to_owned();
            return Ok(Self { target, temporary: None, in_memory: Some(content), _lock: None });
        }
        if let Some(obstacle) = place_obstacle(path) {
            return Err(io::Error::other(obstacle));
        }
        let target = behind_links(path).map_err(io::Error::other)?;
        let before = fs::metadata(&target).ok();
        if before.as_ref().is_some_and(|m| !m.is_file() && !m.is_dir()) {
            filled(open_special(&target)?, write)?;
            return Ok(Self { target, temporary: None, in_memory: None, _lock: None });
        }
        remove_abandoned(&target);
        let (file, temporary) = new_part(&target)?;
        // From here on dropping the draft removes the temporary file.
        let lock = Some(file.try_clone()?);
        let draft = Self { target, temporary: Some(temporary), in_memory: None, _lock: lock };
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
        if let Some(content) = self.in_memory.take() {
            disk::put_written(&self.target, content);
        }
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

/// Opens what is not a regular file for writing.
fn open_special(path: &Path) -> io::Result<File> {
    if disk::is_pipe(path.metadata()?.file_type()) && !path.starts_with("/dev") && !path.starts_with("/proc")
    {
        return pipe::open_to_write(path);
    }
    File::options().write(true).open(path)
}

fn filled(file: File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<File> {
    let mut out = BufWriter::with_capacity(1 << 18, file);
    write(&mut out)?;
    out.into_inner().map_err(io::IntoInnerError::into_error)
}

/// Creates and locks a temporary file in the same folder, `.NAME.RUN-WRITE.part`. Its name is unique among
/// all runs of the program and all writes of each run.
fn new_part(target: &Path) -> io::Result<(File, PathBuf)> {
    static WRITES: AtomicU64 = AtomicU64::new(0);
    let name =
        target.file_name().ok_or_else(|| io::Error::other("the path does not end in the name of a file"))?;
    loop {
        let (run, write) = (std::process::id(), WRITES.fetch_add(1, Ordering::Relaxed));
        let mut hidden = part_prefix(name);
        hidden.push(format!("{run}-{write}{PART}"));
        let path = target.with_file_name(hidden);
        let file = match File::options().write(true).create_new(true).open(&path) {
            // Left by an earlier run with the same number, on a disk without locks.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            opened => opened?,
        };
        // Another run can take the file for an abandoned one before it is locked, and remove it. On a disk
        // without locks nobody removes it.
        let taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock)) || !path.exists();
        if !taken {
            return Ok((file, path));
        }
    }
}

/// Removes the temporary files that runs which were killed have left of writes to `target`: nobody has locked
/// them. What cannot be removed stays, and the write goes on.
fn remove_abandoned(target: &Path) {
    let Some(name) = target.file_name() else { return };
    let prefix = part_prefix(name);
    for entry in fs::read_dir(folder_of(target)).into_iter().flatten().flatten() {
        // To open a pipe would wait for somebody who reads it.
        if !is_part(&entry.file_name(), &prefix) || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        // Some network disks lock only files that are open for writing.
        let file = File::options().write(true).open(entry.path());
        if file.is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path()); // the next write tries again
        }
    }
}

/// Returns the beginning of the names of temporary files of writes to a file. A long name is replaced by its
/// checksum: file systems take names of up to 255 bytes.
fn part_prefix(name: &OsStr) -> OsString {
    let checksum = || format!("{:08x}", crc32fast::hash(name.as_encoded_bytes())).into();
    let name = if name.len() > LONGEST_IN_PART { checksum() } else { name.to_owned() };
    [OsStr::new("."), &name, OsStr::new(".")].into_iter().collect()
}

/// Returns whether a file has the name of a temporary file with this beginning.
fn is_part(name: &OsStr, prefix: &OsStr) -> bool {
    let numbers = name.as_encoded_bytes().strip_prefix(prefix.as_encoded_bytes());
    let numbers = numbers.and_then(|rest| rest.strip_suffix(PART.as_bytes())).unwrap_or_default();
    let mut parts = numbers.split(|&byte| byte == b'-');
    let is_number = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
    let [run, write, more] = [parts.next(), parts.next(), parts.next()];
    run.is_some_and(is_number) && write.is_some_and(is_number) && more.is_none()
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

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_file_that_does_not_exist_yet_is_written_through() {
        let folder = folder("dangling");
        std::os::unix::fs::symlink("further", folder.join("link")).unwrap();
        std::os::unix::fs::symlink("real", folder.join("further")).unwrap();
        write_file(&folder.join("link"), |out| out.write_all(b"new")).unwrap();
        assert!(folder.join("link").is_symlink() && folder.join("further").is_symlink());
        assert_eq!(fs::read_to_string(folder.join("real")).unwrap(), "new");
        std::os::unix::fs::symlink("missing/file", folder.join("lost")).unwrap();
        let lost = write_file(&folder.join("lost"), |out| out.write_all(b"new")).unwrap_err().to_string();
        assert!(lost.starts_with("it is a link to a missing folder: there is no folder "), "{lost}");
        assert!(lost.ends_with("/missing") && folder.join("lost").is_symlink(), "{lost}");
        std::os::unix::fs::symlink("circle", folder.join("circle")).unwrap();
        let circle = write_file(&folder.join("circle"), |out| out.write_all(b"new")).unwrap_err();
        assert_eq!(circle.to_string(), "its links point to each other in a circle");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn pipes_stop_no_write_and_are_written_once_somebody_reads() {
        let folder = folder("pipes");
        let make = |name: &str| {
            let path = folder.join(name);
            assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
            path
        };
        let (_part, path) = (make(".mesh.csv.12-0.part"), folder.join("mesh.csv"));
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        let pipe = make("pipe");
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || io::read_to_string(disk::File::open(pipe).unwrap()).unwrap()
        });
        write_file(&pipe, |out| out.write_all(b"through")).unwrap();
        assert_eq!(reader.join().unwrap(), "through");
        let nobody = "nobody writes to this pipe; start its writer first";
        for (read, said) in [(pipe, nobody), ("/dev/zero".into(), "a device"), (folder.clone(), "a folder")] {
            let refused = disk::File::open(&read).unwrap_err().to_string();
            assert!(refused.contains(said), "{}: {refused}", read.display());
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_name_may_be_as_long_as_the_file_system_allows() {
        let folder = folder("long");
        for length in [150, 201, 244, 255] {
            let path = folder.join("n".repeat(length));
            let left = folder.join({
                let mut left = part_prefix(path.file_name().unwrap());
                left.push("12-0.part");
                left
            });
            fs::write(&left, "half").unwrap();
            assert_eq!(obstacle(&path), None);
            write_file(&path, |out| out.write_all(b"new")).unwrap();
            assert!(path.exists() && !left.exists(), "{length}");
        }
        assert!(obstacle(&folder.join("n".repeat(256))).unwrap().contains("too long"));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_read_only_file_is_an_obstacle_and_replaced_only_by_those_who_ask() {
        let folder = folder("read-only");
        let path = folder.join("a.meshbrush");
        assert!(obstacle(&path).is_none() && !is_read_only(&path), "there is no file");
        fs::write(&path, "old").unwrap();
        assert!(obstacle(&path).is_none() && !is_read_only(&path));
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        assert!(is_read_only(&path) && obstacle(&path).unwrap().contains("the file is read-only"));
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert!(fs::read(&path).unwrap() == b"new" && is_read_only(&path), "it stays read-only");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_write_removes_what_killed_writes_to_the_same_file_left() {
        let folder = folder("killed");
        let path = folder.join("mesh.msh");
        let left = [".mesh.msh.12-0.part", ".mesh.msh.4000000000-17.part"];
        let others =
            [".mesh.msh.12.part", ".mesh.msh.12-0-1.part", ".other.msh.12-0.part", "mesh.msh.12-0.part"];
        left.iter().chain(&others).for_each(|name| fs::write(folder.join(name), "half").unwrap());
        let beside = folder.join(".mesh.msh.13-0.part");
        let in_use = File::create(&beside).unwrap();
        in_use.try_lock().unwrap();
        write_file(&path, |out| {
            // Two writes of this run at the same time do not disturb each other.
            write_file(&path, |out| out.write_all(b"inner"))?;
            out.write_all(b"outer")
        })
        .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "outer");
        assert!(left.iter().all(|name| !folder.join(name).exists()));
        assert!(others.iter().all(|name| folder.join(name).exists()) && beside.exists());
        assert_eq!(names(&folder).len(), others.len() + 2);
        fs::remove_dir_all(folder).unwrap();
    }
}
