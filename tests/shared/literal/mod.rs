//! The report's algorithms, transcribed line by line: a referee, not an example of style.
//!
//! Arrays are one-based (entry 0 is never read), a triangle is the report's 𝒯\[i\] ∈ ℤ⁸, and every routine
//! keeps the name and the order of statements that it has in the report (`new` is ī there). Departures, all
//! of them forced:
//! - nodes are integers on a lattice in which `delta` is the side of a coarse cell, so that midpoints are
//!   exact;
//! - `CheckMemory` and the null padding are `push`;
//! - in Algorithm 18 line 4 the array meant is 𝒯₀^N, and in item 8 of Appendix A the argument meant is N_e.

use std::collections::BTreeMap;

/// Reference to a null boundary triangle.
pub const BETA: i64 = -1;

/// A node in lattice coordinates.
pub type Node = [i64; 2];

/// 𝒩, 𝒯 and what the report keeps beside them.
pub struct Report {
    pub n: Vec<Node>,
    pub t: Vec<[i64; 8]>,
    pub n_e: i64,
    pub delta: i64,
    stack: Vec<usize>,
    m_t: Vec<i64>,
    /// How often each branch of Algorithms 8 and 19 ran: "8", or "19", with k, O(t) and O(t_b) (absent at the
    /// boundary).
    pub branches: BTreeMap<(u32, i64, i64, Option<i64>), usize>,
    /// How often each of `UpdateNeighbours1..4` and `UpdateBoundaryNeighbours1..2` ran.
    pub routines: BTreeMap<&'static str, usize>,
}

/// Algorithm 4: CoarseNodes.
fn coarse_nodes(n_e: i64, delta: i64) -> Vec<Node> {
    let mut n = vec![[0, 0]; 1 + ((n_e + 1) * (n_e + 1)) as usize];
    let mut k = 1;
    for i in 0..=n_e {
        for j in 0..=n_e {
            n[k] = [delta * j, delta * i];
            k += 1;
        }
    }
    n
}

/// Algorithm 5: CoarseTriangleVertices.
fn coarse_triangle_vertices(n_e: i64) -> Vec<[i64; 3]> {
    let n = n_e + 1;
    let mut t0v = vec![[0; 3]; 1 + (2 * n_e * n_e) as usize];
    let mut k = 1;
    for i in 0..n_e {
        for j in 0..n_e {
            t0v[k] = [j + 1 + n * (i + 1), j + 1 + n * i, j + 2 + n * i];
            k += 1;
            t0v[k] = [j + 2 + n * i, j + 2 + n * (i + 1), j + 1 + n * (i + 1)];
            k += 1;
        }
    }
    t0v
}

/// Algorithm 6: CoarseTriangleNeighbours.
fn coarse_triangle_neighbours(n_e: i64) -> Vec<[i64; 3]> {
    let n = 2 * n_e * n_e;
    let s = 2 * n_e;
    let mut l = 1;
    let mut r = 1;
    let k = n - s + 1;
    let mut t0n = vec![[0; 3]; 1 + n as usize];
    t0n[1] = [2, BETA, BETA];
    t0n[n as usize] = [n - 1, BETA, BETA];
    for i in 2..=n - 1 {
        t0n[i as usize] = if i % 2 == 1 {
            if i == l * s + 1 {
                l += 1;
                [i + 1, BETA, i - s + 1]
            } else if i > s {
                [i + 1, i - 1, i - s + 1]
            } else {
                [i + 1, i - 1, BETA]
            }
        } else if i == r * s {
            r += 1;
            [i - 1, BETA, i + s - 1]
        } else if i < k {
            [i - 1, i + 1, i + s - 1]
        } else {
            [i - 1, i + 1, BETA]
        };
    }
    t0n
}

/// Algorithm 16: FilterNodes. Returns the nodes that stay and ℳ_x.
fn filter_nodes(n: &[Node], domain_q: impl Fn(Node) -> bool) -> (Vec<Node>, Vec<i64>) {
    let mut j = 1;
    let mut m_x = vec![0; n.len()];
    let mut kept = vec![[0, 0]];
    for i in 1..n.len() {
        if domain_q(n[i]) {
            kept.push(n[i]);
            m_x[i] = j;
            j += 1;
        } else {
            m_x[i] = 0;
        }
    }
    (kept, m_x)
}

