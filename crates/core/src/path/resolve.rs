//! A march after the costs of some triangles changed.

use super::Passage;
use super::march::{Kite, March, NodeState, Seed, from_corner, through_edge};
use super::path_mesh::{NONE, PathMesh};
use super::shared::SharedParts;

impl March {
    /// Brings the values up to date after the costs of some triangles changed, and returns how many nodes
    /// were accepted again. The last run, from the same seeds through the same mesh, must have gone to the
    /// end.
    ///
    /// The values are those of a new run, bit for bit. A node whose value came from a changed triangle, or
    /// from a node whose value changes, loses its value. Then the march continues from the others, and the
    /// values of accepted nodes may fall. A node whose value falls takes away the values of those that depend
    /// on it, so a node can be accepted several times: once half as many nodes as there are were accepted, or
    /// where more than half of the nodes lose their values at once, a new march is faster.
    pub fn resolve(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        seeds: &[Seed],
        changed: &[u32],
    ) -> usize {
        self.go_on_without(mesh, costs, least, seeds, (changed, &[]))
    }

    /// Moves to a mesh that shares triangles with the previous one, and brings the values up to date as
    /// [`Self::resolve`] does, with the same result. `changed` has the triangles that are new, and those
    /// whose cost or passage changed.
    pub(super) fn move_to(
        &mut self,
        [old, mesh]: [&PathMesh; 2],
        costs: &[f64],
        least: Passage,
        seeds: &[Seed],
        (shared, changed): (&SharedParts, &[u32]),
    ) -> usize {
        let mut lost = Vec::new();
        let before = std::mem::take(&mut self.nodes);
        for ((number, &at), &known) in (0..).zip(&mesh.nodes).zip(&shared.nodes) {
            let unknown = NodeState { at, value: f64::INFINITY, from: NONE, is_accepted: false };
            let mut front = before.get(known as usize).copied().unwrap_or(unknown);
            if front.from != NONE {
                if !is_kept([old, mesh], front.from, shared) {
                    lost.push(number);
                }
                front.from = shared.new_triangles[front.from as usize];
            }
            self.nodes.push(front);
        }
        self.go_on_without(mesh, costs, least, seeds, (changed, &lost))
    }

    /// Continues after the values from `changed` triangles and those of `lost` nodes became invalid.
    fn go_on_without(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        seeds: &[Seed],
        (changed, lost): (&[u32], &[u32]),
    ) -> usize {
        let mut edit = MarchEdit { march: self, mesh, costs, least, seeds, lost: Vec::new() };
        edit.march.queue.clear();
        edit.march.accepted_count = 0;
        lost.iter().for_each(|&node| edit.lose(node));
        changed.iter().for_each(|&t| edit.lose_values_from(t));
        let most = mesh.node_count() / 2;
        if edit.lost.len() > most {
            self.run(mesh, costs, least, seeds, None);
            return self.accepted_count;
        }
        edit.offer_to_lost();
        for &t in changed {
            edit.offer_within(t);
            // A kite has the cost of two triangles.
            mesh.across[t as usize]
                .iter()
                .filter(|&&across| across != NONE)
                .for_each(|&t| edit.offer_within(t));
        }
        while let Some(node) = edit.march.next() {
            if edit.march.accepted_count > most {
                self.run(mesh, costs, least, seeds, None);
                return most + self.accepted_count;
            }
            edit.spread(node);
        }
        self.accepted_count
    }
}

/// Returns whether values from a triangle of an old mesh may still come from it: both meshes have it, and
/// where it has an obtuse angle, the one across.
fn is_kept([old, new]: [&PathMesh; 2], t: u32, shared: &SharedParts) -> bool {
    let Some(kept) = new.triangles.get(shared.new_triangles[t as usize] as usize) else { return false };
    let obtuse = usize::from(kept.obtuse);
    let across = |mesh: &PathMesh, t: u32| mesh.across[t as usize][(obtuse + 1) % 3];
    if obtuse == 3 {
        return true;
    }
    let [of_old, of_new] = [across(old, t), across(new, shared.new_triangles[t as usize])];
    of_old == NONE || shared.new_triangles[of_old as usize] == of_new
}

struct MarchEdit<'a> {
    march: &'a mut March,
    mesh: &'a PathMesh,
    costs: &'a [f64],
    least: Passage,
    seeds: &'a [Seed],
    /// Nodes without a value that no value was offered to yet.
    lost: Vec<u32>,
}

