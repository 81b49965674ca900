//! The pins, as a table.

use eframe::egui::{Align2, FontId, Pos2, Rect, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::PinsCommand;
use super::files::EXPORT_PINS;
use super::table::PinRow;
use crate::app::features::pins::Pins;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{Section, format};

/// All pins with their triangles and values; how to pin a point while there are none.
pub static PINS: Panel = Panel { name: "pins", tab: Tab::Inspect, place: 1, show };

/// The headings after those of the number and of the place.
const HEADINGS: [&str; COLUMNS - 3] =
    ["Triangle", "Level", "ζ₁", "ζ₂", "ζ₃", "Interpolated", "True", "Difference"];
const COLUMNS: usize = 11;
/// Height of a row, in points.
const ROW: f32 = 18.0;
/// Most rows in sight.
const MOST_ROWS: usize = 12;
/// Space between columns, in points.
const GAP: f32 = 12.0;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let count = state.session.document().settings().pins.len();
    let note = if count > 0 { format::count(count as u64) } else { String::new() };
    Section::new("Pins").note(&note).show(ui, |ui| {
        if count == 0 {
            return remark(ui, "Pin a query[ ({pin-the-queried-point})] to follow its triangle and values through every edit.");
        }
        if !state.feature::<Pins>().reader.is_current(state.session, state.view.quantity) {
            // They are read only while the table is shown.
            commands.push(Command::from(PinsCommand::Read));
        }
        table(ui, state, commands);
        buttons(ui, state, commands);
    });
}

/// The header and the rows in sight. It scrolls both ways.
fn table(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let pins = &state.session.document().settings().pins;
    let selected = state.feature::<Pins>().selected_of(pins);
    let height = ROW * (pins.len().min(MOST_ROWS) + 1) as f32 + 12.0;
    ui.spacing_mut().item_spacing.y = 0.0;
    let area = ScrollArea::both().id_salt("table of pins").max_height(height).min_scrolled_height(height);
    let area = area.auto_shrink([false, true]);
    area.show_rows(ui, ROW, pins.len() + 1, |ui, range| {
        let rows: Vec<(Option<usize>, [String; COLUMNS])> = range
            .map(|line| match line.checked_sub(1) {
                None => (None, headings(state)),
                Some(number) => (Some(number), cells(state, number)),
            })
            .collect();
        let widths = widths(ui, rows.iter().map(|(_, cells)| cells));
        let width = widths.iter().sum::<f32>() + GAP * COLUMNS as f32;
        for (number, cells) in &rows {
            let (_, rect) = ui.allocate_space(vec2(width, ROW));
            let Some(number) = *number else {
                paint_row(ui, rect, cells, &widths, font::caption(), false);
                continue;
            };
            let in_sight = rect.intersect(ui.clip_rect());
            let response = ui.interact(in_sight, ui.make_persistent_id(("pin", number)), Sense::click());
            let text = cells[1..].join(" ");
            response.widget_info(|| WidgetInfo {
                current_text_value: Some(text.clone()),
                ..WidgetInfo::labeled(Role::ListItem, true, format!("Pin {}", number + 1))
            });
            if response.hovered() || selected == Some(number) {
                ui.painter().rect_filled(rect, 4.0, tokens(ui).field);
            }
            paint_row(ui, rect, cells, &widths, font::small_value(), true);
            if response.clicked() {
                // Keys such as Delete belong to the canvas.
                response.surrender_focus();
                commands.push(Command::from(PinsCommand::Select(number)));
            }
            response.on_hover_text("A click queries the pin. Drag it on the canvas with the query tool.");
        }
    });
    ui.add_space(6.0);
}

fn headings(state: &FrameState<'_>) -> [String; COLUMNS] {
    let [x, y] = state.place_names();
    let mut all = ["Pin", x, y].into_iter().chain(HEADINGS).map(str::to_owned);
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

/// Returns the cells of a pin in the table.
fn cells(state: &FrameState<'_>, number: usize) -> [String; COLUMNS] {
    let at = state.session.document().settings().pins[number];
    let [x, y] = state.place_text(at).values;
    let first = [(number + 1).to_string(), x, y];
    let read =
        state.feature::<Pins>().reader.rows().get(number).and_then(Option::as_ref).filter(|row| row.at == at);
    let rest = match read {
        None => [(); COLUMNS - 3].map(|()| "…".to_owned()),
        Some(PinRow { triangle: None, .. }) => {
            let mut rest = [(); COLUMNS - 3].map(|()| "–".to_owned());
            rest[0] = "outside".into();
            rest
        }
        Some(PinRow { triangle: Some(triangle), .. }) => {
            let id = match state.session.has_file_numbers() {
                true => format::count(triangle.id.index() as u64),
                false => "…".into(),
            };
            let [a, b, c] = triangle.zeta.map(|zeta| format::fixed(zeta, 3));
            let number = |value: f64| format::significant(value, 4);
            let difference = triangle.interpolated - triangle.exact;
            let sign = if difference < 0.0 { "−" } else { "" };
            let difference = format!("{sign}{}", format::significant(difference.abs(), 2));
            let (interpolated, exact) = (number(triangle.interpolated), number(triangle.exact));
            [id, triangle.level.to_string(), a, b, c, interpolated, exact, difference]
        }
    };
    let mut all = first.into_iter().chain(rest);
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

/// Returns the width of each column, in points.
fn widths<'a>(ui: &Ui, rows: impl Iterator<Item = &'a [String; COLUMNS]>) -> [f32; COLUMNS] {
    let color = tokens(ui).label;
    let width = |text: &str, font: FontId| ui.painter().layout_no_wrap(text.to_owned(), font, color).size().x;
    let mut widths = [0.0_f32; COLUMNS];
    for cells in rows {
        for (widest, cell) in widths.iter_mut().zip(cells) {
            *widest = widest.max(width(cell, font::small_value()).ceil());
        }
    }
    widths
}

/// Paints the cells at the right of their columns.
fn paint_row(
    ui: &Ui,
    rect: Rect,
    cells: &[String; COLUMNS],
    widths: &[f32; COLUMNS],
    font: FontId,
    is_value: bool,
) {
    let t = tokens(ui);
    let mut right = rect.left() + GAP / 2.0;
    for (column, (cell, width)) in cells.iter().zip(widths).enumerate() {
        right += width;
        let color = if is_value && column > 0 { t.value } else { t.label };
        let at: Pos2 = pos2(right, rect.center().y);
        ui.painter().text(at, Align2::RIGHT_CENTER, cell, font.clone(), color);
        right += GAP;
    }
}

fn buttons(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let is_queried = state.readout.is_some();
    let pins = &state.session.document().settings().pins;
    let is_selected = state.feature::<Pins>().selected_of(pins).is_some();
    let pin = Command::from;
    let rows = [
        vec![
            ("Pin the query", is_queried, pin(PinsCommand::Pin)),
            ("Copy table", true, pin(PinsCommand::Copy)),
        ],
        vec![
            ("Delete pin", is_selected, pin(PinsCommand::Delete)),
            ("Export table…", true, Command::from(FileCommand::Ask(&EXPORT_PINS))),
        ],
        vec![("Delete all pins", true, pin(PinsCommand::DeleteAll))],
    ];
    button_rows(ui, rows, commands);
}
