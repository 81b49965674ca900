//! The background picture on the canvas.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage, Context, Painter, Rect, TextureHandle, TextureOptions, pos2};

use meshbrush_core::document::{Background, Picture};
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_render::scene::Camera;

/// The texture of the picture that was drawn last.
#[derive(Default)]
pub struct BackgroundTexture {
    shown: Option<(Arc<Picture>, TextureHandle)>,
}

impl BackgroundTexture {
    /// Draws the picture below the mesh, whose fill is as transparent as the picture is opaque.
    pub fn paint(&mut self, painter: &Painter, rect: Rect, camera: &Camera, background: Option<&Background>) {
        let Some(background) = background else {
            self.shown = None;
            return;
        };
        let texture = self.texture(painter.ctx(), &background.picture);
        let at = |world| point_from_px(rect, camera.screen_from_world(world), painter.pixels_per_point());
        let place = Rect::from_two_pos(at(background.bounds.min), at(background.bounds.max));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        // At a deep zoom f32 cannot place the whole picture: only what is in view is drawn.
        let Some((place, part)) = in_view(place, whole, rect) else { return };
        painter.image(texture, place, part, Color32::WHITE.gamma_multiply(beside_mesh(background.opacity)));
    }

    fn texture(&mut self, ctx: &Context, picture: &Arc<Picture>) -> eframe::egui::TextureId {
        let (kept, texture) = match self.shown.take() {
            Some((kept, texture)) if Arc::ptr_eq(&kept, picture) => (kept, texture),
            _ => {
                let most = ctx.input(|input| input.max_texture_side);
                let image = color_image(picture, most);
                (picture.clone(), ctx.load_texture("background", image, TextureOptions::LINEAR))
            }
        };
        let id = texture.id();
        self.shown = Some((kept, texture));
        id
    }
}

/// Returns the opacity of the picture itself: full from the middle of the range on, so that it is clear below
/// and beside the mesh, and still nothing at 0.
fn beside_mesh(opacity: f64) -> f32 {
    (2.0 * opacity).min(1.0) as f32
}

/// Returns the part of a picture at `place`, with texture coordinates `whole`, that lies in `view`.
fn in_view(place: Rect, whole: Rect, view: Rect) -> Option<(Rect, Rect)> {
    let part = place.intersect(view);
    if !part.is_positive() {
        return None;
    }
    let share = |at: eframe::egui::Pos2| {
        let t = (at - place.min) / place.size();
        whole.min + t * whole.size()
    };
    Some((part, Rect::from_min_max(share(part.min), share(part.max))))
}

/// Returns a picture with at most `most_side` pixels along a side: every second, third … pixel of a larger
/// one.
fn color_image(picture: &Picture, most_side: usize) -> ColorImage {
    let [columns, rows] = picture.size.map(|side| side as usize);
    let every = columns.max(rows).div_ceil(most_side.max(1));
    let size = [columns.div_ceil(every), rows.div_ceil(every)];
    let pixel = |x: usize, y: usize| {
        let start = 4 * (y * columns + x);
        let [r, g, b, a] = [0, 1, 2, 3].map(|i| picture.rgba[start + i]);
        Color32::from_rgba_unmultiplied(r, g, b, a)
    };
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (every * x, every * y)));
    ColorImage::new(size, pixels.map(|(x, y)| pixel(x, y)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_larger_than_a_texture_is_thinned() {
        let picture = Picture { size: [10, 4], rgba: (0..160).map(|i| i as u8).collect() };
        assert_eq!(color_image(&picture, 16).size, [10, 4]);
        assert_eq!(color_image(&picture, 5).size, [5, 2]);
    }

    #[test]
    fn only_the_part_in_view_is_drawn() {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let place = Rect::from_min_max(pos2(-100.0, 0.0), pos2(100.0, 100.0));
        let view = Rect::from_min_max(pos2(0.0, 0.0), pos2(50.0, 50.0));
        let (shown, part) = in_view(place, whole, view).unwrap();
        assert_eq!(shown, view);
        assert_eq!(part, Rect::from_min_max(pos2(0.5, 0.0), pos2(0.75, 0.5)));
        assert_eq!(in_view(place.translate(eframe::egui::vec2(500.0, 0.0)), whole, view), None);
    }
}
