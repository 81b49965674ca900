//! The window's controls.
//!
//! They know no document and no mesh: plain values go in, responses come out. Each has a name by which tests
//! and screen readers find it, works with pointer and keyboard, and takes its colours from [`super::theme`].
//!
//! Rows take the available width; they are designed for panels of [`super::theme::metrics::PANEL_WIDTH`].

mod brush_tips;
mod controls;
mod display;
mod floating;
pub mod format;
pub mod key_menu;
mod paint;
mod reveal;
pub mod degrees;
pub mod shown_keys;
mod domain_tips;
mod picture_tips;
mod space_tips;
mod layer_tips;
pub mod tips;
mod vanished;

pub use controls::*;
pub use display::*;
pub use floating::*;
pub use reveal::reveal;
pub use vanished::VanishedButtons;

/// Returns whether a gesture that may have changed a value is complete: the pointer was released, or a value
/// was typed or set by key.
///
/// Everything that changed since the last complete gesture is one undo step. The answer is yes after a click
/// that changed nothing, too.
pub fn edit_done(response: &egui::Response) -> bool {
    let held = response.dragged() || response.is_pointer_button_down_on();
    // A press that was held for long without a movement is neither a click nor a drag.
    let released = response.contains_pointer() && response.ctx.input(|input| input.pointer.any_released());
    response.drag_stopped() || response.clicked() || released || (response.changed() && !held)
}
