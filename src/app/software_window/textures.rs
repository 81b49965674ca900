//! The textures of the window, for a painter without a graphics driver.

use std::collections::HashMap;

use eframe::egui::epaint::{ImageData, ImageDelta};
use eframe::egui::{Color32, ColorImage, TextureFilter, TextureId, TexturesDelta};

/// A picture that triangles are filled with.
pub struct Texture {
    image: ColorImage,
    filter: TextureFilter,
}

impl Texture {
    /// Returns the colour at a place, from 0 to 1 from the upper left: red, green, blue and alpha from 0 to
    /// 255.
    #[inline]
    pub fn sample(&self, u: f32, v: f32) -> [f32; 4] {
        let [width, height] = self.image.size;
        let (x, y) = (u * width as f32, v * height as f32);
        if self.filter == TextureFilter::Nearest {
            return self.texel(x.floor() as i32, y.floor() as i32);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right_share, low_share) = (x - left, y - top);
        let (column, row) = (left as i32, top as i32);
        let upper_left = self.texel(column, row);
        // Letters lie on whole pixels.
        if right_share < SAME && low_share < SAME {
            return upper_left;
        }
        let upper = mixed(upper_left, self.texel(column + 1, row), right_share);
        let lower = mixed(self.texel(column, row + 1), self.texel(column + 1, row + 1), right_share);
        mixed(upper, lower, low_share)
    }

    #[inline]
    fn texel(&self, column: i32, row: i32) -> [f32; 4] {
        let [width, height] = self.image.size;
        let column = column.clamp(0, width as i32 - 1) as usize;
        let row = row.clamp(0, height as i32 - 1) as usize;
        self.image.pixels[row * width + column].to_array().map(f32::from)
    }
}

/// A share of the next texel that changes no colour.
const SAME: f32 = 1.0 / 512.0;

fn mixed(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
}

/// All textures by their ids.
#[derive(Default)]
pub struct Textures {
    textures: HashMap<TextureId, Texture>,
}

impl Textures {
    pub fn get(&self, id: TextureId) -> Option<&Texture> {
        self.textures.get(&id)
    }

    /// Takes over new pictures. Returns whether what was drawn before can look different now.
    pub fn set(&mut self, delta: &TexturesDelta) -> bool {
        let mut differs = false;
        for (id, parts) in &delta.set {
            for part in parts {
                differs |= self.set_part(*id, part);
            }
        }
        differs
    }

    fn set_part(&mut self, id: TextureId, part: &ImageDelta) -> bool {
        let ImageData::Color(image) = &part.image;
        let Some([left, top]) = part.pos else {
            let texture = Texture { image: ColorImage::clone(image), filter: part.options.magnification };
            self.textures.insert(id, texture);
            return true;
        };
        if let Some(texture) = self.textures.get_mut(&id) {
            let width = texture.image.size[0];
            let rows: Vec<&[Color32]> = image.pixels.chunks(image.size[0].max(1)).collect();
            for (row, pixels) in rows.into_iter().enumerate() {
                let start = (top + row) * width + left;
                texture.image.pixels[start..start + pixels.len()].copy_from_slice(pixels);
            }
        }
        // Letters are added to the free places of theirs.
        id != TextureId::default()
    }

    /// Drops the pictures that are no longer used.
    pub fn free(&mut self, delta: &TexturesDelta) {
        delta.free.iter().for_each(|id| drop(self.textures.remove(id)));
    }
}
