//! Weirs as cracks in a mesh, as ADCIRC has them: its internal barrier boundaries.
//!
//! ```text
//!   ──o────────o───      A line in the domain. Its nodes are doubled, but for an end inside the domain,
//!     │ ╲    ╱ │         where both sides have the node in common. Triangles to the right get the new
//!     o──●══●──o──       nodes. ● is a pair of nodes at one place: front and back.
//!     │ ╱    ╲ │
//!   ──o────────o───
//! ```
//!
//! The front is on the left of the line, so that land is on the right of its nodes, as along other
//! boundaries. A line that ends on the boundary opens it: its end is doubled, too, and the string of the
//! boundary ends at the one node and goes on at the other. ADCIRC wants each node to be in one pair with one
//! other node: where more than two weirs meet, the nodes have no pair, and no water crosses within an edge of
//! that place.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap, HashSet};

use super::boundary_strings::{BoundaryString, StringKind};
use super::{MeshData, Number};
use meshbrush_core::outline::{LineEdges, WeirEdges};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};
use meshbrush_mesh::text::Grouped;

/// The least number of pairs of a weir: with one, it would have no edge.
const LEAST_PAIRS: usize = 2;

/// Two nodes at one place on both sides of a weir.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WeirPair {
    /// The node to the left of the line, and the one to the right.
    pub(super) nodes: [usize; 2],
    /// The height of the crest in metres, positive upwards.
    pub(super) crest: f64,
}

/// Pairs that follow one another along a weir.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WeirString<'a> {
    pub(super) line: &'a LineEdges,
    pub(super) weir: &'a WeirEdges,
    pub(super) pairs: Vec<WeirPair>,
}

/// What of the weirs of a mesh has no pairs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct WeirLosses {
    /// Edges on the boundary, by the numbers of their lines.
    pub(super) on_boundary: BTreeMap<usize, usize>,
    /// Edges that an earlier weir has, too.
    pub(super) shared: BTreeMap<usize, usize>,
    /// Edges of parts that are too short.
    pub(super) short: BTreeMap<usize, usize>,
    /// Nodes where more than two weirs meet, or where one touches the boundary between its ends.
    pub(super) junctions: Vec<usize>,
}

/// A mesh in which weirs are cracks. Nodes and triangles keep their numbers; new nodes follow.
#[derive(Debug, Default)]
pub(super) struct WeirCracks<'a> {
    nodes: usize,
    /// The node of the mesh at the place of each new node.
    added: Vec<usize>,
    /// The nodes of triangles that have other nodes than in the mesh.
    changed: HashMap<usize, [usize; 3]>,
    /// The triangle of each boundary edge with a doubled node.
    opened: HashMap<[usize; 2], usize>,
    pub(super) strings: Vec<WeirString<'a>>,
    pub(super) losses: WeirLosses,
}

impl<'a> WeirCracks<'a> {
    /// Returns the mesh as it is, for a format without weirs.
    pub(super) fn none(mesh: &Extract) -> Self {
        Self { nodes: mesh.nodes().len(), ..Self::default() }
    }

    /// Opens the mesh along its weirs. Takes time in proportion to the mesh where there are any.
    pub(super) fn new(mesh: &Extract, data: &MeshData<'a>) -> Self {
        let none = Self::none(mesh);
        if data.lines.iter().all(|line| line.weir.is_none()) {
            return none;
        }
        let mut losses = WeirLosses::default();
        let mut runs = runs(mesh, data.lines, &mut losses);
        loop {
            let crack = Crack::new(mesh, runs.iter().flat_map(|run| &run.edges));
            let strings: Vec<WeirString<'_>> = runs.iter().flat_map(|run| run.strings(&crack)).collect();
            let has_string = |run: &WeirRun<'_>| run.strings(&crack).next().is_some();
            let before = runs.len();
            let (stay, short): (Vec<_>, Vec<_>) = runs.into_iter().partition(has_string);
            for run in short {
                *losses.short.entry(run.number).or_default() += run.edges.len();
            }
            runs = stay;
            if runs.len() == before {
                losses.junctions = crack.junctions();
                let Crack { added, changed, opened, .. } = crack;
                return Self { added, changed, opened, strings, losses, ..none };
            }
        }
    }

