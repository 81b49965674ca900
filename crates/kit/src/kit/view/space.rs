//! The settings of the view in space.

use super::View;
use crate::kit::command::SpaceCommand;
use crate::kit::heights::Heights;
use crate::kit::session::Session;
use meshbrush_mesh::geometry::Lattice;
use meshbrush_render::render::space_look::SpaceLook;
use meshbrush_render::scene::{
    Camera, HeightScale, Light, NodeHeights, SpaceCamera, SpaceView, ViewDirection,
};

/// Whether the canvas shows the mesh in space, and from where.
///
/// The point of the plan in the middle, and the scale, are those of the camera of the plan: so both views
/// show the same place, and what moves the one moves the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space {
    /// Whether the canvas shows the mesh in space.
    pub is_on: bool,
    /// Where one looks.
    pub direction: ViewDirection,
    /// The factor for heights, where a person chose one.
    pub exaggeration: Option<f64>,
    /// The light.
    pub light: Light,
    /// World units of a unit of height: see [`SpaceCamera::metre_in`].
    pub ground: f64,
    /// The height in the middle; half way up where it is not known.
    height: Option<f64>,
    /// Whether the height in the middle is to become that of the surface there.
    lands: bool,
    /// The heights of the surface on the screen.
    extent: Option<(HeightScale, [u32; 2])>,
}

impl Default for Space {
    fn default() -> Self {
        Self {
            is_on: false,
            direction: ViewDirection::default(),
            exaggeration: None,
            light: Light::default(),
            ground: 1.0,
            height: None,
            lands: false,
            extent: None,
        }
    }
}

impl Space {
    /// Notes the heights of the surface on the screen. Returns whether they are the first.
    pub fn note_extent(&mut self, extent: (HeightScale, [u32; 2])) -> bool {
        self.extent.replace(extent).is_none()
    }

    /// Returns the factor for heights: the one that a person chose, or one that makes relief visible.
    pub fn factor(&self, lattice: &Lattice) -> f64 {
        self.exaggeration.unwrap_or_else(|| self.default_factor(lattice))
    }

    /// Returns the factor that makes relief visible.
    pub fn default_factor(&self, lattice: &Lattice) -> f64 {
        let relief = self.extent.map_or(0.0, |(scale, [low, high])| scale.step() * f64::from(high - low));
        SpaceCamera::visible_exaggeration(lattice.bounds(), relief) / self.ground
    }

    /// Returns how a picture of all of a surface looks from the same direction.
    pub fn picture(&self, heights: NodeHeights, lattice: &Lattice) -> SpaceLook {
        SpaceLook::new((self.direction, self.light), self.exaggeration, self.ground, heights, lattice)
    }

    /// Returns the view of a surface whose middle in the plan is that of `plan`; `None` in the plan, and
    /// until heights are known.
    pub fn view(&self, plan: Camera) -> Option<SpaceView> {
        let extent = self.extent.filter(|_| self.is_on)?;
        let (scale, [low, high]) = extent;
        let half_way = (f64::from(low) + f64::from(high)) / 2.0;
        let height = self.height.map_or(half_way, |height| (height - scale.lowest()) / scale.step());
        let factor = self.factor(plan.lattice()) * self.ground;
        let camera = SpaceCamera::new(plan, height, extent, self.direction, factor);
        Some(SpaceView { camera, light: self.light })
    }

    /// Returns the view of the whole surface over a lattice.
    pub fn fitted(&self, lattice: &Lattice, size_px: [u32; 2], margin_px: f64) -> Option<SpaceCamera> {
        let extent = self.extent.filter(|_| self.is_on)?;
        let factor = self.factor(lattice) * self.ground;
        Some(SpaceCamera::fit(lattice, extent, self.direction, factor, size_px, margin_px))
    }

    /// Takes over a view. Returns the camera of the plan.
    pub fn put(&mut self, camera: SpaceCamera) -> Camera {
        self.direction = camera.direction();
        self.height = Some(camera.scale().height(camera.height()));
        *camera.plan()
    }

