//! How a picture of a whole mesh looks, and drawing it.

use glam::DVec2;

use super::furniture::{
    Bar, Furniture, Inks, Legend, LevelLegend, MapAxes, NoRoom, Sheet, SheetContent, SheetRequest, SpaceAxes,
    draw_sheet, without_premultiplication,
};
use super::north_arrow::{ArrowLines, north_arrow_in};
use super::overlay::PictureOverlay;
use super::picture_size::{LARGEST_PICTURE, PictureGround, PictureSize};
use super::space_look::SpaceLook;
use super::{Image, software};
use crate::colormap::{Ground, LevelColors};
use crate::scene::{Camera, Style};
use meshbrush_core::earth::{DegreeStyle, EarthPlane, Projection, graticule};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Extract, Mesh};
use meshbrush_mesh::text::LengthUnit;

/// The appearance of a picture of a whole mesh.
#[derive(Clone, Debug)]
pub struct Look {
    /// Width and height.
    pub size: PictureSize,
    /// Whether edges are drawn.
    pub edges: bool,
    /// The background.
    pub ground: PictureGround,
    /// Colour of each level.
    pub level_colors: LevelColors,
    /// The direction to the north in the middle of the picture, for an arrow; y points up.
    pub north: Option<DVec2>,
    /// What stands around the map. With `None` the map fills the picture, with an arrow to the north over it.
    pub furniture: Option<Furniture>,
    /// What coordinates and lengths are.
    pub place: MapPlace,
    /// The view in space; the plan without it.
    pub space: Option<SpaceLook>,
    /// What colours the triangles of the plan in place of their levels.
    pub overlay: Option<PictureOverlay>,
}

/// What coordinates and lengths of a map are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapPlace {
    /// The projection of its plane.
    pub projection: Option<Projection>,
    /// The unit of the plane.
    pub unit: LengthUnit,
    /// How longitudes and latitudes are written, where the map lies on the Earth; `None` for coordinates of
    /// the plane.
    pub degrees: Option<DegreeStyle>,
}

impl MapPlace {
    fn earth(&self) -> Option<EarthPlane> {
        EarthPlane::new(self.projection, self.unit)
    }

    fn axes(&self, lattice: &Lattice) -> MapAxes {
        match self.earth().zip(self.degrees) {
            Some((plane, style)) => MapAxes::Earth(graticule(plane, lattice.bounds(), style)),
            None => MapAxes::Plane(self.unit),
        }
    }

    /// Returns what a scale bar in the middle of a map measures: on the Earth lengths on the ground.
    fn bar(&self, lattice: &Lattice) -> Bar {
        let middle = lattice.bounds().center();
        match self.earth() {
            None => Bar { world_per_length: 1.0, unit: self.unit },
            Some(EarthPlane::Projected(projection)) => {
                Bar { world_per_length: projection.scale_in_plane(middle), unit: LengthUnit::Metre }
            }
            Some(plane @ EarthPlane::Degrees) => {
                let half = DVec2::new(HALF_PIECE, 0.0);
                let metres = plane.length(&[middle - half, middle + half]);
                Bar { world_per_length: 2.0 * HALF_PIECE / metres, unit: LengthUnit::Metre }
            }
        }
    }
}

/// Half the length of the piece of a parallel that gives the scale in degrees: 111 m at the equator.
const HALF_PIECE: f64 = 1e-3;
/// Height of text on paper, in inches: 8 points.
const TEXT_INCHES: f64 = 8.0 / 72.0;
/// Height of text as a share of the mean side of a picture of pixels, and the least, in pixels.
const TEXT: (f64, f64) = (1.0 / 85.0, 11.0);
/// Colours of a path over a mesh, and of the wider line under it.
pub(super) const PATH_COLORS: [[u8; 3]; 2] = [[0xff, 0xff, 0xff], [0xc8, 0x1e, 0x4a]];
/// Widths of the lines of [`PATH_COLORS`] in pixels.
const PATH_WIDTHS: [f32; 2] = [4.0, 8.0];
/// Widths of the lines of an arrow to the north and of those below them, in pixels.
const ARROW_WIDTHS: [f32; 2] = [2.0, 5.0];

impl Look {
    /// Returns the direction to the north in the middle of a picture of a mesh in the plane of a projection.
    pub fn north_of(projection: Option<&Projection>, lattice: &Lattice) -> Option<DVec2> {
        projection?.north_at(lattice.bounds().center())
    }

    /// Returns a direction of the plane as it is in the picture.
    fn turned(&self, lattice: &Lattice, direction: DVec2) -> DVec2 {
        match &self.space {
            Some(space) => space.view_in(lattice, [1000; 2]).camera.turned_direction(direction),
            None => direction,
        }
    }

