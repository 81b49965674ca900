//! Another mesh, built beside the shown one.

use super::change::Change;
use super::{Document, Settings, Stage};
use crate::build::{BuildError, BuildStage, BuiltMesh, MeshBuilder, MeshSpec, Parts};
use crate::layers::{PaintChange, PaintLayers};
use crate::mesh::{Progress, TargetChange};

/// Builds the mesh of a document, in slices.
#[derive(Clone, Debug)]
pub(super) struct Rebuild {
    /// The settings of the document when it began.
    settings: Settings,
    builder: MeshBuilder,
    /// The areas in which the paint changed since the rebuild began: the mesh is updated there once it is
    /// shown.
    repainted: Vec<PaintChange>,
}

/// A rebuild for outdated settings is finished up to this many triangles, besides twice those of the shown
/// mesh.
const MOST_OUTDATED: usize = 500_000;

impl Rebuild {
    /// Creates the work for the given settings, described by `spec`, and the present paint. The parts are
    /// those that an earlier mesh has already.
    pub(super) fn new(settings: &Settings, spec: MeshSpec, parts: Parts) -> Self {
        let builder = MeshBuilder::from_parts(spec, parts);
        Self { settings: settings.clone(), builder, repainted: Vec::new() }
    }

    /// Notes what was painted meanwhile.
    pub(super) fn repaint(&mut self, areas: &[PaintChange]) {
        // Pixels may have been read before or after they changed.
        self.repainted.extend(areas.iter().map(|area| PaintChange { change: TargetChange::Any, ..*area }));
    }

    pub(super) fn is_for(&self, settings: &Settings) -> bool {
        self.settings == *settings
    }

    /// Returns whether an error of this work is one of the document as it is: nothing has changed since it
    /// began.
    pub(super) fn is_up_to_date(&self, wanted: &Settings) -> bool {
        self.is_for(wanted) && self.repainted.is_empty()
    }

    /// Returns whether to finish and show the mesh although the document has other settings by now. Then the
    /// mesh keeps moving while a slider or a handle is dragged; a restart at each move would never get to the
    /// end.
    ///
    /// Not so where the result would be of no interest, as for another domain, or would take too long.
    pub(super) fn is_worth_finishing(&self, document: &Document, shown_triangles: usize) -> bool {
        let change = document.settings().change_from(&self.settings, document.paint());
        change != Change::NewMesh { is_similar: false }
            && self.builder.triangles() <= 2 * shown_triangles + MOST_OUTDATED
    }

    /// Returns one slice of work: about `budget` edges, pixels or triangles.
    pub(super) fn advance(&mut self, paint: &PaintLayers, budget: usize) -> Result<Progress, BuildError> {
        self.builder.advance(Some(paint), budget)
    }

    pub(super) fn stage(&self) -> Stage {
        match self.builder.stage() {
            BuildStage::Indexing => Stage::Indexing,
            BuildStage::Checking => Stage::Checking,
            BuildStage::Refining { triangles } | BuildStage::Classifying { triangles } => {
                Stage::Refining { triangles }
            }
        }
    }

    /// Once done: the mesh, its settings, and the areas in which the paint changed meanwhile.
    pub(super) fn finish(self) -> (Settings, BuiltMesh, Vec<PaintChange>) {
        (self.settings, self.builder.finish(), self.repainted)
    }
}
