//! An empty document takes the extent of the first file that is opened into it.

use std::path::Path;
use std::sync::Arc;

use crate::kit::background::name_of;
use crate::kit::command::{Command, FileCommand, LayerCommand, Opened, ShellCommand};
use crate::kit::session::Session;
use meshbrush_core::document::{Document, Settings, extent};
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::{Layer, LayerId, LayerKind};
use meshbrush_core::raster::Resampling;
use meshbrush_io::io::layers::RasterFrame;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// The settings of a document in which nothing was painted, and which has the default domain and layers.
#[derive(Clone, Debug)]
pub struct EmptyDocument(Settings);

impl EmptyDocument {
    /// Returns the settings of the document if it is empty.
    pub fn of(session: &Session) -> Option<Self> {
        let (document, default) = (session.document(), Settings::default());
        let settings = document.settings();
        let has_default_lengths = settings.domain == default.domain
            && settings.spacing == default.spacing
            && settings.transfer == default.transfer
            && settings.layers == default.layers;
        let has_no_data = document.paint().is_blank()
            && settings.background.is_none()
            && settings.lines.is_empty()
            && settings.pins.is_empty()
            && settings.paths == default.paths;
        (has_default_lengths && has_no_data).then(|| Self(settings.clone()))
    }

    /// Returns the settings over the extent of a file, with lengths in proportion to it; `None` if the extent
    /// has no area, or is the extent that the document has.
    pub fn over(&self, file: &Path, extent: Rect, unit: LengthUnit) -> Option<Settings> {
        if !extent.is_proper() || extent == self.0.domain.bounds {
            return None;
        }
        Some(self.on(file, Domain::rectangle(extent), unit))
    }

    /// Returns the settings on a domain from a file, with lengths in proportion to it.
    pub fn on(&self, file: &Path, domain: Domain, unit: LengthUnit) -> Settings {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let unit = if unit == LengthUnit::None { self.0.unit } else { unit };
        let Settings { rule, cleaning, gradation, max_triangles, max_memory, max_level, .. } = self.0;
        let default = Settings::for_domain(name, domain);
        Settings { unit, rule, cleaning, gradation, max_triangles, max_memory, max_level, ..default }
    }
}

/// Returns where a document wants rasters: an empty one takes all of a grid.
pub fn raster_frame(session: &Session) -> RasterFrame {
    let Settings { domain, transfer, .. } = session.document().settings();
    let wanted = EmptyDocument::of(session).is_none().then_some(domain.bounds);
    RasterFrame {
        domain: domain.bounds,
        wanted,
        plane: domain.projection.map(Into::into),
        transfer: *transfer,
        resampling: Resampling::Linear,
    }
}

/// Returns the commands that show settings over the extent of a file, with a layer of it on top, which is
/// selected. The notes are told, too.
///
/// # Errors
/// Fails with a sentence when no mesh can be built for them.
pub fn show_with_layer(
    mut settings: Settings,
    kind: impl Into<LayerKind>,
    file: &Path,
    notes: &[String],
) -> Result<Vec<Command>, String> {
    let id = LayerId(settings.layers.iter().map(|layer| layer.id.0 + 1).max().unwrap_or(0));
    let kind = kind.into();
    settings.layers.push(Layer::new(id, kind.name(), kind));
    let mut commands = show_over_extent(settings, file, notes)?;
    commands.push(Command::from(LayerCommand::Select(id)));
    Ok(commands)
}

/// The space that an empty document leaves around the points of a file, as a share of their longer side.
const SHARE_AROUND: f64 = 0.1;

/// Returns the extent of a file of points, lines or polygons with some space around it.
pub fn with_space_around(extent: Rect) -> Rect {
    extent.expanded(SHARE_AROUND * extent.size().max_element())
}

/// Returns the commands that show settings over the extent of a file, and say so, with notes after it.
///
/// # Errors
/// Fails with a sentence when no mesh can be built for them.
pub fn show_over_extent(settings: Settings, file: &Path, notes: &[String]) -> Result<Vec<Command>, String> {
    // Metres in a plane that was chosen say nothing to a person who knows the file.
    let bounds = match settings.domain.projection {
        Some(_) => String::new(),
        None => format!(": {}", extent(&settings.domain.bounds)),
    };
    let name = name_of(file);
    let document = Document::new(settings, None).map_err(|error| format!("{}: {error}", file.display()))?;
    let opened = Opened { document: Arc::new(document), home: None };
    let news = format!("The document was empty, so it takes the extent of {name}{bounds}.");
    let news = [&[news], notes].concat().join(" ");
    Ok(vec![Command::from(FileCommand::Show(opened)), Command::from(ShellCommand::Tell(news))])
}
