//! From what the pointer does on the canvas to commands.

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Response, Ui};
use glam::{DVec2, dvec2};

use super::super::command::{Command, DomainCommand};
use super::super::tools::{DomainToolMode, Tool, Tools};
use crate::domain::{CutShape, corners};
use crate::geometry::Rect;
use crate::scene::Camera;

/// Points that the pointer must move, with Shift held, before a click becomes a drag of the brush's size.
const CLICK_SLACK: f32 = 4.0;
/// Points within which a click on the first corner of a polygon closes it.
const CLOSING_POINTS: f64 = 9.0;
/// Share by which one point of scrolling zooms; a notch of a wheel scrolls by about 50 points.
const ZOOM_PER_POINT: f64 = 0.004;

/// What the pointer is in the middle of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gesture {
    /// Nothing.
    #[default]
    None,
    /// A stroke.
    Painting,
    /// Moving the view.
    Panning {
        /// Where the pointer was last.
        last: Pos2,
        /// The button that holds on.
        button: PointerButton,
    },
    /// Shift held with a brush: a line if let go here, the brush's size if dragged.
    Sizing {
        /// Where the pointer went down.
        from: Pos2,
        /// The radius then, in world units.
        radius: f64,
        /// Whether it moved far enough to be a drag.
        dragged: bool,
    },
    /// Cutting the domain with the brush.
    Cutting {
        /// Where the brush was last, in world units.
        last: DVec2,
        /// Whether it adds to the domain.
        adds: bool,
    },
    /// Drawing a rectangle: the domain's, or one to cut it with.
    Framing {
        /// Where the pointer went down.
        from: Pos2,
        /// Where it is.
        to: Pos2,
        /// Whether it is to be added to the domain or taken away; `None` where it becomes the frame.
        adds: Option<bool>,
    },
}

/// The canvas as the pointer sees it.
pub struct Pointer<'a> {
    /// Where the canvas is, in points.
    pub rect: egui::Rect,
    /// What is on it.
    pub camera: &'a mut Camera,
    /// Where something floats over it that has the clicks to itself, in points.
    pub covered: &'a [egui::Rect],
    /// The tool in hand.
    pub tools: &'a Tools,
    /// Physical pixels for a point.
    pub px_per_point: f64,
    /// The first corner of the polygon that is being set, in world units.
    pub first_corner: Option<DVec2>,
}

