//! How the document is looked at. Nothing here changes it.

use glam::DVec2;

use super::readout::Quantity;
use crate::colormap::{Colormap, Ground, LevelColors};
use crate::document::Settings;
use crate::mesh::level_for_diameter;
use crate::render::export::Look;
use crate::scene::{Camera, Style};

/// What is laid over the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldOverlay {
    /// Nothing.
    None,
    /// Risk, from nothing to a warm tint.
    Risk,
    /// The level that h̄ asks for, in the level's colour.
    Target,
}

/// What the window shows, and how.
#[derive(Clone, Debug)]
pub struct View {
    /// Where the canvas looks; `None` until its size is known, and after "fit".
    pub camera: Option<Camera>,
    /// Colours of the levels.
    pub colormap: Colormap,
    /// Dark or light.
    pub ground: Ground,
    /// Whether edges are drawn.
    pub edges: bool,
    /// What is laid over the mesh.
    pub overlay: FieldOverlay,
    /// Whether the panels are shown.
    pub panels: bool,
    /// A level to be seen alone, while the pointer is on it in the legend.
    pub lone_level: Option<u32>,
    /// What the inspector reads out.
    pub quantity: Quantity,
}

impl Default for View {
    fn default() -> Self {
        Self {
            camera: None,
            colormap: Colormap::Viridis,
            ground: Ground::Dark,
            edges: true,
            overlay: FieldOverlay::None,
            panels: true,
            lone_level: None,
            quantity: Quantity::TargetDiameter,
        }
    }
}

impl View {
    /// The colours of all levels. They span the levels that the settings can ask for and not those that today's mesh
    /// has, so that a level keeps its colour while one paints.
    pub fn level_colors(&self, settings: &Settings) -> LevelColors {
        LevelColors::new(self.colormap, self.ground, deepest_level(settings))
    }

    /// How the mesh is drawn on a screen with `px_per_point` pixels for a point.
    pub fn style(&self, settings: &Settings, px_per_point: f32) -> Style {
        let colors = self.level_colors(settings);
        let style = match self.ground {
            Ground::Dark => Style::dark(colors),
            Ground::Light => Style::light(colors),
        };
        let shown_levels = self.lone_level.map_or(u64::MAX, |level| 1 << level.min(63));
        Style { edges: self.edges, shown_levels, ..style }.at_density(px_per_point)
    }

    /// How a picture of the whole mesh looks in a file.
    pub fn picture(&self, settings: &Settings) -> Look {
        Look {
            width: Look::WIDTH,
            height: None,
            edges: self.edges,
            ground: self.ground,
            level_colors: self.level_colors(settings),
        }
    }

    /// Zooms by `factor` about the middle of the canvas.
    pub fn zoom(&mut self, factor: f64) {
        if let Some(camera) = &mut self.camera {
            *camera = camera.zoomed(factor, camera.half_size_px());
        }
    }

    /// Puts a point of the world in the middle.
    pub fn look_at(&mut self, point: DVec2) {
        self.camera = self.camera.map(|camera| camera.centered_on(point));
    }

    /// Puts a point of the world in the middle, where it is not in sight already.
    pub fn reveal(&mut self, point: DVec2) {
        if let Some(camera) = &mut self.camera
            && !camera.visible_world().contains(point)
        {
            *camera = camera.centered_on(point);
        }
    }
}

/// The deepest level that h_min can ask for.
pub fn deepest_level(settings: &Settings) -> u8 {
    let spacing = settings.lattice().map_or(settings.spacing, |lattice| lattice.spacing());
    level_for_diameter(spacing, settings.transfer.h_min).unwrap_or(63).max(1) as u8
}
