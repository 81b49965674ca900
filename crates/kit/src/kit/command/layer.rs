//! Commands about layers.

use std::path::PathBuf;

use super::CommandSet;
use meshbrush_core::layers::{Combine, DistanceTo, LayerId, LayerKind, Mask};

/// One thing to do with layers.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerCommand {
    /// Selects a layer: its parameters are shown, and brush and eraser act on it.
    Select(LayerId),
    /// Adds a layer above the selected one.
    Add(Box<LayerKind>),
    /// Adds a band of the selected layer's raster, or else of the highest raster. Asks for a file where there
    /// is none.
    AddBand,
    /// Adds a copy above a layer.
    Duplicate(LayerId),
    /// Removes a layer.
    Delete(LayerId),
    /// Moves a layer to a place, counted from the bottom without that layer.
    Move(LayerId, usize),
    /// Gives a layer a name.
    Rename(LayerId, String),
    /// Shows or hides a layer.
    Show(LayerId, bool),
    /// Shows one layer alone. Where it is alone already, shows all.
    Solo(LayerId),
    /// Shows the area in which a layer asks for something, as large as it fits.
    ZoomTo(LayerId),
    /// Locks or unlocks a layer.
    Lock(LayerId, bool),
    /// Chooses how a layer is combined with those below it.
    Combine(LayerId, Combine),
    /// Changes what a layer asks for. Further changes join this gesture until
    /// [`EditCommand::EndGesture`](super::EditCommand::EndGesture).
    SetKind(LayerId, Box<LayerKind>),
    /// Chooses what the distance of a layer is measured to.
    MeasureTo(LayerId, DistanceTo),
    /// Makes a layer count only inside a mask, or everywhere.
    Mask(LayerId, Option<Mask>),
    /// Removes the paint of a layer.
    Clear(LayerId),
    /// Begins to type a new name of a layer in the panel.
    AskName(LayerId),
    /// Limits the gradation of h̄ to the default slope, or removes the limit.
    LimitGradation(bool),
    /// Reads a greyscale picture, or a grid of its own placement, as a layer of risk.
    OpenImage(PathBuf),
    /// Reads a grid as a layer of target diameters.
    OpenDiameters(PathBuf),
    /// Reads a picture or a grid, and adds a band of its values.
    OpenBand(PathBuf),
    /// Writes what the selected layer asks for, as a grid, and asks before a file is replaced.
    ExportGridAs(PathBuf),
    /// Writes what the selected layer asks for, as a grid.
    ExportGrid(PathBuf),
    /// Measures how far the mesh is from surfaces.
    MeasureSurface,
    /// Reads a picture or a grid, and adds it as a surface that the mesh is to be close to.
    OpenSurface(PathBuf),
    /// Reads a grid of heights or depths, and adds a layer of depths.
    OpenDepth(PathBuf),
    /// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
    OpenValues(PathBuf),
    /// Reads points, lines and polygons, and adds a layer of the distance to them.
    OpenShapes(PathBuf),
    /// Reads points, lines and polygons, to which the selected layer measures the distance from then on.
    ReplaceShapes(PathBuf),
    /// Reads polygons as the mask of the selected layer.
    OpenMask(PathBuf),
}

impl CommandSet for LayerCommand {}