    /// Returns the number of nodes with the new ones.
    pub(super) fn node_count(&self) -> usize {
        self.nodes + self.added.len()
    }

    /// Returns the values of all nodes: new ones have that of the node at their place.
    pub(super) fn values<'v>(&self, in_mesh: &'v [f64]) -> Cow<'v, [f64]> {
        match self.added.is_empty() {
            true => Cow::Borrowed(in_mesh),
            false => in_mesh.iter().copied().chain(self.added.iter().map(|&node| in_mesh[node])).collect(),
        }
    }

    /// Returns the node of the mesh at the place of a node.
    pub(super) fn origin(&self, node: usize) -> usize {
        node.checked_sub(self.nodes).map_or(node, |new| self.added[new])
    }

    /// Returns the nodes of a triangle, which has these in the mesh.
    pub(super) fn corners(&self, triangle: usize, in_mesh: [usize; 3]) -> [usize; 3] {
        self.changed.get(&triangle).copied().unwrap_or(in_mesh)
    }

    /// Returns a string of the boundary with the nodes that its edges have, in parts where weirs meet it. An
    /// island that a weir meets is no closed string any more, and so land.
    pub(super) fn opened(&self, mesh: &Extract, string: &BoundaryString) -> Vec<BoundaryString> {
        let edges = string.nodes.windows(2).map(|ends| {
            let Some(&triangle) = self.opened.get(&[ends[0], ends[1]]) else { return [ends[0], ends[1]] };
            let in_mesh = mesh.cell(TriangleId::from_index(triangle)).corners;
            let now = self.corners(triangle, in_mesh);
            [ends[0], ends[1]].map(|node| place_of(in_mesh, node).map_or(node, |place| now[place]))
        });
        let edges: Vec<[usize; 2]> = edges.collect();
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for [from, to] in edges {
            match parts.last_mut() {
                Some(part) if part.last() == Some(&from) => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        let is_loop = string.nodes.first() == string.nodes.last();
        if is_loop && parts.len() > 1 && parts[0].first() == parts[parts.len() - 1].last() {
            // The place where the list begins is none where the boundary is open.
            let first = parts.remove(0);
            parts[0..].last_mut().into_iter().for_each(|last| last.extend(&first[1..]));
        }
        let is_whole = parts.len() == 1 && parts[0].first() == parts[0].last();
        let kind =
            if string.kind == StringKind::Island && !is_whole { StringKind::Land } else { string.kind };
        parts.into_iter().map(|nodes| BoundaryString { kind, nodes, ..string.clone() }).collect()
    }
}

/// Edges of a weir that follow one another.
struct WeirRun<'a> {
    /// The number of the line.
    number: usize,
    line: &'a LineEdges,
    weir: &'a WeirEdges,
    edges: Vec<WeirEdge>,
}

/// An edge of a weir.
#[derive(Clone, Copy)]
struct WeirEdge {
    ends: [usize; 2],
    crests: [f64; 2],
}

