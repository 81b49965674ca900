//! Holds an update of the mesh that would need very many triangles, until a person agrees.
//!
//! ```text
//!            settings change                over FREE_GROWTH             few
//!   ┌──────┐ ──────────────▶ the mesh grows ───────────────▶ Estimating ─────▶ Agreed
//!   │ Free │                       │                             │ many          ▲
//!   └──────┘ ◀──── up to date ─────┘                             ▼               │ Apply anyway
//!       ▲                                                      Asking ───────────┘
//!       └──────────────── the former settings ──── Keep ─────────┘
//! ```
//!
//! So an ordinary edit is applied at once, and the mesh of one that asks for millions has grown by little
//! when the question is asked. Paint has its price beside the brush, and is never held.

use crate::kit::clock::Instant;

use meshbrush_core::build::BuildError;
use meshbrush_core::document::{CountEstimate, Document, Follower, Settings};
use meshbrush_mesh::mesh::Progress;

/// The mesh grows by this many triangles without an estimate: less than a tenth of a second.
const FREE_GROWTH: usize = 100_000;
/// More triangles than this, and more than half as many as there are, are not added without a question.
const MANY: usize = 2_000_000;
/// A mesh of this many triangles does not become ten times as large without a question.
const LARGE: usize = 500_000;
/// Triangles that are looked at in one slice of an estimate.
const ESTIMATE_SLICE: usize = 64;

/// See the head of the module.
#[derive(Default)]
pub struct GrowthGuard {
    /// The last mesh that was up to date.
    settled: Option<Settled>,
    state: GuardState,
    /// What a document would need whose mesh stopped at a budget.
    stopped: Option<Stopped>,
}

struct Stopped {
    /// The revision of the document.
    revision: u64,
    estimate: CountEstimate,
    is_done: bool,
}

struct Settled {
    settings: Settings,
    triangles: usize,
}

#[derive(Default)]
enum GuardState {
    #[default]
    Free,
    /// The triangles that the settings need are estimated.
    Estimating(Box<(Settings, CountEstimate)>),
    /// The mesh of the settings may have `most` triangles.
    Agreed { settings: Box<Settings>, most: usize },
    /// The mesh of the settings waits for an answer.
    Asking { settings: Box<Settings>, need: Need },
}

/// What settings need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// About this many triangles.
    About(u64),
    /// More than this many.
    MoreThan(u64),
}

impl Need {
    /// Returns the number of triangles, as far as it is known.
    pub fn triangles(self) -> u64 {
        let (Self::About(triangles) | Self::MoreThan(triangles)) = self;
        triangles
    }
}

impl GrowthGuard {
    /// Returns how many triangles the mesh of the document may have without a question; `None` while it
    /// waits for an answer or an estimate.
    pub fn most(&mut self, document: &Document, follower: &Follower) -> Option<usize> {
        let wanted = document.settings();
        if follower.is_in_step(document) {
            self.settle(wanted, follower);
        }
        let is_of = |settings: &Settings| settings == wanted;
        match &self.state {
            GuardState::Agreed { settings, most } if is_of(settings) => return Some(*most),
            GuardState::Asking { settings, .. } if is_of(settings) => return None,
            GuardState::Estimating(work) if is_of(&work.0) => return None,
            _ => self.state = GuardState::Free,
        }
        match &self.settled {
            Some(settled) if settled.settings != *wanted => Some(settled.triangles + FREE_GROWTH),
            _ => Some(usize::MAX),
        }
    }

    fn settle(&mut self, settings: &Settings, follower: &Follower) {
        self.state = GuardState::Free;
        let triangles = follower.mesh().raw_triangle_count();
        match &mut self.settled {
            Some(settled) if settled.settings == *settings => settled.triangles = triangles,
            settled => *settled = Some(Settled { settings: settings.clone(), triangles }),
        }
    }

    /// Forgets everything: another document was opened.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    /// Notes that the mesh has reached the number of triangles that it may have.
    pub fn stop(&mut self, document: &Document, follower: &Follower, triangles: usize) {
        let settings = document.settings();
        let was_agreed = matches!(self.state, GuardState::Agreed { .. });
        let estimate = if was_agreed { None } else { CountEstimate::new(settings, follower) };
        let before = self.settled.as_ref().map_or(0, |settled| settled.triangles);
        self.state = match estimate {
            Some(estimate) => GuardState::Estimating(Box::new((settings.clone(), estimate))),
            // There is none for another coarse grid: ask when there are many.
            None if triangles < before + MANY => {
                GuardState::Agreed { settings: Box::new(settings.clone()), most: before + MANY }
            }
            None => {
                let need = Need::MoreThan(triangles as u64);
                GuardState::Asking { settings: Box::new(settings.clone()), need }
            }
        };
    }

