//! Widgets that change a value or run a command.

mod choices;
mod curve_plot;
mod dropdown;
mod grab;
mod knot_row;
mod layer_row;
mod message;
mod number;
mod number_cell;
mod number_input;
mod number_menu;
mod section;
mod segmented;
mod slider;
mod tabs;
mod text_row;
mod toggle;
mod tool_button;
mod transfer;
mod transfer_plot;

pub use choices::choice_rows;
pub use curve_plot::{CurveChange, CurvePlot};
pub use dropdown::dropdown_row;
pub use knot_row::{KnotAnswer, KnotRow};
pub use layer_row::{LayerRow, LayerRowAnswer};
pub use number::NumberRow;
pub use section::Section;
pub use segmented::segmented;
pub use slider::SliderRow;
pub use tabs::tab_bar;
pub use text_row::{TextError, TextRow};
pub use toggle::{toggle_row, toggle_row_with_help};
pub use tool_button::{ActionButton, ButtonKind, ToolButton};
pub use transfer::{CurveField, CurveValues, TransferCurve};

use super::{Icon, format, paint};
