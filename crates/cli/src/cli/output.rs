//! Output files: checks before the work, and the look of pictures.

use std::fmt::Display;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::args::{PICTURE_COLORMAP, PICTURE_SIZE, PictureArguments};
use super::build::FinishedMesh;
use super::color_by::{ColorBy, UnknownColorBy};
use super::failure::Failure;
use super::schism_files;
use super::space_look::RequestedSpace;
use super::standard_output::StandardOutput;
use meshbrush_core::earth::DegreeStyle;
use meshbrush_io::io::CellShape;
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_io::io::solver_rules::Solver;
use meshbrush_io::io::{
    DEPTH, KeyFault, MeshData, MeshFormat, Meter, PartitionFigures, QuantityPlaces, ThirdCoordinate, obstacle,
};
use meshbrush_mesh::mesh::{Extract, Mesh};
use meshbrush_mesh::text::Number;
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::colormap::{Colormap, LevelColors, UnknownColormap};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_render::render::furniture::{Furniture, UnknownFurniture};
use meshbrush_render::render::look::{Look, MapPlace};
use meshbrush_render::render::picture_size::{PictureGround, PictureSize, SizeError, UnknownGround};

/// A file to be written, or standard output.
#[derive(Clone, Debug)]
pub struct Output {
    /// `None` for standard output.
    path: Option<PathBuf>,
    format: ExportFormat,
    /// Whether it is the binary form of a format that is text otherwise.
    is_binary: bool,
    /// Whether the name of the format was needed, beside the name of the file.
    is_named: bool,
    /// The quantity that the file has in place of the depth, if there is one of that name.
    own_quantity: Option<String>,
}

impl Output {
    /// Creates a file, or `-`, standard output. `format` is the name of a format. It is that of standard
    /// output, and of a file that may be of this format by its extension; otherwise the extension decides. A
    /// format that has a binary form takes it where `is_binary`.
    ///
    /// # Errors
    /// Fails when the extension or the name is unknown, or no format is given for standard output.
    pub fn new(path: &Path, format: Option<&str>, is_binary: bool) -> Result<Self, Failure> {
        let named = format.map(named_format).transpose()?;
        let mut output = match is_standard_stream(path) {
            true => Self::standard(named)?,
            false => Self::file(path, named)?,
        };
        if let (true, Some(binary)) = (is_binary, output.format.binary()) {
            (output.format, output.is_binary) = (binary, true);
        }
        Ok(output)
    }

    fn file(path: &Path, named: Option<ExportFormat>) -> Result<Self, Failure> {
        let by_ending = ExportFormat::from_path(path);
        let fitting = named.filter(|format| format.fits(path) && by_ending != Ok(*format));
        let format = match fitting {
            Some(format) => format,
            None => by_ending.map_err(|error| Failure::Usage(format!("-o {error}")))?,
        };
        let own_quantity = schism_files::quantity_of(path, format);
        let (path, is_named) = (Some(path.to_owned()), fitting.is_some());
        Ok(Self { path, format, is_binary: false, is_named, own_quantity })
    }

    fn standard(named: Option<ExportFormat>) -> Result<Self, Failure> {
        let Some(format) = named else {
            let problem = "-o -: standard output has no ending that chooses a format; name one with --format";
            return Err(Failure::Usage(format!("{problem}, as in --format vtu.")));
        };
        match format.files(Path::new("stdout")).len() {
            1 => Ok(Self { path: None, format, is_binary: false, is_named: true, own_quantity: None }),
            files => {
                let problem = format!("--format {}: this format has {files} files", format.name());
                Err(Failure::Usage(format!("{problem}, and standard output is one. Name a file with -o.")))
            }
        }
    }

