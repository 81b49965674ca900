//! A line of text with carets under a part of it.

use std::ops::Range;

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
/// East Asian letters and pictographs. Blocks of Unicode decide, because tables of all characters take 8 kB.
fn char_columns(c: char) -> usize {
    let is_in = |blocks: &[[char; 2]]| blocks.iter().any(|&[first, last]| (first..=last).contains(&c));
    match c {
        _ if c.is_control() || is_in(&JOINING) => 0, // control characters are not shown
        _ if is_in(&WIDE) => 2,
        _ => 1,
    }
}

/// The first and last characters of blocks that join the letter before, or show nothing.
const JOINING: [[char; 2]; 8] = [
    ['\u{300}', '\u{36f}'],
    ['\u{483}', '\u{489}'],
    ['\u{591}', '\u{5bd}'],
    ['\u{64b}', '\u{65f}'],
    ['\u{1ab0}', '\u{1aff}'],
    ['\u{1dc0}', '\u{1dff}'],
    ['\u{20d0}', '\u{20ff}'],
    ['\u{fe00}', '\u{fe2f}'],
];
/// The first and last characters of blocks whose characters take two columns.
const WIDE: [[char; 2]; 10] = [
    ['\u{1100}', '\u{115f}'],
    ['\u{2e80}', '\u{303e}'],
    ['\u{3041}', '\u{a4cf}'],
    ['\u{a960}', '\u{a97f}'],
    ['\u{ac00}', '\u{d7a3}'],
    ['\u{f900}', '\u{faff}'],
    ['\u{fe30}', '\u{fe6f}'],
    ['\u{ff00}', '\u{ff60}'],
    ['\u{1f300}', '\u{1faff}'],
    ['\u{20000}', '\u{3fffd}'],
];
