//! The commands that have a title: what menus, keys and the palette offer.

use eframe::egui::{Key, KeyboardShortcut, Modifiers, ThemePreference};

use super::command::{BoundaryCommand, Command, DomainCommand};
use super::dialogs::FileRequest;
use super::frame::FrameState;
use super::tools::{BOUNDARY, BoundaryToolMode, DOMAIN, DomainToolMode, PaintKind, TOOLS};
use super::view::FieldOverlay;
use crate::colormap::Colormap;
use crate::document::Example;

/// Every command with a title, in menu order, with its present state.
pub fn catalog(state: &FrameState<'_>) -> Vec<CatalogItem> {
    [file(state), edit(state), tool(state), view(state), examples(), help()].concat()
}

fn file(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::File;
    let mut items = vec![
        CatalogItem::new(File, "New", Command::New).ctrl(Key::N),
        CatalogItem::new(File, "Open…", Command::Ask(FileRequest::Open)).ctrl(Key::O),
        CatalogItem::new(File, "Save", Command::Save).ctrl(Key::S),
        CatalogItem::new(File, "Save as…", Command::Ask(FileRequest::Save))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S),
        CatalogItem::new(File, "Open picture as risk…", Command::Ask(FileRequest::OpenImage)).group(),
        CatalogItem::new(File, "Open domain…", Command::Ask(FileRequest::OpenDomain))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::O),
        CatalogItem::new(File, "Export mesh…", Command::Ask(FileRequest::Export)).ctrl(Key::E),
    ];
    for (i, path) in state.project.recent().iter().enumerate() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let item = CatalogItem::new(File, format!("Open recent {name}"), Command::Open(path.clone()));
        items.push(if i == 0 { item.group() } else { item });
    }
    items.push(CatalogItem::new(File, "Quit", Command::Quit).ctrl(Key::Q).group());
    items
}

fn edit(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Edit;
    let history = state.session.document().history();
    let named = |verb: &str, title: Option<&str>| match title {
        Some(title) => format!("{verb} {title}"),
        None => verb.to_owned(),
    };
    let undo = named("Undo", history.undo_title());
    let redo = named("Redo", history.redo_title());
    let can_undo = state.session.can_undo();
    let can_redo = history.redo_title().is_some();
    vec![
        CatalogItem::new(Edit, undo, Command::Undo).ctrl(Key::Z).enabled(can_undo),
        CatalogItem::new(Edit, redo, Command::Redo)
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            .enabled(can_redo),
        CatalogItem::new(Edit, "Clear paint", Command::ClearPaint)
            .keys(Modifiers::COMMAND, Key::Backspace)
            .group(),
        CatalogItem::new(Edit, "Cancel or deselect", Command::Escape).key(Key::Escape),
    ]
}

fn tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Tool as InTool;
    let tools = state.tools;
    let kind =
        |title: &str, kind| CatalogItem::new(InTool, title, Command::Paint(kind)).checked(tools.kind == kind);
    let harder = |title: &str, step: f64, key| {
        let hardness = (tools.hardness + step).clamp(0.0, 1.0);
        CatalogItem::new(InTool, title, Command::BrushHardness(hardness)).keys(Modifiers::SHIFT, key)
    };
    let mut items: Vec<CatalogItem> = (TOOLS.iter())
        .map(|tool| {
            let item = CatalogItem::new(InTool, tool.name, Command::Use(tool)).key(tool.key);
            item.checked(tools.tool == *tool)
        })
        .collect();
    items.extend([
        kind("Paint risk", PaintKind::Risk).key(Key::R).group(),
        kind("Paint target diameter", PaintKind::Diameter).key(Key::T),
        CatalogItem::new(InTool, "Larger brush", Command::ScaleBrush(1.15)).key(Key::CloseBracket).group(),
        CatalogItem::new(InTool, "Smaller brush", Command::ScaleBrush(1.0 / 1.15)).key(Key::OpenBracket),
        harder("Harder brush", 0.1, Key::CloseCurlyBracket),
        harder("Softer brush", -0.1, Key::OpenCurlyBracket),
    ]);
    items.extend(domain_tool(state));
    for (i, key) in DIGITS.into_iter().enumerate() {
        let percent = 10 * (i + 1);
        let command = Command::BrushStrength(percent as f64 / 100.0);
        let item = CatalogItem::new(InTool, format!("Strength {percent} %"), command).key(key);
        items.push(if i == 0 { item.group() } else { item });
    }
    items
}

fn domain_tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Domain(command));
    let mode = |title: &str, mode| {
        let current = tools.tool == &DOMAIN && tools.domain.mode == mode;
        item(title, DomainCommand::Mode(mode)).checked(current)
    };
    let adds = tools.domain.adds;
    let mut items = vec![
        mode("Cut domain with the brush", DomainToolMode::Brush).group(),
        mode("Cut domain with a rectangle", DomainToolMode::Rectangle),
        mode("Cut domain with a polygon", DomainToolMode::Polygon),
        mode("Draw the frame of the domain", DomainToolMode::Frame),
        item("Add to the domain", DomainCommand::Adds(!adds)).key(Key::X).checked(adds),
    ];
    items.extend(boundary_tool(state));
    if !tools.domain.corners.is_empty() {
        items.push(item("Close the polygon", DomainCommand::ClosePolygon).key(Key::Enter));
    }
    items
}

