//! The menu File.

use eframe::egui::{Key, Modifiers};

use super::{CatalogItem, Menu};
use crate::app::command::{Command, FileCommand};
use crate::app::dialogs::FileRequest;
use crate::app::frame::FrameState;

/// Documents and files.
pub fn file(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::File;
    let has_paths = !state.session.document().settings().paths.routes.is_empty();
    let mut items = vec![
        CatalogItem::new(File, "New", Command::File(FileCommand::New)).ctrl(Key::N),
        CatalogItem::new(File, "Open…", Command::File(FileCommand::Ask(FileRequest::Open))).ctrl(Key::O),
        CatalogItem::new(File, "Save", Command::File(FileCommand::Save)).ctrl(Key::S),
        CatalogItem::new(File, "Save as…", Command::File(FileCommand::Ask(FileRequest::Save)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S),
        CatalogItem::new(File, "Save as recipe…", Command::File(FileCommand::Ask(FileRequest::SaveRecipe))),
        CatalogItem::new(
            File,
            "Open picture as risk…",
            Command::File(FileCommand::Ask(FileRequest::OpenImage)),
        )
        .group(),
        CatalogItem::new(
            File,
            "Open grid as target diameter…",
            Command::File(FileCommand::Ask(FileRequest::OpenDiameters)),
        ),
        CatalogItem::new(
            File,
            "Open background picture…",
            Command::File(FileCommand::Ask(FileRequest::OpenBackground)),
        ),
        CatalogItem::new(File, "Open domain…", Command::File(FileCommand::Ask(FileRequest::OpenDomain)))
            .keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::O),
        CatalogItem::new(
            File,
            "Add outline to this document…",
            Command::File(FileCommand::Ask(FileRequest::AddOutline)),
        ),
        CatalogItem::new(File, "Export mesh…", Command::File(FileCommand::Ask(FileRequest::Export)))
            .ctrl(Key::E),
        CatalogItem::new(File, "Export path…", Command::File(FileCommand::Ask(FileRequest::ExportPath)))
            .enabled(has_paths),
        CatalogItem::new(File, "Export as test…", Command::File(FileCommand::Ask(FileRequest::ExportTest))),
    ];
    for (i, path) in state.project.recent().iter().enumerate() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let item = CatalogItem::new(
            File,
            format!("Open recent {name}"),
            Command::File(FileCommand::Open(path.clone())),
        );
        items.push(if i == 0 { item.group() } else { item });
    }
    items.push(CatalogItem::new(File, "Quit", Command::File(FileCommand::Quit)).ctrl(Key::Q).group());
    items
}
