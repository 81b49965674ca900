//! What the window runs in.

/// Whether the window is in a page of a browser.
pub const IS_PAGE: bool = cfg!(target_family = "wasm");
