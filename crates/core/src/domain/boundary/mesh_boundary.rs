//! The piece of each boundary edge of a mesh.

use glam::DVec2;

use super::super::{Domain, FrameSide};
use super::labels::{Choice, cheapest_labels};
use super::stretches::compare;
use super::{BoundaryKind, BoundaryMarks, BoundaryPiece, BoundaryPieces};
use crate::earth::Ground;
use crate::geometry::Rect;
use crate::mesh::{Extract, NodeId};

/// The boundary of a mesh in the pieces of its domain's boundary.
///
/// An edge along the frame belongs to the open piece there that contains its middle. Any other edge usually
/// belongs to the piece nearest to its middle, without those along the frame. Where the mesh is a staircase,
/// the nearest piece can change from edge to edge and back. So an edge may take a piece that is a little
/// farther away, if that saves changes along the loop. The labels of a loop have the least sum of costs: for
/// each edge, its length times the additional distance, and for each change, the square of the lengths of its
/// edges.
#[derive(Clone, Debug)]
pub struct MeshBoundary {
    pieces: BoundaryPieces,
    /// The piece of each edge, in the order of [`Extract::boundary_edges`].
    piece_of_edge: Vec<u32>,
    figures: Vec<PieceFigures>,
}

/// The edges of a mesh that belong to a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceFigures {
    /// How many.
    pub edges: usize,
    /// The length of these edges: in world units, or on the ground ([`MeshBoundary::on_ground`]).
    pub length: f64,
}

/// Edges of one piece that follow one another along the boundary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PieceRun {
    /// The number of the piece.
    pub piece: usize,
    /// Nodes, with the domain on the left. A closed run ends with its first node.
    pub nodes: Vec<usize>,
}

impl MeshBoundary {
    /// Returns the boundary of a mesh of a domain. Takes time proportional to the boundary edges and to the
    /// corners of the domain near each of them.
    pub fn new(extract: &Extract, domain: &Domain, marks: &BoundaryMarks) -> Self {
        Self::from_pieces(extract, BoundaryPieces::of(domain, extract, marks))
    }

    /// Returns the boundary of a mesh in pieces that follow from the mesh alone: sides of the frame, outer
    /// loops, holes.
    pub fn from_mesh(extract: &Extract) -> Self {
        Self::from_pieces(extract, BoundaryPieces::of_mesh(extract, &BoundaryMarks::default()))
    }

    /// Returns the boundary of a mesh in pieces that were found before.
    pub fn from_pieces(extract: &Extract, pieces: BoundaryPieces) -> Self {
        let edges: Vec<[DVec2; 2]> = edges(extract).collect();
        let candidates = PieceCandidates::new(extract, &pieces);
        let mut piece_of_edge = vec![0; edges.len()];
        for numbers in extract.boundary_edge_loops() {
            let choices: Vec<Choice> = numbers.iter().map(|&n| candidates.of_edge(edges[n])).collect();
            let start = |&n: &usize| {
                let [a, b] = edges[numbers[n]];
                (choices[n].labels.len(), a + b)
            };
            let order = |a: &usize, b: &usize| {
                let ((a, at), (b, other)) = (start(a), start(b));
                a.cmp(&b).then_with(|| compare(at, other))
            };
            let start = (0..numbers.len()).min_by(order).unwrap_or(0);
            for (n, piece) in numbers.into_iter().zip(cheapest_labels(&choices, start)) {
                piece_of_edge[n] = piece;
            }
        }
        let figures = vec![PieceFigures::default(); pieces.list().len()];
        Self { pieces, piece_of_edge, figures }.measured(edges.into_iter(), &Ground::default())
    }

    /// Returns the same boundary, of the same mesh, with lengths on the ground.
    pub fn on_ground(self, extract: &Extract, ground: &Ground) -> Self {
        self.measured(edges(extract), ground)
    }

