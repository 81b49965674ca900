//! Why the queried triangle is in the mesh, and the way from it through the bisection tree.

use glam::DVec2;

use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::explain::{Explanation, NodeFacts};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Cause, Mesh, NodeId, TreeTriangle};

/// A step in the bisection tree, or along the chain of a cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreeStep {
    /// To the queried triangle.
    Queried,
    /// To the coarse triangle.
    Coarse,
    /// To a triangle on the way down from the coarse triangle to the queried one, by its level.
    Ancestor(u32),
    /// To the triangle that this one is half of.
    Parent,
    /// To the other half of the parent.
    Sibling,
    /// To one of the halves, 0 or 1.
    Child(usize),
    /// To a triangle of the chain, 0 being the one that exceeds its target.
    Link(usize),
    /// To the next triangle of the chain, towards the parent of the queried one.
    NextLink,
    /// To the triangle before it.
    PreviousLink,
}

/// The explanation of the queried triangle, and what of it is looked at.
#[derive(Default)]
pub struct Explore {
    key: Option<ExplanationKey>,
    explanation: Option<Explanation>,
    /// The triangle that the user went to, if it is not the queried one.
    place: Option<TreeTriangle>,
    /// The corner of the shown triangle whose node is shown: 0 is the apex.
    corner: Option<usize>,
}

/// The data that an explanation depends on.
#[derive(Clone, Copy, PartialEq)]
struct ExplanationKey {
    point: DVec2,
    document: u64,
    mesh: u64,
}

impl Explore {
    /// Explains the queried triangle if it, the document or the mesh has changed, and the mesh is complete.
    pub fn advance(&mut self, session: &Session) {
        let (document, follower) = (session.document(), session.follower());
        let complete = session.queried().filter(|_| follower.is_in_step(document));
        let key = complete.map(|point| ExplanationKey {
            point,
            document: document.revision(),
            mesh: follower.revision(),
        });
        if key == self.key {
            return;
        }
        *self = Self { key, ..Self::default() };
        let id = complete.and_then(|point| follower.mesh().locate(point).triangle());
        self.explanation = id.map(|id| {
            let settings = follower.settings();
            let paint = Some(document.paint());
            let criterion =
                RefinementCriterion::new(follower.domain(), follower.field(), settings.rule, paint)
                    .with_surface(follower.surface().map(|surface| &**surface));
            let triangle = TreeTriangle::from_mesh(follower.mesh(), id);
            Explanation::new(follower.mesh(), triangle, &criterion, &settings.limits())
        });
    }

    /// Returns why the queried triangle is in the mesh; `None` without a query, and while the mesh is
    /// updated.
    pub fn explanation(&self) -> Option<&Explanation> {
        self.explanation.as_ref()
    }

    /// Returns the triangle that the user went to, else the queried one.
    pub fn shown(&self) -> Option<&TreeTriangle> {
        self.place.as_ref().or(self.explanation.as_ref().map(|explanation| &explanation.triangle))
    }

    /// Returns whether the user went to another triangle than the queried one.
    pub fn is_away(&self) -> bool {
        self.place.is_some()
    }

    /// Returns the chain of the cause: none where the parent exceeds its target itself.
    pub fn chain(&self) -> &[TreeTriangle] {
        match self.explanation.as_ref().map(|explanation| &explanation.cause) {
            Some(Cause::Compatibility { chain }) => chain,
            _ => &[],
        }
    }

    /// Returns the way down the bisection tree: from the coarse triangle to the parent of the queried one.
    pub fn path_down(&self, mesh: &Mesh) -> Vec<TreeTriangle> {
        let queried = self.explanation.as_ref().map(|explanation| &explanation.triangle);
        queried.map_or_else(Vec::new, |queried| queried.ancestors(mesh.lattice()))
    }

    /// Returns the place of the shown triangle in the chain.
    pub fn link(&self) -> Option<usize> {
        let place = self.place.as_ref()?;
        self.chain().iter().position(|link| link.is_same(place))
    }

    /// Returns the triangle that a step leads to, if there is one.
    pub fn target(&self, step: TreeStep, mesh: &Mesh) -> Option<TreeTriangle> {
        let here = self.shown()?;
        let chain = self.chain();
        let along = |link: Option<usize>| link.and_then(|link| chain.get(link)).copied();
        match step {
            TreeStep::Queried => self.explanation.as_ref().map(|explanation| explanation.triangle),
            TreeStep::Coarse => here.ancestors(mesh.lattice()).first().copied(),
            TreeStep::Ancestor(level) => {
                self.path_down(mesh).into_iter().find(|ancestor| ancestor.level() == level)
            }
            TreeStep::Parent => here.parent(mesh.lattice()),
            TreeStep::Sibling => here.sibling(mesh.lattice()),
            TreeStep::Child(half) => mesh.is_bisected(here).then(|| here.children()[half]),
            TreeStep::Link(link) => along(Some(link)),
            // From the queried triangle the chain is entered at its end.
            TreeStep::NextLink => along(self.link().map(|link| link + 1)),
            TreeStep::PreviousLink => along(match self.link() {
                Some(link) => link.checked_sub(1),
                None => chain.len().checked_sub(1),
            }),
        }
    }

    /// Makes a step.
    pub fn step(&mut self, step: TreeStep, mesh: &Mesh) {
        let Some(target) = self.target(step, mesh) else { return };
        let is_queried =
            self.explanation.as_ref().is_some_and(|explanation| explanation.triangle.is_same(&target));
        self.place = (!is_queried).then_some(target);
        self.corner = None;
    }

    /// Shows the node at a corner of the shown triangle, or hides it.
    pub fn show_corner(&mut self, corner: Option<usize>) {
        self.corner = corner;
    }

    /// Returns the corner whose node is shown.
    pub fn corner(&self) -> Option<usize> {
        self.corner
    }

    /// Returns the node that is shown.
    pub fn node(&self, mesh: &Mesh) -> Option<NodeFacts> {
        let at = self.shown()?.corners()[self.corner?];
        node_at(mesh, at).map(|node| NodeFacts::new(mesh, node))
    }
}

/// Returns the node of a mesh at a point of the lattice.
fn node_at(mesh: &Mesh, at: LatticePoint) -> Option<NodeId> {
    let id = mesh.locate(mesh.lattice().world_from_lattice(at)).triangle()?;
    mesh.triangle(id).vertices.into_iter().find(|&vertex| mesh.node(vertex) == at)
}
