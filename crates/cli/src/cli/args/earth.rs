//! Arguments on a region: what its coordinates are, in which plane it is meshed, and where it is open.

use std::path::PathBuf;

use clap::Args;

/// What the coordinates of files are, the plane of the mesh, and its open boundary.
#[derive(Debug, Args)]
pub struct EarthArguments {
    /// Land or coasts: the domain is the rectangle of --bounds less the land. A GeoJSON file, shapefile or
    /// GeoPackage with polygons or lines; - is GeoJSON from standard input
    ///
    /// Only what lies in the rectangle counts, so that a file of the whole Earth serves for a bay. Lines are
    /// closed along the rectangle; closed lines are islands. Without --bounds the rectangle is one around the
    /// land. Its sides are the open boundary.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["domain", "inside", "region"])]
    pub land: Option<PathBuf>,

    /// West, south, east and north: the part of the file of --region or --land that counts, in its
    /// coordinates
    ///
    /// In degrees the east may be less than the west: then the rectangle goes across 180°.
    #[arg(long, value_name = "W,S,E,N", allow_hyphen_values = true)]
    pub bounds: Option<String>,

    /// A place in the sea, where the lines of --land do not tell on which side it is; in the coordinates of
    /// the file
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "land")]
    pub sea: Option<String>,

    /// Mesh the region in metres on the Earth, in the plane of a conformal projection
    ///
    /// All lengths are then in metres, and no edge of the mesh is longer on the Earth than its target
    /// diameter (by the area rule), whatever the scale of the plane is. auto chooses what suits the region:
    /// merc (Mercator), tmerc (transverse Mercator), stere (polar stereographic) or lcc (Lambert). EPSG:N is
    /// the projection of a code, such as EPSG:32633 for a zone of UTM. A projection written as PROJ does,
    /// with all its numbers, is also the coordinate system of files that name none. metres keeps the plane of
    /// the region's file if it is known, and is auto otherwise. none takes degrees for lengths in a plane
    /// [default: metres if a length has a unit, as in 2 km; otherwise none]
    #[arg(long, value_name = "auto|metres|none|merc|tmerc|stere|lcc|EPSG:N|PROJ")]
    pub projection: Option<String>,

    /// Coordinate system of files that do not name a known one: lonlat, EPSG:N, or a projection written as
    /// PROJ does
    ///
    /// Without it, coordinates within the range of longitudes and latitudes are taken as degrees.
    #[arg(long, value_name = "lonlat|EPSG:N|PROJ")]
    pub crs: Option<String>,

    /// Where the boundary is open: in the polygons of a file, where the water is deeper, along the frame, or
    /// in a box. May be repeated
    ///
    /// frame is the rectangle around the region, in the coordinates of its file. depth>50 is where the
    /// grids of --depth are deeper than 50 m. A box is west, south, east and north, in the coordinates of
    /// the region's file. Islands stay land. Without this option, sides along which the region was cut off
    /// by a rectangle are open.
    #[arg(long, value_name = "FILE|depth>N|frame|W,S,E,N", allow_hyphen_values = true)]
    pub open: Vec<String>,
}
