//! Layers with round numbers beside layers with numbers next to them.
//!
//! People type round numbers, and then h̄ is exactly the diameter of triangles along lines of the lattice,
//! diagonals and circles around its points. Sliders of random layers are set to such numbers, and meshes are
//! made with these and with all of them times 0.998 and times 1.002. For each kind of layer, alone and beneath
//! or above another one, there are two figures: the largest ratio of the processor time to that of the slower
//! neighbour, and the longest time for a triangle.
//!
//!     cargo bench -p meshbrush-benches --bench round -- [cases of a kind] [kind]

use std::sync::Arc;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_benches::risks::processor_time;
use meshbrush_core::build::MeshBuilder;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain, corners};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    BandLayer, Combine, DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, FeatureSize, FormulaLayer,
    Layer, LayerKind, Mask, MedialAxis, MedialBalls, PositiveDepth, Quantity, RasterLayer, RasterReading,
    RasterSource, ShapeList, Shapes, Straits, Threat, ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Progress;

/// What sliders show, and what people type.
const ROUND: [f64; 6] = [0.05, 0.1, 0.2, 0.25, 0.5, 1.0];
/// Neighbours of a number.
const BESIDE: [f64; 2] = [0.998, 1.002];
/// Meshes are not made beyond so many triangles.
const MOST_TRIANGLES: usize = 20_000;

/// Numbers of sliders, times a factor that is 1 or near it.
struct Sliders {
    random: Rng,
    factor: f64,
}

impl Sliders {
    fn round(&mut self) -> f64 {
        ROUND[self.random.usize(..ROUND.len())] * self.factor
    }

    /// A place on a line of the lattice, which no slider moves.
    fn place(&mut self) -> DVec2 {
        dvec2(f64::from(self.random.u32(..=8)), f64::from(self.random.u32(..=8))) / 8.0
    }

    fn quantity(&mut self) -> Quantity {
        if self.random.bool() { Quantity::Risk } else { Quantity::Diameter }
    }
}

/// The kinds of layers.
const KINDS: [&str; 12] = [
    "outline",
    "shapes",
    "corridor",
    "formula",
    "long formula",
    "raster",
    "curve",
    "band",
    "threats",
    "depth",
    "straits",
    "feature size",
];

fn shapes(sliders: &mut Sliders) -> Shapes {
    let places: Vec<DVec2> = (0..5).map(|_| sliders.place()).collect();
    let list = match sliders.random.u8(..4) {
        0 => ShapeList { points: places, ..ShapeList::default() },
        1 => ShapeList { lines: vec![vec![DVec2::ZERO, DVec2::ONE]], ..ShapeList::default() },
        2 => ShapeList { lines: vec![places], ..ShapeList::default() },
        _ => {
            let square = corners(&Rect::around(dvec2(0.5, 0.5), 0.125));
            ShapeList { polygons: vec![vec![square]], ..ShapeList::default() }
        }
    };
    let filled = sliders.random.bool();
    Shapes::new(list, filled).expect("shapes")
}

fn formula(sliders: &mut Sliders, is_long: bool) -> LayerKind {
    let (at, [a, b, c]) = (sliders.place(), [(); 3].map(|()| sliders.round()));
    let (x, y) = (at.x, at.y);
    let short = [
        format!("{a} + {b}*hypot(x - {x}, y - {y})"),
        format!("{a} + {b}*abs(x - {x})"),
        format!("{a} + {b}*(x + y)"),
        format!("{a} + {b}*abs(x - y)"),
        format!("{a} + {b}*max(abs(x - {x}), abs(y - {y}))"),
        format!("{a} + {b}*(abs(x - {x}) + abs(y - {y}))"),
        format!("{a} + {b}*(x - y)^2"),
        format!("{a} + {b}*x^2"),
        format!("{a} + {b}*x*y"),
        format!("if(x > {x}, {a}, {b})"),
        format!("{a}*gauss(hypot(x - {x}, y - {y}), {c})"),
        format!("gauss(x - y, {c})"),
        format!("1 - {b}*abs(x + y - 1)"),
    ];
    let text = &short[sliders.random.usize(..short.len())];
    let text = match is_long {
        false => text.clone(),
        true => format!("min({text}, {a} + {b}*hypot(x - {y}, y - {x}), {c} + {a}*abs(x - y), 7 + x*y)"),
    };
    FormulaLayer { quantity: sliders.quantity(), formula: Formula::parse(&text).expect("a formula") }.into()
}

