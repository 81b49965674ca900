//! Shows the window's picture by means of the graphics driver.

use eframe::egui::{Context, FullOutput, PaintCallbackInfo, epaint::ClippedShape};
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, RenderState};
use eframe::wgpu;

use super::{CanvasImage, WindowImage};
use meshbrush_render::render::gpu::ShownImage;

/// Draws all shapes of a window itself, and leaves the driver one picture.
pub struct SoftwareWindow {
    state: RenderState,
    window: WindowImage,
    canvas_image: TakeCanvasImage,
}

/// Returns the picture of the canvas; `None` while the driver must draw something over it.
pub type TakeCanvasImage = fn(&mut CallbackResources) -> Option<CanvasImage<'_>>;

/// The picture in the driver's memory.
struct WindowTexture(ShownImage);

impl SoftwareWindow {
    /// Readies the driver behind a window.
    pub fn new(state: &RenderState, canvas_image: TakeCanvasImage) -> Self {
        let texture = WindowTexture(ShownImage::new(&state.device, state.target_format));
        state.renderer.write().callback_resources.insert(texture);
        Self { state: state.clone(), window: WindowImage::default(), canvas_image }
    }

    /// Draws everything again in the next frame.
    #[cfg(test)]
    pub fn forget(&mut self) {
        self.window.forget();
    }

    /// Draws the shapes of a frame, and puts the picture in their place. Where something can only be drawn by
    /// the driver, the shapes stay.
    pub(super) fn take_over(&mut self, ctx: &Context, output: &mut FullOutput) {
        self.window.set_textures(&output.textures_delta);
        if self.draw(ctx, output).is_none() {
            self.window.forget();
        }
        self.window.free_textures(&output.textures_delta);
    }

    fn draw(&mut self, ctx: &Context, output: &mut FullOutput) -> Option<()> {
        let mut renderer = self.state.renderer.write();
        let resources = &mut renderer.callback_resources;
        let rect = ctx.viewport_rect();
        let size = (rect.size() * output.pixels_per_point).round();
        let size = [size.x as u32, size.y as u32];
        let limit = self.state.device.limits().max_texture_dimension_2d;
        if size.contains(&0) || size.iter().any(|&n| n > limit) {
            return None;
        }
        let canvas = (self.canvas_image)(resources)?;
        let primitives = ctx.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        let part = self.window.draw(primitives, Some(&canvas), size, output.pixels_per_point);
        let WindowTexture(shown) = resources.get_mut()?;
        if let (Some(image), Some(part)) = (self.window.image(), part) {
            shown.fit(&self.state.device, size).ok()?;
            shown.write(&self.state.queue, image, &part);
        }
        let shape = egui_wgpu::Callback::new_paint_callback(rect, WindowCallback);
        output.shapes.push(ClippedShape::new(rect, shape));
        Some(())
    }
}

struct WindowCallback;

impl CallbackTrait for WindowCallback {
    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(WindowTexture(shown)) = resources.get() {
            shown.paint(pass, true);
        }
    }
}
