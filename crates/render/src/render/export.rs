//! Exports a mesh: with its data, or as a picture of the whole mesh.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::north_arrow::{ArrowLines, north_arrow_in};
use super::{Image, software};
use crate::colormap::{Ground, LevelColors};
use crate::scene::{Camera, Light, NodeHeights, SpaceCamera, SpaceView, Style, ViewDirection};
use meshbrush_core::earth::Projection;
use meshbrush_io::io::{
    MeshData, MeshFormat, Meter, Provenance, ThirdCoordinate, png, svg, write_file_metered,
};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Extract, Mesh};

/// Greatest width and height of a picture, in pixels.
pub const LARGEST_PICTURE: u32 = 16_384;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExportFormat {
    /// The mesh with its data.
    Mesh(MeshFormat),
    /// A vector picture.
    Svg,
    /// A pixel picture.
    Png,
}

/// The error for a file name whose ending belongs to no format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: the ending chooses the format; use one of{}", .0.display(), with_dots())]
pub struct UnknownEnding(pub PathBuf);

fn with_dots() -> String {
    ExportFormat::endings().map(|ending| format!(" .{ending}")).collect()
}

impl ExportFormat {
    /// Returns the format that the ending of a file name chooses; upper and lower case are the same.
    ///
    /// # Errors
    /// Fails when the ending is none of [`Self::endings`].
    pub fn from_path(path: &Path) -> Result<Self, UnknownEnding> {
        let found = match ending_of(path).as_str() {
            "svg" => Some(Self::Svg),
            "png" => Some(Self::Png),
            ending => MeshFormat::from_ending(ending).map(Self::Mesh),
        };
        found.ok_or_else(|| UnknownEnding(path.to_owned()))
    }

