//! What is measured of a mesh, against numbers from the coordinates of its nodes.

use std::collections::HashMap;

use fastrand::Rng;
use glam::DVec2;
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::Ground;
use meshbrush_core::layers::{LevelCache, PaintLayers};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::quality::{
    MeasureSummary, MeasuredPlace, MeshQuality, QualityBin, QualityMeasure, TriangleMeasures,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, Extract};
use meshbrush_mesh::text::LengthUnit;

use crate::formula_mesh::{formula_mesh, try_formula_mesh};
use crate::random_coast::random_coast;
use crate::runs::seeds;

/// A target diameter that grows with the distance from the middle of a domain.
#[derive(Clone, Copy)]
struct Target {
    least: f64,
    middle: DVec2,
}

impl Target {
    fn of(domain: &Domain) -> Self {
        Self { least: 0.02 * domain.bounds.size().max_element(), middle: domain.bounds.center() }
    }

    fn formula(self) -> String {
        format!("{} + 0.09*hypot(x - ({}), y - ({}))", self.least, self.middle.x, self.middle.y)
    }

    fn at(self, point: DVec2) -> f64 {
        self.least + 0.09 * point.distance(self.middle)
    }
}

/// The numbers of a triangle or node, with its place.
type Found = Vec<(f64, DVec2)>;

/// Returns each measure of all triangles and nodes.
fn by_brute_force(extract: &Extract, target: Target, depths: &[f64]) -> Vec<(QualityMeasure, Found)> {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let mut all: Vec<(QualityMeasure, Found)> =
        QualityMeasure::ALL.into_iter().map(|measure| (measure, Vec::new())).collect();
    let mut at_nodes: HashMap<usize, usize> = HashMap::new();
    for cell in extract.cells() {
        let [p, q, r] = cell.corners;
        let middle = (nodes[p] + nodes[q] + nodes[r]) / 3.0;
        let length = |m: usize, n: usize| (nodes[m] - nodes[n]).length();
        let (a, b, c) = (length(q, r), length(r, p), length(p, q));
        // By the law of cosines.
        let angle = |opposite: f64, u: f64, v: f64| {
            ((u * u + v * v - opposite * opposite) / (2.0 * u * v)).acos().to_degrees()
        };
        let mut angles = [angle(a, b, c), angle(b, c, a), angle(c, a, b)];
        angles.sort_by(f64::total_cmp);
        let mut edges = [a, b, c];
        edges.sort_by(f64::total_cmp);
        let mut step = f64::INFINITY;
        for (m, n) in [(p, q), (q, r), (r, p)] {
            if depths[m] > 0.0 || depths[n] > 0.0 {
                let depth = (0.5 * (depths[m] + depths[n])).max(1.0);
                step = step.min(1000.0 * length(m, n) / ((9.81 * depth).sqrt() + (9.81 / depth).sqrt()));
            }
        }
        let numbers = [angles[0], angles[2], edges[2] / edges[0], edges[2] / target.at(middle), step];
        for ((_, found), number) in all.iter_mut().zip(numbers) {
            found.extend(number.is_finite().then_some((number, middle)));
        }
        for node in cell.corners {
            *at_nodes.entry(node).or_default() += 1;
        }
    }
    all[5].1.extend(at_nodes.iter().map(|(&node, &count)| (count as f64, nodes[node])));
    all
}

fn measured(extract: &Extract, built: &meshbrush_core::build::BuiltMesh, depths: &[f64]) -> MeshQuality {
    let ground = Ground::default();
    let measures = TriangleMeasures::new(extract.view(), &ground)
        .with_target(&built.field, PaintLayers::blank())
        .with_depths(depths, LengthUnit::Kilometre);
    MeshQuality::of(&measures)
}

/// Returns random depths of water, and of land at some nodes.
fn random_depths(extract: &Extract, random: &mut Rng) -> Vec<f64> {
    extract.nodes().iter().map(|_| 200.0 * random.f64() - 60.0).collect()
}

#[track_caller]
fn assert_is_that_of(found: &MeasuredPlace, all: &Found, value: f64, what: &str) {
    let tolerance = 1e-6 * value.abs().max(1.0);
    assert!((found.value - value).abs() < tolerance, "{what}: {} of {value}", found.value);
    let near = |(number, at): &&(f64, DVec2)| {
        at.distance(found.at) < 1e-6 * found.size && (number - value).abs() < tolerance
    };
    assert!(all.iter().any(|one| near(&one)), "{what}: nothing has {value} at {}", found.at);
}

