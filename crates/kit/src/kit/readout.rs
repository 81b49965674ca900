//! The values at a point that the inspector shows.

use glam::DVec2;

use super::session::Session;
use meshbrush_core::document::{Document, Follower};
use meshbrush_core::earth::EarthPlane;
use meshbrush_core::layers::Decision;
use meshbrush_mesh::mesh::{
    Location, MeshView, Neighbour, NodeId, Orientation, TriangleId, barycentric, interpolate,
};

/// A quantity known at every point, and interpolated from the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// h̄, in world units.
    TargetDiameter,
    /// Risk, 0 to 1: painted or that of the base, whichever is higher.
    Risk,
}

/// Everything about one point and the triangle around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Readout {
    /// The point in world units.
    pub point: DVec2,
    /// The location of the point in the mesh.
    pub location: Location,
    /// The triangle around it, if any.
    pub triangle: Option<TriangleReadout>,
    /// The target diameter at the point and the layer that decides it.
    pub decision: Decision,
}

/// A triangle, and a quantity interpolated in it.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleReadout {
    /// The id of the triangle.
    pub id: TriangleId,
    /// The level of the triangle.
    pub level: u32,
    /// Which way its vertices run in the report's order.
    pub orientation: Orientation,
    /// The longest edge of the triangle, in world units, or in metres on the Earth.
    pub diameter: f64,
    /// Ids and world coordinates, as files list them: anticlockwise, the first two the ends of the bisection
    /// edge.
    pub vertices: [(NodeId, DVec2); 3],
    /// The bisection neighbour first, anticlockwise.
    pub neighbours: [Neighbour; 3],
    /// ζ₁ ζ₂ ζ₃ of the point.
    pub zeta: [f64; 3],
    /// The quantity at the vertices, in their order.
    pub at_vertices: [f64; 3],
    /// The quantity interpolated at the point.
    pub interpolated: f64,
    /// The quantity at the point itself.
    pub exact: f64,
}

impl Readout {
    /// Reads out the point `point`, in world units.
    pub fn at(point: DVec2, session: &Session, quantity: Quantity) -> Self {
        let location = session.locate(point);
        let triangle = location.triangle().map(|id| triangle_with(id, point, session, quantity));
        let decision = session.decision_at(point);
        Self { point, location, triangle, decision }
    }

    /// Returns the triangle around a point in world units, without what the layers ask for there.
    pub fn triangle_at(point: DVec2, session: &Session, quantity: Quantity) -> Option<TriangleReadout> {
        session.locate(point).triangle().map(|id| triangle_with(id, point, session, quantity))
    }
}

fn triangle_with(id: TriangleId, point: DVec2, session: &Session, quantity: Quantity) -> TriangleReadout {
    let value = |p: DVec2| value_at(p, session.document(), session.follower(), quantity);
    let mut triangle = read_triangle(session.view(), id, point, value);
    if let Some(projection) = session.document().settings().domain.projection {
        triangle.diameter =
            longest_side(EarthPlane::Projected(projection), triangle.vertices.map(|(_, at)| at));
    }
    triangle
}

/// Returns the length of the longest side of a triangle on the Earth, in metres.
fn longest_side(plane: EarthPlane, [a, b, c]: [DVec2; 3]) -> f64 {
    [[a, b], [b, c], [c, a]].map(|side| plane.length(&side)).into_iter().fold(0.0, f64::max)
}

fn read_triangle(
    mesh: MeshView<'_>,
    id: TriangleId,
    point: DVec2,
    value: impl Fn(DVec2) -> f64,
) -> TriangleReadout {
    let triangle = mesh.triangle(id);
    let nodes = mesh.file_vertices(id);
    let corners = nodes.map(|node| mesh.node(node));
    let zeta = barycentric(corners, mesh.lattice().lattice_from_world(point));
    let vertices = nodes.map(|node| (node, mesh.world(node)));
    let at_vertices = vertices.map(|(_, place)| value(place));
    TriangleReadout {
        id,
        level: triangle.level(),
        orientation: triangle.orientation(),
        diameter: mesh.diameter(id),
        vertices,
        neighbours: mesh.neighbours(id),
        zeta,
        at_vertices,
        interpolated: interpolate(zeta, at_vertices),
        exact: value(point),
    }
}

/// Returns the quantity at a point in world units; NaN where it is not known.
pub fn value_at(point: DVec2, document: &Document, follower: &Follower, quantity: Quantity) -> f64 {
    match quantity {
        Quantity::TargetDiameter => {
            let rule = follower.settings().rule;
            follower.field().target_by_rule(rule, document.paint(), point)
        }
        Quantity::Risk => document.risk_at(point).unwrap_or(f64::NAN),
    }
}
