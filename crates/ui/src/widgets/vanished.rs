//! Clicks on buttons that have just vanished.

use std::collections::HashMap;
use std::time::Duration;

use egui::{Context, Event, Id, Plugin, PointerButton, Pos2, RawInput, Rect, Response, Ui};

/// Seconds for which the place of a button that vanished takes no click.
const PAUSE: f64 = 0.5;

/// Keeps clicks from what a button has covered, for a moment after it vanished: a hand that is about to click
/// on *Cancel* when the work ends must not paint, nor press what moved there.
#[derive(Default)]
pub struct VanishedButtons {
    buttons: HashMap<Id, VanishingButton>,
    /// The buttons of the mouse whose press was dropped and whose release is still to come.
    dropped: Vec<PointerButton>,
}

/// The place of a button that comes and goes.
struct VanishingButton {
    rect: Rect,
    /// Whether the button was shown in this pass.
    is_shown: bool,
    /// When it was first missing, in egui's time.
    gone_at: Option<f64>,
}

impl VanishedButtons {
    fn covers(&self, at: Pos2, now: f64) -> bool {
        let covers = |place: &VanishingButton| {
            place.rect.contains(at) && place.gone_at.is_some_and(|gone_at| now < gone_at + PAUSE)
        };
        self.buttons.values().any(covers)
    }

    /// Returns whether widgets and canvas may have an event.
    fn lets_through(&mut self, event: &Event, now: f64) -> bool {
        match *event {
            Event::PointerButton { pos, button, pressed: true, .. } if self.covers(pos, now) => {
                self.dropped.push(button);
                false
            }
            Event::PointerButton { button, pressed: false, .. } => {
                let kept = self.dropped.len();
                self.dropped.retain(|dropped| *dropped != button);
                self.dropped.len() == kept
            }
            _ => true,
        }
    }
}

impl Plugin for VanishedButtons {
    fn debug_name(&self) -> &'static str {
        "vanished buttons"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let now = input.time.unwrap_or_else(|| ctx.input(|input| input.time));
        self.buttons.retain(|_, place| place.gone_at.is_none_or(|gone_at| now < gone_at + PAUSE));
        input.events.retain(|event| self.lets_through(event, now));
    }

    fn on_begin_pass(&mut self, _: &mut Ui) {
        self.buttons.values_mut().for_each(|place| place.is_shown = false);
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        let now = ui.input(|input| input.time);
        for place in self.buttons.values_mut().filter(|place| !place.is_shown && place.gone_at.is_none()) {
            place.gone_at = Some(now);
            ui.ctx().request_repaint_after(Duration::from_secs_f64(PAUSE));
        }
    }
}

/// Says that a button comes and goes by itself: when it has vanished, its place takes no click for half a
/// second.
pub(super) fn guard(response: &Response) {
    response.ctx.with_plugin::<VanishedButtons, _>(|vanished| {
        let place = VanishingButton { rect: response.rect, is_shown: true, gone_at: None };
        vanished.buttons.insert(response.id, place);
    });
}
