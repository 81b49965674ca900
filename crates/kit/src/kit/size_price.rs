//! The row below settings of the size: what their last change did, or what another value would do.

use egui::Ui;

use super::FrameState;
use super::size_change::SizeEffect;
use crate::kit::brake::Need;
use crate::kit::command::{Command, EditCommand};
use meshbrush_core::document::{Price, Setting, SettingKind};
use meshbrush_mesh::mesh::Progress;
use meshbrush_ui::widgets::{ValueRow, format};

const HELP: &str = "By how many triangles the last change of these settings made the mesh larger or smaller, and \
                    how long that took. While a value is typed, or the pointer rests on a choice: what that \
                    would do. From 500,000 triangles on it is an estimate. An edit that needs millions asks first.";

/// Shows the row, which is always there, so that nothing moves. `candidate` is a value that is being typed or
/// under the pointer, if there is one.
pub fn size_price_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    kinds: &[SettingKind],
    candidate: Option<Setting>,
    commands: &mut Vec<Command>,
) {
    let considered = state.session.considered();
    let is_ours = considered.is_some_and(|setting| kinds.contains(&setting.kind()));
    if candidate.as_ref() != considered && (candidate.is_some() || is_ours) {
        commands.push(Command::from(EditCommand::Consider(candidate.clone())));
    }
    let (text, stands_out) = match (candidate, state.session.question()) {
        (Some(candidate), _) => (considered_text(state, &candidate), true),
        (None, question) => match (state.session.last_size_effect(kinds), question) {
            (Some(_), Some(need)) => (need_text(need), true),
            (Some(effect), None) => (effect_text(state, effect), false),
            (None, _) => ("–".to_owned(), false),
        },
    };
    ValueRow::new("Change", &text).help(HELP).stands_out(stands_out).show(ui);
}

/// Returns what a setting would do, once that is known.
fn considered_text(state: &FrameState<'_>, candidate: &Setting) -> String {
    let (session, is_known) = (state.session, state.session.considered() == Some(candidate));
    match session.considered_price().filter(|_| is_known) {
        Some(price) => would(price),
        // Whether there is such a frame depends on the machine's speed.
        None if state.reproducible || session.considered_progress() == Progress::Done => "–".to_owned(),
        None => "counting …".to_owned(),
    }
}

/// Returns a price in words.
fn would(price: Price) -> String {
    match price {
        Price::Change(0) | Price::Nothing(_) => "as many as before".to_owned(),
        Price::Change(change) if change < 0 => format!("would free {}", format::count(change.unsigned_abs())),
        Price::Change(change) => format!("would add {}", format::count(change.unsigned_abs())),
        Price::About(change) if change < 0 => {
            format!("would free about {}", format::about(change.unsigned_abs()))
        }
        Price::About(change) => format!("would add about {}", format::about(change.unsigned_abs())),
        Price::MoreThan(_) | Price::Many => {
            format!("would change over {}", format::count(Price::MOST as u64))
        }
        Price::TooFine => "finer than the lattice".to_owned(),
    }
}

fn need_text(need: Need) -> String {
    match need {
        Need::About(triangles) => format!("needs about {}", format::about(triangles)),
        Need::MoreThan(triangles) => format!("needs over {}", format::about(triangles)),
    }
}

/// Returns what the last change did, with the time that it took.
fn effect_text(state: &FrameState<'_>, SizeEffect { change, is_latest }: SizeEffect) -> String {
    let noun = if change.abs() == 1 { "triangle" } else { "triangles" };
    let text = match change {
        0 => "as many as before".to_owned(),
        change => format!("{} {noun}", format::change(change)),
    };
    let is_done = state.session.follower().is_in_step(state.session.document());
    match state.session.last_update().filter(|_| is_latest && is_done && !state.reproducible) {
        Some(time) => format!("{text}, {}", format::time(time.as_secs_f64())),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_says_what_would_come_or_go() {
        let words = [
            (Price::Change(12_340), "would add 12,340"),
            (Price::Change(-3), "would free 3"),
            (Price::Change(0), "as many as before"),
            (Price::About(19_812_345), "would add about 20 million"),
            (Price::About(-712_345), "would free about 710,000"),
            (Price::TooFine, "finer than the lattice"),
        ];
        words.into_iter().for_each(|(price, text)| assert_eq!(would(price), text));
        assert_eq!(need_text(Need::About(31_200_000)), "needs about 31 million");
    }
}
