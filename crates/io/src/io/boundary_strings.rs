//! The boundary as strings of nodes, as coastal solvers want it: open boundaries, land and islands.
//!
//! ```text
//!   o----- land -----o        Outer loops run anticlockwise and holes clockwise: the domain is on the left.
//!   |                |        Neighbouring strings share their end node. A loop of one string ends with its
//!  open    o--o    land       first node. A hole that is land of one type is one string.
//!   |      o--o      |
//!   o----- land -----o
//! ```
//!
//! A solver that adds up over the nodes of open strings, as ADCIRC does, gets neighbouring open pieces as one
//! string ([`BoundaryStrings::with_open_joined`]): a node in two strings would have twice the tide.
//!
//! What a piece is follows from its type ([`BoundaryPiece::boundary_type`]). Inflows are open strings in some
//! formats, and in others strings among those of land.

use std::collections::HashMap;
use std::io;

use super::{MeshData, Number};
use meshbrush_core::domain::{BoundaryPiece, BoundaryType, signed_area};
use meshbrush_mesh::mesh::{Extract, NodeId};

/// The code of a land node in [`BoundaryStrings::node_codes`].
pub(super) const LAND: u32 = 1;

/// What a string is for a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StringKind {
    /// Where the sea goes on; in some formats also inflows.
    Open,
    /// Land on an outer loop, or on a hole that is not all land of one type; and inflows that are not open.
    Land,
    /// The whole of a hole.
    Island,
}

/// Edges of one piece, or of a hole, that follow one another along the boundary.
#[derive(Clone, Debug)]
pub(super) struct BoundaryString {
    /// What it is.
    pub(super) kind: StringKind,
    /// The type of its piece.
    pub(super) boundary_type: BoundaryType,
    /// The name of its piece, or of its pieces with commas between them.
    pub(super) name: String,
    /// Nodes, with the domain on the left; a whole loop ends with its first node.
    pub(super) nodes: Vec<usize>,
}

impl BoundaryString {
    /// Returns the nodes without the repeated first node of an island, and of a loop that is open all around.
    pub(super) fn distinct(&self) -> &[usize] {
        let (is_loop, last) = (self.nodes.first() == self.nodes.last(), self.nodes.len() - 1);
        match self.kind {
            StringKind::Island => &self.nodes[..last],
            StringKind::Open if is_loop => &self.nodes[..last],
            StringKind::Open | StringKind::Land => &self.nodes,
        }
    }

    fn is_open(&self) -> bool {
        self.kind == StringKind::Open
    }
}

/// The strings of a whole boundary.
#[derive(Clone, Debug)]
pub(super) struct BoundaryStrings {
    /// The strings of each loop, in their order along it. Outer loops come first, the longest first, then
    /// holes, the longest first.
    loops: Vec<Vec<BoundaryString>>,
}

impl BoundaryStrings {
    /// Divides the boundary of a mesh. `is_open` says which types are open strings in a format, and `format`
    /// is its name in errors.
    ///
    /// # Errors
    /// Fails where the boundary touches itself in a node: solvers need two boundary edges at each.
    pub(super) fn new(
        mesh: &Extract,
        data: &MeshData,
        format: &str,
        is_open: fn(BoundaryType) -> bool,
    ) -> io::Result<Self> {
        let edges: Vec<[usize; 2]> = mesh.boundary_edges().map(|edge| edge.ends).collect();
        check_contacts(mesh, &edges, format)?;
        let pieces = data.boundary.pieces().list();
        let types: Vec<BoundaryType> = pieces.iter().map(BoundaryPiece::boundary_type).collect();
        let piece_of = |edge: usize| data.boundary.piece_of_edge()[edge] as usize;
        let mut loops = Vec::new();
        for mut numbers in mesh.boundary_edge_loops() {
            let corner = |&edge: &usize| mesh.node(NodeId::from_index(edges[edge][0])).as_dvec2();
            let is_hole = signed_area(&numbers.iter().map(corner).collect::<Vec<_>>()) < 0.0;
            let start = first_of_string(&numbers, |edge| (is_open(types[piece_of(edge)]), piece_of(edge)));
            numbers.rotate_left(start);
            let runs = numbers.chunk_by(|&a, &b| piece_of(a) == piece_of(b));
            let string = |run: &[usize]| {
                let (name, boundary_type) = (pieces[piece_of(run[0])].name.clone(), types[piece_of(run[0])]);
                let kind = if is_open(boundary_type) { StringKind::Open } else { StringKind::Land };
                let nodes = run.iter().map(|&edge| edges[edge][0]).chain([edges[run[run.len() - 1]][1]]);
                BoundaryString { kind, boundary_type, name, nodes: nodes.collect() }
            };
            let strings: Vec<BoundaryString> = runs.map(string).collect();
            let is_island = is_hole && is_land_of_one_type(&strings);
            let strings = if is_island { vec![joined(&strings, StringKind::Island)] } else { strings };
            loops.push((is_hole, numbers.len(), strings));
        }
        loops.sort_by_key(|&(is_hole, edges, _)| (is_hole, std::cmp::Reverse(edges)));
        Ok(Self { loops: loops.into_iter().map(|(_, _, strings)| strings).collect() })
    }

