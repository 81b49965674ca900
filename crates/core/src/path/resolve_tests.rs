//! Marches that follow edits are compared with new ones.

use super::Passage;
use super::march::{Kite, March, NodeState, through_edge};
use super::path_mesh::{PathMesh, obtuse_corner};
use super::shared::SharedParts;
use crate::geometry::{Lattice, Rect};
use crate::mesh::{Limits, Mesh};

pub(super) fn random_mesh(random: &mut fastrand::Rng) -> PathMesh {
    let mut mesh = PathMesh::new(refined(random, None).view());
    if random.bool() {
        move_nodes(&mut mesh, random.u64(..));
    }
    mesh
}

/// Returns a mesh that is finer around some places: another one, or one that was refined further.
pub(super) fn refined(random: &mut fastrand::Rng, known: Option<&Mesh>) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 10_000).unwrap();
    let coarse = || Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    let mut mesh = known.cloned().unwrap_or_else(coarse);
    let (count, finest, growth) = if known.is_some() { (1, 0.01, 2.0) } else { (3, 0.02, 0.3) };
    for _ in 0..count {
        let [x, y] = [random.f64(), random.f64()];
        let near = glam::dvec2(x, y);
        mesh.refine(&Limits::default(), |element| {
            let [a, b, c] = element.world_corners();
            element.diameter() > finest + growth * ((a + b + c) / 3.0).distance(near)
        })
        .unwrap();
    }
    mesh
}

/// Moves inner nodes, so that triangles get obtuse angles.
/// Nodes that two meshes share, with the same triangles around them, go to the same places.
fn move_nodes(mesh: &mut PathMesh, seed: u64) {
    let shortest = |mesh: &PathMesh, node: u32| {
        let sides = mesh.around(node).iter().map(|&t| {
            let [a, b, c] = mesh.corners(t);
            a.distance(b).min(b.distance(c)).min(c.distance(a))
        });
        sides.fold(f64::INFINITY, f64::min)
    };
    let step = |node: u32| {
        let at = mesh.nodes[node as usize];
        let mut random = fastrand::Rng::with_seed(seed ^ at.x.to_bits() ^ at.y.to_bits().rotate_left(17));
        0.45 * shortest(mesh, node) * glam::dvec2(random.f64() - 0.5, random.f64() - 0.5)
    };
    let moves: Vec<glam::DVec2> = (0..mesh.node_count() as u32).map(step).collect();
    for (node, step) in mesh.nodes.iter_mut().zip(moves) {
        if node.min(1.0 - *node).min_element() > 0.0 {
            *node += step;
        }
    }
    for t in 0..mesh.triangle_count() {
        mesh.triangles[t].obtuse = obtuse_corner(&mesh.corners(t as u32));
        mesh.has_obtuse |= mesh.triangles[t].obtuse < 3;
    }
    mesh.sort_along_curve();
}

/// Returns the triangles across from obtuse angles through which values came.
fn crossed_by_kites(march: &March, mesh: &PathMesh, costs: &[f64]) -> Vec<u32> {
    let crossed = |(number, node): (u32, &NodeState)| {
        let kite = Kite::new(mesh, node.from, Passage::Open).filter(|kite| kite.apex == number)?;
        let cost = kite.triangles.map(|t| costs[t as usize]);
        let is_from = |&[a, b]: &[u32; 2]| {
            let [from_a, from_b] = [a, b].map(|n| march.nodes[n as usize]);
            through_edge(&from_a, &from_b, [a, b], node, number, cost[0].max(cost[1])) == node.value
        };
        kite.edges.iter().any(is_from).then_some(kite.triangles[1])
    };
    (0..).zip(&march.nodes).filter_map(crossed).collect()
}

