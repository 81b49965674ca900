//! The pressure of a pen.

use wasm_bindgen::prelude::*;

use meshbrush_kit::kit::command::{BrushCommand, Command};

#[wasm_bindgen(module = "/web/pen.js")]
extern "C" {
    fn pen() -> Option<f64>;
}

/// Returns the command that notes the pressure of a pen, if it has changed since the last frame.
pub fn take_pen() -> Option<Command> {
    let pressure = pen()?;
    Some(Command::from(BrushCommand::Pen((pressure >= 0.0).then_some(pressure))))
}