fn source(sliders: &mut Sliders, scale: f64) -> RasterSource {
    let side = 1 << sliders.random.u32(1..6);
    let values = (0..side * side).map(|_| (scale * sliders.round()) as f32).collect();
    let raster = Raster::from_values(Rect::UNIT, [side; 2], values);
    RasterSource { name: "raster".into(), raster: Arc::new(RasterPyramid::new(raster)) }
}

fn kind_of(name: &str, sliders: &mut Sliders) -> LayerKind {
    let distance = |to: DistanceTo, sliders: &mut Sliders| {
        LayerKind::Distance(DistanceLayer {
            to,
            at_zero: sliders.round(),
            slope: sliders.round(),
            range: if sliders.random.u8(..3) == 0 { sliders.round() } else { f64::INFINITY },
        })
    };
    match name {
        "outline" => distance(DistanceTo::Outline, sliders),
        "shapes" => {
            let shapes = shapes(sliders);
            distance(DistanceTo::Shapes { name: String::new(), shapes }, sliders)
        }
        "corridor" => {
            let (lines, width) = (shapes(sliders), sliders.round());
            distance(DistanceTo::Corridor { lines, width }, sliders)
        }
        "formula" => formula(sliders, false),
        "long formula" => formula(sliders, true),
        "raster" => {
            let of = [RasterReading::Risk, RasterReading::Diameter][sliders.random.usize(..2)].clone();
            RasterLayer { source: source(sliders, 1.0), reading: of }.into()
        }
        "curve" => {
            let (a, b) = (sliders.round(), sliders.round());
            let curve = ValueCurve::new(vec![[0.0, a], [1.0, b]]).expect("a curve");
            let source = source(sliders, 1.0);
            RasterLayer { source, reading: RasterReading::Curve(Arc::new(curve)) }.into()
        }
        "band" => {
            let (a, b) = (sliders.round(), sliders.round());
            let source = source(sliders, 1.0);
            BandLayer { source, between: [a.min(b), a.max(b)], diameter: sliders.round() }.into()
        }
        "threats" => {
            let mut threat = || Threat {
                at: sliders.place(),
                range: sliders.round(),
                peak: sliders.round().min(1.0),
                law: ThreatLaw::ALL[sliders.random.usize(..3)].0,
            };
            let count = [1, 3, 12];
            let threats = (0..12).map(|_| threat()).collect::<Vec<_>>();
            let count = count[sliders.random.usize(..3)];
            LayerKind::Threats(Threats::new(threats[..count].to_vec()).expect("threats"))
        }
        "depth" => {
            let source = source(sliders, 1.0);
            let rule = DepthRule::Wavelength { period: 0.5 * sliders.round(), triangles: 5.0 };
            let positive = PositiveDepth::Down;
            let sizes = DepthSizes { positive, offset: 0.0, between: DepthSizes::ALL_WATER, rule };
            Depths::new(source, sizes).into()
        }
        "straits" => {
            let across = (4.0 * sliders.factor).max(1.0);
            Straits { across, found: MedialBalls::unknown([0.05, 0.5]) }.into()
        }
        _ => {
            let across = (2.0 * sliders.factor).max(1.0);
            FeatureSize { across, found: MedialAxis::unknown([0.05, 1.0]) }.into()
        }
    }
}

/// A square of water with two square islands on lines of the lattice, where a layer asks for a coast.
fn domain(name: &str) -> Domain {
    if !matches!(name, "straits" | "feature size") {
        return Domain::rectangle(Rect::UNIT);
    }
    let ring = |x: f64, y: f64, side: f64| corners(&Rect::new(dvec2(x, y), dvec2(x + side, y + side)));
    let (mut left, mut right) = (ring(0.125, 0.25, 0.25), ring(0.5, 0.25, 0.25));
    left.reverse();
    right.reverse();
    let water = corners(&Rect::around(dvec2(0.5, 0.5), 0.46875));
    Domain::of_polygons(&[vec![water, left, right]]).expect("a domain")
}

