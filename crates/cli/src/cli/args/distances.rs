//! The options on distances from which the target diameter grows.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use crate::cli::failure::Failure;
use meshbrush_core::domain::BoundaryType;
use meshbrush_io::io::layers::{BoundaryKeys, DistanceKeys, GrowthKeys, SavedLayer, ShapeKeys, TargetKeys};
use meshbrush_mesh::text::Length;

/// Growth of the target diameter by unit of distance, unless an option says otherwise.
const DEFAULT_SLOPE: f64 = 0.2;

/// What distances are measured to, and how the target diameter grows with them.
#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("measured").multiple(true).args(["distance", "distance_to_piece", "distance_to_type"])
)]
pub struct DistanceArguments {
    /// Points, lines or polygons (.geojson, .shp, .gpkg) from which the target diameter grows with the
    /// distance; may be repeated
    #[arg(long, value_name = "FILE.geojson")]
    pub distance: Vec<PathBuf>,

    /// A piece of the boundary from which it grows too, by name; may be repeated
    #[arg(long, value_name = "NAME")]
    pub distance_to_piece: Vec<String>,

    /// Pieces of the boundary from which it grows too, by type: open, land, "no-slip land", "natural land",
    /// inflow, "no-slip inflow" or "natural inflow"; may be repeated
    ///
    /// Sides of a rectangle that cuts the domain off are open, and other pieces land, unless their names
    /// begin with open or land.
    #[arg(long, value_name = "TYPE")]
    pub distance_to_type: Vec<String>,

    /// Target diameter at distance 0; the default is --h-min
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, requires = "measured")]
    pub distance_at_zero: Option<Length>,

    /// How much the target diameter grows with the distance: 0.2 is 2 in 10 [default: 0.2]
    #[arg(long, value_name = "SLOPE", allow_hyphen_values = true, requires = "measured")]
    pub distance_slope: Option<f64>,

    /// The distance beyond which the distance asks for nothing [default: unlimited]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, requires = "measured")]
    pub distance_range: Option<Length>,
}

impl DistanceArguments {
    /// Returns the layers of the options, each with its option as typed: one for each file, and one for all
    /// pieces of the boundary. `h_min` is the smallest target diameter, if an option gives it.
    ///
    /// # Errors
    /// Fails when there is no such type, or nothing says what the target diameter is at distance 0.
    pub fn layers(&self, h_min: Option<&Length>) -> Result<Vec<(String, SavedLayer)>, Failure> {
        let of_file = |path: &PathBuf| {
            let shapes = ShapeKeys { file: Some(path.clone()), shapes: None };
            (format!("--distance {}", path.display()), TargetKeys { shapes, ..TargetKeys::default() })
        };
        let layer = |(option, target): (String, TargetKeys)| {
            let at_zero = self.distance_at_zero.as_ref().or(h_min);
            let at_zero = at_zero.ok_or_else(|| {
                let problem =
                    "at distance 0 there is no target diameter. Give it with --distance-at-zero, or --h-min";
                Failure::Usage(format!("{option}: {problem}."))
            })?;
            let growth = GrowthKeys {
                at_zero: at_zero.value.into(),
                slope: self.distance_slope.unwrap_or(DEFAULT_SLOPE),
                range: self.distance_range.as_ref().map(|length| length.value.into()),
            };
            Ok((option, DistanceKeys { target, growth }.into()))
        };
        self.distance.iter().map(of_file).chain(self.pieces()?).map(layer).collect()
    }

    /// Returns the pieces of the boundary that a distance is measured to.
    fn pieces(&self) -> Result<Option<(String, TargetKeys)>, Failure> {
        let (names, words) = (&self.distance_to_piece, &self.distance_to_type);
        let named = names.first().map(|name| ("--distance-to-piece", name));
        let Some((option, first)) = named.or(words.first().map(|word| ("--distance-to-type", word))) else {
            return Ok(None);
        };
        let of_word = |word: &String| {
            let all = BoundaryType::WORDS.join(", ");
            let refused = || Failure::Usage(format!("--distance-to-type {word}: the types are {all}."));
            BoundaryType::from_word(word).map(Into::into).ok_or_else(refused)
        };
        let types = words.iter().map(of_word).collect::<Result<Vec<_>, _>>()?;
        let boundary = BoundaryKeys {
            to: None,
            pieces: (!names.is_empty()).then(|| names.clone()),
            types: (!types.is_empty()).then_some(types),
        };
        Ok(Some((format!("{option} {first}"), TargetKeys { boundary, ..TargetKeys::default() })))
    }
}
