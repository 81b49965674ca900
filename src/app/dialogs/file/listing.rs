//! The contents of a folder, read on another thread: a folder on a network can take long.

use std::path::{Path, PathBuf};

use meshbrush_io::io::{self, FolderListing, MOST_ENTRIES};
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Taken};

/// The contents of a folder, as far as they are known.
pub enum Contents {
    /// They are being read.
    Reading,
    /// They are read.
    Read(FolderListing),
    /// They cannot be read: a sentence.
    Failed(String),
}

/// The contents of the folder that was asked for last.
pub struct Listing {
    jobs: Jobs,
    folder: PathBuf,
    contents: Contents,
    job: Job<std::io::Result<FolderListing>>,
}

impl Listing {
    /// Reads a folder.
    pub fn of(folder: &Path, jobs: &Jobs) -> Self {
        let path = folder.to_owned();
        let job = jobs.start(JobKind::Ask, move |output| {
            output.send(io::list_folder(&path));
        });
        let (jobs, folder) = (jobs.clone(), folder.to_owned());
        let mut listing = Self { jobs, folder, contents: Contents::Reading, job };
        // Most folders are read within the time that a frame may wait, so that nothing flickers.
        listing.keep(listing.job.take(&listing.jobs));
        listing
    }

    /// Goes to a folder, and takes what has been read.
    pub fn show(&mut self, folder: &Path) {
        if self.folder != folder {
            *self = Self::of(folder, &self.jobs);
        }
        self.keep(self.job.take_ready());
    }

    /// Reads the folder again: a file may have been added.
    pub fn read_again(&mut self) {
        *self = Self::of(&self.folder, &self.jobs);
    }

    /// Returns the contents of the folder, as far as they are known.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Returns the note below a list that is not complete.
    pub fn note(&self) -> Option<String> {
        let is_cut = matches!(&self.contents, Contents::Read(listing) if listing.is_cut);
        is_cut.then(|| format!("Only {MOST_ENTRIES} entries are listed. Type the name of another one."))
    }

    /// Keeps what the job found.
    fn keep(&mut self, taken: Taken<std::io::Result<FolderListing>>) {
        if let Taken::Value(answer) = taken {
            self.contents = match answer {
                Ok(listing) => Contents::Read(listing),
                Err(error) => {
                    Contents::Failed(format!("{} cannot be listed: {error}.", self.folder.display()))
                }
            };
        }
    }
}
