//! The lines of an algorithm, the ones that a step runs marked. Long lines wrap, and go on indented.

use std::ops::Range;

use eframe::egui::{Align2, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use meshbrush_study::steps::Algorithm;
use meshbrush_ui::theme::{font, tokens};

/// Height of a line, in points.
const LINE: f32 = 16.0;
/// Room for the number of a line.
const NUMBER: f32 = 28.0;
/// How many letters the rest of a wrapped line is farther in than its beginning.
const HANGING: usize = 4;
/// Algorithms with more lines are shown around the marked lines only.
const MOST_LINES: usize = 24;
/// How many of the others are shown before and after them.
const AROUND: usize = 4;

/// Shows an algorithm with some of its lines marked, counted from 1.
pub fn lines(ui: &mut Ui, algorithm: Algorithm, marked: Range<usize>) {
    let text = algorithm.lines();
    let shown = if text.len() > MOST_LINES {
        marked.start.saturating_sub(AROUND).max(1)..(marked.end + AROUND).min(text.len() + 1)
    } else {
        1..text.len() + 1
    };
    ui.spacing_mut().item_spacing.y = 0.0;
    if shown.start > 1 {
        line(ui, "", "⋮", false);
    }
    for number in shown.clone() {
        line(ui, &number.to_string(), text[number - 1], marked.contains(&number));
    }
    if shown.end <= text.len() {
        line(ui, "", "⋮", false);
    }
    ui.add_space(6.0);
}

fn line(ui: &mut Ui, number: &str, text: &str, is_marked: bool) {
    let letter = ui.painter().layout_no_wrap("0".into(), font::value(), tokens(ui).text).size().x;
    let letters = ((ui.available_width() - NUMBER) / letter).max(1.0) as usize;
    let rows = wrapped(text, letters);
    let size = vec2(ui.available_width(), LINE * rows.len() as f32);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let spoken =
        if is_marked { format!("Current line {number}: {text}") } else { format!("{number}: {text}") };
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let t = tokens(ui);
    let painter = ui.painter();
    if is_marked {
        painter.rect_filled(rect, 3.0, t.field);
        let mark = rect.with_max_x(rect.left() + 3.0);
        painter.rect_filled(mark, 1.0, t.accent);
    }
    let y = rect.top() + 0.5 * LINE;
    let [number_color, color] = if is_marked { [t.label, t.value] } else { [t.faint, t.label] };
    painter.text(
        pos2(rect.left() + NUMBER - 8.0, y),
        Align2::RIGHT_CENTER,
        number,
        font::small_value(),
        number_color,
    );
    for (row, text) in rows.into_iter().enumerate() {
        let at = pos2(rect.left() + NUMBER, y + LINE * row as f32);
        painter.text(at, Align2::LEFT_CENTER, text, font::value(), color);
    }
}

/// Breaks a line into rows of at most so many letters: between words, or where a word has no room, within it.
/// All rows but the first are indented farther than the first, while there is room for that.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let own = text.chars().take_while(|letter| *letter == ' ').count();
    let indent = |count: usize| " ".repeat(count.min(letters / 2));
    let mut rows = vec![indent(own)];
    let mut is_begun = false;
    for word in text.split_whitespace() {
        let count = |text: &str| text.chars().count();
        let last = rows.last().map_or(0, |row| count(row));
        let needed = count(word) + usize::from(is_begun);
        if is_begun && last + needed > letters {
            rows.push(indent(own + HANGING));
            is_begun = false;
        }
        for letter in is_begun.then_some(' ').into_iter().chain(word.chars()) {
            if rows.last().is_some_and(|row| count(row) >= letters) {
                rows.push(indent(own + HANGING));
            }
            if let Some(row) = rows.last_mut() {
                row.push(letter);
            }
        }
        is_begun = true;
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_wrap_with_an_indent_and_lose_no_letter() {
        let text = "    for each triangle t_i with an edge on the boundary do";
        assert_eq!(wrapped(text, 80), [text]);
        assert_eq!(
            wrapped(text, 30),
            ["    for each triangle t_i with", "        an edge on the", "        boundary do"]
        );
        for letters in 2..70 {
            let rows = wrapped(text, letters);
            assert!(rows.iter().all(|row| row.chars().count() <= letters), "{letters}: {rows:?}");
            let squeezed = |text: &str| text.replace(' ', "");
            assert_eq!(squeezed(&rows.concat()), squeezed(text));
        }
        assert_eq!(wrapped("UpdateNeighbours", 10), ["UpdateNeig", "    hbours"]);
        assert_eq!(wrapped("", 10), [""]);
    }
}
