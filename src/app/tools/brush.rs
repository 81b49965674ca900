//! The brush, and the gestures of painting that the eraser shares.

use eframe::egui::{Key, Pos2};

use super::{Gesture, PaintKind, Pointer, Press, ToolSpec, Tools};
use crate::app::command::Command;
use crate::app::panels;
use crate::app::widgets::Hint::{self, Key as HintKey, Text};
use crate::app::widgets::Icon;
use crate::paint::{Brush, Medium};

/// Paints risk or target diameters.
pub static BRUSH: ToolSpec = ToolSpec {
    panels: &[&panels::BRUSH],
    hint: |tools| if tools.kind == PaintKind::Risk { PAINT_RISK } else { PAINT_DIAMETER },
    has_ring: |_| true,
    brush: Some(brush),
    press: press_to_paint,
    ..ToolSpec::new("Brush", Key::B, Icon::BRUSH)
};

/// Points that the pointer must move, with Shift held, before a click becomes a drag of the brush's size.
const CLICK_SLACK: f32 = 4.0;

const PAINT_RISK: &[Hint] = &[
    Text("Drag to paint risk: the mesh follows"),
    HintKey("["),
    HintKey("]"),
    Text("size"),
    HintKey("E"),
    Text("erase"),
    HintKey("Q"),
    Text("query"),
    Text("wheel zooms"),
    HintKey("Space"),
    Text("pans"),
];
const PAINT_DIAMETER: &[Hint] = &[
    Text("Drag to paint a target diameter"),
    HintKey("["),
    HintKey("]"),
    Text("size"),
    HintKey("Alt"),
    Text("click picks a diameter"),
    HintKey("Shift"),
    Text("click draws a line"),
];

fn brush(tools: &Tools) -> Brush {
    // A painted diameter is a length, not a share: a lower strength would make it another length.
    let (medium, strength) = match tools.kind {
        PaintKind::Risk => (Medium::Risk, tools.paint_strength),
        PaintKind::Diameter => (Medium::Diameter(tools.diameter), 1.0),
    };
    Brush { medium, radius: tools.radius, hardness: tools.hardness, strength }
}

/// Alt or Ctrl picks the value under the pointer; Shift draws a line or, dragged, sizes the brush; else a
/// stroke begins.
pub fn press_to_paint(
    press: &Press,
    pointer: &Pointer<'_>,
    commands: &mut Vec<Command>,
) -> Option<Box<dyn Gesture>> {
    let point = pointer.world(press.at);
    if press.modifiers.alt || press.modifiers.command {
        commands.push(Command::PickValue(point));
        return None;
    }
    if press.modifiers.shift {
        return Some(Box::new(Sizing { from: press.at, radius: pointer.tools.radius, dragged: false }));
    }
    commands.push(Command::BeginStroke(point));
    Some(Box::new(Painting))
}

/// A stroke.
#[derive(Debug)]
struct Painting;

impl Gesture for Painting {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        commands.push(Command::DrawTo(pointer.world(at)));
    }

    fn released(&self, _at: Pos2, _pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        commands.push(Command::EndStroke);
    }

    fn interrupted(&self, commands: &mut Vec<Command>) {
        commands.push(Command::EndStroke);
    }
}

/// Shift held with a brush: a line if released here, the brush's size if dragged.
#[derive(Debug)]
struct Sizing {
    /// Where the pointer went down, in points.
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
            commands.push(Command::BrushRadius(self.radius + px / pointer.camera.px_per_world()));
        }
    }

    fn released(&self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if !self.dragged {
            commands.push(Command::LineTo(pointer.world(at)));
        }
    }

    fn ring_center(&self) -> Option<Pos2> {
        self.dragged.then_some(self.from)
    }
}
