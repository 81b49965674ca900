//! How the document is looked at. Nothing here changes it.

mod field_overlay;
mod space;

use egui::{Context, Theme, ThemePreference};
use glam::DVec2;

pub use super::canvas_aids::{CanvasAid, CanvasAids};
pub use field_overlay::FieldOverlay;
pub use space::Space;

use super::Tab;
use super::command::{InterfaceScale, ViewCommand};
use super::coordinates::CoordinateStyle;
use super::dock::Dock;
use super::file_coordinates::FileCoordinates;
use super::picture_choices::{PictureChoices, PictureColors};
use super::presentation::Presentation;
use super::readout::Quantity;
use meshbrush_core::document::Settings;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{TriangleId, level_for_diameter};
use meshbrush_render::colormap::{Colormap, Ground, LevelColors};
use meshbrush_render::render::look::{Look, MapPlace};
use meshbrush_render::scene::{Camera, SpaceCamera, Style};
use meshbrush_ui::widgets::{format, reveal};

/// The least radius of the brush where the whole domain is in sight, as a share of its longer side.
const LEAST_BRUSH_SHARE: f64 = 1e-4;

/// The size in pixels at which something that is gone to can be seen.
const SEEN_PX: f64 = 60.0;

/// The contents of the window and their appearance.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera of the canvas; `None` until its size is known, and after "fit".
    pub camera: Option<Camera>,
    /// Whether the view shows the whole domain and was not moved since: it then follows the size of the
    /// window.
    pub is_fitted: bool,
    /// Bounds of a domain, and the area of it that is shown once its mesh is there.
    pub wanted_area: Option<[Rect; 2]>,
    /// Colours of the levels.
    pub colormap: Colormap,
    /// Dark or light.
    pub ground: Ground,
    /// Whether edges are drawn.
    pub edges: bool,
    /// The field that is drawn over the mesh.
    pub overlay: FieldOverlay,
    /// The aids to orientation that are shown.
    pub aids: CanvasAids,
    /// The coordinates that places are written in.
    pub coordinates: CoordinateStyle,
    /// The coordinates of exported meshes.
    pub file_coordinates: FileCoordinates,
    /// How exported pictures look.
    pub picture: PictureChoices,
    /// Whether the panels are shown.
    pub panels: bool,
    /// Whether menus, status and panels surround the canvas: not in a page that embeds it.
    pub surrounds: bool,
    /// Whether the strip of the tool is above the canvas.
    pub strip: bool,
    /// Which tab of the lower dock is shown.
    pub dock: Dock,
    /// The mode for a projector, while it is on.
    pub presentation: Option<Presentation>,
    /// A level that is shown alone, while the pointer is on it in the legend.
    pub lone_level: Option<u32>,
    /// Bit ℓ: whether level ℓ is hidden on the canvas.
    pub hidden_levels: u64,
    /// A neighbour of the queried triangle, while the pointer is on it in the inspector.
    pub hovered_neighbour: Option<TriangleId>,
    /// The quantity that the inspector interpolates.
    pub quantity: Quantity,
    /// The name of the panel that is opened and scrolled to in this frame.
    pub revealed_panel: Option<&'static str>,
    /// Dark, light, or as the desktop has it.
    pub theme: ThemePreference,
    /// The view in space.
    pub space: Space,
}

impl Default for View {
    fn default() -> Self {
        Self {
            camera: None,
            is_fitted: true,
            wanted_area: None,
            colormap: Colormap::Viridis,
            ground: Ground::Dark,
            edges: true,
            overlay: FieldOverlay::None,
            aids: CanvasAids::default(),
            coordinates: CoordinateStyle::default(),
            file_coordinates: FileCoordinates::default(),
            picture: PictureChoices::default(),
            panels: true,
            surrounds: true,
            strip: true,
            dock: Dock::default(),
            presentation: None,
            lone_level: None,
            hidden_levels: 0,
            hovered_neighbour: None,
            quantity: Quantity::TargetDiameter,
            revealed_panel: None,
            theme: ThemePreference::Dark,
            space: Space::default(),
        }
    }
}

