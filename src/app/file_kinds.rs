//! The kinds of files that whole documents and meshes are read from and written to.

use std::path::Path;

use super::features::ROWS;
use meshbrush_io::io::project::ENDING;
use meshbrush_io::io::{RasterFormat, recipe, recording, shape_format};
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{FileAct, FileKind, FileRequest};
use meshbrush_render::render::export::ExportFormat;

/// Returns the kinds of files to open by ending: the first one that accepts the ending counts.
pub fn opened_by_ending() -> impl Iterator<Item = FileRequest> {
    let of_features = ROWS.iter().flat_map(|row| row.files);
    [&OPEN_PROJECT, &OPEN_RECIPE].into_iter().chain(of_features.copied())
}

/// Returns the contents and the endings of the files that open, in words.
pub fn files_that_open() -> String {
    let kind = |kind: FileRequest| {
        let endings: Vec<String> = (kind.endings)().iter().map(|ending| format!(".{ending}")).collect();
        format!("{} ({})", kind.contents.to_lowercase(), endings.join(", "))
    };
    opened_by_ending().map(kind).collect::<Vec<_>>().join(", ")
}

/// Returns the kind of a file to open, by the ending of its name.
///
/// # Errors
/// Fails with a sentence when files with that ending cannot be opened.
pub fn opened_kind(path: &Path) -> Result<FileRequest, String> {
    let name = path.file_name().unwrap_or_default();
    match opened_by_ending().find(|kind| kind.takes(name)) {
        Some(kind) => Ok(kind),
        None => Err(format!("{} cannot be opened. These files can: {}.", path.display(), files_that_open())),
    }
}

/// Any file that can be opened.
pub static OPEN_ANY: FileKind = FileKind {
    title: "Open",
    act: FileAct::OpenDocument,
    endings: || opened_by_ending().flat_map(|kind| (kind.endings)()).collect(),
    contents: "Projects, domains, pictures, grids",
    folder: "projects",
    ..FileKind::new(|path| Command::from(FileCommand::Open(path)))
};

/// Any file of data, which is asked about once it is read.
pub static ADD_DATA: FileKind = FileKind {
    title: "Add data",
    act: FileAct::Add,
    endings: || {
        let rasters = RasterFormat::all().flat_map(RasterFormat::endings).copied();
        rasters.chain(shape_format::endings()).chain(["csv"]).collect()
    },
    contents: "Grids, pictures, shapes and tables",
    folder: "data",
    ..FileKind::new(|path| Command::from(FileCommand::AddData(path)))
};

/// A project.
pub static OPEN_PROJECT: FileKind = FileKind {
    title: "Open project",
    act: FileAct::OpenDocument,
    endings: || vec![ENDING],
    contents: "Projects",
    folder: "projects",
    ..FileKind::new(|path| Command::from(FileCommand::OpenProject(path)))
};

/// A recipe as a new document.
pub static OPEN_RECIPE: FileKind = FileKind {
    title: "Open recipe",
    act: FileAct::OpenDocument,
    endings: || vec![recipe::ENDING],
    contents: "Recipes",
    folder: "recipes",
    ..FileKind::new(|path| Command::from(FileCommand::OpenRecipe(path)))
};

/// The document as a project.
pub static SAVE_PROJECT: FileKind = FileKind {
    title: "Save project",
    act: FileAct::Save,
    endings: || vec![ENDING],
    contents: "Projects",
    folder: "projects",
    command_after_browsing: |path| Command::from(FileCommand::SaveTo(path)),
    ..FileKind::new(|path| Command::from(FileCommand::SaveAs(path)))
};

/// The document as a recipe.
pub static SAVE_RECIPE: FileKind = FileKind {
    title: "Save as recipe",
    act: FileAct::Save,
    endings: || vec![recipe::ENDING],
    contents: "Recipes",
    folder: "recipes",
    ..FileKind::new(|path| Command::from(FileCommand::SaveRecipeAs(path)))
};

/// The recorded edits, as a test.
pub static EXPORT_TEST: FileKind = FileKind {
    title: "Export as test",
    act: FileAct::Export,
    endings: || vec![recording::ENDING],
    contents: "Recorded sessions",
    folder: "tests",
    command_after_browsing: |path| Command::from(FileCommand::ExportTest(path)),
    ..FileKind::new(|path| Command::from(FileCommand::ExportTestAs(path)))
};

/// The keys that were changed.
pub static EXPORT_KEYS: FileKind = FileKind {
    title: "Export keys",
    act: FileAct::Export,
    endings: || vec!["json"],
    contents: "Keys",
    folder: "keys",
    suffix: " keys",
    command_after_browsing: |path| Command::from(ShellCommand::ExportKeys(path)),
    ..FileKind::new(|path| Command::from(ShellCommand::ExportKeysAs(path)))
};

/// Changed keys, in place of those of the window.
pub static IMPORT_KEYS: FileKind = FileKind {
    title: "Import keys",
    endings: || vec!["json"],
    contents: "Keys",
    folder: "keys",
    ..FileKind::new(|path| Command::from(ShellCommand::ImportKeys(path)))
};

/// The mesh.
pub static EXPORT_MESH: FileKind = FileKind {
    title: "Export mesh",
    act: FileAct::Export,
    endings: || ExportFormat::endings().collect(),
    formats: || {
        let chosen_by_ending =
            |format: &ExportFormat| ExportFormat::from_ending(format.ending()) == Some(*format);
        let formats = ExportFormat::all().filter(chosen_by_ending);
        formats.map(|format| (format.ending(), format.purpose())).collect()
    },
    contents: "Meshes and pictures",
    folder: "exports",
    command_after_browsing: |path| {
        Command::from(match is_one_file(&path) {
            true => FileCommand::Export(path),
            // The desktop has not asked about the files beside it.
            false => FileCommand::ExportAs(path),
        })
    },
    ..FileKind::new(|path| Command::from(FileCommand::ExportAs(path)))
};

fn is_one_file(path: &Path) -> bool {
    ExportFormat::from_path(path).is_ok_and(|format| format.files(path).len() == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_that_open_are_named_with_their_endings() {
        let named = files_that_open();
        assert!(named.starts_with("projects (.meshbrush), recipes (.toml), "), "{named}");
        assert!(named.contains("pictures and grids (.png, "), "{named}");
    }
}