    /// Joins open strings that follow one another along a loop, so that each open node is in exactly one
    /// string.
    pub(super) fn with_open_joined(self) -> Self {
        let join = |strings: Vec<BoundaryString>| {
            let runs = strings.chunk_by(|a, b| a.is_open() && b.is_open());
            runs.map(|run| if run.len() == 1 { run[0].clone() } else { joined(run, StringKind::Open) })
                .collect()
        };
        // A loop begins with an open string after land, so no run goes on at its beginning.
        Self { loops: self.loops.into_iter().map(join).collect() }
    }

    /// Returns all strings.
    pub(super) fn all(&self) -> impl Iterator<Item = &BoundaryString> {
        self.loops.iter().flatten()
    }

    /// Returns the open strings.
    pub(super) fn open(&self) -> impl Iterator<Item = &BoundaryString> {
        self.all().filter(|string| string.is_open())
    }

    /// Returns the strings of land and then the islands.
    pub(super) fn closed(&self) -> impl Iterator<Item = &BoundaryString> {
        let of_kind = |kind| self.all().filter(move |string| string.kind == kind);
        of_kind(StringKind::Land).chain(of_kind(StringKind::Island))
    }

    /// Returns the nodes of the open strings, each once, where it comes first.
    pub(super) fn open_nodes(&self, mesh: &Extract) -> Vec<usize> {
        let mut is_taken = vec![false; mesh.nodes().len()];
        let nodes = self.open().flat_map(|string| &string.nodes).copied();
        nodes.filter(|&node| !std::mem::replace(&mut is_taken[node], true)).collect()
    }

    /// Returns the boundary nodes with their strings, each node once, in the order along the loops. A node in
    /// which two strings meet is in the one that begins there.
    pub(super) fn ring_nodes(&self) -> impl Iterator<Item = (usize, &BoundaryString)> {
        let begins = |string: &'_ BoundaryString| string.nodes.len() - 1;
        self.all()
            .flat_map(move |string| string.nodes[..begins(string)].iter().map(move |&node| (node, string)))
    }

    /// Returns a code for each node: 0 off the boundary, [`LAND`], and from 2 on one for each open string in
    /// the order of [`Self::open`]. A node between an open string and land is open, and one between two open
    /// strings belongs to the string that ends there. So an edge is open exactly if neither of its nodes is
    /// a land node, and it has the code of its second node.
    ///
    /// A land string of one edge between two open ones would be open by that rule. It takes a node of the
    /// longer one, so that an edge of that is land, too.
    ///
    /// # Errors
    /// Fails where no edge of an open string would remain.
    pub(super) fn node_codes(&self, mesh: &Extract, format: &str) -> io::Result<Vec<u32>> {
        let codes = self.marked_codes(mesh);
        match self.without_own_edge(&codes).first() {
            Some(string) => Err(no_own_edge(string, mesh, format)),
            None => Ok(codes),
        }
    }

    /// Returns the codes of [`Self::node_codes`], also where no edge of an open string remains.
    pub(super) fn marked_codes(&self, mesh: &Extract) -> Vec<u32> {
        let mut codes = vec![0; mesh.nodes().len()];
        for string in self.closed() {
            string.nodes.iter().for_each(|&node| codes[node] = LAND);
        }
        for (code, string) in (LAND + 1..).zip(self.open()) {
            codes[string.nodes[0]] = code;
        }
        for (code, string) in (LAND + 1..).zip(self.open()) {
            string.nodes[1..].iter().for_each(|&node| codes[node] = code);
        }
        for node in self.nodes_for_short_land(&codes) {
            codes[node] = LAND;
        }
        codes
    }

