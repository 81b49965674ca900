//! The interface of the window's features.

use glam::DVec2;

use super::{
    CatalogItem, Ctx, DataRole, FileKind, FrameState, GestureHelp, LayerKindRow, OverMesh, Panel, Tool,
};
use crate::kit::command::{Command, CommandSet};

/// A feature of the window: a folder under `features` with its state, its commands and what they do, its
/// panels, its marks on the canvas, its entries in menus, its kinds of files and its tests.
pub trait Feature: Default + 'static {
    /// The commands of the feature.
    type Command: CommandSet;

    /// The parts of the feature that the window shows.
    const ROW: Row;

    /// Runs one command.
    fn execute(&mut self, command: Self::Command, ctx: &mut Ctx<'_>);

    /// Takes and starts work that takes longer than a frame, once a frame, when the mesh has followed the
    /// document. Returns whether some is left.
    fn follow(&mut self, _ctx: &mut Ctx<'_>) -> bool {
        false
    }

    /// Puts down what was begun with a tool: another tool was selected, or Escape was pressed. Returns
    /// whether there was something.
    fn put_down(&mut self, _ctx: &mut Ctx<'_>) -> bool {
        false
    }

    /// Returns what is left when another document is opened: nothing but what belongs to the window, which a
    /// feature names here.
    fn for_next_document(self) -> Self {
        Self::default()
    }
}

/// The parts of a feature that the window shows.
pub struct Row {
    /// Sections of the side panel.
    pub panels: &'static [&'static Panel],
    /// Tools.
    pub tools: &'static [Tool],
    /// Kinds of files that are opened by their ending.
    pub files: &'static [&'static FileKind],
    /// The uses of files of data that the feature has.
    pub roles: &'static [DataRole],
    /// Gestures of the pointer, for the list of keys.
    pub gestures: &'static [GestureHelp],
    /// Kinds of layers.
    pub layer_kinds: &'static [&'static LayerKindRow],
    /// Draws over the mesh, below what the selected tool draws.
    pub marks_below: fn(&FrameState<'_>, &OverMesh<'_>),
    /// Draws over the mesh.
    pub marks: fn(&FrameState<'_>, &OverMesh<'_>),
    /// Entries of menus, in their order.
    pub entries: fn(&FrameState<'_>) -> Vec<CatalogItem>,
    /// Entries of the menu of the canvas at a point, in world units, after those of the tool.
    pub entries_at: fn(&FrameState<'_>, DVec2) -> Vec<(&'static str, Command)>,
}

impl Row {
    /// Nothing yet; use it as the base of a struct update.
    pub const EMPTY: Self = Self {
        panels: &[],
        tools: &[],
        files: &[],
        roles: &[],
        gestures: &[],
        layer_kinds: &[],
        marks_below: |_, _| {},
        marks: |_, _| {},
        entries: |_| Vec::new(),
        entries_at: |_, _| Vec::new(),
    };
}
