//! Connects egui and the renderer: the only file of the window that uses wgpu.

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use eframe::wgpu;

use crate::app::software_window::CanvasImage;
use meshbrush_core::document::MeshChange;
use meshbrush_kit::kit::derivation::PiecesChange;
use meshbrush_kit::kit::derivation::ShownChange;
use meshbrush_kit::kit::heights::Surface;
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::Progress;
use meshbrush_render::render::gpu::{GpuError, GpuRenderer, MeshMirror, emulates_gpu};
use meshbrush_render::scene::{Camera, Overlay, ShownMesh, ShownRevision, SpaceView, Style};

/// Bytes of a mesh that are sent to the GPU in one frame: about 2 ms.
const BYTES_PER_FRAME: usize = 16 << 20;

/// Blocks of a large mesh that are arranged in one frame without changes: about 3 ms on two cores.
const BLOCKS_PER_FRAME: usize = 8;

/// The canvas's share of egui's GPU resources.
struct CanvasResources {
    renderer: GpuRenderer,
    /// The error while a frame was prepared, to be reported in the next frame.
    failed: Option<GpuError>,
}

/// Environment variable that says what draws the mesh: `gpu` or `software`. By default the GPU does, if there
/// is one.
const DRAW_VARIABLE: &str = "MESHBRUSH_DRAW";

/// Draws meshes on the canvas.
pub struct CanvasGpu {
    state: RenderState,
    /// The driver only emulates a GPU: drawing in software and showing the picture is several times as fast.
    in_software: bool,
    /// The whole window is drawn in software, and takes the picture of the mesh from here.
    in_software_window: bool,
    sending: Sending,
}

/// The part of the follower's mesh that the GPU still lacks.
struct Sending {
    /// The follower has another mesh than the one on the screen: all of it must be sent.
    behind: bool,
    /// The revision that the GPU could not hold. It is not tried again.
    refused: Option<u64>,
}

impl CanvasGpu {
    /// Readies the GPU behind a window. Where it cannot draw a mesh at all, as through WebGL, the mesh is
    /// drawn in software.
    ///
    /// # Errors
    /// Fails when it cannot draw a mesh and the environment asks that it does.
    pub fn new(state: &RenderState) -> Result<Self, GpuError> {
        let (device, queue, format) = (&state.device, &state.queue, state.target_format);
        let renderer = GpuRenderer::new(device, queue, format);
        let in_software = match std::env::var(DRAW_VARIABLE).as_deref() {
            Ok("software") => true,
            Ok("gpu") => false,
            _ => renderer.is_err() || emulates_gpu(&state.adapter),
        };
        let renderer = if in_software { GpuRenderer::in_software(device, queue, format) } else { renderer? };
        state.renderer.write().callback_resources.insert(CanvasResources { renderer, failed: None });
        let sending = Sending { behind: true, refused: None };
        Ok(Self { state: state.clone(), in_software, in_software_window: false, sending })
    }

    /// Draws in software from now on, with any driver.
    pub fn draw_in_software(&mut self) {
        self.in_software = true;
    }

    /// Returns whether no GPU draws the mesh.
    pub fn draws_in_software(&self) -> bool {
        self.in_software
    }

    /// Leaves the picture to a window that is drawn in software, if it is drawn in software itself.
    pub fn leave_to_software_window(&mut self) -> Option<&RenderState> {
        self.in_software_window = self.in_software;
        self.in_software.then_some(&self.state)
    }

