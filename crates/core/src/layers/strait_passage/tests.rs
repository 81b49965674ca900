//! The narrowest passage, compared with erosion on a raster that knows nothing of shores and discs.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};

use crate::domain::{BoundaryMarks, BoundaryType, Domain, Ring};
use crate::layers::MedialBalls;

/// Pixels of a raster along a side.
const SIDE: usize = 320;
/// Half of the width of the square that the raster covers.
const REACH: f64 = 12.0;

fn pixel() -> f64 {
    2.0 * REACH / SIDE as f64
}

fn ring(at: DVec2, corners: u32, radius: impl Fn(f64) -> f64) -> Ring {
    let angle = |n: u32| TAU * f64::from(n) / f64::from(corners);
    (0..corners).map(|n| at + radius(angle(n)) * DVec2::from_angle(angle(n))).collect()
}

fn is_inside(at: DVec2, rings: &[Ring]) -> bool {
    let mut inside = false;
    for (a, b) in rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1))) {
        if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

fn to_coast(at: DVec2, rings: &[Ring]) -> f64 {
    let edges = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let distance = |(&a, &b): (&DVec2, &DVec2)| {
        let share = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        at.distance(a + share * (b - a))
    };
    edges.map(distance).fold(f64::INFINITY, f64::min)
}

/// The distance from land at each pixel; less than 0 on land.
fn room(rings: &[Ring]) -> Vec<f64> {
    let center = |n: usize| (n as f64 + 0.5) * pixel() - REACH;
    (0..SIDE * SIDE)
        .map(|n| {
            let at = dvec2(center(n % SIDE), center(n / SIDE));
            if is_inside(at, rings) { to_coast(at, rings) } else { -1.0 }
        })
        .collect()
}

/// The number of parts of the pixels for which `keep` holds that have more than a few pixels. Water is
/// connected across sides, and land also across corners.
fn parts(keep: impl Fn(usize) -> bool, diagonal: bool) -> usize {
    let mut seen = vec![false; SIDE * SIDE];
    let mut count = 0;
    for start in 0..SIDE * SIDE {
        if seen[start] || !keep(start) {
            continue;
        }
        let (mut stack, mut size) = (vec![start], 0);
        seen[start] = true;
        while let Some(n) = stack.pop() {
            size += 1;
            let [x, y] = [n % SIDE, n / SIDE];
            for (dx, dy) in (-1..=1_i32).flat_map(|dx| (-1..=1_i32).map(move |dy| (dx, dy))) {
                let [x, y] = [x as i32 + dx, y as i32 + dy];
                let is_beside = diagonal || dx == 0 || dy == 0;
                if is_beside && (0..SIDE as i32).contains(&x) && (0..SIDE as i32).contains(&y) {
                    let other = y as usize * SIDE + x as usize;
                    if !seen[other] && keep(other) {
                        seen[other] = true;
                        stack.push(other);
                    }
                }
            }
        }
        count += usize::from(size > 12);
    }
    count
}

/// The radius of the first disc that parts the water, or that closes a way around an island.
fn first_parting(rings: &[Ring], most: f64) -> Option<f64> {
    let room = room(rings);
    let topology = |radius: f64| [parts(|n| room[n] > radius, false), parts(|n| room[n] <= radius, true)];
    let start = topology(0.0);
    let steps = (most / (0.5 * pixel())) as u32;
    let radius = |n: u32| f64::from(n) * 0.5 * pixel();
    (1..steps).map(radius).find(|&radius| {
        let [water, land] = topology(radius);
        water > start[0] || land < start[1]
    })
}

/// A sea of random shape with islands and with a bay that ends in a sharp corner.
fn sea(random: &mut fastrand::Rng) -> Option<Vec<Ring>> {
    let [phase, corner] = [(); 2].map(|()| TAU * random.f64());
    let outer = ring(DVec2::ZERO, 180, |angle| {
        let from_corner = (angle - corner + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        8.0 + 0.6 * (3.0 * angle + phase).sin() + 3.0 * (1.0 - from_corner.abs() / 0.1).max(0.0)
    });
    let mut rings = vec![outer];
    for n in 0..4 {
        let at =
            (2.0 + 3.5 * random.f64()) * DVec2::from_angle(TAU * (f64::from(n) + 0.5 * random.f64()) / 4.0);
        let (size, phase) = (0.8 + 1.2 * random.f64(), random.f64());
        let mut island = ring(at, 40, |angle| size * (1.0 + 0.25 * (2.0 * angle + phase).sin()));
        let is_free = island.iter().all(|&at| is_inside(at, &rings) && to_coast(at, &rings) > 4.0 * pixel());
        if is_free {
            island.reverse();
            rings.push(island);
        }
    }
    (rings.len() > 2).then_some(rings)
}

#[test]
fn the_narrowest_passage_is_where_erosion_parts_the_water_first() {
    let mut random = fastrand::Rng::with_seed(41);
    let (mut compared, mut corners) = (0, 0);
    for round in 0..40 {
        let Some(rings) = sea(&mut random) else { continue };
        let Some(radius) = first_parting(&rings, 3.0) else { continue };
        let domain = Domain::of_polygons(std::slice::from_ref(&rings)).unwrap();
        for least in [0.05, 0.5] {
            let straits = MedialBalls::of(&domain, &BoundaryMarks::default(), [least, 7.0]);
            let passage = straits.narrowest(&domain).unwrap();
            let [own, eroded] = [passage.width, 2.0 * radius];
            assert!((own - eroded).abs() < 3.0 * pixel(), "{own} for {eroded} in round {round}: {passage:?}");
            let [from, to] = passage.shores;
            assert!(
                (from.distance(to) - own).abs() < 1e-9 * own && to_coast(passage.center, &rings) > 0.49 * own
            );
            corners += usize::from(straits.discs()[0].width < 0.5 * own);
        }
        compared += 1;
    }
    assert!(compared > 15 && corners > 5, "{compared} seas, {corners} with narrower water in a corner");
}

/// The width of the narrowest passage of water that is turned, so that no side of it lies along the frame.
fn narrowest(rings: Vec<Ring>) -> Option<f64> {
    let turned = |ring: Ring| ring.into_iter().map(|at| DVec2::from_angle(0.3).rotate(at)).collect();
    let rings: Vec<Ring> = rings.into_iter().map(turned).collect();
    let domain = Domain::of_polygons(&[rings]).unwrap();
    let straits = MedialBalls::of(&domain, &BoundaryMarks::default(), [0.01, 3.0]);
    straits.narrowest(&domain).map(|passage| passage.width)
}

/// Two basins with a channel between them, and a dock that leads from the right one to nowhere.
fn basins(channel: f64, dock: f64) -> Ring {
    let [c, d] = [0.5 * channel, 0.5 * dock];
    let upper = [[6.0, c], [4.0, c], [4.0, 2.0], [0.0, 2.0]];
    let lower = [[0.0, -2.0], [4.0, -2.0], [4.0, -c], [6.0, -c], [6.0, -2.0], [10.0, -2.0]];
    let end = [[10.0, -d], [13.0, -d], [13.0, d], [10.0, d], [10.0, 2.0], [6.0, 2.0]];
    lower.into_iter().chain(end).chain(upper).map(DVec2::from).collect()
}

#[test]
fn corners_and_dead_ends_are_no_passages() {
    let width = narrowest(vec![basins(0.4, 0.1)]).unwrap();
    assert!((width - 0.4).abs() < 1e-6, "{width}");
    let width = narrowest(vec![basins(0.4, 1.9)]).unwrap();
    assert!((width - 0.4).abs() < 1e-6, "{width}");
    let wedge = vec![dvec2(0.0, 0.0), dvec2(9.0, -1.0), dvec2(9.0, 1.0)];
    assert_eq!(narrowest(vec![wedge]), None);
    let long = vec![dvec2(0.0, 0.0), dvec2(9.0, 0.0), dvec2(9.0, 1.0), dvec2(0.0, 1.0)];
    assert_eq!(narrowest(vec![long]), None, "a canal with two ends");
}

#[test]
fn a_ring_of_water_is_a_passage_around_its_island() {
    let water = vec![ring(DVec2::ZERO, 200, |_| 10.0), ring(DVec2::ZERO, 200, |_| 8.0)];
    let width = narrowest(water).unwrap();
    assert!((width - 2.0).abs() < 0.01, "{width}");
}

/// Two coasts that come together towards a side: land across it is a corner, and open water no passage,
/// since what is beyond is not known.
#[test]
fn coasts_that_meet_at_the_frame_are_no_passage() {
    let funnel = [[0.0, -0.05], [4.0, -2.0], [8.0, -2.0], [8.0, 2.0], [4.0, 2.0], [0.0, 0.05]];
    let funnel: Ring = funnel.into_iter().map(DVec2::from).collect();
    assert_eq!(narrowest(vec![funnel.clone()]), None, "land across the narrow end");
    let domain = Domain::of_polygons(&[vec![funnel]]).unwrap();
    let marks = BoundaryMarks {
        splits: vec![dvec2(0.0, -0.05), dvec2(0.0, 0.05)],
        types: vec![(dvec2(0.0, 0.0), BoundaryType::Open)],
        ..BoundaryMarks::default()
    };
    let straits = MedialBalls::of(&domain, &marks, [0.01, 3.0]);
    assert!(!straits.discs().is_empty());
    assert_eq!(straits.narrowest(&domain), None);
}
