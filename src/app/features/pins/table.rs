//! The table of the pins: their triangles and values.

use meshbrush_kit::kit::clock::Instant;
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use crate::app::features::pins::PinsCommand;
use meshbrush_io::io::{self, Meter};
use meshbrush_kit::kit::background::{Aim, Background, Outcome, exported};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::nearest_within;
use meshbrush_kit::kit::readout::{Quantity, Readout, TriangleReadout};
use meshbrush_kit::kit::session::Session;
use meshbrush_ui::widgets::format;

/// The data that the values of all pins depend on.
#[derive(Clone, Debug, PartialEq)]
struct PinTableKey {
    pins: Arc<Vec<DVec2>>,
    quantity: Quantity,
    document: u64,
    follower: u64,
    derived: u64,
}

impl PinTableKey {
    fn of(session: &Session, quantity: Quantity) -> Self {
        Self {
            pins: session.document().settings().pins.clone(),
            quantity,
            document: session.document().revision(),
            follower: session.follower().revision(),
            derived: session.derivation().pieces_revision(),
        }
    }
}

/// The values of a pin in the table.
#[derive(Clone, Debug, PartialEq)]
pub struct PinRow {
    /// Where the pin was when it was read, in world units.
    pub at: DVec2,
    /// The triangle around it; `None` where there is none.
    pub triangle: Option<TriangleReadout>,
}

/// Reads the values of the pins, some in each frame while the table is shown, and keeps them.
#[derive(Default)]
pub struct PinReader {
    key: Option<PinTableKey>,
    rows: Vec<Option<PinRow>>,
    /// The pin that is read next: reading goes round, so that no pin waits while edits go on.
    next: usize,
    /// How many are to be read until all are those of the key.
    left: usize,
}

impl PinReader {
    /// Returns the values of each pin; `None` until they were read. They may be those of an earlier mesh.
    pub fn rows(&self) -> &[Option<PinRow>] {
        &self.rows
    }

    /// Returns whether all values are those of the document and the mesh as they are.
    pub fn is_current(&self, session: &Session, quantity: Quantity) -> bool {
        self.left == 0 && self.key.as_ref() == Some(&PinTableKey::of(session, quantity))
    }

    /// Reads pins until all are current, or until `deadline`.
    pub fn advance(&mut self, session: &Session, quantity: Quantity, deadline: Instant) {
        let key = PinTableKey::of(session, quantity);
        let pins = key.pins.clone();
        if self.key.as_ref() != Some(&key) {
            self.rows.resize(pins.len(), None);
            (self.key, self.left) = (Some(key), pins.len());
        }
        while self.left > 0 {
            self.next %= pins.len();
            let at = pins[self.next];
            let triangle = Readout::triangle_at(at, session, quantity);
            self.rows[self.next] = Some(PinRow { at, triangle });
            (self.next, self.left) = (self.next + 1, self.left - 1);
            if Instant::now() >= deadline {
                break;
            }
        }
    }
}

/// Returns the pin nearest to a point, at most `reach` away. Lengths are in world units.
pub fn nearest_pin(pins: &[DVec2], to: DVec2, reach: f64) -> Option<usize> {
    nearest_within(pins.iter().map(|pin| pin.distance(to)), reach)
}

/// Makes the table of the pins, and then copies it.
pub fn copy_table(session: &Session, background: &mut Background) {
    let (count, write) = table(session);
    background.start(Aim::Export, Path::new("table of pins"), move |meter| {
        let mut text = Vec::new();
        match write(&mut text, meter) {
            Ok(()) => {
                let text = String::from_utf8_lossy(&text).into_owned();
                Outcome::PartRead(vec![Command::from(PinsCommand::Copied(text, count))])
            }
            Err(_) if meter.is_cancelled() => Outcome::Exported("The table of pins was not copied.".into()),
            Err(error) => Outcome::NotWritten(format!("The table of pins was not copied. {error}")),
        }
    });
}

/// Writes the table of the pins to a file.
pub fn export_table(session: &Session, background: &mut Background, path: &Path) {
    let (count, write) = table(session);
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| {
        let written = io::write_file_metered(&file, meter, |out| write(out, meter));
        exported(written, meter, &file, || format!("{} written to {}.", counted(count), file.display()))
    });
}

/// Returns a number of pins in words.
pub fn counted(count: usize) -> String {
    if count == 1 { "1 pin".into() } else { format!("{} pins", format::count(count as u64)) }
}

/// Returns how many pins there are, and what writes their table.
fn table(
    session: &Session,
) -> (usize, impl Fn(&mut dyn std::io::Write, &Meter) -> std::io::Result<()> + Send + 'static) {
    let (settings, paint) = (session.document().settings().clone(), session.document().paint().clone());
    let write = move |out: &mut dyn std::io::Write, meter: &Meter| {
        io::located::write_of_document(out, &settings, &paint, &settings.pins, meter)
    };
    (session.document().settings().pins.len(), write)
}
