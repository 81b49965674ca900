//! Changes of other settings.

use std::sync::{Arc, LazyLock};

use glam::{DVec2, dvec2};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryTreatment, BoundaryType, Crest, Domain, DomainShape, Line, LineKind, Weir,
};
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts, bisection_edge_length};

use super::{Choices, Scale};

pub fn setting(choices: &mut impl Choices, scale: Scale) -> Setting {
    let diameter = scale.diameter * (1.0 + 9.0 * choices.share());
    match choices.below(16) {
        0 if choices.below(2) == 0 => Setting::SmallestDiameter(scale.smallest * (1.0 + choices.share())),
        1 if choices.below(2) == 0 => Setting::DiameterAtRiskOne(diameter),
        0 | 1 => Setting::SmallestDiameter(diameter),
        2 => Setting::LargestDiameter(largest_diameter(choices, diameter)),
        3 => Setting::TransferShape(0.5 + 2.0 * choices.share()),
        4 | 5 => Setting::Spacing(SPACINGS[choices.below(SPACINGS.len())]),
        7 => Setting::MaxLevel([None, Some(5), None, Some(9)][choices.below(4)]),
        6 => Setting::RefinementRule(if choices.below(4) == 0 {
            RefinementRule::Vertex
        } else {
            RefinementRule::Area
        }),
        8 => Setting::Gradation([None, Some(0.1 + choices.share())][choices.below(2)]),
        9 => match choices.share() {
            share @ ..0.4 => Setting::Cleaning(cleaning(2.5 * share)),
            share @ ..0.7 => Setting::BoundaryMarks(marks((256.0 * share) as usize)),
            share => Setting::Lines(Arc::new(lines((1000.0 * share) as usize))),
        },
        10 => Setting::MaxTriangles(scale.triangles * [1, 4, 20, 100][choices.below(4)]),
        11 | 12 => Setting::Bounds(bounds(choices)),
        13 => Setting::Domain(inside(choices)),
        14 if choices.below(4) == 0 => Setting::Boundary(BoundaryTreatment::Report),
        14 if diameter < 4.0 * scale.diameter => {
            Setting::Boundary(BoundaryTreatment::Fitted { diameter: 2.0 * diameter })
        }
        14 => Setting::Boundary(BoundaryTreatment::OnOutline { diameter: 2.0 * diameter }),
        _ => impossible(choices),
    }
}

const SPACINGS: [f64; 4] = [0.3, 0.25, 0.2, 0.15];

/// Returns a few times a diameter, or the diameter of a level, as in a new document: triangles of that level
/// then ask wherever a layer asks for anything at all.
fn largest_diameter(choices: &mut impl Choices, diameter: f64) -> f64 {
    match choices.below(4) {
        level @ 0..2 => bisection_edge_length(SPACINGS[choices.below(SPACINGS.len())], level as u32),
        _ => 8.0 * diameter,
    }
}

fn cleaning(share: f64) -> Cleaning {
    let parts = match share {
        ..0.3 => KeptParts::All,
        ..0.6 => KeptParts::Largest,
        _ => KeptParts::Share(share - 0.6),
    };
    Cleaning {
        parts,
        keeps_pinches: (100.0 * share) % 2.0 < 1.0,
        improves_boundary: (100.0 * share) % 3.0 < 1.0,
    }
}

/// Returns no line to three of them, which cross each other, the outline and the sides of the square.
fn lines(number: usize) -> Vec<Line> {
    const PLACES: [[f64; 2]; 7] =
        [[0.1, 0.2], [0.85, 0.3], [0.5, 0.5], [0.3, 0.9], [0.95, 0.95], [0.6, 0.05], [1.2, 0.6]];
    let place = |n: usize| DVec2::from(PLACES[n % PLACES.len()]);
    let line = |n: usize| Line {
        name: format!("line {n}"),
        points: (0..2 + (number + n) % 3).map(|k| place(number + 3 * n + 2 * k)).collect(),
        closed: (number + n) % 4 == 3,
        kind: match (number + 2 * n) % 5 {
            0 => LineKind::Weir(Weir::with_crest(Crest::Height(number as f64))),
            1 => LineKind::Weir(Weir::with_crest(Crest::Profile(vec![[0.0, 1.0], [0.5, n as f64]]))),
            _ => LineKind::Edges,
        },
    };
    (0..number % 4).map(line).collect()
}

