//! Some triangles of a mesh with a patch, whose nodes move and whose edges flip: around lines, and along the
//! outline.

mod improve;
mod patched;
mod replaced;

use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::{NodeId, TriangleId};
use crate::outline::angles::Angles;
use crate::outline::triangulation::{NONE, Triangulation};
pub(in crate::outline) use improve::Improver;
pub(in crate::outline) use patched::{PatchedMesh, PatchedTriangle};
pub(in crate::outline) use replaced::Replaced;

/// What a node may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::outline) enum LineNodeState {
    /// Anything that keeps the angles.
    Free,
    /// Slide along a segment.
    OnSegment(u32),
    /// Slide along an axis on which two straight edges of the boundary lie: 0 along x, 1 along y.
    OnBoundary(u8),
    /// Move once along the outline, to where a line meets it.
    OnOutline,
    /// Nothing.
    Fixed,
}

/// Some triangles. Nodes and triangles have numbers in the order of their places, so that
/// nothing depends on the order of the mesh's entries.
#[derive(Clone, Debug)]
pub(in crate::outline) struct LocalMesh {
    pub(in crate::outline) triangles: Triangulation,
    /// For each triangle, the one of the mesh whose place it takes; `None` for one that is gone.
    pub(in crate::outline) owners: Vec<Option<TriangleId>>,
    pub(in crate::outline) points: Vec<LatticePoint>,
    pub(in crate::outline) states: Vec<LineNodeState>,
    /// For each node, whether it is on the boundary of the domain. Not known of nodes at which some triangles
    /// are missing.
    pub(in crate::outline) on_boundary: Vec<bool>,
    /// For each node of the start, the cotangent of the smallest angle around it, if that is below the bound.
    pub(in crate::outline) poor_at: Vec<f64>,
    /// For each node of the start, its number in the mesh with its patch.
    pub(in crate::outline) ids: Vec<NodeId>,
    /// The edges that lie on segments, by their nodes in ascending order.
    pub(in crate::outline) fixed: NumberMap<[u32; 2], u32>,
}

impl LocalMesh {
    /// Makes the mesh of some triangles, of nodes at `places`. `is_complete` says of each of these whether
    /// all triangles at it are among them.
    pub(in crate::outline) fn new(
        places: &[LatticePoint],
        triangles: &[PatchedTriangle],
        is_complete: &[bool],
        angles: &Angles,
        on_outline: &dyn Fn(LatticePoint) -> bool,
    ) -> Self {
        let mut ids: Vec<NodeId> = triangles.iter().flat_map(|t| t.corners).collect();
        ids.sort_unstable_by_key(|id| (places[id.index()], *id));
        ids.dedup();
        let numbers: NumberMap<u32, u32> =
            ids.iter().enumerate().map(|(n, id)| (id.index() as u32, n as u32)).collect();
        let local = |t: &PatchedTriangle| {
            let corners = t.corners.map(|id| numbers[&(id.index() as u32)]);
            let first = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
            ([0, 1, 2].map(|i| corners[(first + i) % 3]), t.owner)
        };
        let mut sorted: Vec<([u32; 3], TriangleId)> = triangles.iter().map(local).collect();
        sorted.sort_unstable();
        let (corners, owners): (Vec<[u32; 3]>, Vec<TriangleId>) = sorted.into_iter().unzip();
        let across = across(&corners);
        let points: Vec<LatticePoint> = ids.iter().map(|id| places[id.index()]).collect();
        let triangles = Triangulation::new(points.len(), corners, across);
        let mut local = Self {
            owners: owners.into_iter().map(Some).collect(),
            states: vec![LineNodeState::Free; points.len()],
            on_boundary: vec![false; points.len()],
            poor_at: vec![0.0; points.len()],
            triangles,
            points,
            ids,
            fixed: NumberMap::default(),
        };
        local.find_states(is_complete, angles, on_outline);
        local.find_poor(angles);
        local
    }

    fn find_states(
        &mut self,
        is_complete: &[bool],
        angles: &Angles,
        on_outline: &dyn Fn(LatticePoint) -> bool,
    ) {
        let mut counts = vec![0; self.points.len()];
        self.triangles.corners.iter().flatten().for_each(|&v| counts[v as usize] += 1);
        let mut star = Vec::new();
        for v in 0..self.points.len() as u32 {
            let n = v as usize;
            self.triangles.star(v, &mut star);
            let is_complete = is_complete[self.ids[n].index()];
            self.on_boundary[n] = is_complete && !self.closes(&star);
            let is_whole = is_complete && star.len() == counts[n];
            self.states[n] = if !is_whole {
                LineNodeState::Fixed
            } else if !self.on_boundary[n] {
                LineNodeState::Free
            } else if let Some(axis) = self.boundary_axis(v, &star) {
                LineNodeState::OnBoundary(axis)
            } else if self.is_nearly_straight(v, &star, angles) && on_outline(self.points[n]) {
                LineNodeState::OnOutline
            } else {
                LineNodeState::Fixed
            };
        }
    }

