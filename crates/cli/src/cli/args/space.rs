//! Arguments of pictures in space.

use clap::{Args, ValueEnum};

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PictureView {
    /// The plan
    Plan,
    /// The surface in space
    Space,
}

/// Pictures in space.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pictures (.svg and .png)")]
pub struct SpaceArguments {
    /// What pictures show: the plan, or the mesh as a surface in space
    ///
    /// The heights are those of layers of surfaces, or else depths. Triangles without a height are left out.
    /// Pictures in space are .png.
    #[arg(long, value_name = "VIEW", value_enum, default_value = "plan")]
    pub view: PictureView,

    /// Direction in which one looks in space, in degrees clockwise from the y axis: 0 is northwards
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub azimuth: Option<f64>,

    /// How high the viewer stands above the horizon, 5 to 90 degrees: 90 is from above
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub altitude: Option<f64>,

    /// Factor for heights in space; without it relief has an eighth of the longer side of the domain
    ///
    /// In domains in kilometres or degrees, heights are metres: 1 is true there, too.
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    pub exaggeration: Option<f64>,
}

impl SpaceArguments {
    /// Returns whether an option was given that is not the default.
    pub fn differs_from_default(&self) -> bool {
        let Self { view, azimuth, altitude, exaggeration } = self;
        *view != PictureView::Plan || [azimuth, altitude, exaggeration].iter().any(|number| number.is_some())
    }
}
