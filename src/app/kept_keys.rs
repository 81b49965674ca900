//! The changed keys, kept from run to run in the window's own storage.

use super::App;
use meshbrush_kit::kit::Keymap;

/// Where the changed keys are in the storage.
const KEYS_KEY: &str = "keys";
/// Where keys are that could not be read, once others were chosen.
const UNREAD_KEY: &str = "keys that could not be read";

impl App {
    /// Takes over the keys of the last run. If they cannot be read, a message says so, and they stay in the
    /// storage until a person changes keys.
    pub(super) fn load_keys(&mut self, storage: &dyn eframe::Storage) {
        let Some(text) = storage.get_string(KEYS_KEY) else { return };
        match Keymap::parse(&text) {
            Ok(keymap) => self.keymap = keymap,
            Err(problem) => {
                self.session.report(format!(
                    "The keys that you changed could not be read. {problem} The default keys work until you change \
                     or import keys."
                ));
                self.unread_keys = Some(text);
            }
        }
    }

    /// Stores the keys for the next run.
    pub(super) fn store_keys(&self, storage: &mut dyn eframe::Storage) {
        if let Some(unread) = &self.unread_keys {
            if self.keymap == Keymap::default() {
                return;
            }
            storage.set_string(UNREAD_KEY, unread.clone());
        }
        storage.set_string(KEYS_KEY, self.keymap.to_text());
    }
}

#[cfg(test)]
mod tests {
    use eframe::Storage as _;

    use super::*;
    use crate::app::tests::{Kept, notice, send, window};
    use meshbrush_kit::kit::command::{Command, ShellCommand};

    #[test]
    fn keys_that_cannot_be_read_are_reported_and_stay_until_others_are_chosen() {
        let mut storage = Kept::default();
        let damaged =
            "{ \"format\": \"meshbrush keys\", \"version\": 1, \"keys\": { \"brush\": [\"Hyper+Q\"] } }";
        storage.set_string(KEYS_KEY, damaged.into());
        let mut window = window();
        window.state_mut().load_keys(&storage);
        window.run();
        let said = notice(&window);
        assert!(said.contains("Hyper+Q") && said.contains("The default keys work"), "{said}");
        window.state().store_keys(&mut storage);
        assert_eq!(storage.get_string(KEYS_KEY).as_deref(), Some(damaged), "nothing is lost");
        let changed = Keymap::parse(&damaged.replace("Hyper+Q", "F12")).expect("keys");
        send(&mut window, Command::from(ShellCommand::SetKeys(changed.clone())));
        window.state().store_keys(&mut storage);
        assert_eq!(storage.get_string(KEYS_KEY), Some(changed.to_text()));
        assert_eq!(storage.get_string(UNREAD_KEY).as_deref(), Some(damaged));
    }
}
