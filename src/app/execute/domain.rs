//! Commands about the domain.

use eframe::egui::Context;

use crate::app::App;
use crate::app::command::{DomainCommand, OutlineChange};
use crate::app::files;
use crate::app::tools::DOMAIN;
use meshbrush_core::domain::CutShape;

impl App {
    pub(in crate::app) fn execute_on_domain(&mut self, command: DomainCommand, _: &Context) {
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