/// Algorithm 17: FilterVertices. Returns the triangles that stay and ℳ_t.
fn filter_vertices(t0v: &[[i64; 3]], m_x: &[i64]) -> (Vec<[i64; 3]>, Vec<i64>) {
    let mut j = 1;
    let mut m_t = vec![0; t0v.len()];
    let mut kept = vec![[0; 3]];
    for i in 1..t0v.len() {
        let v = t0v[i].map(|x| m_x[x as usize]);
        if v[0] > 0 && v[1] > 0 && v[2] > 0 {
            kept.push(v);
            m_t[i] = j;
            j += 1;
        } else {
            m_t[i] = BETA;
        }
    }
    (kept, m_t)
}

/// Algorithm 18: FilterNeighbours.
fn filter_neighbours(t0n: &[[i64; 3]], m_t: &[i64]) -> Vec<[i64; 3]> {
    let mut kept = vec![[0; 3]];
    for i in 1..t0n.len() {
        if m_t[i] > 0 {
            let mut n = [0; 3];
            for j in 0..3 {
                n[j] = if t0n[i][j] > 0 { m_t[t0n[i][j] as usize] } else { t0n[i][j] };
            }
            kept.push(n);
        }
    }
    kept
}

impl Report {
    /// Algorithm 7: InitialiseMesh, with items 5 to 7 of Appendix A.
    pub fn initialise_mesh(n_e: i64, delta: i64, domain_q: impl Fn(Node) -> bool) -> Self {
        let n = coarse_nodes(n_e, delta);
        let t0v = coarse_triangle_vertices(n_e);
        let t0n = coarse_triangle_neighbours(n_e);
        let (n, m_x) = filter_nodes(&n, domain_q);
        let (t0v, m_t) = filter_vertices(&t0v, &m_x);
        let t0n = filter_neighbours(&t0n, &m_t);
        let mut t = vec![[0; 8]];
        for i in 1..t0v.len() {
            let (v, b) = (t0v[i], t0n[i]);
            t.push([v[0], v[1], v[2], b[0], b[1], b[2], 1, 0]);
        }
        let (stack, branches, routines) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        Self { n, t, n_e, delta, stack, m_t, branches, routines }
    }

    /// Not in the report: leaves out the nodes that no triangle uses, in the order of those that stay.
    pub fn remove_orphans(&mut self) -> usize {
        let used = |k: usize| self.t[1..].iter().any(|t| t[..3].contains(&(k as i64)));
        let used: Vec<bool> = (0..self.n.len()).map(|k| k == 0 || used(k)).collect();
        let mut number = vec![0i64; self.n.len()];
        for k in 1..self.n.len() {
            number[k] = number[k - 1] + i64::from(used[k]);
        }
        for v in self.t[1..].iter_mut().flat_map(|t| &mut t[..3]) {
            *v = number[*v as usize];
        }
        let before = self.n.len();
        let mut k = 0;
        self.n.retain(|_| {
            k += 1;
            used[k - 1]
        });
        before - self.n.len()
    }

    /// T(i, j) of the report, j from 1 to 8.
    fn get(&self, i: usize, j: usize) -> i64 {
        self.t[i][j - 1]
    }

    fn set(&mut self, i: usize, j: usize, value: i64) {
        self.t[i][j - 1] = value;
    }

    fn n_t(&self) -> usize {
        self.t.len() - 1
    }

    /// Line 7 of Algorithm 8 and line 5 of Algorithm 19.
    fn push_midpoint(&mut self, a: i64, b: i64) -> i64 {
        let (a, b) = (self.n[a as usize], self.n[b as usize]);
        let sum = [a[0] + b[0], a[1] + b[1]];
        assert!(sum[0] % 2 == 0 && sum[1] % 2 == 0, "the lattice is deep enough");
        self.n.push([sum[0] / 2, sum[1] / 2]);
        self.n.len() as i64 - 1
    }