/// Returns the runs of all weirs: edges with a triangle on both sides that no earlier weir has.
fn runs<'a>(mesh: &Extract, lines: &'a [LineEdges], losses: &mut WeirLosses) -> Vec<WeirRun<'a>> {
    let boundary: HashSet<[usize; 2]> = mesh.boundary_edges().map(|edge| sorted(edge.ends)).collect();
    let mut taken: HashSet<[usize; 2]> = HashSet::new();
    let mut runs = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let Some(weir) = &line.weir else { continue };
        let mut run: Vec<WeirEdge> = Vec::new();
        let mut end = |run: &mut Vec<WeirEdge>| {
            let edges = std::mem::take(run);
            if !edges.is_empty() {
                runs.push(WeirRun { number, line, weir, edges });
            }
        };
        for (edge, &crests) in line.edges.iter().zip(&weir.crests) {
            let key = sorted(edge.ends);
            let lost = match (boundary.contains(&key), !taken.insert(key)) {
                (true, _) => Some(&mut losses.on_boundary),
                (false, true) => Some(&mut losses.shared),
                (false, false) => None,
            };
            if lost.is_some() || run.last().is_some_and(|last| last.ends[1] != edge.ends[0]) {
                end(&mut run);
            }
            match lost {
                Some(lost) => *lost.entry(number).or_default() += 1,
                None => run.push(WeirEdge { ends: edge.ends, crests }),
            }
        }
        end(&mut run);
    }
    runs
}

impl<'a> WeirRun<'a> {
    /// Returns its pairs, in strings between nodes that have none.
    fn strings<'s>(&'s self, crack: &'s Crack) -> impl Iterator<Item = WeirString<'a>> + 's {
        let first = self.edges.iter().take(1).map(|edge| (edge, 0));
        let nodes: Vec<Option<WeirPair>> = first
            .chain(self.edges.iter().map(|edge| (edge, 1)))
            .map(|(edge, end)| crack.pair(edge, end))
            .collect();
        let strings: Vec<Vec<WeirPair>> = nodes
            .split(Option::is_none)
            .map(|pairs| pairs.iter().flatten().copied().collect())
            .filter(|pairs: &Vec<WeirPair>| pairs.len() >= LEAST_PAIRS)
            .collect();
        strings.into_iter().map(|pairs| WeirString { line: self.line, weir: self.weir, pairs })
    }
}

/// The triangles around the nodes of a crack, in sectors.
struct Crack {
    added: Vec<usize>,
    changed: HashMap<usize, [usize; 3]>,
    opened: HashMap<[usize; 2], usize>,
    /// How many nodes there are at the place of each node of the crack.
    sectors: BTreeMap<usize, usize>,
    /// The triangles to the left and to the right of each edge, from its smaller node to the other one.
    sides: HashMap<[usize; 2], [usize; 2]>,
    /// The nodes in the mesh of the triangles beside edges.
    in_mesh: HashMap<usize, [usize; 3]>,
}

