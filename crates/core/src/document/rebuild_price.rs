use super::Follower;
use super::pricer::{NoChange, Price};
use super::rebuild::Rebuild;
use crate::build::BuildError;
use crate::layers::PaintLayers;
use crate::mesh::{Limits, Mesh, Progress, RefineError};

/// Counts in slices what a stroke would do to a mesh that is made again after each edit: close to a surface,
/// or by the vertex rule. There, only the whole mesh tells.
#[derive(Clone, Debug)]
pub(super) struct RebuildPrice {
    rebuild: Rebuild,
    /// What would be painted.
    paint: PaintLayers,
}

/// Prices are counted for meshes of up to this many triangles. Making larger ones whenever the pointer rests
/// would keep all cores busy.
const MOST_SHOWN: usize = 2_000_000;

impl RebuildPrice {
    /// Returns the work, in the memory of `spare`; `None` for a mesh that is too large.
    pub(super) fn new(paint: PaintLayers, follower: &Follower, spare: Option<Mesh>) -> Option<Self> {
        let shown = follower.mesh().raw_triangle_count();
        // Where the document has no room for the triangles, their number is still wanted.
        let max_triangles = shown + Price::MOST;
        let limits = Limits { max_triangles, max_memory: None, ..follower.settings().limits() };
        let rebuild = (shown <= MOST_SHOWN).then(|| follower.rebuild_within(limits, spare))?.ok()?;
        Some(Self { rebuild, paint })
    }

    /// Does about `budget` edges, pixels or triangles of the work.
    pub(super) fn advance(&mut self, budget: usize) -> Result<Progress, Price> {
        self.rebuild.advance(&self.paint, budget).map_err(|error| match error {
            BuildError::Refine(RefineError::TooFine { .. }) => Price::TooFine,
            // Strokes paint valid values, so that only the number of triangles is left.
            _ => Price::MoreThan(Price::MOST as i64),
        })
    }

    /// Once done: the mesh after the stroke, and the pixels.
    pub(super) fn finish(self) -> (Mesh, PaintLayers) {
        let (_, built, _) = self.rebuild.finish();
        (built.mesh, self.paint)
    }
}

/// Returns the price of a stroke after which the mesh is `after`; it says `why` where no triangle changes.
pub(super) fn price_between(shown: &Mesh, after: &Mesh, why: impl FnOnce() -> NoChange) -> Price {
    match after.triangle_count() as i64 - shown.triangle_count() as i64 {
        0 if after.fingerprint() == shown.fingerprint() => Price::Nothing(why()),
        change => Price::Change(change),
    }
}