    /// Returns the format with a name, [`Self::name`], or else with an ending, without the dot; upper and
    /// lower case are the same.
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        Self::all().find(|format| format.name() == name).or_else(|| MeshFormat::named(&name).map(Self::Mesh))
    }

    /// Returns whether a file with this name may be one of this format: its ending is one of the format's
    /// endings, which may choose another format by itself, or that of no format.
    pub fn fits(self, path: &Path) -> bool {
        let own = match self {
            Self::Mesh(format) => format.may_end_in(&ending_of(path)),
            Self::Svg | Self::Png => Self::from_path(path) == Ok(self),
        };
        own || Self::from_path(path).is_err()
    }

    /// Returns the binary form of this format, or `None` if it has no separate one.
    pub fn binary(self) -> Option<Self> {
        match self {
            Self::Mesh(format) => format.binary().map(Self::Mesh),
            Self::Svg | Self::Png => None,
        }
    }

    /// Returns all formats; formats of meshes come first.
    pub fn all() -> impl Iterator<Item = Self> {
        MeshFormat::all().map(Self::Mesh).chain([Self::Svg, Self::Png])
    }

    /// Returns the name of this format: its default ending, or another word, as `fvcom` and `ugrid`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.name(),
            Self::Svg | Self::Png => self.ending(),
        }
    }

    /// Returns the default ending of file names of this format, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.ending(),
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }

    /// Returns a few words on the contents of the format and the programs that read it.
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.purpose(),
            Self::Svg => "A vector picture of the whole mesh in the present colours",
            Self::Png => "A picture of the whole mesh in the present colours",
        }
    }

    /// Returns the approximate size of the export of a mesh in bytes, over all its files; `None` for a
    /// picture, whose size depends on its contents.
    pub fn approximate_bytes(self, triangles: usize) -> Option<u64> {
        match self {
            Self::Mesh(format) => Some(format.approximate_bytes(triangles)),
            Self::Svg | Self::Png => None,
        }
    }

    /// Returns all endings that choose a format, without their dots.
    pub fn endings() -> impl Iterator<Item = &'static str> {
        MeshFormat::all().flat_map(MeshFormat::endings).chain([Self::Svg, Self::Png].map(Self::ending))
    }

    /// Returns the names of all formats.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::all().map(Self::name)
    }

    /// Returns whether the format contains data at the nodes.
    pub fn wants_node_data(self) -> bool {
        matches!(self, Self::Mesh(_))
    }

    /// Returns whether h̄ at the nodes is in its files.
    pub fn has_targets(self) -> bool {
        matches!(self, Self::Mesh(format) if format.has_targets())
    }

    /// Returns whether a coastal solver finds its open boundary in its files.
    pub fn has_open_boundary(self) -> bool {
        matches!(self, Self::Mesh(format) if format.has_open_boundary())
    }

    /// Returns what the third coordinate of nodes in its files is.
    pub fn third_coordinate(self) -> ThirdCoordinate {
        match self {
            Self::Mesh(format) => format.third_coordinate(),
            Self::Svg | Self::Png => ThirdCoordinate::None,
        }
    }

    /// Returns all files that an export to `path` writes. The first is `path`, or for FVCOM the one beside it
    /// that ends in `_grd.dat`.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        match self {
            Self::Mesh(format) => format.files(path),
            Self::Svg | Self::Png => vec![path.to_owned()],
        }
    }

    /// Writes the file, or all files of a format that has several, and returns their names. `extract` must be
    /// the extract of `mesh`, and `data` the data of its nodes; a picture needs only the provenance.
    ///
    /// # Errors
    /// Fails when a file cannot be written, the format cannot hold the mesh, or the meter was cancelled.
    /// Existing files are then unchanged.
    pub fn write(
        self,
        path: &Path,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> io::Result<Vec<PathBuf>> {
        if let Self::Mesh(format) = self {
            return format.write(path, extract, data, meter);
        }
        write_file_metered(path, meter, |out| self.write_to(out, mesh, extract, data, look, meter))?;
        Ok(vec![path.to_owned()])
    }

    /// Writes to a stream in place of the file of [`Self::write`].
    ///
    /// # Errors
    /// Fails when the format has several files, when the stream fails, and when the meter was cancelled.
    pub fn write_to(
        self,
        out: &mut dyn io::Write,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> io::Result<()> {
        match self {
            Self::Mesh(format) => {
                let several = || io::Error::other("the format has several files");
                format.write_to(out, extract, data, meter).ok_or_else(several)?
            }
            Self::Svg if look.space.is_some() => Err(io::Error::other(NO_SVG_IN_SPACE)),
            Self::Svg => {
                let arrow = look.arrow(mesh.lattice());
                let style = svg::SvgStyle { marks: &arrow, ..look.for_svg(mesh.lattice()) };
                svg::write(&mut meter.count(out), extract, &style, data.provenance)
            }
            Self::Png => {
                let picture = look.draw(mesh, extract);
                meter.check()?;
                png::write_described(&mut meter.count(out), picture.size, &picture.rgba, data.provenance)
            }
        }
    }
}

/// Colours of a path over a mesh, and of the wider line under it.
const PATH_COLORS: [[u8; 3]; 2] = [[0xff, 0xff, 0xff], [0xc8, 0x1e, 0x4a]];
/// Widths of the lines of [`PATH_COLORS`] in pixels.
const PATH_WIDTHS: [f32; 2] = [4.0, 8.0];

impl ExportFormat {
    /// Writes a picture of a mesh with a path over it, in world units.
    ///
    /// # Errors
    /// Fails when this is not a picture format, when the stream fails, and when the meter was cancelled.
    pub fn write_path_to(
        self,
        out: &mut dyn io::Write,
        (mesh, extract): (&Mesh, &Extract),
        path: &[DVec2],
        look: &Look,
        provenance: &Provenance,
        meter: &Meter,
    ) -> io::Result<()> {
        match self {
            Self::Mesh(_) => Err(io::Error::other("the format is no picture")),
            Self::Svg | Self::Png if look.space.is_some() => {
                Err(io::Error::other("pictures of paths show the plan; leave out the view in space"))
            }
            Self::Svg => {
                let (arrow, style) = (look.arrow(mesh.lattice()), look.for_svg(mesh.lattice()));
                let style = svg::SvgStyle { path, path_colors: PATH_COLORS, marks: &arrow, ..style };
                svg::write(&mut meter.count(out), extract, &style, provenance)
            }
            Self::Png => {
                let mut picture = look.draw(mesh, extract);
                let camera = look.camera(mesh.lattice());
                let points: Vec<_> = path.iter().map(|&p| camera.screen_from_world(p).as_vec2()).collect();
                for n in [1, 0] {
                    software::draw_line(&mut picture, &points, PATH_COLORS[n], PATH_WIDTHS[n]);
                }
                meter.check()?;
                png::write_described(&mut meter.count(out), picture.size, &picture.rgba, provenance)
            }
        }
    }
}

/// Why an `.svg` shows no view in space.
pub const NO_SVG_IN_SPACE: &str =
    "a view in space is drawn pixel by pixel, and .svg holds no pixels; write a .png, or the plan";

fn ending_of(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// The appearance of a picture of a whole mesh.
#[derive(Clone, Debug)]
pub struct Look {
    /// Width in pixels, at most [`LARGEST_PICTURE`].
    pub width: u32,
    /// Height in pixels, at most [`LARGEST_PICTURE`]. With `None` it follows from the width and the
    /// proportions of the domain.
    pub height: Option<u32>,
    /// Whether edges are drawn.
    pub edges: bool,
    /// The background.
    pub ground: Ground,
    /// Colour of each level.
    pub level_colors: LevelColors,
    /// The direction to the north in the middle of the picture, for an arrow; y points up.
    pub north: Option<DVec2>,
    /// The view in space; the plan without it.
    pub space: Option<SpaceLook>,
}

/// The appearance of a picture in space.
#[derive(Clone, Debug)]
pub struct SpaceLook {
    /// From where.
    pub direction: ViewDirection,
    /// In which light.
    pub light: Light,
    /// World units that a unit of height has in the picture.
    pub exaggeration: f64,
    /// World units that a unit of height has in truth.
    pub metre: f64,
    /// The heights of the nodes of the extract.
    pub heights: Arc<NodeHeights>,
}

/// Space around a picture in space, as a share of its shorter side.
const SPACE_MARGIN: f64 = 0.04;
/// The minimum and the maximum height of a picture in space, as shares of its width.
const SPACE_PROPORTIONS: [f64; 2] = [0.25, 2.0];

impl SpaceLook {
    /// Returns the appearance of a surface over a lattice. Heights are multiplied by `factor`; without one,
    /// so that relief is visible. `metre` is [`Self::metre`].
    pub fn new(
        (direction, light): (ViewDirection, Light),
        factor: Option<f64>,
        metre: f64,
        heights: NodeHeights,
        lattice: &Lattice,
    ) -> Self {
        let default = || SpaceCamera::visible_exaggeration(lattice.bounds(), heights.relief());
        let exaggeration = factor.map_or_else(default, |factor| factor * metre);
        Self { direction, light, exaggeration, metre, heights: Arc::new(heights) }
    }

    /// Returns the whole surface over a lattice in a picture of a size, in pixels.
    fn view(&self, lattice: &Lattice, size: [u32; 2], margin_px: f64) -> SpaceView {
        let surface = (self.heights.scale, self.heights.ends());
        let camera = SpaceCamera::fit(lattice, surface, self.direction, self.exaggeration, size, margin_px);
        SpaceView { camera, light: self.light }
    }

    /// Returns the height of a picture as a share of its width.
    fn proportion(&self, lattice: &Lattice) -> f64 {
        let size = self.view(lattice, [1000; 2], 0.0).camera.box_px();
        (size.y / size.x).clamp(SPACE_PROPORTIONS[0], SPACE_PROPORTIONS[1])
    }
}

/// Widths of the lines of an arrow to the north and of those below them, in pixels.
const ARROW_WIDTHS: [f32; 2] = [2.0, 5.0];

impl Look {
    /// Default width in pixels.
    pub const WIDTH: u32 = 1600;

    /// Returns the direction to the north in the middle of a picture of a mesh in the plane of a projection.
    pub fn north_of(projection: Option<&Projection>, lattice: &Lattice) -> Option<DVec2> {
        projection?.north_at(lattice.bounds().center())
    }

    /// Returns the lines of the arrow to the north, if there is one.
    fn arrow(&self, lattice: &Lattice) -> ArrowLines {
        let turned = |north| match &self.space {
            Some(space) => space.view(lattice, [1000; 2], 0.0).camera.turned_direction(north),
            None => north,
        };
        self.north.map_or_else(Vec::new, |north| north_arrow_in(self.size(lattice), turned(north)))
    }

    /// Returns the colours of the arrow and of the lines below it.
    fn arrow_colors(&self) -> [[u8; 3]; 2] {
        let own = match self.ground {
            Ground::Dark => [0xff; 3],
            Ground::Light => [0x10; 3],
        };
        [own, self.ground.canvas()]
    }

    fn size(&self, lattice: &Lattice) -> [u32; 2] {
        let extent = lattice.bounds().size();
        let proportion = || match &self.space {
            Some(space) => space.proportion(lattice),
            None => extent.y / extent.x,
        };
        let in_proportion = || (f64::from(self.width) * proportion()).round();
        let height =
            self.height.unwrap_or_else(|| in_proportion().clamp(1.0, f64::from(LARGEST_PICTURE)) as u32);
        [self.width, height]
    }

    fn camera(&self, lattice: &Lattice) -> Camera {
        Camera::fit(lattice, lattice.bounds(), self.size(lattice), 0.0)
    }

    /// Returns the picture of a mesh. `extract` must be the extract of `mesh`.
    pub fn draw(&self, mesh: &Mesh, extract: &Extract) -> Image {
        let lattice = mesh.lattice();
        let camera = self.camera(lattice);
        let colors = self.level_colors.clone();
        let style = match self.ground {
            Ground::Dark => Style::dark(colors),
            Ground::Light => Style::light(colors),
        };
        let style = Style { edges: self.edges, ..style };
        let mut picture = if let Some(space) = &self.space {
            let size = self.size(lattice);
            let margin_px = SPACE_MARGIN * f64::from(size[0].min(size[1]));
            let view = space.view(lattice, size, margin_px);
            software::draw_extract_in_space(extract, &space.heights, &view, &style)
        } else if extract.is_patched() {
            software::draw_extract(extract, &camera, &style)
        } else {
            software::draw(mesh, &camera, &style, None, &[])
        };
        let arrow = self.arrow(lattice);
        for n in [1, 0] {
            for line in &arrow {
                let points: Vec<_> = line.iter().map(|at| at.as_vec2()).collect();
                software::draw_line(&mut picture, &points, self.arrow_colors()[n], ARROW_WIDTHS[n]);
            }
        }
        picture
    }

    fn for_svg(&self, lattice: &Lattice) -> svg::SvgStyle<'_> {
        svg::SvgStyle {
            size: self.size(lattice),
            level_colors: self.level_colors.as_table(),
            background: self.ground.canvas(),
            edges: self.edges,
            path: &[],
            path_colors: [[0; 3]; 2],
            marks: &[],
            mark_colors: self.arrow_colors(),
        }
    }
}
