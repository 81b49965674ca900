//! The data that a frame shows.

use super::{Feature, Features, Keymap, Row};
use crate::app::project::ProjectFile;
use crate::app::readout::Readout;
use crate::app::session::Session;
use crate::app::threads::Threads;
use crate::app::tools::Tools;
use crate::app::view::View;
use glam::DVec2;
use meshbrush_mesh::text::LengthUnit;

/// Everything that a frame shows, to read.
pub struct FrameState<'a> {
    /// The document and its mesh.
    pub session: &'a Session,
    /// The document's file.
    pub project: &'a ProjectFile,
    /// The selected tool and its settings.
    pub tools: &'a Tools,
    /// The settings of the view.
    pub view: &'a View,
    /// The keys that were changed.
    pub keymap: &'a Keymap,
    /// The features. Each reads its own.
    pub features: &'a Features,
    /// The parts of all features.
    pub rows: &'static [Row],
    /// The threads on which the window computes.
    pub threads: &'a Threads,
    /// The position of the pointer on the canvas, in world units.
    pub pointer: Option<DVec2>,
    /// The queried point and the triangle around it.
    pub readout: Option<&'a Readout>,
    /// Whether to leave out what differs from run to run.
    pub reproducible: bool,
}

impl<'a> FrameState<'a> {
    /// Returns the state of a feature, which reads its own.
    pub fn feature<F: Feature>(&self) -> &'a F {
        self.features.get()
    }

    /// Returns the unit of the document's lengths and coordinates.
    pub fn unit(&self) -> LengthUnit {
        self.session.document().settings().unit
    }

    /// Returns the place that is worked at, in world units: that of the pointer, or else the middle of the
    /// view.
    pub fn place(&self) -> DVec2 {
        let center = || self.view.camera.map(|camera| camera.visible_world().center());
        let domain = || self.session.document().settings().domain.bounds.center();
        self.pointer.or_else(center).unwrap_or_else(domain)
    }
}
