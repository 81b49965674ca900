//! A coast with a lake and small islands, whose mesh has nodes on the outline and no small parts.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};
use meshbrush_core::build::BuiltMesh;
use meshbrush_core::domain::{BoundaryTreatment, Domain, Ring};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::{Cleaning, Mesh, PatchPieces};

use crate::formula_mesh::formula_mesh;

fn ring(center: DVec2, radius: f64, roughness: f64) -> Ring {
    let wave =
        |angle: f64| (5.0 * angle).sin() + 0.6 * (13.0 * angle + 1.0).sin() + 0.3 * (31.0 * angle).sin();
    (0..400)
        .map(|k| TAU * f64::from(k) / 400.0)
        .map(|angle| center + radius * (1.0 + roughness * wave(angle)) * DVec2::from_angle(angle))
        .collect()
}

/// Returns the mesh, with triangles of about the given diameter along the coast.
pub fn coast(diameter: f64) -> BuiltMesh {
    let land = vec![ring(dvec2(0.0, 0.0), 0.8, 0.15), ring(dvec2(0.1, 0.05), 0.25, 0.2)];
    let islands = [dvec2(1.1, 0.9), dvec2(-1.0, 0.8)].map(|center| vec![ring(center, 0.06, 0.1)]);
    let domain = Domain::of_polygons(&[vec![land], islands.to_vec()].concat()).unwrap();
    formula_mesh(&domain, 0.4, BoundaryTreatment::OnOutline { diameter }, "10")
}

pub fn derived(mesh: &Mesh, built: &BuiltMesh) -> DerivedMesh {
    DerivedMesh::new(mesh, &built.domain, None, &Cleaning::FOR_SOLVERS)
}

pub fn pieces(mesh: &Mesh, built: &BuiltMesh) -> PatchPieces {
    let derived = derived(mesh, built);
    PatchPieces::new(mesh, derived.patch(), &derived.extract(mesh))
}