impl MarchEdit<'_> {
    fn front(&self, node: u32) -> NodeState {
        self.march.nodes[node as usize]
    }

    /// Takes the values that came through a triangle, also those from a kite that it is a part of.
    fn lose_values_from(&mut self, t: u32) {
        for node in self.mesh.triangles[t as usize].corners {
            if self.front(node).from == t {
                self.lose(node);
            }
        }
        if !self.mesh.has_obtuse {
            return;
        }
        for other in self.mesh.across[t as usize].into_iter().filter(|&other| other != NONE) {
            let obtuse = usize::from(self.mesh.triangles[other as usize].obtuse);
            let apex = self.mesh.triangles[other as usize].corners.get(obtuse).copied();
            if let Some(apex) = apex.filter(|&apex| self.front(apex).from == other) {
                self.lose(apex);
            }
        }
    }

    /// Takes the value from a node, and from all nodes whose values came from it.
    fn lose(&mut self, node: u32) {
        let mut stack = vec![node];
        while let Some(number) = stack.pop() {
            let node = &mut self.march.nodes[number as usize];
            if node.value == f64::INFINITY {
                continue;
            }
            let before = node.value;
            (node.value, node.from, node.is_accepted) = (f64::INFINITY, NONE, false);
            self.lost.push(number);
            self.dependents(number, before, &mut stack);
        }
    }

    /// The nodes whose values may come from a node with a value.
    fn dependents(&self, number: u32, value: f64, found: &mut Vec<u32>) {
        for &t in self.mesh.around(number) {
            let corners = self.mesh.triangles[t as usize].corners;
            let mut add = |node: u32, by: u32| {
                let front = self.front(node);
                if node != number && front.from == by && front.value >= value {
                    found.push(node);
                }
            };
            corners.iter().for_each(|&node| add(node, t));
            if self.mesh.has_obtuse {
                let k = (0..3).find(|&k| corners[k] == number).expect("rows have the triangles of a node");
                let across = self.mesh.across[t as usize][(k + 1) % 3];
                if let Some(kite) = Kite::new(self.mesh, across, self.least) {
                    add(kite.apex, across);
                }
            }
        }
    }

    /// Offers values to the nodes that lost theirs.
    fn offer_to_lost(&mut self) {
        while let Some(node) = self.lost.pop() {
            for &(_, value) in self.seeds.iter().filter(|(seed, _)| *seed == node) {
                self.offer(node, value, NONE);
            }
            for n in 0..self.mesh.around(node).len() {
                self.offer_in(self.mesh.around(node)[n], node);
            }
        }
    }

    /// Offers values to all corners of a triangle.
    fn offer_within(&mut self, t: u32) {
        for node in self.mesh.triangles[t as usize].corners {
            self.offer_in(t, node);
        }
    }

    /// Offers a node what the accepted corners of a triangle around it give.
    fn offer_in(&mut self, t: u32, node: u32) {
        let triangle = self.mesh.triangles[t as usize];
        if triangle.passage < self.least {
            return;
        }
        let k = (0..3).find(|&k| triangle.corners[k] == node).expect("a corner of the triangle");
        let [a, b] = [1, 2].map(|step| triangle.corners[(k + step) % 3]);
        let cost = self.costs[t as usize];
        let (front_a, front_b, to) = (self.front(a), self.front(b), self.front(node));
        let is_a_first = (front_a.value, a) < (front_b.value, b);
        let mut value = f64::INFINITY;
        if front_a.is_accepted && front_b.is_accepted {
            value = through_edge(&front_a, &front_b, [a, b], &to, node, cost);
        }
        let is_through = value < f64::INFINITY;
        // As in a march: from the end that was accepted last only where nothing leads through the edge.
        for (front, is_first) in [(front_a, is_a_first), (front_b, !is_a_first)] {
            if front.is_accepted && front.value < to.value && (is_first || !is_through) {
                value = value.min(from_corner(&front, &to, cost));
            }
        }
        self.offer(node, value, t);
        if usize::from(triangle.obtuse) == k
            && let Some(kite) = Kite::new(self.mesh, t, self.least)
        {
            self.offer_through(&kite, t);
        }
    }

    fn offer_through(&mut self, kite: &Kite, t: u32) {
        let cost = kite.triangles.map(|t| self.costs[t as usize]);
        let cost = cost[0].max(cost[1]);
        for [a, b] in kite.edges {
            let [front_a, front_b, to] = [a, b, kite.apex].map(|n| self.front(n));
            if front_a.is_accepted && front_b.is_accepted {
                self.offer(kite.apex, through_edge(&front_a, &front_b, [a, b], &to, kite.apex, cost), t);
            }
        }
    }

    /// Offers a value. If the node was accepted with a greater one, those that depend on it lose theirs.
    fn offer(&mut self, node: u32, value: f64, from: u32) {
        let known = self.front(node);
        if value >= known.value || value.is_nan() {
            return;
        }
        if known.is_accepted {
            self.lose(node);
            // It has its new value below.
            self.lost.retain(|&lost| lost != node);
        }
        self.march.offer(node, value, from);
        if known.is_accepted {
            self.offer_to_lost();
        }
    }

    /// Offers values to all nodes around an accepted one.
    fn spread(&mut self, number: u32) {
        let value = self.front(number).value;
        for n in 0..self.mesh.around(number).len() {
            let t = self.mesh.around(number)[n];
            let triangle = self.mesh.triangles[t as usize];
            for node in triangle.corners {
                // A lower value does not come from here.
                if node != number && self.front(node).value > value {
                    self.offer_in(t, node);
                }
            }
            if self.mesh.has_obtuse {
                let k = (0..3).find(|&k| triangle.corners[k] == number).expect("a corner of the triangle");
                let across = self.mesh.across[t as usize][(k + 1) % 3];
                for obtuse in [across, t] {
                    if let Some(kite) = Kite::new(self.mesh, obtuse, self.least) {
                        self.offer_through(&kite, obtuse);
                    }
                }
            }
        }
    }
}
