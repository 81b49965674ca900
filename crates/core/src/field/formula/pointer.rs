//! A line of text with carets under a part of it.

use std::ops::Range;

use unicode_width::UnicodeWidthChar;

/// Columns of the text that a pointer shows, not counting an ellipsis at either end.
const POINTER_COLUMNS: usize = 68;
/// Columns of the marked part that a pointer shows at most; the other columns show the text around it.
const CARET_COLUMNS: usize = 30;

/// Returns two lines for a fixed-width font: the text, or about 70 columns of it around the marked part, and
/// carets under that part. `span` is in bytes of `source`, on character boundaries; where it is empty there
/// is one caret.
pub fn draw_pointer(source: &str, span: &Range<usize>) -> String {
    let shown = window(source, span);
    let text = |range: Range<usize>| source[range].chars().map(printable).collect::<String>();
    let ellipsis = |cut: bool| if cut { "…" } else { "" };

    let before = format!("{}{}", ellipsis(shown.start > 0), text(shown.start..span.start));
    let marked = text(span.start..span.end.min(shown.end));
    let after = format!("{}{}", text(span.end.min(shown.end)..shown.end), ellipsis(shown.end < source.len()));
    let indent = " ".repeat(columns(&before));
    let carets = "^".repeat(columns(&marked).max(1));
    format!("{before}{marked}{after}\n{indent}{carets}")
}

/// Returns the range of bytes to show: the marked part, extended by one character on each side in turn.
///
/// Ends: each iteration takes at least one column, or stops at the limit or at both ends of the text.
fn window(source: &str, span: &Range<usize>) -> Range<usize> {
    let cost = |c: char| char_columns(printable(c)).max(1);
    let mut shown = span.start..span.start;
    let mut used = 0;
    for c in source[span.clone()].chars() {
        if used + cost(c) > CARET_COLUMNS {
            break;
        }
        used += cost(c);
        shown.end += c.len_utf8();
    }
    loop {
        let left = source[..shown.start].chars().next_back();
        let right = source[shown.end..].chars().next();
        let mut grown = false;
        if let Some(c) = left.filter(|&c| used + cost(c) <= POINTER_COLUMNS) {
            used += cost(c);
            shown.start -= c.len_utf8();
            grown = true;
        }
        if let Some(c) = right.filter(|&c| used + cost(c) <= POINTER_COLUMNS) {
            used += cost(c);
            shown.end += c.len_utf8();
            grown = true;
        }
        if !grown {
            return shown;
        }
    }
}

/// Returns the character to show for a character of any text: a space for line breaks and tabs, `�` for
/// invisible control characters.
pub(super) fn printable(c: char) -> char {
    match c {
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => '\u{fffd}',
        '\u{feff}' => '\u{fffd}',
        _ if c.is_whitespace() => ' ',
        _ if c.is_control() => '\u{fffd}',
        _ => c,
    }
}

fn columns(text: &str) -> usize {
    text.chars().map(char_columns).sum()
}

/// Returns the columns of a character in a fixed-width font: 0 for accents that join the letter before, 2 for
/// East Asian letters and pictographs.
fn char_columns(c: char) -> usize {
    c.width().unwrap_or(0) // none for control characters, which are not shown
}
