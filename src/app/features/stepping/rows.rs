//! The rows of 𝒯 and 𝒩 that a step changed: old above new.

use eframe::egui::{Align2, Color32, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use meshbrush_kit::kit::FrameState;
use meshbrush_study::steps::{ReportRow, RowChange, StepPlayer};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::format;

/// Height of a row, in points.
const ROW: f32 = 17.0;
/// Room for its name.
const NAME: f32 = 88.0;
/// Names of the columns of 𝒯.
const COLUMNS: [&str; 8] = ["v₁", "v₂", "v₃", "n₁", "n₂", "n₃", "O", "L"];

/// Shows the rows that the last step changed, numbered as in the report.
pub fn changed_rows(ui: &mut Ui, player: &StepPlayer, state: &FrameState<'_>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let new_node = player.step().and_then(|step| step.new_node);
    if player.changes().is_empty() && new_node.is_none() {
        ui.label("None");
        return;
    }
    if let Some(number) = new_node {
        let lattice = &player.recording().lattice;
        let place = lattice.world_from_lattice(player.nodes()[number as usize - 1]);
        let coordinates = [place.x, place.y]
            .map(|value| format::with_unit(&format::digits(value, 6), state.unit().symbol()));
        let text = format!("N[{number}] ← ({})", coordinates.join(", "));
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW + 3.0), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
        ui.painter().text(rect.left_top(), Align2::LEFT_TOP, &text, font::value(), tokens(ui).accent);
    }
    if player.changes().is_empty() {
        return;
    }
    let t = tokens(ui);
    cells(ui, "Column", COLUMNS.map(str::to_owned), |_| t.faint);
    for change in player.changes() {
        change_rows(ui, change);
    }
    ui.add_space(6.0);
}

fn change_rows(ui: &mut Ui, change: &RowChange) {
    let t = tokens(ui);
    let name = format!("T[{}]", change.number);
    let top = ui.next_widget_position();
    if let Some(before) = change.before {
        cells(ui, &format!("{name} was"), numbers(before), |_| t.faint);
    }
    let differs = |column: usize| change.before.is_none_or(|before| before[column] != change.after[column]);
    let color = |column: usize| if differs(column) { t.accent } else { t.text };
    cells(ui, &name, numbers(change.after), color);
    let bottom = ui.next_widget_position();
    ui.painter().hline(top.x..=ui.max_rect().right(), bottom.y, t.hairline());
    ui.add_space(2.0);
}

/// Minus signs, not hyphens.
fn numbers(row: ReportRow) -> [String; 8] {
    row.map(|number| format::fixed(f64::from(number), 0))
}

fn cells(ui: &mut Ui, name: &str, texts: [String; 8], color: impl Fn(usize) -> Color32) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let spoken = format!("{name}: {}", texts.join(" "));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let painter = ui.painter();
    let y = rect.center().y;
    painter.text(pos2(rect.left(), y), Align2::LEFT_CENTER, name, font::small_value(), tokens(ui).label);
    let width = (rect.width() - NAME) / 8.0;
    for (column, text) in texts.iter().enumerate() {
        let right = rect.left() + NAME + width * (column as f32 + 1.0);
        painter.text(pos2(right, y), Align2::RIGHT_CENTER, text, font::small_value(), color(column));
    }
}
