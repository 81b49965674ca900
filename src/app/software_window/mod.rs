//! The whole window drawn in software, for drivers that only emulate a GPU.
//!
//! Such a driver shades every pixel of every panel again for each frame, also where only the pointer moved:
//! a hundred milliseconds for a window. So its pixels are kept here, and of the triangles that egui asks for
//! only those are drawn that can be seen where something changed. The driver shows the result as one picture.
//!
//! ```text
//! shapes of the frame ─→ triangles ─→ compared with those of the last frame ─┐
//! picture of the mesh ─────────────→ the part that was drawn again ──────────┴─→ drawn, sent to the driver
//! ```

mod changes;
mod gpu;
mod raster;
mod textures;

use std::ops::Range;

use eframe::egui::epaint::{ClippedPrimitive, Primitive};
use eframe::egui::{Context, FullOutput, Plugin, TexturesDelta};
use rayon::prelude::*;

use self::changes::px_rect;
pub use self::gpu::SoftwareWindow;
use self::raster::{Strip, blend};
use self::textures::Textures;
use meshbrush_render::render::Image;
use meshbrush_render::render::software::{BAND_ROWS, Damage, PxRect, on_drawing_threads};

/// The colour below all panels, which cover it.
const GROUND: [u8; 4] = [0, 0, 0, 0xff];

/// The picture of the canvas, which is drawn where egui leaves it to others.
pub struct CanvasImage<'a> {
    /// All its pixels, premultiplied.
    pub image: &'a Image,
    /// The part that is new since the last frame.
    pub changed: Option<PxRect>,
    /// Whether nothing below it can be seen.
    pub is_opaque: bool,
}

/// The pixels of a window, kept from frame to frame.
#[derive(Default)]
pub struct WindowImage {
    image: Option<Image>,
    textures: Textures,
    /// The shapes that were drawn last, or `None` if the picture no longer shows them.
    former: Option<Vec<ClippedPrimitive>>,
    px_per_point: f32,
}

impl WindowImage {
    /// Returns the picture as far as it was drawn.
    pub fn image(&self) -> Option<&Image> {
        self.image.as_ref()
    }

    /// Takes over new textures. Where what was drawn can look different now, everything is drawn again.
    pub fn set_textures(&mut self, delta: &TexturesDelta) {
        if self.textures.set(delta) {
            self.forget();
        }
    }

    /// Drops textures that are no longer used.
    pub fn free_textures(&mut self, delta: &TexturesDelta) {
        self.textures.free(delta);
    }

    /// Draws everything again in the next frame.
    pub fn forget(&mut self) {
        self.former = None;
    }

    /// Draws a frame of `size` pixels. Returns the part that changed.
    pub fn draw(
        &mut self,
        primitives: Vec<ClippedPrimitive>,
        canvas: Option<&CanvasImage>,
        size: [u32; 2],
        px_per_point: f32,
    ) -> Option<PxRect> {
        let image = match self.image.take() {
            Some(image) if image.size == size && px_per_point == self.px_per_point => image,
            _ => {
                self.forget();
                Image::filled(size, GROUND)
            }
        };
        self.px_per_point = px_per_point;
        let damage = self.damage(&primitives, canvas, size);
        let image = self.image.insert(image);
        let changed = damage.bounds();
        if changed.is_some() {
            let frame = Frame { primitives: &primitives, canvas, textures: &self.textures, px_per_point };
            on_drawing_threads(|| frame.draw(image, &damage));
        }
        self.former = Some(primitives);
        changed
    }

    fn damage(
        &self,
        primitives: &[ClippedPrimitive],
        canvas: Option<&CanvasImage>,
        size: [u32; 2],
    ) -> Damage {
        let Some(former) = &self.former else { return Damage::everything(size) };
        let mut damage = Damage::nothing(size);
        changes::compare(former, primitives, self.px_per_point, &mut damage);
        if let Some(changed) = canvas.and_then(|canvas| canvas.changed.as_ref()) {
            for primitive in primitives {
                if let Primitive::Callback(callback) = &primitive.primitive {
                    let [left, top] = px_rect(callback.rect, self.px_per_point).map(|range| range.start);
                    let moved = |range: &Range<u32>, by| range.start as i32 + by..range.end as i32 + by;
                    damage.add(moved(&changed.columns, left), moved(&changed.rows, top));
                }
            }
        }
        damage
    }
}

/// The contents of a frame.
struct Frame<'a> {
    primitives: &'a [ClippedPrimitive],
    canvas: Option<&'a CanvasImage<'a>>,
    textures: &'a Textures,
    px_per_point: f32,
}

impl Frame<'_> {
    /// Draws the damaged part of a picture, on all cores.
    fn draw(&self, image: &mut Image, damage: &Damage) {
        let width = image.size[0] as usize;
        let bands = image.pixels_mut().par_chunks_mut(width * BAND_ROWS).with_max_len(1);
        bands.zip(damage.bands()).enumerate().for_each(|(band, (pixels, columns))| {
            if columns.is_empty() {
                return;
            }
            let first = (band * BAND_ROWS) as i32;
            let rows = first..first + (pixels.len() / width) as i32;
            let columns = columns.start as i32..columns.end as i32;
            self.draw_strip(&mut Strip { pixels, width, columns, rows });
        });
    }

    fn draw_strip(&self, strip: &mut Strip) {
        for row in strip.rows.clone() {
            strip.row(row, strip.columns.clone()).fill(GROUND);
        }
        for primitive in self.primitives {
            let clip = px_rect(primitive.clip_rect, self.px_per_point);
            match &primitive.primitive {
                Primitive::Mesh(mesh) => {
                    if let Some(texture) = self.textures.get(mesh.texture_id) {
                        strip.draw(mesh, texture, self.px_per_point, &clip);
                    }
                }
                Primitive::Callback(callback) => {
                    if let Some(canvas) = self.canvas {
                        let [left, top] = px_rect(callback.rect, self.px_per_point).map(|range| range.start);
                        draw_canvas(strip, canvas, [left, top], &clip);
                    }
                }
            }
        }
    }
}

/// Draws the picture of the canvas with its upper left corner at a pixel.
fn draw_canvas(strip: &mut Strip, canvas: &CanvasImage, [left, top]: [i32; 2], clip: &[Range<i32>; 2]) {
    let [width, height] = canvas.image.size.map(|n| n as i32);
    let columns = strip.columns.start.max(clip[0].start).max(left)
        ..strip.columns.end.min(clip[0].end).min(left + width);
    let rows =
        strip.rows.start.max(clip[1].start).max(top)..strip.rows.end.min(clip[1].end).min(top + height);
    if columns.is_empty() {
        return;
    }
    for row in rows {
        let start = ((row - top) * width + columns.start - left) as usize;
        let from = &canvas.image.pixels()[start..start + columns.len()];
        let to = strip.row(row, columns.clone());
        if canvas.is_opaque {
            to.copy_from_slice(from);
        } else {
            to.iter_mut().zip(from).for_each(|(to, from)| blend(to, from.map(f32::from)));
        }
    }
}

impl Plugin for SoftwareWindow {
    fn debug_name(&self) -> &'static str {
        "software window"
    }

    fn output_hook(&mut self, ctx: &Context, output: &mut FullOutput) {
        self.take_over(ctx, output);
    }
}
