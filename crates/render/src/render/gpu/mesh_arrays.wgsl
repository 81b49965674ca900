// The arrays of a mesh, or of pieces in place of some of its triangles, as all shaders read them.

struct Triangle {
    vertices: array<u32, 3>,
    neighbours: array<u32, 3>,
    orientation: u32,
    // The level, plus 64 where the triangle lies outside the domain.
    kind: u32,
}

@group(1) @binding(0) var<storage, read> triangles: array<Triangle>;
@group(1) @binding(1) var<storage, read> nodes_0: array<vec2<u32>>;
@group(1) @binding(2) var<storage, read> nodes_1: array<vec2<u32>>;
@group(1) @binding(3) var<storage, read> nodes_2: array<vec2<u32>>;
@group(1) @binding(4) var<storage, read> nodes_3: array<vec2<u32>>;
// Of the whole mesh, while `triangles` are one part of it. Unused for pieces.
@group(1) @binding(5) var<storage, read> draw_flags: array<u32>;
// Lists of entries, of the whole mesh: two to a word, each as its place in its block.
@group(1) @binding(6) var<storage, read> lists: array<u32>;
@group(1) @binding(7) var<uniform> part: Part;

struct Part {
    // Index of the first of `triangles` in the mesh.
    first: u32,
    // The first place of their lists.
    first_place: u32,
    // Binary logarithm of the nodes in a buffer.
    node_chunk_bits: u32,
}

// No neighbour.
const BOUNDARY: u32 = 0xffffffffu;

// A triangle that is drawn has no flags. Of one that is not drawn, this says whether pieces are in its place.
const HAS_PIECES: u32 = 4u;

fn flags_of(triangle: u32) -> u32 {
    return (draw_flags[triangle / 8u] >> (4u * (triangle % 8u))) & 0xfu;
}

fn node_at(node: u32) -> vec2<u32> {
    let place = node & ((1u << part.node_chunk_bits) - 1u);
    var p: vec2<u32>;
    switch node >> part.node_chunk_bits {
        case 0u: { p = nodes_0[place]; }
        case 1u: { p = nodes_1[place]; }
        case 2u: { p = nodes_2[place]; }
        default: { p = nodes_3[place]; }
    }
    return p;
}

// For each corner, half the line width if the opposite edge is a boundary edge: no neighbour draws the other
// half there. `boundary` is in the order of the neighbours.
fn rims(entry: u32, level: u32, boundary: vec3<bool>, rim_px: f32) -> vec3<f32> {
    let odd = level & 1u;
    let apex = 1u + odd;
    // Neighbours are anticlockwise, the one across the bisection edge first.
    let second = select(2u - 2u * odd, odd, triangles[entry].orientation == 0u);
    var out = vec3(0.0);
    out[apex] = select(0.0, rim_px, boundary[0]);
    out[second] = select(0.0, rim_px, boundary[1]);
    out[3u - apex - second] = select(0.0, rim_px, boundary[2]);
    return out;
}

fn boundary_of_triangle(entry: u32) -> vec3<bool> {
    return vec3(
        is_vacant(triangles[entry].neighbours[0]),
        is_vacant(triangles[entry].neighbours[1]),
        is_vacant(triangles[entry].neighbours[2]),
    );
}

// Whether nothing is drawn in the place of a neighbour.
fn is_vacant(neighbour: u32) -> bool {
    if neighbour == BOUNDARY {
        return true;
    }
    let flags = flags_of(neighbour);
    return flags != 0u && (flags & HAS_PIECES) == 0u;
}

fn boundary_of_piece(entry: u32) -> vec3<bool> {
    return vec3(
        triangles[entry].neighbours[0] == BOUNDARY,
        triangles[entry].neighbours[1] == BOUNDARY,
        triangles[entry].neighbours[2] == BOUNDARY,
    );
}
