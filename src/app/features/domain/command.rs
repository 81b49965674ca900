//! Commands about the domain.

use std::path::PathBuf;

use glam::DVec2;

use super::DomainToolMode;
use meshbrush_core::document::Setting;
use meshbrush_core::domain::{CutShape, DepthContour, Domain};
use meshbrush_core::layers::LayerId;
use meshbrush_kit::kit::command::CommandSet;
use meshbrush_mesh::geometry::Rect;

/// One thing to do with the domain.
#[derive(Clone, Debug, PartialEq)]
pub enum DomainCommand {
    /// Adds a shape to the domain (`true`) or removes it. Further shapes join this gesture until
    /// [`Command::EndGesture`].
    Reshape(CutShape, bool),
    /// Adds the hole of the domain around a point (`true`), or removes the part that the point is in.
    Fill(DVec2, bool),
    /// Sets the next corner of the polygon to cut with.
    AddCorner(DVec2),
    /// Moves one of its corners.
    MoveCorner(usize, DVec2),
    /// Removes its last corner.
    RemoveCorner,
    /// Closes that polygon and cuts. It needs three corners.
    ClosePolygon,
    /// Selects the tool and what it cuts with.
    Mode(DomainToolMode),
    /// Sets whether it adds or removes.
    Adds(bool),
    /// Gives the domain other bounds.
    Bounds(Rect),
    /// Reads polygons, and opens a new document with them as its domain. Longitudes and latitudes are asked
    /// about first.
    Choose(PathBuf),
    /// Opens such a document without a question: in metres where that is possible, with a note.
    OpenFirst(PathBuf),
    /// Opens a document whose domain are polygons in the coordinates of their file.
    Open(PathBuf),
    /// Opens a document whose domain are polygons on the Earth, in the plane of a projection.
    OpenInMetres(PathBuf),
    /// Opens a document whose domain is the water around land, or beside lines of coast.
    OpenSea(PathBuf),
    /// Reads polygons, and adds them to the domain of the document.
    AddOutline(PathBuf),
    /// Makes a contour of a layer of depths the domain.
    UseContour(LayerId, DepthContour),
    /// Makes the area in which the raster of a layer of a surface has values the domain.
    UseValues(LayerId),
    /// Takes over an outline that was read or found.
    SetOutline(Box<OutlineChange>),
}

impl CommandSet for DomainCommand {}

/// An outline that was read for a domain.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineChange {
    /// The name of the file or the layer.
    pub name: String,
    /// The domain that it was made for.
    pub before: Domain,
    /// The change of the document.
    pub setting: Setting,
    /// A sentence about the new domain; without one, polygons of a file were added to it.
    pub news: Option<String>,
}
