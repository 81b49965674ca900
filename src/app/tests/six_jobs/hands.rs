//! A hand with the pointer: it reaches controls as a person does, and counts its clicks.

use eframe::egui::accesskit::Role;
use eframe::egui::{Rect, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::app::tests::pictures::{drawn_window_of, write_for_a_look};
use crate::app::tests::{
    Window, canvas, choose, open_section, open_tab, section, type_into, wait_for_jobs, window,
};
use meshbrush_kit::kit::Tab;

/// Does a job in a window.
pub struct Hands {
    pub window: Window,
    clicks: usize,
}

impl Hands {
    pub fn new() -> Self {
        let is_drawn = std::env::var_os("MESHBRUSH_SCREENS").is_some();
        let drawn = || drawn_window_of(vec2(1440.0, 900.0), |_, _| {});
        Self { window: if is_drawn { drawn() } else { window() }, clicks: 0 }
    }

    /// A click or a drag on the canvas.
    pub fn act(&mut self, act: impl FnOnce(&mut Window)) {
        self.clicks += 1;
        act(&mut self.window);
    }

    /// Opens a menu of the bar and chooses an entry.
    pub fn menu(&mut self, menu: &str, entry: &str) {
        self.clicks += 2;
        choose(&mut self.window, menu, entry);
    }

    /// Selects a tool on the tool strip.
    pub fn tool(&mut self, name: &str) {
        let buttons = self.window.get_all_by_role_and_label(Role::Button, name);
        buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap().click();
        self.window.run();
        self.clicks += 1;
    }

    /// Shows a tab of the lower dock.
    pub fn tab(&mut self, tab: Tab) {
        open_tab(&mut self.window, tab);
        self.clicks += 1;
    }

    /// Opens a section that is closed.
    pub fn open(&mut self, title: &str) {
        let header = section(&self.window, title).unwrap_or_else(|| panic!("no section {title}"));
        assert_eq!(header.accesskit_node().data().is_expanded(), Some(false), "{title} is open");
        self.look(header.rect(), title);
        open_section(&mut self.window, title);
        self.clicks += 1;
    }

    /// Clicks on a control.
    pub fn press(&mut self, role: Role, label: &str) {
        self.read(role, label);
        self.window.get_by_role_and_label(role, label).click();
        self.window.run();
        self.clicks += 1;
    }

    /// Clicks on a field and types.
    pub fn enter(&mut self, name: &str, text: &str) {
        self.read(Role::TextInput, name);
        type_into(&mut self.window, name, text);
        self.clicks += 1;
    }

    /// Chooses from a drop-down list.
    pub fn choose(&mut self, list: &str, choice: &str) {
        self.press(Role::ComboBox, list);
        self.press_in_list(choice);
    }

    /// Chooses from a list that is open.
    pub fn press_in_list(&mut self, label: &str) {
        self.window.get_by_role_and_label(Role::Button, label).click();
        self.window.run();
        self.clicks += 1;
    }

    /// Adds a layer by the button below the list of layers.
    pub fn add_layer(&mut self, title: &str) {
        self.press(Role::Button, "Add layer");
        self.press_in_list(title);
    }

    /// Shows an overlay. The list closes with the choice.
    pub fn overlay(&mut self, name: &str) {
        self.press(Role::Button, "Overlays");
        self.window.get_by_role_and_label(Role::RadioButton, name).click();
        self.window.run();
        self.clicks += 1;
        assert!(
            self.window.query_by_role_and_label(Role::RadioButton, "No overlay").is_none(),
            "the list is closed"
        );
    }

    /// Looks at a control or a value, which must be in sight.
    pub fn read(&self, role: Role, label: &str) {
        let nodes: Vec<_> = self.window.query_all_by_role_and_label(role, label).collect();
        let [node] = &nodes[..] else { panic!("{} times {label}", nodes.len()) };
        self.look(node.rect(), label);
    }

    /// Checks that a place is in sight: on a bar, on the strip, or in a dock without scrolling.
    fn look(&self, place: Rect, what: &str) {
        let canvas = canvas(&self.window);
        let screen = self.window.ctx.content_rect();
        let bottom = canvas.bottom();
        let strip = Rect::from_x_y_ranges(canvas.x_range(), 36.0..=canvas.top());
        let bar = Rect::from_x_y_ranges(screen.x_range(), bottom..=screen.bottom());
        let docks = canvas.right()..=screen.right();
        let areas = match self.window.query_by_role_and_label(Role::Tab, Tab::Size.name()) {
            Some(tab) => vec![
                strip,
                Rect::from_x_y_ranges(docks.clone(), 36.0..=tab.rect().top()),
                Rect::from_x_y_ranges(docks, tab.rect().bottom()..=bottom),
            ],
            // The steps are in place of the docks.
            None => vec![strip, bar, Rect::from_x_y_ranges(docks, 36.0..=bottom)],
        };
        assert!(areas.iter().any(|area| area.contains_rect(place)), "{what} must be scrolled to: {place:?}");
    }

    /// Checks how many clicks the job took. `MESHBRUSH_SCREENS` gets a picture of the window after it.
    pub fn took(mut self, clicks: usize) {
        let job = std::thread::current().name().and_then(|name| name.rsplit("::").next().map(str::to_owned));
        wait_for_jobs(&mut self.window);
        write_for_a_look(&mut self.window, &job.unwrap_or_default());
        assert_eq!(self.clicks, clicks, "clicks");
    }
}