    /// Returns the lines of the arrow to the north over the map, if there is one.
    pub(super) fn arrow(&self, lattice: &Lattice) -> ArrowLines {
        let north = self.north.filter(|_| self.furniture.is_none());
        let lines = |north| north_arrow_in(self.bare_size(lattice), self.turned(lattice, north));
        north.map_or_else(Vec::new, lines)
    }

    /// Returns the colours of the arrow and of the lines below it.
    pub(super) fn arrow_colors(&self) -> [[u8; 3]; 2] {
        let own = match self.ground.theme() {
            Ground::Dark => [0xff; 3],
            Ground::Light => [0x10; 3],
        };
        [own, self.ground.color()]
    }

    /// Returns the height of the map as a share of its width.
    fn proportion(&self, lattice: &Lattice) -> f64 {
        let extent = lattice.bounds().size();
        self.space.as_ref().map_or(extent.y / extent.x, |space| space.proportion(lattice))
    }

    /// Returns width and height of a picture without furniture.
    pub(super) fn bare_size(&self, lattice: &Lattice) -> [u32; 2] {
        let PictureSize { width, height, .. } = self.size;
        let in_proportion = || (f64::from(width) * self.proportion(lattice)).round();
        let height = height.unwrap_or_else(|| in_proportion().clamp(1.0, f64::from(LARGEST_PICTURE)) as u32);
        [width, height]
    }

    /// Returns the camera of the plan for a map of a size in pixels.
    pub(super) fn camera(lattice: &Lattice, size: [u32; 2]) -> Camera {
        Camera::fit(lattice, lattice.bounds(), size, 0.0)
    }

    /// Returns the picture of a mesh. `extract` must be the extract of `mesh`.
    ///
    /// # Errors
    /// Fails when the picture is too small for its furniture.
    pub fn draw(&self, mesh: &Mesh, extract: &Extract) -> Result<Image, NoRoom> {
        self.draw_with_path(mesh, extract, &[])
    }

    /// Returns the picture of a mesh with a path over it, in world units.
    ///
    /// # Errors
    /// Fails as [`Self::draw`] does.
    pub(super) fn draw_with_path(
        &self,
        mesh: &Mesh,
        extract: &Extract,
        path: &[DVec2],
    ) -> Result<Image, NoRoom> {
        let lattice = mesh.lattice();
        let sheet = self.sheet(mesh, extract)?;
        let size = sheet.as_ref().map_or_else(|| self.bare_size(lattice), |sheet| sheet.map_size);
        let mut map = self.draw_map(mesh, extract, size);
        let arrow = self.arrow(lattice);
        for n in [1, 0] {
            for line in &arrow {
                let points: Vec<_> = line.iter().map(|at| at.as_vec2()).collect();
                software::draw_line(&mut map, &points, self.arrow_colors()[n], ARROW_WIDTHS[n]);
            }
        }
        let camera = Self::camera(lattice, size);
        let points: Vec<_> = path.iter().map(|&p| camera.screen_from_world(p).as_vec2()).collect();
        for n in [1, 0] {
            software::draw_line(&mut map, &points, PATH_COLORS[n], PATH_WIDTHS[n]);
        }
        let picture = match &sheet {
            Some(sheet) => draw_sheet(sheet, &map, self.ground.rgba()),
            None => map,
        };
        Ok(if self.ground.is_transparent() { without_premultiplication(picture) } else { picture })
    }

    /// Returns the map alone.
    fn draw_map(&self, mesh: &Mesh, extract: &Extract, size: [u32; 2]) -> Image {
        let lattice = mesh.lattice();
        let colors = self.level_colors.clone();
        let style = match self.ground.theme() {
            Ground::Dark => Style::dark(colors),
            Ground::Light => Style::light(colors),
        };
        let style = Style { edges: self.edges, ground: self.ground.rgba(), ..style };
        if let Some(space) = &self.space {
            let view = space.view_in(lattice, size);
            return software::draw_extract_in_space(extract, &space.heights, &view, &style);
        }
        let camera = Self::camera(lattice, size);
        match &self.overlay {
            Some(overlay) => {
                let mut map = Self::draw_overlay(overlay, mesh, extract, &camera, style);
                put_below(&mut map, self.ground.rgba());
                map
            }
            None => Self::draw_plan(mesh, extract, &camera, &style),
        }
    }

    fn draw_plan(mesh: &Mesh, extract: &Extract, camera: &Camera, style: &Style) -> Image {
        match extract.is_patched() {
            true => software::draw_extract(extract, camera, style),
            false => software::draw(mesh, camera, style, None, &[]),
        }
    }