impl View {
    /// Returns the colours of all levels. They span the levels that the settings can ask for, not those of
    /// the present mesh, so that a level keeps its colour while the user paints.
    pub fn level_colors(&self, settings: &Settings) -> LevelColors {
        LevelColors::new(self.colormap, self.ground, deepest_level(settings))
    }

    /// How a mesh is drawn on a screen with `px_per_point` pixels for a point. `triangles` is their number,
    /// or 0 where none are to be merged.
    pub fn style(&self, settings: &Settings, triangles: usize, px_per_point: f32) -> Style {
        let colors = self.level_colors(settings);
        let style = match self.ground {
            Ground::Dark => Style::dark(colors),
            Ground::Light => Style::light(colors),
        };
        // A hidden level stays hidden under the pointer: a click on its row shows what it does.
        let shown_levels = match self.lone_level.map(bit_of) {
            Some(lone) if lone & self.hidden_levels == 0 => lone,
            _ => !self.hidden_levels,
        };
        // Edges and highlights stay sharp over the picture.
        let fill_opacity = settings.background.as_ref().map_or(1.0, |picture| 1.0 - picture.opacity as f32);
        let style = Style { edges: self.edges, shown_levels, fill_opacity, ..style };
        style.for_triangles(triangles).at_density(px_per_point)
    }

    /// How a picture of the whole mesh looks in a file.
    pub fn picture_of(&self, settings: &Settings) -> Look {
        let (projection, lattice) = (settings.domain.projection, settings.lattice().ok());
        let degrees = match self.coordinates {
            CoordinateStyle::Geographic(style) => Some(style),
            CoordinateStyle::Plane => None,
        };
        let ground = self.picture.ground_in(self.ground);
        Look {
            size: self.picture.size(),
            edges: self.edges,
            ground,
            level_colors: LevelColors::new(self.colormap, ground.theme(), deepest_level(settings)),
            north: lattice.and_then(|lattice| Look::north_of(projection.as_ref(), &lattice)),
            furniture: Some(self.picture.furniture),
            place: MapPlace { projection, unit: settings.unit, degrees },
            space: None,
            overlay: None,
        }
    }

    /// Returns the overlay that an exported picture of the mesh shows: that of the canvas, unless levels are
    /// chosen for pictures. A view in space shows levels.
    pub fn overlay_of_pictures(&self) -> FieldOverlay {
        match self.picture.colors {
            PictureColors::AsShown if !self.space.is_on => self.overlay,
            PictureColors::AsShown | PictureColors::Levels => FieldOverlay::None,
        }
    }

    /// Returns what is left when another document is opened: only what is named here, which is how a person
    /// has arranged the window.
    pub fn for_next_document(self) -> Self {
        Self {
            colormap: self.colormap,
            ground: self.ground,
            edges: self.edges,
            aids: CanvasAids { picture_corners: false, ..self.aids },
            coordinates: self.coordinates,
            picture: self.picture,
            panels: self.panels,
            surrounds: self.surrounds,
            strip: self.strip,
            dock: self.dock,
            presentation: self.presentation,
            quantity: self.quantity,
            theme: self.theme,
            ..Self::default()
        }
    }

