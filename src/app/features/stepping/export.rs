//! Steps as numbered drawings.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use super::Steps;
use super::steps::names_of;
use meshbrush_io::io;
use meshbrush_kit::kit::background::listed;
use meshbrush_kit::kit::background::{Aim, Background, Outcome, not_exported};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::{View, deepest_level};
use meshbrush_render::colormap::{Ground, LevelColors};
use meshbrush_render::render::picture_of;
use meshbrush_study::drawing::Drawing;
use meshbrush_study::steps::{StepColors, drawing, numbered};
use meshbrush_ui::lettering::WindowLetters;
use meshbrush_ui::widgets::format;

/// Most steps that are exported at once.
pub const MOST_FILES: usize = 500;
/// Pixels of pictures for a unit of drawings: a picture is 2400 pixels wide.
const PX_PER_UNIT: f64 = 2.0;
/// Letters on a dark and on a light ground.
const ON_DARK: [u8; 3] = [0xe8; 3];
const ON_LIGHT: [u8; 3] = [0x20; 3];
/// Numbers over the colours of levels, with their halo.
const NUMBERS_ON_DARK: [[u8; 3]; 2] = [[0xdd; 3], [0; 3]];
const NUMBERS_ON_LIGHT: [[u8; 3]; 2] = [[0x18; 3], [0xff; 3]];

impl Steps {
    /// Returns the first and the last step to be exported.
    pub fn export_range(&self) -> RangeInclusive<usize> {
        let last = self.player().map_or(0, |player| player.len());
        let [from, to] = self.export_range;
        from.min(last)..=to.min(last)
    }

    /// Sets the first and the last step to be exported.
    pub fn set_export_range(&mut self, first: usize, last: usize) {
        self.export_range = [first, last];
    }

    /// Returns the files of the steps to be exported.
    ///
    /// # Errors
    /// Fails with a sentence when there are too many of them, or none.
    pub fn files(&self, path: &Path) -> Result<Vec<PathBuf>, String> {
        let range = self.export_range();
        let count = range.clone().count();
        if count == 0 {
            return Err("No step was exported: the first one comes after the last one.".into());
        }
        if count > MOST_FILES {
            return Err(format!(
                "{} steps are too many: at most {MOST_FILES} are exported at once. Choose fewer.",
                format::count(count as u64)
            ));
        }
        let last = self.player().map_or(0, |player| player.len());
        Ok(range.map(|position| numbered(path, position, last)).collect())
    }

    /// Writes the drawings on another thread.
    ///
    /// # Errors
    /// Fails with a sentence when they cannot be written.
    pub fn export(
        &self,
        path: &Path,
        session: &Session,
        view: &View,
        background: &mut Background,
    ) -> Result<(), String> {
        let files = self.files(path)?;
        let blocked = |file: &PathBuf| {
            Some(format!("{} could not be written: {}.", file.display(), io::obstacle(file)?))
        };
        if let Some(problem) = files.iter().find_map(blocked) {
            return Err(problem);
        }
        let Some(mut player) = self.player().cloned() else { return Ok(()) };
        let ground = self.export_ground.unwrap_or(view.ground);
        let deepest = deepest_level(session.follower().settings());
        let levels = LevelColors::new(view.colormap, ground, deepest);
        let (range, figure, path) = (self.export_range(), self.figure, path.to_owned());
        background.start(Aim::Export, &path.clone(), move |meter| {
            let [across, waiting, relinked] = Ground::ON_LEVELS;
            let colors = StepColors {
                levels: levels.as_table(),
                background: ground.canvas(),
                text: if ground == Ground::Dark { ON_DARK } else { ON_LIGHT },
                numbers: if ground == Ground::Dark { NUMBERS_ON_DARK } else { NUMBERS_ON_LIGHT },
                parts: [waiting, relinked, across],
            };
            let letters = WindowLetters::default();
            let mut written = WrittenSteps::default();
            for (position, file) in range.zip(&files) {
                player.go_to(position);
                let is_new = !io::exists(file);
                let drawing = drawing(&player, &names_of(&player, figure), &letters, &colors);
                let written_bytes = encoded(&drawing, file).and_then(|bytes| {
                    io::write_file_metered(file, meter, |out| out.write_all(&bytes))?;
                    Ok(bytes.len())
                });
                match written_bytes {
                    Ok(bytes) => _ = meter.add(bytes as u64),
                    Err(error) => return written.take_back(not_exported(&error, meter, file)),
                }
                if is_new { &mut written.new } else { &mut written.replaced }.push(file.clone());
            }
            let count = format::count(files.len() as u64);
            Outcome::Exported(format!("{count} steps written to {}.", listed(&files)))
        });
        Ok(())
    }
}

/// Returns the bytes of the file of a drawing: a picture where its name ends in `.png`, and else an SVG.
fn encoded(drawing: &Drawing, file: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        let image = picture_of(drawing, PX_PER_UNIT);
        io::png::write_small(&mut bytes, image.size, &image.rgba)?;
    } else {
        drawing.write_svg(&mut bytes)?;
    }
    Ok(bytes)
}

/// The drawings that are written so far.
#[derive(Default)]
struct WrittenSteps {
    new: Vec<PathBuf>,
    /// Those in place of other files.
    replaced: Vec<PathBuf>,
}

impl WrittenSteps {
    /// Removes the new ones, because the export did not come to its end, and says what cannot be taken back.
    fn take_back(self, outcome: Outcome) -> Outcome {
        io::remove_new(&self.new);
        let remains = match &self.replaced[..] {
            [] => return outcome,
            [file] => format!("{} was replaced before that.", file.display()),
            files => format!("{} files were replaced before that: {}.", files.len(), listed(files)),
        };
        match outcome {
            Outcome::NotWritten(problem) => Outcome::NotWritten(format!("{problem} {remains}")),
            Outcome::Exported(_) => Outcome::Exported(format!("Writing the steps was cancelled. {remains}")),
            other => other,
        }
    }
}
