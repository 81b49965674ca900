//! What the files of an export will have in them, measured while the question for a file is open.

use meshbrush_io::io::Meter;
use meshbrush_kit::kit::file_coordinates::FileCoordinates;
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::mesh_export::{ExportFigures, MeshExport};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_render::render::export::ExportFormat;

/// The most triangles of a mesh whose files are measured: writing them takes a second or so. Above, their
/// size is estimated.
const MOST_TRIANGLES: usize = 500_000;

/// What figures depend on: the format, the coordinates, and the revisions of the document and of its mesh.
type MeasuredState = (&'static str, FileCoordinates, u64, u64);

/// Measures files before they are written.
#[derive(Default)]
pub struct ExportMeasurer {
    slot: Slot<MeasuredState, Result<ExportFigures, String>>,
}

impl ExportMeasurer {
    /// Measures the files of the mesh on the screen in a format, unless that was done, or there are too many
    /// triangles. Call it in every frame in which figures are shown.
    pub fn follow(&mut self, session: &Session, view: &View, format: ExportFormat, jobs: &Jobs) {
        let key = measured_state(session, view, format);
        self.slot.poll(jobs);
        if self.slot.has(&key) || session.triangle_count() > MOST_TRIANGLES {
            return;
        }
        self.slot.want(&key, jobs);
        let export = MeshExport::of(session, view, format);
        let measure = move || export.measure(&Meter::default()).map_err(|error| error.to_string());
        self.slot.start(key, measure, jobs);
    }

    /// Returns what was measured of the mesh on the screen in a format, or why it cannot be written.
    pub fn of(
        &self,
        session: &Session,
        view: &View,
        format: ExportFormat,
    ) -> Option<&Result<ExportFigures, String>> {
        let (found, figures) = self.slot.last()?;
        (*found == measured_state(session, view, format)).then_some(figures)
    }
}

fn measured_state(session: &Session, view: &View, format: ExportFormat) -> MeasuredState {
    (format.name(), view.file_coordinates, session.document().revision(), session.follower().revision())
}