    /// Algorithm 8: BisectTriangles.
    fn bisect_triangles(&mut self, i: usize) {
        let i_b = self.get(i, 4) as usize;
        let v = self.t[i];
        let v_b = self.t[i_b];
        let k = 2 - self.get(i, 8) % 2;
        let n_x = self.push_midpoint(v[0], v[k as usize]);
        let o = (self.get(i, 7) + 1) % 2;
        let o_b = (self.get(i_b, 7) + 1) % 2;
        self.set(i, 8, self.get(i, 8) + 1);
        self.set(i_b, 8, self.get(i_b, 8) + 1);
        if k == 1 {
            self.set(i, 1, v[0]);
            self.set(i, 2, n_x);
            self.set(i, 3, v[2]);
            self.set(i_b, 1, v_b[0]);
            self.set(i_b, 2, n_x);
            self.set(i_b, 3, v_b[2]);
            self.t.push([v[1], n_x, v[2], 0, 0, 0, o, self.get(i, 8)]);
            self.t.push([v_b[1], n_x, v_b[2], 0, 0, 0, o_b, self.get(i_b, 8)]);
        } else {
            self.set(i, 1, v[0]);
            self.set(i, 2, v[1]);
            self.set(i, 3, n_x);
            self.set(i_b, 1, v_b[0]);
            self.set(i_b, 2, v_b[1]);
            self.set(i_b, 3, n_x);
            self.t.push([v[1], v[2], n_x, 0, 0, 0, self.get(i, 7), self.get(i, 8)]);
            self.t.push([v_b[1], v_b[2], n_x, 0, 0, 0, self.get(i_b, 7), self.get(i_b, 8)]);
        }
        let case = (k, self.get(i, 7), self.get(i_b, 7));
        *self.branches.entry((8, case.0, case.1, Some(case.2))).or_default() += 1;
        match case {
            (1, 0, 0) | (2, 1, 1) => self.update_neighbours1(i),
            (1, 1, 0) | (2, 0, 1) => self.update_neighbours2(i),
            (1, 0, 1) | (2, 1, 0) => self.update_neighbours3(i),
            _ => self.update_neighbours4(i),
        }
    }

    /// Algorithm 9: UpdateNeighbours1.
    fn update_neighbours1(&mut self, i: usize) {
        *self.routines.entry("UpdateNeighbours1").or_default() += 1;
        let new = self.n_t() - 1;
        let new_b = self.n_t();
        let i_b = self.get(i, 4) as usize;
        let n = [self.get(i, 5), self.get(i, 6)];
        let n_b = [self.get(i_b, 5), self.get(i_b, 6)];
        self.set(i, 4, n[0]);
        self.set(i, 5, new as i64);
        self.set(i, 6, new_b as i64);
        self.set(i_b, 4, n_b[0]);
        self.set(i_b, 5, new_b as i64);
        self.set(i_b, 6, new as i64);
        self.set(new, 4, n[1]);
        self.set(new, 5, i_b as i64);
        self.set(new, 6, i as i64);
        self.set(new_b, 4, n_b[1]);
        self.set(new_b, 5, i as i64);
        self.set(new_b, 6, i_b as i64);
        self.replace_triangle_neighbour(n[1], i, new);
        self.replace_triangle_neighbour(n_b[1], i_b, new_b);
    }

    /// Algorithm 21: UpdateNeighbours2.
    fn update_neighbours2(&mut self, i: usize) {
        *self.routines.entry("UpdateNeighbours2").or_default() += 1;
        let new = self.n_t() - 1;
        let new_b = self.n_t();
        let i_b = self.get(i, 4) as usize;
        let n = [self.get(i, 5), self.get(i, 6)];
        let n_b = [self.get(i_b, 5), self.get(i_b, 6)];
        self.set(i, 4, n[1]);
        self.set(i, 5, i_b as i64);
        self.set(i, 6, new as i64);
        self.set(i_b, 4, n_b[0]);
        self.set(i_b, 5, new_b as i64);
        self.set(i_b, 6, i as i64);
        self.set(new, 4, n[0]);
        self.set(new, 5, i as i64);
        self.set(new, 6, new_b as i64);
        self.set(new_b, 4, n_b[1]);
        self.set(new_b, 5, new as i64);
        self.set(new_b, 6, i_b as i64);
        self.replace_triangle_neighbour(n[0], i, new);
        self.replace_triangle_neighbour(n_b[1], i_b, new_b);
    }

    /// Algorithm 22: UpdateNeighbours3.
    fn update_neighbours3(&mut self, i: usize) {
        *self.routines.entry("UpdateNeighbours3").or_default() += 1;
        let new = self.n_t() - 1;
        let new_b = self.n_t();
        let i_b = self.get(i, 4) as usize;
        let n = [self.get(i, 5), self.get(i, 6)];
        let n_b = [self.get(i_b, 5), self.get(i_b, 6)];
        self.set(i, 4, n[0]);
        self.set(i, 5, new as i64);
        self.set(i, 6, i_b as i64);
        self.set(i_b, 4, n_b[1]);
        self.set(i_b, 5, i as i64);
        self.set(i_b, 6, new_b as i64);
        self.set(new, 4, n[1]);
        self.set(new, 5, new_b as i64);
        self.set(new, 6, i as i64);
        self.set(new_b, 4, n_b[0]);
        self.set(new_b, 5, i_b as i64);
        self.set(new_b, 6, new as i64);
        self.replace_triangle_neighbour(n[1], i, new);
        self.replace_triangle_neighbour(n_b[0], i_b, new_b);
    }

