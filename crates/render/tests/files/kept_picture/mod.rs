//! Writes pictures of tests into a folder, for a person to look at.

use meshbrush_render::render::Image;

/// Writes a picture into the folder that the environment names, if it names one.
pub fn keep(image: &Image, name: &str) {
    let Some(folder) = std::env::var_os("MESHBRUSH_PICTURES") else { return };
    let file = std::fs::File::create(std::path::Path::new(&folder).join(format!("{name}.png"))).unwrap();
    let mut encoder = png::Encoder::new(file, image.size[0], image.size[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&image.rgba).unwrap();
}
