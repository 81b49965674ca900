//! The triangles around lines, whose nodes move and whose edges flip.

use rayon::prelude::*;

use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::{Mesh, MeshPatch, NodeId, PatchTriangle, TriangleId};
use crate::outline::angles::Angles;
use crate::outline::triangulation::{NONE, Triangulation};

/// What a node may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NodeState {
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

/// Connected triangles around lines. Nodes and triangles have numbers in the order of their places, so that
/// nothing depends on the order of the mesh's entries.
#[derive(Clone, Debug)]
pub(super) struct LocalMesh {
    pub(super) triangles: Triangulation,
    /// For each triangle, the one of the mesh whose place it takes; `None` for one that is gone.
    pub(super) owners: Vec<Option<TriangleId>>,
    pub(super) points: Vec<LatticePoint>,
    pub(super) states: Vec<NodeState>,
    /// For each node, whether it is on the boundary of the domain. Not known of nodes at which some triangles
    /// are missing.
    pub(super) on_boundary: Vec<bool>,
    /// For each node of the start, the cotangent of the smallest angle around it, if that is below the bound.
    pub(super) poor_at: Vec<f64>,
    /// For each node of the start, its number in the mesh with its patch.
    pub(super) ids: Vec<NodeId>,
    /// The edges that lie on segments, by their nodes in ascending order.
    pub(super) fixed: NumberMap<[u32; 2], u32>,
}

/// A triangle of a mesh with a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PatchedTriangle {
    pub(super) owner: TriangleId,
    pub(super) corners: [NodeId; 3],
}

/// A mesh with a patch, as an array of triangles and positions.
pub(super) struct PatchedMesh<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) patch: &'a MeshPatch,
    pub(super) points: Vec<LatticePoint>,
    is_changed: Vec<bool>,
}

impl<'a> PatchedMesh<'a> {
    pub(super) fn new(mesh: &'a Mesh, patch: &'a MeshPatch) -> Self {
        let mut points: Vec<LatticePoint> = mesh.raw_nodes().iter().chain(&patch.added).copied().collect();
        patch.moved.iter().for_each(|&(id, at)| points[id.index()] = at);
        let mut is_changed = vec![false; mesh.raw_triangle_count()];
        patch.changed.iter().for_each(|(id, _)| is_changed[id.index()] = true);
        Self { mesh, patch, points, is_changed }
    }

    /// Returns the triangles that take the place of one of the mesh.
    pub(super) fn pieces_of(&self, owner: TriangleId) -> impl Iterator<Item = PatchedTriangle> + '_ {
        let is_changed = self.is_changed[owner.index()];
        let whole = (!is_changed && self.mesh.is_in_domain(owner)).then(|| PatchedTriangle {
            owner,
            corners: self.mesh.triangle(owner).edge_nodes().map(|(v, _)| v),
        });
        let found = is_changed.then(|| self.patch.changed.binary_search_by_key(&owner, |(id, _)| *id));
        let pieces = found.and_then(Result::ok).map_or(0..0, |n| self.patch.changed[n].1.clone());
        let pieces = self.patch.pieces[pieces].iter();
        whole.into_iter().chain(pieces.map(move |piece| PatchedTriangle { owner, corners: piece.corners }))
    }

    /// Returns the triangles for which `counts` is true, in the order of the mesh. All threads work on it.
    pub(super) fn triangles(&self, counts: impl Fn(&PatchedTriangle) -> bool + Sync) -> Vec<PatchedTriangle> {
        let all = (0..self.mesh.raw_triangle_count()).into_par_iter().with_min_len(1 << 12);
        let found = all
            .flat_map_iter(|n| self.pieces_of(TriangleId::from_index(n)).filter(&counts).collect::<Vec<_>>());
        found.collect()
    }

    pub(super) fn corners(&self, triangle: &PatchedTriangle) -> [LatticePoint; 3] {
        triangle.corners.map(|v| self.points[v.index()])
    }
}

