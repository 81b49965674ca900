//! The contents of a folder, read on another thread: a folder on a network can take long.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;

use meshbrush_io::io::{self, FolderListing, MOST_ENTRIES};

/// How long a frame waits for a folder: most are read by then, and nothing flickers.
const PATIENCE: Duration = Duration::from_millis(30);

/// What is known of the contents of a folder.
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
    ctx: Context,
    folder: PathBuf,
    contents: Contents,
    answers: Receiver<std::io::Result<FolderListing>>,
}

impl Listing {
    /// Reads a folder.
    pub fn of(folder: &Path, ctx: &Context) -> Self {
        let (sender, answers) = channel();
        let (path, waker) = (folder.to_owned(), ctx.clone());
        thread::spawn(move || {
            // The dialog may have gone on to another folder.
            let _ = sender.send(io::list_folder(&path));
            waker.request_repaint();
        });
        let mut listing =
            Self { ctx: ctx.clone(), folder: folder.to_owned(), contents: Contents::Reading, answers };
        listing.take(PATIENCE);
        listing
    }

    /// Goes to a folder, and takes what has been read.
    pub fn show(&mut self, folder: &Path) {
        if self.folder != folder {
            *self = Self::of(folder, &self.ctx);
        }
        self.take(Duration::ZERO);
    }

    /// Reads the folder again: a file may have been added.
    pub fn read_again(&mut self) {
        *self = Self::of(&self.folder, &self.ctx);
    }

    /// What is known.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// The note below a list that is not complete.
    pub fn note(&self) -> Option<String> {
        let is_cut = matches!(&self.contents, Contents::Read(listing) if listing.is_cut);
        is_cut.then(|| format!("Only {MOST_ENTRIES} entries are listed. Type the name of another one."))
    }

    fn take(&mut self, patience: Duration) {
        if let Ok(answer) = self.answers.recv_timeout(patience) {
            self.contents = match answer {
                Ok(listing) => Contents::Read(listing),
                Err(error) => {
                    Contents::Failed(format!("{} cannot be listed: {error}.", self.folder.display()))
                }
            };
        }
    }
}
