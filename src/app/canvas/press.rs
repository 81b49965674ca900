//! What a press on the canvas begins.

use eframe::egui::{Context, Key, PointerButton, Rect, TouchPhase};

use super::menu;
use super::space::{only_in_plan, space_sight};
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::platform::IS_PAGE;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::tools::{Tools, move_view};
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{Gesture, Pointer, Press};

/// Returns the pressure of a pen, 0 to 1, or `None` when it is lifted. In a page fingers have a force, too,
/// and the page itself tells of pens.
pub fn pen_pressure(phase: TouchPhase, force: Option<f32>) -> Option<Option<f64>> {
    match phase {
        _ if IS_PAGE => None,
        TouchPhase::Start | TouchPhase::Move => force.map(|force| Some(force.into())),
        TouchPhase::End | TouchPhase::Cancel => Some(None),
    }
}

/// Returns the canvas in a rectangle, in points, as gestures see it; `None` before it was drawn.
pub fn pointer_over<'a>(
    ctx: &Context,
    rect: Rect,
    view: &View,
    tools: &'a Tools,
    session: &'a Session,
) -> Option<Pointer<'a>> {
    let (camera, space) = (view.camera?, space_sight(view, session));
    let (modifiers, px_per_point) = (ctx.input(|input| input.modifiers), f64::from(ctx.pixels_per_point()));
    Some(Pointer { rect, camera, space, tools, session, modifiers, px_per_point })
}

/// Begins the gesture of a press: panning by Space or the middle button, else the tool's.
pub fn begin_gesture(
    ctx: &Context,
    press: Press,
    button: PointerButton,
    pointer: &Pointer<'_>,
    commands: &mut Vec<Command>,
) -> Option<Box<dyn Gesture>> {
    match button {
        PointerButton::Middle => Some(move_view(&press, button, pointer, commands)),
        PointerButton::Primary if space_is_down(ctx) => Some(move_view(&press, button, pointer, commands)),
        PointerButton::Primary if pointer.space.is_some() && !pointer.tools.tool.in_space => {
            commands.push(Command::from(ShellCommand::Tell(only_in_plan(pointer.tools.tool))));
            None
        }
        PointerButton::Primary => (pointer.tools.tool.press)(&press, pointer, commands),
        PointerButton::Secondary => {
            if !(pointer.tools.tool.press_secondary)(pointer.tools, commands) {
                menu::open(ctx, press.at, pointer.world(press.at));
            }
            None
        }
        _ => None,
    }
}

fn space_is_down(ctx: &Context) -> bool {
    ctx.input(|input| input.key_down(Key::Space)) && !ctx.egui_wants_keyboard_input()
}