    /// Returns the nodes beside a node of the boundary: clockwise and anticlockwise of its triangles.
    fn beside(&self, star: &[(u32, usize)]) -> Option<[u32; 2]> {
        let ((first, i), (last, j)) = (*star.first()?, *star.last()?);
        let [_, right, _] = self.triangles.starting_at(first, i);
        let [_, _, left] = self.triangles.starting_at(last, j);
        Some([right, left])
    }

    /// Returns whether the boundary turns by less than 30° at a node.
    fn is_nearly_straight(&self, node: u32, star: &[(u32, usize)], angles: &Angles) -> bool {
        let Some(beside) = self.beside(star) else { return false };
        let [a, b] = beside.map(|v| angles.vector(self.points[node as usize], self.points[v as usize]));
        // The tangent of 30° is below 0.578.
        a.dot(b) < 0.0 && a.perp_dot(b).abs() < -0.577 * a.dot(b)
    }

    /// Returns the sets of triangles that are connected by edges, each in ascending order.
    pub(in crate::outline) fn parts(&self) -> Vec<Vec<u32>> {
        let (mut parts, mut is_seen) = (Vec::new(), vec![false; self.triangles.len()]);
        for first in 0..self.triangles.len() as u32 {
            let mut part = Vec::new();
            let mut stack = vec![first];
            while let Some(t) = stack.pop() {
                if std::mem::replace(&mut is_seen[t as usize], true) {
                    continue;
                }
                part.push(t);
                stack.extend(self.triangles.across[t as usize].iter().filter(|&&other| other != NONE));
            }
            part.sort_unstable();
            parts.extend((!part.is_empty()).then_some(part));
        }
        parts
    }

