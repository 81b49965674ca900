// Draws triangles directly from their arrays, mesh_arrays.wgsl: three vertices per entry, fetched by index. They are
// those of the mesh (vs_main), or pieces in place of some of them (vs_piece).
//
// In a picture with a detail level, triangles finer than it are merged into their ancestors of that level
// (vs_merging, or vs_listed where triangles are listed); scene/detail.rs says how and has the same functions.
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
    unused: u32,
    rim_px: f32,
    huge_px: f32,
    fill_opacity: f32,
    // Unused where no triangles are merged.
    detail_level: u32,
    // How often the side of a coarse cell can be halved: its binary logarithm in lattice steps.
    halvings: u32,
    levels: array<Level, 64>,
}

@group(0) @binding(0) var<uniform> view: View;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Distances from the three edges in pixels.
    @location(0) inside_px: vec3<f32>,
    @location(1) @interpolate(flat) fill: vec3<f32>,
    @location(2) @interpolate(flat) edge: vec4<f32>,
    // Subtracted from each distance, so that boundary edges get their full width.
    @location(3) @interpolate(flat) rims_px: vec3<f32>,
}

// Entries of a block; places of a list are within a block.
const BLOCK: u32 = 16384u;

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    return shown_as_it_is(entry, index % 3u, triangles[entry].kind % 64u);
}

@vertex
fn vs_merging(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    let level_number = triangles[entry].kind % 64u;
    if level_number > view.detail_level {
        let inner = inner_point(entry, level_number);
        return merged(entry, index % 3u, level_number, inner, represents(level_number, inner));
    }
    return shown_as_it_is(entry, index % 3u, level_number);
}

// Places of a list that are drawn are those of triangles that represent others, or are not finer than the
// detail level.
@vertex
fn vs_listed(@builtin(vertex_index) index: u32) -> Corner {
    let place = index / 3u;
    let word = lists[(part.first_place + place) / 2u];
    let entry = (place & ~(BLOCK - 1u)) + ((word >> (16u * (place % 2u))) & 0xffffu);
    let level_number = triangles[entry].kind % 64u;
    if level_number > view.detail_level {
        return merged(entry, index % 3u, level_number, inner_point(entry, level_number), true);
    }
    return shown_as_it_is(entry, index % 3u, level_number);
}

fn shown_as_it_is(entry: u32, corner: u32, level_number: u32) -> Corner {
    let level = view.levels[level_number];
    var placement: Placement;
    if flags_of(part.first + entry) != 0u {
        placement = nowhere();
    } else if level.huge != 0u {
        placement = huge_corner(entry, corner);
    } else {
        let steps = steps_from_anchor(triangles[entry].vertices[corner]);
        placement.px = px_from_steps(steps);
        placement.inside_px = inside_at_corner(corner, level_number, level.apex_height_px, level.base_height_px);
    }
    var rims_px = vec3(0.0);
    if level.edge_alpha > 0.0 {
        rims_px = rims(entry, level_number, boundary_of_triangle(entry), view.rim_px);
    }
    return shaded(placement, level, rims_px);
}

@vertex
fn vs_piece(@builtin(vertex_index) index: u32) -> Corner {
    let entry = index / 3u;
    let corner = index % 3u;
    let level_number = triangles[entry].kind % 64u;
    var placement: Placement;
    if triangles[entry].kind >= 64u {
        placement = nowhere();
    } else {
        placement = piece_corner(entry, corner);
    }
    let rims_px = rims(entry, level_number, boundary_of_piece(entry), view.rim_px);
    return shaded(placement, view.levels[level_number], rims_px);
}

// The ancestor that a triangle represents. Where pieces are in the place of the triangle, they are drawn over
// it.
fn merged(entry: u32, corner: u32, level_number: u32, inner: vec2<u32>, represents: bool) -> Corner {
    var placement = nowhere();
    if represents && !is_vacant(part.first + entry) {
        let steps = bitcast<vec2<i32>>(ancestor_corner(corner, inner)) - view.anchor;
        placement.px = px_from_steps(steps);
    }
    return shaded(placement, view.levels[level_number], vec3(0.0));
}

