//! What files are asked for, and what to do with the answer.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::app::command::{
    Command, DomainCommand, FileCommand, LayerCommand, PictureCommand, PinsCommand, ThreatsCommand,
};
use crate::app::keep_out::KeepOutCommand;
use crate::app::paths::PathCommand;
use crate::app::plots::PlotsCommand;
use crate::app::stepping::StepCommand;
use meshbrush_io::io::project::ENDING;
use meshbrush_io::io::{plot, recipe, recording};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_render::render::path_export::PathFormat;

/// Why a path is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// To open any file that can be opened.
    Open,
    /// To save the document.
    Save,
    /// To write the document as a recipe.
    SaveRecipe,
    /// To write what was done as a test.
    ExportTest,
    /// To open a picture or a grid as risk.
    OpenImage,
    /// To open a grid as target diameters.
    OpenDiameters,
    /// To open a picture to trace.
    OpenBackground,
    /// To open polygons as a domain.
    OpenDomain,
    /// To add polygons to the domain of the document.
    AddOutline,
    /// To open a picture or a grid, and make a band of its values.
    OpenBand,
    /// To open a picture or a grid through a curve of its values.
    OpenValues,
    /// To open points, lines and polygons as a layer of distances.
    OpenShapes,
    /// To open them in place of those of a layer.
    ReplaceShapes,
    /// To open polygons as the mask of a layer.
    OpenMask,
    /// To open polygons as a region that paths stay out of.
    OpenKeepOut,
    /// To open a table of threats.
    OpenThreats,
    /// To write a table of threats.
    SaveThreats,
    /// To write the table of the pins.
    ExportPins,
    /// To write the plot.
    ExportPlot,
    /// To write a path.
    ExportPath,
    /// To write the mesh.
    Export,
    /// To write steps of the refinement.
    ExportSteps,
}

