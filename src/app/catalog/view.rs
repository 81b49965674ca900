//! The menu View.

use eframe::egui::{Key, Modifiers, ThemePreference};

use meshbrush_core::earth::{DegreeStyle, EarthPlane};
use meshbrush_kit::kit::command::{Command, InterfaceScale, ShellCommand, SpaceCommand, ViewCommand};
use meshbrush_kit::kit::coordinates::CoordinateStyle;
use meshbrush_kit::kit::view::{CanvasAid, FieldOverlay};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu, Submenu, Tab};
use meshbrush_render::colormap::Colormap;
use meshbrush_ui::widgets::key_menu::MENU_KEYS;

/// Returns the commands that change the view.
pub fn view(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::View;
    let view = state.view;
    let item = |title: &str, command| CatalogItem::new(View, title, Command::from(command));
    let aid = |title: &str, aid| item(title, ViewCommand::ToggleAid(aid));
    let theme = |title: &str, theme| {
        item(title, ViewCommand::Theme(theme)).checked(view.theme == theme).within(Submenu::Theme)
    };
    let mut items = vec![
        item("Fit domain", ViewCommand::Fit).key(Key::Home),
        item("Zoom in", ViewCommand::Zoom(1.5)).key(Key::Plus).key(Key::Equals),
        item("Zoom out", ViewCommand::Zoom(1.0 / 1.5)).key(Key::Minus),
        CatalogItem::new(View, "Go to…", Command::from(ShellCommand::AskPlace)).ctrl(Key::G),
        item("In space", ViewCommand::Space(SpaceCommand::Toggle))
            .keys(Modifiers::SHIFT, Key::V)
            .checked(view.space.is_on),
        item("Edges", ViewCommand::ToggleEdges).key(Key::G).checked(view.edges).group(),
        aid("Coordinates along the canvas", CanvasAid::Coordinates).checked(view.aids.coordinates),
        aid("Graticule", CanvasAid::Graticule).checked(view.aids.graticule),
        aid("Scale bar", CanvasAid::ScaleBar).checked(view.aids.scale_bar),
        aid("Legend of the levels", CanvasAid::Levels).checked(view.aids.levels).palette_only(),
        aid("Contour lines of h̄", CanvasAid::Contours).checked(view.aids.contours),
        aid("Why the queried triangle is there", CanvasAid::Cause).checked(view.aids.cause).palette_only(),
    ];
    items.extend(coordinates(state));
    items.extend(overlays(view.overlay));
    let queried = state.session.queried_triangle().map(|id| state.session.view().triangle(id).level());
    let of_triangle = |title: &str, command: fn(u32) -> ViewCommand| {
        item(title, command(queried.unwrap_or(0))).enabled(queried.is_some())
    };
    items.extend(method(state));
    items.extend(tabs(state));
    items.extend([
        of_triangle("Hide or show the level of the triangle", ViewCommand::ToggleLevel).palette_only(),
        of_triangle("Show only the level of the triangle", ViewCommand::IsolateLevel).palette_only(),
        item("Show all levels", ViewCommand::ShowAllLevels).enabled(view.hidden_levels != 0).group(),
    ]);
    items.extend(Colormap::ALL.map(|map| {
        let item = item(&format!("{} colours", map.name()), ViewCommand::Colormap(map));
        item.checked(view.colormap == map).within(Submenu::Colours)
    }));
    items.extend([
        theme("Dark theme", ThemePreference::Dark).group(),
        theme("Light theme", ThemePreference::Light),
        theme("Theme of the desktop", ThemePreference::System),
    ]);
    items.extend(scales());
    items.extend([
        item("Panels", ViewCommand::TogglePanels).ctrl(Key::B).checked(view.panels).group(),
        item("Presentation", ViewCommand::TogglePresentation)
            .key(Key::F5)
            .checked(view.presentation.is_some()),
        CatalogItem::new(View, "Find a command…", Command::from(ShellCommand::Palette)).ctrl(Key::P),
    ]);
    items.extend(parts());
    items
}

