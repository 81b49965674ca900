//! Random risk fields on the unit square, and the processor time that work takes.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Duration;

use glam::{DVec2, dvec2};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    Layer, LayerKind, PaintLayers, RasterLayer, RasterReading, RasterSource, RiskField, Threat, ThreatLaw,
    Threats,
};
use meshbrush_core::path::{WeightedCost, Weights};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

/// A risk with the default weights, and two places at least 0.4 apart.
pub struct RandomRisk {
    pub cost: WeightedCost,
    pub places: [DVec2; 2],
}

/// Pixels along a side of a raster.
const SIDE: u32 = 512;

impl RandomRisk {
    /// Returns, in turn, hills as one formula, hills as the pixels of a raster, waves as pixels, and threats.
    pub fn new(number: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(9000 + number);
        let kind = match number % 4 {
            0 => LayerKind::risk(formula(&hills(&mut random))),
            1 => hills_of_pixels(&hills(&mut random)),
            2 => waves(&mut random),
            _ => threats(&mut random),
        };
        let risk = RiskField::new(&Layer::stack([kind]), PaintLayers::blank()).within(&Rect::UNIT);
        let cost = WeightedCost::new(Weights::default(), risk).expect("valid weights");
        let place = |random: &mut fastrand::Rng| dvec2(random.f64(), random.f64());
        let mut places = [place(&mut random), place(&mut random)];
        while places[0].distance(places[1]) < 0.4 {
            places[1] = place(&mut random);
        }
        Self { cost, places }
    }
}

/// Height, width and place of some hills.
fn hills(random: &mut fastrand::Rng) -> Vec<[f64; 4]> {
    let hill = |random: &mut fastrand::Rng| {
        [0.3 + 0.7 * random.f64(), 0.05 + 0.2 * random.f64(), random.f64(), random.f64()]
    };
    (0..random.usize(3..10)).map(|_| hill(random)).collect()
}

fn formula(hills: &[[f64; 4]]) -> Formula {
    let hill = |[height, width, x, y]: &[f64; 4]| format!("{height}*gauss(hypot(x-{x}, y-{y}), {width})");
    let hills: Vec<String> = hills.iter().map(hill).collect();
    Formula::parse(&format!("max(0, {})", hills.join(", "))).expect("a valid formula")
}

fn hills_of_pixels(hills: &[[f64; 4]]) -> LayerKind {
    let hill = |at: DVec2, &[height, width, x, y]: &[f64; 4]| {
        height * (-at.distance_squared(dvec2(x, y)) / (2.0 * width * width)).exp()
    };
    pixels(|at| hills.iter().map(|one| hill(at, one)).fold(0.0, f64::max))
}

/// Returns waves in all directions, a tenth to a half of the square long, scaled to risks from 0 to 1.
fn waves(random: &mut fastrand::Rng) -> LayerKind {
    let wave = |random: &mut fastrand::Rng| {
        let frequency = TAU * (2.0 + 8.0 * random.f64());
        (frequency * DVec2::from_angle(TAU * random.f64()), TAU * random.f64(), 1.0 / frequency)
    };
    let waves: Vec<_> = (0..30).map(|_| wave(random)).collect();
    let sum = |at: DVec2| {
        waves
            .iter()
            .map(|&(direction, phase, height)| height * (direction.dot(at) + phase).sin())
            .sum::<f64>()
    };
    let deviation = (0.5 * waves.iter().map(|wave| wave.2 * wave.2).sum::<f64>()).sqrt();
    pixels(|at| 0.5 + 0.2 * sum(at) / deviation)
}

fn pixels(risk: impl Fn(DVec2) -> f64) -> LayerKind {
    let at = |n: u32| (dvec2(f64::from(n % SIDE), f64::from(n / SIDE)) + 0.5) / f64::from(SIDE);
    let values = (0..SIDE * SIDE).map(|n| risk(at(n)).clamp(0.0, 1.0) as f32).collect();
    let raster = Raster::from_values(Rect::UNIT, [SIDE; 2], values);
    let source = RasterSource { name: "risk".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    RasterLayer { source, reading: RasterReading::Risk }.into()
}

fn threats(random: &mut fastrand::Rng) -> LayerKind {
    let threat = |random: &mut fastrand::Rng| Threat {
        at: dvec2(random.f64(), random.f64()),
        range: 0.1 + 0.25 * random.f64(),
        peak: 0.3 + 0.7 * random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    let threats = (0..random.usize(4..12)).map(|_| threat(random)).collect();
    Threats::new(threats).expect("valid threats").into()
}

/// Returns a mesh of the unit square with about 100 thousand nodes, or 6.6 thousand for `level` 4.
pub fn mesh(level: u32) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.05, 10_000).expect("a square has a grid");
    let limits = Limits::default();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &limits).expect("within the default limits");
    mesh.refine(&limits, |element| element.triangle.level() < level).expect("within the default limits");
    mesh
}

/// Returns the processor time of all threads so far; zero where the system does not tell.
pub fn processor_time() -> Duration {
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let of_thread = |thread: std::fs::DirEntry| {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split(' ').next()?.parse::<u64>().ok()
    };
    Duration::from_nanos(threads.filter_map(of_thread).sum())
}
