//! Runs the commands about the picture.

use std::path::Path;
use std::sync::Arc;

use super::{BACKGROUND, BackgroundPicture, PictureCommand, ROLES};
use crate::app::background::{Aim, Outcome, name_of};
use crate::app::command::{Command, EditCommand};
use crate::app::kit::{Ctx, Feature, Row};
use meshbrush_core::document::{Background, Setting};
use meshbrush_io::io;

impl Feature for BackgroundPicture {
    type Command = PictureCommand;
    const ROW: Row = Row { panels: &[&BACKGROUND], roles: &ROLES, ..Row::EMPTY };

    fn execute(&mut self, command: PictureCommand, ctx: &mut Ctx<'_>) {
        match command {
            PictureCommand::Open(path) => load(&path, ctx),
        }
    }
}

/// Reads a picture to be shown behind the mesh. A world file beside it says where it lies; without one it
/// covers the bounds of the domain.
fn load(path: &Path, ctx: &mut Ctx<'_>) {
    let bounds = ctx.session.document().settings().domain.bounds;
    let file = path.to_owned();
    ctx.background.start(Aim::Read, path, move |meter| {
        let read = io::png::read_picture(&file, meter).and_then(|picture| {
            let placed = io::world_file::bounds_beside(&file, picture.size)?;
            Ok((picture, placed.unwrap_or(bounds)))
        });
        match read {
            Ok((picture, bounds)) => {
                let (name, picture) = (name_of(&file), Arc::new(picture));
                let opacity = Background::USUAL_OPACITY;
                let shown = Background { name, picture, bounds, opacity };
                Outcome::PartRead(vec![
                    Command::Edit(EditCommand::Set(Setting::Background(Some(shown)))),
                    Command::Edit(EditCommand::EndGesture),
                ])
            }
            Err(error) => Outcome::not_read(error),
        }
    });
}
