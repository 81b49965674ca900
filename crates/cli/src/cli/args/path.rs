//! Arguments of `meshbrush path`.

use std::path::PathBuf;

use clap::Args;

use super::input::InputArguments;
use super::picture::PictureArguments;
use crate::cli::output_coordinates::OutputCoordinates;
use meshbrush_mesh::text::Length;

/// `meshbrush path`.
#[derive(Debug, Args)]
pub struct PathArguments {
    #[command(flatten)]
    pub input: InputArguments,

    /// Where the path begins [default: where that of the project or recipe does]
    ///
    /// In world units, as in 0.5,0.25, or as longitude and latitude, as in 24.5°,37.9°.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "to", help_heading = "Path")]
    pub from: Option<String>,

    /// Where the path ends [default: where that of the project or recipe does]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "from", help_heading = "Path")]
    pub to: Option<String>,

    /// A place that the path visits on the way; may be repeated, in order
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "from", help_heading = "Path")]
    pub via: Vec<String>,

    /// Which path of the project or recipe, from 1 [default: 1]
    #[arg(long, value_name = "N", conflicts_with = "from", help_heading = "Path")]
    pub route: Option<usize>,

    /// Polygons (.geojson, .shp, .gpkg) that the path stays out of, in place of those of the project or
    /// recipe; may be repeated
    #[arg(long, value_name = "FILE.geojson", help_heading = "Path")]
    pub keep_out: Vec<PathBuf>,

    /// Keep paths at least this far from the outline of the domain, where polygons give it, and from keep-out
    /// regions [default: that of the project or recipe, or 0]
    ///
    /// In the plane of a projection, this is a length on the Earth. Triangles that are nearer are left out;
    /// along them the mesh is divided for the path. Sides of the rectangle around the domain do not count.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Path")]
    pub clearance: Option<Length>,

    /// Cost per unit of length as a formula of x, y and risk, in place of the weights
    ///
    /// Without this and without weights, the cost is that of the project or recipe.
    #[arg(
        long,
        value_name = "EXPR",
        allow_hyphen_values = true,
        conflicts_with_all = ["length_weight", "risk_weight"],
        help_heading = "Path"
    )]
    pub cost: Option<String>,

    /// What a unit of length costs where there is no risk [default: that of the file, or 1]
    #[arg(long, value_name = "L", allow_hyphen_values = true, help_heading = "Path")]
    pub length_weight: Option<f64>,

    /// What a unit of length costs at risk 1, beside that [default: that of the file, or 10]
    #[arg(long, value_name = "K", allow_hyphen_values = true, help_heading = "Path")]
    pub risk_weight: Option<f64>,

    /// Prove that the path costs at most this much more than the best, as in 1% or 0.01
    ///
    /// Raises the lower bound and looks for better paths until the interval is that narrow, which can take
    /// seconds, or until the work gains nothing more: then a sentence says what would help. The bound holds
    /// for all paths through the domain, not only for those through the mesh. Without this option there is a
    /// lower bound where the mesh covers the whole domain, that is, the domain is a rectangle.
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, help_heading = "Path")]
    pub within: Option<String>,

    /// File to write with what proves the lower bound, as numbers that other programs can check (.json)
    ///
    /// For each leg of the path a function on triangles, whose gradient is nowhere greater than the cost: the
    /// path costs at least the difference of its values at goal and start. tests/check_certificate.py of the
    /// source code is such a program.
    #[arg(long, value_name = "FILE", requires = "within", help_heading = "Output")]
    pub certificate: Option<PathBuf>,

    /// Say how long the path takes at this speed, as in '12 kn', '6 m/s' or '20 km/h'
    ///
    /// In the plane of a projection, and for longitudes and latitudes, lengths are those on the ellipsoid;
    /// otherwise coordinates must be known to be in m or km.
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, help_heading = "Output")]
    pub speed: Option<String>,

    /// Leave out points that are no farther than this from the path
    ///
    /// In the plane of a projection, this is a length on the Earth.
    /// Points without which the path would leave the domain or enter a keep-out region stay, and so do those
    /// without which a part of it would cost more than 1 % more. Cost and bounds are those of the path that
    /// is written.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Output")]
    pub simplify: Option<Length>,

    /// File to write, may be repeated: .geojson .csv .gpx .kml .svg .png
    ///
    /// A .csv has the cost up to each point. A .gpx is a route and a .kml a line in longitudes and latitudes
    /// (WGS 84): the domain needs a projection, or the unit degrees. They have further points, so that lines
    /// between them stay within 2 m of the path whether drawn as great circles or with one course. A picture
    /// has the mesh, with the path over it.
    #[arg(short, long = "output", value_name = "FILE", help_heading = "Output")]
    pub output: Vec<PathBuf>,

    /// Coordinates in .geojson and .csv of a region on the Earth: longitude and latitude (lonlat), those of
    /// the plane of --projection (plane), or those of a code or of a projection as PROJ writes it [default:
    /// of .geojson lonlat, of .csv those of the region's file]
    #[arg(long, value_name = "lonlat|plane|EPSG:N|PROJ", help_heading = "Output")]
    pub out_crs: Option<OutputCoordinates>,

    /// Print the result as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,

    #[command(flatten)]
    pub picture: PictureArguments,
}
