//! The building blocks of a feature of the window, and its view of the window.
//!
//! ```text
//!  Feature ── Row         panels, marks on the canvas, entries of menus
//!     │
//!     ├── execute(command, Ctx)      changes its own state, and through the context what all share
//!     ├── follow(Ctx)                once a frame: work that takes longer than one
//!     └── panels, marks, entries     read a FrameState and send commands
//! ```

pub mod ages;
pub mod background;
pub mod boundary;
pub mod brake;
pub mod busy;
pub mod canvas_aids;
pub mod clock;
pub mod coordinates;
pub mod command;
pub mod cuts;
pub mod derivation;
pub mod dock;
pub mod document_id;
pub mod export_set;
pub mod file_coordinates;
pub mod heights;
pub mod home;
pub mod jobs;
pub mod layer_edits;
pub mod mesh_export;
pub mod notices;
pub mod picture_choices;
pub mod platform;
pub mod presentation;
pub mod project;
pub mod readout;
pub mod recovery;
pub mod session;
pub mod size_change;
pub mod slices;
pub mod solver_repair;
pub mod threads;
pub mod tools;
pub mod view;

mod area;
mod ctx;
mod data_file;
mod data_role;
mod dragged_shape;
mod drawing;
mod empty_document;
mod entry;
mod feature;
mod features;
mod file_kind;
mod formula_row;
mod frame_state;
mod gesture;
mod gesture_help;
mod hatching;
mod keymap;
mod layer_kind;
mod level_light;
pub mod marks;
mod mask_file;
mod menu_item;
mod name_field;
mod panel;
mod place;
mod radius_row;
mod size_price;
mod strip;
mod tab;
mod shortcut;
mod tool;

pub use area::area_text;
pub use ctx::{Ctx, EditRecorder, NO_LIMIT, PictureOverlays};
pub use data_file::{DataContents, DataFile, Preview, RasterFacts, look_at, seen_shapes};
pub use data_role::DataRole;
pub use dragged_shape::{DraggedShape, press_shape};
pub use drawing::{DrawingCommands, UNDER_POINTER, press_brush, press_corner};
pub use empty_document::{EmptyDocument, raster_frame, show_over_extent, show_with_layer, with_space_around};
pub use entry::{CatalogItem, DIGITS, Menu, NOT_QUERYING, QUERYING, Submenu};
pub use feature::{Feature, Row};
pub use features::{Features, all_tools, kinds_of_layers};
pub use file_kind::{FileAct, FileKind, FileRequest};
pub use formula_row::FormulaRow;
pub use frame_state::{FeatureStates, FrameState};
pub use gesture::{CLICK_SLACK, GRIP_POINTS, Gesture, Pointer, Press, SettingsDrag, nearest_within};
pub use gesture_help::{GestureHelp, GesturePlace};
pub use hatching::hatching;
pub use keymap::{Keymap, conflicts, owners};
pub use layer_kind::{Addition, LayerKindRow, LayerKinds, add_layer, range_rows, set_kind, set_kind_once};
pub use level_light::light_level;
pub use mask_file::with_mask;
pub use menu_item::{MENU_WIDTH, menu_item, menu_items};
pub use name_field::name_field;
pub use panel::{Panel, button_rows, end_gesture_when_released, remark, set_once};
pub use place::DockPlace;
pub use radius_row::radius_row;
pub use shortcut::{same_keys, shortcut_text};
pub use size_price::size_price_row;
pub use strip::StripItem;
pub use tab::Tab;
pub use tool::{OverMesh, Tool, ToolSpec};
