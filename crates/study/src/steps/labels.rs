//! Finds room for labels: none covers another, and each is near its place.

/// A label that needs room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelSize {
    /// The place that it belongs to.
    pub at: [f64; 2],
    /// Its width and height.
    pub size: [f64; 2],
    /// The least distance of its rim from the place; 0 where it may cover the place.
    pub gap: f64,
}

/// A label stands in the middle of a triangle whose edges are at least this long: the triangle is still seen
/// around it.
const ROOMY: f64 = 48.0;
/// The distance of a label from a node or an edge.
const BESIDE_NODE: f64 = 5.0;
/// The distance of a label from the corners of a triangle.
const BESIDE_TRIANGLE: f64 = 7.0;

impl LabelSize {
    /// Returns a label of a node, an edge or a triangle with these corners: in the middle of a large
    /// triangle, and beside everything else.
    pub fn of(corners: &[[f64; 2]], size: [f64; 2]) -> Self {
        let at =
            [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / corners.len() as f64);
        let distance = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        let edges = (0..corners.len()).map(|i| distance(corners[i], corners[(i + 1) % corners.len()]));
        let shortest = edges.fold(f64::INFINITY, f64::min);
        let reach = corners.iter().map(|corner| distance(*corner, at)).fold(0.0, f64::max);
        let gap = match corners.len() {
            3 if shortest >= ROOMY => 0.0,
            3 => BESIDE_TRIANGLE + reach,
            _ => BESIDE_NODE,
        };
        Self { at, size, gap }
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

/// Returns the middle of each label, in an area from its lower to its upper corner. What comes first is
/// nearest to its place; a label for which there is no room covers its place.
pub fn placed(labels: &[LabelSize], area: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let dots = labels.iter().filter(|label| label.gap > 0.0);
    let mut taken: Vec<Extent> = dots.map(|label| Extent::around(label.at, [0.0; 2])).collect();
    let mut middles = Vec::with_capacity(labels.len());
    for label in labels {
        let fits = |middle: &[f64; 2]| {
            let extent = Extent::around(*middle, label.size);
            extent.is_within(area) && !taken.iter().any(|other| extent.overlaps(other))
        };
        let middle =
            candidates(label).find(fits).or_else(|| nearest_in(area, label, fits)).unwrap_or(label.at);
        taken.push(Extent::around(middle, label.size));
        middles.push(middle);
    }
    middles
}

/// Returns the places that a label may have, the best one first.
fn candidates(label: &LabelSize) -> impl Iterator<Item = [f64; 2]> {
    let LabelSize { at, size, gap } = *label;
    let on_place = (gap == 0.0).then_some(at);
    let around = DISTANCES.into_iter().flat_map(move |distance| {
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

    fn is_within(&self, [low, high]: [[f64; 2]; 2]) -> bool {
        (0..2).all(|axis| low[axis] <= self.low[axis] && self.high[axis] <= high[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: [[f64; 2]; 2] = [[0.0; 2], [400.0, 300.0]];

    #[test]
    fn labels_of_a_tiny_triangle_do_not_cover_each_other() {
        for corner in [[200.0, 150.0], [3.0, 3.0], [398.0, 299.0]] {
            let label = |number: usize| LabelSize {
                at: [0, 1].map(|axis| corner[axis] + 0.5 * (number % 2) as f64),
                size: [40.0 + 4.0 * number as f64, 16.0],
                gap: if number < 5 { 0.0 } else { 4.0 },
            };
            let labels: Vec<_> = (0..12).map(label).collect();
            let middles = placed(&labels, AREA);
            for (number, (middle, label)) in middles.iter().zip(&labels).enumerate() {
                let extent = Extent::around(*middle, label.size);
                assert!(extent.is_within(AREA), "{number} at {middle:?}");
                for (other, size) in middles[..number].iter().zip(&labels) {
                    assert!(!extent.overlaps(&Extent::around(*other, size.size)), "{number} at {middle:?}");
                }
            }
        }
    }

    #[test]
    fn the_label_of_a_small_triangle_is_beside_it_and_that_of_a_large_one_inside() {
        for (leg, is_inside) in [(10.0, false), (40.0, false), (60.0, true)] {
            let corners = [[100.0, 100.0], [100.0 + leg, 100.0], [100.0, 100.0 + leg]];
            let label = LabelSize::of(&corners, [40.0, 16.0]);
            let [x, y] = placed(&[label], AREA)[0];
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
        let label = LabelSize { at: [100.0, 70.0], size: [10.0; 2], gap: 0.0 };
        let far = |at: &[f64; 2]| libm::hypot(at[0] - 100.0, at[1] - 70.0);
        for reach in [0.0, 40.0, 90.0] {
            let found = nearest_in(AREA, &label, |at| far(at) >= reach).unwrap();
            assert!((reach..reach + 2.0 * GRID).contains(&far(&found)), "{reach}: {found:?}");
        }
        assert_eq!(nearest_in(AREA, &label, |_| false), None);
    }

    #[test]
    fn a_label_with_room_stays_at_its_place() {
        let of_triangle = LabelSize { at: [100.0, 100.0], size: [40.0, 16.0], gap: 0.0 };
        let of_node = LabelSize { at: [200.0, 100.0], gap: 5.0, ..of_triangle };
        let [first, second] = placed(&[of_triangle, of_node], AREA)[..] else { panic!() };
        assert_eq!(first, [100.0, 100.0]);
        assert!(second[0] > 200.0 && second[1] < 100.0, "to the upper right: {second:?}");
    }
}
