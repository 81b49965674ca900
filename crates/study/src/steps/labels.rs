//! Finds room for labels: none covers another, and each is near its place or yields.

/// A label that needs room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelSize {
    /// The place that it belongs to.
    pub at: [f64; 2],
    /// Its width and height.
    pub size: [f64; 2],
    /// The least distance of its rim from the place; 0 where it may cover the place.
    pub gap: f64,
    /// How much farther its rim may be from the place. Where there is no room up to there, it is left out.
    /// 0 if it does not move, infinite if any place will do.
    pub reach: f64,
}

/// What labels are placed among.
#[derive(Clone, Copy, Debug)]
pub struct LabelRoom<'a> {
    /// The lower and the upper corner of the area that they stay in.
    pub area: [[f64; 2]; 2],
    /// Lower and upper corners of what they must not cover.
    pub obstacles: &'a [[[f64; 2]; 2]],
    /// Triangles that they cover only where there is no other room, or if the label is that of the triangle
    /// and stands within it.
    pub avoided: &'a [[[f64; 2]; 3]],
}

/// Triangles of a step that its labels avoid: the steps on an outline change more than anybody looks at.
pub const MOST_AVOIDED: usize = 40;
/// A label stands in the middle of a triangle whose edges are at least this long, and of whose area it takes
/// at most this share: the triangle is still seen around it.
const ROOMY: f64 = 48.0;
const MOST_OF_TRIANGLE: f64 = 0.4;
/// The distance of a label from a node or an edge.
const BESIDE_NODE: f64 = 5.0;
/// The distance of a label from the corners of a triangle.
const BESIDE_TRIANGLE: f64 = 7.0;
/// A label whose rim is this far from its place has a line to it.
const LEADER_FROM: f64 = 6.0;

impl LabelSize {
    /// Returns a label of a node, an edge or a triangle with these corners: in the middle of a large
    /// triangle, and beside everything else. It moves as far as it must.
    pub fn of(corners: &[[f64; 2]], size: [f64; 2]) -> Self {
        let at =
            [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / corners.len() as f64);
        let distance = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        let edges = (0..corners.len()).map(|i| distance(corners[i], corners[(i + 1) % corners.len()]));
        let shortest = edges.fold(f64::INFINITY, f64::min);
        let reach = corners.iter().map(|corner| distance(*corner, at)).fold(0.0, f64::max);
        let gap = match corners {
            &[a, b, c] => {
                let area = 0.5 * cross(a, b, c).abs();
                let has_room = shortest >= ROOMY && size[0] * size[1] <= MOST_OF_TRIANGLE * area;
                if has_room { 0.0 } else { BESIDE_TRIANGLE + reach }
            }
            _ => BESIDE_NODE,
        };
        Self { at, size, gap, reach: f64::INFINITY }
    }

    /// Returns a number at a place, which does not move.
    pub fn fixed(at: [f64; 2], size: [f64; 2]) -> Self {
        Self { at, size, gap: 0.0, reach: 0.0 }
    }

    /// Returns a number beside a node.
    pub fn beside(at: [f64; 2], size: [f64; 2]) -> Self {
        Self { at, size, gap: BESIDE_NODE, reach: 0.0 }
    }

    /// Returns the end of the line from its place to a label with this middle; `None` where it is so near
    /// that it needs none.
    pub fn leader(&self, middle: [f64; 2]) -> Option<[f64; 2]> {
        let end = [0, 1].map(|axis| {
            let half = 0.5 * self.size[axis];
            self.at[axis].clamp(middle[axis] - half, middle[axis] + half)
        });
        let distance = libm::hypot(end[0] - self.at[0], end[1] - self.at[1]);
        (distance > LEADER_FROM).then_some(end)
    }
}

/// Distances of the rims of labels from their places.
const DISTANCES: [f64; 10] = [0.0, 8.0, 16.0, 26.0, 38.0, 52.0, 70.0, 92.0, 120.0, 160.0];
/// Directions that are tried at each distance.
const DIRECTIONS: usize = 16;
/// Distance of the places that are tried where there is no room in any direction.
const GRID: f64 = 6.0;
/// Free space between two labels, and around the places of labels that may not be covered.
const MARGIN: f64 = 2.0;