    /// Algorithm 23: UpdateNeighbours4.
    fn update_neighbours4(&mut self, i: usize) {
        *self.routines.entry("UpdateNeighbours4").or_default() += 1;
        let new = self.n_t() - 1;
        let new_b = self.n_t();
        let i_b = self.get(i, 4) as usize;
        let n = [self.get(i, 5), self.get(i, 6)];
        let n_b = [self.get(i_b, 5), self.get(i_b, 6)];
        self.set(i, 4, n[1]);
        self.set(i, 5, new_b as i64);
        self.set(i, 6, new as i64);
        self.set(i_b, 4, n_b[1]);
        self.set(i_b, 5, new as i64);
        self.set(i_b, 6, new_b as i64);
        self.set(new, 4, n[0]);
        self.set(new, 5, i as i64);
        self.set(new, 6, i_b as i64);
        self.set(new_b, 4, n_b[0]);
        self.set(new_b, 5, i_b as i64);
        self.set(new_b, 6, i as i64);
        self.replace_triangle_neighbour(n[0], i, new);
        self.replace_triangle_neighbour(n_b[0], i_b, new_b);
    }

    /// Algorithm 19: BisectBoundaryTriangle.
    fn bisect_boundary_triangle(&mut self, i: usize) {
        let v = self.t[i];
        let k = 2 - self.get(i, 8) % 2;
        let n_x = self.push_midpoint(v[0], v[k as usize]);
        let o = (self.get(i, 7) + 1) % 2;
        self.set(i, 8, self.get(i, 8) + 1);
        if k == 1 {
            self.set(i, 1, v[0]);
            self.set(i, 2, n_x);
            self.set(i, 3, v[2]);
            self.t.push([v[1], n_x, v[2], 0, 0, 0, o, self.get(i, 8)]);
        } else {
            self.set(i, 1, v[0]);
            self.set(i, 2, v[1]);
            self.set(i, 3, n_x);
            self.t.push([v[1], v[2], n_x, 0, 0, 0, self.get(i, 7), self.get(i, 8)]);
        }
        let case = (k, self.get(i, 7));
        *self.branches.entry((19, case.0, case.1, None)).or_default() += 1;
        match case {
            (1, 0) | (2, 1) => self.update_boundary_neighbours1(i),
            _ => self.update_boundary_neighbours2(i),
        }
    }

    /// Algorithm 24: UpdateBoundaryNeighbours1.
    fn update_boundary_neighbours1(&mut self, i: usize) {
        *self.routines.entry("UpdateBoundaryNeighbours1").or_default() += 1;
        let new = self.n_t();
        let beta = self.get(i, 4);
        let n = [self.get(i, 5), self.get(i, 6)];
        self.set(i, 4, n[0]);
        self.set(i, 5, new as i64);
        self.set(i, 6, beta);
        self.set(new, 4, n[1]);
        self.set(new, 5, beta);
        self.set(new, 6, i as i64);
        self.replace_triangle_neighbour(n[1], i, new);
    }

    /// Algorithm 25: UpdateBoundaryNeighbours2.
    fn update_boundary_neighbours2(&mut self, i: usize) {
        *self.routines.entry("UpdateBoundaryNeighbours2").or_default() += 1;
        let new = self.n_t();
        let beta = self.get(i, 4);
        let n = [self.get(i, 5), self.get(i, 6)];
        self.set(i, 4, n[1]);
        self.set(i, 5, beta);
        self.set(i, 6, new as i64);
        self.set(new, 4, n[0]);
        self.set(new, 5, i as i64);
        self.set(new, 6, beta);
        self.replace_triangle_neighbour(n[0], i, new);
    }

    /// Algorithm 20: ReplaceTriangleNeighbour.
    fn replace_triangle_neighbour(&mut self, i: i64, j: usize, k: usize) {
        if i > 0 {
            let (i, j, k) = (i as usize, j as i64, k as i64);
            if self.get(i, 4) == j {
                self.set(i, 4, k);
            } else if self.get(i, 5) == j {
                self.set(i, 5, k);
            } else {
                self.set(i, 6, k);
            }
        }
    }

