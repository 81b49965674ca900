//! Widgets over the window or the canvas: dialogs, the command palette, messages, progress, hints.

mod banner;
mod confirm;
mod float;
mod palette;
mod progress;
mod search;
mod search_field;

pub use banner::{Banner, BannerAnswer};
pub use confirm::{ConfirmAnswer, ConfirmDialog, dialog, dialog_title};
pub use float::{Hint, elided_text, floating_tag, hint_pill, paint_floating, tag_size};
pub use palette::{PaletteAnswer, PaletteItem, command_palette};
pub use progress::{bytes_row, progress_row};
pub use search::matches;
pub use search_field::SearchField;

use super::{Icon, format, paint};
