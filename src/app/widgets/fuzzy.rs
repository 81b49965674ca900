//! Finding a command by a few of its letters.

/// A text that matches what was typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Match {
    /// Larger is better; comparable only for the same query.
    pub score: i32,
    /// The characters of the text that were matched, ascending.
    pub places: Vec<usize>,
}

const WORD_START: i32 = 8;
const RUN: i32 = 9;
const FIRST: i32 = 4;

/// Matches the characters of `query` in their order with characters of `text`, wherever that is best: starts of words
/// and runs of characters count most. Capitals do not matter; spaces in the query are skipped. An empty query matches
/// everything with score 0.
///
/// The best placement is found exactly, in time proportional to both lengths.
pub fn fuzzy_match(query: &str, text: &str) -> Option<Match> {
    let query: Vec<char> = query.chars().filter(|c| !c.is_whitespace()).map(lower).collect();
    let text: Vec<char> = text.chars().map(lower).collect();
    let mut rows: Vec<Vec<Option<Step>>> = Vec::with_capacity(query.len());
    for (i, wanted) in query.iter().enumerate() {
        let previous = i.checked_sub(1).map(|above| rows[above].as_slice());
        rows.push(row(*wanted, &text, previous));
    }
    let Some(last) = rows.last() else {
        return Some(Match { score: 0, places: Vec::new() });
    };
    let (end, step) = best(last.iter().enumerate())?;
    let length = i32::try_from(text.len()).unwrap_or(i32::MAX / 2);
    Some(Match { score: step.score * 8 - length, places: trace(&rows, end) })
}

/// A query character placed on a text character.
#[derive(Clone, Copy, Debug)]
struct Step {
    score: i32,
    before: Option<usize>,
}

/// All placements of one query character, after those of the characters before it.
fn row(wanted: char, text: &[char], previous: Option<&[Option<Step>]>) -> Vec<Option<Step>> {
    let mut reached: Option<(usize, Step)> = None;
    let mut row = Vec::with_capacity(text.len());
    for (j, c) in text.iter().enumerate() {
        let here = (*c == wanted).then(|| bonus(text, j));
        row.push(match previous {
            None => here.map(|score| Step { score, before: None }),
            Some(previous) => here.and_then(|score| step(score, j, previous, reached)),
        });
        reached = better(reached, previous.and_then(|p| p[j]).map(|step| (j, step)));
    }
    row
}

/// The best step to place `j`: right after the last one, or from the best place before.
fn step(score: i32, j: usize, previous: &[Option<Step>], reached: Option<(usize, Step)>) -> Option<Step> {
    let run = j.checked_sub(1).and_then(|left| previous[left].map(|step| (left, step.score + RUN)));
    let jump = reached.map(|(place, step)| (place, step.score));
    let (place, before) = run.into_iter().chain(jump).max_by_key(|(_, score)| *score)?;
    Some(Step { score: before + score, before: Some(place) })
}

fn bonus(text: &[char], j: usize) -> i32 {
    match j.checked_sub(1).map(|left| text[left].is_alphanumeric()) {
        None => WORD_START + FIRST,
        Some(false) => WORD_START,
        Some(true) => 1,
    }
}

fn better(a: Option<(usize, Step)>, b: Option<(usize, Step)>) -> Option<(usize, Step)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.1.score > a.1.score { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// The first placement with the highest score.
fn best<'a>(steps: impl Iterator<Item = (usize, &'a Option<Step>)>) -> Option<(usize, Step)> {
    steps.fold(None, |best, (j, step)| better(best, step.map(|step| (j, step))))
}

fn trace(rows: &[Vec<Option<Step>>], end: usize) -> Vec<usize> {
    let mut places = vec![end];
    for row in rows.iter().rev() {
        let place = places[places.len() - 1];
        places.extend(row[place].and_then(|step| step.before));
    }
    places.reverse();
    places
}

fn lower(c: char) -> char {
    c.to_lowercase().next().unwrap_or(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn score(query: &str, text: &str) -> i32 {
        fuzzy_match(query, text).map_or(i32::MIN, |found| found.score)
    }

    #[test]
    fn letters_must_come_in_order() {
        assert!(fuzzy_match("ovr", "Fit view").is_none());
        assert!(fuzzy_match("xyz", "Export").is_none());
        assert_eq!(fuzzy_match("", "Export").map(|found| found.score), Some(0));
    }

    #[test]
    fn starts_of_words_and_runs_win() {
        assert_eq!(fuzzy_match("fv", "Fit view").map(|found| found.places), Some(vec![0, 4]));
        assert_eq!(fuzzy_match("expo", "Next export").map(|found| found.places), Some(vec![5, 6, 7, 8]));
        assert!(score("undo", "Undo") > score("undo", "Turn down edges often"));
        assert!(score("save", "Save") > score("save", "Save as"));
        assert!(score("sa", "Save as") > score("sa", "Classic mesh"));
    }

    #[test]
    fn capitals_and_spaces_do_not_matter() {
        assert_eq!(fuzzy_match("SAVE as", "save as").map(|found| found.places.len()), Some(6));
        assert!(fuzzy_match("é", "É").is_some());
    }
}
