// Draws the triangles of mesh_arrays.wgsl in space: those of the mesh (vs_main), or pieces in place of some of
// them (vs_piece). scene/space_camera.rs and software/space.rs have the same projection and the same light.
//
// Nodes have three whole numbers, the third being their height. The point in the middle of the canvas is
// subtracted in integers; only the difference is converted to f32. Positions are in pixels from the middle of
// the canvas: to the right, upwards, and towards the viewer.

struct Level {
    fill: vec3<f32>,
    edge_alpha: f32,
    edge: vec3<f32>,
    unused: u32,
}

struct View {
    // Pixels for a step along each axis.
    right: vec3<f32>,
    edge_reach_px: f32,
    up: vec3<f32>,
    rim_px: f32,
    towards: vec3<f32>,
    seam_slack_px: f32,
    anchor: vec3<i32>,
    huge_px: f32,
    fraction: vec3<f32>,
    // Lengths of legs up to which edges are invisible, and from which on they are drawn in full, in pixels.
    fade_from_px: f32,
    // Lengths of a step along each axis, in one unit.
    shape: vec3<f32>,
    fade_to_px: f32,
    light: vec3<f32>,
    ambient: f32,
    to_viewer: vec3<f32>,
    strength: f32,
    half_size_px: vec2<f32>,
    // The position of the nearest point towards the viewer, and the reciprocal of the range of positions.
    nearest_px: f32,
    per_px: f32,
    levels: array<Level, 64>,
}

@group(0) @binding(0) var<uniform> view: View;
// For each node its height in steps.
@group(0) @binding(1) var<storage, read> heights: array<u32>;

// A node without a height.
const NO_HEIGHT: u32 = 0xffffffffu;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Distances from the three edges in pixels.
    @location(0) inside_px: vec3<f32>,
    @location(1) @interpolate(flat) fill: vec3<f32>,
    @location(2) @interpolate(flat) edge: vec4<f32>,
    // Subtracted from each distance, so that boundary edges get their full width.
    @location(3) @interpolate(flat) rims_px: vec3<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    if flags_of(part.first + entry) != 0u {
        return nowhere();
    }
    return corner_of(entry, index % 3u, boundary_of_triangle(entry));
}

@vertex
fn vs_piece(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    if triangles[entry].kind >= 64u {
        return nowhere();
    }
    return corner_of(entry, index % 3u, boundary_of_piece(entry));
}

// All three corners in one point: nothing is drawn.
fn nowhere() -> Corner {
    return Corner(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0), vec3(0.0), vec4(0.0), vec3(0.0));
}

// Steps from the middle of the canvas to a node. Coordinates and heights are at most 2³⁰, so the difference
// fits.
fn steps_from_anchor(node: u32) -> vec3<i32> {
    return bitcast<vec3<i32>>(vec3(node_at(node), heights[node])) - view.anchor;
}

// The pixels of a difference of nodes.
fn px_from_steps(steps: vec3<f32>) -> vec3<f32> {
    return vec3(dot(view.right, steps), dot(view.up, steps), dot(view.towards, steps));
}

