//! What a step does, in a strip above the canvas while the panel of the step is hidden, as in a presentation.

use eframe::egui::{FontId, RichText, Ui, WidgetText};

use super::Steps;
use super::panel::sentence;
use meshbrush_kit::kit::FrameState;
use meshbrush_ui::theme::{metrics, tokens};

/// Size of its letters, in points.
const LETTERS: f32 = 16.0;
/// Rows that always have room: the canvas keeps its size from step to step.
const ROWS: f32 = 2.0;
/// Margin above and below the text, in points.
const MARGIN: f32 = 6.0;

/// Returns whether the strip is shown: where steps are, and no panel says it.
pub fn is_shown(state: &FrameState<'_>) -> bool {
    !(state.view.surrounds && state.view.panels)
}

/// Returns the height of the strip in the room that is left of the window, in points.
pub fn height(ui: &Ui, steps: &Steps) -> f32 {
    let row = ui.fonts_mut(|fonts| fonts.row_height(&FontId::proportional(LETTERS)));
    let text = ui.painter().layout(
        words(steps),
        FontId::proportional(LETTERS),
        tokens(ui).value,
        ui.available_width() - 2.0 * metrics::PANEL_MARGIN,
    );
    text.size().y.max(ROWS * row) + 2.0 * MARGIN
}

/// Draws what the step does.
pub fn show(ui: &mut Ui, steps: &Steps) {
    let text = RichText::new(words(steps)).font(FontId::proportional(LETTERS)).color(tokens(ui).value);
    ui.centered_and_justified(|ui| ui.label(WidgetText::from(text)));
}

fn words(steps: &Steps) -> String {
    steps.player().map_or_else(|| "The steps are being recorded…".into(), sentence)
}
