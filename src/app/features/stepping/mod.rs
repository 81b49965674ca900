//! The mode that steps through the refinement of the document's mesh: Algorithms 10 to 12, forwards and
//! backwards, and then how triangles outside are removed and nodes move onto the outline.
//!
//! The document and its mesh stay as they are. The steps are recorded on another thread; the canvas then
//! shows the arrays at one step in place of the mesh. An edit of the document ends the mode.

mod bar;
mod code;
mod command;
mod entries;
mod execute;
mod export;
mod files;
mod letters;
mod panel;
mod panel_export;
mod picture;
mod rows;
pub mod sentence;
mod steps;
#[cfg(test)]
mod tests;

pub use bar::{HEIGHT as BAR_HEIGHT, step_bar};
pub use command::StepCommand;
pub use panel::{details, text_and_code, title, width};
pub use picture::paint;
pub use steps::Steps;

use meshbrush_kit::kit::tools::Tools;

/// What the window keeps of the mode.
#[derive(Default)]
pub struct Stepping {
    /// The steps, while the mode is on.
    steps: Option<Steps>,
}

impl Stepping {
    /// Returns the steps, while the mode is on.
    pub fn steps(&self) -> Option<&Steps> {
        self.steps.as_ref()
    }

    /// Shows the mesh of the document again. Returns whether steps were shown.
    pub fn leave(&mut self, tools: &mut Tools) -> bool {
        tools.only_move_view(false);
        self.steps.take().is_some()
    }
}
