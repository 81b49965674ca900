//! The comparison of a mesh with its outline, against brute force on the exported triangles.

use std::collections::HashMap;

use crate::formula_mesh::try_formula_mesh;
use crate::random_coast::random_coast;
use crate::runs::seeds;
use crate::slabs::{Edge, Slabs};
use fastrand::Rng;
use glam::DVec2;
use meshbrush_core::build::BuildError;
use meshbrush_core::domain::{BoundaryTreatment, Domain, FitQuality, HoleFigures};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::{Cleaning, CoarseError, Extract, KeptParts};

/// Returns the edges that one triangle has, with the domain on the left.
fn boundary_of(extract: &Extract) -> Vec<Edge> {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let mut edges: HashMap<[usize; 2], bool> = HashMap::new();
    for [a, b, c] in extract.cells().map(|cell| cell.corners) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if edges.remove(&[to, from]).is_none() {
                edges.insert([from, to], true);
            }
        }
    }
    edges.into_keys().map(|ends| ends.map(|node| nodes[node])).collect()
}

fn outline_of(domain: &Domain) -> Vec<Edge> {
    domain.region().unwrap().edges().collect()
}

/// Returns the land areas of the lost islands and the areas of the new holes that brute force finds, in
/// ascending order.
fn holes_by_brute_force(boundary: &[Edge], outline: &[Edge]) -> [Vec<f64>; 2] {
    let slabs = Slabs::new([outline, boundary]);
    let (islands, holes) = (slabs.complement(0), slabs.complement(1));
    let mut uncovered = vec![0.0; islands.areas.len()];
    let mut of_islands = vec![0.0; holes.areas.len()];
    for (island, hole, area) in slabs.intersections(&islands, &holes) {
        uncovered[island] += area;
        of_islands[hole] += area;
    }
    // Nodes on the outline are beside it by a lattice step.
    let is_none = |area: f64| area < 1e-8 * slabs.side * slabs.side;
    let sorted = |areas: &[f64], kept: &[f64]| {
        let bounded = areas.iter().zip(kept).skip(1).filter(|(area, _)| !is_none(**area));
        let mut chosen: Vec<f64> =
            bounded.filter(|(_, kept)| is_none(**kept)).map(|(area, _)| *area).collect();
        chosen.sort_by(f64::total_cmp);
        chosen
    };
    [sorted(&islands.areas, &uncovered), sorted(&holes.areas, &of_islands)]
}

fn areas(holes: &[HoleFigures], side: f64) -> Vec<f64> {
    let mut areas: Vec<f64> =
        holes.iter().map(|hole| hole.area).filter(|a| *a >= 1e-8 * side * side).collect();
    areas.sort_by(f64::total_cmp);
    areas
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, name: &str) {
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(found.len() == expected.len() && near, "{name}: {found:?}, by brute force {expected:?}");
}

fn distance(p: DVec2, edges: &[Edge]) -> f64 {
    let to = |&[a, b]: &Edge| {
        let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, share))
    };
    edges.iter().map(to).fold(f64::INFINITY, f64::min)
}

/// Checks a largest distance: no sample is farther, and the place is as far.
fn assert_farthest(found: Option<(f64, DVec2)>, from: &[Edge], to: &[Edge], samples: u32, name: &str) {
    let (farthest, place) = found.unwrap();
    let rounding = 1e-13 * from.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    for &[a, b] in from {
        for k in 0..samples {
            let p = a.lerp(b, f64::from(k) / f64::from(samples));
            let distance = distance(p, to);
            assert!(distance <= farthest + rounding, "{name}: {p} is {distance} away, not {farthest}");
        }
    }
    let at = distance(place, to);
    assert!(
        (at - farthest).abs() <= 1.1e-9 * farthest + rounding,
        "{name}: {place} is {at} away, not {farthest}"
    );
    assert!(distance(place, from) <= rounding, "{name}: {place} is not on the line");
}

fn assert_agrees(extract: &Extract, domain: &Domain, samples: u32, name: &str) -> FitQuality {
    let quality = FitQuality::of(extract, domain.region().unwrap(), &domain.ground());
    let (boundary, outline) = (boundary_of(extract), outline_of(domain));
    let [lost, new] = holes_by_brute_force(&boundary, &outline);
    let side = domain.bounds.size().max_element();
    let tolerance = 1e-7 * side * side;
    assert_near(&areas(&quality.lost_islands, side), &lost, tolerance, &format!("{name}, lost islands"));
    assert_near(&areas(&quality.new_holes, side), &new, tolerance, &format!("{name}, new holes"));
    assert!(
        quality.lost_islands.len() <= quality.islands && quality.new_holes.len() <= extract.topology().holes
    );
    assert_farthest(quality.farthest_from_outline, &boundary, &outline, samples, &format!("{name}, mesh"));
    assert_farthest(quality.farthest_from_mesh, &outline, &boundary, samples, &format!("{name}, outline"));
    quality
}

#[test]
fn holes_and_distances_are_those_of_the_exported_triangles() {
    let cleanings =
        [Cleaning::NONE, Cleaning::FOR_SOLVERS, Cleaning { parts: KeptParts::All, ..Cleaning::FOR_SOLVERS }];
    let (mut lost, mut new) = (0, 0);
    for seed in seeds(12) {
        let mut random = Rng::with_seed(seed);
        let domain = Domain::of_polygons(&random_coast(&mut random)).unwrap();
        let spacing = domain.bounds.size().max_element() / (2.0 + 6.0 * random.f64());
        let diameter = spacing * 0.1 * 8f64.powf(random.f64());
        let treatments = [
            BoundaryTreatment::Report,
            BoundaryTreatment::Fitted { diameter },
            BoundaryTreatment::OnOutline { diameter },
        ];
        for treatment in treatments {
            let built = match try_formula_mesh(&domain, spacing, treatment, &spacing.to_string()) {
                // Narrow coasts can have no whole cell.
                Err(BuildError::Coarse(CoarseError::EmptyDomain { .. })) => continue,
                built => built.unwrap(),
            };
            let cleaning = &cleanings[random.usize(..3)];
            let derived = DerivedMesh::new(&built.mesh, &built.domain, None, cleaning);
            let extract = derived.extract(&built.mesh);
            if extract.triangles().is_empty() {
                continue;
            }
            let quality =
                assert_agrees(&extract, &domain, 4, &format!("seed {seed}, {treatment:?}, {cleaning:?}"));
            lost += quality.lost_islands.len();
            new += quality.new_holes.len();
        }
    }
    eprintln!("{lost} lost islands, {new} new holes");
    assert!(lost > 0 && new > 0);
}
