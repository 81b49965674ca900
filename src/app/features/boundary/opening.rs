//! Opens the boundary in one step: along the frame, where the water is deep, in a box, or in polygons.

use std::path::Path;
use std::sync::Arc;

use super::{BOUNDARY, BoundaryCommand};
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, Domain};
use meshbrush_core::layers::DepthSurface;
use meshbrush_io::io::Meter;
use meshbrush_io::io::recipe::Loading;
use meshbrush_io::io::settings::{SavedDomain, SavedOpen, SavedOpenings, SavedSettings};
use meshbrush_kit::kit::Ctx;
use meshbrush_kit::kit::background::{Aim, Background, Outcome};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::text::Grouped;

/// Most names of pieces in a sentence.
const MOST_NAMES: usize = 3;

/// A boundary that was opened somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenedBoundary {
    /// The domain before.
    domain: Domain,
    /// Its names, splits and types.
    marks: Arc<BoundaryMarks>,
    /// The change of the document; `None` where all of it was open already.
    setting: Option<Setting>,
    /// A sentence about it for a person.
    news: String,
}

/// Opens the boundary of the document where an entry says.
pub fn open_boundary(session: &Session, background: &mut Background, entry: SavedOpen) {
    let settings = session.document().settings().clone();
    let shown = match &entry {
        SavedOpen::Polygons(file) => file.clone(),
        _ => "the boundary".into(),
    };
    background.start(Aim::Read, Path::new(&shown), move |meter| match opened(settings, entry, meter) {
        Ok(opened) => Outcome::PartRead(vec![Command::from(BoundaryCommand::SetOpened(Box::new(opened)))]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Changes the document, unless its boundary was edited meanwhile, and shows the pieces.
pub fn set_opened(opened: OpenedBoundary, ctx: &mut Ctx<'_>) {
    let settings = ctx.session.document().settings();
    if settings.domain != opened.domain || settings.boundary_marks != opened.marks || ctx.session.is_cutting()
    {
        let problem = "Nothing was opened, as the boundary was edited in the meantime. Open it again.";
        return ctx.session.report(problem);
    }
    ctx.tools.select(&BOUNDARY);
    if let Some(setting) = opened.setting {
        ctx.session.end_gesture();
        ctx.session.set(setting);
        ctx.session.end_gesture();
    }
    ctx.session.tell(opened.news);
}

/// Returns the boundary of settings, opened where an entry says.
///
/// # Errors
/// Fails with a sentence when the entry opens nothing, or needs something that the document lacks.
fn opened(before: Settings, entry: SavedOpen, meter: &Meter) -> Result<OpenedBoundary, String> {
    let Some(pieces) = BoundaryPieces::of_domain(&before.domain, &before.boundary_marks) else {
        return Err("The boundary of a domain that is given by a formula is that of its mesh, and cannot be opened in one \
                    step. Click its pieces with the tool Boundary, and set their “Type” in the tab Domain."
            .into());
    };
    if matches!(entry, SavedOpen::Deeper(_)) && DepthSurface::of(&before.layers).is_none() {
        return Err(
            "There are no depths in this document. Add a grid of them with “Add data…” in the menu File, as \
                    “Depth of water”."
                .into(),
        );
    }
    let open = SavedOpenings(vec![entry]);
    let asked =
        SavedSettings { domain: SavedDomain { open, ..SavedDomain::default() }, ..SavedSettings::default() };
    let mut after = before.clone();
    let notes = asked.open_boundary_of(&mut after, &Loading::for_document(meter));
    let notes = notes.map_err(|error| error.to_string())?;
    if !notes.is_empty() {
        return Err(notes.join(" "));
    }
    let (domain, boundary_marks) = (after.domain, after.boundary_marks);
    let news = news_of(&pieces, BoundaryPieces::of_domain(&domain, &boundary_marks).as_ref());
    let is_same = domain == before.domain && boundary_marks == before.boundary_marks;
    let setting = if domain == before.domain {
        Setting::BoundaryMarks((*boundary_marks).clone())
    } else {
        Setting::Outline { domain, boundary_marks }
    };
    let setting = (!is_same).then_some(setting);
    Ok(OpenedBoundary { domain: before.domain, marks: before.boundary_marks, setting, news })
}

/// Says which pieces are open that were not.
fn news_of(before: &BoundaryPieces, after: Option<&BoundaryPieces>) -> String {
    let was_open = |at| {
        let piece = before.nearest(at, before.tolerance());
        piece.is_some_and(|(piece, _)| before.list()[piece].boundary_type().is_open())
    };
    let open = after.into_iter().flat_map(BoundaryPieces::list);
    let open = open.filter(|piece| piece.boundary_type().is_open() && !was_open(piece.middle()));
    let names: Vec<&str> = open.map(|piece| piece.name.as_str()).collect();
    let count = match names.len() {
        0 => return "Nothing was opened: that part of the boundary is open already.".into(),
        1 => "1 piece of the boundary was opened".to_owned(),
        many => format!("{} pieces of the boundary were opened", Grouped(many)),
    };
    let first = names[..names.len().min(MOST_NAMES)].join(", ");
    let others = if names.len() > MOST_NAMES { ", …" } else { "" };
    format!("{count}: {first}{others}.")
}
