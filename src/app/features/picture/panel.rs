//! The picture behind the mesh.

use eframe::egui::Ui;
use glam::dvec2;

use super::OPEN_PICTURE;
use meshbrush_core::document::{Background, Setting};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ViewCommand};
use meshbrush_kit::kit::view::CanvasAid;
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, end_gesture_when_released, remark, set_once};
use meshbrush_mesh::geometry::Rect;
use meshbrush_ui::widgets::{ActionButton, NumberRow, Section, SliderRow, toggle_row, value_row};

/// The background picture: opacity and place.
pub static BACKGROUND: Panel = Panel { name: "background", tab: Tab::Domain, place: 3, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Background picture").closed().show(ui, |ui| {
        let settings = state.session.document().settings();
        match &settings.background {
            Some(background) => {
                rows(ui, state, background, commands);
                buttons(ui, settings.domain.bounds, background, commands);
            }
            None => {
                remark(
                    ui,
                    "A map or photograph to trace. A world file beside it (.pgw, .wld) says where it lies.",
                );
                if ui.add(ActionButton::new("Open background…")).clicked() {
                    commands.push(Command::from(FileCommand::Ask(&OPEN_PICTURE)));
                }
            }
        }
    });
}

fn rows(ui: &mut Ui, state: &FrameState<'_>, background: &Background, commands: &mut Vec<Command>) {
    let changed = |background: Background| Setting::Background(Some(background));
    value_row(ui, "Picture", &background.name);
    let mut opacity = background.opacity;
    let help = "How strongly the picture shows through the triangles.";
    let response = SliderRow::new("Opacity", &mut opacity, 0.0..=1.0).step(0.01).help(help).show(ui);
    if response.changed() {
        commands.push(Command::from(EditCommand::Set(changed(Background { opacity, ..background.clone() }))));
    }
    end_gesture_when_released(&response, commands);
    let mut shown = state.view.aids.picture_corners;
    if toggle_row(ui, "Drag corners on the canvas", &mut shown).changed() {
        commands.push(Command::from(ViewCommand::ToggleAid(CanvasAid::PictureCorners)));
    }
    let Rect { min, max } = background.bounds;
    let mut sides = [min.x, min.y, max.x, max.y];
    let mut moved = false;
    let names = ["Picture left", "Picture bottom", "Picture right", "Picture top"];
    for (name, side) in names.into_iter().zip(&mut sides) {
        moved |= NumberRow::new(name, side).unit(state.unit().symbol()).show(ui).changed();
    }
    if moved {
        let [left, bottom, right, top] = sides;
        let bounds = Rect::new(dvec2(left, bottom), dvec2(right, top));
        set_once(changed(Background { bounds, ..background.clone() }), commands);
    }
}

fn buttons(ui: &mut Ui, domain: Rect, background: &Background, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let covering = Setting::Background(Some(Background { bounds: domain, ..background.clone() }));
    let row = [
        ("Cover the domain", background.bounds != domain, covering),
        ("Remove picture", true, Setting::Background(None)),
    ];
    let mut chosen = Vec::new();
    button_rows(ui, [row], &mut chosen);
    chosen.into_iter().for_each(|setting| set_once(setting, commands));
}
