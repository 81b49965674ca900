//! Finds the deepest way between two places, off the window's thread.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use super::LinesCommand;
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{DepthField, DepthSurface};
use meshbrush_core::path::{DeepestWay, DeepestWayError, PathArea, PathMeshing};
use meshbrush_io::io::Meter;
use meshbrush_kit::kit::Ctx;
use meshbrush_kit::kit::background::{Aim, Outcome};
use meshbrush_kit::kit::command::Command;
use meshbrush_mesh::mesh::{Extract, Mesh};

/// What a person is told who asks for the deepest way without depths.
pub const NO_DEPTHS: &str = "The deepest way needs depths: add a layer of depth of water first, from a file with a grid \
                             of depths or heights.";

/// Returns whether a document has depths.
pub fn has_depths(settings: &Settings) -> bool {
    DepthSurface::of(&settings.layers).is_some()
}

/// The mesh that is walked on.
enum WalkedMesh {
    Derived(Arc<Extract<'static>>),
    Mesh(Arc<Mesh>),
}

impl WalkedMesh {
    fn in_area(&self, area: &PathArea) -> PathMeshing {
        match self {
            Self::Derived(extract) => PathMeshing::new(extract.view(), area),
            Self::Mesh(mesh) => PathMeshing::new(mesh.view(), area),
        }
    }
}

/// Begins to look for the deepest way between two places, or says why there can be none.
pub fn find_way(ends: [DVec2; 2], ctx: &mut Ctx<'_>) {
    let settings = ctx.session.document().settings();
    let Some(depths) = DepthField::of(&settings.layers) else {
        return ctx.session.tell(NO_DEPTHS.into());
    };
    let mesh = match ctx.session.derived() {
        Some(derived) => WalkedMesh::Derived(derived.shared_extract()),
        None => WalkedMesh::Mesh(ctx.session.follower().shared_mesh()),
    };
    let (domain, boundary) = (settings.domain.clone(), settings.boundary);
    let begin = move || {
        let area = PathArea::new(&domain, boundary, Vec::new(), 0.0);
        let area = area.map_err(DeepestWayError::from);
        Some(area.and_then(|area| DeepestWay::new(depths, mesh.in_area(&area), &domain, ends)))
    };
    ctx.background.start_in_slices(Aim::Find, Path::new("the deepest way"), begin, advance);
}

/// Takes a step of the search.
fn advance(search: &mut Result<DeepestWay, DeepestWayError>, meter: &Meter) -> Option<Outcome> {
    let search = match search {
        Ok(search) => search,
        Err(problem) => return Some(Outcome::NotFound(problem.to_string())),
    };
    let found = search.advance();
    meter.expect(DeepestWay::STAGES);
    // The job is told to end when it is cancelled: no step needs to look.
    _ = meter.add(search.stage().saturating_sub(meter.done()));
    match found {
        Ok(None) => None,
        Ok(Some(way)) => Some(Outcome::Found(vec![Command::from(LinesCommand::AddWay(way))])),
        Err(problem) => Some(Outcome::NotFound(problem.to_string())),
    }
}
