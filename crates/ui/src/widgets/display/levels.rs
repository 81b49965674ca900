//! The legend of the levels, which is the histogram as well.

use egui::{
    self, Color32, EventFilter, Id, Key, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
    pos2, vec2,
};

use super::{format, paint};
use crate::theme::{font, tokens};
use meshbrush_mesh::text::LengthUnit;

/// Height of a row where all fit.
const ROW: f32 = 18.0;
/// Height of a row where they do not fit; smaller rows scroll instead.
const SMALLEST_ROW: f32 = 14.0;
/// Width of the column of levels.
const LEVEL: f32 = 16.0;

/// A level of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelRow {
    /// The level, from 0.
    pub level: u32,
    /// The level's colour on the canvas.
    pub color: Color32,
    /// How many triangles have it.
    pub count: u64,
    /// The diameter of its triangles in world units.
    pub diameter: f64,
}

/// Bars in the canvas's colours, the counts beside them.
///
/// Bars are linear in the count. The place of a row does not depend on the counts. Above
/// [`LevelLegend::max_height`] rows first move closer together and then scroll.
#[must_use = "call `show`"]
pub struct LevelLegend<'a> {
    rows: &'a [LevelRow],
    unit: LengthUnit,
    lit: Option<u32>,
    /// Bit ℓ: whether level ℓ is hidden on the canvas.
    hidden: u64,
    max_height: f32,
}

/// The actions of a person on the rows of a legend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelAnswer {
    /// The level under the pointer, or that with the focus.
    pub hovered: Option<u32>,
    /// The level that was clicked, to be hidden or shown.
    pub toggled: Option<u32>,
    /// The level that was clicked with Alt, to be shown alone.
    pub isolated: Option<u32>,
}

impl<'a> LevelLegend<'a> {
    /// Creates a legend of `rows`, from the top down.
    pub fn new(rows: &'a [LevelRow]) -> Self {
        Self { rows, unit: LengthUnit::None, lit: None, hidden: 0, max_height: 360.0 }
    }

    /// Returns the unit of the diameters.
    pub fn unit(mut self, unit: LengthUnit) -> Self {
        self.unit = unit;
        self
    }

    /// Highlights a level, such as that of the triangle under the pointer.
    pub fn lit(mut self, level: Option<u32>) -> Self {
        self.lit = level;
        self
    }

    /// Returns the levels that are hidden on the canvas, as bits.
    pub fn hidden(mut self, levels: u64) -> Self {
        self.hidden = levels;
        self
    }

    /// Returns the greatest height in points; 360 by default.
    pub fn max_height(mut self, height: f32) -> Self {
        self.max_height = height;
        self
    }

    /// Shows the legend, and returns what was done with its rows.
    pub fn show(self, ui: &mut Ui) -> LevelAnswer {
        let rows = self.rows.len().max(1) as f32;
        let row_height = (self.max_height / rows).floor().clamp(SMALLEST_ROW, ROW);
        let height = (rows * row_height).min(self.max_height);
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), height));
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(rect).id_salt("levels"));
        child.spacing_mut().item_spacing.y = 0.0;
        egui::ScrollArea::vertical()
            .max_height(height)
            .auto_shrink(false)
            .show(&mut child, |ui| self.rows_ui(ui, row_height))
            .inner
    }

    fn rows_ui(&self, ui: &mut Ui, height: f32) -> LevelAnswer {
        let layout = Layout::of(ui, self.rows);
        let size = vec2(ui.available_width(), height * self.rows.len() as f32);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let place = |i: usize| {
            Rect::from_min_size(pos2(rect.left(), rect.top() + height * i as f32), vec2(rect.width(), height))
        };
        let responses: Vec<_> =
            self.rows.iter().enumerate().map(|(i, row)| self.sense(ui, place(i), row)).collect();
        self.follow_keys(ui, &responses);
        let level_where = |is: fn(&Response) -> bool| {
            let found = responses.iter().zip(self.rows).find(|(response, _)| is(response));
            found.map(|(_, row)| row.level)
        };
        let hovered = level_where(Response::hovered).or_else(|| level_where(Response::has_focus));
        let clicked = level_where(Response::clicked);
        let isolates = ui.input(|input| input.modifiers.alt);
        for (i, row) in self.rows.iter().enumerate() {
            let lit = hovered.or(self.lit) == Some(row.level);
            let opacity = match (self.is_hidden(row.level), hovered.is_some() && !lit) {
                (true, _) => 0.15,
                (false, true) => 0.4,
                (false, false) => 1.0,
            };
            layout.paint(ui, place(i), row, lit, opacity);
            paint::focus_ring(ui, &responses[i], place(i), 4);
        }
        LevelAnswer {
            hovered,
            toggled: clicked.filter(|_| !isolates),
            isolated: clicked.filter(|_| isolates),
        }
    }

    /// Lets the keys Up and Down go from row to row.
    fn follow_keys(&self, ui: &Ui, responses: &[Response]) {
        let Some(place) = responses.iter().position(Response::has_focus) else { return };
        let filter = EventFilter { vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(responses[place].id, filter));
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        let next = match (pressed(Key::ArrowUp), pressed(Key::ArrowDown)) {
            (true, false) => place.checked_sub(1),
            (false, true) => Some(place + 1).filter(|next| *next < responses.len()),
            _ => None,
        };
        if let Some(next) = next {
            ui.data_mut(|data| data.insert_temp(stop_id(ui), self.rows[next].level));
            ui.memory_mut(|memory| memory.request_focus(responses[next].id));
            ui.scroll_to_rect(responses[next].rect, None);
        }
    }

    fn is_hidden(&self, level: u32) -> bool {
        self.hidden >> level.min(63) & 1 == 1
    }

    /// Registers a row for pointer and keyboard, tests and screen readers. Tab stops once in the legend, at
    /// the row that had the focus last: there may be more than fifty.
    fn sense(&self, ui: &Ui, rect: Rect, row: &LevelRow) -> Response {
        let first = self.rows.first().map_or(0, |first| first.level);
        let stop =
            ui.data(|data| data.get_temp(stop_id(ui))).unwrap_or(first).min(self.rows.len() as u32 - 1);
        let sense = if row.level == stop { Sense::click() } else { Sense::CLICK };
        let response = ui.interact(rect, row_id(ui, row.level), sense);
        let triangles = if row.count == 1 { "triangle" } else { "triangles" };
        let name = format!("Level {}: {} {triangles}", row.level, format::count(row.count));
        let is_hidden = self.is_hidden(row.level);
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(if is_hidden { "hidden" } else { "shown" }.into()),
            ..WidgetInfo::labeled(Role::ListItem, true, &name)
        });
        let diameter = self.unit.after(&format::digits(row.diameter, 4));
        let click = if is_hidden { "A click or Space shows it" } else { "A click or Space hides it" };
        let help = format!("{name}\nDiameter {diameter}\n{click}, with Alt it is shown alone.");
        response.on_hover_text_at_pointer(help)
    }
}

