//! Finding a command by a few letters.

/// A text that matches a query.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// 0 if the text begins with the query, 1 if a word does, 2 if only the letters occur in this order.
    pub rank: u8,
    /// The characters of the text that match, ascending.
    pub places: Vec<usize>,
}

/// Finds `query` in `text`: at the start, else at the start of a word, else letter by letter. Capitals do not
/// matter, nor do spaces around the query. An empty query is found everywhere.
pub fn find(query: &str, text: &str) -> Option<Found> {
    let [query, text] = [query.trim(), text].map(|text| text.chars().map(lower).collect::<Vec<char>>());
    let starts = |at: usize| text[at..].starts_with(&query);
    let is_word_start = |at: usize| at == 0 || !text[at - 1].is_alphanumeric();
    let word = (0..text.len()).find(|&at| is_word_start(at) && starts(at));
    if let Some(at) = word {
        return Some(Found { rank: u8::from(at > 0), places: (at..at + query.len()).collect() });
    }
    let mut rest = text.iter().enumerate();
    let letters = query.iter().filter(|letter| !letter.is_whitespace());
    let places = letters.map(|letter| rest.find(|(_, other)| *other == letter).map(|(at, _)| at));
    Some(Found { rank: 2, places: places.collect::<Option<_>>()? })
}

/// Returns whether a text contains a query at the start of a word or anywhere within it. Capitals do not
/// matter.
pub fn matches(query: &str, text: &str) -> bool {
    text.to_lowercase().contains(&query.trim().to_lowercase())
}

fn lower(c: char) -> char {
    c.to_lowercase().next().unwrap_or(c)
}

#[cfg(test)]
mod tests {
    use super::find;

    fn rank(query: &str, text: &str) -> Option<u8> {
        find(query, text).map(|found| found.rank)
    }

    #[test]
    fn the_start_of_the_text_wins_then_that_of_a_word() {
        assert_eq!(rank("save", "Save as"), Some(0));
        assert_eq!(rank("as", "Save as"), Some(1));
        assert_eq!(rank("va", "Save as"), Some(2));
        assert_eq!(rank("", "Save"), Some(0));
    }

    #[test]
    fn letters_must_occur_in_their_order() {
        assert_eq!(find("fv", "Fit view").map(|found| found.places), Some(vec![0, 4]));
        assert_eq!(rank("ovr", "Fit view"), None);
        assert_eq!(rank("xyz", "Export"), None);
    }

    #[test]
    fn capitals_and_outer_spaces_do_not_matter() {
        assert_eq!(find(" SAVE as ", "save as").map(|found| found.places.len()), Some(7));
        assert_eq!(rank("é", "É"), Some(0));
    }
}
