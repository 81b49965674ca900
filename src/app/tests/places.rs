//! Where things are: tabs, sections and popups.

use eframe::egui::accesskit::Role;
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::Window;
use meshbrush_kit::kit::Tab;

/// Opens a section of the docks, and before that its tab.
pub fn open_section(window: &mut Window, title: &str) {
    bring(window, |window| section(window, title).is_some());
    let header = section(window, title).unwrap_or_else(|| panic!("no section {title}"));
    if header.accesskit_node().data().is_expanded() != Some(true) {
        header.click();
        window.run();
    }
}

/// Returns the title of a section; tabs and menus may have the same name.
pub fn section<'a>(window: &'a Window, title: &'a str) -> Option<Node<'a>> {
    let mut named = window.query_all_by_role_and_label(Role::Button, title);
    named.find(|node| node.accesskit_node().data().is_expanded().is_some())
}

/// Opens a tab of the lower dock.
pub fn open_tab(window: &mut Window, tab: Tab) {
    window.get_by_role_and_label(Role::Tab, tab.name()).click();
    window.run();
}

/// Opens the tab in which something is found, unless it is in sight already.
pub fn bring(window: &mut Window, is_found: impl Fn(&Window) -> bool) {
    for tab in Tab::LOWER {
        if is_found(window) {
            return;
        }
        if window.query_by_role_and_label(Role::Tab, tab.name()).is_some() {
            open_tab(window, tab);
        }
    }
}

/// Opens the tab in which a control is, unless it is in sight already.
pub fn find(window: &mut Window, role: Role, label: &str) {
    bring(window, |window| window.query_all_by_role_and_label(role, label).next().is_some());
}

/// Opens a popup at the end of the strip above the canvas.
pub fn open_popup(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::Button, name).click();
    window.run();
}
