//! The commands that have a title: what menus, keys and the palette offer. Their keys are final: menus, tips,
//! palette, help and the window itself read them here.

mod edit;
mod file;
mod gestures;
mod help;
mod places;
mod synonyms;
mod tool;
mod view;

use super::features::ROWS;
pub use gestures::gestures;
use meshbrush_kit::kit::{CatalogItem, FrameState};
pub use places::PLACES;
#[cfg(test)]
pub use synonyms::starts as synonym_starts;
pub use synonyms::words_of;

/// Returns every command with a title, in menu order, with its present state.
pub fn catalog(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let of_window = [
        file::file(state),
        edit::edit(state),
        tool::tool(state),
        view::view(state),
        help::examples(),
        help::help(),
    ];
    let of_features = ROWS.iter().flat_map(|row| (row.entries)(state));
    let mut items: Vec<CatalogItem> = of_window.into_iter().flatten().chain(of_features).collect();
    items.iter_mut().for_each(|item| state.keymap.apply(item));
    items.sort_by_key(|item| (item.menu, !item.is_above));
    items
}