fn boundary_tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Boundary(command));
    let current = |mode| tools.tool == &BOUNDARY && tools.boundary.mode == mode;
    let (select, split) = (BoundaryToolMode::Select, BoundaryToolMode::Split);
    let mut items = vec![
        item("Select pieces of the boundary", BoundaryCommand::Mode(select)).checked(current(select)).group(),
        item("Split the boundary", BoundaryCommand::Mode(split)).checked(current(split)),
    ];
    if tools.tool == &BOUNDARY {
        let other = if tools.boundary.mode == split { select } else { split };
        items.push(item("Select or split", BoundaryCommand::Mode(other)).key(Key::S));
        items.push(item("Join the piece with the next", BoundaryCommand::Join));
    }
    items
}

const DIGITS: [Key; 10] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
    Key::Num0,
];

fn view(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::View;
    let view = state.view;
    let overlay = |title: &str, overlay| {
        // The key of the overlay that is shown hides it.
        let shown = view.overlay == overlay;
        let next = if shown { FieldOverlay::None } else { overlay };
        CatalogItem::new(View, title, Command::SetOverlay(next)).checked(shown)
    };
    let theme = |title: &str, theme| {
        CatalogItem::new(View, title, Command::Theme(theme)).checked(view.theme == theme)
    };
    let mut items = vec![
        CatalogItem::new(View, "Fit domain", Command::Fit).key(Key::Home),
        CatalogItem::new(View, "Zoom in", Command::Zoom(1.5)).key(Key::Plus),
        CatalogItem::new(View, "Zoom out", Command::Zoom(1.0 / 1.5)).key(Key::Minus),
        CatalogItem::new(View, "Edges", Command::ToggleEdges).key(Key::G).checked(view.edges).group(),
        overlay("No overlay", FieldOverlay::None).group(),
        overlay("Overlay risk", FieldOverlay::Risk).key(Key::O),
        overlay("Overlay target", FieldOverlay::Target).keys(Modifiers::SHIFT, Key::O),
    ];
    for (i, map) in Colormap::ALL.into_iter().enumerate() {
        let title = format!("{} colours", map.name());
        let item = CatalogItem::new(View, title, Command::Colormap(map)).checked(view.colormap == map);
        items.push(if i == 0 { item.group() } else { item });
    }
    items.extend([
        theme("Dark theme", ThemePreference::Dark).group(),
        theme("Light theme", ThemePreference::Light),
        theme("Theme of the desktop", ThemePreference::System),
        CatalogItem::new(View, "Panels", Command::TogglePanels).key(Key::Tab).checked(view.panels).group(),
        CatalogItem::new(View, "Find a command…", Command::Palette).ctrl(Key::P),
    ]);
    items
}

fn examples() -> Vec<CatalogItem> {
    let item =
        |example: Example| CatalogItem::new(Menu::Examples, example.name(), Command::OpenExample(example));
    Example::ALL.map(item).into()
}

fn help() -> Vec<CatalogItem> {
    vec![CatalogItem::new(Menu::Help, "About Meshbrush", Command::About)]
}

/// The menu that a command is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Documents and files.
    File,
    /// History and paint.
    Edit,
    /// Tools and the brush.
    Tool,
    /// What is shown.
    View,
    /// Documents that come with the program.
    Examples,
    /// About.
    Help,
}

impl Menu {
    /// All menus, from left to right, with their names.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::Tool, "Tool"),
        (Self::View, "View"),
        (Self::Examples, "Examples"),
        (Self::Help, "Help"),
    ];
}

/// A command with its title, its menu and its key.
#[derive(Clone, Debug)]
pub struct CatalogItem {
    /// Its menu.
    pub menu: Menu,
    /// Its title in menus and in the palette.
    pub title: String,
    /// Its shortcut.
    pub shortcut: Option<KeyboardShortcut>,
    /// What it does.
    pub command: Command,
    /// Whether it can be run now.
    pub enabled: bool,
    /// Whether it is the current choice of several.
    pub checked: bool,
    /// Whether a separator is above it.
    pub begins_group: bool,
}

impl CatalogItem {
    /// A command that is enabled, without a key.
    pub fn new(menu: Menu, title: impl Into<String>, command: Command) -> Self {
        Self {
            menu,
            title: title.into(),
            shortcut: None,
            command,
            enabled: true,
            checked: false,
            begins_group: false,
        }
    }

    /// With a plain key.
    pub fn key(self, key: Key) -> Self {
        self.keys(Modifiers::NONE, key)
    }

    /// With a key and Ctrl (Cmd on a Mac).
    pub fn ctrl(self, key: Key) -> Self {
        self.keys(Modifiers::COMMAND, key)
    }

    /// With a key and modifiers.
    pub fn keys(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.shortcut = Some(KeyboardShortcut::new(modifiers, key));
        self
    }

    /// Only where `enabled`.
    pub fn enabled(mut self, enabled: bool) -> Self {
        self.enabled = enabled;
        self
    }

    /// Marked where `checked`.
    pub fn checked(mut self, checked: bool) -> Self {
        self.checked = checked;
        self
    }

    /// With a separator above it.
    pub fn group(mut self) -> Self {
        self.begins_group = true;
        self
    }
}

/// A shortcut as menus and the palette show it.
pub fn shortcut_text(shortcut: &KeyboardShortcut) -> String {
    let mut text = String::new();
    if shortcut.modifiers.command {
        text += "Ctrl+";
    }
    if shortcut.modifiers.shift {
        text += "Shift+";
    }
    text + match shortcut.logical_key {
        Key::OpenCurlyBracket => "[",
        Key::CloseCurlyBracket => "]",
        Key::Escape => "Esc",
        key => key.symbol_or_name(),
    }
}
