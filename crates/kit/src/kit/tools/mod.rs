//! The selected tool, and the settings of tools that several parts of the window read.
//!
//! Name, key, icon, hint, panel sections and gestures of a tool are fields of its
//! [`ToolSpec`](crate::kit::ToolSpec), a static of its feature. Menus, keys, the tool strip, the side
//! panel and the canvas read the tools of all features, so that a new tool is one file and one entry of a
//! row.

mod kept;
mod paint;
mod pan;
mod pen;
mod presets;
mod settings;

use std::collections::BTreeMap;

use glam::DVec2;

pub use kept::KeptBrush;
pub use paint::{BrushMode, PaintKind};
pub use pan::{PAN, move_view};
pub use pen::{Pen, PenResponse};
pub use presets::{BrushPreset, KeptPreset, MOST_PRESETS, kept_pen, pen_of_kept};
pub use settings::{AnySettings, ToolSettings, first_settings};

use crate::kit::{FrameState, Tool};
use meshbrush_core::paint::{Brush, Mirror, PathPoint};
use meshbrush_mesh::geometry::Rect;
use meshbrush_ui::widgets::Hint;
use settings::SettingsOfTools;

/// How often a tool is used before its hint goes away.
const USES_WITH_HINT: u32 = 6;
/// Radius of the brush at first, as a share of the longer side of the domain.
pub const FIRST_RADIUS: f64 = 0.06;
/// Hardness of the brush at first.
pub const FIRST_HARDNESS: f64 = 0.35;
/// Strength of the brush and of the eraser at first.
const FIRST_STRENGTHS: [f64; 2] = [0.8, 1.0];

/// The selected tool, and the settings of all tools.
#[derive(Clone, Debug, PartialEq)]
pub struct Tools {
    /// All tools, in the order of the tool strip.
    all: Vec<Tool>,
    /// The tool that acts on the canvas.
    pub tool: Tool,
    /// The tool that was selected.
    chosen: Tool,
    /// Whether the pointer only moves the view, whatever tool was selected.
    only_moves_view: bool,
    /// The kind of paint of the brush.
    pub kind: PaintKind,
    /// How a stroke of the brush changes the paint.
    pub mode: BrushMode,
    /// The longer side of the domain that radius and diameter suit, in world units.
    extent: f64,
    /// Radius of brush and eraser in world units.
    pub radius: f64,
    /// Hardness of brush and eraser, 0 to 1.
    pub hardness: f64,
    /// Strength of the brush, 0 to 1.
    pub paint_strength: f64,
    /// Strength of the eraser, 0 to 1.
    pub erase_strength: f64,
    /// The risk that the brush paints in the mode *Set*, 0 to 1.
    pub risk: f64,
    /// The diameter that the brush paints, in world units.
    pub diameter: f64,
    /// The error that the brush paints, in the unit of surfaces.
    pub error: f64,
    /// How strongly strokes are smoothed, 0 to 1.
    pub smoothing: f64,
    /// Whether strokes are repeated: left and right, above and below.
    pub mirrored: [bool; 2],
    /// The pen, where there is one.
    pub pen: Pen,
    /// Brushes that a person keeps under a name.
    presets: Vec<BrushPreset>,
    /// The end of the last stroke, in world units.
    pub last_painted: Option<DVec2>,
    /// The settings of tools that only their features know.
    settings: SettingsOfTools,
    /// Whether a tool was selected since [`Self::take_selection`].
    was_selected: bool,
    /// How often each tool was used, by its name.
    uses: BTreeMap<&'static str, u32>,
}

impl Tools {
    /// Returns tools of which the first is selected, with a brush that suits a domain whose longer side is
    /// `extent` and whose smallest diameter is `h_min`, in world units.
    pub fn for_domain(all: Vec<Tool>, extent: f64, h_min: f64) -> Self {
        let settings = all.iter().filter_map(|tool| tool.settings);
        Self {
            tool: all[0],
            chosen: all[0],
            only_moves_view: false,
            kind: PaintKind::Risk,
            mode: BrushMode::BuildUp,
            extent,
            radius: FIRST_RADIUS * extent,
            hardness: FIRST_HARDNESS,
            paint_strength: FIRST_STRENGTHS[0],
            erase_strength: FIRST_STRENGTHS[1],
            risk: 0.5,
            diameter: 2.0 * h_min,
            error: 1.0,
            smoothing: 0.0,
            mirrored: [false; 2],
            pen: Pen::default(),
            presets: BrushPreset::first(),
            last_painted: None,
            settings: SettingsOfTools::new(settings.map(|first| first())),
            was_selected: false,
            uses: BTreeMap::new(),
            all,
        }
    }

    /// Returns all tools, in the order of the tool strip.
    pub fn all(&self) -> &[Tool] {
        &self.all
    }

    /// Returns the settings of a tool.
    ///
    /// # Panics
    /// Panics where the window has no tool with such settings.
    pub fn settings<S: ToolSettings>(&self) -> &S {
        self.settings.get().expect("the window has the tool")
    }

