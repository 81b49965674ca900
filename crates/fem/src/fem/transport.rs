//! What fluxes miss of their divergence, carried to where the error vanishes.
//!
//! The divergence of the equilibrated flux differs from the data by what integration and solver are wrong by.
//! A flux with that divergence exists: each triangle hands what it misses, and what it was handed, to a
//! neighbour nearer to an edge where u is given, which any flux may cross. Its norm is added to the bound.

use super::element::ElementShape;
use super::fem_mesh::{FemMesh, NONE};
use super::matrix::sum_of;
use super::solution::FemSolution;

/// The norm of such a flux.
pub(crate) struct Transport {
    /// a^−½ times the flux, in L², and what sinks with reaction or leaves by transfer.
    pub norm: f64,
    /// Whether all of it has a place to go.
    pub is_complete: bool,
}

impl Transport {
    /// Carries defects, the bounds of which are given for each triangle.
    pub fn of(mesh: &FemMesh, solution: &FemSolution, defects: &[f64]) -> Self {
        let (order, exit) = ways(mesh, solution);
        let mut carried = defects.to_vec();
        // The bounds of what crosses the edges of each triangle, and of what sinks there.
        let mut through = vec![[0.0; 3]; mesh.triangle_count()];
        let mut sinks = 0.0;
        for &triangle in order.iter().rev() {
            let (triangle, way) = (triangle as usize, exit[triangle as usize]);
            match way {
                Way::Edge(k) => {
                    let amount = carried[triangle];
                    through[triangle][k as usize] += amount;
                    let next = mesh.across[triangle][k as usize];
                    if next != NONE {
                        let back = mesh.across[next as usize].iter().position(|&at| at as usize == triangle);
                        through[next as usize][back.unwrap_or(0)] += amount;
                        carried[next as usize] += amount;
                    }
                }
                Way::Transfer(k, rate) => {
                    through[triangle][k as usize] += carried[triangle];
                    sinks += carried[triangle] * carried[triangle] / rate;
                }
                Way::Sink => {
                    let data = &solution.data[triangle];
                    let rate = data.reaction * ElementShape::of(mesh, triangle).measure();
                    sinks += carried[triangle] * carried[triangle] / rate;
                }
                Way::None => {}
            }
        }
        let square = |triangle: usize| {
            let norm = norm_of(mesh, solution, triangle, through[triangle]);
            norm * norm
        };
        let norm = sum_of(through.len(), square).sqrt() + f64::sqrt(sinks);
        Self { norm, is_complete: !exit.contains(&Way::None) }
    }
}

/// Where a triangle hands on what it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// Through the edge opposite a corner: to a neighbour, or out where u is given.
    Edge(u8),
    /// Through a boundary edge with transfer, whose integral is given.
    Transfer(u8, f64),
    /// It stays: there is reaction.
    Sink,
    /// Nowhere.
    None,
}

/// Returns the triangles from the exits on, and the way that each takes.
fn ways(mesh: &FemMesh, solution: &FemSolution) -> (Vec<u32>, Vec<Way>) {
    let mut ways = vec![Way::None; mesh.triangle_count()];
    let mut order = Vec::with_capacity(mesh.triangle_count());
    for (edge, data) in mesh.edges.iter().zip(&solution.boundary.edges) {
        let way = &mut ways[edge.triangle as usize];
        if data.is_dirichlet && *way == Way::None {
            *way = Way::Edge(edge.opposite as u8);
            order.push(edge.triangle);
        }
    }
    for (edge, data) in mesh.edges.iter().zip(&solution.boundary.edges) {
        let way = &mut ways[edge.triangle as usize];
        if data.transfer > 0.0 && *way == Way::None {
            *way = Way::Transfer(edge.opposite as u8, data.transfer * edge.length);
            order.push(edge.triangle);
        }
    }
    let mut next = 0;
    while next < order.len() {
        let triangle = order[next];
        for across in mesh.across[triangle as usize].into_iter().filter(|&across| across != NONE) {
            if ways[across as usize] == Way::None {
                let back = mesh.across[across as usize].iter().position(|&at| at == triangle);
                ways[across as usize] = Way::Edge(back.unwrap_or(0) as u8);
                order.push(across);
            }
        }
        next += 1;
    }
    for (triangle, way) in ways.iter_mut().enumerate().filter(|(_, way)| **way == Way::None) {
        if solution.data[triangle].reaction > 0.0 {
            *way = Way::Sink;
            order.push(triangle as u32);
        }
    }
    (order, ways)
}

/// Returns a bound of the norm of a flux in a triangle by bounds of what crosses its edges.
fn norm_of(mesh: &FemMesh, solution: &FemSolution, triangle: usize, through: [f64; 3]) -> f64 {
    if through == [0.0; 3] {
        return 0.0;
    }
    let (shape, corners) = (ElementShape::of(mesh, triangle), mesh.triangle(triangle));
    let middle = mesh.middle(triangle);
    let turning: f64 =
        corners.map(|corner| shape.flux_product(corner - middle, corner - middle)).iter().sum();
    let of_edge = |k: usize| {
        let from = middle - corners[k];
        let square = (shape.flux_product(from, from) + turning / 12.0) / (4.0 * shape.area);
        through[k] * square.sqrt()
    };
    (of_edge(0) + of_edge(1) + of_edge(2)) / solution.data[triangle].diffusion.sqrt()
}
