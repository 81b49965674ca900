//! The browser's file dialog, for files that are read. Those that are written are named in the window, and
//! downloaded.

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;

use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::HtmlInputElement;

use super::files::{keep, main_file};
use crate::app::dialogs::{SystemAnswer, SystemQuestion};
use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::jobs::{Job, Jobs, Output};

/// Returns whether the browser asks for a file: it has no dialog for those that are written.
pub fn has_dialog(request: FileRequest) -> bool {
    !request.writes()
}

/// Asks for files. Several may be chosen, so that a recipe comes with its rasters; the answer is the first
/// one that fits the question. Where the browser shows no dialog, the one in the window lists the files of
/// the page.
pub fn ask(question: SystemQuestion, jobs: &Jobs) -> Job<(SystemQuestion, SystemAnswer)> {
    let (job, output) = jobs.expect();
    // One of the events comes, and takes it.
    let asked = Rc::new(RefCell::new(Some((question, output))));
    if open(&asked).is_err() {
        answer(&asked, SystemAnswer::NoDialog);
    }
    job
}

/// A question that was not answered yet.
type OpenQuestion = Rc<RefCell<Option<(SystemQuestion, Output<(SystemQuestion, SystemAnswer)>)>>>;

fn answer(asked: &OpenQuestion, answer: SystemAnswer) {
    if let Some((question, output)) = asked.take() {
        output.send((question, answer));
    }
}

fn open(asked: &OpenQuestion) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("no document")?;
    let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
    input.set_type("file");
    input.set_multiple(true);
    let (chosen, of_change, of_cancel) = (input.clone(), asked.clone(), asked.clone());
    let on_change = Closure::once_into_js(move || {
        spawn_local(async move {
            let names = kept_files(&chosen).await.unwrap_or_default();
            let request = of_change.borrow().as_ref().map(|(question, _)| question.request);
            let file = request.and_then(|request| main_file(&names, request));
            answer(&of_change, file.map_or(SystemAnswer::Cancelled, SystemAnswer::Chosen));
        });
    });
    let on_cancel = Closure::once_into_js(move || answer(&of_cancel, SystemAnswer::Cancelled));
    input.add_event_listener_with_callback("change", on_change.unchecked_ref())?;
    input.add_event_listener_with_callback("cancel", on_cancel.unchecked_ref())?;
    input.click();
    Ok(())
}

/// Keeps the files that were chosen in memory, and returns their names.
async fn kept_files(input: &HtmlInputElement) -> Result<Vec<PathBuf>, JsValue> {
    let mut names = Vec::new();
    let files = input.files().ok_or("no files")?;
    for file in (0..files.length()).filter_map(|index| files.get(index)) {
        let buffer = JsFuture::from(file.array_buffer()).await?;
        names.push(keep(&file.name(), js_sys::Uint8Array::new(&buffer).to_vec()));
    }
    Ok(names)
}