    /// Returns the plan in the colours of an overlay, with nothing below the mesh.
    fn draw_overlay(
        overlay: &PictureOverlay,
        mesh: &Mesh,
        extract: &Extract,
        camera: &Camera,
        style: Style,
    ) -> Image {
        let style = Style { ground: [0; 4], ..style.under(overlay.neutral) };
        let mut map = Self::draw_plan(mesh, extract, camera, &style);
        let colors = overlay.on_map(extract.view(), camera.visible_world(), camera.size_px());
        software::multiply_by(&mut map, camera, &colors.as_overlay());
        map
    }

    /// Returns the overlay that the picture shows: a view in space shows levels.
    pub(super) fn shown_overlay(&self) -> Option<&PictureOverlay> {
        self.overlay.as_ref().filter(|_| self.space.is_none())
    }

    /// Returns the fills of the plan in the colours of an overlay, without edges and with nothing below them.
    pub(super) fn fills_in_pixels(
        &self,
        overlay: &PictureOverlay,
        mesh: &Mesh,
        extract: &Extract,
        size: [u32; 2],
    ) -> Image {
        let style = Style { edges: false, ..Style::light(self.level_colors.clone()) };
        let camera = Self::camera(mesh.lattice(), size);
        Self::draw_overlay(overlay, mesh, extract, &camera, style)
    }

    /// Returns the places of map and furniture; `None` where the map fills the picture.
    ///
    /// # Errors
    /// Fails when the picture is too small for its furniture.
    pub(super) fn sheet(&self, mesh: &Mesh, extract: &Extract) -> Result<Option<Sheet>, NoRoom> {
        let Some(furniture) = self.furniture.filter(|furniture| !furniture.is_none()) else {
            return Ok(None);
        };
        let lattice = mesh.lattice();
        let camera = |size: [u32; 2]| match &self.space {
            Some(space) => *space.view_in(lattice, size).camera.plan(),
            None => Self::camera(lattice, size),
        };
        let request = SheetRequest {
            width: self.size.width,
            height: self.size.height,
            most_height: LARGEST_PICTURE,
            proportion: self.proportion(lattice),
            text_px: self.text_px(lattice),
            camera: &camera,
        };
        Sheet::lay_out(&request, &self.content(furniture, mesh, extract)).map(Some)
    }

    /// Returns the direction to the north in the plane, where the document lies on the Earth.
    fn direction_to_north(&self) -> Option<DVec2> {
        let is_degrees = self.place.earth() == Some(EarthPlane::Degrees);
        self.north.or(is_degrees.then_some(DVec2::Y))
    }

    /// Returns a sentence about furniture that was asked for by name, and that the picture cannot have.
    pub fn missing_furniture(&self) -> Option<&'static str> {
        // Who asks for all means all that there is.
        let furniture = self.furniture.filter(|furniture| *furniture != Furniture::ALL)?;
        let lacks_north = furniture.north && self.direction_to_north().is_none();
        lacks_north.then_some("There is no arrow to the north: the document does not lie on the Earth.")
    }

    fn content(&self, furniture: Furniture, mesh: &Mesh, extract: &Extract) -> SheetContent {
        let lattice = mesh.lattice();
        let north = self.direction_to_north().filter(|_| furniture.north);
        let axes = furniture.axes.then(|| self.place.axes(lattice));
        SheetContent {
            legend: furniture.legend.then(|| match self.shown_overlay() {
                Some(overlay) => overlay.legend.clone(),
                None => self.legend(mesh, extract),
            }),
            axes: axes.clone().filter(|_| self.space.is_none()),
            space_axes: axes.zip(self.space.clone()).map(|(axes, space)| SpaceAxes {
                space,
                axes,
                lattice: *lattice,
            }),
            bar: furniture.scale.then(|| self.place.bar(lattice)),
            north: north.map(|north| self.turned(lattice, north)),
            inks: Inks::on(self.ground.theme()),
        }
    }

    fn legend(&self, mesh: &Mesh, extract: &Extract) -> Legend {
        let levels = LevelLegend::new(&extract.level_counts(), |level| mesh.diameter(level), self.place.unit);
        Legend::of_levels(levels, &self.level_colors)
    }

    /// Returns the height of the text around a map, in pixels.
    fn text_px(&self, lattice: &Lattice) -> f64 {
        if let Some(paper) = self.size.on_paper {
            return TEXT_INCHES * paper.dots_per_inch;
        }
        let [width, height] = self.bare_size(lattice).map(f64::from);
        (TEXT.0 * (width * height).sqrt()).max(TEXT.1)
    }
}

/// Puts a colour where a picture has nothing.
fn put_below(image: &mut Image, ground: [u8; 4]) {
    let blank = image.pixels_mut().iter_mut().filter(|[.., opacity]| *opacity == 0);
    blank.for_each(|pixel| *pixel = ground);
}
