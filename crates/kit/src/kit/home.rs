//! The file that the document belongs to: what was in it when it was read or saved, and who else has it open.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background::{Aim, Background, Outcome, cancelled};
use super::command::Opened;
use meshbrush_io::io::project::Project;
use meshbrush_io::io::{self, Claim, FileStamp, Meter, Stamping};

/// The file of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Home {
    /// The path of the file.
    pub path: PathBuf,
    /// The stamp of its contents when the document was read from it or saved to it; `None` if it is unknown.
    pub stamp: Option<FileStamp>,
}

/// Tells other windows which project is open in this one.
#[derive(Default)]
pub struct Claims {
    /// The folder of the locks; `None` if nothing is kept from run to run.
    folder: Option<PathBuf>,
    held: Option<(PathBuf, Claim)>,
    /// The project that this window may save although another one has it open.
    shared: Option<PathBuf>,
}

impl Claims {
    /// Keeps the locks in a folder from now on.
    pub fn keep_in(&mut self, folder: PathBuf) {
        self.folder = Some(folder);
    }

    /// Claims a project in place of the last one. Returns whether another window has it open.
    pub fn hold(&mut self, project: Option<&Path>) -> bool {
        self.shared.take_if(|shared| project != Some(shared));
        if self.held.as_ref().map(|(path, _)| &**path) == project {
            return false;
        }
        self.held = None;
        let (Some(path), Some(folder)) = (project, &self.folder) else { return false };
        // Where there are no locks, nobody knows: that is no reason to say anything.
        match Claim::new(folder, path) {
            Ok(claim) => {
                self.held = claim.map(|claim| (path.to_owned(), claim));
                self.held.is_none()
            }
            Err(_) => false,
        }
    }

    /// Returns whether another window has a project open, and the user was not asked about it yet.
    pub fn is_open_elsewhere(&self, project: &Path) -> bool {
        let is_held = self.held.as_ref().is_some_and(|(path, _)| path == project);
        let may_ask = !is_held && self.shared.as_deref() != Some(project);
        let folder = self.folder.as_deref().filter(|_| may_ask);
        folder.is_some_and(|folder| matches!(Claim::new(folder, project), Ok(None)))
    }

    /// The user wants to save a project although another window has it open.
    pub fn share(&mut self, project: &Path) {
        self.shared = Some(project.to_owned());
    }
}

/// The contents that a file must have to be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// It is replaced whatever it contains, even if it is read-only.
    Anything,
    /// It is replaced whatever it contains, unless it is read-only.
    Writable,
    /// These contents, and it is not read-only. If they are not known, no existing file is replaced.
    Contents(Option<FileStamp>),
}

/// The loss if a file is replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// The contents of the file.
    Contents,
    /// A version that somebody else saved to the document's own file since it was read.
    OtherVersion,
    /// A file that is read-only, so that nobody changes it by accident.
    ReadOnly,
    /// The document of another window that has the file open.
    OtherWindow,
}

/// What became of a file that was to be written.
enum WriteOutcome {
    Saved(FileStamp),
    /// It stays as it was, because this would be lost.
    Kept(Loss),
}

/// Writes a version of the document on another thread, unless the file is not as it is expected to be.
pub fn write(path: PathBuf, project: Project, version: u64, expected: Expected, background: &mut Background) {
    let (aim, file) = (Aim::Save(version), path.clone());
    background.start(aim, &path, move |meter| match write_expected(&file, &project, expected, meter) {
        Ok(WriteOutcome::Saved(stamp)) => {
            Outcome::Saved { home: Home { path: file, stamp: Some(stamp) }, version }
        }
        Ok(WriteOutcome::Kept(loss)) => Outcome::NotReplaced(file, loss),
        Err(_) if meter.is_cancelled() => Outcome::SavingCancelled(cancelled(aim, &file)),
        Err(error) => Outcome::NotSaved(format!("{} could not be saved: {error}.", file.display())),
    });
}

/// Writes a project, unless its file is not as it is expected to be.
fn write_expected(
    file: &Path,
    project: &Project,
    expected: Expected,
    meter: &Meter,
) -> std::io::Result<WriteOutcome> {
    if let Expected::Contents(expected) = expected {
        let found = FileStamp::from_file(file, meter)?;
        if found.is_some() && found != expected {
            return Ok(WriteOutcome::Kept(Loss::OtherVersion));
        }
    }
    if expected != Expected::Anything && io::is_read_only(file) {
        return Ok(WriteOutcome::Kept(Loss::ReadOnly));
    }
    let mut written = None;
    io::write_file_metered(file, meter, |out| {
        let mut out = Stamping::new(out);
        io::project::write_metered(&mut out, project, meter)?;
        written = Some(WriteOutcome::Saved(out.stamp()));
        Ok(())
    })?;
    written.ok_or_else(|| std::io::Error::other("nothing was written"))
}

/// Reads a project, which is shown once it is read.
pub fn open(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match io::project::read_stamped(&file, meter) {
        Ok((document, stamp)) => {
            let home = Some(Home { path: file.clone(), stamp: Some(stamp) });
            let opened = Opened { document: Arc::new(document), home };
            Outcome::Opened { path: file, opened, note: None }
        }
        Err(error) => Outcome::not_read(error),
    });
}