    /// Sends changes of mesh and overlay to the GPU. The former mesh stays on the screen until the new one is
    /// complete.
    ///
    /// # Errors
    /// Fails when the GPU cannot hold the mesh, or could not draw the last frame.
    pub fn sync(
        &mut self,
        session: &Session,
        change: ShownChange,
        overlay: Option<&Overlay>,
        camera: &Camera,
        style: &Style,
    ) -> Result<Progress, GpuError> {
        let mut renderer = self.state.renderer.write();
        let Some(CanvasResources { renderer, failed }) = renderer.callback_resources.get_mut() else {
            return Ok(Progress::Done);
        };
        // Before anything can fail: each change is reported once.
        let sent = follow(self.in_software, &mut self.sending, renderer, session, change);
        if let Some(failure) = failed.take() {
            return Err(failure);
        }
        let (device, queue) = (&self.state.device, &self.state.queue);
        renderer.set_overlay(device, queue, overlay)?;
        if self.in_software {
            let (follower, derivation) = (session.follower(), session.derivation());
            let shown = ShownMesh { mesh: follower.mesh(), pieces: Some(derivation.pieces()) };
            let revision = ShownRevision { mesh: follower.revision(), pieces: derivation.pieces_revision() };
            if self.in_software_window && overlay.is_none() {
                renderer.draw_image(shown, revision, camera, style);
            } else {
                renderer.prepare_in_software(device, queue, shown, revision, camera, style)?;
            }
        }
        sent
    }

    /// Sends changes of the mesh and its heights to the GPU, for a picture in space. The former picture stays
    /// on the screen until all are there.
    ///
    /// # Errors
    /// Fails when the GPU cannot hold the mesh, or could not draw the last frame.
    pub fn sync_in_space(
        &mut self,
        session: &Session,
        change: ShownChange,
        surface: Option<Surface<'_>>,
        seen: Option<(&SpaceView, &Style)>,
    ) -> Result<Progress, GpuError> {
        let mut renderer = self.state.renderer.write();
        let Some(CanvasResources { renderer, failed }) = renderer.callback_resources.get_mut() else {
            return Ok(Progress::Done);
        };
        let sent = follow(self.in_software, &mut self.sending, renderer, session, change);
        if let Some(failure) = failed.take() {
            return Err(failure);
        }
        let (device, queue) = (&self.state.device, &self.state.queue);
        renderer.set_overlay(device, queue, None)?;
        let (Some(surface), Some((view, style))) = (surface, seen) else { return sent };
        if self.in_software {
            let revision = ShownRevision { mesh: surface.revision(), pieces: surface.revision() };
            let gpu = (!self.in_software_window).then_some((device, queue));
            renderer.prepare_in_space_in_software(gpu, surface.shown(), revision, view, style)?;
        } else if surface.is_current() && renderer.mirror().shown() == Some(session.follower().revision()) {
            renderer.set_heights(device, queue, surface.shown().heights, surface.revision())?;
        }
        sent
    }

    /// Returns the shape that draws the mesh on the canvas, where `can_redraw` with the present view.
    pub fn shape_in_space(
        &self,
        rect: egui::Rect,
        view: SpaceView,
        style: Style,
        can_redraw: bool,
    ) -> egui::Shape {
        let sight = if can_redraw { Sight::Space(view) } else { Sight::Former };
        let callback = CanvasCallback { sight, style: Arc::new(style), in_software: self.in_software };
        egui_wgpu::Callback::new_paint_callback(rect, callback).into()
    }

    /// Returns whether the GPU has the mesh that is to be shown.
    pub fn has_mesh(&self, session: &Session) -> bool {
        let renderer = self.state.renderer.read();
        let canvas = renderer.callback_resources.get::<CanvasResources>();
        canvas.is_some_and(|canvas| canvas.renderer.mirror().shown() == Some(session.follower().revision()))
    }

    /// Returns the shape that draws the mesh on the canvas.
    pub fn shape(&self, rect: egui::Rect, camera: Camera, style: Style) -> egui::Shape {
        let sight = Sight::Plan(camera);
        let callback = CanvasCallback { sight, style: Arc::new(style), in_software: self.in_software };
        egui_wgpu::Callback::new_paint_callback(rect, callback).into()
    }
}

/// Tells the picture or the mirror which changes of the mesh there are.
fn follow(
    in_software: bool,
    sending: &mut Sending,
    renderer: &mut GpuRenderer,
    session: &Session,
    change: ShownChange,
) -> Result<Progress, GpuError> {
    if in_software {
        match &change.mesh {
            Some(MeshChange::Within(changes)) => {
                renderer.picture_in_software_mut().note_changes(changes, session.mesh());
            }
            Some(MeshChange::Replaced) => renderer.picture_in_software_mut().forget_mesh(),
            None => {}
        }
        Ok(Progress::Done)
    } else {
        sending.send(renderer.mirror_mut(), session, change)
    }
}