impl LocalMesh {
    /// Makes the mesh of some triangles. `is_complete` says of each node of the mesh whether all triangles at
    /// it are among them.
    pub(super) fn new(
        whole: &PatchedMesh,
        triangles: &[PatchedTriangle],
        is_complete: &[bool],
        angles: &Angles,
        on_outline: &dyn Fn(LatticePoint) -> bool,
    ) -> Self {
        let mut ids: Vec<NodeId> = triangles.iter().flat_map(|t| t.corners).collect();
        ids.sort_unstable_by_key(|id| (whole.points[id.index()], *id));
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
        let points: Vec<LatticePoint> = ids.iter().map(|id| whole.points[id.index()]).collect();
        let triangles = Triangulation::new(points.len(), corners, across);
        let mut local = Self {
            owners: owners.into_iter().map(Some).collect(),
            states: vec![NodeState::Free; points.len()],
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
                NodeState::Fixed
            } else if !self.on_boundary[n] {
                NodeState::Free
            } else if let Some(axis) = self.boundary_axis(v, &star) {
                NodeState::OnBoundary(axis)
            } else if self.is_nearly_straight(v, &star, angles) && on_outline(self.points[n]) {
                NodeState::OnOutline
            } else {
                NodeState::Fixed
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
    pub(super) fn parts(&self) -> Vec<Vec<u32>> {
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
    pub(super) fn part(&self, part: &[u32]) -> Self {
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
    pub(super) fn closes(&self, star: &[(u32, usize)]) -> bool {
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
    pub(super) fn is_boundary(&self, triangle: u32, i: usize) -> bool {
        let [_, b, c] = self.triangles.starting_at(triangle, i);
        // Where neither is known to be on the boundary, the local triangles end.
        self.triangles.across[triangle as usize][i] == NONE
            && (self.on_boundary[b as usize] || self.on_boundary[c as usize])
    }

    pub(super) fn is_alive(&self, triangle: u32) -> bool {
        self.owners[triangle as usize].is_some()
    }

    pub(super) fn corners(&self, triangle: u32) -> [LatticePoint; 3] {
        self.triangles.corners[triangle as usize].map(|v| self.points[v as usize])
    }

    /// Returns the edge of two nodes, as the key of [`Self::fixed`].
    pub(super) fn key(a: u32, b: u32) -> [u32; 2] {
        [a.min(b), a.max(b)]
    }

    pub(super) fn is_fixed(&self, a: u32, b: u32) -> bool {
        self.fixed.contains_key(&Self::key(a, b))
    }

    /// Adds a node, which has no triangle yet.
    pub(super) fn add_node(&mut self, at: LatticePoint, state: NodeState, on_boundary: bool) -> u32 {
        self.points.push(at);
        self.states.push(state);
        self.on_boundary.push(on_boundary);
        self.triangles.at.push(NONE);
        self.points.len() as u32 - 1
    }

    /// Returns the node opposite an edge in the triangle across it, and that triangle.
    pub(super) fn opposite(&self, triangle: u32, i: usize) -> Option<(u32, u32)> {
        let across = self.triangles.across[triangle as usize][i];
        if across == NONE {
            return None;
        }
        let [_, b, c] = self.triangles.starting_at(triangle, i);
        let j = 3 - self.triangles.place(across, b) - self.triangles.place(across, c);
        Some((self.triangles.corners[across as usize][j], across))
    }

    /// Flips the edge opposite the i-th corner of a triangle.
    pub(super) fn flip(&mut self, triangle: u32, i: usize) {
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
    pub(super) fn split_triangle(&mut self, t: u32, x: u32) {
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
    pub(super) fn split_edge(&mut self, t: u32, i: usize, x: u32) {
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
    pub(super) fn collapse(&mut self, v: u32, star: &[(u32, usize)], k: usize) {
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

    /// Writes the triangles into a patch in place of those that they were made from.
    pub(super) fn write(&self, whole: &PatchedMesh, start: &Self, angles: &Angles, to: &mut Replaced) {
        let mut used = vec![false; self.points.len()];
        self.triangles
            .corners
            .iter()
            .flatten()
            .filter(|&&v| v != NONE)
            .for_each(|&v| used[v as usize] = true);
        let mut ids = self.ids.clone();
        for v in self.ids.len()..self.points.len() {
            // The number of one without triangles is never read.
            ids.push(NodeId::from_index(whole.points.len() + to.added.len()));
            if used[v] {
                to.added.push(self.points[v]);
            }
        }
        let is_moved = |v: u32| start.points.get(v as usize).is_some_and(|&at| at != self.points[v as usize]);
        let changed = (0..self.ids.len()).filter(|&v| used[v] && is_moved(v as u32));
        to.moved.extend(changed.map(|v| (self.ids[v], self.points[v])));
        // Triangles keep their numbers while they change.
        for (t, &owner) in self.owners.iter().enumerate() {
            let former = start.owners.get(t).copied().flatten();
            let (is, was) = (self.triangles.corners[t], start.triangles.corners.get(t));
            let stays = was.is_some_and(|&was| owner.is_some() && (0..3).any(|i| is == turned(was, i)));
            if let Some(owner) = former.filter(|_| !stays) {
                let corners = start.triangles.corners[t].map(|v| ids[v as usize]);
                to.gone.push(PatchedTriangle { owner, corners });
            }
            if let Some(owner) = owner.filter(|_| !stays || is.iter().any(|&v| is_moved(v))) {
                let corners =
                    turned(is, longest_edge(self.corners(t as u32), angles)).map(|v| ids[v as usize]);
                if stays {
                    to.gone.push(PatchedTriangle { owner, corners });
                }
                to.pieces.push(PatchedTriangle { owner, corners });
            }
        }
        to.edges.extend(self.fixed.iter().map(|(ends, &segment)| (segment, ends.map(|v| ids[v as usize]))));
    }
}

/// What takes the place of some triangles of a mesh with a patch.
#[derive(Default)]
pub(super) struct Replaced {
    pub(super) added: Vec<LatticePoint>,
    pub(super) moved: Vec<(NodeId, LatticePoint)>,
    pub(super) gone: Vec<PatchedTriangle>,
    pub(super) pieces: Vec<PatchedTriangle>,
    /// The edges on segments.
    pub(super) edges: Vec<(u32, [NodeId; 2])>,
}

impl Replaced {
    /// Returns the patch with the changes.
    pub(super) fn into_patch(mut self, whole: &PatchedMesh) -> MeshPatch {
        let sorted = |mut corners: [NodeId; 3]| {
            corners.sort_unstable();
            corners
        };
        let former = &whole.patch;
        let raw = whole.mesh.raw_nodes().len();
        let mut patch = MeshPatch { added: former.added.clone(), ..MeshPatch::default() };
        patch.added.append(&mut self.added);
        let mut moved: NumberMap<u32, LatticePoint> =
            former.moved.iter().map(|&(id, at)| (id.index() as u32, at)).collect();
        for (id, at) in self.moved {
            match id.index().checked_sub(raw) {
                Some(added) => patch.added[added] = at,
                None => {
                    moved.insert(id.index() as u32, at);
                }
            }
        }
        let is_moved = |(id, at): &(NodeId, LatticePoint)| whole.mesh.node(*id) != *at;
        let moved = moved.into_iter().map(|(id, at)| (NodeId::from_index(id as usize), at));
        patch.moved = moved.filter(is_moved).collect();
        patch.moved.sort_unstable_by_key(|(id, _)| *id);
        let mut gone: Vec<(TriangleId, [NodeId; 3])> =
            self.gone.iter().map(|t| (t.owner, sorted(t.corners))).collect();
        gone.sort_unstable();
        self.pieces.sort_by_key(|t| t.owner);
        let mut owners: Vec<TriangleId> = self.gone.iter().map(|t| t.owner).collect();
        owners.extend(former.changed.iter().map(|(id, _)| *id));
        owners.sort_unstable();
        owners.dedup();
        let mut pieces = self.pieces.into_iter().peekable();
        for owner in owners {
            let first = patch.pieces.len();
            let level = whole.mesh.triangle(owner).level();
            let stays = |t: &PatchedTriangle| gone.binary_search(&(t.owner, sorted(t.corners))).is_err();
            let staying = whole.pieces_of(owner).filter(stays);
            patch.pieces.extend(staying.map(|t| PatchTriangle { corners: t.corners, level }));
            while let Some(piece) = pieces.next_if(|piece| piece.owner == owner) {
                patch.pieces.push(PatchTriangle { corners: piece.corners, level });
            }
            patch.changed.push((owner, first..patch.pieces.len()));
        }
        patch
    }
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

fn turned([a, b, c]: [u32; 3], i: usize) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]][i]
}

/// Returns the place of the corner at which the longest edge begins.
fn longest_edge(corners: [LatticePoint; 3], angles: &Angles) -> usize {
    let length = |i: usize| angles.vector(corners[i], corners[(i + 1) % 3]).length_squared();
    (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best })
}
