//! Sizes in metres on the Earth: a triangle stays where its diameter in the plane is at most its target times
//! the scale, and an edited mesh is the one made from scratch.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Setting, Settings, Stage};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::{Projection, ProjectionKind};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, ShapeList, Shapes,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::geometry::Rect;

use crate::runs::seeds;

/// Planes in which the scale ranges up to the threefold, and rectangles of them, in metres.
fn planes() -> [(Projection, Rect); 4] {
    let rect = |min: DVec2, size: DVec2| Rect::new(min, min + size);
    [
        ("+proj=merc +lat_ts=0 +ellps=WGS84 +units=m", rect(dvec2(1e6, -1e6), dvec2(4e6, 10e6))),
        ("+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m", rect(dvec2(-5e5, 4e6), dvec2(4e6, 3e6))),
        (
            "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=0 +ellps=WGS84 +units=m",
            rect(DVec2::splat(-2e6), dvec2(7e6, 5e6)),
        ),
        (
            "+proj=lcc +lat_1=60 +lat_2=60 +lat_0=60 +lon_0=0 +ellps=WGS84 +units=m",
            rect(dvec2(-3e6, -4e6), dvec2(6e6, 5e6)),
        ),
    ]
    .map(|(text, bounds)| (text.parse().unwrap(), bounds))
}

fn point(bounds: &Rect, random: &mut Rng) -> DVec2 {
    bounds.min + bounds.size() * dvec2(random.f64(), random.f64())
}

/// A layer of any kind whose target has to do with lengths.
fn kind(bounds: &Rect, random: &mut Rng) -> LayerKind {
    let side = bounds.size().max_element();
    let metres = |random: &mut Rng| side * (0.012 + 0.04 * random.f64());
    let at = point(bounds, random);
    match random.u32(0..3) {
        0 => LayerKind::constant(metres(random)),
        1 => {
            let text = format!("{} + 0.2 * hypot(x - {}, y - {})", metres(random), at.x, at.y);
            LayerKind::target(Formula::parse(&text).unwrap())
        }
        _ => {
            let shapes = ShapeList { lines: vec![vec![at, point(bounds, random)]], ..ShapeList::default() };
            DistanceLayer {
                to: DistanceTo::Shapes { name: "line".into(), shapes: Shapes::new(shapes, false).unwrap() },
                at_zero: metres(random),
                slope: 0.3 * random.f64(),
                range: 0.2 * side * random.f64(),
            }
            .into()
        }
    }
}

fn layers(bounds: &Rect, random: &mut Rng) -> Vec<Layer> {
    let count = random.usize(1..4);
    let mut layers = Layer::default_stack(kind(bounds, random));
    for number in 0..count {
        let id = LayerId(10 + number as u32);
        let combine = if random.u32(0..5) == 0 { Combine::Floor } else { Combine::Finest };
        layers.push(Layer { combine, ..Layer::new(id, "more", kind(bounds, random)) });
    }
    layers
}

fn document(random: &mut Rng) -> Document {
    let (projection, bounds) = planes()[random.usize(..4)];
    let is_ring = random.bool();
    let ring = (0..12).map(|n| {
        let (sine, cosine) = (f64::from(n) * std::f64::consts::TAU / 12.0).sin_cos();
        bounds.center() + (0.3 + 0.2 * random.f64()) * bounds.size() * dvec2(cosine, sine)
    });
    let mut domain = match is_ring {
        true => Domain::of_polygons(&[vec![ring.collect()]]).unwrap(),
        false => Domain::rectangle(bounds),
    };
    domain.projection = Some(projection);
    let side = bounds.size().max_element();
    let settings = Settings {
        spacing: 0.1 * side,
        boundary: BoundaryTreatment::Fitted { diameter: 0.03 * side },
        transfer: Transfer::between(0.008 * side, 0.2 * side),
        layers: layers(&domain.bounds, random),
        gradation: random.bool().then(|| 0.1 + random.f64()),
        domain,
        ..Settings::default()
    };
    Document::new(settings, None).unwrap()
}

fn edit(document: &mut Document, random: &mut Rng) {
    let bounds = document.settings().domain.bounds;
    match random.u32(0..5) {
        0 => document.set(Setting::Layers(layers(&bounds, random))).unwrap(),
        1 => document.set(Setting::Gradation(random.bool().then(|| 0.1 + random.f64()))).unwrap(),
        2 => _ = document.undo(),
        _ => {
            let side = bounds.size().max_element();
            let medium = Medium::Diameter(side * (0.008 + 0.03 * random.f64()), DiameterChange::Finer);
            let radius = (0.02 + 0.1 * random.f64()) * side;
            document.begin_stroke(Brush { medium, radius, hardness: 0.5, strength: 1.0 });
            document.draw_to(point(&bounds, random));
            document.draw_to(point(&bounds, random));
            document.end_stroke();
        }
    }
    document.end_gesture();
}

