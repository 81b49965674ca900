//! Commands about pins.

use meshbrush_kit::kit::clock::{Duration, Instant};
use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec2;

use super::files::ROLES;
use super::load::load_pins;
use super::table::{copy_table, counted, export_table, nearest_pin};
use super::{PINS, Pins, PinsCommand, entries, entries_at, marks};
use crate::app::features::inspection::InspectCommand;
use meshbrush_core::document::Setting;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{Ctx, Feature, NO_LIMIT, Row};

/// The time of a frame that goes into the table of pins.
const TABLE_BUDGET: Duration = Duration::from_millis(3);

impl Feature for Pins {
    type Command = PinsCommand;
    const ROW: Row =
        Row { panels: &[&PINS], roles: &ROLES, marks: marks::paint, entries, entries_at, ..Row::EMPTY };

    fn execute(&mut self, command: PinsCommand, ctx: &mut Ctx<'_>) {
        match command {
            PinsCommand::Press { at, reach } => self.press(at, reach, ctx),
            PinsCommand::DragTo(to) => self.drag(to, ctx),
            PinsCommand::Pin => match ctx.session.queried() {
                Some(point) => self.add(point, ctx),
                None => {
                    ctx.session.tell("There is no query to pin: click the mesh with the query tool.".into());
                }
            },
            PinsCommand::Add(point) => self.add(point, ctx),
            PinsCommand::Select(number) => self.select(number, ctx),
            PinsCommand::Delete => self.delete(ctx),
            PinsCommand::DeleteAll => set_pins(Vec::new(), ctx),
            PinsCommand::Open(path) => load_pins(ctx.session, ctx.background, &path),
            PinsCommand::AddAll(points) => add_all(points, ctx),
            PinsCommand::Read => {
                let budget = if ctx.reproducible { NO_LIMIT } else { TABLE_BUDGET };
                self.reader.advance(ctx.session, ctx.view.quantity, Instant::now() + budget);
            }
            PinsCommand::Copy => copy_table(ctx.session, ctx.background),
            PinsCommand::Copied(text, count) => {
                ctx.egui.copy_text(text);
                ctx.session.tell(format!("Copied: the table of {}.", counted(count)));
            }
            PinsCommand::ExportAs(path) => {
                let export = |path| Command::from(PinsCommand::Export(path));
                ctx.commands.extend(ctx.project.save_table_as(path, export));
            }
            PinsCommand::Export(path) => export_table(ctx.session, ctx.background, &path),
        }
    }
}

impl Pins {
    /// Takes hold of the pin at a point, or else queries the point.
    fn press(&mut self, at: DVec2, reach: f64, ctx: &mut Ctx<'_>) {
        let pins = pins_of(ctx);
        self.selected = nearest_pin(pins, at, reach);
        let pin = self.selected.map(|number| pins[number]);
        self.grip = pin.map(|pin| pin - at);
        ctx.send(Command::from(InspectCommand::Query(pin.unwrap_or(at))));
    }

    fn drag(&mut self, to: DVec2, ctx: &mut Ctx<'_>) {
        let (Some(number), Some(grip)) = (self.selected_of(pins_of(ctx)), self.grip) else { return };
        let mut pins = pins_of(ctx).to_vec();
        pins[number] = to + grip;
        ctx.session.set(Setting::Pins(Arc::new(pins)));
        ctx.session.query(Some(to + grip));
    }

    /// Adds a pin as a gesture of its own, and selects it.
    fn add(&mut self, point: DVec2, ctx: &mut Ctx<'_>) {
        let mut pins = pins_of(ctx).to_vec();
        if let Some(number) = pins.iter().position(|pin| *pin == point) {
            self.selected = Some(number);
            return ctx.session.tell(format!("Pin {} is there already.", number + 1));
        }
        pins.push(point);
        self.selected = Some(pins.len() - 1);
        set_pins(pins, ctx);
    }

    fn select(&mut self, number: usize, ctx: &mut Ctx<'_>) {
        let Some(&pin) = pins_of(ctx).get(number) else { return };
        self.selected = Some(number);
        ctx.session.query(Some(pin));
        ctx.view.reveal(pin);
    }

    fn delete(&mut self, ctx: &mut Ctx<'_>) {
        let Some(number) = self.selected_of(pins_of(ctx)) else { return };
        let mut pins = pins_of(ctx).to_vec();
        pins.remove(number);
        self.selected = None;
        set_pins(pins, ctx);
    }
}

/// Adds a pin at each point that has none, as one gesture.
fn add_all(points: Vec<DVec2>, ctx: &mut Ctx<'_>) {
    let before = pins_of(ctx).len();
    let pins = with_points(pins_of(ctx).to_vec(), points);
    let added = pins.len() - before;
    set_pins(pins, ctx);
    ctx.session.tell(format!("Added: {}.", counted(added)));
}

/// Returns pins with those of points that have none yet.
pub fn with_points(mut pins: Vec<DVec2>, points: Vec<DVec2>) -> Vec<DVec2> {
    let mut known: HashSet<[u64; 2]> = pins.iter().map(bits).collect();
    pins.extend(points.into_iter().filter(|point| known.insert(bits(point))));
    pins
}

fn bits(point: &DVec2) -> [u64; 2] {
    [point.x.to_bits(), point.y.to_bits()]
}

fn pins_of<'a>(ctx: &'a Ctx<'_>) -> &'a [DVec2] {
    &ctx.session.document().settings().pins
}

fn set_pins(pins: Vec<DVec2>, ctx: &mut Ctx<'_>) {
    ctx.session.end_gesture();
    ctx.session.set(Setting::Pins(Arc::new(pins)));
    ctx.session.end_gesture();
}
