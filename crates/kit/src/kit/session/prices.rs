//! Prices of what is about to be done.

use super::Session;
use crate::kit::clock::Instant;
use crate::kit::size_change::SizeEffect;
use crate::kit::slices::SLICE;
use meshbrush_core::document::{Price, Pricer, Setting, SettingKind};
use meshbrush_core::paint::StrokePlan;
use meshbrush_mesh::mesh::Progress;

impl Session {
    /// Computes the price of a stroke until `deadline`. Returns whether work is left. `None` cancels.
    pub fn price_stroke(&mut self, plan: Option<StrokePlan>, deadline: Instant) -> bool {
        self.guards.stroke.ask(plan, &self.live.document, &self.live.follower);
        while self.guards.stroke.progress() == Progress::More && Instant::now() < deadline {
            self.guards.stroke.advance(&self.live.document, &self.live.follower, SLICE);
        }
        self.guards.stroke.progress() == Progress::More
    }

    /// Returns the price of the stroke that a click would paint.
    pub fn pricer(&self) -> &Pricer {
        &self.guards.stroke
    }

    /// Returns what the last edit of the size did to the mesh, if it was one of these settings.
    pub fn last_size_effect(&self, kinds: &[SettingKind]) -> Option<SizeEffect> {
        self.guards.size.last_effect(kinds, self.document())
    }

    /// Considers a setting, or none: its price is computed in the coming frames.
    pub fn consider(&mut self, candidate: Option<Setting>) {
        self.guards.size.consider(candidate);
    }

    /// Returns the setting that is considered.
    pub fn considered(&self) -> Option<&Setting> {
        self.guards.size.considered()
    }

    /// Returns the price of the setting that is considered, once known.
    pub fn considered_price(&self) -> Option<Price> {
        self.guards.size.price()
    }

    /// Whether that price is still being computed.
    pub fn considered_progress(&self) -> Progress {
        self.guards.size.progress()
    }

    /// Computes the price of the setting that is considered until `deadline`. Returns whether work is left.
    pub fn price_setting(&mut self, deadline: Instant) -> bool {
        self.guards.size.advance(&self.live.document, &self.live.follower, deadline)
    }
}
