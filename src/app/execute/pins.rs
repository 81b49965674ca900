//! Commands about pins.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::Context;
use glam::DVec2;

use crate::app::App;
use crate::app::command::{Command, PinsCommand};
use crate::app::frame::NO_LIMIT;
use crate::app::pins::{self, counted, nearest_pin};
use meshbrush_core::document::Setting;

/// The time of a frame that goes into the table of pins.
const TABLE_BUDGET: Duration = Duration::from_millis(3);

impl App {
    pub(super) fn execute_on_pins(&mut self, command: PinsCommand, ctx: &Context) {
        match command {
            PinsCommand::Press { at, reach } => self.press_pins(at, reach),
            PinsCommand::DragTo(to) => self.drag_pin(to),
            PinsCommand::Pin => match self.session.queried() {
                Some(point) => self.add_pin(point),
                None => {
                    self.session.tell("There is no query to pin: click the mesh with the query tool.".into())
                }
            },
            PinsCommand::Add(point) => self.add_pin(point),
            PinsCommand::Select(number) => self.select_pin(number),
            PinsCommand::Delete => self.delete_pin(),
            PinsCommand::DeleteAll => self.set_pins(Vec::new()),
            PinsCommand::Read => {
                let budget = if self.reproducible { NO_LIMIT } else { TABLE_BUDGET };
                self.pins.advance(&self.session, self.view.quantity, Instant::now() + budget);
            }
            PinsCommand::Copy => pins::copy_table(&self.session, &mut self.background),
            PinsCommand::Copied(text, count) => {
                ctx.copy_text(text);
                self.session.tell(format!("Copied: the table of {}.", counted(count)));
            }
            PinsCommand::ExportAs(path) => {
                let export = |path| Command::Pins(PinsCommand::Export(path));
                self.commands.extend(self.project.save_table_as(path, export));
            }
            PinsCommand::Export(path) => pins::export_table(&self.session, &mut self.background, &path),
        }
    }

    /// Takes hold of the pin at a point, or else queries the point.
    fn press_pins(&mut self, at: DVec2, reach: f64) {
        let pins = &self.session.document().settings().pins;
        let pressed = nearest_pin(pins, at, reach);
        let pin = pressed.map(|number| pins[number]);
        self.tools.pins.selected = pressed;
        self.tools.pins.grip = pin.map(|pin| pin - at);
        self.query(pin.unwrap_or(at));
    }

    fn drag_pin(&mut self, to: DVec2) {
        let (Some(number), Some(grip)) = (self.selected_pin(), self.tools.pins.grip) else { return };
        let mut pins = self.session.document().settings().pins.to_vec();
        pins[number] = to + grip;
        self.session.set(Setting::Pins(Arc::new(pins)));
        self.ask(Some(to + grip));
    }

    /// Adds a pin as a gesture of its own, and selects it.
    fn add_pin(&mut self, point: DVec2) {
        let mut pins = self.session.document().settings().pins.to_vec();
        if let Some(number) = pins.iter().position(|pin| *pin == point) {
            self.tools.pins.selected = Some(number);
            return self.session.tell(format!("Pin {} is there already.", number + 1));
        }
        pins.push(point);
        self.tools.pins.selected = Some(pins.len() - 1);
        self.set_pins(pins);
    }

    fn select_pin(&mut self, number: usize) {
        let Some(&pin) = self.session.document().settings().pins.get(number) else { return };
        self.tools.pins.selected = Some(number);
        self.ask(Some(pin));
        self.view.reveal(pin);
    }

    fn delete_pin(&mut self) {
        let Some(number) = self.selected_pin() else { return };
        let mut pins = self.session.document().settings().pins.to_vec();
        pins.remove(number);
        self.tools.pins.selected = None;
        self.set_pins(pins);
    }

    fn set_pins(&mut self, pins: Vec<DVec2>) {
        self.session.end_gesture();
        self.session.set(Setting::Pins(Arc::new(pins)));
        self.session.end_gesture();
    }

    fn selected_pin(&self) -> Option<usize> {
        self.tools.pins.selected_of(&self.session.document().settings().pins)
    }
}