    /// Returns the open strings of which no edge remains by these codes.
    pub(super) fn without_own_edge(&self, codes: &[u32]) -> Vec<&BoundaryString> {
        let has_edge = |string: &BoundaryString| {
            string.nodes.windows(2).any(|ends| ends.iter().all(|&node| codes[node] > LAND))
        };
        self.open().filter(|string| !has_edge(string)).collect()
    }

    /// Returns a node for each land string that has none of its own: the one that it shares with the longer
    /// of the open strings beside it.
    fn nodes_for_short_land(&self, codes: &[u32]) -> Vec<usize> {
        let edges_at: HashMap<[usize; 2], usize> = self
            .open()
            .flat_map(|string| {
                let last = string.nodes.len() - 1;
                [([string.nodes[0], BEGIN], last), ([string.nodes[last], END], last)]
            })
            .collect();
        let edges = |node: usize, end: usize| edges_at.get(&[node, end]).copied().unwrap_or(0);
        let hidden = self.closed().filter(|string| string.nodes.iter().all(|&node| codes[node] > LAND));
        hidden
            .map(|string| {
                let (first, last) = (string.nodes[0], string.nodes[string.nodes.len() - 1]);
                if edges(first, END) >= edges(last, BEGIN) { first } else { last }
            })
            .collect()
    }
}

/// The ends of a string, in [`BoundaryStrings::nodes_for_short_land`].
const BEGIN: usize = 0;
const END: usize = 1;

/// Returns whether no water flows across any string, and all treat the flow alike.
fn is_land_of_one_type(strings: &[BoundaryString]) -> bool {
    let first = strings[0].boundary_type;
    !first.lets_water_through() && strings.iter().all(|string| string.boundary_type == first)
}

/// Returns where to begin with the edges of a loop: at an open piece after land, or else at another piece;
/// of several places, at the piece with the lowest number.
fn first_of_string(numbers: &[usize], piece_of: impl Fn(usize) -> (bool, usize)) -> usize {
    let before = |n: usize| piece_of(numbers[(n + numbers.len() - 1) % numbers.len()]);
    let places = (0..numbers.len()).filter(|&n| piece_of(numbers[n]).1 != before(n).1);
    let rank = |&n: &usize| {
        let (is_open, piece) = piece_of(numbers[n]);
        (!is_open || before(n).0, piece, n)
    };
    places.min_by_key(rank).unwrap_or(0)
}

/// Joins strings that follow one another to one of this kind, with their names.
fn joined(strings: &[BoundaryString], kind: StringKind) -> BoundaryString {
    let mut names: Vec<&str> = Vec::new();
    for string in strings {
        if !names.contains(&&*string.name) {
            names.push(&string.name);
        }
    }
    let name = names.join(", ");
    let inner = strings.iter().flat_map(|string| &string.nodes[1..]);
    let nodes = strings.iter().take(1).map(|string| &string.nodes[0]).chain(inner).copied().collect();
    BoundaryString { kind, boundary_type: strings[0].boundary_type, name, nodes }
}

/// Fails where the boundary touches itself in a node.
fn check_contacts(mesh: &Extract, edges: &[[usize; 2]], format: &str) -> io::Result<()> {
    let mut leaving = vec![0_u32; mesh.nodes().len()];
    edges.iter().for_each(|edge| leaving[edge[0]] += 1);
    let contacts = leaving.iter().filter(|&&count| count > 1).count();
    let Some(node) = leaving.iter().position(|&count| count > 1) else { return Ok(()) };
    let p = mesh.world(NodeId::from_index(node));
    let (x, y) = (Number(p.x), Number(p.y));
    let others = match contacts {
        1 => String::new(),
        _ => format!(", as in {} nodes in all", contacts),
    };
    Err(io::Error::other(format!(
        "{format} needs two boundary edges at each boundary node, and at x = {x}, y = {y} the boundary touches itself \
         in a node{others}; have such nodes removed (without --keep-pinches, or Keep pinched nodes in the tab Domain), \
         put nodes on the outline, or choose smaller triangles there"
    )))
}

fn no_own_edge(string: &BoundaryString, mesh: &Extract, format: &str) -> io::Error {
    let p = mesh.world(NodeId::from_index(string.nodes[0]));
    let (name, x, y) = (&string.name, Number(p.x), Number(p.y));
    io::Error::other(format!(
        "{format} marks nodes and not edges, and no edge would remain of the open boundary \"{name}\" at x = {x}, y = {y}, \
         which lies beside land of one edge; choose smaller triangles there, or join the piece with its neighbour"
    ))
}
