//! Every kind of layer, every mask, and small changes of them, of any size.

use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::domain::{BoundaryType, PieceChoice, Polygon, corners};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    BandLayer, DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, FeatureSize, FormulaLayer,
    LayerKind, LineSizes, Mask, MedialAxis, MedialBalls, PositiveDepth, Quantity, RasterLayer, RasterReading,
    RasterSource, ShapeList, Shapes, Straits, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource, Threat,
    ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

use super::{Choices, Scale};

/// Returns the size of something, by its logarithm: from some of the smallest diameters to a third of the
/// domain.
fn size(choices: &mut impl Choices, scale: Scale) -> f64 {
    let least = (4.0 * scale.smallest).min(0.1);
    0.3 * (least / 0.3).powf(choices.share())
}

/// Returns a diameter that a few hundred triangles of something of a size meet.
fn diameter_for(choices: &mut impl Choices, size: f64, scale: Scale) -> f64 {
    (size * (0.15 + choices.share())).max(scale.smallest)
}

/// Returns a place in the unit square.
fn place(choices: &mut impl Choices) -> DVec2 {
    dvec2(choices.share(), choices.share())
}

/// Returns a polygon about a place: a square, or a triangle.
fn polygon(choices: &mut impl Choices, centre: DVec2, size: f64) -> Polygon {
    let square = corners(&Rect::around(centre, 0.5 * size));
    match choices.below(3) {
        0 => vec![square],
        1 => vec![square[..3].to_vec()],
        _ => {
            let slanted = |angle: f64| centre + 0.6 * size * dvec2(angle.cos(), angle.sin());
            let turn = choices.share();
            vec![(0..5).map(|n| slanted(turn + std::f64::consts::TAU * f64::from(n) / 5.0)).collect()]
        }
    }
}

/// Returns a mask of one or two polygons.
pub fn mask(choices: &mut impl Choices, scale: Scale) -> Option<Mask> {
    let size = size(choices, scale);
    let polygons: Vec<_> = (0..1 + choices.below(2))
        .map(|_| {
            let centre = place(choices);
            polygon(choices, centre, size)
        })
        .collect();
    Mask::new(&polygons).ok()
}

/// Any kind of layer.
pub fn layer_kind(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let diameter = scale.diameter * (1.0 + 9.0 * choices.share());
    match choices.below(18) {
        0 => LayerKind::constant(8.0 * diameter),
        1 => small_constant(choices, scale),
        2..5 => formula(choices, scale),
        5 if choices.below(2) == 0 => {
            let formula = Formula::parse("if(x < 0.4, 0.5 + 0.2 * y, inf)").unwrap();
            FormulaLayer { quantity: Quantity::Error, formula }.into()
        }
        5 => LayerKind::risk(Formula::parse("exp(-30 * hypot(x - 0.6, y - 0.3))").unwrap()),
        6 | 7 => LayerKind::paint([Quantity::Risk, Quantity::Diameter, Quantity::Error][choices.below(3)]),
        8..11 => raster(choices, diameter),
        11..13 => threats(choices, scale),
        13 if choices.below(3) == 0 => {
            LineSizes { across: 0.2 + choices.share(), ..LineSizes::default() }.into()
        }
        13 => {
            let between = [4.0 * diameter, 8.0 * diameter];
            match choices.below(2) {
                0 => LayerKind::Straits(Straits { across: 3.0, found: MedialBalls::unknown(between) }),
                _ => {
                    let found = MedialAxis::unknown(between);
                    FeatureSize { across: 3.0, found }.into()
                }
            }
        }
        14 => surface(choices),
        _ => distance(choices, scale),
    }
}

/// Returns a surface of a few pixels, or of a formula, with either goal.
fn surface(choices: &mut impl Choices) -> LayerKind {
    let source = match choices.below(3) {
        0 => SurfaceSource::Formula(Formula::parse("sin(7 * x) * y + if(x + y > 1.3, 0.4, 0)").unwrap()),
        _ => {
            let corner = dvec2(choices.share(), choices.share()) - 0.4;
            let size = [1 + choices.below(9) as u32, 1 + choices.below(9) as u32];
            let values = (0..size[0] * size[1]).map(|n| match n {
                2 => f32::NAN,
                _ => choices.share() as f32,
            });
            let raster = Raster::from_values(Rect::new(corner, corner + 1.2), size, values.collect());
            let raster = Arc::new(RasterPyramid::new(raster));
            SurfaceSource::Raster(RasterSource { name: "surface.asc".into(), raster })
        }
    };
    let norm = SurfaceNorm::ALL[choices.below(3)];
    // The gradient is large where a formula jumps and at the edges of small pixels: no mesh of a test is near.
    let unit = if norm == SurfaceNorm::Gradient { 20.0 } else { 1.0 };
    let goal = match choices.below(3) {
        0 => SurfaceGoal::AtMost(1 + choices.below(3000)),
        _ => SurfaceGoal::Within(unit * (0.1 + choices.share())),
    };
    Surface { source, goal, norm }.into()
}

