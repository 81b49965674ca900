//! Links: from the centre of a cell to that of its neighbour.

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use super::center::center;
use super::edges::{InnerEdge, inner_edges};
use super::{CellNodes, MeshCell};
use crate::text::LengthUnit;

/// Delft3D-FM removes links shorter than this share of the size of their cells: 0.9 `removesmalllinkstrsh`
/// (flow_geominit.f90).
pub const LEAST_SHARE: f64 = 0.9 * 0.1;
/// The largest cosine of the angle between a link and its edge that Delft3D-FM accepts, `cosphiutrsh`.
pub const LARGEST_COSINE: f64 = 0.5;
/// The cosine above which a link is counted as not orthogonal.
const ORTHOGONAL: f64 = 0.02;
/// Metres of a degree along a meridian.
const METRES_IN_DEGREE: f64 = 111_195.0;

/// How links between cells are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkFigures {
    /// The links.
    pub links: usize,
    /// Those that the solver removes.
    pub short: usize,
    /// Those whose angle with their edge has a cosine above [`LARGEST_COSINE`].
    pub skewed: usize,
    /// Those where it is above 0.02.
    pub not_orthogonal: usize,
    /// The largest cosine; 0 where all links cross their edges at right angles.
    pub largest_cosine: f64,
}

/// A link across an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellLink {
    /// The nodes of the edge, the smaller number first.
    pub ends: [usize; 2],
    /// Its length, in the unit of the coordinates, and with degrees in metres.
    pub length: f64,
    /// The size of the cells: the mean of the roots of their areas.
    pub size: f64,
    /// The cosine of its angle with the edge, from 0 to 1; 0 for a link of no length.
    pub cosine: f64,
}

impl CellLink {
    /// Returns its length as a share of the size of the cells.
    pub fn share(&self) -> f64 {
        self.length / self.size
    }

    /// Returns whether the solver removes it.
    pub fn is_short(&self) -> bool {
        self.share() < LEAST_SHARE
    }

    /// Returns whether it stays, and is far from crossing its edge at a right angle.
    pub fn is_skewed(&self) -> bool {
        !self.is_short() && self.cosine > LARGEST_COSINE
    }

    /// Returns whether the solver removes it, or it is far from a right angle.
    pub(super) fn is_bad(&self) -> bool {
        self.is_short() || self.is_skewed()
    }
}

/// Returns the link between two cells across an edge. `is_inner` says of an edge whether cells are on both
/// sides.
pub(super) fn link(
    mesh: CellNodes<'_>,
    ends: [usize; 2],
    cells: [&MeshCell; 2],
    is_inner: impl Fn([usize; 2]) -> bool,
) -> CellLink {
    let [from, to] = ends.map(|node| mesh.nodes[node]);
    let scale = scale(mesh.unit, 0.5 * (from.y + to.y));
    let placed = cells.map(|cell| {
        let corners: Vec<DVec2> =
            cell.corners().iter().map(|&node| scale * (mesh.nodes[node] - from)).collect();
        let inner: Vec<bool> = cell.edges().map(&is_inner).collect();
        (center(&corners, &inner), area(&corners).sqrt())
    });
    let [(first, first_size), (second, second_size)] = placed;
    let (along, across) = (scale * (to - from), second - first);
    let (length, size) = (across.length(), 0.5 * (first_size + second_size));
    let cosine = if length > 0.0 { across.dot(along).abs() / (length * along.length()) } else { 0.0 };
    CellLink { ends, length, size, cosine }
}

/// Returns what coordinates are multiplied by to be lengths around a latitude.
pub(super) fn scale(unit: LengthUnit, latitude: f64) -> DVec2 {
    match unit {
        LengthUnit::Degree => METRES_IN_DEGREE * dvec2(libm::cos(latitude.to_radians()), 1.0),
        _ => DVec2::ONE,
    }
}

fn area(corners: &[DVec2]) -> f64 {
    let fan = corners[1..].windows(2).map(|pair| (pair[0] - corners[0]).perp_dot(pair[1] - corners[0]));
    0.5 * fan.sum::<f64>().abs()
}

/// Measures all links between cells.
pub(super) fn figures(mesh: CellNodes<'_>, cells: &[MeshCell]) -> LinkFigures {
    let links = links_of(mesh, cells, &edges_of(cells));
    let count = |counts: fn(&CellLink) -> bool| links.iter().filter(|link| counts(link)).count();
    LinkFigures {
        links: links.len(),
        short: count(CellLink::is_short),
        skewed: count(CellLink::is_skewed),
        not_orthogonal: count(|link| link.cosine > ORTHOGONAL && !link.is_short()),
        largest_cosine: links
            .iter()
            .filter(|link| !link.is_short())
            .map(|link| link.cosine)
            .fold(0.0, f64::max),
    }
}

/// Returns the edges between cells.
pub(super) fn edges_of(cells: &[MeshCell]) -> Vec<InnerEdge> {
    inner_edges(
        cells.iter().enumerate().flat_map(|(number, cell)| cell.edges().map(move |edge| (number, edge))),
    )
}

/// Returns the link across each edge.
pub(super) fn links_of(mesh: CellNodes<'_>, cells: &[MeshCell], edges: &[InnerEdge]) -> Vec<CellLink> {
    let is_inner = |ends| edge_between(edges, ends).is_some();
    let link = |edge: &InnerEdge| link(mesh, edge.ends, edge.cells.map(|cell| &cells[cell]), is_inner);
    edges.par_iter().map(link).collect()
}

/// Returns the centre of each cell, in the coordinates of the nodes.
pub(super) fn centers_of(mesh: CellNodes<'_>, cells: &[MeshCell]) -> Vec<DVec2> {
    let edges = edges_of(cells);
    let center_of = |cell: &MeshCell| {
        let corners = cell.corners();
        // Relative to a corner: places far from the origin keep their digits.
        let origin = mesh.nodes[corners[0]];
        let latitudes = corners.iter().map(|&node| mesh.nodes[node].y).sum::<f64>();
        let scale = scale(mesh.unit, latitudes / corners.len() as f64);
        let placed: Vec<DVec2> = corners.iter().map(|&node| scale * (mesh.nodes[node] - origin)).collect();
        let inner: Vec<bool> = cell.edges().map(|ends| edge_between(&edges, ends).is_some()).collect();
        origin + center(&placed, &inner) / scale
    };
    cells.par_iter().map(center_of).collect()
}

/// Returns the number of the edge between two cells that joins two nodes, if there is one.
pub(super) fn edge_between(edges: &[InnerEdge], [from, to]: [usize; 2]) -> Option<usize> {
    edges.binary_search_by_key(&[from.min(to), from.max(to)], |edge| edge.ends).ok()
}