    /// Returns some of the triangles. Nodes and triangles keep their order.
    pub(in crate::outline) fn part(&self, part: &[u32]) -> Self {
        let mut nodes: Vec<u32> = part.iter().flat_map(|&t| self.triangles.corners[t as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let numbers: NumberMap<u32, u32> = nodes.iter().enumerate().map(|(n, &v)| (v, n as u32)).collect();
        let corners: Vec<[u32; 3]> =
            part.iter().map(|&t| self.triangles.corners[t as usize].map(|v| numbers[&v])).collect();
        let across = across(&corners);
        Self {
            triangles: Triangulation::new(nodes.len(), corners, across),
            owners: part.iter().map(|&t| self.owners[t as usize]).collect(),
            points: nodes.iter().map(|&v| self.points[v as usize]).collect(),
            states: nodes.iter().map(|&v| self.states[v as usize]).collect(),
            on_boundary: nodes.iter().map(|&v| self.on_boundary[v as usize]).collect(),
            poor_at: nodes.iter().map(|&v| self.poor_at[v as usize]).collect(),
            ids: nodes.iter().map(|&v| self.ids[v as usize]).collect(),
            fixed: NumberMap::default(),
        }
    }

    /// Returns whether triangles close around their node.
    pub(in crate::outline) fn closes(&self, star: &[(u32, usize)]) -> bool {
        let (first, i) = star[0];
        self.triangles.across[first as usize][(i + 2) % 3] != NONE
    }

    /// Returns the axis along which both edges of the boundary at a node lie.
    fn boundary_axis(&self, node: u32, star: &[(u32, usize)]) -> Option<u8> {
        let [right, left] = self.beside(star)?;
        let [at, right, left] = [node, right, left].map(|v| self.points[v as usize]);
        let x_between = (right.x < at.x) != (left.x < at.x);
        let y_between = (right.y < at.y) != (left.y < at.y);
        match (right.y == at.y && left.y == at.y, right.x == at.x && left.x == at.x) {
            (true, _) if x_between => Some(0),
            (_, true) if y_between => Some(1),
            _ => None,
        }
    }

    fn find_poor(&mut self, angles: &Angles) {
        for t in 0..self.triangles.len() as u32 {
            let worst = angles.worst(self.corners(t));
            if worst > angles.limit() {
                for v in self.triangles.corners[t as usize] {
                    let poor = &mut self.poor_at[v as usize];
                    *poor = poor.max(worst);
                }
            }
        }
    }

    /// Returns whether the domain ends at the edge opposite the i-th corner of a triangle.
    pub(in crate::outline) fn is_boundary(&self, triangle: u32, i: usize) -> bool {
        let [_, b, c] = self.triangles.starting_at(triangle, i);
        // Where neither is known to be on the boundary, the local triangles end.
        self.triangles.across[triangle as usize][i] == NONE
            && (self.on_boundary[b as usize] || self.on_boundary[c as usize])
    }

    pub(in crate::outline) fn is_alive(&self, triangle: u32) -> bool {
        self.owners[triangle as usize].is_some()
    }

    pub(in crate::outline) fn corners(&self, triangle: u32) -> [LatticePoint; 3] {
        self.triangles.corners[triangle as usize].map(|v| self.points[v as usize])
    }

    /// Returns the edge of two nodes, as the key of [`Self::fixed`].
    pub(in crate::outline) fn key(a: u32, b: u32) -> [u32; 2] {
        [a.min(b), a.max(b)]
    }

    pub(in crate::outline) fn is_fixed(&self, a: u32, b: u32) -> bool {
        self.fixed.contains_key(&Self::key(a, b))
    }

    /// Adds a node, which has no triangle yet.
    pub(in crate::outline) fn add_node(
        &mut self,
        at: LatticePoint,
        state: LineNodeState,
        on_boundary: bool,
    ) -> u32 {
        self.points.push(at);
        self.states.push(state);
        self.on_boundary.push(on_boundary);
        self.triangles.at.push(NONE);
        self.points.len() as u32 - 1
    }

    /// Returns the node opposite an edge in the triangle across it, and that triangle.
    pub(in crate::outline) fn opposite(&self, triangle: u32, i: usize) -> Option<(u32, u32)> {
        let across = self.triangles.across[triangle as usize][i];
        if across == NONE {
            return None;
        }
        let [_, b, c] = self.triangles.starting_at(triangle, i);
        let j = 3 - self.triangles.place(across, b) - self.triangles.place(across, c);
        Some((self.triangles.corners[across as usize][j], across))
    }

    /// Flips the edge opposite the i-th corner of a triangle.
    pub(in crate::outline) fn flip(&mut self, triangle: u32, i: usize) {
        self.triangles.flip(triangle, i);
    }

    /// Puts a node into a triangle, which becomes three.
    ///
    /// ```text
    ///        c                 c
    ///       / \               /|\
    ///      /   \             / | \        t  a b x
    ///     /  t  \    -->    /  x  \       u  b c x
    ///    /       \         / /   \ \      w  c a x
    ///   a---------b       a---------b
    /// ```
    pub(in crate::outline) fn split_triangle(&mut self, t: u32, x: u32) {
        let [a, b, c] = self.triangles.corners[t as usize];
        let [bc, ca, ab] = self.triangles.across[t as usize];
        let u = self.push_triangle(t, [b, c, x]);
        let w = self.push_triangle(t, [c, a, x]);
        self.triangles.corners[t as usize] = [a, b, x];
        self.triangles.across[t as usize] = [u, w, ab];
        self.triangles.across[u as usize] = [w, t, bc];
        self.triangles.across[w as usize] = [t, u, ca];
        self.reconnect(bc, t, u);
        self.reconnect(ca, t, w);
        for (v, at) in [(a, t), (b, t), (c, u), (x, t)] {
            self.triangles.at[v as usize] = at;
        }
    }

    /// Puts a node into the edge opposite the i-th corner of a triangle.
    ///
    /// ```text
    ///      c                 c
    ///     /|\               /|\
    ///    / | \             / | \       t  a b x    t2  a x c
    ///   a t|u d    -->    a--x--d      u  d x b    u2  d c x
    ///    \ | /             \ | /
    ///     \|/               \|/
    ///      b                 b
    /// ```
    pub(in crate::outline) fn split_edge(&mut self, t: u32, i: usize, x: u32) {
        let u = self.triangles.across[t as usize][i];
        let [a, b, c] = self.triangles.starting_at(t, i);
        let across = self.triangles.across[t as usize];
        let (ca, ab) = (across[(i + 1) % 3], across[(i + 2) % 3]);
        let t2 = self.push_triangle(t, [a, x, c]);
        self.triangles.corners[t as usize] = [a, b, x];
        let mut beside = [NONE; 2];
        if u != NONE {
            let j = 3 - self.triangles.place(u, b) - self.triangles.place(u, c);
            let d = self.triangles.corners[u as usize][j];
            let across = self.triangles.across[u as usize];
            let (bd, dc) = (across[(j + 1) % 3], across[(j + 2) % 3]);
            let u2 = self.push_triangle(u, [d, c, x]);
            self.triangles.corners[u as usize] = [d, x, b];
            self.triangles.across[u as usize] = [t, bd, u2];
            self.triangles.across[u2 as usize] = [t2, u, dc];
            self.reconnect(dc, u, u2);
            self.triangles.at[d as usize] = u;
            beside = [u, u2];
        }
        self.triangles.across[t as usize] = [beside[0], t2, ab];
        self.triangles.across[t2 as usize] = [beside[1], ca, t];
        self.reconnect(ca, t, t2);
        for (v, at) in [(a, t), (b, t), (c, t2), (x, t)] {
            self.triangles.at[v as usize] = at;
        }
        if let Some(segment) = self.fixed.remove(&Self::key(b, c)) {
            self.fixed.insert(Self::key(b, x), segment);
            self.fixed.insert(Self::key(x, c), segment);
        }
    }

    fn push_triangle(&mut self, like: u32, corners: [u32; 3]) -> u32 {
        self.triangles.corners.push(corners);
        self.triangles.across.push([NONE; 3]);
        self.owners.push(self.owners[like as usize]);
        self.triangles.len() as u32 - 1
    }

    fn reconnect(&mut self, triangle: u32, old: u32, new: u32) {
        if let Some(across) = self.triangles.across.get_mut(triangle as usize) {
            across.iter_mut().filter(|n| **n == old).for_each(|n| *n = new);
        }
    }

    /// Moves a node inside the domain to one beside it, so that both become one. `star` is its star, and `k`
    /// the place in it of a triangle whose second corner, from the node on, is the other one. The caller has
    /// checked that no triangle turns over.
    ///
    /// ```text
    ///        x                    x
    ///      / | \                  |
    ///     /  |  \                 |
    ///   ··v--l--w··    -->     ···w···      l and r are gone
    ///     \  r  /                 |
    ///      \ | /                  |
    ///        y                    y
    /// ```
    pub(in crate::outline) fn collapse(&mut self, v: u32, star: &[(u32, usize)], k: usize) {
        let (l, i) = star[k];
        let (r, j) = star[(k + star.len() - 1) % star.len()];
        let [_, w, x] = self.triangles.starting_at(l, i);
        let [_, y, _] = self.triangles.starting_at(r, j);
        let sides = |t: u32, i: usize| {
            let across = self.triangles.across[t as usize];
            [across[i], across[(i + 1) % 3], across[(i + 2) % 3]]
        };
        let ([wx, xv, _], [yw, _, vy]) = (sides(l, i), sides(r, j));
        let others: Vec<u32> = star.iter().map(|&(t, i)| self.triangles.starting_at(t, i)[1]).collect();
        for &(t, i) in star {
            self.triangles.corners[t as usize][i] = w;
        }
        self.reconnect(wx, l, xv);
        self.reconnect(xv, l, wx);
        self.reconnect(yw, r, vy);
        self.reconnect(vy, r, yw);
        for t in [l, r] {
            self.owners[t as usize] = None;
            self.triangles.corners[t as usize] = [NONE; 3];
            self.triangles.across[t as usize] = [NONE; 3];
        }
        self.triangles.at[v as usize] = NONE;
        self.triangles.at[w as usize] = if xv != NONE { xv } else { vy };
        self.triangles.at[x as usize] = if xv != NONE { xv } else { wx };
        self.triangles.at[y as usize] = if vy != NONE { vy } else { yw };
        for other in others {
            let segment = self.fixed.remove(&Self::key(v, other));
            if let Some(segment) = segment.filter(|_| other != w) {
                self.fixed.insert(Self::key(w, other), segment);
            }
        }
    }
}

/// Returns the triangles for which something is true with some rings around them, and for each node whether
/// all triangles at it are among them.
pub(in crate::outline) fn rings_around(
    whole: &PatchedMesh,
    rings: usize,
    counts: impl Fn(&PatchedTriangle) -> bool + Sync,
) -> (Vec<PatchedTriangle>, Vec<bool>) {
    let mut triangles = whole.triangles(counts);
    let mut is_marked = vec![false; whole.points.len()];
    let mut is_complete = is_marked.clone();
    for _ in 0..rings {
        for v in triangles.iter().flat_map(|t| t.corners) {
            is_marked[v.index()] = true;
        }
        triangles = whole.triangles(|t| t.corners.iter().any(|v| is_marked[v.index()]));
        is_complete.clone_from(&is_marked);
    }
    (triangles, is_complete)
}

/// Returns the triangles across the edges.
fn across(corners: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut open: NumberMap<[u32; 2], (u32, usize)> = NumberMap::default();
    let mut across = vec![[NONE; 3]; corners.len()];
    for (t, &[a, b, c]) in corners.iter().enumerate() {
        for (i, [from, to]) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
            match open.remove(&[to, from]) {
                Some((other, j)) => {
                    across[t][i] = other;
                    across[other as usize][j] = t as u32;
                }
                None => {
                    open.insert([from, to], (t as u32, i));
                }
            }
        }
    }
    across
}