impl Pointer<'_> {
    /// Canvas pixels of a position in points.
    pub fn px(&self, at: Pos2) -> DVec2 {
        let offset = at - self.rect.min;
        dvec2(f64::from(offset.x), f64::from(offset.y)) * self.px_per_point
    }

    /// World coordinates of a position in points.
    pub fn world(&self, at: Pos2) -> DVec2 {
        self.camera.world_from_screen(self.px(at))
    }

    /// World coordinates of a position in points, with no more digits than a pixel is worth.
    fn round_world(&self, at: Pos2) -> DVec2 {
        let unit = 10_f64.powf((1.0 / self.camera.px_per_world()).log10().ceil());
        let inverse = (1.0 / unit).round();
        let world = self.world(at);
        if unit < 1.0 { (world * inverse).round() / inverse } else { (world / unit).round() * unit }
    }

    /// Follows the events of this frame in their order, so that a quick stroke keeps every point the mouse reported.
    pub fn follow_events(
        &mut self,
        ui: &Ui,
        response: &Response,
        gesture: &mut Gesture,
        commands: &mut Vec<Command>,
    ) {
        let events = ui.input(|input| input.events.clone());
        let space = ui.input(|input| input.key_down(Key::Space)) && !ui.ctx().egui_wants_keyboard_input();
        for event in &events {
            match *event {
                Event::PointerButton { pos, button, pressed: true, modifiers }
                    if response.contains_pointer()
                        && !self.covered.iter().any(|float| float.contains(pos))
                        && *gesture == Gesture::None
                        && self.rect.contains(pos) =>
                {
                    *gesture = self.press(pos, button, modifiers, space, commands);
                }
                Event::PointerMoved(pos) => self.moved(pos, gesture, commands),
                Event::PointerButton { pos, button, pressed: false, .. } => {
                    self.released(pos, button, gesture, commands);
                }
                Event::WindowFocused(false) => give_up(gesture, commands),
                _ => {}
            }
        }
        // Let go where no event told of it, as in another window.
        if !ui.input(|input| input.pointer.any_down()) {
            give_up(gesture, commands);
        }
        if response.contains_pointer() {
            self.scroll(ui);
        }
    }

    fn press(
        &mut self,
        pos: Pos2,
        button: PointerButton,
        modifiers: Modifiers,
        space: bool,
        commands: &mut Vec<Command>,
    ) -> Gesture {
        let pans = space || self.tools.tool == Tool::Pan || button == PointerButton::Middle;
        match button {
            PointerButton::Primary | PointerButton::Middle if pans => Gesture::Panning { last: pos, button },
            PointerButton::Primary => self.press_primary(pos, modifiers, commands),
            _ => Gesture::None,
        }
    }

    fn press_primary(&mut self, pos: Pos2, modifiers: Modifiers, commands: &mut Vec<Command>) -> Gesture {
        let point = self.world(pos);
        match self.tools.tool {
            Tool::Brush | Tool::Eraser if modifiers.alt || modifiers.command => {
                commands.push(Command::PickValue(point));
                Gesture::None
            }
            Tool::Brush | Tool::Eraser if modifiers.shift => {
                Gesture::Sizing { from: pos, radius: self.tools.radius, dragged: false }
            }
            Tool::Brush | Tool::Eraser => {
                commands.push(Command::BeginStroke(point));
                Gesture::Painting
            }
            Tool::Query => {
                commands.push(Command::Query(point));
                Gesture::None
            }
            Tool::Domain => self.press_domain(pos, modifiers, commands),
            Tool::Pan => Gesture::None,
        }
    }

    /// Alt turns adding into taking away, and back.
    fn press_domain(&mut self, pos: Pos2, modifiers: Modifiers, commands: &mut Vec<Command>) -> Gesture {
        let point = self.world(pos);
        let adds = self.tools.domain_adds != modifiers.alt;
        match self.tools.domain_shape {
            DomainToolMode::Brush => {
                commands.push(Command::Domain(DomainCommand::Reshape(self.brush_along(vec![point]), adds)));
                Gesture::Cutting { last: point, adds }
            }
            DomainToolMode::Rectangle => Gesture::Framing { from: pos, to: pos, adds: Some(adds) },
            DomainToolMode::Frame => Gesture::Framing { from: pos, to: pos, adds: None },
            DomainToolMode::Polygon => {
                let closes = self.first_corner.is_some_and(|first| {
                    let px = self.camera.screen_from_world(first).distance(self.px(pos));
                    px < CLOSING_POINTS * self.px_per_point
                });
                let command =
                    if closes { DomainCommand::CloseOutline } else { DomainCommand::AddCorner(point) };
                commands.push(Command::Domain(command));
                Gesture::None
            }
        }
    }

    fn brush_along(&self, path: Vec<DVec2>) -> CutShape {
        CutShape::Stroke { path, radius: self.tools.radius }
    }

    /// Cuts from where the brush was to where it is; all that it does in one frame is cut at once.
    fn cut_to(&self, point: DVec2, last: &mut DVec2, adds: bool, commands: &mut Vec<Command>) {
        if let Some(Command::Domain(DomainCommand::Reshape(CutShape::Stroke { path, .. }, _))) =
            commands.last_mut()
        {
            path.push(point);
        } else if point != *last {
            commands
                .push(Command::Domain(DomainCommand::Reshape(self.brush_along(vec![*last, point]), adds)));
        }
        *last = point;
    }

    fn moved(&mut self, pos: Pos2, gesture: &mut Gesture, commands: &mut Vec<Command>) {
        match gesture {
            Gesture::None => {}
            Gesture::Painting => commands.push(Command::DrawTo(self.world(pos))),
            Gesture::Panning { last, .. } => {
                *self.camera = self.camera.panned(self.px(pos) - self.px(*last));
                *last = pos;
            }
            Gesture::Framing { to, .. } => *to = pos,
            Gesture::Cutting { last, adds } => self.cut_to(self.world(pos), last, *adds, commands),
            Gesture::Sizing { from, radius, dragged } => {
                *dragged |= from.distance(pos) > CLICK_SLACK;
                if *dragged {
                    let px = f64::from(pos.x - from.x) * self.px_per_point;
                    commands.push(Command::BrushRadius(*radius + px / self.camera.px_per_world()));
                }
            }
        }
    }

    fn released(
        &mut self,
        pos: Pos2,
        released: PointerButton,
        gesture: &mut Gesture,
        commands: &mut Vec<Command>,
    ) {
        match *gesture {
            Gesture::Painting if released == PointerButton::Primary => commands.push(Command::EndStroke),
            Gesture::Sizing { dragged: false, .. } if released == PointerButton::Primary => {
                commands.push(Command::LineTo(self.world(pos)));
            }
            Gesture::Sizing { .. } if released == PointerButton::Primary => {}
            Gesture::Framing { from, adds, .. } if released == PointerButton::Primary => {
                if (pos.x - from.x).abs().min((pos.y - from.y).abs()) > CLICK_SLACK {
                    let (a, b) = (self.round_world(from), self.round_world(pos));
                    commands.extend(framed(a, b, adds));
                }
            }
            Gesture::Cutting { .. } if released == PointerButton::Primary => {
                commands.push(Command::EndGesture)
            }
            Gesture::Panning { button, .. } if released == button => {}
            _ => return,
        }
        *gesture = Gesture::None;
    }

    fn scroll(&mut self, ui: &Ui) {
        let (scrolled, pinched, at) = ui.input(|i| {
            (f64::from(i.smooth_scroll_delta().y), f64::from(i.zoom_delta()), i.pointer.hover_pos())
        });
        let factor = pinched * (scrolled * ZOOM_PER_POINT).exp();
        if let Some(at) = at
            && factor != 1.0
        {
            *self.camera = self.camera.zoomed(factor, self.px(at));
        }
    }
}

/// Ends a gesture where it is. What was painted or cut stays.
fn give_up(gesture: &mut Gesture, commands: &mut Vec<Command>) {
    match std::mem::take(gesture) {
        Gesture::Painting => commands.push(Command::EndStroke),
        Gesture::Cutting { .. } => commands.push(Command::EndGesture),
        _ => {}
    }
}

/// What a rectangle between two corners does to the domain.
fn framed(a: DVec2, b: DVec2, adds: Option<bool>) -> Vec<Command> {
    match adds {
        None => vec![Command::Domain(DomainCommand::Frame(Rect::spanning(a, b)))],
        Some(adds) => {
            let ring = corners(&Rect::spanning(a, b));
            vec![Command::Domain(DomainCommand::Reshape(CutShape::Ring(ring), adds)), Command::EndGesture]
        }
    }
}