/// Returns a constant that is too fine for all of the domain: it needs a mask, or is refused.
pub fn small_constant(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let size = size(choices, scale);
    LayerKind::constant(diameter_for(choices, size, scale))
}

fn formula(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let texts = [
        "0.1 + 0.2 * x",
        "if(abs(x - y) < 0.1, 0.1, inf)",
        "if(hypot(x - 0.5, y - 0.4) < 0.3, 0.15, inf)",
        "x - 0.3",
        "1 / (x - y)",
        // Refused without depths, as these are invalid where the depth is.
        "0.1 + 0.01 * abs(depth)",
        "if(depth > 2, 0.12 + 0.1 * x, inf)",
    ];
    let number = choices.below(2 * texts.len());
    let text = texts.get(number).map_or_else(
        || {
            let (size, at) = (size(choices, scale), place(choices));
            let diameter = diameter_for(choices, size, scale);
            format!("if(hypot(x - {}, y - {}) < {size}, {diameter}, inf)", at.x, at.y)
        },
        |text| (*text).to_owned(),
    );
    LayerKind::target(Formula::parse_of_size(&text).unwrap())
}

/// Returns a raster over a part of the domain, or beyond it, with a pixel that has no value, by any reading.
fn raster(choices: &mut impl Choices, diameter: f64) -> LayerKind {
    let corner = dvec2(choices.share(), choices.share()) - 0.4;
    let bounds = Rect::new(corner, corner + 0.2 + choices.share());
    let size = [1 + choices.below(9) as u32, 1 + choices.below(9) as u32];
    let reading = choices.below(5);
    // Smaller errors would need very many triangles where a surface jumps.
    let is_error = reading == 1 && choices.below(2) == 0;
    let value = |share: f64| match reading {
        1 if is_error => 0.5 + share,
        1 => diameter * (0.5 + 4.0 * share),
        4 => 20.0 * share - 8.0,
        _ => share,
    };
    let count = (size[0] * size[1]) as usize;
    let mut values: Vec<f32> = (0..count).map(|_| value(choices.share()) as f32).collect();
    values[choices.below(count)] = f32::NAN;
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, size, values)));
    let source = RasterSource { name: "random".into(), raster };
    let reading = match reading {
        0 => RasterReading::Risk,
        1 if is_error => RasterReading::Error,
        1 => RasterReading::Diameter,
        2 => {
            let knots = vec![[0.2, 5.0 * diameter], [0.6, diameter], [0.8, 2.0 * diameter]];
            RasterReading::Curve(Arc::new(ValueCurve::new(knots).unwrap()))
        }
        4 => return LayerKind::Depth(Depths::new(source, depth_sizes(choices, diameter))),
        _ => {
            let from = choices.share();
            return LayerKind::Band(BandLayer { source, between: [from, from + 0.3], diameter });
        }
    };
    RasterLayer { source, reading }.into()
}

/// Returns sizes of about a diameter in water of some metres.
fn depth_sizes(choices: &mut impl Choices, diameter: f64) -> DepthSizes {
    let rule = match choices.below(4) {
        0 => DepthRule::Nothing,
        1 => DepthRule::Wavelength { period: 10.0, triangles: 40.0 / diameter },
        2 => DepthRule::Slope { triangles: 0.01 / diameter, smoothing: 0.3 * choices.share() },
        _ => DepthRule::Courant { time_step: diameter, number: 8.0 },
    };
    let positive = [PositiveDepth::Up, PositiveDepth::Down][choices.below(2)];
    let between =
        if choices.below(2) == 0 { DepthSizes::ALL_WATER } else { [1.0, 9.0 * choices.share() + 2.0] };
    let offset = [0.0, 0.4 * choices.share() - 0.2][choices.below(2)];
    DepthSizes { positive, offset, between, rule }
}

fn threat(choices: &mut impl Choices, scale: Scale) -> Threat {
    let range = size(choices, scale);
    // A peak of which the diameter suits the range.
    let (h_min, h_max) = (scale.smallest, 0.2);
    let wanted = diameter_for(choices, range, scale).min(h_max);
    let peak = ((h_max / wanted).ln() / (h_max / h_min).ln()).clamp(0.0, 1.0);
    let peak = if choices.below(8) == 0 { 0.0 } else { peak };
    let law = ThreatLaw::ALL[choices.below(ThreatLaw::ALL.len())].0;
    Threat { at: place(choices), range, peak, law }
}

fn threats(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let list = (0..choices.below(5)).map(|_| threat(choices, scale)).collect();
    Threats::new(list).unwrap().into()
}

/// Returns pieces of the boundary of which some are there, by names and types that the marks change.
fn pieces(choices: &mut impl Choices) -> PieceChoice {
    let names = ["Open sea", "Rock", "mainland", "island 1", "open south"];
    let names = (0..choices.below(3)).map(|_| names[choices.below(names.len())].to_owned()).collect();
    let types = (0..choices.below(4)).map(|_| BoundaryType::ALL[choices.below(7)]).collect();
    PieceChoice { names, types }
}

