//! Random coasts with what is hard for a mesh: bays, spits, straits, islands and needles.

use std::f64::consts::TAU;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{Polygon, Ring};

/// Returns a point of the unit square.
pub fn place(random: &mut Rng) -> DVec2 {
    dvec2(random.f64(), random.f64())
}

/// Returns a closed line with bays and capes of all sizes.
fn coast(random: &mut Rng, centre: DVec2, radius: f64, corners: usize, roughness: f64) -> Ring {
    let waves: Vec<(f64, f64)> = (0..9).map(|_| (random.f64() - 0.5, random.f64() * TAU)).collect();
    (0..corners)
        .map(|k| {
            let angle = TAU * k as f64 / corners as f64;
            let wave = |(n, &(size, phase)): (usize, &(f64, f64))| {
                let frequency = (1 << n) as f64;
                size / frequency.powf(0.8) * (frequency * angle + phase).sin()
            };
            let waves: f64 = waves.iter().enumerate().map(wave).sum();
            let noise = 0.02 * (random.f64() - 0.5);
            centre + radius * (1.0 + roughness * (waves + noise)).max(0.1) * DVec2::from_angle(angle)
        })
        .collect()
}

/// Returns a triangle with its tip at `from` when it is a needle, or a bar between two points.
fn spit(random: &mut Rng, from: DVec2, to: DVec2) -> Ring {
    let width = 0.06 * 0.02f64.powf(random.f64());
    let across = width * (to - from).normalize().perp();
    if random.bool() {
        vec![from, to - across, to + across]
    } else {
        vec![from - across, to - across, to + across, from + across]
    }
}

/// Land with bays, spits, inlets, islands, rings that touch and needles; and the sea around it or the land.
pub fn random_coast(random: &mut Rng) -> Vec<Polygon> {
    let middle = DVec2::splat(0.5);
    let corners = random.usize(8..400);
    let roughness = random.f64();
    let mut polygons = vec![vec![coast(random, middle, 0.45, corners, roughness)]];
    for _ in 0..random.usize(0..6) {
        let (centre, radius) = (place(random), 0.2 * 0.02f64.powf(random.f64()));
        let corners = random.usize(3..40);
        let ring = coast(random, centre, radius, corners, 0.5);
        if random.bool() { polygons[0].push(ring) } else { polygons.push(vec![ring]) }
    }
    for _ in 0..random.usize(0..4) {
        let (from, to) = (place(random), middle + 0.3 * (place(random) - 0.5));
        let ring = spit(random, from, to);
        // Overlaps are inlets in a polygon of several rings, and spits in one of its own.
        if random.bool() { polygons[0].push(ring) } else { polygons.push(vec![ring]) }
    }
    if random.bool() {
        let at = polygons[0][0][random.usize(..8)];
        polygons[0].push(vec![at, at.lerp(middle, 0.3), at.lerp(middle, 0.3) + 0.1 * place(random)]);
    }
    let scale = dvec2(1.0 + random.f64(), 1.0 + random.f64()) * 10f64.powi(random.i32(-2..4));
    let shift = scale * 100.0 * (place(random) - 0.5) * f64::from(random.u8(0..2));
    for p in polygons.iter_mut().flatten().flatten() {
        *p = *p * scale + shift;
    }
    polygons
}
