//! Messages on the canvas: news, failures, and the standing one while the mesh stops short of the document.

use super::brake::Need;
use super::command::{Command, EditCommand};
use meshbrush_core::build::BuildError;
use meshbrush_mesh::mesh::RefineError;
use meshbrush_mesh::text::Bytes;
use meshbrush_ui::widgets::format;

/// A message on the canvas. News disappears after some seconds; a failure stays until it is dismissed or its
/// cause is gone.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// Distinguishes it from all other messages of the session.
    pub number: u64,
    /// Whether it reports a failure; else it is news.
    pub failed: bool,
    /// The version of the document in which an edit failed. In another version the failure is out of date.
    failed_edit_of: Option<u64>,
    /// A sentence.
    pub text: String,
    /// The button of the notice, if it has one.
    pub offer: Option<Offer>,
    /// Another answer, where the notice is a question.
    pub other: Option<Offer>,
}

/// A button in a message that does what would help.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// The text on the button.
    pub label: &'static str,
    /// The command that the button sends.
    pub command: Command,
}

/// The messages of a session.
#[derive(Clone, Debug, Default)]
pub struct Notices {
    latest: Option<Notice>,
    /// How many messages there were.
    count: u64,
    /// Says that the mesh stopped short of the document, as long as that is so.
    standing: Option<Notice>,
    /// Asks whether an edit is to be applied, until that is answered, and what it needs.
    question: Option<(Need, Notice)>,
}

impl Notices {
    /// Returns the message to show.
    pub fn shown(&self) -> Option<&Notice> {
        let question = self.question.as_ref().map(|(_, notice)| notice);
        question.or(self.latest.as_ref()).or(self.standing.as_ref())
    }

    /// Returns whether the message cannot be dismissed. It disappears once mesh and document agree.
    pub fn shown_stands(&self) -> bool {
        self.question.is_some() || self.latest.is_none() && self.standing.is_some()
    }

    /// Asks whether the mesh, which had `before` triangles, is to have many more.
    pub fn ask(&mut self, need: Need, before: Option<usize>, budget: u64) {
        if self.question.as_ref().is_some_and(|(asked, _)| *asked == need) {
            return;
        }
        let notice = self.numbered(false, None, question(need, before, budget));
        let apply = Command::from(EditCommand::ApplyAnyway);
        let keep = Command::from(EditCommand::KeepMesh);
        let offer = Some(Offer { label: "Keep the mesh", command: keep });
        let other = Some(Offer { label: "Apply anyway", command: apply });
        self.question = Some((need, Notice { offer, other, ..notice }));
    }

    /// The question is answered, or no longer open.
    pub fn end_question(&mut self) {
        self.question = None;
    }

    /// Shows news.
    pub fn tell(&mut self, text: String) {
        self.latest = Some(self.numbered(false, None, text));
    }

    /// Shows news, and offers what else can be done.
    pub fn tell_with_offer(&mut self, text: String, offer: Offer) {
        self.latest = Some(Notice { offer: Some(offer), ..self.numbered(false, None, text) });
    }

    /// Shows a failure.
    pub fn report(&mut self, failure: impl std::fmt::Display) {
        self.latest = Some(self.numbered(true, None, failure.to_string()));
    }

    /// Shows a failure, and offers what would help.
    pub fn report_with_offer(&mut self, failure: impl std::fmt::Display, offer: Offer) {
        let notice = self.numbered(true, None, failure.to_string());
        self.latest = Some(Notice { offer: Some(offer), ..notice });
    }

    /// Shows that an edit of a version of the document failed. The next edit dismisses it.
    pub fn report_edit(&mut self, version: u64, failure: impl std::fmt::Display) {
        self.latest = Some(self.numbered(true, Some(version), failure.to_string()));
    }

    /// Dismisses the failure of an edit that the document has left behind.
    pub fn forget_failed_edit(&mut self, version: u64) {
        self.latest.take_if(|notice| notice.failed_edit_of.is_some_and(|of| of != version));
    }

    fn numbered(&mut self, failed: bool, failed_edit_of: Option<u64>, text: String) -> Notice {
        self.count += 1;
        Notice { number: self.count, failed, failed_edit_of, text, offer: None, other: None }
    }

    /// Dismisses the message, except one that says that the mesh stopped short of the document.
    pub fn dismiss(&mut self) {
        self.latest = None;
    }

    /// Dismisses news; a failure stays until the user dismisses it.
    pub fn dismiss_news(&mut self) {
        self.latest.take_if(|notice| !notice.failed);
    }

    /// Says that the mesh stopped short of the document, until [`Self::end_standing`]. `shows_former`: the
    /// mesh is that of former settings.
    pub fn stand(&mut self, error: &BuildError, shows_former: bool) {
        let text = if shows_former {
            format!("{error}{} Until then the former mesh is shown.", advice(error))
        } else {
            standstill(error)
        };
        self.standing = Some(self.numbered(true, None, text));
    }

    /// Says that the user stopped the update of the mesh, until [`Self::end_standing`].
    /// `awaits_mesh` says that there is none yet.
    pub fn stand_cancelled(&mut self, awaits_mesh: bool) {
        let text = if awaits_mesh {
            "The mesh of the document was not made. The next edit begins with it again."
        } else {
            "The mesh was not updated: it still shows an earlier state. The next edit brings it up to date."
        };
        self.standing = Some(self.numbered(false, None, text.into()));
    }

    /// Mesh and document agree again.
    pub fn end_standing(&mut self) {
        self.standing = None;
    }
}

/// Returns a question before the mesh gets very many triangles.
fn question(need: Need, before: Option<usize>, budget: u64) -> String {
    let triangles = match need {
        Need::About(triangles) => format!("about {}", format::about(triangles)),
        Need::MoreThan(triangles) => format!("more than {}", format::about(triangles)),
    };
    let now = before
        .map_or(String::new(), |before| format!(" The mesh had {} and waits.", format::count(before as u64)));
    let over = match need.triangles() > budget {
        true => format!(" The budgets allow {}, so the edit would be taken back.", format::count(budget)),
        false => String::new(),
    };
    format!("This edit needs {triangles} triangles.{now}{over} Apply it?")
}

/// Returns advice against an error, as a further sentence.
pub fn advice(error: &BuildError) -> &'static str {
    match error {
        BuildError::Refine(RefineError::TooFine { .. }) => {
            " Raise the smallest diameter, or mesh a smaller domain."
        }
        BuildError::Refine(RefineError::OutOfMemory { .. }) => "",
        BuildError::Refine(error) if error.is_over_budget() => {
            " Raise the smallest diameter, paint less, or raise the limit."
        }
        _ => "",
    }
}

/// The message while the mesh does not show all paint.
fn standstill(error: &BuildError) -> String {
    let kept = "what you painted is kept, but the mesh does not show all of it.";
    let helps = "in the Mesh panel or the smallest diameter, erase, or undo.";
    match error {
        BuildError::Refine(RefineError::TooManyTriangles { limit }) => {
            let limit = format::count(*limit as u64);
            format!(
                "The mesh stops at its limit of {limit} triangles: {kept} Raise the triangle budget {helps}"
            )
        }
        BuildError::Refine(RefineError::TooMuchMemory { memory, .. }) => {
            let limit = Bytes(memory.bytes);
            format!(
                "The mesh stops at its limit of {limit} of memory: {kept} Raise the memory budget {helps}"
            )
        }
        other => format!("{other}{} Until then {kept}", advice(other)),
    }
}
