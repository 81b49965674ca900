//! The brush, and the gestures of painting that the eraser shares.

use eframe::egui::{Key, Modifiers, Painter, Pos2};
use glam::DVec2;

use super::BRUSH_OPTIONS;
use meshbrush_core::document::NoPaintLayer;
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_kit::kit::command::{BrushCommand, Command};
use meshbrush_kit::kit::tools::{BrushMode, PaintKind, Tools};
use meshbrush_kit::kit::{CLICK_SLACK, FrameState, Gesture, Pointer, Press, Tab, ToolSpec, marks};
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Paints risk or target diameters.
pub static BRUSH: ToolSpec = ToolSpec {
    place: 0,
    tab: Some(Tab::Size),
    options: &BRUSH_OPTIONS,
    hint: |state| match (hint_without_layer(state), state.tools.kind) {
        (Some(hint), _) => hint,
        (None, PaintKind::Risk) if state.view.space.is_on => PAINT_RISK,
        (None, PaintKind::Risk) => PAINT_RISK_IN_PLAN,
        (None, PaintKind::Diameter | PaintKind::Error) => PAINT_DIAMETER,
    },
    has_ring: |_| true,
    brush: Some(brush),
    in_space: true,
    press: press_to_paint,
    menu: line_to_here,
    ..ToolSpec::new("Brush", Key::B, Icon::BRUSH)
};

/// Length of the string on which the pointer pulls the brush at full smoothing, in points.
const LONGEST_STRING: f32 = 80.0;

const PAINT_RISK_IN_PLAN: &[Hint] = &[
    Text("Drag to paint risk: the mesh follows"),
    KeyOf("smaller-brush"),
    KeyOf("larger-brush"),
    Text("size"),
    KeyOf("eraser"),
    Text("erase"),
    KeyOf("query"),
    Text("query"),
    Text("wheel zooms"),
    HintKey("Space"),
    Text("pans"),
];
/// Without the keys that move the view: in space the canvas shows them.
const PAINT_RISK: &[Hint] = PAINT_RISK_IN_PLAN.split_at(PAINT_RISK_IN_PLAN.len() - 2).0;
const PAINT_DIAMETER: &[Hint] = &[
    Text("Drag to paint a target diameter"),
    KeyOf("smaller-brush"),
    KeyOf("larger-brush"),
    Text("size"),
    HintKey("Alt"),
    Text("click picks a diameter"),
    HintKey("Shift"),
    Text("click draws a line"),
];

const ADD_LAYER: &[Hint] = &[Text("No layer takes this paint: a click offers one")];
const SHOW_LAYER: &[Hint] = &[Text("The layer is hidden: a click offers to show it")];
const UNLOCK_LAYER: &[Hint] = &[Text("The layer is locked: a click offers to unlock it")];