    /// Estimates for a while what the settings need. Returns whether that goes on.
    pub fn advance(&mut self, document: &Document, follower: &Follower, deadline: Instant) -> bool {
        let GuardState::Estimating(work) = &mut self.state else { return false };
        let (settings, estimate) = &mut **work;
        loop {
            if estimate.advance(document, follower, ESTIMATE_SLICE) == Progress::Done {
                break;
            }
            if Instant::now() >= deadline {
                return true;
            }
        }
        let (about, settings) = (estimate.triangles(), Box::new(settings.clone()));
        let before = self.settled.as_ref().map_or(0, |settled| settled.triangles);
        self.state = if asks_first(before, about as usize, settings.limits().most_triangles()) {
            GuardState::Asking { settings, need: Need::About(about) }
        } else {
            GuardState::Agreed { settings, most: (2 * about as usize).max(before + MANY) }
        };
        false
    }

    /// Estimates for a while what a document needs whose mesh stopped at a budget. Returns whether that goes
    /// on.
    pub fn advance_stopped(&mut self, document: &Document, follower: &Follower, deadline: Instant) -> bool {
        let Some(BuildError::Refine(_)) = follower.stopped() else {
            self.stopped = None;
            return false;
        };
        let revision = document.revision();
        if self.stopped.as_ref().is_none_or(|stopped| stopped.revision != revision) {
            let estimate = CountEstimate::new(document.settings(), follower);
            self.stopped = estimate.map(|estimate| Stopped { revision, estimate, is_done: false });
        }
        let Some(stopped) = &mut self.stopped else { return false };
        while !stopped.is_done && Instant::now() < deadline {
            let progress = stopped.estimate.advance(document, follower, ESTIMATE_SLICE);
            stopped.is_done = progress == Progress::Done;
        }
        !stopped.is_done
    }

    /// Returns what the document needs, where its mesh has less.
    pub fn need(&self) -> Option<Need> {
        let stopped = self.stopped.as_ref().filter(|stopped| stopped.is_done);
        self.question().or(stopped.map(|stopped| Need::About(stopped.estimate.triangles())))
    }

    /// Returns whether the mesh waits for an estimate or an answer.
    pub fn holds(&self) -> bool {
        matches!(self.state, GuardState::Estimating(_) | GuardState::Asking { .. })
    }

    /// Returns whether the mesh of other settings waits.
    pub fn holds_other(&self, settings: &Settings) -> bool {
        match &self.state {
            GuardState::Asking { settings: held, .. } => **held != *settings,
            GuardState::Estimating(work) => work.0 != *settings,
            GuardState::Free | GuardState::Agreed { .. } => false,
        }
    }

    /// Returns what the settings need, while that is asked.
    pub fn question(&self) -> Option<Need> {
        if let GuardState::Asking { need, .. } = self.state { Some(need) } else { None }
    }

    /// Returns how many triangles the last mesh had that was up to date.
    pub fn triangles_before(&self) -> Option<usize> {
        self.settled.as_ref().map(|settled| settled.triangles)
    }

    /// Lets the mesh follow: a person agreed.
    pub fn agree(&mut self) {
        self.state = match std::mem::take(&mut self.state) {
            GuardState::Asking { settings, .. } => GuardState::Agreed { settings, most: usize::MAX },
            GuardState::Estimating(work) => {
                GuardState::Agreed { settings: Box::new(work.0), most: usize::MAX }
            }
            state => state,
        };
    }

    /// Returns the settings of the last mesh that was up to date.
    pub fn kept_settings(&self) -> Option<&Settings> {
        self.settled.as_ref().map(|settled| &settled.settings)
    }
}

/// Returns whether a mesh of `before` triangles becomes one of about `after` only after a question.
fn asks_first(before: usize, after: usize, budget: usize) -> bool {
    let added = after.saturating_sub(before);
    let many = added > MANY.max(before / 2);
    let tenfold = after > LARGE && after > before.saturating_mul(10);
    added > 0 && (many || tenfold || after > budget)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_more_triangles_are_asked_for_and_few_are_not() {
        const BUDGET: usize = 20_000_000;
        assert!(!asks_first(45_000, 400_000, BUDGET), "ten times of little is little");
        assert!(asks_first(45_000, 501_000, BUDGET), "ten times as many");
        assert!(asks_first(1_000_000, 3_100_000, BUDGET), "millions more");
        assert!(!asks_first(6_000_000, 8_500_000, BUDGET), "less than half as many again");
        assert!(!asks_first(6_000_000, 5_000_000, BUDGET), "fewer");
        assert!(asks_first(45_000, 60_001, 60_000), "over the budget");
        assert!(!asks_first(70_000, 65_000, 60_000), "towards the budget");
    }
}
