// Copies a picture to a canvas of the same size, pixel by pixel.
//
// Mesa's llvmpipe, which emulates a GPU, copies whole rows instead of shading each pixel if
//   - the fragment shader only reads a texture, at two components of an input that has more than two,
//   - the picture and the canvas have the same format.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var nearest: sampler;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From 0 to 1, from the upper left; the other components are not used.
    @location(0) place: vec4<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) corner: u32) -> Corner {
    let unit = vec2(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u));
    var out: Corner;
    out.position = vec4(unit, 0.0, 1.0);
    out.place = vec4(0.5 + 0.5 * unit.x, 0.5 - 0.5 * unit.y, 0.0, 1.0);
    return out;
}

@fragment
fn fs_main(in: Corner) -> @location(0) vec4<f32> {
    return textureSample(picture, nearest, in.place.xy);
}