/// Returns the coordinates that places may be written in. Documents that do not lie on the Earth have one.
fn coordinates(state: &FrameState<'_>) -> [CatalogItem; 3] {
    let settings = state.session.document().settings();
    let is_on_earth = EarthPlane::new(settings.domain.projection, settings.unit).is_some();
    CoordinateStyle::ALL.map(|style| {
        let title = match style {
            CoordinateStyle::Geographic(DegreeStyle::Decimal) => "Places in degrees",
            CoordinateStyle::Geographic(DegreeStyle::Minutes) => "Places in degrees and minutes",
            CoordinateStyle::Plane => "Places in the plane",
        };
        let item = CatalogItem::new(Menu::View, title, Command::from(ViewCommand::Coordinates(style)));
        item.enabled(is_on_earth)
            .checked(is_on_earth && style == state.view.coordinates)
            .within(Submenu::Places)
    })
}

/// Returns what changes the size of text and controls.
fn scales() -> [CatalogItem; 3] {
    let item = |title: &str, scale| {
        CatalogItem::new(Menu::View, title, Command::from(ViewCommand::Scale(scale)))
            .within(Submenu::InterfaceSize)
    };
    [
        item("Larger interface", InterfaceScale::Larger).ctrl(Key::Plus).ctrl(Key::Equals),
        item("Smaller interface", InterfaceScale::Smaller).ctrl(Key::Minus),
        item("Interface in its normal size", InterfaceScale::Normal).ctrl(Key::Num0),
    ]
}

/// Returns the keys that reach everything without a pointer. No menu needs them.
fn parts() -> Vec<CatalogItem> {
    let item =
        |title: &str, command| CatalogItem::new(Menu::View, title, Command::from(command)).palette_only();
    // Alt with the first letter, where an earlier menu has not taken it.
    let keys = [Key::F, Key::E, Key::T, Key::L, Key::V, Key::X, Key::M, Key::H];
    let menus = Menu::ALL.into_iter().zip(keys).map(|((menu, name), key)| {
        item(&format!("Open the menu {name}"), ShellCommand::OpenMenu(menu)).keys(Modifiers::ALT, key)
    });
    let mut items = vec![
        item("Next part of the window", ShellCommand::FocusPart(1)).key(Key::F6),
        item("Previous part of the window", ShellCommand::FocusPart(-1)).keys(Modifiers::SHIFT, Key::F6),
        item("Menu of the canvas or of the number", ShellCommand::MenuOfCanvas)
            .keys(MENU_KEYS.modifiers, MENU_KEYS.logical_key),
    ];
    items.extend(menus);
    items
}

/// Returns an entry for each overlay.
fn overlays(shown: FieldOverlay) -> impl Iterator<Item = CatalogItem> {
    FieldOverlay::ALL.iter().map(move |&overlay| {
        // The key of the overlay that is shown hides it.
        let next = if overlay == shown { FieldOverlay::None } else { overlay };
        let command = Command::from(ViewCommand::SetOverlay(next));
        let item = CatalogItem::new(Menu::View, overlay.title(), command)
            .checked(overlay == shown)
            .within(Submenu::Overlay);
        match overlay {
            FieldOverlay::Risk => item.key(Key::O),
            FieldOverlay::Target => item.keys(Modifiers::SHIFT, Key::O),
            _ => item,
        }
    })
}

/// Returns the tabs of the lower dock. They are in sight, so that no menu needs them.
fn tabs(state: &FrameState<'_>) -> impl Iterator<Item = CatalogItem> + use<> {
    let shown = state.view.dock.tab();
    Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method).map(move |tab| {
        let command = Command::from(ViewCommand::ShowTab(tab));
        let item = CatalogItem::new(Menu::View, format!("Show the tab {}", tab.name()), command);
        item.checked(tab == shown).palette_only()
    })
}

/// Returns the walk of point location, which is a part of the method.
fn method(state: &FrameState<'_>) -> [CatalogItem; 2] {
    let item = |title: &str, command| CatalogItem::new(Menu::Method, title, Command::from(command));
    let walk = item("Walk of point location", ViewCommand::ToggleAid(CanvasAid::Walk));
    [
        walk.checked(state.view.aids.walk),
        item("Show the tab Method", ViewCommand::ShowTab(Tab::Method))
            .checked(state.view.dock.tab() == Tab::Method),
    ]
}
