//! The tables of settings as texts have them.

use std::ops::Not;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{
    SavedCrest, SavedLineType, SavedName, SavedOpenings, SavedParts, SavedPieceType, SavedProblem, SavedRing,
    SavedRule, SavedUnit,
};
use crate::io::layers::{SavedLayer, SavedPolygon, SavedPositive};
use crate::io::lengths::{GroundArea, GroundLength, METRES, SavedLength, WrittenLengths};

/// All tables. `L` is a layer, with what says where its data are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table", bound(deserialize = "L: Deserialize<'de>"))]
pub struct SavedSettings<L = SavedLayer> {
    /// Ω and how the mesh meets its boundary.
    pub domain: SavedDomain,
    /// The coarse grid, the rule and what the mesh may cost.
    pub mesh: SavedMesh,
    /// Bounds of h̄.
    pub limits: SavedLimits,
    /// The size field, from the bottom layer to the top one.
    pub layer: Vec<L>,
    /// Between which places paths are sought, and what they cost.
    #[serde(skip_serializing_if = "is_default")]
    pub paths: SavedPaths,
    /// Regions that paths stay out of.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<SavedKeepOut>,
    /// Lines along which the mesh has edges.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub line: Vec<SavedLine>,
    /// What `meshbrush solve` solves on the mesh.
    #[serde(skip_serializing_if = "is_default")]
    pub problem: SavedProblem,
    /// Points whose triangles and values the window follows.
    #[serde(skip_serializing_if = "is_default")]
    pub pins: SavedPins,
    /// Files to write.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub output: Vec<SavedOutput>,
    /// Which of the lengths were written with a unit.
    #[serde(skip)]
    pub lengths: WrittenLengths,
}

impl<L> Default for SavedSettings<L> {
    fn default() -> Self {
        Self {
            domain: SavedDomain::default(),
            mesh: SavedMesh::default(),
            limits: SavedLimits::default(),
            layer: Vec::new(),
            paths: SavedPaths::default(),
            keep_out: Vec::new(),
            line: Vec::new(),
            problem: SavedProblem::default(),
            pins: SavedPins::default(),
            output: Vec::new(),
            lengths: WrittenLengths::default(),
        }
    }
}

impl<L> SavedSettings<L> {
    /// Returns the settings with other layers in place of their own.
    pub(in crate::io) fn with_layers<M, E>(
        self,
        of_layers: impl FnOnce(Vec<L>) -> Result<Vec<M>, E>,
    ) -> Result<SavedSettings<M>, E> {
        let Self { domain, mesh, limits, layer, paths, keep_out, line, problem, pins, output, lengths } =
            self;
        let layer = of_layers(layer)?;
        Ok(SavedSettings {
            domain,
            mesh,
            limits,
            layer,
            paths,
            keep_out,
            line,
            problem,
            pins,
            output,
            lengths,
        })
    }
}

impl<L> SavedSettings<L> {
    /// Takes lengths with units: those in metres need a plane in metres.
    pub(in crate::io) fn with_lengths(mut self, lengths: WrittenLengths) -> Self {
        if lengths.are_metric() && self.domain.outline_file().is_some() {
            self.domain.projection.get_or_insert_with(|| METRES.to_owned());
        }
        Self { lengths, ..self }
    }
}

fn is_default<T: Default + PartialEq>(table: &T) -> bool {
    *table == T::default()
}

/// `[domain]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedDomain {
    /// The domain is what the polygons of this file cover.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<PathBuf>,
    /// The domain is the rectangle less the land in this file, which polygons or lines of coast give.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub land: Option<PathBuf>,
    /// A place in the sea, in the coordinates of the file of the land.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sea: Option<[f64; 2]>,
    /// The rectangle that the coarse grid covers: x₀, y₀, x₁, y₁. With a file that is projected, and with
    /// land, it is in the coordinates of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 4]>,
    /// The domain is where this formula is not 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// Where the region is a grid: the depth, in metres, below which the domain is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contour: Option<f64>,
    /// Whether the values of the grid are heights or depths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positive: Option<SavedPositive>,
    /// The area of the smallest island, and of the smallest water, of the contour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_island: Option<GroundArea>,
    /// The width of the narrowest inlet of the contour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_inlet: Option<GroundLength>,
    /// Whether the domain is where the grid has values.
    #[serde(skip_serializing_if = "Not::not")]
    pub outside_nodata: bool,
    /// Rings whose insides are cut off the domain.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cut_off: Vec<SavedRing>,
    /// What the coordinates of files are that do not name a known system: "lonlat", "EPSG:…", or a projection
    /// as PROJ writes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
    /// The plane of the region, in metres: "none", "auto", a family, "EPSG:…", or a projection as PROJ writes
    /// it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<String>,
    /// The unit of coordinates and lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<SavedUnit>,
    /// How the mesh meets the outline of a region.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<SavedTreatment>,
    /// Largest diameter of a triangle on the outline.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary_diameter: Option<SavedLength>,
    /// The parts of the mesh that stay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts: Option<SavedParts>,
    /// Whether pinches stay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep_pinches: Option<bool>,
    /// Whether triangles along the outline are changed for better angles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub improve_boundary: Option<bool>,
    /// Where the boundary is open.
    #[serde(skip_serializing_if = "SavedOpenings::is_empty")]
    pub open: SavedOpenings,
    /// Where the boundary is split.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub splits: Vec<[f64; 2]>,
    /// Names of pieces of the boundary.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<SavedName>,
    /// Types of pieces of the boundary.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub types: Vec<SavedPieceType>,
}

