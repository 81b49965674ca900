//! The folder in which each kind of file was looked for last.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshbrush_io::io;
use meshbrush_kit::kit::FileRequest;

/// Name under which the window's own storage keeps the folders.
const KEY: &str = "folders";

/// Folders by the kind of their files.
#[derive(Clone, Debug, Default)]
pub struct LastFolders(BTreeMap<String, PathBuf>);

impl LastFolders {
    /// Returns the folder to show first: the last folder for such files, else the folder of a known file,
    /// else the home folder.
    pub fn of(&self, request: FileRequest, file: Option<&Path>) -> PathBuf {
        let last = self.0.get(request.folder).map(PathBuf::as_path);
        let beside = file.and_then(Path::parent);
        let known = last.into_iter().chain(beside).find(|folder| io::is_folder(folder));
        let elsewhere = || std::env::home_dir().or(std::env::current_dir().ok());
        known.map(Path::to_owned).or_else(elsewhere).unwrap_or_else(|| PathBuf::from("/"))
    }

    /// Notes the folder of an answer.
    pub fn note(&mut self, request: FileRequest, folder: Option<&Path>) {
        if let Some(folder) = folder {
            self.0.insert(request.folder.to_owned(), folder.to_owned());
        }
    }

    /// Loads the folders from the window's own storage.
    pub fn load(&mut self, storage: &dyn eframe::Storage) {
        self.0 = eframe::get_value(storage, KEY).unwrap_or_default();
    }

    /// Stores them there.
    pub fn store(&self, storage: &mut dyn eframe::Storage) {
        // A path that is not valid Unicode cannot be stored.
        let named: BTreeMap<_, _> = self.0.iter().filter(|(_, folder)| folder.to_str().is_some()).collect();
        eframe::set_value(storage, KEY, &named);
    }
}
