//! Finding a text by a few letters or words.

/// A text that matches a query.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextMatch {
    /// How well it matches, best first: 0 if the text begins with the query; 1 if a word does; 2 if each
    /// word of the query begins a word of the text, in any order; 3 if each is a part of the text; 4 if some
    /// are among its other words; 5 if only the letters occur in this order.
    pub rank: u8,
    /// The characters of the text that match, ascending.
    pub places: Vec<usize>,
}

/// Finds `query` in `text`, or in `words`, which are other words for it. Capitals do not matter, nor do
/// spaces around the query. An empty query is found everywhere.
pub fn find(query: &str, text: &str, words: &str) -> Option<TextMatch> {
    let [whole, text, words] =
        [query.trim(), text, words].map(|text| text.chars().map(lower).collect::<Vec<char>>());
    let word = (0..text.len()).find(|&at| is_word_start(&text, at) && text[at..].starts_with(&whole));
    if let Some(at) = word {
        return Some(TextMatch { rank: u8::from(at > 0), places: (at..at + whole.len()).collect() });
    }
    find_each(&whole, &text, &words).or_else(|| in_order(&whole, &text))
}

/// Finds each word of a query by itself: at the start of a word, anywhere, or among the other words.
fn find_each(query: &[char], text: &[char], words: &[char]) -> Option<TextMatch> {
    let (mut rank, mut places) = (2, Vec::new());
    for part in query.split(|letter| letter.is_whitespace()).filter(|part| !part.is_empty()) {
        let at_start = |text: &[char]| {
            (0..text.len()).find(|&at| is_word_start(text, at) && text[at..].starts_with(part))
        };
        let anywhere = || (0..text.len()).find(|&at| text[at..].starts_with(part));
        if let Some(at) = at_start(text) {
            places.extend(at..at + part.len());
        } else if at_start(words).is_some() {
            rank = rank.max(4);
        } else {
            let at = anywhere().filter(|_| part.len() > 1)?;
            rank = rank.max(3);
            places.extend(at..at + part.len());
        }
    }
    places.sort_unstable();
    places.dedup();
    Some(TextMatch { rank, places })
}

fn in_order(query: &[char], text: &[char]) -> Option<TextMatch> {
    let mut rest = text.iter().enumerate();
    let letters = query.iter().filter(|letter| !letter.is_whitespace());
    let places = letters.map(|letter| rest.find(|(_, other)| *other == letter).map(|(at, _)| at));
    Some(TextMatch { rank: 5, places: places.collect::<Option<_>>()? })
}

fn is_word_start(text: &[char], at: usize) -> bool {
    at == 0 || !text[at - 1].is_alphanumeric()
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
        find(query, text, "").map(|found| found.rank)
    }

    #[test]
    fn the_start_of_the_text_wins_then_that_of_a_word() {
        assert_eq!(rank("save", "Save as"), Some(0));
        assert_eq!(rank("as", "Save as"), Some(1));
        assert_eq!(rank("av", "Save as"), Some(3), "a part of a word");
        assert_eq!(rank("va", "Save as"), Some(5), "letters only");
        assert_eq!(rank("", "Save"), Some(0));
    }

    #[test]
    fn words_are_found_in_any_order_and_by_their_parts() {
        assert_eq!(rank("layer add", "Add layer: threats"), Some(2));
        assert_eq!(rank("lay thr", "Add layer: threats"), Some(2));
        assert_eq!(rank("ayer thr", "Add layer: threats"), Some(3));
        assert_eq!(find("thr add", "Add layer: threats", "").unwrap().places, [0, 1, 2, 11, 12, 13]);
        assert_eq!(rank("layer save", "Add layer: threats"), None);
    }

    #[test]
    fn other_words_are_found_after_those_of_the_text() {
        let found = find("export svg", "Export mesh…", "vtu svg").unwrap();
        assert_eq!((found.rank, found.places), (4, vec![0, 1, 2, 3, 4, 5]));
        assert_eq!(find("sv", "Export mesh…", "vtu svg").map(|found| found.rank), Some(4));
        assert_eq!(find("vg", "Export mesh…", "vtu svg"), None, "only the start of a word");
    }

    #[test]
    fn letters_must_occur_in_their_order() {
        assert_eq!(find("fv", "Fit view", "").map(|found| found.places), Some(vec![0, 4]));
        assert_eq!(rank("ovr", "Fit view"), None);
        assert_eq!(rank("xyz", "Export"), None);
    }

    #[test]
    fn capitals_and_outer_spaces_do_not_matter() {
        assert_eq!(find(" SAVE as ", "save as", "").map(|found| found.places.len()), Some(7));
        assert_eq!(rank("é", "É"), Some(0));
    }
}