fn cross_of(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn corner_of(entry: u32, corner: u32, boundary: vec3<bool>) -> Corner {
    let nodes = array(triangles[entry].vertices[0], triangles[entry].vertices[1], triangles[entry].vertices[2]);
    if heights[nodes[0]] == NO_HEIGHT || heights[nodes[1]] == NO_HEIGHT || heights[nodes[2]] == NO_HEIGHT {
        return nowhere();
    }
    let steps = array(steps_from_anchor(nodes[0]), steps_from_anchor(nodes[1]), steps_from_anchor(nodes[2]));
    let to_b = vec3<f32>(steps[1] - steps[0]);
    let to_c = vec3<f32>(steps[2] - steps[0]);
    let b_px = px_from_steps(to_b);
    let c_px = px_from_steps(to_c);
    let opposite_px = px_from_steps(vec3<f32>(steps[2] - steps[1])).xy;
    let doubled_area = cross_of(b_px.xy, c_px.xy);
    if doubled_area == 0.0 {
        return nowhere();
    }
    let lengths = vec3(length(opposite_px), length(c_px.xy), length(b_px.xy));
    let level_number = triangles[entry].kind % 64u;
    let level = view.levels[level_number];
    let least_px = abs(doubled_area) / max(lengths.x, max(lengths.y, lengths.z));
    var out: Corner;
    let extent = max(max(abs(b_px.xy), abs(c_px.xy)), abs(opposite_px));
    let at = px_from_steps(vec3<f32>(steps[corner]) - view.fraction);
    if max(extent.x, extent.y) >= view.huge_px {
        let a_px = px_from_steps(vec3<f32>(steps[0]) - view.fraction);
        out = huge_corner(corner, array(a_px, a_px + b_px, a_px + c_px), doubled_area);
    } else {
        out.position = clip(at);
        out.inside_px[corner] = abs(doubled_area) / lengths[corner];
    }
    let lit = brightness(to_b, to_c);
    out.fill = min(level.fill * lit, vec3(1.0));
    out.edge = vec4(min(level.edge * lit, vec3(1.0)), level.edge_alpha * fade(1.4142135 * least_px));
    out.rims_px = rims(entry, level_number, boundary, view.rim_px);
    return out;
}

fn clip(px: vec3<f32>) -> vec4<f32> {
    return vec4(px.xy / view.half_size_px, (view.nearest_px - px.z) * view.per_px, 1.0);
}

// How bright a triangle between two edges is: 1 where it is level.
fn brightness(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let normal = cross(a * view.shape, b * view.shape);
    let up = normalize(select(normal, -normal, normal.z < 0.0));
    // From below, only the light from everywhere reaches the viewer.
    let lit = select(max(dot(up, view.light), 0.0), 0.0, dot(up, view.to_viewer) < 0.0);
    return view.ambient + view.strength * lit;
}

fn fade(leg_px: f32) -> f32 {
    let t = clamp((leg_px - view.fade_from_px) / (view.fade_to_px - view.fade_from_px), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// A corner of a triangle that covers the whole canvas; the fragment shader discards what is outside the huge
// triangle.
fn huge_corner(corner: u32, corners: array<vec3<f32>, 3>, doubled_area: f32) -> Corner {
    let unit = vec2(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u));
    let px = unit * view.half_size_px;
    let lines = array(
        line(corners[1].xy, corners[2].xy, doubled_area),
        line(corners[2].xy, corners[0].xy, doubled_area),
        line(corners[0].xy, corners[1].xy, doubled_area),
    );
    let to_b = corners[1] - corners[0];
    let to_c = corners[2] - corners[0];
    let slope = vec2(to_b.z * to_c.y - to_c.z * to_b.y, to_b.x * to_c.z - to_c.x * to_b.z) / doubled_area;
    let depth = corners[0].z + dot(slope, px - corners[0].xy);
    var out: Corner;
    out.position = clip(vec3(px, depth));
    out.inside_px = vec3(dot(lines[0], vec3(px, 1.0)), dot(lines[1], vec3(px, 1.0)), dot(lines[2], vec3(px, 1.0)));
    return out;
}

// The half-plane of an edge, positive inside: xy · px + z is the distance in pixels. Both triangles at an edge
// begin at its nearer end, so that their half-planes are each other's complement.
fn line(start: vec2<f32>, end: vec2<f32>, doubled_area: f32) -> vec3<f32> {
    let is_swapped = dot(end, end) < dot(start, start);
    let from_px = select(start, end, is_swapped);
    let along = normalize(select(end, start, is_swapped) - from_px);
    let left = vec3(-along.y, along.x, along.y * from_px.x - along.x * from_px.y);
    return select(left, -left, is_swapped != (doubled_area < 0.0));
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
