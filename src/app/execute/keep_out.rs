//! Commands about the regions that paths stay out of.

use crate::app::App;
use crate::app::keep_out::{self, KeepOutCommand};
use meshbrush_core::document::KeepOut;

impl App {
    pub(super) fn execute_on_keep_out(&mut self, command: KeepOutCommand) {
        match command {
            KeepOutCommand::Open(path) => keep_out::load(&mut self.background, &path),
            KeepOutCommand::Add(region) => self.change_keep_out(|regions| regions.push(region)),
            KeepOutCommand::AddMask => {
                if let Some(region) = KeepOutCommand::mask_to_add(&self.session) {
                    self.change_keep_out(|regions| regions.push(region));
                }
            }
            KeepOutCommand::Remove(number) => self.change_keep_out(|regions| {
                if number < regions.len() {
                    regions.remove(number);
                }
            }),
            KeepOutCommand::RemoveAll => self.change_keep_out(Vec::clear),
        }
    }

    fn change_keep_out(&mut self, change: impl FnOnce(&mut Vec<KeepOut>)) {
        self.change_paths(|plan| {
            let mut regions = plan.keep_out.to_vec();
            change(&mut regions);
            plan.keep_out = regions.into();
        });
    }
}