    /// Returns the file with a number in its name, as sea_2.14 for sea.14.
    pub fn numbered(&self, number: u32) -> Self {
        let named = |path: &PathBuf| {
            let mut name = path.file_stem().unwrap_or_default().to_owned();
            name.push(format!("_{number}"));
            if let Some(ending) = path.extension() {
                name.push(".");
                name.push(ending);
            }
            path.with_file_name(name)
        };
        Self { path: self.path.as_ref().map(named), own_quantity: self.own_quantity.clone(), ..*self }
    }

    /// Returns the file with the part of each cell.
    pub fn parts_file(&self, parts: u32) -> PathBuf {
        let path = self.path.as_deref().unwrap_or(Path::new("-"));
        self.format.mesh().map_or_else(|| path.to_owned(), |format| format.parts_file(path, parts))
    }

    /// Writes the part of each cell, and returns its file and how even the parts are; `None` for a picture
    /// and for standard output.
    pub fn write_parts(
        &self,
        mesh: &Extract,
        data: &MeshData,
        parts: u32,
        meter: &Meter,
    ) -> Option<io::Result<(PathBuf, PartitionFigures)>> {
        let (path, format) = (self.path.as_deref()?, self.format.mesh()?);
        Some(format.write_parts(path, mesh, data, parts, meter))
    }

    /// Returns whether it is standard output.
    pub fn is_stdout(&self) -> bool {
        self.path.is_none()
    }

