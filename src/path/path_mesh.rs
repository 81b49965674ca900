//! The triangles that paths go through, as plain arrays.

use glam::DVec2;

use super::{CostDensity, PathError, checked_range};
use crate::geometry::Rect;
use crate::layers::{Coverage, Mask};
use crate::mesh::MeshView;

/// Marks a missing triangle.
pub(super) const NONE: u32 = u32::MAX;

/// Whether paths go through a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Passage {
    /// No path goes there.
    Closed,
    /// A part of it may be open: bounds from below count it, and the path that is shown stays outside.
    Partly,
    /// Paths go there.
    Open,
}

/// The triangles of a mesh for paths: nodes in world units, who is next to whom, and where paths may go.
///
/// Nodes and triangles have the numbers of the mesh or extract that they are made from.
#[derive(Clone, Debug, Default)]
pub struct PathMesh {
    pub(super) nodes: Vec<DVec2>,
    pub(super) triangles: Vec<PathTriangle>,
    /// The triangle across the edge from corner j to the next one; [`NONE`] where there is none.
    pub(super) across: Vec<[u32; 3]>,
    /// Where the row of each node begins in `around`.
    row_starts: Vec<u32>,
    /// The triangles around each node that are not closed.
    around: Vec<u32>,
    pub(super) has_obtuse: bool,
    pub(super) has_partly: bool,
}

/// A triangle for paths.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathTriangle {
    /// Nodes, anticlockwise.
    pub corners: [u32; 3],
    pub passage: Passage,
    /// The corner with an obtuse angle; 3 without one.
    pub obtuse: u8,
    /// Whether it belongs to the domain and is closed by a keep-out region.
    pub is_kept_out: bool,
}

impl PathMesh {
    /// All triangles of the domain are open.
    pub fn new(view: MeshView) -> Self {
        Self::with_passages(view, |_, is_outside| if is_outside { Passage::Closed } else { Passage::Open })
    }

    /// Keep-out regions close the triangles within and leave out those that they touch.
    pub fn with_keep_out(view: MeshView, keep_out: &[Mask]) -> Self {
        Self::with_passages(view, |corners, is_outside| {
            if is_outside {
                return Passage::Closed;
            }
            let [a, b, c] = *corners;
            let rectangle = Rect::new(a.min(b).min(c), a.max(b).max(c));
            let passage = |mask: &Mask| match mask.classify(&rectangle) {
                Coverage::Inside => Passage::Closed,
                Coverage::Mixed => Passage::Partly,
                Coverage::Outside => Passage::Open,
            };
            keep_out.iter().map(passage).min().unwrap_or(Passage::Open)
        })
    }

    /// `passage` says for each triangle, by its corners and whether it is marked as outside the domain,
    /// whether paths go there.
    pub fn with_passages(view: MeshView, passage: impl Fn(&[DVec2; 3], bool) -> Passage) -> Self {
        let lattice = view.lattice();
        let nodes: Vec<DVec2> = view.nodes().iter().map(|&node| lattice.world_from_lattice(node)).collect();
        let mut mesh = Self { nodes, ..Self::default() };
        for triangle in view.triangles() {
            let corners = triangle.edge_nodes().map(|(from, _)| from.index() as u32);
            let places = corners.map(|node| mesh.nodes[node as usize]);
            let across = triangle.raw_neighbours.map(|n| n.triangle().map_or(NONE, |t| t.index() as u32));
            let (passage, obtuse) = (passage(&places, triangle.is_outside()), obtuse_corner(&places));
            mesh.has_obtuse |= obtuse < 3 && passage > Passage::Closed;
            mesh.has_partly |= passage == Passage::Partly;
            let is_kept_out = passage == Passage::Closed && !triangle.is_outside();
            mesh.triangles.push(PathTriangle { corners, passage, obtuse, is_kept_out });
            mesh.across.push(across);
        }
        mesh.connect();
        mesh
    }

