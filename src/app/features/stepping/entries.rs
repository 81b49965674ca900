//! Entries of the menu Method about stepping through the refinement.

use eframe::egui::{Key, Modifiers};

use super::StepCommand;
use super::files::EXPORT_STEPS;
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// The situation of keys that work while steps are shown.
const STEPPING: &str = "while steps are shown";

/// How to begin; and once begun, how to move.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Method, title, Command::from(command));
    let title = "Step through the refinement";
    let Some(steps) = state.feature::<Stepping>().steps() else {
        return vec![item(title, StepCommand::Begin(None)).key(Key::F10).group()];
    };
    let (position, count) = steps.player().map_or((0, 0), |player| (player.position(), player.len()));
    let play = if steps.is_playing() { "Pause the steps" } else { "Play the steps" };
    vec![
        item(title, StepCommand::Leave).key(Key::F10).checked(true).group(),
        item("Next step", StepCommand::Move(1))
            .key(Key::ArrowRight)
            .only(STEPPING, true)
            .enabled(position < count),
        item("Previous step", StepCommand::Move(-1))
            .key(Key::ArrowLeft)
            .only(STEPPING, true)
            .enabled(position > 0),
        item("Last step", StepCommand::GoTo(count))
            .keys(Modifiers::SHIFT, Key::ArrowRight)
            .only(STEPPING, true)
            .enabled(position < count),
        item("First step", StepCommand::GoTo(0))
            .keys(Modifiers::SHIFT, Key::ArrowLeft)
            .only(STEPPING, true)
            .enabled(position > 0),
        item(play, StepCommand::TogglePlay)
            .id("play-the-steps")
            .key(Key::Space)
            .only(STEPPING, true)
            .enabled(count > 0),
        item("Only bisections", StepCommand::OnlyBisections(!steps.only_bisections))
            .checked(steps.only_bisections)
            .palette_only(),
        CatalogItem::new(Menu::Method, "Export steps…", Command::from(FileCommand::Ask(&EXPORT_STEPS)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::E)
            .enabled(count > 0),
    ]
}