    /// Runs a command about the view.
    pub fn execute(&mut self, command: ViewCommand, ctx: &Context) {
        match command {
            ViewCommand::Fit => self.fit(),
            ViewCommand::LookAt(point) => self.move_camera(|camera| camera.centered_on(point)),
            ViewCommand::GoTo(point, size) => self.go_to(point, size, SEEN_PX),
            ViewCommand::ShowArea(area) => self.show_area(area),
            ViewCommand::ShowAreaOf(bounds, area) => self.wanted_area = Some([bounds, area]),
            ViewCommand::Zoom(factor) => {
                let about_middle = |camera: SpaceCamera| camera.zoomed(factor, camera.plan().half_size_px());
                self.move_view(|camera| camera.zoomed(factor, camera.half_size_px()), about_middle);
            }
            ViewCommand::ZoomAt(factor, px) => {
                self.move_view(|camera| camera.zoomed(factor, px), |camera| camera.zoomed(factor, px));
            }
            ViewCommand::Pan(delta_px) => {
                self.move_view(|camera| camera.panned(delta_px), |camera| camera.panned(delta_px));
            }
            ViewCommand::ToggleEdges => self.edges = !self.edges,
            ViewCommand::ToggleAid(aid) => self.aids.toggle(aid),
            ViewCommand::SetOverlay(overlay) => self.overlay = overlay,
            ViewCommand::Colormap(map) => self.colormap = map,
            ViewCommand::Coordinates(style) => self.coordinates = style,
            ViewCommand::FileCoordinates(coordinates) => self.file_coordinates = coordinates,
            ViewCommand::Picture(choices) => self.picture = choices,
            ViewCommand::ShowLevel(level) => self.lone_level = level,
            ViewCommand::ToggleLevel(level) => self.hidden_levels ^= bit_of(level),
            ViewCommand::IsolateLevel(level) if self.hidden_levels == !bit_of(level) => {
                self.hidden_levels = 0
            }
            ViewCommand::IsolateLevel(level) => self.hidden_levels = !bit_of(level),
            ViewCommand::ShowAllLevels => self.hidden_levels = 0,
            ViewCommand::HighlightNeighbour(id) => self.hovered_neighbour = id,
            ViewCommand::Theme(theme) => self.set_theme(theme, ctx),
            ViewCommand::Reveal(place) => {
                (self.panels, self.revealed_panel) = (true, Some(place.panel));
                reveal(ctx, place.section, place.control);
            }
            ViewCommand::TogglePanels => self.toggle_panels(),
            ViewCommand::ShowTab(tab) => self.show_tab(tab),
            ViewCommand::TogglePresentation => self.toggle_presentation(ctx),
            ViewCommand::Scale(InterfaceScale::Larger) => egui::gui_zoom::zoom_in(ctx),
            ViewCommand::Scale(InterfaceScale::Smaller) => egui::gui_zoom::zoom_out(ctx),
            ViewCommand::Scale(InterfaceScale::Normal) => ctx.set_zoom_factor(1.0),
            ViewCommand::Space(command) => self.change_space(command),
        }
    }

    /// Shows the depths of a document that has them, and no overlay of depths in one that has none.
    pub fn show_depths(&mut self, has_depths: bool) {
        let shows_them = matches!(self.overlay, FieldOverlay::Depth | FieldOverlay::DepthError);
        self.overlay = match (has_depths, shows_them) {
            (true, false) => FieldOverlay::Depth,
            (false, true) => FieldOverlay::None,
            _ => self.overlay,
        };
    }

    /// Shows the whole domain, also when the window gets another size, until the view is moved.
    pub fn fit(&mut self) {
        (self.camera, self.is_fitted, self.wanted_area) = (None, true, None);
        self.space.forget_height();
    }

    /// Shows an area, in world units, as large as it fits.
    fn show_area(&mut self, area: Rect) {
        self.move_camera(|camera| Camera::fit(camera.lattice(), area, camera.size_px(), 0.0));
    }

    /// Shows the area that is wanted of the domain with these bounds, if one is.
    fn show_wanted_area(&mut self, bounds: Rect) {
        if let Some([_, area]) = self.wanted_area.take_if(|[of, _]| *of == bounds) {
            let height = self.space.middle();
            self.show_area(area);
            self.space.keep_height(height);
        }
    }

    /// Moves the camera of the plan.
    pub(super) fn move_camera(&mut self, moved: impl FnOnce(Camera) -> Camera) {
        let camera = self.camera.map(moved);
        if camera != self.camera {
            (self.camera, self.is_fitted) = (camera, false);
            self.space.land();
        }
    }

    /// Chooses a theme. It shows from the next frame on.
    pub fn set_theme(&mut self, theme: ThemePreference, ctx: &Context) {
        self.theme = theme;
        ctx.set_theme(theme);
        ctx.request_repaint();
    }

    /// Shows a tab of the lower dock, also where the panels are hidden.
    fn show_tab(&mut self, tab: Tab) {
        self.panels = true;
        self.dock.choose(tab);
        // Nothing in a hidden tab is under the pointer.
        (self.lone_level, self.hovered_neighbour) = (None, None);
    }

