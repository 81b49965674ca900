//! The window's controls.
//!
//! They know no document and no mesh: plain values go in, responses come out. Each has a name by which tests and screen
//! readers find it, works with pointer and keyboard, and takes its colours from [`super::theme`].
//!
//! Rows take the width they are given; they are made for panels of [`super::theme::metrics::PANEL_WIDTH`].

mod banner;
mod chip;
mod confirm;
mod dropdown;
mod empty;
mod float;
pub mod format;
mod fuzzy;
mod icon;
mod levels;
mod number;
mod paint;
mod palette;
mod progress;
mod section;
mod segmented;
mod slider;
mod status;
mod text_row;
mod toggle;
mod tool_button;
mod transfer;
mod value_row;

pub use banner::{Banner, BannerAnswer, BannerKind};
pub use chip::{Chip, chips};
pub use confirm::{Answer, ConfirmDialog, dialog, dialog_title};
pub use dropdown::dropdown_row;
pub use empty::empty_state;
pub use float::{Hint, floating_tag, hint_pill, paint_floating, tag_size};
pub use fuzzy::{Match, fuzzy_match};
pub use icon::Icon;
pub use levels::{LevelLegend, LevelRow, LevelsResponse};
pub use number::NumberRow;
pub use palette::{CommandPalette, PaletteItem};
pub use progress::{bytes_row, progress_row};
pub use section::{Section, SectionResponse};
pub use segmented::segmented;
pub use slider::SliderRow;
pub use status::StatusCell;
pub use text_row::{TextError, TextRow};
pub use toggle::toggle_row;
pub use tool_button::{ActionButton, ButtonKind, ToolButton};
pub use transfer::{Transfer, TransferCurve, TransferResponse};
pub use value_row::value_row;

/// Whether a gesture that may have changed a value is complete: the pointer was let go, or a value was typed or reached
/// by key.
///
/// Everything that changed since the last complete gesture belongs to one entry of the history. After a click that
/// changed nothing the answer is yes as well.
pub fn edit_done(response: &eframe::egui::Response) -> bool {
    let held = response.dragged() || response.is_pointer_button_down_on();
    response.drag_stopped() || response.clicked() || (response.changed() && !held)
}