/// Returns splits, names and types at some sides of the square and of the hole, and beside them.
fn marks(number: usize) -> BoundaryMarks {
    const PLACES: [[f64; 2]; 5] = [[0.5, 0.0], [1.0, 0.5], [0.45, 0.05], [0.0, 0.5], [0.45, 0.325]];
    let place = |n: usize| DVec2::from(PLACES[(number + n) % PLACES.len()]);
    let of_piece = |n: usize| (place(n), BoundaryType::ALL[(number + 3 * n) % BoundaryType::ALL.len()]);
    BoundaryMarks {
        splits: (0..number % 2).map(|n| place(n) + dvec2(0.1, 0.0)).collect(),
        names: (0..number % 3).map(|n| (place(n), ["Open sea", "Rock"][n].to_owned())).collect(),
        types: (0..number % 4).map(of_piece).collect(),
    }
}

fn bounds(choices: &mut impl Choices) -> Rect {
    let size = dvec2(0.4 + choices.share(), 0.4 + choices.share());
    let min = dvec2(choices.share(), choices.share()) - 0.5;
    if choices.below(2) == 0 { Rect::UNIT } else { Rect::new(min, min + size) }
}

/// A hole and a bite out of the rim, a strip, two parts that do not touch, nothing at all.
const INSIDES: [&str; 4] =
    ["not(hypot(x - 0.4, y - 0.6) < 0.2 or x + y > 1.7)", "abs(x - y) < 0.4", "x < 0.25 or x > 0.7", "x > 9"];

/// The shapes of these formulas: clones share the line, which is followed once.
static SHAPES: LazyLock<[DomainShape; 4]> =
    LazyLock::new(|| INSIDES.map(|text| Formula::parse(text).unwrap().into()));

fn inside(choices: &mut impl Choices) -> Domain {
    let chosen = choices.below(1 + 2 * SHAPES.len()).checked_sub(1).and_then(|n| SHAPES.get(n));
    Domain { bounds: Rect::UNIT, shape: chosen.cloned().unwrap_or(DomainShape::Whole), projection: None }
}

/// Returns a setting that no document accepts.
fn impossible(choices: &mut impl Choices) -> Setting {
    let bad = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300][choices.below(5)];
    match choices.below(7) {
        0 => Setting::Spacing(bad),
        1 => Setting::SmallestDiameter(bad),
        2 => Setting::TransferShape(bad),
        3 => Setting::Gradation(Some(if bad == 1e-300 { -bad } else { bad })),
        4 => Setting::DiameterAtRiskOne(if bad == 1e-300 { -bad } else { bad }),
        5 => {
            Setting::Layers(Layer::default_stack(LayerKind::constant(if bad == 1e-300 { 0.0 } else { bad })))
        }
        _ => Setting::Bounds(Rect::new(DVec2::ZERO, dvec2(bad, 1.0))),
    }
}

/// Returns a square, a rectangle, a domain with a hole and a bite out of its rim by a formula, and a slanted
/// one with a hole.
pub fn domains() -> [Domain; 4] {
    let outline = vec![dvec2(0.0, 0.1), dvec2(0.9, 0.0), dvec2(1.0, 0.8), dvec2(0.3, 1.0)];
    let hole = vec![dvec2(0.3, 0.3), dvec2(0.6, 0.35), dvec2(0.5, 0.7)];
    [
        Domain::rectangle(Rect::UNIT),
        Domain::rectangle(Rect::new(DVec2::ZERO, dvec2(1.0, 0.7))),
        Domain { bounds: Rect::UNIT, shape: SHAPES[0].clone(), projection: None },
        Domain::of_polygons(&[vec![outline, hole]]).unwrap(),
    ]
}
