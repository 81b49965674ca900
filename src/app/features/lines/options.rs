//! The settings of the line tool, on the strip above the canvas.

use eframe::egui::Ui;

use super::{LineToolMode, LinesCommand};
use crate::app::features::lines::LineTool;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem};
use meshbrush_ui::widgets::{dropdown_row, toggle_row};

/// What a press does, and whether corners snap.
pub static LINE_OPTIONS: [StripItem; 2] = [
    StripItem::new(232.0, 0, mode_row),
    StripItem::new(80.0, 1, snap_row).only(|state| {
        let mode = state.tools.settings::<LineTool>().mode;
        !matches!(mode, LineToolMode::Rectangle | LineToolMode::Circle)
    }),
];

fn mode_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut mode = state.tools.settings::<LineTool>().mode;
    let choices = [
        (LineToolMode::Corners, "Corners"),
        (LineToolMode::FreeHand, "Free hand"),
        (LineToolMode::Rectangle, "Rectangle"),
        (LineToolMode::Circle, "Circle"),
        (LineToolMode::DeepestWay, "Deepest way"),
        (LineToolMode::Edit, "Move corners"),
    ];
    if dropdown_row(ui, "Draw by", &mut mode, &choices).changed() {
        commands.push(Command::from(LinesCommand::Mode(mode)));
    }
}

fn snap_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut snaps = state.tools.settings::<LineTool>().snaps;
    if toggle_row(ui, "Snap", &mut snaps).changed() {
        commands.push(Command::from(LinesCommand::Snaps(snaps)));
    }
}
