//! The list of commands that have a name: what menus, shortcuts and the palette offer.

use eframe::egui::{Key, Modifiers, ThemePreference};

use super::App;
use super::command::{Command, DomainCommand, Entry, Menu};
use super::tools::{DomainToolMode, PaintKind, Tool};
use super::view::FieldOverlay;
use crate::colormap::Colormap;
use crate::document::Example;

/// Every named command, in menu order, as it stands now.
pub fn catalog(app: &App) -> Vec<Entry> {
    [file(app), edit(app), tool(app), view(app), examples(), help()].concat()
}

fn file(app: &App) -> Vec<Entry> {
    use Menu::File;
    let mut entries = vec![
        Entry::new(File, "New", Command::New).ctrl(Key::N),
        Entry::new(File, "Open…", Command::AskToOpen).ctrl(Key::O),
        Entry::new(File, "Save", Command::Save).ctrl(Key::S),
        Entry::new(File, "Save as…", Command::AskWhereToSave)
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S),
        Entry::new(File, "Open picture as risk…", Command::AskForImage).group(),
        Entry::new(File, "Open domain…", Command::AskForDomain)
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::O),
        Entry::new(File, "Export mesh…", Command::AskForExport).ctrl(Key::E),
    ];
    for (i, path) in app.project.recent().iter().enumerate() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let entry = Entry::new(File, format!("Open recent {name}"), Command::Open(path.clone()));
        entries.push(if i == 0 { entry.group() } else { entry });
    }
    entries.push(Entry::new(File, "Quit", Command::Quit).ctrl(Key::Q).group());
    entries
}

fn edit(app: &App) -> Vec<Entry> {
    use Menu::Edit;
    let history = app.session.document().history();
    let named = |verb: &str, title: Option<&str>| match title {
        Some(title) => format!("{verb} {title}"),
        None => verb.to_owned(),
    };
    let undo = named("Undo", history.undo_title());
    let redo = named("Redo", history.redo_title());
    let can_undo = history.undo_title().is_some() || app.session.document().stroke().is_some();
    let can_redo = history.redo_title().is_some();
    vec![
        Entry::new(Edit, undo, Command::Undo).ctrl(Key::Z).enabled(can_undo),
        Entry::new(Edit, redo, Command::Redo)
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            .enabled(can_redo),
        Entry::new(Edit, "Clear paint", Command::ClearPaint).keys(Modifiers::COMMAND, Key::Backspace).group(),
        Entry::new(Edit, "Let go", Command::Escape).key(Key::Escape),
    ]
}

fn tool(app: &App) -> Vec<Entry> {
    use Menu::Tool as InTool;
    let tools = &app.tools;
    let tool = |title: &str, tool, key| {
        Entry::new(InTool, title, Command::Use(tool)).key(key).checked(tools.tool == tool)
    };
    let kind =
        |title: &str, kind| Entry::new(InTool, title, Command::Paint(kind)).checked(tools.kind == kind);
    let harder = |title: &str, step: f64, key| {
        let hardness = (tools.hardness + step).clamp(0.0, 1.0);
        Entry::new(InTool, title, Command::BrushHardness(hardness)).keys(Modifiers::SHIFT, key)
    };
    let mut entries = vec![
        tool("Brush", Tool::Brush, Key::B),
        tool("Eraser", Tool::Eraser, Key::E),
        tool("Query", Tool::Query, Key::Q),
        tool("Domain", Tool::Domain, Key::D),
        tool("Pan", Tool::Pan, Key::H),
        kind("Paint risk", PaintKind::Risk).key(Key::R).group(),
        kind("Paint target diameter", PaintKind::Diameter).key(Key::T),
        Entry::new(InTool, "Larger brush", Command::ScaleBrush(1.15)).key(Key::CloseBracket).group(),
        Entry::new(InTool, "Smaller brush", Command::ScaleBrush(1.0 / 1.15)).key(Key::OpenBracket),
        harder("Harder brush", 0.1, Key::CloseCurlyBracket),
        harder("Softer brush", -0.1, Key::OpenCurlyBracket),
    ];
    let shape = |title: &str, shape| {
        let taken = tools.tool == Tool::Domain && tools.domain_shape == shape;
        Entry::new(InTool, title, Command::Domain(DomainCommand::Shape(shape))).checked(taken)
    };
    entries.extend([
        shape("Cut domain with the brush", DomainToolMode::Brush).group(),
        shape("Cut domain with a rectangle", DomainToolMode::Rectangle),
        shape("Cut domain with a polygon", DomainToolMode::Polygon),
        shape("Draw the frame of the domain", DomainToolMode::Frame),
        Entry::new(InTool, "Add to the domain", Command::Domain(DomainCommand::Adds(!tools.domain_adds)))
            .key(Key::X)
            .checked(tools.domain_adds),
    ]);
    let drawing = !app.outline.is_empty();
    if drawing {
        entries.push(
            Entry::new(InTool, "Close the polygon", Command::Domain(DomainCommand::CloseOutline))
                .key(Key::Enter),
        );
    }
    for (i, key) in DIGITS.into_iter().enumerate() {
        let percent = 10 * (i + 1);
        let command = Command::BrushStrength(percent as f64 / 100.0);
        let entry = Entry::new(InTool, format!("Strength {percent} %"), command).key(key);
        entries.push(if i == 0 { entry.group() } else { entry });
    }
    entries
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

fn view(app: &App) -> Vec<Entry> {
    use Menu::View;
    let view = &app.view;
    let overlay = |title: &str, overlay| {
        Entry::new(View, title, Command::Overlay(overlay)).checked(view.overlay == overlay)
    };
    let theme =
        |title: &str, theme| Entry::new(View, title, Command::Theme(theme)).checked(app.theme == theme);
    let mut entries = vec![
        Entry::new(View, "Fit domain", Command::Fit).key(Key::Home),
        Entry::new(View, "Zoom in", Command::Zoom(1.5)).key(Key::Plus),
        Entry::new(View, "Zoom out", Command::Zoom(1.0 / 1.5)).key(Key::Minus),
        Entry::new(View, "Edges", Command::ToggleEdges).key(Key::G).checked(view.edges).group(),
        overlay("No overlay", FieldOverlay::None).group(),
        overlay("Overlay risk", FieldOverlay::Risk).key(Key::O),
        overlay("Overlay target", FieldOverlay::Target).keys(Modifiers::SHIFT, Key::O),
    ];
    for (i, map) in Colormap::ALL.into_iter().enumerate() {
        let title = format!("{} colours", map.name());
        let entry = Entry::new(View, title, Command::Colormap(map)).checked(view.colormap == map);
        entries.push(if i == 0 { entry.group() } else { entry });
    }
    entries.extend([
        theme("Dark theme", ThemePreference::Dark).group(),
        theme("Light theme", ThemePreference::Light),
        theme("Theme of the desktop", ThemePreference::System),
        Entry::new(View, "Panels", Command::TogglePanels).key(Key::Tab).checked(view.panels).group(),
        Entry::new(View, "Find a command…", Command::Palette).ctrl(Key::P),
    ]);
    entries
}

fn examples() -> Vec<Entry> {
    let entry = |example: Example| Entry::new(Menu::Examples, example.name(), Command::OpenExample(example));
    Example::ALL.map(entry).into()
}

fn help() -> Vec<Entry> {
    vec![Entry::new(Menu::Help, "About Meshbrush", Command::About)]
}
