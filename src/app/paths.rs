//! The paths of the document: found on another thread while the document changes, and then certified.
//!
//! ```text
//!   edit ─→ PathFinder ─→ thread: Planner      live paths while a gesture goes on
//!                            │
//!                            ▼ mesh complete
//!                         thread: Planner      the mesh as it is; paths with both bounds
//!                            │
//!                            ▼
//!           Prover      ─→ thread: Certificate the lower bound rises until the width is reached
//! ```

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::Context;
use glam::DVec2;

use super::latest::Latest;
use super::prover::Prover;
use super::session::Session;
use crate::document::{PathCost, PathPlan};
use crate::domain::DomainShape;
use crate::layers::RiskField;
use crate::mesh::{Extract, Mesh};
use crate::path::{CostDensity, PathError, PathMesh, PathRequest, PathSample, Planner, Solution};

/// One thing to do with paths. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum PathCommand {
    /// Takes hold of the place at a point, at most `reach` away, or adds a place there.
    Press {
        /// Where.
        at: DVec2,
        /// How far from a place still counts.
        reach: f64,
        /// Whether a place that is added lies between start and goal.
        is_between: bool,
    },
    /// Moves the place that was taken hold of. Further moves join this gesture until [`Command::EndGesture`].
    ///
    /// [`Command::EndGesture`]: super::command::Command::EndGesture
    DragTo(DVec2),
    /// Begins a path.
    StartAt(DVec2),
    /// Ends the path that was begun.
    GoalAt(DVec2),
    /// Adds a place in between to the path that is shown.
    ViaAt(DVec2),
    /// Removes the selected place in between, or the path of a selected start or goal.
    Delete,
    /// Removes all paths.
    DeleteAll,
    /// Makes the start the goal of the path that is shown.
    Swap,
    /// Sets what paths cost. Further changes join this gesture.
    Cost(PathCost),
    /// Sets the width of the interval that is proved, as a share of the cost.
    Width(f64),
    /// Marks the place at a distance from the start of the path that is shown.
    ShowDistance(Option<f64>),
}

/// Places on a path at which its profile is known.
const PROFILE_SAMPLES: usize = 200;

/// What paths were computed from.
#[derive(Clone, PartialEq)]
struct Key {
    plan: Arc<PathPlan>,
    opened_documents: u64,
    document: u64,
    /// The mesh, by its revision and that of its pieces along the outline.
    mesh: (u64, u64),
    /// Whether the document is being changed.
    is_live: bool,
}

/// What a thread returns: the planner goes back and forth.
struct Work {
    planner: Option<Planner>,
    density: Option<Arc<dyn CostDensity>>,
    routes: Vec<Result<FoundPath, PathError>>,
}

/// A path with its profile.
#[derive(Clone, Debug)]
pub struct FoundPath {
    /// The path and its bounds.
    pub solution: Solution,
    /// Cost and risk along it.
    pub profile: Vec<PathSample>,
}

/// What is known of a route.
#[derive(Clone, Debug, Default)]
pub struct ShownPath {
    /// The last path that was found.
    pub found: Option<FoundPath>,
    /// Why there is none for the route as it is: the one that is shown is outdated.
    pub problem: Option<PathError>,
}

/// Finds the paths of the document, and keeps the last ones.
#[derive(Default)]
pub struct PathFinder {
    work: Latest<Key, Option<Work>>,
    planner: Option<(Planner, u64, (u64, u64))>,
    key: Option<Key>,
    shown: Vec<ShownPath>,
    prover: Prover,
}

impl PathFinder {
    /// What is known of each route of the document, in order.
    pub fn shown(&self) -> &[ShownPath] {
        &self.shown
    }

    /// The requested width of the interval, as a share of the cost.
    pub fn width(&self) -> f64 {
        self.prover.width
    }

    /// Sets the requested width.
    pub fn set_width(&mut self, width: f64) {
        self.prover.width = width;
        // The bounds that are known stay; certificates begin again.
        self.prover.restart();
    }

    /// Whether the lower bounds are still rising.
    pub fn is_proving(&self) -> bool {
        self.prover.is_running()
    }

    /// Whether the paths are those of the document as it is.
    pub fn is_current(&self, session: &Session) -> bool {
        self.key.as_ref().is_some_and(|key| key.document == session.document().revision() && !key.is_live)
    }

    /// Takes what was found, waiting for it up to `patience`, and begins what is to be found next. The
    /// threads wake the window: no frame needs to wait for them.
    pub fn advance(&mut self, session: &Session, patience: Duration, ctx: &Context) {
        if self.work.is_running() {
            if self.work.take(patience) {
                return;
            }
            self.take_work(session);
        }
        if session.document().settings().paths.routes.is_empty() {
            return self.forget();
        }
        let Some(key) = self.wanted(session) else { return };
        if self.key.as_ref() != Some(&key) {
            self.prover.cancel();
            self.start(key, session, ctx);
        } else if !key.is_live {
            self.prove(session, patience, ctx);
        }
    }

