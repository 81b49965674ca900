//! How exported pictures look: in a dialog of its own, and in the question for a file.

use eframe::egui::{Align, Context, Layout, Ui};

use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::picture_choices::{GroundChoice, PictureChoices, PictureColors, WidthIn};
use meshbrush_kit::kit::view::{FieldOverlay, View};
use meshbrush_kit::kit::{FrameState, remark};
use meshbrush_render::render::picture_size::{LARGEST_PICTURE, PictureSize};
use meshbrush_ui::widgets::{
    ActionButton, ButtonKind, NumberRow, dialog, dialog_title, segmented, toggle_row,
};

/// Width of the dialog, in points.
const WIDTH: f32 = 320.0;
/// The longest name of a number.
const LONGEST: &str = "Dots per inch";

/// Shows the dialog.
pub fn ask(ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let shown = dialog(ctx, "pictures", |ui| {
        ui.set_width(WIDTH);
        dialog_title(ui, "Exported pictures");
        ui.add_space(8.0);
        rows(ui, state.view, commands);
        ui.add_space(12.0);
        let button = ActionButton::new("Done").kind(ButtonKind::Main);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.add(button)).inner.clicked()
    });
    if shown.inner || shown.should_close() {
        commands.push(Command::from(ShellCommand::CloseDialog));
    }
}

/// Shows size, colours, ground and furniture.
pub fn rows(ui: &mut Ui, view: &View, commands: &mut Vec<Command>) {
    let mut choices = view.picture;
    segmented(
        ui,
        "Width in",
        &mut choices.width_in,
        &[(WidthIn::Pixels, "Pixels"), (WidthIn::Paper, "Millimetres")],
    );
    size_rows(ui, &mut choices);
    segmented(
        ui,
        "Colours of pictures",
        &mut choices.colors,
        &[(PictureColors::AsShown, "As shown"), (PictureColors::Levels, "Levels")],
    );
    if let Some(text) = colors_in_words(view) {
        remark(ui, &text);
    }
    segmented(
        ui,
        "Ground of pictures",
        &mut choices.ground,
        &[
            (GroundChoice::AsShown, "As shown"),
            (GroundChoice::White, "White"),
            (GroundChoice::Transparent, "Transparent"),
        ],
    );
    let furniture = &mut choices.furniture;
    toggle_row(ui, "Legend", &mut furniture.legend);
    toggle_row(ui, "Axes", &mut furniture.axes);
    toggle_row(ui, "Scale", &mut furniture.scale);
    toggle_row(ui, "North arrow", &mut furniture.north);
    if choices != view.picture {
        commands.push(Command::from(ViewCommand::Picture(choices)));
    }
}

/// Says what colours are shown, where that is not what a person may expect.
fn colors_in_words(view: &View) -> Option<String> {
    let overlay = view.overlay.name();
    if view.overlay == FieldOverlay::None || view.picture.colors == PictureColors::Levels {
        return None;
    }
    Some(match view.space.is_on {
        true => format!("A view in space shows levels, also where the plan shows “{overlay}”."),
        false => format!("Shows “{overlay}” with its own legend."),
    })
}

fn size_rows(ui: &mut Ui, choices: &mut PictureChoices) {
    if choices.width_in == WidthIn::Pixels {
        let mut width = f64::from(choices.width_px);
        let row = NumberRow::new("Pixels wide", &mut width).aligned_with(LONGEST).integer();
        row.range(1.0..=f64::from(LARGEST_PICTURE)).default(f64::from(PictureSize::WIDTH)).show(ui);
        choices.width_px = width as u32;
        return;
    }
    let (largest, standard) = (choices.largest_mm(), PictureChoices::default());
    let row = NumberRow::new("Width on paper", &mut choices.width_mm).aligned_with(LONGEST).unit("mm");
    row.range(1.0..=largest).default(standard.width_mm).show(ui);
    let row = NumberRow::new(LONGEST, &mut choices.dots_per_inch);
    let [fewest, most] = PictureSize::DOTS;
    row.range(fewest..=most).default(standard.dots_per_inch).show(ui);
}