/// Returns what a click offers where no layer takes the paint of the current tool.
pub fn hint_without_layer(state: &FrameState<'_>) -> Option<&'static [Hint<'static>]> {
    let medium = state.tools.brush()?.medium;
    Some(match state.session.document().layer_for(&medium).err()? {
        NoPaintLayer::Missing(_) => ADD_LAYER,
        NoPaintLayer::Hidden { .. } => SHOW_LAYER,
        NoPaintLayer::Locked { .. } => UNLOCK_LAYER,
    })
}

fn brush(tools: &Tools) -> Brush {
    // A brush that sets a value has full strength: a lower strength would give another value.
    let (medium, strength) = match (tools.kind, tools.mode) {
        (PaintKind::Risk, BrushMode::BuildUp) => (Medium::Risk(1.0), tools.paint_strength),
        (PaintKind::Risk, BrushMode::Set) => (Medium::Risk(tools.risk), 1.0),
        (PaintKind::Risk, BrushMode::Lower) => (Medium::Risk(0.0), tools.paint_strength),
        (PaintKind::Diameter, mode) => (Medium::Diameter(tools.diameter, diameter_change(mode)), 1.0),
        (PaintKind::Error, _) => (Medium::Error(tools.error), 1.0),
    };
    Brush { medium, radius: tools.radius, hardness: tools.hardness, strength }
}

/// Returns whether a click picks the value under the pointer instead of painting.
pub fn picks(modifiers: Modifiers) -> bool {
    modifiers.alt || modifiers.command
}

fn diameter_change(mode: BrushMode) -> DiameterChange {
    match mode {
        BrushMode::BuildUp => DiameterChange::Finer,
        BrushMode::Set => DiameterChange::Any,
        BrushMode::Lower => DiameterChange::Coarser,
    }
}

/// Returns the menu of the tools that paint.
pub fn line_to_here(state: &FrameState<'_>, point: DVec2) -> Vec<(&'static str, Command)> {
    let line = state
        .tools
        .last_painted
        .map(|_| ("Straight line to here", Command::from(BrushCommand::LineTo(point))));
    line.into_iter().collect()
}

/// Alt or Ctrl picks the value under the pointer; Shift draws a line or, dragged, sizes the brush; else a
/// stroke begins.
pub fn press_to_paint(
    press: &Press,
    pointer: &Pointer<'_>,
    commands: &mut Vec<Command>,
) -> Option<Box<dyn Gesture>> {
    let point = pointer.world(press.at);
    if picks(press.modifiers) {
        commands.push(Command::from(BrushCommand::Pick(point)));
        return None;
    }
    if press.modifiers.shift {
        return Some(Box::new(Sizing { from: press.at, radius: pointer.tools.radius, dragged: false }));
    }
    commands.push(Command::from(BrushCommand::BeginStroke(point)));
    let slack = LONGEST_STRING * pointer.tools.smoothing as f32;
    Some(Box::new(StrokeInHand { brush: press.at, pointer: press.at, slack }))
}

/// A stroke. With smoothing, the pointer pulls the brush on a string, so that small movements of the hand do
/// not move it.
#[derive(Debug)]
struct StrokeInHand {
    /// The position of the brush, in points.
    brush: Pos2,
    /// The position of the pointer, in points.
    pointer: Pos2,
    /// Length of the string, in points; 0 without smoothing.
    slack: f32,
}

impl Gesture for StrokeInHand {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.pointer = at;
        let (pull, distance) = (at - self.brush, at.distance(self.brush));
        if distance > self.slack {
            self.brush = at - pull * (self.slack / distance);
            commands.push(Command::from(BrushCommand::DrawTo(pointer.world(self.brush))));
        }
    }

    fn released(&self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if at != self.brush {
            commands.push(Command::from(BrushCommand::DrawTo(pointer.world(at))));
        }
        commands.push(Command::from(BrushCommand::EndStroke));
    }

    fn ring_center(&self) -> Option<Pos2> {
        (self.slack > 0.0).then_some(self.brush)
    }

    fn paint(&self, painter: &Painter) {
        if self.slack > 0.0 {
            marks::paint_string(painter, self.brush, self.pointer);
        }
    }

    fn interrupted(&self, commands: &mut Vec<Command>) {
        commands.push(Command::from(BrushCommand::EndStroke));
    }
}

/// Shift held with a brush: a line if released here, the brush's size if dragged.
#[derive(Debug)]
struct Sizing {
    /// The point where the pointer went down, in points.
    from: Pos2,
    /// The radius then, in world units.
    radius: f64,
    /// Whether the pointer moved far enough to be a drag.
    dragged: bool,
}

impl Gesture for Sizing {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.dragged |= self.from.distance(at) > CLICK_SLACK;
        if self.dragged {
            let px = f64::from(at.x - self.from.x) * pointer.px_per_point;
            commands
                .push(Command::from(BrushCommand::Radius(self.radius + px / pointer.camera.px_per_world())));
        }
    }

    fn released(&self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if !self.dragged {
            commands.push(Command::from(BrushCommand::LineTo(pointer.world(at))));
        }
    }

    fn ring_center(&self) -> Option<Pos2> {
        self.dragged.then_some(self.from)
    }
}