#[test]
fn a_march_goes_over_to_another_mesh_bit_for_bit() {
    let mut random = fastrand::Rng::with_seed(1405);
    let (mut redone, mut all, mut kites) = (0, 0, 0);
    for round in 0..100 {
        let (moved, seed) = (random.bool(), random.u64(..));
        let path_mesh = |mesh: &Mesh| {
            let mut mesh = PathMesh::new(mesh.view());
            if moved {
                move_nodes(&mut mesh, seed);
            }
            mesh
        };
        // By the place of a triangle, so that both meshes agree where they are the same.
        let cost = |mesh: &PathMesh, t: u32| {
            let [a, b, c] = mesh.corners(t);
            let bits = (a + 3.0 * b + 5.0 * c).to_array().map(f64::to_bits);
            0.5 + fastrand::Rng::with_seed(bits[0] ^ bits[1].rotate_left(9)).f64()
        };
        let costs = |mesh: &PathMesh| -> Vec<f64> {
            (0..mesh.triangle_count() as u32).map(|t| cost(mesh, t)).collect()
        };
        let mut mesh = refined(&mut random, None);
        let mut known = path_mesh(&mesh);
        let start = known.nodes[random.usize(..known.node_count())];
        let seeds = |mesh: &PathMesh| {
            let node = (0..mesh.node_count()).find(|&n| mesh.nodes[n] == start);
            node.map(|node| [(node as u32, 0.0)])
        };
        let (mut march, mut known_costs) = (March::default(), costs(&known));
        march.run(&known, &known_costs, Passage::Open, &seeds(&known).unwrap(), None);
        for step in 0..6 {
            mesh = match random.u32(..4) {
                // As after an undo, or an edit of all.
                0 if step % 2 == 0 => refined(&mut random, None),
                _ => refined(&mut random, Some(&mesh)),
            };
            let new = path_mesh(&mesh);
            let mut new_costs = costs(&new);
            for _ in 0..random.usize(..4) {
                new_costs[random.usize(..new.triangle_count())] *= [0.3, 3.0][random.usize(..2)];
            }
            let Some(seeds) = seeds(&new) else { break };
            let shared = SharedParts::between(&known, &new);
            let is_changed = |&t: &u32| {
                let known = shared.triangles[t as usize] as usize;
                known_costs.get(known).is_none_or(|&cost| cost != new_costs[t as usize])
            };
            let changed: Vec<u32> = (0..new.triangle_count() as u32).filter(is_changed).collect();
            let mut fresh = March::default();
            fresh.run(&new, &new_costs, Passage::Open, &seeds, None);
            redone += march.move_to([&known, &new], &new_costs, Passage::Open, &seeds, (&shared, &changed));
            all += new.node_count();
            kites += crossed_by_kites(&march, &new, &new_costs).len();
            let same = march.values().zip(fresh.values()).all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(same, "{round} {step} {moved}");
            (known, known_costs) = (new, new_costs);
        }
    }
    assert!(redone < 3 * all / 4 && kites > 300, "{redone} of {all}, {kites} from kites");
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
    let (mut redone, mut all, mut kites) = (0, 0, 0);
    for _ in 0..40 {
        let mesh = random_mesh(&mut random);
        let mut costs: Vec<f64> = (0..mesh.triangle_count()).map(|_| 0.5 + random.f64()).collect();
        let seeds = [(random.u32(0..mesh.node_count() as u32), 0.0)];
        let (mut edited, mut fresh) = (March::default(), March::default());
        edited.run(&mesh, &costs, Passage::Open, &seeds, None);
        for _ in 0..30 {
            let changed: Vec<u32> = match random.u32(..5) {
                0 => crossed_by_kites(&edited, &mesh, &costs),
                1 | 2 => (0..random.u32(1..6)).map(|_| random.u32(0..costs.len() as u32)).collect(),
                // A disc, as a brush changes it.
                _ => {
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
            kites += crossed_by_kites(&fresh, &mesh, &costs).len();
        }
    }
    assert!(redone < all / 2 && kites > 300, "{redone} of {all}, {kites} from kites");
}

/// A start whose own value is a little above that of a way from another start loses that value when the way
/// becomes expensive: its own value counts again.
#[test]
fn a_start_whose_value_came_from_elsewhere_gets_its_own_again() {
    let mut random = fastrand::Rng::with_seed(1406);
    let mut own = 0;
    for _ in 0..100 {
        let mesh = random_mesh(&mut random);
        let mut costs = vec![1.0; mesh.triangle_count()];
        let [first, second] = [(); 2].map(|()| random.u32(0..mesh.node_count() as u32));
        let mut march = March::default();
        march.run(&mesh, &costs, Passage::Open, &[(first, 0.0)], None);
        let NodeState { value, from, .. } = march.nodes[second as usize];
        if first == second {
            continue;
        }
        let seeds = [(first, 0.0), (second, 1.001 * value)];
        march.run(&mesh, &costs, Passage::Open, &seeds, None);
        costs[from as usize] *= 100.0;
        march.resolve(&mesh, &costs, Passage::Open, &seeds, &[from]);
        let mut fresh = March::default();
        fresh.run(&mesh, &costs, Passage::Open, &seeds, None);
        assert!(march.values().eq(fresh.values()));
        own += usize::from(fresh.nodes[second as usize].value == seeds[1].1);
    }
    assert!(own > 30, "{own}");
}
