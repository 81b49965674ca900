//! The question for a place on the canvas.

use eframe::egui::{Align, Context, Id, Key, Layout, RichText, Ui};
use glam::{DVec2, dvec2};

use crate::app::features::inspection::InspectCommand;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_core::earth::{DegreeStyle, EarthPlane, GeographicAxis, geographic_from_text};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::coordinates::PlaceText;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::TriangleId;
use meshbrush_mesh::text::{LengthUnit, typed};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, ButtonKind, TextError, TextRow, dialog, dialog_title, format};

/// The target that was typed.
#[derive(Clone, Debug, PartialEq)]
enum GoToTarget {
    Point(DVec2),
    /// Longitude and latitude, in degrees.
    OnEarth(DVec2),
    Triangle(usize),
    /// Something with a name: a pin or a piece of the boundary.
    Named(String, Rect),
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
        let point = split.map(|(x, y)| Self::Point(dvec2(x, y)));
        point.or_else(|| geographic_from_text(text).map(Self::OnEarth))
    }

    /// Returns the pin or the piece of the boundary of a name: whole, or else the only one that begins so.
    fn named(text: &str, state: &FrameState<'_>) -> Option<Self> {
        let wanted = text.trim().to_lowercase();
        let pins = state.session.document().settings().pins.iter().enumerate();
        let pins = pins.map(|(number, &at)| (format!("Pin {}", number + 1), Rect::new(at, at)));
        let pieces = state.session.boundary_pieces().into_iter().flat_map(BoundaryPieces::list);
        let pieces = pieces
            .filter_map(|piece| Some((piece.name.clone(), Rect::holding(piece.points.iter().copied())?)));
        let mut starting: Vec<_> =
            pins.chain(pieces).filter(|(name, _)| name.to_lowercase().starts_with(&wanted)).collect();
        let whole = starting.iter().position(|(name, _)| name.to_lowercase() == wanted);
        let found = match (whole, starting.len()) {
            (Some(place), _) => starting.swap_remove(place),
            (None, 1) if !wanted.is_empty() => starting.remove(0),
            _ => return None,
        };
        Some(Self::Named(found.0, found.1))
    }

    /// Returns the command that goes to the target, or a sentence that says why it is impossible.
    fn command(&self, state: &FrameState<'_>) -> Result<Command, String> {
        match *self {
            Self::Point(point) => command_to(point, state),
            Self::OnEarth(at) => {
                let settings = state.session.document().settings();
                let Some(plane) = EarthPlane::new(settings.domain.projection, settings.unit) else {
                    return Err("This document does not lie on the Earth: give x and y.".into());
                };
                command_to(plane.point_of(at, settings.domain.bounds), state)
            }
            Self::Named(_, area) if area.size() == DVec2::ZERO => command_to(area.min, state),
            Self::Named(_, area) => {
                let rim = ROOM_AROUND * area.size().max_element();
                Ok(Command::from(ViewCommand::ShowArea(area.expanded(rim))))
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
    fn name(&self, unit: LengthUnit) -> String {
        match self {
            Self::Point(point) => {
                let [x, y] = [point.x, point.y].map(|value| unit.after(&format::digits(value, 12)));
                format!("Point {x}, {y}")
            }
            Self::OnEarth(at) => {
                let step = |degrees: f64| {
                    let is_shown = |step: &f64| ((degrees / step).round() * step - degrees).abs() < 1e-7;
                    [1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5].into_iter().find(is_shown).unwrap_or(1e-6)
                };
                let text = |axis, degrees| DegreeStyle::Decimal.text(axis, degrees, step(degrees));
                let longitude = text(GeographicAxis::Longitude, at.x);
                format!("{longitude}, {}", text(GeographicAxis::Latitude, at.y))
            }
            Self::Triangle(number) => format!("Triangle {}", format::count(*number as u64)),
            Self::Named(name, _) => name.clone(),
        }
    }
}

/// Room around an area that is gone to, as a share of its longer side.
const ROOM_AROUND: f64 = 0.1;

/// Returns the command that goes to a point in world units, or a sentence that says why it is impossible.
fn command_to(point: DVec2, state: &FrameState<'_>) -> Result<Command, String> {
    let bounds = state.session.follower().settings().domain.bounds;
    if bounds.contains(point) {
        return Ok(Command::from(InspectCommand::GoTo(point)));
    }
    let (PlaceText { names, values: from }, to) = match state.geographic_plane() {
        Some(_) => (state.place_text(bounds.min), state.place_text(bounds.max).values),
        None => {
            let text = |corner: DVec2| corner.to_array().map(|value| format::length(value, state.unit()));
            (PlaceText { names: state.place_names(), values: text(bounds.min) }, text(bounds.max))
        }
    };
    let range = |axis: usize| format!("{} is {} to {}", names[axis], from[axis], to[axis]);
    Err(format!("The domain does not reach there: {}, and {}.", range(0), range(1)))
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

/// Asks for a point, the number of a triangle, or a name.
pub fn ask(ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let id = typed_text();
    let mut text = ctx.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let shown = dialog(ctx, "go to", |ui| {
        ui.set_width(400.0);
        dialog_title(ui, "Go to");
        ui.add_space(8.0);
        let place = GoToTarget::parse(&text, state.unit()).or_else(|| GoToTarget::named(&text, state));
        let command = place.as_ref().map(|place| place.command(state));
        let problem = command.as_ref().and_then(|command| command.as_ref().err()).cloned();
        let error = problem.as_deref().map(|message| TextError { message, at: None });
        let hint = "a point, a triangle, a pin or a piece of the boundary";
        let takes_focus = text.is_empty() || ui.memory(|memory| memory.focused().is_none());
        let field =
            TextRow::formula("Place", &mut text).hint(hint).error(error).take_focus(takes_focus).show(ui);
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let ready = command.and_then(Result::ok);
        let understood = ready.as_ref().and(place.as_ref()).map(|place| place.name(state.unit()));
        let understood =
            understood.unwrap_or_else(|| "Such as 23.5, 38 or 50° 12′ N 5.5° W or 1,204 or Pin 2".into());
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
        for (text, longitude, latitude) in [("5.5 W 50.2 N", -5.5, 50.2), ("50° 12′ N, 5° 30′ W", -5.5, 50.2)]
        {
            assert_eq!(parse(text), Some(GoToTarget::OnEarth(dvec2(longitude, latitude))), "{text}");
        }
        for text in ["", "x", "1.5", "-1", "1, 2, 3", "#a"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
