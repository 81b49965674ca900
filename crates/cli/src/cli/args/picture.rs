//! The look of pictures, as typed.

use clap::Args;

/// The default width of a picture, in pixels.
pub const PICTURE_SIZE: &str = "1600";
/// The default colours of the levels.
pub const PICTURE_COLORMAP: &str = "viridis";

impl PictureArguments {
    /// Returns whether an option was given that is not the default.
    pub fn differs_from_default(&self) -> bool {
        let Self { size, dpi, no_edges, colormap, color_by, light, ground, furniture } = self;
        let is_usual = size == PICTURE_SIZE && !no_edges && colormap == PICTURE_COLORMAP && !light;
        !is_usual || dpi.is_some() || color_by.is_some() || ground.is_some() || furniture.is_some()
    }
}

/// The look of pictures.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pictures (.svg and .png)")]
pub struct PictureArguments {
    /// Width, or width and height, in pixels, or as lengths on paper: 1600, 1600x900, 160mm, 16x9cm, 6in
    #[arg(long, value_name = "W[xH]", default_value = PICTURE_SIZE)]
    pub size: String,

    /// Pixels of an inch: how many pixels a length has, and how large pixels are on paper [default: 300 for
    /// lengths]
    #[arg(long, value_name = "NUMBER")]
    pub dpi: Option<f64>,

    /// Do not draw the edges
    #[arg(long)]
    pub no_edges: bool,

    /// Colours of the levels: viridis, magma, cividis, turbo or greys
    #[arg(long, value_name = "NAME", default_value = PICTURE_COLORMAP)]
    pub colormap: String,

    /// What colours the triangles: levels, target (the level that is asked for), smallest_angle,
    /// largest_angle, edge_ratio, target_ratio, time_step, triangles_at_node, link_length or link_cosine
    /// [default: levels]
    ///
    /// The legend of `--furniture legend` says what the colours mean. Time steps need depths.
    #[arg(long, value_name = "NAME", alias = "colour-by")]
    pub color_by: Option<String>,

    /// Draw on a light background
    #[arg(long)]
    pub light: bool,

    /// What is behind the mesh: dark, light, white or transparent [default: dark]
    ///
    /// With white and transparent, lines and texts have the colours of paper.
    #[arg(long, value_name = "NAME", conflicts_with = "light")]
    pub ground: Option<String>,

    /// What stands around the map: some of legend, axes, scale and north, separated by commas, or all, or
    /// none [default: only an arrow to the north over the map, in the plane of a projection]
    ///
    /// The legend has the diameter and the number of triangles of each level. Axes are longitudes and
    /// latitudes where the document lies on the Earth, and x and y elsewhere. The size of the
    /// picture includes all of this, and nothing covers the map.
    #[arg(long, value_name = "LIST")]
    pub furniture: Option<String>,
}
