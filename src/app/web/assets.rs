//! Files that come with the program: the page fetches them when they are needed first.

use std::cell::RefCell;
use std::collections::BTreeMap;

use js_sys::{Reflect, Uint8Array};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::spawn_local;

use meshbrush_kit::kit::jobs::{Job, Jobs};

#[wasm_bindgen(module = "/web/assets.js")]
extern "C" {
    #[wasm_bindgen(catch)]
    async fn load(name: &str) -> Result<Uint8Array, JsValue>;
}

thread_local! {
    /// What was fetched, by name. It is kept as long as the page.
    static FETCHED: RefCell<BTreeMap<&'static str, &'static [u8]>> = RefCell::default();
}

/// Returns a file of an example, or a picture as the manual names it, if it was [fetched](fetch).
pub fn asset(name: &str) -> Option<&'static [u8]> {
    FETCHED.with_borrow(|fetched| fetched.get(name).copied())
}

/// Fetches files, and sends the outcome, as a sentence where one cannot be fetched.
pub fn fetch<T: Send + 'static>(
    names: Vec<&'static str>,
    outcome: impl FnOnce(Result<(), String>) -> T + Send + 'static,
    jobs: &Jobs,
) -> Job<T> {
    let (job, output) = jobs.expect();
    spawn_local(async move {
        output.send(outcome(fetch_all(names).await));
    });
    job
}

async fn fetch_all(names: Vec<&'static str>) -> Result<(), String> {
    for name in names {
        match load(name).await {
            Ok(bytes) => {
                let bytes: &'static [u8] = Vec::leak(bytes.to_vec());
                FETCHED.with_borrow_mut(|fetched| _ = fetched.insert(name, bytes));
            }
            Err(problem) => {
                let reason = Reflect::get(&problem, &"message".into()).ok().and_then(|text| text.as_string());
                let reason = reason.unwrap_or_else(|| "no answer".into());
                return Err(format!(
                    "the server did not send {name} ({reason}). Look at the connection and try again."
                ));
            }
        }
    }
    Ok(())
}
