//! Triangles whose corners all moved onto the outline, and nodes where the domain would touch itself.

use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, GRAIN};
use super::snap::OutlineSide;
use super::stencil::NodePlacement;

/// Leaves out flat triangles inside with all corners on the outline, if the domain stays in one piece without
/// them: triangles with two or three edges on the boundary, and triangles with one whose opposite corner is
/// not on the boundary. `limit` is the cotangent of the smallest angle that counts as not flat.
///
/// They are left out in rounds. No two triangles of a round have a common node, and each round starts from
/// the result of the previous one.
pub(super) fn drop_flat(band: &Band, placement: &mut NodePlacement, angles: &Angles, limit: f64) {
    let all_on = |&t: &u32| placement.keeps[t as usize] && placement.is_all_on(band, t);
    let is_flat = |&t: &u32| angles.worst(placement.points(band.triangles.corners[t as usize])) > limit;
    let all = (0..band.triangles.len() as u32).into_par_iter().with_min_len(GRAIN);
    let mut flat: Vec<u32> = all.filter(all_on).filter(is_flat).collect();
    let mut lowest = vec![u32::MAX; band.points.len()];
    loop {
        let droppable: Vec<u32> =
            flat.iter().copied().filter(|&t| is_droppable(band, placement, t)).collect();
        let corners = |t: u32| band.triangles.corners[t as usize].map(|v| v as usize);
        for &v in droppable.iter().flat_map(|&t| &band.triangles.corners[t as usize]) {
            placement.acted[v as usize] = true;
        }
        for &t in droppable.iter().rev() {
            corners(t).into_iter().for_each(|v| lowest[v] = t);
        }
        let first: Vec<u32> =
            droppable.iter().copied().filter(|&t| corners(t).iter().all(|&v| lowest[v] == t)).collect();
        for &t in &droppable {
            corners(t).into_iter().for_each(|v| lowest[v] = u32::MAX);
        }
        if first.is_empty() {
            return;
        }
        first.iter().for_each(|&t| placement.keeps[t as usize] = false);
        flat.retain(|t| !first.contains(t));
    }
}

fn is_droppable(band: &Band, placement: &NodePlacement, triangle: u32) -> bool {
    let boundary = boundary_edges(band, placement, triangle, true);
    match boundary.iter().filter(|&&is| is).count() {
        0 => false,
        1 => {
            let opposite = boundary.iter().position(|&is| is).expect("counted");
            let node = band.triangles.corners[triangle as usize][opposite];
            !has_sector(band, placement, node, false)
        }
        _ => true,
    }
}

/// Returns, for each corner of a triangle with all corners on the outline, whether the opposite edge is on
/// the boundary. `inside` is the class of the triangle.
pub(super) fn boundary_edges(
    band: &Band,
    placement: &NodePlacement,
    triangle: u32,
    inside: bool,
) -> [bool; 3] {
    [0, 1, 2].map(|i| {
        let [_, from, to] = band.triangles.starting_at(triangle, i);
        let across = band.triangles.across[triangle as usize][i];
        placement.is_inside_across(band, across, [from, to]) != inside
    })
}

/// Returns whether a node on the outline has a triangle of a class around it. The area beyond the frame is
/// outside.
pub(super) fn has_sector(band: &Band, placement: &NodePlacement, node: u32, inside: bool) -> bool {
    let mut star = Vec::new();
    sectors(band, placement, node, &mut star).contains(&inside)
}

/// Returns the classes of the triangles around a node on the outline, anticlockwise, with the class outside
/// at the end if the triangles do not close around the node. Overwrites `star`.
fn sectors(band: &Band, placement: &NodePlacement, node: u32, star: &mut Vec<(u32, usize)>) -> Vec<bool> {
    band.triangles.star(node, star);
    let mut sectors = Vec::with_capacity(star.len() + 2);
    for &(t, i) in star.iter() {
        let [_, a, b] = band.starting_at(t, i, &placement.sides);
        match (a, b) {
            (OutlineSide::On, OutlineSide::On) => sectors.push(placement.keeps[t as usize]),
            (OutlineSide::On, side) => sectors.push(side == OutlineSide::Inside),
            (a, OutlineSide::On) => sectors.push(a == OutlineSide::Inside),
            (a, b) => sectors.extend([a == OutlineSide::Inside, b == OutlineSide::Inside]),
        }
    }
    let (first, last) = (star[0], star[star.len() - 1]);
    let [_, right, _] = band.triangles.starting_at(first.0, first.1);
    let [_, _, left] = band.triangles.starting_at(last.0, last.1);
    if right != left {
        sectors.push(false);
    }
    sectors
}

/// Returns the nodes on the outline where the domain would touch itself: more than one fan of triangles
/// inside meets there.
pub(super) fn pinched(band: &Band, placement: &NodePlacement) -> Vec<u32> {
    let all = (0..band.points.len() as u32).into_par_iter().with_min_len(GRAIN);
    let pinched = all.map_init(Vec::new, |star, v| {
        if placement.sides[v as usize] != OutlineSide::On {
            return (v, false);
        }
        let sectors = sectors(band, placement, v, star);
        let changes = (0..sectors.len()).filter(|&k| sectors[k] != sectors[(k + 1) % sectors.len()]);
        (v, changes.count() > 2)
    });
    pinched.filter(|(_, is_pinched)| *is_pinched).map(|(v, _)| v).collect()
}