/// Returns the middle of each label; `None` for one that is left out, because there is no room for it. What
/// comes first is nearest to its place. Labels cover neither each other nor an obstacle, nor the places of
/// those that stand beside them, and are within the area. Numbers do not stand on the lines of other labels.
pub fn placed(labels: &[LabelSize], room: &LabelRoom<'_>) -> Vec<Option<[f64; 2]>> {
    let dots = labels.iter().filter(|label| label.gap > 0.0);
    let mut taken: Vec<Extent> = dots.map(|label| Extent::around(label.at, [0.0; 2])).collect();
    taken.extend(room.obstacles.iter().map(|&[low, high]| Extent { low, high }));
    let (mut middles, mut leaders) = (Vec::with_capacity(labels.len()), Vec::new());
    for label in labels {
        let is_crossed = |extent: &Extent| leaders.iter().any(|leader| extent.is_crossed_by(leader));
        let fits = |middle: &[f64; 2]| {
            let extent = Extent::around(*middle, label.size);
            extent.is_within(room.area)
                && !taken.iter().any(|other| extent.overlaps(other))
                && (label.reach.is_infinite() || !is_crossed(&extent))
        };
        let is_polite = |middle: &[f64; 2]| {
            let stays = label.gap == 0.0 && *middle == label.at;
            let extent = Extent::around(*middle, label.size);
            let covers = room.avoided.iter().any(|triangle| extent.meets(triangle));
            (stays || !covers) && !is_crossed(&extent)
        };
        let middle = candidates(label)
            .find(|middle| is_polite(middle) && fits(middle))
            .or_else(|| candidates(label).find(fits))
            .or_else(|| label.reach.is_infinite().then(|| nearest_in(room.area, label, fits)).flatten());
        taken.extend(middle.map(|middle| Extent::around(middle, label.size)));
        leaders.extend(middle.and_then(|middle| Some([label.at, label.leader(middle)?])));
        middles.push(middle);
    }
    middles
}

/// Returns the places that a label may have, the best one first.
fn candidates(label: &LabelSize) -> impl Iterator<Item = [f64; 2]> {
    let LabelSize { at, size, gap, reach } = *label;
    let on_place = (gap == 0.0).then_some(at);
    let moves = gap > 0.0 || reach > 0.0;
    let distances = DISTANCES.into_iter().filter(move |&distance| moves && distance <= reach);
    let around = distances.flat_map(move |distance| {
        (0..DIRECTIONS).map(move |number| {
            // To the upper right first, as on maps.
            let turn = (number as f64 + 2.0) / DIRECTIONS as f64;
            let (sin, cos) =
                (libm::sin(std::f64::consts::TAU * turn), libm::cos(std::f64::consts::TAU * turn));
            let away = |part: f64, size: f64| part * (gap + distance + 0.5 * size);
            [at[0] + away(cos, size[0]), at[1] - away(sin, size[1])]
        })
    });
    on_place.into_iter().chain(around)
}

