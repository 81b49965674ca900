//! Commands about the domain and its boundary.

use glam::DVec2;

use crate::app::App;
use crate::app::command::{BoundaryCommand, DomainCommand, OutlineChange};
use crate::app::files;
use crate::app::tools::{BOUNDARY, BoundaryToolMode, DOMAIN};
use meshbrush_core::domain::{BoundaryPieces, CutShape};

impl App {
    pub(super) fn execute_on_domain(&mut self, command: DomainCommand) {
        let tool = &mut self.tools.domain;
        match command {
            DomainCommand::Reshape(cut_shape, adds) => self.reshape(cut_shape, adds),
            DomainCommand::AddCorner(corner) => tool.corners.push(corner),
            DomainCommand::MoveCorner(index, corner) => {
                if let Some(place) = tool.corners.get_mut(index) {
                    *place = corner;
                }
            }
            DomainCommand::RemoveCorner => {
                tool.corners.pop();
            }
            DomainCommand::ClosePolygon => self.close_polygon(),
            DomainCommand::Mode(mode) => {
                self.tools.select(&DOMAIN);
                self.tools.domain.mode = mode;
            }
            DomainCommand::Adds(adds) => tool.adds = adds,
            DomainCommand::Open(path) => files::load_domain(&mut self.background, &path),
            DomainCommand::AddOutline(path) => {
                files::load_outline(&self.session, &mut self.background, &path);
            }
            DomainCommand::SetOutline(change) => self.set_outline(*change),
            DomainCommand::Bounds(bounds) => {
                self.session.set_bounds(bounds);
                self.tools.note_use(&DOMAIN);
            }
        }
    }

    pub(super) fn execute_on_boundary(&mut self, command: BoundaryCommand) {
        match command {
            BoundaryCommand::Click(point, reach) => self.click_boundary(point, reach),
            BoundaryCommand::Select(point) => {
                self.tools.boundary.selected = Some(point);
                self.view.reveal(point);
            }
            BoundaryCommand::Mode(mode) => {
                self.tools.select(&BOUNDARY);
                self.tools.boundary.mode = mode;
            }
            BoundaryCommand::Join => {
                let selected = |pieces: &BoundaryPieces| self.tools.boundary.selected_of(pieces);
                let marks =
                    self.session.changed_marks(|pieces, marks| pieces.joined(marks, selected(pieces)?));
                self.session.set_marks(marks);
            }
        }
    }

    /// Selects or splits what is at a point, at most `reach` away.
    fn click_boundary(&mut self, point: DVec2, reach: f64) {
        self.tools.note_use(&BOUNDARY);
        if self.tools.boundary.mode == BoundaryToolMode::Split {
            let marks = self.session.changed_marks(|pieces, marks| pieces.split(marks, point, reach));
            return self.session.set_marks(marks);
        }
        let piece = self.session.boundary_pieces().and_then(|pieces| {
            let (piece, _) = pieces.nearest(point, reach)?;
            Some(pieces.list()[piece].middle())
        });
        self.tools.boundary.selected = piece;
    }

    fn set_outline(&mut self, change: OutlineChange) {
        let OutlineChange { name, before, setting } = change;
        let settings = self.session.document().settings();
        if settings.domain != before || self.session.is_cutting() {
            let problem = "was not added, as the domain was edited in the meantime. Add it again.";
            return self.session.report(format!("{name} {problem}"));
        }
        self.session.end_gesture();
        self.session.set(setting);
        self.session.end_gesture();
        let settings = self.session.document().settings();
        if settings.domain != before {
            let grows = settings.domain.bounds != before.bounds;
            let frame = if grows { " The frame grew to hold it." } else { "" };
            self.session.tell(format!("The outline {name} was added to the domain.{frame}"));
            self.view.camera = self.view.camera.filter(|_| !grows);
        }
    }

    fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        self.session.reshape(cut_shape, adds);
        self.tools.note_use(&DOMAIN);
    }

    fn close_polygon(&mut self) {
        if self.tools.domain.corners.len() < 3 {
            return self.session.tell("A polygon needs three corners: click to set another one.".into());
        }
        let ring = std::mem::take(&mut self.tools.domain.corners);
        self.reshape(CutShape::Ring(ring), self.tools.domain.adds);
        self.session.end_gesture();
    }
}
