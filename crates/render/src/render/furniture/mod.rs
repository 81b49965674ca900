//! What stands around the map in exported pictures: legend, axes, scale bar and arrow to the north.
//!
//! [`Sheet::lay_out`] decides all places and texts, as plain data. [`pixels`] and [`shapes`] draw that data.

mod axes;
mod blocks;
mod choice;
mod content;
mod drawing;
mod glyphs;
mod layout;
mod legend;
mod level_legend;
mod pixels;
mod scale_bar;
mod shapes;
mod sheet;
mod space_axes;

pub use self::axes::MapAxes;
pub use self::choice::{Furniture, UnknownFurniture};
pub use self::content::{Bar, Inks, SheetContent};
pub use self::layout::{NoRoom, SheetRequest};
pub use self::legend::{Legend, LegendBody, LegendRow, LegendScale};
pub use self::level_legend::{LevelLegend, LevelRow};
pub use self::pixels::{draw_sheet, without_premultiplication};
pub use self::scale_bar::ScaleBar;
pub use self::shapes::shapes_of;
pub use self::sheet::{Sheet, SheetMark};
pub use self::space_axes::SpaceAxes;