    /// Algorithm 10: RefineTriangle.
    pub fn refine_triangle(&mut self, i: usize) {
        let i_b = self.get(i, 4);
        if i_b < 0 {
            self.bisect_boundary_triangle(i);
            self.bisect_triangles_in_stack();
        } else if self.get(i, 8) == self.get(i_b as usize, 8) {
            self.bisect_triangles(i);
            self.bisect_triangles_in_stack();
        } else {
            self.stack.push(i);
            self.refine_triangle(i_b as usize);
        }
    }

    /// Algorithm 11: BisectTrianglesInStack.
    fn bisect_triangles_in_stack(&mut self) {
        while let Some(j) = self.stack.pop() {
            self.bisect_triangles(j);
        }
    }

    /// Algorithm 12: RefineMesh. `exceeds` is Eq. (13) for the level and the vertices of a triangle.
    pub fn refine_mesh(&mut self, exceeds: impl Fn(i64, [Node; 3]) -> bool) {
        let mut i = 1;
        while i <= self.n_t() {
            while exceeds(self.get(i, 8), self.corners(i)) {
                self.refine_triangle(i);
            }
            i += 1;
        }
    }

    pub fn corners(&self, i: usize) -> [Node; 3] {
        [1, 2, 3].map(|j| self.n[self.get(i, j) as usize])
    }

    /// Algorithm 13: AdjacencyList. Entry 0 is empty.
    pub fn adjacency_list(&self) -> Vec<Vec<i64>> {
        let p_v = [(2, 3), (1, 3), (1, 2)];
        let mut a = vec![[0i64; 16]; self.n.len()];
        let mut p_a = vec![1usize; self.n.len()];
        for i in 1..self.t.len() {
            for j in 1..=3 {
                let n = self.get(i, j) as usize;
                let n_p = p_a[n];
                a[n][n_p - 1] = self.get(i, p_v[j - 1].0);
                a[n][n_p] = self.get(i, p_v[j - 1].1);
                p_a[n] = n_p + 2;
            }
        }
        let row = |row: [i64; 16]| {
            let mut row = row.to_vec();
            row.sort_unstable();
            row.dedup();
            row.retain(|&n| n != 0);
            row
        };
        a.into_iter().map(row).collect()
    }

    /// Algorithm 14: InitialTriangle, for a point in lattice coordinates.
    fn initial_triangle(&self, y: [f64; 2]) -> usize {
        let (n_e, delta) = (self.n_e, self.delta as f64);
        let (x, y) = (y[0] / delta, y[1] / delta);
        let x_ = 1.max(x.ceil() as i64);
        let y_ = 1.max(y.ceil() as i64);
        let i = 2 * x_ - 1 + 2 * n_e * (y_ - 1);
        (if y > (x_ + y_ - 1) as f64 - x { i + 1 } else { i }) as usize
    }

    /// Algorithm 15: PointLocation, for a point in lattice coordinates; `None` where item 8 of Appendix A
    /// finds that the coarse triangle was removed.
    pub fn point_location(&self, y: [f64; 2], random: &mut fastrand::Rng) -> Option<usize> {
        let m_l = self.t[1..].iter().map(|t| t[7]).max().unwrap_or(0);
        let n_max = 1u64 << m_l;
        let mut i_prev = 0i64;
        let mut n = 0;
        let mut b = true;
        let start = self.m_t[self.initial_triangle(y)];
        if start < 0 {
            return None;
        }
        let mut i = start as usize;
        let mut t = self.corners(i);
        while b && n <= n_max {
            b = false;
            let e = self.edges(i);
            let mut p = [1, 2, 3];
            random.shuffle(&mut p);
            for j in p {
                let at = |vertex: usize| t[vertex - 1].map(|c| c as f64);
                let (to, from) = (at(e[j - 1].0), at(e[j - 1].1));
                let v = [y[0] - from[0], y[1] - from[1]];
                let w = [to[0] - from[0], to[1] - from[1]];
                let across = self.get(i, j + 3);
                if across != i_prev && across > 0 && v[0] * w[1] - v[1] * w[0] > 0.0 {
                    b = true;
                    i_prev = i as i64;
                    i = across as usize;
                    t = self.corners(i);
                    break;
                }
            }
            n += 1;
        }
        Some(i)
    }

    /// Returns the table ℰ of Section 7.2.
    fn edges(&self, i: usize) -> [(usize, usize); 3] {
        match (2 - self.get(i, 8) % 2, self.get(i, 7)) {
            (1, 0) => [(1, 2), (3, 1), (2, 3)],
            (1, _) => [(2, 1), (3, 2), (1, 3)],
            (_, 0) => [(3, 1), (2, 3), (1, 2)],
            _ => [(1, 3), (2, 1), (3, 2)],
        }
    }
}
