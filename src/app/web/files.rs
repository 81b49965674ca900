//! Files of a page: those that a person drops or chooses are kept in memory, and those that are written
//! become downloads.

use std::path::{Path, PathBuf};

use eframe::egui::DroppedFileHandle;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::spawn_local;
use web_sys::{Blob, BlobPropertyBag, HtmlAnchorElement, Url};

use crate::app::file_kinds::{OPEN_PROJECT, OPEN_RECIPE, opened_by_ending};
use meshbrush_io::io::{Meter, disk};
use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::background::{Aim, Background, Outcome};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::jobs::Jobs;

/// Keeps a file in memory, and returns its name there.
pub fn keep(name: &str, bytes: Vec<u8>) -> PathBuf {
    let path = PathBuf::from(name);
    disk::put(&path, bytes);
    path
}

/// Returns the first of some files that fits a question, or else the first one.
pub fn main_file(names: &[PathBuf], request: FileRequest) -> Option<PathBuf> {
    let fits = |name: &&PathBuf| request.takes(name.as_os_str());
    // A recipe is opened with the rasters that it names.
    let documents = names.iter().filter(|name| is_document(name)).find(fits);
    documents.or_else(|| names.iter().find(fits)).or(names.first()).cloned()
}

fn is_document(name: &Path) -> bool {
    [&OPEN_PROJECT, &OPEN_RECIPE].iter().any(|kind| kind.takes(name.as_os_str()))
}

/// Reads files that were dropped on the page, all of them before any is used: a recipe needs its rasters.
pub fn take_dropped(files: &[DroppedFileHandle], background: &mut Background, jobs: &Jobs) -> Vec<Command> {
    let Some(first) = files.first() else { return Vec::new() };
    let (job, output) = jobs.expect();
    background.enter(Aim::Read, first.path(), Meter::default(), job);
    let files = files.to_vec();
    spawn_local(async move {
        let mut names = Vec::new();
        for file in files {
            match file.bytes_async().await {
                Ok(bytes) => names.push(keep(&file.path().to_string_lossy(), bytes)),
                Err(problem) => {
                    let name = file.path().display();
                    output.send(Outcome::not_read(format!("{name} could not be read: {problem}.")));
                    return;
                }
            }
        }
        output.send(Outcome::PartRead(commands_for(names)));
    });
    Vec::new()
}

/// Returns the commands for files that came together: those that are documents are opened, with the others
/// beside them. Without a document each file that can be opened is data; if none can, the first one says so.
fn commands_for(names: Vec<PathBuf>) -> Vec<Command> {
    let opens = |name: &PathBuf| opened_by_ending().any(|kind| kind.takes(name.as_os_str()));
    let wanted: Vec<PathBuf> = if names.iter().any(|name| is_document(name)) {
        names.into_iter().filter(|name| is_document(name)).collect()
    } else if names.iter().any(opens) {
        names.into_iter().filter(opens).collect()
    } else {
        names.into_iter().take(1).collect()
    };
    wanted.into_iter().map(|name| Command::from(FileCommand::AddData(name))).collect()
}

/// Hands the files that were written since the last call to the browser, as downloads.
pub fn hand_over() {
    for (path, bytes) in disk::take_written() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        if let Err(problem) = download(&name, &bytes) {
            web_sys::console::error_2(&format!("{name} could not be downloaded:").into(), &problem);
        }
    }
}

fn download(name: &str, bytes: &[u8]) -> Result<(), JsValue> {
    let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
    let options = BlobPropertyBag::new();
    options.set_type("application/octet-stream");
    let blob = Blob::new_with_u8_array_sequence_and_options(&parts, &options)?;
    let url = Url::create_object_url_with_blob(&blob)?;
    let document = web_sys::window().and_then(|window| window.document()).ok_or("no document")?;
    let link: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
    link.set_href(&url);
    link.set_download(name);
    link.click();
    // The browser has taken the contents once the click has been handled.
    Url::revoke_object_url(&url)
}