impl FileRequest {
    /// Title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::Open => "Open",
            Self::Save => "Save project",
            Self::SaveRecipe => "Save as recipe",
            Self::ExportTest => "Export as test",
            Self::OpenImage => "Open picture as risk",
            Self::OpenDiameters => "Open grid as target diameter",
            Self::OpenBackground => "Open background picture",
            Self::OpenDomain => "Open domain",
            Self::AddOutline => "Add outline to this document",
            Self::OpenBand => "Open picture or grid as band",
            Self::OpenValues => "Open picture or grid through a curve",
            Self::OpenShapes => "Open shapes to measure the distance to",
            Self::ReplaceShapes => "Open other shapes for this layer",
            Self::OpenMask => "Open polygons as mask",
            Self::OpenKeepOut => "Open polygons as keep-out region",
            Self::OpenThreats => "Open table of threats",
            Self::SaveThreats => "Save table of threats",
            Self::ExportPins => "Export table of pins",
            Self::ExportPlot => "Export plot",
            Self::ExportPath => "Export path",
            Self::Export => "Export mesh",
            Self::ExportSteps => "Export steps as SVG",
        }
    }

    /// Whether the file can become a document of its own.
    pub fn opens_document(self) -> bool {
        matches!(self, Self::Open | Self::OpenDomain)
    }

    /// The word on the button.
    pub fn verb(self) -> &'static str {
        match self {
            Self::Open
            | Self::OpenImage
            | Self::OpenDiameters
            | Self::OpenBackground
            | Self::OpenDomain
            | Self::OpenBand
            | Self::OpenValues
            | Self::OpenShapes
            | Self::ReplaceShapes
            | Self::OpenMask
            | Self::OpenKeepOut
            | Self::OpenThreats => "Open",
            Self::AddOutline => "Add",
            Self::Save | Self::SaveRecipe | Self::SaveThreats => "Save",
            Self::ExportPins
            | Self::ExportPlot
            | Self::ExportPath
            | Self::Export
            | Self::ExportSteps
            | Self::ExportTest => "Export",
        }
    }

    /// The endings of the files that it is about, without the dot.
    pub fn endings(self) -> Vec<&'static str> {
        match self {
            Self::Open => vec![ENDING, recipe::ENDING, "geojson", "json", "png", "asc"],
            Self::Save => vec![ENDING],
            Self::SaveRecipe => vec![recipe::ENDING],
            Self::ExportTest => vec![recording::ENDING],
            Self::OpenImage | Self::OpenBand | Self::OpenValues => vec!["png", "asc"],
            Self::OpenDiameters => vec!["asc"],
            Self::OpenBackground => vec!["png"],
            Self::OpenDomain
            | Self::AddOutline
            | Self::OpenShapes
            | Self::ReplaceShapes
            | Self::OpenMask
            | Self::OpenKeepOut => vec!["geojson", "json"],
            Self::OpenThreats | Self::SaveThreats | Self::ExportPins => vec!["csv"],
            Self::Export => ExportFormat::endings().collect(),
            Self::ExportPlot => plot::ENDINGS.to_vec(),
            Self::ExportPath => PathFormat::ENDINGS.to_vec(),
            Self::ExportSteps => vec!["svg"],
        }
    }

    /// What those files are, in the words of a filter.
    pub fn kinds(self) -> &'static str {
        match self {
            Self::Open => "Projects, domains, pictures, grids",
            Self::Save => "Projects",
            Self::SaveRecipe => "Recipes",
            Self::ExportTest => "Recorded sessions",
            Self::OpenImage | Self::OpenBand | Self::OpenValues => "Pictures and grids",
            Self::OpenDiameters => "Grids",
            Self::OpenBackground => "Pictures",
            Self::OpenDomain | Self::AddOutline | Self::OpenMask | Self::OpenKeepOut => "Polygons",
            Self::OpenShapes | Self::ReplaceShapes => "Points, lines and polygons",
            Self::OpenThreats | Self::SaveThreats => "Tables of threats",
            Self::ExportPins => "Tables",
            Self::ExportPlot => "Drawings and tables",
            Self::ExportPath => "Lines, tables and pictures",
            Self::Export => "Meshes and pictures",
            Self::ExportSteps => "Drawings",
        }
    }

    /// Whether a file with this name can be the answer.
    pub fn takes(self, name: &OsStr) -> bool {
        let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        self.endings().contains(&ending.as_str())
    }

    /// Names the kind of file: each has its own last folder.
    pub fn folder_key(self) -> &'static str {
        match self {
            Self::Open | Self::Save => "projects",
            Self::OpenImage | Self::OpenDiameters | Self::OpenBand | Self::OpenValues => "pictures",
            Self::OpenBackground => "backgrounds",
            Self::OpenDomain | Self::AddOutline | Self::OpenMask | Self::OpenKeepOut => "domains",
            Self::OpenShapes | Self::ReplaceShapes => "shapes",
            Self::SaveRecipe => "recipes",
            Self::ExportTest => "tests",
            Self::OpenThreats | Self::SaveThreats => "threats",
            Self::ExportPins | Self::ExportPlot | Self::ExportPath | Self::Export | Self::ExportSteps => {
                "exports"
            }
        }
    }

    /// Whether a file is written.
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::Save
                | Self::SaveRecipe
                | Self::ExportTest
                | Self::SaveThreats
                | Self::ExportPins
                | Self::ExportPlot
                | Self::ExportPath
                | Self::Export
                | Self::ExportSteps
        )
    }

    /// The name that a file to write is given first; nothing for a file to read.
    pub fn proposed_name(self, document: &str, format: ExportFormat) -> String {
        let name: String =
            document.chars().map(|c| if c == '/' || c == '\\' || c.is_control() { '-' } else { c }).collect();
        match self {
            Self::Save => format!("{name}.{ENDING}"),
            Self::SaveRecipe => format!("{name}.{}", recipe::ENDING),
            Self::ExportTest => format!("{name}.{}", recording::ENDING),
            Self::SaveThreats => format!("{name} threats.csv"),
            Self::ExportPins => format!("{name} pins.csv"),
            Self::ExportPlot => format!("{name} plot.svg"),
            Self::ExportPath => format!("{name} path.{}", PathFormat::ENDINGS[0]),
            Self::Export => format!("{name}.{}", format.ending()),
            Self::ExportSteps => format!("{name} step.svg"),
            _ => String::new(),
        }
    }

    /// What to do with a path that was typed.
    pub fn command(self, path: PathBuf) -> Command {
        match self {
            Self::Open => Command::File(FileCommand::Open(path)),
            Self::Save => Command::File(FileCommand::SaveAs(path)),
            Self::SaveRecipe => Command::File(FileCommand::SaveRecipeAs(path)),
            Self::ExportTest => Command::File(FileCommand::ExportTestAs(path)),
            Self::OpenImage => Command::Layer(LayerCommand::OpenImage(path)),
            Self::OpenDiameters => Command::Layer(LayerCommand::OpenDiameters(path)),
            Self::OpenBackground => Command::Picture(PictureCommand::Open(path)),
            Self::OpenDomain => Command::Domain(DomainCommand::Open(path)),
            Self::AddOutline => Command::Domain(DomainCommand::AddOutline(path)),
            Self::OpenBand => Command::Layer(LayerCommand::OpenBand(path)),
            Self::OpenValues => Command::Layer(LayerCommand::OpenValues(path)),
            Self::OpenShapes => Command::Layer(LayerCommand::OpenShapes(path)),
            Self::ReplaceShapes => Command::Layer(LayerCommand::ReplaceShapes(path)),
            Self::OpenMask => Command::Layer(LayerCommand::OpenMask(path)),
            Self::OpenKeepOut => Command::Path(PathCommand::KeepOut(KeepOutCommand::Open(path))),
            Self::OpenThreats => Command::Threats(ThreatsCommand::Open(path)),
            Self::SaveThreats => Command::Threats(ThreatsCommand::SaveAs(path)),
            Self::ExportPins => Command::Pins(PinsCommand::ExportAs(path)),
            Self::ExportPlot => Command::Plots(PlotsCommand::ExportAs(path)),
            Self::ExportPath => Command::Path(PathCommand::ExportAs(path)),
            Self::Export => Command::File(FileCommand::ExportAs(path)),
            Self::ExportSteps => Command::Steps(StepCommand::ExportAs(path)),
        }
    }

    /// What to do with a path from the desktop's own dialog, which has asked already whether to replace the
    /// file.
    pub fn command_after_browsing(self, path: PathBuf) -> Command {
        // It has not asked about the files beside it.
        let alone = ExportFormat::of(&path).is_ok_and(|format| format.files(&path).len() == 1);
        match self {
            Self::Save => Command::File(FileCommand::SaveTo(path)),
            Self::SaveThreats => Command::Threats(ThreatsCommand::Save(path)),
            Self::ExportPins => Command::Pins(PinsCommand::Export(path)),
            Self::ExportPlot => Command::Plots(PlotsCommand::Export(path)),
            Self::ExportPath if path.extension().is_some() => Command::Path(PathCommand::Export(path)),
            Self::ExportTest => Command::File(FileCommand::ExportTest(path)),
            Self::Export if alone => Command::File(FileCommand::Export(path)),
            _ => self.command(path),
        }
    }
}
