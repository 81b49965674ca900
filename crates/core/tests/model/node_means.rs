//! Means of pixels over the cells of nodes, against sums that look at every triangle for every pixel.

use std::collections::BTreeMap;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::layers::NodeMeans;
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Extract;

use crate::formula_mesh::formula_mesh;
use crate::runs::seeds;

/// The size of the domain. With its spacing all nodes are at binary fractions.
const SIZE: DVec2 = dvec2(1.0, 0.75);

/// The nodes and triangles of a mesh that is refined around a random place.
fn with_mesh<T>(random: &mut Rng, read: impl FnOnce(&Extract) -> T) -> T {
    let formula = format!("0.03 + 0.3*hypot(x - {}, y - {})", random.f64(), random.f64());
    let domain = Domain::rectangle(Rect::new(DVec2::ZERO, SIZE));
    read(&formula_mesh(&domain, 0.25, BoundaryTreatment::Report, &formula).mesh.extract())
}

/// Classes 0 to 5, or none, over a part of the domain and more.
fn raster(random: &mut Rng) -> Raster {
    let low = dvec2(random.f64(), random.f64()) * 0.2 - 0.15;
    let size = [random.u32(20..90), random.u32(20..90)];
    let value = |_| if random.u8(..5) == 0 { f32::NAN } else { f32::from(random.u8(..6)) };
    let values = (0..size[0] * size[1]).map(value).collect();
    Raster::from_values(Rect::new(low, dvec2(1.1, 0.9)), size, values)
}

/// The barycentric coordinates of a point, by the areas of three triangles.
fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> [f64; 3] {
    let area = |p: DVec2, q: DVec2, r: DVec2| (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
    [area(at, b, c), area(a, at, c), area(a, b, at)].map(|part| part / area(a, b, c))
}

#[test]
fn a_node_has_the_mean_of_the_pixels_in_its_cell() {
    let meaning = |class: f32| 0.02 + 0.01 * f64::from(class).sqrt();
    let (mut averaged, mut alone) = (0, 0);
    for seed in seeds(12) {
        let mut random = Rng::with_seed(seed);
        let raster = raster(&mut random);
        with_mesh(&mut random, |mesh| {
            let nodes: Vec<DVec2> = mesh.world_nodes().collect();
            let with_classes = seed % 2 == 0;
            let meant = |value: f32| if with_classes { meaning(value) } else { f64::from(value) };
            let found = NodeMeans::of(mesh.view(), &raster, if with_classes { Some(&meaning) } else { None });
            let found = found.unwrap();
            let mut sums: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
            for (x, y) in raster.all().pixels().filter(|&(x, y)| !raster.get(x, y).is_nan()) {
                let at = raster.pixel_center(x, y);
                let owners = mesh.cells().filter_map(|cell| {
                    let parts = weights(cell.corners.map(|node| nodes[node]), at);
                    let is_in = parts.iter().all(|part| *part > 0.0);
                    let best = (0..3).max_by(|&m, &n| parts[m].total_cmp(&parts[n]))?;
                    is_in.then_some(cell.corners[best])
                });
                let owners: Vec<usize> = owners.collect();
                assert!(owners.len() <= 1);
                for node in owners {
                    let sum = sums.entry(node).or_default();
                    *sum = (sum.0 + meant(raster.get(x, y)), sum.1 + 1.0);
                }
            }
            for (node, &at) in nodes.iter().enumerate() {
                let expected = match sums.get(&node) {
                    Some((sum, count)) => Some(sum / count),
                    None if with_classes => raster.sample(at).filter(|v| !v.is_nan()).map(meaning),
                    None => raster.linear_at(at),
                };
                match sums.contains_key(&node) {
                    true => averaged += 1,
                    false => alone += 1,
                }
                let close = |expected: f64| (found.values[node] - expected).abs() < 1e-9;
                assert!(
                    expected.is_none_or(close),
                    "document {seed}, {at}: {expected:?} {}",
                    found.values[node]
                );
            }
            assert!(found.filled < nodes.len() && found.farthest < 0.2);
        });
    }
    assert!(averaged > 500 && alone > 100, "{averaged} {alone}");
}

#[test]
fn every_pixel_in_the_domain_counts_once() {
    for seed in seeds(10) {
        let mut random = Rng::with_seed(seed);
        // Centres of pixels lie on nodes and edges, too: the sides of pixels are binary fractions.
        let shift = [0.5, 0.0, 0.3 * random.f64()][random.usize(..3)] / 64.0;
        let bounds = Rect::new(DVec2::splat(-1.0 - shift), DVec2::splat(1.0 - shift) + 1.0);
        let raster = Raster::filled(bounds, [192; 2], 1.0_f32);
        with_mesh(&mut random, |mesh| {
            let means = NodeMeans::of(mesh.view(), &raster, None).unwrap();
            assert!(means.values.iter().all(|value| *value == 1.0) && means.filled == 0);
            let centers = || raster.all().pixels().map(|(x, y)| raster.pixel_center(x, y));
            let within = centers().filter(|at| at.cmpgt(DVec2::ZERO).all() && at.cmplt(SIZE).all()).count();
            let closed = centers().filter(|at| at.cmpge(DVec2::ZERO).all() && at.cmple(SIZE).all()).count();
            assert!((within..=closed).contains(&means.pixels), "{} {within} {closed}", means.pixels);
            assert!(shift != 0.5 / 64.0 || means.pixels == within + 64 + 48 - 1, "{} {within}", means.pixels);
        });
    }
}

#[test]
fn nodes_far_from_every_pixel_are_said() {
    let mut random = Rng::with_seed(1);
    let raster = Raster::filled(Rect::new(DVec2::ZERO, DVec2::splat(0.01)), [10; 2], 1.0);
    with_mesh(&mut random, |mesh| {
        let error = NodeMeans::of(mesh.view(), &raster, None).unwrap_err();
        let near = mesh.world_nodes().filter(|at| at.max_element() < 0.07).count();
        assert!(error.nodes >= mesh.nodes().len() - near - 2, "{error}");
        assert!(error.to_string().contains("nodes have no value: no pixel within 64"), "{error}");
    });
}
