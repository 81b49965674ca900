//! The data that a frame shows.

use std::any::{Any, TypeId};

use super::{Keymap, LayerKinds};
use crate::kit::coordinates::{PlaceText, geographic_plane, names_of, place_text};
use crate::kit::project::ProjectFile;
use crate::kit::readout::Readout;
use crate::kit::session::Session;
use crate::kit::threads::Threads;
use crate::kit::tools::Tools;
use crate::kit::view::View;
use glam::DVec2;
use meshbrush_core::earth::{DegreeStyle, EarthPlane};
use meshbrush_core::paint::Mirror;
use meshbrush_mesh::text::LengthUnit;

/// The states of features, by their types.
pub trait FeatureStates {
    /// Returns the state of a feature; `None` where the window has no such feature.
    fn state(&self, id: TypeId) -> Option<&dyn Any>;
}

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
    pub features: &'a dyn FeatureStates,
    /// The kinds of layers of all features.
    pub layer_kinds: LayerKinds,
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
    ///
    /// # Panics
    /// Panics where the window has no such feature.
    pub fn feature<F: 'static>(&self) -> &'a F {
        let state = self.features.state(TypeId::of::<F>());
        state.and_then(<dyn Any>::downcast_ref).expect("the window has the feature")
    }

    /// Returns the unit of the document's lengths and coordinates.
    pub fn unit(&self) -> LengthUnit {
        self.session.document().settings().unit
    }

    /// See [`geographic_plane`].
    pub fn geographic_plane(&self) -> Option<(EarthPlane, DegreeStyle)> {
        geographic_plane(self.session.document().settings(), self.view.coordinates)
    }

    /// Returns the names of the coordinates that the person wants.
    pub fn place_names(&self) -> [&'static str; 2] {
        names_of(self.geographic_plane().is_some())
    }

    /// Returns a place, in world units, in the coordinates that the person wants, with the digits that a
    /// pixel can tell apart.
    pub fn place_text(&self, at: DVec2) -> PlaceText {
        place_text(self.session.document().settings(), self.view.coordinates, at, self.view.world_per_px())
    }

    /// Returns what repeats the strokes of the selected tool, if anything does.
    pub fn stroke_mirror(&self) -> Option<Mirror> {
        let mirrors = self.tools.paints() && self.tools.mirrored != [false; 2];
        mirrors.then(|| self.tools.mirror(self.session.document().settings().domain.bounds))
    }

    /// Returns the place that is worked at, in world units: that of the pointer, or else the middle of the
    /// view.
    pub fn place(&self) -> DVec2 {
        let center = || self.view.camera.map(|camera| camera.visible_world().center());
        let domain = || self.session.document().settings().domain.bounds.center();
        self.pointer.or_else(center).unwrap_or_else(domain)
    }
}
