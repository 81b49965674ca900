//! Output files: checks before the work, and the look of pictures.

use std::path::{Path, PathBuf};

use super::args::PictureArguments;
use super::failure::Failure;
use crate::colormap::{Colormap, Ground, LevelColors};
use crate::io::{MeshData, Meter, obstacle};
use crate::mesh::{Extract, Mesh};
use crate::render::export::{ExportFormat, LARGEST_PICTURE, Look};
use crate::text::Grouped;

/// A file to be written.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    format: ExportFormat,
}

impl Output {
    /// A file; its extension decides the format.
    ///
    /// # Errors
    /// When the extension is unknown.
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let format = ExportFormat::of(path).map_err(|error| Failure::Usage(format!("-o {error}")))?;
        Ok(Self { path: path.to_owned(), format })
    }

    /// Checks before the work whether its files can be written there.
    ///
    /// # Errors
    /// Those of [`check_place`], for each of its files.
    pub fn check_places(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        self.format.files(&self.path).iter().try_for_each(|file| check_place(file, inputs))
    }

    /// Whether some node data is written.
    pub fn wants_node_data(&self) -> bool {
        self.format.wants_node_data()
    }

    /// Writes the file, or the four files of `.node`, and returns their names. `extract` is that of `mesh`,
    /// and `data` is in the order of its nodes.
    ///
    /// # Errors
    /// When the file cannot be written. What was there before is kept then.
    pub fn write(
        &self,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
    ) -> Result<Vec<PathBuf>, Failure> {
        let written = self.format.write(&self.path, mesh, extract, data, look, &Meter::default());
        written.map_err(|error| failed(&self.path, error.to_string()))
    }
}

fn failed(path: &Path, problem: String) -> Failure {
    Failure::Write { file: path.to_owned(), problem }
}

/// Checks before the work whether a file can be written there.
///
/// # Errors
/// When its folder does not exist, it is a folder itself, or it is one of the input files.
pub fn check_place(path: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    if let Some(obstacle) = obstacle(path) {
        return Err(failed(path, obstacle));
    }
    let same = |input: &PathBuf| match (input.canonicalize(), path.canonicalize()) {
        (Ok(input), Ok(output)) => input == output,
        _ => false,
    };
    if inputs.iter().any(same) {
        return Err(Failure::Usage(format!("{} is an input file; write to another name.", path.display())));
    }
    Ok(())
}

/// The look that is asked for, before there is a mesh.
#[derive(Debug)]
pub struct RequestedLook {
    width: u32,
    height: Option<u32>,
    edges: bool,
    colormap: Colormap,
    ground: Ground,
}

impl RequestedLook {
    /// The look that the arguments describe.
    ///
    /// # Errors
    /// When the size or the name of the colour map is invalid.
    pub fn new(typed: &PictureArguments) -> Result<Self, Failure> {
        let colormap: Colormap =
            typed.colormap.parse().map_err(|e| Failure::Usage(format!("--colormap: {e}")))?;
        let ground = if typed.light { Ground::Light } else { Ground::Dark };
        let (width, height) = parse_size(&typed.size)?;
        Ok(Self { width, height, edges: !typed.no_edges, colormap, ground })
    }

    /// The look, with the colours spread over the levels of a mesh.
    pub fn for_mesh(self, mesh: &Mesh) -> Look {
        let Self { width, height, edges, colormap, ground } = self;
        let deepest = mesh.level_counts().len() as u8 - 1;
        Look { width, height, edges, ground, level_colors: LevelColors::new(colormap, ground, deepest) }
    }
}

fn parse_size(text: &str) -> Result<(u32, Option<u32>), Failure> {
    let side = |text: &str| text.trim().parse().ok().filter(|side| (1..=LARGEST_PICTURE).contains(side));
    let parsed = match text.split_once(['x', 'X', '×']) {
        Some((width, height)) => side(width).zip(side(height)).map(|(w, h)| (w, Some(h))),
        None => side(text).map(|width| (width, None)),
    };
    parsed.ok_or_else(|| {
        let problem = format!("--size {text}: write a width, or width x height, as in 1600 or 1600x900");
        Failure::Usage(format!("{problem}; each from 1 to {} pixels.", Grouped(LARGEST_PICTURE as usize)))
    })
}
