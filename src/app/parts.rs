//! The parts of the window, between which F6 moves the focus.

use std::collections::BTreeMap;

use eframe::egui::{Context, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};

use meshbrush_ui::theme::tokens;

/// A part of the window, in the order of the key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WindowPart {
    /// The bar of menus.
    Menus,
    /// The strip of tools.
    Tools,
    /// The options of the tool.
    Strip,
    /// The canvas.
    Canvas,
    /// The dock with the layers.
    Layers,
    /// The dock with the tabs, or the panel in its place while steps are shown.
    Panel,
    /// The bar below the canvas.
    Status,
}

impl WindowPart {
    fn name(self) -> &'static str {
        match self {
            Self::Menus => "Menus",
            Self::Tools => "Tools",
            Self::Strip => "Options of the tool",
            Self::Canvas => "Canvas",
            Self::Layers => "Layers dock",
            Self::Panel => "Panel",
            Self::Status => "Status bar",
        }
    }

    fn id(self) -> Id {
        Id::unique(("part of the window", self.name()))
    }
}

/// Where the parts were last shown, with the number of the pass.
type Shown = BTreeMap<WindowPart, (u64, Rect)>;

fn shown_id() -> Id {
    Id::unique("parts of the window")
}

/// Notes a part of the window, before its controls. After F6 it has the focus: a ring shows where, and Tab
/// leads to its first control.
pub fn mark(ui: &Ui, part: WindowPart) {
    // With its margins.
    let rect = ui.clip_rect();
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|data| data.get_temp_mut_or_default::<Shown>(shown_id()).insert(part, (pass, rect)));
    if part == WindowPart::Canvas || !ui.memory(|memory| memory.has_focus(part.id())) {
        return;
    }
    let response = ui.interact(rect, part.id(), Sense::focusable_noninteractive());
    response.widget_info(|| WidgetInfo::labeled(Role::Group, true, part.name()));
    ui.painter().rect_stroke(rect.shrink(1.0), 2, Stroke::new(1.5, tokens(ui).accent), StrokeKind::Inside);
}

/// Moves the focus `by` parts, in a circle. The canvas is where keys go while nothing has the focus.
pub fn focus(ctx: &Context, canvas: Option<Id>, by: i32) {
    let pass = ctx.cumulative_pass_nr();
    let shown: Shown = ctx.data(|data| data.get_temp(shown_id())).unwrap_or_default();
    let parts: Vec<(WindowPart, Rect)> = shown
        .into_iter()
        .filter(|(_, (at, _))| at + 2 > pass)
        .map(|(part, (_, rect))| (part, rect))
        .collect();
    let focused = ctx.memory(|memory| memory.focused());
    let id_of = |part: WindowPart| if part == WindowPart::Canvas { canvas } else { Some(part.id()) };
    let own = focused.and_then(|focused| parts.iter().position(|(part, _)| id_of(*part) == Some(focused)));
    // A control is in the smallest part around it: a dock can hold another one.
    let place = focused.and_then(|id| ctx.read_response(id)).map(|response| response.rect.center());
    let around = || {
        let around =
            parts.iter().enumerate().filter(|(_, (_, rect))| place.is_some_and(|at| rect.contains(at)));
        around.min_by(|(_, (_, a)), (_, (_, b))| a.area().total_cmp(&b.area())).map(|(place, _)| place)
    };
    let own = own.or_else(around);
    let canvas_at = || parts.iter().position(|(part, _)| *part == WindowPart::Canvas);
    let Some(from) = own.or_else(canvas_at) else { return };
    let to = (from as i32 + by).rem_euclid(parts.len() as i32) as usize;
    if let Some(id) = id_of(parts[to].0) {
        ctx.memory_mut(|memory| memory.request_focus(id));
    }
}
