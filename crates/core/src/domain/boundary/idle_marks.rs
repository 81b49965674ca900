//! What a person should know about a boundary, in words: marks that have no effect, and that nothing is open.

use glam::DVec2;

use super::{BoundaryMarks, BoundaryPieces};
use crate::text::Number;

impl BoundaryPieces {
    /// Returns a sentence for a person where no part of the boundary is open; `None` where some is.
    pub fn closed_note(&self) -> Option<String> {
        if self.list().iter().any(|piece| piece.boundary_type().is_open()) {
            return None;
        }
        let longest = self.list().iter().max_by(|a, b| a.length().total_cmp(&b.length()))?;
        Some(format!(
            "There is no open boundary: no rectangle seems to have cut the outline off, and no piece is of the type open. \
             The longest piece is “{}”. If the sea goes on somewhere, say where: --open, `open` in the table [domain] of a \
             recipe or in Python, or the types of the boundary's pieces. If the polygons are land, --land (`land` in a recipe, \
             “Sea around this land” in the window, Domain.sea in Python) meshes the sea around them.",
            longest.name
        ))
    }

    /// Returns a sentence for a person for each mark that has no effect: it is not on the boundary, or on a
    /// piece for which another one counts. These are the pieces with the marks.
    pub fn idle_marks(&self, marks: &BoundaryMarks) -> Vec<String> {
        let mut notes = Vec::new();
        let mut named = vec![None; self.list().len()];
        for (place, name) in &marks.names {
            let at = in_words(*place);
            match self.nearest(*place, self.tolerance()) {
                None => {
                    notes.push(format!("The name “{name}” at {at} is not on the boundary: it names nothing."))
                }
                Some((piece, _)) => match named[piece].replace(name) {
                    Some(first) if first != name => {
                        named[piece] = Some(first);
                        notes.push(format!(
                            "The names “{first}” and “{name}” (at {at}) are on one piece of the boundary: the first counts."
                        ));
                    }
                    _ => {}
                },
            }
        }
        let mut typed = vec![None; self.list().len()];
        for (place, of_piece) in &marks.types {
            let (at, word) = (in_words(*place), of_piece.word());
            match self.nearest(*place, self.tolerance()) {
                None => {
                    notes.push(format!("The type “{word}” at {at} is not on the boundary: no piece has it."))
                }
                Some((piece, _)) => match typed[piece].replace(*of_piece) {
                    Some(first) if first != *of_piece => {
                        typed[piece] = Some(first);
                        let (first, name) = (first.word(), &self.list()[piece].name);
                        notes.push(format!(
                            "The types “{first}” and “{word}” (at {at}) are on one piece of the boundary, “{name}”: the first counts."
                        ));
                    }
                    _ => {}
                },
            }
        }
        let is_off = |place: &&DVec2| self.nearest(**place, self.tolerance()).is_none();
        notes.extend(marks.splits.iter().filter(is_off).map(|&place| {
            format!("The split at {} is not on the boundary: it splits nothing.", in_words(place))
        }));
        notes
    }
}

fn in_words(place: DVec2) -> String {
    format!("{}, {}", Number(place.x), Number(place.y))
}
