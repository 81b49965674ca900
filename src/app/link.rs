//! Links: the document, and how it is looked at.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use super::App;
use super::features::stepping::StepCommand;
use super::files::new_document;
use crate::app::features::stepping::Stepping;
use meshbrush_io::io::link::{self, LinkSpace, LinkView, Linked};
use meshbrush_kit::kit::command::{Command, FileCommand, Opened, ShellCommand, SpaceCommand, ViewCommand};
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::scene::ViewDirection;

/// Returns the part of a link after `#`, where a name of a file is a link to a page of the program, or that
/// part alone.
pub fn part_of(name: &Path) -> Option<String> {
    let (page, part) = name.to_str()?.split_once('#')?;
    let is_page = page.starts_with("https://") || page.starts_with("http://");
    let is_part = || part.split_once('.').is_some_and(|(version, _)| version.parse::<u32>().is_ok());
    (is_page || page.is_empty() && is_part()).then(|| part.to_owned())
}

impl App {
    /// Returns the document, and how it is looked at, as the part of a link after `#`.
    ///
    /// # Errors
    /// Fails with a sentence where the document is too large for a link.
    pub(super) fn link(&self) -> Result<String, String> {
        let area = self.view.camera.filter(|_| !self.view.is_fitted).map(|camera| camera.visible_world());
        let tool = self.tools.chosen();
        let view = LinkView {
            area: area.map(|area| [area.min.x, area.min.y, area.max.x, area.max.y]),
            tool: (!self.tools.has_first()).then(|| tool.name.to_owned()),
            space: self.view.space.shown().map(|(from, [exaggeration, height])| LinkSpace {
                direction: [from.azimuth, from.altitude],
                exaggeration,
                height,
            }),
            step: self
                .features
                .get::<Stepping>()
                .steps()
                .map(|steps| steps.player().map_or(0, |p| p.position())),
        };
        link::write(self.session.document(), &view)
    }

    /// Shows what a link holds; one that cannot be read leaves an empty document and a sentence.
    pub(super) fn open_link(&mut self, link: &str) {
        let (Linked { document, view }, problem) = match link::read(link) {
            Ok(linked) => (linked, None),
            Err(problem) => (Linked { document: new_document(), view: LinkView::default() }, Some(problem)),
        };
        self.starts_with_file = false;
        let bounds = document.settings().lattice().map(|lattice| lattice.bounds());
        let opened = Opened { document: Arc::new(document), home: None };
        self.send(Command::from(FileCommand::Show(opened)));
        match view.space {
            Some(LinkSpace { direction: [azimuth, altitude], exaggeration, height }) => {
                let direction = ViewDirection { azimuth, altitude };
                let show = SpaceCommand::Show(direction, [exaggeration, height]);
                self.send(Command::from(ViewCommand::Space(show)));
            }
            None => self.view.leave_space(),
        }
        if let (Ok(bounds), Some([x0, y0, x1, y1])) = (bounds, view.area) {
            let area = Rect::spanning(DVec2::new(x0, y0), DVec2::new(x1, y1));
            self.send(Command::from(ViewCommand::ShowAreaOf(bounds, area)));
        }
        let tool = view.tool.and_then(|name| self.tools.all().iter().find(|tool| tool.name == name).copied());
        if let Some(tool) = tool {
            self.send(Command::from(ShellCommand::Use(tool)));
        }
        if let Some(step) = view.step {
            self.send(Command::from(StepCommand::BeginAt(step)));
        }
        if let Some(problem) = problem {
            self.send(Command::from(FileCommand::Fail(problem)));
        }
    }
}