/// Returns the nearest middle of a coarse grid that fits: for crowds at a rim of the area.
fn nearest_in(
    [low, high]: [[f64; 2]; 2],
    label: &LabelSize,
    fits: impl Fn(&[f64; 2]) -> bool,
) -> Option<[f64; 2]> {
    let along = |axis: usize| {
        let places = ((high[axis] - low[axis]) / GRID).max(0.0) as usize;
        (0..=places).map(move |place| low[axis] + GRID * place as f64)
    };
    let all = along(0).flat_map(|x| along(1).map(move |y| [x, y]));
    let distance = |middle: &[f64; 2]| libm::hypot(middle[0] - label.at[0], middle[1] - label.at[1]);
    all.filter(fits).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// A rectangle, with the free space around a label.
struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    fn around(middle: [f64; 2], size: [f64; 2]) -> Self {
        let end = |sign: f64| [0, 1].map(|axis| middle[axis] + sign * (0.5 * size[axis] + MARGIN));
        Self { low: end(-1.0), high: end(1.0) }
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
    }

    /// Returns whether it covers a part of a triangle: no side of either has all of the other beyond it.
    fn meets(&self, triangle: &[[f64; 2]; 3]) -> bool {
        let [low, high] = [self.low, self.high];
        let is_beside = (0..2).any(|axis| {
            triangle.iter().all(|corner| corner[axis] <= low[axis])
                || triangle.iter().all(|corner| corner[axis] >= high[axis])
        });
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let inner = cross(triangle[0], triangle[1], triangle[2]);
        let is_cut_off = (0..3).any(|i| {
            let [from, to] = [triangle[i], triangle[(i + 1) % 3]];
            corners.iter().all(|corner| cross(from, to, *corner) * inner <= 0.0)
        });
        !is_beside && !is_cut_off
    }

    /// Returns whether a line passes through it.
    fn is_crossed_by(&self, [from, to]: &[[f64; 2]; 2]) -> bool {
        let [low, high] = [self.low, self.high];
        let is_beside = (0..2)
            .any(|axis| from[axis].max(to[axis]) <= low[axis] || from[axis].min(to[axis]) >= high[axis]);
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let sides = corners.map(|corner| cross(*from, *to, corner));
        let is_on_one_side = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
        !is_beside && !is_on_one_side
    }

    fn is_within(&self, [low, high]: [[f64; 2]; 2]) -> bool {
        (0..2).all(|axis| low[axis] <= self.low[axis] && self.high[axis] <= high[axis])
    }
}