/// Returns a random document with layers of a kind; `factor` is 1 or near it.
fn settings(name: &str, seed: u64, factor: f64) -> Settings {
    let mut sliders = Sliders { random: Rng::with_seed(seed), factor };
    let domain = domain(name);
    let mut layers = Layer::stack((0..1 + sliders.random.usize(..2)).map(|n| {
        let other = KINDS[sliders.random.usize(..10)];
        kind_of(if n == 0 { name } else { other }, &mut sliders)
    }));
    for layer in &mut layers {
        layer.combine =
            [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][sliders.random.usize(..4)];
        let diamond = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]].map(DVec2::from).to_vec();
        let square = corners(&Rect::around(dvec2(0.5, 0.5), 0.25));
        let mask = [None, None, None, Some(diamond), Some(square)][sliders.random.usize(..5)].clone();
        layer.mask = mask.map(|ring| Mask::new(&[vec![ring]]).expect("a mask"));
        layer.kind = match &layer.kind {
            LayerKind::Straits(straits) => straits.for_domain(&domain, &BoundaryMarks::default()).into(),
            LayerKind::FeatureSize(size) => size.for_domain(&domain, &BoundaryMarks::default()).into(),
            other => other.clone(),
        };
    }
    let h_min = [0.01, 0.02, 0.05][sliders.random.usize(..3)];
    let gradation = [None, Some(0.1), Some(0.2), Some(0.25), Some(0.5)][sliders.random.usize(..5)];
    Settings {
        domain,
        spacing: [0.5, 0.25, 0.1][sliders.random.usize(..3)],
        boundary: BoundaryTreatment::Report,
        transfer: Transfer::between(h_min * factor, 0.5),
        layers,
        gradation,
        rule: [RefinementRule::Area, RefinementRule::Vertex][usize::from(sliders.random.u8(..4) == 0)],
        max_triangles: MOST_TRIANGLES,
        ..Settings::default()
    }
}

/// Returns the processor time of a mesh in seconds, the least of several, and the number of its triangles.
fn mesh(settings: &Settings) -> (f64, usize) {
    let spec = settings.mesh_spec().expect("a grid");
    let (mut least, mut triangles) = (f64::INFINITY, 0);
    for _ in 0..2 {
        let began = processor_time();
        let mut builder = MeshBuilder::new(spec.clone());
        // A mesh that grows too large ends there.
        while let Ok(Progress::More) = builder.advance(None, 1000) {}
        triangles = builder.triangles();
        least = least.min((processor_time() - began).as_secs_f64());
    }
    (least, triangles)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let cases = arguments.first().and_then(|cases| cases.parse().ok()).unwrap_or(84);
    let only = arguments.get(1);
    for name in KINDS.into_iter().filter(|&name| only.is_none_or(|only| only == name)) {
        // Times below a millisecond are mostly those of threads that start.
        const LEAST: f64 = 1e-3;
        let (mut ratios, mut longest) = (Vec::new(), (0.0, 0));
        for seed in 0..cases {
            let (time, triangles) = mesh(&settings(name, seed, 1.0));
            let of_triangle = time / triangles.max(100) as f64;
            if of_triangle > longest.0 {
                longest = (of_triangle, seed);
            }
            let beside = BESIDE.map(|factor| mesh(&settings(name, seed, factor)).0);
            let ratio = time.max(LEAST) / beside[0].max(beside[1]).max(LEAST);
            ratios.push((ratio, seed));
        }
        ratios.sort_by(|a, b| b.0.total_cmp(&a.0));
        let worst: Vec<String> =
            ratios.iter().take(4).map(|(ratio, seed)| format!("{ratio:.2} ({seed})")).collect();
        eprintln!(
            "{name:14} largest ratios {}; a triangle takes at most {:.1} µs ({})",
            worst.join(", "),
            1e6 * longest.0,
            longest.1
        );
    }
}