    fn measured(mut self, edges: impl Iterator<Item = [DVec2; 2]>, ground: &Ground) -> Self {
        self.figures.fill(PieceFigures::default());
        for (&piece, edge) in self.piece_of_edge.iter().zip(edges) {
            let figures = &mut self.figures[piece as usize];
            figures.edges += 1;
            figures.length += ground.length(edge);
        }
        self
    }

    /// Returns all pieces of the domain's boundary, also those that the mesh does not have.
    pub fn pieces(&self) -> &BoundaryPieces {
        &self.pieces
    }

    /// Returns for each piece of [`Self::pieces`] the edges that the mesh has of it. It has none of an island
    /// that it covers.
    pub fn figures(&self) -> &[PieceFigures] {
        &self.figures
    }

    /// Returns the numbers of the pieces that have edges in the mesh.
    pub fn present(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.figures.len()).filter(|&piece| self.figures[piece].edges > 0)
    }

    /// Returns the numbers of the pieces of the domain's boundary that have no edge in the mesh.
    pub fn lost(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.figures.len()).filter(|&piece| self.figures[piece].edges == 0)
    }

    /// Returns the number of the piece of each edge of [`Extract::boundary_edges`].
    pub fn piece_of_edge(&self) -> &[u32] {
        &self.piece_of_edge
    }

    /// Returns, for each node, the number of its piece plus one: 0 off the boundary, and the lowest number
    /// where pieces meet.
    ///
    /// # Panics
    /// Panics when `extract` belongs to another mesh.
    pub fn node_markers(&self, extract: &Extract) -> Vec<u32> {
        let mut markers = vec![0; extract.nodes().len()];
        for (edge, &piece) in extract.boundary_edges().zip(&self.piece_of_edge) {
            for node in edge.ends {
                let marker: &mut u32 = &mut markers[node];
                *marker = if *marker == 0 { piece + 1 } else { (piece + 1).min(*marker) };
            }
        }
        markers
    }

    /// Returns the boundary as runs of edges of one piece each, in the order of the pieces, the longest run
    /// of a piece first. Most pieces have one run. A piece has several where the mesh closes straits or joins
    /// islands.
    ///
    /// # Panics
    /// Panics when `extract` belongs to another mesh.
    pub fn runs(&self, extract: &Extract) -> Vec<PieceRun> {
        let ends: Vec<[usize; 2]> = extract.boundary_edges().map(|edge| edge.ends).collect();
        let mut runs = Vec::new();
        for mut edges in extract.boundary_edge_loops() {
            let piece = |edge: usize| self.piece_of_edge[edge];
            let first = (0..edges.len())
                .find(|&n| piece(edges[n]) != piece(edges[(n + edges.len() - 1) % edges.len()]));
            edges.rotate_left(first.unwrap_or(0));
            for run in edges.chunk_by(|&a, &b| piece(a) == piece(b)) {
                let last = ends[run[run.len() - 1]][1];
                let nodes = run.iter().map(|&edge| ends[edge][0]).chain([last]).collect();
                runs.push(PieceRun { piece: piece(run[0]) as usize, nodes });
            }
        }
        runs.sort_by_key(|run| (run.piece, std::cmp::Reverse(run.nodes.len())));
        runs
    }
}

/// The pieces that an edge may belong to.
struct PieceCandidates<'a> {
    pieces: &'a BoundaryPieces,
    frame: Rect,
    /// The side of the frame that each piece is on.
    sides: Vec<Option<FrameSide>>,
}

/// Returns the ends of the boundary edges of a mesh, in world units.
fn edges(extract: &Extract) -> impl Iterator<Item = [DVec2; 2]> {
    extract.boundary_edges().map(|edge| edge.ends.map(|node| extract.world(NodeId::from_index(node))))
}

/// How much farther than the nearest a piece may be, in lengths of the edge.
const MARGIN: f64 = 2.0;

impl<'a> PieceCandidates<'a> {
    fn new(extract: &Extract, pieces: &'a BoundaryPieces) -> Self {
        let frame = extract.lattice().bounds();
        let sides = pieces.list().iter().map(|piece| side_of_frame(piece, &frame)).collect();
        Self { pieces, frame, sides }
    }