    /// Begins or ends the mode for a projector. It begins without panels.
    fn toggle_presentation(&mut self, ctx: &Context) {
        let panels = match self.presentation.take() {
            Some(presentation) => presentation.end(ctx),
            None => {
                self.presentation = Some(Presentation::begin(self.panels, ctx));
                false
            }
        };
        if panels != self.panels {
            self.toggle_panels();
        }
    }

    fn toggle_panels(&mut self) {
        self.panels = !self.panels;
        // Nothing in a hidden panel is under the pointer.
        (self.lone_level, self.hovered_neighbour) = (None, None);
    }

    /// Resizes the camera to a canvas. Where there is no camera yet, the domain has other bounds, or the view
    /// was never moved, it shows the whole domain with a margin, and `below_px` pixels more below.
    pub fn fit_camera(&mut self, lattice: &Lattice, size_px: [u32; 2], margin_px: f64, below_px: f64) {
        let bounds = lattice.bounds();
        self.camera = Some(match self.camera {
            Some(camera) if self.keeps(&camera, bounds, size_px) => {
                camera.resized(size_px).on_lattice(lattice)
            }
            _ => {
                self.is_fitted = true;
                let above_hint = [size_px[0], size_px[1].saturating_sub(below_px as u32)];
                let up = DVec2::new(0.0, -0.5 * below_px);
                match self.space.fitted(lattice, above_hint, margin_px) {
                    Some(fitted) => self.space.put(fitted.resized(size_px).panned(up)),
                    None => Camera::fit(lattice, bounds, above_hint, margin_px).resized(size_px).panned(up),
                }
            }
        });
        self.show_wanted_area(bounds);
    }

    /// Returns whether a camera stays where it is when the canvas gets a size.
    fn keeps(&self, camera: &Camera, bounds: Rect, size_px: [u32; 2]) -> bool {
        camera.lattice().bounds() == bounds && (!self.is_fitted || camera.size_px() == size_px)
    }

    /// Takes up the ground of the theme that is shown.
    pub fn follow_theme(&mut self, ctx: &Context) {
        self.ground = if ctx.theme() == Theme::Dark { Ground::Dark } else { Ground::Light };
    }

    /// Returns a point as a person would type it: with the digits that a pixel can tell apart, without
    /// commas.
    pub fn typed_point(&self, point: DVec2) -> String {
        let decimals = format::decimals_for(self.world_per_px());
        format!("{:.decimals$}, {:.decimals$}", point.x, point.y)
    }

    /// Returns world units of one pixel.
    pub fn world_per_px(&self) -> f64 {
        self.camera.map_or(1e-4, |camera| 1.0 / camera.px_per_world())
    }

    /// Returns the least radius of the brush in a domain with this longer side, in world units: a pixel, and
    /// no less than a step of the lattice. Where the whole domain is in sight, it is a little less.
    pub fn least_brush_radius(&self, extent: f64) -> f64 {
        let step = self.camera.map_or(0.0, |camera| camera.lattice().step().max_element());
        (LEAST_BRUSH_SHARE * extent).min(self.world_per_px()).max(step)
    }

    /// Puts a point of the world in the middle, where it is out of sight.
    pub fn reveal(&mut self, point: DVec2) {
        if self.camera.is_some_and(|camera| !camera.visible_world().contains(point)) {
            self.move_camera(|camera| camera.centered_on(point));
        }
    }

    /// Puts a point of the world in the middle, and zooms in until a length is at least `px` long there.
    pub fn go_to(&mut self, point: DVec2, length: f64, px: f64) {
        self.move_camera(|camera| {
            let factor = (px / (length * camera.px_per_world())).max(1.0);
            camera.centered_on(point).zoomed(factor, camera.half_size_px())
        });
    }
}

fn bit_of(level: u32) -> u64 {
    1 << level.min(63)
}

/// Returns the deepest level that h_min or the diameter at the outline can ask for.
pub fn deepest_level(settings: &Settings) -> u8 {
    let spacing = settings.lattice().map_or(settings.spacing, |lattice| lattice.spacing());
    let at_outline = settings.boundary.diameter().filter(|_| settings.is_fitted());
    let smallest = at_outline.map_or(settings.transfer.h_min, |at| at.min(settings.transfer.h_min));
    level_for_diameter(spacing, smallest).unwrap_or(63).max(1) as u8
}
