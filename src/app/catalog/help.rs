//! The menus Examples and Help.

use super::{CatalogItem, Menu};
use crate::app::command::Command;
use crate::document::Example;

/// Documents that come with the program.
pub fn examples() -> Vec<CatalogItem> {
    let item =
        |example: Example| CatalogItem::new(Menu::Examples, example.name(), Command::OpenExample(example));
    Example::ALL.map(item).into()
}

/// About the program.
pub fn help() -> Vec<CatalogItem> {
    vec![CatalogItem::new(Menu::Help, "About Meshbrush", Command::About)]
}
