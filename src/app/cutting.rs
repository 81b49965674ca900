//! What the domain tool does.

use glam::DVec2;

use super::App;
use super::command::DomainCommand;
use super::tools::{DomainShape, Tool};
use crate::document::Setting;
use crate::domain::Stencil;
use crate::geometry::Rect;

impl App {
    pub(super) fn execute_on_domain(&mut self, command: DomainCommand) {
        match command {
            DomainCommand::Reshape(stencil, adds) => self.reshape(&stencil, adds),
            DomainCommand::AddCorner(corner) => self.outline.push(corner),
            DomainCommand::CloseOutline => self.close_outline(),
            DomainCommand::Shape(shape) => self.take_domain_shape(shape),
            DomainCommand::Adds(adds) => self.tools.domain_adds = adds,
            DomainCommand::Frame(a, b) => self.frame(a, b),
        }
    }

    fn take_domain_shape(&mut self, shape: DomainShape) {
        self.take_tool(Tool::Domain);
        self.tools.domain_shape = shape;
    }

    fn reshape(&mut self, stencil: &Stencil, adds: bool) {
        match self.session.document().settings().domain.reshaped(stencil, adds) {
            Some(domain) => self.session.set(Setting::Domain(domain)),
            None => self.session.report(
                "The domain is given by a formula, and a formula has no outline to cut. Empty the row \"Domain where\" to start \
                 from the whole rectangle.",
            ),
        }
        self.hints.did(Tool::Domain);
    }

    fn close_outline(&mut self) {
        let ring = std::mem::take(&mut self.outline);
        if ring.len() >= 3 {
            self.reshape(&Stencil::Ring(ring), self.tools.domain_adds);
            self.session.document_mut().end_gesture();
        }
    }

    fn frame(&mut self, a: DVec2, b: DVec2) {
        self.session.set(Setting::Bounds(Rect::new(a.min(b), a.max(b))));
        self.session.document_mut().end_gesture();
        self.hints.did(Tool::Domain);
    }
}