fn settle(follower: &mut Follower, document: &mut Document, random: &mut Rng) {
    while follower.advance(document, random.usize(1..3000)).unwrap() != Stage::InStep {}
}

/// Returns how many triangles are longer in the plane than their target is on the Earth, and checks that none
/// is longer than that times the scale.
fn longer_in_plane(document: &Document, follower: &Follower, random: &mut Rng) -> usize {
    let mesh = follower.mesh();
    let projection = document.settings().domain.projection.unwrap();
    let mut longer = 0;
    // Reading a target takes long with a gradation.
    for element in mesh.raw_elements().step_by(mesh.raw_triangle_count() / 24 + 1) {
        if follower.domain().excludes(&element) || follower.domain().has_none_of(&element) {
            continue;
        }
        let [a, b, c] = element.corners.map(|corner| mesh.lattice().world_from_lattice(corner));
        let points = (0..6).map(|n| {
            let (s, t) = (random.f64(), random.f64());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            [a, b, c].get(n).copied().unwrap_or(a + s * (b - a) + t * (c - a))
        });
        let points: Vec<DVec2> = points.collect();
        let least =
            |value: &dyn Fn(DVec2) -> f64| points.iter().map(|&at| value(at)).fold(f64::INFINITY, f64::min);
        let target = least(&|at| follower.field().target_at(document.paint(), at));
        let scale = least(&|at| projection.scale_in_plane(at));
        let diameter = element.diameter();
        assert!(
            diameter <= target * scale * (1.0 + 1e-9),
            "{projection}: {diameter} for {target} at {scale}"
        );
        longer += usize::from(diameter > target);
    }
    longer
}

#[test]
fn an_edited_mesh_on_the_earth_meets_targets_in_metres() {
    let mut longer = 0;
    for seed in seeds(8) {
        let mut random = Rng::with_seed(seed);
        let mut document = document(&mut random);
        let mut follower = Follower::new(&mut document).unwrap();
        for _ in 0..6 {
            for _ in 0..random.usize(1..3) {
                edit(&mut document, &mut random);
                _ = follower.advance(&mut document, random.usize(1..2000)).unwrap();
            }
            settle(&mut follower, &mut document, &mut random);
            let from_scratch = Follower::new(&mut document.clone()).unwrap();
            assert_eq!(follower.mesh().fingerprint(), from_scratch.mesh().fingerprint(), "document {seed}");
            longer += longer_in_plane(&document, &follower, &mut random);
        }
    }
    assert!(longer > 60, "{longer}");
}

/// The level that the window shows beside a target diameter is that of the triangles there.
#[test]
fn the_level_of_a_diameter_is_that_of_the_triangles_at_the_place() {
    let mut random = Rng::with_seed(5);
    for (projection, bounds) in planes() {
        let target = 0.02 * bounds.size().max_element();
        let document = Document::new(
            Settings {
                spacing: 0.2 * bounds.size().max_element(),
                transfer: Transfer { h_min: target, h_risk: target, h_max: 1e9, shape: 1.0 },
                layers: Layer::default_stack(LayerKind::constant(target)),
                ..Settings::for_domain(
                    "levels".into(),
                    Domain { projection: Some(projection), ..Domain::rectangle(bounds) },
                )
            },
            None,
        );
        let mut document = document.unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        settle(&mut follower, &mut document, &mut random);
        for corner in [bounds.min, bounds.max, bounds.max + bounds.size()] {
            assert!(follower.field().level_of_diameter(target, corner).is_some());
        }
        let mut levels = Vec::new();
        for _ in 0..200 {
            let at = point(&bounds, &mut random);
            let Some(triangle) = follower.mesh().locate(at).triangle() else { continue };
            let level = follower.field().level_of_diameter(target, at).unwrap();
            let found = follower.mesh().triangle(triangle).level();
            // Neighbours bisect some triangles once more; the scale of a larger square counts for the rule.
            assert!((level..=level + 2).contains(&found), "{} at {at}: {level}, {found}", projection);
            levels.push(level);
        }
        let range = levels.iter().max().unwrap() - levels.iter().min().unwrap();
        let is_mercator = projection.kind() == ProjectionKind::Mercator;
        assert!(range >= if is_mercator { 2 } else { 0 }, "{projection}: {range}");
    }
}