    fn of_edge(&self, edge: [DVec2; 2]) -> Choice {
        let [a, b] = edge;
        let (middle, length) = (0.5 * (a + b), a.distance(b));
        let change = length * length;
        if let Some(open) = FrameSide::of(edge, &self.frame).and_then(|side| self.open_at(side, middle)) {
            return Choice { labels: vec![(open, 0.0)], change };
        }
        let all_on_frame = self.sides.iter().all(Option::is_some);
        let counts = |piece: usize| all_on_frame || self.sides[piece].is_none();
        let mut labels = self.pieces.distances(middle, MARGIN * length, counts);
        if !all_on_frame {
            self.keep_those_along(edge, counts, &mut labels);
        }
        let least = labels.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
        labels.iter_mut().for_each(|(_, distance)| *distance = (*distance - least) * length);
        if labels.is_empty() {
            labels.push((0, 0.0)); // no ring has an area: there is one piece at most
        }
        Choice { labels, change }
    }

    /// Of the pieces near an edge beside an open piece, keeps only the open one that both ends of the edge
    /// are on, or else only those that are not open: where water flows across must not depend on the lengths
    /// of edges.
    fn keep_those_along(
        &self,
        edge: [DVec2; 2],
        counts: impl Fn(usize) -> bool,
        labels: &mut Vec<(u32, f64)>,
    ) {
        if labels.len() < 2 || !labels.iter().any(|&(piece, _)| self.is_open(piece)) {
            return;
        }
        let [a, b] = edge.map(|end| self.at(end, &counts));
        let along: Vec<u32> = a.iter().copied().filter(|piece| b.contains(piece)).collect();
        if let Some(open) = along.iter().copied().find(|&piece| self.is_open(piece)) {
            labels.retain(|&(piece, _)| piece == open);
            return;
        }
        let is_on_outline = !a.is_empty() && !b.is_empty();
        // An edge across the corner between two sides is on none of them, and still open.
        let joins_open = [&a, &b].into_iter().all(|end| end.iter().any(|&piece| self.is_open(piece)));
        if !along.is_empty() || (is_on_outline && !joins_open) {
            labels.retain(|&(piece, _)| !self.is_open(piece));
        }
    }

    fn is_open(&self, piece: u32) -> bool {
        self.pieces.list()[piece as usize].kind == BoundaryKind::Open
    }

    /// Returns the pieces that a point is on.
    fn at(&self, point: DVec2, counts: impl Fn(usize) -> bool) -> Vec<u32> {
        let reach = self.pieces.tolerance();
        let near = self.pieces.distances(point, reach, counts);
        near.into_iter().filter(|(_, distance)| *distance <= reach).map(|(piece, _)| piece).collect()
    }

    /// Returns the open piece on a side of the frame that has a point.
    fn open_at(&self, side: FrameSide, point: DVec2) -> Option<u32> {
        let axis = side.axis();
        let holds = |points: &[DVec2]| {
            let (from, to) = (points[0][axis], points[points.len() - 1][axis]);
            from.min(to) <= point[axis] && point[axis] <= from.max(to)
        };
        let mut open = (0..self.sides.len()).filter(|&piece| self.sides[piece] == Some(side));
        open.find(|&piece| holds(&self.pieces.list()[piece].points)).map(|piece| piece as u32)
    }
}

/// Returns the side of a frame that an open piece is on. Sides of another rectangle are curves, or elsewhere.
fn side_of_frame(piece: &BoundaryPiece, frame: &Rect) -> Option<FrameSide> {
    let first = FrameSide::of([piece.points[0], piece.points[1]], frame);
    let is_on = |ends: &[DVec2]| FrameSide::of([ends[0], ends[1]], frame) == first;
    first.filter(|_| piece.kind == BoundaryKind::Open && piece.points.windows(2).all(is_on))
}
