//! Tables of threats, read and written.

use std::path::Path;

use super::threats_layer;
use meshbrush_core::layers::{LayerKind, Threat, Threats};
use meshbrush_io::io;
use meshbrush_kit::kit::background::{Aim, Background, Outcome, exported};
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{EmptyDocument, show_with_layer};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// Reads a table of threats in place of those of the selected layer, or as a new layer if the selected one is
/// of another kind. An empty document takes the extent of their ranges.
pub fn load_threats(session: &Session, background: &mut Background, path: &Path) {
    let layer = threats_layer(session.document()).map(|(layer, _)| layer.id);
    let (file, empty) = (path.to_owned(), EmptyDocument::of(session));
    let projection = session.document().settings().domain.projection;
    background.start(Aim::Read, path, move |meter| {
        let list = match io::threats::read(&file, projection, meter) {
            Ok(list) => list,
            Err(error) => return Outcome::not_read(error),
        };
        let extent = list.iter().map(Threat::reach).reduce(|a, b| a.union(&b));
        let over = empty.zip(extent).and_then(|(empty, extent)| empty.over(&file, extent, LengthUnit::None));
        match (Threats::new(list), over) {
            (Ok(threats), Some(settings)) => match show_with_layer(settings, threats, &file, &[]) {
                Ok(commands) => Outcome::PartRead(commands),
                Err(problem) => Outcome::NotRead(problem),
            },
            (Ok(threats), None) => {
                let kind = Box::new(LayerKind::Threats(threats));
                let change = match layer {
                    Some(layer) => LayerCommand::SetKind(layer, kind),
                    None => LayerCommand::Add(kind),
                };
                Outcome::PartRead(vec![
                    Command::from(EditCommand::EndGesture),
                    Command::from(change),
                    Command::from(EditCommand::EndGesture),
                ])
            }
            (Err((_, error)), _) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Writes the threats of the selected layer as a table.
pub fn save_threats(session: &Session, background: &mut Background, path: &Path) {
    let Some((_, threats)) = threats_layer(session.document()) else { return };
    let (threats, file) = (threats.clone(), path.to_owned());
    background.start(Aim::Export, path, move |meter| {
        let written = io::write_file_metered(&file, meter, |out| io::threats::write(out, threats.list()));
        let count = format::count(threats.list().len() as u64);
        exported(written, meter, &file, || format!("{count} threats written to {}.", file.display()))
    });
}
