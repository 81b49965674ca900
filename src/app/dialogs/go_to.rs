//! The question for a place on the canvas.

use eframe::egui::{Align, Context, Id, Key, Layout, RichText, Ui};
use glam::{DVec2, dvec2};

use crate::app::features::inspection::InspectCommand;
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_mesh::mesh::TriangleId;
use meshbrush_mesh::text::{LengthUnit, typed};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, ButtonKind, TextError, TextRow, dialog, dialog_title, format};

/// The target that was typed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GoToTarget {
    Point(DVec2),
    Triangle(usize),
}

impl GoToTarget {
    /// Two numbers are a point, and one whole number is that of a triangle. Commas that group thousands
    /// belong to their number.
    fn parse(text: &str, unit: LengthUnit) -> Option<Self> {
        let text = text.trim();
        let number = |text: &str| typed::number(text, unit.symbol()).ok();
        let digits = text.strip_prefix('#').unwrap_or(text);
        if is_grouped(digits) {
            return digits.replace(',', "").parse().ok().map(Self::Triangle);
        }
        let parts = |separator: fn(char) -> bool| -> Vec<&str> {
            text.split(separator).map(str::trim).filter(|part| !part.is_empty()).collect()
        };
        let separators: [fn(char) -> bool; 3] = [|c| c == ';', |c| c == ',', char::is_whitespace];
        let split = separators.into_iter().find_map(|separator| match parts(separator)[..] {
            [x, y] => Some((number(x)?, number(y)?)),
            _ => None,
        });
        split.map(|(x, y)| Self::Point(dvec2(x, y)))
    }

    /// Returns the command that goes to the target, or a sentence that says why it is impossible.
    fn command(self, state: &FrameState<'_>) -> Result<Command, String> {
        match self {
            Self::Point(point) => {
                let bounds = state.session.follower().settings().domain.bounds;
                if bounds.contains(point) {
                    return Ok(Command::from(InspectCommand::GoTo(point)));
                }
                let unit = state.unit();
                let range =
                    |from, to| format!("{} to {}", format::length(from, unit), format::length(to, unit));
                let (x, y) = (range(bounds.min.x, bounds.max.x), range(bounds.min.y, bounds.max.y));
                Err(format!("The domain does not reach there: x is {x}, and y is {y}."))
            }
            Self::Triangle(_) if !state.session.has_file_numbers() => {
                Err("Triangles have no numbers yet: the mesh is being derived.".into())
            }
            Self::Triangle(number) => {
                let count = state.session.triangle_count();
                if number < count {
                    return Ok(Command::from(InspectCommand::GoToTriangle(TriangleId::from_index(number))));
                }
                let last = format::count(count.saturating_sub(1) as u64);
                Err(format!("There is no such triangle: they have the numbers 0 to {last}."))
            }
        }
    }

    /// Returns the target in words, as it was understood.
    fn name(self, unit: LengthUnit) -> String {
        match self {
            Self::Point(point) => {
                let [x, y] = [point.x, point.y].map(|value| unit.after(&format::digits(value, 12)));
                format!("Point {x}, {y}")
            }
            Self::Triangle(number) => format!("Triangle {}", format::count(number as u64)),
        }
    }
}

/// Returns whether a text is one whole number, with or without commas at every third digit.
fn is_grouped(text: &str) -> bool {
    let groups: Vec<&str> = text.split(',').collect();
    let digits = |group: &&str| !group.is_empty() && group.bytes().all(|byte| byte.is_ascii_digit());
    let grouped =
        groups.len() == 1 || groups[0].len() <= 3 && groups[1..].iter().all(|group| group.len() == 3);
    groups.iter().all(digits) && grouped
}

/// Returns the text typed so far, in egui's memory.
fn typed_text() -> Id {
    Id::unique("place typed so far")
}

/// Types a text in before the question is opened.
pub fn fill_in_place(ctx: &Context, text: String) {
    ctx.data_mut(|data| data.insert_temp(typed_text(), text));
}

/// Asks for a point or the number of a triangle.
pub fn ask(ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let id = typed_text();
    let mut text = ctx.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let shown = dialog(ctx, "go to", |ui| {
        ui.set_width(400.0);
        dialog_title(ui, "Go to");
        ui.add_space(8.0);
        let place = GoToTarget::parse(&text, state.unit());
        let command = place.map(|place| place.command(state));
        let problem = command.as_ref().and_then(|command| command.as_ref().err()).cloned();
        let error = problem.as_deref().map(|message| TextError { message, at: None });
        let hint = "x, y or the number of a triangle";
        let takes_focus = text.is_empty() || ui.memory(|memory| memory.focused().is_none());
        let field =
            TextRow::formula("Place", &mut text).hint(hint).error(error).take_focus(takes_focus).show(ui);
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let ready = command.and_then(Result::ok);
        let understood = ready.as_ref().and(place).map(|place| place.name(state.unit()));
        let understood = understood.unwrap_or_else(|| "Such as 23.5, 38 or 12 or 1,204".into());
        ui.label(RichText::new(understood).font(font::caption()).color(tokens(ui).faint));
        ui.add_space(8.0);
        if entered && ready.is_none() {
            field.request_focus();
        }
        let answer = buttons(ui, ready.is_some());
        (ready, if entered { Some(true) } else { answer })
    });
    let dismissed = shown.should_close();
    let (ready, answer) = shown.inner;
    let closed = if dismissed { Some(false) } else { answer };
    match (closed, ready) {
        (Some(true), Some(command)) => commands.extend([Command::from(ShellCommand::CloseDialog), command]),
        (Some(false), _) => commands.push(Command::from(ShellCommand::CloseDialog)),
        _ => {
            ctx.data_mut(|data| data.insert_temp(id, text));
            return;
        }
    }
    ctx.data_mut(|data| data.remove::<String>(id));
}

/// Returns whether to go or to cancel, once a button was clicked.
fn buttons(ui: &mut Ui, is_ready: bool) -> Option<bool> {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let go = ActionButton::new("Go").kind(ButtonKind::Main);
        if ui.add_enabled_ui(is_ready, |ui| ui.add(go)).inner.clicked() {
            return Some(true);
        }
        ui.add(ActionButton::new("Cancel")).clicked().then_some(false)
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_numbers_of_triangles_are_told_apart() {
        let parse = |text| GoToTarget::parse(text, LengthUnit::Metre);
        for (text, x, y) in
            [("0.5, 0.25", 0.5, 0.25), ("-3 7", -3.0, 7.0), ("1 km; 20 m", 1000.0, 20.0), ("1,5", 1.0, 5.0)]
        {
            assert_eq!(parse(text), Some(GoToTarget::Point(dvec2(x, y))), "{text}");
        }
        for (text, number) in [("17", 17), ("#17", 17), ("37,987", 37_987), ("1,204,000", 1_204_000)] {
            assert_eq!(parse(text), Some(GoToTarget::Triangle(number)), "{text}");
        }
        for text in ["", "x", "1.5", "-1", "1, 2, 3", "#a"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