    /// Forgets all paths: the document has none.
    fn forget(&mut self) {
        let prover = std::mem::take(&mut self.prover);
        *self = Self::default();
        self.prover.width = prover.width;
    }

    /// What the paths should be those of; `None` while the first mesh is not complete.
    fn wanted(&self, session: &Session) -> Option<Key> {
        let (document, follower) = (session.document(), session.follower());
        let is_settled = !document.is_in_gesture()
            && follower.is_in_step(document)
            && (session.derived().is_some() || document.settings().domain.region().is_none());
        let now = (follower.revision(), session.derivation().pieces_revision());
        let opened_documents = session.opened_documents();
        let planned = self.planner.as_ref().filter(|(_, opened, _)| *opened == opened_documents);
        let mesh = if is_settled { now } else { planned?.2 };
        Some(Key {
            plan: document.settings().paths.clone(),
            opened_documents,
            document: document.revision(),
            mesh,
            is_live: !is_settled,
        })
    }

    fn start(&mut self, key: Key, session: &Session, ctx: &Context) {
        let document = session.document();
        let risk = RiskField::new(&document.settings().layers, document.paint());
        let planner = self
            .planner
            .take()
            .filter(|(_, opened, mesh)| *opened == key.opened_documents && *mesh == key.mesh);
        let mesh = match planner {
            Some((planner, ..)) => PlannedMesh::Planner(Box::new(planner)),
            None => match session.derived() {
                Some(derived) => PlannedMesh::Extract(derived.shared_extract()),
                None => PlannedMesh::Mesh(session.follower().shared_mesh()),
            },
        };
        let (plan, is_live) = (key.plan.clone(), key.is_live);
        let bounds = document.settings().domain.bounds;
        self.work.start(
            key,
            move || {
                let density = plan.cost.density(risk).ok()?;
                let planner = mesh.planner(&density, &bounds);
                Some(find(planner, density, &plan.routes, is_live))
            },
            ctx,
        );
    }

    /// Takes the work that has ended.
    fn take_work(&mut self, session: &Session) {
        let Some((key, work)) = self.work.take_last() else { return };
        let Some(work) = work else {
            // The settings are checked: weights that make no cost are refused there.
            self.key = Some(key);
            return;
        };
        let revision = key.mesh;
        self.planner = work.planner.map(|planner| (planner, key.opened_documents, revision));
        if key.opened_documents != session.opened_documents() {
            return;
        }
        let bounds_hold = session.document().settings().domain.shape == DomainShape::Whole;
        self.shown.resize_with(work.routes.len(), ShownPath::default);
        for (shown, found) in self.shown.iter_mut().zip(work.routes) {
            match found {
                Ok(mut found) => {
                    if !bounds_hold {
                        // It knows no path between the outline and the mesh: a certificate does.
                        found.solution.lower = 0.0;
                    }
                    *shown = ShownPath { found: Some(found), problem: None };
                }
                Err(problem) => shown.problem = Some(problem),
            }
        }
        self.prover.begin(work.density);
        self.key = Some(key);
    }

    /// Raises the lower bounds of complete paths.
    fn prove(&mut self, session: &Session, patience: Duration, ctx: &Context) {
        let found = self.shown.iter_mut().filter(|shown| shown.problem.is_none());
        let solutions = found.filter_map(|shown| shown.found.as_mut()).map(|found| &mut found.solution);
        self.prover.advance(solutions.collect(), &session.document().settings().domain, patience, ctx);
    }
}

/// Where a planner comes from.
enum PlannedMesh {
    /// The one for this mesh.
    Planner(Box<Planner>),
    Mesh(Arc<Mesh>),
    Extract(Arc<Extract<'static>>),
}

impl PlannedMesh {
    fn planner(
        self,
        density: &Arc<dyn CostDensity>,
        bounds: &crate::geometry::Rect,
    ) -> Result<Planner, PathError> {
        match self {
            Self::Planner(mut planner) => {
                planner.update(&**density, std::slice::from_ref(bounds)).map(|()| *planner)
            }
            Self::Mesh(mesh) => Planner::new(PathMesh::new(mesh.view()), &**density),
            Self::Extract(extract) => Planner::new(PathMesh::new(extract.view()), &**density),
        }
    }
}

fn find(
    planner: Result<Planner, PathError>,
    density: Arc<dyn CostDensity>,
    routes: &[Vec<DVec2>],
    is_live: bool,
) -> Work {
    let mut planner = match planner {
        Ok(planner) => planner,
        Err(problem) => {
            let routes = routes.iter().map(|_| Err(problem.clone())).collect();
            return Work { planner: None, density: None, routes };
        }
    };
    let request = if is_live { PathRequest::LIVE } else { PathRequest::FULL };
    let routes = routes.iter().map(|places| {
        let solution = planner.solve(&*density, places, request)?;
        let profile = solution.profile(&*density, PROFILE_SAMPLES);
        Ok(FoundPath { solution, profile })
    });
    let routes = routes.collect();
    Work { planner: Some(planner), density: Some(density), routes }
}
