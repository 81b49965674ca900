//! Triangles that are refined to one depth everywhere, ready to be copied.

use std::ops::Range;
use std::sync::LazyLock;

use crate::geometry::{Lattice, LatticePoint, Rect};
use crate::mesh::kernel::{
    CoarseIndex, LevelAndSide, LevelAndSideCounts, Mesh, Neighbour, NodeId, Orientation, Triangle, TriangleId,
};

/// The most levels by which a block is refined: 256 triangles, 8 KB of them.
pub(super) const MOST_DEPTH: u32 = 8;

/// A triangle after a number of uniform bisections, with its own numbering.
///
/// ```text
///                 2
///               / | \            slots of nodes: the three corners, then the nodes within each edge,
///             8   |   7          anticlockwise and the bisection edge first, then those inside
///           /   \ | /   \
///         0 - 3 - 4 - 5 - 1
/// ```
///
/// Its triangles and inner nodes are in the order in which bisection makes them.
#[derive(Debug)]
pub(super) struct Template {
    /// Vertices are slots, and neighbours places in this array; across the edges of the block, place 0.
    pub triangles: Vec<Triangle>,
    /// The neighbours of triangle 0: place, and which of their neighbours it is.
    pub around_first: Vec<TemplateEdge>,
    /// For each edge of the block the triangles along it, anticlockwise around the block.
    pub borders: [Vec<TemplateEdge>; 3],
    /// For each slot its node as a mean of the corners: how much each of them counts.
    weights: Vec<[u16; 3]>,
    /// For each slot one of the triangles around it.
    pub triangle_at: Vec<u32>,
    depth: u32,
}

/// An edge of a triangle of a template: its place, and the number of the edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct TemplateEdge {
    pub triangle: u32,
    pub edge: u8,
}

/// The templates, by depth, parity of the level, and orientation.
static TEMPLATES: LazyLock<Vec<Template>> = LazyLock::new(|| {
    let mut templates = Vec::new();
    for depth in 0..=MOST_DEPTH {
        for orientation in [Orientation::Clockwise, Orientation::Anticlockwise] {
            templates.extend([0, 1].map(|level| Template::new(depth, level, orientation)));
        }
    }
    templates
});

/// Returns how often an edge is halved in a block of this depth; edge 0 is the bisection edge.
#[inline]
pub(super) fn halvings(depth: u32, edge: usize) -> u32 {
    (depth + u32::from(edge == 0)) / 2
}

/// Returns how many nodes lie within an edge of a block.
#[inline]
pub(super) fn nodes_within(depth: u32, edge: usize) -> u32 {
    (1 << halvings(depth, edge)) - 1
}

impl Template {
    /// Returns the parity of the level and the orientation of a triangle, as a number below four.
    #[inline]
    pub fn form(triangle: &Triangle) -> usize {
        2 * (triangle.orientation() as usize) + (triangle.level() & 1) as usize
    }

    /// Returns the template of triangles of this form that are refined by `depth` levels.
    #[inline]
    pub fn of_form(form: usize, depth: u32) -> &'static Self {
        &TEMPLATES[4 * depth as usize + form]
    }

    /// Returns how many nodes lie within an edge of the block.
    #[inline]
    pub fn nodes_within(&self, edge: usize) -> u32 {
        nodes_within(self.depth, edge)
    }

    /// Returns the slots of the nodes inside the block.
    #[inline]
    pub fn inner_slots(&self) -> Range<usize> {
        let on_edges: u32 = (0..3).map(|edge| self.nodes_within(edge)).sum();
        3 + on_edges as usize..self.triangle_at.len()
    }

    /// Returns the point of a slot in a block with these corners.
    #[inline]
    pub fn point(&self, slot: usize, [a, b, c]: [LatticePoint; 3]) -> LatticePoint {
        let weights = self.weights[slot].map(u64::from);
        let mean = |of: [u32; 3]| {
            let [a, b, c] = of.map(u64::from);
            (a * weights[0] + b * weights[1] + c * weights[2]) >> weight_bits(self.depth)
        };
        let at = |a, b, c| mean([a, b, c]) as u32;
        LatticePoint::new(at(a.x, b.x, c.x), at(a.y, b.y, c.y))
    }

    /// Bisects a triangle of this level, 0 or 1, and numbers the resulting triangles.
    fn new(depth: u32, level: u32, orientation: Orientation) -> Self {
        let block = single_triangle(depth, level, orientation);
        let mesh = refined(block.clone(), level + depth);
        let weights: Vec<_> = mesh.nodes.iter().map(|&node| weights(&block, node)).collect();
        let edges = block.triangles[0].edges();
        let order = order_of_slots(edges, &weights);
        let mut slot_of = vec![NodeId(0); order.len()];
        for (slot, &node) in order.iter().enumerate() {
            slot_of[node] = NodeId::from_index(slot);
        }
        let numbered = |triangle: &Triangle| {
            let vertices = triangle.vertices.map(|node| slot_of[node.index()]);
            let places = triangle.raw_neighbours.map(|n| n.triangle().unwrap_or(TriangleId(0)).into());
            triangle.renumbered(vertices, places, triangle.level_and_side())
        };
        Self {
            triangles: mesh.triangles.iter().map(numbered).collect(),
            around_first: sides(&mesh)
                .filter(|&(_, across)| across == TriangleId(0).into())
                .map(|(side, _)| side)
                .collect(),
            borders: edges.map(|edge| border(&mesh, edge, &weights)),
            weights: order.iter().map(|&node| weights[node]).collect(),
            triangle_at: order.iter().map(|&node| mesh.triangle_at[node].0).collect(),
            depth,
        }
    }
}

