//! What the domain tool does. An outline is cut off the window's thread: one of many corners takes longer than a frame.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use eframe::egui::Context;

use super::App;
use super::command::DomainCommand;
use super::tools::{DomainToolMode, Tool};
use crate::document::Setting;
use crate::domain::{CutShape, Domain};
use crate::geometry::Rect;

/// How long a frame waits for a cut: those of small outlines are seen in the frame that they were made in.
pub const PATIENCE: Duration = Duration::from_millis(3);

/// One edit of the outline.
#[derive(Clone, Debug, PartialEq)]
enum Cut {
    /// Adds a shape (`true`), or takes it away.
    Reshape(CutShape, bool),
    /// Another rectangle for the coarse grid, in world units.
    Frame(Rect),
}

impl Cut {
    /// What it makes of a domain that has an outline.
    fn of(&self, domain: &Domain) -> Option<Domain> {
        match self {
            Self::Reshape(cut_shape, adds) => domain.reshaped(cut_shape, *adds),
            Self::Frame(bounds) => Some(domain.with_bounds(*bounds)),
        }
    }

    /// Takes in the next one, where both are made by one stroke of the brush.
    fn join(&mut self, next: &Self) -> bool {
        let (Self::Reshape(cut_shape, adds), Self::Reshape(next, next_adds)) = (self, next) else {
            return false;
        };
        *adds == *next_adds && cut_shape.join(next)
    }
}

/// What is to happen to the domain, in this order.
#[derive(Debug)]
enum Step {
    Cut(Cut),
    /// The gesture ends: what follows is an entry of its own.
    EndGesture,
}

/// A cut being made.
struct UnderWay {
    cut: Cut,
    /// What is cut.
    domain: Domain,
    result: Receiver<Option<Domain>>,
}

/// Edits of the outline on their way to the document.
#[derive(Default)]
pub struct Cutter {
    waiting: VecDeque<Step>,
    under_way: Option<UnderWay>,
}

impl Cutter {
    /// Whether all edits have come to the document.
    pub fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.under_way.is_none()
    }

    /// The shapes that are not cut yet.
    pub fn cut_shapes(&self) -> impl Iterator<Item = &CutShape> {
        let waiting = self.waiting.iter().filter_map(|step| match step {
            Step::Cut(cut) => Some(cut),
            Step::EndGesture => None,
        });
        self.under_way.iter().map(|work| &work.cut).chain(waiting).filter_map(|cut| match cut {
            Cut::Reshape(cut_shape, _) => Some(cut_shape),
            Cut::Frame(_) => None,
        })
    }

    fn push(&mut self, cut: Cut) {
        if let Some(Step::Cut(last)) = self.waiting.back_mut()
            && last.join(&cut)
        {
            return;
        }
        self.waiting.push_back(Step::Cut(cut));
    }

    fn begin(&mut self, cut: Cut, domain: &Domain, ctx: &Context) {
        let (sender, result) = channel();
        let (theirs, before, ctx) = (cut.clone(), domain.clone(), ctx.clone());
        thread::spawn(move || {
            // Nobody waits for what was given up.
            let _ = sender.send(theirs.of(&before));
            ctx.request_repaint();
        });
        self.under_way = Some(UnderWay { cut, domain: domain.clone(), result });
    }
}

impl App {
    pub(super) fn execute_on_domain(&mut self, command: DomainCommand) {
        match command {
            DomainCommand::Reshape(cut_shape, adds) => self.reshape(cut_shape, adds),
            DomainCommand::AddCorner(corner) => self.outline.push(corner),
            DomainCommand::CloseOutline => self.close_outline(),
            DomainCommand::Shape(shape) => self.take_domain_shape(shape),
            DomainCommand::Adds(adds) => self.tools.domain_adds = adds,
            DomainCommand::Frame(bounds) => self.frame(bounds),
        }
    }

    fn take_domain_shape(&mut self, shape: DomainToolMode) {
        self.take_tool(Tool::Domain);
        self.tools.domain_shape = shape;
    }

    fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        if self.session.document().settings().domain.formula().is_some() {
            self.session.report(
                "The domain is given by a formula, and a formula has no outline to cut. Empty the row \"Domain where\" to start \
                 from the whole rectangle.",
            );
        } else {
            self.cutter.push(Cut::Reshape(cut_shape, adds));
        }
        self.hints.did(Tool::Domain);
    }

    fn close_outline(&mut self) {
        let ring = std::mem::take(&mut self.outline);
        if ring.len() >= 3 {
            self.reshape(CutShape::Ring(ring), self.tools.domain_adds);
            self.end_gesture();
        }
    }

    fn frame(&mut self, bounds: Rect) {
        if self.session.document().settings().domain.region().is_some() {
            self.cutter.push(Cut::Frame(bounds));
        } else {
            self.session.set(Setting::Bounds(bounds));
        }
        self.end_gesture();
        self.hints.did(Tool::Domain);
    }

    /// Ends a gesture with a setting, after the cuts that belong to it.
    pub(super) fn end_gesture(&mut self) {
        if self.cutter.is_idle() {
            self.session.document_mut().end_gesture();
        } else {
            self.cutter.waiting.push_back(Step::EndGesture);
        }
    }

    /// Gives up the cuts that have not come to the document, and tells whether the present gesture consists of nothing else.
    pub(super) fn give_up_cuts(&mut self) -> bool {
        let nothing_else = !self.cutter.is_idle() && !self.session.document().is_in_gesture();
        let cutter = std::mem::take(&mut self.cutter);
        if cutter.waiting.iter().any(|step| matches!(step, Step::EndGesture)) {
            // The brush was lifted: what is cut already is an entry of its own.
            self.session.document_mut().end_gesture();
        }
        nothing_else
    }

    /// Takes in the cuts that are made, begins those that wait, and tells whether one is left.
    pub(super) fn follow_cuts(&mut self, ctx: &Context, patience: Duration) -> bool {
        let deadline = Instant::now() + patience;
        loop {
            if let Some(work) = &self.cutter.under_way {
                let patience = deadline.saturating_duration_since(Instant::now());
                match work.result.recv_timeout(patience) {
                    Err(RecvTimeoutError::Timeout) => return true,
                    result => self.take_in_cut(result.ok().flatten()),
                }
            }
            match self.cutter.waiting.pop_front() {
                None => return false,
                Some(Step::EndGesture) => self.session.document_mut().end_gesture(),
                Some(Step::Cut(cut)) => {
                    self.cutter.begin(cut, &self.session.document().settings().domain, ctx);
                }
            }
        }
    }

    /// Puts a cut domain in the place of the one that it was cut from. Where that is another one by now, the cuts are given up.
    fn take_in_cut(&mut self, cut: Option<Domain>) {
        let Some(work) = self.cutter.under_way.take() else { return };
        match cut {
            Some(domain) if self.session.document().settings().domain == work.domain => {
                self.session.set(Setting::Domain(domain));
            }
            _ => {
                self.give_up_cuts();
            }
        }
    }
}