    /// Returns the name of the quantity that its file has in place of the depth, of those with these `names`:
    /// `manning` for SCHISM's manning.gr3.
    ///
    /// # Errors
    /// Fails when SCHISM looks for a quantity in a file of that name, and there is none.
    pub fn in_place_of_depth<'a>(
        &self,
        mut names: impl Iterator<Item = &'a str>,
    ) -> Result<Option<&'a str>, Failure> {
        let Some(own) = self.own_quantity.as_deref() else { return Ok(None) };
        let found = names.find(|name| *name == own);
        let missing = if found.is_none() { schism_files::missing(own, &self.name()) } else { None };
        missing.map_or(Ok(found), |sentence| Err(Failure::Usage(sentence)))
    }

    /// Returns whether SCHISM reads its files.
    pub fn is_for_schism(&self) -> bool {
        schism_files::is_for_schism(self.format)
    }

    /// Returns whether the quantity of this name and number, from 0, has a place in its files. Those of a
    /// picture need none.
    pub fn has_quantity(&self, number: usize, name: &str) -> bool {
        let Some(mesh) = self.format.mesh() else { return true };
        // Standard output has no file of attributes beside it.
        let is_cut = self.is_stdout() && mesh.attributes_file(Path::new("mesh")).is_some();
        let is_within = match mesh.quantities() {
            QuantityPlaces::All if !is_cut => true,
            QuantityPlaces::First => number == 0,
            _ => name == DEPTH,
        };
        is_within || self.own_quantity.as_deref() == Some(name)
    }

    /// Checks before the work whether its files can be written there, with those of attributes and those of
    /// lines where there are any, in turn.
    ///
    /// # Errors
    /// Fails with the errors of [`check_place`], for each of its files.
    pub fn check_places(&self, inputs: &[PathBuf], there_are: [bool; 2]) -> Result<(), Failure> {
        let [has_attributes, has_lines] = there_are;
        let attributes = |path: &PathBuf| self.format.mesh()?.attributes_file(path);
        let attributes = self.path.as_ref().filter(|_| has_attributes).and_then(attributes);
        let files = self.path.iter().flat_map(|path| self.format.files_of(path, has_lines)).chain(attributes);
        files.into_iter().try_for_each(|file| check_place(&file, inputs))
    }

    /// Whether the name of the format was needed, beside the name of the file.
    pub fn is_named(&self) -> bool {
        self.is_named
    }

    /// Returns the format of a mesh; `None` for a picture.
    pub fn mesh_format(&self) -> Option<MeshFormat> {
        self.format.mesh()
    }

    /// Returns whether coordinates in its files have to be lengths.
    pub fn needs_lengths(&self) -> bool {
        self.format.needs_lengths()
    }

    /// Returns whether files of its format can have these cells.
    pub fn can_have(&self, cells: CellShape) -> bool {
        cells != CellShape::Squares || self.format.holds_squares()
    }

    /// Returns whether it has quadrilaterals where these cells are asked for.
    pub fn has_squares(&self, cells: CellShape) -> bool {
        match cells {
            CellShape::OfFormat => self.format.wants_squares(),
            CellShape::Triangles => false,
            CellShape::Squares => self.format.holds_squares(),
        }
    }

    /// Returns the solver that reads its format; `None` for a format of many programs.
    pub fn solver(&self) -> Option<Solver> {
        Solver::of_format(self.format.name())
    }

    /// Whether it is the binary form of a format that is text otherwise.
    pub fn is_binary(&self) -> bool {
        self.is_binary
    }

    /// Returns whether some node data is written.
    pub fn wants_node_data(&self) -> bool {
        self.format.wants_node_data()
    }

    /// Returns whether h̄ at the nodes is written.
    pub fn has_targets(&self) -> bool {
        self.format.has_targets()
    }

    /// Returns whether a coastal solver finds its open boundary there.
    pub fn has_open_boundary(&self) -> bool {
        self.format.has_open_boundary()
    }

    /// Returns what the third coordinate of nodes is.
    pub fn third_coordinate(&self) -> ThirdCoordinate {
        self.format.third_coordinate()
    }

    /// Returns whether it is a picture.
    pub fn is_picture(&self) -> bool {
        !matches!(self.format, ExportFormat::Mesh(_))
    }

    /// Returns whether it is a picture without pixels.
    pub fn is_vector_picture(&self) -> bool {
        self.format == ExportFormat::Svg
    }

    /// Returns the name of the output in messages.
    pub fn name(&self) -> String {
        self.path.as_deref().map_or("standard output".into(), |path| path.display().to_string())
    }

    /// Returns what a line about the written file adds to its name.
    pub fn caption(&self, look: &Look) -> String {
        match &look.space {
            Some(space) if self.is_picture() => {
                format!(", with heights times {}", Number(rounded(space.exaggeration / space.metre)))
            }
            _ => String::new(),
        }
    }

    /// Writes the file, or all files of a format that has several, and returns their names. `extract` is that
    /// of `mesh`, and `data` is in the order of its nodes.
    ///
    /// # Errors
    /// Fails when the file cannot be written. What was there before is kept then.
    pub fn write(
        &self,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> Result<Vec<PathBuf>, Failure> {
        let Some(path) = &self.path else {
            let mut out = BufWriter::new(StandardOutput::lock());
            let written = self.format.write_to(&mut out, mesh, extract, data, look, meter);
            return written.and_then(|()| out.flush()).map(|()| Vec::new()).map_err(Failure::Print);
        };
        let written = self.format.write(path, mesh, extract, data, look, meter);
        written.map_err(|error| failed(path, error.to_string()))
    }
}

/// Returns a positive number with three digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

fn named_format(name: &str) -> Result<ExportFormat, Failure> {
    ExportFormat::named(name.trim_start_matches('.')).ok_or_else(|| {
        let names: String = ExportFormat::names().map(|name| format!(" {name}")).collect();
        Failure::Usage(format!("--format {name}: use one of{names}."))
    })
}

/// Returns whether a path stands for standard input or standard output.
pub fn is_standard_stream(path: &Path) -> bool {
    path == Path::new("-")
}

/// Returns why a file cannot be written.
pub fn failed(path: &Path, problem: String) -> Failure {
    Failure::Write { file: path.to_owned(), problem }
}

/// Checks before the work whether a file can be written there.
///
/// # Errors
/// Fails when its folder does not exist, it is a folder itself, or it is one of the input files.
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
#[derive(Clone, Copy, Debug)]
pub struct RequestedLook {
    size: PictureSize,
    edges: bool,
    colormap: Colormap,
    color_by: ColorBy,
    ground: PictureGround,
    furniture: Option<Furniture>,
    space: Option<RequestedSpace>,
}

