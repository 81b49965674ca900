//! The options on depths of water and on straits.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};

use meshbrush_io::io::layers::{
    CourantKeys, DatumKeys, DepthKeys, DepthSizeKeys, GridKeys, SavedCombine, SavedLayer, SavedPositive,
    SharedKeys, SlopeKeys, WavelengthKeys,
};
use meshbrush_mesh::text::{Length, LengthUnit, area};

/// The period of the semidiurnal lunar tide (M2), in seconds.
const TIDE: f64 = 44_712.0;

/// Depths of water and straits, and the sizes that they ask for.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("grid_region").multiple(true).args(["region", "outside_nodata"]))]
#[command(group = ArgGroup::new("depths").multiple(true).args(["depth", "contour"]))]
pub struct WaterArguments {
    /// Where --region is a grid: the domain is where the depth is more than this, in metres [default: 0, the
    /// shore]
    #[arg(long, value_name = "DEPTH", requires = "region", allow_hyphen_values = true)]
    pub contour: Option<f64>,

    /// Area of the smallest island, and of the smallest water, of --contour; smaller ones are left out
    /// [default: none are]
    ///
    /// As in 20000, "2 km²" or "5 ha": without a unit in square metres where the grid is in longitudes and
    /// latitudes, otherwise in its unit.
    #[arg(long, value_name = "AREA", requires = "grid_region", allow_hyphen_values = true, value_parser = area_on_ground)]
    pub smallest_island: Option<f64>,

    /// Width of the narrowest inlet of --contour; narrower ones are closed [default: none are]
    ///
    /// Water stays where a disc of this diameter and one pixel, around the centre of a pixel, has no centre
    /// of a pixel of land in it. As in 300, "300 m" or "0.2 nmi": without a unit in metres where the grid is
    /// in longitudes and latitudes, otherwise in its unit.
    #[arg(long, value_name = "WIDTH", requires = "grid_region", allow_hyphen_values = true, value_parser = width_on_ground)]
    pub smallest_inlet: Option<f64>,

    /// The domain is where the grid of --region has values, or that of --surface where there is no region
    ///
    /// Its outline runs halfway between the centre of a pixel with a value and one without. With
    /// --smallest-island smaller gaps belong to the domain, and smaller parts do not.
    #[arg(long, conflicts_with_all = ["contour", "domain", "inside", "project"])]
    pub outside_nodata: bool,

    /// Depths of water: a grid of heights in metres, for the nodes of files and the options below; may be
    /// repeated, the first that has a value at a place counts
    ///
    /// Files get the depth at each node: the value there, or the mean of the pixels around it where triangles
    /// are larger than four of them.
    #[arg(long, value_name = "FILE")]
    pub depth: Vec<PathBuf>,

    /// Whether the values of --depth, and of the grid of --contour, are heights, so that water is below 0, or
    /// depths [default: up]
    #[arg(long, value_name = "up|down", requires = "depths")]
    pub depth_positive: Option<PositiveArgument>,

    /// Metres that are added to the depths of each file of --depth, in their order: for charts of depths
    /// below low water; the last counts for further files [default: 0]
    #[arg(long, value_name = "METRES", requires = "depth", allow_hyphen_values = true)]
    pub depth_offset: Vec<f64>,

    /// At least this many triangles in the length of a wave with the period --period
    ///
    /// The length follows from the depth, by the dispersion relation. Land asks for nothing.
    #[arg(long, value_name = "N", requires = "depth", allow_hyphen_values = true)]
    pub per_wavelength: Option<f64>,

    /// Period of the wave of --per-wavelength, in seconds [default: 44712, the lunar tide M2]
    #[arg(long, value_name = "SECONDS", requires = "per_wavelength", allow_hyphen_values = true)]
    pub period: Option<f64>,

    /// At least this many triangles in the topographic length, 2π H / slope
    #[arg(long, value_name = "N", requires = "depth", allow_hyphen_values = true)]
    pub per_slope: Option<f64>,

    /// Side of the squares over which heights are averaged for --per-slope [default: none]
    #[arg(long, value_name = "LENGTH", requires = "per_slope", allow_hyphen_values = true)]
    pub smoothing: Option<Length>,

    /// Largest Courant number of a wave of 1 m with --time-step, along edges
    ///
    /// A floor for all other sizes: no triangle is bisected whose halves would have a shorter edge than this
    /// needs. A note counts the edges that exceed it all the same, where neighbours, nodes on the outline or
    /// a steep bottom make them shorter.
    #[arg(long, value_name = "C", requires_all = ["depth", "time_step"], allow_hyphen_values = true)]
    pub max_courant: Option<f64>,