    /// Puts the surface at the place in the middle of the plan there, once its height is known.
    pub fn land(&mut self) {
        self.lands = true;
    }

    /// Returns what [`SpaceCommand::Show`] needs for the same view; `None` in the plan.
    pub fn shown(&self) -> Option<(ViewDirection, [Option<f64>; 2])> {
        self.is_on.then_some((self.direction, [self.exaggeration, self.height]))
    }

    /// Returns the height in the middle, if one is known.
    pub fn middle(&self) -> Option<f64> {
        self.height
    }

    /// Moves the plan without another height in the middle, if one is known.
    pub fn keep_height(&mut self, height: Option<f64>) {
        if height.is_some() {
            (self.height, self.lands) = (height, false);
        }
    }

    /// Forgets the height in the middle: the whole surface is shown.
    pub fn forget_height(&mut self) {
        (self.height, self.lands) = (None, false);
    }

    /// Runs a command that needs no camera. Returns whether it was one.
    pub fn set(&mut self, command: SpaceCommand) -> bool {
        match command {
            SpaceCommand::Toggle => (self.is_on, self.extent) = (!self.is_on, None),
            SpaceCommand::Exaggerate(factor) => self.exaggeration = factor,
            SpaceCommand::Light(light) => self.light = light,
            SpaceCommand::Show(direction, [exaggeration, height]) => {
                (self.is_on, self.extent, self.lands) = (true, None, false);
                (self.direction, self.exaggeration, self.height) = (direction, exaggeration, height);
            }
            SpaceCommand::Turn(_) | SpaceCommand::About(_) | SpaceCommand::LookFrom(_) => return false,
        }
        true
    }
}

impl View {
    /// Returns the view in space; `None` in the plan, and until heights are known.
    pub fn space_view(&self) -> Option<SpaceView> {
        self.space.view(self.camera?)
    }

    /// Notes the heights of the surface on the screen, for the view in space.
    pub fn follow_heights(&mut self, session: &Session) {
        if !self.space.is_on {
            return;
        }
        self.space.ground = SpaceCamera::metre_in(session.document().settings().unit);
        let Heights::Known(surface) = session.heights() else { return };
        if self.space.note_extent(surface.extent()) && self.is_fitted {
            self.fit();
        }
        if let (true, Some(camera)) = (self.space.lands, self.camera) {
            let middle = camera.lattice_from_screen(camera.half_size_px());
            let height = surface.height_at(middle).map(|steps| surface.extent().0.height(steps));
            (self.space.height, self.space.lands) = (height.or(self.space.height), false);
        }
    }

    /// Shows the plan.
    pub fn leave_space(&mut self) {
        if self.space.is_on {
            self.change_space(SpaceCommand::Toggle);
        }
    }

    /// Runs a command about the view in space.
    pub(super) fn change_space(&mut self, command: SpaceCommand) {
        let was_on = self.space.is_on;
        if matches!(command, SpaceCommand::Show(..)) {
            // Before it, because it says the height in the middle.
            self.fit();
            self.space.set(command);
            return;
        }
        if self.space.set(command) {
            if self.is_fitted && was_on != self.space.is_on {
                self.fit();
            }
            return;
        }
        self.move_view(
            |camera| camera,
            |camera| match command {
                SpaceCommand::Turn(by) => camera.turned(by.x, by.y),
                SpaceCommand::About(height) => camera.about(height),
                SpaceCommand::LookFrom(direction) => camera.seen_from(direction),
                _ => camera, // all others are done
            },
        );
    }

    /// Moves the camera of the plan, or the one in space where that is shown.
    pub(super) fn move_view(
        &mut self,
        in_plan: impl FnOnce(Camera) -> Camera,
        in_space: impl FnOnce(SpaceCamera) -> SpaceCamera,
    ) {
        let Some(view) = self.space_view() else { return self.move_camera(in_plan) };
        let moved = in_space(view.camera);
        if moved != view.camera {
            (self.camera, self.is_fitted) = (Some(self.space.put(moved)), false);
        }
    }
}