impl RequestedLook {
    /// Returns the look that the arguments describe.
    ///
    /// # Errors
    /// Fails when the size, or the name of a colour map, of a ground or of furniture is invalid.
    pub fn new(typed: &PictureArguments) -> Result<Self, Failure> {
        let size = PictureSize::parse(&typed.size, typed.dpi).map_err(|error| {
            Failure::Usage(match error {
                SizeError::DotsPerInch(_) => format!("--dpi: {error}"),
                _ => format!("--size {}: {error}", typed.size),
            })
        })?;
        let usage = |option: &str, error: &dyn Display| Failure::Usage(format!("--{option}: {error}"));
        let colormap = typed.colormap.parse().map_err(|error: UnknownColormap| usage("colormap", &error))?;
        let color_by = typed.color_by.as_deref().map(str::parse).transpose();
        let color_by = color_by.map_err(|error: UnknownColorBy| usage("color-by", &error))?;
        let ground = typed.ground.as_deref().map(str::parse).transpose();
        let ground = ground.map_err(|error: UnknownGround| usage("ground", &error))?;
        let furniture = typed.furniture.as_deref().map(str::parse).transpose();
        let furniture = furniture.map_err(|error: UnknownFurniture| usage("furniture", &error))?;
        let ground = ground.unwrap_or_else(|| theme(typed.light));
        let (edges, color_by) = (!typed.no_edges, color_by.unwrap_or_default());
        Ok(Self { size, edges, colormap, color_by, ground, furniture, space: None })
    }

    /// Returns the look that an output of a recipe describes.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does.
    pub fn of_saved(saved: &SavedOutput) -> Result<Self, KeyFault> {
        let size = PictureSize::parse(saved.size.as_deref().unwrap_or(PICTURE_SIZE), saved.dpi);
        let size = size.map_err(|error| {
            let key = if matches!(error, SizeError::DotsPerInch(_)) { "dpi" } else { "size" };
            KeyFault::value(key, error.to_string())
        })?;
        let colormap = saved.colormap.as_deref().unwrap_or(PICTURE_COLORMAP).parse();
        let colormap =
            colormap.map_err(|error: UnknownColormap| KeyFault::value("colormap", error.to_string()))?;
        let color_by = saved.color_by.as_deref().map(str::parse).transpose();
        let color_by =
            color_by.map_err(|error: UnknownColorBy| KeyFault::value("color_by", error.to_string()))?;
        let color_by = color_by.unwrap_or_default();
        let ground = saved.ground.as_deref().map(str::parse).transpose();
        let ground = ground.map_err(|error: UnknownGround| KeyFault::value("ground", error.to_string()))?;
        if ground.is_some() && saved.light.is_some() {
            return Err(KeyFault::key("light", "the ground says this already; leave it out."));
        }
        let furniture = saved.furniture.as_deref().map(str::parse).transpose();
        let furniture =
            furniture.map_err(|error: UnknownFurniture| KeyFault::value("furniture", error.to_string()))?;
        let ground = ground.unwrap_or_else(|| theme(saved.light.unwrap_or(false)));
        let edges = saved.edges.unwrap_or(true);
        let look = Self { size, edges, colormap, color_by, ground, furniture, space: None };
        let look = look.in_space(RequestedSpace::of_saved(saved)?);
        match look.levels_only() {
            Some(sentence) => Err(KeyFault::key("color_by", sentence)),
            None => Ok(look),
        }
    }

    /// Returns this look in space, or with `None` that of the plan.
    pub fn in_space(self, space: Option<RequestedSpace>) -> Self {
        Self { space, ..self }
    }

