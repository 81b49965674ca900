//! Why a part of a line is not on edges, in a sentence.

use meshbrush_core::outline::{LineFit, LineProblem, UnresolvedPlace};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// Returns the fit of a line by its number; `None` while the mesh has not followed the document.
pub fn fit_in(session: &Session, number: usize) -> Option<&LineFit> {
    let line = session.document().settings().lines.get(number)?;
    let fit = session.derived()?.line_fits.get(number)?;
    (fit.name == line.name).then_some(fit)
}

/// Says why a part is not on edges, and what helps.
pub fn reason(part: &UnresolvedPlace, unit: LengthUnit) -> String {
    let length = format::length(part.length, unit);
    match (part.problem, part.diameter) {
        (LineProblem::TooCoarse, Some(diameter)) => {
            let diameter = format::length(diameter, unit);
            format!("Too coarse: {length} on no edge. Triangles of about {diameter} would do.")
        }
        (LineProblem::TooCoarse, None) => {
            format!("Too coarse: {length} on no edge. Make the mesh finer here.")
        }
        (LineProblem::OutsideDomain, _) => format!("Outside the domain: {length} on no edge."),
        (LineProblem::Tangled, _) => {
            format!("Tangled: {length} crosses other lines again and again. Move one of them.")
        }
        (LineProblem::NotFinite, _) => "A corner is not a finite number. Delete it.".into(),
        (LineProblem::NoLength, _) => "All corners are at one place. Delete the line.".into(),
        (LineProblem::Removed, _) => {
            format!("Removed: {length} in a part of the mesh that does not stay.")
        }
        _ => format!("{length} on no edge."),
    }
}