/// Returns the logarithm of the sum of a node's weights.
#[inline]
fn weight_bits(depth: u32) -> u32 {
    depth.div_ceil(2)
}

/// Returns a mesh of one triangle, with its right angle at the origin. Its legs have as many steps as the
/// weights of a node add up to.
fn single_triangle(depth: u32, level: u32, orientation: Orientation) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 1.0, 2).expect("the unit square has a grid");
    let steps = 1 << weight_bits(depth);
    let (right, up) = (LatticePoint::new(steps, 0), LatticePoint::new(0, steps));
    let apex = LatticePoint::new(0, 0);
    // Both ways round the apex comes last at the odd level, and second at the even one.
    let nodes = match (level, orientation) {
        (1, Orientation::Anticlockwise) => vec![right, up, apex],
        (1, Orientation::Clockwise) => vec![up, right, apex],
        (_, Orientation::Anticlockwise) => vec![up, apex, right],
        (_, Orientation::Clockwise) => vec![right, apex, up],
    };
    let kind = LevelAndSide::inside(level);
    let mut counts = LevelAndSideCounts::default();
    counts.add(kind);
    let vertices = [0, 1, 2].map(NodeId);
    let triangle = Triangle::new(vertices, [Neighbour::BOUNDARY; 3], orientation, kind);
    let (triangles, triangle_at) = (vec![triangle], vec![TriangleId(0); 3]);
    Mesh { lattice, nodes, triangles, triangle_at, counts, coarse: CoarseIndex::default() }
}

/// Returns the mesh with all triangles of this level.
fn refined(mut mesh: Mesh, level: u32) -> Mesh {
    while let Some(coarse) = mesh.triangles.iter().position(|triangle| triangle.level() < level) {
        mesh.refine_triangle(TriangleId::from_index(coarse));
    }
    mesh
}

/// Returns a node of the block as the weighted mean of its corners: their weights, in the order of its
/// vertices.
fn weights(block: &Mesh, node: LatticePoint) -> [u16; 3] {
    let steps = block.nodes.iter().map(|corner| corner.x).max().unwrap_or_default();
    block.corners(TriangleId(0)).map(|corner| match (corner.x, corner.y) {
        (0, 0) => steps - node.x - node.y,
        (_, 0) => node.x,
        _ => node.y,
    } as u16)
}

/// The places of two vertices of the block, as in [`Triangle::edges`].
type Edge = (usize, usize);

/// Returns whether a node with these weights lies on an edge of the block.
fn is_on((from, to): Edge, weights: [u16; 3]) -> bool {
    weights[3 - from - to] == 0
}

/// Returns for each slot its node in the mesh.
fn order_of_slots(edges: [Edge; 3], weights: &[[u16; 3]]) -> Vec<usize> {
    let others = 3..weights.len();
    let mut order = vec![0, 1, 2];
    for edge in edges {
        let first = order.len();
        order.extend(others.clone().filter(|&node| is_on(edge, weights[node])));
        order[first..].sort_by_key(|&node| weights[node][edge.1]);
    }
    order.extend(others.filter(|&node| !edges.iter().any(|&edge| is_on(edge, weights[node]))));
    order
}

/// Returns the edges of all triangles, with what lies across.
fn sides(mesh: &Mesh) -> impl Iterator<Item = (TemplateEdge, Neighbour)> + '_ {
    mesh.triangles.iter().zip(0..).flat_map(|(triangle, id)| {
        let across = triangle.raw_neighbours.into_iter().zip(0..);
        across.map(move |(across, edge)| (TemplateEdge { triangle: id, edge }, across))
    })
}

/// Returns the sides along an edge of the block, from its beginning to its end.
fn border(mesh: &Mesh, edge: Edge, weights: &[[u16; 3]]) -> Vec<TemplateEdge> {
    let start = |side: &TemplateEdge| {
        let (from, to) = mesh.triangles[side.triangle as usize].edge_nodes()[usize::from(side.edge)];
        let [from, to] = [from, to].map(|node| weights[node.index()]);
        (is_on(edge, from) && is_on(edge, to)).then_some(from[edge.1])
    };
    let on_border = sides(mesh).filter(|&(_, across)| across == Neighbour::BOUNDARY).map(|(side, _)| side);
    let mut along: Vec<_> = on_border.filter(|side| start(side).is_some()).collect();
    along.sort_by_key(start);
    along
}