    /// Smallest Courant number of a wave of 1 m with --time-step: no triangle is larger than this allows
    #[arg(long, value_name = "C", requires_all = ["depth", "time_step"], allow_hyphen_values = true)]
    pub min_courant: Option<f64>,

    /// Time step of a solver, in seconds, for the Courant numbers
    #[arg(long, value_name = "SECONDS", requires = "depth", allow_hyphen_values = true)]
    pub time_step: Option<f64>,

    /// At least this many triangles across every strait of a region, down to --h-min
    ///
    /// A strait is where the water between two coasts is narrow. Those in which K triangles are smaller than
    /// --h-min get triangles of that size.
    #[arg(long, value_name = "K", requires = "region", requires = "h_min", allow_hyphen_values = true)]
    pub straits: Option<f64>,

    /// Width of the widest strait of --straits [default: K times --h-max]
    #[arg(long, value_name = "LENGTH", requires = "straits", allow_hyphen_values = true)]
    pub widest_strait: Option<Length>,

    /// This many triangles across the water everywhere, growing with the way from the shore and from the
    /// middle of the water: the feature size of a region
    ///
    /// The target diameter is 2 W / R, where W is the distance to the shore and the middle of the water
    /// together: half of the width of a channel. It changes by at most 4 / R times the way.
    #[arg(long, value_name = "R", requires = "region", requires = "h_min", allow_hyphen_values = true)]
    pub feature_size: Option<f64>,

    /// Width of the widest water of --feature-size [default: R times --h-max]
    #[arg(long, value_name = "LENGTH", requires = "feature_size", allow_hyphen_values = true)]
    pub widest_feature: Option<Length>,
}

/// The direction in which values grow.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PositiveArgument {
    /// Heights.
    Up,
    /// Depths.
    Down,
}

fn width_on_ground(text: &str) -> Result<f64, String> {
    Length::on_ground(text, LengthUnit::Metre)
}

fn area_on_ground(text: &str) -> Result<f64, String> {
    area(text, LengthUnit::Metre)
}

impl WaterArguments {
    /// Returns the layers of the options, from the bottom of the stack to its top, each with its option as
    /// typed. The last file is the lowest.
    pub fn depth_layers(&self) -> Vec<(String, SavedLayer)> {
        let finest = SavedCombine::Finest;
        let courant = |number: Option<f64>| {
            let (time_step, courant) = self.time_step.zip(number)?;
            Some(DepthSizeKeys::Courant(CourantKeys { time_step, courant }))
        };
        let rules = [
            self.per_wavelength.map(|triangles| {
                let period = self.period.unwrap_or(TIDE);
                let size = DepthSizeKeys::Wavelength(WavelengthKeys { period, triangles });
                ("--per-wavelength", size, finest)
            }),
            self.per_slope.map(|triangles| {
                let smoothing = self.smoothing.as_ref().map(|side| side.value.into());
                ("--per-slope", DepthSizeKeys::Slope(SlopeKeys { triangles, smoothing }), finest)
            }),
            courant(self.min_courant).map(|size| ("--min-courant", size, finest)),
            // A floor counts for all layers below it.
            courant(self.max_courant).map(|size| ("--max-courant", size, SavedCombine::Floor)),
        ];
        let files = || self.depth.iter().enumerate().rev();
        let nodes = files().map(|file| {
            let layer = self.depths(file, DepthSizeKeys::Nothing, finest);
            (format!("--depth {}", file.1.display()), layer)
        });
        let sizes = rules.iter().flatten().flat_map(|(option, size, combine)| {
            files().map(move |file| ((*option).to_owned(), self.depths(file, size.clone(), *combine)))
        });
        nodes.chain(sizes).collect()
    }

    /// Returns the layer of a file of depths, by its place among all.
    fn depths(
        &self,
        (number, file): (usize, &PathBuf),
        size: DepthSizeKeys,
        combine: SavedCombine,
    ) -> SavedLayer {
        let grid = GridKeys { file: Some(file.clone()), bounds: None };
        let offset = self.depth_offset.get(number).or(self.depth_offset.last()).copied();
        let datum = DatumKeys { positive: self.depth_positive.map(Into::into), offset };
        let keys = DepthKeys { grid, datum, size, ..DepthKeys::default() };
        let shared = SharedKeys { combine, ..SharedKeys::default() };
        SavedLayer { shared, ..keys.into() }
    }
}

impl From<PositiveArgument> for SavedPositive {
    fn from(typed: PositiveArgument) -> Self {
        match typed {
            PositiveArgument::Up => Self::Up,
            PositiveArgument::Down => Self::Down,
        }
    }
}