    /// Fills the rows of triangles around the nodes.
    fn connect(&mut self) {
        self.row_starts = vec![0; self.nodes.len() + 1];
        let open = |triangle: &&PathTriangle| triangle.passage > Passage::Closed;
        for triangle in self.triangles.iter().filter(open) {
            triangle.corners.iter().for_each(|&node| self.row_starts[node as usize + 1] += 1);
        }
        for n in 1..self.row_starts.len() {
            self.row_starts[n] += self.row_starts[n - 1];
        }
        let mut next = self.row_starts.clone();
        self.around = vec![0; self.row_starts.last().map_or(0, |&end| end as usize)];
        for (number, triangle) in self.triangles.iter().enumerate().filter(|(_, t)| open(t)) {
            for &node in &triangle.corners {
                self.around[next[node as usize] as usize] = number as u32;
                next[node as usize] += 1;
            }
        }
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles around a node that are not closed.
    #[inline]
    pub(super) fn around(&self, node: u32) -> &[u32] {
        &self.around[self.row_starts[node as usize] as usize..self.row_starts[node as usize + 1] as usize]
    }

    /// The corners of a triangle in world units.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [DVec2; 3] {
        self.triangles[triangle as usize].corners.map(|node| self.nodes[node as usize])
    }

    /// Whether paths go through a triangle.
    pub fn passage(&self, triangle: u32) -> Passage {
        self.triangles[triangle as usize].passage
    }

    /// The rectangle around a triangle.
    pub(super) fn rectangle(&self, triangle: u32) -> Rect {
        let [a, b, c] = self.corners(triangle);
        Rect::new(a.min(b).min(c), a.max(b).max(c))
    }

    /// The rectangle around all triangles that are not closed.
    pub fn bounds(&self) -> Option<Rect> {
        let open = |t: &u32| self.passage(*t) > Passage::Closed;
        (0..self.triangles.len() as u32).filter(open).map(|t| self.rectangle(t)).reduce(|a, b| a.union(&b))
    }

    /// A lower bound of the cost in each triangle, in their order; infinite in closed ones.
    ///
    /// # Errors
    /// When the cost is zero, negative, NaN or infinite somewhere.
    pub fn costs(&self, density: &dyn CostDensity) -> Result<Vec<f64>, PathError> {
        let mut costs = vec![f64::INFINITY; self.triangles.len()];
        for (number, cost) in (0..).zip(&mut costs) {
            *cost = self.cost(number, density)?;
        }
        Ok(costs)
    }

    /// A lower bound of the cost in one triangle.
    fn cost(&self, triangle: u32, density: &dyn CostDensity) -> Result<f64, PathError> {
        match self.passage(triangle) {
            Passage::Closed => Ok(f64::INFINITY),
            _ => Ok(checked_range(density, &self.rectangle(triangle))?.least),
        }
    }

    /// Computes the costs again of the triangles that meet a rectangle, and returns those that changed.
    ///
    /// # Errors
    /// As [`Self::costs`]; then the costs are as before.
    pub fn update_costs(
        &self,
        costs: &mut [f64],
        density: &dyn CostDensity,
        area: &Rect,
    ) -> Result<Vec<u32>, PathError> {
        let mut changed = Vec::new();
        for number in 0..self.triangles.len() as u32 {
            if self.rectangle(number).intersection(area).is_some() {
                let cost = self.cost(number, density)?;
                if cost != costs[number as usize] {
                    changed.push((number, cost));
                }
            }
        }
        changed.iter().for_each(|&(number, cost)| costs[number as usize] = cost);
        Ok(changed.into_iter().map(|(number, _)| number).collect())
    }

    /// Whether a point lies in a triangle of the domain that a keep-out region closes.
    pub(super) fn is_kept_out(&self, point: DVec2) -> bool {
        let holds = |t: u32| self.triangles[t as usize].is_kept_out && contains(&self.corners(t), point);
        (0..self.triangles.len() as u32).any(holds)
    }

    /// The triangle with the lowest number that contains a point and has at least this passage.
    pub fn locate(&self, point: DVec2, least: Passage) -> Option<u32> {
        let contains = |&number: &u32| {
            self.triangles[number as usize].passage >= least && contains(&self.corners(number), point)
        };
        (0..self.triangles.len() as u32).find(contains)
    }
}

/// The corner with an angle above 90°, beyond rounding; 3 without one.
fn obtuse_corner(corners: &[DVec2; 3]) -> u8 {
    let is_obtuse = |&k: &usize| {
        let (p, q) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
        p.dot(q) < -1e-9 * p.length() * q.length()
    };
    (0..3).find(is_obtuse).unwrap_or(3) as u8
}

/// Whether a closed triangle, anticlockwise, contains a point, but for rounding.
pub(super) fn contains(corners: &[DVec2; 3], point: DVec2) -> bool {
    let [a, b, c] = *corners;
    let margin = -1e-12 * (b - a).perp_dot(c - a);
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| (to - from).perp_dot(point - from) >= margin)
}
