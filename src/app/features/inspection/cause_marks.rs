//! The cause of the queried triangle over the mesh: the chain of triangles that led to it, the place that
//! decides, and what of the bisection tree is shown.

use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke, vec2};
use glam::DVec2;

use crate::app::features::inspection::Inspector;
use meshbrush_core::explain::{Demand, NodeFacts};
use meshbrush_kit::kit::{FrameState, OverMesh, marks};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Mesh, TreeTriangle};
use meshbrush_ui::theme::tokens;

/// Width of the outline of a triangle of the chain, in points.
const LINK_WIDTH: f32 = 1.0;
/// Width of the outline of the triangle that is shown.
const SHOWN_WIDTH: f32 = 2.5;
/// Length of the head of an arrow.
const HEAD: f32 = 7.0;
/// Arrows shorter than this are not drawn.
const SHORTEST_ARROW: f32 = 10.0;
/// Arm of the cross at the place that decides.
const ARM: f32 = 6.0;
/// Radius of the dot at a node.
const DOT: f32 = 3.5;

/// Draws the cause while the tool with its panel is selected.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    if !state.view.aids.cause || !state.tools.tool.queries {
        return;
    }
    let accent = tokens(over.ui).accent;
    let marks = CauseMarks { over, mesh: state.session.mesh(), accent };
    for ancestor in state.feature::<Inspector>().explore.path_down(marks.mesh) {
        marks.ancestor(&ancestor);
    }
    marks.chain(state.feature::<Inspector>().explore.chain());
    if let Some(Demand::Target(least)) =
        state.feature::<Inspector>().explore.explanation().and_then(|one| one.demand)
    {
        marks.decision(least.at, least.from);
    }
    if let Some(shown) = state
        .feature::<Inspector>()
        .explore
        .shown()
        .filter(|_| state.feature::<Inspector>().explore.is_away())
    {
        marks.outline(shown, accent, SHOWN_WIDTH);
    }
    if let Some(node) = state.feature::<Inspector>().explore.node(marks.mesh) {
        marks.node(&node);
    }
}

struct CauseMarks<'a> {
    over: &'a OverMesh<'a>,
    mesh: &'a Mesh,
    accent: Color32,
}

impl CauseMarks<'_> {
    fn at(&self, point: LatticePoint) -> Pos2 {
        (self.over.screen_from_world)(self.mesh.lattice().world_from_lattice(point))
    }

    fn painter(&self) -> &Painter {
        self.over.painter
    }

    fn corners(&self, triangle: &TreeTriangle) -> [Pos2; 3] {
        triangle.corners().map(|corner| self.at(corner))
    }

    fn middle(&self, triangle: &TreeTriangle) -> Pos2 {
        let [a, b, c] = self.corners(triangle).map(Pos2::to_vec2);
        ((a + b + c) / 3.0).to_pos2()
    }

    fn outline(&self, triangle: &TreeTriangle, color: Color32, width: f32) {
        let [a, b, c] = self.corners(triangle);
        marks::paint_rimmed_line(self.painter(), [a, b, c, a].into_iter(), color, width);
    }

    /// A triangle on the way down the bisection tree: fainter than those of the chain.
    fn ancestor(&self, triangle: &TreeTriangle) {
        let [a, b, c] = self.corners(triangle);
        for (width, color) in [(2.5, Color32::from_black_alpha(110)), (1.0, Color32::from_white_alpha(120))] {
            let stroke = Stroke::new(width, color);
            self.painter().add(Shape::closed_line(vec![a, b, c], stroke));
        }
    }

    /// The triangles of the chain, with an arrow from each to the next.
    fn chain(&self, chain: &[TreeTriangle]) {
        for (place, link) in chain.iter().enumerate() {
            let [a, b, c] = self.corners(link);
            let (color, width) = if place == 0 { (self.accent, 2.0) } else { (Color32::WHITE, LINK_WIDTH) };
            marks::paint_line(self.painter(), [a, b, c, a].into_iter(), color, width);
        }
        for pair in chain.windows(2) {
            self.arrow(self.middle(&pair[0]), self.middle(&pair[1]));
        }
    }

    fn arrow(&self, from: Pos2, to: Pos2) {
        if from.distance(to) < SHORTEST_ARROW {
            return;
        }
        let along = (to - from).normalized();
        let tip = to - 2.0 * along;
        let back = tip - HEAD * along;
        let side = 0.5 * HEAD * along.rot90();
        for (width, color) in [(4.0, Color32::from_black_alpha(150)), (1.8, Color32::WHITE)] {
            self.painter().line_segment([from, back], Stroke::new(width, color));
        }
        let head = vec![tip, back + side, back - side];
        let rim = Stroke::new(1.0, Color32::from_black_alpha(150));
        self.painter().add(Shape::convex_polygon(head, Color32::WHITE, rim));
    }

    /// A cross where the least h̄ is, and a dashed line from where gradation carries it.
    fn decision(&self, at: DVec2, from: DVec2) {
        let [at, from] = [at, from].map(|point| (self.over.screen_from_world)(point));
        if at.distance(from) > SHORTEST_ARROW {
            marks::paint_line_preview(self.painter(), from, at);
        }
        for (width, color) in [(4.5, Color32::from_black_alpha(190)), (2.0, self.accent)] {
            let stroke = Stroke::new(width, color);
            self.painter().line_segment([at - vec2(ARM, ARM), at + vec2(ARM, ARM)], stroke);
            self.painter().line_segment([at - vec2(ARM, -ARM), at + vec2(ARM, -ARM)], stroke);
        }
    }

    /// A node with the edges to its adjacent nodes, its parent nodes and those that depend on it.
    fn node(&self, node: &NodeFacts) {
        let at = self.at(node.at);
        for &other in &node.adjacent {
            let ends = [at, self.at(self.mesh.node(other))];
            marks::paint_line(self.painter(), ends.into_iter(), Color32::WHITE, 1.5);
        }
        for parent in node.parents.into_iter().flatten() {
            self.dot(self.at(parent), self.accent);
        }
        for &dependent in &node.dependents {
            self.dot(self.at(dependent), Color32::BLACK);
        }
        self.dot(at, Color32::WHITE);
    }

    fn dot(&self, at: Pos2, color: Color32) {
        let rim = if color == Color32::BLACK { Color32::WHITE } else { Color32::from_black_alpha(220) };
        self.painter().circle(at, DOT, color, Stroke::new(1.5, rim));
    }
}
