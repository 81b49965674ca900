//! Shortens texts from files for messages: a word of a file may be as long as the file.

use std::borrow::Cow;

/// Most characters between two quotation marks of a message.
const LONGEST_QUOTE: usize = 60;
/// Most characters of a line of a message, apart from what follows its last long quotation.
const LONGEST_LINE: usize = 500;
/// Characters at the end of a line that is too long, which stay: what would help is said there.
const END_OF_LINE: usize = 150;

/// Most characters of a word of a message: of a name with all its folders.
const LONGEST_WORD: usize = 400;

/// Returns a message as a terminal may get it: names in it cannot move the cursor, change colours, or turn
/// the direction of writing, and long words are shortened in their middle.
///
/// ```
/// # use meshbrush_mesh::text::printable;
/// assert_eq!(printable("a\u{1b}[31m.vtu\n\u{202e}b"), "a\\u{1b}[31m.vtu\n\\u{202e}b");
/// ```
pub fn printable(message: &str) -> String {
    message.split_inclusive([' ', '\n']).map(|word| escaped(&shortened_word(word))).collect()
}

fn shortened_word(word: &str) -> Cow<'_, str> {
    let count = word.chars().count();
    if count <= LONGEST_WORD {
        return word.into();
    }
    let start: String = word.chars().take(LONGEST_WORD / 2).collect();
    let end: String = word.chars().skip(count - LONGEST_WORD / 4).collect();
    format!("{start}…{end}").into()
}

/// Escapes what controls a terminal or the direction of writing, except the end of a line.
fn escaped(text: &str) -> String {
    let is_direction = |c| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let controls = |c: char| c != '\n' && (c.is_control() || is_direction(c));
    let mut escaped = String::new();
    for c in text.chars() {
        match controls(c) {
            true => escaped.extend(c.escape_unicode()),
            false => escaped.push(c),
        }
    }
    escaped
}

/// Returns at most `most` characters of a text from a file, escaped, with an ellipsis if more follow.
pub fn excerpt(most: usize, text: &str) -> String {
    let end = text.char_indices().nth(most).map_or(text.len(), |(end, _)| end);
    let more = if end < text.len() { "…" } else { "" };
    format!("{}{more}", text[..end].escape_debug())
}

/// Returns at most 60 characters of a name that may come from a file, unchanged, with an ellipsis if more
/// follow.
pub fn short_name(name: &str) -> Cow<'_, str> {
    match name.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}…", &name[..end]).into(),
        None => name.into(),
    }
}

/// Shortens a message whose parts between quotation marks may come from a file: to at most 60 characters of
/// each such part, and to the beginning and the end of lines without quotation marks. Parsers repeat
/// unexpected text in their messages.
///
/// ```text
/// invalid type: string "aaaaaaaaaaaaaaaaaaaa", expected a number
/// invalid type: string "aaaaaa…", expected a number
/// ```
pub fn abridged(message: &str) -> String {
    let lines = message.split('\n').map(|line| with_ends(&with_short_quotes(line)));
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the beginning and the end of a line that is too long.
fn with_ends(line: &str) -> String {
    let count = line.chars().count();
    if count <= LONGEST_LINE {
        return line.to_owned();
    }
    let start: String = line.chars().take(LONGEST_LINE - END_OF_LINE).collect();
    let end: String = line.chars().skip(count - END_OF_LINE).collect();
    format!("{start}…{end}")
}

fn with_short_quotes(line: &str) -> String {
    let mut shortened = String::new();
    let mut rest = line;
    while let Some(open) = rest.find(['"', '`', '“']) {
        let mark = rest[open..].chars().next().expect("a mark was found");
        let (before, quoted) = rest.split_at(open + mark.len_utf8());
        shortened.push_str(before);
        let end = end_of_quote(quoted, mark);
        let (text, after) = quoted.split_at(end.unwrap_or(0));
        match text.char_indices().nth(LONGEST_QUOTE) {
            // Half of an escape sequence is not shown.
            Some((cut, _)) => shortened.extend([text[..cut].trim_end_matches('\\'), "…"]),
            None => shortened.push_str(text),
        }
        let closing = after.chars().next().filter(|_| end.is_some()).map_or(0, char::len_utf8);
        shortened.push_str(&after[..closing]);
        rest = &after[closing..];
    }
    shortened + rest
}

/// Returns the end of the text after an opening quotation mark.
fn end_of_quote(quoted: &str, mark: char) -> Option<usize> {
    let mut is_escaped = false;
    for (at, c) in quoted.char_indices() {
        match (mark, c) {
            ('"', '"') if !is_escaped => return Some(at),
            ('`', '`') | ('“', '”') => return Some(at),
            _ => {}
        }
        is_escaped = c == '\\' && !is_escaped;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_quotations_are_cut_and_the_rest_stays() {
        let long = "a".repeat(1000);
        let short = "a".repeat(60) + "…";
        for [open, close] in [["\"", "\""], ["`", "`"], ["“", "”"]] {
            let of = |text: &str| format!("a {open}{text}{close} is no {open}b{close}.\nNext");
            assert_eq!(abridged(&of(&long)), of(&short));
            assert_eq!(abridged(&of("word")), of("word"));
        }
        assert_eq!(abridged(r#"a "b\"c" and "d\\" is"#), r#"a "b\"c" and "d\\" is"#);
        assert_eq!(abridged(&format!("\"\\\"{long}\" is")), format!("\"\\\"{}…\" is", "a".repeat(58)));
        // Without an end, or without marks.
        for text in [format!("it's `{long}. The end."), format!("{long}. The end.")] {
            let abridged = abridged(&text);
            assert!(abridged.chars().count() <= LONGEST_LINE + 1 && abridged.ends_with(". The end."));
        }
        assert_eq!(abridged("an odd \" or ` or “"), "an odd \" or ` or “");
        assert_eq!(excerpt(3, "ab\nc"), "ab\\n…");
        assert_eq!(excerpt(3, "äöü"), "äöü");
        assert_eq!((&*short_name("O'Brien “ä”"), &*short_name(&long)), ("O'Brien “ä”", &*short));
    }
}