fn row_id(ui: &Ui, level: u32) -> Id {
    ui.scope_id().with(("level", level))
}

/// Under it, egui's memory has the level at which Tab stops.
fn stop_id(ui: &Ui) -> Id {
    ui.scope_id().with("stop of Tab")
}

/// The widths of the legend's columns, which depend on all rows.
struct Layout {
    total: f32,
    count: f32,
}

impl Layout {
    fn of(ui: &Ui, rows: &[LevelRow]) -> Self {
        let most = rows.iter().map(|row| row.count).max().unwrap_or(0);
        let widest = paint::line(ui, &format::count(most), font::small_value(), Color32::PLACEHOLDER);
        Self { total: most.max(1) as f32, count: widest.size().x.ceil() }
    }

    fn paint(&self, ui: &Ui, rect: Rect, row: &LevelRow, lit: bool, opacity: f32) {
        let t = tokens(ui);
        if lit {
            ui.painter().rect_filled(rect.expand2(vec2(6.0, 0.0)), 4.0, t.field);
        }
        let ink = if (lit || row.count > 0) && opacity > 0.2 { t.label } else { t.faint };
        let level =
            paint::line(ui, &row.level.to_string(), font::small_value(), if lit { t.value } else { ink });
        paint::at_right(ui, rect.with_max_x(rect.left() + LEVEL), level);
        let end = self.bar(ui, rect, row, opacity);
        let count = format::count(row.count);
        let count = paint::line(ui, &count, font::small_value(), if lit { t.value } else { ink });
        paint::at_left(ui, rect.with_min_x(end + 8.0), count);
    }

    /// Paints the bar and returns its right edge.
    fn bar(&self, ui: &Ui, rect: Rect, row: &LevelRow, opacity: f32) -> f32 {
        let left = rect.left() + LEVEL + 10.0;
        // A level without triangles has a swatch: the legend shows every colour of the canvas.
        let longest = (rect.right() - self.count - 8.0 - left).max(8.0);
        let width = (longest * row.count as f32 / self.total).max(3.0);
        let thickness = (rect.height() - 6.0).clamp(8.0, 11.0);
        let middle = pos2(left + width / 2.0, rect.center().y);
        let bar = Rect::from_center_size(middle, vec2(width, thickness));
        let edge = edge_of(ui, row.color).gamma_multiply(opacity);
        let fill = row.color.gamma_multiply(opacity);
        ui.painter().rect(bar, 2.0, fill, Stroke::new(1.0, edge), StrokeKind::Inside);
        bar.right()
    }
}

/// Returns an outline for bars that are hard to tell from the panel: level 0 is close to it on purpose.
fn edge_of(ui: &Ui, color: Color32) -> Color32 {
    let t = tokens(ui);
    let far = |a: u8, b: u8| a.abs_diff(b) > 40;
    let p = t.panel;
    let distinct = far(color.r(), p.r()) || far(color.g(), p.g()) || far(color.b(), p.b());
    if distinct { Color32::TRANSPARENT } else { t.panel.lerp_to_gamma(t.faint, 0.45) }
}
