//! What an edit of the size did to the number of triangles, and what another one would do.

use crate::kit::clock::Instant;

use super::session::Session;
use meshbrush_core::document::{Document, Follower, Price, Setting, SettingKind, SizePricer};
use meshbrush_mesh::mesh::Progress;

/// Triangles that are looked at in one slice of a price. Few, because a question to a stack of layers with a
/// limit of gradation can take 20 µs.
const SLICE: usize = 256;

/// The last edit of the size, and the one that is considered.
#[derive(Default)]
pub struct SizeChange {
    last: Option<Edit>,
    /// A setting that is not applied: under the pointer, or being typed.
    candidate: Option<Setting>,
    pricer: SizePricer,
}

struct Edit {
    kind: SettingKind,
    /// The triangles of the domain before.
    before: usize,
}

impl SizeChange {
    /// Notes that a setting is about to change. The changes of one gesture are one edit.
    pub fn note(&mut self, setting: &Setting, document: &Document, follower: &Follower) {
        if !setting.is_of_size() {
            return;
        }
        let kind = setting.kind();
        let joins = document.is_in_gesture() && self.last.as_ref().is_some_and(|last| last.kind == kind);
        if !joins {
            self.last = Some(Edit { kind, before: follower.mesh().triangle_count() });
        }
    }
}

impl Session {
    /// Returns by how many triangles the last edit of the size changed the mesh, if it was one of these
    /// settings.
    pub fn last_size_change(&self, kinds: &[SettingKind]) -> Option<i64> {
        let last = self.size_change.last.as_ref().filter(|last| kinds.contains(&last.kind))?;
        Some(self.mesh().triangle_count() as i64 - last.before as i64)
    }

    /// Considers a setting, or none: its price is computed in the coming frames.
    pub fn consider(&mut self, candidate: Option<Setting>) {
        self.size_change.candidate = candidate;
    }

    /// Returns the setting that is considered.
    pub fn considered(&self) -> Option<&Setting> {
        self.size_change.candidate.as_ref()
    }

    /// Returns the price of the setting that is considered, once known.
    pub fn considered_price(&self) -> Option<Price> {
        self.size_change.pricer.price()
    }

    /// Whether that price is still being computed.
    pub fn considered_progress(&self) -> Progress {
        self.size_change.pricer.progress()
    }

    /// Computes the price of the setting that is considered until `deadline`. Returns whether work is left.
    pub fn price_setting(&mut self, deadline: Instant) -> bool {
        let settings = self.document().settings();
        let wanted = self.size_change.candidate.clone().map(|setting| setting.applied_to(settings));
        let wanted = wanted.and_then(|settings| settings.checked().ok());
        let mut pricer = std::mem::take(&mut self.size_change.pricer);
        let (document, follower) = (self.document(), self.follower());
        pricer.ask(wanted.as_ref(), document, follower);
        while pricer.progress() == Progress::More && Instant::now() < deadline {
            pricer.advance(document, follower, SLICE);
        }
        let left = pricer.progress() == Progress::More;
        self.size_change.pricer = pricer;
        left
    }
}
