//! A march after the costs of some triangles changed.

use super::Passage;
use super::march::{Front, Kite, March, Seed, from_corner, through_edge};
use super::path_mesh::{NONE, PathMesh};

impl March {
    /// Brings the values up to date after the costs of some triangles changed, and returns how many nodes
    /// were accepted again. The last run, from the same seeds through the same mesh, must have gone to the
    /// end.
    ///
    /// The values are those of a new run, bit for bit. A node whose value came from a changed triangle, or
    /// from a node whose value changes, loses its value. Then the march goes on from the others, and nodes
    /// that were accepted may fall. Each that falls takes the values of those that depend on it, so a node
    /// can be accepted several times: after half as many times as there are nodes, or where more than half of
    /// the nodes lose their values at once, a new march is faster.
    pub fn resolve(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        seeds: &[Seed],
        changed: &[u32],
    ) -> usize {
        let mut edit = Edit { march: self, mesh, costs, least, seeds, lost: Vec::new() };
        edit.march.queue.clear();
        edit.march.accepted_count = 0;
        for &t in changed {
            for node in mesh.triangles[t as usize].corners {
                if edit.march.nodes[node as usize].from == t {
                    edit.lose(node);
                }
            }
        }
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

struct Edit<'a> {
    march: &'a mut March,
    mesh: &'a PathMesh,
    costs: &'a [f64],
    least: Passage,
    seeds: &'a [Seed],
    /// Nodes without a value that no value was offered to yet.
    lost: Vec<u32>,
}

impl Edit<'_> {
    fn front(&self, node: u32) -> Front {
        self.march.nodes[node as usize]
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
                if let Some(kite) = Kite::of(self.mesh, across, self.least) {
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
            && let Some(kite) = Kite::of(self.mesh, t, self.least)
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
                    if let Some(kite) = Kite::of(self.mesh, obtuse, self.least) {
                        self.offer_through(&kite, obtuse);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};

    fn random_mesh(random: &mut fastrand::Rng) -> PathMesh {
        let lattice = Lattice::covering(Rect::UNIT, 0.25, 10_000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        for _ in 0..3 {
            let [x, y] = [random.f64(), random.f64()];
            let near = glam::dvec2(x, y);
            mesh.refine(&Limits::default(), |element| {
                let [a, b, c] = element.world_corners();
                element.diameter() > 0.02 + 0.3 * ((a + b + c) / 3.0).distance(near)
            })
            .unwrap();
        }
        let mut mesh = PathMesh::new(mesh.view());
        if random.bool() {
            move_nodes(&mut mesh, random);
        }
        mesh
    }

    /// Moves inner nodes, so that triangles get obtuse angles.
    fn move_nodes(mesh: &mut PathMesh, random: &mut fastrand::Rng) {
        let shortest = |mesh: &PathMesh, node: u32| {
            let sides = mesh.around(node).iter().map(|&t| {
                let [a, b, c] = mesh.corners(t);
                a.distance(b).min(b.distance(c)).min(c.distance(a))
            });
            sides.fold(f64::INFINITY, f64::min)
        };
        let moves: Vec<glam::DVec2> = (0..mesh.node_count() as u32)
            .map(|node| 0.4 * shortest(mesh, node) * glam::dvec2(random.f64() - 0.5, random.f64() - 0.5))
            .collect();
        for (node, step) in mesh.nodes.iter_mut().zip(moves) {
            if node.min(1.0 - *node).min_element() > 0.0 {
                *node += step;
            }
        }
        for t in 0..mesh.triangle_count() {
            mesh.triangles[t].obtuse = super::super::path_mesh::obtuse_corner(&mesh.corners(t as u32));
            mesh.has_obtuse |= mesh.triangles[t].obtuse < 3;
        }
    }

    #[test]
    fn an_edit_of_nearly_everything_accepts_each_node_once() {
        let mut random = fastrand::Rng::with_seed(1404);
        for factor in [0.5, 2.0] {
            let mesh = random_mesh(&mut random);
            let mut costs: Vec<f64> = (0..mesh.triangle_count()).map(|_| 0.5 + random.f64()).collect();
            let seeds = [(random.u32(0..mesh.node_count() as u32), 0.0)];
            let mut march = March::default();
            march.run(&mesh, &costs, Passage::Open, &seeds, None);
            costs.iter_mut().for_each(|cost| *cost *= factor * (1.0 + 0.1 * random.f64()));
            let all: Vec<u32> = (0..costs.len() as u32).collect();
            let redone = march.resolve(&mesh, &costs, Passage::Open, &seeds, &all);
            assert!(redone <= mesh.node_count(), "{redone} of {}", mesh.node_count());
            let mut fresh = March::default();
            fresh.run(&mesh, &costs, Passage::Open, &seeds, None);
            assert!(march.values().eq(fresh.values()));
        }
    }

    #[test]
    fn values_after_an_edit_are_those_of_a_new_march_bit_for_bit() {
        let mut random = fastrand::Rng::with_seed(1403);
        let (mut redone, mut all, mut obtuse) = (0, 0, 0);
        for _ in 0..40 {
            let mesh = random_mesh(&mut random);
            obtuse += usize::from(mesh.has_obtuse);
            let mut costs: Vec<f64> = (0..mesh.triangle_count()).map(|_| 0.5 + random.f64()).collect();
            let seeds = [(random.u32(0..mesh.node_count() as u32), 0.0)];
            let (mut edited, mut fresh) = (March::default(), March::default());
            edited.run(&mesh, &costs, Passage::Open, &seeds, None);
            for _ in 0..30 {
                let changed: Vec<u32> = match random.bool() {
                    true => (0..random.u32(1..6)).map(|_| random.u32(0..costs.len() as u32)).collect(),
                    // A disc, as a brush changes it.
                    false => {
                        let at = glam::dvec2(random.f64(), random.f64());
                        let near = |t: &u32| mesh.corners(*t)[0].distance(at) < 0.1;
                        (0..costs.len() as u32).filter(near).collect()
                    }
                };
                let factor = [0.2, 0.9, 1.1, 5.0][random.usize(..4)];
                changed.iter().for_each(|&t| costs[t as usize] *= factor);
                redone += edited.resolve(&mesh, &costs, Passage::Open, &seeds, &changed);
                all += mesh.node_count();
                fresh.run(&mesh, &costs, Passage::Open, &seeds, None);
                let same = edited.values().zip(fresh.values()).all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(same);
            }
        }
        assert!(redone < all / 2, "{redone} of {all}");
        assert!(obtuse > 10, "{obtuse}");
    }
}
