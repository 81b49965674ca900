//! Files of polygons, and meshes of the domains that they cover.

#![no_main]

use std::path::Path;

use meshbrush_core::build::{MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::{RefinementRule, Transfer};
use meshbrush_core::layers::SizeFieldSpec;
use meshbrush_io::io::geojson;
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};

/// Few, so that many files are tried in a second.
const MOST_TRIANGLES: usize = 3000;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(polygons) = geojson::read_from(bytes, Path::new("fuzz.geojson")) else { return };
    let Ok(domain) = Domain::of_polygons(&polygons) else { return };
    let region = domain.region().expect("polygons make a region");
    assert!(region.area() > 0.0 && region.edges().flatten().all(|p| domain.bounds.contains(p)));
    let spacing = domain.bounds.size().max_element() / 5.0;
    for boundary in [BoundaryTreatment::Report, BoundaryTreatment::default_for(spacing)] {
        check_mesh(&domain, boundary, spacing);
    }
});

fn check_mesh(domain: &Domain, boundary: BoundaryTreatment, spacing: f64) {
    let Ok(lattice) = Lattice::covering(domain.bounds, spacing, MOST_TRIANGLES) else { return };
    let mut builder = MeshBuilder::new(MeshSpec {
        domain: domain.clone(),
        boundary,
        lattice,
        field: SizeFieldSpec {
            layers: Vec::new(),
            transfer: Transfer::between(spacing / 1000.0, 2.0 * spacing),
            unasked: 2.0 * spacing,
            outline: None,
            gradation: None,
            projection: None,
        },
        rule: RefinementRule::Vertex,
        cleaning: Cleaning::NONE,
        limits: Limits { max_triangles: MOST_TRIANGLES, ..Limits::default() },
    });
    loop {
        match builder.advance(None, 100) {
            Ok(Progress::More) => {}
            Ok(Progress::Done) => break,
            Err(_) => return,
        }
    }
    let built = builder.finish();
    assert_eq!(built.mesh.violations(), []);
    assert_eq!(built.unsatisfied(None), Ok(vec![]));
    let topology = built.mesh.extract().topology();
    assert_eq!(topology.nodes, built.mesh.extract().nodes().len());
    assert_eq!(topology.parts == 0, built.mesh.triangle_count() == 0);
}
