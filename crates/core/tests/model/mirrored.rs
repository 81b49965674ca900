//! A turned or mirrored outline gives a turned or mirrored mesh. Grid and bisection are symmetric under half
//! a turn, and under a reflection in the diagonal of the cells.

use std::f64::consts::TAU;

use crate::formula_mesh::formula_mesh;
use crate::runs::seeds;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{BoundaryTreatment, Domain, Ring};
use meshbrush_core::outline::{DerivedMesh, OutlineFit};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Cleaning;

/// Returns a polygon around the origin with corners of all angles. Coordinates are multiples of 2⁻²⁰, so that
/// they stay what they are on the grid of a region.
fn polygon(random: &mut Rng) -> Ring {
    let corners = random.usize(5..30);
    let corner = |k: usize| {
        let angle = TAU * (k as f64 + 0.6 * random.f64()) / corners as f64;
        let p = (0.25 + 0.65 * random.f64()) * DVec2::from_angle(angle);
        (p * 1048576.0).round() / 1048576.0
    };
    (0..corners).map(corner).collect()
}

/// Returns the mesh of an image of a polygon: how its boundary lies on the outline, how many triangles it
/// has, and the nodes of its boundary, mapped back.
fn mesh_of_image(
    ring: &Ring,
    spacing: f64,
    diameter: f64,
    map: fn(DVec2) -> DVec2,
) -> (OutlineFit, usize, Vec<DVec2>) {
    let frame = Rect::new(dvec2(-1.0, -1.0), dvec2(1.0, 1.0));
    let image: Ring = ring.iter().map(|&p| map(p)).collect();
    let domain = Domain::of_polygons(&[vec![image]]).unwrap().with_bounds(frame);
    let built = formula_mesh(&domain, spacing, BoundaryTreatment::OnOutline { diameter }, "100");
    let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::NONE);
    let extract = derived.extract(&built.mesh);
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    // Both maps are their own inverses.
    let boundary = extract.boundary_edges().map(|edge| map(nodes[edge.ends[0]])).collect();
    (derived.fit().unwrap(), extract.triangles().len(), boundary)
}

#[test]
fn an_image_of_an_outline_has_the_image_of_the_mesh() {
    type Image = (&'static str, fn(DVec2) -> DVec2);
    let images: [Image; 2] = [("turned", |p| -p), ("mirrored", |p| dvec2(p.y, p.x))];
    let mut corners = 0;
    for seed in seeds(25) {
        let mut random = Rng::with_seed(seed);
        let ring = polygon(&mut random);
        let spacing = [0.25, 0.5][random.usize(..2)];
        let diameter = spacing * 0.1 * 6f64.powf(random.f64());
        let (fit, triangles, nodes) = mesh_of_image(&ring, spacing, diameter, |p| p);
        corners += fit.corners;
        for (name, map) in images {
            let (image_fit, image_triangles, image) = mesh_of_image(&ring, spacing, diameter, map);
            assert_eq!(image_fit.corners, fit.corners, "seed {seed}, {name}: pinned corners");
            assert_eq!(
                (image_fit.nodes, image_fit.on_outline),
                (fit.nodes, fit.on_outline),
                "seed {seed}, {name}"
            );
            assert_eq!((image_triangles, image.len()), (triangles, nodes.len()), "seed {seed}, {name}");
            // But for the rounding to lattice points.
            let is_there = |p: &DVec2| nodes.iter().any(|q| p.distance(*q) < 1e-7);
            assert!(image.iter().all(is_there), "seed {seed}, {name}: nodes of the boundary");
        }
    }
    assert!(corners > 0);
}
