// Copies a picture to a canvas of the same size, pixel by pixel.

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From 0 to 1, from the upper left.
    @location(0) place: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) corner: u32) -> Corner {
    let unit = vec2(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u));
    var out: Corner;
    out.position = vec4(unit, 0.0, 1.0);
    out.place = vec2(0.5 + 0.5 * unit.x, 0.5 - 0.5 * unit.y);
    return out;
}

@fragment
fn fs_main(in: Corner) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(picture));
    return textureLoad(picture, vec2<i32>(in.place * size), 0);
}