/// Returns the picture of the mesh for a window that is drawn in software; `None` while the driver must draw
/// an overlay over it.
pub fn canvas_image(resources: &mut CallbackResources) -> Option<CanvasImage<'_>> {
    let canvas: &mut CanvasResources = resources.get_mut()?;
    let (image, changed, is_opaque) = canvas.renderer.take_image()?;
    Some(CanvasImage { image, changed, is_opaque })
}

impl Sending {
    /// Sends what changed, and the next part of a mesh that the GPU does not have yet.
    fn send(
        &mut self,
        mirror: &mut MeshMirror,
        session: &Session,
        change: ShownChange,
    ) -> Result<Progress, GpuError> {
        let revision = session.follower().revision();
        let is_still = change.mesh.is_none();
        let mut sent = self.try_to_send(mirror, session, change);
        if is_still && !self.behind && matches!(sent, Ok(Progress::Done)) {
            sent = arrange(mirror, session);
        }
        match sent {
            Ok(progress) => self.behind &= progress == Progress::More || self.refused == Some(revision),
            Err(_) => (self.behind, self.refused) = (true, Some(revision)),
        }
        sent
    }

    fn try_to_send(
        &mut self,
        mirror: &mut MeshMirror,
        session: &Session,
        change: ShownChange,
    ) -> Result<Progress, GpuError> {
        let (mesh, revision) = (session.mesh(), session.follower().revision());
        match change.mesh {
            Some(MeshChange::Within(changes)) if !self.behind || mirror.uploading().is_some() => {
                mirror.apply_changes(mesh, revision, &changes)?;
            }
            Some(_) => self.behind = true,
            None => {}
        }
        if self.refused == Some(revision) {
            return Ok(Progress::Done);
        }
        if self.behind && mirror.uploading() != Some(revision) {
            mirror.begin_upload(mesh, revision)?;
        }
        // Now the mirror holds the mesh of the pieces, on the screen or on its way there.
        let pieces = session.derivation().pieces();
        match change.pieces {
            Some(PiecesChange::Replaced) => mirror.set_pieces(Some(pieces))?,
            Some(PiecesChange::Within(touched)) => mirror.change_pieces(pieces, &touched)?,
            None => {}
        }
        if self.behind { Ok(mirror.advance_upload(mesh, BYTES_PER_FRAME)) } else { Ok(Progress::Done) }
    }
}

/// Arranges a little more of a mesh that is so large that its smallest triangles are merged.
fn arrange(mirror: &mut MeshMirror, session: &Session) -> Result<Progress, GpuError> {
    let mesh = session.mesh();
    if !Style::merges(mesh.raw_triangle_count()) {
        return Ok(Progress::Done);
    }
    mirror.arrange(mesh, session.follower().revision(), BLOCKS_PER_FRAME)
}

/// What the GPU draws.
enum Sight {
    Plan(Camera),
    Space(SpaceView),
    /// The picture of the last frame.
    Former,
}

struct CanvasCallback {
    sight: Sight,
    style: Arc<Style>,
    in_software: bool,
}

impl CallbackTrait for CanvasCallback {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(canvas) = resources.get_mut::<CanvasResources>().filter(|_| !self.in_software) {
            let (renderer, style) = (&mut canvas.renderer, &self.style);
            let prepared = match &self.sight {
                Sight::Plan(camera) => renderer.prepare(device, queue, encoder, camera, style),
                Sight::Space(view) => renderer.prepare_in_space(device, queue, encoder, view, style),
                Sight::Former => Ok(()),
            };
            canvas.failed = prepared.err();
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(canvas) = resources.get::<CanvasResources>() {
            canvas.renderer.paint(pass);
        }
    }
}
