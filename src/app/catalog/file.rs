//! The menu File.

use eframe::egui::{Key, Modifiers};

use crate::app::features::domain::{
    ADD_OUTLINE, OPEN_DOMAIN, OPEN_DOMAIN_AS_IT_IS, OPEN_DOMAIN_IN_METRES, OPEN_SEA,
};
use crate::app::features::layers::{OPEN_DIAMETERS, OPEN_RISK};
use crate::app::features::paths::EXPORT_PATH;
use crate::app::features::picture::OPEN_PICTURE;
use crate::app::file_kinds::{ADD_DATA, EXPORT_MESH, EXPORT_TEST, OPEN_ANY, SAVE_PROJECT, SAVE_RECIPE};
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::platform::IS_PAGE;
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// Recent files in the menu; the palette has all.
const MOST_RECENT_IN_MENU: usize = 5;

/// Documents and files.
pub fn file(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::File;
    let mut items = vec![
        CatalogItem::new(File, "New…", Command::from(FileCommand::NewFromPage)).ctrl(Key::N),
        CatalogItem::new(File, "Open…", Command::from(FileCommand::Ask(&OPEN_ANY))).ctrl(Key::O),
        CatalogItem::new(File, "Save", Command::from(FileCommand::Save)).ctrl(Key::S),
        CatalogItem::new(File, "Save as…", Command::from(FileCommand::Ask(&SAVE_PROJECT)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S),
        CatalogItem::new(File, "Save as recipe…", Command::from(FileCommand::Ask(&SAVE_RECIPE))),
        CatalogItem::new(File, "Add data…", Command::from(FileCommand::Ask(&ADD_DATA)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::D)
            .group(),
        // *Add data…* asks what a file is to be; these know it already.
        CatalogItem::new(File, "Open picture as risk…", Command::from(FileCommand::Ask(&OPEN_RISK)))
            .palette_only(),
        CatalogItem::new(
            File,
            "Open grid as target diameter…",
            Command::from(FileCommand::Ask(&OPEN_DIAMETERS)),
        )
        .palette_only(),
        CatalogItem::new(File, "Open background picture…", Command::from(FileCommand::Ask(&OPEN_PICTURE)))
            .palette_only(),
        CatalogItem::new(File, "Open domain…", Command::from(FileCommand::Ask(&OPEN_DOMAIN)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::O),
        CatalogItem::new(
            File,
            "Open domain in metres…",
            Command::from(FileCommand::Ask(&OPEN_DOMAIN_IN_METRES)),
        )
        .palette_only(),
        CatalogItem::new(
            File,
            "Open domain in its own coordinates…",
            Command::from(FileCommand::Ask(&OPEN_DOMAIN_AS_IT_IS)),
        )
        .palette_only(),
        CatalogItem::new(File, "Open the sea around land…", Command::from(FileCommand::Ask(&OPEN_SEA)))
            .palette_only(),
        CatalogItem::new(
            File,
            "Add outline to this document…",
            Command::from(FileCommand::Ask(&ADD_OUTLINE)),
        )
        .palette_only(),
    ];
    items.extend(exports(state));
    items.extend(recent(state));
    items.push(last());
    items
}

/// What writes files.
fn exports(state: &FrameState<'_>) -> [CatalogItem; 5] {
    use Menu::File;
    let has_paths = !state.session.document().settings().paths.routes.is_empty();
    let files = state.project.exports.paths().len();
    let again = match files {
        0 | 1 => "Export again".to_owned(),
        files => format!("Export {files} files again"),
    };
    [
        CatalogItem::new(File, "Export mesh…", Command::from(FileCommand::Ask(&EXPORT_MESH)))
            .ctrl(Key::E)
            .group(),
        CatalogItem::new(File, again, Command::from(FileCommand::ExportAgain))
            .id("export-again")
            .enabled(files > 0),
        CatalogItem::new(File, "Picture options…", Command::from(ShellCommand::AskPicture)),
        CatalogItem::new(File, "Export path…", Command::from(FileCommand::Ask(&EXPORT_PATH)))
            .enabled(has_paths),
        CatalogItem::new(File, "Export as test…", Command::from(FileCommand::Ask(&EXPORT_TEST))),
    ]
}

/// Files that were opened or saved.
fn recent(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let mut items = Vec::new();
    for (i, path) in state.project.recent().iter().enumerate() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let item = CatalogItem::new(
            Menu::File,
            format!("Open recent {name}"),
            Command::from(FileCommand::Open(path.clone())),
        );
        let item = item.id(format!("open-recent-{}", i + 1)).in_menu(i < MOST_RECENT_IN_MENU);
        items.push(if i == 0 { item.group() } else { item });
    }
    items
}

/// Ends the window; a page is closed with its tab, and can be sent.
fn last() -> CatalogItem {
    let item = if IS_PAGE {
        CatalogItem::new(Menu::File, "Copy link", Command::from(FileCommand::CopyLink))
    } else {
        CatalogItem::new(Menu::File, "Quit", Command::from(FileCommand::Quit)).ctrl(Key::Q)
    };
    item.group()
}
