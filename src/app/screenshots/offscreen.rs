//! An invisible window: the app's frames without a display, drawn into a texture.
//!
//! It does what eframe does for a real window, and nothing more: it passes input in, and draws the shapes
//! that come out.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{Context, Event, FullOutput, Pos2, RawInput, Rect, Vec2, ViewportId};
use eframe::{egui_wgpu, wgpu};
use egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup};

use glam::DVec2;

use crate::app::App;
use crate::app::canvas::space_sight;
use meshbrush_core::layers::Layer;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_mesh::mesh::Progress;
use meshbrush_render::render::Image;
use meshbrush_render::render::gpu::{device_descriptor, read_back};

/// Seconds from frame to frame. Time is counted, not measured, so that the same input gives the same picture.
const FRAME: f64 = 1.0 / 60.0;
/// Frames after which all animations, such as those of tooltips and menus, have ended.
const SETTLING_FRAMES: u32 = 30;

/// The app in an invisible window.
pub struct OffscreenWindow {
    app: App,
    ctx: Context,
    state: RenderState,
    size: Vec2,
    px_per_point: f32,
    frames: u32,
    events: Vec<Event>,
}

impl OffscreenWindow {
    /// Opens the app in a window of `size` points.
    ///
    /// # Errors
    /// Fails with a sentence when there is no graphics driver that can paint it.
    pub fn open(size: Vec2, px_per_point: f32) -> Result<Self, String> {
        let (state, ctx) = (render_state()?, Context::default());
        let app = App::new(&ctx, Some(&state))?;
        Ok(Self::show(app, ctx, state, size, px_per_point))
    }

    /// Opens the app on a file.
    ///
    /// # Errors
    /// Fails with a sentence when there is no graphics driver that can paint it.
    pub fn open_file(size: Vec2, px_per_point: f32, file: PathBuf) -> Result<Self, String> {
        let (state, ctx) = (render_state()?, Context::default());
        let app = App::with_file(&ctx, Some(&state), file)?;
        Ok(Self::show(app, ctx, state, size, px_per_point))
    }

    fn show(mut app: App, ctx: Context, state: RenderState, size: Vec2, px_per_point: f32) -> Self {
        app.be_reproducible();
        let mut window = Self { app, ctx, state, size, px_per_point, frames: 0, events: Vec::new() };
        window.settle();
        window
    }

    /// Returns the position of a point in world units on the screen, in points.
    pub fn screen_from_world(&self, world: DVec2) -> Option<Pos2> {
        let px = match space_sight(&self.app.view, &self.app.session) {
            Some(space) => space.screen(world),
            None => self.app.view.camera?.screen_from_world(world),
        };
        Some(point_from_px(self.app.canvas.rect()?, px, self.px_per_point))
    }

    /// Returns the rectangle of the canvas on the screen, in points.
    pub fn canvas_rect(&self) -> Option<Rect> {
        self.app.canvas.rect()
    }

    /// Returns the middle of the domain, in world units.
    pub fn domain_center(&self) -> DVec2 {
        self.app.session.document().settings().domain.bounds.center()
    }

    /// Returns the layers of the document, from the bottom to the top.
    pub fn layers(&self) -> &[Layer] {
        &self.app.session.document().settings().layers
    }

    /// Runs a command and everything that follows from it.
    pub fn send(&mut self, command: Command) {
        self.app.send(command);
        self.settle();
    }

    /// Passes an event in, and runs everything that follows from it.
    pub fn event(&mut self, event: Event) {
        self.events.push(event);
        self.settle();
    }

    /// Runs frames until nothing changes any more.
    fn settle(&mut self) {
        let mut quiet = 0;
        while quiet < SETTLING_FRAMES {
            self.frame();
            let session = &self.app.session;
            let is_settled = (session.stage().is_settled() || session.question().is_some())
                && session.pricer().progress() == Progress::Done
                && !session.is_cutting()
                && !(self.app.view.space.is_on && session.seeks_heights())
                && !self.works_on_files();
            quiet = if is_settled { quiet + 1 } else { 0 };
        }
    }

    /// Returns whether a file is being read or written, which is waited for a little.
    fn works_on_files(&self) -> bool {
        let works = !self.app.background.rows(true).is_empty();
        if works {
            std::thread::sleep(Duration::from_millis(2));
        }
        works
    }

    fn frame(&mut self) -> FullOutput {
        self.frames += 1;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            max_texture_side: Some(self.state.device.limits().max_texture_dimension_2d as usize),
            time: Some(f64::from(self.frames) * FRAME),
            events: std::mem::take(&mut self.events),
            focused: true,
            ..RawInput::default()
        };
        let viewport = input.viewports.entry(ViewportId::ROOT).or_default();
        viewport.native_pixels_per_point = Some(self.px_per_point);
        let mut output = self.ctx.run_ui(input, |ui| {
            self.app.advance(ui.ctx());
            self.app.draw(ui);
        });
        self.take_textures(&mut output);
        output
    }

    fn take_textures(&self, output: &mut FullOutput) {
        let mut renderer = self.state.renderer.write();
        for (id, images) in output.textures_delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.state.device, &self.state.queue, id, &image);
            }
        }
        for id in output.textures_delta.free.drain() {
            renderer.free_texture(&id);
        }
    }

    /// Paints the window as it is now.
    ///
    /// # Errors
    /// Fails with a sentence when the driver does not give the picture back.
    pub fn picture(&mut self) -> Result<Image, String> {
        let output = self.frame();
        let shapes = self.ctx.tessellate(output.shapes, self.px_per_point);
        let size = (self.size * self.px_per_point).round();
        let screen = ScreenDescriptor {
            size_in_pixels: [size.x as u32, size.y as u32],
            pixels_per_point: self.px_per_point,
        };
        let (device, queue) = (&self.state.device, &self.state.queue);
        let mut renderer = self.state.renderer.write();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let before = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        queue.submit(before);
        let canvas = self.canvas(screen.size_in_pixels);
        let view = canvas.create_view(&wgpu::TextureViewDescriptor::default());
        renderer.render(&mut begin_pass(&mut encoder, &view), &shapes, &screen);
        read_back(device, queue, encoder, &canvas).map_err(|error| error.to_string())
    }

    fn canvas(&self, [width, height]: [u32; 2]) -> wgpu::Texture {
        self.state.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.state.target_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }
}

/// Returns a driver without a window behind it.
fn render_state() -> Result<RenderState, String> {
    let mut config = WgpuConfiguration::default();
    if let WgpuSetup::CreateNew(setup) = &mut config.wgpu_setup {
        setup.device_descriptor = Arc::new(device_descriptor);
    }
    let instance = pollster::block_on(config.wgpu_setup.new_instance());
    let opened = RenderState::create(&config, &instance, None, RendererOptions::PREDICTABLE);
    pollster::block_on(opened).map_err(|_| crate::app::NO_DRIVER.to_owned())
}

fn begin_pass(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'static> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
    let attachment = wgpu::RenderPassColorAttachment { view, resolve_target: None, ops, depth_slice: None };
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment)],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.forget_lifetime()
}
