//! Widgets that show a value.

mod answer_row;
mod chip;
mod empty;
mod file_row;
mod histogram;
mod icon;
mod key_row;
mod levels;
mod plot;
mod status;
mod value_row;

pub use answer_row::{AnswerClicks, AnswerRow};
pub use chip::{Chip, chips};
pub use empty::empty_state;
pub use file_row::FileRow;
pub use histogram::{Histogram, HistogramBar};
pub use icon::Icon;
pub use key_row::{key_row, key_row_button};
pub use levels::{LevelLegend, LevelRow};
pub use plot::{plot_picker, plot_view};
pub use status::StatusCell;
pub use value_row::{ValueRow, value_row};

use super::{format, paint};