// A point inside a triangle, in quarters of a lattice step: the mean of the corners in which the apex counts
// twice.
fn inner_point(entry: u32, level: u32) -> vec2<u32> {
    let a = node_at(triangles[entry].vertices[0]);
    let b = node_at(triangles[entry].vertices[1]);
    let c = node_at(triangles[entry].vertices[2]);
    return a + b + c + select(b, c, (level & 1u) == 1u);
}

// A point in a square cell of the grid.
struct Place {
    cell: vec2<u32>,
    // From the lower left corner of the cell, in quarters of a lattice step, as is the side.
    at: vec2<u32>,
    side: u32,
    is_right: bool,
    is_low: bool,
}

fn place_in_cell(level: u32, inner: vec2<u32>) -> Place {
    let bits = view.halvings + 2u - level / 2u;
    var out: Place;
    out.side = 1u << bits;
    out.cell = inner >> vec2(bits);
    out.at = inner & vec2(out.side - 1u);
    out.is_right = out.at.x > out.at.y;
    out.is_low = out.at.x < out.side - out.at.y;
    return out;
}

// Whether a triangle represents its ancestor at the detail level.
fn represents(level: u32, inner: vec2<u32>) -> bool {
    for (var finer = level; finer > view.detail_level; finer--) {
        if !is_chosen(finer, inner) {
            return false;
        }
    }
    return true;
}

// Whether the triangle of `level` around a point has the representative of its parent.
fn is_chosen(level: u32, inner: vec2<u32>) -> bool {
    let place = place_in_cell(level - 1u, inner);
    let is_along_x = place.is_right == place.is_low;
    var half = is_along_x;
    var parent = 0u;
    if (level & 1u) == 0u {
        half = select(place.at.y, place.at.x, is_along_x) >= place.side / 2u;
        parent = 1u + 2u * u32(place.is_right) + u32(place.is_low);
    }
    return half == coin(place.cell, 8u * level + parent);
}

// A random bit for a triangle: a function of its cell and number.
fn coin(cell: vec2<u32>, number: u32) -> bool {
    var hash = (cell.x * 0x9e3779b1u) ^ (cell.y * 0x85ebca77u) ^ (number * 0xc2b2ae3du);
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12u)) * 0x297a2d39u;
    return (hash >> 31u) == 1u;
}

// A corner of the triangle of the detail level around a point, on the lattice.
fn ancestor_corner(corner: u32, inner: vec2<u32>) -> vec2<u32> {
    let place = place_in_cell(view.detail_level, inner);
    let side = place.side / 4u;
    let origin = place.cell * side;
    var to = vec2(0u);
    if (view.detail_level & 1u) == 1u {
        if corner == 0u {
            return origin + vec2(side / 2u);
        }
        // The ends of a side of the cell.
        let is_first = corner == 1u;
        if place.is_right == place.is_low {
            to = vec2(u32(is_first), u32(!place.is_low));
        } else {
            to = vec2(u32(place.is_right), u32(is_first));
        }
    } else if ((place.cell.x + place.cell.y) & 1u) == 0u {
        // The diagonal joins the corners whose sum of columns and rows is even.
        to = select(vec2(u32(corner == 1u)), vec2(u32(place.is_right), u32(!place.is_right)), corner == 0u);
    } else {
        let end = vec2(u32(corner == 1u), u32(corner != 1u));
        to = select(end, vec2(u32(!place.is_low)), corner == 0u);
    }
    return origin + to * side;
}

fn shaded(placement: Placement, level: Level, rims_px: vec3<f32>) -> Corner {
    var out: Corner;
    out.position = vec4(placement.px / view.half_size_px, 0.0, 1.0);
    out.inside_px = placement.inside_px;
    out.fill = level.fill;
    out.edge = vec4(level.edge, level.edge_alpha);
    out.rims_px = rims_px;
    return out;
}

struct Placement {
    px: vec2<f32>,
    inside_px: vec3<f32>,
}

// All three corners in one point: nothing is drawn.
fn nowhere() -> Placement {
    return Placement(vec2(0.0), vec3(0.0));
}

fn px_from_steps(steps_from_anchor: vec2<i32>) -> vec2<f32> {
    return (vec2<f32>(steps_from_anchor) - view.fraction) * view.px_per_step;
}

