//! Output files: what the ending of a name means, checks before the work, and writing.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::args::PictureArguments;
use super::failure::Failure;
use super::job::ending;
use crate::colormap::{Colormap, Ground, LevelColors};
use crate::geometry::Lattice;
use crate::io::{MeshData, MeshFormat, png, svg, write_file};
use crate::mesh::{Extract, Mesh};
use crate::render::{Image, software};
use crate::scene::{Camera, Style};

/// A file to be written.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    /// The mesh with its data.
    Mesh(MeshFormat),
    /// A picture of lines and faces.
    Svg,
    /// A picture of pixels.
    Png,
}

impl Format {
    fn from_ending(ending: &str) -> Option<Self> {
        match ending {
            "svg" => Some(Self::Svg),
            "png" => Some(Self::Png),
            _ => MeshFormat::from_ending(ending).map(Self::Mesh),
        }
    }
}

impl Output {
    /// A file whose ending says what to write.
    ///
    /// # Errors
    /// When the ending is unknown.
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let Some(format) = Format::from_ending(&ending(path)) else {
            let meshes = MeshFormat::ALL.map(|(ending, _)| format!(".{ending}")).join(" ");
            let problem = format!("-o {}: the ending says what to write; choose one of", path.display());
            return Err(Failure::Usage(format!("{problem} {meshes} .svg .png")));
        };
        Ok(Self { path: path.to_owned(), format })
    }

    /// Whether some node data is written.
    pub fn wants_node_data(&self) -> bool {
        matches!(self.format, Format::Mesh(_))
    }

    /// Writes the file, or the four files of `.node`, and returns their names. `extract` is that of `mesh`, and `data` belongs
    /// to its nodes.
    ///
    /// # Errors
    /// When the file system says no. What was there before is then still there.
    pub fn write(
        &self,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
    ) -> Result<Vec<PathBuf>, Failure> {
        let path = &self.path;
        match self.format {
            Format::Mesh(format) => {
                return format.write(path, extract, data).map_err(|error| failed(path, error.to_string()));
            }
            Format::Svg => write_one(path, |mut out| svg::write(&mut out, extract, &look.for_svg(mesh)))?,
            Format::Png => {
                let picture = look.draw(mesh);
                write_one(path, |mut out| png::write(&mut out, picture.size, &picture.rgba))?;
            }
        }
        Ok(vec![path.clone()])
    }
}

fn write_one(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    write_file(path, write).map_err(|error| failed(path, error.to_string()))
}

fn failed(path: &Path, problem: String) -> Failure {
    Failure::Write { file: path.to_owned(), problem }
}

/// Finds out before the work whether a file can be put there at all.
///
/// # Errors
/// When its folder does not exist, it is a folder itself, or it is one of the input files.
pub fn check_place(path: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(failed(path, format!("there is no folder {}", folder.display())));
    }
    if path.is_dir() {
        return Err(failed(path, "a folder has this name".to_owned()));
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

/// How pictures look.
#[derive(Debug)]
pub struct Look {
    width: u32,
    height: Option<u32>,
    edges: bool,
    colormap: Colormap,
    ground: Ground,
    level_colors: LevelColors,
}

/// Most pixels along a side of a picture.
const LARGEST_PICTURE: u32 = 16_384;

impl Look {
    /// The look that the arguments ask for.
    ///
    /// # Errors
    /// When the size or the name of the colour map makes no sense.
    pub fn new(typed: &PictureArguments) -> Result<Self, Failure> {
        let colormap: Colormap =
            typed.colormap.parse().map_err(|e| Failure::Usage(format!("--colormap: {e}")))?;
        let ground = if typed.light { Ground::Light } else { Ground::Dark };
        let (width, height) = parse_size(&typed.size)?;
        let level_colors = LevelColors::new(colormap, ground, 1);
        Ok(Self { width, height, edges: !typed.no_edges, colormap, ground, level_colors })
    }

    /// The same look, with the colours spread over the levels of a mesh.
    pub fn for_mesh(self, mesh: &Mesh) -> Self {
        let deepest = mesh.level_counts().len() as u8 - 1;
        Self { level_colors: LevelColors::new(self.colormap, self.ground, deepest), ..self }
    }

    /// Width and height in pixels; where no height was given, that of the domain's proportions.
    fn size(&self, lattice: &Lattice) -> [u32; 2] {
        let extent = lattice.bounds().size();
        let in_proportion = || (f64::from(self.width) * extent.y / extent.x).round();
        let height =
            self.height.unwrap_or_else(|| in_proportion().clamp(1.0, f64::from(LARGEST_PICTURE)) as u32);
        [self.width, height]
    }

    fn draw(&self, mesh: &Mesh) -> Image {
        let lattice = mesh.lattice();
        let camera = Camera::fit(lattice, lattice.bounds(), self.size(lattice), 0.0);
        let colors = *self.level_colors.as_table();
        let style = match self.ground {
            Ground::Dark => Style::dark(colors),
            Ground::Light => Style::light(colors),
        };
        let [r, g, b] = self.ground.canvas();
        let style = Style { edges: self.edges, ground: [r, g, b, 0xff], ..style };
        software::draw(mesh, &camera, &style, None, &[])
    }

    fn for_svg(&self, mesh: &Mesh) -> svg::Style<'_> {
        svg::Style {
            size: self.size(mesh.lattice()),
            level_colors: self.level_colors.as_table(),
            background: self.ground.canvas(),
            edges: self.edges,
        }
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
        Failure::Usage(format!("{problem}; each from 1 to {LARGEST_PICTURE} pixels."))
    })
}
