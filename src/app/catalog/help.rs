//! The menus Examples and Help.

use eframe::egui::{Key, Modifiers};

use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::HelpTopic;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{CatalogItem, Menu};

/// Documents that come with the program.
pub fn examples() -> Vec<CatalogItem> {
    let item = |example: Example| {
        CatalogItem::new(Menu::Examples, example.name(), Command::from(FileCommand::OpenExample(example)))
    };
    Example::ALL.map(item).into_iter().collect()
}

/// Returns the manual, keys and gestures, and what the program is.
pub fn help() -> Vec<CatalogItem> {
    let topic = |title: &str, topic| {
        CatalogItem::new(Menu::Help, title, Command::from(ShellCommand::ShowHelp(topic)))
    };
    vec![
        topic("Manual", HelpTopic::MANUAL).key(Key::F1),
        topic("How it works", HelpTopic::HOW_IT_WORKS),
        topic("Glossary", HelpTopic::GLOSSARY),
        topic("Keyboard and mouse", HelpTopic::Keys).keys(Modifiers::SHIFT, Key::F1).group(),
        CatalogItem::new(Menu::Help, "About Meshbrush", Command::from(ShellCommand::About)).group(),
    ]
}
