//! The distance to pieces of the boundary: by names and types, and after edits of both.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Setting, Settings, Stage};
use meshbrush_core::domain::{
    BoundaryKind, BoundaryMarks, BoundaryPieces, BoundaryType, Domain, PieceChoice, Ring,
};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Combine, DistanceLayer, DistanceTo, Layer, LayerKind};
use meshbrush_mesh::geometry::Rect;

use crate::runs::seeds;

/// A sea with an island, cut off by its frame in the south and the west.
fn sea() -> Domain {
    let outer = [(-1.0, -1.0), (0.9, -1.0), (0.8, 0.6), (0.5, 0.9), (-1.0, 0.8)];
    let island = [(0.3, 0.3), (0.35, 0.5), (0.5, 0.45), (0.45, 0.3)];
    let ring = |points: &[(f64, f64)]| -> Ring { points.iter().map(|&(x, y)| dvec2(x, y)).collect() };
    let domain = Domain::of_polygons(&[vec![ring(&outer), ring(&island)]]).unwrap();
    domain.with_bounds(Rect::new(DVec2::ZERO, DVec2::ONE))
}

fn choice(random: &mut Rng) -> PieceChoice {
    let names = ["open south", "mainland", "island 1", "Port", "Rock"];
    PieceChoice {
        names: names.into_iter().filter(|_| random.u8(..4) == 0).map(str::to_owned).collect(),
        types: BoundaryType::ALL.into_iter().filter(|_| random.u8(..3) == 0).collect(),
    }
}

/// Names, types or splits one more piece, or gives its own back to all.
fn marked(marks: &BoundaryMarks, domain: &Domain, random: &mut Rng) -> BoundaryMarks {
    let pieces = BoundaryPieces::of_domain(domain, marks).unwrap();
    let number = random.usize(..pieces.list().len());
    match random.u8(..8) {
        0 => BoundaryMarks::default(),
        1..3 => pieces.renamed(marks, number, ["Port", "Rock", "open mouth", ""][random.usize(..4)]),
        3 => pieces.split(marks, pieces.list()[number].middle(), 0.1).unwrap_or_else(|| marks.clone()),
        4 => pieces.joined(marks, number).unwrap_or_else(|| marks.clone()),
        _ => {
            let all = BoundaryType::ALL;
            pieces.retyped(marks, number, all.get(random.usize(..all.len() + 1)).copied())
        }
    }
}

/// The distance to the chosen pieces, from points along them.
fn referee(settings: &Settings, chosen: &PieceChoice, at: DVec2) -> f64 {
    let pieces = BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks).unwrap();
    let default = |name: &str, kind| match name.to_lowercase() {
        name if name.starts_with("open") => BoundaryType::Open,
        name if name.starts_with("land") => BoundaryType::Land,
        _ if kind == BoundaryKind::Open => BoundaryType::Open,
        _ => BoundaryType::Land,
    };
    let mut least = f64::INFINITY;
    for piece in pieces.list() {
        let of_piece = piece.set_type.unwrap_or(default(&piece.name, piece.kind));
        if !chosen.names.contains(&piece.name) && !chosen.types.contains(&of_piece) {
            continue;
        }
        for ends in piece.points.windows(2) {
            let along = (0..=4000).map(|n| ends[0].lerp(ends[1], f64::from(n) / 4000.0));
            least = along.fold(least, |least, p| least.min(p.distance(at)));
        }
    }
    least
}

#[test]
fn edits_of_pieces_change_the_mesh_in_place_and_it_is_the_one_of_the_distance() {
    let (mut within, mut all, mut far) = (0, 0, 0);
    for seed in seeds(16) {
        let mut random = Rng::with_seed(seed);
        let mut chosen = choice(&mut random);
        let layers = |chosen: &PieceChoice, random: &mut Rng| {
            let range = [f64::INFINITY, 0.15][random.usize(..2)];
            let (at_zero, slope) = (0.02 + 0.03 * random.f64(), 0.3);
            let to = DistanceTo::Pieces(chosen.clone());
            let mut layers = Layer::stack([DistanceLayer { to, at_zero, slope, range }]);
            layers[0].combine = if random.u8(..4) == 0 { Combine::Replace } else { Combine::Finest };
            layers
        };
        let settings = Settings {
            layers: layers(&chosen, &mut random),
            transfer: Transfer::between(0.02, 0.3),
            spacing: 0.2,
            gradation: [None, Some(0.4)][random.usize(..2)],
            ..Settings::for_domain("Sea".into(), sea())
        };
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        for _ in 0..10 {
            if random.u8(..4) == 0 {
                chosen = choice(&mut random);
                let layers = layers(&chosen, &mut random);
                document.set(Setting::Layers(layers)).unwrap();
            } else {
                let Settings { domain, boundary_marks, .. } = document.settings();
                let marks = marked(boundary_marks, domain, &mut random);
                document.set(Setting::BoundaryMarks(marks)).unwrap();
            }
            document.end_gesture();
            let before = follower.mesh().fingerprint();
            while follower.advance(&mut document, random.usize(1..2000)).unwrap() != Stage::InStep {}
            let from_scratch = Follower::new(&mut document.clone()).unwrap();
            let now = follower.mesh().fingerprint();
            assert_eq!(now, from_scratch.mesh().fingerprint(), "document {seed}");
            (within, all) = (within + usize::from(now != before), all + 1);
        }
        let LayerKind::Distance(DistanceLayer { at_zero, slope, range, .. }) =
            document.settings().layers[0].kind
        else {
            panic!("a distance")
        };
        for _ in 0..20 {
            let at = dvec2(random.f64(), random.f64());
            let distance = referee(document.settings(), &chosen, at);
            if document.settings().gradation.is_some() || (distance - range).abs() < 1e-3 {
                continue;
            }
            let asked = if distance <= range { at_zero + slope * distance } else { f64::INFINITY };
            let (expected, found) =
                (asked.clamp(0.02, 0.3), follower.field().target_at(document.paint(), at));
            assert!((found - expected).abs() < 1e-3, "document {seed}: {found} for {expected} at {at}");
            far += usize::from(expected < 0.3);
        }
    }
    assert!(4 * within > all && far > 30, "{within} of {all} edits changed the mesh; {far}");
}
