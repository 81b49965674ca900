//! Cleaning of meshes, judged by the triangles that stay: parts, pinches, area, and no dependence on the
//! order of edits.

use std::collections::{BTreeSet, HashMap};

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{
    Cleaning, Extract, KeptParts, Limits, Mesh, MeshPatch, NodeId, Removed, TriangleId,
};

/// Corners in lattice coordinates, sorted: what a triangle is, whatever its number.
type Shape = [[u32; 2]; 3];

/// Discs in which triangles belong to the domain.
fn discs(random: &mut Rng) -> Vec<(DVec2, f64)> {
    (0..random.usize(3..40))
        .map(|_| (dvec2(random.f64(), random.f64()), 0.02 + 0.15 * random.f64()))
        .collect()
}

/// Returns a mesh refined at random places in random order, and then at all places that the discs' rims ask
/// for.
fn mesh(discs: &[(DVec2, f64)], order: u64) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.125, 1_000_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    let mut random = Rng::with_seed(order);
    let rim = |corners: [DVec2; 3]| {
        discs.iter().any(|(middle, radius)| {
            let inside = corners.map(|p| p.distance(*middle) < *radius);
            inside.contains(&true) && inside.contains(&false)
        })
    };
    for level in 0..7 {
        loop {
            let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
            let mut coarse: Vec<TriangleId> =
                ids.filter(|&id| mesh.triangle(id).level() == level && rim(mesh.world_corners(id))).collect();
            if coarse.is_empty() {
                break;
            }
            random.shuffle(&mut coarse);
            for id in coarse {
                if mesh.triangle(id).level() == level {
                    mesh.refine_triangle(id);
                }
            }
        }
    }
    mesh.classify(0..mesh.raw_triangle_count(), |element| {
        let centroid = element.world_corners().iter().sum::<DVec2>() / 3.0;
        !discs.iter().any(|(middle, radius)| centroid.distance(*middle) < *radius)
    });
    mesh
}

fn shapes(extract: &Extract) -> BTreeSet<Shape> {
    let shape = |corners: [usize; 3]| {
        let mut shape = corners.map(|node| extract.node(NodeId::from_index(node))).map(|p| [p.x, p.y]);
        shape.sort_unstable();
        shape
    };
    extract.cells().map(|cell| shape(cell.corners)).collect()
}

fn cleaned<'a>(mesh: &'a Mesh, cleaning: &Cleaning) -> (Extract<'a>, Removed) {
    let mut patch = MeshPatch::default();
    let removed = patch.clean(mesh, cleaning);
    (mesh.extract_with(&patch), removed)
}

fn doubled_area([a, b, c]: &Shape) -> i64 {
    let [a, b, c] = [a, b, c].map(|p| p.map(i64::from));
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
}

/// Returns the areas of the parts that edges join, by flooding.
fn part_areas(shapes: &BTreeSet<Shape>) -> Vec<i64> {
    let mut across: HashMap<[[u32; 2]; 2], Vec<&Shape>> = HashMap::new();
    let edges = |&[a, b, c]: &Shape| [[a, b], [a, c], [b, c]];
    for shape in shapes {
        edges(shape).into_iter().for_each(|edge| across.entry(edge).or_default().push(shape));
    }
    let mut left: BTreeSet<&Shape> = shapes.iter().collect();
    let mut areas = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut area, mut waiting) = (0, vec![first]);
        while let Some(shape) = waiting.pop() {
            area += doubled_area(shape);
            let near = edges(shape).into_iter().flat_map(|edge| across[&edge].clone());
            waiting.extend(near.filter(|other| left.remove(other)));
        }
        areas.push(area);
    }
    areas.sort_unstable();
    areas
}

/// Returns the most boundary edges at one node.
fn most_boundary_edges(shapes: &BTreeSet<Shape>) -> usize {
    let mut uses: HashMap<[[u32; 2]; 2], usize> = HashMap::new();
    for [a, b, c] in shapes {
        for edge in [[a, b], [a, c], [b, c]] {
            *uses.entry(edge.map(|&p| p)).or_default() += 1;
        }
    }
    let mut at: HashMap<[u32; 2], usize> = HashMap::new();
    for (edge, _) in uses.into_iter().filter(|&(_, uses)| uses == 1) {
        edge.into_iter().for_each(|node| *at.entry(node).or_default() += 1);
    }
    at.into_values().max().unwrap_or(0)
}

#[test]
fn one_part_without_pinches_is_left_whatever_the_order_of_triangles() {
    let (mut parts_before, mut pinched_before) = (0, 0);
    for seed in 0..150 {
        let discs = discs(&mut Rng::with_seed(seed));
        let [one, other] = [1, 2].map(|order| mesh(&discs, order));
        let before = shapes(&one.extract());
        assert_eq!(before, shapes(&other.extract()), "seed {seed}: the same mesh in another order");
        let (cleaned_one, removed) = cleaned(&one, &Cleaning::FOR_SOLVERS);
        let (cleaned_other, removed_of_other) = cleaned(&other, &Cleaning::FOR_SOLVERS);
        assert_eq!(removed_of_other, removed, "seed {seed}");
        let after = shapes(&cleaned_one);
        assert_eq!(after, shapes(&cleaned_other), "seed {seed}");
        assert!(after.is_subset(&before) && !after.is_empty());
        assert_eq!(part_areas(&after).len(), 1, "seed {seed}");
        assert_eq!(most_boundary_edges(&after), 2, "seed {seed}");
        assert_eq!(removed.triangles, before.len() - after.len());
        assert!((removed.area - (one.area() - cleaned_one.area())).abs() < 1e-12);
        parts_before += usize::from(part_areas(&before).len() > 1);
        pinched_before += usize::from(most_boundary_edges(&before) > 2);
    }
    assert!(
        parts_before > 50 && pinched_before > 50,
        "{parts_before} {pinched_before} of 150 needed cleaning"
    );
}

#[test]
fn parts_are_kept_by_their_share_of_the_area() {
    let mut some_of_several = 0;
    for seed in 0..60 {
        let before_cleaning = mesh(&discs(&mut Rng::with_seed(seed)), 1);
        let areas = part_areas(&shapes(&before_cleaning.extract()));
        let whole: i64 = areas.iter().sum();
        for share in [0.0, 0.02, 0.2, 1.0] {
            let cleaning =
                Cleaning { parts: KeptParts::Share(share), keeps_pinches: true, improves_boundary: false };
            let (extract, removed) = cleaned(&before_cleaning, &cleaning);
            let large = areas.partition_point(|&area| (area as f64) < share * whole as f64);
            // The largest part stays in any case.
            let expected = areas[large.min(areas.len() - 1)..].to_vec();
            assert_eq!(part_areas(&shapes(&extract)), expected, "seed {seed}, share {share}");
            assert_eq!(removed.parts.len(), areas.len() - expected.len());
            assert!(removed.parts.is_sorted_by(|a, b| a.area >= b.area));
            some_of_several += usize::from(expected.len() > 1 && expected.len() < areas.len());
        }
        assert_eq!(cleaned(&before_cleaning, &Cleaning::NONE).1.triangles, 0);
    }
    assert!(some_of_several > 10, "{some_of_several}");
}
