//! A field for a name.

use egui::{Id, Ui};

use meshbrush_ui::widgets::TextRow;

/// The text typed so far, in egui's memory.
#[derive(Clone, Debug, Default)]
struct TypedName {
    text: String,
    /// The name when the text was last equal to it.
    of: String,
}

/// Shows a field for the name of something, such as a piece of the boundary. Returns the new name once it is
/// complete.
pub fn name_field(ui: &mut Ui, of: &str, current: &str) -> Option<String> {
    let id = Id::unique(("name typed so far", of));
    let mut typed: TypedName = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if typed.of != current {
        // Another one is selected, or the name was changed elsewhere.
        typed = TypedName { text: current.to_owned(), of: current.to_owned() };
    }
    let help = format!("Name of the {of}, in lists and files.");
    let response = TextRow::new("Name", &mut typed.text).help(&help).show(ui);
    let changed = typed.text != current;
    let new = (response.lost_focus() && changed).then(|| typed.text.clone());
    ui.data_mut(|data| data.insert_temp(id, typed));
    new
}
