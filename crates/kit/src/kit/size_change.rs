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

/// What an edit of the size did to the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeEffect {
    /// By how many triangles it changed.
    pub change: i64,
    /// Whether no other edit has come since.
    pub is_latest: bool,
}

struct Edit {
    kind: SettingKind,
    /// The triangles of the domain before.
    before: usize,
    /// The revision of the document with the edit, once it is applied. At later ones other edits count, too.
    revision: Option<u64>,
    /// The triangles of the domain with the edit, as far as the mesh followed it.
    after: usize,
    /// Whether the mesh followed it to the end.
    is_followed: bool,
}

impl Edit {
    /// Counts the triangles while no other edit has come.
    fn count(&mut self, document: &Document, follower: &Follower) {
        let revision = *self.revision.get_or_insert(document.revision());
        if revision == document.revision() {
            self.after = follower.mesh().triangle_count();
            self.is_followed = follower.is_in_step(document);
        }
    }

    /// Returns what the edit did to the mesh; `None` where another one came before the mesh had followed.
    fn effect(&self, document: &Document) -> Option<SizeEffect> {
        let is_latest = self.revision.is_none_or(|revision| revision == document.revision());
        let change = self.after as i64 - self.before as i64;
        (is_latest || self.is_followed).then_some(SizeEffect { change, is_latest })
    }
}

impl SizeChange {
    /// Notes that a setting is about to change. The changes of one gesture are one edit.
    pub fn note(&mut self, setting: &Setting, document: &Document, follower: &Follower) {
        if !setting.is_of_size() {
            return;
        }
        let kind = setting.kind();
        let joins = document.is_in_gesture() && self.last.as_ref().is_some_and(|last| last.kind == kind);
        let count = follower.mesh().triangle_count();
        let before = self.last.as_ref().filter(|_| joins).map_or(count, |last| last.before);
        self.last = Some(Edit { kind, before, revision: None, after: count, is_followed: false });
    }

    /// Returns what the last edit of the size did to the mesh, if it was one of these settings. Later edits
    /// do not count.
    pub fn last_effect(&self, kinds: &[SettingKind], document: &Document) -> Option<SizeEffect> {
        self.last.as_ref().filter(|last| kinds.contains(&last.kind))?.effect(document)
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
        if let Some(last) = &mut self.last {
            last.count(document, follower);
        }
        let wanted = self.candidate.clone().map(|setting| setting.applied_to(document.settings()));
        let wanted = wanted.and_then(|settings| settings.checked().ok());
        self.pricer.ask(wanted.as_ref(), document, follower);
        while self.pricer.progress() == Progress::More && Instant::now() < deadline {
            self.pricer.advance(document, follower, SLICE);
        }
        self.pricer.progress() == Progress::More
    }
}