fn assert_agrees(summary: &MeasureSummary, all: &Found, what: &str) {
    let what = &format!("{what}, {:?}", summary.measure);
    let least = all.iter().map(|(number, _)| *number).fold(f64::INFINITY, f64::min);
    let greatest = all.iter().map(|(number, _)| *number).fold(f64::NEG_INFINITY, f64::max);
    assert_is_that_of(&summary.least, all, least, what);
    assert_is_that_of(&summary.greatest, all, greatest, what);
    let counted: usize = summary.bins.iter().map(|bin| bin.count).sum();
    assert_eq!(counted, all.len(), "{what}");
    let in_use: usize = summary.bins_in_use().iter().map(|bin| bin.count).sum();
    assert_eq!(in_use, all.len(), "{what}");
    for &QualityBin { from, to, count, worst } in &summary.bins {
        let slack = 1e-6 * if to.is_finite() { to - from } else { 1.0 };
        let within = |off: f64| all.iter().filter(|(n, _)| *n >= from - off && *n <= to + off).count();
        let inside = all.iter().filter(|(n, _)| *n > from + slack && *n < to - slack).count();
        assert!((inside..=within(slack)).contains(&count), "{what}: {count} from {from} to {to}");
        assert_eq!(worst.is_some(), count > 0, "{what}");
        let Some(worst) = worst else { continue };
        let smaller = matches!(summary.measure, QualityMeasure::SmallestAngle | QualityMeasure::TimeStep);
        let is_worse = |n: f64| if smaller { n < worst.value - slack } else { n > worst.value + slack };
        let inside = |n: f64| n > from + slack && n < to - slack;
        assert!(!all.iter().any(|(n, _)| inside(*n) && is_worse(*n)), "{what}: worse than {worst:?}");
        assert_is_that_of(&worst, all, worst.value, what);
    }
}

#[test]
fn every_number_is_that_of_the_triangles_with_their_nodes_on_the_outline() {
    let mut triangles = 0;
    for seed in seeds(6) {
        let mut random = Rng::with_seed(seed);
        let domain = Domain::of_polygons(&random_coast(&mut random)).unwrap();
        let (target, extent) = (Target::of(&domain), domain.bounds.size().max_element());
        let treatment = BoundaryTreatment::OnOutline { diameter: (0.02 + 0.05 * random.f64()) * extent };
        let Ok(built) = try_formula_mesh(&domain, 0.2 * extent, treatment, &target.formula()) else {
            continue;
        };
        let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::FOR_SOLVERS);
        let extract = derived.extract(&built.mesh);
        if extract.triangles().is_empty() {
            continue;
        }
        triangles += extract.triangles().len();
        let depths = random_depths(&extract, &mut random);
        let quality = measured(&extract, &built, &depths);
        for (measure, all) in by_brute_force(&extract, target, &depths) {
            match quality.get(measure) {
                Some(summary) => assert_agrees(summary, &all, &format!("seed {seed}")),
                None => assert!(all.is_empty(), "{measure:?}"),
            }
        }
    }
    assert!(triangles > 5000, "{triangles}");
}

#[test]
fn the_most_triangles_at_a_corner_are_those_that_share_it() {
    let domain = Domain::rectangle(Rect::UNIT);
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, &Target::of(&domain).formula());
    let extract = built.mesh.extract();
    let ground = Ground::default();
    let most = TriangleMeasures::new(extract.view(), &ground).most_at_corners();
    let corners: Vec<[usize; 3]> = extract.cells().map(|cell| cell.corners).collect();
    assert_eq!(most.len(), corners.len());
    for (own, most) in corners.iter().zip(&most).step_by(7) {
        let sharing = |node: &usize| corners.iter().filter(|other| other.contains(node)).count();
        assert_eq!(own.iter().map(sharing).max(), Some(*most as usize));
    }
    assert!(most.contains(&8) && !most.contains(&9), "a mesh of right-angled triangles has 8 at most");
}