fn distance(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let (size, centre) = (size(choices, scale), place(choices));
    let end = centre + size * (place(choices) - 0.5);
    let mut at_zero = diameter_for(choices, size, scale);
    let mut slope = 0.2 + choices.share();
    let to = match choices.below(5) {
        0 => {
            at_zero = scale.diameter * (2.0 + 8.0 * choices.share());
            match choices.below(4) {
                0 => DistanceTo::Outline,
                1 => DistanceTo::Coasts,
                _ => DistanceTo::Pieces(pieces(choices)),
            }
        }
        1 => {
            let lines = ShapeList { lines: vec![vec![centre, end]], ..ShapeList::default() };
            DistanceTo::Corridor { lines: Shapes::new(lines, false).unwrap(), width: size * choices.share() }
        }
        other => {
            let polygons = if other == 4 { vec![polygon(choices, centre, size)] } else { Vec::new() };
            let lines = if other == 3 { vec![vec![centre, end]] } else { Vec::new() };
            let list = ShapeList { points: vec![centre, end], lines, polygons };
            // Polygons from a file are always filled, and so are those of a project.
            let shapes = Shapes::new(list, true).unwrap();
            DistanceTo::Shapes { name: "shapes".into(), shapes }
        }
    };
    let range = if choices.below(2) == 0 { f64::INFINITY } else { size * choices.share() };
    if range.is_finite() && choices.below(3) == 0 {
        slope = 0.0;
    }
    DistanceLayer { to, at_zero, slope, range }.into()
}

/// Returns a layer with one number changed, by much or by little.
pub fn tweaked(kind: &LayerKind, choices: &mut impl Choices, scale: Scale) -> Option<LayerKind> {
    let factor = [0.5, 0.9, 1.1, 2.0, 1.0 - 1e-12, 1.0 + 1e-12][choices.below(6)];
    let mut kind = kind.clone();
    match &mut kind {
        LayerKind::Paint(_) | LayerKind::Raster(_) => return None,
        LayerKind::Formula(FormulaLayer { formula, .. }) => {
            *formula = Formula::constant_of((factor * formula.constant()?).max(scale.smallest));
        }
        LayerKind::Threats(threats) => *threats = other_threats(threats, choices, scale, factor)?,
        LayerKind::Distance(DistanceLayer { at_zero, slope, range, to }) => match choices.below(4) {
            0 => *at_zero = (factor * *at_zero).max(scale.smallest),
            1 => *slope = (factor * *slope).min(2.0),
            2 => *range *= factor,
            _ => match to {
                DistanceTo::Corridor { width, .. } => *width *= factor,
                _ => return None,
            },
        },
        LayerKind::Band(BandLayer { diameter, between, .. }) => match choices.below(2) {
            0 => *diameter = (factor * *diameter).max(scale.diameter),
            _ => between[1] = (factor * between[1]).max(between[0]),
        },
        LayerKind::Straits(straits) => straits.across = (straits.across / factor).clamp(1.0, 4.0),
        LayerKind::FeatureSize(size) => size.across = (size.across / factor).clamp(1.0, 4.0),
        LayerKind::Lines(sizes) => sizes.across = (sizes.across / factor).clamp(0.2, 2.0),
        LayerKind::Surface(Surface { goal: SurfaceGoal::Within(error), .. }) => *error *= factor.max(0.9),
        LayerKind::Surface(Surface { goal: SurfaceGoal::AtMost(count), .. }) => {
            *count = (factor * *count as f64) as usize + 1;
        }
        LayerKind::Depth(depths) => {
            let mut sizes = *depths.sizes();
            match &mut sizes.rule {
                DepthRule::Nothing => return None,
                DepthRule::Wavelength { triangles: number, .. }
                | DepthRule::Slope { triangles: number, .. }
                | DepthRule::Courant { number, .. } => *number /= factor.max(0.9),
            }
            *depths = depths.with_sizes(sizes);
        }
    }
    Some(kind)
}

/// Returns one threat moved, changed, added, removed, or exchanged with another.
fn other_threats(
    threats: &Threats,
    choices: &mut impl Choices,
    scale: Scale,
    factor: f64,
) -> Option<Threats> {
    let mut list = threats.list().to_vec();
    let (place, other) = (choices.below(8), threat(choices, scale));
    if list.is_empty() || choices.below(5) == 0 {
        list.insert(place % (list.len() + 1), other);
        return Threats::new(list).ok();
    }
    let number = place % list.len();
    let before = list[number];
    let changed = match choices.below(7) {
        0 => Threat { at: other.at, ..before },
        1 => Threat { at: before.at + before.range * factor * 0.1, ..before },
        2 => Threat { peak: (factor * before.peak).min(1.0), ..before },
        3 => Threat { range: (factor * before.range).min(0.3), ..before },
        4 => other,
        5 => {
            list.swap(0, number);
            return Threats::new(list).ok();
        }
        _ => {
            list.remove(number);
            return Threats::new(list).ok();
        }
    };
    // As the drag of a threat does.
    let mut threats = threats.clone();
    threats.set(number, changed).ok()?;
    Some(threats)
}