    /// Returns a sentence where other colours than those of levels are asked for, and cannot be.
    pub fn levels_only(&self) -> Option<&'static str> {
        let is_asked = self.is_in_space() && self.color_by != ColorBy::Levels;
        is_asked.then_some("a view in space shows levels; leave it out, or draw the plan.")
    }

    /// Returns whether it is a view in space.
    pub fn is_in_space(&self) -> bool {
        self.space.is_some()
    }

    /// Returns the look of a mesh as files get it.
    ///
    /// # Errors
    /// Fails when it is in space, and no node has a height, and when triangles do not have what they are to
    /// be coloured by.
    pub fn for_extract(&self, finished: &FinishedMesh, extract: &Extract) -> Result<Look, Failure> {
        let space = self.space.map(|space| space.for_extract(finished, extract)).transpose()?;
        let look = self.for_mesh(finished);
        let palette = OverlayPalette::new(self.ground.theme(), look.level_colors.clone());
        let overlay = self.color_by.overlay(finished, extract, &palette, &look.level_colors)?;
        Ok(Look { space, overlay, ..look })
    }

    /// Returns the look of the plan, with the colours spread over the levels of a mesh, and an arrow to the
    /// north in the plane of a projection.
    pub fn for_mesh(&self, finished: &FinishedMesh) -> Look {
        let Self { size, edges, colormap, color_by: _, ground, furniture, space: _ } = *self;
        let mesh = finished.mesh();
        let deepest = mesh.level_counts().len() as u8 - 1;
        let projection = finished.domain().projection;
        Look {
            size,
            edges,
            ground,
            level_colors: LevelColors::new(colormap, ground.theme(), deepest),
            north: Look::north_of(projection.as_ref(), mesh.lattice()),
            furniture,
            place: MapPlace { projection, unit: finished.unit(), degrees: Some(DegreeStyle::default()) },
            space: None,
            overlay: None,
        }
    }
}

/// Returns the ground of a theme.
fn theme(is_light: bool) -> PictureGround {
    if is_light { PictureGround::Light } else { PictureGround::Dark }
}

#[cfg(test)]
mod tests {
    use std::ffi::OsString;

    use super::super::args::{Arguments, Command};
    use super::*;

    fn look(options: &str) -> Result<RequestedLook, String> {
        let words = format!("meshbrush mesh {options}");
        let words: Vec<OsString> = words.split(' ').map(OsString::from).collect();
        let read = Arguments::read(&words).map_err(|error| error.to_string())?;
        let Some(Command::Mesh(typed)) = read.command else { panic!("{options}") };
        RequestedLook::new(&typed.picture).map_err(|failure| failure.to_string())
    }

    #[test]
    fn options_of_pictures_say_the_look() {
        let usual = look("-o m.png").unwrap();
        assert_eq!((usual.size, usual.furniture), (PictureSize::of_width(1600), None));
        assert_eq!(usual.ground, PictureGround::Dark);
        let given = look("--size 6in --dpi 100 --ground transparent --furniture legend,north").unwrap();
        assert_eq!((given.size.width, given.ground), (600, PictureGround::Transparent));
        assert_eq!(given.furniture, Some(Furniture { legend: true, north: true, ..Furniture::NONE }));
        assert_eq!(look("--light").unwrap().ground, PictureGround::Light);
    }

    #[test]
    fn options_of_pictures_are_refused_with_their_names() {
        for (options, sentence) in [
            ("--size 0", "--size 0: write a width"),
            ("--size 9999in", "--size 9999in: 9999 in are"),
            ("--dpi 5", "--dpi: 5 dots per inch are not possible"),
            ("--ground green", "--ground: “green” is no ground"),
            ("--furniture grid", "--furniture: “grid” is none of"),
            ("--color-by angle", "--color-by: “angle” is nothing that triangles can be coloured by"),
            ("--light --ground white", "cannot be used with"),
        ] {
            let refused = look(options).unwrap_err();
            assert!(refused.contains(sentence), "{options}: {refused}");
        }
    }
}
