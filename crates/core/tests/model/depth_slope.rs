//! Depths smoothed to a slope, on random meshes and by edges that are listed here.

use fastrand::Rng;
use glam::DVec2;
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::layers::DepthSlope;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Extract;

use crate::formula_mesh::formula_mesh;
use crate::runs::seeds;

fn with_mesh<T>(random: &mut Rng, read: impl FnOnce(&Extract) -> T) -> T {
    let formula = format!("0.02 + 0.3*hypot(x - {}, y - {})", random.f64(), random.f64());
    let domain = Domain::rectangle(Rect::UNIT);
    read(&formula_mesh(&domain, 0.25, BoundaryTreatment::Report, &formula).mesh.extract())
}

/// A shelf, a cliff, banks and noise; land here and there.
fn depth(at: DVec2, random: &mut Rng) -> f64 {
    let cliff = if at.x + 0.3 * at.y > 0.6 { 900.0 } else { 4.0 };
    let bank = 300.0 * (at.x * 23.0).sin() * (at.y * 17.0).cos();
    let noise = libm::exp(3.0 * random.f64() - 1.0);
    if random.u8(..40) == 0 { -3.0 * random.f64() } else { cliff + bank.max(0.0) * random.f64() + noise }
}

fn edges(mesh: &Extract) -> Vec<[usize; 2]> {
    mesh.cells()
        .flat_map(|cell| {
            let [a, b, c] = cell.corners;
            [[a, b], [b, c], [c, a]]
        })
        .collect()
}

fn factor(depths: &[f64], [a, b]: [usize; 2]) -> f64 {
    let (a, b) = (depths[a], depths[b]);
    if a > 0.0 && b > 0.0 { (a - b).abs() / (a + b) } else { 0.0 }
}

#[test]
fn no_edge_is_steeper_than_the_limit_and_the_water_stays() {
    for seed in seeds(12) {
        let mut random = Rng::with_seed(seed);
        let limit = [0.05, 0.2, 0.4, 0.9][random.usize(..4)];
        with_mesh(&mut random.clone(), |mesh| {
            let nodes: Vec<DVec2> = mesh.world_nodes().collect();
            let old: Vec<f64> = nodes.iter().map(|at| depth(*at, &mut random)).collect();
            let mut new = old.clone();
            let found = DepthSlope::smooth(mesh.view(), &mut new, limit);
            let steepest =
                |depths: &[f64]| edges(mesh).into_iter().map(|edge| factor(depths, edge)).fold(0.0, f64::max);
            assert!(steepest(&new) <= limit, "document {seed}: {}", steepest(&new));
            assert_eq!((found.before, found.after), (steepest(&old), steepest(&new)));
            // Land stays, and water keeps within the depths that there were.
            let wet = || old.iter().copied().filter(|depth| *depth > 0.0);
            let (least, most) = (wet().fold(f64::INFINITY, f64::min), wet().fold(0.0, f64::max));
            for (old, new) in old.iter().zip(&new) {
                assert!(if *old <= 0.0 { old == new } else { (least..=most).contains(new) });
            }
            let changed = (0..old.len()).filter(|&node| old[node] != new[node]);
            let largest =
                changed.clone().max_by(|&a, &b| (old[a] - new[a]).abs().total_cmp(&(old[b] - new[b]).abs()));
            assert_eq!(found.changed, changed.count());
            let largest = largest.unwrap();
            assert_eq!(found.largest.abs(), (new[largest] - old[largest]).abs());
            assert_eq!(found.dry, old.iter().filter(|depth| **depth <= 0.0).count());
            // The volume over triangles, each by the mean of its corners.
            let volume = |depths: &[f64]| -> f64 {
                let of_cell = mesh.cells().map(|cell| {
                    let [a, b, c] = cell.corners.map(|node| nodes[node]);
                    let [d, e, f] = cell.corners.map(|node| depths[node]);
                    0.5 * (b - a).perp_dot(c - a).abs() * (d + e + f) / 3.0
                });
                of_cell.sum()
            };
            let more = (volume(&new) - volume(&old)) / wet_volume(&volume, &old);
            assert!(
                (more - found.more_water).abs() < 1e-9 && (-1e-9..1e-3).contains(&more),
                "{seed} {limit}: {more}"
            );
            // What fits already stays as it is.
            let again = DepthSlope::smooth(mesh.view(), &mut new.clone(), limit);
            assert_eq!((again.changed, again.before), (0, found.after));
        });
    }
}

fn wet_volume(volume: &impl Fn(&[f64]) -> f64, depths: &[f64]) -> f64 {
    volume(&depths.iter().map(|depth| depth.max(0.0)).collect::<Vec<_>>())
}

#[test]
fn gentle_depths_stay_and_a_step_shares_its_water() {
    with_mesh(&mut Rng::with_seed(3), |mesh| {
        let mut flat = vec![7.0; mesh.nodes().len()];
        let found = DepthSlope::smooth(mesh.view(), &mut flat, 0.1);
        assert!(found.changed == 0 && found.before == 0.0 && flat.iter().all(|depth| *depth == 7.0));
        let step = |at: DVec2| if at.x < 0.5 { 10.0 } else { 100.0 };
        let mut depths: Vec<f64> = mesh.world_nodes().map(step).collect();
        DepthSlope::smooth(mesh.view(), &mut depths, 0.3);
        // Both sides change, and far away nothing does.
        let all = || mesh.world_nodes().zip(&depths);
        assert!(
            all().any(|(at, depth)| at.x < 0.5 && *depth > 11.0)
                && all().any(|(at, depth)| at.x >= 0.5 && *depth < 99.0)
        );
    });
}
