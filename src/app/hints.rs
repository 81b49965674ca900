//! The next useful thing for the tool in hand, until it was done a few times.

use super::tools::{PaintKind, Tool};
use super::widgets::Hint::{self, Key, Text};

/// How often a tool is used before its hint goes away.
const ENOUGH: u32 = 6;

/// Counts what the user has already done.
#[derive(Clone, Debug, Default)]
pub struct Hints {
    painted: u32,
    erased: u32,
    queried: u32,
    framed: u32,
}

const PAINT_RISK: &[Hint] = &[
    Text("Drag to paint risk: the mesh follows"),
    Key("["),
    Key("]"),
    Text("size"),
    Key("E"),
    Text("erase"),
    Key("Q"),
    Text("query"),
    Text("wheel zooms"),
    Key("Space"),
    Text("pans"),
];
const PAINT_DIAMETER: &[Hint] = &[
    Text("Drag to paint a target diameter"),
    Key("["),
    Key("]"),
    Text("size"),
    Key("Alt"),
    Text("click picks a diameter"),
    Key("Shift"),
    Text("click draws a line"),
];
const ERASE: &[Hint] = &[
    Text("Drag to take paint away: the mesh coarsens"),
    Key("B"),
    Text("brush"),
    Key("Ctrl+Z"),
    Text("undo"),
];
const QUERY: &[Hint] =
    &[Text("Click a triangle to read it out"), Key("B"), Text("brush"), Key("Esc"), Text("let go")];
const DOMAIN: &[Hint] = &[
    Text("Cut the domain: brush, rectangle or polygon"),
    Key("X"),
    Text("add or take away"),
    Key("Alt"),
    Text("the other way"),
    Key("Ctrl+Z"),
    Text("undo"),
];
const PAN: &[Hint] =
    &[Text("Drag to move, wheel to zoom"), Key("Home"), Text("fits"), Key("B"), Text("brush")];

impl Hints {
    /// Notes that a tool was used.
    pub fn did(&mut self, tool: Tool) {
        match tool {
            Tool::Brush => self.painted += 1,
            Tool::Eraser => self.erased += 1,
            Tool::Query => self.queried += 1,
            Tool::Domain => self.framed += 1,
            Tool::Pan => {}
        }
    }

    /// The hint for a tool; empty once it is known.
    pub fn for_tool(&self, tool: Tool, kind: PaintKind) -> &'static [Hint<'static>] {
        match (tool, kind) {
            (Tool::Brush, _) if self.painted >= ENOUGH => &[],
            (Tool::Eraser, _) if self.erased >= ENOUGH => &[],
            (Tool::Query, _) if self.queried >= ENOUGH => &[],
            (Tool::Domain, _) if self.framed >= ENOUGH => &[],
            (Tool::Brush, PaintKind::Risk) => PAINT_RISK,
            (Tool::Brush, PaintKind::Diameter) => PAINT_DIAMETER,
            (Tool::Eraser, _) => ERASE,
            (Tool::Query, _) => QUERY,
            (Tool::Domain, _) => DOMAIN,
            (Tool::Pan, _) => PAN,
        }
    }
}
