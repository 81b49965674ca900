//! The mode for a projector: larger text and lines, one panel at most, and a ring around the pointer.

use egui::{Color32, Context, Id, LayerId, Order, Stroke, Vec2, vec2};

/// How much larger everything is.
const LARGER: f32 = 1.5;
/// The least room that everything fits into, in points. In a small window things get less large.
const LEAST_ROOM: Vec2 = vec2(640.0, 380.0);
/// Radius of the ring around the pointer, and while a button is held, in points.
const RADIUS: f32 = 24.0;
const RADIUS_HELD: f32 = 17.0;
/// The colour of the ring, on a dark halo.
const RING: Color32 = Color32::from_rgb(0xff, 0xd2, 0x3f);
const HALO: Color32 = Color32::from_black_alpha(130);

/// What the window was like before a presentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Presentation {
    zoom_factor: f32,
    panels: bool,
}

impl Presentation {
    /// Begins a presentation: everything gets larger. `panels` says whether the panels are shown.
    pub fn begin(panels: bool, ctx: &Context) -> Self {
        let zoom_factor = ctx.zoom_factor();
        let room = ctx.content_rect().size() / LEAST_ROOM;
        ctx.set_zoom_factor(zoom_factor * LARGER.min(room.min_elem()).max(1.0));
        Self { zoom_factor, panels }
    }

    /// The zoom factor before the presentation.
    pub fn zoom_factor(self) -> f32 {
        self.zoom_factor
    }

    /// Ends the presentation. Returns whether the panels were shown before it.
    pub fn end(self, ctx: &Context) -> bool {
        ctx.set_zoom_factor(self.zoom_factor);
        self.panels
    }
}

/// Draws a ring around the pointer, above everything; a smaller one while a button is held.
pub fn paint_pointer_ring(ctx: &Context) {
    let (at, held) = ctx.input(|input| (input.pointer.latest_pos(), input.pointer.any_down()));
    let Some(at) = at else { return };
    let painter = ctx.layer_painter(LayerId::new(Order::Tooltip, Id::unique("ring around the pointer")));
    let radius = if held { RADIUS_HELD } else { RADIUS };
    painter.circle_stroke(at, radius, Stroke::new(6.0, HALO));
    painter.circle_stroke(at, radius, Stroke::new(3.0, RING));
}