impl Crack {
    fn new<'e>(mesh: &Extract, edges: impl Iterator<Item = &'e WeirEdge>) -> Self {
        let mut sides: HashMap<[usize; 2], [usize; 2]> =
            edges.map(|edge| (sorted(edge.ends), [usize::MAX; 2])).collect();
        let mut around: BTreeMap<usize, Vec<usize>> =
            sides.keys().flatten().map(|&node| (node, Vec::new())).collect();
        let mut in_mesh = HashMap::new();
        for (triangle, cell) in mesh.cells().enumerate() {
            for place in 0..3 {
                let [from, to] = [cell.corners[place], cell.corners[(place + 1) % 3]];
                if let Some(triangles) = around.get_mut(&from) {
                    triangles.push(triangle);
                    in_mesh.insert(triangle, cell.corners);
                }
                if let Some(sides) = sides.get_mut(&sorted([from, to])) {
                    sides[usize::from(from > to)] = triangle;
                }
            }
        }
        let mut crack = Self {
            added: Vec::new(),
            changed: HashMap::new(),
            opened: HashMap::new(),
            sectors: BTreeMap::new(),
            sides,
            in_mesh,
        };
        for (&node, triangles) in &around {
            crack.divide(mesh, node, triangles);
        }
        for edge in mesh.boundary_edges() {
            if edge.ends.iter().any(|node| around.contains_key(node)) {
                crack.opened.insert(edge.ends, edge.triangle);
            }
        }
        crack
    }

    /// Gives each sector of the triangles around a node a node of its own; the first one keeps it.
    fn divide(&mut self, mesh: &Extract, node: usize, triangles: &[usize]) {
        let mut left = triangles.to_vec();
        let mut sectors = 0;
        while let Some(&start) = left.first() {
            let mut stack = vec![start];
            let own = if sectors == 0 { node } else { mesh.nodes().len() + self.added.len() };
            if sectors > 0 {
                self.added.push(node);
            }
            sectors += 1;
            while let Some(triangle) = stack.pop() {
                let Some(at) = left.iter().position(|&other| other == triangle) else { continue };
                left.remove(at);
                let cell = mesh.cell(TriangleId::from_index(triangle));
                let place = place_of(cell.corners, node).unwrap_or_default();
                if own != node {
                    self.changed.entry(triangle).or_insert(cell.corners)[place] = own;
                }
                // Across the two edges at the node, opposite the other two corners.
                for other in [(place + 1) % 3, (place + 2) % 3] {
                    let beyond = cell.corners[3 - place - other];
                    if !self.sides.contains_key(&sorted([node, beyond])) {
                        stack.extend(cell.opposite[other]);
                    }
                }
            }
        }
        self.sectors.insert(node, sectors);
    }

    /// Returns the pair at an end of an edge, 0 or 1; `None` where the node is not doubled, or there are more
    /// than two at its place.
    fn pair(&self, edge: &WeirEdge, end: usize) -> Option<WeirPair> {
        let node = edge.ends[end];
        if self.sectors.get(&node) != Some(&2) {
            return None;
        }
        let [low_to_high, high_to_low] = *self.sides.get(&sorted(edge.ends))?;
        let sides = match edge.ends[0] < edge.ends[1] {
            true => [low_to_high, high_to_low],
            false => [high_to_low, low_to_high],
        };
        let now = |triangle: usize| {
            let in_mesh = *self.in_mesh.get(&triangle)?;
            let place = place_of(in_mesh, node)?;
            Some(self.changed.get(&triangle).copied().unwrap_or(in_mesh)[place])
        };
        Some(WeirPair { nodes: [now(sides[0])?, now(sides[1])?], crest: edge.crests[end] })
    }

    fn junctions(&self) -> Vec<usize> {
        self.sectors.iter().filter(|(_, sectors)| **sectors > 2).map(|(node, _)| *node).collect()
    }
}

/// Returns what a person should know about the weirs of a mesh in a format that has weirs: which edges and
/// nodes have no pairs.
pub fn weir_notes(mesh: &Extract, data: &MeshData) -> Vec<String> {
    let WeirCracks { losses, .. } = WeirCracks::new(mesh, data);
    let WeirLosses { on_boundary, shared, short, junctions } = losses;
    let mut notes = Vec::new();
    let mut tell = |lost: BTreeMap<usize, usize>, sentence: &str| {
        notes.extend(lost.into_iter().map(|(line, edges)| {
            let noun = if edges == 1 { "edge" } else { "edges" };
            format!("The weir “{}”: {} {noun} {sentence}", data.lines[line].name, Grouped(edges))
        }));
    };
    tell(on_boundary, "on the boundary cannot be a weir inside the domain, and are left out.");
    tell(shared, "that an earlier weir has, too, are weirs once, with its crest.");
    tell(
        short,
        "of parts with fewer than two pairs of nodes are left out: a weir needs three edges, or two where an end is \
         on the boundary. Smaller triangles there help.",
    );
    if let Some(&node) = junctions.first() {
        let p = mesh.world(NodeId::from_index(node));
        let places = if junctions.len() == 1 { "one place" } else { "several places, the first" };
        notes.push(format!(
            "Weirs meet at {places} at x = {}, y = {}: a node can be in one pair, so those there have none, and no water \
             crosses the edges beside them.",
            Number(p.x),
            Number(p.y)
        ));
    }
    notes
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

fn place_of(corners: [usize; 3], node: usize) -> Option<usize> {
    corners.iter().position(|&corner| corner == node)
}
