// Draws triangles directly from the arrays of the mesh: three vertices per entry, fetched by index.
//
// Positions are in pixels from the middle of the canvas, y upwards. The position of the camera is subtracted
// from lattice coordinates in integers; only the difference is converted to f32.

struct Level {
    fill: vec3<f32>,
    apex_height_px: f32,
    edge: vec3<f32>,
    edge_alpha: f32,
    base_height_px: f32,
    huge: u32,
    unused: vec2<u32>,
}

struct View {
    anchor: vec2<i32>,
    fraction: vec2<f32>,
    px_per_step: vec2<f32>,
    half_size_px: vec2<f32>,
    edge_reach_px: f32,
    seam_slack_px: f32,
    node_chunk_bits: u32,
    rim_px: f32,
    levels: array<Level, 64>,
}

struct Triangle {
    vertices: array<u32, 3>,
    neighbours: array<u32, 3>,
    orientation: u32,
    // The level, plus 64 where the triangle lies outside the domain.
    kind: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<storage, read> triangles: array<Triangle>;
@group(1) @binding(1) var<storage, read> nodes_0: array<vec2<u32>>;
@group(1) @binding(2) var<storage, read> nodes_1: array<vec2<u32>>;
@group(1) @binding(3) var<storage, read> nodes_2: array<vec2<u32>>;
@group(1) @binding(4) var<storage, read> nodes_3: array<vec2<u32>>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Distances from the three edges in pixels.
    @location(0) inside_px: vec3<f32>,
    @location(1) @interpolate(flat) fill: vec3<f32>,
    @location(2) @interpolate(flat) edge: vec4<f32>,
    // Subtracted from each distance, so that boundary edges get their full width.
    @location(3) @interpolate(flat) rims_px: vec3<f32>,
}

// No neighbour.
const BOUNDARY: u32 = 0xffffffffu;

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    let corner = index % 3u;
    let level_number = triangles[entry].kind % 64u;
    let level = view.levels[level_number];
    var placement: Placement;
    if triangles[entry].kind >= 64u {
        // All three corners in one point: nothing is drawn.
        placement.px = vec2(0.0);
    } else if level.huge != 0u {
        placement = huge_corner(entry, corner);
    } else {
        let steps = steps_from_anchor(triangles[entry].vertices[corner]);
        placement.px = (vec2<f32>(steps) - view.fraction) * view.px_per_step;
        placement.inside_px = inside_at_corner(corner, level_number, level.apex_height_px, level.base_height_px);
    }
    var out: Corner;
    out.position = vec4(placement.px / view.half_size_px, 0.0, 1.0);
    out.inside_px = placement.inside_px;
    out.fill = level.fill;
    out.edge = vec4(level.edge, level.edge_alpha);
    out.rims_px = rims(entry, level_number);
    return out;
}

struct Placement {
    px: vec2<f32>,
    inside_px: vec3<f32>,
}

// Lattice steps from the camera's anchor to a node. Lattice coordinates are at most 2³⁰, so the difference
// fits.
fn steps_from_anchor(node: u32) -> vec2<i32> {
    let place = node & ((1u << view.node_chunk_bits) - 1u);
    var p: vec2<u32>;
    switch node >> view.node_chunk_bits {
        case 0u: { p = nodes_0[place]; }
        case 1u: { p = nodes_1[place]; }
        case 2u: { p = nodes_2[place]; }
        default: { p = nodes_3[place]; }
    }
    return bitcast<vec2<i32>>(p) - view.anchor;
}

// The distances of a corner from the three edges: its height from the opposite edge, 0 from the two others.
fn inside_at_corner(corner: u32, level: u32, apex_height_px: f32, base_height_px: f32) -> vec3<f32> {
    // The apex is the second vertex at even levels, the third at odd levels.
    let is_apex = corner == 1u + (level & 1u);
    let height = select(base_height_px, apex_height_px, is_apex);
    return vec3(
        select(0.0, height, corner == 0u),
        select(0.0, height, corner == 1u),
        select(0.0, height, corner == 2u),
    );
}

// For each corner, half the line width if the opposite edge is a boundary edge: no neighbour draws the other
// half there.
fn rims(entry: u32, level: u32) -> vec3<f32> {
    let odd = level & 1u;
    let apex = 1u + odd;
    // Neighbours are anticlockwise, the one across the bisection edge first.
    let second = select(2u - 2u * odd, odd, triangles[entry].orientation == 0u);
    var out = vec3(0.0);
    out[apex] = rim_towards(triangles[entry].neighbours[0]);
    out[second] = rim_towards(triangles[entry].neighbours[1]);
    out[3u - apex - second] = rim_towards(triangles[entry].neighbours[2]);
    return out;
}

fn rim_towards(neighbour: u32) -> f32 {
    return select(0.0, view.rim_px, neighbour == BOUNDARY);
}

// A corner of a triangle that covers the whole canvas; the fragment shader discards what is outside the huge
// triangle. If the canvas lies beyond one of its edges, all corners are off the canvas.
fn huge_corner(entry: u32, corner: u32) -> Placement {
    let a = steps_from_anchor(triangles[entry].vertices[0]);
    let b = steps_from_anchor(triangles[entry].vertices[1]);
    let c = steps_from_anchor(triangles[entry].vertices[2]);
    let half_planes = array(half_plane(b, c, a), half_plane(c, a, b), half_plane(a, b, c));
    let unit = vec2(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u));
    let px = unit * view.half_size_px;
    var out: Placement;
    out.px = px;
    out.inside_px =
        vec3(dot(half_planes[0], vec3(px, 1.0)), dot(half_planes[1], vec3(px, 1.0)), dot(half_planes[2], vec3(px, 1.0)));
    for (var i = 0; i < 3; i++) {
        let largest = dot(abs(half_planes[i].xy), view.half_size_px) + half_planes[i].z;
        if largest < -view.seam_slack_px {
            out.px = vec2(-2.0, -2.0) * view.half_size_px;
        }
    }
    return out;
}

// The half-plane of an edge, positive on the side of the opposite corner: xy · px + z is the distance in
// pixels.
//
// Edges run along an axis or a diagonal, so the normal has components −1, 0 and 1. Its product with a node
// fits an i32: on a line that meets the lattice in more than one point, only one coordinate can be near 2³⁰
// with that sign.
fn half_plane(start: vec2<i32>, end: vec2<i32>, opposite: vec2<i32>) -> vec3<f32> {
    let along = sign(end - start);
    var normal = vec2(-along.y, along.x);
    let across = opposite - start;
    if normal.x * across.x + normal.y * across.y < 0 {
        normal = -normal;
    }
    let steps_to_line = f32(normal.x * start.x + normal.y * start.y) - dot(vec2<f32>(normal), view.fraction);
    let per_px = vec2<f32>(normal) / view.px_per_step;
    return vec3(per_px, -steps_to_line) / length(per_px);
}

@fragment
fn fs_main(in: Corner) -> @location(0) vec4<f32> {
    let inside_px = min(in.inside_px.x, min(in.inside_px.y, in.inside_px.z));
    if inside_px < -view.seam_slack_px {
        discard;
    }
    let from_edge = in.inside_px - in.rims_px;
    let nearest_px = min(from_edge.x, min(from_edge.y, from_edge.z));
    let share = clamp(view.edge_reach_px - nearest_px, 0.0, 1.0) * in.edge.a;
    return vec4(mix(in.fill, in.edge.rgb, share), 1.0);
}
