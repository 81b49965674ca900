//! The lines of an algorithm, the ones that a step runs marked.

use std::ops::Range;

use eframe::egui::{Align2, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use meshbrush_study::steps::Algorithm;
use meshbrush_ui::theme::{font, tokens};

/// Height of a line, in points.
const LINE: f32 = 16.0;
/// Room for the number of a line.
const NUMBER: f32 = 28.0;
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
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::hover());
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
    let y = rect.center().y;
    let [number_color, color] = if is_marked { [t.label, t.value] } else { [t.faint, t.label] };
    painter.text(
        pos2(rect.left() + NUMBER - 8.0, y),
        Align2::RIGHT_CENTER,
        number,
        font::small_value(),
        number_color,
    );
    painter.text(pos2(rect.left() + NUMBER, y), Align2::LEFT_CENTER, text, font::value(), color);
}
