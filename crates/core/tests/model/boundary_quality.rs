//! Better triangles along the outline, counted by code that knows the triangles alone.

use std::collections::HashMap;

use glam::DVec2;
use meshbrush_core::document::{Document, Follower};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::{Cleaning, Extract};

use crate::promise::{Coast, Found, check};
use crate::runs::{prints_table, seeds};

/// Counts the defects edge by edge and angle by angle.
fn counted(extract: &Extract) -> [usize; 3] {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let (mut edges, mut at_node) = (HashMap::new(), vec![0; nodes.len()]);
    for triangle in extract.cells() {
        let [a, b, c] = triangle.corners;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_insert(0) += 1;
            at_node[from] += 1;
        }
    }
    let mut on_boundary = vec![false; nodes.len()];
    for (ends, _) in edges.iter().filter(|(_, count)| **count == 1) {
        ends.iter().for_each(|&end| on_boundary[end] = true);
    }
    let (mut angles, mut between) = (0, 0);
    for triangle in extract.cells() {
        let [a, b, c] = triangle.corners.map(|node| nodes[node]);
        let angle = |p: DVec2, q: DVec2, r: DVec2| (q - p).angle_to(r - p).to_degrees().abs();
        angles += usize::from(angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b)) < 25.0);
        between += usize::from(triangle.corners.iter().all(|&node| on_boundary[node]));
    }
    [angles, between, at_node.iter().filter(|&&count| count > 8).count()]
}

#[test]
fn improved_boundaries_have_fewer_defects() {
    let (mut sums, mut defects) = ([Found::default(); 2], [[0; 3]; 2]);
    let mut seconds = [0.0; 2];
    for seed in seeds(6) {
        let coast = Coast::new(seed);
        let mut document = Document::new(coast.settings.clone(), None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        let (mesh, domain) = (follower.mesh(), follower.domain());
        let targets = follower.edge_targets(document.paint());
        for (n, improves_boundary) in [false, true].into_iter().enumerate() {
            let cleaning = Cleaning { improves_boundary, ..Cleaning::FOR_SOLVERS };
            let began = std::time::Instant::now();
            let derived = DerivedMesh::new(mesh, domain, targets, &cleaning);
            seconds[n] += began.elapsed().as_secs_f64();
            let extract = derived.extract(mesh);
            assert_eq!(derived.violations(&extract), [], "seed {seed}");
            let found = check(&extract, derived.fit().unwrap(), &coast);
            assert_eq!(found.over, 0, "seed {seed}: {found:?}");
            let own = counted(&extract);
            (0..3).for_each(|k| defects[n][k] += own[k]);
            sums[n] = sums[n].and(found);
        }
    }
    if prints_table() {
        eprintln!("defects {defects:?}\n{:?}\n{:?}\n{seconds:?} s", sums[0], sums[1]);
    }
    assert!((0..3).all(|k| 2 * defects[1][k] < defects[0][k]), "{defects:?}");
    assert!(20 * defects[1][0] < defects[0][0] && defects[1][2] == 0, "{defects:?}");
    assert!(1000 * sums[1].triangles < 1005 * sums[0].triangles);
    assert_eq!(sums[1].on_outline, sums[0].on_outline);
}
