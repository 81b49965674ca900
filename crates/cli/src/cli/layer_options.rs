//! The layers that the options ask for, from the bottom of the stack to its top.

use std::path::Path;

use super::args::InputArguments;
use super::failure::Failure;
use super::request::{length, parse_formula};
use meshbrush_core::layers::Quantity;
use meshbrush_io::io::layers::{
    DistanceTo, KindSpec, LayerSpec, RasterFile, RasterFormat, RasterReading, ThreatsSpec,
};
use meshbrush_mesh::text::Number;

/// Growth of the target diameter by unit of distance, unless an option says otherwise.
const USUAL_SLOPE: f64 = 0.2;

/// The layers of the options, each of which takes the finest.
///
/// # Errors
/// With a sentence that names the option, the value and the rule.
pub fn layers(typed: &InputArguments) -> Result<Vec<LayerSpec>, Failure> {
    let mut kinds = Vec::new();
    for (option, texts, quantity) in
        [("--target", &typed.target, Quantity::Diameter), ("--risk", &typed.risk, Quantity::Risk)]
    {
        for text in texts {
            kinds.push(KindSpec::Formula { quantity, formula: parse_formula(option, text)? });
        }
    }
    for path in &typed.target_raster {
        kinds.push(raster("--target-raster", path, RasterReading::Diameter)?);
    }
    for path in &typed.risk_raster {
        kinds.push(raster("--risk-raster", path, RasterReading::Risk)?);
    }
    kinds.extend(typed.threats.iter().map(|path| KindSpec::Threats(ThreatsSpec::File(path.clone()))));
    for path in &typed.distance {
        kinds.push(distance(typed, path)?);
    }
    Ok(kinds.into_iter().map(LayerSpec::of_kind).collect())
}

fn raster(option: &str, path: &Path, reading: RasterReading) -> Result<KindSpec, Failure> {
    let format = RasterFormat::of(path);
    let format = format.map_err(|rule| Failure::Usage(format!("{option} {}: {rule}", path.display())))?;
    let raster = RasterFile { path: path.to_owned(), format, bounds: None };
    Ok(KindSpec::Raster { raster, reading })
}

fn distance(typed: &InputArguments, path: &Path) -> Result<KindSpec, Failure> {
    let Some(at_zero) = typed.distance_at_zero.or(typed.h_min) else {
        let problem = format!("--distance {}: at distance 0 there is no target diameter", path.display());
        return Err(Failure::Usage(format!("{problem}. Give it with --distance-at-zero, or --h-min.")));
    };
    let slope = typed.distance_slope.unwrap_or(USUAL_SLOPE);
    if !(slope >= 0.0 && slope.is_finite()) {
        let rule = "the growth by unit of distance must be 0 or more, and finite";
        return Err(Failure::Usage(format!("--distance-slope {}: {rule}.", Number(slope))));
    }
    Ok(KindSpec::Distance {
        to: DistanceTo::File(path.to_owned()),
        at_zero: length("--distance-at-zero", at_zero)?,
        slope,
        range: typed.distance_range.map(|range| length("--distance-range", range)).transpose()?,
    })
}