#[test]
fn numbers_of_one_triangle_are_those_of_the_histogram() {
    let domain = Domain::rectangle(Rect::UNIT);
    let formula = Target::of(&domain).formula();
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, &formula);
    let extract = built.mesh.extract();
    let depths = vec![50.0; extract.nodes().len()];
    let quality = measured(&extract, &built, &depths);
    let ground = Ground::default();
    let measures = TriangleMeasures::new(extract.view(), &ground)
        .with_target(&built.field, PaintLayers::blank())
        .with_depths(&depths, LengthUnit::Kilometre);
    let mut squares = LevelCache::default();
    for measure in QualityMeasure::OF_TRIANGLES {
        let numbers = (0..extract.triangles().len()).filter_map(|n| measures.of(measure, n, &mut squares));
        let numbers: Vec<f64> = numbers.collect();
        let summary = quality.get(measure).unwrap();
        assert_eq!(numbers.iter().copied().fold(f64::INFINITY, f64::min), summary.least.value, "{measure:?}");
        assert_eq!(numbers.iter().copied().fold(0.0, f64::max), summary.greatest.value, "{measure:?}");
    }
    assert_eq!(quality.get(QualityMeasure::SmallestAngle).unwrap().bins_in_use().len(), 1, "all have 45°");
    // Without depths and a field there is nothing to say about them; in degrees, none about time.
    let bare = MeshQuality::of(&TriangleMeasures::new(extract.view(), &ground));
    let in_degrees = TriangleMeasures::new(extract.view(), &ground).with_depths(&depths, LengthUnit::Degree);
    for quality in [bare, MeshQuality::of(&in_degrees)] {
        let known: Vec<_> = quality.summaries().map(|summary| summary.measure).collect();
        use QualityMeasure::{EdgeRatio, LargestAngle, SmallestAngle, Valence};
        assert_eq!(known, [SmallestAngle, LargestAngle, EdgeRatio, Valence]);
    }
}

/// The steps of the work end within the triangles, and what they find does not depend on threads.
#[test]
fn a_mesh_of_many_steps_is_measured_as_a_whole() {
    let built = formula_mesh(&Domain::rectangle(Rect::UNIT), 0.25, BoundaryTreatment::Report, "0.0035");
    let extract = built.mesh.extract();
    let count = extract.triangles().len();
    assert!(count > 262_144, "{count}");
    // One node has deep water: the time step is decided around it.
    let mut depths = vec![10.0; extract.nodes().len()];
    let last = depths.len() - 1;
    depths[last] = 5000.0;
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| measured(&extract, &built, &depths))
    };
    let quality = on_threads(1);
    assert_eq!(quality, on_threads(3));
    for measure in QualityMeasure::OF_TRIANGLES {
        let counted: usize = quality.get(measure).unwrap().bins.iter().map(|bin| bin.count).sum();
        assert_eq!(counted, count, "{measure:?}");
    }
    let step = quality.get(QualityMeasure::TimeStep).unwrap();
    let node = extract.world_nodes().nth(last).unwrap();
    assert!(step.least.at.distance(node) < 0.01, "{:?}", step.least);
}

#[test]
fn links_between_squares_are_as_long_as_the_squares_and_orthogonal() {
    let domain = Domain::rectangle(Rect::UNIT);
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, "1");
    let extract = built.mesh.extract();
    let ground = Ground::default();
    let measures = TriangleMeasures::new(extract.view(), &ground).with_links(LengthUnit::None);
    let quality = MeshQuality::of(&measures);
    let [length, cosine] =
        [QualityMeasure::LinkLength, QualityMeasure::LinkCosine].map(|measure| quality.get(measure).unwrap());
    // 4 by 4 squares have 12 links along each axis.
    let count = |summary: &MeasureSummary| summary.bins.iter().map(|bin| bin.count).sum::<usize>();
    assert_eq!((extract.triangles().len(), count(length), count(cosine)), (32, 24, 24));
    assert!((length.least.value - 1.0).abs() < 1e-12 && (length.greatest.value - 1.0).abs() < 1e-12);
    assert!(cosine.greatest.value < 1e-12);
    let of_all = measures.of_all(QualityMeasure::LinkLength).unwrap();
    assert!(of_all.len() == 32 && of_all.iter().all(|share| (share - 1.0).abs() < 1e-12));
    // The place of a link is the middle of the edge that it crosses: on a line between squares.
    let on_line = |x: f64| (4.0 * x).fract() == 0.0;
    assert!(on_line(length.least.at.x) != on_line(length.least.at.y), "{}", length.least.at);
    assert!(MeshQuality::of(&TriangleMeasures::new(extract.view(), &ground)).get(length.measure).is_none());
    // On a graded mesh the cells are measured as the links of their cells are.
    let graded = formula_mesh(&domain, 0.25, BoundaryTreatment::Report, "0.03 + 0.2*hypot(x, y)");
    let extract = graded.mesh.extract();
    let measures = TriangleMeasures::new(extract.view(), &ground).with_links(LengthUnit::None);
    let quality = MeshQuality::of(&measures);
    for (measure, worst) in [
        (QualityMeasure::LinkLength, quality.get(QualityMeasure::LinkLength).unwrap().least.value),
        (QualityMeasure::LinkCosine, quality.get(QualityMeasure::LinkCosine).unwrap().greatest.value),
    ] {
        let numbers = measures.of_all(measure).unwrap();
        assert!(numbers.contains(&worst), "{measure:?}: {worst}");
    }
}
