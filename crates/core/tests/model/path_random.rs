//! Random risks with random keep-out regions: the intervals of two meshes and of a certificate overlap.
//!
//! Both uppers are costs of paths, and all lowers are proven on their own, so none may exceed another's
//! upper. `MESHBRUSH_TABLE=1` prints the widths.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::runs::{prints_table, seeds};
use glam::{DVec2, dvec2};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    Layer, LayerKind, Mask, PaintLayers, RasterLayer, RasterReading, RasterSource, RiskField,
};
use meshbrush_core::path::{
    CertificateTask, PathCertificate, PathMesh, PathRequest, Planner, Solution, WeightedCost, Weights,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

/// The width that certificates are asked for.
const WIDTH: f64 = 0.03;

/// Hills, as pixels or as a formula.
fn random_risk(random: &mut fastrand::Rng) -> RiskField {
    let hills: Vec<[f64; 4]> = (0..random.usize(2..6))
        .map(|_| [0.3 + 0.7 * random.f64(), 0.08 + 0.25 * random.f64(), random.f64(), random.f64()])
        .collect();
    let kind = if random.bool() {
        let side = [16, 32, 50][random.usize(..3)];
        let mut raster = Raster::filled(Rect::UNIT, [side, side], 0.0);
        for (x, y) in (0..side * side).map(|n| (n % side, n / side)) {
            let at = (dvec2(f64::from(x), f64::from(y)) + 0.5) / f64::from(side);
            let hill = |&[height, width, x, y]: &[f64; 4]| {
                height * (-at.distance_squared(dvec2(x, y)) / (2.0 * width * width)).exp()
            };
            raster.set(x, y, hills.iter().map(hill).fold(0.0, f64::max) as f32);
        }
        let source = RasterSource { name: "hills".into(), raster: Arc::new(RasterPyramid::new(raster)) };
        RasterLayer { source, reading: RasterReading::Risk }.into()
    } else {
        let hill = |[height, width, x, y]: &[f64; 4]| format!("{height}*gauss(hypot(x-{x}, y-{y}), {width})");
        let hills: Vec<String> = hills.iter().map(hill).collect();
        LayerKind::risk(Formula::parse(&format!("max(0, {})", hills.join(", "))).unwrap())
    };
    RiskField::new(&Layer::stack([kind]), PaintLayers::blank())
}

/// Returns the triangles and quadrilaterals, anywhere.
fn random_keep_out(random: &mut fastrand::Rng) -> Vec<Mask> {
    let polygon = |random: &mut fastrand::Rng| {
        let (centre, turn) = (dvec2(random.f64(), random.f64()), random.f64());
        let corners = random.u32(3..5);
        let radius = 0.05 + 0.15 * random.f64();
        let corner = |n: u32| radius * DVec2::from_angle(TAU * (turn + f64::from(n) / f64::from(corners)));
        Mask::new(&[vec![(0..corners).map(|n| centre + corner(n)).collect()]]).unwrap()
    };
    (0..random.usize(..4)).map(|_| polygon(random)).collect()
}

fn mesh(cells: f64, diameter: impl Fn(DVec2) -> f64) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 1.0 / cells, 100_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    let exceeds = |element: &meshbrush_mesh::mesh::Element| {
        element.diameter() > diameter(element.world_rectangle().center())
    };
    mesh.refine(&Limits::default(), exceeds).unwrap();
    mesh
}

fn certified(solution: &Solution, cost: &WeightedCost, keep_out: &[Mask]) -> PathCertificate {
    let cost = Arc::new(cost.clone());
    let task = CertificateTask::in_rectangle(Rect::UNIT, cost, solution.points.clone(), 1.0, WIDTH).unwrap();
    let task = CertificateTask { most_nodes: 1500, ..task.outside_of(keep_out.to_vec()) };
    let mut certificate = PathCertificate::new(solution, &task).unwrap();
    while certificate.advance().unwrap().is_none() {}
    certificate
}

#[test]
fn the_intervals_of_two_meshes_and_a_certificate_overlap() {
    let (mut compared, mut reached, mut widths) = (0, 0, [0.0; 3]);
    for seed in seeds(4) {
        let mut random = fastrand::Rng::with_seed(seed);
        let weights = Weights { length: 1.0, risk: 10.0 * random.f64() };
        let cost = WeightedCost::new(weights, random_risk(&mut random)).unwrap();
        let keep_out = random_keep_out(&mut random);
        let middle = dvec2(random.f64(), random.f64());
        let meshes = [mesh(4.0, |_| 0.05), mesh(5.0, |x| 0.02 + 0.1 * x.distance(middle))];
        let places: Vec<DVec2> = (0..random.usize(2..4)).map(|_| dvec2(random.f64(), random.f64())).collect();
        let solutions = meshes.each_ref().map(|mesh| {
            let mesh = PathMesh::with_keep_out(mesh.view(), &keep_out);
            Planner::new(mesh, &cost).unwrap().solve(&cost, &places, PathRequest::FULL)
        });
        // A place in a region, or cut off on one of the meshes.
        let [Ok(a), Ok(b)] = solutions else { continue };
        let certificate = certified(&a, &cost, &keep_out);
        let uppers = [a.upper, b.upper, certificate.upper()];
        let lowers = [a.lower, b.lower, certificate.lower()];
        for lower in lowers {
            assert!(uppers.iter().all(|&upper| lower <= upper), "{seed}: {lowers:?} {uppers:?}");
        }
        compared += 1;
        reached += usize::from(certificate.width() <= WIDTH);
        let new = [a.gap(), b.gap(), certificate.width()];
        widths.iter_mut().zip(new).for_each(|(sum, width)| *sum += width);
        if prints_table() {
            let (nodes, programs) = (certificate.nodes(), certificate.programs());
            eprintln!("{seed}: {new:.4?} {nodes} nodes, {programs} programs, {:?}", certificate.end());
        }
    }
    let widths = widths.map(|sum| sum / f64::from(compared));
    if prints_table() {
        eprintln!("{compared} compared, {reached} certificates reached {WIDTH}, mean widths {widths:.4?}");
    }
    assert!(compared > 0 && widths[2] < 0.25, "{compared} {widths:?}");
}
