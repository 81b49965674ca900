//! What an edit of the size did to the number of triangles, and what another one would do.

use super::clock::Instant;
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

    /// Returns the triangles before the last edit of the size, if it was one of these settings.
    pub fn triangles_before(&self, kinds: &[SettingKind]) -> Option<usize> {
        self.last.as_ref().filter(|last| kinds.contains(&last.kind)).map(|last| last.before)
    }

    /// Considers a setting, or none: [`Self::advance`] computes its price.
    pub fn consider(&mut self, candidate: Option<Setting>) {
        self.candidate = candidate;
    }

    /// Returns the setting that is considered.
    pub fn considered(&self) -> Option<&Setting> {
        self.candidate.as_ref()
    }

    /// Returns the price of the setting that is considered, once known.
    pub fn price(&self) -> Option<Price> {
        self.pricer.price()
    }

    /// Whether that price is still being computed.
    pub fn progress(&self) -> Progress {
        self.pricer.progress()
    }

    /// Computes the price of the setting that is considered until `deadline`. Returns whether work is left.
    pub fn advance(&mut self, document: &Document, follower: &Follower, deadline: Instant) -> bool {
        let wanted = self.candidate.clone().map(|setting| setting.applied_to(document.settings()));
        let wanted = wanted.and_then(|settings| settings.checked().ok());
        self.pricer.ask(wanted.as_ref(), document, follower);
        while self.pricer.progress() == Progress::More && Instant::now() < deadline {
            self.pricer.advance(document, follower, SLICE);
        }
        self.pricer.progress() == Progress::More
    }
}
