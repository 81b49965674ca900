//! The edges along lines, as files number them.

use super::LineFit;
use crate::domain::{BoundaryMarks, Line, LineMeasure, Weir};
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::Extract;

/// Halvings after which the edges of a mesh that was refined are no longer looked for. A lattice has 30 bits.
const MOST_HALVINGS: usize = 30;

/// An edge of a mesh along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineEdge {
    /// The numbers of its nodes, along the line.
    pub ends: [usize; 2],
    /// The number of a triangle with this edge.
    pub triangle: usize,
}

/// The edges of a mesh along a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineEdges {
    /// The name of the line, as files can hold it ([`BoundaryMarks::valid_name`]).
    pub name: String,
    /// Its edges, along the line.
    pub edges: Vec<LineEdge>,
    /// The crest along them, if the line is a weir.
    pub weir: Option<WeirEdges>,
}

/// The crest of a weir along the edges of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct WeirEdges {
    /// The height of the crest at both ends of each of [`LineEdges::edges`], in metres, positive upwards.
    pub crests: Vec<[f64; 2]>,
    /// See [`Weir::subcritical`].
    pub subcritical: f64,
    /// See [`Weir::supercritical`].
    pub supercritical: f64,
}

impl WeirEdges {
    fn of(weir: &Weir, line: &Line, edges: &[LineEdge], mesh: &Extract) -> Self {
        let measure = LineMeasure::new(line);
        let crest = |node: usize| {
            let place = mesh.lattice().world_from_lattice(mesh.nodes()[node]);
            weir.crest.at(measure.share(place))
        };
        let Weir { subcritical, supercritical, .. } = *weir;
        Self { crests: edges.iter().map(|edge| edge.ends.map(crest)).collect(), subcritical, supercritical }
    }
}

/// Returns the name of a line as files can hold it; `number` counts the lines from 1.
fn name_in_files(name: &str, number: usize) -> String {
    let name = BoundaryMarks::valid_name(name);
    if name.is_empty() { format!("line {number}") } else { name }
}

fn sorted([a, b]: [LatticePoint; 2]) -> [LatticePoint; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the edges of a mesh that have both ends of one of these segments, by their ends.
fn edges_of(
    wanted: impl Iterator<Item = [LatticePoint; 2]>,
    mesh: &Extract,
) -> NumberMap<[LatticePoint; 2], LineEdge> {
    let mut found: NumberMap<[LatticePoint; 2], Option<LineEdge>> =
        wanted.map(|ends| (sorted(ends), None)).collect();
    for (triangle, cell) in mesh.cells().enumerate() {
        let [a, b, c] = cell.corners;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let ends = if mesh.nodes()[from] < mesh.nodes()[to] { [from, to] } else { [to, from] };
            let edge = found.get_mut(&ends.map(|node| mesh.nodes()[node]));
            if let Some(edge @ None) = edge {
                *edge = Some(LineEdge { ends, triangle });
            }
        }
    }
    found.into_iter().filter_map(|(ends, edge)| Some((ends, edge?))).collect()
}

/// Halves segments as [`Extract::refined`] does.
fn halved(segments: &[[LatticePoint; 2]]) -> Vec<[LatticePoint; 2]> {
    let halves = |&[a, b]: &[LatticePoint; 2]| {
        let middle = LatticePoint::new((a.x + b.x) / 2, (a.y + b.y) / 2);
        [[a, middle], [middle, b]]
    };
    segments.iter().flat_map(halves).collect()
}

impl LineEdges {
    /// Returns the edges along each line that has some in a mesh, in the order of the lines, or in a mesh
    /// that follows from it by [`Extract::refined`]. `lines` are those of which `fits` are the fits. Takes
    /// time in proportion to the mesh.
    pub fn all(fits: &[LineFit], lines: &[Line], mesh: &Extract) -> Vec<Self> {
        let mut segments: Vec<Vec<[LatticePoint; 2]>> = fits.iter().map(|fit| fit.edges.clone()).collect();
        if segments.iter().all(Vec::is_empty) {
            return Vec::new();
        }
        let mut found = NumberMap::default();
        for _ in 0..=MOST_HALVINGS {
            found = edges_of(segments.iter().flatten().copied(), mesh);
            if !found.is_empty() {
                break;
            }
            segments.iter_mut().for_each(|of_line| *of_line = halved(of_line));
        }
        let along = |ends: &[LatticePoint; 2]| {
            let edge = found.get(&sorted(*ends))?;
            let [low, high] = edge.ends;
            Some(LineEdge { ends: if ends[0] < ends[1] { [low, high] } else { [high, low] }, ..*edge })
        };
        let of_line = |(number, segments): (usize, &Vec<[LatticePoint; 2]>)| {
            let edges: Vec<LineEdge> = segments.iter().filter_map(along).collect();
            let weir = lines.get(number).and_then(|line| Some((line, line.weir()?)));
            let weir = weir.map(|(line, weir)| WeirEdges::of(weir, line, &edges, mesh));
            Self { name: name_in_files(&fits[number].name, number + 1), edges, weir }
        };
        let all = segments.iter().enumerate().map(of_line);
        all.filter(|line| !line.edges.is_empty()).collect()
    }

    /// Returns the nodes of each part of the line that is on edges without a gap.
    pub fn runs(&self) -> Vec<Vec<usize>> {
        let runs = self.edges.chunk_by(|a, b| a.ends[1] == b.ends[0]);
        let nodes = |run: &[LineEdge]| {
            let first = run.first().map(|edge| edge.ends[0]);
            first.into_iter().chain(run.iter().map(|edge| edge.ends[1])).collect()
        };
        runs.map(nodes).collect()
    }
}
