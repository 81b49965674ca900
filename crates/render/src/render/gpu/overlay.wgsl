// Multiplies the canvas by a raster with nearest sampling at any zoom.

struct View {
    // Column and row in the middle of the canvas: whole texels, and the rest from 0 to 1.
    texel: vec2<i32>,
    fraction: vec2<f32>,
    texels_per_px: vec2<f32>,
    half_size_px: vec2<f32>,
    // The colour beyond the raster.
    beyond: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var raster: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From the middle of the canvas, y upwards.
    @location(0) px: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) corner: u32) -> Corner {
    let unit = vec2(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u));
    var out: Corner;
    out.position = vec4(unit, 0.0, 1.0);
    out.px = unit * view.half_size_px;
    return out;
}

@fragment
fn fs_main(in: Corner) -> @location(0) vec4<f32> {
    let texel = view.texel + vec2<i32>(floor(view.fraction + in.px * view.texels_per_px));
    let size = vec2<i32>(textureDimensions(raster));
    if any(texel < vec2(0)) || any(texel >= size) {
        return view.beyond;
    }
    return textureLoad(raster, texel, 0);
}
