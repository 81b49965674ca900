//! The files that the mesh of the document is exported to, to write all of them again.

use std::path::{Path, PathBuf};

use meshbrush_io::io;
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_render::render::export::ExportFormat;

/// The files that the mesh of the document was exported to, or that its recipe names.
#[derive(Clone, Debug, Default)]
pub struct ExportSet(Vec<ExportedFile>);

#[derive(Clone, Debug)]
struct ExportedFile {
    /// The file with its keys in a recipe.
    output: SavedOutput,
    /// Whether it was written in this window: then it may be replaced.
    is_written: bool,
}

impl ExportSet {
    /// Returns the files that a recipe names.
    pub fn of_recipe(outputs: Vec<SavedOutput>) -> Self {
        Self(outputs.into_iter().map(|output| ExportedFile { output, is_written: false }).collect())
    }

    /// Notes that the mesh is exported to a file.
    pub fn note(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        match self.0.iter_mut().find(|file| file.output.file == path) {
            Some(file) => file.is_written = true,
            None => {
                let output = SavedOutput { file: path, ..SavedOutput::default() };
                self.0.push(ExportedFile { output, is_written: true });
            }
        }
    }

    /// Returns the files, in the order in which they were named.
    pub fn paths(&self) -> impl ExactSizeIterator<Item = &Path> {
        self.0.iter().map(|file| &*file.output.file)
    }

    /// Returns the files that exist, were not written in this window, and would be replaced by the export of
    /// a document with lines, or of one without them.
    pub fn foreign_files(&self, has_lines: bool) -> Vec<PathBuf> {
        let foreign = self.0.iter().filter(|file| !file.is_written).map(|file| &*file.output.file);
        let all = foreign.flat_map(|path| {
            let format = ExportFormat::from_path(path);
            format.map_or_else(|_| Vec::new(), |format| format.files_of(path, has_lines))
        });
        all.filter(|file| io::exists(file)).collect()
    }

    /// Returns the tables `[[output]]` of a recipe in a folder.
    pub fn for_recipe_in(&self, folder: &Path) -> Vec<SavedOutput> {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let beside = |file: &ExportedFile| {
            let mut output = file.output.clone();
            let of_grids =
                output.grids.iter_mut().flat_map(|grid| [Some(&mut grid.file), grid.table.as_mut()]);
            for file in std::iter::once(&mut output.file).chain(of_grids.flatten()) {
                if let Ok(name) = file.strip_prefix(&folder) {
                    *file = name.to_owned();
                }
            }
            output
        };
        self.0.iter().map(beside).collect()
    }

    /// Returns a sentence about the keys of the files that the window does not honour; `None` where it
    /// honours all.
    pub fn unheard_keys(&self) -> Option<String> {
        let has_keys = |file: &&ExportedFile| {
            let plain = SavedOutput { file: file.output.file.clone(), ..SavedOutput::default() };
            file.output != plain
        };
        let names: Vec<String> = (self.0.iter().filter(has_keys))
            .map(|file| file.output.file.file_name().unwrap_or_default().to_string_lossy().into_owned())
            .collect();
        (!names.is_empty()).then(|| {
            format!(
                "The recipe has keys for {} beside the name of the file. The window writes {} without them, and pictures \
                 as they are on the canvas; a saved recipe keeps them.",
                names.join(", "),
                if names.len() == 1 { "it" } else { "them" }
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_once_and_beside_a_recipe_from_its_folder() {
        let mut set = ExportSet::of_recipe(vec![SavedOutput {
            file: "/sea/a.14".into(),
            binary: true,
            ..SavedOutput::default()
        }]);
        assert!(set.unheard_keys().unwrap().contains("a.14"));
        for path in ["/sea/a.14", "/sea/b.vtu", "/sea/b.vtu", "/other/c.png"] {
            set.note(Path::new(path));
        }
        assert_eq!(set.paths().len(), 3);
        let outputs = set.for_recipe_in(Path::new("/sea"));
        let files: Vec<_> = outputs.iter().map(|output| output.file.to_str().unwrap()).collect();
        assert_eq!(files, ["a.14", "b.vtu", "/other/c.png"]);
        assert!(outputs[0].binary, "its keys stay");
        assert_eq!(ExportSet::default().unheard_keys(), None);
    }
}
