//! The look of pictures, as typed.

use clap::Args;

/// The default width of a picture, in pixels.
pub const PICTURE_SIZE: &str = "1600";
/// The default colours of the levels.
pub const PICTURE_COLORMAP: &str = "viridis";

impl PictureArguments {
    /// Returns whether an option was given that is not the default.
    pub fn differs_from_default(&self) -> bool {
        self.size != PICTURE_SIZE || self.no_edges || self.colormap != PICTURE_COLORMAP || self.light
    }
}

/// The look of pictures.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pictures (.svg and .png)")]
pub struct PictureArguments {
    /// Width, or width and height, in pixels
    #[arg(long, value_name = "W[xH]", default_value = PICTURE_SIZE)]
    pub size: String,

    /// Do not draw the edges
    #[arg(long)]
    pub no_edges: bool,

    /// Colours of the levels: viridis, magma, cividis, turbo or greys
    #[arg(long, value_name = "NAME", default_value = PICTURE_COLORMAP)]
    pub colormap: String,

    /// Draw on a light background
    #[arg(long)]
    pub light: bool,
}