/// Returns twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: [[f64; 2]; 2] = [[0.0; 2], [400.0, 300.0]];

    fn room() -> LabelRoom<'static> {
        LabelRoom { area: AREA, obstacles: &[], avoided: &[] }
    }

    /// Left, top, right and bottom of a drawn label, without free space.
    fn sides([x, y]: [f64; 2], [width, height]: [f64; 2]) -> [f64; 4] {
        [x - 0.5 * width, y - 0.5 * height, x + 0.5 * width, y + 0.5 * height]
    }

    fn cover(a: [f64; 4], b: [f64; 4]) -> bool {
        a[0].max(b[0]) < a[2].min(b[2]) && a[1].max(b[1]) < a[3].min(b[3])
    }

    #[test]
    fn no_two_labels_overlap_and_none_is_off_the_area_wherever_their_places_are() {
        let mut random = fastrand::Rng::with_seed(7);
        let [mut left_out, mut with_line] = [0, 0];
        for case in 0..40 {
            let spread = [30.0, 150.0, 600.0][case % 3];
            let labels: Vec<LabelSize> = (0..150)
                .map(|number| {
                    let at = [200.0, 150.0].map(|middle| middle + spread * (random.f64() - 0.5));
                    let size = [8.0 + 60.0 * random.f64(), 8.0 + 12.0 * random.f64()];
                    match number % 4 {
                        0 => LabelSize { at, size, gap: 5.0, reach: f64::INFINITY },
                        1 => LabelSize { at, size, gap: 0.0, reach: 40.0 },
                        2 => LabelSize::fixed(at, size),
                        _ => LabelSize::beside(at, size),
                    }
                })
                .collect();
            let obstacles = [[[250.0, 0.0], [400.0, 60.0]], [[0.0, 280.0], [120.0, 300.0]]];
            let triangle = [[180.0, 130.0], [230.0, 140.0], [190.0, 190.0]];
            let room = LabelRoom { area: AREA, obstacles: &obstacles, avoided: &[triangle] };
            let middles = placed(&labels, &room);
            assert_eq!(middles.len(), labels.len());
            let drawn: Vec<[f64; 4]> = middles
                .iter()
                .zip(&labels)
                .filter_map(|(middle, label)| middle.map(|middle| sides(middle, label.size)))
                .collect();
            for (number, one) in drawn.iter().enumerate() {
                assert!(one[0] >= 0.0 && one[1] >= 0.0 && one[2] <= 400.0 && one[3] <= 300.0, "{one:?}");
                for [low, high] in obstacles {
                    assert!(!cover(*one, [low[0], low[1], high[0], high[1]]), "{one:?} and an obstacle");
                }
                for other in &drawn[..number] {
                    assert!(!cover(*one, *other), "case {case}: {one:?} and {other:?}");
                }
            }
            left_out += labels.len() - drawn.len();
            let leaders = middles.iter().zip(&labels).filter_map(|(middle, label)| label.leader((*middle)?));
            with_line += leaders.count();
        }
        assert!(left_out > 100 && with_line > 100, "{left_out} left out, {with_line} with a line");
    }

    #[test]
    fn labels_of_a_tiny_triangle_find_room_and_do_not_cover_each_other() {
        for corner in [[200.0, 150.0], [3.0, 3.0], [398.0, 299.0]] {
            let label = |number: usize| LabelSize {
                at: [0, 1].map(|axis| corner[axis] + 0.5 * (number % 2) as f64),
                size: [40.0 + 4.0 * number as f64, 16.0],
                gap: if number < 5 { 0.0 } else { 4.0 },
                reach: f64::INFINITY,
            };
            let labels: Vec<_> = (0..12).map(label).collect();
            assert!(placed(&labels, &room()).iter().all(Option::is_some), "{corner:?}");
        }
    }

    #[test]
    fn names_of_corners_are_beside_the_triangle_while_there_is_room() {
        let triangle = [[180.0, 120.0], [220.0, 120.0], [180.0, 160.0]];
        let labels = triangle.map(|corner| LabelSize::of(&[corner], [50.0, 18.0]));
        let avoided = [triangle];
        let middles = placed(&labels, &LabelRoom { avoided: &avoided, ..room() });
        for (middle, label) in middles.iter().zip(&labels) {
            let [left, top, right, bottom] = sides(middle.unwrap(), label.size);
            // No point of a fine grid of the triangle is in the label.
            for i in 0..=40 {
                for j in 0..=40 - i {
                    let [x, y] = [180.0 + f64::from(i), 120.0 + f64::from(j)];
                    assert!(!(left < x && x < right && top < y && y < bottom), "{middle:?} covers {x}, {y}");
                }
            }
        }
        // Where the triangle takes all the room, they are within it.
        let everything = [[[-900.0, -900.0], [1800.0, -900.0], [-900.0, 1800.0]]];
        let middles = placed(&labels, &LabelRoom { avoided: &everything, ..room() });
        assert!(middles.iter().all(Option::is_some));
    }

    #[test]
    fn a_number_that_does_not_move_yields() {
        let [first, second] = [100.0, 110.0].map(|x| LabelSize::fixed([x, 100.0], [20.0, 12.0]));
        assert_eq!(placed(&[first, second], &room()), [Some([100.0, 100.0]), None]);
        let obstacle = [[[95.0, 95.0], [96.0, 96.0]]];
        assert_eq!(placed(&[first], &LabelRoom { obstacles: &obstacle, ..room() }), [None]);
        assert_eq!(placed(&[LabelSize::fixed([1.0, 1.0], [20.0, 12.0])], &room()), [None]);
    }

    #[test]
    fn no_number_stands_on_the_line_of_a_name() {
        let names = (0..4).map(|number| LabelSize {
            at: [100.0 + f64::from(number), 100.0],
            size: [60.0, 18.0],
            gap: 40.0,
            reach: f64::INFINITY,
        });
        let numbers = (0..150).map(|number| {
            let (x, y) = (f64::from(number % 15), f64::from(number / 15));
            LabelSize::fixed([30.0 + 10.0 * x, 50.0 + 10.0 * y], [7.0, 7.0])
        });
        let labels: Vec<LabelSize> = names.chain(numbers).collect();
        let middles = placed(&labels, &room());
        let (mut lines, mut shown) = (0, 0);
        for (name, middle) in labels[..4].iter().zip(&middles) {
            let Some(end) = name.leader(middle.unwrap()) else { continue };
            lines += 1;
            for (number, middle) in labels[4..].iter().zip(&middles[4..]) {
                let Some(middle) = middle else { continue };
                shown += 1;
                let [left, top, right, bottom] = sides(*middle, number.size);
                for part in 0..=200 {
                    let share = f64::from(part) / 200.0;
                    let [x, y] = [0, 1].map(|axis| name.at[axis] + share * (end[axis] - name.at[axis]));
                    assert!(!(left < x && x < right && top < y && y < bottom), "{middle:?} on a line");
                }
            }
        }
        assert!(lines == 4 && shown > 40, "{lines} {shown}");
    }

    #[test]
    fn a_label_far_from_its_place_has_a_line_to_its_rim() {
        let label = LabelSize::fixed([100.0, 100.0], [20.0, 10.0]);
        assert_eq!(label.leader([100.0, 100.0]), None);
        assert_eq!(label.leader([115.0, 100.0]), None, "5 beside it");
        assert_eq!(label.leader([140.0, 100.0]), Some([130.0, 100.0]));
        assert_eq!(label.leader([100.0, 60.0]), Some([100.0, 65.0]));
    }

    #[test]
    fn the_label_of_a_small_triangle_is_beside_it_and_that_of_a_large_one_inside() {
        for (leg, is_inside) in [(10.0, false), (40.0, false), (60.0, true)] {
            let corners = [[100.0, 100.0], [100.0 + leg, 100.0], [100.0, 100.0 + leg]];
            let label = LabelSize::of(&corners, [30.0, 16.0]);
            let [x, y] = placed(&[label], &room())[0].unwrap();
            let extent = Extent::around([x, y], label.size);
            let covers = |corner: &[f64; 2]| extent.overlaps(&Extent::around(*corner, [0.0; 2]));
            assert_eq!([x, y] == label.at, is_inside, "{leg}");
            assert!(is_inside || !corners.iter().any(covers), "{leg}: {x}, {y}");
        }
    }

    #[test]
    fn an_extent_is_within_an_area_if_it_passes_no_side() {
        let extent = Extent { low: [10.0, 20.0], high: [30.0, 40.0] };
        assert!(extent.is_within([[10.0, 20.0], [30.0, 40.0]]));
        for axis in 0..2 {
            for shift in [-1.0, 1.0] {
                let mut area = [[10.0, 20.0], [30.0, 40.0]];
                area.iter_mut().for_each(|end| end[axis] += shift);
                assert!(!extent.is_within(area), "{axis} {shift}");
            }
        }
    }

    #[test]
    fn the_nearest_place_of_the_grid_that_fits_is_taken() {
        let label = LabelSize { at: [100.0, 70.0], size: [10.0; 2], gap: 0.0, reach: f64::INFINITY };
        let far = |at: &[f64; 2]| libm::hypot(at[0] - 100.0, at[1] - 70.0);
        for reach in [0.0, 40.0, 90.0] {
            let found = nearest_in(AREA, &label, |at| far(at) >= reach).unwrap();
            assert!((reach..reach + 2.0 * GRID).contains(&far(&found)), "{reach}: {found:?}");
        }
        assert_eq!(nearest_in(AREA, &label, |_| false), None);
    }

    #[test]
    fn a_label_with_room_stays_at_its_place() {
        let of_triangle = LabelSize { at: [100.0, 100.0], size: [40.0, 16.0], gap: 0.0, reach: 8.0 };
        let of_node = LabelSize { at: [200.0, 100.0], gap: 5.0, ..of_triangle };
        let [Some(first), Some(second)] = placed(&[of_triangle, of_node], &room())[..] else { panic!() };
        assert_eq!(first, [100.0, 100.0]);
        assert!(second[0] > 200.0 && second[1] < 100.0, "to the upper right: {second:?}");
    }
}
