//! The description of a tool: its names, and its behaviour on the canvas.

use std::fmt;

use egui::{CursorIcon, Key, Painter, Pos2, Rect, Ui};
use glam::DVec2;

use super::{FrameState, Gesture, Pointer, Press, StripItem, Tab};
use crate::kit::command::Command;
use crate::kit::tools::{AnySettings, Tools};
use meshbrush_core::paint::Brush;
use meshbrush_ui::widgets::{Hint, Icon};

/// A tool: a static of the feature that it belongs to.
pub type Tool = &'static ToolSpec;

/// The description of a tool: its names, and its behaviour on the canvas.
pub struct ToolSpec {
    /// Its place on the tool strip and in menus: tools with a lower number stand first.
    pub place: u8,
    /// Name in menus and on the tool strip.
    pub name: &'static str,
    /// The key that selects it.
    pub key: Key,
    /// The icon of the tool on the tool strip.
    pub icon: Icon,
    /// The cursor over the canvas, where no ring is drawn.
    pub cursor: CursorIcon,
    /// The tab of the lower dock that is shown when the tool is selected.
    pub tab: Option<Tab>,
    /// Its options on the strip above the canvas, from the left. Without any the strip shows its hint.
    pub options: &'static [StripItem],
    /// What to do with it next.
    pub hint: fn(&FrameState<'_>) -> &'static [Hint<'static>],
    /// Whether the brush ring is drawn around the pointer.
    pub has_ring: fn(&Tools) -> bool,
    /// The brush of its strokes, if it paints.
    pub brush: Option<fn(&Tools) -> Brush>,
    /// Whether its strokes remove paint.
    pub erases: bool,
    /// The settings that it has at first, if only its feature knows them.
    pub settings: Option<fn() -> Box<dyn AnySettings>>,
    /// Whether it queries triangles: the one under the pointer is highlighted, the queried one is explained,
    /// pins can be moved, and the digits go to neighbours.
    pub queries: bool,
    /// Whether it works in the view in space, too.
    pub in_space: bool,
    /// Draws over the mesh while the tool is selected.
    pub paint: fn(&FrameState<'_>, &OverMesh<'_>),
    /// Begins a gesture when the primary button is pressed.
    pub press: BeginGesture,
    /// Reacts to a press of the secondary button. Returns whether it did anything; if not, the menu of the
    /// canvas opens.
    pub press_secondary: fn(&Tools, &mut Vec<Command>) -> bool,
    /// Entries of the canvas's menu at a point, in world units.
    pub menu: fn(&FrameState<'_>, DVec2) -> Vec<(&'static str, Command)>,
}

/// Begins a gesture, or acts at once and returns `None`.
pub type BeginGesture = fn(&Press, &Pointer<'_>, &mut Vec<Command>) -> Option<Box<dyn Gesture>>;

/// The surface on which features and tools draw over the mesh.
pub struct OverMesh<'a> {
    /// The canvas, for what takes part in hovering and clicks, and for colours.
    pub ui: &'a Ui,
    /// The rectangle of the canvas, in points.
    pub canvas: Rect,
    /// Clipped to the canvas.
    pub painter: &'a Painter,
    /// Screen points from world coordinates.
    pub screen_from_world: &'a dyn Fn(DVec2) -> Pos2,
    /// In space the greatest length of a straight piece of a line, in world units.
    pub straight: Option<f64>,
    /// The pointer in points, while it is over the canvas.
    pub pointer: Option<Pos2>,
}

/// Most pieces of a straight line on a surface.
const MOST_PIECES: f64 = 256.0;

impl OverMesh<'_> {
    /// Returns a line through points in world units on the screen. In space it lies on the surface, also
    /// between the points.
    pub fn line(&self, points: impl IntoIterator<Item = DVec2>) -> Vec<Pos2> {
        let (mut line, mut last) = (Vec::new(), None);
        for point in points {
            if let (Some(straight), Some(from)) = (self.straight, last) {
                let from: DVec2 = from;
                let pieces = (from.distance(point) / straight).ceil().clamp(1.0, MOST_PIECES) as u32;
                let between = (1..pieces).map(|n| from.lerp(point, f64::from(n) / f64::from(pieces)));
                line.extend(between.map(|at| (self.screen_from_world)(at)));
            }
            line.push((self.screen_from_world)(point));
            last = Some(point);
        }
        line
    }
}

impl ToolSpec {
    /// Creates a tool that does nothing yet; use it as the base of a struct update.
    pub const fn new(name: &'static str, key: Key, icon: Icon) -> Self {
        Self {
            place: u8::MAX,
            name,
            key,
            icon,
            cursor: CursorIcon::Crosshair,
            tab: None,
            options: &[],
            hint: |_| &[],
            has_ring: |_| false,
            brush: None,
            erases: false,
            settings: None,
            queries: false,
            in_space: false,
            paint: |_, _| {},
            press: |_, _, _| None,
            press_secondary: |_, _| false,
            menu: |_, _| Vec::new(),
        }
    }
}

impl PartialEq for ToolSpec {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for ToolSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
