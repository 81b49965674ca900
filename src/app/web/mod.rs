//! The window in a tab of a browser: what a page can do with it, and what a desktop does otherwise.
//!
//! The page in `web/` loads the module, makes a [`Meshbrush`] and gives it a canvas. Everything else is the
//! same [`App`] as on a desktop. A tab has no threads: frames do the work of jobs (`kit/jobs`). Its files are
//! in memory (`io::disk`).

mod assets;
mod events;
mod file_dialog;
mod files;
mod interface;
pub mod journal;
mod pen;

use std::path::PathBuf;

pub use assets::{asset, fetch};
pub use file_dialog::{ask, has_dialog};
pub use files::take_dropped;
pub use pen::take_pen;

/// Returns the address of the page, without the part after `#`.
pub fn address() -> String {
    let address = web_sys::window().and_then(|window| window.location().href().ok()).unwrap_or_default();
    address.split('#').next().unwrap_or_default().to_owned()
}

/// Returns the part of the address of the page after `#`; nothing where there is none.
fn link() -> String {
    let hash = web_sys::window().and_then(|window| window.location().hash().ok()).unwrap_or_default();
    hash.trim_start_matches('#').to_owned()
}

/// Returns the folder for the data of the program: all files of a page are in one.
pub fn data_folder() -> Option<PathBuf> {
    Some(PathBuf::new())
}

/// Fails: only a page opens the window.
///
/// # Errors
/// Always, with a sentence.
pub fn run(_file: Option<PathBuf>) -> Result<(), String> {
    Err("In a browser a page opens the window.".into())
}