    /// Returns the settings of a tool, to be changed.
    ///
    /// # Panics
    /// Panics where the window has no tool with such settings.
    pub fn settings_mut<S: ToolSettings>(&mut self) -> &mut S {
        self.settings.get_mut().expect("the window has the tool")
    }

    /// Returns whether another tool, kind of paint, mode or amount is chosen than in `other`.
    pub fn differs_in_choice(&self, other: &Self) -> bool {
        let choices = |tools: &Self| (tools.tool, tools.kind, tools.mode);
        let amounts = |tools: &Self| [tools.paint_strength, tools.erase_strength, tools.risk];
        choices(self) != choices(other)
            || amounts(self) != amounts(other)
            || self.settings.differ_in_choice(&other.settings)
    }

    /// Selects a tool.
    pub fn select(&mut self, tool: Tool) {
        self.chosen = tool;
        self.put_into_effect();
        self.was_selected = true;
    }

    /// Returns whether a tool was selected since the last call.
    pub fn take_selection(&mut self) -> bool {
        std::mem::take(&mut self.was_selected)
    }

    /// Returns the tool that was selected, also while the pointer only moves the view.
    pub fn chosen(&self) -> Tool {
        self.chosen
    }

    /// Lets the pointer only move the view, or use the selected tool again.
    pub fn only_move_view(&mut self, only: bool) {
        self.only_moves_view = only;
        self.put_into_effect();
    }

    fn put_into_effect(&mut self) {
        self.tool = if self.only_moves_view { &PAN } else { self.chosen };
    }

    /// Selects the brush: the first tool that paints.
    pub fn select_brush(&mut self) {
        let brush = self.all.iter().find(|tool| tool.brush.is_some()).copied();
        self.select(brush.unwrap_or(self.all[0]));
    }

    /// Returns whether the tool that was selected is the first one.
    pub fn has_first(&self) -> bool {
        self.chosen == self.all[0]
    }

    /// Returns what is left when another document is opened, whose domain is that of [`Self::for_domain`]:
    /// only what is named here, which is about the hand of a person.
    pub fn for_next_document(self, extent: f64, h_min: f64) -> Self {
        Self {
            tool: self.chosen,
            chosen: self.chosen,
            radius: self.radius / self.extent * extent,
            hardness: self.hardness,
            paint_strength: self.paint_strength,
            erase_strength: self.erase_strength,
            risk: self.risk,
            smoothing: self.smoothing,
            pen: self.pen,
            presets: self.presets,
            uses: self.uses,
            ..Self::for_domain(self.all, extent, h_min)
        }
    }

    /// Notes the longer side of the domain, in world units. Where it changed, the brush keeps its share of
    /// it.
    pub fn follow_extent(&mut self, extent: f64) {
        let ratio = extent / self.extent;
        if ratio != 1.0 {
            self.radius *= ratio;
            self.diameter *= ratio;
            self.extent = extent;
        }
    }

    /// Returns whether the selected tool shows the brush ring.
    pub fn has_ring(&self) -> bool {
        (self.tool.has_ring)(self)
    }

    /// Returns whether the selected tool changes the paint.
    pub fn paints(&self) -> bool {
        self.tool.brush.is_some()
    }

    /// Returns the brush of the selected tool's strokes, if it paints.
    pub fn brush(&self) -> Option<Brush> {
        self.tool.brush.map(|brush| brush(self))
    }

    /// Returns the lines in which strokes are repeated, through the middle of the domain.
    pub fn mirror(&self, bounds: Rect) -> Mirror {
        let [x, y] = self.mirrored;
        let middle = bounds.center();
        Mirror { x: x.then_some(middle.x), y: y.then_some(middle.y) }
    }

    /// Returns a point of a stroke, in world units, with the brush as the pressure of the pen makes it.
    pub fn path_point(&self, at: DVec2) -> PathPoint {
        self.pen.path_point(at)
    }

    /// Strength of the selected tool.
    pub fn strength(&self) -> f64 {
        if self.tool.erases { self.erase_strength } else { self.paint_strength }
    }

    /// Strength of the selected tool at first.
    pub fn first_strength(&self) -> f64 {
        FIRST_STRENGTHS[usize::from(self.tool.erases)]
    }

    /// Sets the strength of the selected tool.
    pub fn set_strength(&mut self, strength: f64) {
        let own = if self.tool.erases { &mut self.erase_strength } else { &mut self.paint_strength };
        *own = strength.clamp(0.01, 1.0);
    }

    /// Counts a use of a tool.
    pub fn note_use(&mut self, tool: Tool) {
        let uses = self.uses.entry(tool.name).or_default();
        *uses = uses.saturating_add(1);
    }

    /// Returns the hint for the selected tool; empty after a few uses.
    pub fn hint(&self, state: &FrameState<'_>) -> &'static [Hint<'static>] {
        let known = self.uses.get(self.tool.name).is_some_and(|&uses| uses >= USES_WITH_HINT);
        if known { &[] } else { (self.tool.hint)(state) }
    }
}