// Lattice steps from the camera's anchor to a node. Lattice coordinates are at most 2³⁰, so the difference
// fits.
fn steps_from_anchor(node: u32) -> vec2<i32> {
    return bitcast<vec2<i32>>(node_at(node)) - view.anchor;
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

// A corner of a triangle of any shape. Its size and heights are calculated from differences of lattice
// coordinates, which are exact.
fn piece_corner(entry: u32, corner: u32) -> Placement {
    let own = steps_from_anchor(triangles[entry].vertices[corner]);
    let next = steps_from_anchor(triangles[entry].vertices[(corner + 1u) % 3u]);
    let last = steps_from_anchor(triangles[entry].vertices[(corner + 2u) % 3u]);
    let to_next = vec2<f32>(next - own) * view.px_per_step;
    let to_last = vec2<f32>(last - own) * view.px_per_step;
    let opposite = vec2<f32>(last - next) * view.px_per_step;
    let extent = max(max(abs(to_next), abs(to_last)), abs(opposite));
    if max(extent.x, extent.y) >= view.huge_px {
        return huge_corner(entry, corner);
    }
    let doubled_area = abs(to_next.x * to_last.y - to_next.y * to_last.x);
    var out: Placement;
    out.px = px_from_steps(own);
    out.inside_px[corner] = doubled_area / length(opposite);
    return out;
}

// A corner of a triangle that covers the whole canvas; the fragment shader discards what is outside the huge
// triangle. If the canvas lies beyond one of its edges, all corners are off the canvas.
fn huge_corner(entry: u32, corner: u32) -> Placement {
    let a = steps_from_anchor(triangles[entry].vertices[0]);
    let b = steps_from_anchor(triangles[entry].vertices[1]);
    let c = steps_from_anchor(triangles[entry].vertices[2]);
    let half_planes = array(half_plane(entry, b, c), half_plane(entry, c, a), half_plane(entry, a, b));
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

// The half-plane of an edge, positive inside the triangle: xy · px + z is the distance in pixels. `start` and
// `end` are in the order of the vertices.
//
// The cross product of lattice coordinates is exact in 64 bits. Only its sum with the remainder, which is at
// most as large as the length of the edge, is an f32.
fn half_plane(entry: u32, start: vec2<i32>, end: vec2<i32>) -> vec3<f32> {
    let along = end - start;
    let along_f32 = vec2<f32>(along);
    let whole = difference(product(along.y, start.x), product(along.x, start.y));
    let cross = whole + (along_f32.x * view.fraction.y - along_f32.y * view.fraction.x);
    let along_px = along_f32 * view.px_per_step;
    let length_px = length(along_px);
    let left = vec3(
        -along_px.y / length_px,
        along_px.x / length_px,
        cross * (view.px_per_step.x * view.px_per_step.y / length_px),
    );
    return select(left, -left, triangles[entry].orientation == 0u);
}

// A product in 64 bits, the low half first, in two's complement.
fn product(a: i32, b: i32) -> vec2<u32> {
    let x = bitcast<u32>(a);
    let y = bitcast<u32>(b);
    let x_low = x & 0xffffu;
    let x_high = x >> 16u;
    let y_low = y & 0xffffu;
    let y_high = y >> 16u;
    let first = x_high * y_low + ((x_low * y_low) >> 16u);
    let second = x_low * y_high + (first & 0xffffu);
    let high = x_high * y_high + (first >> 16u) + (second >> 16u);
    // A negative factor was read as itself plus 2³².
    return vec2(x * y, high - select(0u, y, a < 0) - select(0u, x, b < 0));
}

// a − b, rounded once or twice.
fn difference(a: vec2<u32>, b: vec2<u32>) -> f32 {
    var low = a.x - b.x;
    var high = a.y - b.y - select(0u, 1u, a.x < b.x);
    let is_negative = high >= 0x80000000u;
    if is_negative {
        low = ~low + 1u;
        high = ~high + select(0u, 1u, low == 0u);
    }
    let magnitude = f32(high) * 4294967296.0 + f32(low);
    return select(magnitude, -magnitude, is_negative);
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
    // Premultiplied.
    return mix(vec4(in.fill, 1.0) * view.fill_opacity, vec4(in.edge.rgb, 1.0), share);
}
