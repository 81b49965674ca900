//! Files of polygons, and meshes of the domains that they cover.

#![no_main]

use std::path::Path;

use meshbrush::internals::domain::{BoundaryTreatment, Domain, DomainOnLattice};
use meshbrush::internals::geometry::Lattice;
use meshbrush::internals::io::geojson;
use meshbrush::internals::mesh::{Limits, Mesh};

/// Few, so that many files are tried in a second.
const MOST_TRIANGLES: usize = 3000;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(polygons) = geojson::from_bytes(bytes, Path::new("fuzz.geojson")) else { return };
    let Ok(domain) = Domain::of_polygons(&polygons) else { return };
    let region = domain.region().expect("polygons make a region");
    assert!(region.area() > 0.0 && region.edges().flatten().all(|p| domain.bounds.contains(p)));
    let spacing = domain.bounds.size().max_element() / 5.0;
    for boundary in [BoundaryTreatment::Report, BoundaryTreatment::usual(spacing)] {
        check_mesh(&domain, boundary, spacing);
    }
});

fn check_mesh(domain: &Domain, boundary: BoundaryTreatment, spacing: f64) {
    let limits = Limits { max_triangles: MOST_TRIANGLES, ..Limits::default() };
    let Ok(lattice) = Lattice::covering(domain.bounds, spacing, MOST_TRIANGLES) else { return };
    let domain_on_lattice = DomainOnLattice::new(domain, boundary, &lattice);
    let Ok(mut mesh) = Mesh::coarse_grid(&lattice, |node| domain_on_lattice.admits(node), &limits) else {
        return;
    };
    // After the budget stops refinement, the mesh must still be valid.
    let refined = mesh.refine(&limits, |element| domain_on_lattice.exceeds(element, |_| Ok(false)));
    mesh.classify(0..mesh.raw_triangle_count(), |element| domain_on_lattice.excludes(element));
    assert_eq!(mesh.violations(), []);
    if refined.is_ok() {
        assert_eq!(mesh.unsatisfied(|element| domain_on_lattice.exceeds(element, |_| Ok(false))), Ok(vec![]));
    }
    let topology = mesh.topology();
    assert_eq!(topology.nodes, mesh.extract().nodes().len());
    assert_eq!(topology.parts == 0, mesh.triangle_count() == 0);
}