/// `[mesh]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedMesh {
    /// Longest side of a coarse cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<SavedLength>,
    /// Which points of a triangle count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<SavedRule>,
    /// Most triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_triangles: Option<usize>,
    /// Deepest level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_level: Option<u32>,
    /// Most memory, as in `"2GB"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_memory: Option<String>,
}

/// `[limits]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedLimits {
    /// Smallest target diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub h_min: Option<SavedLength>,
    /// Target diameter at risk 1; the smallest where it is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub h_risk: Option<SavedLength>,
    /// Largest target diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub h_max: Option<SavedLength>,
    /// The exponent of the curve from risk to diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<f64>,
    /// How fast h̄ may change with the distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradation: Option<f64>,
}

/// `[paths]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedPaths {
    /// x and y of each place of each path, in world units, from the start to the goal.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub routes: Vec<Vec<[f64; 2]>>,
    /// The names of paths, in their order; an empty one is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<String>,
    /// Cost per unit of length, without risk.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_weight: Option<f64>,
    /// Cost per unit of length where the risk is 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub risk_weight: Option<f64>,
    /// A formula of x, y and the risk in place of the weights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost: Option<String>,
    /// The least distance from the outline of the domain and from keep-out regions, in world units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<SavedLength>,
}

/// `[[keep_out]]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedKeepOut {
    /// The name of the region.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The polygons of the region, in world units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polygons: Option<Vec<SavedPolygon>>,
    /// A file with the polygons, in their place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
}

/// `[[line]]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedLine {
    /// The name of the line, also in files of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// x and y of each corner, in world units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<[f64; 2]>>,
    /// Whether the last corner is joined to the first one.
    #[serde(skip_serializing_if = "Not::not")]
    pub closed: bool,
    /// A file with lines or polygons, in their place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// What it is for solvers; edges where it is missing.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub line_type: Option<SavedLineType>,
    /// The height of the crest of a weir.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crest: Option<SavedCrest>,
    /// The coefficients of the flow across a weir.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subcritical: Option<f64>,
    /// See [`Self::subcritical`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub supercritical: Option<f64>,
}

/// `[pins]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedPins {
    /// x and y of each, in world units.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<[f64; 2]>,
}

/// `[[output]]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SavedOutput {
    /// The file, whose ending decides the format.
    pub file: PathBuf,
    /// Whether a format that is text otherwise is written in its binary form.
    #[serde(default, skip_serializing_if = "Not::not")]
    pub binary: bool,
    /// The cells of a format that can have quadrilaterals: `"triangles"` or `"squares"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<String>,
    /// Further values at the nodes, as in `"depth = 20 - x"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
    /// Further values at the nodes, from grids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grids: Vec<SavedQuantityGrid>,
    /// The least depth in the file, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least_depth: Option<f64>,
    /// The largest r-factor of an edge: the depths are smoothed to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_slope: Option<f64>,
    /// Whether the third coordinate is 0, and not the height of a surface.
    #[serde(default, skip_serializing_if = "Not::not")]
    pub flat: bool,
    /// Width, or width and height, of a picture in pixels or as lengths, as in `"1600x900"` or `"160mm"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Pixels of an inch of a picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dpi: Option<f64>,
    /// Whether a picture shows the edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<bool>,
    /// Colours of the levels in a picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colormap: Option<String>,
    /// What colours the triangles of a picture, as in `"smallest_angle"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color_by: Option<String>,
    /// Whether the background of a picture is light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<bool>,
    /// What is behind the mesh of a picture: `"dark"`, `"light"`, `"white"` or `"transparent"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<String>,
    /// What stands around the map of a picture, as in `"legend,axes"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub furniture: Option<String>,
    /// What a picture shows: `"plan"` or `"space"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// Where one looks in space, in degrees clockwise from the y axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// How high the viewer is above the horizon, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
    /// The factor by which heights are exaggerated in space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exaggeration: Option<f64>,
}

/// A value at the nodes that a grid gives: the mean over the cell of each node.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SavedQuantityGrid {
    /// Its name in files.
    pub name: String,
    /// The grid.
    pub file: PathBuf,
    /// A table with the values of classes, where the grid has classes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<PathBuf>,
}

/// The boundary treatments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedTreatment {
    /// As in the report.
    Report,
    /// Refined along the outline.
    Fitted,
    /// With nodes on the outline.
    Outline,
}
