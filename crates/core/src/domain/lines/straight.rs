//! Leaves out the corners of a line that lie on a straight part of it.
//!
//! Every corner of a line becomes a node, and a mesh cannot have more nodes than its triangles resolve. A
//! line that a program has divided into short pieces needs no node at most of its corners.
//!
//! Those within one lattice step of a straight part are left out, so that the line stays where it is as far
//! as the mesh can tell. A closed line begins at a place that does not depend on its order of corners. So the
//! result is the same in both directions.

use glam::DVec2;

use super::{Line, LineKind};
use crate::geometry::{Lattice, corners_that_stay};

/// The largest distance of a corner that is left out from the straight part, in lattice steps.
const TOLERANCE: f64 = 1.0;

/// Returns a line without the corners that lie on straight parts of it, within a lattice step.
pub(super) fn without_straight_corners(line: &Line, lattice: &Lattice) -> Line {
    let in_steps: Vec<DVec2> = line.points.iter().map(|&p| p / lattice.step()).collect();
    let stays = match line.closed && in_steps.len() > 2 && in_steps.iter().all(|p| p.is_finite()) {
        true => corners_of_ring(&in_steps),
        // A corner that is not a finite number ends a part.
        false => in_steps.chunk_by(|a, b| a.is_finite() && b.is_finite()).flat_map(corners_of_part).collect(),
    };
    let points = line.points.iter().zip(stays).filter_map(|(&p, stays)| stays.then_some(p)).collect();
    Line { name: line.name.clone(), points, closed: line.closed, kind: LineKind::default() }
}

fn corners_of_part(points: &[DVec2]) -> Vec<bool> {
    corners_that_stay(points, TOLERANCE, |_| true)
}

/// A ring begins at its lowest corner, and is divided at the ones that are farthest from it.
fn corners_of_ring(points: &[DVec2]) -> Vec<bool> {
    let lowest = points.iter().copied().min_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let lowest = lowest.expect("a ring has corners");
    let begin = points.iter().position(|&p| p == lowest).expect("it is one of them");
    let around: Vec<DVec2> = (0..=points.len()).map(|n| points[(begin + n) % points.len()]).collect();
    let mut stays = corners_of_part(&around);
    stays.pop();
    stays.rotate_right(begin);
    stays
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::dvec2;

    use super::*;
    use crate::geometry::{Rect, nearest_on_segment};

    fn lattice() -> Lattice {
        Lattice::covering(Rect::new(DVec2::ZERO, DVec2::ONE), 0.25, 1000).unwrap()
    }

    fn line(points: Vec<DVec2>, closed: bool) -> Line {
        Line { name: String::new(), points, closed, kind: LineKind::default() }
    }

    fn divided(points: &[DVec2], random: &mut fastrand::Rng) -> Vec<DVec2> {
        let mut all = vec![points[0]];
        for ends in points.windows(2) {
            let mut shares: Vec<f64> = (0..random.usize(..40)).map(|_| random.f64()).collect();
            shares.sort_by(f64::total_cmp);
            all.extend(shares.into_iter().map(|share| ends[0].lerp(ends[1], share)));
            all.push(ends[1]);
        }
        all
    }

    #[test]
    fn corners_on_straight_parts_are_left_out_in_both_directions() {
        let mut random = fastrand::Rng::with_seed(11);
        for _ in 0..300 {
            let corners: Vec<DVec2> =
                (0..random.usize(2..7)).map(|_| dvec2(random.f64(), random.f64())).collect();
            let many = divided(&corners, &mut random);
            assert_eq!(without_straight_corners(&line(many.clone(), false), &lattice()).points, corners);
            let ring = |points: &[DVec2]| {
                let closed: Vec<DVec2> = points.iter().chain([&points[0]]).copied().collect();
                let mut many = divided(&closed, &mut fastrand::Rng::with_seed(5));
                many.pop();
                many
            };
            let mut many = ring(&corners);
            let begin = random.usize(..many.len());
            many.rotate_left(begin);
            if corners.len() > 2 {
                let mut kept = without_straight_corners(&line(many.clone(), true), &lattice()).points;
                many.reverse();
                let mut backwards = without_straight_corners(&line(many, true), &lattice()).points;
                let mut wanted = corners;
                for all in [&mut kept, &mut backwards, &mut wanted] {
                    all.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
                }
                assert_eq!(kept, wanted);
                assert_eq!(backwards, wanted);
            }
        }
    }

    #[test]
    fn curves_keep_their_corners_and_stay_where_they_are() {
        let lattice = lattice();
        let circle: Vec<DVec2> =
            (0..200_000).map(|n| 0.5 + 0.4 * DVec2::from_angle(TAU * f64::from(n) / 200_000.0)).collect();
        let kept = without_straight_corners(&line(circle.clone(), true), &lattice).points;
        assert!((10_000..100_000).contains(&kept.len()), "{} corners", kept.len());
        let coarse = kept.iter().chain([&kept[0]]).copied().collect::<Vec<_>>();
        let mut at = 0;
        for p in circle.iter().skip(circle.iter().position(|p| *p == kept[0]).unwrap()) {
            let far = |at: usize| p.distance(nearest_on_segment(*p, [coarse[at], coarse[at + 1]]));
            if *p == coarse[at + 1] {
                at += 1;
            }
            assert!(at + 1 >= coarse.len() || far(at) <= 1.01 * lattice.step().max_element());
        }
    }

    #[test]
    fn there_and_back_is_kept_and_a_spiral_takes_little_time() {
        let back = vec![dvec2(0.1, 0.1), dvec2(0.9, 0.1), dvec2(0.5, 0.1)];
        assert_eq!(without_straight_corners(&line(back.clone(), false), &lattice()).points, back);
        let hole =
            vec![dvec2(0.1, 0.1), dvec2(f64::NAN, 0.1), dvec2(0.5, 0.1), dvec2(0.6, 0.1), dvec2(0.7, 0.1)];
        assert_eq!(without_straight_corners(&line(hole, false), &lattice()).points.len(), 4);
        let spiral = (0..1_000_000).map(|n| 0.5 + 0.4 * DVec2::from_angle(f64::from(n)) / f64::from(n + 1));
        let kept = without_straight_corners(&line(spiral.collect(), false), &lattice()).points;
        assert!(kept.len() > 1000);
        let same = vec![dvec2(0.5, 0.5); 1000];
        assert_eq!(without_straight_corners(&line(same.clone(), true), &lattice()).points.len(), 1);
        assert_eq!(without_straight_corners(&line(same, false), &lattice()).points.len(), 2);
    }
}
