//! Runs the commands about the picture.

use std::path::Path;
use std::sync::Arc;

use glam::dvec2;

use super::{BACKGROUND, BackgroundPicture, PictureCommand, ROLES};
use meshbrush_core::document::{Background, Setting, Settings};
use meshbrush_io::io;
use meshbrush_kit::kit::background::{Aim, Outcome, name_of};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::{Ctx, EmptyDocument, Feature, Row, show_over_extent};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

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
/// covers the bounds of the domain. An empty document takes the extent of the picture: without a world file,
/// a rectangle of its proportions.
fn load(path: &Path, ctx: &mut Ctx<'_>) {
    let bounds = ctx.session.document().settings().domain.bounds;
    let (file, empty) = (path.to_owned(), EmptyDocument::of(ctx.session));
    ctx.background.start(Aim::Read, path, move |meter| {
        let read = io::png::read_picture(&file, meter).and_then(|picture| {
            let placed = io::world_file::bounds_beside(&file, picture.size)?;
            Ok((picture, placed))
        });
        let (picture, placed) = match read {
            Ok(read) => read,
            Err(error) => return Outcome::not_read(error),
        };
        let extent = placed.unwrap_or_else(|| proportioned(&bounds, picture.size));
        let over = empty.and_then(|empty| empty.over(&file, extent, LengthUnit::None));
        let bounds = placed.unwrap_or(if over.is_some() { extent } else { bounds });
        let (name, picture) = (name_of(&file), Arc::new(picture));
        let shown = Some(Background { name, picture, bounds, opacity: Background::DEFAULT_OPACITY });
        match over {
            Some(settings) => {
                match show_over_extent(Settings { background: shown, ..settings }, &file, &[]) {
                    Ok(commands) => Outcome::PartRead(commands),
                    Err(problem) => Outcome::NotRead(problem),
                }
            }
            None => Outcome::PartRead(vec![
                Command::from(EditCommand::Set(Setting::Background(shown))),
                Command::from(EditCommand::EndGesture),
            ]),
        }
    });
}

/// Returns a rectangle with the proportions of a picture, at the lower left corner of another one and with
/// the longer side of that one.
fn proportioned(bounds: &Rect, [columns, rows]: [u32; 2]) -> Rect {
    let size = dvec2(f64::from(columns), f64::from(rows));
    Rect::new(bounds.min, bounds.min + size / size.max_element() * bounds.size().max_element())
}
