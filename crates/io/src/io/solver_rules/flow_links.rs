//! Rules on flow links, from the centre of one cell to that of the next.
//!
//! A cell has its water level at its circumcentre, where that lies in it; otherwise at the place where the
//! line from the middle of the cell to the circumcentre leaves it, as MeshKernel has it. In an acute pair a
//! link is d/2 (cot α + cot β) long, with the common edge d and the angles across from it: 0 where all four
//! nodes lie on one circle.

use glam::{DVec2, dvec2};

use super::written_mesh::InnerEdge;
use super::{BrokenPlace, WrittenMesh};
use meshbrush_mesh::text::{LengthUnit, digits, fixed};

/// Links shorter than this share of the size of the cells are removed: 0.9 `removesmalllinkstrsh`.
const LEAST_SHARE: f64 = 0.9 * 0.1;
/// The largest cosine of the angle between a link and the edge that it crosses, `cosphiutrsh`.
const LARGEST_COSINE: f64 = 0.5;
/// Metres in a degree along a meridian.
const METRES_IN_DEGREE: f64 = 111_195.0;

/// A link across an edge.
struct FlowLink {
    /// Its length; with degrees in metres.
    length: f64,
    /// Half the sum of the roots of both areas.
    size: f64,
    /// The cosine of its angle with the edge, from 0 to 1.
    cosine: f64,
}

impl FlowLink {
    fn new(mesh: &WrittenMesh, edge: &InnerEdge) -> Self {
        let [from, to] = edge.ends.map(|node| mesh.nodes[node]);
        let scale = scale(mesh.unit, 0.5 * (from.y + to.y));
        let cells = edge.triangles.map(|triangle| mesh.corners(triangle).map(|p| scale * (p - from)));
        let (along, [first, second]) = (scale * (to - from), cells.map(centre));
        let link = second - first;
        let length = link.length();
        let cosine = if length > 0.0 { link.dot(along).abs() / (length * along.length()) } else { 0.0 };
        let size = 0.5 * cells.map(|cell| doubled_area(cell).abs() / 2.0).map(f64::sqrt).iter().sum::<f64>();
        Self { length, size, cosine }
    }

    fn is_short(&self) -> bool {
        self.length < LEAST_SHARE * self.size
    }
}

/// Returns what coordinates are multiplied by to be lengths around a latitude.
fn scale(unit: LengthUnit, latitude: f64) -> DVec2 {
    match unit {
        LengthUnit::Degree => METRES_IN_DEGREE * dvec2(libm::cos(latitude.to_radians()), 1.0),
        _ => DVec2::ONE,
    }
}

fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns where a cell has its water level.
fn centre(cell: [DVec2; 3]) -> DVec2 {
    let [a, b, c] = cell;
    let (u, v, area) = (b - a, c - a, doubled_area(cell));
    let middle = (a + b + c) / 3.0;
    if area == 0.0 {
        return middle;
    }
    let circumcentre = a + dvec2(
        v.y * u.length_squared() - u.y * v.length_squared(),
        u.x * v.length_squared() - v.x * u.length_squared(),
    ) / (2.0 * area);
    let share = [[a, b], [b, c], [c, a]].iter().fold(1.0, |share: f64, [from, to]| {
        let left = |p: DVec2| (*to - *from).perp_dot(p - *from) / area;
        let (of_middle, of_circumcentre) = (left(middle), left(circumcentre));
        if of_circumcentre < 0.0 { share.min(of_middle / (of_middle - of_circumcentre)) } else { share }
    });
    middle + share * (circumcentre - middle)
}

/// Finds links that the solver removes, so that no water crosses them.
pub(super) fn short(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    find(mesh, |link| {
        link.is_short().then(|| {
            let (length, least) = (digits(link.length, 3), digits(LEAST_SHARE * link.size, 3));
            format!(
                "The centres of two cells are {length} apart, and links of less than {least} are removed."
            )
        })
    })
}

/// Finds links that do not cross their edge at a right angle, by far.
pub(super) fn skewed(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    find(mesh, |link| {
        (!link.is_short() && link.cosine > LARGEST_COSINE).then(|| {
            let cosine = fixed(link.cosine, 2);
            format!("A link crosses its edge with the cosine {cosine}, and {LARGEST_COSINE} is the largest.")
        })
    })
}

/// Finds links, at the middles of the edges that they cross.
fn find(mesh: &WrittenMesh, sentence: impl Fn(&FlowLink) -> Option<String>) -> Vec<BrokenPlace> {
    let found = |edge: &InnerEdge| {
        let place = edge.ends.map(|node| mesh.nodes[node]).iter().sum::<DVec2>() / 2.0;
        Some(BrokenPlace { place, sentence: sentence(&FlowLink::new(mesh, edge))? })
    };
    mesh.inner().iter().filter_map(found).collect()
}
